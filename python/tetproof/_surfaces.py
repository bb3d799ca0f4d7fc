"""Surfaces, and arrays as the module `_core` takes them."""
import dataclasses
import html
import os
import re
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, NamedTuple, Optional, Set, Tuple, Union

import numpy as np

from . import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
else:
    Array = np.ndarray


def _line(name: str, *counts: Tuple[int, str], more: str = "") -> str:
    return "%s(%s)" % (name, ", ".join(["%d %s" % pair for pair in counts] + ([more] if more else [])))


def _html(title: str, rows: Iterable[Tuple[str, Any]]) -> str:
    """What a notebook shows: a table of names and values."""
    cells = "".join('<tr><td style="text-align:left">%s</td><td style="text-align:left">%s</td></tr>' % (html.escape(name), html.escape(str(value)))
                    for name, value in rows)
    return "<b>%s</b><table>%s</table>" % (html.escape(title), cells)


def _indices(values: Any, name: str) -> Array:
    array = np.asarray(values)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise TypeError("%s must be whole numbers, not %s" % (name, array.dtype))
    if array.size and (array.min() < 0 or array.max() > 0xffffffff):
        raise ValueError("%s: numbers of points are from 0 to 2^32 - 1" % name)
    return np.ascontiguousarray(array, dtype=np.uint32)


def _points(values: Any) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)


def _labels(values: Any, name: str = "labels") -> Optional[Array]:
    if values is None:
        return None
    array = np.asarray(values)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        if not np.issubdtype(array.dtype, np.floating) or not (array == np.round(array)).all():
            raise TypeError("%s must be whole numbers, not %s" % (name, array.dtype))
    if array.size and (array.min() < -0x80000000 or array.max() > 0x7fffffff):
        raise ValueError("%s are from -2^31 to 2^31 - 1" % name)
    return np.ascontiguousarray(array, dtype=np.int32)


def _signed(value: Any) -> Any:
    """Numbers of things, of which differences do not wrap around."""
    if not isinstance(value, np.ndarray) or value.dtype != np.uint32:
        return value
    return value.view(np.int32) if value.size == 0 or value.max() < 1 << 31 else value.astype(np.int64)


class Defect(NamedTuple):
    """What is wrong at one place of a surface: its kind, a line that names it, and the numbers of the vertices and triangles."""
    kind: str
    message: str
    vertices: Array
    triangles: Array


class RegionPoint(NamedTuple):
    """What the region around a point is called, how long its edges may be (0: any), or that it is left out."""
    point: Tuple[float, float, float]
    name: str = ""
    max_edge: float = 0
    is_hole: bool = False


class Face(NamedTuple):
    """The triangles of one label of a surface: how many, their area, and the two corners of their bounding box. The shape is "planar"
    (then `direction` is the normal, outwards), "cylindrical" (then it is that of the axis) or "other" (then it is zero), within a
    thousandth of the box."""
    label: int
    name: str
    triangles: int
    area: float
    shape: str
    direction: Array
    lower: Array
    upper: Array


@dataclasses.dataclass(eq=False, repr=False)  # arrays have no one truth to compare by
class Surface:
    """A triangulated surface.

    Attributes
    ----------
    points : (n, 3) float64
    triangles : (m, 3) int32
        Counter-clockwise seen from outside.
    labels : (m,) int32
    names : dict of int to str
        What labels are called, where a file says so.
    region_points : list of RegionPoint
        Of a .poly or .smesh.
    """
    points: Array
    triangles: Array
    labels: Array
    names: Dict[int, str] = dataclasses.field(default_factory=dict)
    warnings: List[str] = dataclasses.field(default_factory=list)
    region_points: List[RegionPoint] = dataclasses.field(default_factory=list)

    def __repr__(self) -> str:
        return _line(type(self).__name__, (len(self.points), "points"), (len(self.triangles), "triangles"),
                     (len(np.unique(self.labels)), "labels"))

    def _repr_html_(self) -> str:
        rows: List[Tuple[str, Any]] = [("points", len(self.points)), ("triangles", len(self.triangles))]
        rows += [("label %d" % label, "%d triangles%s" % (count, ", " + self.names[label] if label in self.names else ""))
                 for label, count in zip(*(found.tolist() for found in np.unique(self.labels, return_counts=True)))][:20]
        return _html(type(self).__name__, rows + [("warning", line) for line in self.warnings])

    def plot(self, defects: Any = None, *, show: bool = True) -> Any:
        """Show the surface, with its defects in red, by pyvista.

        Parameters
        ----------
        defects : Report or InvalidSurface, optional
            Whose `places` to show; else `check` finds them.
        show
            As in `Mesh.plot`, like what comes back.
        """
        import pyvista

        from ._jobs import check

        places = (check(self) if defects is None else defects).places
        plotter = pyvista.Plotter()
        sound = np.ones(len(self.triangles), bool)
        for kind, found in places.items():
            if not len(found):
                continue
            if kind.endswith(" edge") or kind == "inconsistent orientation":
                lines = pyvista.PolyData(self.points, lines=np.hstack([np.full((len(found), 1), 2), found]).ravel())
                plotter.add_mesh(lines, color="red", line_width=5, label=kind)
            elif kind == "non-manifold vertex":
                plotter.add_mesh(pyvista.PolyData(self.points[found[:, 0]]), color="red", point_size=12, label=kind)
            elif "triangle" in kind or kind == "self-intersection":
                sound[np.unique(found)] = False
        drawable = (self.triangles < len(self.points)).all(axis=1) & (self.triangles >= 0).all(axis=1)
        for which, color in ((sound & drawable, "lightgray"), (~sound & drawable, "red")):
            if which.any():
                faces = np.hstack([np.full((int(which.sum()), 1), 3), self.triangles[which]]).ravel()
                plotter.add_mesh(pyvista.PolyData(self.points, faces), color=color, show_edges=True)
        if show:
            plotter.show()
        return plotter

    def faces(self) -> List[Face]:
        """What the triangles of each label are, by label."""
        rows = _core.labelled_faces(*_surface(self, None, None))
        return [Face(label, self.names.get(label, "label %d" % label), count, area, shape, *map(np.array, vectors))
                for label, count, area, shape, *vectors in rows]

    def write(self, path: "Union[str, os.PathLike[str]]") -> None:
        """Write an .stl, .ply or .off, see `write`."""
        from ._jobs import write  # which takes these classes

        write(path, self)

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` of the triangles, with cell data ``label``."""
        import meshio

        return meshio.Mesh(self.points, [("triangle", self.triangles.astype(np.int64))], cell_data={"label": [self.labels]})

    def to_trimesh(self) -> Any:
        """A `trimesh.Trimesh` with the same points and triangles."""
        import trimesh

        return trimesh.Trimesh(self.points, self.triangles, process=False)

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData`, with cell data ``label``."""
        import pyvista

        faces = np.hstack([np.full((len(self.triangles), 1), 3), self.triangles]).ravel()
        data = pyvista.PolyData(self.points, faces)
        data.cell_data["label"] = self.labels
        return data


@dataclasses.dataclass(eq=False, repr=False)
class Repaired(Surface):
    """A mended surface; `done` says what was done to it, a line each."""
    done: List[str] = dataclasses.field(default_factory=list)


# What meshio calls cells, and the numbers of VTK, by which pyvista has them; and cells of the same dimension, of whatever order, that
# would be missing.
_TRIANGLES, _TETRAHEDRA = ("triangle", 5), ("tetra", 10)
_NO_TRIANGLES = ("(triangle|quad|pixel|polygon|VTK_(LAGRANGE|BEZIER)_(TRIANGLE|QUAD))", {6, 7, 8, 9, 22, 23, 28, 30, 34, 36, 61, 62, 63, 69, 70, 76, 77})
_NO_TETRAHEDRA = ("(tetra|hexahedron|voxel|wedge|pyramid|polyhedron|penta_prism|hexa_prism|VTK_(LAGRANGE|BEZIER)_(TETRA|HEXA|WEDGE|PYRAMID))",
                  {11, 12, 13, 14, 15, 16, 24, 25, 26, 27, 29, 31, 32, 33, 37, 41, 42, 64, 65, 66, 67, 71, 72, 73, 74, 78, 79, 80, 81})


def _kind_of_cells(given: Any, kinds: Tuple[Any, ...], others: Tuple[str, Set[int]]) -> Any:
    """The name or number of those cells that an object of meshio or pyvista has of these kinds, or None."""
    cells = getattr(given, "cells_dict", {})
    names, numbers = others
    wrong = [str(cell) for cell in cells if cell not in kinds and (re.match(names, cell) if isinstance(cell, str) else int(cell) in numbers)]
    if wrong:
        raise ValueError("only cells of the kind %s are taken, with straight edges, and there are others: %s" % (kinds[0], ", ".join(wrong)))
    return next((kind for kind in kinds if kind in cells), None)


def _of_triangles(faces: Any) -> Array:
    """The triangles of the faces that pyvista has, each after the number of its corners."""
    array = np.ravel(faces)
    if len(array) % 4 or (array[::4] != 3).any():
        raise ValueError("the surface has faces that are no triangles; its method `triangulate` makes triangles")
    return array.reshape(-1, 4)[:, 1:]


def _surface(points: Any, triangles: Any, labels: Any) -> Tuple[Array, Array, Optional[Array]]:
    """Arrays, or an object that has them: of tetproof, trimesh (vertices, faces), meshio (points, cells_dict) or pyvista."""
    if triangles is None:
        given = points
        if hasattr(given, "vertices") and hasattr(given, "faces"):
            points, triangles = given.vertices, given.faces
        elif (kind := _kind_of_cells(given, _TRIANGLES, _NO_TRIANGLES)) is not None:
            points, triangles = given.points, given.cells_dict[kind]
        elif hasattr(given, "points") and hasattr(given, "triangles"):
            points, triangles = given.points, given.triangles
            labels = labels if labels is not None else getattr(given, "labels", None)
        elif hasattr(given, "faces") and hasattr(given, "points"):
            points, triangles = given.points, _of_triangles(given.faces)
        else:
            raise TypeError("points and triangles are expected, or an object that has them, not %s; `read` makes one of a file"
                            % type(given).__name__)
    return _points(points), _indices(triangles, "triangles"), _labels(labels)

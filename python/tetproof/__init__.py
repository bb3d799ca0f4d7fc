"""Tetrahedral meshes of closed triangulated surfaces, exactly conforming.

>>> import numpy as np, tetproof
>>> points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
>>> triangles = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
...              [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
>>> mesh = tetproof.mesh(points, triangles, max_edge=0.5)
>>> float(round(mesh.volumes().sum(), 12))
1.0
"""
import contextlib
import dataclasses
import difflib
import errno
import inspect
import os
import re
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Tuple, TypeVar, Union

import numpy as np

from . import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
else:
    Array = np.ndarray

__version__ = _core.version
__all__ = ["Defect", "Error", "Face", "Interrupted", "InvalidMesh", "InvalidSurface", "LimitReached", "Mesh", "PlaneMesh", "PlaneReport",
           "Repaired", "RepairedPlane", "Report", "Surface", "TenNodes", "cdt", "check", "check_plane", "improve", "label_by_angle", "mesh", "plane",
           "read", "read_mesh", "remesh", "repair", "repair_plane", "write"]

#: Called several times a second with the phase, the fraction done (negative: unknown) and the vertices so far; False ends the run.
Progress = Callable[[str, float, int], Optional[bool]]


class Error(Exception):
    """A run ended without a result; the message says why."""


class LimitReached(Error):
    """Vertices, time, memory or the precision of doubles.

    Attributes
    ----------
    limit : str
        "size", "time", "memory" or "precision".
    """

    def __init__(self, message: str, limit: str = ""):  # with a default, or it could not leave another process
        super().__init__(message)
        self.limit = limit


class Interrupted(Error):
    """The progress callable returned False."""


class InvalidMesh(Error, ValueError):
    """The mesh given to `improve` is not conforming."""


class Defect(NamedTuple):
    """What is wrong at one place of a surface: its kind, a line that names it, and the numbers of the vertices and triangles."""
    kind: str
    message: str
    vertices: Array
    triangles: Array


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


class TenNodes(NamedTuple):
    """Elements of second order: `points`, the mesh's own first; (t, 10) `tetrahedra` and (b, 6) `boundary`, corners first, then nodes
    in the middle of the edges 01 12 02, of tetrahedra also 03 13 23 (the order of VTK, meshio, Abaqus and Nastran)."""
    points: Array
    tetrahedra: Array
    boundary: Array


def _line(name: str, *counts: Tuple[int, str], more: str = "") -> str:
    return "%s(%s)" % (name, ", ".join(["%d %s" % pair for pair in counts] + ([more] if more else [])))


class InvalidSurface(Error, ValueError):
    """The surface is not closed, manifold, oriented and free of self-intersections.

    Attributes
    ----------
    report : Report
        What `check` says of it.
    defects : list of Defect
        Described: at most ten of each kind.
    counts : dict of str to int
        How many defects there are of each kind.
    places : dict of str to (n, 2) int32
        All of them, as in `Report`.
    """

    def __init__(self, message: str, report: "Optional[Report]" = None):
        if report and len(report.defects) > 1:
            message += "; in all " + ", ".join("%s: %d" % count for count in report.counts.items())
        if report and report.hints:
            message += "; " + report.hints[0]
        super().__init__(message)
        self.report = report
        self.defects = report.defects if report else []
        self.counts = report.counts if report else {}
        self.places = report.places if report else {}


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
    """
    points: Array
    triangles: Array
    labels: Array
    names: Dict[int, str] = dataclasses.field(default_factory=dict)
    warnings: List[str] = dataclasses.field(default_factory=list)

    def __repr__(self) -> str:
        return _line(type(self).__name__, (len(self.points), "points"), (len(self.triangles), "triangles"),
                     (len(np.unique(self.labels)), "labels"))

    def faces(self) -> List[Face]:
        """What the triangles of each label are, by label."""
        rows = _core.labelled_faces(*_surface(self, None, None))
        return [Face(label, self.names.get(label, "label %d" % label), count, area, shape, *map(np.array, vectors))
                for label, count, area, shape, *vectors in rows]

    def write(self, path: "Union[str, os.PathLike[str]]") -> None:
        """Write an .stl, .ply or .off, see `write`."""
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


@dataclasses.dataclass(eq=False, repr=False)
class Mesh:
    """A mesh of tetrahedra.

    Attributes
    ----------
    points : (n, 3) float64
    tetrahedra : (t, 4) int32
        Positively oriented: det(b - a, c - a, d - a) > 0.
    inside : (t,) bool
        In the solid: all of them, unless the region is the hull.
    regions : (t,) int32 or empty
        With ``regions="all"``, largest first, and of meshes from elsewhere.
    boundary : (b, 3) int32
        The triangles that tile the surface, counter-clockwise seen from outside.
    labels, facets : (b,) int32
        The label of the input, and the facet that the triangle is a part of.
    names, region_names : dict of int to str
        What labels, and regions, are called in files.
    planar_within : float
        How far the boundary may be from the surface as given between the vertices and edges of that, as a fraction of the diagonal.
    stats : dict
        Sizes, angles in degrees, shapes and seconds.
    warnings : list of str
    """
    points: Array
    tetrahedra: Array
    inside: Array
    boundary: Array
    labels: Array
    facets: Array
    regions: Array = dataclasses.field(default_factory=lambda: np.zeros(0, np.int32))
    names: Dict[int, str] = dataclasses.field(default_factory=dict)
    stats: Dict[str, Any] = dataclasses.field(default_factory=dict)
    warnings: List[str] = dataclasses.field(default_factory=list)
    region_names: Dict[int, str] = dataclasses.field(default_factory=dict)
    planar_within: float = 0

    def __repr__(self) -> str:
        refined = self.stats.get("final", {})
        angle = "smallest dihedral angle %.2f degrees" % refined["min_dihedral"] if refined else ""
        return _line("Mesh", (len(self.points), "points"), (len(self.tetrahedra), "tetrahedra"), (len(self.boundary), "boundary triangles"),
                     more=angle)

    def boundary_regions(self) -> Array:
        """(b, 2) int32: the regions behind each boundary triangle, from where it is seen clockwise, and in front; 0 where there is none."""
        faces = np.concatenate([self.tetrahedra[:, list(f)] for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])  # seen from outside
        start = np.argmin(self.boundary, axis=1)[:, None]
        turned = [np.take_along_axis(self.boundary, (start + np.array(k)) % 3, axis=1) for k in ((0, 1, 2), (0, 2, 1))]
        own = np.take_along_axis(faces, (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3, axis=1)
        region = {tuple(face): number for face, number in zip(own.tolist(), np.tile(self._regions(), 4).tolist())}
        sides: Array = np.array([[region.get(tuple(face), 0) for face in side.tolist()] for side in turned], np.int32)
        return sides.T

    def region(self, which: Union[str, int]) -> "Mesh":
        """The mesh of one region, by its name or number, with the boundary triangles at it."""
        named = [number for number, name in self.region_names.items() if name == which]
        numbers = named or [number for number in np.unique(self._regions()).tolist() if number == which]
        if not numbers:
            raise KeyError("no region %r: there are %s" % (which, ", ".join(sorted(self.region_names.values())) or "no names"))
        inside, at = np.isin(self._regions(), numbers), np.isin(self.boundary_regions(), numbers).any(axis=1)
        points, tetrahedra = np.unique(self.tetrahedra[inside], return_inverse=True)
        boundary = np.searchsorted(points, self.boundary[at]).astype(np.int32)
        return dataclasses.replace(self, points=self.points[points], tetrahedra=tetrahedra.reshape(-1, 4).astype(np.int32), inside=self.inside[inside],
                                   boundary=boundary, labels=self.labels[at], facets=self.facets[at], regions=self._regions()[inside], stats={},
                                   region_names={number: name for number, name in self.region_names.items() if number in numbers})

    def _regions(self) -> Array:
        return self.regions if len(self.regions) else np.where(self.inside, 1, 2).astype(np.int32)

    def _sets(self) -> "Tuple[Dict[str, Tuple[int, int]], Dict[str, List[Array]]]":
        """By name: number and dimension; the tetrahedra and the boundary triangles of the set."""
        regions = self._regions()
        sides = {} if len(self.regions) else {1: "inside", 2: "outside"}
        numbers: Dict[str, Tuple[int, int]] = {}
        members: Dict[str, List[Array]] = {}
        none = np.zeros(0, np.int64)
        for dimension, values, names, kind in ((3, regions, sides or self.region_names, "region"), (2, self.labels, self.names, "label")):
            for number in np.unique(values):
                name = first = names.get(int(number), "%s %d" % (kind, number))
                while name in numbers:  # programs find sets by their names
                    name = "%s %d" % (first, int(name[len(first):] or 1) + 1)
                numbers[name] = (int(number), dimension)
                found = np.flatnonzero(values == number)
                members[name] = [found, none] if dimension == 3 else [none, found]
        return numbers, members

    def ten_nodes(self) -> TenNodes:
        """The mesh with a node in the middle of every edge, as ``write(order=2)`` has it."""
        ends = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
        of_tetrahedra = [np.sort(self.tetrahedra[:, pair], axis=1) for pair in ends]
        of_boundary = [np.sort(self.boundary[:, pair], axis=1) for pair in ends[:3]]
        edges, place = np.unique(np.concatenate(of_tetrahedra + of_boundary), axis=0, return_inverse=True)
        place = place.reshape(-1).astype(np.int32) + np.int32(len(self.points))
        cut = len(ends) * len(self.tetrahedra)
        tetrahedra = np.hstack([self.tetrahedra, place[:cut].reshape(len(ends), -1).T])
        boundary = np.hstack([self.boundary, place[cut:].reshape(3, -1).T])
        middles = (self.points[edges[:, 0]] + self.points[edges[:, 1]]) / 2
        return TenNodes(np.vstack([self.points, middles]), tetrahedra, boundary)

    def volumes(self) -> Array:
        """The volume of each tetrahedron, in doubles."""
        a, b, c, d = (self.points[self.tetrahedra[:, k]] for k in range(4))
        volumes: Array = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        return volumes

    def write(self, path: "Union[str, os.PathLike[str]]", *, order: int = 1, ascii: bool = False, msh: str = "4.1") -> None:
        """Write a file, see `write`."""
        write(path, self, order=order, ascii=ascii, msh=msh)

    def to_meshio(self, *, order: int = 1) -> Any:
        """A `meshio.Mesh` of the tetrahedra and the boundary.

        Cell data ``label``, ``region`` and ``inside``; a cell set for each region and label, by its name, and its number in the
        field data. With ``order=2`` the elements have ten and six nodes.
        """
        import meshio

        points, tetrahedra, boundary = self.ten_nodes() if order == 2 else (self.points, self.tetrahedra, self.boundary)
        numbers, members = self._sets()
        kinds = ("tetra10", "triangle6") if order == 2 else ("tetra", "triangle")
        return meshio.Mesh(points, [(kinds[0], tetrahedra.astype(np.int64)), (kinds[1], boundary.astype(np.int64))],
                           cell_data={"label": [np.zeros(len(tetrahedra), np.int32), self.labels],
                                      "region": [self._regions(), np.zeros(len(boundary), np.int32)],
                                      "inside": [self.inside.astype(np.int8), np.full(len(self.labels), -1, np.int8)]},
                           cell_sets=members, field_data={name: np.array(number) for name, number in numbers.items()})

    def to_pyvista(self) -> Any:
        """A `pyvista.UnstructuredGrid` of the tetrahedra, then the boundary, with cell data ``region`` (0 on triangles) and ``label`` (0 on
        tetrahedra); names are field data: number and dimension."""
        import pyvista

        grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: self.tetrahedra, pyvista.CellType.TRIANGLE: self.boundary}, self.points)
        grid.cell_data["region"] = np.concatenate([self._regions(), np.zeros(len(self.labels), np.int32)])
        grid.cell_data["label"] = np.concatenate([np.zeros(len(self.tetrahedra), np.int32), self.labels])
        for name, number in self._sets()[0].items():
            grid.field_data[name] = np.array(number)
        return grid


@dataclasses.dataclass(eq=False, repr=False)
class PlaneMesh:
    """A mesh of triangles in the plane; `edges` tile the segments, with their `markers` and the numbers of the `segments`."""
    points: Array
    triangles: Array
    inside: Array
    edges: Array
    markers: Array
    segments: Array
    stats: Dict[str, Any] = dataclasses.field(default_factory=dict)
    warnings: List[str] = dataclasses.field(default_factory=list)

    def __repr__(self) -> str:
        return _line("PlaneMesh", (len(self.points), "points"), (len(self.triangles), "triangles"), (len(self.edges), "edges"))


@dataclasses.dataclass(eq=False)
class _Found:
    valid: bool
    message: str
    counts: Dict[str, int]
    places: Dict[str, Array]
    hints: List[str]
    warnings: List[str]


@dataclasses.dataclass(eq=False)
class PlaneReport(_Found):
    """What `check_plane` found.

    Attributes
    ----------
    valid, message, hints, warnings
        As of `Report`.
    counts : dict of str to int
        By kind: "equal vertices", "segment without length", "overlap", "crossing".
    places : dict of str to (n, 2) int32
        All of each kind, up to a million: two points ("equal vertices"), or two segments, or one twice.
    area : float
        Of the inside; 0 if it is not valid.
    """
    area: float


@dataclasses.dataclass(eq=False)
class RepairedPlane:
    """A mended planar graph; `done` says what was done to it, a line each. `markers` is empty if none were given."""
    points: Array
    segments: Array
    markers: Array
    done: List[str]


@dataclasses.dataclass(eq=False)
class Report(_Found):
    """What `check` found.

    Attributes
    ----------
    valid : bool
    message : str
        The first defect; empty if there is none.
    counts : dict of str to int
        Defects by kind: "open edge", "self-intersection", ...
    defects : list of Defect
        Described: at most ten of each kind.
    hints : list of str
        What to do about the defects, as far as that is known.
    places : dict of str to (n, 2) int32
        All of each kind, up to a million: the two ends of an edge ("open edge", "non-manifold edge", "inconsistent orientation"), two
        triangles ("self-intersection", "duplicate triangle"), a vertex twice ("non-manifold vertex", "non-finite coordinate") or a
        triangle twice ("degenerate triangle", "vertex index out of range").
    components, facets, acute_vertices, acute_edges : int
    volume, bbox_diagonal, smallest_local_feature_size : float
        Only of a valid surface, but for the diagonal.
    flipped : bool
        The surface was inside out, which is not a defect.
    """
    defects: List[Defect]
    flipped: bool
    components: int
    facets: int
    acute_vertices: int
    acute_edges: int
    volume: float
    bbox_diagonal: float
    smallest_local_feature_size: float


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


def _read_first(points: Any, triangles: Any) -> Any:
    """A surface of a file, if that was named."""
    return read(points) if triangles is None and isinstance(points, (str, os.PathLike)) else points


def _signed(value: Any) -> Any:
    """Numbers of things, of which differences do not wrap around."""
    if not isinstance(value, np.ndarray) or value.dtype != np.uint32:
        return value
    return value.view(np.int32) if value.size == 0 or value.max() < 1 << 31 else value.astype(np.int64)


#: Values of options that are words.
_WORDS = sorted({word for options in _core.options.values() for _, kind, *_ in options for word in re.findall(r"'(\w+)'", kind)})


def _in_python(text: str) -> str:
    """What messages say of the command line, as it is called here."""
    def argument(match: "re.Match[str]") -> str:
        name, value = match[1].replace("-", "_"), match[2]
        return name if value is None else "%s=%s" % (name, repr(value) if value in _WORDS else value)

    def call(match: "re.Match[str]") -> str:
        arguments = [argument(found) for found in re.finditer(r"--([a-z-]+)(?: ([^ -][^ ]*))?", match[2])]
        return "`tetproof.%s(%s)`" % (match[1], ", ".join(a if "=" in a else a + "=True" for a in arguments))

    text = re.sub(r"`delmesher ([a-z]+)([^`]*)`", call, text)
    outside = re.split(r"(`[^`]*`)", text)  # commands of the harness stay
    given = r"--([a-z][a-z-]*)(?: (%s|[0-9](?:[0-9.e+-]*[0-9])?)\b)?" % "|".join(_WORDS)
    return "".join(part if part.startswith("`") else re.sub(given, argument, part) for part in outside)


def _of_planes(text: str) -> str:
    return _in_python(text).replace("tetproof.repair(", "tetproof.repair_plane(")


def _surface(points: Any, triangles: Any, labels: Any) -> Tuple[Array, Array, Optional[Array]]:
    """Arrays, or an object that has them: of tetproof, trimesh (vertices, faces), meshio (points, cells_dict) or pyvista."""
    if triangles is None:
        given = points
        if hasattr(given, "vertices") and hasattr(given, "faces"):
            points, triangles = given.vertices, given.faces
        elif hasattr(given, "cells_dict") and "triangle" in given.cells_dict:
            points, triangles = given.points, given.cells_dict["triangle"]
        elif hasattr(given, "points") and hasattr(given, "triangles"):
            points, triangles = given.points, given.triangles
            labels = labels if labels is not None else getattr(given, "labels", None)
        elif hasattr(given, "faces") and hasattr(given, "points"):
            points, triangles = given.points, np.reshape(given.faces, (-1, 4))[:, 1:]
        else:
            raise TypeError("points and triangles are expected, or an object that has them, not %s; `read` makes one of a file"
                            % type(given).__name__)
    return _points(points), _indices(triangles, "triangles"), _labels(labels)


_Function = TypeVar("_Function", bound=Callable[..., Any])


def _with_options(function: _Function) -> _Function:
    """Puts the options of a job, of the function's name, into its signature and docstring."""
    signature, lines = inspect.signature(function), []
    parameters = [p for p in signature.parameters.values() if p.kind != p.VAR_KEYWORD]
    for name, kind, default, unit, text in _core.options[function.__name__]:
        parameters.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default))
        lines.append("    %s : %s, %s" % (name, kind, "optional" if default is None else "default %r" % default))
        text = _in_python(text)
        lines.append("        %s%s." % (text[0].upper() + text[1:], unit and ", " + unit))
    function.__signature__ = signature.replace(parameters=parameters)  # type: ignore
    if function.__doc__:  # not there with -OO
        function.__doc__ = function.__doc__.replace("    **options\n", "\n".join(lines) + "\n")
    return function


def _value(value: Any) -> Union[str, float]:
    """Names of regions, and lengths in some, as one text."""
    if isinstance(value, Mapping):
        return ",".join(str(x) if name is None else "%s=%r" % (name, float(x)) for name, x in value.items())
    if isinstance(value, (list, tuple)):
        return ",".join(value)
    return value if isinstance(value, str) else float(value)


def _options(job: str, given: Mapping[str, Any]) -> Dict[str, Any]:
    options = {name: value for name, value in given.items() if value is not None}
    names = [name for name, *_ in _core.options[job]]
    unknown = sorted(set(options) - set(names))
    if unknown:
        near = difflib.get_close_matches(unknown[0], names, 1)
        hint = ": did you mean %s?" % near[0] if near else " (there are %s)" % ", ".join(names)
        raise TypeError("no such option: %s%s" % (", ".join(unknown), hint))
    if "size_growth" in options and "size_field" not in options:
        raise ValueError("size_growth: of no effect without size_field")
    named: Dict[str, Any] = {name: _value(value) for name, value in options.items() if name != "size_field"}
    if "size_field" in options:
        named["size_field"] = np.ascontiguousarray(options["size_field"], dtype=np.float64)
    return named


def _raise(result: Dict[str, Any], report: Callable[[], Optional[Report]] = lambda: None) -> None:
    status, message = result["status"], _in_python(result["message"])
    if status == "ok":
        return
    if status == "invalid_options":
        raise ValueError(message)
    if status == "invalid_surface":
        raise InvalidSurface(message, report())
    if status == "invalid_mesh":
        raise InvalidMesh(message)
    if status == "limit_reached":
        raise LimitReached(message, result["limit"])
    if status == "interrupted":
        raise Interrupted(message)
    raise Error(message)


def _raise_plane(result: Dict[str, Any]) -> None:
    _raise({**result, "message": _of_planes(result["message"])})


def _mesh(result: Dict[str, Any], names: Optional[Mapping[int, str]] = None) -> Mesh:
    fields = {f.name: _signed(result[f.name]) for f in dataclasses.fields(Mesh) if f.name in result}
    fields["warnings"] = [_in_python(line) for line in fields["warnings"]]
    fields["inside"] = fields["inside"].view(np.bool_)
    fields["names"] = dict(names if names is not None else result.get("names", {}))
    of_regions = {region: fields["names"].get(label) for region, label in result.get("region_labels", {}).items()}
    if of_regions:
        fields["region_names"] = {region: name for region, name in of_regions.items() if name is not None}
    return Mesh(**fields)


class _Bar:
    """A progress bar, of tqdm if it is there, else a line; anew for every phase, so that the time left is that of the phase."""

    def __init__(self) -> None:
        self.phase, self.width = "", 0
        self.bar: Any = None
        self.stream = sys.stdout if "ipykernel" in sys.modules else sys.stderr  # notebooks show stderr in red
        try:
            from tqdm.auto import tqdm  # type: ignore

            # In a notebook without widgets this is what fails.
            self.bar = tqdm(total=1, bar_format="{desc:<10}{percentage:3.0f}%|{bar}| [{elapsed}<{remaining}{postfix}]")
        except ImportError:
            pass

    def show(self, phase: str, done: float, vertices: int) -> None:
        if self.bar is None:
            text = phase if done < 0 else "%-9s %3d %%" % (phase, 100 * done)
            text += ", %d points" % vertices if vertices else ""
            print("\r" + text.ljust(self.width), end="", file=self.stream, flush=True)
            self.width = len(text)
            return
        if phase != self.phase:
            self.phase = phase
            self.bar.reset(total=1)
            self.bar.set_description_str(phase, refresh=False)
        self.bar.n = min(max(done, 0), 1)
        self.bar.set_postfix_str("%d points" % vertices if vertices else "", refresh=False)
        self.bar.refresh()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
        elif self.width:
            print(file=self.stream)


@contextlib.contextmanager
def _shown(progress: Any) -> Iterator[Any]:
    """What is to be called: the user's callable, or for True that of a bar."""
    if progress is not True:
        yield progress or None
        return
    bar = _Bar()
    try:
        yield bar.show
    finally:
        bar.close()


def _run(job: str, given: Tuple[Any, ...], progress: Any, options: Mapping[str, Any], **more: Any) -> Dict[str, Any]:
    named = {**_options(job, options), **more}
    with _shown(progress) as shown:
        result: Dict[str, Any] = getattr(_core, job)(*given, named, shown)
    return result


def _run_on_surface(job: str, points: Any, triangles: Any, labels: Any, progress: Any,
                    options: Mapping[str, Any]) -> Tuple[Dict[str, Any], Optional[Mapping[int, str]]]:
    """The result, and what the labels are called."""
    points = _read_first(points, triangles)
    arrays = _surface(points, triangles, labels)
    names = getattr(points, "names", None)
    more = {"label_names": dict(names or {})} if job == "mesh" else {}
    result = _run(job, arrays, progress, options, **more)
    _raise(result, lambda: check(*arrays[:2]))
    return result, names


@_with_options
def mesh(points: Any, triangles: Any = None, labels: Any = None, *, progress: Union[Progress, bool, None] = None, **options: Any) -> Mesh:
    """Mesh the inside of a closed surface.

    Parameters
    ----------
    points : (n, 3) array_like of float, or an object with points and triangles, or a path
        A `Surface`, or what trimesh, meshio or pyvista have, or the name of a file that `read` reads.
    triangles : (m, 3) array_like of int
        Counter-clockwise seen from outside; a surface that is inside out is turned round, with a warning.
    labels : (m,) array_like of int, optional
        Come back on the boundary. With ``regions="all"`` a region has the name of the smallest solid that the triangles of a label bound
        around it. Names of regions may be a list; of `max_edge` also ``{"copper": 0.2}``, with None for the rest.
    progress : callable or True, optional
        ``progress(phase, done, vertices)``, called several times a second; False ends the run with `Interrupted`, an
        exception ends it with that. True shows a bar.
    **options

    Rows of a `size_field` are ``x, y, z, size``: no edge is longer than ``size + size_growth * d`` at a distance ``d`` of any of these
    points. Of a function ``f``: ``numpy.column_stack([points, f(points)])``.

    Returns
    -------
    Mesh

    Raises
    ------
    InvalidSurface
        With the defects. `repair` mends some.
    LimitReached
        With the limit: "size", "time", "memory" or "precision".
    ValueError, TypeError
        An option or an array makes no sense.
    """
    return _mesh(*_run_on_surface("mesh", points, triangles, labels, progress, options))


@_with_options
def cdt(points: Any, triangles: Any = None, labels: Any = None, *, progress: Union[Progress, bool, None] = None, **options: Any) -> Mesh:
    """Constrained Delaunay tetrahedrization of the convex hull of a valid surface, without any promise of quality.

    Parameters
    ----------
    points, triangles, labels, progress
        As in `mesh`.
    **options
    """
    return _mesh(*_run_on_surface("cdt", points, triangles, labels, progress, options))


def _tetrahedra(given: Any) -> Mesh:
    """A mesh, or an object that has tetrahedra: of meshio (points, cells_dict) or pyvista."""
    if all(hasattr(given, name) for name in ("points", "tetrahedra", "boundary")):
        mesh: Mesh = given
        return mesh
    if hasattr(given, "cells_dict"):
        cells = given.cells_dict
        for kind in ("tetra", 10):  # meshio's name, and VTK's number, of which pyvista has a dict
            if kind in cells:
                none = np.zeros(0, np.int32)
                return Mesh(given.points, cells[kind], np.ones(len(cells[kind]), bool), np.zeros((0, 3), np.uint32), none, none)
    raise TypeError("a mesh of tetrahedra is expected; `read_mesh` makes one of a file")


@_with_options
def improve(mesh: Any, *, progress: Union[Progress, bool, None] = None, **options: Any) -> Mesh:
    """Fewer and better tetrahedra of any conforming mesh; its boundary and its regions are kept exactly.

    Parameters
    ----------
    mesh : Mesh, or an object with tetrahedra, or a path
        What meshio or pyvista have, of which the tetrahedra are taken; their hull is kept.
    progress
        As in `mesh`.
    **options

    Raises
    ------
    InvalidMesh
        The mesh is not conforming.
    """
    mesh = read_mesh(mesh) if isinstance(mesh, (str, os.PathLike)) else mesh
    result = _run("improve", (_fields(_tetrahedra(mesh)),), progress, options)
    _raise(result)
    better = _mesh(result, getattr(mesh, "names", None))
    better.region_names = dict(getattr(mesh, "region_names", {}))
    return better


@_with_options
def check(points: Any, triangles: Any = None, **options: Any) -> Report:
    """Is this a valid surface? If not, what is wrong, and where? Decided exactly.

    Parameters
    ----------
    points, triangles
        As in `mesh`.
    **options

    >>> tetproof.check([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).counts
    {'open edge': 3}
    """
    arrays = _surface(_read_first(points, triangles), triangles, None)
    result = _core.check(*arrays[:2], _options("check", options))
    if result["status"] not in ("ok", "invalid_surface"):
        _raise(result)
    fields = {f.name: result[f.name] for f in dataclasses.fields(Report) if f.name in result}
    fields["valid"] = result["status"] == "ok"
    fields["hints"] = [_in_python(hint) for hint in result["hints"]]
    fields["places"] = {kind: _signed(places) for kind, places in result["places"].items()}
    fields["defects"] = [Defect(kind, text, _signed(vertices), _signed(triangles)) for kind, text, vertices, triangles in result["defects"]]
    return Report(**fields)


def label_by_angle(points: Any, triangles: Any = None, *, degrees: float) -> Surface:
    """Label the faces of a surface without labels by its sharp edges, and call them face_1, face_2, ...

    A face grows over edges at which two triangles bend by less than `degrees`, decided exactly; faces are numbered by their smallest
    triangle. `Surface.faces` says what they are.

    Parameters
    ----------
    points, triangles
        As in `mesh`.
    degrees : float
        Above 0, at most 90.

    Raises
    ------
    ValueError
        There are several labels already, the angle is out of range, or a triangle or a point makes no sense.

    >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> surface = tetproof.label_by_angle(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], degrees=30)
    >>> [face.name for face in surface.faces()]
    ['face_1', 'face_2', 'face_3', 'face_4']
    """
    points = _read_first(points, triangles)
    arrays = _surface(points, triangles, None)
    labels = _core.label_by_angle(*arrays, float(degrees))
    return Surface(arrays[0], _signed(arrays[1]), labels, {label: "face_%d" % label for label in np.unique(labels).tolist()})


def repair(points: Any, triangles: Any = None, labels: Any = None, *, weld: float = 0, fill: bool = False) -> Repaired:
    """Mend what can be mended without guessing.

    Equal points are welded, triangles without area and duplicates are removed, and triangles are turned round so that neighbours
    agree. Whether the result is valid is for `check` to say.

    Parameters
    ----------
    weld : float
        Points no farther apart than this become one, too.
    fill : bool
        Fill holes that are planar within 1e-6 of the diagonal, or no wider than a twentieth of it.
    """
    if not 0 <= weld < np.inf:
        raise ValueError("weld must be at least 0, and finite")
    points = _read_first(points, triangles)
    result = _core.repair(*_surface(points, triangles, labels), float(weld), bool(fill))
    result["triangles"] = _signed(result["triangles"])
    return Repaired(**result, names=dict(getattr(points, "names", {})))


@_with_options
def remesh(points: Any, triangles: Any = None, labels: Any = None, *, progress: Union[Progress, bool, None] = None, **options: Any) -> Surface:
    """Another surface within a tolerance of a valid one, in both directions: few and round triangles, same topology and labels.

    Parameters
    ----------
    points, triangles, labels, progress
        As in `mesh`.
    **options

    Raises
    ------
    InvalidSurface, LimitReached
        As of `mesh`.
    """
    result, names = _run_on_surface("remesh", points, triangles, labels, progress, options)
    return Surface(result["points"], _signed(result["triangles"]), result["labels"], dict(names or {}),
                   [_in_python(line) for line in result["warnings"]])


@_with_options
def plane(points: Any, segments: Any, markers: Any = None, *, holes: Any = None, progress: Union[Progress, bool, None] = None,
          **options: Any) -> PlaneMesh:
    """Mesh a planar straight-line graph with triangles: what its segments enclose, but for the faces with a hole point.

    Parameters
    ----------
    points : (n, 2) array_like of float
    segments : (m, 2) array_like of int
    markers : (m,) array_like of int, optional
    holes : (h, 2) array_like of float, optional
    progress
        As in `mesh`.
    **options
    """
    no_holes = np.zeros((0, 2)) if holes is None else holes
    arrays = (_points(points), _indices(segments, "segments"), _labels(markers, "markers"), _points(no_holes))
    result = _run("plane", arrays, progress, options)
    _raise_plane(result)
    fields = {f.name: _signed(result[f.name]) for f in dataclasses.fields(PlaneMesh)}
    fields["inside"] = fields["inside"].view(np.bool_)
    return PlaneMesh(**fields)


def check_plane(points: Any, segments: Any) -> PlaneReport:
    """Can a planar straight-line graph be meshed? If not, what is wrong, and where? Decided exactly.

    Parameters
    ----------
    points, segments
        As in `plane`.

    >>> tetproof.check_plane([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]).counts
    {'crossing': 1}
    """
    result = _core.check_plane(_points(points), _indices(segments, "segments"))
    if result["status"] not in ("ok", "invalid_surface"):
        _raise_plane(result)
    places = {kind: _signed(found) for kind, found in result["places"].items()}
    return PlaneReport(result["status"] == "ok", _of_planes(result["message"]), {kind: len(found) for kind, found in places.items()}, places,
                       [_of_planes(hint) for hint in result["hints"]], result["warnings"], result["area"])


def repair_plane(points: Any, segments: Any, markers: Any = None, *, weld: float = 0) -> RepairedPlane:
    """Mend a planar graph: merge points, drop segments without length and repeated ones, cut segments where they cross or overlap.

    A crossing becomes a point, rounded to doubles; nothing else moves, unless it is merged.

    Parameters
    ----------
    points, segments, markers
        As in `plane`.
    weld : float
        Points no farther apart than this become one, the first of them. Equal ones do in any case.

    >>> tetproof.repair_plane([[0, 0], [2, 2], [2, 0], [0, 2]], [[0, 1], [2, 3]]).points[-1].tolist()
    [1.0, 1.0]
    """
    result = _core.repair_plane(_points(points), _indices(segments, "segments"), _labels(markers, "markers"), float(weld))
    _raise_plane(result)
    return RepairedPlane(result["points"], _signed(result["segments"]), result["markers"], result["done"])


def read(path: "Union[str, os.PathLike[str]]") -> Surface:
    """Read a surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly, compressed with gzip or not.

    ValueError says what is wrong with the file, and in which line; FileNotFoundError that there is none.
    """
    _need_file(path)
    result = _core.read_surface(os.fspath(path))
    result["triangles"] = _signed(result["triangles"])
    if not len(result["labels"]):
        result["labels"] = np.zeros(len(result["triangles"]), np.int32)
    return Surface(**result)


def read_mesh(path: "Union[str, os.PathLike[str]]") -> Mesh:
    """Read a mesh of tetrahedra: .mesh, .msh, .vtu, .node, .ele or .tet, compressed with gzip or not.

    Of elements of second order the corners are read; `warnings` of the mesh say how far off the middle of their edges the other nodes are.
    """
    _need_file(path)
    return _mesh(_core.read_mesh(os.fspath(path)))


def _need_file(path: "Union[str, os.PathLike[str]]") -> None:
    if os.fspath(path) != "-" and not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))


def _fields(mesh: Mesh) -> Dict[str, Array]:
    count, triangles = len(mesh.tetrahedra), len(mesh.boundary)
    return {"points": _points(mesh.points), "tetrahedra": _indices(mesh.tetrahedra, "tetrahedra"),
            "inside": np.ascontiguousarray(np.broadcast_to(mesh.inside, (count,)), np.uint8),
            "regions": np.ascontiguousarray(mesh.regions, np.int32),
            "boundary": np.reshape(_indices(mesh.boundary, "boundary"), (triangles, 3)),
            "labels": np.ascontiguousarray(mesh.labels, np.int32), "facets": _indices(mesh.facets, "facets"),
            "planar_within": float(getattr(mesh, "planar_within", 0))}


def _called(names: Mapping[int, str]) -> Dict[int, str]:
    try:
        called = {int(number): name for number, name in names.items()}
    except (AttributeError, TypeError, ValueError):
        called = {0: None}  # type: ignore
    if not all(isinstance(name, str) for name in called.values()):
        raise TypeError("names must be a dict from whole numbers to strings")
    return called


def write(path: "Union[str, os.PathLike[str]]", mesh: Union[Mesh, Surface], names: Optional[Mapping[int, str]] = None, *,
          order: int = 1, ascii: bool = False, msh: str = "4.1") -> None:
    """Write a mesh, or a surface, in the format of the extension; labels are called by `names` (of the mesh).

    .mesh, .msh, .vtu, .vtk, .xdmf, .inp, .bdf, .node, .tet; .stl, .ply and .off hold the boundary alone. ValueError says why a file
    could not be written; it is complete or not there. With ``order=2`` the elements have a node in the middle of every edge, too
    (.mesh, .msh, .vtu, .vtk, .inp, .bdf). .msh and .vtu hold bytes, with ``ascii=True`` text.
    ``msh="2.2"`` is the older version of .msh, which MFEM and GetDP read. Python warns of what the format cannot hold.
    """
    if msh not in ("4.1", "2.2"):
        raise ValueError("msh must be '4.1' or '2.2'")
    called = _called(getattr(mesh, "names", {}) if names is None else names)
    if not os.path.isdir(os.path.dirname(os.path.abspath(path))):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.path.dirname(os.fspath(path)))
    if hasattr(mesh, "tetrahedra"):
        lost = _core.write_mesh(os.fspath(path), _fields(mesh), called, _called(mesh.region_names), order, ascii, msh == "2.2")
    elif hasattr(mesh, "triangles"):
        lost = _core.write_surface(os.fspath(path), *_surface(mesh, None, None), called)
    else:
        raise TypeError("a mesh or a surface is expected, not %s" % type(mesh).__name__)
    for line in lost:
        warnings.warn(_in_python(line), stacklevel=2)

"""Meshes, of tetrahedra and of triangles in the plane."""
import dataclasses
import os
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ._surfaces import _NO_TETRAHEDRA, _TETRAHEDRA, Array, _html, _indices, _kind_of_cells, _line, _points


class TenNodes(NamedTuple):
    """Elements of second order: `points`, the mesh's own first; (t, 10) `tetrahedra` and (b, 6) `boundary`, corners first, then nodes
    in the middle of the edges 01 12 02, of tetrahedra also 03 13 23 (the order of VTK, meshio, Abaqus and Nastran)."""
    points: Array
    tetrahedra: Array
    boundary: Array


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

    def _repr_html_(self) -> str:
        rows: List[Tuple[str, Any]] = [("points", len(self.points)), ("tetrahedra", len(self.tetrahedra)), ("boundary triangles", len(self.boundary))]
        rows += [("region %d" % number, name) for number, name in sorted(self.region_names.items())][:20]
        rows += [("label %d" % number, name) for number, name in sorted(self.names.items())][:20]
        final = self.stats.get("final", {})
        rows += [(name, "%.4g%s" % (final[key], unit)) for key, name, unit in (
            ("min_dihedral", "smallest dihedral angle", "\u00b0"), ("max_dihedral", "largest dihedral angle", "\u00b0"),
            ("min_gamma", "smallest gamma", ""), ("mean_gamma", "mean gamma", "")) if key in final]
        return _html("Mesh", rows + [("warning", line) for line in self.warnings])

    def smallest_dihedrals(self) -> Array:
        """(t,) float64: the smallest dihedral angle of each tetrahedron, in degrees, in doubles."""
        corners = self.points[self.tetrahedra]
        normals = [np.cross(corners[:, b] - corners[:, a], corners[:, c] - corners[:, a])  # outwards
                   for a, b, c in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))]
        with np.errstate(invalid="ignore", divide="ignore"):  # flat ones have an angle of 0 somewhere, or none at all
            normals = [normal / np.linalg.norm(normal, axis=1)[:, None] for normal in normals]
        cosines = [-np.einsum("ij,ij->i", normals[i], normals[j]) for i in range(4) for j in range(i)]
        angles: Array = np.degrees(np.arccos(np.clip(np.max(cosines, axis=0), -1, 1)))
        return np.nan_to_num(angles)

    def plot(self, *, cut: "Optional[Sequence[float]]" = (1, 0, 0), show: bool = True) -> Any:
        """Show the inside, cut open, each tetrahedron coloured by its smallest dihedral angle, by pyvista.

        Parameters
        ----------
        cut : (3,) float, optional
            The normal of a plane through the middle: tetrahedra whose centroids are in front of it are left out. None: all are there.
        show : bool
            Open the window, or the picture in a notebook.

        Returns
        -------
        pyvista.Plotter

        Raises
        ------
        ImportError
            There is no pyvista.
        """
        import pyvista

        kept = np.array(self.inside, bool)
        if cut is not None:
            normal = np.asarray(cut, np.float64)
            if normal.shape != (3,) or not np.isfinite(normal).all() or not normal.any():
                raise ValueError("cut must be three numbers that are not all 0")
            middle = (self.points.min(axis=0) + self.points.max(axis=0)) / 2
            kept &= (self.points[self.tetrahedra].mean(axis=1) - middle) @ normal <= 0
        grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: self.tetrahedra[kept]}, self.points)
        grid.cell_data["smallest dihedral angle, degrees"] = self.smallest_dihedrals()[kept]
        plotter = pyvista.Plotter()
        plotter.add_mesh(grid, scalars="smallest dihedral angle, degrees", clim=[0, 60], cmap="viridis", show_edges=True)
        if show:
            plotter.show()
        return plotter

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
        """The mesh of one region, by its name or number, with the boundary triangles at it. KeyError if there is none."""
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
        """The volume of each tetrahedron, (n,), in the cube of the points' unit and rounded to doubles; negative if it is inverted."""
        a, b, c, d = (self.points[self.tetrahedra[:, k]] for k in range(4))
        volumes: Array = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        return volumes

    def write(self, path: "Union[str, os.PathLike[str]]", *, order: int = 1, ascii: bool = False, msh: str = "4.1") -> None:
        """Write a file, see `write`."""
        from ._jobs import write  # which takes these classes

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


def _tetrahedra(given: Any) -> Mesh:
    """A mesh, or an object that has tetrahedra: of meshio (points, cells_dict) or pyvista."""
    if all(hasattr(given, name) for name in ("points", "tetrahedra", "boundary")):
        mesh: Mesh = given
        return mesh
    kind = _kind_of_cells(given, _TETRAHEDRA, _NO_TETRAHEDRA)
    if kind is not None:
        cells = given.cells_dict
        none = np.zeros(0, np.int32)
        return Mesh(given.points, cells[kind], np.ones(len(cells[kind]), bool), np.zeros((0, 3), np.uint32), none, none)
    raise TypeError("a mesh of tetrahedra is expected; `read_mesh` makes one of a file")


def _fields(mesh: Mesh) -> Dict[str, Any]:
    count, triangles = len(mesh.tetrahedra), len(mesh.boundary)
    return {"points": _points(mesh.points), "tetrahedra": _indices(mesh.tetrahedra, "tetrahedra"),
            "inside": np.ascontiguousarray(np.broadcast_to(mesh.inside, (count,)), np.uint8),
            "regions": np.ascontiguousarray(mesh.regions, np.int32),
            "boundary": np.reshape(_indices(mesh.boundary, "boundary"), (triangles, 3)),
            "labels": np.ascontiguousarray(mesh.labels, np.int32), "facets": _indices(mesh.facets, "facets"),
            "planar_within": float(getattr(mesh, "planar_within", 0))}

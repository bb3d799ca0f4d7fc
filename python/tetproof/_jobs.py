"""The jobs, each a call of the library, and files."""
import dataclasses
import errno
import os
import warnings
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _core
from ._meshes import Mesh, PlaneMesh, _fields, _tetrahedra
from ._runs import PlaneReport, Progress, Report, _in_python, _of_planes, _options, _raise, _raise_plane, _run, _with_options
from ._surfaces import Array, Defect, RegionPoint, Repaired, Surface, _indices, _labels, _points, _signed, _surface


def _read_first(points: Any, triangles: Any) -> Any:
    """A surface of a file, if that was named."""
    return read(points) if triangles is None and isinstance(points, (str, os.PathLike)) else points


def _mesh(result: Dict[str, Any], names: Optional[Mapping[int, str]] = None) -> Mesh:
    fields = {f.name: _signed(result[f.name]) for f in dataclasses.fields(Mesh) if f.name in result}
    fields["warnings"] = [_in_python(line) for line in fields["warnings"]]
    fields["inside"] = fields["inside"].view(np.bool_)
    fields["names"] = {**(names if names is not None else result.get("names", {})), **result.get("wall_names", {})}
    of_regions = {region: fields["names"].get(label) for region, label in result.get("region_labels", {}).items()}
    of_regions.update(result.get("region_names", {}))
    fields["region_names"] = {region: name for region, name in of_regions.items() if name is not None}
    return Mesh(**fields)


def _region_point(given: Any) -> Tuple[Any, str, float, bool]:
    point = RegionPoint(*given)
    return tuple(map(float, point.point)), point.name, float(point.max_edge), bool(point.is_hole)


def _run_on_surface(job: str, points: Any, triangles: Any, labels: Any, progress: Any, options: Mapping[str, Any],
                    region_points: Any = None) -> Tuple[Dict[str, Any], Optional[Mapping[int, str]]]:
    """The result, and what the labels are called."""
    points = _read_first(points, triangles)
    arrays = _surface(points, triangles, labels)
    names = getattr(points, "names", None)
    region_points = getattr(points, "region_points", ()) if region_points is None else region_points
    more: Dict[str, Any] = {"label_names": dict(names or {}), "region_points": list(map(_region_point, region_points))} if job == "mesh" else {}
    result = _run(job, arrays, progress, options, **more)
    _raise(result, lambda: check(*arrays[:2]))
    return result, names


@_with_options
def mesh(points: Any, triangles: Any = None, labels: Any = None, *, region_points: Any = None, progress: Union[Progress, bool, None] = None,
         **options: Any) -> Mesh:
    """Mesh the inside of a closed surface.

    Parameters
    ----------
    points : (n, 3) array_like of float, or an object with points and triangles, or a path
        A `Surface`, or what trimesh, meshio or pyvista have, or the name of a file that `read` reads. Points that no triangle has
        become points of the mesh, as electrodes, unless they lie outside or on a triangle.
    triangles : (m, 3) array_like of int
        Counter-clockwise seen from outside; a surface that is inside out is turned round, with a warning.
    labels : (m,) array_like of int, optional
        Come back on the boundary. With ``regions="all"`` a region has the name of the smallest solid that the triangles of a label bound
        around it. Names of regions and walls may be a list; of `max_edge` also ``{"copper": 0.2}``, with None for the rest.
    region_points : list of RegionPoint, optional
        With `regions`: names, longest edges and holes of the regions around points. Else those of the surface.
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
        With the limit: "size", "budget", "time", "memory" or "precision".
    ValueError, TypeError
        An option or an array makes no sense.
    """
    return _mesh(*_run_on_surface("mesh", points, triangles, labels, progress, options, region_points))


@_with_options
def cdt(points: Any, triangles: Any = None, labels: Any = None, *, progress: Union[Progress, bool, None] = None, **options: Any) -> Mesh:
    """Constrained Delaunay tetrahedrization of the convex hull of a valid surface, without any promise of quality.

    Parameters
    ----------
    points, triangles, labels, progress
        As in `mesh`.
    **options

    Raises
    ------
    InvalidSurface, LimitReached, ValueError, TypeError
        As `mesh` does.
    """
    return _mesh(*_run_on_surface("cdt", points, triangles, labels, progress, options))


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

    Raises
    ------
    ValueError, TypeError
        An option or an array makes no sense, or a file is none of a surface. What is wrong with the surface is no error.

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
    points, triangles, labels
        As in `mesh`.
    weld : float
        Points no farther apart than this become one, too.
    fill : bool
        Fill holes that are planar within 1e-6 of the diagonal, or no wider than a twentieth of it.

    Raises
    ------
    ValueError, TypeError
        `weld` or an array makes no sense, or a file is none of a surface.
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

    Raises
    ------
    InvalidSurface
        Segments cross or overlap, or enclose nothing (`check_plane` says where).
    LimitReached, ValueError, TypeError
        As of `mesh`.
    """
    no_holes = np.zeros((0, 2)) if holes is None else holes
    arrays = (_points(points), _indices(segments, "segments"), _labels(markers, "markers"), _points(no_holes))
    result = _run("plane", arrays, progress, options)
    _raise_plane(result)
    fields = {f.name: _signed(result[f.name]) for f in dataclasses.fields(PlaneMesh)}
    fields["inside"] = fields["inside"].view(np.bool_)
    return PlaneMesh(**fields)


@dataclasses.dataclass(eq=False)
class RepairedPlane:
    """A mended planar graph; `done` says what was done to it, a line each. `markers` is empty if none were given."""
    points: Array
    segments: Array
    markers: Array
    done: List[str]


def check_plane(points: Any, segments: Any) -> PlaneReport:
    """Can a planar straight-line graph be meshed? If not, what is wrong, and where? Decided exactly.

    Parameters
    ----------
    points, segments
        As in `plane`.

    Raises
    ------
    ValueError, TypeError
        An array makes no sense.

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

    Raises
    ------
    ValueError, TypeError
        `weld` or an array makes no sense.

    >>> tetproof.repair_plane([[0, 0], [2, 2], [2, 0], [0, 2]], [[0, 1], [2, 3]]).points[-1].tolist()
    [1.0, 1.0]
    """
    result = _core.repair_plane(_points(points), _indices(segments, "segments"), _labels(markers, "markers"), float(weld))
    _raise_plane(result)
    return RepairedPlane(result["points"], _signed(result["segments"]), result["markers"], result["done"])


def _need_file(path: "Union[str, os.PathLike[str]]") -> None:
    if os.fspath(path) != "-" and not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))


def read(path: "Union[str, os.PathLike[str]]") -> Surface:
    """Read a surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly, compressed with gzip or not.

    ValueError says what is wrong with the file, and in which line; FileNotFoundError that there is none.
    """
    _need_file(path)
    result = _core.read_surface(os.fspath(path))
    result["triangles"] = _signed(result["triangles"])
    if not len(result["labels"]):
        result["labels"] = np.zeros(len(result["triangles"]), np.int32)
    result["region_points"] = [RegionPoint(*point) for point in result["region_points"]]
    return Surface(**result)


def read_mesh(path: "Union[str, os.PathLike[str]]") -> Mesh:
    """Read a mesh of tetrahedra: .mesh, .msh, .vtu, .node, .ele or .tet, compressed with gzip or not.

    Of elements of second order the corners are read; `warnings` of the mesh say how far off the middle of their edges the other nodes are.
    ValueError says what is wrong with the file; FileNotFoundError that there is none.
    """
    _need_file(path)
    return _mesh(_core.read_mesh(os.fspath(path)))


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
        solid: Any = mesh
        lost = _core.write_mesh(os.fspath(path), _fields(solid), called, _called(solid.region_names), order, ascii, msh == "2.2")
    elif hasattr(mesh, "triangles"):
        lost = _core.write_surface(os.fspath(path), *_surface(mesh, None, None), called)
    else:
        raise TypeError("a mesh or a surface is expected, not %s" % type(mesh).__name__)
    for line in lost:
        warnings.warn(_in_python(line), stacklevel=2)

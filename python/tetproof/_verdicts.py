"""Verdicts on meshes from anywhere, by oracles that share no code with the mesher."""
import dataclasses
import json
import math
import os
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from . import _oracles
from ._jobs import check, read, read_mesh
from ._meshes import Mesh
from ._runs import InvalidSurface
from ._surfaces import _NO_TETRAHEDRA, _NO_TRIANGLES, _TETRAHEDRA, _TRIANGLES, Array, _html, _indices, _kind_of_cells, _labels, _points, _surface


@dataclasses.dataclass(eq=False, repr=False)
class Verdict:
    """What the oracles found; true if the mesh passed.

    Attributes
    ----------
    verdict : str
        "exact", "rounded" (as far as doubles are from it), "deviating", "undecided" or "broken".
    passed : bool
        Decided, not broken, and it deviates by no more than was declared or promised.
    reasons : list of str
        Why it did not pass: for each oracle the first five violations.
    places : dict of str to dict of str to array
        All places of violations, up to a million, by oracle and by what is there: "vertices", "tetrahedra", "listed triangles" (rows of
        `boundary`), "input vertices", "input triangles": (k,) int64; "edges", "input edges": (k, 2); "faces": (k, 3) vertices;
        "points": (k, 3) float64. Some violations are nowhere; of walls that are split none are given.
    unproven : list of str
        What was promised, or is taken for granted, and nobody could show.
    deviation, deviation_ulps, deviation_relative : float
        Of the surface: at most, in units of the input, in ulp of the largest coordinate there (0: unknown), as a fraction of the diagonal.
    inverted, flat : int
    oracles : list of dict
        Of each its name, status ("pass", "FAIL", "info", "undecided"), what it counted and measured; as ``tetproof verify --json``.
    hint : str
        What to ask instead, or empty.
    text : str
        The report of the command ``tetproof verify``.
    """
    verdict: str
    passed: bool
    reasons: List[str]
    places: Dict[str, Dict[str, Array]]
    unproven: List[str]
    deviation: float
    deviation_ulps: float
    deviation_relative: float
    inverted: int
    flat: int
    oracles: List[Dict[str, Any]]
    hint: str
    text: str

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        return "Verdict(%s, %d oracles%s)" % (self.verdict, len(self.oracles), "".join(": " + reason for reason in self.reasons[:1]))

    def _repr_html_(self) -> str:
        rows = [("passed" if self.passed else "not passed", "deviation %.3g, %.3g of the diagonal" % (self.deviation, self.deviation_relative))]
        rows += [("reason", reason) for reason in self.reasons] + [("not proven", line) for line in self.unproven]
        rows += [(oracle["name"], "%s, %d %s" % (oracle["status"], oracle["checked"], oracle["checked_what"])) for oracle in self.oracles]
        return _html("Verdict: " + self.verdict, rows + ([("hint", self.hint)] if self.hint else []))

    def __str__(self) -> str:
        return self.text + (self.hint + "\n" if self.hint else "")


def _check_arrays(what: str, points: Array, rows: Array, name: str) -> None:
    """What the oracles would call broken is a mistake of the caller, in arrays."""
    finite = np.isfinite(points).all(axis=tuple(range(1, points.ndim)))
    if not finite.all():
        raise ValueError("%s: point %d is not finite" % (what, np.argmin(finite)))
    beyond = (rows >= len(points)).any(axis=tuple(range(1, rows.ndim)))
    if beyond.any():
        row = int(np.argmax(beyond))
        raise ValueError("%s: row %d of %s names point %d, and there are %d" % (what, row, name, rows[row].max(), len(points)))


def _polyhedron(given: Any) -> Tuple[Array, Array, Optional[Array], Dict[int, str]]:
    if isinstance(given, (str, os.PathLike)):
        given = read(given)
    if isinstance(given, (tuple, list)) and len(given) in (2, 3):
        points, triangles, labels = _surface(given[0], given[1], given[2] if len(given) == 3 else None)
    else:
        points, triangles, labels = _surface(given, None, None)
    _check_arrays("surface", points, triangles, "triangles")
    if labels is not None and not labels.any():  # as `read` has it, of a file without
        labels = None
    return points, triangles, labels, dict(getattr(given, "names", None) or {})


def _cell_data(given: Any, name: str, kind: Any) -> Any:
    """The data of the cells of one kind, of meshio or pyvista; or None."""
    if hasattr(given, "cell_data_dict"):
        return given.cell_data_dict.get(name, {}).get(kind)
    data = getattr(given, "cell_data", {})
    return np.asarray(data[name])[np.asarray(given.celltypes) == kind] if name in data else None


def _judged(given: Any) -> Dict[str, Any]:
    """A mesh as the oracles take it, with what its owner says of it."""
    if isinstance(given, (str, os.PathLike)):
        given = read_mesh(given)
    mesh: Dict[str, Any] = dict.fromkeys(("boundary", "regions", "inside", "labels", "facets"))
    mesh.update(planar_within=0.0, either_orientation=False, names={}, region_names={})
    if isinstance(given, Mesh):
        points, tetrahedra = given.points, given.tetrahedra
        mesh.update(boundary=given.boundary, regions=given._regions(), inside=np.ascontiguousarray(given.inside, np.uint8), labels=given.labels,
                    facets=given.facets, planar_within=float(given.planar_within), names=given.names, region_names=given.region_names)
    elif hasattr(given, "cells_dict"):
        cells, kind = given.cells_dict, _kind_of_cells(given, _TETRAHEDRA, _NO_TETRAHEDRA)
        if kind is None:
            raise TypeError("the mesh has no tetrahedra")
        points, tetrahedra = given.points, cells[kind]
        inside = _cell_data(given, "inside", kind)
        mesh.update(regions=_labels(_cell_data(given, "region", kind), "regions"),
                    inside=None if inside is None else np.not_equal(inside, 0).astype(np.uint8))
        triangle = _kind_of_cells(given, _TRIANGLES, _NO_TRIANGLES)
        if triangle is not None:
            mesh.update(boundary=cells[triangle], labels=_cell_data(given, "label", triangle))
    elif hasattr(given, "elem") and hasattr(given, "node"):  # a tetgen.TetGen
        points, tetrahedra = given.node, given.elem
        mesh.update(either_orientation=True)
    elif isinstance(given, (tuple, list)) and len(given) >= 2:
        points, tetrahedra = given[:2]
        mesh.update(either_orientation=True)
    else:
        raise TypeError("a mesh of tetrahedra is expected: of tetproof, meshio or pyvista, or (points, tetrahedra), not %s" % type(given).__name__)
    mesh.update(points=_points(points), tetrahedra=_indices(tetrahedra, "tetrahedra"))
    _check_arrays("mesh", mesh["points"], mesh["tetrahedra"], "tetrahedra")
    if mesh["boundary"] is not None:
        mesh["boundary"] = np.reshape(_indices(mesh["boundary"], "boundary"), (-1, 3))
        _check_arrays("mesh", mesh["points"], mesh["boundary"], "boundary")
    mesh["labels"] = _labels(mesh["labels"])
    mesh["facets"] = None if mesh["facets"] is None else _indices(mesh["facets"], "facets")
    return mesh


def verify(surface: Any, mesh: Any, *, promised: str = "mesh", envelope: Optional[float] = None, declared_deviation: float = 0,
           threads: int = 1) -> Verdict:
    """Is this a mesh of the inside of the surface? Decided exactly, whoever made the mesh.

    The oracles are those of the command ``tetproof verify``, without its second opinions by CGAL and OpenMesh, whose licence does not let
    them into a package under MIT: above all nobody asks whether the surface intersects itself. They share no code with the mesher; but
    files are read by its readers, where the command has its own.

    Parameters
    ----------
    surface : Surface, or an object with points and triangles, or a path, or (points, triangles) or (points, triangles, labels)
        As in `mesh`.
    mesh : Mesh, or an object with tetrahedra (of meshio, pyvista, tetgen), or a path, or (points, tetrahedra)
        Of meshio and pyvista the tetrahedra, with cell data ``region`` and ``inside``, and the triangles, with ``label``, as the
        mesh's list of its boundary. A pair of arrays, as of tetgen or pytetwild: (n, 3) float and (t, 4) int; all its tetrahedra
        may be turned the other way.
    promised : str
        What the mesher was asked for, as the command has it: "mesh OPTIONS" or "cdt OPTIONS".
    envelope : float, optional
        The mesh has a surface of its own, at most this fraction of the diagonal from the input, from 1e-7 to 1.
    declared_deviation : float
        The deviation that is not a failure, as a fraction of the diagonal.
    threads : int
        0: one per core. The verdict is the same for any number.

    Raises
    ------
    InvalidSurface
        The surface bounds no solid.
    ValueError, TypeError
        A number, an array or a promise makes no sense.

    >>> points, triangles = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    >>> tetproof.verify((points, triangles), (points, [[0, 1, 2, 3]])).verdict
    'exact'
    """
    if envelope is not None and not _oracles.least_envelope <= envelope <= 1:
        raise ValueError("envelope must be a fraction of the diagonal, from 1e-7 to 1")
    if not (declared_deviation >= 0 and math.isfinite(declared_deviation)):
        raise ValueError("declared_deviation must be at least 0, and finite")
    if not 0 <= threads <= 1024:
        raise ValueError("threads must be from 0 to 1024")
    points, triangles, labels, names = _polyhedron(surface)
    result = _oracles.verify(points, triangles, labels, names, _judged(mesh), promised, envelope or 0.0, float(declared_deviation), threads)
    if "invalid" in result:
        more = "; several regions need promised='mesh --regions all'" if result["invalid"].startswith("edge ") else ""
        raise InvalidSurface("the surface bounds no solid: " + result["invalid"] + more, check(points, triangles))
    found = json.loads(result["json"])
    passed = not result["failed"] and found["verdict"] != "undecided"
    hint = ""
    if "near" in result:
        hint = "the surface is another one, at most %.2g away: envelope=%r judges such a mesh" % result["near"]
    return Verdict(verdict=found["verdict"], passed=passed, reasons=[] if passed else _reasons(found), places=result["places"],
                   unproven=found.get("unproven", []), deviation=found["deviation"], deviation_ulps=found["deviation_ulps"],
                   deviation_relative=found["deviation_relative"], inverted=found["inverted"], flat=found["flat"], oracles=found["oracles"],
                   hint=hint, text=result["text"])


def _reasons(found: Dict[str, Any]) -> List[str]:
    reasons = []
    for oracle in found["oracles"]:
        if oracle["passed"]:
            continue
        said = oracle["notes"][-1:] if oracle["status"] == "undecided" else oracle["findings"] or ["nothing to check"]
        reasons += ["%s: %s" % (oracle["name"], line) for line in said]
        if oracle["violations"] > len(oracle["findings"]):
            reasons.append("%s: %d more" % (oracle["name"], oracle["violations"] - len(oracle["findings"])))
    return reasons or ["the surface deviates by %.3g of the diagonal, more than declared" % found["deviation_relative"]]


def measure(mesh: Any) -> Dict[str, Any]:
    """Counts, angles in degrees, shapes, volume (in the points' unit) and orientation of a mesh, as ``tetproof measure`` has them.

    Parameters
    ----------
    mesh
        As in `verify`.

    Returns
    -------
    dict
        Of all tetrahedra; with key "inside" the same of those inside, where the mesh tells. "inverted" and "flat" are exact.

    Raises
    ------
    ValueError, TypeError
        This is no mesh of tetrahedra with straight edges.

    >>> tetproof.measure(([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]]))["faces"]
    4
    """
    measures: Dict[str, Any] = json.loads(_oracles.measure(_judged(mesh)))
    return measures

"""Tetrahedral meshes of closed triangulated surfaces, exactly conforming.

>>> import numpy as np, tetproof
>>> points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
>>> triangles = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
...              [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
>>> mesh = tetproof.mesh(points, triangles, max_edge=0.5)
>>> float(round(mesh.volumes().sum(), 12))
1.0
"""
from . import _core
from ._jobs import (RepairedPlane, cdt, check, check_plane, improve, label_by_angle, mesh, plane, read, read_mesh, remesh, repair, repair_plane,
                    write)
from ._meshes import Mesh, PlaneMesh, TenNodes
from ._runs import Error, Interrupted, InvalidMesh, InvalidSurface, LimitReached, PlaneReport, Progress as Progress, Report
from ._surfaces import Defect, Face, RegionPoint, Repaired, Surface
from ._verdicts import Verdict, measure, verify

__version__ = _core.version
__all__ = ["Defect", "Error", "Face", "Interrupted", "InvalidMesh", "InvalidSurface", "LimitReached", "Mesh", "PlaneMesh", "PlaneReport",
           "RegionPoint", "Repaired", "RepairedPlane", "Report", "Surface", "TenNodes", "Verdict", "cdt", "check", "check_plane", "improve",
           "label_by_angle", "measure", "mesh", "plane", "read", "read_mesh", "remesh", "repair", "repair_plane", "verify", "write"]

for _name in __all__:
    globals()[_name].__module__ = __name__  # what is pickled, and what help says, do not know of the files

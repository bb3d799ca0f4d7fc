"""What notebooks and windows show. Pyvista itself is asked where it is there; else a stand-in that keeps what it is given."""
import sys
import types

import numpy as np
import pytest

import tetproof

from test_verdicts import CUBE, LABELS, POINTS, TRIANGLES


class Plotter:
    def __init__(self):
        self.shown, self.meshes = False, []

    def add_mesh(self, mesh, **options):
        self.meshes.append((mesh, options))

    def show(self):
        self.shown = True


@pytest.fixture
def pyvista(monkeypatch):
    stand_in = types.ModuleType("pyvista")
    stand_in.CellType = types.SimpleNamespace(TETRA=10, TRIANGLE=5)
    stand_in.Plotter = Plotter
    stand_in.PolyData = lambda points, faces=None, lines=None: types.SimpleNamespace(points=points, faces=faces, lines=lines)
    stand_in.UnstructuredGrid = lambda cells, points: types.SimpleNamespace(cells=cells, points=points, cell_data={})
    monkeypatch.setitem(sys.modules, "pyvista", stand_in)


def test_dihedral_angles():
    mesh = tetproof.mesh(*CUBE, max_edge=0.3)
    angles = mesh.smallest_dihedrals()
    assert angles.shape == (len(mesh.tetrahedra),) and angles.min() == pytest.approx(mesh.stats["final"]["min_dihedral"])
    regular = np.array([[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]])
    assert tetproof.Mesh(regular, np.array([[0, 2, 1, 3]]), np.ones(1, bool), *(np.zeros(0),) * 3).smallest_dihedrals() == pytest.approx(
        np.degrees(np.arccos(1 / 3)))


def test_a_mesh_cut_open(pyvista):
    mesh = tetproof.mesh(*CUBE, max_edge=0.3)
    plotter = mesh.plot(cut=(0, 0, 2))
    (grid, options), = plotter.meshes
    heights = mesh.points[grid.cells[10]].mean(axis=1)[:, 2]
    assert plotter.shown and 0 < len(heights) < len(mesh.tetrahedra) and heights.max() <= 0.5
    assert len(grid.cell_data[options["scalars"]]) == len(heights)
    whole = mesh.plot(cut=None, show=False)
    assert not whole.shown and len(whole.meshes[0][0].cells[10]) == len(mesh.tetrahedra)
    hull = tetproof.cdt(*CUBE)
    assert len(hull.plot(cut=None).meshes[0][0].cells[10]) == hull.inside.sum()
    for wrong in ((0, 0, 0), (1, 0), (1, 0, float("nan"))):
        with pytest.raises(ValueError, match="cut must be"):
            mesh.plot(cut=wrong)


def test_defects_are_red(pyvista):
    open_cube = tetproof.Surface(POINTS, TRIANGLES[:-1], LABELS[:-1])
    plotter = open_cube.plot()
    edges, surface = plotter.meshes
    assert plotter.shown and edges[1]["color"] == "red" and surface[1]["color"] == "lightgray"
    assert {tuple(sorted(edge)) for edge in edges[0].lines.reshape(-1, 3)[:, 1:].tolist()} == {(1, 7), (5, 7), (1, 5)}
    pierced = tetproof.Surface(np.vstack([POINTS, POINTS * 0.5 + [0.2, 0.2, -0.3]]), np.vstack([TRIANGLES, TRIANGLES + 8]), np.zeros(24, int))
    report = tetproof.check(pierced)
    colours = {options["color"]: len(mesh.faces) // 4 for mesh, options in pierced.plot(report, show=False).meshes}
    assert colours["red"] == len(np.unique(report.places["self-intersection"])) and sum(colours.values()) == 24
    assert [options["color"] for _, options in tetproof.Surface(*CUBE, LABELS).plot().meshes] == ["lightgray"]


def test_with_pyvista_itself():
    pyvista = pytest.importorskip("pyvista")
    mesh = tetproof.mesh(*CUBE, max_edge=0.3)
    plotter = mesh.plot(show=False)
    assert isinstance(plotter, pyvista.Plotter) and 0 < plotter.mesh.n_cells < len(mesh.tetrahedra)
    tetproof.Surface(POINTS, TRIANGLES[:-1], LABELS[:-1]).plot(show=False)
    # Its own meshes come back.
    assert tetproof.verify(tetproof.Surface(*CUBE, LABELS).to_pyvista(), mesh.to_pyvista()).verdict == "exact"


def test_without_pyvista(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError):
        tetproof.cdt(*CUBE).plot()


def test_notebooks():
    mesh = tetproof.mesh(*CUBE, max_edge=0.5)
    mesh.names[3] = "<b>"
    assert "<td" in mesh._repr_html_() and str(len(mesh.tetrahedra)) in mesh._repr_html_() and "&lt;b&gt;" in mesh._repr_html_()
    assert "12 triangles" in tetproof.Surface(POINTS, TRIANGLES, np.zeros(12, int))._repr_html_()
    verdict = tetproof.verify(CUBE, (mesh.points, mesh.tetrahedra[1:]))
    assert "not passed" in verdict._repr_html_() and verdict.reasons[0].split(":")[0] in verdict._repr_html_()

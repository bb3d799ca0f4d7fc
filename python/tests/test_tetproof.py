"""The package as users see it. Run with pytest where tetproof is installed."""
import gzip
import inspect
import os
import pickle
import re
import signal
import sys
import threading
import time
import types

import numpy as np
import pytest

import tetproof

POINTS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
TRIANGLES = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2],
                      [1, 3, 7], [1, 7, 5]])
LABELS = np.repeat([1, 2, 3, 4, 5, 6], 2)


def areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_a_labelled_cube():
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS, max_edge=0.4)
    assert mesh.points.dtype == np.float64 and mesh.tetrahedra.dtype == np.int32 and mesh.inside.dtype == bool
    assert mesh.inside.all() and mesh.volumes().min() > 0
    assert mesh.volumes().sum() == pytest.approx(1, abs=1e-12)
    for label in range(1, 7):
        assert areas(mesh.points, mesh.boundary[mesh.labels == label]).sum() == pytest.approx(1, abs=1e-12)
    assert np.array_equal(mesh.points[:8], POINTS)
    assert mesh.stats["final"]["tetrahedra"] == len(mesh.tetrahedra)
    edges = mesh.points[mesh.tetrahedra[:, [0, 0, 0, 1, 1, 2]]] - mesh.points[mesh.tetrahedra[:, [1, 2, 3, 2, 3, 3]]]
    assert np.linalg.norm(edges, axis=2).max() <= 0.4 + 1e-12


def test_inputs_of_any_kind():
    expected = tetproof.mesh(POINTS, TRIANGLES)
    for points, triangles in ((POINTS.tolist(), TRIANGLES.tolist()), (np.asfortranarray(POINTS), TRIANGLES.astype(np.int16)),
                              (POINTS.astype(np.float32), TRIANGLES.astype(np.uint64))):
        assert np.array_equal(tetproof.mesh(points, triangles).tetrahedra, expected.tetrahedra)

    class Trimesh:
        vertices, faces = POINTS, TRIANGLES

    class Pyvista:
        points = POINTS
        faces = np.hstack([np.full((12, 1), 3), TRIANGLES]).ravel()

    class Meshio:
        points, cells_dict = POINTS, {"triangle": TRIANGLES}

    for given in (Trimesh(), Pyvista(), Meshio(), tetproof.Surface(POINTS, TRIANGLES, LABELS)):
        assert np.array_equal(tetproof.mesh(given).tetrahedra, expected.tetrahedra)


@pytest.mark.parametrize("wrong", [
    dict(triangles=[[0, 1, -1]]), dict(triangles=[[0, 1, 2, 3]]), dict(points=[[0, 0]]), dict(labels=[1, 2]),
    dict(labels=[1 << 40] * 12), dict(labels=[0xffffffff] * 12), dict(delta=99), dict(max_edge=float("nan")), dict(threads=-1), dict(threads=1.5), dict(region="all"), dict(improve=2)])
def test_what_makes_no_sense_is_a_value_error(wrong):
    arguments = {"points": POINTS, "triangles": TRIANGLES, **wrong}
    with pytest.raises(ValueError):
        tetproof.mesh(**arguments)


def test_unknown_options_and_types():
    for labels in ([0.5] * 12, ["inlet"] * 12, [float("nan")] * 12):
        with pytest.raises(TypeError, match="labels must be whole numbers"):
            tetproof.mesh(POINTS, TRIANGLES, labels=labels)
    assert set(tetproof.mesh(POINTS, TRIANGLES, labels=LABELS * -1.0).labels) == set(range(-6, 0))
    for nothing in (POINTS, None):
        with pytest.raises(TypeError, match="`read_mesh` makes one"):
            tetproof.improve(nothing)
    with pytest.raises(TypeError, match="no such option: detla: did you mean delta?"):
        tetproof.mesh(POINTS, TRIANGLES, detla=3)
    with pytest.raises(TypeError, match="no such option: colour .there are "):
        tetproof.mesh(POINTS, TRIANGLES, colour=3)
    with pytest.raises(TypeError):
        tetproof.mesh(POINTS, TRIANGLES + 0.5)
    with pytest.raises(TypeError):
        tetproof.mesh(POINTS)


def test_options_are_those_of_the_job():
    signature = inspect.signature(tetproof.mesh).parameters
    assert signature["delta"].default == 14.47 and signature["planar"].default == "auto" and signature["max_edge"].default is None
    assert inspect.signature(tetproof.plane).parameters["delta"].default == 20.7
    assert inspect.signature(tetproof.cdt).parameters["region"].default == "hull"
    assert "paper_order : bool, default False" in tetproof.mesh.__doc__ and "**options" not in tetproof.mesh.__doc__
    for job, names in {"mesh": ("paper_link", "gabriel"), "cdt": ("delta", "improve", "max_edge", "planar"),
                       "check": ("max_vertices", "delta"), "plane": ("threads", "corner", "paper_link")}.items():
        there = inspect.signature(getattr(tetproof, job)).parameters
        for name in names:
            assert (name in there) == (job == "mesh"), (job, name)
    cube = tetproof.mesh(POINTS, TRIANGLES)
    for wrong in (lambda: tetproof.cdt(POINTS, TRIANGLES, delta=3), lambda: tetproof.improve(cube, tau=0), lambda: tetproof.check(POINTS, TRIANGLES, max_vertices=9),
                  lambda: tetproof.mesh(POINTS, TRIANGLES, order=2), lambda: tetproof.mesh(POINTS, TRIANGLES, steiner_point=1)):
        with pytest.raises(TypeError, match="no such option"):
            wrong()
    with pytest.raises(ValueError, match="region cannot be 'all' .but 'interior' or 'hull'"):
        tetproof.mesh(POINTS, TRIANGLES, region="all")
    order = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.2, improve=False, paper_order=True, paper_steiner_point=True)
    assert len(order.points) != len(tetproof.mesh(POINTS, TRIANGLES, max_edge=0.2, improve=False).points)


def test_an_invalid_surface_says_where():
    with pytest.raises(tetproof.InvalidSurface) as caught:
        tetproof.mesh(POINTS, TRIANGLES[:-1])
    assert caught.value.counts == {"open edge": 3}
    assert {tuple(sorted(d.vertices)) for d in caught.value.defects} == {(1, 7), (5, 7), (1, 5)}
    assert {tuple(sorted(edge)) for edge in caught.value.places["open edge"].tolist()} == {(1, 7), (5, 7), (1, 5)}
    assert not caught.value.report.valid
    report = tetproof.check(POINTS, TRIANGLES)
    assert report.valid and report.volume == 1 and report.facets == 6 and report.defects == []


def test_all_defects_are_arrays():
    count = 40  # cubes far apart, each without its last triangle, and each with another that goes through its bottom
    points = np.vstack([POINTS + [3 * i, 0, 0] for i in range(count)] + [POINTS * 0.5 + [3 * i + 0.2, 0.2, -0.3] for i in range(count)])
    triangles = np.vstack([TRIANGLES[:-1] + 8 * i for i in range(count)] + [TRIANGLES + 8 * (count + i) for i in range(count)])
    with pytest.raises(tetproof.InvalidSurface) as caught:
        tetproof.mesh(points, triangles)
    error = caught.value
    assert set(error.places) == {"open edge", "self-intersection"} and len(error.defects) == 20
    assert all(len(error.places[kind]) == error.counts[kind] for kind in error.counts)
    assert error.counts["open edge"] == 3 * count
    pairs = error.places["self-intersection"]
    assert pairs.dtype == np.int32 and len(pairs) >= 8 * count
    bottoms, inner = pairs[:, 0], pairs[:, 1] - 11 * count
    assert set(bottoms % 11) == {0, 1} and np.array_equal(bottoms // 11, inner // 12)  # the first two triangles are the bottom


def test_repair():
    soup = POINTS[TRIANGLES.ravel()], np.arange(36).reshape(12, 3)
    assert tetproof.check(*soup).counts["open edge"] == 36
    mended = tetproof.repair(*soup)
    assert mended.done == ["28 vertices welded to others at the same place"]
    assert tetproof.mesh(mended).volumes().sum() == pytest.approx(1)
    assert tetproof.check(tetproof.repair(POINTS, TRIANGLES[:-1], fill=True)).valid
    for weld in (-1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="weld"):
            tetproof.repair(POINTS, TRIANGLES, weld=weld)


def test_limits():
    with pytest.raises(tetproof.LimitReached) as caught:
        tetproof.mesh(POINTS, TRIANGLES, max_edge=0.02, max_vertices=500)
    assert caught.value.limit == "size"


def test_a_size_by_default_is_told():
    told, none = tetproof.mesh(POINTS, TRIANGLES).stats, tetproof.mesh(POINTS, TRIANGLES, size="none").stats
    assert told["chosen_size"] == pytest.approx(np.sqrt(3) / 10) and told["tetrahedra_without_size"] == none["final"]["tetrahedra"]
    assert none["chosen_size"] == 0 and none["tetrahedra_without_size"] == 0


def test_progress():
    phases = []
    tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3, progress=lambda phase, done, vertices: phases.append(phase))
    assert phases[0] == "check" and "refine" in phases
    with pytest.raises(tetproof.Interrupted):
        tetproof.mesh(POINTS, TRIANGLES, progress=lambda *_: False)
    with pytest.raises(ZeroDivisionError):
        tetproof.mesh(POINTS, TRIANGLES, progress=lambda *_: 1 / 0)
    assert len(tetproof.mesh(POINTS, TRIANGLES, size="none", progress=lambda *_: "going on").points) == 8
    with pytest.raises(ValueError, match="ambiguous"):
        tetproof.mesh(POINTS, TRIANGLES, progress=lambda *_: np.array([1, 2]))


def test_errors_and_results_go_to_other_processes():
    for error in (tetproof.LimitReached("too many", "size"), tetproof.InvalidMesh("not one"), tetproof.Interrupted("stopped")):
        back = pickle.loads(pickle.dumps(error))
        assert type(back) is type(error) and back.args == error.args and getattr(back, "limit", "") == getattr(error, "limit", "")
    with pytest.raises(tetproof.InvalidSurface) as caught:
        tetproof.mesh(POINTS, TRIANGLES[:-1])
    assert pickle.loads(pickle.dumps(caught.value)).counts == {"open edge": 3}
    mesh = tetproof.mesh(POINTS, TRIANGLES)
    again = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(again.points, mesh.points) and again != mesh and mesh == mesh


def test_meshes_of_others_are_improved():
    mesh = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3, improve=False)

    class Meshio:
        points, cells_dict = mesh.points, {"tetra": mesh.tetrahedra, "triangle": mesh.boundary}

    class Pyvista:
        points, cells_dict = mesh.points, {10: mesh.tetrahedra}

    for given in (Meshio(), Pyvista()):
        better = tetproof.improve(given)
        assert better.volumes().sum() == pytest.approx(1) and len(better.tetrahedra) < len(mesh.tetrahedra)


def test_surfaces_are_written_and_given_to_others(tmp_path):
    surface = tetproof.Surface(POINTS, TRIANGLES, LABELS, {1: "inlet", 2: "inlet"})
    surface.write(tmp_path / "cube.stl")
    back = tetproof.read(tmp_path / "cube.stl")
    assert back.names[1] == "inlet" and back.names[2] == "inlet 2" and np.array_equal(np.sort(back.labels), LABELS)
    tetproof.write(tmp_path / "cube.ply", tetproof.repair(surface), {1: "outlet"})
    assert "comment label 1 outlet" in (tmp_path / "cube.ply").read_text()
    for wrong in ({"a": "b"}, {1: 2}, [1]):
        with pytest.raises(TypeError, match="names must be a dict"):
            tetproof.write(tmp_path / "cube.stl", surface, wrong)
    with pytest.raises(TypeError, match="a mesh or a surface is expected, not int"):
        tetproof.write(tmp_path / "cube.stl", 3)
    with pytest.raises(ValueError, match="unknown mesh format"):
        surface.write(tmp_path / "cube.msh")
    meshio = pytest.importorskip("meshio")
    assert isinstance(surface.to_meshio(), meshio.Mesh) and np.array_equal(surface.to_meshio().cells_dict["triangle"], TRIANGLES)


def test_names_in_latin_1_are_read(tmp_path):
    surface = tetproof.Surface(POINTS, TRIANGLES, LABELS, {1: "inlet", 2: "outlet"})
    surface.write(tmp_path / "cube.stl")
    (tmp_path / "cube.stl").write_bytes((tmp_path / "cube.stl").read_bytes().replace(b"inlet", "Einla\xdf".encode("latin-1")))
    assert tetproof.read(tmp_path / "cube.stl").names[1] == "Einla\xdf"


def test_names_of_regions_come_back(tmp_path):
    mesh = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.5)
    mesh.regions = np.where(np.arange(len(mesh.tetrahedra)) % 2 == 0, 7, 9).astype(np.int32)
    mesh.region_names = {7: "steel", 9: "copper"}
    for name in ("cube.msh", "cube.vtu"):
        mesh.write(tmp_path / name)
        back = tetproof.read_mesh(tmp_path / name)
        assert back.region_names == mesh.region_names and np.array_equal(np.sort(back.regions), np.sort(mesh.regions))
        assert tetproof.improve(back).region_names == mesh.region_names


def ball(n=12):
    """A sphere of 12 n^2 triangles."""
    points, triangles = {}, []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    quad = [np.roll([side, i + di, j + dj], axis) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
                    a, b, c, d = [points.setdefault(tuple(q), len(points)) for q in (quad if side else quad[::-1])]
                    triangles += [(a, b, c), (a, c, d)]
    corners = np.array(list(points), float) * 2 / n - 1
    return corners / np.linalg.norm(corners, axis=1)[:, None], np.array(triangles)


def test_another_surface_within_a_tolerance():
    points, triangles = ball()
    surface = tetproof.remesh(points, triangles, tolerance=0.02)
    assert tetproof.check(surface).valid and len(surface.triangles) < len(triangles) / 4
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    share = tetproof.remesh(points, triangles, tolerance="%.17gd" % (0.02 / diagonal))
    assert np.array_equal(share.triangles, surface.triangles)
    mesh = tetproof.mesh(points, triangles, tolerance=0.02)
    assert len(mesh.tetrahedra) < len(tetproof.mesh(points, triangles, surface="keep").tetrahedra) / 3
    assert np.abs(np.linalg.norm(mesh.points[np.unique(mesh.boundary)], axis=1) - 1).max() <= 0.02
    with pytest.raises(ValueError, match="tolerance"):
        tetproof.remesh(points, triangles, tolerance=0)
    with pytest.raises(ValueError, match="tolerance"):
        tetproof.mesh(points, triangles, tolerance="2e")
    assert "1e-3d" in tetproof.remesh.__doc__ and "'0.001d'" in tetproof.remesh.__doc__


def test_bodies_that_share_a_wall_are_regions(tmp_path):
    points = np.array([(x, y, z) for x in (0, 1, 3) for y in (0, 1) for z in (0, 1)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    one = [(q[0], q[k], q[k + 1]) for q in sides for k in (1, 2)]
    triangles = np.array(one + [tuple(v + 4 for v in t) for t in one])
    labels = np.repeat([1, 2], len(one))
    with pytest.raises(tetproof.InvalidSurface):
        tetproof.mesh(points, triangles, labels)
    mesh = tetproof.mesh(tetproof.Surface(points, triangles, labels, {1: "copper", 2: "air"}), regions="all")
    assert mesh.region_names == {1: "air", 2: "copper"}
    corners = mesh.points[mesh.tetrahedra]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    assert np.isclose(volumes[mesh.regions == 1].sum(), 2) and np.isclose(volumes[mesh.regions == 2].sum(), 1)
    assert len(mesh.boundary) == len(triangles) - 2
    sides = mesh.boundary_regions()
    assert sorted(map(tuple, np.unique(np.sort(sides, axis=1), axis=0))) == [(0, 1), (0, 2), (1, 2)]
    wall = mesh.boundary[np.sort(sides, axis=1)[:, 0] > 0]
    assert len(wall) == 2 and (mesh.points[wall][:, :, 0] == 1).all()
    a, b, c = (mesh.points[mesh.boundary][:, k] for k in range(3))  # the triangle's front is where its normal points
    for (behind, front), normal, at in zip(sides, np.cross(b - a, c - a), (a + b + c) / 3):
        for number, x in ((behind, at - 1e-3 * normal), (front, at + 1e-3 * normal)):
            assert number == (0 if (x < 0).any() or (x > [3, 1, 1]).any() else 2 if x[0] < 1 else 1)
    copper = mesh.region("copper")
    assert np.isclose(copper.volumes().sum(), 1) and len(copper.boundary) == 12 and copper.region_names == {2: "copper"}
    assert len(mesh.region(1).tetrahedra) + len(copper.tetrahedra) == len(mesh.tetrahedra)
    with pytest.raises(KeyError, match="air, copper"):
        mesh.region("gold")
    surface = tetproof.Surface(points, triangles, labels, {1: "copper", 2: "air"})
    assert np.isclose(tetproof.mesh(surface, regions=["copper"]).volumes().sum(), 1)
    assert np.isclose(tetproof.mesh(surface, regions="largest").volumes().sum(), 2)
    with pytest.raises(ValueError, match="air, copper"):
        tetproof.mesh(surface, regions="gold")
    fine = tetproof.mesh(surface, regions="all", max_edge={"copper": 0.3})
    assert len(fine.region("copper").tetrahedra) > 2 * len(copper.tetrahedra)


@pytest.mark.parametrize("with_tqdm", [False, True])
def test_a_bar_for_every_function(capsys, monkeypatch, with_tqdm):
    shown = []

    class Bar:
        def __init__(self, **_):
            self.n, self.open = 0, True

        def reset(self, total):
            assert total == 1

        def set_description_str(self, text, refresh):
            shown.append(text)

        def set_postfix_str(self, text, refresh):
            assert text == "" or text.endswith(" points")

        def refresh(self):
            assert 0 <= self.n <= 1 and self.open

        def close(self):
            shown.append("closed")

    module = types.ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm") if with_tqdm else None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", module if with_tqdm else None)
    mesh = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3, progress=True)
    tetproof.cdt(POINTS, TRIANGLES, progress=True)
    tetproof.improve(mesh, progress=True)
    tetproof.plane(POINTS[:4, :2], [[0, 1], [1, 3], [3, 2], [2, 0]], progress=True)
    tetproof.mesh(POINTS, TRIANGLES, progress=False)
    written = capsys.readouterr().err
    if with_tqdm:
        assert shown.count("closed") == 4 and shown[0] == "check" and "refine" in shown and written == ""
    else:
        assert written.count("\n") == 4 and "\rrefine" in written


def test_ctrl_c_ends_a_long_run():
    # What a shell runs in the background ignores the signal, and Python then has no handler for it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            tetproof.mesh(POINTS, TRIANGLES, max_edge=2e-3, time_limit=60)
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_meanwhile():
    count, ended = [0], threading.Event()

    def tick():
        while not ended.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    tetproof.mesh(POINTS, TRIANGLES, max_edge=0.05)
    ended.set()
    thread.join()
    assert count[0] > 10


def test_the_same_for_any_number_of_threads():
    one, two = (tetproof.mesh(POINTS, TRIANGLES, max_edge=0.2, threads=n) for n in (1, 2))
    assert np.array_equal(one.points, two.points) and np.array_equal(one.tetrahedra, two.tetrahedra)


def test_points_without_triangles():
    points = np.vstack([POINTS, [[0.25, 0.5, 0.625], [9, 9, 9]]])
    mesh = tetproof.mesh(points, TRIANGLES)
    assert [0.25, 0.5, 0.625] in mesh.points.tolist() and [9, 9, 9] not in mesh.points.tolist()
    assert any("1 point left out" in line for line in mesh.warnings)


def test_region_points_and_split_walls(tmp_path):
    points = np.vstack([POINTS, POINTS[POINTS[:, 0] == 1] + [1, 0, 0]])
    second = np.array([1, 8, 3, 9, 5, 10, 7, 11])[TRIANGLES]
    triangles = np.vstack([TRIANGLES, second])
    told = [tetproof.RegionPoint((0.5, 0.5, 0.4), "left"), tetproof.RegionPoint((1.5, 0.5, 0.4), "right", max_edge=0.9)]
    mesh = tetproof.mesh(points, triangles, regions="all", region_points=told, split_walls="all")
    assert sorted(mesh.region_names.values()) == ["left", "right"]
    assert sorted(mesh.names.values()) == ["left|right", "right|left"]
    assert len(mesh.points) == len(np.unique(mesh.points, axis=0)) + 4
    assert len(set(mesh.region("left").tetrahedra.ravel())) == len(mesh.region("left").points)
    assert np.isclose(mesh.region("right").volumes().sum(), 1)
    with pytest.raises(ValueError, match="no wall is called"):
        tetproof.mesh(points, triangles, regions="all", split_walls=["copper|air"])
    hole = [tetproof.RegionPoint((0.5, 0.5, 0.4), is_hole=True)]
    assert np.isclose(tetproof.mesh(points, triangles, regions="all", region_points=hole).volumes().sum(), 1)
    faces = "".join("1\n3 %d %d %d\n" % tuple(t) for t in triangles.tolist())
    nodes = "".join("%d %g %g %g\n" % (n, *p) for n, p in enumerate(points.tolist()))
    path = tmp_path / "two.poly"
    path.write_text("%d 3\n%s%d\n%s0\n1\n0 0.5 0.5 0.4 7\n" % (len(points), nodes, len(triangles), faces))
    assert tetproof.read(path).region_points == [tetproof.RegionPoint([0.5, 0.5, 0.4], "7", 0.0, False)]
    assert list(tetproof.mesh(path, regions="all").region_names.values()) == ["7"]


def test_a_size_field():
    corner, fine = np.zeros(3), [[0, 0, 0, 0.02]]
    mesh = tetproof.mesh(POINTS, TRIANGLES, size_field=fine, size_growth=0.5, improve=False, region="interior")
    edges = np.vstack([mesh.tetrahedra[:, pair] for pair in ([0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3])])
    ends = mesh.points[edges]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    nearest = np.linalg.norm(ends - corner, axis=2).min(axis=1)
    assert (lengths <= 0.02 + 0.5 * nearest + 1e-9).all()
    assert lengths.max() > 0.2
    again = tetproof.improve(mesh, size_field=fine, size_growth=0.5)
    assert len(again.tetrahedra) < len(mesh.tetrahedra)
    assert len(tetproof.improve(mesh).tetrahedra) < len(again.tetrahedra)
    for wrong in ([[0, 0, 0]], [0, 0, 0, 1], [[0, 0, 0, 0]], [[0, 0, 0, -1]], [[0, 0, float("nan"), 1]]):
        with pytest.raises(ValueError):
            tetproof.mesh(POINTS, TRIANGLES, size_field=wrong)


def test_cdt_and_improve():
    mesh = tetproof.cdt(POINTS, TRIANGLES)
    assert len(mesh.tetrahedra) in (5, 6) and mesh.volumes().sum() == pytest.approx(1)
    coarse = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3, improve=False)
    better = tetproof.improve(coarse)
    assert better.volumes().sum() == pytest.approx(1)
    assert better.stats["final"]["min_dihedral"] >= coarse.stats["final"]["min_dihedral"]
    twice = np.concatenate([coarse.tetrahedra, coarse.tetrahedra[:1]])
    doubled = tetproof.Mesh(coarse.points, twice, True, coarse.boundary, coarse.labels, coarse.facets)
    with pytest.raises(tetproof.InvalidMesh):
        tetproof.improve(doubled)


def test_a_dirty_plane_is_mended():
    points, segments = [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]
    with pytest.raises(tetproof.InvalidSurface, match=r"segments 4 and 5 cross.*`tetproof.repair_plane\(\)` makes a vertex there"):
        tetproof.plane(points, segments)
    report = tetproof.check_plane(points, segments)
    assert (report.valid, report.counts, report.places["crossing"].tolist()) == (False, {"crossing": 1}, [[4, 5]])
    assert "`tetproof.repair_plane()`" in report.hints[0]
    mended = tetproof.repair_plane(points, segments, markers=range(6))
    assert mended.points[-1].tolist() == [0.5, 0.5] and mended.markers.tolist().count(4) == 2 and mended.done
    assert tetproof.check_plane(mended.points, mended.segments).area == pytest.approx(1)
    tetproof.plane(mended.points, mended.segments, mended.markers)
    assert len(tetproof.repair_plane(points, segments, weld=0.1).points) == 5
    with pytest.raises(ValueError, match="weld"):
        tetproof.repair_plane(points, segments, weld=-1)


def test_plane():
    square = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [2, 1], [2, 2], [1, 2]]
    segments = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]]
    mesh = tetproof.plane(square, segments, markers=[1] * 4 + [2] * 4, holes=[[1.5, 1.5]])
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    area = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    assert area.min() > 0 and area.sum() == pytest.approx(15)
    assert set(mesh.markers) == {1, 2} and mesh.stats["min_angle"] >= 20.7


def test_compressed_files_and_second_order(tmp_path):
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS)
    mesh.write(tmp_path / "cube.vtu", order=2)
    mesh.write(tmp_path / "cube.off")
    for name in ("cube.vtu", "cube.off"):
        (tmp_path / (name + ".gz")).write_bytes(gzip.compress((tmp_path / name).read_bytes()))
    back = tetproof.read_mesh(tmp_path / "cube.vtu.gz")
    assert np.array_equal(back.points, mesh.points) and np.array_equal(back.tetrahedra, mesh.tetrahedra) and back.warnings == []
    assert np.array_equal(tetproof.read(tmp_path / "cube.off.gz").triangles, tetproof.read(tmp_path / "cube.off").triangles)
    (tmp_path / "cut.off.gz").write_bytes((tmp_path / "cube.off.gz").read_bytes()[:50])
    with pytest.raises(ValueError, match="byte 50: the compressed data end early"):
        tetproof.read(tmp_path / "cut.off.gz")


def test_files(tmp_path):
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS)
    mesh.names = {1: "inlet"}
    mesh.write(tmp_path / "cube.msh")
    back = tetproof.read_mesh(tmp_path / "cube.msh")
    assert back.names == {1: "inlet"} and np.array_equal(back.points, mesh.points)
    mesh.write(tmp_path / "cube.vtu", order=2, ascii=True)
    assert "\n24\n" in (tmp_path / "cube.vtu").read_text()
    with pytest.raises(ValueError, match="no elements of second order"):
        mesh.write(tmp_path / "cube.tet", order=2)
    tetproof.write(tmp_path / "cube.stl", mesh)
    surface = tetproof.read(tmp_path / "cube.stl")
    assert surface.names[1] == "inlet" and set(surface.labels) == set(range(1, 7))
    assert tetproof.mesh(surface).names[1] == "inlet"
    for missing in (tetproof.read, tetproof.read_mesh, tetproof.mesh, tetproof.improve):
        with pytest.raises(FileNotFoundError, match="none.stl"):
            missing(tmp_path / "none.stl")
    with pytest.raises(FileNotFoundError, match="folder"):
        tetproof.write(tmp_path / "folder" / "cube.msh", mesh)
    with pytest.raises(ValueError, match="unknown mesh format"):
        tetproof.write(tmp_path / "cube.doc", mesh)


@pytest.mark.parametrize("page, written", [("README.md", "part.msh"), ("python/README.md", "part.inp")])
def test_what_pages_show(tmp_path, monkeypatch, page, written):
    with open(os.path.join(os.path.dirname(__file__), "..", "..", page), encoding="utf-8") as stream:
        snippet = re.search(r"^```python\n(.*?)^```", stream.read(), re.M | re.S).group(1)
    monkeypatch.chdir(tmp_path)
    tetproof.write("part.stl", tetproof.Surface(POINTS, TRIANGLES, LABELS))
    made = {}
    exec(snippet, made)
    assert len(made["mesh"].tetrahedra) > 0 and os.path.getsize(written) > 0


def test_files_are_given_by_name(tmp_path):
    tetproof.Surface(POINTS, TRIANGLES, LABELS, {1: "inlet", 2: "outlet"}).write(tmp_path / "cube.stl")
    mesh = tetproof.mesh(str(tmp_path / "cube.stl"))
    assert mesh.names[1] == "inlet" and tetproof.check(tmp_path / "cube.stl").valid
    mesh.write(tmp_path / "cube.msh")
    assert tetproof.improve(tmp_path / "cube.msh").names[2] == "outlet"


def test_objects_are_told_in_a_line():
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS, size="none")
    assert repr(mesh) == "Mesh(8 points, 6 tetrahedra, 12 boundary triangles, smallest dihedral angle 45.00 degrees)"
    assert repr(tetproof.Surface(POINTS, TRIANGLES, LABELS)) == "Surface(8 points, 12 triangles, 6 labels)"
    plane = tetproof.plane([[0, 0], [1, 0], [0, 1]], [[0, 1], [1, 2], [2, 0]])
    assert repr(plane) == "PlaneMesh(%d points, %d triangles, %d edges)" % (len(plane.points), len(plane.triangles), len(plane.edges))


def test_messages_speak_python():
    soup = POINTS[TRIANGLES.ravel()] + 1e-7 * np.random.default_rng(1).random((36, 3)), np.arange(36).reshape(12, 3)
    report = tetproof.check(*soup)
    hint = next(h for h in report.hints if "nearly coincide" in h)
    weld = float(re.search(r"`tetproof.repair\(weld=([^)]*)\)`", hint)[1])
    assert tetproof.check(tetproof.repair(*soup, weld=weld)).valid
    with pytest.raises(tetproof.InvalidSurface, match="in all open edge: 36, self-intersection: [0-9]+; vertices nearly coincide"):
        tetproof.mesh(*soup)
    with pytest.raises(tetproof.LimitReached, match="see max_vertices|max_vertices"):
        tetproof.mesh(POINTS, TRIANGLES, max_edge=0.1, max_vertices=20)
    with pytest.raises(ValueError, match="^strict needs surface='keep'$"):
        tetproof.mesh(POINTS, TRIANGLES, strict=True)
    with pytest.raises(ValueError, match="^chamfer_radius does nothing with regions$"):
        tetproof.mesh(POINTS, TRIANGLES, regions="all", chamfer_radius=1)
    with pytest.raises(ValueError, match="size_growth: of no effect without size_field"):
        tetproof.mesh(POINTS, TRIANGLES, size_growth=0.5)
    with pytest.raises(TypeError, match="points and triangles are expected, .* not Scene"):
        tetproof.mesh(type("Scene", (), {"triangles": TRIANGLES})())
    assert not re.search("--[a-z]", tetproof.mesh.__doc__) and "With surface='keep': fail" in tetproof.mesh.__doc__


def test_hints_know_all_defects():
    """Two boxes with a wall in common, each with its own triangles of it."""
    second = np.where(TRIANGLES % 2 == 1, TRIANGLES + 8, TRIANGLES + 1)
    report = tetproof.check(np.vstack([POINTS, POINTS + [1, 0, 0]]), np.vstack([TRIANGLES, second]))
    assert report.hints == ["bodies, or parts of one, touch in 2 triangles: `tetproof.repair()` makes one of them, "
                            "or `tetproof.mesh(regions='all')` meshes each as a region"]


def test_ten_nodes(tmp_path):
    """The arrays are what write(order=2) writes."""
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS, max_edge=0.5)
    ten = mesh.ten_nodes()
    assert np.array_equal(ten.points[:len(mesh.points)], mesh.points) and np.array_equal(ten.tetrahedra[:, :4], mesh.tetrahedra)
    meshio = pytest.importorskip("meshio")
    mesh.write(tmp_path / "ten.vtu", order=2)
    file = meshio.read(tmp_path / "ten.vtu")
    assert np.array_equal(file.points, ten.points)
    assert np.array_equal(file.cells_dict["tetra10"], ten.tetrahedra) and np.array_equal(file.cells_dict["triangle6"], ten.boundary)
    assert np.array_equal(mesh.to_meshio(order=2).cells_dict["tetra10"], ten.tetrahedra)


def test_meshio_gets_the_names(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS, max_edge=0.5)
    mesh.names = {1: "inlet", 2: "inlet"}
    given = mesh.to_meshio()
    assert isinstance(given, meshio.Mesh)
    assert set(given.cell_sets) == {"inside", "inlet", "inlet 2", "label 3", "label 4", "label 5", "label 6"}
    assert given.field_data["inlet 2"].tolist() == [2, 2] and given.field_data["inside"].tolist() == [1, 3]
    tetrahedra, triangles = given.cell_sets["inlet"]
    assert len(tetrahedra) == 0 and np.array_equal(triangles, np.flatnonzero(mesh.labels == 1))
    assert len(given.cell_sets["inside"][0]) == len(mesh.tetrahedra)
    given.write(tmp_path / "cube.inp")
    assert "inlet" in (tmp_path / "cube.inp").read_text()


def test_what_a_format_cannot_hold_is_warned_of(tmp_path):
    mesh = tetproof.mesh(POINTS, TRIANGLES, labels=LABELS)
    with pytest.warns(UserWarning, match="cube.off has no place for the labels, which are lost there"):
        mesh.write(tmp_path / "cube.off")
    mesh.write(tmp_path / "cube.msh", msh="2.2")
    assert (tmp_path / "cube.msh").read_text().startswith("$MeshFormat\n2.2 0 8\n")
    assert np.array_equal(np.sort(tetproof.read_mesh(tmp_path / "cube.msh").labels), np.sort(mesh.labels))
    with pytest.raises(ValueError, match="msh must be"):
        mesh.write(tmp_path / "cube.msh", msh="3")


def test_results_outlive_each_other():
    points = tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3).points
    copy = points.copy()
    for _ in range(20):
        tetproof.mesh(POINTS, TRIANGLES, max_edge=0.3)
    assert np.array_equal(points, copy)


def test_faces_between_sharp_edges_get_labels():
    surface = tetproof.label_by_angle(POINTS, TRIANGLES, degrees=30)
    assert np.array_equal(surface.labels, LABELS) and surface.names == {n: "face_%d" % n for n in range(1, 7)}
    bottom = surface.faces()[0]
    assert bottom[:5] == (1, "face_1", 2, 1.0, "planar") and np.array_equal(bottom.direction, [0, 0, -1])
    assert np.array_equal(bottom.lower, [0, 0, 0]) and np.array_equal(bottom.upper, [1, 1, 0])
    mesh = tetproof.mesh(surface)
    assert mesh.names[6] == "face_6" and set(mesh.labels) == set(range(1, 7))
    for wrong in (0, 90.5, float("nan")):
        with pytest.raises(ValueError, match="at most 90 degrees"):
            tetproof.label_by_angle(POINTS, TRIANGLES, degrees=wrong)
    with pytest.raises(ValueError, match="labels already"):
        tetproof.label_by_angle(surface, degrees=30)


def test_sides_of_a_cylinder_are_one_face(tmp_path):
    n = 24
    turns = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(turns), np.sin(turns), 0 * turns])
    points = np.vstack([ring, ring + [0, 0, 3], [[0, 0, 0], [0, 0, 3]]])
    triangles = [t for i in range(n) for j in [(i + 1) % n]
                 for t in ([i, j, n + j], [i, n + j, n + i], [2 * n, j, i], [2 * n + 1, n + i, n + j])]
    tetproof.write(tmp_path / "can.stl", tetproof.Surface(points, np.array(triangles), np.zeros(4 * n, np.int32)))
    side, *caps = tetproof.label_by_angle(tmp_path / "can.stl", degrees=30).faces()
    assert side.shape == "cylindrical" and np.allclose(side.direction, [0, 0, 1]) and side.triangles == 2 * n
    assert side.area == pytest.approx(2 * n * np.sin(np.pi / n) * 3, rel=1e-6)
    assert [np.round(cap.direction[2]) for cap in caps] == [-1, 1]

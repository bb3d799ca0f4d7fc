"""What the oracles say, as users of the package see it. Run with pytest where tetproof is installed."""
import functools
import pickle
import signal
import threading

import numpy as np
import pytest

import tetproof

POINTS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
TRIANGLES = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2],
                      [1, 3, 7], [1, 7, 5]])
LABELS = np.repeat([1, 2, 3, 4, 5, 6], 2)
CUBE = (POINTS, TRIANGLES)


@pytest.fixture(scope="module")
def mesh():
    return tetproof.mesh(POINTS, TRIANGLES, labels=LABELS, max_edge=0.5)


def bare(mesh):
    return mesh.points.copy(), mesh.tetrahedra.copy()


def test_our_own_mesh(mesh):
    verdict = tetproof.verify(tetproof.Surface(POINTS, TRIANGLES, LABELS), mesh, promised="mesh --max-edge 0.5")
    assert verdict and verdict.passed and verdict.verdict == "exact" and verdict.reasons == [] and verdict.places == {}
    status = {oracle["name"]: oracle["status"] for oracle in verdict.oracles}
    assert {"complex", "orientation", "conformity", "volume", "boundary-list", "edges"} <= set(status)
    assert set(status.values()) <= {"pass", "info"}
    # Without CGAL nobody asks whether the surface intersects itself, and the verdict says so.
    assert any("CGAL" in line for line in verdict.unproven)
    assert str(verdict).startswith("verdict: exact") and repr(verdict) == "Verdict(exact, %d oracles)" % len(verdict.oracles)
    again = pickle.loads(pickle.dumps(verdict))
    assert again.verdict == "exact" and again.oracles == verdict.oracles


def test_labels_are_judged(mesh):
    import dataclasses
    surface = tetproof.Surface(POINTS, TRIANGLES, LABELS)
    wrong = mesh.labels.copy()
    wrong[5] = wrong[5] % 6 + 1
    verdict = tetproof.verify(surface, dataclasses.replace(mesh, labels=wrong))
    assert verdict.verdict == "broken"
    assert verdict.places["boundary-list"]["listed triangles"].tolist() == [5]
    bare_verdict = tetproof.verify(surface, bare(mesh))  # has no labels, and nobody said that it would
    assert bare_verdict.passed and "labels of the input (the file has none)" in bare_verdict.unproven


def test_an_inverted_tetrahedron(mesh):
    import dataclasses
    tetrahedra = mesh.tetrahedra.copy()
    tetrahedra[[7, 30]] = tetrahedra[[7, 30]][:, [1, 0, 2, 3]]
    verdict = tetproof.verify(CUBE, dataclasses.replace(mesh, tetrahedra=tetrahedra))
    assert not verdict and verdict.verdict == "broken" and verdict.inverted == 2
    assert verdict.places["orientation"]["tetrahedra"].tolist() == [7, 30]
    assert any(reason.startswith("orientation: tetrahedron 7 ") for reason in verdict.reasons)
    place = next(oracle for oracle in verdict.oracles if oracle["name"] == "orientation")["places"][0]  # as in the command's JSON
    assert place["kind"] == "tetrahedra" and place["numbers"] == [7] and place["at"] == pytest.approx(mesh.points[tetrahedra[7]].mean(axis=0))
    corners = verdict.places["complex"]["faces"]  # both tetrahedra of each are on one side
    assert corners.shape[1] == 3 and {tuple(face) for face in corners.tolist()} <= {
        tuple(sorted(set(tet) - {corner})) for tet in tetrahedra[[7, 30]].tolist() for corner in tet}
    # Arrays of nobody's convention may all be turned.
    points, tetrahedra = bare(mesh)
    assert tetproof.verify(CUBE, (points, tetrahedra[:, [1, 0, 2, 3]])).verdict == "exact"


def test_a_missing_tetrahedron(mesh):
    points, tetrahedra = bare(mesh)
    verdict = tetproof.verify(CUBE, (points, np.delete(tetrahedra, 11, axis=0)))
    assert verdict.verdict == "broken" and {"conformity", "volume"} <= {reason.split(":")[0] for reason in verdict.reasons}
    gap = verdict.places["conformity"]
    assert len(gap["faces"]) and {v for face in gap["faces"].tolist() for v in face} <= set(tetrahedra[11].tolist())
    assert len(gap["vertices"]) == 1 and set(gap["vertices"].tolist()) < set(tetrahedra[11].tolist()) and len(gap["input triangles"]) == 2


def test_a_missing_face(mesh):
    import dataclasses
    verdict = tetproof.verify(tetproof.Surface(POINTS, TRIANGLES, LABELS), dataclasses.replace(
        mesh, boundary=mesh.boundary[1:], labels=mesh.labels[1:], facets=mesh.facets[1:]))
    assert verdict.verdict == "broken"
    assert sorted(verdict.places["boundary-list"]["faces"][0].tolist()) == sorted(mesh.boundary[0].tolist())


def test_a_moved_vertex(mesh):
    points, tetrahedra = bare(mesh)
    top = np.flatnonzero((points[:, 2] == 1) & (points[:, :2] > 0).all(axis=1) & (points[:, :2] < 1).all(axis=1))
    points[top[0], 2] = 0.99
    verdict = tetproof.verify(CUBE, (points, tetrahedra))
    assert verdict.verdict == "broken" and set(verdict.places["conformity"]["input triangles"].tolist()) & {2, 3}
    # It is near all the same, and the verdict says how near.
    assert verdict.hint.startswith("the surface is another one, at most 0.01")
    assert tetproof.verify(CUBE, (points, tetrahedra), envelope=0.02).passed
    far = tetproof.verify(CUBE, (points, tetrahedra), envelope=0.001)
    assert not far and np.abs(far.places["envelope"]["points"] - points[top[0]]).max() < 1
    # By less than doubles resolve: rounded.
    points[top[0], 2] = np.nextafter(1, 2)
    verdict = tetproof.verify(CUBE, (points, tetrahedra))
    assert verdict.verdict == "rounded" and verdict.passed and 0 < verdict.deviation < 1e-15
    points[top[0], 2] = 1 + 1e-9
    assert not tetproof.verify(CUBE, (points, tetrahedra)).passed
    assert tetproof.verify(CUBE, (points, tetrahedra), declared_deviation=1e-8).passed


def test_a_vertex_too_many(mesh):
    points, tetrahedra = bare(mesh)
    verdict = tetproof.verify(CUBE, (np.vstack([points, [[0.5, 0.5, 0.5]]]), tetrahedra))
    assert verdict.places["complex"]["vertices"].tolist() == [len(points)]


def test_promises(mesh):
    verdict = tetproof.verify(CUBE, tetproof.cdt(*CUBE), promised="cdt")
    assert verdict.verdict == "exact" and "hull" in {oracle["name"] for oracle in verdict.oracles}
    # Beside a kept surface nothing excuses the diagonal of the cube; where the surface itself is too long, it is not proven.
    kept = tetproof.mesh(*CUBE, surface="keep", max_edge=2)
    assert tetproof.verify(CUBE, kept, promised="mesh --surface keep --max-edge 2").passed
    short = tetproof.verify(CUBE, kept, promised="mesh --surface keep --max-edge 1.5")
    (a, b), = short.places["edges"]["edges"]
    assert not short and np.linalg.norm(kept.points[a] - kept.points[b]) == pytest.approx(np.sqrt(3))
    assert any("--max-edge" in line for line in tetproof.verify(CUBE, kept, promised="mesh --surface keep --max-edge 0.2").unproven)
    with pytest.raises(ValueError, match="promised: .*--detla"):
        tetproof.verify(CUBE, mesh, promised="mesh --detla 3")
    for other in ("plane", "improve"):
        with pytest.raises(ValueError, match="promised: 'mesh OPTIONS' or 'cdt OPTIONS'"):
            tetproof.verify(CUBE, mesh, promised=other)


def test_regions():
    two = (np.vstack([POINTS, POINTS + [2, 0, 0]]), np.vstack([TRIANGLES, TRIANGLES + 8]))
    mesh = tetproof.mesh(*two, regions="all", max_edge=0.9)
    assert tetproof.verify(two, mesh, promised="mesh --regions all").passed
    mesh.regions[0] = 3 - mesh.regions[0]
    assert not tetproof.verify(two, mesh, promised="mesh --regions all")


def test_meshes_of_others(mesh):
    class Meshio:
        points = mesh.points
        cells_dict = {"tetra": mesh.tetrahedra.astype(np.int64), "triangle": mesh.boundary.astype(np.int64)}
        cell_data_dict = {"label": {"triangle": mesh.labels, "tetra": np.zeros(len(mesh.tetrahedra), int)}}

    class Pyvista:
        points = mesh.points
        cells_dict = {10: mesh.tetrahedra, 5: mesh.boundary}
        celltypes = np.repeat([10, 5], [len(mesh.tetrahedra), len(mesh.boundary)])
        cell_data = {"label": np.concatenate([np.zeros(len(mesh.tetrahedra), int), mesh.labels])}

    class Tetrahedra:
        points, cells_dict = mesh.points, {"tetra": mesh.tetrahedra}

    surface = tetproof.Surface(POINTS, TRIANGLES, LABELS)
    for given in (Meshio(), Pyvista()):
        verdict = tetproof.verify(surface, given)
        assert verdict.passed and not any("label" in line for line in verdict.unproven), verdict
    assert tetproof.verify(surface, Tetrahedra()).passed
    Meshio.cell_data_dict["label"]["triangle"] = np.roll(mesh.labels, 1)
    assert "listed triangles" in tetproof.verify(surface, Meshio()).places["boundary-list"]


def test_turned_tetrahedra_within_an_envelope(mesh):
    points, tetrahedra = bare(mesh)
    assert tetproof.verify(CUBE, (points, tetrahedra[:, [1, 0, 2, 3]]), envelope=1e-3).passed


def test_cells_of_other_kinds(mesh):
    class Tetgen:  # as a tetgen.TetGen
        node, elem = mesh.points, mesh.tetrahedra[:, [1, 0, 2, 3]]

    class File:  # as pyvista has it of a .vtu, where sides are int8
        points = mesh.points
        cells_dict = {np.uint8(10): mesh.tetrahedra}
        celltypes = np.full(len(mesh.tetrahedra), 10, np.uint8)
        cell_data = {"inside": np.ones(len(mesh.tetrahedra), np.int8), "region": np.ones(len(mesh.tetrahedra))}

    class Quads:  # as a pyvista.PolyData
        points = POINTS
        faces = np.hstack([np.full((4, 1), 4), np.arange(16).reshape(4, 4) % 8]).ravel()

    class Prisms:
        points = mesh.points
        cells_dict = {"tetra": mesh.tetrahedra, "wedge": np.zeros((1, 6), int)}

    class Grid:  # as a pyvista.UnstructuredGrid of triangles
        points = POINTS.astype(np.float32)
        cells_dict = {np.uint8(5): TRIANGLES}

    class Squares:
        points = POINTS
        cells_dict = {"triangle": TRIANGLES, "quad": np.zeros((1, 4), int)}

    for surface in (CUBE, Grid()):
        assert tetproof.verify(surface, Tetgen()).verdict == tetproof.verify(surface, File()).verdict == "exact"
    assert tetproof.measure(Tetgen())["inverted"] == 0
    File.cell_data["inside"] = np.zeros(len(mesh.tetrahedra), np.int8)
    assert not tetproof.verify(CUBE, File())
    with pytest.raises(ValueError, match="no triangles"):
        tetproof.check(Quads())
    with pytest.raises(ValueError, match="triangle are taken, .*: quad"):
        tetproof.check(Squares())
    for job in (tetproof.measure, tetproof.improve):
        with pytest.raises(ValueError, match="tetra are taken, .*: wedge"):
            job(Prisms())


@pytest.mark.parametrize("cell, nodes", [("tetra10", 10), (np.uint8(24), 10), ("hexahedron20", 20), ("VTK_LAGRANGE_TETRAHEDRON", 10)])
def test_curved_cells_are_not_left_out(mesh, cell, nodes):
    class Alone:
        points = mesh.points
        cells_dict = {cell: np.zeros((1, nodes), int)}

    class Beside(Alone):
        cells_dict = {"tetra": mesh.tetrahedra, cell: np.zeros((1, nodes), int), "line3": np.zeros((1, 3), int)}

    for given in (Alone(), Beside()):
        for job in (tetproof.measure, tetproof.improve, functools.partial(tetproof.verify, CUBE)):
            with pytest.raises(ValueError, match="tetra are taken, .*: %s$" % cell):
                job(given)


@pytest.mark.parametrize("cell, nodes", [("triangle6", 6), (np.uint8(22), 6), ("quad9", 9)])
def test_curved_triangles_are_not_left_out(mesh, cell, nodes):
    class Surface:
        points = POINTS
        cells_dict = {cell: np.zeros((1, nodes), int)}

    class Boundary:
        points = mesh.points
        cells_dict = {"tetra": mesh.tetrahedra, "triangle": mesh.boundary, cell: np.zeros((1, nodes), int)}

    for job in (lambda: tetproof.check(Surface()), lambda: tetproof.verify(CUBE, Boundary())):
        with pytest.raises(ValueError, match="triangle are taken, .*: %s$" % cell):
            job()


# The packages themselves: what comes out of them goes straight in.


def polydata():
    pyvista = pytest.importorskip("pyvista")
    return pyvista.Cube().triangulate().clean()


def test_with_tetgen_itself():
    tetgen = pytest.importorskip("tetgen")
    surface = polydata()
    mesher = tetgen.TetGen(surface)
    arrays = mesher.tetrahedralize(order=1, quiet=True)
    for given in (arrays, mesher, mesher.grid):
        assert tetproof.verify(surface, given).verdict == "exact" and tetproof.measure(given)["volume"] == pytest.approx(1)


def test_with_pytetwild_itself():
    pytetwild = pytest.importorskip("pytetwild")
    surface = polydata()
    triangles = surface.faces.reshape(-1, 4)[:, 1:].astype(np.int32)
    for given in (pytetwild.tetrahedralize(np.asarray(surface.points), triangles, edge_length_fac=0.3),
                  pytetwild.tetrahedralize_pv(surface, edge_length_fac=0.3)):
        assert tetproof.verify(surface, given, envelope=2e-3).passed and tetproof.measure(given)["inverted"] == 0


def test_with_files_of_ours(mesh, tmp_path):
    meshio = pytest.importorskip("meshio")
    surface = tetproof.Surface(POINTS, TRIANGLES, LABELS)
    readers = [meshio.read]
    try:
        import pyvista
        readers.append(pyvista.read)
    except ImportError:
        pass
    for read in readers:
        for name in ("cube.vtu", "cube.msh") if read is meshio.read else ("cube.vtu",):
            mesh.write(tmp_path / name)
            assert tetproof.verify(surface, read(tmp_path / name)).verdict == "exact"


def test_files(mesh, tmp_path):
    tetproof.write(tmp_path / "cube.off", tetproof.Surface(POINTS, TRIANGLES, np.zeros(12, np.int32)))
    for name in ("cube.msh", "cube.vtu", "cube.mesh"):
        mesh.write(tmp_path / name)
        assert tetproof.verify(tmp_path / "cube.off", str(tmp_path / name)).verdict == "exact"


def test_what_makes_no_sense(mesh):
    points, tetrahedra = bare(mesh)
    bad_points = points.copy()
    bad_points[3, 1] = np.nan
    bad_tetrahedra = tetrahedra.copy()
    bad_tetrahedra[9, 2] = len(points)
    for match, given in {"mesh: point 3 is not finite": (CUBE, (bad_points, tetrahedra)),
                         "mesh: row 9 of tetrahedra names point %d, and there are %d" % (len(points), len(points)): (CUBE, (points, bad_tetrahedra)),
                         "points must have shape .n, 3.": (CUBE, (points[:, :2], tetrahedra)),
                         "tetrahedra must have shape .n, 4.": (CUBE, (points, tetrahedra[:, :3])),
                         "surface: row 0 of triangles names point 8": ((POINTS, [[0, 1, 8]]), (points, tetrahedra)),
                         "surface: point 0 is not finite": ((POINTS + np.inf, TRIANGLES), (points, tetrahedra)),
                         "1 labels for 12 triangles": ((POINTS, TRIANGLES, [1]), (points, tetrahedra)),
                         "numbers of points are from 0": (CUBE, (points, tetrahedra - 1))}.items():
        with pytest.raises(ValueError, match=match):
            tetproof.verify(*given)
    for wrong in (dict(envelope=2), dict(envelope=0), dict(envelope=float("nan")), dict(declared_deviation=-1), dict(declared_deviation=float("inf")),
                  dict(threads=-1), dict(threads=5000)):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            tetproof.verify(CUBE, mesh, **wrong)
    for given in (None, POINTS, "no such file.msh"):
        with pytest.raises((TypeError, FileNotFoundError)):
            tetproof.verify(CUBE, given)
    with pytest.raises(TypeError, match="whole numbers"):
        tetproof.verify(CUBE, (points, tetrahedra + 0.5))
    with pytest.raises(tetproof.InvalidSurface, match="open") as caught:
        tetproof.verify((POINTS, TRIANGLES[:-1]), mesh)
    assert caught.value.counts == {"open edge": 3}


def test_any_number_of_threads(mesh):
    first = tetproof.verify(CUBE, mesh)
    assert all(tetproof.verify(CUBE, mesh, threads=threads).oracles == first.oracles for threads in (0, 3))


def test_measure(mesh):
    measures = tetproof.measure(mesh)
    assert measures["tetrahedra"] == len(mesh.tetrahedra) and measures["vertices"] == len(mesh.points)
    assert measures["volume"] == pytest.approx(1) and measures["inverted"] == measures["flat"] == 0
    assert measures["min_dihedral"] == pytest.approx(mesh.stats["final"]["min_dihedral"])
    assert sum(measures["dihedral_histogram"]) == 6 * len(mesh.tetrahedra)
    points, tetrahedra = bare(mesh)
    tetrahedra[3] = tetrahedra[3, [1, 0, 2, 3]]
    assert tetproof.measure((points, tetrahedra))["inverted"] == 1
    with pytest.raises(ValueError, match="point 0 is not finite"):
        tetproof.measure((points * np.nan, tetrahedra))


def test_interrupted(mesh):
    fine = tetproof.mesh(*CUBE, max_edge=0.05)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background ignores the signal
    try:
        timer = threading.Timer(0.2, signal.raise_signal, (signal.SIGINT,))
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            for _ in range(100):
                tetproof.verify(CUBE, fine)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)

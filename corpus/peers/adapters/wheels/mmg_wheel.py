"""Mmg by the package mmgpy, after our own constrained Delaunay tetrahedrization (delmesher beside $TETPROOF), since Mmg improves meshes and
makes none. SWITCHES: names and values of the arguments of its remesh; hausd is a fraction of the diagonal here."""
import os
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def constrained_delaunay(model):
    """vertices, tetrahedra, triangles of the boundary."""
    import numpy

    with tempfile.TemporaryDirectory(dir=".") as folder:
        surface, volume = os.path.join(folder, "surface.off"), os.path.join(folder, "volume.mesh")
        with open(surface, "w", encoding="ascii") as stream:
            stream.write("OFF\n%d %d 0\n" % (len(model.vertices), len(model.triangles)))
            stream.writelines("%r %r %r\n" % tuple(vertex) for vertex in model.vertices.tolist())
            stream.writelines("3 %d %d %d\n" % tuple(triangle) for triangle in model.triangles.tolist())
        program = os.path.join(os.path.dirname(os.environ["TETPROOF"]), "delmesher")
        done = subprocess.run([program, "cdt", "--region", "interior", surface, "-o", volume, "-q"], capture_output=True, text=True)
        if done.returncode != 0:
            raise contract.Refused("delmesher cdt: " + done.stderr.strip())
        with open(volume, encoding="ascii") as stream:
            text = stream.read()

    def section(name, width, kind):
        words = text.split("\n" + name + "\n", 1)[1].split("\n", 1)
        count = int(words[0])
        return numpy.array(words[1].split(maxsplit=width * count)[:width * count], dtype=kind).reshape(-1, width)[:, :-1].copy()

    return section("Vertices", 4, float), section("Tetrahedra", 5, int) - 1, section("Triangles", 4, int) - 1


def mesh(model, words):
    import mmgpy
    import numpy

    vertices, tetrahedra, triangles = constrained_delaunay(model)
    arguments = {"verbose": -1, **contract.arguments(words)}
    if "hausd" in arguments:
        arguments["hausd"] *= float(numpy.linalg.norm(model.vertices.max(axis=0) - model.vertices.min(axis=0)))
    started = time.monotonic()
    mmg = mmgpy.MmgMesh3D()
    mmg.set_mesh_size(vertices=len(vertices), tetrahedra=len(tetrahedra), triangles=len(triangles))
    mmg.set_vertices(vertices)
    mmg.set_tetrahedra(tetrahedra.astype("int32"))
    mmg.set_triangles(triangles.astype("int32"))
    mmg.remesh(**arguments)
    return numpy.array(mmg.get_vertices()), numpy.array(mmg.get_tetrahedra()).astype(numpy.int64), time.monotonic() - started


contract.run("mmgpy", mesh)

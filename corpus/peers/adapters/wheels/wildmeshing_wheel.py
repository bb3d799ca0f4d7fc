"""fTetWild by the package wildmeshing, its authors' own. SWITCHES: names and values of the arguments of its Tetrahedralizer."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def mesh(model, words):
    import wildmeshing

    started = time.monotonic()
    mesher = wildmeshing.Tetrahedralizer(**contract.arguments(words))
    mesher.set_log_level(6)
    mesher.set_mesh(model.vertices, contract.outwards(model).astype("int32"))
    mesher.tetrahedralize()
    vertices, tetrahedra = mesher.get_tet_mesh()[:2]
    return vertices, tetrahedra, time.monotonic() - started


contract.run("wildmeshing", mesh)

"""The program that the authors of "Surface chamfering for robust tetrahedral meshing" published, by the package delmesher.
SWITCHES: names and values of the arguments of its tetrahedralize, as lfs_exponent=4 or sliver_removal=True, or "-"."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def mesh(model, words):
    import delmesher

    started = time.monotonic()
    result = delmesher.tetrahedralize(model.vertices, model.triangles.astype("uint32"), **contract.arguments(words))
    return result.vertices, result.tetrahedra.astype("int64"), time.monotonic() - started


contract.run("delmesher", mesh)

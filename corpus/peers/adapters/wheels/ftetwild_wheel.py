"""fTetWild by the package pytetwild. SWITCHES: names and values of the arguments of pytetwild.tetrahedralize, as epsilon=1e-3."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def mesh(model, words):
    import pytetwild

    started = time.monotonic()
    vertices, tetrahedra = pytetwild.tetrahedralize(model.vertices, contract.outwards(model).astype("int32"), **contract.arguments(words))
    return vertices, tetrahedra, time.monotonic() - started


contract.run("pytetwild", mesh)

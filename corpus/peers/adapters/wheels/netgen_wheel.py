"""Netgen by the package netgen-mesher. SWITCHES: names and values of its MeshingParameters (numbers or words), or "-".

It needs shells that are oriented by what is inside, which files do not always have: they are turned."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def mesh(model, words):
    import numpy
    import pyngcore
    from netgen import meshing

    pyngcore.SetNumThreads(1)
    meshing.SetMessageImportance(0)
    netgen = meshing.Mesh(3)
    netgen.AddPoints(numpy.ascontiguousarray(model.vertices))
    face = netgen.Add(meshing.FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
    netgen.AddElements(dim=2, index=face, data=numpy.ascontiguousarray(contract.outwards(model), dtype=numpy.int32), base=0)
    started = time.monotonic()
    netgen.GenerateVolumeMesh(**contract.arguments(words))
    seconds = time.monotonic() - started
    cells = netgen.Elements3D().NumPy()
    vertices = numpy.array(netgen.Coordinates())
    return vertices, cells["nodes"][:, :4].astype(numpy.int64) - 1, seconds


contract.run("netgen-mesher", mesh)

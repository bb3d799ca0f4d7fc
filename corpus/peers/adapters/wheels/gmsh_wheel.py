"""Gmsh by the package gmsh. SWITCHES: names and values of Gmsh's options, as Mesh.Algorithm3D=10.

The triangles are discrete surfaces, one for each shell; each solid is a volume of its own, between its outer shell and those of its
cavities. What Gmsh says as an error is a refusal, also if it has a mesh."""
import sys
import time

sys.dont_write_bytecode = True
import contract  # noqa: E402


def mesh(model, words):
    import gmsh
    import numpy

    gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    for name, value in contract.arguments(words).items():
        gmsh.option.setNumber(name, value)
    gmsh.logger.start()
    gmsh.model.add("model")
    try:
        for shell in range(int(model.shell.max()) + 1):
            triangles = model.triangles[model.shell == shell]
            used = numpy.unique(triangles)
            gmsh.model.addDiscreteEntity(2, shell + 1)
            gmsh.model.mesh.addNodes(2, shell + 1, used + 1, model.vertices[used].reshape(-1))
            gmsh.model.mesh.addElementsByType(shell + 1, 2, [], triangles.reshape(-1) + 1)
        for solid in model.solids:
            loops = [gmsh.model.geo.addSurfaceLoop([shell + 1]) for shell in solid]
            gmsh.model.geo.addVolume(loops)
        gmsh.model.geo.synchronize()
        started = time.monotonic()
        gmsh.model.mesh.generate(3)
        seconds = time.monotonic() - started
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, corners = gmsh.model.mesh.getElementsByType(4)
    except Exception as error:
        said = [line for line in gmsh.logger.get() if line.startswith("Error")]
        raise contract.Refused(said[0] if said else str(error)) from error
    said = [line for line in gmsh.logger.get() if line.startswith("Error")]
    if said:
        raise contract.Refused(said[0])
    if not numpy.isin(corners, tags).all():
        raise contract.Refused("its tetrahedra have nodes that it does not list")
    place = numpy.zeros(int(tags.max()) + 1, dtype=numpy.int64)
    place[tags] = numpy.arange(len(tags))
    return coordinates.reshape(-1, 3), place[corners].reshape(-1, 4), seconds


contract.run("gmsh", mesh)

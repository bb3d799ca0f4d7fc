#!/usr/bin/python3
"""Draws defects.png: two spheres with defects, as `delmesher check --defects FILE.vtu` colours them, read and drawn by VTK as ParaView does.

Usage: docs/defects_picture.py DELMESHER FOLDER     Needs Debian's python3-vtk9, and xvfb-run where there is no screen; FOLDER gets the surface, the .vtu and the picture.
"""
import math
import os
import subprocess
import sys

import vtk

COLOURS = {0: (0.82, 0.82, 0.8), 5: (0.98, 0.6, 0.1), 6: (0.6, 0.25, 0.75), 8: (0.2, 0.35, 0.86), 9: (0.16, 0.63, 0.27), 10: (0.86, 0.16, 0.16)}


def sphere(points, triangles, centre, radius, hole=()):
    """Twelve rings of twenty; without the squares of the hole."""
    first, around, rings = len(points), 20, 12

    def corner(i, j):
        return first + (i > 0) if i in (0, rings) else first + 2 + (i - 1) * around + j % around

    places = [(0, 0), (math.pi, 0)] + [(math.pi * i / rings, 2 * math.pi * (j + 0.3) / around) for i in range(1, rings) for j in range(around)]
    points += [(centre[0] + radius * math.sin(t) * math.cos(p), centre[1] + radius * math.sin(t) * math.sin(p), centre[2] + radius * math.cos(t))
               for t, p in places]
    for i, j in ((i, j) for i in range(rings) for j in range(around) if (i, j) not in hole):
        a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
        triangles += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]


def write_surface(path):
    """Spheres that overlap; a hole, a triangle that is there twice, and one that is turned round."""
    points, triangles = [], []
    sphere(points, triangles, (0, 0, 0), 1, hole={(5, 14), (5, 15), (6, 14)})
    sphere(points, triangles, (1.1, 0.25, 0.1), 0.8)
    triangles.append(triangles[697])
    triangles[653] = triangles[653][::-1]
    with open(path, "w") as file:
        file.writelines("v %r %r %r\n" % p for p in points)
        file.writelines("f %d %d %d\n" % tuple(v + 1 for v in t) for t in triangles)


def draw(vtu, png):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(vtu)
    reader.Update()
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(11)
    table.Build()
    for value in range(11):
        table.SetTableValue(value, *COLOURS.get(value, (0, 0, 0)))
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(reader.GetOutput())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SetColorModeToMapScalars()  # small numbers would be colours themselves
    mapper.SelectColorArray("defect")
    mapper.SetScalarRange(0, 10)
    mapper.SetLookupTable(table)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    for name, value in (("EdgeVisibility", True), ("EdgeColor", (0.45, 0.45, 0.45)), ("LineWidth", 2)):
        getattr(actor.GetProperty(), "Set" + name)(*value if isinstance(value, tuple) else (value,))
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    renderer.GetActiveCamera().SetPosition(2.2, -6, 2.2)
    renderer.GetActiveCamera().SetFocalPoint(0.5, 0, 0)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    renderer.GetActiveCamera().Zoom(1.75)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(640, 400)
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(png)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    surface, vtu, png = (os.path.join(sys.argv[2], "defects." + e) for e in ("obj", "vtu", "png"))
    write_surface(surface)
    subprocess.run([sys.argv[1], "check", surface, "--defects", vtu], stderr=subprocess.DEVNULL)  # ends with 4: it is not valid
    draw(vtu, png)


if __name__ == "__main__":
    main()

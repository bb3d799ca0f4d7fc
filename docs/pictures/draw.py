#!/usr/bin/python3
"""Draws the pictures of this folder from files that delmesher writes, each for light and for dark pages.

Usage: docs/pictures/draw.py DELMESHER FOLDER     Without a screen: xvfb-run -a. Needs `ci/install_packages pictures solver models`. FOLDER gets surfaces, meshes and pictures.

gear.*     a surface, and its mesh cut open, tetrahedra coloured by their smallest dihedral angle
sizes.*, budgets.*, surface.*, tolerance.*, planar.*, improve.*  its meshes by the options of these guides
names.*    its faces, as `--label-by-angle` labels them
stages.*   a surface, what chamfering leaves of it, the refined mesh of that, the final mesh
defects.*  a surface with defects, as `delmesher check --defects FILE.vtu` colours it
models.*   ten models of CGAL's archive (ci/campaigns/demo_models), cut open
solvers.*  what five solvers find on the same mesh (ci/full/solver_check)
"""
import os
import subprocess
import sys

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

sys.dont_write_bytecode = True
import models  # noqa: E402

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
PAGES = {"light": ((1, 1, 1), (0.12, 0.14, 0.16), (0.80, 0.83, 0.87)), "dark": ((0.051, 0.067, 0.09), (0.90, 0.93, 0.95), (0.55, 0.60, 0.66))}
STOPS = ((0, 0.75, 0.10, 0.12), (10, 0.96, 0.49, 0.15), (25, 0.99, 0.84, 0.35), (40, 0.55, 0.82, 0.55), (60, 0.10, 0.53, 0.65))  # degrees, colour


def colours():
    table = vtk.vtkColorTransferFunction()
    for stop in STOPS:
        table.AddRGBPoint(*stop)
    return table


def read_mesh(path):
    """Points, tetrahedra and boundary triangles of a .vtu of ours, and the smallest dihedral angle of each tetrahedron."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    quality = vtk.vtkMeshQuality()
    quality.SetInputConnection(reader.GetOutputPort())
    quality.SetTetQualityMeasureToMinAngle()
    quality.Update()
    grid = quality.GetOutput()
    cells, types = vtk_to_numpy(grid.GetCells().GetConnectivityArray()), vtk_to_numpy(grid.GetCellTypesArray())
    count = int((types == vtk.VTK_TETRA).sum())  # they come first
    return (vtk_to_numpy(grid.GetPoints().GetData()), cells[:4 * count].reshape(-1, 4), cells[4 * count:].reshape(-1, 3),
            vtk_to_numpy(grid.GetCellData().GetArray("Quality"))[:count])


def read_off(path):
    with open(path) as file:
        words = " ".join(line.split("#")[0] for line in file).split()
    n, m = int(words[1]), int(words[2])
    points = numpy.array(words[4:4 + 3 * n], float).reshape(-1, 3)
    polygons, at = [], 4 + 3 * n
    for _ in range(m):
        size = int(words[at])
        polygons.append([int(v) for v in words[at + 1:at + 1 + size]])
        at += 1 + size
    return points, polygons


def cut(mesh, keep):
    """Faces around the tetrahedra to keep: those of the surface, the others, and the quality behind the others."""
    points, tetrahedra, boundary, quality = mesh
    kept = numpy.flatnonzero(keep(points[tetrahedra].mean(axis=1)))
    corners = tetrahedra[kept]
    faces = numpy.concatenate([corners[:, f] for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    behind = numpy.tile(quality[kept], 4)
    _, index, counts = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = index[counts == 1]
    surface = {tuple(t) for t in numpy.sort(boundary, axis=1)}
    given = numpy.array([tuple(sorted(f)) in surface for f in faces[outer]], bool)
    return faces[outer[given]], faces[outer[~given]], behind[outer[~given]]


def actor(points, polygons, colour, values=None, line=1.0, line_colour=(0.2, 0.22, 0.25)):
    cells = vtk.vtkCellArray()
    for polygon in polygons:
        cells.InsertNextCell(len(polygon), [int(v) for v in polygon])
    data, places = vtk.vtkPolyData(), vtk.vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, float), deep=True))
    data.SetPoints(places)
    data.SetPolys(cells)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    if values is not None:
        data.GetCellData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values, float), deep=True))
        mapper.SetLookupTable(colours())
        mapper.UseLookupTableScalarRangeOn()
    drawn = vtk.vtkActor()
    drawn.SetMapper(mapper)
    look = drawn.GetProperty()
    look.SetColor(*colour)
    look.SetInterpolationToFlat()
    look.SetAmbient(0.25 if values is None else 0.6)
    look.SetDiffuse(0.8 if values is None else 0.5)
    look.SetSpecular(0.1)
    look.SetEdgeVisibility(line > 0)
    look.SetEdgeColor(*line_colour)
    look.SetLineWidth(line)
    return drawn


def panel(window, left, right, actors, page, camera, caption):
    """Draws the actors between two shares of the width, under a camera (position, up, half the height that it sees)."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(left, 0, right, 1)
    renderer.SetBackground(*page[0])
    for each in actors:
        renderer.AddActor(each)
    if camera:
        view = renderer.GetActiveCamera()
        view.ParallelProjectionOn()
        view.SetFocalPoint(*camera[0])
        view.SetPosition(*(a + b for a, b in zip(camera[0], camera[1])))
        view.SetViewUp(0, 0, 1)
        view.SetParallelScale(camera[2])
        renderer.ResetCameraClippingRange()
    text = vtk.vtkTextActor()
    text.SetInput(caption)
    style(text.GetTextProperty(), page)
    text.GetTextProperty().SetJustificationToCentered()
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.SetPosition(0.5, 0.03)
    renderer.AddActor2D(text)
    window.AddRenderer(renderer)
    return renderer


def style(text, page):
    text.SetFontFamilyToArial()
    text.SetFontSize(22)
    text.SetColor(*page[1])
    text.ShadowOff()
    text.BoldOff()
    text.ItalicOff()


def add_scale(window, left, page, caption):
    """The colours of the tetrahedra, right of the panels."""
    renderer = panel(window, left, 1, [], page, None, caption)
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours())
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.0f")
    bar.SetUnconstrainedFontSize(True)
    style(bar.GetLabelTextProperty(), page)
    bar.SetPosition(0.3, 0.22)
    bar.SetWidth(0.4)
    bar.SetHeight(0.6)
    renderer.AddActor2D(bar)


def save(window, path):
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    subprocess.run(["pngquant", "--force", "--speed", "1", "--strip", "--output", path, "256", path], check=True)  # a quarter of the bytes


def open_window(width, height):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(width, height)
    return window


def run(delmesher, *words):
    subprocess.run([delmesher, *words, "-q"], check=True)


GEAR = (0, 0, 0.19), (0.9, -3, 1.7), 0.86  # the camera
GUIDES = {  # what makes the two meshes of each picture
    "sizes": ("--max-edge 0.15", "--max-edge 0.15 --size-field sizes.txt"),
    "budgets": ("--surface split", "--budget 10000"),
    "surface": ("--surface keep", "--surface split"),
    "planar": ("--surface split --planar auto", "--surface split --planar 1e-9"),
    "tolerance": ("--surface keep", "--tolerance 5e-3d"),
    "improve": ("--surface split --improve off --slivers off", "improve"),
}


def draw_pair(folder, name, left, right, width=1200, height=440):
    """Two panels of the gear, each with its actors by page and a caption."""
    for light, page in PAGES.items():
        window = open_window(width, height)
        for at, (actors, caption) in ((0, left), (0.44, right)):
            panel(window, at, at + 0.44, actors(page), page, GEAR, caption)
        add_scale(window, 0.88, page, "smallest dihedral\nangle, degrees" if width > 1200 else "smallest\ndihedral\nangle")
        save(window, os.path.join(folder, "%s-%s.png" % (name, light)))


def cut_gear(path, caption):
    made = read_mesh(path)
    outside, inside, quality = cut(made, lambda c: c[:, 1] > -0.3)
    return lambda page: [actor(made[0], outside, page[2], line=0.7), actor(made[0], inside, page[2], quality, line=0.7)], caption


def draw_gear(delmesher, folder):
    surface, mesh, sizes = (os.path.join(folder, name) for name in ("gear.off", "gear.vtu", "sizes.txt"))
    models.write_off(surface, models.gear())
    with open(sizes, "w") as file:
        file.write("0.3 -0.4 0.3 0.03\n")
    run(delmesher, surface, "-o", mesh, "--surface", "split")
    draw_pair(folder, "gear", (lambda page: [actor(*read_off(surface), page[2])], "surface"), cut_gear(mesh, "mesh, cut open"), 1600, 580)
    turned = os.path.join(folder, "turned.off")
    models.write_off(turned, models.turned(models.gear()))
    scan = os.path.join(folder, "scan.off")
    models.write_off(scan, models.scan())
    for name, captions in GUIDES.items():
        panels = []
        for caption in captions:
            made = os.path.join(folder, "%s%d.vtu" % (name, len(panels)))
            given = [turned if name == "planar" else scan if name == "tolerance" else surface, *caption.replace("sizes.txt", sizes).split()]
            if caption == "improve":
                given = ["improve", os.path.join(folder, "improve0.vtu")]
            run(delmesher, *given, "-o", made)
            panels.append(cut_gear(made, caption))
        draw_pair(folder, name, *panels)


def draw_names(delmesher, folder):
    surface, faces = os.path.join(folder, "gear.off"), os.path.join(folder, "faces.vtu")
    subprocess.run([delmesher, "check", surface, "--label-by-angle", "30", "--defects", faces], check=True, stdout=subprocess.DEVNULL)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(faces)
    reader.Update()
    grid = reader.GetOutput()
    labels = vtk_to_numpy(grid.GetCellData().GetArray("label"))
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 3)
    for light, page in PAGES.items():
        window = open_window(700, 440)
        palette = [(0.10, 0.53, 0.65), (0.99, 0.84, 0.35), (0.55, 0.82, 0.55), (0.96, 0.49, 0.15), (0.75, 0.60, 0.80)]
        panel(window, 0, 1, [actor(vtk_to_numpy(grid.GetPoints().GetData()), corners[labels % 5 == k], palette[k], line=0.7) for k in range(5)],
              page, GEAR, "--label-by-angle 30")
        save(window, os.path.join(folder, "names-%s.png" % light))


def draw_stages(delmesher, folder):
    surface, chamfered, refined, final = (os.path.join(folder, "star" + e) for e in (".off", "-chamfered.off", "-refined.vtu", "-final.vtu"))
    models.write_off(surface, models.star())
    run(delmesher, surface, "-o", refined, "--approximate", "--save-chamfered", chamfered)
    run(delmesher, surface, "-o", refined, "--approximate", "--max-edge", "0.4")
    run(delmesher, surface, "-o", final, "--max-edge", "0.4", "--improve", "off")
    camera = (0, 0, -0.15), (1.6, -7, 1.6), 2.1
    for name, page in PAGES.items():
        window = open_window(1600, 420)
        for left, path, caption in ((0, surface, "surface"), (0.235, chamfered, "chamfered")):
            panel(window, left, left + 0.235, [actor(*read_off(path), page[2], line=1.5)], page, camera, caption)
        for left, path, caption in ((0.47, refined, "refined, cut open"), (0.705, final, "final, cut open")):
            made = read_mesh(path)
            outside, inside, quality = cut(made, lambda c: c[:, 1] > 0)
            panel(window, left, left + 0.235, [actor(made[0], outside, page[2]), actor(made[0], inside, page[2], quality)], page, camera, caption)
        add_scale(window, 0.94, page, "degrees")
        save(window, os.path.join(folder, "stages-%s.png" % name))


DEFECTS = {0: (0.82, 0.82, 0.8), 5: (0.98, 0.6, 0.1), 6: (0.6, 0.25, 0.75), 8: (0.2, 0.35, 0.86), 9: (0.16, 0.63, 0.27), 10: (0.86, 0.16, 0.16)}


def draw_defects(delmesher, folder):
    surface, defects = (os.path.join(folder, "defects" + e) for e in (".off", ".vtu"))
    models.write_off(surface, models.dirty_spheres())
    subprocess.run([delmesher, "check", surface, "--defects", defects], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # ends with 4: it is not valid
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(defects)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(11)
    table.Build()
    for value in range(11):
        table.SetTableValue(value, *DEFECTS.get(value, (0, 0, 0)))
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SetColorModeToMapScalars()  # small numbers would be colours themselves
    mapper.SelectColorArray("defect")
    mapper.SetScalarRange(0, 10)
    mapper.SetLookupTable(table)
    drawn = vtk.vtkActor()
    drawn.SetMapper(mapper)
    drawn.GetProperty().SetEdgeVisibility(True)
    drawn.GetProperty().SetEdgeColor(0.45, 0.45, 0.45)
    drawn.GetProperty().SetLineWidth(2)
    for name, page in PAGES.items():
        window = open_window(640, 400)
        panel(window, 0, 1, [drawn], page, ((0.45, 0, 0), (1.7, -6, 2.2), 1.1), "")
        save(window, os.path.join(folder, "defects-%s.png" % name))


MODELS = ("elephant", "rotor_small", "triceratops", "knot2", "anchor", "helmet", "fandisk", "femur", "couplingdown", "homer")


def draw_models(delmesher, folder):
    archive = os.path.join(folder, "demo")
    subprocess.run([os.path.join(ROOT, "ci", "campaigns", "demo_models"), archive], check=True)
    meshes = {}
    for name in MODELS:
        made = os.path.join(folder, name + ".vtu")
        run(delmesher, os.path.join(archive, "data", "meshes", name + ".off"), "-o", made)
        meshes[name] = read_mesh(made)
    for light, page in PAGES.items():
        window = open_window(1600, 660)
        for number, (name, made) in enumerate(meshes.items()):
            # Flat sides up to the viewer: the axis of least extent looks at him, the longest one goes across.
            low, high = made[0].min(axis=0), made[0].max(axis=0)
            axes = numpy.argsort(low - high)[[0, 2, 1]]
            points = ((made[0] - (low + high) / 2) / (high - low).max())[:, axes]
            if numpy.linalg.det(numpy.eye(3)[axes]) < 0:
                points[:, 1] *= -1
            outside, inside, quality = cut((points, *made[1:]), lambda c: c[:, 1] > 0.1 * c[:, 0])
            left, low = number % 5 * 0.187, 0.5 - number // 5 * 0.5
            renderer = panel(window, left, left + 0.187, [actor(points, outside, page[2], line=0.5), actor(points, inside, page[2], quality, line=0.5)],
                             page, ((0, 0, -0.06), (0.8, -3, 1), 0.66), "%s, %d" % (name, len(made[1])))
            renderer.SetViewport(left, low, left + 0.187, low + 0.5)
        add_scale(window, 0.935, page, "degrees")
        save(window, os.path.join(folder, "models-%s.png" % light))


def draw_solvers(delmesher, folder):
    results, build = os.path.join(folder, "solvers"), os.path.dirname(os.path.dirname(os.path.realpath(delmesher)))
    subprocess.run([os.path.join(ROOT, "ci", "full", "solver_check"), build, results], check=True, stdout=subprocess.DEVNULL)
    camera, names = ((0, 0, -0.12), (1.5, -6, 2.5), 1.25), ("CalculiX", "GetDP", "FreeFEM", "scikit-fem", "sfepy")
    for light, page in PAGES.items():
        window = open_window(1600, 380)
        for number, name in enumerate(names):
            reader = vtk.vtkXMLUnstructuredGridReader()
            reader.SetFileName(os.path.join(results, name + ".vtu"))
            reader.Update()
            grid = reader.GetOutput()
            points, tetrahedra = vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
            heat = vtk_to_numpy(grid.GetPointData().GetArray("heat"))[tetrahedra].mean(axis=1)
            # Warm is red, as needles are in the other pictures.
            _, inside, behind = cut((points, tetrahedra, numpy.zeros((0, 3), int), STOPS[-1][0] * (1 - heat)), lambda c: c[:, 1] > 0)
            panel(window, number / 5, (number + 1) / 5, [actor(points, inside, page[2], behind, line=0.7)], page, camera, name)
        save(window, os.path.join(folder, "solvers-%s.png" % light))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    os.makedirs(sys.argv[2], exist_ok=True)
    draw_gear(*sys.argv[1:])
    draw_names(*sys.argv[1:])
    draw_stages(*sys.argv[1:])
    draw_defects(*sys.argv[1:])
    draw_models(*sys.argv[1:])
    draw_solvers(*sys.argv[1:])


if __name__ == "__main__":
    main()

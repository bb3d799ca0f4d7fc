"""What the scripts have in common that call meshers by their Python packages (ci/campaigns/peers installs them).

A script is called as PYTHON SCRIPT SWITCHES INPUT OUTPUT.vtu STATS.json, as the programs of corpus/peers/programs are, with `tetproof` in
$TETPROOF; with --version alone it tells the package and its version, without loading it. Arrays go to the mesher and come from it in
memory; the model is read by `tetproof convert`, so that all see the same doubles, and the mesh is written in binary, as the same doubles.
Exit codes: 0 done, 2 usage, 4 refused with a line of why, 5 out of memory.
"""
import importlib.metadata
import json
import os
import subprocess
import sys
import tempfile
import time


class Model:
    """vertices: n x 3 doubles; triangles: m x 3, from 0; shell: m, the shell of each triangle, from 0; solids: a list of lists of shells,
    the outer one first, then those of its cavities."""


class Refused(Exception):
    """The mesher refuses the model, and says why."""


def read(path):
    import numpy

    model = Model()
    with tempfile.TemporaryDirectory(dir=".") as folder:
        surface, solids = os.path.join(folder, "surface.mesh"), os.path.join(folder, "solids")
        done = subprocess.run([os.environ["TETPROOF"], "convert", path, surface, "--solids", solids], capture_output=True, text=True)
        if done.returncode != 0:
            sys.stderr.write(done.stderr)
            sys.exit(3)
        with open(surface, encoding="ascii") as stream:
            text = stream.read()
        with open(solids, encoding="ascii") as stream:
            model.solids = [[int(word) - 1 for word in line.split()] for line in stream if line.strip()]
    vertices, rest = text.split("Vertices", 1)[1].split("Triangles", 1)
    vertices = vertices.split()
    triangles = rest.split("End", 1)[0].split()
    model.vertices = numpy.array(vertices[1:], dtype=float).reshape(-1, 4)[:, :3].copy()
    cells = numpy.array(triangles[1:], dtype=numpy.int64).reshape(-1, 4)
    model.triangles = cells[:, :3] - 1
    model.shell = cells[:, 3] - 1
    return model


def outwards(model):
    """The triangles, each oriented away from the inside as parity has it: a surface may have some of its shells the other way round."""
    import numpy

    triangles = model.triangles.copy()
    a, b, c = (model.vertices[triangles[:, i]] - model.vertices[triangles[0, 0]] for i in range(3))
    volumes = numpy.bincount(model.shell, weights=(a * numpy.cross(b, c)).sum(axis=1))
    for outer, *cavities in model.solids:
        for shell, sign in [(outer, 1)] + [(cavity, -1) for cavity in cavities]:
            if sign * volumes[shell] < 0:
                triangles[model.shell == shell] = triangles[model.shell == shell][:, [0, 2, 1]]
    return triangles


def arguments(words):
    """Of names and values, as epsilon=1e-3 threads=1 coarsen=True; words that are neither a number nor a truth stay words. None of "-"."""
    values = {}
    for word in words:
        if word == "-":
            continue
        name, value = word.split("=")
        if value in ("True", "False"):
            values[name] = value == "True"
        elif value.lstrip("-").isdigit():
            values[name] = int(value)
        else:
            try:
                values[name] = float(value)
            except ValueError:
                values[name] = value
    return values


def determinants(vertices, tetrahedra):
    import numpy

    edges = vertices[tetrahedra[:, 1:]] - vertices[tetrahedra[:, :1]]
    return numpy.linalg.det(edges) if len(edges) else numpy.zeros(0)


def oriented(vertices, tetrahedra):
    """Some meshers order corners the other way round. All are turned or none, so that what the mesher inverted stays visible."""
    if 2 * (determinants(vertices, tetrahedra) > 0).sum() < len(tetrahedra):
        return tetrahedra[:, [0, 1, 3, 2]]
    return tetrahedra


def write(path, vertices, tetrahedra):
    """An unstructured grid of VTK with appended arrays; vertices that no tetrahedron uses are left out."""
    import numpy

    used = numpy.zeros(len(vertices), dtype=bool)
    used[tetrahedra] = True
    tetrahedra = (numpy.cumsum(used) - 1)[tetrahedra]
    vertices = vertices[used]
    count = len(tetrahedra)
    arrays = [("Points", "Float64", "points", 3, numpy.ascontiguousarray(vertices, dtype="<f8")),
              ("Cells", "Int64", "connectivity", 1, numpy.ascontiguousarray(tetrahedra, dtype="<i8")),
              ("Cells", "Int64", "offsets", 1, 4 * numpy.arange(1, count + 1, dtype="<i8")),
              ("Cells", "UInt8", "types", 1, numpy.full(count, 10, dtype="u1"))]
    sections, offset = {"Points": "", "Cells": ""}, 0
    for section, kind, name, components, array in arrays:
        sections[section] += '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="appended" offset="%d"/>\n' % (
            kind, name, components, offset)
        offset += 8 + array.nbytes
    with open(path, "wb") as stream:
        stream.write(('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
                      'header_type="UInt64">\n<UnstructuredGrid>\n<Piece NumberOfPoints="%d" NumberOfCells="%d">\n'
                      '<Points>\n%s</Points>\n<Cells>\n%s</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding="raw">_' %
                      (len(vertices), count, sections["Points"], sections["Cells"])).encode())
        for *_, array in arrays:
            stream.write(len(array.tobytes()).to_bytes(8, "little"))
            stream.write(array.tobytes())
        stream.write(b"</AppendedData>\n</VTKFile>\n")


def run(package, mesh):
    """The whole script. `mesh(model, words)` is given the words of SWITCHES and returns vertices and tetrahedra, from 0."""
    if sys.argv[1:] == ["--version"]:
        try:
            print(package, importlib.metadata.version(package))
        except importlib.metadata.PackageNotFoundError:
            sys.exit("no package " + package)
        return
    if len(sys.argv) != 5:
        sys.exit("usage: %s SWITCHES INPUT OUTPUT.vtu STATS.json" % sys.argv[0])
    switches, source, output, statistics = sys.argv[1:]
    started = time.monotonic()
    model = read(source)
    have_read = time.monotonic()
    code, reason = 0, ""
    try:
        vertices, tetrahedra, seconds = mesh(model, switches.split())
        if len(tetrahedra) == 0:
            raise Refused("no tetrahedron")
        written = time.monotonic()
        write(output, vertices, oriented(vertices, tetrahedra))
        with open(statistics, "w", encoding="utf-8") as stream:
            json.dump({"status": "ok",
                       "input": {"vertices": len(model.vertices), "triangles": len(model.triangles)},
                       "phases_seconds": {"read": have_read - started, "tetrahedralize": seconds, "write": time.monotonic() - written},
                       "final": {"vertices": len(vertices), "tetrahedra": len(tetrahedra), "interior_tetrahedra": len(tetrahedra)}}, stream)
    except MemoryError:
        code, reason = 5, "out of memory"
    except Exception as error:  # whatever a package throws
        code, reason = 4, " ".join((str(error) or type(error).__name__).split())
    sys.stdout.flush()
    if reason:
        print("%s: %s" % (package, reason), file=sys.stderr, flush=True)
    # Without the end of the interpreter: what a package leaves behind is not to be judged here.
    os._exit(code)

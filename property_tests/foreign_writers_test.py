#!/usr/bin/python3
"""What another library writes as 3MF is read: lib3mf, that of the consortium behind the format. Counts, coordinates, transforms, labels, names
and units. Where things are is also asked of lib3mf itself, which writes the same model as an STL with all transforms applied.

Usage: foreign_writers_test.py DELMESHER SCRATCH-FOLDER
"""
import ctypes
import os
import shutil
import struct
import subprocess
import sys
import unittest

DELMESHER, SCRATCH = sys.argv[1], sys.argv[2]
LIBRARY = ctypes.CDLL("lib3MF.so.1")
INCH, METER = 3, 5  # of its eModelUnit
POINTS = [(0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 5)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
# Rows as in the format: a point is a row before them, and the last one moves it. All numbers have few digits, so that floats hold them.
TURNED = [0, 1, 0, -1, 0, 0, 0, 0, 1, 10, 0, 0]
SHEARED = [0.5, 0, 0, 0.25, 2, 0, 0, 0, 1, 0, 20, 0.125]
MIRRORED = [1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, -30]
BACK = [1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0]
AWAY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 40, 0, 0]


def path(name):
    return os.path.join(SCRATCH, name)


def moved(points, transform):
    return [tuple(sum(p[i] * transform[3 * i + k] for i in range(3)) + transform[9 + k] for k in range(3)) for p in points]


def call(name, *arguments):
    code = getattr(LIBRARY, "lib3mf_" + name)(*arguments)
    if code:
        raise OSError("lib3mf_%s: error 0x%x" % (name, code & 0xffffffff))


def made(name, *arguments):
    """The last argument of the function, what it makes."""
    result = ctypes.c_void_p()
    call(name, *arguments, ctypes.byref(result))
    return result


def transform_of(numbers):
    """A row of lib3mf's fields is a coordinate of the result."""
    return ctypes.byref((ctypes.c_float * 12)(*[numbers[3 * i + k] for k in range(3) for i in range(4)])) if numbers else None


class Model:
    def __init__(self, unit):
        self.model = made("createmodel")
        call("model_setunit", self.model, ctypes.c_uint(unit))
        call("model_addmetadatautf8", self.model, b"Title", b"a title")

    def mesh(self, name):
        """A tetrahedron. Names are written as they are given: lib3mf 1.8 escapes nothing."""
        result = made("model_addmeshobject", self.model)
        if name:
            call("object_setnameutf8", result, name.encode())
        vertices = (ctypes.c_float * 12)(*[x for p in POINTS for x in p])
        triangles = (ctypes.c_uint * 12)(*[v for t in TRIANGLES for v in t])
        call("meshobject_setgeometry", result, vertices, ctypes.c_uint(4), triangles, ctypes.c_uint(4))
        return result

    def components(self, *objects):
        result = made("model_addcomponentsobject", self.model)
        for used, transform in objects:
            made("componentsobject_addcomponent", result, used, transform_of(transform))
        return result

    def build(self, used, transform=None):
        made("model_addbuilditem", self.model, used, transform_of(transform))

    def materials(self, *names):
        """Their group, and the number of each."""
        group, numbers = made("model_addbasematerialgroup", self.model), []
        for name in names:
            number = ctypes.c_uint()
            call("basematerial_addmaterialutf8", group, name.encode(), *[ctypes.c_ubyte(200)] * 3, ctypes.byref(number))
            numbers.append(number.value)
        identity = ctypes.c_uint()
        call("basematerial_getresourceid", group, ctypes.byref(identity))
        return identity.value, numbers

    def write(self, name):
        for kind in ("3mf", "stl"):
            writer = made("model_querywriter", self.model, kind.encode())
            call("writer_writetofileutf8", writer, path(name + "." + kind).encode())
        return path(name + ".3mf")


class Read:
    """What delmesher makes of a file: `repair` has nothing to mend, and writes what was read."""

    def __init__(self, file):
        told = subprocess.run([DELMESHER, "check", file, "-v"], capture_output=True, text=True)
        self.told, self.code = told.stdout + told.stderr, told.returncode
        subprocess.run([DELMESHER, "repair", file, "-q", "-o", file + ".ply"], check=True)
        with open(file + ".ply") as text:
            head, body = text.read().split("end_header\n")
        lines = [line.split() for line in body.splitlines()]
        self.names = dict(line.split(None, 3)[2:] for line in head.splitlines() if line.startswith("comment label "))
        count = next(int(line.split()[2]) for line in head.splitlines() if line.startswith("element vertex "))
        self.points = [tuple(map(float, line[:3])) for line in lines[:count]]
        self.triangles = [tuple(map(int, line[1:4])) for line in lines[count:]]
        self.labels = [int(line[4]) for line in lines[count:]]

    def corners(self):
        return [[self.points[v] for v in t] for t in self.triangles]


def stl_corners(file):
    with open(file, "rb") as stream:
        data = stream.read()
    numbers = [struct.unpack_from("<12f", data, 84 + 50 * i) for i in range(struct.unpack_from("<I", data, 80)[0])]
    return [[n[3:6], n[6:9], n[9:12]] for n in numbers]


def turned(triangles):
    """Each from its smallest corner on, so that the sense remains; in order."""
    result = []
    for corners in triangles:
        first = corners.index(min(corners))
        result.append(tuple(corners[first:] + corners[:first]))
    return sorted(result)


class Lib3mf(unittest.TestCase):
    def test_one_object(self):
        model = Model(INCH)
        model.build(model.mesh("only one"))
        read = Read(model.write("one"))
        self.assertEqual(read.code, 0, read.told)
        self.assertIn("coordinates are in the unit 'inch'", read.told)
        self.assertEqual((read.points, read.triangles, read.labels, read.names), (POINTS, TRIANGLES, [0] * 4, {}))

    def test_components_and_build_items_are_where_lib3mf_puts_them(self):
        model = Model(METER)
        part, plate = model.mesh("part one"), model.mesh("")
        group = model.components((part, TURNED), (plate, SHEARED))
        model.build(group, MIRRORED)
        model.build(part, AWAY)
        model.build(model.components((group, AWAY)))
        model.build(model.components((plate, MIRRORED)), BACK)  # no mirror image of it
        read = Read(model.write("placed"))
        self.assertEqual(read.code, 0, read.told)
        self.assertIn("coordinates are in the unit 'meter'", read.told)
        expected = [moved(moved(POINTS, t), MIRRORED) for t in (TURNED, SHEARED)] + [moved(POINTS, AWAY)]
        expected += [moved(moved(POINTS, t), AWAY) for t in (TURNED, SHEARED)]
        expected.append(moved(moved(POINTS, MIRRORED), BACK))
        self.assertEqual(read.points, [p for points in expected for p in points])
        self.assertEqual(len(read.triangles), 24)
        self.assertEqual(read.labels, [1] * 4 + [2] * 4 + [1] * 8 + [2] * 8)
        self.assertEqual(read.names["1"], "part one")
        self.assertRegex(read.names["2"], r"^object \d+$")
        # lib3mf does not turn the triangles of a mirror image, and they have to be for a solid (section 3.3 of the format's specification).
        theirs = turned(stl_corners(path("placed.stl")))
        ours = [c[::-1] if min(p[2] for p in c) < -10 else c for c in read.corners()]
        self.assertEqual(turned(ours), theirs)

    def test_materials_of_one_object_are_labels(self):
        model = Model(INCH)
        group, (steel, wood) = model.materials("steel, zinc", "wood")
        mesh = model.mesh("part")
        call("defaultpropertyhandler_setbasematerial", made("object_createdefaultpropertyhandler", mesh), *map(ctypes.c_uint, (group, steel)))
        handler = made("meshobject_createpropertyhandler", mesh)
        for triangle, material in ((0, wood), (2, wood), (3, steel)):
            call("propertyhandler_setbasematerial", handler, *map(ctypes.c_uint, (triangle, group, material)))
        model.build(mesh)
        read = Read(model.write("materials"))
        self.assertEqual(read.code, 0, read.told)
        self.assertEqual(read.labels, [1, 2, 1, 2])
        self.assertEqual(read.names, {"1": "wood", "2": "steel, zinc"})


if __name__ == "__main__":
    shutil.rmtree(SCRATCH, ignore_errors=True)
    os.makedirs(SCRATCH)
    unittest.main(argv=sys.argv[:1])

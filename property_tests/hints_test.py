#!/usr/bin/python3
"""Every hint of `delmesher check` that names a command: the command, run as named, mends the surface.

Usage: hints_test.py DELMESHER TETPROOF SCRATCH-FOLDER
"""
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest

DELMESHER, TETPROOF, SCRATCH = sys.argv[1:4]
CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def cube(x=0.0, y=0.0, z=0.0, size=1.0):
    return [(x + size * (v & 1), y + size * (v >> 1 & 1), z + size * (v >> 2)) for v in range(8)]


def bodies(*places, **size):
    points, triangles = [], []
    for place in places:
        triangles += [tuple(v + len(points) for v in t) for t in CUBE]
        points += cube(*place, **size)
    return points, triangles


def apart(points, triangles, shift=0.0):
    """Every triangle with vertices of its own, moved by a different multiple of the shift."""
    soup = [tuple(x + shift * ((3 * i + k) % 5) for x in points[v]) for i, t in enumerate(triangles) for k, v in enumerate(t)]
    return soup, [(i, i + 1, i + 2) for i in range(0, len(soup), 3)]


def voxels(cells):
    """The surface of unit cubes in a grid, with one vertex at each place."""
    number, triangles = {}, []
    cells = set(cells)
    for cell in sorted(cells):
        for triangle in CUBE:
            corners = [tuple(c + (v >> k & 1) for k, c in enumerate(cell)) for v in triangle]
            normal = next(k for k in range(3) if len({p[k] for p in corners}) == 1)
            outwards = 1 if corners[0][normal] > cell[normal] else -1
            if tuple(c + outwards * (k == normal) for k, c in enumerate(cell)) not in cells:
                triangles.append(tuple(number.setdefault(p, len(number)) for p in corners))
    return list(number), triangles


def cases():
    """Name, the words of the hint, and a surface."""
    points, one = cube(), list(CUBE)
    yield "cracks", "vertices nearly coincide", apart(points, one, 1e-7)
    yield "soup", "vertices coincide", apart(points, one)
    yield "flat", "1 flat sheet", ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    crossed = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, -1, -1), (1, 3, -1), (1, 3, 1), (1, -1, 1)]
    yield "crossed sheets", "2 flat sheets", (crossed, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    yield "hole", "1 hole", (points, one[1:])
    yield "T-junction", "1 T-junction", (points + [(1, 0.5, 0.5)], one[:10] + [(1, 3, 8), (3, 7, 8), (1, 7, 5)])
    yield "twice", "mends triangles without area, duplicates and orientation", (points, one + one[:1])
    yield "turned", "mends triangles without area, duplicates and orientation", (points, [(0, 3, 2)] + one[1:])
    yield "without area", "mends triangles without area, duplicates and orientation", (points, one + [(0, 0, 1)])
    yield "double-sided", "a double-sided surface", (points, one + [(a, c, b) for a, b, c in one])
    second = [tuple(v + 8 if v & 1 else v + 1 for v in t) for t in one]
    yield "in triangles", "touch in 2 triangles", (points + cube(1), second + one)
    yield "edge", "touch along 1 edge", voxels([(0, 0, 0), (1, 1, 0)])
    yield "vertex", "touch at a vertex", voxels([(0, 0, 0), (1, 1, 1)])
    ball = set(itertools.product(range(3), repeat=3))
    yield "cavity", "touch along 1 edge", voxels(ball - {(1, 1, 1), (0, 0, 1)} | {(0, 1, 1), (1, 0, 1)})
    yield "on a side", "bodies touch, and do not cross", (bodies((0, 0, 0))[0] + cube(1, 0.25, 0.25, 0.5), bodies((0,), (1,))[1])
    yield "overlap", "if bodies overlap", bodies((0, 0, 0), (0.5, 0.25, 0.25))
    wall = voxels([(0, 0, 0), (1, 0, 0)])
    inner = [(wall[0].index((1, 0, 0)), wall[0].index((1, 1, 0)), wall[0].index((1, 1, 1))),
             (wall[0].index((1, 0, 0)), wall[0].index((1, 1, 1)), wall[0].index((1, 0, 1)))]
    sheet = [(0.5, -1, -1), (0.5, 2, -1), (0.5, 2, 2), (0.5, -1, 2)]
    yield "sheet", "sheet of 2 triangles meets", (points + sheet, one + [(8, 9, 10), (8, 10, 11)])
    yield "inner wall", "inner wall of 2 triangles", (wall[0], wall[1] + inner)


def graphs():
    """Name, the words of the hint, points and segments of a planar graph."""
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    yield "crossing", "makes a vertex of each crossing", square, ring + [(0, 2), (1, 3)]
    yield "overlapping", "cuts overlaps", square + [(2, 0)], ring + [(0, 4)]


def run(*command):
    return subprocess.run(command, capture_output=True, text=True)


def path(name):
    return os.path.join(SCRATCH, name.replace(" ", "_"))


class Hints(unittest.TestCase):
    def test_the_command_that_is_named_mends(self):
        seen = set()
        for name, words, (points, triangles) in cases():
            with self.subTest(name):
                given = path(name + ".off")
                with open(given, "w") as file:
                    file.write("OFF\n%d %d 0\n" % (len(points), len(triangles)))
                    file.writelines("%r %r %r\n" % tuple(map(float, p)) for p in points)
                    file.writelines("3 %d %d %d\n" % t for t in triangles)
                said = run(DELMESHER, "check", given)
                self.assertEqual(said.returncode, 4, said.stderr)
                hints = [line for line in said.stdout.split("\n") if line.startswith("  hint: ")]
                hint = [line for line in hints if words in line]
                self.assertEqual(len(hint), 1, said.stdout)
                if "flat sheet" in words:
                    self.assertNotIn("--fill", said.stdout)
                    in_plane = name == "flat"
                    self.assertEqual(run(DELMESHER, "plane", given, "-o", path(name + ".msh")).returncode, 0 if in_plane else 3)
                    self.assertNotIn("union", said.stdout)
                    continue
                for command in re.findall("`([^`]*)`", hint[0]):
                    program, *arguments = shlex.split(command)
                    seen.add((program, arguments[0]))
                    meshes = arguments[0] == "mesh"
                    result = path(name + (".msh" if meshes else ".mended.off"))
                    done = run({"delmesher": DELMESHER, "tetproof": TETPROOF}[program], *arguments, given, "-o", result)
                    self.assertEqual(done.returncode, 0, command + ": " + done.stderr + done.stdout)
                    verify = [TETPROOF, "verify", given, result, "--promised", " ".join(arguments)]
                    with_regions = ["mesh", "--regions", "all", "-o", path(name + ".msh")]
                    check = with_regions if "--walls" in arguments else ["check"]
                    checked = run(*verify) if meshes else run(DELMESHER, *check, result)
                    self.assertEqual(checked.returncode, 0, command + ": " + checked.stdout)
        self.assertEqual(seen, {("delmesher", "mesh"), ("delmesher", "repair"), ("tetproof", "union")})

    def test_planar_graphs(self):
        for name, words, points, segments in graphs():
            with self.subTest(name):
                given, mended = path(name + ".poly"), path(name + ".mended.poly")
                with open(given, "w") as file:
                    file.write("%d 2 0 0\n" % len(points))
                    file.writelines("%d %r %r\n" % (i, *p) for i, p in enumerate(points))
                    file.write("%d 0\n" % len(segments))
                    file.writelines("%d %d %d\n" % (i, *s) for i, s in enumerate(segments))
                    file.write("0\n")
                said = run(DELMESHER, "check", given, "--defects", path(name + ".vtu"))
                self.assertEqual(said.returncode, 4, said.stderr)
                self.assertIn("hint: `delmesher repair` ", said.stdout)
                self.assertIn(words, said.stdout)
                refused = run(DELMESHER, "plane", given, "-o", path(name + ".msh"))
                self.assertEqual((refused.returncode, "`delmesher repair`" in refused.stderr), (4, True), refused.stderr)
                self.assertEqual(run(DELMESHER, "repair", given, "-o", mended).returncode, 0)
                self.assertEqual(run(DELMESHER, "check", mended).returncode, 0)
                meshed = run(DELMESHER, "plane", mended, "-o", path(name + ".node"))
                self.assertEqual(meshed.returncode, 0, meshed.stderr)
                verified = run(TETPROOF, "verify", mended, path(name + ".node"), "--promised", "plane")
                self.assertEqual(verified.returncode, 0, verified.stdout + verified.stderr)


if __name__ == "__main__":
    shutil.rmtree(SCRATCH, ignore_errors=True)
    os.makedirs(SCRATCH)
    unittest.main(argv=sys.argv[:1])

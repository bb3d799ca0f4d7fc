#!/usr/bin/env python3
"""README.md must be short, its commands must work, and print what stands there; so must the commands of docs/, and C++ and C must compile.
Usage: readme_test.py DELMESHER TETPROOF COMPILER"""
import glob
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))


def read(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as stream:
        return stream.read()


README = read("README.md")
GUIDES = {os.path.basename(path): read(path) for path in sorted(glob.glob(os.path.join(ROOT, "docs", "*.md")))}
DELMESHER, TETPROOF, COMPILER = map(os.path.realpath, sys.argv[1:4])
CORNERS = [(v & 1, v >> 1 & 1, v >> 2) for v in range(8)]
CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def stl(triangles, place=lambda x, y, z: (x, y, z), name="part"):
    points = [place(*corner) for corner in CORNERS]
    return "solid %s\n%sendsolid\n" % (name, "".join(
        "facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %r %r %r\n" % points[v] for v in t) for t in triangles))


FILES = {
    "part.stl": stl(CUBE),
    "torn.stl": stl(CUBE[1:]),
    "scan.stl": stl(CUBE),
    "rotated.stl": stl(CUBE, lambda x, y, z: (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, z / 3)),
    "air.stl": stl(CUBE) + stl(CUBE, lambda x, y, z: (4 * x - 2, 4 * y - 2, 4 * z - 2)),
    "assembly.stl": stl(CUBE, name="copper") + stl(CUBE, lambda x, y, z: (x + 1, y, z), "air"),
    "ball.stl": "".join(stl(CUBE, lambda x, y, z, size=size: ((x - 0.5) * size, (y - 0.5) * size, (z - 0.5) * size), name)
                        for size, name in ((1, "hole"), (2, "core"), (3, "mantle"))),
    "outline.txt": "0 0\n4 0\n1 1\n0 4\n",
    "names.txt": "1 wall\n",
    "sizes.txt": "0 0 0 0.2\n",
}


def blocks_of(text, language=""):
    return [block for kind, block in re.findall(r"^```(\w*)\n(.*?)^```", text, re.M | re.S) if kind == language]


def blocks(section, language=""):
    return blocks_of(re.search(r"^## %s\n(.*?)(?=^## |\Z)" % re.escape(section), README, re.M | re.S).group(1), language)


def timeless(text):
    return re.sub(r"in \d+\.\d s;", "in 0.0 s;", text)


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        figure8 = os.path.join(ROOT, "corpus", "models", "figure8")
        for folder, program in (("corpus/models", figure8), ("build/mesher/bin", DELMESHER), ("bin", DELMESHER), ("bin", TETPROOF)):
            os.makedirs(os.path.join(cls.scratch.name, folder), exist_ok=True)
            os.symlink(program, os.path.join(cls.scratch.name, folder, os.path.basename(program)))
        for name, text in FILES.items():
            with open(os.path.join(cls.scratch.name, name), "w", encoding="utf-8") as stream:
                stream.write(text)
        cls.said = "".join(map(cls.run_line, blocks("Quick start")[0].strip().split("\n")[2:]))  # without installing and building

    @classmethod
    def run_line(cls, line, code=0):
        path = os.path.join(cls.scratch.name, "bin") + os.pathsep + os.environ["PATH"]
        done = subprocess.run(line, shell=True, cwd=cls.scratch.name, env=dict(os.environ, PATH=path), text=True, check=False, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        if done.returncode != code:
            raise AssertionError("%s: exit code %d: %s" % (line, done.returncode, done.stdout))
        return done.stdout

    def test_it_is_read_in_a_minute(self):
        self.assertLessEqual(len(README.encode()), 6144)

    def test_quick_start_prints_what_it_says(self):
        self.assertEqual(timeless(self.said), timeless(blocks("Quick start")[1]))

    def test_commands_work(self):
        self.run_line("delmesher part.stl -o part.msh")
        lines = blocks("Quick start")[2].strip().split("\n")
        self.assertGreater(len(lines), 4)
        for line in lines:
            self.run_line(re.split(r"  +", line)[0])

    def test_verify_prints_what_it_says(self):
        command, *lines = blocks("Is my mesh right?")[0].strip().split("\n")
        self.assertEqual(lines.pop(), "...")
        self.assertEqual(self.run_line(command[2:]).split("\n")[: len(lines)], lines)

    def test_commands_of_guides_work(self):
        self.run_line("delmesher part.stl -o part.msh")
        lines = [line for text in GUIDES.values() for block in blocks_of(text) if "OPTIONS" not in block and "PATH" not in block
                 for line in block.strip().split("\n")]
        self.assertGreater(len(lines), 25)
        for line in lines:
            self.run_line(re.split(r"  +", line)[0], int((re.findall(r"exit code (\d)", line) + ["0"])[0]))

    def compile(self, name, text):
        source = os.path.join(self.scratch.name, name)
        with open(source, "w", encoding="utf-8") as stream:
            stream.write(text)
        self.run_line("%s %s -fsyntax-only -I %s %s" % (COMPILER, "-std=c++20" if name.endswith("cpp") else "-x c", os.path.join(ROOT, "mesher"), source))

    def test_c_compiles(self):
        self.compile("guide.c", blocks_of(GUIDES["cpp.md"], "c")[0])

    def test_cpp_compiles(self):
        for text in blocks("C++", "cpp")[0], blocks_of(GUIDES["cpp.md"], "cpp")[0]:
            lines = text.split("\n")
            includes = "\n".join(line for line in lines if line.startswith("#"))
            body = "\n".join(line for line in lines if not line.startswith("#"))
            self.compile("readme.cpp", "%s\nint fail(const std::string&);\nint run() {\n%s\nreturn 0;\n}\n" % (includes, body))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

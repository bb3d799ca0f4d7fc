#!/usr/bin/env python3
"""README.md must be short, its commands must work, and print what stands there; its C++ must compile.
Usage: readme_test.py DELMESHER TETPROOF COMPILER"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), ".."))
with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as stream:
    README = stream.read()
DELMESHER, TETPROOF, COMPILER = map(os.path.realpath, sys.argv[1:4])
CORNERS = [(v & 1, v >> 1 & 1, v >> 2) for v in range(8)]
CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
FILES = {
    "part.stl": "solid part\n%sendsolid part\n" % "".join(
        "facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %d %d %d\n" % CORNERS[v] for v in t) for t in CUBE),
    "outline.txt": "0 0\n4 0\n1 1\n0 4\n",
}


def blocks(section, language=""):
    text = re.search(r"^## %s\n(.*?)(?=^## |\Z)" % re.escape(section), README, re.M | re.S).group(1)
    return re.findall(r"^```%s\n(.*?)^```" % re.escape(language), text, re.M | re.S)


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
    def run_line(cls, line):
        path = os.path.join(cls.scratch.name, "bin") + os.pathsep + os.environ["PATH"]
        done = subprocess.run(line, shell=True, cwd=cls.scratch.name, env=dict(os.environ, PATH=path), text=True, check=False, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        if done.returncode != 0:
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

    def test_cpp_compiles(self):
        lines = blocks("C++", "cpp")[0].split("\n")
        source = os.path.join(self.scratch.name, "readme.cpp")
        with open(source, "w", encoding="utf-8") as stream:
            includes = "\n".join(line for line in lines if line.startswith("#"))
            body = "\n".join(line for line in lines if not line.startswith("#"))
            stream.write("%s\nint fail(const std::string&);\nint run() {\n%s\nreturn 0;\n}\n" % (includes, body))
        self.run_line("%s -std=c++20 -fsyntax-only -I %s %s" % (COMPILER, os.path.join(ROOT, "mesher"), source))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

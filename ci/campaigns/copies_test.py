#!/usr/bin/env python3
"""Tests of what makes copies of models: tetproof vary and rotate, and ci/campaigns/varied. Usage: copies_test.py TETPROOF"""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
TETPROOF = None


def tetrahedron(height):
    return "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 %g\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n" % height


class Copies(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        for name, text in (("a/same.off", tetrahedron(1)), ("b/same.off", tetrahedron(2)), ("b/same.stl", "solid\nfacet"),
                           ("b/z.off", tetrahedron(3))):
            os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
            with open(self.path(name), "w", encoding="utf-8") as stream:
                stream.write(text)

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_all_are_there_whatever_they_are_called(self):
        for verb in ("vary", "rotate"):
            out = self.path(verb)
            done = subprocess.run([TETPROOF, verb, self.path("a"), self.path("b"), "-o", out], text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            names = os.listdir(out)
            self.assertEqual(sorted(n for n in names if "@" not in n), ["same-2.off", "same.off", "z.off"])
            given, copies = (int(w) for w in done.stdout.splitlines()[-1].split() if w.isdigit() and w != "1")
            self.assertEqual((given, given + copies), (3, len(names)), done.stdout)
            # The malformed one, which no other has to wait for.
            self.assertEqual(done.stdout.count("left out: same"), 1, done.stdout)

    def test_other_models_have_other_figures(self):
        environment = dict(os.environ, VARIED_BUILD=os.path.dirname(os.path.dirname(os.path.realpath(TETPROOF))),
                           VARIED_OUT=self.path("out"), VARIED_MESHERS="cdt")

        def rows(name):
            done = subprocess.run([ROOT + "/ci/campaigns/varied", self.path(name)], text=True, capture_output=True, check=False, env=environment)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            return [line.split()[-5:] for line in done.stdout.splitlines() if line.startswith("cdt ") and " turned " in line]

        self.assertEqual([rows(name)[0][0] for name in ("a", "b", "a")], ["2", "4", "2"])

    def test_wrong_arguments_are_named(self):
        for name in ("varied", "rotated"):
            for arguments, more, said in (([self.path("none")], {}, "none: no such file"), (["--help"], {}, "usage: "),
                                          ([], {name.upper() + "_CPU": "x"}, "_CPU: x is not a number above 0"),
                                          ([], {name.upper() + "_BUILD": "/none"}, "/none/bin/tetproof is missing")):
                done = subprocess.run([ROOT + "/ci/campaigns/" + name, *arguments], text=True, capture_output=True, check=False,
                                      env=dict(os.environ, **more))
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
                self.assertIn(said, done.stderr)


if __name__ == "__main__":
    TETPROOF = sys.argv.pop(1)
    unittest.main()

#!/usr/bin/env python3
"""Tests of ci/campaigns/valid_models, on made-up collections."""
import csv
import hashlib
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "valid_models")


class Links(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def model(self, *names):
        """A file with its path as content, and its row."""
        os.makedirs(os.path.dirname(self.path(*names)), exist_ok=True)
        text = "/".join(names).encode("utf-8", "replace").decode()
        with open(self.path(*names), "w", encoding="utf-8") as stream:
            stream.write(text)
        return {"file": os.path.join(*names[1:]), "sha256": hashlib.sha256(text.encode()).hexdigest(), "verdict": "valid"}

    def run_on(self, rows, *paths):
        with open(self.path("manifest.csv"), "w", newline="", encoding="utf-8", errors="surrogateescape") as stream:
            writer = csv.DictWriter(stream, ("file", "sha256", "verdict"))
            writer.writeheader()
            writer.writerows(rows)
        return subprocess.run([SCRIPT, self.path("manifest.csv"), self.path("out"), *map(self.path, paths)], text=True, capture_output=True,
                              check=False)

    def linked(self):
        """What each link leads to, by its name."""
        found = {}
        for parent, _, files in os.walk(self.path("out")):
            for name in files:
                with open(os.path.join(parent, name), encoding="utf-8") as stream:
                    found[os.path.relpath(os.path.join(parent, name), self.path("out"))] = stream.read()
        return found

    def test_no_model_is_lost_that_has_the_name_of_another(self):
        rows = [self.model("a", "x.off"), self.model("a", "sub", "x.off"), self.model("b", "x.off"), self.model("c", "x.off")]
        done = self.run_on(rows, "b", "a", "c/x.off")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.linked(), {"x.off": "a/x.off", "sub/x.off": "a/sub/x.off", "2/x.off": "b/x.off", "3/x.off": "c/x.off"})

    def test_a_folder_may_be_called_like_a_link(self):
        rows = [self.model("a", "x.off"), self.model("b", "x.off"), self.model("b", "2", "x.off", "y.off"), self.model("c", "2"),
                self.model("d", "2", "x.off")]
        done = self.run_on(rows, "a", "b", "c", "d")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(self.linked().values()), ["a/x.off", "b/2/x.off/y.off", "b/x.off", "c/2", "d/2/x.off"])

    def test_names_in_another_encoding(self):
        rows = [self.model("a", "Geh\udce4use.off")]
        done = self.run_on(rows, "a")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(os.listdir(self.path("out")), ["Geh\udce4use.off"])
        os.unlink(self.path("a", "Geh\udce4use.off"))
        self.assertEqual(self.run_on(rows, "a").returncode, 1)

    def test_only_what_is_valid(self):
        rows = [self.model("a", "17.off"), self.model("a", "part.off"), self.model("a", "18.off"), self.model("a", "19.off")]
        rows[2]["verdict"], rows[3]["verdict"] = "invalid", "undecided"
        done = self.run_on(rows, "a")
        self.assertEqual(sorted(self.linked()), ["17.off", "part.off"])
        self.assertTrue(done.stdout.startswith("4 models, 2 of them valid; 1 have names like those of Thingi10K"), done.stdout)

    def test_made_anew(self):
        rows = [self.model("a", "x.off"), self.model("a", "y.off")]
        self.run_on(rows, "a")
        self.run_on(rows[1:], "a")
        self.assertEqual(self.linked(), {"y.off": "a/y.off"})

    def test_a_folder_of_files_is_left_alone(self):
        rows = [self.model("a", "x.off")]
        self.model("out", "mine.off")
        done = self.run_on(rows, "a")
        self.assertEqual(done.returncode, 1)
        self.assertIn("mine.off is not a link", done.stderr)
        self.assertEqual(self.linked(), {"mine.off": "out/mine.off"})

    def test_what_has_gone_or_changed_is_named(self):
        rows = [self.model("a", "x.off"), self.model("a", "y.off")]
        os.unlink(self.path("a", "y.off"))
        self.assertIn("y.off of ", self.run_on(rows, "a").stderr)
        with open(self.path("a", "x.off"), "w", encoding="utf-8") as stream:
            stream.write("something else")
        done = self.run_on(rows[:1], "a")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("x.off of ", done.stderr)

    def test_what_is_there_stays_if_a_model_is_missing(self):
        rows = [self.model("a", "x.off"), self.model("a", "y.off")]
        self.run_on(rows, "a")
        os.unlink(self.path("a", "y.off"))
        self.run_on(rows, "a")
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["x.off", "y.off"])

    def test_no_manifest(self):
        for text in (b"", b"\xff\x00garbage", b"a,b\n1,2\n"):
            with open(self.path("manifest.csv"), "wb") as stream:
                stream.write(text)
            done = subprocess.run([SCRIPT, self.path("manifest.csv"), self.path("out"), self.path("a")], text=True, capture_output=True,
                                  check=False)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
        done = subprocess.run([SCRIPT, self.path("none.csv"), self.path("out"), self.path("a")], text=True, capture_output=True, check=False)
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1))


if __name__ == "__main__":
    unittest.main()

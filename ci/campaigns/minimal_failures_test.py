#!/usr/bin/env python3
"""Tests of ci/campaigns/minimal_failures: which failures it takes, what it drops, what --listed finds; and all of it on a mesher that fails where
a surface reaches to the left of the origin. Usage: minimal_failures_test.py [TETPROOF] (without it the last is left out)"""
import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "minimal_failures")
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("minimal_failures", SCRIPT)
minimal = importlib.util.module_from_spec(importlib.util.spec_from_loader("minimal_failures", loader))
loader.exec_module(minimal)
TETPROOF = None

TETRAHEDRON = ["OFF", "4 4 0", "0 0 0", "1 0 0", "0 1 0", "0 0 1", "3 0 2 1", "3 0 1 3", "3 1 2 3", "3 0 3 2"]


def run(name, disposition="rejected", reason="exit 1: no", size=1, path=None):
    return minimal.Run(name, path or name, size, disposition, disposition + ": " + reason.split(",")[0], reason, "1", "-")


class Kinds(unittest.TestCase):
    def test_families_are_names_without_numbers(self):
        self.assertEqual(minimal.family_of("d/ulp_parts-4-13.off"), "ulp_parts")
        self.assertEqual(minimal.family_of("32770-2.off"), "32770-2")

    def test_every_kind_comes_before_a_second_one(self):
        runs = [run("a-1-%d.off" % i, size=i) for i in range(5)] + [run("b-1-0.off", "crash", "SIGSEGV", 90), run("b-1-1.off", size=9)]
        names = [r.name for r in minimal.chosen(runs, 4)]
        # A member of another family before a smaller one of the same.
        self.assertEqual(names, ["a-1-0.off", "b-1-0.off", "b-1-1.off", "a-1-1.off"])
        self.assertEqual(len(minimal.chosen(runs, 50)), 7)


class StandIn:
    """Shrinks to a tetrahedron; what is run again ends as it is told."""

    def __init__(self, again, ours="ok"):
        self.ends = {"peer": again, minimal.OURS: ours}
        self.lines = [TETRAHEDRON[0], "# words", TETRAHEDRON[1], "0 0 0  # 0x0p+0 0x0p+0 0x0p+0"] + TETRAHEDRON[3:]

    def shrink(self, _, __, small):
        with open(small, "w", encoding="utf-8") as stream:
            stream.write("\n".join(self.lines) + "\n")
        return True

    def run_anew(self, paths, mesher, _):
        return [run(os.path.basename(paths[0]), self.ends[mesher], "exit 1: no, 7", path=paths[0])]


class MakingSmall(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def files(self):
        return sorted(f for f in os.listdir(self.scratch.name) if f.endswith(".off"))

    def make(self, harness, name="fan-1-2.off"):
        return minimal.make_small(harness, "peer", run(name, reason="exit 1: no, 12"), self.scratch.name)

    def test_what_lasts_is_kept(self):
        self.assertEqual(self.make(StandIn("rejected")), ("fan_refused", "4", "fan", "rejected: exit 1: no, 7"))
        with open(os.path.join(self.scratch.name, "fan_refused.off"), encoding="utf-8") as stream:
            self.assertEqual(stream.read().split("\n"),
                             TETRAHEDRON[:1] + ["# what tetproof shrink left of fan-1-2"] + TETRAHEDRON[1:] + [""])
        self.assertIsNone(self.make(StandIn("rejected"), "fan-1-3.off"))  # the same as the first

    def test_what_is_of_several_pieces_is_dropped(self):
        harness = StandIn("rejected")
        moved = ["5 0 0", "6 0 0", "5 1 0", "5 0 1"] + ["3 4 6 5", "3 4 5 7", "3 5 6 7", "3 4 7 6"]
        harness.lines = ["OFF", "8 8 0"] + TETRAHEDRON[2:6] + moved[:4] + TETRAHEDRON[6:] + moved[4:]
        self.assertIsNone(self.make(harness))
        self.assertEqual(self.files(), [])

    def test_what_is_kept_is_oriented_outwards(self):
        harness = StandIn("rejected")
        harness.lines = minimal.turned(TETRAHEDRON)
        self.assertEqual((minimal.outwards(TETRAHEDRON), minimal.outwards(harness.lines)), (True, False))
        self.make(harness)
        self.assertEqual(minimal.lines_of(os.path.join(self.scratch.name, "fan_refused.off")), TETRAHEDRON)

    def test_what_does_not_last_is_dropped(self):
        for harness in (StandIn("ok"), StandIn("timeout"), StandIn("rejected", "wrong-result")):
            self.assertIsNone(self.make(harness))
            self.assertEqual(self.files(), [])


class Listed(unittest.TestCase):
    def test_files_and_rows_have_to_agree(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, minimal.TABLE), "w", encoding="utf-8") as stream:
                stream.write("surface,triangles,from,what happens\na,4,fan,crash: SIGSEGV\nb,4,fan,timeout\nc,4,fan,oops\n")
            for name in ("a", "c", "d"):
                open(os.path.join(folder, name + ".off"), "w", encoding="utf-8").close()
            said = [line.split(": ", 1)[1] for line in minimal.differences(folder)]
            self.assertEqual(said, ["b is not there", "d is not in the table", "c: 'oops' begins with no disposition"])

    def test_the_project_lists_what_it_ships(self):
        self.assertEqual([line for folder in minimal.folders() for line in minimal.differences(folder)], [])
        self.assertGreater(sum(len(minimal.listed(folder)) for folder in minimal.folders()), 20)


class AllOfIt(unittest.TestCase):
    def test_a_mesher_that_fails_to_the_left(self):
        if TETPROOF is None:
            self.skipTest("no tetproof")
        binaries = os.path.dirname(os.path.realpath(TETPROOF))
        with tempfile.TemporaryDirectory() as scratch:
            program = os.path.join(scratch, "program")
            with open(program, "w", encoding="utf-8") as stream:
                stream.write("#!/bin/sh\n! grep -q '^-' \"$1\" || { echo 'reaches too far left' >&2; exit 1; }\nexec '%s/delmesher' cdt \"$1\" -o \"$2\" -q\n"
                             % binaries)
            os.chmod(program, 0o755)
            subprocess.run([TETPROOF, "generate", "star", "--seed", "1", "--count", "2", "-o", scratch + "/models"], check=True,
                           stdout=subprocess.DEVNULL)
            words = ["-m", "left=cmd,region=hull:%s {in} {out.mesh}" % program, "--count", "1", "--seconds", "10", "--build",
                     os.path.dirname(binaries), "--out", scratch + "/out", scratch + "/models"]
            done = subprocess.run([sys.executable, SCRIPT, *words], text=True, stdout=subprocess.PIPE, check=False)
            self.assertEqual(done.returncode, 0, done.stdout)
            with open(scratch + "/out/left/surfaces.csv", encoding="utf-8") as stream:
                rows = stream.read().split("\n")[1:-1]
            self.assertEqual(len(rows), 1, done.stdout)
            self.assertIn("rejected: exit 1: reaches too far left", rows[0])
            with open(scratch + "/out/left/star_refused.off", encoding="utf-8") as stream:
                lines = stream.read().split("\n")
            self.assertEqual(lines[2], "4 4 0")
            self.assertTrue(any(line.startswith("-") for line in lines[3:7]))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        TETPROOF = os.path.realpath(sys.argv.pop(1))
    unittest.main()

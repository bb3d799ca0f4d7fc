#!/usr/bin/env python3
"""readmes.py must catch a table that is wrong, and pass one that is right."""
import contextlib
import io
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import readmes  # noqa: E402

SOURCES = {
    "mesher/refine/goal.h": "struct Goal {\n  int badness(int t) const;\n};\nconstexpr int kWorst = 254;\n",
    "mesher/refine/goal.cpp": "int Goal::badness(int t) const {\n  // twisted(t)\n  return level_of(t);\n}\n",
    "mesher/refine/level.cpp": "static int level_of(int t) {\n  return t;\n}\nenum class Level { low };\n",
}
HEAD = readmes.HEAD + "\n|---|---|---|\n"
PROSE = readmes.PROSE + "\n|---|---|\n"

GOOD = {
    "a function": HEAD + "| how bad | `refine/goal.cpp` | `badness`, `Goal::badness` |",
    "a declaration in the header": HEAD + "| how bad | `refine/goal.cpp` | `Goal`, `kWorst` |",
    "a file beside the one before": HEAD + "| levels | `refine/goal.cpp`, `level.cpp` | `badness`, `level_of`, `Level` |",
    "no function": HEAD + "| levels | `refine/level.cpp` | |",
    "prose": PROSE + "| levels | `level_of` (`refine/level.cpp`), in the worst case `kWorst` (`mesher/refine/goal`); `goal_test` |",
    "another table": "| file |\n|---|\n| `gone.cpp`: `gone` |",
    "links": "[oracles](../oracles/README.md#what), [elsewhere](https://gone.example/x), ![goal](refine/goal.h)\n```\n[code](gone)\n```",
}
BAD = {
    "no such file": (HEAD + "| how bad | `refine/gone.cpp` | |", "no file refine/gone.cpp"),
    "no such function": (HEAD + "| how bad | `refine/goal.cpp` | `goodness` |", "goodness is not declared"),
    "only called": (HEAD + "| how bad | `refine/goal.cpp` | `level_of` |", "level_of is not declared"),
    "only in a comment": (HEAD + "| how bad | `refine/goal.cpp` | `twisted` |", "twisted is not declared"),
    "of another class": (HEAD + "| how bad | `refine/goal.cpp` | `Level::badness` |", "Level::badness is not declared"),
    "two cells": (HEAD + "| how bad | `refine/goal.cpp` |", "three cells"),
    "prose about no file": (PROSE + "| levels | `level_of` says it |", "level_of is in no file"),
    "a link that leads nowhere": ("\n\n[goals](refine/goals.h#what)", "a link leads nowhere: refine/goals.h"),
    "prose about a file that is gone": (PROSE + "| levels | `Goal::badness` (`refine/goals.cpp`) |", "no file refine/goals.cpp"),
}


def complaints(readme, path="mesher/README.md"):
    """The exit code, and what is printed about a tree with this text at the path."""
    with tempfile.TemporaryDirectory() as root:
        right = {"oracles/README.md": GOOD["a function"].replace("refine/", "../mesher/refine/")}
        for path, text in {**SOURCES, **right, path: readme}.items():
            os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
            with open(os.path.join(root, path), "w", encoding="utf-8") as stream:
                stream.write(text + "\n")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            code = readmes.check_all(root)
        return code, said.getvalue()


class CheckReadmes(unittest.TestCase):
    def test_right_tables_pass(self):
        for name, readme in GOOD.items():
            with self.subTest(name):
                self.assertEqual(complaints(readme), (0, ""))

    def test_wrong_tables_do_not(self):
        for name, (readme, reason) in BAD.items():
            with self.subTest(name):
                code, said = complaints(readme)
                self.assertEqual(code, 1)
                self.assertIn("mesher/README.md:3: ", said)
                self.assertIn(reason, said)

    def test_files_that_contributing_names_have_to_exist(self):
        self.assertEqual(complaints("`refine/goal.cpp`, `mesher/refine/goal.h`, `goal.cpp`, `refine/*.h`", "CONTRIBUTING.md"), (0, ""))
        self.assertEqual(complaints("`refine/goals.cpp`", "CONTRIBUTING.md"), (1, "CONTRIBUTING.md:1: there is no file refine/goals.cpp\n"))

    def test_a_tree_without_tables_does_not(self):
        with tempfile.TemporaryDirectory() as root, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(readmes.check_all(root), 1)


if __name__ == "__main__":
    unittest.main()

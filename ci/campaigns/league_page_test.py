#!/usr/bin/env python3
"""Tests of ci/campaigns/league_page, on made-up campaigns whose numbers can be worked out by hand; and on a real one if there is a program to make
it. Usage: league_page_test.py [TETPROOF] (without it the last is left out)"""
import contextlib
import csv
import importlib.machinery
import importlib.util
import io
import json
import os
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
sys.dont_write_bytecode = True
SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "league_page")
loader = importlib.machinery.SourceFileLoader("league_page", SCRIPT)
league = importlib.util.module_from_spec(importlib.util.spec_from_loader("league_page", loader))
loader.exec_module(league)
TETPROOF = None

COLUMNS = ("model_sha256", "mesher", "version", "flags", "limits", "model_name", "disposition", "reason", "cpu_seconds", "peak_rss_bytes",
           "mesh_json", "verdict_json", "promise")


def row(model, mesher, disposition="ok", reason="", version="peer 1.2 (build 00)", limits="60 s", cpu=1.0, solver=None,
        rss=3 << 20, **mesh):
    measured = {"tetrahedra": 100, "min_dihedral": 10.0, "dihedral_1_percent": 12.0, "min_face_angle": 9.0, "mean_gamma": 0.5}
    measured.update(mesh)
    if solver:
        measured["solver"] = solver
    return {"model_sha256": model[-1] * 64, "mesher": mesher, "version": version, "flags": "-x", "limits": limits, "model_name": model + ".off",
            "disposition": disposition, "reason": reason, "cpu_seconds": cpu, "peak_rss_bytes": rss,
            "mesh_json": json.dumps(measured) if disposition in ("ok", "wrong-result") else "",
            "verdict_json": json.dumps({"verdict": "exact"}) if disposition == "ok" else "", "promise": "exact"}


def rows_under(text, title):
    """The cells of the first table below a headline, by their heads; equal heads get a number."""
    lines = text[text.index("## " + title):].split("\n")
    start = next(i for i, line in enumerate(lines) if line.startswith("| "))
    heads = []
    for head in lines[start].strip("| ").split(" | "):
        heads.append(head if head not in heads else head + " 2")
    found = []
    for line in lines[start + 2:]:
        if not line.startswith("|"):
            break
        found.append(dict(zip(heads, (c.strip() for c in line.strip()[1:-1].split("|")))))
    return found


class Pages(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.families = self.path("families.csv")
        with open(self.families, "w", encoding="utf-8") as stream:
            stream.write("# comment\nfan-*,generated\n*bunny*,scans\nbunny_fan-*,never\n")
        self.count = 0

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def campaign(self, *rows):
        self.count += 1
        path = self.path("runs%d.sqlite" % self.count)
        connection = sqlite3.connect(path)
        connection.execute("create table runs (id integer primary key, %s)" % ", ".join(COLUMNS))
        for each in rows:
            connection.execute("insert into runs (%s) values (%s)" % (", ".join(COLUMNS), ", ".join("?" * len(COLUMNS))),
                               [each[c] for c in COLUMNS])
        connection.commit()
        connection.close()
        return path

    def page(self, *arguments, commit="c0ffee"):
        self.assertEqual(league.main([*arguments, "-o", self.path("page.md"), "--families", self.families, "--commit", commit]), 0)
        with open(self.path("page.md"), encoding="utf-8") as stream:
            return stream.read()

    def runs(self, name="page.csv"):
        with open(self.path(name), newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_a_row_per_mesher_the_most_successful_first(self):
        text = self.page(self.campaign(
            row("fan-1", "delmesher", cpu=1), row("fan-2", "delmesher", cpu=3), row("bunny-3", "delmesher", cpu=7),
            row("fan-1", "tetgen"), row("fan-2", "tetgen", "crash", "SIGSEGV"), row("bunny-3", "tetgen", "unverified", "limit")))
        found = rows_under("## x\n" + text, "x")
        self.assertEqual([r["Mesher"] for r in found], ["`delmesher`", "`tetgen`"])
        # (1 + z^2/2 -+ z sqrt(2/3 + z^2/4)) / (3 + z^2) for z = 1.96, and 1 / (1 + z^2 / 3)
        self.assertEqual(found[1]["Ok, % (95 % interval)"], "33.3 (6.1 to 79.2)")
        self.assertEqual(found[0]["Ok, % (95 % interval)"], "100.0 (43.9 to 100.0)")
        self.assertEqual([found[1][d] for d in ("Ok", "crash", "unverified")], ["1", "1", "1"])
        self.assertNotIn("timeout", found[1])  # nothing ended like that
        self.assertEqual([found[0]["s"], found[0]["s, 95 %"]], ["3.00", "6.60"])
        self.assertEqual(found[0]["MB"], "3")

    def test_limits_that_differ_are_made_equal(self):
        wide, narrow = "wall 6000 s, cpu 600 s, memory 12000 MiB", "wall 400 s, cpu 20 s, memory 2 MiB"
        text = self.page(self.campaign(
            row("fan-1", "delmesher", limits=wide, cpu=21), row("fan-2", "delmesher", limits=wide, cpu=20, rss=2 << 20),
            row("bunny-3", "delmesher", limits=wide, cpu=21, disposition="wrong-result"), row("x4", "delmesher", limits=wide, rss=3 << 20),
            row("fan-2", "tetgen", limits=narrow, cpu=5, rss=1 << 20)))
        self.assertIn("the least of them, 20 s of processor time and 2 MiB, counts", text)
        (_, ours) = rows_under("## x\n" + text, "x")
        self.assertEqual([ours[h] for h in ("Runs", "Ok", "timeout", "out-of-memory", "ok under its own limits")], ["4", "1", "2", "1", "3"])
        self.assertNotIn("wrong-result", ours)
        # What is kept run by run is what happened.
        self.assertEqual([r["disposition"] for r in self.runs() if r["mesher"] == "delmesher"], ["wrong-result", "ok", "ok", "ok"])

    def test_equal_limits_have_no_column_of_their_own(self):
        text = self.page(self.campaign(row("fan-1", "delmesher", cpu=70), row("fan-1", "tetgen")))
        self.assertNotIn("own limits", text)
        self.assertIn("under the same limits", text)

    def test_only_what_is_inside_counts(self):
        self.page(self.campaign(row("fan-1", "tetgen", min_dihedral=1, inside={"tetrahedra": 7, "min_dihedral": 20.5})))
        self.assertEqual([self.runs()[0][f] for f in ("tetrahedra", "min_dihedral", "mean_gamma")], ["7", "20.5", ""])

    def test_the_oracles_tell_what_is_inside_if_the_file_does_not(self):
        figures = {"smallest dihedral angle": 20.5, "1 % quantile of smallest dihedral angles": 21, "smallest face angle": 22, "mean gamma": 0.5}
        whole = row("fan-1", "published-e4", tetrahedra=90, min_dihedral=1)
        whole["verdict_json"] = json.dumps({"verdict": "exact", "oracles": [
            {"name": "angles", "checked": 7, "checked_what": "tetrahedra inside", "figures": figures}]})
        self.page(self.campaign(whole))
        self.assertEqual([(r["tetrahedra"], r["min_dihedral"]) for r in self.runs()], [("7", "20.5")])

    def test_a_wrong_mesh_has_no_angles(self):
        self.page(self.campaign(row("fan-1", "netgen", "wrong-result", "verify: broken: conformity: edge\n1-2")))
        self.assertEqual([self.runs()[0][f] for f in ("tetrahedra", "min_dihedral", "reason")],
                         ["", "", "verify: broken: conformity: edge 1-2"])

    def test_groups_are_compared_on_what_all_of_them_mesh(self):
        text = self.page(self.campaign(
            row("fan-1", "delmesher", tetrahedra=10), row("fan-2", "delmesher", tetrahedra=1000), row("bunny-3", "delmesher", tetrahedra=30),
            row("fan-1", "netgen", tetrahedra=40), row("fan-2", "netgen", "timeout"), row("bunny-3", "netgen", tetrahedra=60),
            row("fan-2", "gmsh-hxt-raw")))
        self.assertIn("Those optimized, on the 2 models", text)
        self.assertNotIn("Those without", text)  # one alone
        self.assertEqual([r["tets"] for r in rows_under(text, "On the same models")], ["20", "50"])

    def test_pairs_tell_who_succeeds_alone(self):
        text = self.page(self.campaign(
            row("fan-1", "delmesher", tetrahedra=10, min_dihedral=12), row("fan-2", "delmesher", "timeout"), row("bunny-3", "delmesher"),
            row("bunny-4", "delmesher", tetrahedra=100, min_dihedral=5), row("bunny-5", "delmesher"),
            row("fan-1", "netgen", tetrahedra=30, min_dihedral=11), row("fan-2", "netgen"), row("bunny-3", "netgen", "rejected", "no"),
            row("bunny-4", "netgen", tetrahedra=50, min_dihedral=6)))
        (found,) = rows_under(text, "Each beside ours")
        self.assertEqual([found[h] for h in ("Models", "only ours ok", "only it ok", "both ok")], ["4", "1", "1", "2"])
        self.assertEqual(found["tets, it / ours"], "1.75")  # the middle of 3 and 0.5
        self.assertEqual([found["min dihedral, ours"], found["it"]], ["8.5", "8.5"])
        self.assertEqual(found["smallest dihedral larger with ours, %"], "50")

    def test_the_first_pattern_decides_on_a_family(self):
        text = self.page(self.campaign(row("bunny_fan-1", "cdt"), row("fan-2", "cdt", "timeout"), row("x3", "cdt")))
        self.assertEqual({r["Family"]: r["`cdt`"] for r in rows_under(text, "By family")}, {"scans": "1/1", "generated": "0/1", "other": "1/1"})

    def test_failures_of_a_kind_are_counted_together(self):
        text = self.page(self.campaign(row("fan-1", "netgen", "rejected", "fan-1.off: 7 points"), row("fan-2", "netgen", "rejected", "fan-2.off: 8 points"),
                                       row("bunny-3", "netgen", "wrong-result", "verify: broken: conformity: edge 1"), row("x4", "netgen")))
        self.assertEqual([(r["How"], r["Runs"], r["For example"]) for r in rows_under(text, "How they fail")],
                         [("rejected: MODEL.off: # points", "2", "fan-1, fan-2"), ("wrong-result: broken: conformity", "1", "bunny-3")])

    def test_a_solver_compares_at_equal_unknowns(self):
        def seen(unknowns, iterations, error, **more):
            return {"unknowns": unknowns, "iterations": iterations, "condition": 1.0, "mean_error": error, "converged": True, **more}

        text = self.page(self.campaign(
            row("fan-1", "delmesher", solver=seen(1000, 20, 0.01)), row("fan-2", "delmesher", solver=seen(8, 1, 0.5)),
            row("fan-1", "netgen", solver=seen(8000, 80, 0.005)), row("fan-2", "netgen", solver=seen(1000, 1, 1)), row("x3", "netgen"),
            row("fan-1", "cdt", solver=seen(49, 1, 1)), row("fan-1", "tetgen")))
        self.assertIn("\nNo mesh with so many unknowns was solved of `cdt`, `tetgen`.\n", text)
        found = rows_under(text, "What a solver sees")
        # 0.01 x 100 and 0.005 x 400; 20 / 10 and 80 / 20; of eight unknowns nothing is told.
        self.assertEqual([found[0]["Meshes"], found[0]["error x n^(2/3)"], found[0]["iterations / n^(1/3)"]], ["1", "1.000", "2.00"])
        self.assertEqual([found[1]["meshes in common with `delmesher`"], found[1]["error x n^(2/3), it / ours"],
                          found[1]["iterations / n^(1/3), it / ours"]], ["1", "2.00", "2.00"])
        self.assertNotIn("What a solver", self.page(self.campaign(row("fan-1", "delmesher"))))

    def test_a_later_run_with_a_solver_takes_the_place_of_one_without(self):
        solver = {"unknowns": 1000, "iterations": 20, "condition": 1.0, "mean_error": 0.01, "converged": True}
        self.page(self.campaign(row("fan-1", "netgen", tetrahedra=1), row("fan-2", "netgen", tetrahedra=1, solver=solver)))
        earlier = self.path("page.csv")
        self.page(self.campaign(row("fan-1", "netgen", tetrahedra=2, solver=solver), row("fan-2", "netgen", tetrahedra=2)), "--merge", earlier)
        self.assertEqual([(r["tetrahedra"], r["unknowns"]) for r in self.runs()], [("2", "1000"), ("1", "1000")])

    def test_runs_of_equal_versions_stay_and_others_take_their_place(self):
        self.page(self.campaign(row("fan-1", "netgen", tetrahedra=1), row("fan-2", "netgen", "killed"), row("fan-1", "delmesher", tetrahedra=1),
                                row("bunny-3", "netgen", tetrahedra=1)))
        earlier = self.path("earlier.csv")
        os.rename(self.path("page.csv"), earlier)
        os.rename(self.path("page_meshers.csv"), self.path("earlier_meshers.csv"))
        again = self.campaign(row("fan-1", "netgen", tetrahedra=2), row("fan-2", "netgen", tetrahedra=2),
                              row("fan-1", "delmesher", tetrahedra=2, version="otherwise"), row("bunny-3", "netgen", tetrahedra=2, limits="9 s"))

        def sizes():
            return {(r["model"], r["mesher"]): r["tetrahedra"] for r in self.runs()}

        self.page(again, "--merge", earlier)
        # Of ours the commit is the version, not the bytes of its program.
        self.assertEqual(sizes(), {("fan-1", "netgen"): "1", ("fan-2", "netgen"): "2", ("fan-1", "delmesher"): "1", ("bunny-3", "netgen"): "2"})
        self.page(again, "--merge", earlier, commit="beef")
        self.assertEqual(sizes()["fan-1", "delmesher"], "2")
        text = self.page("--merge", earlier)
        self.assertEqual(sizes()["fan-2", "netgen"], "")
        self.assertIn("2 meshers, 4 runs; 1 models have", text)
        self.assertEqual({r["program"] for r in self.runs("page_meshers.csv")}, {"peer 1.2 (build 00)", "peer 1.2 (build 00) of c0ffee"})
        self.page("--merge", earlier, "--drop", "netgen")
        self.assertEqual(len(sizes()), 1)

    def test_what_is_written_by_hand_stays(self):
        self.assertTrue(self.page(self.campaign(row("fan-1", "cdt"))).endswith("\n" + league.BY_HAND + "\n"))
        with open(self.path("page.md"), "a", encoding="utf-8") as stream:
            stream.write("## What was learnt\n\nMuch.\n")
        text = self.page(self.campaign(row("fan-1", "netgen")))
        self.assertTrue(text.endswith("\n" + league.BY_HAND + "\n## What was learnt\n\nMuch.\n"))
        self.assertNotIn("`cdt`", text)

    def test_limits_that_differ_are_said(self):
        for limits, said in (("60 s", "under the same limits"), ("600 s", "under limits that differ, on one thread")):
            self.assertIn(said, self.page(self.campaign(row("fan-1", "cdt"), row("fan-1", "netgen", limits=limits))))

    def test_another_table_is_refused(self):
        with open(self.path("other.csv"), "w", encoding="utf-8") as stream:
            stream.write("model,mesher\n")
        for arguments in (["--merge", self.path("other.csv")], [self.path("none.sqlite")], []):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                self.page(*arguments)

    def test_no_mesh_is_ok_that_nobody_has_verified(self):
        rows = [row("fan-%d" % i, "netgen") for i in range(4)]
        for i, verdict in enumerate(("", '{"error": "own limit"}', '{"verdict": "unknown"}')):
            rows[i]["verdict_json"] = verdict
        self.page(self.campaign(*rows))
        self.assertEqual([(r["disposition"], r["tetrahedra"]) for r in self.runs()], 3 * [("unverified", "")] + [("ok", "100")])

    def test_a_limit_of_zero_is_none(self):
        text = self.page(self.campaign(row("fan-1", "netgen", limits="wall 9 s, cpu 9 s, memory 0 MiB"),
                                       row("fan-1", "delmesher", limits="wall 9 s, cpu 9 s, memory 5 MiB")))
        self.assertEqual(text.count("| 1 | 1 | 100.0 "), 2)

    def test_a_path_is_no_query(self):
        path = self.campaign(row("fan-1", "netgen"))
        odd = self.path("a#b?mode=rwc&x%41.sqlite")
        os.rename(path, odd)
        self.page(odd)
        self.assertEqual(len(self.runs()), 1)
        self.assertEqual(sorted(os.listdir(self.folder.name)), sorted([os.path.basename(odd), "families.csv", "page.csv", "page.md",
                                                                       "page_meshers.csv"]))

    def test_texts_in_another_encoding(self):
        path = self.campaign(row("fan-1", "netgen", "rejected"))
        with contextlib.closing(sqlite3.connect(path)) as connection:
            connection.execute("update runs set reason = cast(x'756e67fc6c746967' as text), mesh_json = 'no json'")
            connection.commit()
        self.page(path)
        self.assertEqual(self.runs()[0]["reason"], "ung\ufffdltig")

    def test_what_is_wrong_is_said_in_a_line(self):
        def refused(*arguments):
            with self.assertRaises(SystemExit) as said:
                self.page(*arguments)
            self.assertNotIn("\n", str(said.exception))
            return str(said.exception)

        path = self.campaign(row("fan-1", "netgen"))
        odd = self.campaign(row("fan-1", "netgen", "great"))
        self.assertIn("unknown disposition: great", refused(odd))
        with contextlib.closing(sqlite3.connect(odd)) as connection:
            connection.execute("alter table runs drop column promise")
        self.assertIn("no results of this version (promise)", refused(odd))
        self.page(path)
        with open(self.path("page.csv"), encoding="utf-8") as stream:
            head, line = stream.read().splitlines()
        for text in (line + ",1", line[:line.rindex(",")], line.replace(",100,", ",abc,")):
            with open(self.path("page.csv"), "w", encoding="utf-8") as stream:
                stream.write(head + "\n" + text + "\n")
            self.assertIn("page.csv:2: ", refused(path, "--merge", self.path("page.csv")))
        with open(self.path("page.csv"), "w", encoding="utf-8") as stream:
            stream.write(head + "\n" + line.replace("netgen", "gmsh") + "\n")
        self.assertIn("no row for gmsh of version", refused(path, "--merge", self.path("page.csv")))
        with open(self.families, "w", encoding="utf-8") as stream:
            stream.write("# comment\nfan-*\n")
        self.assertIn("families.csv:2: PATTERN,FAMILY is expected", refused(path))

    def test_all_files_or_none(self):
        os.mkdir(self.path("page.md"))
        with self.assertRaises(OSError):
            self.page(self.campaign(row("fan-1", "netgen")))
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["families.csv", "page.md", "runs1.sqlite"])

    def test_numbers_are_short(self):
        self.assertEqual([league.number(v) for v in (None, 12.34567, 1234567.0, 0.000012345, 7)], ["", "12.35", "1234567", "1.234e-05", "7"])


class Real(unittest.TestCase):
    def test_a_real_campaign(self):
        if TETPROOF is None:
            self.skipTest("no tetproof")
        with tempfile.TemporaryDirectory() as folder:
            model, database, page = (os.path.join(folder, name) for name in ("wedge.off", "runs.sqlite", "page.md"))
            with open(model, "w", encoding="utf-8") as stream:
                stream.write("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
            subprocess.run([TETPROOF, "run", model, "-m", "cdt", "-m", "no=cmd:false {in} {out.mesh}", "--db", database], check=True,
                           stdout=subprocess.DEVNULL)
            self.assertEqual(league.main([database, "-o", page, "--commit", "c0ffee"]), 0)
            with open(os.path.join(folder, "page.csv"), newline="", encoding="utf-8") as stream:
                ours, theirs = csv.DictReader(stream)
            self.assertEqual([ours[f] for f in ("model", "mesher", "disposition", "tetrahedra", "min_face_angle")], ["wedge", "cdt", "ok", "1", "45"])
            self.assertEqual(ours["min_dihedral"], "54.74")  # acos(1/sqrt(3)): coordinate planes against the slanted one
            self.assertTrue(re.match("c0ffee-[0-9a-f]{4}$", ours["version"]))
            self.assertEqual([theirs["mesher"], theirs["disposition"], theirs["tetrahedra"]], ["no", "rejected", ""])


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        TETPROOF = sys.argv.pop(1)
    unittest.main()

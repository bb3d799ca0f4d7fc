#!/usr/bin/env python3
"""A campaign over a folder, as a table of pandas: what could be meshed, what was wrong with the rest. Usage: folder.py [FOLDER]"""
import pathlib
import sys
import tempfile

import numpy as np
import pandas

import tetproof
from poisson import cube


def row_of(path):
    row = {"file": path.name, "tetrahedra": 0, "dihedral": float("nan"), "problem": ""}
    try:
        surface = tetproof.read(path)
        mesh = tetproof.mesh(surface, time_limit=60)
        row.update(tetrahedra=len(mesh.tetrahedra), dihedral=mesh.stats["final"]["min_dihedral"])
    except tetproof.InvalidSurface as error:
        row["problem"] = ", ".join("%d x %s" % (count, kind) for kind, count in error.counts.items())
    except (tetproof.Error, ValueError) as error:
        row["problem"] = str(error)
    return row


def examples(folder):
    """A good file, an open surface and one that is not a surface."""
    good = tetproof.mesh(cube())
    good.write(folder / "good.stl")
    hole = tetproof.Mesh(good.points, good.tetrahedra[:0], good.inside[:0], good.boundary[1:], good.labels[1:], good.facets[1:])
    hole.write(folder / "hole.stl")
    (folder / "text.stl").write_text("solid nothing\n")


def main(folder):
    files = sorted(folder.glob("*.stl"))
    table = pandas.DataFrame([row_of(path) for path in files]).set_index("file")
    print(table.to_string())
    return table


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(pathlib.Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as name:
            examples(pathlib.Path(name))
            table = main(pathlib.Path(name))
            assert table.loc["good.stl", "tetrahedra"] >= 5
            assert table.loc["hole.stl", "problem"] == "3 x open edge"
            assert np.isnan(table.loc["text.stl", "dihedral"]) and "text.stl" in table.loc["text.stl", "problem"]

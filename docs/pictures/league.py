#!/usr/bin/python3
"""Draws the pictures of docs/league.md from its runs, each for light and for dark pages.

Usage: docs/pictures/league.py LEAGUE.csv FOLDER [MESHER...]     Needs `ci/install_packages pictures`. Only of these meshers, if there are any.

league-success.*  how the runs of each mesher ended, in percent
league-time.*     how many percent of its models each mesher has meshed within so many processor seconds
league-shape.*    tetrahedra beside those of `delmesher` on the same models, and mean gamma: medians
"""
import csv
import itertools
import math
import os
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

PAGES = {"light": ("white", "#1f2428"), "dark": ("#0d1117", "#e6edf3")}
ENDS = {"ok": "#2a9d8f", "wrong-result": "#c1121f", "crash": "#e76f51", "timeout": "#e9c46a", "out-of-memory": "#b08968", "rejected": "#8d99ae", "unverified": "#ced4da"}
OURS = "delmesher"
LEAST = 10  # models, for a curve


def runs_of(path, wanted):
    """Rows by mesher, then model; meshers by the lower end of Wilson's interval."""
    runs = {}
    with open(path, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            if not wanted or row["mesher"] in wanted:
                runs.setdefault(row["mesher"], {})[row["sha256"]] = row
    return dict(sorted(runs.items(), key=lambda item: -certain(item[1])))


def share(rows, end):
    return 100 * sum(row["disposition"] == end for row in rows.values()) / len(rows)


def certain(rows):
    n, ok, z = len(rows), share(rows, "ok") / 100, 1.96
    return (ok + z * z / (2 * n) - z * math.sqrt(ok * (1 - ok) / n + z * z / (4 * n * n))) / (1 + z * z / n)


def is_ours(mesher):
    return mesher == "cdt" or mesher.startswith("delmesher")


def draw_success(axes, runs):
    names = [f"{mesher} ({len(rows)})" for mesher, rows in runs.items()]
    left = [0] * len(runs)
    for end, colour in ENDS.items():
        widths = [share(rows, end) for rows in runs.values()]
        if any(widths):
            axes.barh(names, widths, left=left, color=colour, label=end)
        left = [a + b for a, b in zip(left, widths)]
    axes.invert_yaxis()
    axes.set_xlim(0, 100)
    axes.set_xlabel("% of its runs (number of models)")
    axes.legend(ncol=4, loc="lower center", bbox_to_anchor=(0.4, 1), frameon=False)


def draw_time(axes, runs):
    for number, (mesher, rows) in enumerate(runs.items()):
        if len(rows) < LEAST:
            continue
        seconds = sorted(float(row["cpu_s"]) for row in rows.values() if row["disposition"] == "ok")
        shares = [100 * (i + 1) / len(rows) for i in range(len(seconds))]
        axes.step([max(s, 0.01) for s in seconds], shares, where="post", color=f"C{number % 10}", linestyle=("-", "--", ":")[number // 10 % 3],
                  linewidth=2.6 if is_ours(mesher) else 1.2, label=mesher)
    axes.set_xscale("log")
    axes.set_ylim(0, 101)
    axes.set_xlabel("processor seconds")
    axes.set_ylabel("% of its models meshed")
    axes.legend(fontsize="small", frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))


def draw_shape(axes, runs):
    ours, dots = runs.get(OURS, {}), []
    for mesher, rows in runs.items():
        common = [(row, ours[model]) for model, row in rows.items() if model in ours and row["disposition"] == ours[model]["disposition"] == "ok"]
        if len(common) < LEAST:
            continue
        weight = statistics.median(float(a["tetrahedra"]) / float(b["tetrahedra"]) for a, b in common)
        gamma = statistics.median(float(a["mean_gamma"]) for a, _ in common)
        axes.plot(weight, gamma, "o", color=ENDS["ok"] if is_ours(mesher) else ENDS["crash"], markersize=8)
        dots.append((mesher, (weight, gamma)))
    axes.set_xscale("log")
    axes.set_xlabel(f"tetrahedra, times those of {OURS}")
    axes.set_ylabel("mean gamma (1: regular)")
    axes.figure.canvas.draw()  # where all is now is where it stays
    taken = [matplotlib.transforms.Bbox.from_bounds(x - 5, y - 5, 10, 10) for x, y in (axes.transData.transform(place) for _, place in dots)]
    for mesher, place in dots:
        for right, up in itertools.product((7, -7), (4, -11, 19, -26, 34, -41)):
            text = axes.annotate(mesher, place, xytext=(right, up), textcoords="offset points", fontsize="small", ha="left" if right > 0 else "right",
                                 arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": plt.rcParams["text.color"], "relpos": (0 if right > 0 else 1, 0.5)})
            text.update_positions(axes.figure.canvas.get_renderer())
            box = matplotlib.text.Text.get_window_extent(text)
            if box.x0 > axes.bbox.x0 and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            text.remove()


def draw(drawing, runs, path, height):
    for page, (paper, ink) in PAGES.items():
        colours = {name: ink for name in ("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color")}
        with plt.rc_context({**colours, "axes.facecolor": paper, "figure.facecolor": paper, "axes.spines.top": False, "axes.spines.right": False}):
            figure, axes = plt.subplots(figsize=(9, height))
            drawing(axes, runs)
            figure.savefig(f"{path}-{page}.png", dpi=110, bbox_inches="tight", metadata={"Software": None})
            plt.close(figure)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    runs = runs_of(sys.argv[1], sys.argv[3:])
    os.makedirs(sys.argv[2], exist_ok=True)
    draw(draw_success, runs, os.path.join(sys.argv[2], "league-success"), 1 + 0.3 * len(runs))
    draw(draw_time, runs, os.path.join(sys.argv[2], "league-time"), 5)
    draw(draw_shape, runs, os.path.join(sys.argv[2], "league-shape"), 5)


main()

#!/usr/bin/env python3
"""Draws the table that the benchmark work_precision writes: error against time and against dofs.

usage: work_precision.py TABLE.csv FILE.png     (also .pdf, .svg)

One row a problem, its first quantity. Colours tell orders apart, dashes and marks kinds of meshes. Errors
within the uncertainty of the reference (the grey band) are not drawn.
"""
import csv
import sys
from collections import OrderedDict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from plot import COLOURS

MESHES = {"uniform": ("-", "o"), "graded": ((0, (5, 2)), "s"), "nested": ((0, (1, 1)), "^"), "default": ("", "*")}


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    table, picture = arguments
    problems = OrderedDict()
    with open(table, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            problem = problems.setdefault(row["problem"], {"title": row["title"], "quantity": row["quantity"],
                                                           "curves": OrderedDict(), "uncertainty": 0.0})
            if row["quantity"] != problem["quantity"]:
                continue
            problem["uncertainty"] = float(row["uncertainty"])
            problem["curves"].setdefault((row["mesh"], int(row["order"])), []).append(
                (float(row["seconds"]), float(row["dofs"]), float(row["error"])))
    plt.rcParams.update({"font.size": 9, "axes.titlesize": 10, "font.family": "DejaVu Sans"})
    figure, grid = plt.subplots(len(problems), 2, figsize=(9.6, 2.9 * len(problems)), squeeze=False, sharey="row")
    handles = OrderedDict()
    for axes_pair, problem in zip(grid, problems.values()):
        for column, axes in enumerate(axes_pair):
            for (mesh, order), points in problem["curves"].items():
                points = [point for point in points if point[2] > problem["uncertainty"]]
                dashes, mark = MESHES[mesh]
                line, = axes.plot([point[column] for point in points], [point[2] for point in points],
                                  color="black" if mesh == "default" else COLOURS[(order - 1) % len(COLOURS)],
                                  linestyle=dashes, marker=mark, markersize=9 if mesh == "default" else 4,
                                  linewidth=1.3, zorder=5 if mesh == "default" else 3)
                handles.setdefault("default mesh" if mesh == "default" else f"p = {order}, {mesh}", line)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlabel(("seconds (CPU)", "dofs")[column])
            axes.grid(True, which="major", color="#DDDDDD", linewidth=0.6)
            axes.set_axisbelow(True)
            if problem["uncertainty"] > 0:
                lo, hi = axes.get_ylim()
                axes.axhspan(min(lo, problem["uncertainty"]), problem["uncertainty"], color="#E8E8E8", zorder=0)
                axes.set_ylim(min(lo, 0.5 * problem["uncertainty"]), hi)
        axes_pair[0].set_ylabel("error")
        axes_pair[0].set_title(f"{problem['title']}: {problem['quantity']}", loc="left")
    figure.legend(handles.values(), handles.keys(), ncol=4, loc="lower center", fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.9 / figure.get_figheight(), 1, 1))
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1:])

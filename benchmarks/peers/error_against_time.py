#!/usr/bin/env python3
"""Errors against run times of whole programs, from the points that peers.py measured (JSON):

    python3 benchmarks/peers/error_against_time.py PICTURE POINTS

One panel a study; a line joins the meshes of one program and one number of cycles."""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

TITLES = {"punch": "Square punch", "lap_joint": "Lap joint", "hertz": "Hertz and Cattaneo"}
COLOURS, MARKERS = {"ours": "k", "GetFEM": "C1", "CalculiX": "C0"}, {0: "o", 1: "s", 10: "^", 100: "D"}


def main():
    points = json.loads(sys.argv[2])
    figure, axes = plt.subplots(1, len(TITLES), figsize=(12.6, 4.2))
    for axis, (study, title) in zip(axes, TITLES.items()):
        for program in COLOURS:
            for cycles in MARKERS:
                own = [p for p in points if (p["study"], p["program"], p["cycles"]) == (study, program, cycles)]
                what = "loading" if cycles == 0 else "1 cycle" if cycles == 1 else "%d cycles" % cycles
                axis.plot([p["seconds"] for p in own], [100 * p["error"] for p in own], color=COLOURS[program],
                          marker=MARKERS[cycles], linewidth=0.7, markersize=5,
                          label="%s, %s" % (program, what) if own else "_")
        axis.set(xscale="log", yscale="log", title=title, xlabel="CPU seconds of the process")
        axis.grid(alpha=0.3, which="both")
    axes[0].set_ylabel("error in %: of a border after loading or\n1 cycle, of the steady loss after more")
    lines = {line.get_label(): line for axis in axes for line in axis.get_lines() if not line.get_label().startswith("_")}
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    figure.legend(lines.values(), lines.keys(), fontsize=8, loc="lower center", ncol=8)
    figure.savefig(sys.argv[1], dpi=130)


if __name__ == "__main__":
    main()

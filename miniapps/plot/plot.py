#!/usr/bin/env python3
"""Draws panels written by the miniapps (--csv PREFIX, --plot FILE.png).

usage: plot.py PANEL.csv [PANEL.csv ...] FILE.png     (also .pdf, .svg)

A panel is a CSV file with comment lines that name it and its axes:

    # kind: lines            or zones, or plan
    # title: ...             # x: label    # y: label
    # limits x: lo,hi        an empty side is left to the data; also "limits y"
    # reversed: x            # scale: loglog
    series,style,x,y         lines; style: line, dashed, points or thesis
    time,state,from,to       zones; one row a zone, times in order
    item,from,to             plan of a body of revolution: rings (state, radii) and arrows (rate or total, radius,
                             angle from the radial direction)

Colours are Okabe and Ito's, which the colour-blind can tell apart; lines differ in dashes and zones
in hatching as well, so that a black-and-white print can be read.
"""
import csv
import math
import sys
from collections import OrderedDict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Annulus, Patch, Polygon

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]
DASHES = ["-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)), (0, (1, 1)), (0, (9, 3)), "-"]
STATES = OrderedDict([
    ("stick", ("#F2F2F2", "")),
    ("forward slip", ("#E69F00", "////")),
    ("backward slip", ("#56B4E9", "\\\\\\\\")),
    ("slip", ("#E69F00", "////")),
    ("separation", ("#FFFFFF", "....")),
])


def read(path):
    """Comments as a dictionary, rows as dictionaries."""
    comments, lines = {}, []
    with open(path, encoding="utf-8", newline="") as file:
        for line in file:
            if line.startswith("#"):
                key, _, value = line[1:].partition(":")
                comments[key.strip()] = value.strip()
            else:
                lines.append(line)
    return comments, list(csv.DictReader(lines))


def value(text):
    return float(text) if text else float("nan")


def draw_lines(axes, rows):
    series = OrderedDict()
    for row in rows:
        series.setdefault((row["series"], row["style"]), []).append((value(row["x"]), value(row["y"])))
    # Curves with companions are told apart by colour, and the companions are the dashed ones.
    plain = any(style == "dashed" and ": " in name for name, style in series)
    names = list(OrderedDict.fromkeys(name for name, style in series if style in ("line", "points")))
    for (name, style), points in series.items():
        x, y = zip(*points)
        # A comparison takes the colour of the curve it belongs to ("closed form: q" goes with "q").
        owner = next((k for k, other in enumerate(names) if name == other or name.endswith(": " + other)), None)
        colour = COLOURS[owner % len(COLOURS)] if owner is not None else "#555555"
        if style == "line":
            axes.plot(x, y, color=colour, linestyle="-" if plain else DASHES[owner % len(DASHES)], linewidth=1.6,
                      label=name)
        elif style == "points":
            axes.plot(x, y, "o", color=colour, markersize=3.5, label=name)
        elif style == "dashed":
            axes.plot(x, y, color=colour, linestyle=(0, (5, 2)), linewidth=1.2, label=name)
        else:
            axes.plot(x, y, "D", markerfacecolor="none", markeredgecolor="black", markersize=6,
                      markeredgewidth=1.2, label=name, zorder=5)
    axes.grid(True, color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)
    if len(series) > 1 or (series and next(iter(series))[0]):
        axes.legend(fontsize=8, framealpha=0.9, loc="best")


def draw_zones(axes, rows):
    marks = [row for row in rows if row["state"] == "thesis"]
    steps = OrderedDict()
    for row in rows:
        if row["state"] != "thesis":
            steps.setdefault(value(row["time"]), []).append((row["state"], value(row["from"]), value(row["to"])))
    times = list(steps)
    seen = []
    for k, time in enumerate(times):
        # The states at the end of an increment hold during it; edges move linearly where the same
        # zones were there before, and jump where they were not.
        before = steps[times[k - 1]] if k else None
        start = times[k - 1] if k else time
        same = before is not None and [z[0] for z in before] == [z[0] for z in steps[time]]
        for j, (state, lo, hi) in enumerate(steps[time]):
            lo0, hi0 = before[j][1:] if same else (lo, hi)
            colour, hatch = STATES[state]
            axes.add_patch(Polygon([(start, lo0), (time, lo), (time, hi), (start, hi0)], closed=True,
                                   facecolor=colour, edgecolor="none", hatch=None, linewidth=0))
            if hatch:
                axes.add_patch(Polygon([(start, lo0), (time, lo), (time, hi), (start, hi0)], closed=True,
                                       facecolor="none", edgecolor="#00000044", hatch=hatch, linewidth=0))
            if j:
                axes.plot([start, time], [lo0, lo], color="black", linewidth=0.7)
            if state not in seen:
                seen.append(state)
    if times:
        axes.set_xlim(min(times), max(times))
        axes.set_ylim(min(z[1] for s in steps.values() for z in s), max(z[2] for s in steps.values() for z in s))
    if marks:
        axes.plot([value(r["time"]) for r in marks], [value(r["from"]) for r in marks], "D", color="black",
                  markerfacecolor="white", markersize=5, label="thesis", zorder=5)
    handles = [Patch(facecolor=STATES[s][0], edgecolor="#00000066", hatch=STATES[s][1], label=s)
               for s in STATES if s in seen]
    if marks:
        handles.append(plt.Line2D([], [], marker="D", color="black", markerfacecolor="white", linestyle="",
                                  markersize=5, label="thesis"))
    axes.legend(handles=handles, fontsize=8, ncol=len(handles), loc="lower center", bbox_to_anchor=(0.5, 1.0),
                frameon=False, handlelength=1.6, columnspacing=1.2)


def draw_plan(axes, rows):
    rings = [row for row in rows if row["item"] in STATES]
    outer = max(value(row["to"]) for row in rings)
    for row in rings:
        lo, hi = value(row["from"]), value(row["to"])
        colour, hatch = STATES[row["item"]]
        for face, edge, pattern in ((colour, "black", None), ("none", "#00000033", hatch)):
            axes.add_patch(Annulus((0, 0), hi, (hi - lo) * 0.9999, facecolor=face, edgecolor=edge, hatch=pattern,
                                   linewidth=0.7))
    handles = [Patch(facecolor=STATES[s][0], edgecolor="#00000066", hatch=STATES[s][1], label=s)
               for s in STATES if any(row["item"] == s for row in rings)]
    for kind, colour, spokes in (("rate", "black", range(0, 12)), ("total", "#0072B2", range(0, 12))):
        arrows = [(value(row["from"]), value(row["to"])) for row in rows if row["item"] == kind]
        if not arrows:
            continue
        # Four radii of the annulus, on twelve spokes; the two kinds on spokes of their own.
        chosen = [arrows[round((len(arrows) - 1) * share)] for share in (0.1, 0.37, 0.63, 0.9)]
        for spoke in spokes:
            turn = (spoke + (0.5 if kind == "total" else 0)) * math.pi / 6
            for radius, angle in chosen:
                axes.annotate("", xytext=(radius * math.cos(turn), radius * math.sin(turn)),
                              xy=(radius * math.cos(turn) + 0.09 * outer * math.cos(turn + angle),
                                  radius * math.sin(turn) + 0.09 * outer * math.sin(turn + angle)),
                              arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 1.0, "shrinkA": 0,
                                          "shrinkB": 0})
        handles.append(plt.Line2D([], [], color=colour, marker=">", markersize=4,
                                  label="rate of slip" if kind == "rate" else "total slip"))
    axes.set_xlim(-1.05 * outer, 1.05 * outer)
    axes.set_ylim(-1.05 * outer, 1.05 * outer)
    axes.set_aspect("equal")
    axes.legend(handles=handles, fontsize=8, ncol=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False,
                handlelength=1.6, columnspacing=1.2)


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    *panels, picture = arguments
    columns = 1 if len(panels) == 1 else 2
    rows = -(-len(panels) // columns)
    plt.rcParams.update({"font.size": 9, "axes.titlesize": 10, "hatch.linewidth": 0.5, "font.family": "DejaVu Sans"})
    figure, grid = plt.subplots(rows, columns, figsize=(5.6 if columns == 1 else 9.6, 3.7 * rows), squeeze=False)
    for axes in grid.flat[len(panels):]:
        axes.remove()
    for axes, path in zip(grid.flat, panels):
        comments, data = read(path)
        kind = comments.get("kind", "")
        if kind == "zones":
            draw_zones(axes, data)
        elif kind == "plan":
            draw_plan(axes, data)
        elif kind == "lines":
            draw_lines(axes, data)
        else:
            sys.exit(f"plot.py: {path}: there is no line '# kind: lines', '# kind: zones' or '# kind: plan'")
        axes.set_title(comments.get("title", ""), pad={"zones": 20, "plan": 34}.get(kind, 6))
        axes.set_xlabel(comments.get("x", ""))
        axes.set_ylabel(comments.get("y", ""))
        if comments.get("scale") == "loglog":
            axes.set_xscale("log")
            axes.set_yscale("log")
        for axis, limit in (("x", axes.set_xlim), ("y", axes.set_ylim)):
            lo, _, hi = comments.get("limits " + axis, ",").partition(",")
            limit(float(lo) if lo else None, float(hi) if hi else None)
        if comments.get("reversed") == "x":
            axes.invert_xaxis()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1:])

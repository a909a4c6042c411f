#!/usr/bin/env python3
"""Draws docs/bolted_joint.png: a bolted lap joint, its slip zones in time, and its hysteresis loop.

usage: bolted_joint.py [PICTURE]     (runs ./run contact --case meshes/bolted_joint.json; needs matplotlib)

Lengths are mm, forces N per mm of thickness, as in the case file.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch

ROOT = pathlib.Path(__file__).resolve().parent.parent
BODIES = {"upper": "#56B4E9", "lower": "#A6CEE3", "head": "#BBBBBB", "nut": "#BBBBBB"}
STATES = {"stick": ("#FFFFFF", ""), "slip": ("#E69F00", "///"), "separation": ("#CCCCCC", "...")}


def rows(path):
    """The rows of a CSV file whose comments begin with '#'."""
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def elements(path):
    """The corners of the elements of a mesh in Gmsh's format 2.2: one array of places for each."""
    lines = iter(path.read_text().splitlines())
    nodes, corners = {}, {2: 3, 3: 4, 9: 3, 10: 4, 16: 4}
    for line in lines:
        if line == "$Nodes":
            for _ in range(int(next(lines))):
                number, x, y, _ = next(lines).split()
                nodes[number] = (float(x), float(y))
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                words = next(lines).split()
                kind, tags = int(words[1]), int(words[2])
                if kind in corners:
                    first = 3 + tags
                    yield [nodes[n] for n in words[first : first + corners[kind]]]


def sketch(axes, case, bolt):
    for body, colour in BODIES.items():
        mesh = list(elements(ROOT / "meshes" / case["bodies"][body]["mesh"]))
        axes.add_collection(PolyCollection(mesh, facecolor=colour, edgecolor="#555555", linewidth=0.15))
    axes.plot([-60, -60], [-5.5, 1.5], color="black", linewidth=3)  # the lower plate's end is held
    axes.annotate("", (84, 2), (63, 2), arrowprops={"arrowstyle": "<->", "color": "#D55E00", "linewidth": 1.5})
    axes.text(73.5, 5, "±80 N/mm", ha="center", color="#D55E00")
    axes.text(0, 11.5, f"bolt: {bolt:.0f} N/mm", ha="center")
    axes.text(-58, -11, "held", ha="left")
    axes.set(xlim=(-64, 90), ylim=(-16, 19), aspect="equal", xlabel="x, mm", ylabel="y, mm", title="The joint")


def zones(axes, prefix):
    """Stretches of each state at each recorded time, between the plates."""
    bands = rows(f"{prefix}_zones_in_time_faying.csv")
    times = sorted({float(band["time"]) for band in bands})
    width = {time: after - time for time, after in zip(times, times[1:] + [2 * times[-1] - times[-2]])}
    for band in bands:
        time, low, high = float(band["time"]), float(band["from"]), float(band["to"])
        colour, hatch = STATES["slip" if "slip" in band["state"] else band["state"]]
        # The arc length runs from x = 15 to x = -15.
        axes.bar(time, high - low, width[time], 15 - high, align="edge", color=colour, hatch=hatch,
                 edgecolor="#555555", linewidth=0)
    axes.set(xlim=(times[0], times[-1]), ylim=(-15, 15), xlabel="load step", ylabel="x between the plates, mm",
             title="Slip zones")
    legend = [Patch(facecolor=c, hatch=h, edgecolor="#555555", label=s) for s, (c, h) in STATES.items()]
    axes.legend(handles=legend, loc="upper center", bbox_to_anchor=(0.5, -0.22), ncol=3, frameon=False)


def loop(axes, prefix):
    points = [row for row in rows(f"{prefix}_interface_loops.csv") if row["series"] == "faying"]
    axes.plot([1e3 * float(p["x"]) for p in points], [float(p["y"]) for p in points], color="#0072B2")
    axes.set(xlabel="mean slip, µm", ylabel="shear force, N/mm", title="Hysteresis between the plates")
    axes.grid(alpha=0.3)


def main():
    picture = sys.argv[1] if len(sys.argv) > 1 else ROOT / "docs/bolted_joint.png"
    path = ROOT / "meshes/bolted_joint.json"
    plt.rcParams.update({"font.size": 9, "hatch.linewidth": 0.4})
    with tempfile.TemporaryDirectory() as folder:
        prefix = f"{folder}/joint"
        subprocess.run([str(ROOT / "run"), "contact", "--case", str(path), "--csv", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        figure, axes = plt.subplots(1, 3, figsize=(12, 3.2), width_ratios=[1.7, 1.2, 1], layout="constrained")
        sketch(axes[0], json.loads(path.read_text()), float(rows(f"{prefix}_bolts.csv")[0]["force"]))
        zones(axes[1], prefix)
        loop(axes[2], prefix)
        figure.savefig(picture, dpi=130)


if __name__ == "__main__":
    main()

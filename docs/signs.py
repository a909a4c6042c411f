"""Draws docs/signs.png, the sign conventions that docs/theory.md explains: /usr/bin/python3 docs/signs.py"""

import pathlib

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.patches import Polygon  # noqa: E402

BODY, LINE, NORMAL, SHEAR = "#dfe6ee", "#44515f", "#b03a2e", "#1f618d"


def arrow(axes, start, end, colour, text, at, **kind):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0, **kind})
    axes.text(*at, text, color=colour, fontsize=12, ha="center", va="center")


def bodies(axes, gap, shift=0.0):
    axes.add_patch(Polygon([(-2 + shift, gap), (2 + shift, gap), (1.6 + shift, gap + 1.5), (-1.6 + shift, gap + 1.5)], fc=BODY, ec=LINE))
    axes.add_patch(Polygon([(-2.6, -1.5), (2.6, -1.5), (2.6, 0), (-2.6, 0)], fc=BODY, ec=LINE))
    axes.text(-1.05 + shift, gap + 1.2, "body 1", color=LINE, fontsize=11, ha="center")
    axes.text(-2.1, -1.3, "body 2", color=LINE, fontsize=11, ha="center")
    axes.set(xlim=(-3, 3.2), ylim=(-2.7, 2.75), aspect="equal")
    axes.axis("off")


figure, (frames, forces, slips) = plt.subplots(1, 3, figsize=(12.6, 4.1))

bodies(frames, 0.75)
frames.set_title("Frame, opening and gap", fontsize=12)
frames.plot([-1.5, -0.75, 0, 0.75, 1.5], [0.75] * 5, "o", color=LINE, ms=4)
arrow(frames, (0, 0.75), (0.85, 0.75), SHEAR, "s", (0.85, 1.0))
arrow(frames, (0, 0.75), (0, 1.6), NORMAL, "n", (-0.25, 1.5))
arrow(frames, (1.6, 0), (1.6, 0.75), NORMAL, "w + g", (2.2, 0.4), arrowstyle="<|-|>")
arrow(frames, (-1.5, 0.6), (-0.3, 0.6), LINE, "", (0, 0), lw=1.0)
frames.text(-0.75, -0.55, "nodes run this way,\nbody 1 on their left", fontsize=10, ha="center", color=LINE)
frames.plot([-0.9, -0.9], [-0.05, 0.55], color=LINE, lw=0.7)
frames.text(0, -2.1, "s along the line, n into body 1\nw > 0 opens, closed where w + g = 0", fontsize=10, ha="center", va="center", color=LINE)

bodies(forces, 0.75)
forces.set_title("Contact forces on body 1", fontsize=12)
arrow(forces, (0, 0.05), (0, 0.72), NORMAL, "p > 0", (-0.5, 0.4))
arrow(forces, (0.05, 0.72), (1.0, 0.72), SHEAR, "q > 0", (0.7, 0.5))
arrow(forces, (0, 2.5), (0, 2.27), LINE, "", (0, 0))
for x in (-1, -0.5, 0.5, 1):
    arrow(forces, (x, 2.5), (x, 2.27), LINE, "", (0, 0))
forces.text(1.55, 2.42, "pressure > 0", fontsize=10, color=LINE, va="center")
forces.text(0, -2.1, "p: compression is positive\nq: along s; both are nodal forces,\ntraction = force / weight", fontsize=10, ha="center", va="center", color=LINE)

bodies(slips, 0.0, shift=0.55)
slips.set_title("Slip of body 1 relative to body 2", fontsize=12)
slips.plot([0, 0], [-0.28, -0.05], color=LINE, lw=1)
slips.plot([0.55, 0.55], [-0.28, 0.05], color=LINE, lw=1)
slips.plot([0, 0.55], [0, 0], "o", color=LINE, ms=4)
arrow(slips, (0, -0.18), (0.55, -0.18), SHEAR, "v > 0", (1.05, -0.25))
arrow(slips, (0.7, 0.45), (1.5, 0.45), SHEAR, r"$\dot v > 0$: forward", (1.2, 0.75))
arrow(slips, (0.45, 0.12), (-0.4, 0.12), NORMAL, "q = - f p", (-0.35, 0.42))
slips.text(0, -2.1, "forward slip: q = - f p,  backward slip: q = + f p\nfriction takes - q dv > 0", fontsize=10, ha="center", va="center", color=LINE)

figure.tight_layout()
figure.savefig(pathlib.Path(__file__).with_name("signs.png"), dpi=100)

#!/usr/bin/env python3
"""Draws docs/sphere.png: a steel sphere on a steel plane, pressed and then sheared.

usage: sphere.py [PICTURE]     (needs the Python package cattaneo, and matplotlib)

Lengths are mm, forces N. docs/half_space.md explains the calls.
"""

import pathlib
import sys

import cattaneo
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

STATES = {"stick": "#F0F0F0", "slip": "#E69F00", "separation": "#CCCCCC"}

steel = cattaneo.Material(young=210e3, poisson=0.3)
x, y = np.meshgrid(*2 * [np.linspace(-1.2, 1.2, 49)])
space = cattaneo.HalfSpace(steel, steel, size=0.05, centres=np.column_stack([x.ravel(), y.ravel()]))
problem = space.problem(gap=(x**2 + y**2).ravel() / 200)  # a sphere of radius 100 on a plane
problem.friction = 0.3
state = cattaneo.march(problem, [{}, {"P": 1538.0}, {"Q1": 300.0}], increments=1).state

settled = np.array(cattaneo.settled_states(problem, state))
words = np.full(len(settled), 1)
words[settled == int(cattaneo.NodeState.stick)] = 0
words[settled == int(cattaneo.NodeState.separation)] = 2

figure, axes = plt.subplots(1, 3, figsize=(13, 3.9), constrained_layout=True)
for axis, title, values in ((axes[0], "Pressure, MPa", state.p), (axes[1], "Shear traction, MPa", np.hypot(*state.q.reshape(2, -1)))):
    picture = axis.pcolormesh(x, y, (values / problem.weights).reshape(x.shape), cmap="viridis")
    figure.colorbar(picture, ax=axis)
    axis.set_title(title)
axes[2].pcolormesh(x, y, words.reshape(x.shape), cmap=ListedColormap(list(STATES.values())), vmin=0, vmax=2)
axes[2].legend(handles=[Patch(facecolor=colour, edgecolor="#555555", label=word) for word, colour in STATES.items()],
               loc="upper center", bbox_to_anchor=(0.5, -0.16), ncol=3, frameon=False, fontsize=8)
axes[2].set_title("States")
for axis in axes:
    axis.set(aspect="equal", xlabel="x, mm", ylabel="y, mm")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().with_name("sphere.png"), dpi=100)

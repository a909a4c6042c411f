"""A shakedown map: the largest cyclic shear that a pressed punch bears without slipping for ever, over friction and the ratio
of the cycle's ends, with bounds that are proven while the nodes stay closed. The limit problem is set up once for each ratio.

Run as `python shakedown_map.py [problem.json] [map.png]`."""

import pathlib
import sys

import cattaneo
import numpy as np
from cattaneo import shakedown

shipped = pathlib.Path(__file__).parents[2] / "problems" / "punch_on_half_plane.json"
problem = cattaneo.load_reduced_problem(sys.argv[1] if len(sys.argv) > 1 else shipped)

frictions, ratios = np.linspace(0.3, 0.8, 5), (-1.0, -0.5, 0.0)
print("Q/fP between R and 1 times:", "".join(f"  R = {ratio:4.1f}            " for ratio in ratios))
limits = np.full((len(frictions), len(ratios)), np.nan)
for r, ratio in enumerate(ratios):
    cycle = shakedown.held_and_cycled(problem, "P", 1.0, "Q", ratio)
    limit = shakedown.limit_problem(problem, cycle)
    last = None
    for k, friction in enumerate(frictions):
        limit.reduced.friction = friction
        last = shakedown.load_limit(limit, start=last)  # from the one before
        limits[k, r] = last.limit / friction
        assert last.lower <= last.limit <= last.upper
for friction, row in zip(frictions, limits):
    print(f"f = {friction:5.3f}                  ", "".join(f"  {value:<22.6f}" for value in row))

if len(sys.argv) > 2:
    import matplotlib.pyplot as pyplot

    for ratio, column in zip(ratios, limits.T):
        pyplot.plot(frictions, column, "o-", label=f"R = {ratio}")
    pyplot.xlabel("friction f")
    pyplot.ylabel("shakedown limit Q/fP")
    pyplot.legend()
    pyplot.savefig(sys.argv[2])

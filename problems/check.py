#!/usr/bin/env python3
"""Checks the solutions of this set against the laws of contact and friction, and nothing else: it reads the
files with the reader printed in docs/reduced_problems.md.

    python3 problems/check.py [PROBLEM.json...]"""
import glob
import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(HERE, "..", "docs", "reduced_problems.md"), encoding="utf-8") as f:
    exec(re.search(r"```python\n(.*?)```", f.read(), re.DOTALL).group(1))  # read_reduced


def bounds(problem, way, p):
    """What the friction of each node is bounded by at its normal force, for slip "forward" or "backward"."""
    if not problem["laws"]:
        return problem["friction"] * p
    result = np.zeros(len(p))
    for i, law in enumerate(problem["laws"]):
        points = np.vstack([[0, 0], law[way]])
        k = min(max(np.searchsorted(points[:, 0], p[i]), 1), len(points) - 1)  # of the piece's end
        (p0, b0), (p1, b1) = points[k - 1:k + 1]
        result[i] = b0 + (b1 - b0) / (p1 - p0) * (p[i] - p0)
    return result


def check(file):
    """Largest violation of each law over all increments: of forces over the largest clamped force (in
    equilibrium: over the largest sum of absolute terms), of lengths over the largest displacement or gap. A node in a wrong state violates the law of its state."""
    problem = read_reduced(file)
    with open(file.replace(".json", ".solution.json")) as f:
        increments = json.load(f)["increments"]
    n, g = len(problem["gap"]), problem["gap"]
    loads = [sum(l * force for l, (_, force) in zip(i["multipliers"], problem["patterns"])) for i in increments]
    force = max(np.abs(x).max() for x in loads)
    length = max(max(np.abs(i["v"]).max(), np.abs(np.add(i["w"], g)).max()) for i in increments)
    worst, v_old = {}, np.zeros(n)

    def law(name, violations, scale):
        if len(violations):
            worst[name] = max(worst.get(name, 0.0), np.abs(violations).max() / scale)

    for load, i in zip(loads, increments):
        v, w, q, p = (np.array(i[key]) for key in "vwqp")
        states = np.array(list(i["states"]))
        assert len(states) == n and set(states) <= set("os+-"), "states"
        opened, stuck, forward, backward = (states == s for s in "os+-")
        closed = ~opened
        u = np.append(v, w)
        terms = (np.abs(problem["K"]) @ np.abs(u) + np.abs(load)).max()
        law("equilibrium", problem["K"] @ u + load - np.append(q, p), terms)
        law("open: no force", np.append(q[opened], p[opened]), force)
        law("open: gap", np.minimum(w + g, 0)[opened], length)
        law("closed: no gap", (w + g)[closed], length)
        law("closed: pressure", np.minimum(p, 0)[closed], force)
        forth, back = (bounds(problem, way, p) for way in ("forward", "backward"))
        law("friction bound", np.maximum(np.maximum(-q - forth, q - back), 0)[closed], force)
        law("stick: no slip", (v - v_old)[stuck], length)
        law("forward: q = -bound", (q + forth)[forward], force)
        law("forward: sense", np.minimum(v - v_old, 0)[forward], length)
        law("backward: q = bound", (q - back)[backward], force)
        law("backward: sense", np.maximum(v - v_old, 0)[backward], length)
        v_old = v
    return worst


def main():
    files = sys.argv[1:] or sorted(
        file.replace(".solution.json", ".json") for file in glob.glob(os.path.join(HERE, "*.solution.json")))
    bad = False
    for file in files:
        worst = check(file)
        name = max(worst, key=worst.get)
        # The coupling of equal half-planes (hertz) is round-off, 1e-12 of the stiffness, and solved as none.
        bad = bad or not worst[name] <= 1e-11
        print("%-28s largest violation %.1e (%s)" % (os.path.basename(file), worst[name], name))
    sys.exit(1 if bad or not files else 0)


if __name__ == "__main__":
    main()

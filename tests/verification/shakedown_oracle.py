"""Shakedown limits by HiGHS: an independent answer for the tests.

usage: shakedown_oracle.py problem.json answer.json

The problem has the matrices A (c n × c n) and B (n × c n), the friction coefficients, and for each
load vertex the stuck forces q0 + λ q1, p0 + λ p1. The limit is asked for in the slips v themselves:

   max λ   with   |q0 + λ q1 + A v| <= f (p0 + λ p1 + B v)   at every node and vertex.

One tangential component is one linear programme. The discs of two components are cut out by
tangents, added where the solution leaves a disc until it does so by less than 1e-10.
"""

import json
import sys

import highspy
import numpy as np

problem = json.load(open(sys.argv[1]))
A, B = np.array(problem["A"]), np.array(problem["B"])
f = np.array(problem["friction"])
n, m = len(f), len(A)
c = m // n
loads = [{k: np.array(x) for k, x in vertex.items()} for vertex in problem["vertices"]]

# Order-one unknowns and rows: HiGHS' tolerances are absolute.
force = np.max([np.abs(vertex["p0"]) for vertex in loads], axis=0)
length = np.median(force) / np.median(np.diag(A))


def cut(i, vertex, direction):
    """Row of f p - direction·q >= 0 at node i: coefficients of (λ, v), and the lower bound."""
    own = [d * n + i for d in range(c)]
    by_load = f[i] * vertex["p1"][i] - direction @ vertex["q1"][own]
    by_slip = f[i] * B[i] - direction @ A[own]
    constant = f[i] * vertex["p0"][i] - direction @ vertex["q0"][own]
    return np.concatenate(([by_load], length * by_slip)) / force[i], -constant / force[i]


highs = highspy.Highs()
highs.setOptionValue("output_flag", False)
highs.setOptionValue("primal_feasibility_tolerance", 1e-10)
highs.setOptionValue("dual_feasibility_tolerance", 1e-10)
infinity = highs.getInfinity()
for k in range(1 + m):
    highs.addVar(-infinity, infinity)
highs.changeColCost(0, -1.0)
columns = np.arange(1 + m, dtype=np.int32)


def add(row, low):
    used = columns[row != 0]
    highs.addRow(low, infinity, len(used), used, row[row != 0])


angles = [0.0, np.pi] if c == 1 else np.linspace(0, 2 * np.pi, 12, endpoint=False)
for vertex in loads:
    for i in range(n):
        for angle in angles:
            add(*cut(i, vertex, np.array([np.cos(angle), np.sin(angle)][:c])))

# A rigid slip costs nothing and means nothing: hold the first node if there is one.
for d in range(c):
    rigid = np.zeros(m)
    rigid[d * n : (d + 1) * n] = 1
    if np.abs(A @ rigid).max() < 1e-9 * np.abs(A).max():
        highs.changeColBounds(1 + d * n, 0.0, 0.0)

for _ in range(100):
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        break
    x = np.array(highs.getSolution().col_value)
    cuts = 0
    for vertex in loads if c == 2 else ():
        q = vertex["q0"] + x[0] * vertex["q1"] + A @ x[1:] * length
        p = vertex["p0"] + x[0] * vertex["p1"] + B @ x[1:] * length
        for i in range(n):
            own = q[[i, n + i]]
            size = np.hypot(*own)
            if size - f[i] * p[i] > 1e-10 * force[i]:
                add(*cut(i, vertex, own / size))
                cuts += 1
    if cuts == 0:
        break

status = highs.modelStatusToString(highs.getModelStatus())
json.dump({"status": status, "limit": highs.getSolution().col_value[0]}, open(sys.argv[2], "w"))

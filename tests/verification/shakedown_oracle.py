"""Shakedown limits by HiGHS: independent answers for the tests.

usage: shakedown_oracle.py questions.json answers.json

A question has the matrices A (c n × c n) and B (n × c n), the friction coefficients, for each load
vertex the stuck forces q0 + λ q1, p0 + λ p1, and what is asked for:

  load       the largest λ with |q0 + λ q1 + A v| <= f (p0 + λ p1 + B v) at every node and vertex.
             Answer: [status, limit] with the status "limited", "unlimited", or "no solution" if
             there is no v for λ = 0.
  friction   the smallest friction coefficient, the same everywhere, for λ = 1, by bisection.
             Answer: [status, low, high]; "no solution" where 100 does not do.

One tangential component makes linear programmes. The discs of two components lie between polygons:
with "sides" in the question the answer is a pair, of the polygons inside and of those around the
discs. Without it the discs are cut out by tangents, added where the solution leaves a disc until it
does so by less than 1e-10.
"""

import json
import sys

import highspy
import numpy as np

Status = highspy.HighsModelStatus


class Contact:
    def __init__(self, question):
        self.A, self.B = np.array(question["A"]), np.array(question["B"])
        self.f = np.array(question["friction"])
        self.n, self.m = len(self.f), len(self.A)
        self.c = self.m // self.n
        self.loads = [{k: np.array(x) for k, x in vertex.items()} for vertex in question["vertices"]]
        if question["ask"] == "friction":
            for vertex in self.loads:
                for k in "qp":
                    vertex[k + "0"] = vertex[k + "0"] + vertex[k + "1"]
                    vertex[k + "1"] = 0 * vertex[k + "1"]

        # Order-one unknowns and rows: HiGHS' tolerances are absolute.
        def size(normal, tangential):
            forces = [np.abs(v[normal]) for v in self.loads]
            forces += [np.abs(q) for v in self.loads for q in v[tangential].reshape(self.c, self.n)]
            return np.max(forces, axis=0)

        constant, varying = size("p0", "q0"), size("p1", "q1")
        largest = constant.max() or varying.max() or 1.0
        self.unit = largest / varying.max() if varying.max() > 0 else 1.0
        self.force = np.maximum(constant, 1e-3 * largest)
        self.length = largest / np.median(np.diag(self.A))

    def cut(self, i, vertex, direction, friction):
        """Row of f p - direction·q >= 0 at node i: coefficients of (λ, v), and the constant."""
        own = [d * self.n + i for d in range(self.c)]
        by_load = friction * vertex["p1"][i] - direction @ vertex["q1"][own]
        by_slip = friction * self.B[i] - direction @ self.A[own]
        constant = friction * vertex["p0"][i] - direction @ vertex["q0"][own]
        return np.concatenate(([self.unit * by_load], self.length * by_slip)) / self.force[i], constant / self.force[i]

    def tangents(self, friction, sides, around):
        """The cuts of all discs; with two components those of polygons around or inside them."""
        n, c = self.n, self.c
        if c == 1:
            directions = np.array([[1.0], [-1.0]])
        else:
            angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
            directions = np.column_stack((np.cos(angles), np.sin(angles)))
            friction = friction if around else friction * np.cos(np.pi / sides)

        # Rows of f p - direction·q >= 0, as cut() has them, of all nodes and directions at once.
        def bounds(p, q):
            node = (n,) + (1,) * (p.ndim - 1)
            along = np.tensordot(directions, q.reshape((c, n) + p.shape[1:]), 1)
            return np.swapaxes((friction.reshape(node) * p - along) / self.force.reshape(node), 0, 1)

        by_slip = self.length * bounds(self.B, self.A)
        rows, constants = [], []
        for vertex in self.loads:
            by_load = self.unit * bounds(vertex["p1"], vertex["q1"])
            rows.append(np.concatenate((by_load[..., None], by_slip), axis=-1).reshape(-1, 1 + self.m))
            constants.append(bounds(vertex["p0"], vertex["q0"]).ravel())
        return np.concatenate(rows), np.concatenate(constants)


def programme(cost, rows, low, upper=None, rigid=()):
    """max cost·x with rows x >= low, x[0] <= upper. The HiGHS object, solved."""
    infinity = highspy.kHighsInf
    highs = highspy.Highs()
    highs.setOptionValue("output_flag", False)
    highs.setOptionValue("primal_feasibility_tolerance", 1e-10)
    highs.setOptionValue("dual_feasibility_tolerance", 1e-10)
    width = rows.shape[1]
    fixed = np.isin(np.arange(width), list(rigid))
    model = highspy.HighsLp()
    model.num_col_, model.num_row_ = width, len(rows)
    model.col_cost_ = -np.asarray(cost, dtype=float)
    low_x, high_x = np.where(fixed, 0.0, -infinity), np.where(fixed, 0.0, infinity)
    if upper is not None:
        high_x[0] = upper
    model.col_lower_, model.col_upper_ = low_x, high_x
    model.row_lower_, model.row_upper_ = np.asarray(low, dtype=float), np.full(len(rows), infinity)
    where, column = np.nonzero(rows)
    model.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    model.a_matrix_.start_ = np.searchsorted(where, np.arange(len(rows) + 1))
    model.a_matrix_.index_ = column
    model.a_matrix_.value_ = rows[where, column]
    highs.passModel(model)
    highs.run()
    if highs.getModelStatus() == Status.kUnboundedOrInfeasible:
        highs.setOptionValue("presolve", "off")
        highs.run()
    return highs


def first(size):
    unit = np.zeros(size)
    unit[0] = 1
    return unit


def rigid_slips(contact):
    """A rigid slip costs nothing and means nothing: hold the first node if there is one."""
    held = []
    for d in range(contact.c):
        rigid = np.zeros(contact.m)
        rigid[d * contact.n : (d + 1) * contact.n] = 1
        if np.abs(contact.A @ rigid).max() < 1e-9 * np.abs(contact.A).max():
            held.append(1 + d * contact.n)
    return held


def clearance(contact, rows, constants, rigid):
    """Largest t <= 1 with rows v + constants >= t: its sign says whether there is a state."""
    with_t = np.column_stack((-np.ones(len(rows)), rows[:, 1:]))
    highs = programme(first(1 + contact.m), with_t, -constants, 1.0, rigid)
    if highs.getModelStatus() != Status.kOptimal:
        return None
    return highs.getSolution().col_value[0]


def load(contact, sides, around):
    rigid = rigid_slips(contact)
    rows, constants = contact.tangents(contact.f, sides, around)
    room = clearance(contact, rows, constants, rigid)
    if room is None:
        return ["failed: clearance", 0]
    if room < -1e-9:
        return ["no solution", 0]
    for _ in range(100):
        highs = programme(first(1 + contact.m), rows, -constants, None, rigid)
        status = highs.getModelStatus()
        if status == Status.kUnbounded:
            return ["unlimited", 0]
        if status != Status.kOptimal:
            return ["failed: " + highs.modelStatusToString(status), 0]
        x = np.array(highs.getSolution().col_value)
        if contact.c == 1 or sides != 12:
            break
        more = []
        for vertex in contact.loads:
            q = vertex["q0"] + x[0] * contact.unit * vertex["q1"] + contact.A @ x[1:] * contact.length
            p = vertex["p0"] + x[0] * contact.unit * vertex["p1"] + contact.B @ x[1:] * contact.length
            for i in range(contact.n):
                own = q[[i, contact.n + i]]
                size = np.hypot(*own)
                if size - contact.f[i] * p[i] > 1e-10 * contact.force[i]:
                    more.append(contact.cut(i, vertex, own / size, contact.f[i]))
        if not more:
            break
        rows = np.vstack([rows] + [row for row, _ in more])
        constants = np.append(constants, [constant for _, constant in more])
    return ["limited", contact.unit * x[0]]


def friction(contact, sides, around):
    rigid = rigid_slips(contact)

    def holds(f):
        rows, constants = contact.tangents(np.full(contact.n, f), sides, around)
        room = clearance(contact, rows, constants, rigid)
        return room is not None and room > 0

    low, high = 0.0, 100.0
    if not holds(high):
        return ["no solution", high, high]
    while high - low > 1e-8 * high and high > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return ["limited", low, high]


def answer(question):
    ask = {"load": load, "friction": friction}[question["ask"]]
    if "sides" in question:
        return [ask(Contact(question), question["sides"], around) for around in (False, True)]
    return ask(Contact(question), 12, True)


questions = json.load(open(sys.argv[1], encoding="utf-8"))
json.dump([answer(question) for question in questions], open(sys.argv[2], "w", encoding="utf-8"))

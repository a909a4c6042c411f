"""Random joints in space: laws of contact, equilibrium of each body, and states that do not know axes, hands, numbers or units."""

import os
import warnings

import cattaneo
import numpy as np
import pytest

CORNERS = [0, 3, 6, 2, 1, 5, 7, 4]  # scikit-fem's corners of a hexahedron, one side after the other
SEEDS = int(os.environ.get("CATTANEO_RANDOM_JOINTS", "12"))


class Solid:
    """Stiffness of a block of hexahedra or tetrahedra, of order 1 or 2, its nodes inside moved at random."""

    def __init__(self, random, x, y, z, kind, order):
        skfem = pytest.importorskip("skfem")
        from skfem.models.elasticity import lame_parameters, linear_elasticity

        mesh = (skfem.MeshHex if kind == "hex" else skfem.MeshTet).init_tensor(x, y, z)
        ends = [np.array([axis.min(), axis.max()]) for axis in (x, y, z)]
        inside = np.all([(p > low) & (p < high) for p, (low, high) in zip(mesh.p, ends)], axis=0)
        # Faces of hexahedra of order 2 stay plane, so that weights are as exact as those of others.
        if order == 1:
            step = 0.1 * min(np.diff(axis).min() for axis in (x, y, z))
            mesh = type(mesh)(mesh.p + step * inside * random.uniform(-1, 1, mesh.p.shape), mesh.t)
        element = {
            ("hex", 1): skfem.ElementHex1,
            ("hex", 2): skfem.ElementHexS2,
            ("tet", 1): skfem.ElementTetP1,
            ("tet", 2): skfem.ElementTetP2,
        }[kind, order]()
        basis = skfem.Basis(mesh, skfem.ElementVector(element), intorder=2 * order)
        self.K = linear_elasticity(*lame_parameters(10 ** random.uniform(-0.5, 1), random.uniform(0, 0.4))).assemble(basis)
        self.places = basis.doflocs.T[::3]
        self.elements = basis.element_dofs.T[:, ::3] // 3
        if kind == "hex":
            self.elements[:, :8] = self.elements[:, CORNERS]
        self.bottom = self.places[:, 1] < y.min() + 1e-9
        self.top = self.places[:, 1] > y.max() - 1e-9


class Joint:
    """One to three blocks on one another, the lowest one clamped below or on a rigid plane; loads and friction at random."""

    def __init__(self, seed):
        self.random = random = np.random.default_rng(seed)
        kind, order = random.choice(["hex", "tet"]), int(random.integers(1, 3))
        count = int(random.integers(1, 4))
        cells = [int(random.integers(1, 4 if order == 1 else 3)) for _ in range(2)]
        grid = [np.cumsum([0.0, *random.uniform(0.5, 1, n)]) for n in cells]
        self.solids, y = [], 0.0
        for number in range(count):
            tall = np.cumsum([y, *random.uniform(0.4, 0.8, int(random.integers(1, 3)))])
            # Faces of order 1 may differ: quadrilaterals meet pairs of triangles at the same nodes.
            own = random.choice(["hex", "tet"]) if order == 1 else kind
            self.solids.append(Solid(random, grid[0], tall, grid[1], own, order))
            y = tall[-1]
        self.on_plane = count == 1 or random.random() < 0.4
        self.tied = [bool(random.random() < 0.25) for _ in range(count - 1)]
        if not self.on_plane and all(self.tied):
            self.tied[0] = False
        self.friction = random.uniform(0.05, 0.5)
        self.gaps = [random.uniform(0, 0.2, solid.bottom.sum()) * (random.random() < 0.5) for solid in self.solids]
        self.tractions = {"P": (0.0, -1.0, 0.0), "Q": (0.15, 0.0, 0.05), "R": tuple(random.uniform(-0.1, 0.1, 3))}
        # Supports of two sides, along x and z, hold contact nodes of some bodies; a load may move one of the top body.
        held = random.random() < 0.5
        self.sides = [[held and random.random() < 0.5 for _ in range(2)] for _ in self.solids]
        self.moves = None
        if self.sides[-1][0] and count > 1 and not any(side[0] for side in self.sides[:-1]):
            self.moves = random.uniform(-0.1, 0.1)
        ends = random.uniform(-1, 1, (3, 2)) * self.friction * np.array([6.0, 3.0])
        self.points = [{}, {"P": 1, "Q": 0.1 * self.friction}] + [{"Q": q, "R": r} for q, r in ends]
        if self.moves:
            self.points[2]["U"], self.points[4]["U"] = 1, -0.5

    def solved(self, turn=None, renumber=False, length=1.0, force=1.0):
        """Reduction and states, of the same joint turned, numbered otherwise, in other units."""
        turn = np.eye(3) if turn is None else turn
        random = np.random.default_rng(7)
        bodies, faces, orders = [], [], []
        for number, solid in enumerate(self.solids):
            n = len(solid.places)
            new = random.permutation(n) if renumber else np.arange(n)  # the node of each number
            old = np.argsort(new)
            rows = (3 * new[:, None] + np.arange(3)).ravel()
            T = np.kron(np.eye(n), turn)
            K = (T @ solid.K.toarray() @ T.T)[np.ix_(rows, rows)] * (force / length)
            K = 0.5 * (K + K.T)
            elements = old[solid.elements]
            if renumber:
                elements = elements[random.permutation(len(elements))]
            body = cattaneo.NodalStiffness(K, length * (solid.places @ turn.T)[new], elements=elements, name=f"body {number}")
            if number == 0 and not self.on_plane:
                body.fix(solid.bottom[new], "xyz")
            if number == len(self.solids) - 1:
                for name, traction in self.tractions.items():
                    body.add_traction(name, solid.top[new], tuple(turn @ np.array(traction) * force / length**2))
            else:
                # Each other body has a small load of its own on all nodes.
                for axis, each in zip("xyz", turn @ np.array([0.01, -0.02, 0.01]) * force / n):
                    body.add_forces("P", np.ones(n, bool), axis, each)
            for side, axis in zip(self.sides[number], (0, 2)):
                if not side:
                    continue
                along = np.argmax(np.abs(turn[:, axis]))
                on = (solid.places[:, axis] < 1e-9)[new]
                if axis == 0 and self.moves and number == len(self.solids) - 1:
                    body.add_displacement("U", on, "xyz"[along], self.moves * turn[along, axis] * length)
                else:
                    body.fix(on, "xyz"[along])
            bodies.append(body)
            orders.append(new)
            own = {}
            if number > 0 or self.on_plane:
                own["bottom"] = body.contact_surface(solid.bottom[new])
            if number + 1 < len(self.solids):
                own["top"] = body.contact_surface(solid.top[new])
            faces.append(own)
        condensed = [cattaneo.condense(body, cattaneo.joined(list(own.values()))) for body, own in zip(bodies, faces)]

        def gaps(number):
            """By place, as nodes have other numbers."""
            solid = self.solids[number]
            at = solid.places[solid.bottom]
            given = self.gaps[number]

            def gap(x, y, z):
                place = turn.T @ np.array([x, y, z]) / length
                return length * given[np.argmin(np.abs(at - place).sum(axis=1))]

            return gap

        interfaces = []
        if self.on_plane:
            interfaces.append(cattaneo.Interface("plane", (0, faces[0]["bottom"]), gap=gaps(0)))
        for number in range(1, len(bodies)):
            tied = self.tied[number - 1]
            interfaces.append(
                cattaneo.Interface(
                    f"face {number}",
                    (number, faces[number]["bottom"]),
                    (number - 1, faces[number - 1]["top"]),
                    tied=tied,
                    **({} if tied else {"gap": gaps(number)}),
                )
            )
        reduction = cattaneo.reduce(condensed, interfaces)
        reduction.problem.friction = self.friction
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cattaneo.OutcomeWarning)  # loads that no friction bears
            report = cattaneo.march(reduction.problem, self.points, increments=3, keep_states=True)
        return reduction, bodies, condensed, orders, report


def checked_laws(reduction, states, friction):
    """The largest violation of the laws of contact, over the largest force or opening."""
    problem = reduction.problem
    n = problem.nodes
    slides = ~np.isin(np.arange(2 * n), problem.held).reshape(2, n)  # supports take the rest
    v, worst, stick, slip, open_ = np.zeros((2, n)), 0.0, 0, 0, 0
    force = max(np.abs(state.p).max() for state in states)
    way = max(max(np.abs(state.w).max(), np.abs(state.v).max()) for state in states) + np.abs(problem.gap).max() or 1.0
    for state in states:
        opening, q, p = problem.gap + state.w, state.q.reshape(2, n), np.asarray(state.p)
        q, dv = q * slides, (state.v.reshape(2, n) - v) * slides
        size = np.hypot(*q)
        worst = max(worst, -p.min() / force, -opening.min() / way, (np.minimum(p / force, opening / way)).max())
        worst = max(worst, (size - friction * p).max() / force)
        going = np.hypot(*dv)
        closed = p > 1e-9 * force
        slips = closed & (going > 1e-8 * way)
        open_ += (~closed).sum()
        slip += slips.sum()
        stick += (closed & ~slips).sum()
        if slips.any():
            worst = max(worst, np.abs(q * going + friction * p * dv)[:, slips].max() / (force * going[slips].max()))
        v = state.v.reshape(2, n)
    return worst, (stick, slip, open_)


def balanced(joint, problem, loads):
    """Are there forces within the friction cones (polygons around them) that keep the rigid motions of the bodies in equilibrium?"""
    force = sum(loads.get(load.name, 0) * np.concatenate([load.q, load.p]) for load in problem.patterns)
    n, sides = problem.nodes, 48
    Q = problem.rigid_motions
    corner = 2 * np.pi * np.arange(sides) / sides
    reach = joint.friction / np.cos(np.pi / sides)
    # Each node's force is a sum of edges of its pyramid, none negative.
    ways = np.concatenate([np.concatenate([reach * np.cos(a) * np.eye(n), reach * np.sin(a) * np.eye(n), np.eye(n)]) for a in corner], axis=1)
    size = np.abs(force).max()
    optimize = pytest.importorskip("scipy.optimize")
    return optimize.linprog(np.ones(ways.shape[1]), A_eq=Q.T @ ways, b_eq=Q.T @ force / size, method="highs").status == 0


def checked_equilibrium(joint, reduction, bodies, condensed, state, multipliers):
    """The largest force of a free row that nothing balances, over the largest of all forces."""
    worst = 0.0
    for number, body in enumerate(bodies):
        u = reduction.displacement(number, state)
        forces = {name: values for name, values in body.loads.items() if name != "U"}
        external = sum((multipliers.get(name, 0) * values for name, values in forces.items()), np.zeros(len(u)))
        on_body = reduction.contact_forces(number, state)
        external[condensed[number].surface.dofs] += on_body
        free = np.setdiff1d(np.arange(len(u)), body.fixed)
        internal = body.K @ u
        largest = max(np.abs(external).max(), np.abs(internal).max(), np.abs(on_body).max(), 1e-300)
        worst = max(worst, np.abs(internal - external)[free].max() / largest)
    return worst


def fields(joint, run, turn, length, force):
    """Displacements and contact forces of all bodies at the end, back in the first axes, numbers and units."""
    reduction, bodies, condensed, orders, report = run
    all_fields = []
    for number, new in enumerate(orders):
        u = reduction.displacement(number, report.state).reshape(-1, 3) @ turn / length
        back = np.empty_like(u)
        back[new] = u
        forces = np.zeros_like(u)
        nodes = condensed[number].surface.dofs[:, 0] // 3
        forces[new[nodes]] = reduction.contact_forces(number, report.state) @ turn / force
        all_fields.append((back, forces))
    return all_fields


def examined(seed):
    """All checks of one joint; which states its nodes had."""
    joint = Joint(seed)
    run = joint.solved()
    reduction, bodies, condensed, orders, report = run
    completed = report.state.time == len(joint.points) - 1
    if not completed:
        # Forces can balance the loads where the march ends, and not a little beyond.
        names = [load.name for load in reduction.problem.patterns]
        here, first, last = dict(zip(names, report.state.multipliers)), {}, {}
        for point in joint.points[: int(np.ceil(report.state.time)) + 1]:
            first = dict(last)
            last.update(point)
        beyond = {name: here[name] + 0.02 * (last.get(name, 0) - first.get(name, 0)) for name in names}
        assert balanced(joint, reduction.problem, here)
        assert not balanced(joint, reduction.problem, beyond), report.message
    worst, seen = checked_laws(reduction, report.states, joint.friction)
    assert worst < 1e-7, f"laws: {worst}"
    last = dict(zip((load.name for load in reduction.problem.patterns), report.state.multipliers))
    off = checked_equilibrium(joint, reduction, bodies, condensed, report.state, last)
    assert off < 1e-9, f"equilibrium: {off}"
    expected = fields(joint, run, np.eye(3), 1, 1)
    random = joint.random
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    if np.any(joint.sides):  # supports are along axes
        turn = np.eye(3)[random.permutation(3)] * random.choice([-1, 1], 3)
    turn *= np.sign(np.linalg.det(turn))
    mirror = np.eye(3) - 2 * np.outer(turn[0], turn[0])
    for name, how in (
        ("turned", {"turn": turn}),
        ("mirrored", {"turn": mirror}),
        ("renumbered", {"renumber": True}),
        ("units", {"length": 1e3, "force": 1e-3}),
        ("all", {"turn": mirror @ turn, "renumber": True, "length": 1e-3, "force": 1e6}),
    ):
        if not completed and name != "all":
            continue  # to find the end takes long
        other = joint.solved(**how)
        assert other[-1].state.time == pytest.approx(report.state.time, abs=1e-3), name
        if not completed:
            continue
        found = fields(joint, other, how.get("turn", np.eye(3)), how.get("length", 1), how.get("force", 1))
        for part in (0, 1):
            size = max(np.abs(one[part]).max() for one in expected)
            off = max(np.abs(one[part] - two[part]).max() for one, two in zip(expected, found)) / size
            assert off < 1e-6, f"{name}, {'displacements' if part == 0 else 'forces'}: {off}"
    return seen


@pytest.mark.parametrize("seed", range(SEEDS))
def test_random_joint(seed):
    assert sum(examined(seed)) > 0

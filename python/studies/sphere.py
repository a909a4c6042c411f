"""sphere: spheres in three dimensions, pressed, sheared, twisted and taken around a circle, beside closed forms

Two equal elastic spheres (Hertz, Cattaneo and Mindlin, Lubkin, a circular path of shear), then a rigid one on an elastic
half-space (Spence). Lengths in radii of the contact (a = 1), forces and stresses in any units that fit: the shear modulus is 1.

Sample runs: ./run sphere
             ./run sphere -cells 49 -poisson 0
             ./run sphere -triangles -torque 0.8 -plot sphere.png -json sphere.json
"""

import argparse
import json
import sys
import time

import cattaneo
import numpy as np

RADIUS = 20.0  # of one sphere on a plane; two spheres of twice this radius are as far apart
ONE = cattaneo.MarchSettings(increments=1)  # of each leg: nothing couples, and slip hardly turns


def options(words):
    parser = argparse.ArgumentParser(prog="sphere", description=__doc__.split("\n\n")[1], allow_abbrev=False)
    share = {"type": within(0, 1)}

    def add(name, text, **more):
        parser.add_argument("-" + name, "--" + name, help=text, **more)

    add("cells", "across the contact", type=within(5, 101, int), default=21)
    add("triangles", "irregular triangles in place of squares", action="store_true")
    add("poisson", "of the elastic bodies", type=within(-0.99, 0.5), default=0.3)
    add("friction", "coefficient", type=within(1e-3, 10), default=0.3)
    add("shear", "amplitude of a cycle of shear, over f P", default=0.7, **share)
    add("torque", "over what spins the spheres, 3π f P a/16", default=0.5, **share)
    add("circle", "radius of a circular path of shear, over f P", default=0.5, **share)
    add("increments", "of each eighth of the circle", type=within(1, 1000, int), default=4)
    add("stages", "of pressing the rigid sphere", type=within(2, 100, int), default=10)
    add("json", "file for the results", metavar="FILE")
    add("plot", "picture of the results (needs matplotlib)", metavar="FILE")
    add("vtu", "prefix of files for ParaView: the states after shear, torsion and circle", metavar="PREFIX")
    return parser.parse_args(words)


def within(least, most, kind=float):
    """A number between these, both excluded unless whole."""

    def read(text):
        try:
            value = kind(text)
        except ValueError:
            value = np.nan
        if kind is int and least <= value <= most or least < value < most:
            return value
        raise argparse.ArgumentTypeError(f"{text} must be {'a whole number ' if kind is int else ''}from {least} to {most}")

    return read


# -- closed forms, of G = 1 and a = 1 ------------------------------------------------------------------


def elliptic(k):
    """Complete elliptic integrals K(k) and E(k), by the arithmetic-geometric mean."""
    a, b, c, sum, power = 1.0, np.sqrt(1 - k * k), k, k * k / 2, 0.5
    for _ in range(12):  # digits double with each
        a, b, c = (a + b) / 2, np.sqrt(a * b), (a - b) / 2
        power *= 2
        sum += power * c * c
    return np.pi / (2 * a), np.pi / (2 * a) * (1 - sum)


def torque_of(c):
    """Lubkin's torque over f P a at which r > c slips."""
    points, weights = np.polynomial.legendre.leggauss(60)
    r = c + (1 - c) * (points + 1) / 2
    return 4 / np.pi * (1 - c) / 2 * (weights * r * r * np.array([elliptic(np.sqrt(1 - s * s))[1] for s in r])).sum()


def stick_of_torque(share):
    low, high = 0.0, 1.0
    for _ in range(60):
        c = (low + high) / 2
        low, high = (c, high) if torque_of(c) > share * 3 * np.pi / 16 else (low, c)
    return c


class Cattaneo:
    """Two equal spheres; exact for ν = 0."""

    def __init__(self, poisson, friction, load):
        self.limit = friction * load
        self.full = 3 * self.limit / 16 * 2 * (2 - poisson)

    def shift(self, share):
        return self.full * (1 - (1 - share) ** (2 / 3))

    def loss(self, share):
        """Of a cycle between ± this share, by Masing's rule."""
        under = self.full * (share - 0.6 * (1 - (1 - share) ** (5 / 3)))
        return self.limit * (4 * share * self.shift(share) - 8 * under)


# -- the contact ---------------------------------------------------------------------------------------


def disc(edge, reach):
    """Irregular triangles of about this edge: vertices of rings, moved by up to a fifth, the same ones every time."""
    random = np.random.default_rng(1)
    rings = int(np.ceil(reach / edge))
    vertices, triangles = [(0.0, 0.0)], []
    first = [0, *(1 + 3 * k * (k - 1) for k in range(1, rings + 1))]

    def number(ring, place):
        return first[ring] + (place % (6 * ring) if ring else 0)

    for ring in range(1, rings + 1):
        move = 0.2 * random.uniform(-1, 1, (6 * ring, 2)) * (ring < rings)
        r, angle = reach / rings * (ring + move[:, 0]), np.pi / 3 * (np.arange(6 * ring) + move[:, 1]) / ring
        vertices += list(zip(r * np.cos(angle), r * np.sin(angle)))
        for sixth in range(6):
            within, out = sixth * (ring - 1), sixth * ring
            for k in range(ring):
                triangles.append((number(ring - 1, within + k), number(ring, out + k), number(ring, out + k + 1)))
                if k < ring - 1:
                    triangles.append((number(ring - 1, within + k), number(ring, out + k + 1), number(ring - 1, within + k + 1)))
    return np.array(vertices), np.array(triangles)


def contact(material, other, asked, turns=False):
    """The half-spaces and their problem, with the gap of a sphere."""
    edge = 2 / asked.cells
    reach = 1 + 2 * edge
    if asked.triangles:
        # Half of an equilateral triangle's height more than a square's edge: as many triangles as squares.
        vertices, triangles = disc(edge * 1.5, reach)
        space = cattaneo.HalfSpace(material, other, vertices=vertices, triangles=triangles, turns=turns)
        middles = (vertices[triangles] + vertices[np.roll(triangles, 1, axis=1)]) / 2
        gap = (middles**2).sum(axis=2).mean(axis=1) / (2 * RADIUS)  # the mean over each triangle
    else:
        half = int(np.ceil(reach / edge))
        x, y = (axis.ravel() for axis in np.meshgrid(*2 * [edge * np.arange(-half, half + 1)]))
        inside = np.hypot(x, y) < reach
        space = cattaneo.HalfSpace(material, other, size=edge, centres=np.column_stack([x[inside], y[inside]]), turns=turns)
        gap = (space.centres**2).sum(axis=1) / (2 * RADIUS)
    problem = space.problem(gap)
    problem.friction = asked.friction
    return space, problem


class Stopped(Exception):
    """A march that ended before its last load, with a message."""


def march(problem, points, settings=ONE, keep_states=False):
    result = cattaneo.march(problem, [{}, *points], settings=settings, keep_states=keep_states)
    if str(result.status) != "converged":
        raise Stopped(result.message)
    return result


def moved(problem, state, load):
    return cattaneo.conjugates(problem, state)[problem.loads.index(load)]


# -- results -------------------------------------------------------------------------------------------


class Table:
    """Rows that are printed as they come, and go to JSON: computed, closed form, and an estimate of the error if there is one."""

    def __init__(self):
        self.rows = {}
        print(f"{'':44} {'computed':>12} {'closed form':>12} {'apart':>10}")

    def add(self, name, computed, exact=np.nan, error=np.nan):
        self.rows[name] = {"computed": computed, "closed_form": exact, "error_estimate": error}
        apart = "" if np.isnan(exact) else f" {exact:12.5e} {100 * (computed / exact - 1):8.3f} %"
        print(f"{name:44} {computed:12.5e}{apart}" + ("" if np.isnan(error) else f"   ± {error:.1e}"))

    def add_edge(self, name, edge, exact):
        self.add(name, edge.radius, exact, edge.error)


def equal_spheres(asked, table):
    """@return the half-spaces, their problem, states by title, and a loop of shear."""
    material = cattaneo.Material(young=2 * (1 + asked.poisson), poisson=asked.poisson)
    space, problem = contact(material, material, asked, turns=True)
    load = 4 / 3 / (1 - asked.poisson) / RADIUS  # E* = G/(1 - ν)
    limit = asked.friction * load
    table.add("cells", float(len(space.areas)))

    # 1. Hertz.
    pressed = {"P": load}
    state = march(problem, [pressed]).state
    table.add("Hertz: approach", moved(problem, state, "P"), 1 / RADIUS)
    # A cell in the middle: the mean over it is less than the peak by its area's share.
    middle = np.argmin(np.hypot(*space.middles.T))
    table.add("Hertz: pressure in the middle", state.p[middle] / space.areas[middle], 1.5 * load / np.pi)
    table.add_edge("Hertz: radius", cattaneo.readout.radial_edges(problem, state).contact, 1.0)

    # 2. Cattaneo and Mindlin: first loading, then a cycle.
    closed = Cattaneo(asked.poisson, asked.friction, load)
    corners = [{"P": load, "Q1": sign * asked.shear * limit} for sign in (1, -1, 1)]
    run = march(problem, [pressed, *corners], cattaneo.MarchSettings(increments=8), keep_states=True)
    sheared = run.states[-17]
    table.add("Cattaneo and Mindlin: shift", moved(problem, sheared, "Q1"), closed.shift(asked.shear))
    table.add_edge("Cattaneo and Mindlin: radius of stick", cattaneo.readout.radial_edges(problem, sheared).stick, np.cbrt(1 - asked.shear))
    lost = run.state.dissipation - sheared.dissipation
    table.add("Cattaneo and Mindlin: loss of a cycle", lost, closed.loss(asked.shear))
    loop = [(moved(problem, each, "Q1"), problem_load(problem, each, "Q1")) for each in run.states[-25:]]

    # 3. Torsion, by Lubkin: exact for any ν, as nothing couples.
    torque = asked.torque * 3 * np.pi / 16 * limit
    twisted = march(problem, [pressed, {"P": load, "T": torque}]).state
    c = stick_of_torque(asked.torque)
    K, E = elliptic(np.sqrt(1 - c * c))
    table.add("Lubkin: turn", moved(problem, twisted, "T"), 3 * limit * (K - E) / (2 * np.pi))
    table.add_edge("Lubkin: radius of stick", cattaneo.readout.radial_edges(problem, twisted).stick, c)

    # 4. Around a circle: slip turns in every increment, so that the loss is extrapolated from three marches.
    Q = asked.circle * limit
    corners = [{"P": load, "Q1": Q * np.cos(angle), "Q2": Q * np.sin(angle)} for angle in np.linspace(0, 2 * np.pi, 9)]
    around = march(problem, [pressed, *corners], cattaneo.MarchSettings(increments=asked.increments, loss_error=True))
    table.add("circle: loss of the first turn", around.dissipation.sum(), error=around.loss_error)
    table.add("circle: the same without increments", around.extrapolated_loss)
    return space, problem, {"sheared": sheared, "twisted": twisted, "around a circle": around.state}, loop


def problem_load(problem, state, load):
    return state.multipliers[problem.loads.index(load)]


def rigid_sphere(asked, table):
    """Spence: it slips while it is pressed, and the radius of stick stays in proportion to that of contact."""
    material = cattaneo.Material(young=2 * (1 + asked.poisson), poisson=asked.poisson)
    problem = contact(material, None, asked)[1]
    load = 8 / 3 / (1 - asked.poisson) / RADIUS
    shares = np.linspace(0, 1, asked.stages + 1)[1:]  # of the last radius of contact
    states = march(problem, [{"P": load * share**3} for share in shares], keep_states=True).states[-asked.stages:]
    for share, state in zip(shares, states):
        if share < 0.5:  # a few cells in contact, and few stages of slip
            continue
        edges = cattaneo.readout.radial_edges(problem, state)
        ratio = edges.stick.radius / edges.contact.radius
        error = (edges.stick.error + ratio * edges.contact.error) / edges.contact.radius
        table.add(f"Spence: stick over contact, a = {share:.3g}", ratio, error=error)


def draw(name, space, problem, states, loop, asked):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import PolyCollection

    figure, axes = plt.subplots(1, 4, figsize=(19, 4.4), layout="constrained")
    if asked.triangles:
        cells = space.vertices[space.triangles]
    else:
        cells = space.centres[:, None] + space.size / 2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    for axis, (title, state) in zip(axes, states.items()):
        q = state.q.reshape(2, -1) / space.areas
        shear = PolyCollection(cells, array=np.hypot(*q), cmap="viridis")
        axis.add_collection(shear)
        some = slice(None, None, max(1, len(space.areas) // 400))
        axis.quiver(*space.middles[some].T, *q[:, some], color="white")
        settled = cattaneo.settled_states(problem, state)
        for which, colour in ((settled != cattaneo.NodeState.separation, "black"), (settled == cattaneo.NodeState.stick, "red")):
            for line in space.outlines(which):
                axis.plot(*line.T, color=colour, linewidth=1)
        axis.set(title=title + ": contact black, stick red", aspect="equal", xlim=(-1.2, 1.2), ylim=(-1.2, 1.2), xlabel="x/a", ylabel="y/a")
        figure.colorbar(shear, ax=axis, label="shear traction/G")
    axes[3].plot(*np.array(loop).T, marker=".")
    axes[3].set(title="a cycle of shear", xlabel="shift/a", ylabel="force/(G a²)")
    figure.savefig(name, dpi=100)


def main(words=None):
    asked = options(words)
    began = time.perf_counter()
    table = Table()
    try:
        space, problem, states, loop = equal_spheres(asked, table)
        rigid_sphere(asked, table)
    except Stopped as end:
        print(end, file=sys.stderr)
        return 2
    seconds = time.perf_counter() - began
    print(f"{seconds:.2f} s")
    if asked.json:
        # JSON has no word for a number that there is not.
        rows = {name: {key: None if np.isnan(each) else each for key, each in row.items()} for name, row in table.rows.items()}
        result = {"status": "converged", "options": vars(asked), "values": rows, "loop": {"shift": [d for d, _ in loop], "force": [Q for _, Q in loop]}, "seconds": seconds}
        with open(asked.json, "w") as file:
            json.dump(result, file, indent=1)
    for title, state in states.items() if asked.vtu else ():
        space.write_vtu(f"{asked.vtu}_{title.split()[-1]}.vtu", problem, state)
    if asked.plot:
        draw(asked.plot, space, problem, states, loop, asked)
    return 0


if __name__ == "__main__":
    sys.exit(main())

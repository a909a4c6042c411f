"""CalculiX on two of the studies and on a sphere in space: writes its decks, runs it, reads its results. Used by peers.py.

Plane strain, quadrilaterals of order 1 or 2, graded as ours, face-to-face penalty contact. Units as in the studies. The
loads are consistent nodal forces, the same as ours. Penalties are PENALTY contact moduli over the element size at the
contact: what remains of them is seen by changing it."""
import math
import os
import re
import resource
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "meshes"))
import solids  # noqa: E402

SCALE = 1e-4  # of the displacements, by stiffer bodies: contact is sought between displaced faces, and the studies are
              # of small displacements (smaller loads would meet absolute tolerances)
PENALTY = 50.0  # normal stiffness of the contact over E/length; the stick slope is a tenth of it


def graded(length, smallest, growth, largest):
    """Points from 0 to length, spacing growing from `smallest`."""
    points, h = [0.0], smallest
    while points[-1] < length:
        points.append(points[-1] + h)
        h = min(h * growth, largest)
    scale = length / points[-1]
    return [x * scale for x in points]


def graded_to_ends(half, intervals, ratio):
    """Points from -half to half: spacing falls geometrically to `ratio` of the middle one at both ends."""
    m = intervals // 2
    sizes = [ratio ** (k / max(m - 1, 1)) for k in range(m)]
    scale = half / sum(sizes)
    right = [0.0]
    for s in sizes:
        right.append(right[-1] + s * scale)
    right[-1] = half
    return [-x for x in reversed(right[1:])] + right


class Deck:
    """Nodes and elements of rectangles, on a grid of points that order 2 fills with the middles."""

    def __init__(self, order):
        self.order, self.lines, self.nodes, self.elements = order, [], [], []
        self.loads = {}

    def rectangle(self, name, xs, ys, material):
        o = self.order
        fine = lambda c: c if o == 1 else sorted(c + [(a + b) / 2 for a, b in zip(c, c[1:])])
        X, Y = fine(xs), fine(ys)
        node = {}
        for j, y in enumerate(Y):
            for i, x in enumerate(X):
                if o == 2 and i % 2 and j % 2:
                    continue  # serendipity: no middle
                self.nodes.append((x, y))
                node[i, j] = len(self.nodes)
        first = len(self.elements) + 1
        for j in range(len(ys) - 1):
            for i in range(len(xs) - 1):
                a, b = o * i, o * j
                corners = [node[a, b], node[a + o, b], node[a + o, b + o], node[a, b + o]]
                if o == 2:
                    corners += [node[a + 1, b], node[a + 2, b + 1], node[a + 1, b + 2], node[a, b + 1]]
                self.elements.append((name, corners))
        cols, rows = len(xs) - 1, len(ys) - 1
        edge = lambda js: [node[i, js] for i in range(len(X)) if (i, js) in node]
        part = {"bottom": [first + i for i in range(cols)], "top": [first + (rows - 1) * cols + i for i in range(cols)],
                "left": [first + j * cols for j in range(rows)], "right": [first + j * cols + cols - 1 for j in range(rows)],
                "bottom nodes": edge(0), "top nodes": edge(len(Y) - 1),
                "left nodes": [node[0, j] for j in range(len(Y)) if (0, j) in node],
                "right nodes": [node[len(X) - 1, j] for j in range(len(Y)) if (len(X) - 1, j) in node],
                "X": X, "Y": Y, "all": list(node.values()), "material": material, "name": name}
        return part

    def edge_forces(self, nodes, coordinates, component, density):
        """Consistent nodal forces of a piecewise linear density (exact: three Gauss points, intervals cut where it jumps
        are the caller's)."""
        gauss = [(-0.7745966692414834, 5 / 9), (0.0, 8 / 9), (0.7745966692414834, 5 / 9)]
        forces = {}
        step = self.order
        for k in range(0, len(coordinates) - 1, step):
            a, b = coordinates[k], coordinates[k + step]
            for s, w in gauss:
                x = (a + b) / 2 + (b - a) / 2 * s
                f = density(x) * w * (b - a) / 2
                shapes = ((1 - s) / 2, (1 + s) / 2) if step == 1 else (s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2)
                for m, N in enumerate(shapes):
                    forces[nodes[k + m], component] = forces.get((nodes[k + m], component), 0.0) + N * f
        return forces

    def write(self, file, parts, fixed, contact, friction, modulus, size, steps, printed):
        """`steps`: list of (increment, {(node, component): force}), absolute loads at the end of each."""
        kind = "CPE4" if self.order == 1 else "CPE8"
        with open(file, "w") as f:
            say = lambda *text: print(*text, file=f)
            say("*NODE, NSET=ALL")
            for k, (x, y) in enumerate(self.nodes):
                say("%d, %.12g, %.12g, 0" % (k + 1, x, y))
            for part in parts:
                say("*ELEMENT, TYPE=%s, ELSET=%s" % (kind, part["name"]))
                for k, (name, nodes) in enumerate(self.elements):
                    if name == part["name"]:
                        say(", ".join(str(n) for n in [k + 1] + nodes))
                young, poisson = part["material"]
                say("*MATERIAL, NAME=M%s\n*ELASTIC\n%.12g, %.12g" % (part["name"], young / SCALE, poisson))
                say("*SOLID SECTION, ELSET=%s, MATERIAL=M%s\n1." % (part["name"], part["name"]))
            say("*BOUNDARY")
            for node, component in fixed:
                say("%d, %d, %d" % (node, component, component))
            for name, elements, face in contact:
                say("*SURFACE, NAME=%s, TYPE=ELEMENT" % name)
                for e in elements:
                    say("%d, %s" % (e, face))
            say("*NSET, NSET=PRINTED")
            for n in printed:
                say("%d," % n)
            penalty = PENALTY * modulus / SCALE / size
            say("*SURFACE INTERACTION, NAME=LAW\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%.12g\n*FRICTION\n%.12g, %.12g"
                % (penalty, friction, penalty / 10))
            say("*CONTACT PAIR, INTERACTION=LAW, TYPE=SURFACE TO SURFACE\n%s, %s" % (contact[0][0], contact[1][0]))
            for increment, loads in steps:
                say("*STEP, INC=10000\n*STATIC\n%.6g, 1., 1e-6, %.6g" % (increment, increment))
                say("*CLOAD, OP=MOD")
                for (node, component), force in sorted(loads.items()):
                    say("%d, %d, %.12g" % (node, component, force))
                say("*NODE PRINT, NSET=PRINTED, FREQUENCY=1000000\nU")
                say("*CONTACT PRINT, FREQUENCY=1000000\nCDIS, CSTR\n*END STEP")


def run(folder, name, limit):
    """Runs a deck: seconds of CPU, MB at the peak, and its results; None if it failed. At most `limit` seconds of CPU."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    process = subprocess.Popen(["ccx", "-i", name], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1)))
    output = process.stdout.read().decode(errors="replace")
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if os.WIFSIGNALED(status):
        return None, "*ERROR: no end within %d s" % limit
    if status != 0 or "Job finished" not in output:
        return None, output
    with open(os.path.join(folder, name + ".dat")) as f:
        dat = f.read()
    equations = [int(n) for n in re.findall(r"number of equations\s+(\d+)", output)]
    iterations = len(re.findall(r"^ iteration\s+\d+", output, re.MULTILINE))
    return {"seconds": usage.ru_utime + usage.ru_stime, "MB": usage.ru_maxrss / 1024,
            "dofs": equations[0] if equations else 0, "iterations": iterations, "dat": dat}, output


def blocks(dat, title):
    """The tables of that title, one a step, as lists of rows of numbers."""
    tables = []
    for block in re.split(r"\n(?= [a-z])", dat):
        head, _, body = block.partition("\n")
        if head.strip().startswith(title):
            tables.append([[float(x) for x in re.findall(r"[-+]?\d+\.?\d*(?:[Ee][-+]?\d+)?", line)] for line in body.strip().split("\n") if line.strip()])
    return tables


def punch(folder, order, intervals, name="punch", increments=(5, 10)):
    """The square punch on a rigid plane, f = 0.2, P = 1, then Q = 0.5 f P."""
    f, Q = 0.2, 0.1
    deck = Deck(order)
    xs = graded_to_ends(1.0, intervals, 0.05)
    smallest = xs[1] - xs[0]
    block = deck.rectangle("BLOCK", xs, graded(2.0, smallest, 1.3, 0.2), (0.91, 0.3))
    plane = deck.rectangle("PLANE", [-1.5, 1.5], [-0.5, 0.0], (0.91, 0.3))
    fixed = [(n, c) for n in plane["all"] for c in (1, 2)]
    P = deck.edge_forces(block["top nodes"], block["X"], 2, lambda x: -0.5)
    shear = dict(P)
    for key, force in list(deck.edge_forces(block["top nodes"], block["X"], 1, lambda x: 0.5 * Q).items()) + \
            list(deck.edge_forces(block["top nodes"], block["X"], 2, lambda x: 3 * x * Q).items()):
        shear[key] = shear.get(key, 0.0) + force
    deck.write(os.path.join(folder, name + ".inp"), [block, plane], fixed,
               [("SLAVE", block["bottom"], "S1"), ("MASTER", plane["top"], "S3")], f, 0.91, smallest,
               [(1 / increments[0], P), (1 / increments[1], shear)], block["bottom nodes"])
    return dict(zip(block["bottom nodes"], block["X"]))


def front(points, values, noise):
    """Where a profile that grows as the 3/2 power of the distance sets out from zero: `points` go from the zero side
    outward. Line through values^(2/3) of the first four points above the noise."""
    above = [k for k, v in enumerate(values) if abs(v) > noise]
    first = next(k for k in above if all(j in above for j in range(k, min(k + 4, len(values)))))
    x, y = points[first:first + 4], [abs(v) ** (2 / 3) for v in values[first:first + 4]]
    n, sx, sy = len(x), sum(x), sum(y)
    slope = (n * sum(a * b for a, b in zip(x, y)) - sx * sy) / (n * sum(a * a for a in x) - sx * sx)
    return (sx - sy / slope) / n


def punch_results(result, position):
    """Stick half-width and corner slip under P, right end of the stick zone under Q."""
    after_p, after_q = ({int(row[0]): row[1] / SCALE for row in table} for table in blocks(result["dat"], "displacements"))
    nodes = sorted(position, key=position.get)
    xs = [position[n] for n in nodes]
    v = [after_p[n] for n in nodes]
    change = [after_q[n] - after_p[n] for n in nodes]
    middle = len(nodes) // 2
    share = 0.01  # more than the elastic slip of the penalty, less than the first slipping node
    return {"stick half-width": front(xs[middle:], v[middle:], share * abs(v[-1])), "corner slip": abs(v[-1]),
            "stick end at Q": front(xs, change, share * max(change))}


def lap_joint(folder, order, spacing, name="lap", increments=(5, 10)):
    """Two laps pinched by a bolt (P0 = 1 over |x| < 1/2) and pulled by T = 0.04; f = 0.2, t = 1."""
    f, T, protrusion, remote = 0.2, 0.04, 1.95, 16.0
    deck = Deck(order)
    count = 2 * round(1.0 / spacing)
    near = [-1 + 2 * k / count for k in range(count + 1)]  # |x| <= 1, with the edges of the load
    out = [x + 1 for x in graded(protrusion - 1, spacing, 1.2, 0.1)][1:]
    far = [x + protrusion for x in graded(remote - protrusion, 0.1, 1.3, 1.0)][1:]
    right = near + out
    overlap = [-x for x in reversed(out)] + right
    ys = graded(0.5, spacing, 1.2, 0.1)
    middle = min(ys, key=lambda y: abs(y - 0.25))
    ys[ys.index(middle)] = 0.25
    upper = deck.rectangle("UPPER", [-x for x in reversed(far)] + overlap, ys, (0.91, 0.3))
    lower = deck.rectangle("LOWER", overlap + far, [-y for y in reversed(ys)], (0.91, 0.3))
    at = lambda part, edge, axis, value: min(part[edge], key=lambda n: abs(deck.nodes[n - 1][axis] - value))
    fixed = [(at(upper, "left nodes", 1, 0.25), 2), (at(lower, "right nodes", 1, -0.25), 2),
             (at(lower, "top nodes", 0, 0.0), 1)]
    # Bears nothing, as the joint turned by 180 degrees is itself, but keeps the first iterations together.
    fixed.append((at(upper, "bottom nodes", 0, 0.0), 1))
    cut = lambda x: 1.0 if abs(x) < 0.5 else 0.0
    pinch = deck.edge_forces(upper["top nodes"], upper["X"], 2, lambda x: -cut(x))
    pinch.update(deck.edge_forces(lower["bottom nodes"], lower["X"], 2, cut))
    pulled = dict(pinch)
    for forces in (deck.edge_forces(upper["left nodes"], upper["Y"], 1, lambda y: -2 * T),
                   deck.edge_forces(lower["right nodes"], lower["Y"], 1, lambda y: 2 * T)):
        for key, force in forces.items():
            pulled[key] = pulled.get(key, 0.0) + force
    side = lambda part, edge: {round(deck.nodes[n - 1][0], 9): n for n in part[edge] if abs(deck.nodes[n - 1][0]) < protrusion + 1e-9}
    above, below = side(upper, "bottom nodes"), side(lower, "top nodes")
    deck.write(os.path.join(folder, name + ".inp"), [upper, lower], fixed,
               [("SLAVE", upper["bottom"], "S1"), ("MASTER", lower["top"], "S3")], f, 0.91, spacing,
               [(1 / increments[0], pinch), (1 / increments[1], pulled)], list(above.values()) + list(below.values()))
    return {x: (above[x], below[x]) for x in sorted(above)}


def lap_joint_results(result, pairs):
    """Half-length of contact after the pinch and at T, half-length of stick at T."""
    xs = [x for x in pairs if x >= 0]
    slip, opening = [], []
    for table in blocks(result["dat"], "displacements"):
        u = {int(row[0]): [x / SCALE for x in row[1:3]] for row in table}
        slip.append([u[pairs[x][0]][0] - u[pairs[x][1]][0] for x in xs])
        opening.append([max(0, u[pairs[x][0]][1] - u[pairs[x][1]][1]) for x in xs])
    return lap_lengths(xs, opening, [b - a for a, b in zip(*slip)])


def lap_lengths(xs, opening, change):
    return {"contact half-length": front(xs, opening[0], 0.003 * max(opening[0])),
            "contact half-length at T": front(xs, opening[1], 0.003 * max(opening[1])),
            "stick half-length at T": front(xs, change, 0.02 * max(abs(s) for s in change))}


class Space:
    """A deck of C3D8: bodies, each with its mesh and material, and one contact pair."""
    SIDES = {"S1": (0, 1, 2, 3), "S2": (4, 5, 6, 7), "S3": (0, 1, 5, 4), "S4": (1, 2, 6, 5), "S5": (2, 3, 7, 6), "S6": (3, 0, 4, 7)}

    def __init__(self):
        self.bodies, self.places, self.fixed, self.equations, self.forces = {}, [], set(), [], [{}]

    def add(self, name, mesh, young, poisson):
        self.bodies[name] = (mesh, len(self.places), young, poisson)
        self.places += mesh.nodes

    def nodes(self, body, *parts):
        """Numbers of the nodes of parts of a body."""
        mesh, first, _, _ = self.bodies[body]
        return sorted({first + p + 1 for name, face in mesh.faces if name in parts for p in face})

    def nearest(self, body, x, y):
        """All nodes of a body at the (x, y) of the node that lies nearest to it."""
        mesh, first, _, _ = self.bodies[body]
        at = min(mesh.nodes, key=lambda node: math.hypot(node[0] - x, node[1] - y))
        return [first + k + 1 for k, node in enumerate(mesh.nodes) if math.hypot(node[0] - at[0], node[1] - at[1]) < 1e-9]

    def fix(self, nodes, *components):
        self.fixed |= {(n, c) for n in nodes for c in components}

    def traction(self, body, part, component, density):
        """Adds consistent forces of a constant density on a part of rectangles to those of this step."""
        mesh, first, _, _ = self.bodies[body]
        for name, face in mesh.faces:
            if name == part:
                a, b, _, d = (mesh.nodes[p] for p in face)
                area = math.dist(a, b) * math.dist(a, d)
                for p in face:
                    key = (first + p + 1, component)
                    self.forces[-1][key] = self.forces[-1].get(key, 0.0) + density * area / 4

    def write(self, file, slave, master, friction, penalty, increments, printed, contact="SURFACE TO SURFACE"):
        """`slave` and `master`: body and names of parts; `self.forces`: those at the end of each step."""
        with open(file, "w") as f:
            say = lambda *text: print(*text, file=f)
            say("*NODE, NSET=ALL")
            for k, at in enumerate(self.places, 1):
                say("%d, %.12g, %.12g, %.12g" % (k, *at))
            side_of, count = {}, 0
            for name, (mesh, first, young, poisson) in self.bodies.items():
                say("*ELEMENT, TYPE=C3D8, ELSET=%s" % name)
                for cell in mesh.cells:
                    count += 1
                    say(", ".join(str(n) for n in [count] + [first + p + 1 for p in cell]))
                    for side, corners in self.SIDES.items():
                        side_of[name, tuple(sorted(cell[c] for c in corners))] = (count, side)
                say("*MATERIAL, NAME=M%s\n*ELASTIC\n%.12g, %.12g\n*SOLID SECTION, ELSET=%s, MATERIAL=M%s" % (name, young, poisson, name, name))
            say("*BOUNDARY")
            for node, component in sorted(self.fixed):
                say("%d, %d, %d" % (node, component, component))
            if self.equations:
                say("*EQUATION")
            for node, component, other in self.equations:
                say("2\n%d, %d, 1., %d, %d, -1." % (node, component, other, component))
            for name, parts in (slave, master):
                say("*SURFACE, NAME=S%s, TYPE=ELEMENT" % name)
                for part, face in self.bodies[name][0].faces:
                    if part in parts:
                        say("%d, %s" % side_of[name, tuple(sorted(face))])
            say("*NSET, NSET=PRINTED")
            for n in printed:
                say("%d," % n)
            say("*SURFACE INTERACTION, NAME=LAW")
            if contact == "SURFACE TO SURFACE":
                say("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%.12g\n*FRICTION\n%.12g, %.12g" % (penalty, friction, penalty / 10))
            else:
                say("*FRICTION\n%.12g" % friction)
            say("*CONTACT PAIR, INTERACTION=LAW, TYPE=%s\nS%s, S%s" % (contact, slave[0], master[0]))
            for number, forces in zip(increments, self.forces):
                say("*STEP, INC=10000\n*STATIC\n%.6g, 1., 1e-6, %.6g\n*CLOAD, OP=MOD" % (1 / number, 1 / number))
                for (node, component), force in sorted(forces.items()):
                    say("%d, %d, %.12g" % (node, component, force))
                say("*NODE PRINT, NSET=PRINTED, FREQUENCY=1000000\nU\n*END STEP")


YOUNG, RADIUS, PRESS, SPHERE_FRICTION, SHEAR = 210e3, 50.0, 1000.0, 0.3, 0.5  # of the sphere; ν = 0, Q = SHEAR f P


def sphere_references():
    """Hertz, Cattaneo and Mindlin, for whom ν = 0 is exact: radius of contact, of stick, largest pressure."""
    a = (0.75 * PRESS * RADIUS / (YOUNG / 2)) ** (1 / 3)
    return {"contact radius": a, "stick radius": a * (1 - SHEAR) ** (1 / 3), "peak pressure": 1.5 * PRESS / (math.pi * a * a)}


def sphere_meshes(across, lowered=0.0):
    """Halves of a pin with a spherical end and of a block, on one plan: `across` elements across 0.6 mm at the contact."""
    reach, step = 0.9, 0.6 / across
    rings = round((reach - 0.3) / step)
    plan = solids.disc(0.3, across, [0.3 + (reach - 0.3) * k / rings for k in range(1, rings + 1)] + solids.growing(reach, 10.0, 1.6 * step, 1.6)[1:])
    face = lambda x, y: "contact" if math.hypot(x, y) < reach else "rim"
    end = lambda x, y, z: (x, y, z - lowered + (RADIUS - math.sqrt(RADIUS**2 - x * x - y * y)) * (1 - z / 10))
    depth = solids.growing(0.0, 10.0, step, 1.6)
    return solids.ended(solids.layers(plan, depth, end, low=face, high="far"), "cut", 10.0), solids.layers(plan, [-z for z in reversed(depth)], low="far", high=face)


def sphere(folder, across, name="sphere", increments=(5, 10), contact="SURFACE TO SURFACE"):
    """Pressed by P, then sheared by Q, halves of both. The pin is lowered a little, which its motion takes up: without contact nothing would
    hold it in the first iteration."""
    lowered = 0.002
    deck = Space()
    for body, mesh in zip(("PIN", "BLOCK"), sphere_meshes(across, lowered)):
        deck.add(body, mesh, YOUNG, 0)
        deck.fix(deck.nodes(body, "cut", "cut_end"), 2)
    top = deck.nodes("PIN", "far")
    deck.fix(top, 2)
    deck.fix(deck.nodes("BLOCK", "far"), 1, 2, 3)
    deck.equations = [(n, c, top[0]) for n in top[1:] for c in (1, 3)]
    deck.forces = [{(top[0], 3): -PRESS / 2}, {(top[0], 1): SHEAR * SPHERE_FRICTION * PRESS / 2}]
    # Nodes on the axis of the shear face each other.
    above, below = ({round(deck.places[n - 1][0], 9): n for n in deck.nodes(body, "contact") if deck.places[n - 1][1] == 0 <= deck.places[n - 1][0]}
                    for body in ("PIN", "BLOCK"))
    penalty = PENALTY * YOUNG / (0.6 / across)
    deck.write(os.path.join(folder, name + ".inp"), ("PIN", ("contact",)), ("BLOCK", ("contact", "rim")), SPHERE_FRICTION, penalty, increments,
               list(above.values()) + list(below.values()), contact)
    return {x: (above[x], below[x], RADIUS - math.sqrt(RADIUS**2 - x * x) - lowered) for x in sorted(above)}, penalty


def sphere_results(result, asked):
    """Pressure and shear are those of the penalties on overlap and elastic slip."""
    pairs, penalty = asked
    after_p, after_q = ({int(row[0]): row[1:4] for row in table} for table in blocks(result["dat"], "displacements"))
    overlap = [after_p[below][2] - after_p[above][2] - gap for above, below, gap in pairs.values()]
    slip = [u[above][0] - u[below][0] for u in (after_p, after_q) for above, below, _ in list(pairs.values())[:1]]
    return sphere_lengths(list(pairs), [penalty * max(0, w) for w in overlap], penalty / 10 * abs(slip[1] - slip[0]))


def sphere_lengths(xs, pressures, shear):
    """From pressures along a radius and the shear at its centre. Squares of the pressures are linear in those of the radii: a line through those
    above 0.3 of the largest one has its zero at the edge. At the centre, in stick, the shear is f p0 (1 - c/a)."""
    used = [(x * x, p * p) for x, p in zip(xs, pressures) if p > 0.3 * max(pressures)]
    n, sx, sy = len(used), sum(x for x, _ in used), sum(y for _, y in used)
    slope = (n * sum(x * y for x, y in used) - sx * sy) / (n * sum(x * x for x, _ in used) - sx * sx)
    peak = ((sy - slope * sx) / n) ** 0.5
    a = peak / (-slope) ** 0.5
    return {"contact radius": a, "stick radius": a * (1 - shear / (SPHERE_FRICTION * peak)), "peak pressure": peak}


def slice_meshes(spacing, thick=0.1):
    """The laps of lap_joint() as slices of one layer of hexahedra: `pinch` on |x| < 1/2, `face` on |x| < 1.95, `pull` at the far end, `wall`."""
    protrusion, remote = 1.95, 16.0
    count = 2 * round(1.0 / spacing)
    near = [-1 + 2 * k / count for k in range(count + 1)]
    out = [x + 1 for x in graded(protrusion - 1, spacing, 1.2, 0.1)][1:]
    far = [x + protrusion for x in graded(remote - protrusion, 0.1, 1.3, 1.0)][1:]
    xs = [-x for x in reversed(far)] + [-x for x in reversed(out)] + near + out
    ys = graded(0.5, spacing, 1.2, 0.1)
    ys[ys.index(min(ys, key=lambda y: abs(y - 0.25)))] = 0.25
    columns, made = len(xs), []
    for turn in (1, -1):
        points = [(turn * x, turn * y) for y in ys for x in xs]
        cells = [(k, k + 1, k + 1 + columns, k + columns) for j in range(len(ys) - 1) for k in range(j * columns, (j + 1) * columns - 1)]
        top = (len(ys) - 1) * columns
        edges = [("face", (k, k + 1)) for k in range(columns - 1) if xs[k] > -protrusion - 1e-9]
        edges += [("pinch", (top + k + 1, top + k)) for k in range(columns - 1) if abs(xs[k] + xs[k + 1]) < 1]
        edges += [("pull", ((j + 1) * columns, j * columns)) for j in range(len(ys) - 1)]
        made.append(solids.layers(solids.Plan(points, cells, edges), [0, thick], low="wall", high="wall"))
    return made


def lap_slice(folder, spacing, name="slice", increments=(5, 10), contact="SURFACE TO SURFACE"):
    """lap_joint() in space."""
    f, T, deck = 0.2, 0.04, Space()
    for body, mesh in zip(("UPPER", "LOWER"), slice_meshes(spacing)):
        deck.add(body, mesh, 0.91 / SCALE, 0.3)
        deck.fix(deck.nodes(body, "wall"), 3)
    deck.fix(deck.nearest("UPPER", -16, 0.25) + deck.nearest("LOWER", 16, -0.25), 2)
    deck.fix(deck.nearest("LOWER", 0, 0) + deck.nearest("UPPER", 0, 0), 1)
    for step in (0, 1):
        if step:
            deck.forces.append(dict(deck.forces[0]))
            deck.traction("UPPER", "pull", 1, -2 * T)
            deck.traction("LOWER", "pull", 1, 2 * T)
        else:
            deck.traction("UPPER", "pinch", 2, -1)
            deck.traction("LOWER", "pinch", 2, 1)
    above, below = ({round(deck.places[n - 1][0], 9): n for n in deck.nodes(body, "face") if deck.places[n - 1][2] == 0} for body in ("UPPER", "LOWER"))
    deck.write(os.path.join(folder, name + ".inp"), ("UPPER", ("face",)), ("LOWER", ("face",)), f, PENALTY * 0.91 / SCALE / spacing, increments,
               list(above.values()) + list(below.values()), contact)
    return {x: (above[x], below[x]) for x in sorted(above)}

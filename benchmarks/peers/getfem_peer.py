"""GetFEM on three of the studies, as a process of its own that prints a line of JSON. Used by peers.py.

    python3 benchmarks/peers/getfem_peer.py punch|lap_joint|hertz ORDER SIZE CYCLES

Contact with friction as integral terms with multipliers (GetFEM's `integral contact` bricks: the augmented Lagrangian of
Alart and Curnier in its form 3, which needs the fewest iterations here), Newton's method to a residual of 1e-9, plane strain, the meshes of
calculix.py. SIZE: edges of the punch, spacing of the lap joint, edges of Hertz' contact candidates. CYCLES: after the
first loading, the last cycle's loss is the result."""
import json
import os
import sys

sys.path.append("/usr/lib/python3/dist-packages")
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy  # noqa: E402
import getfem  # noqa: E402
from calculix import front, graded, graded_to_ends  # noqa: E402

YOUNG, POISSON = 0.91, 0.3
FORM = 3  # of the augmented Lagrangian


class Body:
    """A rectangle of quadrilaterals with an edge of contact, `below` or `above`."""

    def __init__(self, name, order, xs, ys, contact):
        self.name, self.order = name, order
        self.mesh = getfem.Mesh("empty", 2)
        # Not as a "cartesian" mesh, whose products of intervals GetFEM does not project on.
        corners = [[(a, c), (b, c), (a, d), (b, d)] for c, d in zip(ys, ys[1:]) for a, b in zip(xs, xs[1:])]
        self.mesh.add_convex(getfem.GeoTrans("GT_QK(2,1)"), numpy.array(corners).transpose(2, 1, 0))
        faces = self.mesh.outer_faces()
        normals = self.mesh.normal_of_faces(faces)
        self.regions = {}
        for side, component, sign in (("below", 1, -1), ("above", 1, 1), ("left", 0, -1), ("right", 0, 1)):
            self.region(side, faces[:, numpy.nonzero(sign * normals[component] > 0.5)[0]])
        self.contact = self.regions[contact]
        self.u, self.linear = getfem.MeshFem(self.mesh, 2), getfem.MeshFem(self.mesh, 1)
        self.u.set_classical_fem(order)
        self.linear.set_classical_fem(1)
        self.rule = getfem.MeshIm(self.mesh, 2 * order + 1)

    def region(self, name, faces):
        self.regions[name] = len(self.regions) + 1
        self.mesh.set_region(self.regions[name], faces)

    def part(self, name, side, wanted):
        """Makes a region of those edges of a side whose middle is wanted."""
        faces = self.mesh.region(self.regions[side])
        ends = [self.mesh.pts(numpy.unique(self.mesh.pid_in_faces(faces[:, [k]])))[0] for k in range(faces.shape[1])]
        self.region(name, faces[:, [k for k, x in enumerate(ends) if wanted(numpy.mean(x))]])

    def line(self):
        """Points of the edge of contact sorted by x, and their dofs along x."""
        dofs = self.u.basic_dof_on_region(self.contact)[0::2]
        x = self.u.basic_dof_nodes()[0, dofs]
        return numpy.sort(x), dofs[numpy.argsort(x)]


class Joint:
    """A body on the rigid plane y = 0, or two bodies, and loads in proportion to multipliers."""

    def __init__(self, bodies, friction):
        self.bodies, self.loads = bodies, []
        m = self.model = getfem.Model("real")
        first, shear = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
        for name, value in (("lambda", first), ("mu", shear), ("r", 1.0), ("friction", friction), ("whole", 1.0)):
            m.add_initialized_data(name, [value])
        for body in bodies:
            m.add_fem_variable(body.name, body.u)
            m.add_fem_data("old_" + body.name, body.u)
            m.add_isotropic_linearized_elasticity_brick(body.rule, body.name, "lambda", "mu")
        one = bodies[0]
        space = getfem.MeshFem(one.mesh, 2)
        space.set_classical_fem(1)
        m.add_filtered_fem_variable("stress", space, one.contact)
        if len(bodies) == 1:
            m.add_initialized_fem_data("plane", one.linear, one.linear.eval("y"))
            m.add_integral_contact_with_rigid_obstacle_brick(one.rule, one.name, "stress", "plane", "r", "friction",
                                                             one.contact, FORM, "whole", "old_" + one.name)
        else:
            two = bodies[1]
            m.add_integral_contact_between_nonmatching_meshes_brick(
                one.rule, one.name, two.name, "stress", "r", "friction", one.contact, two.contact, FORM, "whole",
                "old_" + one.name, "old_" + two.name)

    def load(self, body, side, density):
        """Traction density(x, y, multipliers), two components, on a side."""
        name = "load_%d" % len(self.loads)
        self.model.add_fem_data(name, body.linear, 2)
        self.model.add_source_term_brick(body.rule, body.name, name, body.regions[side])
        self.loads.append((name, body, body.regions[side], density))

    def hold(self, body, x, y, component):
        """A component of the node next to (x, y)."""
        at = body.u.basic_dof_nodes()[:, component::2]
        dof = component + 2 * int(numpy.argmin((at[0] - x) ** 2 + (at[1] - y) ** 2))
        row, name = getfem.Spmat("empty", 1, body.u.nbdof()), "held_%s_%d" % (body.name, dof)
        row.add(0, dof, 1.0)
        self.model.add_variable(name, 1)
        self.model.add_constraint_with_multipliers(body.name, name, row, [0.0])

    def tractions(self, multipliers):
        for name, body, region, density in self.loads:
            x, y = body.linear.basic_dof_nodes()
            yield name, body, region, numpy.array([0 * x + c for c in density(x, y, multipliers)])

    def increment(self, multipliers):
        for name, _, _, traction in self.tractions(multipliers):
            self.model.set_variable(name, traction.T.ravel())
        for body in self.bodies:
            self.model.set_variable("old_" + body.name, self.model.variable(body.name))
        _, converged = self.model.solve("max_res", 1e-9, "max_iter", 100)
        if not converged:
            sys.exit("an increment did not converge")

    def march(self, start, end, increments):
        """Work of the loads on the way."""
        start, end, work = numpy.array(start, float), numpy.array(end, float), 0.0
        for k in range(increments):
            old = {body.name: self.model.variable(body.name).copy() for body in self.bodies}
            self.increment(start + (end - start) * (k + 1) / increments)
            for _, body, region, traction in self.tractions(start + (end - start) * (k + 0.5) / increments):
                force = getfem.asm_boundary_source(region, body.rule, body.u, body.linear, traction)
                work += force @ (self.model.variable(body.name) - old[body.name])
        return work

    def touch(self, stress):
        """Newton's first matrix is singular where nothing touches: a first guess of the contact stress across the line."""
        start = numpy.zeros_like(self.model.variable("stress"))
        start[1::2] = stress
        self.model.set_variable("stress", start)

    def cycles(self, count, corners, increments):
        """The last cycle's loss."""
        loss = None
        for _ in range(count):
            loss = sum(self.march(a, b, increments) for a, b in zip(corners, corners[1:]))
        return loss


def punch(order, edges, cycles):
    """P = 1 in 5 increments, then Q in 10: 0.5 fP, or for cycles ± 0.8 fP."""
    xs = graded_to_ends(1.0, int(edges), 0.05)
    block = Body("block", order, xs, graded(2.0, xs[1] - xs[0], 1.3, 0.2), "below")
    joint = Joint([block], 0.2)
    joint.load(block, "above", lambda x, y, m: (0.5 * m[1], -0.5 * m[0] + 3 * x * m[1]))
    joint.touch(0.1)
    x, dofs = block.line()
    joint.march((0, 0), (1, 0), 5)
    v = joint.model.variable("block")[dofs].copy()
    Q = 0.16 if cycles else 0.1
    joint.march((1, 0), (1, Q), 10)
    change = joint.model.variable("block")[dofs] - v
    right = x >= 0
    found = {"stick half-width": front(x[right], v[right], 0.01 * abs(v[-1])), "corner slip": abs(v[-1]),
             "stick end at Q": front(x, change, 0.01 * max(change)),
             "loss": joint.cycles(cycles, [(1, Q), (1, -Q), (1, Q)], 20)}
    return joint, found


def lap_joint(order, spacing, cycles):
    """Pinched in 5 increments, pulled by T = 0.04 in 10; cycles are 0, T, 0, the first loading part of the first."""
    protrusion, remote = 1.95, 16.0
    count = 2 * round(1.0 / spacing)
    near = [-1 + 2 * k / count for k in range(count + 1)]
    out = [x + 1 for x in graded(protrusion - 1, spacing, 1.2, 0.1)][1:]
    far = [x + protrusion for x in graded(remote - protrusion, 0.1, 1.3, 1.0)][1:]
    overlap = [-x for x in reversed(out)] + near + out
    ys = graded(0.5, spacing, 1.2, 0.1)
    ys[ys.index(min(ys, key=lambda y: abs(y - 0.25)))] = 0.25
    upper = Body("upper", order, [-x for x in reversed(far)] + overlap, ys, "below")
    lower = Body("lower", order, overlap + far, [-y for y in reversed(ys)], "above")
    for body, side in ((upper, "above"), (lower, "below")):
        body.part("bolt", side, lambda x: abs(x) < 0.5)
    for body, edge in ((upper, "below"), (lower, "above")):
        body.part("overlap", edge, lambda x: abs(x) < protrusion)
        body.contact = body.regions["overlap"]
    joint = Joint([upper, lower], 0.2)
    joint.load(upper, "bolt", lambda x, y, m: (0, -m[0]))
    joint.load(lower, "bolt", lambda x, y, m: (0, m[0]))
    joint.load(upper, "left", lambda x, y, m: (-2 * m[1], 0))
    joint.load(lower, "right", lambda x, y, m: (2 * m[1], 0))
    joint.hold(upper, -remote, 0.25, 1)
    joint.hold(lower, remote, -0.25, 1)
    joint.hold(lower, 0, 0, 0)
    joint.touch(0.2)
    joint.march((0, 0), (1, 0), 5)
    sides = [body.line() for body in (upper, lower)]

    def profile(component):
        across = [joint.model.variable(body.name)[dofs + component] for body, (_, dofs) in zip((upper, lower), sides)]
        return (across[0] - across[1])[sides[0][0] >= -1e-12]

    x = sides[0][0][sides[0][0] >= -1e-12]
    opening, v = profile(1), profile(0)
    first = joint.march((1, 0), (1, 0.04), 10)
    pulled, change = profile(1), profile(0) - v
    found = {"contact half-length": front(x, numpy.maximum(opening, 0), 0.003 * max(opening)),
             "contact half-length at T": front(x, numpy.maximum(pulled, 0), 0.003 * max(pulled)),
             "stick half-length at T": front(x, change, 0.02 * max(abs(change)))}
    if cycles:
        first += joint.march((1, 0.04), (1, 0), 10)
    found["loss"] = first if cycles == 1 else joint.cycles(cycles - 1, [(1, 0), (1, 0.04), (1, 0)], 10)
    return joint, found


def hertz(order, edges, cycles):
    """Half-planes cut off at 20 half-widths b = 1, P = 1e-3 in 5 increments, Q = 0.6 fP in 10; cycles are ± Q."""
    span, domain, P, f = 1.67, 20.0, 1e-3, 0.4
    inner = [span * (2 * k / edges - 1) for k in range(int(edges) + 1)]
    out = [x + span for x in graded(domain - span, inner[1] - inner[0], 1.3, 5.0)][1:]
    xs, ys = [-x for x in reversed(out)] + inner + out, graded(domain, inner[1] - inner[0], 1.3, 5.0)
    pad, base = Body("pad", order, xs, ys, "below"), Body("base", order, xs, [-y for y in reversed(ys)], "above")
    radius = 0.5 * numpy.pi / 4 / P  # b² = 4 P R / π E*, E* = 1/2
    points = pad.mesh.pts()
    points[1] += points[0] ** 2 / (2 * radius) * (1 - points[1] / domain)
    pad.mesh.set_pts(points)
    for body, side in ((pad, "below"), (base, "above")):
        body.part("candidates", side, lambda x: abs(x) < span)
        body.contact = body.regions["candidates"]
    joint = Joint([pad, base], f)
    L = domain
    joint.load(pad, "above", lambda x, y, m: (m[1] / (2 * L), -m[0] / (2 * L) + 1.5 * m[1] * x / L ** 2))
    joint.model.add_Dirichlet_condition_with_multipliers(base.rule, "base", base.u, base.regions["below"])
    joint.touch(0.2 * P)
    joint.march((0, 0), (P, 0), 5)
    sides = [body.line() for body in (pad, base)]
    right = sides[0][0] >= -1e-12
    slip = lambda: (joint.model.variable("pad")[sides[0][1]] - joint.model.variable("base")[sides[1][1]])[right]
    v, Q = slip(), 0.6 * f * P
    joint.march((P, 0), (P, Q), 10)
    change = slip() - v
    found = {"stick half-length": front(sides[0][0][right], change, 1e-3 * max(abs(change))),
             "loss": joint.cycles(cycles, [(P, Q), (P, -Q), (P, Q)], 20)}
    return joint, found


def main():
    study, order, size, cycles = sys.argv[1:]
    getfem.util_trace_level(0)
    getfem.util_warning_level(0)
    joint, found = {"punch": punch, "lap_joint": lap_joint, "hertz": hertz}[study](int(order), float(size), int(cycles))
    print(json.dumps(dict(found, dofs=sum(body.u.nbdof() for body in joint.bodies))))


if __name__ == "__main__":
    main()

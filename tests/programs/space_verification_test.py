"""Bodies in space against closed forms and against the plane: a meshed sphere on a block, loss over amplitude, a ring, a dovetail."""

import math
import sys

import pytest

from programs import ROOT, even, mesh_text, near, near_all, near_relative, rectangle, shipped

sys.path.insert(0, str(ROOT / "meshes"))
import solids  # noqa: E402

pytestmark = pytest.mark.rest


class Mindlin:
    """Two alike half-spaces, one of which has a sphere, ν = 0: Hertz, and Cattaneo and Mindlin, for which both are exact."""

    def __init__(self, young, radius, friction, force):
        self.friction, self.force = friction, force
        self.a = (0.75 * force * radius / (young / 2)) ** (1 / 3)
        self.peak = 1.5 * force / (math.pi * self.a**2)
        # Twice (2 - ν)/G, with G = E/2.
        self.softness = 8 / young
        self.slide = 3 * friction * force / (16 * self.a) * self.softness

    def stick(self, s):
        return self.a * (1 - s) ** (1 / 3)

    def compliance(self, share):
        """Of the sticking contact under this share of the force."""
        return self.softness / (8 * self.a * share ** (1 / 3))

    def loss(self, s):
        """Of a cycle of Q between ± s f P, by Masing's rule."""
        return 4 * self.friction * self.force * self.slide * (s * (1 - (1 - s) ** (2 / 3)) - 2 * (s - 0.6 * (1 - (1 - s) ** (5 / 3))))


def at_point(columns, key, time):
    """A column of a table at a point of the history."""
    return next(value for value, t in zip(columns[key], columns["time"]) if abs(t - time) < 1e-9)


def pin(run, finer, friction, history, shear, increments, **keys):
    """The shipped pin and block at ν = 0 with elements at the contact so much finer: the whole is pressed by 1000 and sheared by `shear`."""
    case = shipped("pin_on_block")
    run.write("pin.msh", solids.gmsh_text(solids.pin(finer)))
    case["bodies"]["pin"].update(mesh=str(run.folder / "pin.msh"), poisson=0)
    case["bodies"]["block"]["poisson"] = 0
    for axis in case["bodies"]["block"]["block"].values():
        # Cells at the contact have no growth.
        axis["cells"] = [n * finer if growth == 1 else n + finer - 1 for n, growth in zip(axis["cells"], axis["growth"])]
    case["bodies"]["pin"]["guides"]["x"]["value"] = shear / 2
    case["interfaces"]["end"]["friction"] = friction
    for key in ("cycle-start", "cycles"):
        del case[key]
    case.update(history=history, increments=increments, stepping="fixed", **keys)
    return run.case(case, "--csv", run.folder / "pin"), run.columns("pin_history.csv")


def test_meshed_sphere_is_hertz_cattaneo_and_mindlin(run):
    """Half of a pin with a spherical end on half of a block, nodes that do not match: peak pressure, radii of contact and stick,
    compliance and loss, to what halving the elements changes, and 4e-3 for the chords of the sphere and the size of the bodies."""
    exact, s = Mindlin(210e3, 50, 0.3, 1000), 0.8
    found = []
    for finer in (1, 2):
        got, _ = pin(run, finer, 0.3, ["P=0", "P=1", "Q=1", "Q=-1", "Q=1"], s * 300, 6, **{"cycle-start": 2, "cycles": 1})
        areas = {row["state"]: row["area"] for row in got["areas"]}
        near_all([row["imbalance"] for row in got["balance"]], 0, 1e-9)
        near_relative(abs(got.interface("end")["force_z"]), 500, 1e-9)
        near_relative(abs(got.interface("end")["force_x"]), s * 150, 1e-9)
        # In full stick the contact's part of the compliance is that which changes with the pressing force.
        shear = 3
        _, stuck = pin(run, finer, 10, ["P=0", "P=1", "Q=1", "Q=0", "P=0.25", "Q=1"], shear, 2)
        soft = [(at_point(stuck, "displacement Q", end) - at_point(stuck, "displacement Q", end - 1)) / shear for end in (2, 5)]
        found.append({"peak": got["peak_pressure"] / exact.peak,
                      "contact": math.sqrt(2 * areas["contact"] / math.pi) / exact.a,
                      "stick": math.sqrt(2 * areas["stick"] / math.pi) / exact.stick(s),
                      "compliance": (soft[1] - soft[0]) / (exact.compliance(0.25) - exact.compliance(1)),
                      "loss": 2 * got["dissipation"][-1] / exact.loss(s)})
    for key, most in (("peak", 0.02), ("contact", 0.06), ("stick", 0.06), ("compliance", 0.2), ("loss", 0.06)):
        coarse, fine = (each[key] for each in found)
        assert abs(fine - coarse) < most, (key, found)
        near(fine, 1, abs(fine - coarse) + 4e-3)


def pressed_by_a_sphere(run, step, shears):
    """Half of two alike discs with the gap of a sphere, radius of contact 1, and rings of elements `step` wide at its edge. For cycles of
    growing shear, each around that of P alone: loss over the closed form, and the number of rings of nodes that slip."""
    radius, friction, start = 1000.0, 0.3, 0.85
    exact = Mindlin(1.0, radius, friction, 4 / (3 * radius) / 2)
    near_relative(exact.a, 1, 1e-12)
    fine = math.ceil((1 + 3.5 * step - start) / step)
    reach = start + fine * step
    rings = [0.4, 0.48, 0.56, 0.64, 0.72, 0.78, 0.82, start] + [start + step * k for k in range(1, fine + 1)]
    plan = solids.disc(0.3, 6, rings + solids.growing(reach, 10.0, step * 1.5, 1.8)[1:])
    depth = solids.growing(0.0, 10.0, 0.03, 1.8)

    def face(x, y):
        return "contact" if math.hypot(x, y) < reach else "rim"
    run.write("upper.msh", solids.gmsh_text(solids.ended(solids.layers(plan, depth, low=face, high="far"), "cut", 10.0)))
    run.write("lower.msh", solids.gmsh_text(solids.layers(plan, [-z for z in reversed(depth)], low="far", high=face)))

    def body(name, **keys):
        return {"mesh": str(run.folder / (name + ".msh")), "young": 1.0, "poisson": 0.0, **keys}
    guide = {"on": "far", "x": {"force": "Q", "value": friction * exact.force / 2}, "y": "held", "z": {"force": "P", "value": -exact.force / 2}}
    history = ["P=0", "P=1"] + [f"Q={sign * s}" for s in shears for sign in (1, -1, 1)]
    ends = [4 + 3 * k for k in range(len(shears))]
    run.case({"analysis": "space", "order": 1, "history": history, "increments": 6, "stepping": "fixed",
              "bodies": {"upper": body("upper", support="cut:y", guides=guide), "lower": body("lower", support="cut:y far:xyz")},
              "interfaces": {"face": {"between": ["upper:contact", "lower:contact"], "friction": friction, "gap": f"(x^2+y^2)/{2 * radius}"}}},
             "--csv", run.folder / "discs", "--frames", " ".join(map(str, ends)))
    table, nodes = run.columns("discs_history.csv"), run.columns("discs_nodes.csv")
    losses = [2 * (at_point(table, "total_dissipation", end) - at_point(table, "total_dissipation", end - 2)) / exact.loss(s) for s, end in zip(shears, ends)]
    rows = [len({round(math.hypot(x, y), 6) for t, x, y, state in zip(*(nodes[key] for key in ("time", "x", "y", "state")))
                 if abs(t - end) < 1e-9 and state == "slip"}) for end in ends]
    return losses, rows, exact


def test_loss_grows_with_the_third_power_where_five_rows_slip(run):
    """Loss of a cycle over its amplitude, which is small enough for slope 3 to show and large enough for five rings of nodes to slip: it is the
    closed form's, whose slope tends to 3, to what halving the rings changes."""
    shears = (0.13, 0.18, 0.25)
    (coarse, _, _), (fine, rows, exact) = (pressed_by_a_sphere(run, step, shears) for step in (0.02, 0.01))
    assert min(rows) >= 5, rows

    def slopes(ratios):
        losses = [ratio * exact.loss(s) for ratio, s in zip(ratios, shears)]
        return [math.log(losses[k + 1] / losses[k]) / math.log(shears[k + 1] / shears[k]) for k in (0, 1)]
    change = max(abs(a - b) for a, b in zip(slopes(coarse), slopes(fine)))
    assert change < 0.3
    for slope, expected in zip(slopes(fine), slopes([1, 1, 1])):
        assert abs(slope - expected) <= change and abs(slope - 3) < 0.25, (slopes(coarse), slopes(fine))
    near_all(fine, 1, max(abs(a - b) for a, b in zip(coarse, fine)))


def ring(run, cells, friction, increments, numbers):
    """A ring on a rigid plane, pressed and then turned to and fro: as a cross-section about its axis, and as hexahedra, of which so many go
    around. Courses of the tables of the history."""
    march = {"history": ["P=0", "P=1", "T=1", "T=-1", "T=1"], "stepping": "fixed", "increments": increments, "order": 1}
    run.write("section.mesh", rectangle(even(1, 2, cells), even(0, 1, cells)))
    run.case({"analysis": "axisymmetric", **march,
              "bodies": {"ring": {"mesh": str(run.folder / "section.mesh"), "young": 1, "poisson": 0.3, "load": "P pressure 3 1; T traction-t 3 0.14*r"}},
              "interfaces": {"floor": {"between": "ring:1", "friction": friction}}}, "--csv", run.folder / "flat")
    yield run.columns("flat_history.csv")
    for around in numbers:
        points = [(r * math.cos(2 * math.pi * m / around), r * math.sin(2 * math.pi * m / around)) for m in range(around) for r in even(1, 2, cells)]
        quads = []
        for m in range(around):
            first, second = m * (cells + 1), (m + 1) % around * (cells + 1)
            quads += [(first + k, first + k + 1, second + k + 1, second + k) for k in range(cells)]
        run.write("ring.msh", solids.gmsh_text(solids.layers(solids.Plan(points, quads, []), even(0, 1, cells))))
        run.case({"analysis": "space", **march,
                  "bodies": {"ring": {"mesh": str(run.folder / "ring.msh"), "young": 1, "poisson": 0.3,
                                      "load": "P pressure high 1; T traction high -0.14*y 0.14*x 0"}},
                  "interfaces": {"floor": {"between": "ring:low", "friction": friction,
                                           "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}}}, "--csv", run.folder / "deep")
        yield run.columns("deep_history.csv")


def test_a_ring_of_hexahedra_is_the_axisymmetric_one(run):
    """Polygons of 32 and 64 sides: their limit, by the square of the angle of an element, is the ring about the axis, to the change between
    both. Where nothing slips, the angle of twist is that of a shaft."""
    for table in ring(run, 4, 2, 2, (16,)):
        near_relative(at_point(table, "displacement T", 2), 0.14 * 2 * 1.3, 1e-9)
    axial, coarse, fine = ring(run, 8, 0.3, 10, (32, 64))
    for key, time, most in (("displacement P", 1, 1e-3), ("displacement T", 2, 2e-3), ("total_dissipation", 2, 0.05)):
        one, other, exact = (at_point(table, key, time) for table in (coarse, fine, axial))
        change = abs(other - one)
        assert change < most * abs(exact)
        assert abs(other + (other - one) / 3 - exact) < change, (key, time, one, other, exact)
    assert 0 < at_point(fine, "slip", 2) and 0 < at_point(fine, "stick", 2)


def dovetail(run, held, sides="flank,arc"):
    """The shipped dovetail; its free face held, if it is said."""
    case = shipped("dovetail_3d")
    for body in case["bodies"].values():
        body["support"] += " face:z" if held else ""
    case["interfaces"]["flank"]["between"] = ["root:" + sides, "disc:" + sides]
    return run.case({**case, "stepping": "fixed"}, "--csv", run.folder / "dovetail")


def plane_dovetail(run, arcs):
    """The plane dovetail on the same straight triangles, in which the contact ends with the flat flank or has the arcs beside it."""
    plane = shipped("dovetail")
    sides = {"symmetry": 1, "end": 2, "flank": 3, "arc": 3 if arcs else 4, "free": 4, "next": 5}
    for name in plane["bodies"]:
        flat = solids.dovetail_plan(ROOT / "meshes", name)
        plane["bodies"][name]["mesh"] = run.write(name + ".mesh", mesh_text(
            [f"1 2 {' '.join(map(str, cell))}" for cell in flat.cells], [f"{sides[side]} 1 {a} {b}" for side, (a, b) in flat.edges],
            ["%.17g %.17g" % at for at in flat.points]))
    del plane["interfaces"]["flank"]["pairing"]
    return run.case({**plane, "order": 1, "cycles": 2, "increments": 10, "stepping": "fixed"}, "--csv", run.folder / "plane")


def test_dovetail_between_walls_is_the_plane_one(run):
    """The dovetail of finite width whose faces are held is that of plane strain on the same triangles. With arcs, whose chords do not face
    each other, the plane's sides are smooth curves: there, and with free faces, it differs, by what the guide says."""
    depth, exact = 3, 1e-9
    plane, held = plane_dovetail(run, False).interface("flank"), dovetail(run, True, "flank").interface("flank")
    for key in ("normal", "force_x", "force_y"):
        near_relative(held[key], depth * plane[key], exact)
    for key in ("stick", "slip"):
        near(held[key], depth * plane[key], 0.15 * depth)
    # Increments differ, which changes the loss by less than 1e-4 of it.
    near_relative(held["dissipation"], depth * plane["dissipation"], 1e-4)
    plane, held, free = plane_dovetail(run, True), dovetail(run, True), dovetail(run, False)
    for got in (held, free):
        # All that pulls the root, 200 N/mm² on its end, goes through the flank.
        near_relative(got.interface("flank")["force_y"], depth * plane.interface("flank")["force_y"], exact)
        near_all([row["imbalance"] for row in got["balance"]], 0, exact)
        near_relative(got["peak_pressure"], plane["peak_pressure"], 0.04)
    near_relative(held.interface("flank")["dissipation"], depth * plane.interface("flank")["dissipation"], 0.03)
    assert 1.05 < free.interface("flank")["dissipation"] / held.interface("flank")["dissipation"] < 1.3

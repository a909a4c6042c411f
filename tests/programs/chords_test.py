"""Sides of straight edges that stand for curves."""

import itertools
import math
import random

import pytest

from programs import body, even, face, near, near_all, rectangle


def disc(run, name, angles, depth=1.0, radius=1.0, layers=6):
    """A part of a ring under its lowest point, boundary 1 on the outside; angles in degrees from there."""
    def place(angle, y):
        r, a = radius - depth * y, math.radians(angle)
        return r * math.sin(a), -r * math.cos(a)

    run.write(name, rectangle(angles, even(0, 1, layers), place))


@pytest.mark.parametrize("order", (1, 2, 3))
def test_that_bear_with_a_vertex_alone_are_told(run, order):
    """A polygon on a rigid line touches it with its vertices, where no chord is off its curve; from order 2 on it is off at the
    open nodes beside them. As meshed this ended in a fault of memory."""
    disc(run, "disc.mesh", even(-40, 40, 8), 0.5)
    keys = {"order": order, "geometry": "as meshed", "history": ["D=0", "D=1"],
            "bodies": {"disc": body("disc.mesh", None, ["D displacement-y 3 -7e-3", "D displacement-x 3 0"])},
            "interfaces": {"c": {"between": ["disc:1"], "friction": 0.1, "obstacle": {"line": [[-2, -1], [2, -1]]}}}}
    got = run.case(keys, "--csv", run.folder / "out")
    p = run.columns("out_nodes.csv")["p"]
    assert max(p) > 0
    if order > 1:
        assert sum(x > 0 for x in p) == 1
        assert got["chords_node_pressure_change_estimate"] > 0.05
        assert "that of a single node by up to" in got.warned()
    else:  # gaps of nodes are right
        assert "chords_node_pressure_change_estimate" not in got.results


E, NU = 1000, 0.3
MODULUS = E / (1 - NU * NU)


def rings(run, inner, outer, sides, span=90, order=2, geometry="smooth", d=1e-3, wall=1, layers=6, **keys):
    """Parts of two rings that meet at radius 1 and overlap by d, each with the angles given; supports at both ends. The outer one has
    that wall, of so many layers."""
    def ring(name, first, last, angles, layers=6):
        def place(x, y):
            r, angle = first + (last - first) * x, math.radians(y)
            return r * math.cos(angle), r * math.sin(angle)

        run.write(name, rectangle(even(0, 1, layers), angles, place))

    ring("in.mesh", 0.5, 1 + (0 if "gap" in keys else d), inner)
    ring("out.mesh", 1, 1 + wall, outer, layers)
    support = "1:y 3:x" if span == 90 else "1:y 3:y"
    return run.case({"order": order, "geometry": geometry, "history": ["P=0", "P=1"],
                     "bodies": {"in": body("in.mesh", support, [], E, NU), "out": body("out.mesh", support, ["P pressure 2 1e-9"], E, NU)},
                     "interfaces": {"fit": {**face(*sides, 0), **keys}}}, "--csv", run.folder / "fit")


def lame(d=1e-3, inner=0.5, outer=2):
    """Lamé's pressure of an interference d at radius 1."""
    return d * MODULUS / ((outer**2 + 1) / (outer**2 - 1) + (1 + inner**2) / (1 - inner**2))


@pytest.mark.parametrize("span, edges", ((90, 3), (90, 4), (180, 6), (180, 7)))
def test_of_few_edges_end_at_planes_of_symmetry(run, span, edges):
    """A half and a quarter of a regular polygon, whose first chord leans by 12.9 to 15 degrees from the plane of symmetry: its
    pressure is the same at all nodes, as that of the whole polygon is, and Lamé's to the error of linear elements."""
    angles = even(0, span, edges)
    for geometry in ("smooth", "as meshed"):
        rings(run, angles, angles, ("in:2", "out:4"), span, 1, geometry, gap=-1e-3)
        p = run.columns("fit_nodes.csv")["p"]
        assert len(p) == edges + 1
        near_all(p, p[0], 1e-9 * p[0])
        near(p[0] / lame(), 1, 0.12)


@pytest.mark.parametrize("order", (2, 3))
def test_short_edges_bear_no_more_than_their_neighbours(run, order):
    """An edge of a hundredth of those beside it, on the side that has the nodes: Lamé's pressure there as everywhere."""
    short = 0.01
    step = 90 / (8 + short)
    sliver = [k * step for k in range(3)] + [(2 + short + k) * step for k in range(7)]
    uneven = [10 * (k + (0.3 * math.sin(5 * k) if 0 < k < 9 else 0)) for k in range(10)]
    rings(run, sliver, uneven, ("in:2", "out:4"), order=order, slave="first", overlap=100)
    p = run.columns("fit_nodes.csv")["p"]
    assert len(p) == 9 * order + 1
    near_all([x / lame() for x in p], 1, 0.015)


def cylinder(run, half, order, geometry, angles, pressure=5.3):
    """A cylinder of radius 1, cut off at 0.4 above its lowest point, pressed on a half-plane of the same material by a load over
    its flat top; results, and pressures with their places."""
    w = math.sin(math.radians(angles[-1]))

    def place(x, y):
        low = 1 - math.cos(math.radians(x))
        return math.sin(math.radians(x)), low + (0.4 - low) * y

    run.write("cap.mesh", rectangle(angles, even(0, 1, 10), place))
    keys = {"order": order, "geometry": geometry, "history": ["P=0", "P=1"],
            "bodies": {"cap": body("cap.mesh", "4:x" if half else "@0,0.4:x", ["P pressure 3 %g" % pressure], E, NU),
                       "ground": {"half-plane": {"young": E, "poisson": NU, "depth": 100}}},
            "interfaces": {"foot": face("cap:1", "ground", 0)}}
    got = run.case(keys, "--csv", run.folder / "foot")
    table = run.columns("foot_nodes.csv")
    last = [(x, p) for x, p, t in zip(table["x"], table["p"], table["time"]) if t == table["time"][-1]]
    return got, sorted(last), math.sqrt(2 * w * pressure * MODULUS / 2 / math.pi)


@pytest.mark.parametrize("order", (1, 2))
def test_half_of_a_cylinder_on_a_half_plane_is_half_of_the_whole(run, order):
    """The half-plane is mirrored with it: the pressures of the whole, node by node, and Hertz's."""
    right = [0.6 * k for k in range(41)]
    _, whole, hertz = cylinder(run, False, order, "smooth", [-a for a in reversed(right[1:])] + right)
    got, half, _ = cylinder(run, True, order, "smooth", right)
    assert got.warned() == ""
    most = max(p for _, p in whole)
    near(most / hertz, 1, 0.05)
    of_whole = [p for x, p in whole if x > -1e-9]
    assert len(of_whole) == len(half)
    near_all([p - q for p, (_, q) in zip(of_whole, half)], 0, 1e-4 * most)


@pytest.mark.parametrize("order", (2, 4))
def test_on_a_half_plane_tell_what_they_take(run, order):
    """As meshed a cylinder on a half-plane is a polygon: how much its largest pressure is wrong by is told to a factor of two."""
    for step in (3, 5):
        angles = [step * k for k in range(-24 // step, 24 // step + 1)]
        smooth, _, _ = cylinder(run, False, order, "smooth", angles)
        assert "which changes the gap by up to" in smooth["notes"][0]
        assert "chords_peak_pressure_change_estimate" not in smooth.results
        meshed, _, _ = cylinder(run, False, order, "as meshed", angles)
        told = meshed["chords_peak_pressure_change_estimate"]
        off = abs(smooth["peak_pressure"] / meshed["peak_pressure"] - 1)
        assert off > 0.05
        assert 0.5 * off < told < 2 * off
        assert "on smooth curves" not in meshed.warned() and "chords of curves" in meshed.warned()


@pytest.mark.parametrize("order, layers", ((2, 1), (2, 3), (3, 2)))
def test_of_a_thin_sleeve_leave_its_wall_as_it_is(run, order, layers):
    """A sleeve of a fiftieth of its radius, of 36 edges, whose chords are off its circle by a fifth of the wall: Lamé's pressure,
    which is 13 to 15 % less if its free side keeps them."""
    got = rings(run, even(0, 90, 14), even(0, 90, 9), ("in:2", "out:4"), order=order, wall=0.02, layers=layers)
    p = run.columns("fit_nodes.csv")["p"]
    near_all([x / lame(outer=1.02) for x in p], 1, 0.02)
    assert any("straight edges of its other sides" in note for note in got["notes"])
    assert "free sides" not in got.warned()


@pytest.mark.parametrize("edges, told", ((3, True), (9, False)))
def test_of_free_sides_that_linear_elements_keep_are_told(run, edges, told):
    """Linear elements keep the chords of free sides: between circles of radius 1 and 2 the wall is thinner by 1 - cos(45°/edges), which
    is told above a fortieth."""
    angles = even(0, 90, edges)
    warned = rings(run, angles, angles, ("in:2", "out:4"), order=1).warned()
    assert ("straight edges of its free sides are chords" in warned) == told
    if told:
        wall, curves = (float(warned.split(word)[-1].split(": ")[0].split(",")[0]) for word in ("its wall is ", "that of the curves "))
        near(wall, math.cos(math.pi / 4 / edges), 1e-3)
        near(curves, 1, 1e-3)


def test_of_a_polygon_beside_a_curve_are_told(run):
    """A pad whose foot has three edges of 10 degrees, on a seat of the same radius with finer ones: the foot's chords are 1 - cos 5°
    off the circle that the seat is taken for, and its inner nodes bear nothing."""
    disc(run, "pad.mesh", even(-15, 15, 3), 0.5)

    def seat(angle, y):
        r, a = 1 + y, math.radians(angle)
        return r * math.sin(a), -r * math.cos(a)

    run.write("seat.mesh", rectangle([-a for a in even(-30, 30, 24)], even(0, 1, 6), seat))
    keys = {"order": 2, "history": ["D=0", "D=1"],
            "bodies": {"pad": body("pad.mesh", None, ["D displacement-y 3 -1e-3", "D displacement-x 3 0"], E, NU),
                       "seat": body("seat.mesh", "3:xy", [], E, NU)},
            "interfaces": {"foot": face("pad:1", "seat:1", 0)}}
    got = run.case(keys)
    assert "stay a polygon" in got.warned() and "pad" in got.warned()
    told = float(got.warned().split("is wrong by up to ")[1].split()[0])
    near(told, 1 - math.cos(math.radians(5)), 1e-2 * told)
    assert got["chords_node_pressure_change_estimate"] > 0.05


@pytest.mark.parametrize("order", (1, 2, 3))
@pytest.mark.rest
def test_of_graded_edges_tell_what_they_take(run, order):
    """Rings as meshed whose edges are of random lengths, up to 1:16: what chords are told to change of the largest pressure, and of that
    of a node, is what it is wrong by beside Lamé, to a factor of two."""
    draw = random.Random(13 + order)

    def angles(edges, ratio):
        ends = list(itertools.accumulate(ratio ** draw.random() for _ in range(edges)))
        return [0] + [90 * x / ends[-1] for x in ends]

    for ratio in (1.5, 2, 4, 8, 16):
        for d in (1e-3, 2e-2):
            edges = draw.choice((9, 12, 18))
            got = rings(run, angles(edges, ratio), angles(edges * 5 // 3, ratio), ("in:2", "out:4"), order=order, geometry="as meshed", d=d,
                        overlap=100)
            p = run.columns("fit_nodes.csv")["p"]
            largest = max(p)
            if largest == 0:
                assert "no node carries a force now, but some may on the curves" in got.warned()
                continue
            for what, wrong in (("peak", abs(1 - lame(d) / largest)), ("node", max(abs(x - lame(d)) for x in p) / largest)):
                told = got["chords_%s_pressure_change_estimate" % what]
                # Less than a tenth may be the mesh's.
                assert told < max(2 * wrong, 0.1), (what, ratio, d, told, wrong)
                assert told > wrong / 2 or wrong < 0.1, (what, ratio, d, told, wrong)


@pytest.mark.parametrize("order", (1, 2, 3))
def test_of_one_circle_leave_no_gap(run, order):
    """Rings whose edges do not match, 9 on 15, with an interference of 1e-8: Lamé's pressure at every node."""
    rings(run, even(0, 90, 9), even(0, 90, 15), ("in:2", "out:4"), order=order, d=1e-8)
    near_all([p / lame(1e-8) for p in run.columns("fit_nodes.csv")["p"]], 1, 0.01)


def gmsh_sector(name, run, edges, curve_of):
    """A sector of 60 degrees between radii 1 and 2 below the origin in Gmsh's format 2.2: group 1 the hole, whose edge k is on the curve
    curve_of(k), group 2 the outside."""
    angles = [math.radians(-90 - 30 + 60 * k / edges) for k in range(edges + 1)]
    nodes = [(r * math.cos(a), r * math.sin(a)) for r in (1, 2) for a in angles]
    n = edges + 1
    elements = [(1, 1, curve_of(k), k + 2, k + 1) for k in range(edges)] + [(1, 2, 100, n + k + 1, n + k + 2) for k in range(edges)]
    elements += [(3, 3, 200, k + 1, n + k + 1, n + k + 2, k + 2) for k in range(edges)]
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    text += ["%d %.17g %.17g 0" % (i + 1, *x) for i, x in enumerate(nodes)] + ["$EndNodes", "$Elements", str(len(elements))]
    text += ["%d %d 2 %d %d %s" % (i + 1, kind, group, curve, " ".join(map(str, corners)))
             for i, (kind, group, curve, *corners) in enumerate(elements)]
    run.write(name, "\n".join(text + ["$EndElements", ""]))


@pytest.mark.parametrize("facets", (False, True))
def test_as_meshed_are_those_of_the_curves_of_the_file(run, facets):
    """Six edges of ten degrees on one curve of the file are chords of it, on six curves they are facets, which chords change nothing of."""
    gmsh_sector("hole.msh", run, 6, lambda k: k + 1 if facets else 1)
    keys = {"order": 2, "geometry": "as meshed", "history": ["D=0", "D=1"],
            "bodies": {"hole": body("hole.msh", None, ["D displacement-y 2 3e-3", "D displacement-x 2 0"], E, NU)},
            "interfaces": {"c": {"between": ["hole:1"], "obstacle": {"circle": {"centre": [0, 0], "radius": 1}}, "overlap": 10}}}
    got = run.case(keys)
    assert ("chords_node_pressure_change_estimate" in got.results) != facets
    assert ("chords of curves" in got.warned()) != facets

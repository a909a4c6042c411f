"""Cases of any number of bodies, interfaces and bolts."""

import json
import math

import pytest

from programs import alike, body, changed, curved, even, face, mesh_text, near, near_all, rectangle, shipped


def test_of_three_bodies_pass_the_patch_test(run):
    """Three plates whose nodes do not match carry a pressure and a shear uniformly."""
    run.block("low.mesh", 0, 2, 8, 0, 1, 2)
    run.block("middle.mesh", 0, 2, 11, 1, 2, 2)
    run.block("high.mesh", 0, 2, 3, 2, 3, 2)
    ends = ["Q traction 2 0 0.4", "Q traction 4 0 -0.4"]
    for analysis in ("plane strain", "plane stress"):
        for order in (1, 2, 3):
            got = run.case({"analysis": analysis, "order": order, "history": ["P=0", "P=1", "Q=1"],
                            "bodies": {"low": body("low.mesh", "1:xy", ends), "middle": body("middle.mesh", "", ends),
                                       "high": body("high.mesh", "", [*ends, "Q traction 3 0.4 0", "P pressure 3 0.9"])},
                            "interfaces": {"lower": face("middle:1", "low:3"), "upper": face("high:1", "middle:3")}},
                           "--csv", run.folder / "out")
            nodes = run.columns("out_nodes.csv")
            near_all(nodes["p"], 0.9, 1e-10)
            near_all([abs(q) for q in nodes["q"]], 0.4, 1e-10)
            for name in ("lower", "upper"):
                found = got.interface(name)
                near(found["force_x"], -0.8, 1e-10)
                near(found["force_y"], 1.8, 1e-10)
                near(found["moment"], 0, 1e-10)
                near(found["about_x"], 1, 1e-12)


def test_about_an_axis_carry_a_uniform_pressure(run):
    """About an axis: a stack of discs under a uniform pressure, the force on the whole face."""
    run.block("low.mesh", 0, 2, 8, 0, 1, 2)
    run.block("middle.mesh", 0, 2, 5, 1, 2, 2)
    run.block("high.mesh", 0, 2, 7, 2, 3, 2)
    keys = {"analysis": "axisymmetric",
            "bodies": {"low": body("low.mesh", "1:z"), "middle": body("middle.mesh"),
                       "high": body("high.mesh", "", ["P pressure 3 0.9"])},
            "interfaces": {"lower": face("middle:1", "low:3"), "upper": face("high:1", "middle:3")}}
    got = run.case(keys, "--csv", run.folder / "out")
    near_all(run.columns("out_nodes.csv")["p"], 0.9, 1e-9)
    near(got.interface("upper")["normal"], 0.9 * math.pi * 4, 1e-10)
    near(got.interface("lower")["force_y"], 0.9 * math.pi * 4, 1e-10)
    assert got.warned() == ""
    # Linear elements have some of it on the axis, where no node of the contact is: it is told.
    keys["order"] = 1
    linear = run.case(keys)
    near(linear.interface("lower")["force_y"], 0.9 * math.pi * 4, 1e-10)
    for name in ("low", "middle", "high"):
        assert f"body {name} has linear elements" in linear.output
    # Rings have no axis.
    run.block("low.mesh", 1, 2, 8, 0, 1, 2)
    run.block("middle.mesh", 1, 2, 5, 1, 2, 2)
    run.block("high.mesh", 1, 2, 7, 2, 3, 2)
    assert run.case(keys, "--csv", run.folder / "out").warned() == ""
    near_all(run.columns("out_nodes.csv")["p"], 0.9, 1e-9)


def test_that_are_tied_are_one_body(run):
    """A pad that is cut in two and tied is the pad."""
    run.block("pad.mesh", -1, 1, 12, 0, 2, 4)
    run.block("lower.mesh", -1, 1, 12, 0, 1, 2)
    run.block("upper.mesh", -1, 1, 12, 1, 2, 2)
    run.block("base.mesh", -3, 3, 18, -2, 0, 4)
    load = ["P pressure 3 1", "Q traction 3 1 0"]
    base = body("base.mesh", "1:xy", [], 1000, 0.3)
    history = ["P=0", "P=1", "Q=0.2", "Q=-0.2"]
    run.case({"history": history, "bodies": {"pad": body("pad.mesh", "", load, 1000, 0.3), "base": base},
              "interfaces": {"flat": face("pad:1", "base:3", 0.4)}}, "--csv", run.folder / "whole")
    cut = run.case({"history": history,
                    "bodies": {"upper": body("upper.mesh", "", load, 1000, 0.3), "lower": body("lower.mesh", "", [], 1000, 0.3), "base": base},
                    "interfaces": {"flat": face("lower:1", "base:3", 0.4), "cut": {"between": ["upper:1", "lower:3"], "tied": True}}},
                   "--csv", run.folder / "cut")
    one, other = run.columns("whole_nodes.csv"), run.columns("cut_nodes.csv")
    for name in ("p", "q", "slip", "opening"):
        alike(one[name], other[name], 1e-9 * max(map(abs, one[name])))
    # The cut carries what the contact does, and both what is loaded.
    near(cut.interface("cut")["force_y"], 2, 1e-10)
    near(cut.interface("cut")["force_x"], 0.4, 1e-10)
    near(cut.interface("flat")["force_x"], 0.4, 1e-10)


def test_do_not_depend_on_the_order_of_their_parts(run):
    """Neither the order of bodies and interfaces nor that of the sides changes an answer."""
    run.block("low.mesh", -3, 3, 17, -1, 0, 3)
    run.block("middle.mesh", -2, 2, 16, 0, 1, 3)
    run.block("high.mesh", -1, 1, 10, 1, 2, 3)
    low, middle = body("low.mesh", "1:xy", [], 1000, 0.3), body("middle.mesh", "", ["Q traction 2 1 0"], 2000, 0.3)
    high = body("high.mesh", "", ["P pressure 3 1"], 1000, 0.2)
    history = ["P=0", "P=1", "Q=0.3", "Q=-0.3"]
    one = run.case({"history": history, "bodies": {"low": low, "middle": middle, "high": high},
                    "interfaces": {"below": face("middle:1", "low:3", 0.5), "above": face("high:1", "middle:3[-1.5<x<1.5]", 0.3)}})
    other = run.case({"history": history, "bodies": {"high": high, "low": low, "middle": middle},
                      "interfaces": {"above": face("middle:3[-1.5<x<1.5]", "high:1", 0.3), "below": face("middle:1", "low:3", 0.5)}})
    near(one["total_dissipation"] / other["total_dissipation"], 1, 1e-8)
    for name, sign in (("above", -1), ("below", 1)):  # forces on the first side
        first, second = one.interface(name), other.interface(name)
        near(first["force_y"], sign * second["force_y"], 1e-9)
        near(first["force_x"], sign * second["force_x"], 1e-9)
        near(first["moment"], sign * second["moment"], 1e-8)
        near(first["force_y"], 2, 1e-10)


def bolted(between, stiffness, pretension):
    return {"bolt": {"between": between, "stiffness": stiffness, "pretension": pretension}}


def test_bolts_lose_what_the_columns_give(run):
    """A shank through two columns, ν = 0: N = T / (1 + s c), c the columns' compliance."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    stiffness, pretension = 300, 40
    got = run.case({"bodies": {"low": body("low.mesh", "4:x 1:y"), "high": body("high.mesh", "4:x", ["F traction 3 0 1"], 500)},
                    "interfaces": {"joint": face("high:1", "low:3")}, "bolts": bolted(["high:3", "low:1"], stiffness, pretension),
                    "history": ["bolt=0", "bolt=1", "F=10"]})
    # The lower end does not move: y is held there. The working load of 10 pulls at the upper.
    compliance = 2 / 1000 + 3 / 500
    tightened = pretension / (1 + stiffness * compliance)
    loaded = tightened + 10 * stiffness * compliance / (1 + stiffness * compliance)
    bolt = got["bolts"][0]
    assert bolt["bolt"] == "bolt"
    near(bolt["force"], loaded, 1e-10 * loaded)
    near(got.interface("joint")["normal"], loaded - 10, 1e-10 * loaded)


@pytest.mark.parametrize("part", ["[2.5<x<7.5]", "[0<x<4.3]", "[4.1<x<4.5]"])
def test_bolts_pull_both_ends_alike(run, part):
    """An interval may end within elements, the last lies within one of either body: both ends of a shank feel its force all
    the same, and the joint carries what the table of bolts says."""
    run.block("low.mesh", 0, 10, 10, 0, 2, 4)
    run.block("high.mesh", 0, 10, 13, 2, 4, 3)
    got = run.case({"bodies": {"low": body("low.mesh", "@5,0:xy @0,0:y"), "high": body("high.mesh", "@5,4:x")},
                    "interfaces": {"joint": face("high:1", "low:3")}, "bolts": bolted(["high:3" + part, "low:1" + part], 1, 10),
                    "history": ["bolt=0", "bolt=1"]})
    near(got.interface("joint")["normal"], got["bolts"][0]["force"], 1e-9)


@pytest.mark.rest
def test_of_a_plate_over_neighbours_pass_the_patch_test(run):
    """A plate over two blocks whose joint lies within one of its elements: pressed evenly, ν = 0, each block carries what
    stands on it, whichever side has the nodes, tied or not."""
    run.block("w.mesh", 0, 1.3, 5, 0, 1, 2)
    run.block("e.mesh", 1.3, 3, 8, 0, 1, 2)
    run.block("t.mesh", 0, 3, 7, 1, 2, 2)
    for order in (1, 2, 3):
        for slave in ("first", "second"):
            for tied in (False, True):
                left = {"between": ["t:1", "w:3"], "tied": True} if tied else face("t:1", "w:3")
                got = run.case({"order": order, "history": ["P=0", "P=1"],
                                "bodies": {"w": body("w.mesh", "1:xy"), "e": body("e.mesh", "1:xy"),
                                           "t": body("t.mesh", "@0,2:x", ["P pressure 3 1"])},
                                "interfaces": {"l": {**left, "slave": slave}, "r": {**face("t:1", "e:3"), "slave": slave}}},
                               "--csv", run.folder / "plate")
                near(got.interface("l")["normal"], 1.3, 1e-11)
                near(got.interface("r")["normal"], 1.7, 1e-11)
                near_all(run.columns("plate_nodes.csv")["p"], 1, 1e-11)
                assert got.warned() == ""


def test_of_a_disc_in_a_hole_are_no_corners(run):
    """A disc in a hole of its own size, moved up, bears wherever it faces the hole's upper half."""
    def place(x, y):
        u, v = 2 * x - 1, 2 * y - 1
        return u * math.sqrt(1 - v * v / 2), v * math.sqrt(1 - u * u / 2)

    run.write("disc.msh", curved(8, 8, place))
    got = run.case({"history": ["D=0", "D=1"], "bodies": {"disc": body("disc.msh", "@0,0:xy @0.2,0:y", [], 1000, 0.3)},
                    "interfaces": {"hole": {"between": ["disc:1,2,3,4"], "obstacle": {"circle": {"centre": [0, 0], "radius": -1}},
                                            "motion": {"D": {"y": 1e-3}}}}})
    assert got.interface("hole")["force_y"] > 1e-3
    assert "degrees off" not in got.output


def test_of_corners_are_told(run):
    """A corner within an interface has one normal for two faces, which is told where it bears; a floor and a wall of their own
    have none."""
    run.block("block.mesh", 0, 1, 5, 0, 1, 4)
    keys = {"history": ["P=0", "P=1"], "bodies": {"block": body("block.mesh", "", ["P pressure 3 1", "P pressure 2 2"])},
            "interfaces": {"corner": {"between": ["block:1,4"], "obstacle": {"line": [[0, 5], [0, 0], [5, 0]]}}}}
    assert "interface 'corner': its side turns by 90 degrees at (0, 0)" in run.case(keys).output
    # Of the side that has no nodes of its own there: all around a block on a wider one.
    run.block("wide.mesh", -0.45, 1.7, 7, -1, 0, 2)
    keys["bodies"] = {"block": body("block.mesh", "", ["P pressure 3 1"]), "wide": body("wide.mesh", "1:xy")}
    keys["interfaces"] = {"around": {**face("block:4,1,2", "wide:3"), "slave": "second"}}
    assert "interface 'around': its side turns by 90 degrees at (" in run.case(keys).output
    keys["interfaces"]["around"]["between"] = ["block:1", "wide:3"]
    assert "its side turns" not in run.case(keys, code=None).output


def test_of_rings_tell_what_chords_take(run):
    """Rings that are pressed into each other, a quarter of each: Lamé's pressure of an interference d at radius 1. Chords of
    elements are off the arcs by as much; how much that takes of the largest pressure is what it is wrong by, and is told."""
    d, E, nu, inner, outer = 1e-3, 1000, 0.3, 0.5, 2
    lame = d * E / (1 - nu * nu) / ((outer**2 + 1) / (outer**2 - 1) + (1 + inner**2) / (1 - inner**2))

    def ring(name, first, last, along, order):
        def place(x, y):
            r, angle = first + (last - first) * x, math.pi / 2 * y
            return r * math.cos(angle), r * math.sin(angle)

        run.write(name, curved(8, along, place) if order == 2 else rectangle(even(0, 1, 8), even(0, 1, along), place))

    def press(along, order, gap=None, overlap=1e-3):
        """What was warned of, and by how much the pressure is wrong, over its largest."""
        kind = ".msh" if order == 2 else ".mesh"
        ring("in" + kind, inner, 1 + overlap, along, order)
        ring("out" + kind, 1, outer, along * 4 // 3, order)
        fit = face("in:2", "out:4", 0)
        if gap is not None:
            fit["gap"] = gap
        got = run.case({"order": order, "history": ["P=0", "P=1"], "geometry": "as meshed",
                        "bodies": {"in": body("in" + kind, "1:y 3:x", [], E, nu), "out": body("out" + kind, "1:y 3:x", ["P pressure 2 1e-9"], E, nu)},
                        "interfaces": {"fit": fit}}, "--csv", run.folder / "fit")
        p = run.columns("fit_nodes.csv")["p"]
        return got.warned(), max(abs(x - lame) for x in p) / max(max(p), 1e-300)

    for along, order in ((45, 1), (3, 2)):
        said, wrong = press(along, order)
        assert wrong > 0.05
        near(float(said.split("of a single node by up to ")[1].split()[0]) / wrong, 1, 0.5)
        said, wrong = press(along, order, -d)
        assert said == "" and wrong < 0.06
    # Chords so long that sides that overlap are apart, and elements that follow the arcs.
    for overlap in (d, 0.1 * d):
        assert "no node carries a force now, but some may on the curves" in press(9, 1, None, overlap)[0]
    assert press(9, 1, None, -20 * d)[0] == ""  # a clearance beyond doubt
    # What was pressed and is no more is known by what it was.
    run.block("plane.mesh", -2, 2, 24, -2, 0, 6)
    run.write("pad.mesh", rectangle(even(-1, 1, 32), even(0, 1, 8), lambda x, y: (x, y + (1 - y) * 0.025 * x * x)))
    assert run.case({"order": 1, "history": ["P=0", "P=1", "P=0"],
                     "bodies": {"pad": body("pad.mesh", "@0,1:x", ["P pressure 3 1"], 1000, 0.3), "plane": body("plane.mesh", "1:xy", [], 1000, 0.3)},
                     "interfaces": {"hertz": face("pad:1", "plane:3", 0.3)}}).warned() == ""
    said, wrong = press(15, 2)
    assert said == "" and wrong < 0.01


def test_orders_may_differ(run):
    """The orders of two sides may differ: a uniform pressure is carried as it is."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 3, 2, 5, 4)
    keys = {"history": ["P=0", "P=1"], "order": 2,
            "bodies": {"low": body("low.mesh", "4:x 1:y"), "high": body("high.mesh", "4:x", ["P pressure 3 2"])},
            "interfaces": {"joint": {**face("high:1", "low:3"), "slave": "first"}}}
    for order in (1, 3):
        run.case(changed(keys, {"bodies.high.order": order}), "--csv", run.folder / "out")
        p = run.columns("out_nodes.csv")["p"]
        assert len(p) == 3 * order + 1
        near_all(p, 2, 1e-11)
    assert "key 'bodies.high.order' is 1.5, must be a whole number" in run.refused(changed(keys, {"bodies.high.order": 1.5}))


def test_of_matrices_without_elements_take_an_order(run):
    """A bilinear square as a program of one's own writes it: 2 × 2, nodes 1 to 4 round it, E = 1000, ν = 0; K of its two by two
    functions is a product of the 1-D mass {2/3, 1/3} and stiffness {1/2, -1/2}."""
    place = [(0, 0), (2, 0), (2, 2), (0, 2)]

    def mass(i, j):
        return 2 / 3 if i == j else 1 / 3

    def stiff(i, j):
        return 0.5 if i == j else -0.5

    def slope(i, _):  # ∫ φ_i' φ_j
        return -0.5 if i == 0 else 0.5

    def entry(a, c, b, d):
        (ax, ay), (bx, by) = ((place[n][0] > 1, place[n][1] > 1) for n in (a, b))
        xx, yy = stiff(ax, bx) * mass(ay, by), mass(ax, bx) * stiff(ay, by)
        if c == d:
            return 1000 * (xx + yy / 2 if c == 0 else yy + xx / 2)
        # ν = 0: only shear couples, G ∫ (of x) φ_a,y φ_b,x.
        return 500 * slope(ay, by) * slope(bx, ax) if c == 0 else 500 * slope(ax, bx) * slope(by, ay)

    pairs = [(a, c, b, d) for a in range(4) for c in (0, 1) for b in range(4) for d in (0, 1)]
    run.write("own.mtx", "%%MatrixMarket matrix coordinate real general\n8 8 64\n"
              + "".join("%d %d %.17g\n" % (2 * a + c + 1, 2 * b + d + 1, entry(a, c, b, d)) for a, c, b, d in pairs))
    run.write("own.dofs", "".join(f"{a + 1} {c + 1} {place[a][0]} {place[a][1]}\n" for a in range(4) for c in (0, 1))
              + "set BOTTOM 1 2\nset TOP 3 4\nset LEFT 1 4\n")
    keys = {"history": ["P=0", "P=1"], "bodies": {"own": {"matrix": "own.mtx", "support": "LEFT:x", "load": ["P traction TOP 0 -3"]}},
            "interfaces": {"floor": {"between": ["own:BOTTOM"]}}}
    assert "its elements are not known, so key 'bodies.own.order' must give" in run.refused(keys)
    got = run.case(changed(keys, {"bodies.own.order": 1}), "--csv", run.folder / "own")
    near(got.interface("floor")["normal"], 6, 1e-12)
    near_all(run.columns("own_nodes.csv")["p"], 3, 1e-12)


def test_heated_columns_press(run):
    """A column between two walls that is heated: E α ΔT."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    keys = {"analysis": "plane stress",
            "bodies": {"low": {**body("low.mesh", "4:x 1:y", ["H temperature 50"], 1000, 0.3), "expansion": 1e-4},
                       "high": body("high.mesh", "4:x 3:y", [], 1000, 0.3)},
            "interfaces": {"joint": face("high:1", "low:3", 0)}}
    near(run.case(keys).interface("joint")["normal"], 1000 * 1e-4 * 50 * 2 / 5, 1e-10)
    assert "coefficient of thermal expansion is not given" in run.refused(changed(keys, {"bodies.low.expansion": None}))


def test_guides_are_forces_or_displacements(run):
    """A lap joint whose end is gripped: under a force, and by the displacements that it made."""
    run.block("low.mesh", 0, 4, 16, 0, 1, 4)
    run.block("high.mesh", 1, 6, 22, 1, 2, 4)
    keys = {"bodies": {"low": body("low.mesh", "4:xy", [], 1000, 0.3), "high": body("high.mesh", "", ["P pressure 3[1.1<x<4] 20"], 1000, 0.3)},
            "interfaces": {"flat": face("high:1[0<x<5]", "low:3", 0.4)}, "history": ["P=0", "P=1", "Q=1", "Q=-0.5"]}
    keys["bodies"]["high"]["guides"] = {"on": "2", "x": {"force": "Q", "value": 7}, "rotation": "free"}
    force = run.case(keys, "--csv", run.folder / "force")
    near(force.interface("flat")["force_x"], 3.5, 1e-9)
    near(force.interface("flat")["force_y"], 20 * 2.9, 1e-8)
    # From each increment to the next.
    history = run.columns("force_history.csv")
    keys["bodies"]["high"]["guides"] = {"on": "2", "x": {"displacement": "Q"}, "rotation": "free"}
    keys["history"] = ["P=0"] + ["P=%.17g Q=%.17g" % (p, u) for p, u in zip(history["load P"], history["displacement Q"])]
    keys["increments"] = 1
    displacement = run.case(keys, "--csv", run.folder / "moved")
    near(run.columns("moved_history.csv")["reaction Q"][-1], -3.5, 1e-3)
    near(displacement.interface("flat")["force_x"], 3.5, 1e-3)


@pytest.mark.parametrize("sides, mirrored", [(["up:1", "low:3"], False), (["low:3", "up:1"], False), (["up:1", "low:3"], True)])
def test_strengths_hold_by_their_way_of_slip(run, sides, mirrored):
    """A block that a guide presses by 2 over a length of 2 and pushes: with bounds of 0.06 + 0.1 p forward and 0.1 + 0.2 p
    backward (but for pressures below 0.01, which no node has) it slides at 0.06·2 + 0.1·2 to the right and 0.1·2 + 0.2·2 to
    the left, however the pressure is spread. Forward is where the first side's body moves with its line on its left, which is
    the same of either body; in a mirror the ways change places."""
    run.block("up.mesh", -1, 1, 16, 0, 1, 6)
    run.block("low.mesh", -2, 2, 20, -1, 0, 6)
    weak, strong = [[0.01, 0.061], [100, 10.06]], [[0.01, 0.102], [100, 20.1]]
    strength = {"forward": strong if mirrored else weak, "backward": weak if mirrored else strong}
    up = {**body("up.mesh"), "guides": [{"on": "3", "x": {"force": "Q", "value": 1}, "y": {"force": "P", "value": -2}}]}
    keys = {"bodies": {"up": up, "low": body("low.mesh", "1:xy")}, "interfaces": {"flat": {"between": sides, "strength": strength}}}
    right, left = (0.6, 0.32) if mirrored else (0.32, 0.6)
    for push, bound in ((1, right), (-1, -left)):
        got = run.case({**keys, "history": ["P=0", "P=1", f"Q={push}"]}, code=2)
        assert got["status"] == "gross sliding"
        # What the march tells the last load by, 1e-10 of the way there, and round-off.
        near(got["event_loads"]["Q"], bound, 1e-9)


def test_guided_bars_give_by_their_compliance(run):
    run.block("low.mesh", 0, 2, 8, 0, 3, 6)
    run.block("high.mesh", 0, 2, 11, 3, 7, 6)
    guide = {"on": "3", "y": {"force": "P", "value": -10}, "rotation": {"moment": "M"}}
    keys = {"bodies": {"low": body("low.mesh", "1:xy"), "high": {**body("high.mesh", "", [], 500), "guides": [guide]}},
            "interfaces": {"joint": face("high:1", "low:3")}, "history": ["P=0", "P=1"]}
    got = run.case(keys, "--csv", run.folder / "out")
    near(run.columns("out_history.csv")["displacement P"][-1], 10 * (3 / 1000 + 4 / 500) / 2, 1e-11)
    near(got.interface("joint")["normal"], 10, 1e-10)
    near_all(run.columns("out_nodes.csv")["p"], 5, 1e-9)
    assert "is held, moved or guided already" in run.refused(changed(keys, {"bodies.high.support": "2:x"}))


def column_on(obstacle, load="D displacement-y 3 -0.03"):
    return {"bodies": {"column": body("column.mesh", "3:x", [load])}, "interfaces": {"floor": {"between": ["column:1"], "obstacle": obstacle}}}


def circle(radius, y):
    return {"circle": {"centre": [0, y], "radius": radius}}


def test_obstacles_have_shapes(run):
    """A column above a rigid line, a disc whose top and a hole whose bottom are there."""
    run.block("column.mesh", -0.5, 0.5, 4, 0.01, 1.01, 4)
    line = run.case(column_on({"line": [[-1, 0], [0, 0], [3, 0]]}))
    near(line.interface("floor")["normal"], 20, 1e-10)  # 1000 (0.03 - 0.01)
    for side in (1, -1):
        run.case(column_on(circle(100 * side, -100 * side)), "--csv", run.folder / "out", "--history", "D=0; D=0.1")
        # Not reached yet by what is moved by 0.003; opening is the gap there.
        nodes = run.columns("out_nodes.csv")
        for x, gap in zip(nodes["x"], nodes["opening"]):
            near(gap, 0.01 - 0.003 + side * (100 - math.sqrt(1e4 - x * x)), 1e-12)
    assert "does not face the obstacle" in run.refused(column_on(circle(0.1, -0.1)))


def test_obstacles_may_be_curves(run):
    """A curve is the circle that it is; a hole comes from above."""
    run.block("column.mesh", -0.5, 0.5, 4, 0.01, 1.01, 4)
    for side, curve in ((1, "sqrt(100-x^2)-10"), (-1, "10-sqrt(100-x^2)")):
        run.case(column_on(circle(10 * side, -10 * side)), "--csv", run.folder / "circle")
        run.case(column_on({"curve": curve}), "--csv", run.folder / "curve")
        alike(run.columns("circle_nodes.csv")["p"], run.columns("curve_nodes.csv")["p"], 1e-9)
    assert "does not face the obstacle" in run.refused(column_on({"curve": "sqrt(x-9)"}))
    assert "'y' is not a number or a function of x" in run.refused(column_on({"curve": "y"}))


def test_obstacles_overlap_by_little(run):
    """An obstacle in a wrong place is no interference, unless it is said to be one."""
    run.block("column.mesh", -0.5, 0.5, 4, 0, 1, 4)
    keys = column_on({"line": [[-1, 0.02], [1, 0.02]]}, "D displacement-y 3 0")
    near(run.case(keys).interface("floor")["normal"], 1000 * 0.02, 1e-9)
    keys = column_on({"line": [[-1, 0.03], [1, 0.03]]}, "D displacement-y 3 0")
    assert "key 'interfaces.floor.obstacle' overlaps the body by 0.03" in run.refused(keys)
    near(run.case(changed(keys, {"interfaces.floor.overlap": 0.2})).interface("floor")["normal"], 1000 * 0.03, 1e-9)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_of_a_block_in_a_rigid_corner_pass_the_patch_test(run, order):
    """A block in a rigid corner bears uniform pressures, of 1 below and 2 on its left: the node in the corner has one row, and
    its neighbours carry what it leaves of the other side."""
    run.block("block.mesh", 0, 1, 5, 0, 1, 4)
    got = run.case({"order": order, "history": ["P=0", "P=1"],
                    "bodies": {"block": body("block.mesh", "", ["P pressure 3 1", "P pressure 2 2"], 1000, 0.3)},
                    "interfaces": {"floor": {"between": ["block:1"]}, "wall": {"between": ["block:4"]}}}, "--csv", run.folder / "corner")
    assert got.warned() == ""
    p = run.columns("corner_nodes.csv")["p"]
    assert len(p) == 9 * order + 1
    near_all(p[:5 * order + 1], 1, 1e-9)
    near_all(p[5 * order + 1:], 2, 1e-9)


def slit_block():
    """A block of 4 x 2 that is cut along y = 1 from its left side to x = 3: of boundary attributes as a block, and 5 for the
    lower lip, 6 for the upper one."""
    columns, tip = 8, 6

    def lower(i, j):
        return ("lower", i, j)

    def upper(i, j):
        return lower(i, j) if j == 2 and i >= tip else ("upper", i, j)

    quads, edges = [], []
    for i in range(columns):
        for at, j in ((lower, 0), (lower, 1), (upper, 2), (upper, 3)):
            quads.append([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        edges += [(1, lower(i, 0), lower(i + 1, 0)), (3, upper(i + 1, 4), upper(i, 4))]
        if i < tip:
            edges += [(5, lower(i + 1, 2), lower(i, 2)), (6, upper(i, 2), upper(i + 1, 2))]
    for at, j in ((lower, 0), (lower, 1), (upper, 2), (upper, 3)):
        edges += [(2, at(columns, j), at(columns, j + 1)), (4, at(0, j + 1), at(0, j))]
    number = {vertex: k for k, vertex in enumerate(dict.fromkeys(vertex for quad in quads for vertex in quad))}
    return mesh_text(["1 3 " + " ".join(str(number[v]) for v in quad) for quad in quads],
                     [f"{tag} 1 {number[a]} {number[b]}" for tag, a, b in edges], [f"{0.5 * i} {0.5 * j}" for _, i, j in number])


@pytest.mark.parametrize("order", [1, 2, 3])
def test_of_a_slit_pass_the_patch_test(run, order):
    """A slit whose lips match bears the uniform stress of the block around it, but for its tip, which carries no row, and slips
    where friction is less than that."""
    run.write("slit.mesh", slit_block())
    load = ["P pressure 1,3 1.3", "Q traction 3 0.3 0", "Q traction 1 -0.3 0", "Q traction 2 0 0.3", "Q traction 4 0 -0.3"]
    keys = {"order": order, "history": ["P=0", "P=1", "Q=1"], "bodies": {"block": body("slit.mesh", "@0,0:xy @4,0:y", load, 1000, 0.3)},
            "interfaces": {"slit": face("block:6", "block:5")}}
    run.case(keys, "--csv", run.folder / "slit")
    nodes = run.columns("slit_nodes.csv")
    assert len(nodes["p"]) == 6 * order
    near_all(nodes["p"], 1.3, 1e-9)
    near_all([abs(q) for q in nodes["q"]], 0.3, 1e-9)
    assert run.case(changed(keys, {"interfaces.slit.friction": 0.1}))["total_dissipation"] > 0


def test_warn_of_what_is_not_meant(run):
    """What is warned of, and what is not: a shank that pushes, a load that does nothing, nodes of the slave that face nothing
    are counted; a hole, a slit that is an interface and contact that goes on tied are what they should be."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 4, 2, 5, 4)
    keys = {"bodies": {"low": body("low.mesh", "4:x 1:y"), "high": body("high.mesh", "4:x", ["F pressure 3 1", "Z traction 2 0 1"])},
            "interfaces": {"joint": face("high:1", "low:3")}, "bolts": bolted(["high:3", "low:1"], 1, 40),
            "history": ["F=0", "F=10", "bolt=1"]}
    pushed = run.case(keys)
    # Pressed by 10 the columns, of compliance 5/1000, give: the shank resists by 10 s c/(1 + s c). Its range begins where it
    # is tightened.
    bolt = pushed["bolts"][0]
    near(bolt["least"], (40 - 10 * 0.005) / 1.005, 1e-10)
    assert bolt["least"] == bolt["most"]
    assert "bolt 'bolt' is compressed, by up to 0.0497" in pushed.warned()
    assert "load 'Z' is zero throughout the history" in pushed.warned()
    assert "no node opposite" not in pushed.output
    keys["history"] = ["F=0", "bolt=1", "Z=1 F=1", "F=0 Z=0"]
    assert run.case(keys).warned() == ""
    # Forces of a shank along y that pass each other at 0.875 - 0.125.
    keys["bolts"]["bolt"].update(between=["high:3[0<x<0.25]", "low:1[0.75<x<1]"], direction=[0, 1])
    keys["history"] = ["F=0 Z=0", "F=40 bolt=0.01 Z=1", "F=0 Z=0 bolt=0"]
    assert ("lie at (0.125, 5) and (0.875, 0): its two forces pass each other at a distance of 0.75 and turn the bodies"
            in run.case(keys).warned())
    # Two elements of the upper side stand beyond the lower one.
    run.block("wide.mesh", 0, 1.5, 6, 2, 5, 4)
    keys["bodies"]["high"] = body("wide.mesh", "4:x", ["F pressure 3 1"])
    keys.update(order=1, history=["F=0", "F=1"])
    keys["interfaces"]["joint"]["slave"] = "first"
    del keys["bolts"]
    wide = run.case(keys)
    assert wide.interface("joint")["free_surface"] == 2
    assert "no node opposite" in wide.output
    # They are drawn where they are.
    run.case(keys, "--check", "--csv", run.folder / "wide")
    drawn = (run.folder / "wide_contact.csv").read_text(encoding="utf-8").splitlines()
    facing = "contact facing nothing,"
    assert {line[len(facing):] for line in drawn if line.startswith(facing)} == {"1.25,2,0,0", "1.5,2,0,0"}
    # Plates that are bolted one bolt after the other: the last one feels the others by less than a thousandth of its
    # pretension.
    run.block("low.mesh", -6, 5, 22, -1, 0, 3)
    run.block("high.mesh", -5, 6, 22, 0, 1, 3)
    places = {"a": "[-4<x<-3]", "b": "[-0.5<x<0.5]", "c": "[3<x<4]"}
    row = run.case({"history": ["a=0", "a=1", "b=1", "c=1"],
                    "bodies": {"low": body("low.mesh", "4:xy"), "high": body("high.mesh")},
                    "interfaces": {"joint": face("high:1", "low:3", 0.3)},
                    "bolts": {name: {"between": ["high:3" + at, "low:1" + at], "stiffness": 50, "pretension": 2} for name, at in places.items()}})
    assert row.warned() == ""
    assert row["bolts"][2]["least"] == row["bolts"][2]["force"]
    run.write("slit.mesh", slit_block())
    history = ["P=0", "P=1", "Q=1"]
    assert run.case({"history": history, "bodies": {"block": body("slit.mesh", "1:xy", ["P pressure 3 1.3", "Q traction 3 0.3 0"], 1000, 0.3)},
                     "interfaces": {"slit": face("block:6", "block:5")}}).warned() == ""
    run.block("a.mesh", 0, 4, 8, 0, 1, 2)
    run.block("b.mesh", 0, 4, 8, 1, 2, 2)
    assert run.case({"history": history,
                     "bodies": {"a": body("a.mesh", "1:xy"), "b": body("b.mesh", "", ["P pressure 3 1", "Q traction 3 0.25 0"])},
                     "interfaces": {"weld": {"between": ["a:3[0<x<1.5]", "b:1[0<x<1.5]"], "tied": True},
                                    "contact": face("a:3[1.5<x<4]", "b:1[1.5<x<4]", 0.3)}}).warned() == ""


def moved_nodes(text, up):
    """A mesh of Gmsh's, format 2.2, that is moved up."""
    head, _, rest = text.partition("$Nodes\n")
    nodes, _, tail = rest.partition("$EndNodes")
    count, *lines = nodes.splitlines()
    made = [count]
    for line in lines:
        number, x, y, z = line.split()
        made.append("%s %s %.17g %s" % (number, x, float(y) + up, z))
    return head + "$Nodes\n" + "\n".join(made) + "\n$EndNodes" + tail


def read(file):
    with open(file, encoding="utf-8") as opened:
        return opened.read()


@pytest.mark.rest
def test_of_a_pin_amid_its_hole_take_up_the_clearance(run):
    """A pin that is meshed amid its hole comes to where the shipped one is meshed, and is pressed on there. Its hole is then
    that of a place 0.01 higher, 0.2 % of the radius."""
    keys = shipped("pin")
    touches = run.case(keys)
    run.write("pin.msh", moved_nodes(read(keys["bodies"]["pin"]["mesh"]), 0.01))
    free = run.case(changed(keys, {"bodies.pin.mesh": "pin.msh"}))
    near(free.interface("bearing")["force_y"], touches.interface("bearing")["force_y"], 1e-6)
    near(free["peak_pressure"] / touches["peak_pressure"], 1, 5e-3)


def test_obstacles_move(run):
    """It is the same whether a body is pressed on its obstacle and dragged, or the obstacle moves."""
    run.block("pad.mesh", -1, 1, 12, 0, 1, 6)
    load = ["D displacement-y 3 -0.03", "D displacement-x 3 0", "S displacement-x 3 0.02", "S displacement-y 3 0",
            "T displacement-x 3 0.01-0.01*y", "T displacement-y 3 0.01*x"]
    keys = {"history": ["D=0", "D=1", "S=1", "S=-1", "S=1", "T=1"], "increments": 40,
            "bodies": {"pad": body("pad.mesh", "", load, 1000, 0.3)}, "interfaces": {"floor": {"between": ["pad:1"], "friction": 0.4}}}
    body_moves = run.case(keys, "--csv", run.folder / "one")
    motion = {"D": {"y": 0.03}, "S": {"x": -0.02}, "T": {"angle": -0.01, "centre": [0, 1]}}
    keys = changed(keys, {"bodies.pad": body("pad.mesh", "3:xy", [], 1000, 0.3), "interfaces.floor.motion": motion})
    floor_moves = run.case(keys, "--csv", run.folder / "other")
    one, other = run.columns("one_nodes.csv"), run.columns("other_nodes.csv")
    for name in ("p", "q", "slip", "opening"):
        alike(one[name], other[name], 1e-7 * 30)
    near(body_moves["total_dissipation"] / floor_moves["total_dissipation"], 1, 1e-8)
    one, other = run.columns("one_history.csv"), run.columns("other_history.csv")
    # A function has no size, so that its reaction is work per unit of T.
    for name, its, size in (("reaction D", "reaction D", 1), ("reaction S", "reaction S", 1), ("reaction per unit of T", "reaction T", 0.01)):
        assert len(one[name]) == len(other[its])
        near(one[name][-1], size * other[its][-1], 1e-8 * size / 0.02)
    # By the force on the pad, for the obstacle.
    force = floor_moves.interface("floor")
    near(other["reaction S"][-1], -force["force_x"], 1e-9 / 0.02)
    near(other["reaction D"][-1], force["force_y"], 1e-8 / 0.03)
    assert "unknown key 'z'" in run.refused(changed(keys, {"interfaces.floor.motion": {"D": {"z": 1}}}))


def test_initial_strains_are_tensors(run):
    """A residual stress: a strain along y of 1e-3 y in the lower of two columns between walls."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    got = run.case({"analysis": "plane stress",
                    "bodies": {"low": body("low.mesh", "4:x 1:y", ["E initial-strain 0 1e-3*y 0 7"]), "high": body("high.mesh", "4:x 3:y")},
                    "interfaces": {"joint": face("high:1", "low:3", 0)}})
    near(got.interface("joint")["normal"], 1000 * 1e-3 * 2 / 5, 1e-10)


def test_tell_the_loop_of_each_interface(run):
    """Losses and loops of each interface: they add up to those of the joint."""
    run.block("low.mesh", -3, 3, 18, -1, 0, 4)
    run.block("middle.mesh", -2, 2, 16, 0, 1, 4)
    run.block("high.mesh", -1, 1, 11, 1, 2, 4)
    got = run.case({"history": ["P=0", "P=1", "Q=0.5", "Q=-0.5", "Q=0.5"], "cycle-start": 2, "cycles": 3,
                    "bodies": {"low": body("low.mesh", "1:xy", [], 1000, 0.3), "middle": body("middle.mesh", "", [], 1000, 0.3),
                               "high": body("high.mesh", "", ["P pressure 3 1", "Q traction 3 1 0"], 1000, 0.3)},
                    "interfaces": {"below": face("middle:1", "low:3[-2<x<2]", 0.6), "above": face("high:1", "middle:3[-1.5<x<1.5]", 0.6)}},
                   "--csv", run.folder / "out")
    cycles, its = run.columns("out_cycles.csv")["dissipation"], run.columns("out_interface_cycles.csv")
    losses = its["dissipation"]
    assert len(losses) == 2 * len(cycles)
    for k, loss in enumerate(cycles):
        near(losses[2 * k] + losses[2 * k + 1], loss, 1e-9 * loss)  # of 10 digits
    near_all(its["shear_range"], 2, 1e-9)
    for name, length in (("below", 4), ("above", 2)):  # zones fill the interface
        found = got.interface(name)
        near(found["stick"] + found["slip"] + found["separation"], length, 1e-9)


def test_warn_where_displacements_are_not_small(run):
    """Each limit of small displacements is warned of in one sentence."""
    run.block("pad.mesh", -1, 1, 12, 0.3, 1.3, 6)
    run.block("base.mesh", -3, 3, 18, -1, 0, 4)
    load = ["D displacement-y 3 -0.31", "D displacement-x 3 0", "S displacement-x 3 0.01", "S displacement-y 3 0"]
    keys = {"history": ["D=0", "D=1", "S=1"], "bodies": {"pad": body("pad.mesh", "", load), "base": body("base.mesh", "1:xy")},
            "interfaces": {"flat": face("pad:1", "base:3[-1<x<1]", 0.1)}}
    text = run.case(keys).warned()
    assert "'flat': contact closes or opens a gap of 0.3 at" in text
    assert "slips by" not in text and "turns by" not in text
    run.block("pad.mesh", -1, 1, 12, 0, 1, 6)
    keys["bodies"]["pad"]["load"][0] = "D displacement-y 3 -0.01"
    assert run.case(keys).warned() == ""
    keys["bodies"]["pad"]["load"][2] = "S displacement-x 3 0.4"
    assert "'flat': a node slips by 0.4" in run.case(keys).warned()
    keys["bodies"]["pad"]["load"] = ["D displacement-y 3 0.06*x-0.1", "D displacement-x 3 -0.06*y", "S displacement-x 3 0", "S displacement-y 3 0"]
    assert "body pad turns by 3." in run.case(keys).warned()


def test_tables_are_over_the_arc_length(run):
    """Friction and gap may vary along an interface: as tables, and the same as functions."""
    run.block("pad.mesh", 0, 2, 8, 0, 1, 2)
    run.block("base.mesh", 0, 2, 8, -1, 0, 2)
    keys = {"bodies": {"pad": body("pad.mesh", "", ["D displacement-y 3 -0.01", "D displacement-x 3 0"]), "base": body("base.mesh", "1:xy")},
            "interfaces": {"flat": {**face("pad:1", "base:3"), "slave": "first"}}}
    for gap, friction in (([[0, 0.004], [2, 0.004]], [[0, 0.1], [2, 0.5]]), ("0.004+0*s", "0.1+0.2*s")):
        keys["interfaces"]["flat"].update(gap=gap, friction=friction)
        run.case(keys, "--csv", run.folder / "out", "--save", run.folder / "saved.json")
        nodes = run.columns("out_nodes.csv")
        # Two columns of height 1 in series, each of E = 1000.
        near_all(nodes["p"], 3, 1e-10)
        saved = json.loads(read(run.folder / "saved.json"))["friction"]["values"]
        alike(saved, [0.1 + 0.2 * s for s in nodes["arc_length"]], 1e-14)
    assert "key 'interfaces.flat.friction' is -0." in run.refused(changed(keys, {"interfaces.flat.friction": "0.1-s"}))


@pytest.mark.parametrize("gap", ["0.3+0.1*s", "0.4+0.1*x+0*y", [[0, 0.3], [1, 0.4], [2, 0.5]]])
def test_tables_do_not_depend_on_the_slave(run, gap):
    """The arc length of tables is that of the first side, whichever has the nodes."""
    run.block("pad.mesh", -1, 1, 7, 0, 1, 2)
    run.block("base.mesh", -2, 2, 11, -1, 0, 2)
    for slave in ("first", "second"):
        run.case({"bodies": {"pad": body("pad.mesh", "3:xy", ["P traction 2 0 1e-9"]), "base": body("base.mesh", "1:xy")},
                  "interfaces": {"flat": {**face("pad:1", "base:3"), "gap": gap, "slave": slave}}}, "--csv", run.folder / "out")
        nodes = run.columns("out_nodes.csv")
        assert len(nodes["x"]) > 5
        for x, opening in zip(nodes["x"], nodes["opening"]):
            # Beyond its ends a table is constant, the line goes on.
            at = min(max(x, -1), 1) if isinstance(gap, list) else x
            near(opening, 0.4 + 0.1 * at, 1e-9)


def test_moments_are_in_equilibrium(run):
    """Forces act where they act: the moment about the middle balances the loads, also over a gap and where the slave is wider
    than what it faces."""
    gap, p, q = 0.01, 0.9, 0.2
    run.block("pad.mesh", -1, 1, 5, gap, 1 + gap, 3)
    run.block("base.mesh", -3.1, 2, 7, -1, 0, 2)
    for slave in ("first", "second"):
        flat = run.case({"bodies": {"pad": body("pad.mesh", "", ["P pressure 3 0.9", "Q traction 3 0.2 0"]), "base": body("base.mesh", "1:xy")},
                         "interfaces": {"flat": {**face("pad:1", "base:3", 0.9), "slave": slave}},
                         "history": ["P=0", "P=1", "Q=1"]}).interface("flat")
        x, y = flat["about_x"], flat["about_y"]
        loads = -x * -2 * p - (1 + gap - y) * 2 * q
        near(flat["moment"], -loads, 1e-11)
        # On the base they act lower by the gap.
        near(flat["moment_defect"], gap * 2 * q, 1e-11)


def test_pads_feel_each_other_through_a_half_plane(run):
    """Two pads on one half-plane: what they do to each other goes through it."""
    run.block("left.mesh", -3, -1, 6, 0, 1, 2)
    run.block("right.mesh", 0.5, 2, 7, 0, 1.2, 3)
    run.write("both.mesh", united(rectangle(even(-3, -1, 6), even(0, 1, 2)), rectangle(even(0.5, 2, 7), even(0, 1.2, 3))))

    def loads(part, p, q):
        return [f"P pressure 3{part} {p}", f"Q traction 3{part} {q} 0"]

    ground = {"half-plane": {"young": 500, "poisson": 0.2}}
    history = ["P=0", "P=1", "Q=1", "Q=-1", "Q=1"]
    two = run.case({"history": history,
                    "bodies": {"left": body("left.mesh", "", loads("", 3, 0.3)), "ground": ground, "right": body("right.mesh", "", loads("", 1, -0.1))},
                    "interfaces": {"l": face("left:1", "ground", 0.4), "r": face("right:1", "ground", 0.4)}}, "--csv", run.folder / "two")
    near(two.interface("l")["normal"], 6, 1e-11)
    near(two.interface("r")["tangential"], 0.15, 1e-11)
    # One body of two pieces has one line of two.
    all_loads = loads("[-3<x<-1]", 3, 0.3) + loads("[0.5<x<2]", 1, -0.1)
    one = run.case({"history": history, "bodies": {"both": body("both.mesh", "", all_loads), "ground": ground},
                    "interfaces": {"one": face("both:1", "ground", 0.4)}}, "--csv", run.folder / "one")
    a, b = run.columns("two_nodes.csv"), run.columns("one_nodes.csv")
    for name in ("p", "q", "slip", "opening"):
        alike(a[name], b[name], 1e-9)
    near(two["total_dissipation"], one["total_dissipation"], 1e-12)


def united(one, other):
    """Two MFEM meshes in one."""
    def sections(text):
        words = text.split("\n\n")
        return [words[k].split("\n")[2:] for k in (2, 3)], words[4].strip().split("\n")[3:]

    (elements, boundary), vertices = sections(one)
    (more, edges), places = sections(other)

    def shifted(lines):
        return [" ".join(line.split()[:2] + [str(int(v) + len(vertices)) for v in line.split()[2:]]) for line in lines]

    return mesh_text(elements + shifted(more), boundary + shifted(edges), vertices + places)


@pytest.mark.rest
def test_shafts_of_two_parts_twist(run):
    """A hollow shaft of two parts that are pressed together and twisted: of one material it stays plane, and its angle is that
    of its parts in series; all of it slips under 2/3 π f p (a³ - b³)."""
    a, p, f, G, J = 2, 3, 0.3, 500, math.pi / 2 * 15
    most = 2 * math.pi / 3 * f * p * 7
    run.block("upper.mesh", 1, a, 5, 0, 1.5, 2)
    run.block("same.mesh", 1, a, 5, -1, 0, 2)
    run.block("other.mesh", 1, a, 8, -1, 0, 2)
    losses = []
    for lower in ("same.mesh", "other.mesh"):
        for slave in ("first", "second"):
            def twisted(torque, code=0):
                load = ["P pressure 3 3", "T traction-t 3 %.17g*r" % (torque / J)]
                return run.case({"analysis": "axisymmetric", "history": ["P=0", "P=1", "T=1"],
                                 "bodies": {"upper": body("upper.mesh", "", load), "lower": body(lower, "1:zt")},
                                 "interfaces": {"flat": {**face("upper:1", "lower:3", f), "slave": slave}}}, "--csv", run.folder / "out", code=code)

            # The outer edge slips from 3/4 of all on, on a mesh its node a little earlier.
            T = 0.4 * most
            stuck = twisted(T)
            near(stuck.interface("flat")["torque"], -T, 1e-9)
            near(stuck.interface("flat")["normal"], 3 * p * math.pi, 1e-9)
            # A shear that grows with r is right in the mean alone where nodes do not match.
            angle = T * 2.5 / (G * J)
            near(run.columns("out_history.csv")["displacement T"][-1] / angle, 1, 1e-9 if lower == "same.mesh" else 1e-6)
            losses.append(twisted(0.99 * most)["total_dissipation"])
            assert twisted(1.01 * most, code=2)["status"] == "gross sliding"
    # Nodes that match are paired if the first side has them, a union over interfaces if not.
    near(losses[0], losses[1], 1e-9 * losses[0])


@pytest.mark.parametrize("inner", [1, 0])
def test_torques_are_in_equilibrium(run, inner):
    """The torque of an interface is that of the loads also where elements are faced in part, so that forces act beside the
    nodes. A full shaft may be held on its axis, where nothing moves around it anyhow."""
    a, b = inner + 0.1 if inner else 0, 1.75
    axis = "" if inner else "4:rt"
    run.block("upper.mesh", a, b, 5, 0, 1, 2)
    run.block("lower.mesh", inner, 2, 8, -1, 0, 2)
    T, N = 0.2 * 2 * math.pi * (b**4 - a**4) / 4, 3 * math.pi * (b * b - a * a)
    for order in (1, 2, 3):
        for slave in ("first", "second"):
            flat = run.case({"analysis": "axisymmetric", "order": order, "history": ["P=0", "P=1", "T=1"],
                             "bodies": {"upper": body("upper.mesh", axis, ["P pressure 3 3", "T traction-t 3 0.2*r"]),
                                        "lower": body("lower.mesh", ("1:rzt " + axis).strip())},
                             "interfaces": {"flat": {**face("upper:1", "lower:3"), "slave": slave}}}).interface("flat")
            near(flat["torque"], -T, 1e-9 * T)
            near(flat["normal"], N, 1e-9 * N)


@pytest.mark.parametrize("order", [1, 2, 4])
def test_of_meshes_that_match_need_no_pairing(run, order):
    """The dovetail without its pairing, by integrals over its elements: nothing that this discretisation and the paired one
    share decides the loss, nor the peak of the pressure. Paired nodes stand off one another by 0.06 of an element, whose square
    is 4e-3: half of it. Linear elements are chords of its arcs, and what the arcs do between nodes is seen by integrals alone: as
    meshed it is left out of both, else it changes the largest pressure by what is estimated of chords, to a factor of two."""
    keys = {**shipped("dovetail"), "order": order}
    without = changed(keys, {"interfaces.flank.pairing": None})
    paired, mortar = run.case(keys), run.case({**without, "geometry": "as meshed"} if order == 1 else without)
    if order == 1:
        told = mortar["chords_peak_pressure_change_estimate"]
        smooth = run.case(without)
        assert "chords_peak_pressure_change_estimate" not in smooth.results
        changes = abs(smooth["peak_pressure"] / mortar["peak_pressure"] - 1)
        assert 0.5 * told < changes < 2 * told
    for key in ("total_dissipation", "peak_pressure"):
        near(mortar[key] / paired[key], 1, 2e-3)
    near(mortar["dissipation"][-1] / paired["dissipation"][-1], 1, 2e-3)
    for c in (0, 1):
        near(mortar["contact_force"][c] / paired["contact_force"][c], 1, 1e-4)


FLAT = "interfaces.flat."
BOLT = {"between": ["pad:2", "base:2"], "stiffness": 1, "pretension": 1}
FLOOR = {"interfaces.floor": {"between": ["base:1"]}, "bodies.base.support": None}
WRONG = [
    ({"nonsense": 1}, "unknown key 'nonsense', must be one of "),
    ({"analysis": "plane"}, "key 'analysis': 'plane' is not one of plane strain"),
    ({"analysis": ""}, "key 'analysis': '' is not one of plane strain"),
    ({"bolts": {"P": BOLT}}, "has a load 'P', which is the name of a bolt"),
    ({"bodies.pad.youngs": 1}, "key 'bodies.pad': unknown key 'youngs'"),
    ({"bodies.pad.young": -1}, "key 'bodies.pad.young' is -1, must be positive"),
    ({"bodies.pad.support": "7:x"}, "body pad ("),
    ({"bodies.base.support": "1,3:xy"}, "its side '3' of body base is held in all components by supports of the body (1,3:xy)"),
    ({"bodies.pad.load": 3}, "key 'bodies.pad.load' is 3, must be a string"),
    ({"bodies.pad.load": "P push 3 1"}, "bodies.pad.load' 'P push 3 1'"),
    ({FLAT + "between": ["pad:1", "bass:3"]}, "there is no body 'bass', must be one of pad, base"),
    ({FLAT + "between": ["pad:1"]}, "body base is in no interface"),
    ({FLAT + "friction": None, FLAT + "strength": [[1, 0.5], [2, 0.4]]}, "key 'interfaces.flat.strength"),
    ({FLAT + "friction": None, FLAT + "strength": {"forward": [[1, 0.5]]}}, "key 'interfaces.flat.strength"),
    ({"analysis": "axisymmetric", "bodies.pad.load": ["P pressure 3 1", "T traction-t 3 r"], "bodies.base.support": "1:rzt",
      FLAT + "friction": None, FLAT + "strength": {"forward": [[1, 0.5]], "backward": [[1, 0.4]]}}, "key 'interfaces.flat.strength'"),
    ({FLAT + "between": ["pad:1", "base:9"]}, "attribute 9"),
    ({FLAT + "between": ["pad:1", "pad:1"]}, "both sides are 'pad:1', must be two"),
    ({FLAT + "between": ["pad:2", "base:2"]}, "outward normals are (1, 0) and (1, 0) in the mean, must be opposite"),
    ({FLAT + "between": ["pad:4", "base:2"]}, "they lie beside each other, must lie over each other"),
    ({FLAT + "between": ["pad:face", "base:3"]}, "'face'"),
    ({FLAT + "friction": -0.1}, "key 'interfaces.flat.friction' is -0.1"),
    ({FLAT + "friction": [[1, 0.1], [0, 0.2]]}, "must increase"),
    ({FLAT + "gap": "open"}, "gap' is 'open', must be geometry, closed, a number, a function"),
    ({FLAT + "tied": True}, "is tied, it goes without the key friction"),
    ({FLAT + "between": ["pad:1", "base:2"]}, "interface 'flat'"),
    ({"bolts": {"b": {"between": ["pad:3", "base:1"]}}}, "has no 'stiffness'"),
    ({"bolts": {"b": {**BOLT, "between": ["pad:3"]}}}, "is bolted to the ground, it must have a direction"),
    ({"version": 3}, "must be 2"),
    ({"bolts": {"b": {**BOLT, "between": ["pad:2", "pad:2"]}}}, "both ends are 'pad:2'"),
    ({FLAT + "gap": "1/(s-s)"}, "key 'interfaces.flat.gap' is "),
    ({"interfaces.again": face("pad:1", "base:3")}, "are in contact by earlier interfaces"),
    ({"bodies.pad.guides": [{"on": "4"}]}, "reaches into the guide on '4' at (0, 0), whose nodes move as one block"),
    ({"bodies.pad.support": "3:t"}, "component 't', must be x, y or xy"),
    ({"bodies.pad.load": "T twist 3 1"}, "kind 'twist' is not one of "),
    ({**FLOOR, "interfaces.floor.motion": {"D": {"x": 0}}}, "floor.motion.D' moves nothing"),
    ({**FLOOR, "interfaces.floor.motion": {}}, "must be loads by names in braces, as {\"D\": {\"y\": -1}}"),
    ({**FLOOR, "interfaces.floor.obstacle": {"line": [[0, -1], [0, -1]]}}, "key 'interfaces.floor.obstacle': "),
]


def test_refuse_what_is_wrong_in_one_sentence(run):
    run.block("pad.mesh", 0, 2, 8, 0, 1, 2)
    run.block("base.mesh", 0, 2, 8, -1, 0, 2)
    keys = {"bodies": {"pad": body("pad.mesh", "", ["P pressure 3 1"]), "base": body("base.mesh", "1:xy")},
            "interfaces": {"flat": face("pad:1", "base:3")}}
    run.case(keys)
    for changes, words in WRONG:
        message = run.refused(changed(keys, changes))
        assert words in message, (changes, message)


def test_are_swept_by_their_keys(run):
    """A key of a structure may be swept."""
    run.block("pad.mesh", 0, 2, 8, 0, 1, 2)
    run.block("base.mesh", 0, 2, 8, -1, 0, 2)
    got = run.case({"bodies": {"pad": body("pad.mesh", "", ["P pressure 3 1"]), "base": body("base.mesh", "1:xy")},
                    "interfaces": {"flat": face("pad:1", "base:3")}},
                   "--sweep", "interfaces.flat.friction=0.1 0.2", "--csv", run.folder / "out")
    assert len(got["sweep"]) == 2


def deck(text, surfaces):
    """A mesh of Gmsh's, triangles of 6 nodes, as a deck: its named parts as surfaces, or as sets of nodes."""
    def section(name):
        return text.split(f"${name}\n")[1].split(f"$End{name}")[0].splitlines()[1:]

    names = {int(line.split()[1]): line.split('"')[1] for line in section("PhysicalNames") if line.startswith("1 ")}
    out = ["*HEADING", "** as a program writes it", "*NODE, NSET=ALL"]
    for line in section("Nodes"):
        number, x, y, _ = line.split()
        out.append(f"{number}, {x}, {y}, 0.")
    out.append("*ELEMENT, TYPE=CPS6, ELSET=BODY")
    side_of, parts = {}, {name: [] for name in names.values()}
    for line in section("Elements"):
        number, kind, tags, *rest = map(int, line.split())
        nodes = rest[tags:]
        if kind == 9:
            out.append(", ".join(map(str, [1000 + number, *nodes])))
            for k in range(3):
                side_of[frozenset((nodes[k], nodes[(k + 1) % 3]))] = (1000 + number, k + 1)
        elif kind == 8:
            parts[names[rest[0]]].append(nodes)
    for name, edges in parts.items():
        out.append(("*SURFACE, NAME=" if surfaces else "*NSET, NSET=") + name)
        for nodes in edges:
            element, side = side_of[frozenset(nodes[:2])]
            out.append(f"{element}, S{side}" if surfaces else ", ".join(map(str, nodes)))
    # Of parts that overlap each edge has all names.
    return "\n".join([*out, "*SURFACE, NAME=OUTSIDE", "BODY"]) + "\n"


def test_of_decks_are_those_of_the_same_meshes(run):
    """The bolted joint from decks as ABAQUS and CalculiX read them is that of Gmsh's meshes."""
    keys = {**shipped("bolted_joint"), "cycles": 1}
    meshes = run.case(keys, "--csv", run.folder / "meshes")
    for name, its in keys["bodies"].items():
        run.write(name + ".inp", deck(read(its["mesh"]), name in ("upper", "nut")))
        its["mesh"] = name + ".inp"
    decks = run.case(keys, "--csv", run.folder / "decks")
    one, other = run.columns("meshes_nodes.csv"), run.columns("decks_nodes.csv")
    for name in ("p", "q", "slip", "opening"):
        alike(one[name], other[name], 1e-10 * max(map(abs, one[name])))
    near(meshes["total_dissipation"] / decks["total_dissipation"], 1, 1e-12)


def test_of_decks_with_curved_sides_are_those_of_the_same_meshes(run):
    """Rings of straight edges from decks, which know of no curves, are those of MFEM's meshes: Lamé's pressure, with the same
    notes; and polygons if they are asked for."""
    d, E, nu, inner, outer = 1e-3, 1000, 0.3, 0.5, 2
    lame = d * E / (1 - nu * nu) / ((outer**2 + 1) / (outer**2 - 1) + (1 + inner**2) / (1 - inner**2))

    def ring(name, first, last, along):
        def place(x, y):
            r, angle = first + (last - first) * x, math.pi / 2 * y
            return r * math.cos(angle), r * math.sin(angle)

        run.write(name + ".mesh", rectangle(even(0, 1, 6), even(0, 1, along), place))
        out = ["*NODE, NSET=ALL"]
        out += ["%d, %.17g, %.17g" % (1 + i + 7 * j, *place(i / 6, j / along)) for j in range(along + 1) for i in range(7)]
        out.append("*ELEMENT, TYPE=CPE4, ELSET=BODY")
        out += ["%d, %d, %d, %d, %d" % (1 + i + 6 * j, *(1 + i + a + 7 * (j + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))))
                for j in range(along) for i in range(6)]
        for side, at in (("FLOOR", lambda i, j: j == 0), ("WALL", lambda i, j: j == along), ("INSIDE", lambda i, j: i == 0),
                         ("OUTSIDE", lambda i, j: i == 6)):
            out.append("*NSET, NSET=" + side)
            out += [str(1 + i + 7 * j) for j in range(along + 1) for i in range(7) if at(i, j)]
        run.write(name + ".inp", "\n".join(out) + "\n")

    ring("in", inner, 1 + d, 9)
    ring("out", 1, outer, 12)
    for order in (1, 2, 3):
        keys = {"order": order, "history": ["P=0", "P=1"],
                "bodies": {"in": body("in.mesh", "1:y 3:x", [], E, nu), "out": body("out.mesh", "1:y 3:x", ["P pressure 2 1e-9"], E, nu)},
                "interfaces": {"fit": face("in:2", "out:4", 0)}}
        meshes = run.case(keys, "--csv", run.folder / "meshes")
        keys["bodies"] = {"in": body("in.inp", "FLOOR:y WALL:x", [], E, nu),
                          "out": body("out.inp", "FLOOR:y WALL:x", ["P pressure OUTSIDE 1e-9"], E, nu)}
        keys["interfaces"] = {"fit": face("in:OUTSIDE", "out:INSIDE", 0)}
        decks = run.case(keys, "--csv", run.folder / "decks")
        one, other = run.columns("meshes_nodes.csv")["p"], run.columns("decks_nodes.csv")["p"]
        alike(one, other, 1e-10 * lame)
        assert decks["notes"] == meshes["notes"] and "smooth curves" in decks["notes"][0]
        assert decks.warned() == meshes.warned() == ""
        # Linear elements are wrong by their own, as edges are long.
        near_all([p / lame for p in other], 1, 0.1 if order == 1 else 0.02)
        assert min(other) > 0
        polygons = run.case({**keys, "geometry": "as meshed"})
        assert not polygons.results.get("notes") and "chords of curves" in polygons.warned()


def test_of_independent_laps_are_that_of_matching_ones(run):
    """A lap joint whose laps are meshed each on its own errs no more than twice as much as with the nodes of its coarser lap on
    both sides."""
    def lost(low, high):
        run.block("low.mesh", 0, 4, 4 * low, 0, 1, low)
        run.block("high.mesh", 1, 6, 5 * high, 1, 2, high)
        load = ["P pressure 3[1.5<x<3.5] 20", "Q traction 2 9 0"]
        return run.case({"history": ["P=0", "P=1", "Q=1", "Q=-1", "Q=1"], "cycle-start": 2, "cycles": 2,
                         "bodies": {"low": body("low.mesh", "4:xy", [], 1000, 0.3), "high": body("high.mesh", "2:y", load, 1000, 0.3)},
                         "interfaces": {"lap": face("high:1[1<x<4]", "low:3[1<x<4]", 0.5)}})["dissipation"][-1]

    fine, matching = lost(24, 24), lost(6, 6)
    assert fine > 0
    for low, high in ((6, 8), (8, 6), (6, 13)):
        assert abs(lost(low, high) - fine) <= 2 * abs(matching - fine)


def test_of_instances_of_a_deck_are_those_of_meshes(run):
    """One deck of a pre-processor with a part that is there twice, turned upside down the second time, with its materials,
    contact, supports and loads: what the case says of it is what it says of two meshes. Forces of equilibrium by hand."""
    columns, rows = 6, 3
    nodes = [(x, y) for y in even(0, 1.5, rows) for x in even(-1, 1, columns)]
    part = ["*NODE"] + ["%d, %.17g, %.17g" % (k + 1, *at) for k, at in enumerate(nodes)] + ["*ELEMENT, TYPE=CPS4, ELSET=ALL"]
    for j in range(rows):
        for i in range(columns):
            k = 1 + i + (columns + 1) * j
            part.append(f"{1 + i + columns * j}, {k}, {k + 1}, {k + columns + 2}, {k + columns + 1}")
    part += ["*NSET, NSET=FACE, GENERATE", f"1, {columns + 1}", "*NSET, NSET=BACK, GENERATE",
             f"{1 + (columns + 1) * rows}, {(columns + 1) * (rows + 1)}", "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL", "1.,"]
    deck_of_both = ["*PART, NAME=BLOCK", *part, "*END PART", "*ASSEMBLY, NAME=A", "*INSTANCE, NAME=UPPER, PART=BLOCK", "*END INSTANCE",
                    "*INSTANCE, NAME=LOWER, PART=BLOCK", "0., 0., 0.", "0., 0., 0., 0., 0., 1., 180.", "*END INSTANCE",
                    "*NSET, NSET=TOP, INSTANCE=UPPER", f"{1 + (columns + 1) * rows}, ",
                    "*SURFACE, NAME=PUSHED", "UPPER.ALL, S3", "*END ASSEMBLY", "*MATERIAL, NAME=STEEL", "*ELASTIC", "1000., 0.25",
                    "*SURFACE INTERACTION, NAME=I", "*FRICTION", "0.9", "*CONTACT PAIR, INTERACTION=I", "A, B", "*STEP", "*STATIC",
                    "*BOUNDARY", "TOP, 1, 2", "*DLOAD", "1, P1, 3.", "*END STEP"]
    run.write("both.inp", "\n".join(deck_of_both).replace("UPPER.ALL, S3\n", "UPPER.%d, S3\n" % (columns * rows)) + "\n")
    run.block("upper.mesh", -1, 1, columns, 0, 1.5, rows)
    run.block("lower.mesh", -1, 1, columns, -1.5, 0, rows)
    keys = {"analysis": "plane stress", "order": 1, "history": ["P=0", "P=1", "P=1 Q=1"]}
    meshes = run.case({**keys, "bodies": {"upper": body("upper.mesh", "", ["P pressure 3 2", "Q traction 3 0.5 0"], 1000, 0.25),
                                          "lower": body("lower.mesh", "1:xy", [], 1000, 0.25)},
                       "interfaces": {"flat": face("upper:1", "lower:3", 0.4)}}, "--csv", run.folder / "meshes")
    bodies = {"upper": {"mesh": "both.inp", "load": ["P pressure BACK 2", "Q traction back 0.5 0"]},
              "below": {"mesh": "both.inp", "part": "Lower", "support": "back:xy"}}
    decks = run.case({**keys, "bodies": bodies, "interfaces": {"flat": face("upper:FACE", "below:FACE", 0.4)}},
                     "--csv", run.folder / "decks")
    one, other = run.columns("meshes_nodes.csv"), run.columns("decks_nodes.csv")
    for name in ("p", "q", "slip"):
        alike(one[name], other[name], 1e-11 * max(map(abs, one[name])))
    flat = decks.interface("flat")
    near(flat["normal"], 2 * 2, 1e-11)
    near(abs(flat["tangential"]), 0.5 * 2, 1e-11)
    near(meshes["total_dissipation"] / decks["total_dissipation"], 1, 1e-9)
    assert "*BOUNDARY, *CONTACT PAIR, *DLOAD, *FRICTION, *STATIC, *STEP, *SURFACE INTERACTION are ignored" in decks.warned()
    strained = run.case({**keys, "analysis": "plane strain", "bodies": bodies,
                         "interfaces": {"flat": face("upper:FACE", "below:FACE", 0.4)}})
    assert "plane stress (CPS), the case computes plane strain" in strained.warned()
    # Neither body says which one it is.
    bodies["below"].pop("part")
    sentence = run.refused({**keys, "bodies": bodies, "interfaces": {"flat": face("upper:FACE", "below:FACE", 0.4)}})
    for word in ("body below (", "has 2 instances, UPPER, LOWER", "key 'part'"):
        assert word in sentence


def test_check_lists_loads_of_guides_and_of_the_whole_thickness(run):
    """A plate 10 deep: the forces on its guide as the case says them, a traction and a bolt over the depth. The bolt is at x = 1."""
    run.block("plate.mesh", 0, 1, 4, 0, 1, 4)
    guide = {"on": "3", "x": {"force": "Q", "value": 50}, "y": {"force": "P", "value": -100}, "rotation": {"moment": "M", "value": 7}}
    case = {"thickness": 10, "bodies": {"plate": {**body("plate.mesh", None, ["T traction 4 0.5 0"]), "guides": [guide]}},
            "interfaces": {"floor": {"between": ["plate:1"], "friction": 0.3}},
            "bolts": {"B": {"between": ["plate:2[0.3<y<0.8]"], "direction": [0, 1], "stiffness": 100, "preload": 200}},
            "history": ["P=0", "P=1", "B=1", "Q=1", "T=1", "M=1"]}
    rows = {row["load"]: row for row in run.case(case, "--check")["loads"]}
    for load, x, y, moment in (("Q", 50, 0, None), ("P", 0, -100, None), ("M", 0, 0, 7), ("T", 5, 0, -2.5), ("B", 0, -200, -200)):
        row = rows[load]
        near(row["x"], x, 1e-9)
        near(row["y"], y, 1e-9)
        assert row["moment"] is None if moment is None else abs(row["moment"] - moment) < 1e-9, row
        assert row["nodes"] > 0

"""The program for a user's own meshes: one or two bodies, half-planes, matrices, edges, and mistakes."""

import json
import math
import subprocess

import pytest

from programs import (ROOT, changed, curved, even, graded, graded_to_ends, half_plane, mesh_text, near, near_relative, quadratic,
                      rectangle, shipped, straight, to_ends)


def block(mesh, load="P pressure 3 1", **keys):
    """A body of E = 1, ν = 0.3 on a rigid line, which its boundary 1 touches."""
    return {"bodies": {"block": {"mesh": mesh, "young": 1, "poisson": 0.3, "load": load, **keys}},
            "interfaces": {"floor": {"between": "block:1"}}}


def pad(elements, curvature=0, grading=1):
    """A pad 4 wide and 2 high, of so many elements along a bottom y = curvature x²."""
    x = [-2 + 4 * (k / elements) ** grading for k in range(elements + 1)]
    y = [4 * k / elements for k in range(elements // 2 + 1)]
    return rectangle(x, y, lambda a, b: (a, b + (1 - b / 2) * curvature * a * a))


def test_dovetail_carries_its_load_on_the_flank(run):
    got = run("contact", "--case", "meshes/dovetail.json", "--csv", run.folder / "dovetail")
    assert got["status"] == "converged"
    # The neck is pulled by 200 on a half-width of 5 - √2.
    load = 200 * (5 - math.sqrt(2))
    near(got["contact_force"][1], -load, 1e-9 * load)
    # The flank is inclined by 45°: friction lies between its two bounds.
    ratio = got["contact_force"][0] / got["contact_force"][1]
    assert (1 - 0.3) / (1 + 0.3) * 0.98 < ratio < 1
    zones = got["zones"]
    assert zones[0]["state"] == zones[-1]["state"] == "separation"
    near(zones[-1]["to"], 5.4, 0.005)
    assert abs(got["energy_imbalance"]) < 1e-4  # increments
    assert got["largest_residual"] < 1e-12
    assert got["steady_cycle"] >= 1
    assert len(got["dissipation"]) == got["steady_cycle"]  # it ends there
    assert all(loss > 0 for loss in got["dissipation"])
    counters = got["counters"]
    assert (counters["assemblies"], counters["factorisations"], counters["field_recoveries"]) == (2, 2, 0)
    history = run.columns("dovetail_history.csv")
    assert len(history["time"]) == counters["increments"]
    near(sum(history["dissipation"]), got["total_dissipation"], 1e-12 * got["total_dissipation"])


@pytest.mark.parametrize("name", ["dovetail", "rounded_punch"])
def test_paired_bodies_may_be_named_in_either_order(run, name):
    """Of nodes that are paired one to one no body comes first: on curved lines that part, frames, gaps and areas are
    those between both."""
    case = shipped(name)
    exchanged = json.loads(json.dumps(case))
    exchanged["bodies"] = dict(reversed(case["bodies"].items()))
    for face in exchanged["interfaces"].values():
        face["between"].reverse()
    one, two = run.case(case), run.case(exchanged)
    assert one["warnings"] == []
    force = one["contact_force"][1]
    for c in (0, 1):
        near(one["contact_force"][c], -two["contact_force"][c], 1e-9 * abs(force))
    for key in ("peak_pressure", "total_dissipation"):
        near(two[key] / one[key], 1, 1e-9)
    assert len(one["dissipation"]) == len(two["dissipation"])
    for loss, other in zip(one["dissipation"], two["dissipation"]):
        near(other / loss, 1, 1e-9)


@pytest.mark.parametrize("grading", [1.05, 1.01])
def test_nodes_that_are_paired_far_off_one_another(run, grading):
    """One force at two places is a couple: where these are far apart, it is said."""
    x = [-2 + 4 * (k / 8) ** grading for k in range(9)]
    most = max(abs(x[k] - (-2 + 0.5 * k)) / 0.5 for k in range(9))  # in distances of nodes
    run.write("upper.mesh", pad(8))
    run.write("lower.mesh", rectangle(x, [-2, -1, 0]))
    got = run.case({"order": 1,
                    "bodies": {"upper": {"mesh": "upper.mesh", "young": 1, "poisson": 0.3, "load": "P pressure 3 1e-3"},
                               "lower": {"mesh": "lower.mesh", "young": 1, "poisson": 0.3, "support": "1:xy"}},
                    "interfaces": {"face": {"between": ["upper:1", "lower:3"], "pairing": 0.4}}})
    warnings = got["warnings"]
    assert len(warnings) == (1 if most > 0.1 else 0), got.output
    if warnings:
        # Of the shorter one of the two distances, which is a few per cent less.
        near(float(warnings[0].split("lie up to ")[1].split()[0]) / most, 1, 0.2)


@pytest.mark.parametrize("command", ["fretting", "march -reduced problems/hertz.json", "shakedown -reduced problems/hertz.json",
                                     "contact -case meshes/calculix/laps.json"])
def test_what_has_no_meshes_cannot_be_shown(run, command):
    got = run(*command.split(), "--check", code=1)
    assert got.error == "error: option --check: this run has no meshes to show\n"
    assert got.results is None


def test_rounded_punch_has_the_contact_width_of_the_closed_form(run):
    got = run("contact", "--case", "meshes/rounded_punch.json", "--history", "P=0; P=1", "--cycle-start", -1, "--cycles", 1,
              "--csv", run.folder / "punch")
    near(got["contact_force"][0], 0, 1e-7)
    near(got["contact_force"][1], 600, 1e-7)
    # Ciavarella, Hills & Monno (1998): P R/(a² E*) = (ε - sin ε cos ε)/(2 cos² ε), b = a/cos ε.
    right = 600 * 5 / (9 * 0.5 * 210e3 / (1 - 0.09))
    low, high = 0.0, 1.0
    while high - low > 1e-12:
        e = 0.5 * (low + high)
        left = (e - math.sin(e) * math.cos(e)) / (2 * math.cos(e) ** 2)
        low, high = (e, high) if left < right else (low, e)
    closed = [zone for zone in got["zones"] if zone["state"] != "separation"]
    half = 0.5 * (max(zone["to"] for zone in closed) - min(zone["from"] for zone in closed))
    near(half, 3 / math.cos(low), 0.0031)  # a spacing of the nodes, 0.2 / 64
    # The meshes are symmetric on the contact line, but not inside.
    nodes = run.columns("punch_nodes.csv")
    p, q = nodes["p"], nodes["q"]
    assert len(p) == 257
    skew = sum(abs(a - b) + abs(c + d) for a, b, c, d in zip(p, reversed(p), q, reversed(q)))
    assert skew < 0.02 * sum(p)


def test_rounded_punch_reaches_a_steady_cycle(run):
    got = run("contact", "--case", "meshes/rounded_punch.json", "--edges", "1 2 3", "--csv", run.folder / "of")
    # What is printed of the edges is a file as well.
    head, *rows = (run.folder / "of_edges.csv").read_text(encoding="utf-8").splitlines()
    assert head.startswith("edge,position,")
    for key in (",x,", ",k_n.value,", ",k_t.window.1,", ",slip_zone,", ",energy,"):
        assert key in head
    assert [row.split(",")[0] for row in rows] == ["first", "last"]
    assert got["steady_cycle"] > 0 and got["steady_period"] == 1
    assert got["dissipation"][-1] > 0
    assert abs(got["energy_imbalance"]) < 1e-4  # increments
    # Each number of an error is a bound or an estimate, by its own name.
    assert "loss_error_bound" in got.results and "± (estimate)" in got.output
    assert all("from_error_estimate" in zone and "to_error_estimate" in zone for zone in got["zones"])
    assert not [key for key in got.results if key.endswith("_error")]
    # Pressed alike at both edges. For two half-planes the closed form gives 3,693; the sides of the punch and of the block
    # are away by half a contact and by several.
    edges = got["edges"]
    assert len(edges) == 2
    for edge in edges:
        # To 3 %, thrice what a fit over the nodes near an edge is wrong by elsewhere; and it must know itself to a tenth, or
        # it is of no use.
        near(edge["k_n"]["value"], 3693, 0.03 * 3693)
        assert edge["k_n"]["relative_error_estimate"] < 0.1
    # Sheared alike, too: what K_T of one has more than that of the other is of the shear that pressing left, which points
    # outward at both and has none; each must know that of itself.
    k_t = [edge["k_t"]["value"] for edge in edges]
    wrong = [abs(edge["k_t"]["value"]) * edge["k_t"]["relative_error_estimate"] for edge in edges]
    assert abs(sum(k_t)) < sum(wrong)


def test_displacements_on_a_half_plane_are_relative_to_a_depth(run):
    """A block on a half-plane that has no mesh: what forces do to the contact is known, how far they move is relative."""
    run.write("whole.mesh", rectangle(to_ends(1, 20, 0.1), [0, 0.1, 0.3, 1, 2]))
    forces = {"bodies.block.load": ["P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"], "history": ["P=0", "P=1", "Q=0.2"]}
    moved = {"bodies.block.load": "D displacement-y 3 -0.1", "history": ["D=0", "D=1"]}

    def case(depth, changes):
        half_plane = {"young": 0.91, "poisson": 0.3, **({} if depth is None else {"depth": depth})}
        return changed({"bodies": {"block": {"mesh": "whole.mesh", "young": 0.91, "poisson": 0.3}, "ground": {"half-plane": half_plane}},
                        "interfaces": {"face": {"between": ["block:1", "ground"], "friction": 0.4}}}, changes)

    without = run.case(case(None, forces), "--csv", run.folder / "run")
    assert "displacement P" not in run.columns("run_history.csv")
    sunk = []
    for depth in (100, 1000):
        got = run.case(case(depth, forces), "--csv", run.folder / "run")
        sunk.append(run.columns("run_history.csv")["displacement P"][-1])
        # The contact does not know of it.
        near(got["peak_pressure"], without["peak_pressure"], 1e-9)
        for zone, other in zip(got["zones"], without["zones"]):
            near(zone["to"], other["to"], 1e-9)
    # P = 1, E' = 1: 2/π ln(D₂/D₁).
    near(sunk[1] - sunk[0], 2 / math.pi * math.log(10), 1e-9)
    # A prescribed displacement or a support needs the depth: 0.1 is more than what P = 0.1 does.
    must = "key 'bodies.ground.half-plane.depth' must give it"
    for changes in (moved, {**forces, "bodies.block.support": "3:x"}):
        assert must in run.refused(case(None, changes))
    run.case(case(1000, moved), "--paraview", run.folder / "fields")
    for name in ("block", "ground", "contact"):
        assert (run.folder / "fields" / name / (name + ".pvd")).exists()
    assert must in run.refused(case(None, forces), "--paraview", run.folder / "none")
    assert not (run.folder / "none").exists()


@pytest.mark.parametrize("curvature", [0, 0.5])
def test_a_plane_of_symmetry_goes_on_in_the_half_plane(run, curvature):
    """Half of the block, held on its plane of symmetry, presses as the whole does; also where its face is curved, so that the
    last edge before the plane of symmetry leans."""
    x, y = to_ends(1, 20, 0.1), [0, 0.1, 0.3, 1, 2]
    pressures = []
    for places, support in ((x, {}), (x[10:], {"support": "4:x"})):
        run.write("block.mesh", rectangle(places, y, lambda a, b: (a, b + 0.5 * curvature * a * a * (1 - b / 2))))
        case = block("block.mesh", "P pressure 3 0.05", **support)
        case["bodies"]["block"]["young"] = 0.91
        case["bodies"]["ground"] = {"half-plane": {"young": 2, "poisson": 0.2}}
        case["interfaces"]["floor"] = {"between": ["block:1", "ground"], "friction": 0.4}
        run.case(case, "--csv", run.folder / "run")
        pressures.append(run.columns("run_nodes.csv")["p"])
    whole, half = pressures
    assert len(whole) == 41 and len(half) == 21
    assert whole[20] > 0.02
    assert (whole[0] == 0) == (curvature > 0)
    for one, other in zip(half, whole[20:]):
        near(one, other, 1e-6)


def test_fields_are_recovered_for_frames_only(run):
    got = run("contact", "--case", "meshes/rounded_punch.json", "--cycles", 1, "--frames", "1 2", "--paraview", run.folder / "fields")
    # Two frames and the last state, two bodies.
    assert got["counters"]["field_recoveries"] == 6
    for name in ("punch", "block", "contact"):
        assert (run.folder / "fields" / name / (name + ".pvd")).read_text(encoding="utf-8").count("<DataSet") == 3


def test_a_run_cut_in_two_gives_the_same_bits(run):
    # With this friction it settles in many cycles.
    words = ["contact", "--case", "meshes/dovetail.json", "--set", "interfaces.flank.friction=0.5", "--cycles"]
    state = run.folder / "state.json"
    whole = run(*words, 4)
    run(*words, 2, "--save-state", state)
    second = run(*words, 4, "--load-state", state)
    assert len(whole["dissipation"]) == 4
    for key in ("time", "loads", "peak_pressure", "contact_force", "zones", "total_dissipation", "steady_cycle", "status"):
        assert whole[key] == second[key], key
    assert second["first_cycle"] == 3
    assert second["dissipation"] == whole["dissipation"][2:]
    other = run(*words, 4, "--history", "P=0; P=0.5; P=0.6; P=0.5", "--load-state", state, code=1)
    assert "option --load-state: the saved state has the loads P = 1 at its time 5, and the history has P = 0.5 then" in other.error


def test_gross_sliding_is_an_outcome_with_its_load(run):
    run.write("block.mesh", rectangle(to_ends(1, 20, 0.02), even(0, 2, 10)))
    case = block("block.mesh", ["P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"])
    case["interfaces"]["floor"]["friction"] = 0.3
    got = run.case({**case, "history": ["P=0", "P=1", "Q=0.4"]}, code=2)
    assert got["status"] == "gross sliding"
    near(got["event_loads"]["Q"], 0.3, 1e-4)
    assert "gross sliding" in got.output


PUNCH = {"bodies": {"pad": {"mesh": str(ROOT / "meshes/rounded_punch.msh"), "young": 1, "poisson": 0.3, "load": "P pressure 2 1"}},
         "interfaces": {"floor": {"between": ["pad:3"]}}}
LOAD, SUPPORT, FLOOR = "bodies.pad.load", "bodies.pad.support", "interfaces.floor."
GROUND = {"interfaces.floor.between": ["pad:3", "ground"]}
HALF, FULL = "bodies.ground.half-plane", {"young": 1, "poisson": 0.3}
# Changes of the case, further options, and words that the sentence must hold.
MISTAKES = [
    ({"bodies.pad.mesh": "nowhere.msh"}, [], ["body pad", "/nowhere.msh", "cannot be read"]),
    ({**GROUND, HALF: {"young": 1}}, [], ["key 'bodies.ground.half-plane' has no 'poisson'"]),
    ({**GROUND, HALF: {"depth": 1}}, [], ["half-plane' has no 'young'"]),
    ({**GROUND, HALF: {"young": 1, "poisson": 0.5}}, [], ["half-plane.poisson' is 0.5", "between -1 and 0.5"]),
    ({**GROUND, HALF: {**FULL, "depth": 1}}, [], ["the depth to which its displacements are relative is 1", "at least twice the length"]),
    ({**GROUND, HALF: {**FULL, "width": 2}}, [], ["unknown key 'width'", "young, poisson, depth"]),
    ({"bodies.pad.half-plane": FULL}, [], ["bodies.pad' has 2 of the keys mesh, matrix (or deck) and half-plane"]),
    ({FLOOR + "between": ["pad:3", "ground:1"], HALF: FULL}, [], ["between.1'", "the name of the half-plane alone"]),
    ({"bodies.pad.mesh": "solid.mesh"}, [], ["solid.mesh", "dimension 3", "must be 2"]),
    ({"bodies.pad.mesh": "text.mesh"}, [], ["text.mesh", "must begin with", "not a mesh"]),
    ({"bodies.pad.mesh": "short.mesh"}, [], ["short.mesh", "ends where the number of elements should be"]),
    ({"bodies.pad.mesh": "new.msh"}, [], ["new.msh", "mesh file has no nodes"]),
    ({FLOOR + "between": "pad:9"}, [], ["contact line", "attribute 9", "2, 3, 4"]),
    ({FLOOR + "between": "pad:"}, [], ["between'", "BODY:PART"]),
    ({FLOOR + "between": 1.5}, [], ["between' is 1.5", "must be BODY:PART, or a list of two"]),
    ({FLOOR + "between": ["pad:3", "base:3"]}, [], ["there is no body 'base'"]),
    ({FLOOR + "between": "pad:3[7<x<8]"}, [], ["no boundary elements", "7 <= x"]),
    ({FLOOR + "between": "pad:3[x<8]"}, [], ["interfaces.floor.between", "3[x<8]", "3[-1<x<1]"]),
    ({LOAD: "P pressure 7 1"}, [], ["pressure 'P'", "attribute 7", "2, 3, 4"]),
    ({SUPPORT: "8:x"}, [], ["fix", "attribute 8", "2, 3, 4"]),
    ({FLOOR + "friction": -0.25}, [], ["floor.friction' is -0.25", "not be negative"]),
    ({FLOOR + "friction": "0.3 nan"}, [], ["floor.friction'", "nan"]),
    ({FLOOR + "friction": {}}, [], ["floor.friction' is empty", "a number"]),
    ({}, ["--set", "interfaces.floor.friction=1e999"], ["floor.friction'", "1e999"]),
    ({}, ["--set", "interfaces.floor.frictions=1"], ["unknown key 'frictions'"]),
    ({}, ["--set", "interfaces.roof.friction=1"], ["option --set", "there is no key 'roof' in interfaces"]),
    ({}, ["--set", "friction=1"], ["option --set", "there is no option 'friction'", "interfaces"]),
    ({}, ["--set", "order"], ["option --set: 'order', must be KEY=VALUE"]),
    ({}, ["--increments", 2.5], ["increments", "2.5", "not an integer"]),
    ({"bodies.pad.young": "nan"}, [], ["bodies.pad.young' is \"nan\"", "a number"]),
    ({"bodies.pad.young": -1}, [], ["bodies.pad.young' is -1", "positive"]),
    ({"bodies.pad.young": [1, "2"]}, [], ["bodies.pad.young.1' is \"2\"", "a number"]),
    ({"bodies.pad.young": [1, 2], "bodies.pad.poisson": [0.1, 0.2, 0.3]}, [], ["key 'bodies.pad.young' has 2 values", "must have one"]),
    ({"bodies.pad.poisson": 0.5}, [], ["Poisson's ratio", "0.5", "below 0.5"]),
    ({"bodies.pad.poisson": [0.1, 0.2]}, [], ["key 'bodies.pad.poisson' has 2 values", "must have one"]),
    ({"bodies.pad.young": [1, 2, 3]}, [], ["key 'bodies.pad.young' has 3 values", "must have one: the elements of the mesh have one attribute"]),
    ({}, ["--order", 0], ["order", "0", "1 to 8"]),
    ({}, ["--increments", 0], ["increments", "0", "at least 1"]),
    ({FLOOR + "gap": "wide"}, [], ["floor.gap'", "wide", "geometry, closed"]),
    ({}, ["--stepping", "fast"], ["stepping", "fast", "exact, fixed"]),
    ({SUPPORT: "3:xy"}, [], ["interface 'floor': its side '3' of body pad", "is held in all components by supports of the body (3:xy)"]),
    ({SUPPORT: "2"}, [], ["bodies.pad.support' '2'", "must be"]),
    ({SUPPORT: "2:z"}, [], ["bodies.pad.support' '2:z'", "x, y or xy"]),
    ({SUPPORT: "@1:x"}, [], ["@1", "must be a point"]),
    ({SUPPORT: "@70,5:x"}, [], ["@70,5:x", "outside of the body", "extends from"]),
    ({LOAD: None}, [], ["no load"]),
    ({LOAD: {"P": 1}}, [], ["bodies.pad.load' is an object", "a string"]),
    ({LOAD: "P pressure 2"}, [], ["P pressure 2", "3 words", "PATTERN pressure WHERE p"]),
    ({LOAD: "P push 2 1"}, [], ["kind 'push'", "pressure, traction, body-force"]),
    ({LOAD: "P pressure 2 nan"}, [], ["'nan'", "a function of x and y"]),
    ({LOAD: "P pressure 2 1*z"}, [], ["'1*z'", "a function of x and y"]),
    ({}, ["--history", "P=0; Q=1"], ["history 'Q=1'", "there is no load 'Q'", "one of: P"]),
    ({}, ["--history", "P=0; P=one"], ["history", "'one'", "not a number"]),
    ({}, ["--history", "P=1; P=2"], ["history", "first point", "must be 0", "begin with 'P=0'"]),
    ({}, ["--history", "P=0"], ["history has one point", "'P=0; P=1'"]),
    ({}, ["--history", "P=0 P=1"], ["history 'P=0 P=1'", "'P' is named twice", "P=0; P=1"]),
    ({}, ["--history", "P=0; P=1,P=1"], ["history 'P=1,P=1'", "'P' is named twice"]),
    ({}, ["--increments", "99999999999"], ["--increments", "99999999999", "at most 2147483647"]),
    ({}, ["--edges", "--order", 2], ["--edges", "has no value"]),
    ({}, ["--edges"], ["--edges", "has no value"]),
    ({}, ["--save", "out/state.json"], ["--save", "--save-state", "state.json", "name another"]),
    ({}, ["--save", "case.json"], ["--save", "case.json", "--case"]),
    ({}, ["--history", "P=0; P=1; P=2", "--cycle-start", 1], ["load 'P' is 2 at the end of the cycle", "1 at its start"]),
    ({}, ["--cycle-start", -2], ["cycle-start", "-2", "at least -1"]),
    ({}, ["--cycle-start", 4], ["cycle starts at point 4", "0 to 0"]),
    ({}, ["--history", "P=0; P=1; P=0", "--cycle-start", 0, "--cycles", 0], ["cycles is 0", "at least 1"]),
    ({}, ["--cycles", 0], ["cycles", "is 0", "at least 1"]),
    ({}, ["--cycles", 3], ["--cycles is 3", "no cycle", "key 'cycle-start'"]),
    ({FLOOR + "friction": 0.3}, ["--edges", "1 0.5"], ["edges", "0.5", "after", "1"]),
    ({"edges": [0.5, 1], FLOOR + "friction": 0}, [], ["'edges' needs friction"]),
    ({}, ["--frames", 2], ["frames", "time 2", "from 0 to 1"]),
    ({}, ["--load-state", "nowhere.json"], ["nowhere.json", "cannot read"]),
    ({}, ["--wrong", 3], ["Unrecognized option", "--wrong"]),
    ({"yung": 2}, [], ["case.json", "'yung'", "bodies, interfaces"]),
    ({"points": {"tip": [0, 0, 0]}}, [], ["key 'points.tip' is a list of 3, must be two numbers"]),
    ({"order": "2"}, [], ["'order'", "\"2\"", "an integer"]),
    ({"order": 1.5}, [], ["'order'", "1.5", "an integer"]),
]
LAPS = [
    ({"bodies.lower": None, "interfaces.faces.between": "upper:UPPER_FACE", "interfaces.faces.pairing": None}, [],
     ["has 2 bodies that nothing connects, the case has 1 with this matrix", "'LOWER': ", "LOWER_FACE", "'UPPER': "]),
    ({"interfaces.faces.between.1": "lower:3"}, [], ["between.1' names the set '3'", "does not have, must be one of", "LOWER_FACE"]),
    ({"interfaces.faces.between.1": "lower:UPPER_FACE"}, [], ["names the set 'UPPER_FACE'", "is of the part 'UPPER', and that is body upper already: body lower must be another part"]),
    ({"bodies.lower.young": 3}, [], ["bodies.lower' has the keys matrix and young"]),
    ({"bodies.upper.mesh": "nowhere.msh"}, [], ["has 2 of the keys"]),
    ({"bodies.upper.order": 1}, [], ["bodies.upper.order'", "its elements are known"]),
    ({"bodies.lower.support": "WALL:z"}, [], ["body lower ('LOWER')", "support' 'WALL:z'", "SET:xy"]),
    ({"bodies.upper.load": "P traction X 1 0"}, [], ["body upper ('UPPER')", "there is no set 'X'"]),
    ({"bodies.upper.matrix": "nowhere.sti", "bodies.lower.matrix": "nowhere.sti"}, [], ["body upper: cannot read file", "nowhere.sti': there is no such file"]),
]
TEXTS = {
    '{"order": 2': ["case.json", "is not JSON"],
    "[1, 2]": ["case.json", "array", "must be an object"],
    '{"version": 2, "order": 1, "order": 2}': ["'order'", "twice", "once"],
    '{"version": 2, "interfaces": {"a": {"friction": 0.1, "friction": 0.3}}}': ["key 'friction'", "twice"],
    '{"version": 2, "bodies": {"a": {"half-plane": {"young": 1, "poisson": 0, "young": 2}}}}': ["key 'young'", "twice"],
    '{"version": 2, "interfaces": {}}': ["key 'bodies' is missing"],
    '{"version": 3, "bodies": {}}': ["'version' is 3", "must be 2"],
    '{"version": [1], "bodies": {}}': ["'version' is array", "must be 2"],
    '{"bodies": {}, "interfaces": {}}': ["key 'version' is missing, must be 2"],
    '{"mesh1": "a.msh", "contact1": "3"}': ["is of version 1", "docs/contact.md"],
    '{"version": 1, "mesh1": "a.msh", "contact1": "3"}': ["is of version 1", "must be 2", "docs/contact.md"],
}


def test_bad_input_is_one_sentence_and_leaves_no_file(run):
    run.write("solid.mesh", mesh_text(["1 5 0 1 2 3 4 5 6 7"], ["1 3 0 3 2 1", "2 3 4 5 6 7"],
                                      [f"{x} {y} {z}" for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], 3))
    run.write("text.mesh", "not a mesh\n")
    run.write("short.mesh", "MFEM mesh v1.0\n\ndimension\n2\n\nelements\n")
    run.write("new.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")
    out = run.folder / "out"
    out.mkdir()

    def refused(case, options, words):
        paths = [run.folder / word if word in ("out/state.json", "case.json") else word for word in options]
        message = run.refused(case, *paths, "--csv", out / "t", "--paraview", out / "fields", "--save-state", out / "state.json")
        for word in words:
            assert word in message, f"{case} {options} should say '{word}': {message}"
        assert not list(out.iterdir()), (case, options)

    for changes, options, words in MISTAKES:
        refused(changed(PUNCH, changes), options, words)
    for changes, options, words in LAPS:
        refused(changed(shipped("calculix/laps"), changes), options, words)
    refused(shipped("calculix/laps"), [], ["option --paraview", "a matrix"])
    assert "1 and a body that is a matrix" in run.refused(shipped("calculix/laps"), "--edges", "1 2")
    refused(changed(shipped("dovetail"), {"interfaces.flank.pairing": 1e-6}), [], ["pairing", "without a partner", "81 nodes"])
    for text, words in TEXTS.items():
        refused(text, [], words)
    for words in ([], ["--case", "nowhere.json"]):
        message = run("contact", *words, code=1).error
        assert ("cannot read" if words else "key 'bodies' is missing") in message
    # Where there is no folder for what is to be written, it is said before the work.
    for option, file in (("--save", "/nowhere/r.json"), ("--csv", "/nowhere/r"), ("--paraview", "meshes/README.md/r"), ("--save-state", "/nowhere/s")):
        assert "no folder" in run.refused(PUNCH, option, file)


def test_case_files_may_have_comments(run):
    """Of both kinds of C++; what stands between quotes is none."""
    plain = run("contact", "--case", "meshes/rounded_punch.json", "--cycles", 1)
    text = json.dumps(shipped("rounded_punch"), indent=1).replace("{", '{ // of {"these": 1}\n /* not "version": 3,\n */', 1)
    commented = run.case(text, "--cycles", 1)
    for key in ("peak_pressure", "total_dissipation", "zones"):
        assert commented[key] == plain[key]


def gmsh(nodes, elements):
    """A mesh as Gmsh writes it: nodes are "x y z", elements "type tags … nodes …"."""
    def section(name, lines):
        return "\n".join([f"${name}", str(len(lines)), *(f"{k} {line}" for k, line in enumerate(lines, 1)), f"$End{name}"])
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + section("Nodes", nodes) + "\n" + section("Elements", elements) + "\n"


# Two squares side by side over 0 < x < 2, 0 < y < 1.
NODES = ["0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "2 1 0"]
BOUNDARY = ["1 2 1 5 1 2", "1 2 1 5 2 3", "1 2 2 6 3 6", "1 2 3 7 6 5", "1 2 3 7 5 4", "1 2 4 8 4 1"]
SURFACE = ["3 2 1 9 1 2 5 4", "3 2 1 9 2 3 6 5"]
WHOLE = BOUNDARY + SURFACE
SQUARES = gmsh(NODES, WHOLE)
# The second square has its own nodes on the line between them.
UNJOINED = gmsh(NODES + ["1 0 0", "1 1 0"], ["1 2 1 5 1 2", "1 2 1 5 7 3", "1 2 2 6 3 6", "1 2 3 7 6 8", "1 2 3 7 5 4", "1 2 4 8 4 1",
                                             "3 2 1 9 1 2 5 4", "3 2 1 9 7 3 6 8"])


@pytest.mark.parametrize("name, text, words", [
    ("curve.msh", gmsh(NODES, WHOLE[:3] + ["1 2 0 7 6 5"] + WHOLE[4:]),
     ["element 4, of curve 7", "no physical group", "Physical Curve(1) = {7};", "SaveAll"]),
    ("surface.msh", gmsh(NODES, WHOLE[:7] + ["3 2 0 9 2 3 6 5"]), ["element 8, of surface 9", "no physical group", "Physical Surface(1) = {9};"]),
    ("lines.msh", gmsh(NODES, BOUNDARY), ["no triangles or quadrilaterals", "Plane Surface", "gmsh -2"]),
    ("areas.msh", gmsh(NODES, SURFACE), ["no boundary elements", "Physical Curve"]),
    ("solid.msh", gmsh(NODES, WHOLE + ["4 2 1 1 1 2 4 3"]), ["element 9, a tetrahedron", "plane", "gmsh -2", "no volume"]),
    ("eight.msh", gmsh(NODES, WHOLE + ["16 2 1 1 1 3 6 4 2 5 1 3"]), ["element 9 of order 2", "must be 1"]),
    ("format4.msh", SQUARES.replace("2.2 0 8", "4.0 0 8"), ["format 4.0", "4.1 or 2.2", "gmsh -2"]),
    ("mixed.msh", SQUARES.replace("2.2 0 8", "4.1 0 8"), ["$Nodes"]),
    ("binary.msh", SQUARES.replace("2.2 0 8", "2.2 1 8"), ["order of bytes", "ASCII"]),
    ("block.geo", "Point(1) = {0, 0, 0};\n", ["geometry", "gmsh -2 NAME.geo makes a mesh"]),
    ("groups.msh", gmsh(NODES, WHOLE + ["1 2 7 5 2 1"]),
     ["one edge twice", "element 1 of attribute 1", "element 9 of attribute 7", "one physical group"]),
    ("twice.msh", gmsh(NODES, WHOLE + ["1 2 1 5 1 2"]), ["one edge twice"]),
    ("unjoined.msh", UNJOINED, ["contact line", "two nodes coincide", "not joined", "Coherence Mesh"]),
    ("right.msh", SQUARES, []),
], ids=lambda value: value if isinstance(value, str) and "." in value and len(value) < 20 else "")
def test_mistakes_in_gmsh_name_their_remedy(run, name, text, words):
    run.write(name, text)
    if not words:
        run.case(block(name))
        return
    message = run.refused(block(name))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize("option", ["--csv", "--save", "--save-state", "--paraview"])
def test_an_output_is_never_written_over_an_input(run, option):
    run.write("body.msh", SQUARES)
    case = {"version": 2, **block("body.msh")}
    file = run.write("case.json", json.dumps(case))
    # A prefix is not the name of a file.
    run("contact", "--case", file, option, run.folder / ".." / run.folder.name / "case.json", code=0 if option == "--csv" else 1)
    assert json.loads((run.folder / "case.json").read_text(encoding="utf-8")) == case


def test_a_number_stands_for_a_list_of_one(run):
    run.write("body.msh", SQUARES)
    case = block("body.msh")
    expected = run.case(case)["contact_force"]
    for place, value in (("bodies.block.young", [1]), ("bodies.block.poisson", [0.3]), ("bodies.block.load", ["P pressure 3 1"]),
                         ("interfaces.floor.between", ["block:1"])):
        assert run.case(changed(case, {place: value}))["contact_force"] == expected


def test_lines_that_do_not_pair_are_told_what_would_do(run):
    run.write("upper.mesh", rectangle([-1, -0.5, 0, 0.5, 1], [0.2, 0.7, 1.2]))

    def case(x, pairing):
        run.write("lower.mesh", rectangle(x, [-1, -0.5, 0]))
        return {"order": 1, "bodies": {"upper": {"mesh": "upper.mesh", "young": 1, "poisson": 0.3, "load": "P pressure 3 1"},
                                       "lower": {"mesh": "lower.mesh", "young": 1, "poisson": 0.3, "support": "1:xy"}},
                "interfaces": {"face": {"between": ["upper:1", "lower:3"], "pairing": pairing}}}

    # Nodes 0.01 beside those of the other line, whose distance is 0.5, and 0.2 below them.
    beside = [-0.99, -0.49, 0.01, 0.51, 1.01]
    message = run.refused(case(beside, 1e-6))
    assert "interface 'face': pairing: " in message
    assert "the nearest nodes are 0.20025 apart" in message  # √(0.2² + 0.01²)
    tolerance = float(message.split("a tolerance of ")[1].split()[0])
    assert 0.02 <= tolerance <= 0.021  # 0.01 of 0.5, rounded up to two digits
    run.case(case(beside, tolerance))
    message = run.refused(case([-2, -1, -0.5, 0, 0.5, 1, 2], 1e-6))
    assert "no tolerance would pair all" in message
    assert "line 2 from (-2, 0) to (2, 0)" in message


def test_what_is_not_unique_is_said_of_all_that_follows(run):
    """Far above the critical friction a pad that is pressed and sheared goes on, and says of all that follows that it is one
    of several."""
    run.write("pad.mesh", pad(8))
    case = block("pad.mesh", ["P pressure 3 1", "Q traction 3 1 0"])
    got = run.case(changed(case, {"interfaces.floor.friction": 20, "history": ["P=0", "P=1", "Q=0.1"]}), code=2)
    assert got["status"] == "not unique" and got["time"] == 2
    first = got["not_unique"]
    assert first["time"] == got["event_time"] == 0  # since when they touch
    assert first["loads"] == got["event_loads"] and first["message"] == got["message"]
    assert "critical value" in got["message"]
    assert "Not unique: from time " in got.output and "At time 2, one of several states: " in got.output
    assert "Ended with" not in got.output


def test_an_unsupported_body_is_refused(run):
    # The second of two separate squares touches neither support nor contact.
    run.write("two.mesh", mesh_text(["1 3 0 1 2 3", "1 3 4 5 6 7"], ["1 1 0 1", "2 1 2 3"],
                                    ["0 0", "1 0", "1 1", "0 1", "5 0", "6 0", "6 1", "5 1"]))
    assert "unsupported body" in run.refused(block("two.mesh", "P pressure 2 1"))


def test_the_documented_case_is_the_one_shipped():
    guide = (ROOT / "docs/contact.md").read_text(encoding="utf-8")
    shown = guide.split("```json\n")[1].split("```")[0]
    assert shown == (ROOT / "meshes/rounded_punch.json").read_text(encoding="utf-8")


def test_options_override_the_case_file(run):
    got = run("contact", "--case", "meshes/dovetail.json", "--set", "interfaces.flank.friction=0", "--order", 1, "--cycles", 1)
    assert got["counters"]["tangential_unknowns"] == 0
    assert got["total_dissipation"] == 0
    assert got["contact_nodes"] == 41
    # Without friction the flank of 45° carries as much sideways as upward, but for its ends.
    near(got["contact_force"][0] / got["contact_force"][1], 1, 0.02)


def test_places_of_a_case_are_set_as_the_file_would_say_them(run):
    """--set against a file with the same values, and a sweep of a place that is set as well."""
    case = shipped("dovetail")
    words = ["--cycles", 1, "--set", "bodies.root.young=[100e3, 100e3]; bodies.disc.poisson=0.25", "--set", "history.2.P=0.5",
             "--set", "interfaces.flank.friction=0.2+0.01*s"]
    case["bodies"]["root"]["young"] = [114e3]
    # The mesh has one attribute, as it says itself.
    assert "2 values" in run.refused(case, *words)
    words[3] = "bodies.root.young.0=100e3; bodies.disc.poisson=0.25"
    set_ = run.case(case, *words)
    said = run.case(changed(case, {"bodies.root.young": 100e3, "bodies.disc.poisson": 0.25, "interfaces.flank.friction": "0.2+0.01*s",
                                   "history": ["P=0", "P=1", "P=0.5", "P=1"], "cycles": 1}))
    for key in ("peak_pressure", "total_dissipation", "contact_force", "zones"):
        assert set_[key] == said[key], key
    swept = run.case(case, *words, "--sweep", "bodies.disc.poisson=0.25 0.3")["sweep"]
    assert swept[0]["peak_pressure"] == said["peak_pressure"] != swept[1]["peak_pressure"]


def test_says_what_accuracy_materials_far_apart_leave(run):
    # A hard sole under a soft block that is pushed down at its top: in uniform compression the block's stiffness is that of
    # its layers in series, as nothing contracts sideways.
    run.write("layers.mesh", rectangle([0, 1, 2, 3], [0, 0.5, 1, 1.5, 2], attribute=lambda i, j: 1 if j < 2 else 2))
    before = 0
    for hard in (1, 1e6, 1e12):
        case = block("layers.mesh", "D displacement-y 3 -0.1", support="3:x")
        got = run.case(changed(case, {"bodies.block.young": [hard, 1], "bodies.block.poisson": 0, "interfaces.floor.friction": 0.3}))
        error = abs(got["contact_force"][1] / (3 * 0.1 / (1 + 1 / hard)) - 1)
        estimate = got["condensation_error_estimate"]
        assert error <= estimate and estimate >= before
        before = estimate
        assert ("warning: the relative error of the contact stiffness may be" in got.output) == (hard > 1e9)
        assert len(got["warnings"]) == (1 if hard > 1e9 else 0)
    assert before > 1e-6


@pytest.mark.parametrize("curvature", [0.02, 0.1])
def test_a_pad_that_only_the_contact_holds_comes_to_rest(run, curvature):
    """Nothing but the contact holds a pad that is pressed onto a line: it may rock on its lowest node, and slide without
    friction. The line bears the whole load all the same."""
    run.write("pad.mesh", pad(20, curvature))
    for pressure in (0.005, 0.02, 0.3):
        for friction in (0, 0.4):
            case = changed(block("pad.mesh"), {"bodies.block.young": 100, "interfaces.floor.friction": friction})
            got = run.case({**case, "history": ["P=0", f"P={pressure}"]})
            near(got["contact_force"][1], 4 * pressure, 1e-9 * pressure)


@pytest.mark.parametrize("grading", [1, 1.5])
def test_slip_of_a_free_body_is_counted_from_its_middle(run, grading):
    """Pressed evenly without friction a pad widens about its middle, on any mesh."""
    run.write("pad.mesh", pad(20, 0, grading))
    for order in (1, 2):
        zones = run.case({**block("pad.mesh"), "order": order})["zones"]
        assert len(zones) == 2
        near(zones[0]["to"], 2, zones[0]["to_error_estimate"])


@pytest.mark.parametrize("elements", [12, 20, 40])
def test_borders_next_to_a_corner_say_their_doubt(run, elements):
    """The front edge of a flat pad in full stick slips over 1e-4 at f = 0.33 (graded meshes of 140 and 220 elements); uniform
    meshes show more, and must say by how much."""
    run.write("pad.mesh", pad(elements))
    case = changed(block("pad.mesh", ["P pressure 3 1", "Q traction 3 1 0"]), {"interfaces.floor.friction": 0.33})
    for zone in run.case({**case, "history": ["P=0", "P=1", "Q=0.165"]})["zones"]:
        # Slip ahead of the stick; what lies at the other corner is a zone of its own.
        if zone["state"] == "stick":
            break
        assert zone["to"] - 1e-4 <= zone["to_error_estimate"]


def test_a_half_plane_must_be_below_something_that_touches_it(run):
    """Mistakes about half-planes that no schema tells."""
    run.write("pad.mesh", pad(8))
    case = changed(block("pad.mesh"), {"bodies.ground": {"half-plane": FULL}})
    assert "ground" in run.refused(case)
    two = changed(case, {"bodies.other": {"half-plane": FULL}, "interfaces.floor.between": ["block:1", "ground"]})
    assert "there are 2 half-planes" in run.refused(two)


def test_warns_of_a_side_that_bears(run):
    run.write("pad.mesh", pad(16))
    case = block("pad.mesh")
    around = run.case(changed(case, {"interfaces.floor.between": "block:1,4"}), code=None)
    # A pad that is pressed so much that its side bears turns there, and closes a large gap.
    assert len(around["warnings"]) == 3
    assert "name no boundary around a corner" in around["warnings"][0]
    assert run.case(case)["warnings"] == []


@pytest.mark.parametrize("bent", [0, 0.05])
def test_warns_of_elements_that_miss_the_curves_of_their_mesh(run, bent):
    def place(u, v):
        x = 4 * u - 2
        return x, 2 * v * (1 + bent * x * x)

    run.write("curved.msh", curved(4, 2, place))  # straight sides may be said by many nodes
    case = block("curved.msh", "P pressure 3 1e-3")
    assert run.case(case, "--order", 2)["warnings"] == []
    warnings = run.case(case, "--order", 1)["warnings"]
    assert len(warnings) == (1 if bent else 0)
    if bent:
        assert "curved.msh' is curved, but elements of order 1" in warnings[0]
        assert "use option -order 2" in warnings[0]


def test_warns_of_a_line_that_is_named_too_short(run):
    # A block on a block of the same width, pressed as a whole: of the joint only the middle is named, or all of it, up to the
    # blocks' corners.
    run.block("upper.mesh", -2, 2, 16, 0, 1, 4)
    run.block("lower.mesh", -2, 2, 16, -1, 0, 4)
    case = {"bodies": {"upper": {"mesh": "upper.mesh", "young": 1, "poisson": 0.3, "load": "P pressure 3 1e-3"},
                       "lower": {"mesh": "lower.mesh", "young": 1, "poisson": 0.3, "support": "1:xy"}},
            "interfaces": {"joint": {"between": ["upper:1", "lower:3"], "friction": 0.3, "pairing": 1e-6}}}
    part = run.case(changed(case, {"interfaces.joint.between": ["upper:1[-1<x<1]", "lower:3[-1<x<1]"]}))
    first, last = part["warnings"]
    assert "first node of piece 1 of the line 'joint' (node 0 at (-1, 0)" in first
    assert "at (1, 0)" in last
    assert "warning: " + first in part.output
    assert run.case(case)["warnings"] == []


@pytest.mark.rest
def test_edges_of_a_hertz_contact_have_the_closed_forms(run):
    """On a block that stands for a half-plane."""
    hertz_contact(run, meshed=True)


@pytest.mark.rest
def test_edges_of_a_hertz_contact_on_a_half_plane_have_the_closed_forms(run):
    """On a half-plane without a mesh, of 481 contact nodes."""
    hertz_contact(run, meshed=False)


def hertz_contact(run, meshed):
    """Edges of a cylinder of radius 100 that touches a half-plane over |x| < 1, E* = 1/2."""
    radius, friction, share, modulus = 100, 0.5, 0.3, 0.5
    P = math.pi * modulus / (4 * radius)
    peak, k_n, k_t = 2 * P / math.pi, P / math.pi * math.sqrt(8), share * friction * P / (math.pi * math.sqrt(2))
    # The sheet: the slip zone is underestimated by this factor.
    factor = 0.5 * (1 + math.sqrt(1 - share))
    # Of one edge, and the near edge's prediction of it.
    energy = 2 * (friction * P) ** 2 / (math.pi * modulus) * ((1 - share) * math.log(1 - share) + share - share**2 / 2)
    predicted = math.pi / 3 * (2 * k_t) ** 3 / (friction * k_n * modulus) / energy
    # A block that stands for a half-plane has a remote tension of the order of Q/domain, which K_T feels, unless the other body has
    # the same. Equal blocks have no coupling at all; that of unlike discretisations is of their error.
    domain, line = (1e3, graded_to_ends(1.67, 80, 1)) if meshed else (1e5, graded_to_ends(1.67, 240, 1))
    h = line[1] - line[0]
    elements, boundary, vertices = half_plane(line, graded(0, 1.67, h, 1.25, 0.3), domain, 1.25)

    def lifted(x, y):
        """Turned over, and the contact candidates on the cylinder, with curved elements: facets cost K_T one per cent. And with them,
        to less, the first layer: surfaces alone would fold its elements."""
        x, y, layer = -x, -y, 2 * 1.67 / 80
        return (x, y) if abs(x) > 1.67 + 1e-9 or y > layer else (x, y + x * x / 200 * (1 - y / layer))

    run.write("pad.msh", quadratic(elements, boundary, vertices, lifted))
    run.write("plane.mesh", straight(elements, boundary, vertices))
    p, turn, similar = P / (2 * domain), -1.5 * P / domain**2, {"young": 0.91, "poisson": 0.3}
    below = {**similar, "mesh": "plane.mesh", "support": "3:xy"} if meshed else {"half-plane": similar}
    got = run.case({
        "bodies": {"pad": {**similar, "mesh": "pad.msh",
                           "load": [f"P pressure 3 {p!r}", f"Q traction 3 {p!r} 0", f"Q pressure 3 {turn!r}*x"]},
                   "plane": below},
        "interfaces": {"contact": {"between": ["pad:1", "plane:1" if meshed else "plane"], "friction": friction,
                                   **({"pairing": 0.01} if meshed else {})}},
        "history": ["P=0", "P=1", f"Q={share * friction!r}", f"Q={-share * friction!r}", "Q=0"],
        "edges": [1, 2, 3], "cycle-start": 1, "cycles": 3 if meshed else 2,
        # Advancing contact goes from node to node, of which the half-plane's has 481.
        "stepping": "exact" if meshed else "fixed"})
    assert len(got["edges"]) == 2
    for edge in got["edges"]:
        assert edge["complete"] is False
        near_relative(edge["k_n"]["value"], k_n, 0.01)
        near_relative(abs(edge["k_t"]["value"]), k_t, 0.01)
        near_relative(edge["k_t_range"], 2 * k_t, 0.01)
        d = edge["slip_zone"]
        near(d, 1 - math.sqrt(1 - share), 0.2 * h)
        near(edge["slip_zone_predicted"] / d, factor, 0.05)
        near_relative(edge["energy"], energy, 0.03)
        near_relative(edge["energy_predicted"] / energy, predicted, 0.05)
    near_relative(got["peak_pressure"], peak, 0.01)


def test_corners_have_intensities_of_their_own(run):
    """A square block on a similar one, bonded by friction, and on a rigid line."""
    x = graded_to_ends(1, 60, 0.02)
    step = x[1] - x[0]
    run.write("block.mesh", rectangle(x, graded(0, 2, step, 1.3, 0.2)))
    run.write("plane.mesh", straight(*half_plane(x, graded(0, 1, step, 1.3, 0.2), 1e3, 1.3)))
    similar = {"young": 0.91, "poisson": 0.3}

    def on(below=None):
        """Edges of the block on another body, or on a rigid line."""
        case = {"bodies": {"block": {**similar, "mesh": "block.mesh",
                                     "load": ["P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"]}},
                "interfaces": {"contact": {"between": ["block:1"], "friction": 3}},
                "history": ["P=0", "P=1", "Q=0.1"], "edges": [1, 2]}
        if below:
            case["bodies"]["below"] = below
            case["interfaces"]["contact"]["between"].append("below:1" if "mesh" in below else "below")
            if "mesh" in below:
                case["interfaces"]["contact"]["pairing"] = 1e-6
        edges = run.case(case)["edges"]
        assert len(edges) == 2
        return edges

    body = {**similar, "mesh": "plane.mesh", "support": "3:xy"}
    for below in (body, {"half-plane": similar}):
        for edge in on(below):
            assert edge["complete"] is True
            assert "k_n" not in edge
            assert "corner" in edge["notes"][0]
            for value, exponent in zip(edge["eigenvalues"], (0.544483736782, 0.908529189846), strict=True):
                near(value, exponent, 1e-9)
            near(edge["least_friction"], 0.543075578837, 1e-9)
            assert edge["k_one"]["value"] > 0
            assert edge["k_one"]["relative_error_estimate"] < 0.02
    for edge in on():
        exponent, = edge["eigenvalues"]
        near(exponent, 0.7112, 1e-4)
        assert edge["k_one"]["relative_error_estimate"] < 0.05
    # Another material has exponents that are not known; the edge is refused all the same.
    for edge in on({**body, "young": 2}):
        assert "k_one" not in edge
        assert len(edge["notes"]) == 2
        assert "material" in edge["notes"][1]


@pytest.mark.parametrize("obstacle, domain", [("rigid", 0), ("half-plane", 0), ("half-plane", 1e4)])
def test_equals_the_square_punch(run, obstacle, domain):
    """Meshes as the study makes them: on a rigid line, a half-plane and a block."""
    x = graded_to_ends(1, 20, 0.01)
    step, coarsest = x[1] - x[0], max(0.8 * 0.5, x[11] - x[10])
    run.write("block.mesh", rectangle(x, graded(0, 2, step, 1.5, coarsest)))
    similar = {"young": 0.91, "poisson": 0.3}
    case = {"bodies": {"block": {**similar, "mesh": "block.mesh",
                                 "load": ["P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"]}},
            "interfaces": {"contact": {"between": ["block:1[-1<x<1]"], "friction": 0.3}},
            "history": ["P=0", "P=1", "Q=0.24", "Q=0", "Q=-0.24", "Q=0"], "cycle-start": 1, "cycles": 3, "increments": 40}
    face = case["interfaces"]["contact"]
    if domain:
        run.write("plane.mesh", straight(*half_plane(x, graded(0, 1, step, 1.5, coarsest), domain, 1.5)))
        case["bodies"]["plane"] = {**similar, "mesh": "plane.mesh", "support": "3:xy"}
        face["between"].append("plane:1")
        face["pairing"] = 1e-6
    elif obstacle == "half-plane":
        case["bodies"]["plane"] = {"half-plane": similar}
        face["between"].append("plane")
    mine = run.case(case)
    other = run("square_punch", "--nodes", 41, "--friction", 0.3, "--shear", "", "--cycles", 3, "--amplitude", 0.8,
                "--obstacle", obstacle, "--domain", domain)
    for key in ("dofs", "contact_nodes"):
        assert mine[key] == other[key], key
    for loss, expected in zip(mine["dissipation"], other["dissipation"], strict=True):
        near_relative(loss, expected, 1e-8)
    run.case(case, "--frames", 1, "--csv", run.folder / "punch")
    nodes = run.columns("punch_nodes.csv")
    near_relative(max(nodes["p"][:41]), other["peak_pressure"], 1e-8)
    near(nodes["slip"][40], other["slip_edge"], 1e-9)


@pytest.mark.parametrize("name", ["bolted_joint", "bolted_joint_drawing", "pin", "dovetail", "rounded_punch", "fretting_pad", "fretting_rig", "calculix/laps"])
@pytest.mark.rest
def test_a_run_fits_on_a_screen(run, name):
    """Forty lines and the warnings by default; --verbose prints more, and the results are the same."""
    short, long = (run("contact", "--case", f"meshes/{name}.json", *more) for more in ([], ["--verbose"]))
    printed = short.output.splitlines()
    sentences = len(short.results["warnings"]) + len(short.results.get("notes", []))
    assert len(printed) - sentences <= 40, short.output
    assert len(long.output.splitlines()) > len(printed)
    for results in (short.results, long.results):
        for key in ("seconds", "seconds_condensation", "shown"):
            results.pop(key)
    assert short.results == long.results


def test_a_case_starts_from_an_example(run):
    """What is printed is a case that runs in any folder; names that are none are told which there are."""
    names = ("joint", "pin", "dovetail", "pad", "punch")
    for name in names:
        done = subprocess.run([run.programs / "contact", "--example", name], cwd=run.folder, stdout=subprocess.PIPE, check=True, text=True)
        case = run.write("my.json", done.stdout)
        assert run("contact", "--case", case, "--check")["status"] == "checked"
    wrong = subprocess.run([run.programs / "contact", "--example", "ball"], cwd=run.folder, stderr=subprocess.PIPE, check=False, text=True)
    assert wrong.returncode == 1 and wrong.stderr.count("\n") == 1
    assert all(word in wrong.stderr for word in ("'ball'", *names)), wrong.stderr
    assert "--example stands alone" in run("contact", "--case", case, "--example", "pin", code=1).error

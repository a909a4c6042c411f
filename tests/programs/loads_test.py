"""Loads, bolts and reactions of contact, against closed forms and equilibrium."""

import json
import math

import pytest

from joints_test import slit_block
from programs import alike, body, changed, even, face, near, near_all, rectangle, shipped


def columns_case(run, **bolt):
    """Two columns of width 1 one on the other, ν = 0, E = 1000 and 500, with a bolt through both: 2/1000 + 3/500 per force."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    return {"bodies": {"low": body("low.mesh", "4:x 1:y"), "high": body("high.mesh", "4:x", ["F traction 3 0 1"], 500)},
            "interfaces": {"joint": face("high:1", "low:3")},
            "bolts": {"bolt": {"between": ["high:3", "low:1"], "stiffness": 300, "preload": 40, **bolt}}}


COMPLIANCE = 2 / 1000 + 3 / 500
SHARE = 300 * COMPLIANCE / (1 + 300 * COMPLIANCE)  # of a working load that the bolt takes


def test_joint_diagram_up_to_separation_and_beyond(run):
    """A preload is the force that the bolt has when it is tightened, not less. Then it takes its share of the working load, until the
    joint opens, and all of it beyond."""
    case = columns_case(run)
    opens = 40 / (1 - SHARE)
    for load in (0, 10, 0.999 * opens, 1.001 * opens, 2 * opens):
        got = run.case({**case, "history": ["bolt=0", "bolt=1", f"F={load!r}"]})
        force = 40 + SHARE * load if load < opens else load
        near(got["bolts"][0]["tightened_to"], 40, 1e-9 * 40)
        near(got["bolts"][0]["force"], force, 1e-9 * force)
        near(got.interface("joint")["normal"], max(force - load, 0), 1e-9 * force)
    # Tightened further, and to a part first: the force is that of the last turn of the nut.
    got = run.case({**case, "history": ["bolt=0", "bolt=0.5", "F=10", "bolt=0.75", "F=0", "bolt=1"]})
    near(got["bolts"][0]["force"], 40, 1e-9 * 40)
    got = run.case({**case, "history": ["bolt=0", "bolt=1", "bolt=0.25", "F=10"]})
    near(got["bolts"][0]["force"], 10 + SHARE * 10, 1e-9 * 40)


def test_naming_a_bolt_again_tightens_it_again(run):
    """Under a load that took from it, to the force of the drawing; then the load goes, and with it what the bolt would have lost."""
    case = columns_case(run)
    got = run.case({**case, "history": ["F=0", "bolt=1", "F=-20", "bolt=1"]})
    row = got["bolts"][0]
    near(row["force"], 40, 1e-9 * 40)
    near(row["least"], 40, 1e-9 * 40)
    assert row["tightened_at"] == "1, 3"
    assert "point 3 of the history (from 0) names bolt 'bolt', which has this value already: it is tightened to it again" in got.output
    near(run.case({**case, "history": ["F=0", "bolt=1", "F=-20", "bolt=1", "F=0"]})["bolts"][0]["force"], 40 + SHARE * 20, 1e-9 * 40)
    left = run.case({**case, "history": ["F=0", "bolt=1", "F=-20", "F=-20"]})
    near(left["bolts"][0]["force"], 40 - SHARE * 20, 1e-9 * 40)
    assert "again" not in left.output and left["bolts"][0]["tightened_at"] == "1"
    # While a load changes the tool keeps its force.
    near(run.case({**case, "history": ["F=0", "bolt=1", "bolt=1, F=-20", "F=0"]})["bolts"][0]["force"], 40 + SHARE * 20, 1e-9 * 40)
    # Two bolts side by side in two passes, as the workshop does it: the first ends with its preload, the second loses a little.
    case["bolts"]["other"] = {**case["bolts"]["bolt"], "stiffness": 500, "preload": 25}
    rows = {row["bolt"]: row for row in run.case({**case, "history": ["F=0", "bolt=1", "other=1", "bolt=1"]})["bolts"]}
    near(rows["bolt"]["force"], 40, 1e-9 * 40)
    # By hand: the second took 25 s c/(1 + s c) from the first, and loses its share of that with its own stiffness beside the columns.
    first, second = 300 * COMPLIANCE, 500 * COMPLIANCE
    near(rows["other"]["force"], 25 - 25 * first / (1 + first) * second / (1 + second), 1e-8)
    refused = run.refused({**case, "history": ["F=0", "bolt=1", "other=1", "F=1", "bolt=1, F=-1", "F=1"], "cycle-start": 3})
    assert "the bolt 'bolt' is named within the cycle, at point 4 (from 0)" in refused


def test_the_table_of_bolts_goes_on_after_a_cut(run):
    """To the last digit what an uninterrupted march has; of a state that keeps nothing, the table says where it begins."""
    case = {**columns_case(run), "history": ["F=0", "bolt=1", "F=-20", "F=10", "F=5"]}
    whole = run.case(case)["bolts"]
    state = run.folder / "state.json"
    for points in (2, 3, 4):
        run.case({**case, "history": case["history"][:points]}, "--save-state", state)
        assert run.case(case, "--load-state", state)["bolts"] == whole
    near(whole[0]["least"], 40 - SHARE * 20, 1e-8)
    old = json.loads(state.read_text())
    del old["kept"]
    state.write_text(json.dumps(old))
    got = run.case(case, "--load-state", state)
    row = got["bolts"][0]
    assert row["known_from"] == 3 and row["tightened_to"] is None and "begin at time 3" in got.output
    near(row["least"], 40 + SHARE * 5, 1e-8)
    near(row["most"], 40 + SHARE * 10, 1e-8)
    other = changed(case, {"bolts.second": {"between": ["high:3", "low:1"], "stiffness": 1, "preload": 1}, "history": ["F=0", "bolt=1", "second=1", "F=1"]})
    assert "option --load-state: file" in run.refused(other, "--load-state", state)


def test_displacements_that_contradict_are_refused(run):
    """A node that two loads, or a load and a support, would move differently. What agrees there is no mistake."""
    run.block("block.mesh", -3, 3, 12, -2, 0, 4)
    def case(loads, support=None, **more):
        return {"bodies": {"b": body("block.mesh", support, ["P pressure 1 1", *loads])},
                "interfaces": {"o": {"between": ["b:3"], "friction": 0.3, "obstacle": {"line": [[-5, 0], [5, 0]]}}}, "history": ["P=0", "P=1", *more.pop("then", [])], **more}
    for loads, support, said in (
            (["D displacement-x 4 0.01", "F displacement-x 1 0.02"], None, "two loads share the node at (-3, -2) along x, which is to be 0.01 per unit of load 'D' and 0.02 per unit of load 'F'"),
            (["D displacement-x 4 0.01", "F displacement-x 4[-2<y<-1] 0.01"], None, "two loads share the node"),
            (["D displacement-x 4 0.01", "F displacement-x 1 0"], None, "two loads share the node at (-3, -2) along x"),
            (["D displacement-x 4 0.01", "D displacement-x 1 0.02"], None, "its parts must agree where they meet"),
            (["F displacement-x 1 0.002"], "4:x", "support '4:x' holds the node at (-3, -2) along x, and it is moved by 0.002 per unit of load 'F'"),
            (["F displacement-x 4 0.002"], "4:x", "support '4:x' holds the node")):
        message = run.refused(case(loads, support))
        assert said in message and ("must end before it" in message or "one must end before" in message), message
    # Along another direction, of value 0 there, by one load, by two loads that move the same nodes, and with an interval between.
    for loads, support in ((["D displacement-x 4 1e-4", "F displacement-y 1 1e-4"], None), (["F displacement-x 1 1e-5*(x+3)"], "4:x"),
                           (["D displacement-x 4 1e-4", "D displacement-x 1 1e-4"], None), (["D displacement-x 4 1e-4", "D displacement-x 1[-2.9<x<3] 1e-4"], None),
                           (["D displacement-x 4 1e-4", "F displacement-x 4 1e-5"], None)):
        name = loads[-1].split()[0]
        got = run.case(case(loads, support, then=[f"{name}=1"], points={"corner": [-3, -2]}))
        if loads[-1].endswith("4 1e-5"):
            near(run.case(case(loads, support, then=["D=1", "F=1"], points={"corner": [-3, -2]}))["points"][0]["ux"], 1.1e-4, 1e-9)
        elif name == "D":
            near(got["points"][0]["ux"], 1e-4, 1e-9)


def test_what_is_said_of_bolts(run):
    """A part that is none, a bolt that pulls held nodes, one without a direction, and one that no point names."""
    case = {**columns_case(run), "history": ["bolt=0", "bolt=1"]}
    message = run.refused(changed(case, {"bolts.bolt.between": ["high:9", "low:1"]}))
    assert "key 'bolts.bolt.between.0': '9': the mesh has no boundary attribute 9; it has: 1, 2, 3, 4" in message
    unnamed = run.refused({**case, "history": ["F=0", "F=1"]})
    assert "is never tightened" in unnamed
    got = run.case(changed(case, {"bolts.ground": {"between": ["low:1"], "direction": [0, 1], "stiffness": 10, "preload": 1}, "history": ["bolt=0", "bolt=1", "ground=1"]}))
    assert "all nodes that bolt 'ground' pulls are held along it by supports" in got.warned() and "'bolt'" not in got.warned()
    # Without a direction it lies along the line between its ends: of two columns that lie on their side as of those that stand.
    run.block("left.mesh", 0, 2, 4, 0, 1, 4)
    run.block("right.mesh", 2, 5, 6, 0, 1, 4)
    lying = {"bodies": {"left": body("left.mesh", "1:y 4:x"), "right": body("right.mesh", "1:y", [], 500)}, "interfaces": {"joint": face("right:4", "left:2")},
             "bolts": {"bolt": {"between": ["right:2", "left:4"], "stiffness": 300, "preload": 40}}, "history": ["bolt=0", "bolt=1"]}
    got = run.case(lying)
    near(got.interface("joint")["normal"], 40, 1e-9 * 40)
    assert got.warned() == ""
    same = run.refused(changed(lying, {"bolts.bolt.between": ["right:4", "left:2"]}))
    assert "so that no direction follows from them" in same


def test_the_row_of_a_twist_has_its_place(run):
    """A column about the axis that a twist turns: the row's place is the middle of what it turns."""
    run.block("column.mesh", 0, 2, 4, 0, 3, 6)
    got = run.case({"analysis": "axisymmetric", "bodies": {"column": body("column.mesh", None, ["P pressure 3 10", "W twist 3 1e-4"])},
                    "interfaces": {"floor": {"between": ["column:1"], "friction": 0.3}}, "history": ["P=0", "P=1", "W=1"]})
    row = [row for row in got["reactions"] if row["name"] == "W"][0]
    near(row["about_y"], 3, 1e-12)
    assert 0 < row["about_x"] < 2


def test_a_bolt_that_would_push_ends_the_march(run):
    """Pressed together the joint takes from the bolt what it gives way: nothing is left at 40 (1 + s c)/s c."""
    falls_loose = 40 / SHARE
    case = {**columns_case(run), "history": ["bolt=0", "bolt=1", "F=-100"]}
    got = run.case(case, code=2)
    assert got["status"] == "stopped" and "the bolt 'bolt' has no tension left and would be compressed" in got["message"]
    near(got["event_loads"]["F"], -falls_loose, 1e-8 * falls_loose)
    near(got["event_time"], 1 + falls_loose / 100, 1e-8)
    near(got["loads"]["F"], -falls_loose, 1e-8 * falls_loose)
    near(got["bolts"][0]["force"], 0, 1e-8 * 40)
    assert run.case({**case, "history": ["bolt=0", "bolt=1", f"F={-0.999 * falls_loose!r}"]})["status"] == "converged"


def test_bolts_that_are_not_tightened_yet_do_nothing(run):
    """A second bolt beside the first: tightened first, it does what the first would without it."""
    case = columns_case(run)
    case["bolts"]["other"] = {"between": ["high:3", "low:1"], "stiffness": 500, "preload": 25}
    got = run.case({**case, "history": ["bolt=0", "bolt=1", "F=10", "F=0", "other=1"]})
    rows = {row["bolt"]: row for row in got["bolts"]}
    # What the second takes from the first: that shares its 25 with the columns.
    lost = 25 * SHARE
    near(rows["bolt"]["tightened_to"], 40, 1e-8)
    near(rows["bolt"]["all_tightened"], 40 - lost, 1e-8)
    near(rows["bolt"]["most"], 40 + SHARE * 10, 1e-8)
    near(rows["other"]["force"], 25, 1e-8)
    near(got.interface("joint")["normal"], 65 - lost, 1e-8)
    # In the other order, and both at once: each has what it is given.
    got = run.case({**case, "history": ["bolt=0", "other=1", "bolt=0.5"]})
    rows = {row["bolt"]: row for row in got["bolts"]}
    near(rows["other"]["force"], 25 - 20 * 500 * COMPLIANCE / (1 + 500 * COMPLIANCE), 1e-8)
    near(rows["bolt"]["force"], 20, 1e-8)
    got = run.case({**case, "history": ["bolt=0", "bolt=1 other=1"]})
    near_all([row["force"] - {"bolt": 40, "other": 25}[row["bolt"]] for row in got["bolts"]], 0, 1e-8)


def test_two_bolts_in_either_order(run):
    """A plate on an elastic bed, pressed evenly, with bolts at x = 2 and 7: what the second takes from the first follows from the
    compliances of the tractions alone, a12/(1/s + a11) of its preload, and mirrored the orders change places."""
    run.block("bed.mesh", 0, 10, 20, -2, 0, 4)
    run.block("plate.mesh", 0, 10, 26, 0, 1, 3)

    def case(first, second):
        bolts = {name: {"between": [f"plate:3[{x - 0.5}<x<{x + 0.5}]", f"bed:1[{x - 0.5}<x<{x + 0.5}]"], "stiffness": 200, "preload": 3}
                 for name, x in (("a", first), ("b", second))}
        return {"bodies": {"bed": body("bed.mesh", "@5,-2:x @0,-2:y @10,-2:y", [], 1000, 0.3),
                           "plate": body("plate.mesh", "@5,1:x", ["W pressure 3 2"], 1000, 0.3)},
                "interfaces": {"flat": face("plate:1", "bed:3", 0)}, "bolts": bolts}

    def pulls(x):
        return f"traction 3[{x - 0.5}<x<{x + 0.5}] 0 -1", f"traction 1[{x - 0.5}<x<{x + 0.5}] 0 1"

    # Their compliances by unit forces, with the bed pressed evenly and everywhere closed.
    alone = {key: value for key, value in case(2, 7).items() if key != "bolts"}
    for number, x in ((1, 2), (2, 7)):
        plate, bed = pulls(x)
        alone["bodies"]["plate"].setdefault("load", []).append(f"F{number} {plate}")
        alone["bodies"]["bed"].setdefault("load", []).append(f"F{number} {bed}")
    run.case({**alone, "history": ["W=0", "W=1", "F1=1", "F1=0 F2=1"]}, "--csv", run.folder / "alone")
    history = run.columns("alone_history.csv")
    at = {time: k for k, time in enumerate(history["time"])}
    zero = {n: history[f"displacement F{n}"][at[1]] for n in (1, 2)}
    a11 = history["displacement F1"][at[2]] - zero[1]
    a22 = history["displacement F2"][at[3]] - zero[2]
    a12 = history["displacement F1"][at[3]] - zero[1]
    near(a12, history["displacement F2"][at[2]] - zero[2], 1e-10)
    for history, first, own in ((["W=0", "W=1", "a=1", "b=1"], "a", a11), (["W=0", "W=1", "b=1", "a=1"], "b", a22)):
        got = run.case({**case(2, 7), "history": history})
        rows = {row["bolt"]: row for row in got["bolts"]}
        second = "b" if first == "a" else "a"
        near(rows[first]["tightened_to"], 3, 1e-9)
        near(rows[first]["force"], 3 - 3 * a12 / (1 / 200 + own), 1e-8)
        near(rows[second]["force"], 3, 1e-9)
        mirrored = {row["bolt"]: row for row in run.case({**case(8, 3), "history": history})["bolts"]}
        for name in ("a", "b"):
            near(mirrored[name]["force"], rows[name]["force"], 1e-8)


def test_a_march_with_bolts_is_taken_up(run):
    """Once all bolts are tightened: to round-off the same forces."""
    run.block("low.mesh", 0, 4, 16, 0, 1, 4)
    run.block("high.mesh", 1, 6, 22, 1, 2, 4)
    case = {"bodies": {"low": body("low.mesh", "4:xy", [], 1000, 0.3), "high": body("high.mesh", "@6,1.5:y", ["Q traction 2 1 0"], 1000, 0.3)},
            "interfaces": {"flat": face("high:1[0<x<5]", "low:3", 0.4)},
            "bolts": {name: {"between": [f"high:3[{x}<x<{x + 0.5}]", f"low:1[{x}<x<{x + 0.5}]"], "stiffness": 500, "preload": 8}
                      for name, x in (("a", 1.5), ("b", 3))},
            "history": ["a=0", "a=1", "Q=0.5", "b=1", "Q=1", "Q=-1", "Q=1"], "cycle-start": 4, "cycles": 2, "increments": 4}
    whole = run.case(case, "--csv", run.folder / "whole")
    last = run.columns("whole_nodes.csv")
    for points in (4, 5):
        state = run.folder / "state.json"
        run.case({**changed(case, {"cycle-start": None, "cycles": None}), "history": case["history"][:points]}, "--save-state", state)
        got = run.case(case, "--load-state", state, "--csv", run.folder / "rest")
        alike(run.columns("rest_nodes.csv")["p"], last["p"], 1e-9 * max(last["p"]))
        for one, other in zip(got["bolts"], whole["bolts"]):
            near(one["force"], other["force"], 1e-8)


def test_thickness(run):
    """Forces as they are: of a joint of thickness 5 all are five times those per thickness, pressures and displacements are the same."""
    case = {**columns_case(run), "history": ["bolt=0", "bolt=1", "F=10", "F=20", "F=10"], "cycle-start": 2, "cycles": 2}
    one = run.case(case, "--csv", run.folder / "one")
    thick = changed(case, {"thickness": 5, "bolts.bolt.stiffness": 1500, "bolts.bolt.preload": 200})
    five = run.case(thick, "--csv", run.folder / "five")
    assert five["thickness"] == 5 and "thickness 5: forces, moments and energies are those of the whole thickness" in five.output
    near(five["bolts"][0]["force"], 5 * one["bolts"][0]["force"], 1e-9)
    near(five.interface("joint")["normal"], 5 * one.interface("joint")["normal"], 1e-9)
    near(five["peak_pressure"], one["peak_pressure"], 1e-10)
    for name in ("p", "slip", "opening"):
        alike(run.columns("one_nodes.csv")[name], run.columns("five_nodes.csv")[name], 1e-10)
    # Bodies of their own thickness: compliances 2/(1000·2) + 3/(500·4), and the joint has the thinner one.
    own = changed(thick, {"bodies.low.thickness": 2, "bodies.high.thickness": 4, "bolts.bolt.stiffness": 300, "bolts.bolt.preload": 40,
                          "history": ["bolt=0", "bolt=1", "F=10"], "cycle-start": None, "cycles": None})
    got = run.case(own)
    compliance = 2 / (1000 * 2) + 3 / (500 * 4)
    load = 4 * 10  # a traction of 10 on a width of 1 and a thickness of 4
    force = 40 + 300 * compliance / (1 + 300 * compliance) * load
    near(got["bolts"][0]["force"], force, 1e-8)
    near(got["peak_pressure"], (force - load) / 2, 1e-8)
    # A force on a rigid block is a force.
    pushed = changed(own, {"bodies.high.load": None, "bodies.high.guides": [{"on": "3", "y": {"force": "F", "value": 4}, "rotation": "held"}],
                           "bodies.high.support": None, "bolts": None, "history": ["F=0", "F=-1"]})
    got = run.case(pushed)
    near(got.interface("joint")["normal"], 4, 1e-10)
    for wrong, said in (({"edges": [1, 2]}, "key 'edges' is per thickness"), ({"analysis": "axisymmetric"}, "about an axis"), ({"thickness": None}, "key 'thickness' must be there"), ({"thickness": -1}, "thickness")):
        assert said in run.refused(changed(own, wrong))


def test_a_bolt_to_the_ground(run):
    """A column that a bolt pulls onto a rigid floor: it is one column less."""
    run.block("column.mesh", 0, 1, 4, 0, 2, 4)
    case = {"bodies": {"column": body("column.mesh", "4:x", ["F traction 3 0 1"])}, "interfaces": {"floor": {"between": ["column:1"]}},
            "bolts": {"anchor": {"between": ["column:3"], "direction": [0, 1], "stiffness": 300, "preload": 40}}}
    share = 300 * 0.002 / (1 + 300 * 0.002)
    opens = 40 / (1 - share)
    for load in (0, 10, 0.999 * opens, 1.5 * opens):
        got = run.case({**case, "history": ["anchor=0", "anchor=1", f"F={load!r}"]})
        force = 40 + share * load if load < opens else load
        near(got["bolts"][0]["force"], force, 1e-9 * force)
        near(got.interface("floor")["normal"], max(force - load, 0), 1e-9 * force)
    assert "must have a direction, which points from the ground" in run.refused(changed(case, {"bolts.anchor.direction": None}))


def test_bolts_that_are_wrong_are_told(run):
    """One sentence each."""
    case = {**columns_case(run), "history": ["bolt=0", "bolt=1"]}
    for changes, said in (({"history": ["F=0", "F=1"]}, "the bolt 'bolt' is never tightened"),
                          ({"history": ["bolt=0", "bolt=-1"]}, "is tightened to -1, must not be negative"),
                          ({"history": ["bolt=0", "bolt=1", "bolt=0"]}, "is loosened at the last point"),
                          ({"history": ["bolt=1", "bolt=1"]}, "is 1 at the first point, must be 0"),
                          ({"history": ["bolt=0", "bolt=1", "bolt=2", "bolt=1"], "cycle-start": 1}, "changes its preload within the cycle"),
                          ({"bolts.bolt.pretension": 3}, "has both of the keys preload and pretension"),
                          ({"bolts.bolt.preload": None}, "has none of the keys preload and pretension")):
        assert said in run.refused(changed(case, changes)), said


def stick_of(got):
    """Middle and half-width of the stick zone, and of the contact."""
    zones = [zone for zone in got["zones"] if zone["state"] != "separation"]
    stick = [zone for zone in zones if zone["state"] == "stick"]
    assert len(stick) == 1
    middle, half = (zones[0]["from"] + zones[-1]["to"]) / 2, (zones[-1]["to"] - zones[0]["from"]) / 2
    return ((stick[0]["from"] + stick[0]["to"]) / 2 - middle) / half, (stick[0]["to"] - stick[0]["from"]) / 2 / half


def test_a_rig_with_bulk_stress_in_step_and_in_opposition(run):
    """Nowell and Hills: the stick zone moves by e = a σ/(4 f p0), whatever the pad's size does to the rest."""
    case = shipped("fretting_rig")
    case["history"], case["cycles"], case["cycle-start"] = ["P=0", "P=1", "Q=1"], 1, -1
    shifts = {}
    for stress in (100, -100, 0):
        got = run.case(changed(case, {"bodies.specimen.load": f"Q bulk-stress {stress}"}))
        shifts[stress], half = stick_of(got)
        near(half, math.sqrt(1 - 0.6), 0.01)
    near((shifts[100] - shifts[-100]) / 2, 100 / (4 * 0.5 * 383.3), 0.003)
    near(shifts[0], 0, 0.01)  # the ± of borders, 0.0026 mm of 0.33, and what is left of the pad's size
    # As a load of its own, beside the pad's: the same.
    own = changed(case, {"bodies.specimen.load": "S bulk-stress 1", "history": ["P=0", "P=1", "Q=1 S=100"]})
    near(stick_of(run.case(own))[0], shifts[100], 1e-9)
    for load, said in (("Q pressure 3", "must be PATTERN bulk-stress VALUE"), ("Q bulk-stress x", "'x' is not a number")):
        assert said in run.refused(changed(case, {"bodies.specimen.load": load}))


@pytest.mark.parametrize("depth", [None, 100])
def test_bulk_stress_alone_is_felt_by_friction_alone(run, depth):
    """Without friction a bulk stress changes no pressure of equal bodies; a pad tied to the half-plane holds it back."""
    run.block("pad.mesh", -1, 1, 16, 0, 1, 6)
    case = {"bodies": {"pad": body("pad.mesh", "", ["P pressure 3 1"], 1000, 0.3),
                       "ground": {"half-plane": {"young": 1000, "poisson": 0.3}, "load": ["S bulk-stress 2", "S bulk-stress 1"]}},
            "interfaces": {"flat": face("pad:1", "ground", 0)}, "history": ["P=0", "P=1", "S=1"]}
    if depth:
        case["bodies"]["ground"]["half-plane"]["depth"] = depth
    case["bodies"]["pad"]["support"] = "@0,1:x" if depth else ""
    run.case(case, "--csv", run.folder / "out", "--frames", "1 2")
    table = run.columns("out_nodes.csv")
    half = len(table["p"]) // 2
    alike(table["p"][:half], table["p"][half:], 1e-9)
    # Their slip is the strain of the surface, 3 (1 - ν²)/E.
    slip = [b - a for a, b in zip(table["slip"][:half], table["slip"][half:])]
    rates = {round((slip[k] - slip[0]) / (table["x"][k] - table["x"][0]), 12) for k in range(1, half)}
    for rate in rates:
        near(abs(rate), 3 * (1 - 0.09) / 1000, 1e-9)


def indenter(run, **guide):
    """A rigid cylinder of radius 10 on a block, ν = 0.3; its side is graded to the middle."""
    run.write("block.mesh", rectangle([x * abs(x) / 6 for x in even(-6, 6, 48)], [-6 + y - y * y / 24 for y in even(0, 12, 16)]))
    return {"bodies": {"block": body("block.mesh", "1:xy", [], 1000, 0.3)},
            "interfaces": {"face": {"between": ["block:3"], "friction": 0.3, "obstacle": {"circle": {"centre": [0, 10], "radius": 10}},
                                    "guide": {"centre": [0, 10], **guide}}}}


def test_an_indenter_under_a_force(run):
    """Pressed by a force and by the displacement that it made: the same contact, and each is the other's conjugate. Then it is rolled
    by a moment, and pushed while it is free to turn: nothing is left of the moment about its centre."""
    pressed = run.case({**indenter(run, x="held", y={"force": "P", "value": -20}), "history": ["P=0", "P=1"]}, "--csv", run.folder / "force")
    near(pressed.interface("face")["normal"], 20, 1e-9)
    deep = run.columns("force_history.csv")["displacement P"][-1]
    moved = run.case({**indenter(run, x="held", y={"displacement": "D", "value": -1}), "history": ["D=0", f"D={deep!r}"]}, "--csv", run.folder / "moved")
    alike(run.columns("force_nodes.csv")["p"], run.columns("moved_nodes.csv")["p"], 1e-8 * max(run.columns("force_nodes.csv")["p"]))
    near(run.columns("moved_history.csv")["reaction D"][-1], 20, 1e-8)
    assert pressed["interfaces"][0]["force_y"] < 0
    # Hertz, without friction, on a half-plane, of which the block is the middle: a² = 4 P R/(π E'), p0 = 2 P/(π a), and a is a twelfth
    # of the block's depth.
    smooth = run.case(changed({**indenter(run, x="held", y={"force": "P", "value": -20}), "history": ["P=0", "P=1"]}, {"interfaces.face.friction": 0}))
    half = math.sqrt(4 * 20 * 10 / (math.pi * 1000 / 0.91))
    near(smooth["peak_pressure"] / (2 * 20 / (math.pi * half)), 1, 0.005)
    # A moment that rolls it, at a constant force; without friction it would spin.
    rolled = {**indenter(run, x="held", y={"force": "P", "value": -20}, rotation={"moment": "M", "value": 10}), "history": ["P=0", "P=1", "M=1"]}
    got = run.case(rolled, "--csv", run.folder / "rolled")
    # The contact's forces on the block have the moment -10 about the centre on the obstacle, and no net force across.
    face_ = got.interface("face")
    about = face_["moment"] + (face_["about_x"] - 0) * face_["force_y"] - (face_["about_y"] - 10) * face_["force_x"]
    near(about, 10, 1e-8)
    assert run.columns("rolled_history.csv")["displacement M"][-1] > 0
    # Free to move across and to turn, pushed: rolling needs no force to begin with, and nothing balances it.
    free = {**indenter(run, y={"force": "P", "value": -20}, x={"force": "Q", "value": 1}, rotation="free"), "history": ["P=0", "P=1", "Q=1"]}
    got = run.case(free, code=None)
    if got["status"] == "converged":
        face_ = got.interface("face")
        near(face_["moment"] + face_["about_x"] * face_["force_y"] - (face_["about_y"] - 10) * face_["force_x"], 0, 1e-8)
        near(face_["force_x"], 1, 1e-9)
    for changes, said in (({"interfaces.face.guide.centre": None, "interfaces.face.guide.rotation": "free"}, "must have the key centre"),
                          ({"interfaces.face.motion": {"D": {"y": 1}}}, "has a guide and a motion"),
                          ({"interfaces.face.guide.y": {"force": "P", "displacement": "D"}}, "must have one of the keys force and displacement")):
        assert said in run.refused(changed(rolled, changes))


def test_named_points(run):
    """A column under its load, ν = 0.25: stresses and displacements anywhere, of each body that has the point; below a half-plane."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    case = {"analysis": "plane stress", "history": ["P=0", "P=1"], "increments": 2, "stepping": "fixed",
            "bodies": {"low": body("low.mesh", "4:x 1:y", [], 1000, 0.25), "high": body("high.mesh", "4:x", ["P pressure 3 2"], 500, 0.25)},
            "interfaces": {"joint": face("high:1", "low:3", 0)},
            "points": {"top": [1, 5], "joint": [0.3, 2], "middle": {"body": "low", "at": [0.5, 1]}}}
    got = run.case(case, "--csv", run.folder / "out")
    rows = {(row["point"], row["body"]): row for row in got["points"]}
    assert set(rows) == {("top", "high"), ("joint", "low"), ("joint", "high"), ("middle", "low")}
    for row in rows.values():
        near(row["yy"], -2, 1e-10)
        near(row["xx"], 0, 1e-10)
        near(row["von_mises"], 2, 1e-10)
    near(rows["middle", "low"]["uy"], -2 * 1 / 1000, 1e-12)
    near(rows["middle", "low"]["ux"], 0.25 * 2 / 1000 * 0.5, 1e-12)
    near(rows["top", "high"]["uy"], -2 * (2 / 1000 + 3 / 500), 1e-12)
    table = run.columns("out_point_history.csv")
    assert len(table["time"]) == 4 * len(set(table["time"]))
    assert "key 'points.far': (3, 3) is in no body" in run.refused(changed(case, {"points.far": [3, 3]}))
    assert "there is no body 'x'" in run.refused(changed(case, {"points.far": {"body": "x", "at": [0, 0]}}))
    ground = run.case({"bodies": {"pad": body("high.mesh", "@0.5,5:x", ["P pressure 3 1"], 1000, 0.3),
                                  "ground": {"half-plane": {"young": 1000, "poisson": 0.3, "depth": 50}, "load": "S bulk-stress 3"}},
                       "interfaces": {"flat": face("pad:1", "ground", 0)}, "history": ["P=0", "P=1", "P=0 S=1"],
                       "points": {"below": [0.5, 1], "deep": {"body": "ground", "at": [0.2, -3]}}})
    for row in ground["points"]:
        near(row["xx"], 3, 1e-9)
        near(row["yy"], 0, 1e-9)
        near(row["zz"], 0.9, 1e-9)


def test_ties_alone(run):
    """Two columns that are tied, ν = 0: stresses, displacements, reactions and what the tie transfers by hand, over a history with a
    cycle, with fields and a table."""
    run.block("low.mesh", 0, 1, 4, 0, 2, 4)
    run.block("high.mesh", 0, 1, 6, 2, 5, 4)
    case = {"bodies": {"low": body("low.mesh", "4:x 1:y"), "high": body("high.mesh", "4:x", ["F traction 3 0 1"], 500)},
            "interfaces": {"joint": {"between": ["high:1", "low:3"], "tied": True}}, "points": {"top": [1, 5]},
            "history": ["F=0", "F=4", "F=-2", "F=4"], "cycle-start": 1, "cycles": 3, "increments": 2}
    got = run.case(case, "--csv", run.folder / "out", "--paraview", run.folder / "fields", "--html", run.folder / "page.html")
    assert got["status"] == "converged" and got["loads"]["F"] == 4
    near(got["points"][0]["uy"], 4 * (2 / 1000 + 3 / 500), 1e-12)
    near(got.interface("joint")["normal"], -4, 1e-10)
    held = {row["name"]: row for row in got["reactions"] if row["body"] == "low"}
    near(held["1:y"]["force_y"], -4, 1e-10)
    near(run.columns("out_history.csv")["displacement F"][-1], 4 * (2 / 1000 + 3 / 500), 1e-12)
    for row in got["balance"]:
        assert row["imbalance"] < 1e-10


def test_reactions_by_name(run):
    """A beam on two supports under a load off its middle, and a guide: by levers."""
    run.block("beam.mesh", 0, 10, 40, 0, 1, 4)
    run.block("foot.mesh", 0, 10, 40, -1, 0, 4)
    got = run.case({"bodies": {"beam": body("beam.mesh", "", ["P pressure 3[2<x<3] 8"], 1000, 0.3), "foot": body("foot.mesh", "@0,-1:xy @10,-1:y", [], 1000, 0.3)},
                    "interfaces": {"joint": {"between": ["beam:1", "foot:3"], "tied": True}}, "history": ["P=0", "P=1"]})
    held = {row["name"]: row for row in got["reactions"]}
    near(held["@0,-1:xy"]["force_y"], 8 * 7.5 / 10, 1e-9)
    near(held["@10,-1:y"]["force_y"], 8 * 2.5 / 10, 1e-9)
    near(held["@0,-1:xy"]["force_x"], 0, 1e-9)
    assert held["@10,-1:y"]["about_x"] == 10
    # A cantilever in a guide that is held: force and moment about its middle.
    got = run.case({"bodies": {"beam": {**body("beam.mesh", "", ["P pressure 3[8<x<9] 2"], 1000, 0.3), "guides": [{"on": "4", "x": "held", "y": "held", "rotation": "held"}]},
                               "foot": body("foot.mesh", "1:xy", [], 1000, 0.3)},
                    "interfaces": {"joint": {**face("beam:1", "foot:3"), "gap": 10}}, "history": ["P=0", "P=1"]})
    row = next(row for row in got["reactions"] if row["kind"] == "guide")
    near(row["force_y"], 2, 1e-9)
    near(row["moment"], 2 * 8.5, 1e-8)
    near(row["about_y"], 0.5, 1e-12)


SHIPPED = ["bolted_joint", "bolted_joint_drawing", "dovetail", "fretting_pad", "fretting_rig", "pin", "punch_on_half_plane", "rounded_punch", "SSNP154"]


@pytest.mark.parametrize("name", SHIPPED)
def test_every_body_of_shipped_cases_balances(run, name):
    """Supports, guides, loads and contact on each body add up to nothing."""
    case = shipped(name)
    got = run.case({**case, **({"cycles": 1} if "cycles" in case else {})})
    assert got["balance"]
    for row in got["balance"]:
        assert row["imbalance"] < 1e-9, got["balance"]


def test_a_matrix_balances_where_its_supports_are_known(run):
    """The upper lap has all of its rows; supports may have been left out of the lower one's, which bear what is left over."""
    got = run("contact", "--case", "meshes/calculix/laps.json")
    balance = {row["body"]: row["imbalance"] for row in got["balance"]}
    assert balance["upper"] < 1e-9 and balance["lower"] is None
    lower = [row for row in got["reactions"] if row["body"] == "lower"]
    assert "left out of the matrix" in [row["name"] for row in lower]
    # Pressed by 90 from below as from above, and pulled by the friction alone.
    near(sum(row["force_x"] for row in lower), got["contact_force"][0], 1e-9)
    near(sum(row["force_y"] for row in lower), 0, 1e-9)


def test_zones_have_places(run):
    """The ends of zones lie on the side, as far along it as their arc length says."""
    case = shipped("fretting_pad")
    got = run.case({**case, "history": ["P=0", "P=1"], "cycles": 1, "cycle-start": -1})
    for zone in got["zones"]:
        for end in ("from", "to"):
            x, y = zone[end + "_x"], zone[end + "_y"]
            near(abs(x), abs(zone[end] - 0.6), 1e-4)
            near(y, 50 - math.sqrt(50 * 50 - x * x), 1e-5)


def press_fit(run):
    """A sleeve of radii 0.5 and 1 in a hub of 1 and 2, both 2 long, an interference of 1e-3, E = 1000, ν = 0, f = 0.2; the hub's bottom
    is held. With Lamé's pressure."""
    run.block("sleeve.mesh", 0.5, 1, 4, 0, 2, 16)
    run.block("hub.mesh", 1, 2, 6, 0, 2, 16)
    lame = 1e-3 * 1000 / ((4 + 1) / (4 - 1) + (1 + 0.25) / (1 - 0.25))
    return {"analysis": "axisymmetric", "bodies": {"sleeve": body("sleeve.mesh"), "hub": body("hub.mesh", "1:z")},
            "interfaces": {"fit": {**face("sleeve:2", "hub:4", 0.2), "gap": -1e-3}}}, lame


def test_a_press_fit_is_pushed_out(run):
    """Lamé's pressure, and all of the fit slides under f p 2π R L: what the shear does to the pressure at the ends is 1 % of it."""
    case, lame = press_fit(run)
    case["bodies"]["sleeve"]["load"] = f"Z traction 3 0 {-1 / (math.pi * 0.75)!r}"
    fitted = run.case({**case, "history": ["Z=0", "Z=1e-6"]})
    near(fitted["peak_pressure"], lame, 1e-5 * lame)
    near(fitted.interface("fit")["normal"], 2 * math.pi * 2 * lame, 1e-5 * 2 * math.pi * 2 * lame)
    most = 0.2 * 2 * math.pi * 2 * lame
    slid = run.case({**case, "history": ["Z=0", f"Z={1.5 * most!r}"]}, code=2)
    assert slid["status"] == "gross sliding"
    near(slid["event_loads"]["Z"], most, 0.01 * most)
    near(slid.interface("fit")["force_y"], slid["loads"]["Z"], 1e-9)
    held = next(row for row in slid["reactions"] if row["body"] == "hub")
    near(held["force_y"], slid["loads"]["Z"], 1e-9)


def test_a_press_fit_is_turned(run):
    """The turn changes no pressure: all of the fit slides under f p 2π R² L."""
    case, lame = press_fit(run)
    case["bodies"]["hub"]["support"] = "1:zt"
    case["bodies"]["sleeve"]["support"] = "1:z"
    case["bodies"]["sleeve"]["load"] = f"T traction-t 3 {1 / (math.pi / 2 * (1 - 0.5**4))!r}*r"
    most = 0.2 * 2 * math.pi * 2 * lame
    holds = run.case({**case, "history": ["T=0", f"T={0.99 * most!r}"]})
    near(holds.interface("fit")["torque"], -0.99 * most, 1e-8)
    near(holds["peak_pressure"], lame, 1e-5 * lame)
    assert run.case({**case, "history": ["T=0", f"T={1.01 * most!r}"]}, code=2)["status"] == "gross sliding"


def test_a_crack_under_compression(run):
    """Its lips bear the pressure p, and slip as those without friction under the shear less f p."""
    run.write("slit.mesh", slit_block())

    def slips(friction, shear):
        load = ["P pressure 1,3 1.3", *(f"Q traction {part}" for part in ("3 1 0", "1 -1 0", "2 0 1", "4 0 -1"))]
        got = run.case({"history": ["P=0", "P=1", f"Q={shear!r}"], "bodies": {"block": body("slit.mesh", "@0,0:xy @4,0:y", load, 1000, 0.3)},
                        "interfaces": {"slit": face("block:6", "block:5", friction)}}, "--csv", run.folder / "slit")
        assert got["status"] == "converged"
        near_all(run.columns("slit_nodes.csv")["p"], 1.3, 1e-9)
        return run.columns("slit_nodes.csv")["slip"]

    rough, smooth = slips(0.3, 0.5), slips(0, 0.5 - 0.3 * 1.3)
    assert max(map(abs, smooth)) > 1e-4
    alike(rough, smooth, 1e-9 * max(map(abs, smooth)))
    near_all(slips(0.3, 0.38), 0, 1e-12)


def test_zones_of_a_disc_begin_at_the_axis(run):
    """The node on the axis is none of the contact, and its zone begins there all the same: stick over all of the radius."""
    run.block("disc.mesh", 0, 2, 5, 0, 1, 2)
    for order in (1, 2):
        got = run.case({"analysis": "axisymmetric", "order": order, "bodies": {"disc": body("disc.mesh", "4:r", ["P pressure 3 1"])},
                        "interfaces": {"floor": {"between": ["disc:1"], "friction": 0.3}}, "history": ["P=0", "P=1"]})
        (zone,) = got["zones"]
        near(abs(zone["to"] - zone["from"]), 2, 1e-12)
        near(min(abs(zone["from_x"]), abs(zone["to_x"])), 0, 1e-12)
        near(got.interface("floor")["stick"], 2, 1e-12)
    # A cylinder that is half of one: its plane of symmetry is no axis.
    run.block("shaft.mesh", 1, 2, 4, 0, 1, 4)
    run.block("hub.mesh", 2, 3, 4, 0, 1, 6)
    got = run.case({"analysis": "axisymmetric", "bodies": {"shaft": body("shaft.mesh", "1:z"), "hub": body("hub.mesh", "1:z", ["P pressure 2 1"])},
                    "interfaces": {"fit": face("shaft:2", "hub:4")}, "history": ["P=0", "P=1"]})
    near(sum(zone["to"] - zone["from"] for zone in got["zones"]), 1, 1e-9)


def pushed_pad(run, base, pad_moves):
    """A pad that is pressed on a base and moved along it by both of its side faces, with the corners of the contact; or the base's
    bottom is moved the other way, and the pad's faces are held."""
    run.block("pad.mesh", 0, 2, 7, 0, 1, 4)
    run.block("base.mesh", -1, 3, base, -2, 0, 8)
    pad = body("pad.mesh", None if pad_moves else "2:x 4:x", ["P pressure 3 50", *(["D displacement-x 2,4 0.1"] if pad_moves else [])], 1000, 0.3)
    lower = body("base.mesh", "1:xy" if pad_moves else "1:y", [] if pad_moves else ["D displacement-x 1 -0.1"], 800, 0.2)
    return {"bodies": {"pad": pad, "base": lower}, "interfaces": {"flat": face("pad:1", "base:3", 0.3)}, "history": ["P=0", "P=1", "D=1", "D=-0.5"]}


@pytest.mark.parametrize("base", [6, 20])
def test_a_face_is_moved_with_a_corner_of_the_contact(run, base):
    """It does not matter which of two bodies is moved: tractions, slip, losses and the reaction are the same. Nothing is left out, since
    nodes of the base face the corners."""
    tables = []
    for moves in (True, False):
        got = run.case(pushed_pad(run, base, moves), "--csv", run.folder / "out")
        assert "law of friction is left out" not in got.warned()
        for row in got["balance"]:
            assert row["imbalance"] < 1e-9
        tables.append((run.columns("out_nodes.csv"), run.columns("out_history.csv")))
    (nodes, history), (other_nodes, other_history) = tables
    for one, other, names in ((nodes, other_nodes, ("p", "q", "slip", "opening")),
                              (history, other_history, ("reaction D", "displacement P", "total_dissipation", "external_work"))):
        for name in names:
            alike(one[name], other[name], 1e-8 * max(map(abs, one[name])))
    assert max(history["total_dissipation"]) > 0.1


def test_a_bar_is_pulled_over_a_rigid_floor(run):
    """Held at one end and moved at the other, with both corners of the contact: a bar under a pressure, its strain and reaction by hand.
    With friction the corner that is moved has none, which is said."""
    run.block("bar.mesh", 0, 4, 8, 0, 1, 3)
    case = {"analysis": "plane stress", "bodies": {"bar": body("bar.mesh", "4:x", ["P pressure 3 5", "D displacement-x 2 0.01"])},
            "interfaces": {"floor": {"between": ["bar:1"]}}, "history": ["P=0", "P=1", "D=1"]}
    got = run.case(case, "--csv", run.folder / "out")
    near(run.columns("out_history.csv")["reaction D"][-1], 1000 * 0.01 / 4, 1e-10)
    nodes = run.columns("out_nodes.csv")
    near_all(nodes["p"], 5, 1e-10)
    for x, slip in zip(nodes["x"], nodes["slip"]):
        near(slip, 0.01 * x / 4 if x < 4 else 0, 1e-12)
    assert "load 'D' moves node" in got.warned() and "law of friction is left out at that node" in got.warned()
    moved = next(row for row in got["reactions"] if row["name"] == "D")
    near(moved["force_x"], 1000 * 0.01 / 4, 1e-9)
    # It is no plane of symmetry: contact ends there.
    rough = run.case(changed(case, {"interfaces.floor.friction": 0.1, "history": ["P=0", "P=1", "D=1", "D=2"]}))
    for row in rough["balance"]:
        assert row["imbalance"] < 1e-9
    assert "law of friction is left out" in rough.warned()


def test_a_press_fit_is_pushed_out_by_a_displacement(run):
    """The sleeve's end is moved, with the corner of the fit: once all slides the reaction is f p 2π R L, to the 1 % that the shear
    changes the pressure at the ends by."""
    case, lame = press_fit(run)
    case["bodies"]["sleeve"]["load"] = "Z displacement-z 3 1"
    case["history"] = ["Z=0", "Z=0.02"]
    case["increments"] = 4
    got = run.case(case, "--csv", run.folder / "out")
    most = 0.2 * 2 * math.pi * 2 * lame
    near(run.columns("out_history.csv")["reaction Z"][-1], most, 0.01 * most)
    assert got.interface("fit")["stick"] == 0 and "law of friction is left out" not in got.warned()
    near(next(row for row in got["reactions"] if row["body"] == "hub")["force_y"], -most, 0.01 * most)


def test_a_load_moves_one_body_and_pushes_another(run):
    """As two loads that the history has at once. Its displacements are a load of their own in the results."""
    run.block("pad.mesh", 0, 2, 6, 0, 1, 3)
    run.block("base.mesh", -1, 3, 12, -1, 0, 3)
    case = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 20", "Q traction 2 1 0"], 1000, 0.3), "base": body("base.mesh", "1:y", ["Q displacement-x 1 0.01"], 1000, 0.3)},
            "interfaces": {"flat": face("pad:1", "base:3", 0.6)}, "history": ["P=0", "P=1", "Q=1", "Q=-1"]}
    one = run.case(case, "--csv", run.folder / "one")
    two = run.case(changed(case, {"bodies.base.load": ["D displacement-x 1 0.01"], "history": ["P=0", "P=1", "Q=1 D=1", "Q=-1 D=-1"]}), "--csv", run.folder / "two")
    first, second = run.columns("one_history.csv"), run.columns("two_history.csv")
    for name, other in (("displacement Q", "displacement Q"), ("reaction Q.moved", "reaction D"), ("load Q.moved", "load D"), ("total_dissipation", "total_dissipation")):
        assert first[name] == second[other], name
    assert one["loads"] == {"P": 1, "Q": -1, "Q.moved": -1} and two["loads"]["D"] == -1
    assert "history names 'Q.moved', which goes with 'Q'" in run.refused(changed(case, {"history": ["P=0", "P=1", "Q=1 Q.moved=1"]}))
    # An obstacle that is moved by the load that pushes the pad.
    floor = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 20", "Q traction 2 1 0"], 1000, 0.3)},
             "interfaces": {"flat": {"between": ["pad:1"], "friction": 0.6, "motion": {"Q": {"x": 0.01}}}}, "history": ["P=0", "P=1", "Q=1"]}
    got = run.case(floor)
    near(got["loads"]["Q.moved"], 1, 0)


def test_zones_on_a_circle_have_angles(run):
    """The pin's side is a circle of radius 5 about its middle: the ends of zones lie at their angles on it, one after the other."""
    got = run.case({**shipped("pin"), "cycles": 1})
    zones = got["zones"]
    assert len(zones) > 2
    before = None
    for zone in zones:
        for end in ("from", "to"):
            angle = math.degrees(math.atan2(zone[end + "_y"], zone[end + "_x"]))
            near(math.remainder(zone[end + "_angle"] - angle, 360), 0, 1e-6)
        if before is not None:
            near(math.remainder(zone["from_angle"] - before, 360), 0, 1e-6)
        before = zone["to_angle"]
    # Sides that are straight have none.
    run.block("pad.mesh", 0, 2, 6, 0, 1, 3)
    flat = run.case({"bodies": {"pad": body("pad.mesh", "4:x", ["P pressure 3 20"])}, "interfaces": {"flat": {"between": ["pad:1"]}}, "history": ["P=0", "P=1"]})
    assert all(zone["from_angle"] is None for zone in flat["zones"])


def test_units_are_printed_by_their_names(run):
    """Nothing is converted. Forces are per length of thickness unless the case has a thickness."""
    case = {**columns_case(run), "history": ["bolt=0", "bolt=1", "F=10"]}
    plain = run.case(case)
    named = run.case({**case, "units": {"length": "mm", "force": "N"}})
    assert named["units"] == {"length": "mm", "force": "N"}
    assert "forces in [N/mm]" in run.case({**case, "units": {"length": "mm", "force": "N"}}, "--verbose").output
    assert "N (pressing) [N/mm]" in named.output and "force at the end [N/mm]" in named.output
    assert "peak pressure [N/mm²]" in named.output and "to (arc length) [mm]" in named.output
    assert named["bolts"] == plain["bolts"]
    assert "[mm]" not in plain.output and "units" not in plain.results
    thick = run.case({**case, "thickness": 5, "units": {"length": "mm", "force": "N"}})
    assert "thickness 5 [mm]" in thick.output and "force at the end [N]" in thick.output and "moment [N mm]" in thick.output
    assert "has no 'force', must have one" in run.refused({**case, "units": {"length": "mm"}})
    assert "must be the name of a unit, as N" in run.refused({**case, "units": {"length": "mm", "force": ""}})


def test_ties_come_before_contacts_that_share_their_nodes(run):
    """A pad of which the ends are tied: whichever order the file has, the answer is the same; a uniform pressure is exact where nodes do
    not match; and an interval that ends within an element is told."""
    run.block("pad.mesh", -1, 1, 10, 0, 1, 4)
    run.block("base.mesh", -1, 1, 15, -1, 0, 4)
    ties = {name: {"between": [f"pad:1[{where}]", "base:3"], "tied": True, "slave": "first"} for name, where in (("left", "-1<x<-0.4"), ("right", "0.4<x<1"))}
    middle = {"middle": {**face("pad:1[-0.4<x<0.4]", "base:3", 0.3), "slave": "first"}}
    answers = []
    for order in (1, 2):
        for interfaces in ({**ties, **middle}, {**middle, **ties}):
            case = {"order": order, "bodies": {"pad": body("pad.mesh", None, ["P pressure 3 1", "Q traction 2 0.2 0"], 1000, 0.3), "base": body("base.mesh", "1:y @0,-1:x", [], 1000, 0.3)},
                    "interfaces": interfaces, "history": ["P=0", "P=1"]}
            got = run.case(case, "--csv", run.folder / "out")
            nodes = run.columns("out_nodes.csv")
            near_all(nodes["p"], 1, 1e-9)
            assert "ends within an element" not in got.warned()
            run.case(changed(case, {"history": ["P=0", "P=1", "Q=1"]}), "--csv", run.folder / "out")
            answers.append(run.columns("out_nodes.csv"))
    for one, other in (answers[:2], answers[2:]):
        for name in ("x", "p", "q", "slip"):
            alike(one[name], other[name], 1e-12)
    cut = run.case(changed(case, {"interfaces.middle.between": ["pad:1[-0.4<x<0.35]", "base:3"]}))
    assert "the interval of 'pad:1[-0.4<x<0.35]' ends within an element" in cut.warned() or "the interval of '1[-0.4<x<0.35]' ends within an element" in cut.warned()


def test_reactions_around_the_axis(run):
    """A shaft of two parts, turned at one end: each support, tie and obstacle has its torque, and they balance."""
    case, lame = press_fit(run)
    case["bodies"]["hub"]["support"] = "1:zt"
    case["bodies"]["sleeve"]["support"] = "1:z"
    case["bodies"]["sleeve"]["load"] = f"T traction-t 3 {1 / (math.pi / 2 * (1 - 0.5**4))!r}*r"
    torque = 0.5 * 0.2 * 2 * math.pi * 2 * lame
    got = run.case({**case, "history": ["T=0", f"T={torque!r}"]})
    rows = {(row["body"], row["name"]): row for row in got["reactions"]}
    near(rows["hub", "1:zt"]["torque"], -torque, 1e-9 * torque)
    near(rows["sleeve", "1:z"]["torque"], 0, 1e-12)
    for row in got["balance"]:
        assert row["imbalance"] < 1e-9
    # Tied, and turned by an angle against a rigid floor that it stands on: the floor takes what the angle does.
    run.block("shaft.mesh", 0.5, 1, 4, 0, 2, 8)
    run.block("head.mesh", 0.5, 1, 4, 2, 3, 4)
    turned = {"analysis": "axisymmetric", "bodies": {"shaft": body("shaft.mesh"), "head": body("head.mesh", None, ["P pressure 3 5", "W twist 3 1e-3"])},
              "interfaces": {"floor": {"between": ["shaft:1"], "friction": 0.5}, "glue": {"between": ["head:1", "shaft:3"], "tied": True}}, "history": ["P=0", "P=1", "W=1"]}
    got = run.case(turned, "--csv", run.folder / "out")
    rows = {(row["body"], row["name"]): row for row in got["reactions"]}
    # G J φ/L of a shaft that sticks, as it does under an angle this small.
    expected = 500 * math.pi / 2 * (1 - 0.5**4) * 1e-3 / 3
    near(rows["head", "W"]["torque"], expected, 1e-8 * expected)
    near(rows["shaft", "floor"]["torque"], -rows["head", "W"]["torque"], 1e-9 * expected)
    near(run.columns("out_history.csv")["reaction W"][-1], rows["head", "W"]["torque"], 1e-9 * expected)
    for row in got["balance"]:
        assert row["imbalance"] < 1e-9


def test_a_face_that_tilts_about_a_corner_of_the_contact(run):
    """It is no plane of symmetry, although the corner is at rest: the answer is that of a corner that moves by next to nothing."""
    run.block("pad.mesh", 0, 2, 8, 0, 1, 4)

    def pressures(tilt):
        case = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 10", f"D displacement-x 4 {tilt}"], 1000, 0.3),
                           "ground": {"half-plane": {"young": 1000, "poisson": 0.3, "depth": 100}}},
                "interfaces": {"flat": face("pad:1", "ground", 0.3)}, "history": ["P=0", "P=1", "D=1"]}
        run.case(case, "--csv", run.folder / "out")
        return run.columns("out_nodes.csv")

    still, moved = pressures("0.002*y"), pressures("0.002*y+1e-12")
    for name in ("p", "q", "slip"):
        alike(still[name], moved[name], 1e-6 * max(map(abs, moved[name])))


def test_loads_of_one_name_on_bodies_and_obstacles(run):
    """They are one load: an inclined force on an indenter, and a face that is moved with the floor that it stands on."""
    inclined = indenter(run, x={"force": "P", "value": 3}, y={"force": "P", "value": -20})
    one = run.case({**inclined, "history": ["P=0", "P=1"]}, "--csv", run.folder / "one")
    two = run.case({**changed(inclined, {"interfaces.face.guide.x": {"force": "Q", "value": 3}}), "history": ["P=0", "P=1 Q=1"]}, "--csv", run.folder / "two")
    assert one["loads"] == {"P": 1}
    near(one.interface("face")["force_x"], 3, 1e-9)
    near(one.interface("face")["force_y"], -20, 1e-9)
    alike(run.columns("one_nodes.csv")["q"], run.columns("two_nodes.csv")["q"], 1e-9 * one["peak_pressure"])
    # The work is the same: each force by the displacement along it.
    both = sum(force * run.columns("two_history.csv")[f"displacement {load}"][-1] for load, force in (("P", 20), ("Q", 3)))
    near(run.columns("one_history.csv")["displacement P"][-1] * math.hypot(20, 3), both, 1e-9 * abs(both))
    assert two["peak_pressure"] == pytest.approx(one["peak_pressure"], rel=1e-9)
    # A pad whose faces are moved with its floor does not slip, and friction has nothing to do.
    run.block("pad.mesh", 0, 2, 7, 0, 1, 4)
    case = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 5", "D displacement-x 2,4 0.1"], 1000, 0)},
            "interfaces": {"floor": {"between": ["pad:1"], "friction": 0.3, "motion": {"D": {"x": 0.1}}}}, "history": ["P=0", "P=1", "D=1"]}
    got = run.case(case, "--csv", run.folder / "out")
    near_all(run.columns("out_nodes.csv")["slip"], 0, 1e-12)
    near_all(run.columns("out_nodes.csv")["q"], 0, 1e-9)
    near(run.columns("out_history.csv")["reaction D"][-1], 0, 1e-9)


def test_loads_have_sizes(run):
    """Kinds, sizes and directions by hand; loops are force over displacement whatever a multiplier of 1 is said to be."""
    case = columns_case(run)
    del case["bolts"]
    case.update(units={"length": "mm", "force": "N"}, thickness=4, **{"cycle-start": 1, "cycles": 1})
    def sized(load, history, **more):
        got = run.case({**changed(case, {"bodies.high.load": [load]}), "history": history, **more})
        row = got["load_sizes"][0]
        panel = [one for one in got["shown"]["panels"] if one["name"] == "loops"]
        return got, row, panel[0] if panel else None
    # A column on a column: 4 deep, so four times as stiff.
    for load, history, size in (("F traction 3 0 -1", ["F=0", "F=10", "F=20", "F=10"], 4), ("F traction 3 0 -5", ["F=0", "F=2", "F=4", "F=2"], 20),
                                ("F pressure 3 1", ["F=0", "F=10", "F=20", "F=10"], 4)):
        got, row, panel = sized(load, history)
        assert (row["load"], row["kind"], row["displacement of"]) == ("F", "force", "high:3")
        near(row["size"], size, 1e-9 * size)
        alike(row["direction"], [0, -1], 1e-9)
        near(got["cycles"][0]["stiffness F"], 4 / COMPLIANCE, 1e-9 * 4 / COMPLIANCE)
        assert (panel["x"], panel["y"]) == ("displacement of high:3 along -y [mm]", "force F [N]")
        alike([max(panel["parts"][0]["y"]), min(panel["parts"][0]["y"])], [80, 40], 1e-7)
        alike([max(panel["parts"][0]["x"]), min(panel["parts"][0]["x"])], [20 * COMPLIANCE, 10 * COMPLIANCE], 1e-9)
    got, row, panel = sized("D displacement-y 3 -0.5", ["D=0", "D=0.1", "D=0.2", "D=0.1"])
    assert (row["kind"], row["size"], row["direction"]) == ("displacement", 0.5, [0, -1])
    near(got["cycles"][0]["stiffness D"], 4 / COMPLIANCE, 1e-9 * 4 / COMPLIANCE)
    assert (panel["x"], panel["y"]) == ("displacement D of high:3 along -y [mm]", "reaction D [N]")
    near(max(panel["parts"][0]["y"]), 0.1 * 4 / COMPLIANCE, 1e-6)
    # Without a resultant: both sides of a column, heat, and what a function says.
    for load, kind, size in (("S traction 2 3 0; S traction 4 -3 0", "opposite forces", 3 * 3 * 4), ("H temperature 50", "temperature", 50), ("E initial-strain 1e-3", "strain", 1e-3),
                             ("D displacement-y 3 -0.1*(1+0*x)", "load factor", 1), ("W traction 3 0 x-0.5", "moment", 4 / 12)):
        name = load.split()[0]
        held = changed(case, {"bodies.high.load": ["P pressure 3 1", *load.split("; ")], "bodies.high.expansion": 1e-5, "bodies.high.support": "@0,3:x", "cycle-start": None, "cycles": None})
        got = run.case({**held, "history": ["P=0", "P=1", f"{name}=1e-3", f"{name}=0"]})
        row = [row for row in got["load_sizes"] if row["load"] == name][0]
        assert row["kind"] == kind, row
        near(row["size"], size, 1e-9 * size)
    # A bolt, a guide and an obstacle; the file of the reduced problem has them too.
    bolted = {**columns_case(run), "history": ["F=0", "bolt=1", "F=1"]}
    got = run.case(bolted, "--save", run.folder / "reduced.json")
    rows = {row["load"]: row for row in got["load_sizes"]}
    assert (rows["bolt"]["kind"], rows["bolt"]["size"]) == ("bolt", 40)
    saved = {one["name"]: one["size"] for one in json.loads((run.folder / "reduced.json").read_text())["patterns"]}
    assert saved["bolt"]["kind"] == "bolt" and saved["F"]["direction"] == [0, 1]
    rolled = {**indenter(run, x={"displacement": "X", "value": 0.25}, y={"force": "P", "value": -20}, rotation={"moment": "M", "value": 10}), "history": ["P=0", "P=1", "M=0.1"]}
    rows = {row["load"]: row for row in run.case(rolled)["load_sizes"]}
    assert [(rows[name]["kind"], rows[name]["size"], rows[name]["direction"]) for name in "PMX"] == [
        ("force", 20, [0, -1]), ("moment", 10, None), ("displacement", 0.25, [1, 0])]


@pytest.mark.rest
def test_what_is_at_rest_does_not_depend_on_the_order_of_bodies(run):
    """A plate under a cap is dragged over its base until it slides as a whole. The cap rides along: nothing changes in its contact,
    and its zones stay as they were, in whichever order bodies, interfaces, sides and bolts are named."""
    run.block("base.mesh", -2.6, 2.6, 24, -2, 0, 6)
    run.block("plate.mesh", -2.13, 2.03, 19, 0, 1, 4)
    run.block("cap.mesh", -1.007, 1.092, 11, 1, 1.6, 3)
    bodies = {"base": body("base.mesh", "4:xy", (), 1e5, 0.3), "cap": body("cap.mesh", None, (), 1e5, 0.3),
              "plate": body("plate.mesh", None, ["G body-force 0 -0.288", "Q displacement-x 2 0.01116"], 2e5, 0.25)}
    push = {"x": {"force": "H", "value": 3.1}, "y": {"force": "P", "value": -15.5}, "rotation": "held", "centre": [0.0266, 7.125]}
    interfaces = {"top": {"between": ["cap:3"], "friction": 0.5, "obstacle": {"circle": {"centre": [0.0266, 7.125], "radius": 5.525}}, "guide": push},
                  "f": {"between": ["plate:1", "base:3"], "friction": 0.6547, "slave": "second"},
                  "g": {"between": ["cap:1", "plate:3"], "friction": 0.5732, "slave": "first"}}
    case = {"analysis": "plane strain", "order": 3, "bodies": bodies, "interfaces": interfaces,
            "history": ["P=0", "P=0.5, G=1", "P=1", "H=0.5", "Q=0.6", "Q=-0.5"]}
    other = {**case, "bodies": dict(reversed(bodies.items())), "interfaces": {
        name: {**face_, "between": face_["between"][::-1], **({"slave": {"first": "second", "second": "first"}[face_["slave"]]} if "slave" in face_ else {})}
        for name, face_ in reversed(interfaces.items())}}
    zones = []
    for each in (case, other):
        got = run.case(each, "--csv", run.folder / "out")
        assert got["status"] == "converged"
        rows = run.columns("out_zones_in_time_g.csv")
        zones.append([row for row in zip(rows["time"], rows["state"], rows["from"], rows["to"]) if row[0] >= 4])
    assert len(zones[0]) == len(zones[1])
    for one, two in zip(*zones):
        assert one[1] == two[1], (one, two)
        alike([one[0], *one[2:]], [two[0], *two[2:]], 1e-7)
    # The plate slides as a whole, and the cap does not: the zones of the last increments are the same.
    last = sorted({row[0] for row in zones[0]})[-5:]
    alone = [[row[1:] for row in zones[0] if row[0] == time] for time in last]
    assert all(each == alone[0] for each in alone) and len({row[0] for row in alone[0]}) > 1

def test_a_state_is_loaded_by_the_history_that_saved_it(run):
    """Bolts that were tightened otherwise, a gap or a friction that is not that of the state: each is refused. A bolt that is named
    with 0 is tightened by the march that goes on, with the same bits as in one march."""
    case, state = columns_case(run), run.folder / "state.json"
    case["bolts"]["other"] = {**case["bolts"]["bolt"], "preload": 25}
    run.case({**case, "history": ["F=0", "bolt=1", "other=0", "F=1"]}, "--save-state", state)

    def refused(changes, history):
        return run.refused({**changed(case, changes), "history": history}, "--load-state", state)

    then = ["F=0", "bolt=1", "other=0", "F=1", "other=1", "F=2"]
    for history, said in ((["F=0", "bolt=0.25", "other=0", "F=1", "other=1", "F=2"], "to 1 at point 1, and the history tightens it to 0.25 at point 1"),
                          (["F=0", "other=0", "other=0", "F=1 bolt=1", "other=1", "F=2"], "to 1 at point 1, and the history tightens it to 1 at point 3"),
                          (["F=0", "bolt=1", "other=1", "F=1", "F=2"], "bolt 'other' nowhere, and the history tightens it to 1 at point 2")):
        error = refused({}, history)
        assert said in error and "option --load-state" in error, error
    assert "the gap of interface 'joint' has been changed" in refused({"interfaces.joint.gap": 1e-3}, then)
    whole = run.case({**case, "history": ["F=0", "bolt=1", "F=1", "F=1", "other=1", "F=2"]})
    got = run.case({**case, "history": then}, "--load-state", state)
    for one, other in zip(got["bolts"], whole["bolts"]):
        near(one["force"], other["force"], 1e-9)
    unnamed = run.refused({**case, "history": ["F=0", "bolt=1", "F=1"]})
    assert "is never tightened" in unnamed and "'other=0'" in unnamed
    # A friction that the state cannot have.
    run.block("pad.mesh", 0, 2, 6, 0, 1, 3)
    pad = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 1", "Q traction 3 0.2 0"])}, "interfaces": {"floor": {"between": ["pad:1"], "friction": 0.5}},
           "history": ["P=0", "P=1", "Q=1", "Q=0"]}
    run.case({**pad, "history": ["P=0", "P=1", "Q=1"]}, "--save-state", state)
    error = run.refused(changed(pad, {"interfaces.floor.friction": 0.1}), "--load-state", state)
    assert "the friction of interface 'floor' has been changed to 0.1, and the saved state has a shear of" in error, error


def test_what_is_said_of_pressing_and_of_guided_bolts(run):
    """A load that presses and slides at once does press. A bolt whose end is guided, and moves along it, works."""
    run.block("pad.mesh", 0, 2, 6, 0, 1, 3)
    case = {"bodies": {"pad": body("pad.mesh", None, ["P traction 3 10 -10"])}, "interfaces": {"floor": {"between": ["pad:1"], "friction": 0.3}},
            "history": ["P=0", "P=1"]}
    got = run.case(case, code=2)
    assert "load 'P' presses too little for the shear that comes at the same time" in got["message"], got["message"]
    guide = {"on": "3", "x": "held", "y": {"force": "F", "value": 3}, "rotation": "held"}
    bolted = {"bodies": {"pad": {**body("pad.mesh"), "guides": [guide]}}, "interfaces": {"floor": {"between": ["pad:1"], "friction": 0.3}},
              "bolts": {"b": {"between": ["pad:3"], "direction": [0, 1], "stiffness": 100, "preload": 10}}, "history": ["F=0", "b=1", "F=1"]}
    got = run.case(bolted)
    assert "does nothing" not in got.warned()
    # The joint diagram: the pad is 2 · 1000 stiff (ν = 0).
    near(got["bolts"][0]["force"], 10 + 3 * 100 / (100 + 2000), 1e-9)


def test_a_contact_without_friction_that_does_not_slide_has_no_direction(run):
    """Pressed evenly: what is left of slip is round-off."""
    run.block("pad.mesh", 0, 20, 8, 0, 5, 4)
    run.block("base.mesh", 0, 20, 8, -5, 0, 4)
    case = {"bodies": {"pad": body("pad.mesh", None, ["P pressure 3 10"], 1000, 0.3), "base": body("base.mesh", "1:y @0,-5:x", (), 1000, 0.3)},
            "interfaces": {"flat": face("pad:1", "base:3", 0)}, "history": ["P=0", "P=1"]}
    got = run.case(case)
    assert {zone["state"] for zone in got["zones"]} == {"slip"}, got["zones"]

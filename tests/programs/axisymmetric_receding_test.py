"""A disc that recedes from a half-space, loaded and twisted: borders of the studies' notes, part D."""

import shlex

import pytest

from programs import near

# Sub-grid read-out ±0.001, and a tenth of the spacing, 0.02 t.
SPREAD, READ_OUT = 0.001, 0.002
LOADED = {"d/t, loaded, a = 2.5, f = 0.5": (3.728, SPREAD, READ_OUT), "c/t, loaded, a = 2.5, f = 0.5": (1.879, SPREAD, READ_OUT)}


def disc(run, options, code=0):
    return run.line("axisymmetric_receding " + options, code=code)


def falls(values):
    assert all(later < before for before, later in zip(values, values[1:])), values


def test_loaded_twisted_and_bonded_disc_meets_the_references(run):
    got = disc(run, "-torque '0.3 0.5 0.7' -bonded '2.1 3.75 4.25 4.7'")
    got.meets({**LOADED,
               # Four digits, at nodes: no read-out.
               "bonded, a = 2.1: p/p0 at r/t = 0.5": (0.9088, 5e-5, 4e-4),
               "bonded, a = 2.1: p/p0 at r/t = 1": (0.8618, 5e-5, 4e-4),
               "bonded, a = 2.1: p/p0 at r/t = 2": (0.4829, 5e-5, 4e-4),
               "bonded, a = 2.1: p/p0 at r/t = 3": (0.07621, 5e-6, 4e-4),
               "bonded, a = 2.1: p/p0 at r/t = 4": (0.01505, 5e-6, 4e-4),
               # A quotient at the rim, where both tractions are small.
               "f for full adhesion, a = 3.75": (1.69, 0.005, 0.01),
               "f for full adhesion, a = 4.25": (1.07, 0.005, 0.006),
               "f for full adhesion, a = 4.7": (0.600, 5e-4, 0.004),
               "T_s/(p0 t³)": (17.106, 0.001, 0.004),
               "d/t without friction": (3.1705, 5e-5, READ_OUT),
               # The error is of first order in the steps. There are 80.
               "c/t at T/T_s = 0.3": (1.829, 0.003, READ_OUT),
               "d/t at T/T_s = 0.3": (3.617, 0.003, READ_OUT),
               "c/t at T/T_s = 0.7": (1.564, 0.003, READ_OUT),
               "d/t at T/T_s = 0.7": (3.431, 0.003, READ_OUT),
               "slip angle at 10 %, rate, °": (14, 1, 0),
               "slip angle at 10 %, total, °": (8, 1, 0),
               "slip angle at 50 %, rate, °": (49, 1, 0),
               "slip angle at 50 %, total, °": (13, 1, 0),
               "slip angle at 90 %, rate, °": (77, 1, 0),
               "slip angle at 90 %, total, °": (37, 1, 0),
               "T_max/T_s": (1.0037, 5e-5, 4e-4)})
    assert got["status"] == "converged"
    assert got["torque_max"] > got["torque_limit"]
    # Coupling: d recedes as the torque grows, and slip eats the stick zone.
    for key in ("separation", "stick"):
        falls([got[key]] + [row[key] for row in got["torsion"]])


def test_narrow_load_meets_the_references(run):
    disc(run, "-load-radius 0.5 -friction 0.9").meets({
        "d/t, loaded, a = 0.5, f = 0.9": (2.625, SPREAD, READ_OUT), "c/t, loaded, a = 0.5, f = 0.9": (0.849, 5e-4, READ_OUT)})


def test_cycles_of_the_load_begin_as_unloading_does(run):
    got = disc(run, f"-cycle-to '0.5 0.9' -cycles 12 -increments 40 -spacing 0.04 -csv '{run.folder}/disc'")
    # Borders at half of the load, and the separation at all of it: studies' notes D.
    zones = run.columns("disc_load_cycle_zones.csv")
    half = [to for time, to in zip(zones["time"], zones["to"]) if abs(time - 1) < 1e-9]
    full = [to for time, to in zip(zones["time"], zones["to"]) if time == 0]
    for found, references, within in ((half, (1.715, 2.415, 3.015, 3.402, 5), 0.01), (full, (1.879, 3.728, 5), SPREAD)):
        assert len(found) == len(references)
        for to, reference in zip(found, references):
            near(to, reference, within + 2 * READ_OUT)
    # Whatever makes the contact recede further makes its edge slip, the first time the most.
    small, large = got["load_cycles"][1], got["load_cycles"][0]
    assert len(got["load_cycles"]) == 2
    for row in (small, large):
        assert row["opening"] > 0
        assert 0 < row["last_loss"] < row["first_loss"]
    assert small["last_loss"] < large["last_loss"]


@pytest.mark.parametrize("steps", [40, 80])
def test_unloading_meets_the_references_whatever_the_steps(run, steps):
    """1 - 40/80 is not 0.5 to the last bit: that must not become a step of its own."""
    got = disc(run, f"-unload '0.9 0.5 0.3' -increments {steps}")
    # Borders of unloading: ±0.01, separation to its digits.
    got.meets({**LOADED,
               "d/t at P/P0 = 0.9": (3.670, SPREAD, READ_OUT),
               "d/t at P/P0 = 0.3": (3.254, SPREAD, READ_OUT),
               "border 1 at P/P0 = 0.5": (1.715, 0.01, READ_OUT),
               "border 2 at P/P0 = 0.5": (2.415, 0.01, READ_OUT),
               "border 3 at P/P0 = 0.5": (3.015, 0.01, READ_OUT),
               "border 4 at P/P0 = 0.5": (3.402, 0.01, READ_OUT)})
    assert [len(row["zones"]) for row in got["unloading"]] == [5] * 3
    falls([got["separation"]] + [row["separation"] for row in got["unloading"]])


def test_what_does_not_twist_has_no_circumferential_unknowns(run):
    smooth, rough, twisted = (disc(run, "-spacing 0.1 " + more) for more in ("-friction 0", "", "-torque 0.5 -increments 10"))

    def counts(key):
        return [one["counters"][key] for one in (smooth, rough, twisted)]

    nodes = rough["contact_nodes"]
    assert counts("tangential_unknowns") == [0, nodes, 2 * nodes]
    assert counts("assemblies") == counts("factorisations") == [1, 1, 2]  # the half-space has no mesh


def test_maps_condense_once_per_disc(run):
    got = disc(run, "-map-load-radius '0.5 1.5 2.5 3.5' -critical '3 5'")
    assert got["counters"]["factorisations"] == 3
    assert len(got["map"]) == 8
    assert len(got["critical_load_radius"]) == 6
    rim = 0.004  # its node tells: of the first order in the spacing
    got.meets({**LOADED,
               "d/t, loaded, a = 2.5, f = 0.8": (4.046, SPREAD, READ_OUT),
               "c/t, loaded, a = 2.5, f = 0.8": (2.384, SPREAD, READ_OUT),
               "critical a/t, b = 3, f = 0": (2.367, 0.002, rim),
               "critical a/t, b = 3, f = 0.5": (1.733, 0.002, rim),
               "critical a/t, b = 3, f = 0.8": (1.341, 0.002, rim),
               "critical a/t, b = 5, f = 0": (4.415, 0.002, rim),
               "critical a/t, b = 5, f = 0.5": (3.793, 0.002, rim),
               "critical a/t, b = 5, f = 0.8": (3.458, 0.002, rim)})


@pytest.mark.parametrize("twist", ["top", "traction"])
def test_cycles_balance_their_energy(run, twist):
    got = disc(run, "-spacing 0.1 -increments 20 -twist-cycles 3 -amplitude 0.6 -twist " + twist)
    assert abs(got["energy_imbalance"]) < 0.01  # 20 steps
    assert len(got["cycles"]) == 3
    assert all(cycle["dissipation"] > 0 for cycle in got["cycles"])
    # Ratchetting: the contact shrinks from cycle to cycle.
    falls([got["separation"]] + [cycle["separation_back"] for cycle in got["cycles"]])


def test_no_torque_beyond_the_spinning_limit(run):
    got = disc(run, "-spacing 0.1 -increments 40 -twist traction -torque '0.5 1.1'", code=2)
    assert got["status"] == "gross sliding"
    assert len(got["torsion"]) == 1
    assert got["event_loads"]["a = 2.5"] == 1
    near(got["event_loads"]["twist"] / got["torque_limit"], 1, 0.01)


def test_every_way_of_twisting_meets_the_same_limit(run):
    for twist in ("top", "loaded", "rim"):
        got = disc(run, "-spacing 0.1 -increments 20 -torque 0.5 -twist " + twist)
        near(got["torsion"][0]["torque"], 0.5, 2e-6)
        near(got["torque_max"] / got["torque_limit"], 1, 0.01)
    assert disc(run, "-spacing 0.1 -increments 20 -rotation '1 20'")["torsion"][1]["rotation"] == 20


@pytest.mark.parametrize("options", [
    "-torque 0.5 -rotation 1", "-friction -1", "-load-radius 6", "-twist sideways", "-rotation 1 -twist traction", "-amplitude 2",
    "-unload 1.5", "-map-load-radius 7", "-friction 0 -torque 0.5", "-domain 3", "-increments 1", "-critical -1", "-map-load-radius 2 -map-friction ''",
])
def test_bad_options_are_one_sentence(run, options):
    run.refuses("axisymmetric_receding", shlex.split(options), [])

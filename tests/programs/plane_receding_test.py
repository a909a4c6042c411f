"""A strip that recedes from a block: borders of the studies' notes, part B."""

import pytest

from programs import near

# ±0.003, and a tenth of the spacing, 0.02 t unless said, for the read-out of edges.
SPREAD, READ_OUT = 0.003, 0.002


@pytest.mark.rest  # the same run is a sample run with the same values
def test_loading_and_unloading_meet_the_references_on_a_large_block(run):
    got = run.line("plane_receding -domain 1e4 -unload '0.9 0.5 0.2 0.1' -increments 50")
    got.meets({"s/t, n = 4, f = 0.7": (1.406, SPREAD, READ_OUT),
               "e/t, n = 4, f = 0.7": (-0.442, SPREAD, READ_OUT),
               "ξ/t of separation, unloaded to p/p0 = 0.9": (-1.336, SPREAD, READ_OUT),
               "ξ/t of separation, unloaded to p/p0 = 0.2": (-0.740, SPREAD, READ_OUT),
               "ξ/t of separation, unloaded to p/p0 = 0.1": (-0.594, SPREAD, READ_OUT),
               "ξ/t of border 1 of 4, p/p0 = 0.5": (-1.018, SPREAD, READ_OUT),
               # To two digits, and read to half a spacing.
               "ξ/t of border 2 of 4, p/p0 = 0.5": (-0.68, 0.005, 0.01),
               "ξ/t of border 3 of 4, p/p0 = 0.5": (-0.12, 0.005, 0.01),
               "ξ/t of border 4 of 4, p/p0 = 0.5": (0.61, 0.005, 0.01),
               "v E'/(p0 t) at ξ/t = -0.5, full load": (-0.8245, 5e-4, 5e-4),
               # Levels are known to a step, 1/50 of what is left of the load.
               "p/p0 down to which ξ/t = -0.5 sticks": (0.41, 0.005, 0.02),
               "p/p0 at which ξ/t = -0.5 separates": (0.06, 0.005, 0.01)})
    # Separation recedes further during unloading, and a forward zone follows it.
    separations = [got["separation"]] + [level["separation"] for level in got["levels"]]
    assert all(later < before for before, later in zip(separations, separations[1:])), separations
    assert [len(level["zones"]) for level in got["levels"]] == [5] * 4
    assert got["counters"]["pivots"] == 0


def test_finite_block_of_the_thesis(run):
    run.line("plane_receding -obstacle th0 -friction 0.3").meets({
        "s/t, n = 4, f = 0.3": (0.910, SPREAD, READ_OUT), "e/t, n = 4, f = 0.3": (-1.655, SPREAD, READ_OUT)})
    got = run.line("plane_receding -obstacle th0 -unload 0.5 -slip '' -lowest 0.4")
    # The notes' fourth border is 0.48 for n = 2, and 0.502 for n = 4.
    zones = got["levels"][0]["zones"]
    assert len(zones) == 5
    for zone, border, within in zip(zones, (-1.053, -0.77, -0.18, 0.502), (0.005, 0.015, 0.015, 0.015)):
        near(zone["to"], border, within)
    near(got["separation"], 1.382, SPREAD + READ_OUT)
    near(got["stick_slip"], -0.351, SPREAD + READ_OUT)


@pytest.mark.rest
def test_blocks_tend_to_the_half_plane(run):
    """The half-plane without a mesh is that to which blocks tend as they grow. (The references marked HP are those of a block of
    10⁴ t, whose remote tension, a hundredth of p0, still moves e by 0.007 to 0.016.)"""
    words = "plane_receding -map-overhang '1.2 1.6 4' -unload '0.9 0.5 0.2'"
    limit, block = run.line(words), run.line(words + " -domain 1e6")
    tenth = 0.002  # of the spacing

    def same(a, b, within):
        """Nothing separates in either of them, or here in both."""
        if a is None or b is None:
            assert a is b, (a, b)
        else:
            near(a, b, within)

    assert len(limit["map"]) == len(block["map"]) == 12
    for a, b in zip(limit["map"], block["map"]):
        same(a["separation"], b["separation"], tenth)
        same(a["stick_slip"], b["stick_slip"], tenth)
    assert len(limit["levels"]) == len(block["levels"]) == 3
    for one, other in zip(limit["levels"], block["levels"]):
        assert [zone["state"] for zone in one["zones"]] == [zone["state"] for zone in other["zones"]]
        for k, (a, b) in enumerate(zip(one["zones"], other["zones"])):
            # Where loading slip follows stick the edge is read to a node.
            same(a["to"], b["to"], 10 * tenth if k == 2 else tenth)
    same(limit["slip_histories"][0]["slip_at_p0"], block["slip_histories"][0]["slip_at_p0"], 5e-4)
    # The references that the remote tension does not move.
    for f, s in enumerate((0.903, 1.169, 1.406)):
        same(limit["map"][3 * f + 2]["separation"], s, SPREAD + tenth)


def test_map_over_overhang_and_friction_from_one_condensation(run):
    got = run.line("plane_receding -domain 1e4 -map-overhang '0.4 1.2 1.6 2 4' -spacing 0.04 -corner 0.01 -domain-study")
    coarse = 0.004  # a tenth of this spacing
    got.meets({"s/t, n = 4, f = 0.3": (0.903, SPREAD, coarse),
               "e/t, n = 4, f = 0.3": (-1.858, SPREAD, coarse),
               "s/t, n = 4, f = 0.5": (1.169, SPREAD, coarse),
               "e/t, n = 4, f = 0.5": (-0.883, SPREAD, coarse),
               "s/t, n = 4, f = 0.7": (1.406, SPREAD, coarse),
               "e/t, n = 4, f = 0.7": (-0.442, SPREAD, coarse),
               "s/t, n = 4, f = 1": (1.730, SPREAD, coarse),
               "e/t, n = 4, f = 1": (-0.046, SPREAD, coarse),
               "s/t, n = 1.6, f = 0.5": (1.169, SPREAD, coarse),
               "e/t, n = 1.6, f = 0.5": (-0.883, SPREAD, coarse),
               "s/t, n = 1.2, f = 0.3": (0.906, SPREAD, coarse),
               "e/t, n = 1.2, f = 0.3": (-1.859, SPREAD, coarse),
               "length separated, n = 1.2, f = 0.5": (0, 0, 0)})
    # One pair for the map, one for each of the five domains, and a strip without a block.
    assert got["counters"]["factorisations"] == 2 + 2 * 5 + 1
    assert got["counters"]["unions"] == 1 + 5 + 1
    # Independent of n from n = 2 on, but for f = 1, where separation nears the strip's end.
    long = [row for row in got["map"] if row["friction"] != 1 and row["overhang"] >= 2]
    assert len(long) == 6
    for a in long:
        for b in long:
            if a["friction"] == b["friction"]:
                near(a["separation"], b["separation"], 0.005)
                near(a["stick_slip"], b["stick_slip"], 0.005)
    assert "Domain study" in got.output


def test_long_free_ends_that_close_at_once_need_a_path(run):
    """Runs of penetrating nodes make the active set cycle."""
    got = run.line("plane_receding -map-overhang '2 2.25 3.5' -map-friction 1 -spacing 0.05")
    assert len(got["map"]) == 3
    assert got["counters"]["pivots"] > 0
    for state in got["map"]:  # nearly independent of n
        near(state["separation"], got["map"][2]["separation"], 0.01)
        near(state["stick_slip"], got["map"][2]["stick_slip"], 0.01)


def test_a_bonded_short_overhang_needs_the_corners_friction(run):
    """A short overhang needs no more than the corner itself."""
    got = run.line("plane_receding -overhang 0.1 -friction 0.8")
    near(got["adhesion_friction"], 0.543075578837, 1e-9)
    assert got["separation"] is None
    assert got["stick_slip"] is None, "the corner's nodes ask for 0.6 to 0.77, never converging"


def test_poissons_ratio_does_not_matter(run):
    a, b = (run.line(f"plane_receding -friction 0.5 -spacing 0.05 -corner 0.01 -poisson {poisson}") for poisson in (0, 0.4))
    # Discretisation errors do depend on it: a fiftieth of the spacing.
    near(a["separation"], b["separation"], 1e-3)
    near(a["stick_slip"], b["stick_slip"], 1e-3)


def test_unloading_hardly_depends_on_the_steps(run):
    coarse, fine = (run.line(f"plane_receding -unload '0.8 0.5 0.2' -lowest 0.2 -overhang 2.5 -increments {steps}") for steps in (25, 100))
    assert len(coarse["levels"]) == len(fine["levels"]) == 3
    for one, other in zip(coarse["levels"], fine["levels"]):
        assert [zone["state"] for zone in one["zones"]] == [zone["state"] for zone in other["zones"]]
        for a, b in zip(one["zones"], other["zones"]):
            near(a["to"], b["to"], 0.02)


def test_cycles_whose_loss_falls_shake_down(run):
    """The loss falls by one factor a cycle: cycles on, nothing is left of it. Where slip turns over more of the contact, a part of
    it slips for ever."""
    options = "plane_receding -spacing 0.1 -length 40 -corner 0.01 -cycle-to '0.6 0.95'"
    cycles = run.line(options)["load_cycles"]
    assert [cycle["outcome"] for cycle in cycles] == ["slips for ever", "shaken down"]
    assert cycles[1]["last_loss"] <= 1e-9 * cycles[1]["first_loss"]
    # On its way there it says by which factor.
    tenth, later = (run.line(f"{options} -cycles {count}")["load_cycles"][1] for count in (10, 18))
    factor = (later["last_loss"] / tenth["last_loss"]) ** (1 / 8)
    words = "still falls, by a factor "
    assert later["outcome"].startswith(words)
    near(float(later["outcome"].removeprefix(words).split()[0]), factor, 0.01)  # to two digits


def test_a_map_goes_on_beyond_what_is_not_unique(run):
    """Friction above its critical value has several answers: that is a row, and those after it are the same as without it."""
    options = "plane_receding -spacing 0.05 -corner 0.01 -map-overhang '2 4' -map-friction "
    got, good = run.line(options + "'0.3 50 0.5'", code=2), run.line(options + "'0.3 0.5'")
    states = got["map"]
    assert [state["status"] for state in states] == ["converged"] * 2 + ["not unique"] * 2 + ["converged"] * 2
    for state, same in zip(states[:2] + states[4:], good["map"], strict=True):
        near(state["separation"], same["separation"], 1e-9)
        near(state["stick_slip"], same["stick_slip"], 1e-9)
    assert "2 of 6 states of the map" in got.output


def test_one_of_several_states_is_shown(run):
    """All of the strip may stick where friction is large: that state is shown."""
    got = run.line("plane_receding -friction 100 -spacing 0.05 -corner 0.01", code=2)
    assert got["status"] == "not unique"
    assert "Loading, n = 4" in got.output
    assert got["zones"][0]["state"] == "stick"

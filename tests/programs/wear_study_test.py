"""Wear of fretting contacts: closed forms of what is worn out, and what is said of the way there."""

import json

import pytest

from programs import near, near_relative, problem, twice

HERTZ = "wear --reduced problems/hertz.json "
CYCLE = "--history 'P=0; P=1; Q=.2; Q=-.2; Q=.2' --cycle-start 2 --cycles 1 "


def test_options_of_the_pad_are_not_for_a_reduced_problem(run):
    run.line(HERTZ + CYCLE)
    for of_pad in ("--profile flat", "--flat 0.6", "--poisson 0.2", "--nodes 101", "--order 1", "--amplitude 0.2"):
        assert "belongs to the pad" in run.line(HERTZ + CYCLE + of_pad, code=1).output


@pytest.mark.parametrize("flat, stick, extent, volume, depth", [
    (0.5, 1.077145, 1.509827, 0.053944, 0.089260),
    (0.9, 1.416307, 1.821895, 0.042860, 0.075610),
])
def test_flat_pads_of_any_width_wear_within_their_line(run, flat, stick, extent, volume, depth):
    """Closed form by quadrature: contact of a flat with rounded edges grows as a row of flat punches, what wears is lifted as by
    the punch of the load that stick does not carry by itself."""
    got = run.line(f"wear --profile flat --cycles 1 --flat {flat}")
    near_relative(got["final_stick"], stick, 0.003)
    near_relative(got["final_extent"], extent, 0.003)
    near_relative(got["final_volume"], volume, 0.02)
    near_relative(got["final_depth"], depth, 0.01)
    assert got["warnings"] == []


@pytest.mark.parametrize("law", ["--least-pressure 0.4", "--wear 0"])
def test_there_is_no_worn_out_state_of_a_threshold_or_without_wear(run, law):
    got = run.line("wear --cycles 10 --nodes 49 " + law)
    assert "final_depth" not in got.results and "worn_out" not in got.results


def test_loads_with_names_of_studies_and_depths_that_are_not_small(run):
    """Names that a study wrote are said in quotes; units t = p0 = E' = 1 make displacements large."""
    got = run.line("wear --reduced problems/lap_joint.json --cycles 1e9 --wear 1e-9 --cycle-start 2 "
                   "--history \"'bolt 1, w = 1'=0; 'bolt 1, w = 1'=1; T=0.01; T=0; T=0.01\"", code=None)
    assert got.code != 1, got.output
    assert got["cycles_worn"] == 1e9


@pytest.mark.parametrize("bent", [
    "--reduced problems/punch_on_half_plane.json --history 'P=0; P=1; Q=.3; Q=-.3; Q=.3' ",
    "--reduced problems/hertz.json --history 'P=0; P=1; P=1.3 Q=.3; P=1 Q=-.2; P=1.3 Q=.3' ",
])
def test_increments_where_slip_bends(run, bent):
    """Where shear moves the pressure, or the load that presses varies, slip bends on its way and one increment errs by more than
    the share of the depth that jumps may err by, 1e-3; twenty do not. A study that asks for none follows the exact path."""
    asked = "wear " + bent + "--cycle-start 2 --cycles 1 --wear 1e-5 "
    exact, many, one = (run.line(asked + more) for more in ("", "--stepping fixed --increments 20", "--stepping fixed --increments 1"))
    volume = exact["volume"]
    near_relative(many["volume"], volume, 1e-3)
    assert abs(one["volume"] - volume) > 1e-3 * volume


def test_end_of_one_of_two_lines(run):
    """Two contacts side by side end as each does alone: what is printed is of one of them."""
    asked = CYCLE + "--wear 1e-5"
    file = run.write("two_lines_to_wear.json", json.dumps(twice(problem("hertz"))))
    one, two = run.line(HERTZ + asked), run.line(f"wear --reduced '{file}' " + asked)
    for value in ("final_stick", "final_extent", "final_pressure_centre", "final_depth"):
        near_relative(two[value], one[value], 1e-6)
    near_relative(two["final_volume"], 2 * one["final_volume"], 0.5e-6)


def test_sliding_says_at_which_load(run):
    """It slides where Q = f P, with the f = 0.4 of the file."""
    got = run.line(HERTZ + "--history 'P=0; P=1; Q=0.5; Q=-0.5; Q=0.5' --cycle-start 2 --cycles 20", code=2)
    near(got["event_loads"]["Q"], 0.4, 1e-6)
    assert "(P = 1, Q = 0.4)" in got.output


@pytest.mark.parametrize("least", ["0", "0.5"])
def test_nothing_wears_where_nothing_slips(run, least):
    """Two equal bodies that are pressed alone do not slip (B = 0), and what does not slip does not wear: neither where they part
    in the cycle, nor where only the edges of contact do."""
    got = run.line(HERTZ + f"--history 'P=0; P=1; P={least}; P=1' --cycle-start 1 --cycles 5 --wear 10")
    for none in ("volume", "depth", "energy", "final_volume", "final_depth"):
        assert got[none] == 0, none
    assert got["worn_out"] == "converged"
    assert got["explicit_limit"] is None
    assert "no node slips in a cycle, so nothing wears" in got.output


def test_a_cycle_of_the_worn_out_contact_loses_nothing(run):
    """What is left of the loss where a contact of equal bodies is worn out is round-off."""
    got = run.line("wear --cycles 0 --nodes 97")
    assert got["final_depth"] > 0
    assert got["final_loss"] == 0


@pytest.mark.rest
def test_the_table_of_an_interrupted_run_has_its_last_state(run):
    """Ctrl-C: a cycle that is not whole is none, and the table goes up to the last one."""
    got = run("wear", "--cycles", "1e9", "--depth-error", 0, "--wear", "1e-6", "--nodes", 49, code=2,
              launcher="timeout --foreground --preserve-status -s INT 2".split())
    assert got["status"] == "stopped"
    assert got["event_loads"]["P"] == 1  # within a cycle or between two
    assert got["cycles_worn"] > 1
    assert got["cycles_marched"] == got["cycles_worn"]
    assert got["cycles"][-1]["cycle"] == got["cycles_worn"]
    assert got["cycles"][-1]["volume"] == got["volume"]

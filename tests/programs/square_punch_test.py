"""A square punch: stick zones and losses of the studies' notes, part A, and what is said of a run."""

import math

import pytest

from programs import near, near_relative

# The 201 contact nodes are graded to the corners, to 0.02 a apart in the middle: edges are read out to a tenth of that.
READ_OUT = 0.002


@pytest.mark.parametrize("order", [1, 2])
def test_rigid_plane_meets_the_references_at_both_orders(run, order):
    got = run("square_punch", "-cycles", 3, "-order", order)
    got.meets({"stick half-width, P only": (0.471, 0.003, READ_OUT),
               "v(corner), P only": (0.0496, 5e-4, 0),
               "right end of stick, Q/fP = 0.25": (0.19, 0.005, READ_OUT),
               "right end of stick, Q/fP = 0.5": (-0.203, 0.005, READ_OUT),
               "right end of stick, Q/fP = 0.75": (-0.511, 0.005, READ_OUT),
               "right end of stick, Q/fP = 0.9": (-0.729, 0.005, READ_OUT),
               "steady loss per cycle, Q = ±0.8 fP": (9.17e-4, 0.003 * 9.17e-4, 0)})
    assert got["status"] == "converged"
    assert got["steady_cycle"] == 2
    assert abs(got["energy_imbalance"]) < 1e-3  # increments
    # A rigid obstacle is no body: one operator, one factorisation, no union; no field was asked.
    counters = got["counters"]
    assert [counters[key] for key in ("assemblies", "factorisations", "unions", "field_recoveries")] == [1, 1, 0, 0]


def test_only_a_steady_loss_is_called_one(run):
    """The loss of the last cycle is called steady where the march is: from the first cycle on below what friction bears without
    slip, not after one or two of a shear that turns all of the slip."""
    def loss(options, key, other):
        got = run.line("square_punch -shear none " + options)
        assert other not in got.results
        return got[key]

    assert loss("-friction 0.5 -amplitude 0.3 -cycles 2", "steady_loss", "last_loss") == 0
    assert loss("-friction 0.5 -amplitude 0.7 -cycles 2", "last_loss", "steady_loss") > 0
    assert loss("-cycles 1", "last_loss", "steady_loss") > 9.17e-4  # the studies' notes, part A


@pytest.mark.parametrize("order, corner", [(1, 0.008), (2, 0.003)])
def test_half_plane_meets_the_references_at_both_orders(run, order, corner):
    """Slip is lost at the corners, where linear elements are first order in their size."""
    got = run("square_punch", "-obstacle", "half-plane", "-cycles", 3, "-order", order)
    got.meets({"stick half-width, P only": (0.909, 0.002, READ_OUT),
               "right end of stick, Q/fP = 0.25": (0.737, 0.002, READ_OUT),
               "right end of stick, Q/fP = 0.75": (-0.526, 0.002, READ_OUT),
               "steady loss per cycle, Q = ±0.8 fP": (3.377e-3, 0.003 * 3.377e-3, corner * 3.377e-3)})
    assert got["counters"]["factorisations"] == 1  # the half-plane has no mesh
    assert got["counters"]["unions"] == 1


def test_no_loss_below_the_shakedown_load(run):
    """Studies A: at ±0.6 fP nothing is lost from the second cycle on."""
    got = run.line("square_punch -cycles 3 -amplitude 0.6 --shear ''")
    assert got["dissipation"][0] > 1e-6
    assert abs(got["dissipation"][1]) < 1e-14


def test_infinitesimal_shear_sticks_the_backward_slip(run):
    near(run.line("square_punch --shear 1e-6")["levels"][0]["stick_left"], -1, 1e-12)


def test_references_know_the_path(run):
    """A load that turned back has no reference of loading, and no closed form of it."""
    for shear, compared in (("0.25 0.9", True), ("0.9 0.25", False), ("-0.5 0.25", False)):
        got = run("square_punch", "-shear", shear)
        named = [row for row in got["references"] if row["quantity"] == "right end of stick, Q/fP = 0.25"]
        assert bool(named) == compared, shear
        for row in run("hertz", "-shear", shear)["levels"]:
            if row["shear"] == 0.25:
                assert isinstance(row["cattaneo_mindlin"], (int, float)) == compared, row
    # The mirror image of a shear has the same stick, and is as far off the closed form.
    right, left = (run("hertz", "-shear", shear)["levels"][0] for shear in (0.5, -0.5))
    near(left["cattaneo_mindlin"], math.sqrt(0.5), 1e-15)
    for key in ("stick_half_width", "shear_deviation"):
        near(left[key], right[key], 1e-6)


def test_slip_under_pressure_alone_is_odd(run):
    got = run.line("square_punch --shear ''")
    near(got["stick_left"], -got["stick_right"], 1e-9)
    assert got["counters"]["increments"] == 1  # self-similar: one increment is exact


def test_loop_of_the_history_is_that_of_the_cycle(run):
    """The cycle begins where P alone left the punch, not where the levels of Q ended: the history says so, and the area of the
    loop in it is what is printed."""
    got = run("square_punch", "-nodes", 41, "-shear", "0.5 0.9", "-cycles", 1, "-amplitude", 0.5, "-events", "--csv", run.folder / "loop")
    rows = run.columns("loop_history.csv")
    time, Q, moved = rows["time"], rows["load Q"], rows["displacement per unit of Q"]
    work = jumps = 0
    for k in range(1, len(time)):
        if time[k] == time[k - 1]:
            assert Q[k] == 0  # P alone
            jumps += 1
            work = 0
        else:
            work += 0.5 * (Q[k] + Q[k - 1]) * (moved[k] - moved[k - 1])
    assert jumps == 1
    assert rows["cycle"][-1] == 1
    near_relative(work, got["cycles"][0]["work Q"], 1e-9)


def test_frictionless_has_no_tangential_unknowns(run):
    got = run.line("square_punch -friction 0 --shear ''")
    assert got["counters"]["tangential_unknowns"] == 0
    assert got["stick_left"] is None
    # Q is in f P, which is none.
    assert run.line("square_punch -friction 0 -nodes 33")["levels"] == []
    for options in ("-shear 0.5", "-cycles 2"):
        run.line("square_punch -friction 0 " + options, code=1)


def test_gross_sliding_is_an_answer_with_its_load(run):
    got = run.line("square_punch --shear '0.5 1.2'", code=2)
    assert got["status"] == "gross sliding"
    near(got["event_loads"]["Q"], 0.2, 1e-8)  # Q = f P, whatever the elasticity
    assert "slides" in got.output


def test_a_study_has_one_clock(run):
    """P in the first unit of time, Q/fP = 0.5 in the second, and of the way to 1.2 in the third what is up to 1. All that is
    written has that time."""
    got = run("square_punch", "-shear", "0.5 1.2", "-nodes", 41, "--csv", run.folder / "clock", "--html", run.folder / "clock.html", code=2)
    slides = 2 + (1 - 0.5) / (1.2 - 0.5)
    near(got["event_time"], slides, 1e-6)
    assert "at time 2.714" in got.output
    near(float(run.text("clock_history.csv").splitlines()[-1].split(",")[0]), slides, 1e-6)
    assert '"time": 2.714' in run.text("clock.html")


@pytest.mark.parametrize("options", [
    ["-friction", -0.1], ["-poisson", 0.5], ["-nodes", 100], ["-order", 0], ["-grading", 0], ["-domain", 1], ["-obstacle", "wall"],
    ["--shear", "0.2 x"], ["-cycles", -1], ["-increments", 0], ["-friction", "nan"], ["--no-such-option"], ["-order", "two"],
])
def test_bad_options_are_one_sentence_and_exit_code_one(run, options):
    run.refuses("square_punch", options, [])


def test_help_and_a_results_file_that_cannot_be_written(run):
    run.line("square_punch -h")
    run.line("square_punch -nodes 33 --json /nonexistent/folder/x.json", code=1)

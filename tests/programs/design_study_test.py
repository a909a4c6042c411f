"""Designs: pressures and losses that are least, beside closed forms, sweeps and marches."""

import concurrent.futures
import json
import math
import random

import pytest

from programs import Runner, near, near_relative, problem, twice

STOPPED_AFTER = "timeout --foreground --preserve-status -s INT".split()


def test_a_gap_that_is_too_round_is_made_flatter(run):
    """A parabola presses less where its middle is taken off. No profile presses less than the mean over what touches; a node that
    stays open does not add to that."""
    P, length, a = 0.00392699, 3.34, 1  # of the file
    free, crown = (run.line("design --reduced problems/hertz.json --history 'P=0; P=1' --profile " + profile) for profile in ("free", "crown"))
    for got in (free, crown):
        assert got["design"] == "optimal"
        near(got["objective_at_start"], 2 * P / (math.pi * a), 1e-5)
        assert got["objective"] > P / length
    # Uniform over |x| < a and half an element on either side.
    near_relative(free["objective"], P / (2 * a), 0.05)
    assert crown["objective"] < 1.1 * P / length


def test_compares_with_the_uniform_pressure_where_the_gap_may_have_its_profile(run):
    """The closed form is that of a gap without bounds."""
    assert "profile_error" not in run.line("design --most 0.05 --nodes 17").results
    assert "profile_error" in run.line("design --nodes 17").results


def test_ends_where_derivatives_jump(run):
    """Where responses bend at the optimum the search ends, and a sweep finds nothing better."""
    got = run.line("design --goal loss --amplitude 0.5 --scene punch --profile crown --nodes 17 --lines 16")
    assert got["best_of_lines"] <= 1e-4
    assert got["design"] == "optimal" or got["stationarity"] is None
    assert "return status" not in got.output


@pytest.mark.rest
def test_says_that_it_was_stopped(run):
    """Ctrl-C, long before it would be done."""
    # In the foreground: otherwise timeout also signals its group, a second Ctrl-C, which ends a program at once.
    got = run("design", *"--goal loss --amplitude 0.5 --scene punch --profile free --nodes 129 --increments 50".split(), code=2,
              launcher=[*STOPPED_AFTER, "4"])
    assert got["status"] == got["design"] == "stopped"
    assert got["message"] == "the design was stopped on request"
    assert "stopped on request" in got.output


@pytest.mark.rest
def test_pretensions_of_a_row_of_bolts_against_a_sweep(run):
    """Three bolts whose pretensions add up to 3, pulled and pushed: against marches over all shares in steps of 0.02. Pressures are
    convex along a load, nearly, so the best of the grid is within half a step's worth of the optimum. The row is its own mirror
    image."""
    got = run.line("design --case problems/bolt_row.case.json")
    assert got["design"] == "optimal"
    x = got["variables"]
    assert len(x) == 3
    near(sum(x), 0, 1e-9)
    near(x[0], x[2], 1e-6)

    def peak(pretensions):
        """The largest pressure at the points of the history, by a march of its own, in a folder of its own."""
        folder = run.folder / "_".join(map(repr, pretensions))
        folder.mkdir()
        own = Runner(folder, run.programs)
        tightened = " ".join(f"'bolt {k}, w = 1'={force!r}" for k, force in enumerate(pretensions, 1))
        own("march", "--reduced", "problems/bolt_row.json", "--history", f"T=0; {tightened}; T=0.1; T=-0.1", "--frames", "1 2 3",
            "--csv", folder / "m")
        return max(own.columns("m_nodes.csv")["p"])

    least = got["objective"]
    near(peak([1 + choice for choice in x]), least, 1e-9)
    near(peak([1, 1, 1]), got["objective_at_start"], 1e-9)
    points = []
    for k in range(13):
        second = 0.9 + 0.02 * k
        rest = 0.5 * (3 - second)
        points += [(rest + lean, second, rest - lean) for lean in (-0.1 + 0.02 * j for j in range(11))]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        best = min(pool.map(peak, points))
    assert least - 1e-9 <= best <= least + 0.02


ROW = "--reduced problems/lap_joint.json --history 'T=0; T=0.02' "


@pytest.mark.parametrize("options, words", [
    ("--choose 'P; Q'", "--choose does nothing in this run: it goes with --reduced"),
    (ROW + "--choose 'T; P' --coat '0.1 0.5'", "cannot be used together"),
    ("--coat '0.1 0.5' --profile crown", "which --choose and --coat replace"),
    ("--coat '0.5 0.1'", "must be the least friction and the most"),
    ("--coat '0.5 0.9'", "must include the friction of the problem, 0.3 to 0.3"),
    ("--coat '0.1 0.5' --zones 1000", "no node lies"),
    ("--zones 3", "--zones does nothing in this run: it goes with --coat"),
    ("--powers 3", "--powers does nothing in this run: it goes with --profile crown"),
    ("--profile crown --powers '2 2.5'", "must be whole numbers"),
    ("--profile crown --powers '2 2'", "each once"),
    ("--profile rounded --curvature 1", "--most is the limit of 1/R"),
    ("--lines 4", "--lines does nothing in this run: it is not for a free profile"),
    ("--goal energy", "needs a cycle"),
    (ROW + "--choose T", "must be at least two loads"),
    (ROW + "--choose 'T; T'", "names 'T' twice"),
    (ROW + "--choose 'T; U'", "'U'"),
    ("--reduced problems/lap_joint.json --history 'T=0; T=-1' --choose 'T; bolt 1, w = 1'", "must not be negative"),
    ("--reduced problems/lap_joint.json --history 'T=0; T=0' --choose 'T; bolt 1, w = 1'", "one must act"),
])
def test_loads_that_are_chosen_keep_their_sum(run, options, words):
    assert words in run.line("design " + options, code=1).output


@pytest.mark.rest
def test_coat_of_a_dovetail_against_the_work_of_its_tractions(run):
    """The criterion of fretting that asks for the largest energy per area of a cycle, on the flank of the shipped dovetail: friction
    of two zones is chosen so that it is least. Printed is the work of tractions in small increments, and no coating that is drawn at
    random is better."""
    file, history = run.folder / "flank.json", "P=0; P=1; P=0.6; P=1; P=0.6; P=1"
    run("contact", "--case", "meshes/dovetail.json", "--cycles", 1, "--save", file)
    got = run.line(f"design --reduced '{file}' --history '{history}' --from 3 --goal energy --coat '0.1 0.6' --zones 2 --starts 2")
    objective = got["objective"]
    assert len(got["starts"]) == 2
    for start in got["starts"]:
        assert start["objective"] >= objective * (1 - 1e-12)
    flank = problem(file)
    s = flank["arc_length"]["values"]
    half = 0.5 * (min(s) + max(s))

    def coated(first, second):
        """The largest energy that a node loses per area from the third point of the history on: the work of its traction by the
        trapezoidal rule over many increments, which is the law's but where slip turns within one."""
        flank["friction"]["values"] = [first if place < half else second for place in s]
        run.write("coated.json", json.dumps(flank))
        run("march", "--reduced", run.folder / "coated.json", "--history", history, "--increments", 200, "--stepping", "fixed",
            "--frames", "all", "--csv", run.folder / "m")
        # Only time, q and slip of a row are read. The rows of a node are as many lines apart as there are nodes.
        rows = [line.split(",") for line in run.text("m_nodes.csv").splitlines()]
        at = [rows[0].index(name) for name in ("time", "q", "slip")]
        states = [[float(row[k]) for k in at] for row in rows[1:] if float(row[at[0]]) >= 3]
        assert (states[0][0], states[-1][0], len(states)) == (3, 5, 401 * len(s))
        lost = [0.0] * len(s)
        for k, ((_, q, slip), (_, later_q, later_slip)) in enumerate(zip(states, states[len(s):])):
            lost[k % len(s)] -= 0.5 * (later_q + q) * (later_slip - slip)
        return max(lost)

    found, before = got["cases"][0]["density_after"], got["cases"][0]["density_before"]
    near_relative(found, objective, 1e-9)
    near_relative(coated(*(zone["after"] for zone in got["chosen"][:2])), objective, 0.01)
    assert before > 1.5 * objective
    draw = random.Random(5)
    for _ in range(10):
        one, other = draw.uniform(0.1, 0.6), draw.uniform(0.1, 0.6)
        assert coated(one, other) > 0.99 * objective, (one, other)


def test_flat_and_radius_from_several_starts(run):
    """A rounded punch: nothing presses less than the uniform pressure of a free profile, the flat punch more; on few nodes bests
    among their neighbours are a per cent apart, and the least of them is kept."""
    got = run.line("design --profile rounded --most 3 --starts 3 --nodes 33")
    assert got["design"] == "optimal"
    objective = got["objective"]
    assert 0.5 < objective < 0.7
    assert len(got["starts"]) == 3
    for start in got["starts"]:
        near_relative(start["objective"], objective, 0.03)
        assert start["objective"] >= objective
        assert start["before"] > objective
    assert got["objective_at_start"] == got["starts"][0]["before"]
    # 1/R takes the flat punch away.
    flat = run.line("design --profile rounded --most 1e-9 --nodes 33")
    near(flat["objective"], got["cases"][0]["peak_before"], 1e-5)


@pytest.mark.rest
def test_counts_from_a_point_of_the_history_on(run):
    """From which point on a history counts is said by its time, and a time between two points is the same as the later one; before
    it begins, all of it."""
    hertz = "design --reduced problems/hertz.json --profile crown --most 0.001 --history 'P=0; P=1; Q=.24; Q=-.24; Q=.24' --goal "
    for goal, column in (("loss", "lost"), ("energy", "density")):
        got, point = (run.line(f"{hertz}{goal} --from {time}") for time in (2.5, 3))
        assert got["objective"] == point["objective"]
        near_relative(got["cases"][0][column + "_before"], got["objective_at_start"], 1e-9)
        near_relative(got["cases"][0][column + "_after"], got["objective"], 1e-9)
    whole, before = (run.line(f"{hertz}pressure --from {time}") for time in (0, -3))
    assert before["objective"] == whole["objective"]
    assert "must leave 2 points" in run.line(hertz + "loss --from 4", code=1).output


def test_sweeps_where_limits_hold(run):
    """Points of a sweep that limits do not allow are no better designs; loads whose sum stays are not swept one by one."""
    got = run.line("design --profile crown --curvature 0.3 --nodes 33 --lines 8")
    # Crowns are α x² + β x⁴, and their curvature 2α + 12 β x² is at most 0.3. A flatter one presses more at the ends, so α is 0.15.
    near(got["variables"][0], 0.15, 1e-6)
    assert got["best_of_lines"] <= 1e-6
    chosen = run.line("design --case problems/bolt_row.case.json --lines 8", code=1)
    assert "--lines does nothing in this run: it is not for --choose" in chosen.output


def test_first_start_without_equilibrium(run):
    """Friction of 0.4 does not hold Q = 0.5 P, friction of another start does: it is found, and nothing is said of a start that has
    no equilibrium."""
    got = run.line("design --reduced problems/hertz.json --history 'P=0; P=1; Q=.5; Q=-.5; Q=.5' --from 2 --goal loss "
                   "--coat '0.3 0.8' --starts 3 --lines 2")
    assert got["starts"][0]["design"] == "no equilibrium"
    assert got["starts"][0]["objective"] is None
    assert got["objective_at_start"] is None
    assert got["cases"][0]["lost_before"] is None
    near_relative(got["cases"][0]["lost_after"], got["objective"], 1e-9)


@pytest.mark.rest
def test_each_line_has_variables_of_its_own(run):
    """Two contacts side by side, each with a line of its own: each has its own zones, flat and crown, which are those that it has
    alone."""
    file = run.write("two_lines.json", json.dumps(twice(problem("hertz"))))
    history = " --history 'P=0; P=1; Q=.24; Q=-.24; Q=.24' --from 2 "
    for choice in ("--goal energy --coat '0.3 0.6' --zones 3", "--profile crown --powers '2 4' --most 0.01",
                   "--goal energy --profile rounded --most 0.01"):
        one, two = (run.line(f"design --reduced '{name}'" + history + choice) for name in ("problems/hertz.json", file))
        objective = one["objective"]
        near(two["objective_at_start"], one["objective_at_start"], 1e-9 * objective)
        near(two["objective"], objective, 1e-3 * objective)
        count = len(one["variables"])
        assert len(two["variables"]) == 2 * count
        assert two["chosen"][count]["variable"].startswith('line 2 ("other"), ')
    # Names with commas and quotes are one field of a table, and of the lines of a figure.
    run.line(f"design --reduced '{file}' --history 'P=0; P=1' --profile crown --powers 2 --most 0.001 --lines 1 --csv '{run.folder}/two'")
    for table in ("two_chosen.csv", "two_lines.csv"):
        assert '\n"line 2 (""other""), of power 2",' in run.text(table), table


@pytest.mark.parametrize("end", [0, 1])
def test_middle_of_half_a_line(run, end):
    """Half of a contact has its middle on the plane of symmetry: of a crown x² it is the end that stays, whichever that is."""
    half = problem("hertz")
    nodes = half["gap"]["rows"]
    half["gap"]["values"] = [0] * nodes
    ends = ["smooth", "smooth"]
    ends[end] = "axis"  # or plane of symmetry
    half["chains"][0]["ends"] = half["chains"][0]["other_ends"] = ends
    file = run.write("half_a_line.json", json.dumps(half))
    for profile in ("--profile crown --powers 2 --most 0.001", "--profile rounded --most 1e-4"):
        chosen = run.line(f"design --reduced '{file}' --history 'P=0; P=1' " + profile)["gap"]
        middle, other = (chosen[0], chosen[nodes - 1]) if end == 0 else (chosen[nodes - 1], chosen[0])
        assert middle == 0, profile
        assert other > 1e-5, profile


def test_sliding_says_at_which_load(run):
    """It slides where Q = f P, with the f = 0.4 of the file."""
    got = run.line("design --reduced problems/hertz.json --history 'P=0; P=1; Q=0.5'", code=2)
    near(got["event_loads"]["Q"], 0.4, 1e-6)
    near(got["event_time"], 1.8, 1e-5)
    assert "(P = 1, Q = 0.4)" in got.output

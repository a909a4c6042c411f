"""Limits of shakedown: values of the studies' notes, part A, and what is said of limits and marches."""

import json
import re

import pytest

from programs import meshes, near, near_relative, problem


def test_meets_its_references(run):
    got = run.line("shakedown -loads-over-friction -transposed -lower")
    # The studies' notes, part A. Extremes lie between the 201 nodes: second order in their spacing, of a part in two hundred.
    mesh = 7.5e-4
    got.meets({"corner opens at λ": (0.865, 0.002, mesh),
               "full adhesion, f at λ = 0.4": (0.7256, 3e-4, mesh),
               "full adhesion, f at λ = 0.6": (1.1045, 3e-4, mesh),
               "full adhesion, f at λ = 0.8": (1.5752, 3e-4, mesh),
               "corner decides up to λ": (0.2815, 3e-4, mesh),
               # "About": and the place of a flat maximum is of first order, half of the distance of the nodes there, 0.023.
               "x/a where the largest ratio is then": (0.635, 0.005, 0.012),
               "method 1, f": (0.8385, 1e-4, mesh),
               "exact limit, f": (0.805, 1e-3, 0),
               "exact with B transposed, f": (0.848, 5e-4, mesh),
               "method 2, least f": (0.783, 5e-4, mesh),
               "method 2, most f": (0.806, 5e-4, mesh),
               "exact, λ/f at R = -1, f = 0.85": (0.8040, 3e-4, mesh),
               "exact with B transposed, λ/f at R = -1, f = 0.85": (0.732, 5e-4, mesh),
               "exact, λ/f at R = -1, f = 1": (0.8059, 3e-4, mesh),
               "exact, λ/f at R = -0.5, f = 0.85": (0.9915, 5e-5, mesh),
               "method 1, λ/f at R = -1": (0.7273, 2e-4, mesh)})
    assert got["status"] == "certified"
    assert got["bound_lower"] <= got["friction_limit"] <= got["bound_upper"] <= got["bound_lower"] + 1e-6
    assert got["violation"] <= 0
    assert got["method2_low"] <= got["method2_high"]
    assert "closed" in got["limit_assumption"]
    assert got["friction_limit_of_the_mesh"] is False
    # An admissible slip can empty a corner: nothing is proven of the lower limit, and said so.
    assert "lower_limit" not in got.results
    assert "no bound" in got["lower_limit_statement"]


def test_solves_what_is_asked_for(run):
    """One programme for one limit; what else may be asked has options."""
    load = run.line("shakedown -nodes 33 -find load")
    assert load["counters"]["limit_solves"] == 1
    for key in ("load_ratio", "lower_limits_apart", "lower_limit"):
        assert key not in load.results
    # That it is a limit of some starts is said all the same.
    assert "some starts" in load["lower_limit_statement"]
    friction, both = run.line("shakedown -nodes 33 -find friction"), run.line("shakedown -nodes 33")
    assert "friction_limit_transposed" not in friction.results
    assert both["counters"]["limit_solves"] == friction["counters"]["limit_solves"] + 1
    # A ratio that is the limit just found is not found again.
    assert run.line("shakedown -nodes 33 -find load -loads-over-friction")["counters"]["limit_solves"] == 3


def test_marches_lose_what_the_references_say(run):
    # The finer mesh takes most of the time: ./test --all. Second order in the spacing.
    for nodes in meshes([101], [201]):
        got = run("shakedown", "-march", "-cycles", 140, "-nodes", nodes)
        mesh = 30 / nodes**2
        got.meets({"first loss from zero slip": (0.340, 1e-3, mesh),
                   # An optimal slip dissipates nothing.
                   "first loss from optimal slip": (0, 0, 1e-15),
                   "first loss from negative optimal slip": (0.827, 0.02 * 0.827, mesh)})
        assert got["marches"]
        for march in got["marches"]:
            # A few nodes at the trailing corner open in every cycle and slip for ever, unless the march starts from the optimal
            # slip: the loss of the others dies out.
            optimal = march["start"] == "optimal"
            assert march["outcome"] == ("shaken down" if optimal else "moves only at nodes that open")
            assert (march["opened_nodes"] == 0) == optimal
            assert march["opened_nodes"] < 10
            if not optimal:
                near(march["decay"], 0.885, 0.05)  # the resolved mesh's rate, 0.88 to 0.89 a cycle, with what corner nodes add


@pytest.mark.rest
def test_bound_and_march_name_what_they_are_of(run):
    """0.1 % above the bound for a contact that stays closed a march goes on slipping only at nodes that open, which the bound does
    not know."""
    got = run.line("shakedown -nodes 65 -friction 0.804 -find load -load-ratio -0.5 -march -cycles 170")
    assert got["load_limit_upper"] < 0.8
    assert "Where nodes open the bounds above do not apply" in got.output
    assert got["marches"]
    for march in got["marches"]:
        assert march["outcome"] == "moves only at nodes that open"
        assert march["opened_nodes"] > 0
        assert march["opened_loss"] > 0


def test_adhesion_map_ends_where_the_corner_opens(run):
    got = run.line("shakedown -nodes 129 -find friction -adhesion-map")
    # The trailing corner opens at λ = 0.865(2) (independent reference).
    assert {point["open"] for point in got["adhesion_map"]} == {True, False}
    for point in got["adhesion_map"]:
        opens = point["load_factor"] > 0.87
        assert point["open"] is opens, point
        assert (point["friction"] is None) == opens, point
    assert re.search(r" 0\.875 +open", got.output)
    # The forces of the corner's own node: 0.59 to 0.77, by the mesh; the tractions: 0.5431.
    assert 0.59 < got["corner_node_ratio"] < 0.77


@pytest.mark.rest
def test_only_dundurs_constants_of_a_block_and_its_plane_matter(run):
    """Three pairs with α = 0 and β = (1/(1-ν) - 1/(1-ν'))/4 = -1/16: by Dundurs' theorem one and the same contact. The differences
    are the mesh's, a tenth of its own error of 30/64²."""
    rows = []
    for block, plane in ((0, 0.2), (0.2, 1 / 3), (1 / 3, 3 / 7)):
        got = run("shakedown", "-nodes", 65, "-find", "load", "-poisson", repr(block), "-mismatch", 1, "-mismatch-poisson", repr(plane))
        row = got["mismatch"][0]
        rows.append(row)
        near(row["alpha"], 0, 1e-15)
        near(row["beta"], -1 / 16, 1e-15)
        for key in ("friction_limit", "load_limit", "load_limit_reversed"):
            near(row[key], rows[0][key], 7e-4)
        near_relative(row["coupling"], rows[0]["coupling"], 7e-3)
    # Another β is another contact, and a soft plane under a block is two half-planes' |β|.
    other = run.line("shakedown -nodes 65 -find load -mismatch '1e-4 1' -mismatch-poisson '0 0.2'")["mismatch"]
    assert abs(other[2]["load_limit"] - rows[0]["load_limit"]) > 5e-3
    for row, beta in zip(other, (0.5, 0.375)):
        near(row["beta"], beta, 2e-4)  # (1-2ν)/(2-2ν) on a rigid block
        near(row["coupling"], row["beta"], 0.02)


@pytest.mark.parametrize("friction, by_corner", [(0.3, True), (0.5, True), (0.6, False), (0.85, False)])
def test_says_which_limits_are_of_the_mesh(run, friction, by_corner):
    """Below the corner's ratio of tractions, 0.5431, the corner decides; above, the inside does."""
    got = run("shakedown", "-nodes", 65, "-find", "load", "-load-ratio", -1, "-friction", friction)
    assert got["load_limit_of_the_mesh"] is by_corner
    assert ("no limit of the bodies" in got.output) == by_corner


def test_limit_of_a_saved_block_on_a_rigid_plane(run):
    """README's: decided inside the contact, so that it converges with the mesh."""
    file, limits = run.folder / "block.json", []
    for nodes in (51, 101, 201):
        run("square_punch", "-obstacle", "rigid", "-nodes", nodes, "-save", file)
        got = run("shakedown", "-reduced", file, "-friction", 0.8, "-find", "load", "-load-ratio", -1)
        assert got["load_limit_of_the_mesh"] is False
        limits.append(got["load_limit"])
    near_relative(limits[1], limits[2], 2e-3)
    assert abs(limits[2] - limits[1]) < 0.5 * abs(limits[1] - limits[0])


def test_other_laws_of_friction_have_a_largest_load(run):
    """A block on a half-plane has a law of friction that bends. The expected limits are those of a linear programme of the saved matrices
    (slip of the nodes and λ; at both ends of the cycle p >= 0 and -0.75 p, -(0.4 w + 0.25 p) <= q <= the same or 0.5 p, w the
    weights), solved by HiGHS."""
    file = run.folder / "law.json"
    of_file, law = f"-reduced '{file}' ", "-strength '.8 .6 2 .9' "

    def limit(options):
        got = run.line("shakedown " + options)
        assert got["load_limit_status"] == "certified"
        return got["load_limit"]

    near(limit(f"-nodes 33 -find load {law} -save '{file}'"), 0.44296957130609, 1e-8)
    near(limit(of_file), 0.44296957130609, 1e-8)
    near(limit(of_file + "-load-ratio -1 -strength-backward '1 .5' " + law), 0.35052341700053, 1e-8)
    # Coulomb's takes its place only where it is said.
    coulomb = "-find load -friction 0.5 -nodes 33"
    near(limit(of_file + "-find load -friction 0.5"), limit(coulomb), 1e-10)
    run.line(f"shakedown {coulomb} -save '{file}'")
    near(limit(of_file), limit(coulomb), 1e-10)
    for options, words in (("-find friction", "must be load"), ("-map", "knows Coulomb's law alone"), ("-friction 0.3", "two laws of friction"),
                           ("-strength-backward '1 .5 2 2'", "steeper")):
        assert words in run.line(f"shakedown -nodes 9 {law} {options}", code=1).output
    several = problem(file)
    several["friction"]["values"][0] = 0.4
    run.write("law.json", json.dumps(several))
    assert "from 0.4 to 0.5" in run.line("shakedown " + of_file, code=1).output
    several["friction"]["values"] = [0] * len(several["friction"]["values"])
    run.write("law.json", json.dumps(several))
    assert "has no friction" in run.line("shakedown " + of_file, code=1).output


@pytest.mark.rest
def test_converges_with_the_mesh(run):
    words = "shakedown -find friction -nodes 65 -mesh-study '65 129 257'"
    got = run.line(words + " -domain 1e4")
    study = got["mesh_study"]
    # Second order in the size of the elements: differences fall by about four.
    coarse, middle, fine = (row["load_limit_reversed"] for row in study)
    assert 3 < (middle - coarse) / (fine - middle) < 5
    near((fine + (fine - middle) / 3) / 0.85, 0.8040, 3e-4)
    # The degree of coupling does not follow the number of nodes.
    near(study[0]["coupling"], study[2]["coupling"], 0.01)
    # Without a mesh below there is less error on each mesh of the block.
    itself = [row["load_limit_reversed"] / 0.85 for row in run.line(words)["mesh_study"]]
    for one, other in zip(itself, (coarse, middle, fine), strict=True):
        assert abs(one - 0.8040) < abs(other / 0.85 - 0.8040) + 5e-5
    near(itself[2], 0.8040, 3e-4)


def test_lower_limit_is_proven_for_little_friction(run):
    got = run.line("shakedown -nodes 65 -find load -friction 0.55 -starts 2 -cycles 60")
    assert 0 < got["lower_limit"] < got["load_limit"]
    # No march contradicts it.
    assert got["quiet_up_to"] >= got["lower_limit"]


def test_lower_limit_but_for_the_corners_is_proven(run):
    got = run.line("shakedown -nodes 33 -find load -lower -starts 4 -cycles 60")
    apart = got["lower_limits_apart"]
    assert len(apart) >= 3
    # The more nodes are exempt, the more is proven of the rest.
    proven = [0] + [row["load_factor"] for row in apart]
    assert all(less < more for less, more in zip(proven, proven[1:])), proven
    assert proven[-1] <= got["load_limit"]
    # With the least pressures of each vertex by HiGHS, linear programmes of their own, the condition holds at the vertices up to
    # 0.251 and 0.624. It must hold between them too, with multipliers that are the same for all loads: a sixth less.
    for distance, sharpest in ((0.005, 0.2514), (0.02, 0.6245)):
        row, = [row for row in apart if abs(row["distance"] - distance) < 1e-9]
        assert 0.83 * sharpest < row["load_factor"] <= sharpest
    # Corner nodes open and slip on from some starts, far below.
    assert 0 < got["opens_at"] < 0.2


def test_reads_what_it_saves(run):
    file = run.folder / "study.json"
    punch = run.line(f"shakedown -domain 1e4 -nodes 33 -save '{file}'")
    saved = run("shakedown", "-reduced", file)
    for key in ("friction_limit", "load_limit"):
        assert punch[key] == saved[key]
    # A contact that stays closed everywhere is its own closed part.
    closed = run.line(f"shakedown -reduced '{file}' -closed -lambda-max 0.2 -load-ratio -0.5")
    assert closed["closed_nodes"] == 33
    # The part is a problem of its own, whose sums are rounded elsewhere.
    near(closed["load_limit"], saved["load_limit"], 1e-13)


def test_limit_of_a_saved_lap_joint(run):
    """Pinched and pulled: the contact recedes. Below the limit the whole joint, whose open nodes are free to close, shakes down from
    the optimal slip; above it does not."""
    file, limits = run.folder / "joint.json", []
    for spacing in (0.04, 0.02):
        joint = run("lap_joint", "-load", 0.01, "-increments", 5, "-spacing", spacing, "-save", file)
        got = run.line(f"shakedown -reduced '{file}' -held 'bolt 1, w = 1' -cycled T -closed -find load -friction 0.2 "
                       "-lambda-max 0.01 -load-ratio 0 -cycles 30")
        assert got["closed_nodes"] < joint["contact_nodes"]
        assert got["smallest_open_gap"] >= 0
        assert [march["outcome"] for march in got["whole_contact"]] == ["shaken down", "cyclic slip"]
        # Stuck shear is singular at a receding edge: no mesh has the last word, and it says so.
        assert got["load_limit_of_the_mesh"] is True
        assert "no limit of the bodies" in got.output
        limits.append(got["load_limit"])
    coarse, fine = limits
    assert coarse > 0
    assert fine < 0.75 * coarse


@pytest.mark.parametrize("options", ["-friction 0", "-lambda-max -1", "-load-ratio 2", "-find all", "-left-out 0.7", "-held X -nodes 9",
                                     "-reduced missing.json"])
def test_refuses_bad_options(run, options):
    run.refuses("shakedown", options.split(), [])


def test_where_nothing_sticks_is_an_outcome(run):
    """Nothing sticks under a pull: an outcome, not an error."""
    run.line("shakedown -nodes 9 -held Q -cycled P", code=2)


def test_marches_that_slide_say_at_which_loads(run):
    """A body that P presses slides where Q is f P: the outcome of the marches is that of the run, whatever is proven of the
    limit."""
    got = run.line("shakedown -nodes 41 -find load -friction 0.85 -march -cycles 3 -lambda-max 0.9", code=2)
    assert got["load_limit_status"] == "certified"
    assert got["status"] == "gross sliding"
    assert "from zero, optimal, negative optimal slip" in got["message"]
    near(got["event_loads"]["Q"], 0.85, 1e-6)  # bisection, to a millionth
    assert len(got["marches"]) == 3
    for march in got["marches"]:
        assert march["event_loads"]["P"] == 1
        near(march["event_loads"]["Q"], 0.85, 1e-6)
    assert "(P = 1, Q = 0.85): the loads exceed" in got.output


def test_three_saved_loads_need_a_name(run):
    """Of many loads nobody knows which one is cycled."""
    run.refuses("shakedown", ["-reduced", "problems/bolt_row.json"], ["bolt_row.json' has the loads", "option --cycled must name"])

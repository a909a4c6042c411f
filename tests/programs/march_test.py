"""Marches of saved reduced problems."""

import json

import pytest

from programs import ROOT, alike, near

HERTZ = ["march", "-reduced", "problems/hertz.json"]


def test_a_run_cut_in_two_leaves_the_same_files(run):
    """Cut in two it leaves the files of one that was not, and the same results, to what round-off is of a path whose factor is made
    anew where it is taken up."""
    state = run.folder / "state.json"

    def march(name, history, *words):
        return run(*HERTZ, "-csv", run.folder / name, "-history", "P=0; P=1; Q=.2" + history, *words)

    whole = march("whole", "; Q=-.2", "-frames", "1.5 2 2.5")
    march("cut", "", "-frames", 1.5, "-save-state", state)
    second = march("cut", "; Q=-.2", "-frames", 2.5, "-load-state", state)
    for table in ("_history.csv", "_nodes.csv", "_zones_in_time.csv"):
        one, other = run.columns("cut" + table), run.columns("whole" + table)
        assert list(one) == list(other) and len(run.text("cut" + table)) > 5000
        for name in one:
            if name in ("residual_normal", "residual_tangential", "round_off"):
                continue  # each of its own way, and judged when it is accepted
            assert len(one[name]) == len(other[name])
            if all(isinstance(value, float) for value in one[name] + other[name]):
                alike(one[name], other[name], 1e-12 * max(map(abs, one[name])))
            else:
                assert one[name] == other[name], (table, name)
    assert [{**zone, "from": 0, "to": 0} for zone in second["zones"]] == [{**zone, "from": 0, "to": 0} for zone in whole["zones"]]
    near(second["total_dissipation"] / whole["total_dissipation"], 1, 1e-12)
    # Under another name there is nothing of the first part to go on with.
    begins = "Zones in time begin at 2,"
    assert begins not in second.output
    alone = march("alone", "; Q=-.2", "-load-state", state)
    assert begins in alone.output
    assert "The table of cycles begins" not in alone.output
    # Nor of its cycles.
    cycled = "; Q=-.2; Q=.2"
    march("cycled", cycled, "-cycle-start", 2, "-cycles", 1, "-save-state", state)
    (run.folder / "cycled_cycles.csv").unlink()  # it was killed before it wrote them
    two = march("cycled", cycled, "-cycle-start", 2, "-cycles", 3, "-load-state", state)
    assert "The table of cycles begins after cycle 1," in two.output


def test_a_load_on_held_nodes_has_no_loop(run):
    """Forces on held nodes, of which round-off has left the reduced problem something, have no loop; the others have theirs."""
    problem = json.loads((ROOT / "problems/hertz.json").read_text(encoding="utf-8"))
    held = json.loads(json.dumps(problem["patterns"][0]))
    held["name"] = "held"
    for forces in ("q", "p"):
        held[forces]["values"] = [1e-17 * force for force in held[forces]["values"]]
    problem["patterns"].append(held)
    H, left = problem["H"]["values"], 3e-19
    problem["H"] = {"rows": 3, "cols": 3, "values": [H[0], H[1], left, H[2], H[3], left, left, left, left]}
    got = run("march", "-reduced", run.write("held.json", json.dumps(problem)), "-cycle-start", 1, "-cycles", 2,
              "-history", "P=0; P=1; P=1 Q=.2 held=1; P=1 Q=-.2 held=-1; P=1 Q=0 held=0")
    assert "load held does no work in a cycle" in got.output
    cycle = got["cycles"][-1]
    assert cycle["work held"] == 0 and cycle["stiffness held"] is None and cycle["loss_factor held"] is None
    assert cycle["stiffness Q"] > 0
    near(cycle["work Q"] / cycle["dissipation"], 1, 0.01)


def test_a_cycle_that_is_taken_up_within_is_left_out(run):
    """Of a cycle within which a march is taken up the record has the rest alone: it is left out, and those after it are the same
    as of a march that was not cut."""
    words = ["march", "-reduced", "problems/square_punch.json", "-increments", 20]
    loads, cycles = "P=0; P=1; Q=.16; Q=-.16", ["-cycle-start", 2, "-cycles", 4]
    state = run.folder / "state.json"
    whole = run(*words, "-history", loads + "; Q=.16", *cycles)
    run(*words, "-history", loads, "-save-state", state)
    second = run(*words, "-history", loads + "; Q=.16", *cycles, "-load-state", state)
    assert len(whole["cycles"]) > 1
    assert (whole["first_cycle"], second["first_cycle"]) == (1, 2)
    assert second["cycles"] == whole["cycles"][1:]
    assert "the march began within cycle 1" in second.output


def test_methods_agree(run):
    """The thesis' method node by node comes to the forces of the other, which it shares no step with."""
    words = ["march", "-reduced", "problems/square_punch.json", "-history", "P=0; P=1; Q=0.1", "-increments", 5, "-frames", "all",
             "-csv", run.folder / "out"]
    automatic, sweeps = run(*words, "-stepping", "fixed"), run(*words, "-method", "gauss-seidel")
    assert sweeps["counters"]["dense_factorisations"] == 0
    assert sweeps["counters"]["sweeps"] > 100
    for key in ("normal_force", "tangential_force", "total_dissipation"):
        near(sweeps[key], automatic[key], 1e-8 * abs(automatic[key]))
    # It says where it was not given enough of them.
    assert run(*words, "-method", "gauss-seidel", "-max-sweeps", 2, code=2)["status"] == "stalled"


@pytest.mark.parametrize("options, words", [
    ([], ["option reduced", "must name"]),
    (["-reduced", "nowhere.json"], ["cannot read", "nowhere.json"]),
    (["-reduced", "meshes/dovetail.json"], ["dovetail.json", "not a reduced problem"]),
    ([*HERTZ[1:], "-friction", -1], ["option --friction", "-1", "not be negative"]),
    ([*HERTZ[1:], "-method", "newton"], ["option --method", "'newton'", "gauss-seidel"]),
    ([*HERTZ[1:], "-tolerance", 0], ["option --tolerance", "positive"]),
    ([*HERTZ[1:], "-history", "P=0; R=1"], ["history 'R=1'", "there is no load 'R'", "P, Q"]),
    ([*HERTZ[1:], "-frames", 2], ["frames", "time 2", "from 0 to 1"]),
    ([*HERTZ[1:], "-load-state", "problems/hertz.json"], ["problems/hertz.json"]),
    ([*HERTZ[1:], "-save", "problems/hertz.json"], ["--save", "name another"]),
])
def test_bad_input_is_one_sentence(run, options, words):
    run.refuses("march", options, words)


def test_laws_of_friction_that_bend_or_differ_by_way(run):
    """Of a punch with a shear strength that ends no node bears more, and its corners bear that; one way more than the other where
    it is said; and Q is carried all the same."""
    def shears(time, *law):
        got = run("march", "--reduced", "problems/punch_on_half_plane.json", "--history", "P=0; P=1; Q=0.25; Q=-0.25",
                  "--csv", run.folder / "m", "--frames", 2, *law)
        near(got["tangential_force"], 0.25, 1e-10)
        nodes = run.columns("m_nodes.csv")
        assert list(nodes) == "time,node,arc_length,x,y,state,p,q,slip,opening".split(",")
        found = [(p, q) for at, p, q in zip(nodes["time"], nodes["p"], nodes["q"]) if at == time]
        assert len(found) == 41
        return found

    bent = shears(3, "--strength", "0.75 0.3 1 0.3")
    for p, q in bent:
        assert abs(q) <= min(0.4 * p, 0.3) + 1e-9
    near(max(q for _, q in bent), 0.3, 1e-9)
    ways = ["--strength", "1 0.4", "--strength-backward", "1 0.28"]
    near(max(-q / p for p, q in shears(2, *ways)), 0.4, 1e-9)
    near(max(q / p for p, q in shears(3, *ways)), 0.28, 1e-9)
    for options, words in ((["--strength", "1 0.4 2"], "in turn"), (["--strength", "1 0.4", "--friction", 0.3], "two laws of friction"),
                           (["--strength-backward", "1 0.4"], "goes with --strength"), (["--strength", "2 0.4 1 0.5"], "the pressure must increase")):
        assert words in run(*HERTZ, "--history", "P=0; P=1", *options, code=1).error


def test_cycles_that_are_not_steady_are_called_so(run):
    """The first cycle of a shear on what was only pressed leaves slip that was not there before."""
    loads = [*HERTZ, "-history", "P=0; P=1; Q=0.1; Q=-0.1; Q=0", "-cycle-start", 1, "-cycles"]
    assert "not steady after cycle 1" in run(*loads, 1).output
    more = run(*loads, 4).output
    assert "not steady" not in more and "steady from cycle" in more


def test_a_loop_that_loses_nothing_has_no_loss_factor(run):
    """Equal bodies that are pressed and let go as far as 0.5 lose nothing (B = 0), and a loop that encloses nothing has no loss
    factor; the secant of the load is that of its elastic way."""
    got = run(*HERTZ, "-cycle-start", 1, "-cycles", 2, "-history", "P=0; P=1; P=0.5; P=1")
    for cycle in got["cycles"]:
        assert cycle["work P"] == cycle["external_work"] == 0
        assert cycle["loss_factor P"] is None and cycle["stiffness P"] > 0


def test_is_steady_from_the_same_cycle_wherever_it_was_cut(run):
    """Equal bodies in partial slip are steady from the first cycle on; a march that is cut after it says the same as one that is
    not, also where nothing is left of it."""
    words = [*HERTZ, "-history", "P=0; P=1; Q=.2; Q=-.2; Q=.2", "-cycle-start", 2, "-cycles"]
    state = run.folder / "steady.json"
    assert run(*words, 4)["steady_cycle"] == 1
    run(*words, 1, "-save-state", state)
    for cycles in (4, 1):
        rest = run(*words, cycles, "-load-state", state)
        assert rest["steady_cycle"] == rest["steady_period"] == 1
        assert ("nothing was left to march" in rest.output) == (cycles == 1)


def test_increments_that_stall_are_said_to_be_passed_only_where_they_are(run):
    """Sweeps that are too few find no increment, however short."""
    got = run(*HERTZ, "-history", "P=0; P=1; Q=0.2", "-method", "gauss-seidel", "-max-sweeps", 1, code=2)
    assert got["event_time"] == 0
    assert "increments stalled and shorter ones were tried" in got.output
    assert "passed by shorter" not in got.output

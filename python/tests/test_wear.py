"""Wear against closed forms, and what a script can do with it."""

import copy
import os
import pickle
import signal
import threading
import warnings

import cattaneo
import numpy as np
import pytest
from cattaneo import wear

k, friction, kt, P, d = 1e-3, 0.5, 2.0, 3.0, 2.0


def sliders(nodes=2):
    """Nodes on springs kt of their own, beneath a block that P presses on all of them alike whatever they wear; the
    block moves by d."""
    ones, none = np.ones(nodes), np.zeros(nodes)
    return cattaneo.ReducedProblem(
        kt * np.eye(nodes),
        np.zeros((nodes, nodes)),
        np.eye(nodes) - np.full((nodes, nodes), 1 / nodes),
        [cattaneo.LoadPattern("P", none, ones), cattaneo.LoadPattern("d", -kt * ones, none, control="displacement")],
        friction=friction,
        weights=1.0,
        arc_length=np.arange(nodes),
    )


def history(problem, held, swept):
    points = [{}, held] + [{name: s * value for name, value in swept.items()} for s in (1, -1, 1)]
    return cattaneo.LoadHistory.through(problem, points, cycle_start=2)


def way(cycles):
    """Slip path of a slider after these cycles: d - f P/kt to the first turning point, four times that in each cycle."""
    return (4 * cycles + 1) * (d - friction * P / kt)


@pytest.fixture(scope="module")
def block():
    problem = sliders()
    return problem, history(problem, {"P": P}, {"d": d})


@pytest.mark.parametrize("tolerance", [0, 1e-3])
def test_sliders_by_hand(block, tolerance):
    """Depth = k p times the way, energy = f P times the way of each, marched or jumped over."""
    problem, loads = block
    report = wear.wear(problem, wear.WearLaw.uniform(problem, k), loads, 400, settings=wear.WearSettings(tolerance=tolerance))
    assert report.converged and (report.jumps > 0) == (tolerance > 0)
    assert report.state.depth == pytest.approx([k * P * way(400)] * 2, rel=1e-10)
    assert report.state.dissipation == pytest.approx([friction * P * way(400)] * 2, rel=1e-10)
    assert report.volume[-1] == pytest.approx(2 * k * P * way(400), rel=1e-10)
    assert report.cycles[-1] == report.state.cycles == 400
    assert report.covered.sum() == 400 and (report.marched >= 400) == (tolerance == 0)
    assert report.loss[-1] == pytest.approx(2 * friction * P * (way(1) - way(0)), rel=1e-10)
    assert report.last.converged and "400 cycles" in repr(report)


def test_law(block):
    """A threshold takes its share of the pressure off; k of the energy is f times k; an interface that is not there is
    named."""
    problem, loads = block
    for law, factor in (
        (wear.WearLaw([k, k], threshold=1.0), (P - 1) / P),
        (wear.WearLaw([k, k], of_energy=True), friction),
    ):
        report = wear.wear(problem, law, loads, 3)
        assert report.state.depth == pytest.approx([factor * k * P * way(3)] * 2, rel=1e-12)
    law = wear.WearLaw.uniform(problem, k)
    with pytest.raises(cattaneo.InputError, match="no interface 'lap'"):
        law.set(problem, "lap", 1.0)
    for coefficient in (-k, [k, k, k]):
        with pytest.raises(cattaneo.InputError, match="wear law|must be one for each"):
            wear.wear(problem, wear.WearLaw(np.broadcast_to(coefficient, np.shape(coefficient) or 2)), loads, 1)
    marched = cattaneo.march(problem, loads, settings=cattaneo.MarchSettings(increments=3), keep_states=True).states
    depth = sum(wear.worn_depth(problem, law, a, b) for a, b in zip(marched, marched[1:]))
    assert depth[0] == pytest.approx(k * P * way(1), rel=1e-12)
    assert wear.worn_volume(problem, depth) == pytest.approx(2 * depth[0])


@pytest.fixture(scope="module")
def hertz():
    """A parabola on a half-plane of the same material: a = P = R = 1, f = 1/2, Q = ± f P/2, finer at the ends of
    stick."""
    c, most = np.sqrt(0.5), 1.29
    inner = c - c * np.linspace(1, 0, 31) ** 1.8
    x = np.concatenate([inner, c + (most - c) * np.linspace(0, 1, 21)[1:] ** 1.8])
    material = cattaneo.Material(8 / np.pi * 0.91, 0.3)
    upper = cattaneo.HalfPlane(material, depth=1e4, normal=(0, 1), forces={"P": (0, -1), "Q": (1, 0)})
    body = cattaneo.condense(upper, np.concatenate([-x[:0:-1], x]), order=2)
    problem = cattaneo.reduce(body, cattaneo.HalfPlane(material, depth=1e4)).problem
    problem.gap = problem.position[:, 0] ** 2 / 2
    problem.friction = friction
    return problem, history(problem, {"P": 1.0}, {"Q": 0.25})


def test_worn_out_parabola(hertz):
    """Ciavarella and Hills (1999): stick keeps its half-width c = a √(1 - Q/fP), and bears all of P."""
    problem, loads = hertz
    end = wear.worn_out(problem, loads, settings=cattaneo.MarchSettings(increments=1))
    assert end.converged and end.loss < 1e-8
    x, c = problem.position[:, 0], np.sqrt(0.5)
    assert abs(x[end.stick]).max() == pytest.approx(c, abs=2e-3)
    ratio = np.maximum(abs(x) / c, 1)
    depth = 0.25 * np.arccosh(ratio) - 0.5 * c**2 * (ratio * np.sqrt(ratio**2 - 1) - np.arccosh(ratio))
    assert end.depth == pytest.approx(np.maximum(depth, 0), abs=0.01 * 0.1127331)
    assert wear.worn_volume(problem, end.depth) == pytest.approx(0.0726252, rel=0.01)
    amid = abs(x) < 0.9 * c
    root = np.sqrt(c**2 - x[amid] ** 2)
    p = cattaneo.readout.tractions(problem, end.contact.p)[amid]
    assert p == pytest.approx(2 / np.pi * root + 0.5 / (np.pi * root), rel=0.01)
    assert (end.slip_range[end.stick] < 1e-8).all() and end.slip_range.max() > 1e-3


@pytest.mark.rest
def test_volume_is_that_of_the_energy(hertz):
    """k/f times the energy lost, at every moment; and the way there ends in what worn_out() finds. No cycle wears so
    much that its own update is implicit: such cycles are all marched."""
    problem, loads = hertz
    law = wear.WearLaw.uniform(problem, 0.01)
    report = wear.wear(problem, law, loads, 2000, settings=wear.WearSettings(march=cattaneo.MarchSettings(increments=1), tolerance=1e-2))
    assert report.jumps > 0 and report.implicit_cycles == 0
    assert report.volume == pytest.approx(0.01 / friction * report.dissipation, rel=1e-9)
    end = wear.worn_out(problem, loads, settings=cattaneo.MarchSettings(increments=1))
    assert report.state.depth == pytest.approx(end.depth, abs=0.02 * end.depth.max())


def test_states_are_values_and_go_on_to_the_last_bit(block, tmp_path):
    problem, loads = block
    law = wear.WearLaw.uniform(problem, k)
    whole = wear.wear(problem, law, loads, 7).state
    half = wear.wear(problem, law, loads, 3).state
    cattaneo.save(half, tmp_path / "worn.json")
    for state in (half, wear.load_wear_state(tmp_path / "worn.json"), copy.deepcopy(half), pickle.loads(pickle.dumps(half))):
        rest = wear.wear(problem, law, loads, 7, state)
        assert np.array_equal(rest.state.depth, whole.depth) and np.array_equal(rest.state.contact.v, whole.contact.v)
        assert state.cycles == 3
    made = wear.WearState(half.contact, half.depth, half.dissipation, half.cycles)
    assert np.array_equal(wear.wear(problem, law, loads, 7, made).state.depth, whole.depth)


def test_watched_stopped_and_interrupted(block):
    problem, loads = block
    law = wear.WearLaw.uniform(problem, k)
    seen = []
    report = wear.wear(problem, law, loads, 5, observer=lambda state, record: seen.append((state, record)))
    assert [record.cycles for _, record in seen] == list(report.cycles)
    assert seen[-1][0].depth == pytest.approx(report.state.depth, rel=0)
    stop = threading.Event()
    threading.Timer(0.3, stop.set).start()
    stopped = wear.wear(problem, law, loads, 10**9, stop=stop)
    assert stopped.status == "stopped" and 0 < stopped.state.cycles < 10**9
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        wear.wear(problem, law, loads, 10**9)

    def refuse(state, record):
        raise KeyError("seen")

    with pytest.raises(KeyError, match="seen"):
        wear.wear(problem, law, loads, 5, observer=refuse)
    assert wear.worn_out(problem, history(problem, {"P": P}, {"d": 0.5}), stop=stop).status == "stopped"


def test_outcomes(block):
    """A slider that slips as a whole wears for ever."""
    problem, loads = block
    with pytest.warns(cattaneo.OutcomeWarning, match="worn_out: gross sliding"):
        assert not wear.worn_out(problem, loads).converged
    with pytest.raises(cattaneo.InputError, match="the load history has no cycle"):
        wear.wear(problem, wear.WearLaw.uniform(problem, k), cattaneo.LoadHistory.through(problem, [{}, {"P": 1}]), 5)


@pytest.mark.parametrize("tolerance", [0, 0.1, 1e-3])
def test_states_are_those_of_the_worn_contact(tolerance):
    """Two nodes that stay closed while they are dragged to and fro: p = 1 - C depth, marched or jumped over."""
    C = np.linalg.inv(np.array([[1.0, 0.3], [0.3, 1.0]]))
    patterns = [
        cattaneo.LoadPattern("P", np.zeros(2), np.ones(2)),
        cattaneo.LoadPattern("D", C @ np.ones(2), np.zeros(2), control="displacement"),
    ]
    problem = cattaneo.ReducedProblem(C, np.zeros((2, 2)), C, patterns, friction=0.3, weights=np.ones(2), arc_length=[0.0, 1.0])
    seen = []
    report = wear.wear(
        problem,
        wear.WearLaw.uniform(problem, 1e-4),
        history(problem, {"P": 1.0}, {"D": 1.0}),
        2000,
        settings=wear.WearSettings(tolerance=tolerance),
        observer=lambda state, record: seen.append(state),
    )
    assert report.reached and report.remark == ""
    for state in [*seen, report.state]:
        assert state.contact.p == pytest.approx(1 - C @ state.depth, abs=1e-12)
        assert state.contact.w == pytest.approx(-state.depth, abs=1e-12)


@pytest.mark.parametrize("tolerance", [0, 1e-3])
def test_a_worn_gap_without_an_equilibrium_is_warned_of(tolerance):
    """Two nodes that a spring kt joins, on springs of 1 across. Q pushes the first, which slips and wears; the second
    sticks, and bears Q - f p of the first. Both slide where that is more than f: once the first has worn by more than
    2 - Q/f, which the recurrence of its depth says by hand."""
    stiffness, f, Q, k = 1.0, 0.5, 0.8, 0.02
    problem = cattaneo.ReducedProblem(
        stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]]),
        np.zeros((2, 2)),
        np.eye(2),
        [cattaneo.LoadPattern("P", np.zeros(2), np.ones(2)), cattaneo.LoadPattern("Q", [1.0, 0.0], np.zeros(2))],
        friction=f,
        weights=1.0,
        arc_length=[0.0, 1.0],
    )
    depth = [k * (Q - f) / stiffness]
    before = 1.0
    while 1 - depth[-1] > Q / f - 1:
        p = 1 - depth[-1]
        way = 0.5 * (before + p) * f * (before - p) + 4 * p * (Q - f * p)
        depth.append(depth[-1] + k * way / stiffness)
        before = p
    last = len(depth) - 1
    loads = history(problem, {"P": 1.0}, {"Q": Q})
    law = wear.WearLaw.uniform(problem, k)
    settings = wear.WearSettings(tolerance=tolerance, march=cattaneo.MarchSettings(stepping="exact"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert wear.wear(problem, law, loads, last - 1, settings=settings).remark == ""
    with pytest.warns(cattaneo.OutcomeWarning, match=f"after cycle {last} no equilibrium was found at the worn gap"):
        report = wear.wear(problem, law, loads, last, settings=settings)
    assert report.converged and report.reached and report.state.cycles == last
    assert report.state.depth == pytest.approx([depth[-1], 0], abs=1e-12)
    assert report.state.contact.p == pytest.approx([1 - depth[-2], 1], abs=1e-12)


def test_worn_out_says_that_a_march_may_end_elsewhere(hertz):
    problem, loads = hertz
    assert "may be another" in wear.worn_out.__doc__
    assert "a march may end elsewhere" in repr(wear.worn_out(problem, loads, settings=cattaneo.MarchSettings(increments=1)))

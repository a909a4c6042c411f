"""Marches of the public problems, and what a script can do with one: resume, watch, stop, interrupt, run in threads."""

import concurrent.futures
import copy
import json
import os
import pickle
import signal
import threading
import time

import cattaneo
import numpy as np
import pytest


def slow_march(problem, **options):
    """Minutes of work, if nobody stops it."""
    P = {"P": 1.0}
    history = cattaneo.LoadHistory.through(
        problem, [{}, P, {"Q": 0.2}, {"Q": -0.2}, {"Q": 0.2}], cycle_start=2, cycles=10**6
    )
    settings = cattaneo.MarchSettings(increments=100, stop_at_steady_state=False)
    return cattaneo.march(problem, history, settings=settings, **options)


@pytest.fixture
def hertz(root):
    return cattaneo.load_reduced_problem(root / "problems" / "hertz.json")


@pytest.mark.parametrize(
    "name", ["square_punch", "punch_on_half_plane", "hertz", "receding_strip", "lap_joint", "wedge"]
)
def test_public_problems_have_their_solutions(root, name):
    """problems/check.py judges these solutions by the laws alone."""
    problem = cattaneo.load_reduced_problem(root / "problems" / f"{name}.json")
    solution = json.loads((root / "problems" / f"{name}.solution.json").read_text())
    points = [dict(zip(problem.loads, increment["multipliers"])) for increment in solution["increments"]]
    report = cattaneo.march(
        problem,
        cattaneo.LoadHistory.through(problem, [{}] + points),
        settings=cattaneo.MarchSettings(increments=1, stepping="fixed"),
        keep_states=True,
    )
    stored = {key: np.array([i[key] for i in solution["increments"]]) for key in "vwqp"}
    length = max(abs(stored["v"]).max(), abs(stored["w"]).max())
    for key, scale in (("v", length), ("w", length), ("q", abs(stored["p"]).max()), ("p", abs(stored["p"]).max())):
        marched = np.array([getattr(state, key) for state in report.states])
        assert abs(marched - stored[key]).max() < 1e-8 * scale, key


def test_a_march_is_resumed_to_the_last_bit(hertz, tmp_path):
    points = [{}, {"P": 1}, {"P": 1, "Q": 0.2}]
    whole = cattaneo.march(hertz, points)
    half = cattaneo.march(hertz, points[:2])
    cattaneo.save(half.state, tmp_path / "state.json")
    state = cattaneo.load_contact_state(tmp_path / "state.json")
    rest = cattaneo.march(hertz, cattaneo.LoadHistory.through(hertz, points), state)
    assert state.time == 1 and rest.state.time == 2
    for key in "vwqp":
        assert np.array_equal(getattr(whole.state, key), getattr(rest.state, key))
    assert np.array_equal(np.concatenate([half.time, rest.time]), whole.time)


def test_points_go_on_from_where_the_state_stands(hertz):
    """And from nowhere else: loads that jump would be another path."""
    points = [{}, {"P": 1}, {"P": 1, "Q": 0.2}]
    half = cattaneo.march(hertz, points[:2])
    rest = cattaneo.march(hertz, [half.loads, points[2]], half.state)
    assert rest.loads == points[2] and rest.state.time == 2
    assert np.array_equal(rest.state.v, cattaneo.march(hertz, points).state.v)
    with pytest.raises(cattaneo.InputError, match="load 'P' is 0 at its first point, and 1 in the state"):
        cattaneo.march(hertz, [{"P": 0}, *points[1:]], half.state)
    # A load that the first point does not name is that of the state, and keeps it.
    same = cattaneo.march(hertz, [{}, {"Q": 0.2}], half.state)
    assert same.loads == points[2] and np.array_equal(same.state.v, rest.state.v)
    for history in ([{"P": 1}, {"P": 2}], cattaneo.LoadHistory.through(hertz, [{"P": 1}, {"P": 2}])):
        with pytest.raises(cattaneo.InputError, match="load 'P' is 1 at its first point, and 0 before any load"):
            cattaneo.march(hertz, history)
    with pytest.warns(cattaneo.OutcomeWarning, match="nothing was marched"):
        cattaneo.march(hertz, cattaneo.LoadHistory.through(hertz, points[:2]), half.state)


def test_a_load_that_is_not_named_keeps_its_value(hertz):
    """In Python as in the words of a case file; the cycle closes with the loads that it begins with."""
    points = [{}, {"P": 1}, {"Q": 0.2}, {"P": 0.5}, {"Q": -0.1}]
    named = cattaneo.LoadHistory.through(hertz, points)
    assert np.array_equal(named.multipliers, [[0, 1, 1, 0.5, 0.5], [0, 0, 0.2, 0.2, -0.1]])
    read = cattaneo.LoadHistory.read(hertz, "P=0; P=1; Q=0.2; P=0.5; Q=-0.1")
    assert np.array_equal(read.multipliers, named.multipliers)
    cyclic = cattaneo.LoadHistory.through(hertz, [{}, {"P": 1}, {"Q": 0.2}, {"Q": 0}], cycle_start=1, cycles=3)
    assert (cyclic.cycle_start, cyclic.cycles) == (1, 3)
    for options, sentence in (
        ({"cycle_start": 2}, "load 'Q' is 0 at the end of the cycle and 0.2 at its start"),
        ({"cycle_start": 3}, "the cycle starts at point 3, must be one of 0 to 2"),
        ({"cycle_start": -1}, "cycle_start is -1, must be the number of a point"),
        ({"cycle_start": 1, "cycles": 0}, "0 cycles, must be at least 1"),
        ({"cycles": 2}, "cycles needs cycle_start"),
    ):
        with pytest.raises(cattaneo.InputError, match=sentence):
            cattaneo.LoadHistory.through(hertz, [{}, {"P": 1}, {"Q": 0.2}, {"Q": 0}], **options)


def test_problems_and_states_are_pickled_and_copied(hertz):
    """As multiprocessing does; to the last bit."""
    report = cattaneo.march(hertz, [{}, {"P": 1}])
    for again in (pickle.loads(pickle.dumps(hertz)), copy.deepcopy(hertz), copy.copy(hertz)):
        assert np.array_equal(again.K, hertz.K) and again.loads == hertz.loads
    for again in (pickle.loads(pickle.dumps(report.state)), copy.deepcopy(report.state)):
        assert np.array_equal(again.p, report.state.p)


def test_views_cost_no_copy_and_stay_alive(hertz):
    K, friction = hertz.K, hertz.friction
    assert np.shares_memory(K, hertz.K) and np.shares_memory(hertz.A, K) and not K.flags.writeable
    friction[3] = 0.125
    assert hertz.friction[3] == 0.125
    hertz.friction = 0.25
    assert friction[3] == 0.25
    other = hertz.copy()
    other.friction[:] = 0.5
    assert hertz.friction[3] == 0.25
    p = cattaneo.march(hertz, [{}, {"P": 1}]).state.p
    total = K.sum(), p.sum()
    del hertz, other
    assert (K.sum(), p.sum()) == total


def test_many_threads_give_the_same_bits(hertz):
    points = [{}, {"P": 1}, {"P": 1, "Q": 0.2}]

    def loss(f):
        problem = hertz.copy()
        problem.friction = f
        return cattaneo.march(problem, points).state.dissipation

    frictions = np.linspace(0.25, 0.6, 40)
    one_by_one = [loss(f) for f in frictions]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert list(pool.map(loss, frictions)) == one_by_one


def test_other_threads_run_during_a_march(hertz):
    """And one of them stops it: the report has what there is."""
    stop = threading.Event()
    timer = threading.Timer(0.5, stop.set)
    timer.start()
    begin = time.monotonic()
    report = slow_march(hertz, stop=stop)
    assert time.monotonic() - begin < 30
    assert report.status == "stopped" and report.state.time > 2 and len(report.cycles) > 0
    assert slow_march(hertz, stop=stop).time.size == 0  # set before it began


def test_observer_stops_at_its_own_increment(hertz):
    stop = threading.Event()
    seen = []

    def third(state):
        seen.append(state.time)
        if len(seen) == 3:
            stop.set()

    report = slow_march(hertz, stop=stop, observer=third)
    assert report.status == "stopped" and len(seen) == 3 and report.state.time == seen[-1]


def test_control_c_interrupts(hertz):
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        slow_march(hertz)


def test_progress_is_heard_and_may_raise(hertz, capsys):
    heard = []

    def listen(progress):
        heard.append(progress.steps)
        if len(heard) == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        slow_march(hertz, progress=listen)
    assert heard == sorted(heard)
    states = []
    cattaneo.march(hertz, [{}, {"P": 1}, {"P": 1, "Q": 0.1}], observer=states.append)
    assert states[-1].time == 2

    def refuse(state):
        raise KeyError("seen")

    with pytest.raises(KeyError, match="seen"):
        cattaneo.march(hertz, [{}, {"P": 1}], observer=refuse)
    stop = threading.Event()
    threading.Timer(1.5, stop.set).start()
    slow_march(hertz, progress=True, stop=stop)
    assert "steps" in capsys.readouterr().err


def test_reports_say_what_a_person_wants_to_see(hertz):
    report = cattaneo.march(hertz, [{}, {"P": 1}, {"P": 1, "Q": 0.1}])
    assert "converged" in repr(report) and "P = 1 Q = 0.1" in repr(report)
    assert "41 contact nodes" in repr(hertz) and "P Q" in repr(hertz)
    assert f"normal force {report.state.p.sum():.6g}" in repr(report.state)


def test_plot(hertz):
    matplotlib = pytest.importorskip("matplotlib")
    report = cattaneo.march(hertz, [{}, {"P": 1}, {"P": 1, "Q": 0.1}])
    axes = report.plot()
    assert len(axes) == 3  # tractions, slip, and the loop of Q, which varies
    p = axes[0].lines[0].get_ydata()
    assert np.array_equal(p, report.state.p / hertz.weights)
    with pytest.raises(ValueError, match="must be 3"):
        report.plot(axes[:2])
    matplotlib.pyplot.close("all")


def test_a_load_that_acts_before_anything_presses(hertz):
    """The outcome says which loads come later, or that none does."""
    with pytest.warns(cattaneo.OutcomeWarning, match="no load presses the bodies together yet: load 'P' grows on the way to point 2"):
        report = cattaneo.march(hertz, [{}, {"Q": 0.1}, {"P": 1}])
    assert "the load that presses must come first" in report.message and report.state.p.max() == 0
    with pytest.warns(cattaneo.OutcomeWarning, match="no other load comes later: does a load have the wrong sign"):
        cattaneo.march(hertz, [{}, {"P": -1}])

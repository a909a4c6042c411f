"""Derivatives and designs against closed forms, and what a script can do with them."""

import os
import pathlib
import signal
import threading
import time
import warnings

import cattaneo
import numpy as np
import pytest
from cattaneo import design

k, P, d = 2.0, 3.0, 2.0


def slider(friction):
    """A slider on a spring k, pressed by P, whose spring's end moves by d. A cycle loses 4 f P (d - f P/k)."""
    return cattaneo.ReducedProblem(
        [[k]],
        [[0.0]],
        [[1.0]],
        [cattaneo.LoadPattern("P", [0.0], [1.0]), cattaneo.LoadPattern("d", [-k], [0.0], control="displacement")],
        friction=friction,
        weights=1.0,
        H=[[0, 0], [0, k]],
    )


EXACT = design.DesignSettings(march=cattaneo.MarchSettings(stepping="exact"))


def cycle(problem):
    points = [{}, {"P": P}] + [{"d": s * d} for s in (1, -1, 1)]
    return cattaneo.LoadHistory.through(problem, points, cycle_start=2)


@pytest.mark.parametrize("stepping", ["exact", "fixed"])
def test_gradient_of_a_loss_by_hand(stepping):
    """Loss 4 f P (d - f P/k), by friction and by the loads' size; backward, forward, and of what is made of it."""
    f = 0.4
    problem = slider(f)
    trace = design.trace_march(problem, cycle(problem), settings=cattaneo.MarchSettings(stepping=stepping, increments=1))
    of = design.Responses(problem, trace)
    lost = of.dissipation(trace.at(2), trace.last())
    assert float(lost) == lost.value == pytest.approx(4 * f * P * (d - f * P / k), rel=1e-12)
    sensitivity = design.Sensitivity(problem, trace)
    by = sensitivity.gradient(lost).by
    assert by.friction == pytest.approx([4 * P * (d - 2 * f * P / k)], rel=1e-10)
    by_P, by_d = design.Parameters(multipliers=[[0, 1, 1, 1, 1], [0] * 5]), [[0] * 5, [0, 0, 1, -1, 1]]
    assert by.dot(by_P) == pytest.approx(4 * f * (d - 2 * f * P / k), rel=1e-10)
    assert by.dot(design.Parameters(multipliers=by_d)) == pytest.approx(4 * f * P, rel=1e-10)
    along = sensitivity.along(by_P)
    assert along.of(lost) == pytest.approx(by.dot(by_P), rel=1e-10)
    assert along.loss.shape == (1, len(trace))
    # Reaction f P: 2 f P over 2 d is the secant stiffness; the loss over the area of range times range.
    first, turned = trace.at(2), trace.at(3)
    force = of.conjugate(first, "d") - of.conjugate(turned, "d")
    assert force.value == pytest.approx(2 * f * P, rel=1e-12)
    moved = of.multiplier(first, "d") - of.multiplier(turned, "d")
    ratio = lost / (force * moved)
    assert ratio.value == pytest.approx((d - f * P / k) / d, rel=1e-12)
    assert sensitivity.gradient(ratio).by.friction == pytest.approx([-P / k / d], rel=1e-9)
    half = 1 - 0.5 * ratio / 2 + (-ratio)
    assert half.value == pytest.approx(1 - 1.25 * ratio.value, rel=1e-12)
    assert sensitivity.gradient(half).by.friction == pytest.approx([1.25 * P / k / d], rel=1e-9)
    assert of.secant_stiffness(turned, first, "d").value == pytest.approx(f * P / d, rel=1e-12)
    # One of its own: q of the last state.
    own = design.Response(trace.states[-1].q[0], {trace.last(): {"forces": [1, 0]}})
    assert sensitivity.gradient(own).by.friction == pytest.approx([-P], rel=1e-12)
    assert own.weights[trace.last()]["forces"] == pytest.approx([1, 0])


def test_modulus():
    """With a spring (1 + s) k the loss is 4 f P (d - f P/k(1 + s))."""
    f = 0.4
    problem = slider(f)
    trace = design.trace_march(problem, cycle(problem), settings=cattaneo.MarchSettings(stepping="exact"))
    lost = design.Responses(problem, trace).dissipation(trace.at(2), trace.last())
    change = design.stiffness_scale(problem)
    gradient = design.Sensitivity(problem, trace, [change]).gradient(lost)
    assert gradient.by.stiffness == pytest.approx([4 * (f * P) ** 2 / k], rel=1e-9)
    assert np.array_equal(change.K, problem.K)


def test_worn_depth_by_hand():
    """Two sliders beneath a block wear by k P times their way, 4 N + 1 times d - f P/kt after N cycles: derivatives by
    k, friction and d."""
    from cattaneo import wear

    kt, f, K, cycles = 2.0, 0.5, 1e-3, 3
    ones, none = np.ones(2), np.zeros(2)
    patterns = [cattaneo.LoadPattern("P", none, ones), cattaneo.LoadPattern("d", -kt * ones, none, control="displacement")]
    problem = cattaneo.ReducedProblem(
        kt * np.eye(2), np.zeros((2, 2)), np.eye(2) - 0.5, patterns, friction=f, weights=1.0, arc_length=[0, 1]
    )
    exactly = wear.WearSettings(march=cattaneo.MarchSettings(stepping="exact"))
    trace = design.trace_wear(problem, wear.WearLaw.uniform(problem, K), cycle(problem), cycles, settings=exactly)
    worn = design.Responses(problem, trace).worn_volume(0, trace.last())
    way = (4 * cycles + 1) * (d - f * P / kt)
    assert worn.value == pytest.approx(2 * K * P * way, rel=1e-12)
    by = design.Sensitivity(problem, trace).gradient(worn).by
    assert by.wear == pytest.approx([P * way] * 2, rel=1e-9)
    assert by.friction == pytest.approx([-(4 * cycles + 1) * K * P**2 / kt] * 2, rel=1e-9)
    assert by.dot(design.Parameters(multipliers=[[0] * 5, [0, 0, 1, -1, 1]])) == pytest.approx(
        2 * K * P * (4 * cycles + 1), rel=1e-9
    )


def test_problems_are_as_they_were_marched():
    """A problem whose friction was set since then has other derivatives."""
    problem = slider(0.4)
    trace = design.trace_march(problem, cycle(problem))
    problem.friction = 0.5
    for use in (design.Responses, design.Sensitivity, design.ties):
        with pytest.raises(cattaneo.InputError, match=r"friction\[0\] of the problem is 0.5, and was 0.4 when it was marched"):
            use(problem, trace)
    problem.friction = 0.4
    states = design.Responses(problem, trace), trace.states, design.Sensitivity(problem, trace)
    del problem, trace
    assert states[1][-1].time == 4 and states[0].slip(0, 0).value == 0


def test_ties_have_two_sides():
    """With k d = f P the node is at the limit: its slip follows d on one side, and not on the other."""
    f = k * d / P
    problem = slider(f)
    trace = design.trace_march(problem, [{}, {"P": P}, {"P": P, "d": d}], settings=cattaneo.MarchSettings(increments=1, stepping="fixed"))
    (tie,) = [tie for tie in design.ties(problem, trace) if tie.state == trace.last()]
    assert {tie.taken, tie.other} == {cattaneo.NodeState.stick, cattaneo.NodeState.forward_slip}
    slopes = []
    for side in (trace, trace.other_side([tie])):
        slip = design.Responses(problem, side).slip(side.last(), 0)
        slopes.append(design.Sensitivity(problem, side).gradient(slip).by.multipliers[1, 2])
    assert sorted(slopes) == pytest.approx([0, 1], abs=1e-12)


def searched(report):
    if report.status == "unavailable":
        pytest.skip("built without Ipopt")
    return report


@pytest.fixture(autouse=True)
def without_ipopt():
    warnings.filterwarnings("ignore", "design: unavailable", cattaneo.OutcomeWarning)


def damped(objective, high=0.9):
    problem = slider(0.1)
    return design.DesignProblem(
        problem,
        [design.DesignCase("cycle", cycle(problem), weight=-1, from_=2)],
        [design.Parameters(friction=[1.0])],
        low=0,
        high=high,
        goal="least_sum",
        objective=objective,
    )


def lost_in_all(of, states):
    return [of.dissipation(states[0], states[-1])]


def test_friction_of_most_damping():
    """Most is lost with f P = k d/2, k d² a cycle; a bound below holds it with the slope that is left."""
    report = searched(design.design(damped(lost_in_all), 0.0, settings=EXACT))
    assert report.optimal and report.problem.friction[0] == pytest.approx(k * d / 2 / P, rel=1e-6)
    assert -report.objective == pytest.approx(k * d**2, rel=1e-10)
    assert 0.1 + report.x[0] == report.problem.friction[0]
    held = design.design(damped(lost_in_all, high=0.3), [0.0], settings=EXACT)
    assert held.x == pytest.approx([0.3], abs=1e-7)
    assert held.bound_multipliers == pytest.approx([4 * P * (d - 2 * 0.4 * P / k)], rel=1e-5)
    assert len(held.traces) == 1 and held.traces[0].report.converged


def test_punch_of_uniform_pressure():
    """From a flat punch with the gap of every node free; the closed form is interpolated, so to the size of an element."""
    material = cattaneo.Material(8 / np.pi * 0.91, 0.3)
    upper = cattaneo.HalfPlane(material, depth=1e4, normal=(0, 1), forces={"P": (0, -1), "Q": (1, 0)})
    body = cattaneo.condense(upper, np.linspace(-1, 1, 17), order=1)
    flat = cattaneo.reduce(body, cattaneo.HalfPlane(material, depth=1e4)).problem
    flat.friction = 0.3
    n = flat.nodes
    G = np.delete(np.eye(n), n // 2, axis=1)
    case = design.DesignCase("pressed", cattaneo.LoadHistory.through(flat, [{}, {"P": 1}]))
    wanted = design.DesignProblem(flat, [case], G, low=0, high=2)
    # The half-plane goes on beyond its contact nodes, which end here as a punch does.
    warnings.filterwarnings("ignore", "design, case 'pressed': contact is compressed up to", cattaneo.OutcomeWarning)
    report = searched(design.design(wanted, 0))
    assert report.optimal and report.objective_at_start > 0.6
    assert report.objective == pytest.approx(0.5, abs=1e-6)
    x = flat.position[:, 0]
    part = lambda s: s * np.log(np.maximum(s, 1e-300))
    exact = (part(1 + x) + part(1 - x)) / 4
    assert report.problem.gap == pytest.approx(exact, abs=0.04 * exact.max())
    assert sum(active.multiplier for active in report.active) == pytest.approx(1, abs=1e-6)
    assert np.array_equal(wanted.with_(report.x).gap, report.problem.gap)
    design.limit_curvature(wanted, -0.1, 0.35)
    assert wanted.limits.shape == (n - 2, n - 1) and (wanted.most == 0.35).all()
    curved = design.design(wanted, 0)
    assert report.objective < curved.objective < curved.objective_at_start


def rounded_pad(shape=None):
    """A flat pad |x| < 1 on a half-plane, flat for |x| < x[0] and of radius 1/x[1] beyond."""
    material = cattaneo.Material(8 / np.pi * 0.91, 0.3)
    upper = cattaneo.HalfPlane(material, depth=1e4, normal=(0, 1), forces={"P": (0, -1), "Q": (1, 0)})
    flat = cattaneo.reduce(cattaneo.condense(upper, np.linspace(-1, 1, 33), order=1), cattaneo.HalfPlane(material, depth=1e4)).problem
    flat.friction = 0.3
    at = flat.position[:, 0]

    def rounded(x):
        beyond = np.maximum(0, abs(at) - x[0])
        return x[1] * beyond**2 / 2, np.stack([-x[1] * beyond, beyond**2 / 2], axis=1)

    case = design.DesignCase("pressed", cattaneo.LoadHistory.through(flat, [{}, {"P": 1}]))
    nothing = [design.Parameters(), design.Parameters()]
    return design.DesignProblem(flat, [case], nothing, low=0, high=[1, 4], shape=shape or rounded)


def test_rounded_punch_of_least_pressure():
    """From several starts: the best has no better neighbour by marches alone, and is above what no profile is below."""
    wanted = rounded_pad()
    starts = design.spread_starts(wanted, [0.5, 0], 3)
    assert len(starts) == 3 and all((x >= 0).all() and (x <= [1, 4]).all() for x in starts)
    warnings.simplefilter("ignore", cattaneo.OutcomeWarning)
    best = min((searched(design.design(wanted, x)) for x in [[0.5, 0], *starts]), key=lambda report: report.objective)

    def peak(x):
        problem = wanted.with_(x)
        state = cattaneo.march(problem, [{}, {"P": 1}]).state
        return (state.p / problem.weights).max()

    assert best.objective > 0.5 and peak(best.x) == pytest.approx(best.objective, rel=1e-9)
    for way in ([1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]):
        assert peak(best.x + 1e-3 * np.array(way)) > best.objective - 1e-8


def test_a_shape_says_what_is_wrong_with_it():
    with pytest.raises(TypeError, match="must be|incompatible function arguments"):
        rounded_pad(3)
    with pytest.raises(TypeError, match="what the shape returned is a list of 1 entries, must be two arrays"):
        rounded_pad(lambda x: [x]).with_([0, 0])
    with pytest.raises(ValueError, match="gaps of the shape"):
        rounded_pad(lambda x: (x, np.zeros((33, 2)))).with_([0, 0])
    with pytest.raises(ValueError, match="returns for variable 1"):
        design.design(rounded_pad(lambda x: (np.full(33, x[1]), np.zeros((33, 2)))), [0, 0])
    with pytest.raises(ZeroDivisionError):
        design.design(rounded_pad(lambda x: 1 / 0), [0, 0])
    with pytest.raises(ValueError, match="must be linear in them"):
        design.limit_curvature(rounded_pad(), -1, 1)


def test_what_an_objective_raises_is_raised():
    """Also from within Ipopt, as Ctrl-C and what a monitor raises."""
    searched(design.design(damped(lost_in_all), 0.0, settings=EXACT))
    calls, kept = [], []

    def failing(of, states):
        calls.append(1)
        kept.append(of)
        if len(calls) > 2:
            raise KeyError("enough")
        return lost_in_all(of, states)

    with pytest.raises(KeyError, match="enough"):
        design.design(damped(failing), 0.0)
    with pytest.raises(cattaneo.InputError, match="end with the call"):
        kept[0].peak_pressure(0)
    with pytest.raises(TypeError, match="what the objective returned is a list of 1 entries, must be a list of Response"):
        design.design(damped(lambda of, states: [3]), 0.0)
    with pytest.raises(TypeError, match="what the objective returned is None, must be a list"):
        design.design(damped(lambda of, states: None), 0.0)

    def slow(of, states):
        if len(calls) < 1000:
            calls.append(1)
            os.kill(os.getpid(), signal.SIGINT) if len(calls) == 6 else None
        return lost_in_all(of, states)

    with pytest.raises(KeyboardInterrupt):
        design.design(damped(slow), 0.0)
    stop = threading.Event()
    stop.set()
    assert design.design(damped(lost_in_all), 0.0, stop=stop).status == "stopped"


def test_limits_raise_what_a_monitor_raises():
    from cattaneo import shakedown

    problem = slider(0.5)
    limit = shakedown.limit_problem(problem, shakedown.LoadCycle.through(problem, {"P": P}, [{"d": 1}, {"d": -1}]))
    if shakedown.load_limit(limit).status == "unavailable":
        pytest.skip("built without Ipopt")

    def listen(progress):
        raise RuntimeError("heard")

    with pytest.raises(RuntimeError, match="heard"):
        shakedown.load_limit(limit, progress=listen)


def test_outcomes():
    """A case that slides away is named."""
    problem = slider(0.1)
    problem = cattaneo.ReducedProblem(
        [[k]], [[0.0]], [[1.0]], [cattaneo.LoadPattern("P", [0.0], [1.0]), cattaneo.LoadPattern("Q", [-1.0], [0.0])], friction=0.1, weights=1.0
    )
    sliding = cattaneo.LoadHistory.through(problem, [{}, {"P": 1}, {"P": -1}])
    wanted = design.DesignProblem(problem, [design.DesignCase("lifted", sliding)], np.ones((1, 1)), 0, 1)
    assert "1 variables" in repr(wanted)
    trace = design.trace_march(problem, [{}, {"P": 1}])
    with pytest.raises(cattaneo.InputError, match="state 9, must be below"):
        design.Responses(problem, trace).pressure(9, 0)
    with pytest.raises(cattaneo.InputError, match="a response has 3 weights|trace change"):
        design.Sensitivity(problem, trace).along(design.Parameters(friction=[1.0])).of(design.Response(0, {0: {"forces": [1, 2, 3]}}))


PROBLEMS = pathlib.Path(__file__).parents[2] / "problems"


def pressed_and_sheared(name, Q=0.2, **members):
    problem = cattaneo.load_reduced_problem(PROBLEMS / f"{name}.json")
    points = [{}, {"P": 1.0}, {"P": 1.0, "Q": Q}]
    return problem, design.trace_march(problem, points, settings=cattaneo.MarchSettings(**members))


def test_an_edge_of_hertz_moves():
    """a² is as the load: the half-width changes by a/2 of a relative change of it, K_N = p0 sqrt(2/a) by a fourth."""
    problem, trace = pressed_and_sheared("hertz", stepping="exact")
    pressed = trace.at(1)
    edges = cattaneo.readout.contact_edges(problem, trace.states[pressed], trace.states[-1])
    sensitivity = design.Sensitivity(problem, trace)
    for edge in edges:
        moving = design.moving_edge(problem, trace, pressed, edge)
        assert moving.position.value == pytest.approx(float(edge.position), abs=edge.position.error)
        assert moving.k_n.value == pytest.approx(float(edge.k_n), rel=edge.k_n.relative_error)
        grows = sensitivity.gradient(moving.position).by.multipliers[0, 1]
        assert -edge.side * grows == pytest.approx(edge.half_width / 2, rel=0.1)
        assert sensitivity.gradient(moving.k_n).by.multipliers[0, 1] == pytest.approx(moving.k_n.value / 4, rel=0.2)
    stuck = design.trace_stuck(problem, trace, pressed, trace.last())
    assert len(stuck) == pressed + 2
    fitted = cattaneo.readout.fit_edge(cattaneo.readout.edge_tractions(problem, stuck.states[-1], edges[0]))
    both = design.edge_intensities(problem, stuck, stuck.last(), edges[0])
    assert [both.k_n.value, both.k_t.value] == pytest.approx([float(fitted.k_n), float(fitted.k_t)], rel=1e-9)
    # The shear of a stuck contact is proportional to Q, which is the second load.
    by = design.Sensitivity(problem, stuck).gradient(both.k_t).by
    assert by.multipliers[1, 2] * 0.2 == pytest.approx(both.k_t.value, rel=1e-9)
    with pytest.raises(cattaneo.InputError, match="pressed"):
        design.trace_stuck(problem, trace, trace.last(), pressed)


def test_strengths_of_corners_are_as_the_loads():
    """Without a gap all loads times a factor are all forces times it: a response is the sum of load times derivative."""
    problem, trace = pressed_and_sheared("punch_on_half_plane", stepping="exact")
    edges = cattaneo.readout.contact_edges(problem, trace.states[trace.at(1)], trace.states[-1])
    assert [edge.complete for edge in edges] == [True, True]
    modes = cattaneo.fretting.corner_modes(np.pi / 2, np.pi)
    stuck = design.trace_stuck(problem, trace, trace.at(1), trace.last())
    sensitivity = design.Sensitivity(problem, stuck)
    for edge in edges:
        fitted = cattaneo.fretting.fit_corner(modes, cattaneo.readout.edge_tractions(problem, stuck.states[-1], edge))
        strengths = design.corner_intensities(problem, stuck, stuck.last(), edge, modes)
        for mine, reference in ((strengths.k_one, fitted.k_one), (strengths.k_two, fitted.k_two)):
            assert mine.value == pytest.approx(float(reference), rel=1e-9)
            by = sensitivity.gradient(mine).by.multipliers
            assert (by * stuck.history.multipliers).sum() == pytest.approx(mine.value, rel=1e-8)


def test_gradients_of_limits():
    """Without a gap: a limit is as the constant loads, as 1 over the varying ones, and as friction where nothing couples."""
    from cattaneo import shakedown

    for name, coupled in (("punch_on_half_plane", True), ("hertz", False)):
        problem = cattaneo.load_reduced_problem(PROBLEMS / f"{name}.json")
        problem.gap = 0.0
        cycle = shakedown.LoadCycle.through(problem, {"P": 1}, [{"Q": 1}, {"Q": -1}])
        of = shakedown.limit_problem(problem, cycle)
        limit = shakedown.load_limit(of)
        if limit.status == "unavailable":
            pytest.skip("built without Ipopt")
        gradient = design.load_limit_gradient(of, limit)
        assert gradient.found and gradient.message == "" and gradient.friction.shape == (len(problem.gap),)
        assert (gradient.constant * cycle.constant).sum() == pytest.approx(limit.limit, rel=1e-3)
        assert (gradient.varying * cycle.varying).sum() == pytest.approx(-limit.limit, rel=1e-3)
        if not coupled:
            assert (gradient.friction * problem.friction).sum() == pytest.approx(limit.limit, rel=1e-3)
        # f at which the limit is half as much; by its load factor, and by the loads alike.
        least = shakedown.friction_limit(of, limit.limit / 2)
        by = design.friction_limit_gradient(of, limit.limit / 2, least)
        assert by.load_factor * limit.limit / 2 == pytest.approx((by.varying * cycle.varying).sum(), rel=1e-6)
        assert by.load_factor * limit.limit / 2 == pytest.approx(-(by.constant * cycle.constant).sum(), rel=1e-3)
        if not coupled:
            assert by.load_factor * limit.limit / 2 == pytest.approx(least.limit, rel=1e-3)
    with pytest.raises(TypeError, match="must be|incompatible function arguments"):
        design.load_limit_gradient(of, None)
    stop = threading.Event()
    stop.set()
    unknown = shakedown.load_limit(of, stop=stop)
    assert unknown.status == "stopped"
    with pytest.warns(cattaneo.OutcomeWarning, match="load_limit_gradient: the derivative could not be computed"):
        design.load_limit_gradient(of, unknown)


def test_derivatives_obey_ctrl_c():
    problem, trace = pressed_and_sheared("punch_on_half_plane", stepping="fixed", increments=6000, single_increment_if_exact=False)
    sensitivity = design.Sensitivity(problem, trace)
    response = design.Responses(problem, trace).dissipation(0, trace.last())
    change = design.Parameters(friction=problem.friction)
    whole = sensitivity.gradient(response).by.friction

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for long in (lambda: sensitivity.gradient(response), lambda: sensitivity.along(change)):
            with pytest.raises(KeyboardInterrupt):
                began = time.process_time()
                signal.setitimer(signal.ITIMER_REAL, 0.02)
                long()
            assert time.process_time() - began < 0.4  # asked every tenth of a second
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert sensitivity.gradient(response).by.friction == pytest.approx(whole, rel=1e-12)

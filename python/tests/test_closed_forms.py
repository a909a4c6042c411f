"""Half-planes in contact against Hertz, Cattaneo and Mindlin, and single nodes by hand."""

import warnings

import cattaneo
import numpy as np
import pytest
from cattaneo import fretting, readout, shakedown

friction, a = 0.3, 1.0  # a: half-width of contact
steel = cattaneo.Material(210.0, 0.3)
modulus = 210.0 / (2 * (1 - 0.3**2))  # E* of two bodies of the same material
pressed = np.pi * modulus * a**2 / 4  # on a relative radius of 1


@pytest.fixture(scope="module")
def hertz():
    """Two half-planes with a parabolic gap, 50 nodes in contact."""
    upper = cattaneo.HalfPlane(steel, depth=1e4, normal=(0, 1), forces={"P": (0, -1), "Q": (1, 0)})
    body = cattaneo.condense(upper, np.linspace(-1.52, 1.52, 77))
    problem = cattaneo.reduce(body, cattaneo.HalfPlane(steel, depth=1e4)).problem
    problem.gap = problem.position[:, 0] ** 2 / 2
    problem.friction = friction
    return problem


def test_hertz_pressure(hertz):
    report = cattaneo.march(hertz, [{}, {"P": pressed}])
    x = hertz.position[:, 0]
    exact = 2 * pressed / (np.pi * a) * np.sqrt(np.maximum(1 - x**2, 0))
    p = readout.tractions(hertz, report.state.p)
    inside = abs(x) < 0.9
    assert p[inside] == pytest.approx(exact[inside], abs=3e-3 * exact.max())
    zone = readout.contact_zone(hertz, report.state)
    assert zone.width / 2 == pytest.approx(a, abs=zone.from_.error)
    assert report.state.p.sum() == pytest.approx(pressed, rel=1e-12)
    assert str(zone.from_) == f"{zone.from_.position:.6g} ± {zone.from_.error:.6g} (estimate)"
    # The ends of the line are no estimates.
    first = readout.zones(hertz, report.state)[0]
    assert first.from_.error == 0 and str(first.from_) == "0"


def test_cattaneo_mindlin_stick_and_loss(hertz):
    """c = a √(1 - Q/fP); the loss of a cycle is in the book of Johnson, 7.4."""
    Q = 0.6 * friction * pressed
    points = [{}, {"P": pressed}] + [{"P": pressed, "Q": s * Q} for s in (1, -1, 1)]
    history = cattaneo.LoadHistory.through(hertz, points, cycle_start=2, cycles=4)
    report = cattaneo.march(hertz, history, settings=cattaneo.MarchSettings(every_event=True))
    stick = readout.stick_zone(hertz, cattaneo.march(hertz, points[:3], settings=cattaneo.MarchSettings(increments=40)).state)
    assert stick.width / 2 == pytest.approx(a * np.sqrt(1 - 0.6), abs=stick.from_.error)
    x = 0.6
    exact = 4 * (friction * pressed) ** 2 / (np.pi * modulus) * ((1 - x) * np.log(1 - x) + x - x**2 / 2)
    loop = report.cycles[-1].loops["Q"]
    assert loop.work == pytest.approx(exact, rel=5e-3)
    assert report.cycles[-1].dissipation == pytest.approx(loop.work, rel=1e-9)
    assert report.steady_cycle == 1
    assert len(report.changes) > 20


def test_gross_sliding_is_where_coulomb_says(hertz):
    """Sliding begins at Q = f P; the march says so, and keeps the last equilibrium."""
    with pytest.warns(cattaneo.OutcomeWarning, match="gross sliding"):
        report = cattaneo.march(hertz, [{}, {"P": 1.0}, {"P": 1.0, "Q": 2 * friction}])
    assert (report.status, report.converged) == ("gross sliding", False)
    at = dict(zip(hertz.loads, report.event_multipliers))
    assert at["Q"] == pytest.approx(friction, rel=1e-6)


def test_two_half_spaces_twisted_while_they_stick():
    """A turn of 1 between two half-spaces that stick within the radius a meets the torque of two discs of radius a in
    series, each 16 G a^3/3 (Reissner and Sagoci)."""
    nu, a = 0.3, 1.0
    material = cattaneo.Material(1.0, nu)
    shear_modulus = 1 / (2 * (1 + nu))
    above = cattaneo.HalfPlane(material, depth=1e4, normal=(0, 1))
    below = cattaneo.HalfPlane(material, depth=1e4)
    line = a * np.sin(np.linspace(0, np.pi / 2, 41))
    bodies = [[cattaneo.condense(each, line, 2, way) for each in (above, below)] for way in ("axisymmetric", "torsion")]
    problem = cattaneo.reduce(*bodies[0], torsion=bodies[1]).problem
    n = problem.nodes
    assert problem.components == 2
    r = np.asarray(problem.position)[:, 0]
    torque = r @ np.asarray(problem.A)[n:, n:] @ r
    assert torque == pytest.approx(16 / 3 * shear_modulus * a**3 / 2, rel=2e-3)
    with pytest.raises(cattaneo.InputError, match="torsion"):
        cattaneo.reduce(*bodies[1])


def test_linear_elements_beside_the_axis_are_warned_of():
    body = cattaneo.HalfPlane(cattaneo.Material(1.0, 0.3), depth=1e4)
    with pytest.warns(cattaneo.OutcomeWarning, match="next to the axis"):
        cattaneo.condense(body, [0, 0.5, 1], 1, "axisymmetric")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cattaneo.condense(body, [0, 0.5, 1], 2, "axisymmetric")
        cattaneo.condense(body, [0.2, 0.5, 1], 1, "axisymmetric")


def slider(k=2.0, f=0.5):
    """A mass-less slider on a spring k, pressed by P on a rigid plane, its spring's end moved by d: q = k (v - d),
    p = P. H of the spring alone is k."""
    return cattaneo.ReducedProblem(
        [[k]],
        [[0.0]],
        [[1.0]],
        [cattaneo.LoadPattern("P", [0.0], [1.0]), cattaneo.LoadPattern("d", [-k], [0.0], control="displacement")],
        friction=f,
        H=[[0, 0], [0, k]],
    )


def test_slider_by_hand():
    """Slips when k d = f P, then v = d - f P/k; the reaction of the spring's end is f P; over a cycle ±d it loses
    4 f P (d - f P/k)."""
    k, f, P, d = 2.0, 0.5, 3.0, 2.0
    problem = slider(k, f)
    points = [{}, {"P": P}] + [{"P": P, "d": s * d} for s in (1, -1, 1)]
    history = cattaneo.LoadHistory.through(problem, points, cycle_start=2)
    report = cattaneo.march(problem, history, settings=cattaneo.MarchSettings(stepping="exact"), keep_states=True)
    assert report.state.v == pytest.approx([d - f * P / k], rel=1e-14)
    assert report.state.q == pytest.approx([-f * P], rel=1e-14)
    assert report.conjugates["d"][-1] == pytest.approx(f * P, rel=1e-14)
    assert report.cycles[0].loops["d"].work == pytest.approx(4 * f * P * (d - f * P / k), rel=1e-12)
    assert [s.time for s in report.states] == list(report.time)
    assert cattaneo.settled_states(problem, report.state)[0] == cattaneo.NodeState.forward_slip
    assert report.dissipation.sum() == pytest.approx(report.state.dissipation)


def test_two_nodes_by_hand():
    """Two nodes on springs of their own share P as 1 and 2; under Q = 0.4 on each of them the first, with f p = 0.3,
    slips by 0.1/k, the second, with f p = 0.6, does not."""
    k = 4.0
    problem = cattaneo.ReducedProblem(
        np.diag([k, k]),
        np.zeros((2, 2)),
        np.eye(2),
        [cattaneo.LoadPattern("P", [0, 0], [1, 2]), cattaneo.LoadPattern("Q", [-1, -1], [0, 0])],
        friction=0.3,
    )
    state = cattaneo.march(problem, [{}, {"P": 1}, {"P": 1, "Q": 0.4}]).state
    assert state.v == pytest.approx([0.1 / k, 0], abs=1e-15)
    assert state.q == pytest.approx([-0.3, -0.4], rel=1e-14)
    assert list(state.status) == [cattaneo.NodeState.forward_slip, cattaneo.NodeState.stick]


def test_shakedown_of_a_slider():
    """It sticks from then on if the spring's end moves by less than 2 f P/k in all."""
    k, f, P = 2.0, 0.5, 3.0
    problem = slider(k, f)
    cycle = shakedown.LoadCycle.through(problem, {"P": P}, [{"d": 1}, {"d": -1}])
    limit = shakedown.load_limit(shakedown.limit_problem(problem, cycle))
    if limit.status == "unavailable":
        pytest.skip("built without Ipopt")
    assert limit.certified
    assert limit.lower <= f * P / k * (1 + 1e-12) and limit.upper >= f * P / k * (1 - 1e-12)
    assert limit.limit == pytest.approx(f * P / k, rel=1e-5)
    least = shakedown.friction_limit(shakedown.limit_problem(problem, cycle), 0.6)
    assert least.limit == pytest.approx(k * 0.6 / P, rel=1e-5)
    assert float(shakedown.method1_load(problem, cycle)) == pytest.approx(f * P / k)
    assert shakedown.lower_limit(shakedown.limit_problem(problem, cycle), limit).kind == "uncoupled"


def test_lower_limit_with_nodes_apart():
    """Node 1 feels the slip of node 0: 0.8 ∓ 0.12 λ is its least pressure (see the core's test of this chain)."""
    B = np.zeros((3, 3))
    B[1, 0] = 0.8
    problem = cattaneo.ReducedProblem(
        2 * np.eye(3),
        B,
        2 * np.eye(3),
        [cattaneo.LoadPattern("P", [0, 0, 0], [1, 1, 1]), cattaneo.LoadPattern("Q", [0.3, 1, 0], [0, 0, 0])],
        friction=0.5,
    )
    contact = shakedown.limit_problem(problem, shakedown.held_and_cycled(problem, "P", 1, "Q", -1))
    upper = shakedown.load_limit(contact)
    if upper.status == "unavailable":
        pytest.skip("built without Ipopt")
    for apart, kind, value in ((None, "bound", 0.4), ([0], "apart", 0.4), ([1], "apart", 0.6 / 1.06)):
        lower = shakedown.lower_limit(contact, upper, apart=apart)
        assert lower.kind == kind
        assert lower.value == pytest.approx(value, abs=1e-7)
    with pytest.raises(cattaneo.InputError, match="apart"):
        shakedown.lower_limit(contact, upper, apart=[3])
    # The report of the limit says what it is worth: λ1 = 0.4, below which every start shakes down.
    assert upper.coupled and upper.every_start == pytest.approx(0.4, abs=1e-7)
    for words in ("stay closed", "some start shakes down, but not every start", "λ1", "at least 0.4"):
        assert words in str(upper) and words in " ".join([upper.assumption, *upper.statement])
    unasked = shakedown.load_limit(contact, settings=shakedown.LimitSettings())
    assert np.isnan(unasked.every_start) and "not computed" in str(unasked)
    assert "with more friction some start" in str(shakedown.friction_limit(contact, 0.3))
    # From rest the chain shakes down below λ1; above the upper limit nothing does, as far as it is known.
    hundred = shakedown.TransientSettings(cycles=100)
    assert shakedown.transient(contact, 0.39, settings=hundred).verdict == "shaken down"
    above = shakedown.transient(contact, upper.upper * 1.00001, upper.slip, limit=upper, settings=hundred)
    assert above.verdict in ("cyclic slip", "still slipping")
    # A limit that was not found has no bounds.
    pulled = shakedown.limit_problem(problem, shakedown.held_and_cycled(problem, "P", -1, "Q", -1))
    with pytest.warns(cattaneo.OutcomeWarning):
        none = shakedown.load_limit(pulled)
    assert none.status == "no solution" and str(none).startswith("<LimitReport: no solution: ")
    assert "proven between" not in str(none)


def test_fretting_closed_forms():
    """Formulas of the near-edge field, with arrays as NumPy's functions take them."""
    edge = fretting.Edge(k_n=2.0, k_t=0.3, friction=0.5)
    assert fretting.slip_zone(edge) == pytest.approx(2 * 0.3 / (0.5 * 2.0))
    t = np.array([[0.1, 1.0, 4.0]])
    assert fretting.pressure(edge, t) == pytest.approx(2.0 * np.sqrt(t))
    d = fretting.slip_zone(edge)
    assert fretting.shear_traction(edge, t) == pytest.approx(np.sqrt(t) - np.sqrt(np.maximum(t - d, 0)))
    assert isinstance(fretting.pressure(edge, 1.0), float)
    assert fretting.stress(edge, t, 0.2).shape == (1, 3, 3)
    contact = fretting.hertz_contact(load=pressed, radius=1.0, modulus=modulus)
    assert contact.half_width == pytest.approx(a)
    assert fretting.corner_modes(np.pi / 2, np.pi).one.eigenvalue == pytest.approx(0.544483736782)
    assert fretting.hertz_slip_energy(friction, pressed, [0.2, 0.6], modulus).shape == (2,)


def test_criteria_on_critical_planes(tmp_path):
    (tmp_path / "materials.json").write_text(
        '{"materials": [{"name": "Al", "young_GPa": 74, "poisson": 0.3, "threshold_MPa_sqrt_m": 2.1,'
        ' "fatigue_limit_MPa": 124, "shear_yield_MPa": 270}]}'
    )
    material = fretting.find_material(tmp_path / "materials.json", "Al")
    limit = fretting.plain_fatigue_cycle(material)
    assert np.allclose(limit, [[62, 0, 0, 0], [-62, 0, 0, 0]])
    value, angle = fretting.critical_plane("smith_watson_topper", material, limit)
    assert value == pytest.approx(62**2 / 74e3)
    assert np.sin(angle) == pytest.approx(0, abs=1e-6)
    shear = [[0, 0, 0, 10], [0, 0, 0, -10]]
    assert fretting.critical_plane("findley", material, shear, weights=fretting.PlaneWeights(findley=0.2))[0] == pytest.approx(10 * np.hypot(1, 0.2))
    with pytest.raises(ValueError, match="cycle"):
        fretting.critical_plane("findley", material, [[1, 2, 3]])
    with pytest.raises(ValueError, match="fatemi_socie"):
        fretting.critical_plane("crossland", material, limit)


def test_laws_of_friction_by_hand():
    """A block on a spring of 2 slips with what its law has at its pressure, forward less than backward; Coulomb's law comes back."""
    problem = cattaneo.ReducedProblem(
        [[2.0]], [[0.0]], [[3.0]], [cattaneo.LoadPattern("P", [0.0], [1.0]), cattaneo.LoadPattern("Q", [1.0], [0.0])], weights=[0.5]
    )

    def sheared(P, Q):
        return cattaneo.march(problem, [{}, {"P": P}, {"P": P, "Q": Q}]).state

    problem.set_friction_law([[2, 1.2], [6, 2], [8, 2]], backward=[[1, 0.3]])  # tractions: forces are half of them
    assert problem.friction[0] == pytest.approx(0.6)
    (forward, backward), = problem.laws
    assert forward == pytest.approx(np.array([[1, 0.6], [3, 1], [4, 1]])) and backward == pytest.approx(np.array([[0.5, 0.15]]))
    for P, bound in ((0.5, 0.3), (2, 0.8), (10, 1)):
        there, back = sheared(P, -4), sheared(P, 4)
        assert there.q[0] == pytest.approx(-bound) and there.v[0] == pytest.approx((4 - bound) / 2)
        assert back.q[0] == pytest.approx(0.3 * P) and back.v[0] == pytest.approx(-(4 - 0.3 * P) / 2)
    problem.friction = 0.25
    assert problem.laws == [] and sheared(2, 4).q[0] == pytest.approx(0.5)
    with pytest.raises(ValueError, match="the pressure must increase from 0"):
        problem.set_friction_law([[1, 0.5], [2, 0.4]])
    with pytest.raises(ValueError, match="nodes is empty"):
        problem.set_friction_law([[1, 0.5]], nodes=[])
    problem.set_friction_law([[1, 0.5]])
    problem.friction[0] = 0.1
    with pytest.raises(ValueError, match="steepest slope"):
        sheared(1, 1)

"""Problems made of compliances: closed forms, another way to the same stiffness, and what cannot be one."""

import cattaneo
import numpy as np
import pytest
from cattaneo import readout
from test_bodies import strip

E, NU = 70.0, 0.3  # of both bodies: 1/E* is 2 (1 - ν²)/E
SOFTNESS = 2 * (1 - NU**2) / E


def half_planes(ends):
    """Two half-planes of one material in relative coordinates, by Flamant: tractions uniform between `ends`, and
    displacements at the middles, less those of a point far away, of which no stress knows."""
    middles, lengths = (ends[1:] + ends[:-1]) / 2, np.diff(ends)
    # The mean of ln|x - s| over an element: antiderivative t ln|t| - t.
    t = ends[None, :] - middles[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        integral = np.where(t == 0, 0.0, t * np.log(np.abs(t)) - t)
    F = -2 * SOFTNESS / np.pi * np.diff(integral, axis=1) / lengths[None, :]
    return middles, lengths, (F + F.T) / 2


def test_hertz_and_cattaneo_by_a_closed_form():
    """A cylinder of radius 1 pressed by 1 and sheared: half-width, peak and stick zone."""
    middles, lengths, F = half_planes(np.linspace(-0.4, 0.4, 201))
    n, load, friction = len(middles), 1.0, 0.5
    zero, one = np.zeros((n, n)), np.ones(n)
    shift, opening = np.concatenate([one, 0 * one]), np.concatenate([0 * one, one])
    problem = cattaneo.from_compliance(
        np.block([[F, zero], [zero, F]]), np.column_stack([shift, opening]), forces={"P": [0, -1], "Q": [1, 0]},
        gap=middles**2 / 2, friction=friction, weights=lengths, arc_length=middles,
    )  # fmt: skip
    assert not problem.coupled and problem.rigid_motions.shape == (2 * n, 2)
    report = cattaneo.march(problem, [{}, {"P": load}, {"Q": 0.3}])
    # Johnson: a² = 4 P R/(π E*) and p0 = 2 P/(π a); the stick zone is a sqrt(1 - Q/f P).
    a = np.sqrt(4 * load * SOFTNESS / np.pi)
    spacing = lengths[0]
    assert readout.contact_zone(problem, report.state).width / 2 == pytest.approx(a, abs=spacing / 2)
    assert readout.tractions(problem, report.state.p).max() == pytest.approx(2 * load / (np.pi * a), rel=2e-3)
    assert readout.stick_zone(problem, report.state).width / 2 == pytest.approx(a * np.sqrt(0.4), abs=spacing)
    assert report.state.p.sum() == pytest.approx(load, rel=1e-12)
    assert report.state.q.sum() == pytest.approx(-0.3, rel=1e-12)


def test_a_condensed_body_and_back():
    """The generalised inverse of the S of a free body, and any multiple of its motions added, are its S again."""
    body = strip(order=2)
    condensed = cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0))
    S = np.array(condensed.S)
    x = condensed.line.positions[:, 0]
    n = len(x)
    motions = np.zeros((2 * n, 3))
    motions[:n, 0] = motions[n:, 1] = 1
    motions[n:, 2] = x
    random = np.random.default_rng(5)
    for added in (np.zeros((3, 3)), 10 * random.standard_normal((3, 3))):
        F = np.linalg.pinv(S, rcond=1e-10) + motions @ (added + added.T) @ motions.T
        problem = cattaneo.from_compliance(F, motions @ random.standard_normal((3, 3)), gap=0.0)
        assert abs(problem.K - S).max() < 1e-9 * abs(S).max()
    assert problem.coupled


def test_loads_are_those_of_the_same_body_by_its_stiffness():
    """A strip that a traction presses and shears, by its matrix and by the compliance of its contact nodes."""
    body = strip(order=2)
    top, bottom = body.places[:, 1] == 1, body.places[:, 1] == 0
    body.add_traction("P", top, (0, -1))
    body.add_traction("Q", top, (1, 0))
    condensed = cattaneo.condense(body, body.contact_line(bottom))
    direct = cattaneo.reduce(condensed).problem
    n = direct.nodes
    x = condensed.line.positions[:, 0]
    motions = np.zeros((2 * n, 3))
    motions[:n, 0] = motions[n:, 1] = 1
    motions[n:, 2] = x
    # Contact nodes move by -S⁺ f under a load whose forces f they do not resist, but for motions of the body.
    S = np.linalg.pinv(direct.K, rcond=1e-10)
    clamped = {name: direct.clamped_forces({name: 1}) for name in ("P", "Q")}
    # The motions do with both as their forces do on them.
    problem = cattaneo.from_compliance(
        S, motions,
        forces={name: -motions.T @ f for name, f in clamped.items()},
        displacements={name: -S @ f for name, f in clamped.items()},
    )  # fmt: skip
    for name, f in clamped.items():
        assert problem.clamped_forces({name: 1}) == pytest.approx(f, abs=1e-9)
    assert problem.H.size == 0  # what such loads do to the held body is not known
    problem.friction = direct.friction = 0.4
    history = [{}, {"P": 1}, {"Q": 0.2}]
    states = [cattaneo.march(each, history).state for each in (problem, direct)]
    assert states[0].p == pytest.approx(states[1].p, abs=1e-9)
    assert states[0].q == pytest.approx(states[1].q, abs=1e-9)


def test_rectangles_on_a_half_space():
    """Displacements of HalfSpace as a compliance are its own reduced problem, with its loads and conjugates."""
    centres = np.array([(i, j) for i in range(4) for j in range(3)], dtype=float)
    steel, rubber = cattaneo.Material(2.0, 0.3), cattaneo.Material(0.5, 0.45)
    space = cattaneo.HalfSpace(steel, rubber, size=1.0, centres=centres)
    n = len(centres)
    columns = [space.displacements(centres, unit).T.ravel() for unit in np.eye(3 * n)]
    F = np.column_stack(columns)
    shift_x, shift_y, approach = np.zeros((3, 3 * n))
    shift_x[:n] = shift_y[n : 2 * n] = 1
    approach[2 * n :] = -1
    problem = cattaneo.from_compliance(
        (F + F.T) / 2, np.column_stack([shift_x, shift_y, approach]), components=2,
        forces={"Q1": [1, 0, 0], "Q2": [0, 1, 0], "P": [0, 0, 1]}, gap=0.0, weights=1.0,
    )  # fmt: skip
    own = space.problem(0.0)
    assert problem.components == 2 and problem.coupled
    assert abs(problem.K - own.K).max() < 1e-10 * abs(own.K).max()
    for name in own.loads:
        load = {name: 1.0}
        assert problem.clamped_forces(load) == pytest.approx(own.clamped_forces(load), abs=1e-10)
    order = [problem.loads.index(name) for name in own.loads]
    assert problem.H[np.ix_(order, order)] == pytest.approx(own.H, abs=1e-10)


def test_an_indenter_that_is_pressed_in():
    """A displacement that gives the force P of a march under forces moves by what P moves: loads that are each other's
    conjugate; and the energy of both is one."""
    middles, lengths, F = half_planes(np.linspace(-0.4, 0.4, 81))
    one = np.ones(len(middles))
    facts = {"components": 0, "gap": middles**2 / 2, "weights": lengths}
    pressed = cattaneo.from_compliance(F, one[:, None], forces={"P": [-1]}, **facts)
    moved = cattaneo.from_compliance(F, displacements={"D": -one}, **facts)
    under = cattaneo.march(pressed, [{}, {"P": 1}])
    approach = under.conjugates["P"][-1]
    driven = cattaneo.march(moved, [{}, {"D": approach}])
    assert driven.conjugates["D"][-1] == pytest.approx(1, rel=1e-9)
    assert driven.state.p == pytest.approx(under.state.p, abs=1e-9)


_, LENGTHS, GOOD = half_planes(np.linspace(-1, 1, 4))
ONES = np.ones((3, 1))


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"F": GOOD[:2]}, r"F has shape \(2, 3\), must be square with 1 rows per node"),
        ({"F": GOOD, "components": 1}, r"F has shape \(3, 3\), must be square with 2 rows per node, as components is 1"),
        ({"F": GOOD, "components": 3}, "components is 3, must be 0, 1 or 2"),
        ({"F": GOOD * [1, 2, 1]}, r"F\[0, 1\] is .* and F\[1, 0\] is .*, must be equal: columns are of nodal forces"),
        ({"F": GOOD + [[0, 0, 0], [0, np.nan, 0], [0, 0, 0]]}, r"F\[1, 1\] is nan, must be finite"),
        ({"F": -GOOD}, "F is not positive definite: forces that balance on the rigid motions do no work"),
        ({"F": np.ones((3, 3)), "rigid_motions": None}, "F is not positive definite: some forces do no work"),
        ({"F": GOOD, "rigid_motions": np.ones((2, 1))}, r"rigid_motions has shape \(2, 1\), must be \(3, k\)"),
        ({"F": GOOD, "rigid_motions": np.hstack([ONES, 0 * ONES])}, r"rigid_motions\[:, 1\] is zero"),
        ({"F": GOOD, "rigid_motions": np.hstack([ONES, 2 * ONES])}, "rigid_motions are not independent"),
        ({"F": GOOD, "rigid_motions": np.eye(3)}, "rigid_motions has 3 columns, must have fewer than F has rows, 3"),
        ({"F": GOOD, "forces": {"P": [-1, 0]}}, r"forces\['P'\] has shape \(2,\), must be \(1,\), one for each"),
        ({"F": GOOD, "displacements": {"D": [1]}}, r"displacements\['D'\] has shape \(1,\), must be \(3,\), of all"),
        ({"F": "stiff"}, "F is not an array of numbers, must be square"),
        ({"F": GOOD, "weights": [1, 2]}, "weights"),
    ],
)
def test_mistakes(values, sentence):
    values = {"rigid_motions": ONES, "components": 0, **values}
    with pytest.raises(cattaneo.InputError, match=sentence):
        cattaneo.from_compliance(**values)

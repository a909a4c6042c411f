"""Reports keep interfaces apart: forces, slip and losses of each, in numbers, pictures and words."""

import json

import cattaneo
import numpy as np
import pytest
from cattaneo import readout
from test_bodies import column


@pytest.fixture
def stacked():
    """Three strips on the ground, pressed and pushed at the top; the lowest is held."""
    bodies, lines = column(1.0, 2.0, 0.5)
    bodies[0].fix(bodies[0].places[:, 1] == 0, "xy")
    bodies[2].add_traction("Q", bodies[2].places[:, 1] == bodies[2].places[:, 1].max(), (0.1, 0))
    condensed = [
        cattaneo.condense(bodies[0], lines[0][1]),
        cattaneo.condense(bodies[1], cattaneo.joined(lines[1])),
        cattaneo.condense(bodies[2], lines[2][0]),
    ]
    faces = [
        cattaneo.Interface("lower", (0, lines[0][1]), (1, lines[1][0])),
        cattaneo.Interface("upper", (1, lines[1][1]), (2, lines[2][0])),
    ]
    problem = cattaneo.reduce(condensed, faces).problem
    problem.friction = 0.3
    return problem


def test_sums_and_numbers_of_each(stacked):
    history = cattaneo.LoadHistory.through(
        stacked, [{}, {"P": 1}, {"Q": 1}, {"Q": -1}, {"Q": 1}], cycle_start=2, cycles=2
    )
    report = cattaneo.march(stacked, history, keep_states=True, settings=cattaneo.MarchSettings(loss_error=True))
    faces = report.interfaces
    assert list(faces) == ["lower", "upper"]
    assert sorted(np.concatenate([each.nodes for each in faces.values()])) == list(range(stacked.nodes))
    for each in faces.values():
        # Equilibrium: both joints carry what is put on the top.
        pressed = report.time >= 1
        assert each.normal_force[pressed] == pytest.approx(1)
        assert abs(each.tangential_force[pressed]) == pytest.approx(abs(0.1 * report.multipliers["Q"][pressed]), abs=1e-12)
        for k, state in enumerate(report.states):
            assert each.normal_force[k] == pytest.approx(state.p[each.nodes].sum(), abs=1e-14)
            weights = stacked.weights[each.nodes]
            assert each.slip[k] == pytest.approx((weights * state.v[each.nodes]).sum() / weights.sum(), abs=1e-14)
        assert (each.sticking + each.slipping + each.open == len(each.nodes)).all()
        assert each.dissipation == pytest.approx([cycle.node_dissipation[each.nodes].sum() for cycle in report.cycles])
    assert (faces["lower"].sticking + faces["upper"].sticking == report.stick).all()
    lost = faces["lower"].dissipation + faces["upper"].dissipation
    assert lost == pytest.approx([cycle.dissipation for cycle in report.cycles])
    assert lost.max() > 0
    said = repr(report)
    assert "interface 'lower': 5 nodes, normal force 1, tangential force" in said and "interface 'upper'" in said


def test_pictures_and_pages(stacked):
    plot = pytest.importorskip("matplotlib.pyplot")
    report = cattaneo.march(stacked, [{}, {"P": 1}, {"Q": 1}])
    axes = report.plot()
    assert len(axes) == 2 * 2 + 1  # tractions and slip of each, and the loop of Q
    assert [axis.get_title() for axis in axes[:4]] == ["lower", "lower", "upper", "upper"]
    for k, name in enumerate(report.interfaces):
        drawn = axes[2 * k].lines[0].get_ydata()
        assert len(drawn) == 5 and drawn.sum() == pytest.approx(
            (report.state.p / stacked.weights)[report.interfaces[name].nodes].sum()
        )
    with pytest.raises(ValueError, match="axes are 1, must be 5"):
        report.plot(axes[:1])
    plot.close("all")
    page = report._repr_html_()
    assert page.count("<table>") == 2 and "<td>lower</td><td>1</td>" in page and "<th>displacement or reaction</th>" in page
    assert stacked._repr_html_().startswith("<pre>ReducedProblem: 10 contact nodes")


def test_zones_say_what_they_are(stacked):
    state = cattaneo.march(stacked, [{}, {"P": 1}]).state
    zones = readout.contact_zones(stacked, state)
    assert [zone.interface for zone in zones] == ["lower", "upper"] and [zone.state for zone in zones] == [None, None]
    first, last = stacked.position[[zones[0].first, zones[0].last]]  # the whole line
    assert repr(zones[0]) == "<Zone: contact from 0 to 1 of 'lower', ({:g}, {:g}) to ({:g}, {:g})>".format(*first, *last)
    assert readout.zones(stacked, state)[0].state == cattaneo.NodeState.stick
    nothing = readout.contact_zone(stacked, cattaneo.ContactState.virgin(stacked))
    assert repr(nothing) == "<Zone: no contact>" and nothing.width == 0
    assert repr(readout.stick_zone(stacked, cattaneo.ContactState.virgin(stacked))) == "<Zone: no stick>"


def test_zones_have_places():
    """The line of a half-plane whose body is above runs along x; its contact nodes begin at x = -1.5."""
    steel = cattaneo.Material(young=210.0, poisson=0.3)
    upper = cattaneo.HalfPlane(steel, depth=1e4, normal=(0, 1), forces={"P": (0, -1)})
    problem = cattaneo.reduce(cattaneo.condense(upper, np.linspace(-1.5, 1.5, 31)), cattaneo.HalfPlane(steel, depth=1e4)).problem
    problem.gap = problem.position[:, 0] ** 2 / 2
    report = cattaneo.march(problem, [{}, {"P": 90.0}])
    (face,) = report.interfaces.values()
    assert [str(zone.state) for zone in face.zones] == [str(zone.state) for zone in readout.zones(problem, report.state)]
    assert len(face.zones) >= 3
    start, sign = problem.position[0, 0], np.sign(problem.position[-1, 0] - problem.position[0, 0])
    for zone in face.zones:
        for end, place in ((zone.from_, zone.from_place), (zone.to, zone.to_place)):
            assert place == pytest.approx([start + sign * (float(end) - problem.arc_length[0]), 0], abs=1e-12)
    closed = readout.contact_zone(problem, report.state)
    assert closed.from_place[0] == pytest.approx(-closed.to_place[0], abs=1e-9)
    assert f"({closed.from_place[0]:g}, 0) to ({closed.to_place[0]:g}, 0)" in repr(closed)
    assert repr(face).count("\n") == len(face.zones)


def test_one_interface_of_a_problem_by_hand():
    one = np.eye(2)
    problem = cattaneo.ReducedProblem(one, 0 * one, one, [cattaneo.LoadPattern("P", [0, 0], [1, 2])])
    report = cattaneo.march(problem, [{}, {"P": 1}])
    face = report.interfaces["contact"]
    assert list(face.nodes) == [0, 1] and face.normal_force[-1] == 3
    assert "normal force 3, tangential force 0, dissipation 0" in repr(report)
    assert json.loads(json.dumps(list(report.interfaces))) == ["contact"]


def test_two_tangents_have_a_force_each():
    space = cattaneo.HalfSpace(cattaneo.Material(1.0, 0.3), size=1.0, centres=[(0, 0), (1, 0), (2, 0)], ends=True)
    problem = space.problem(0.0)
    problem.friction = 0.5
    report = cattaneo.march(problem, [{}, {"P": 1}, {"Q1": 0.1, "Q2": 0.2}])
    face = report.interfaces["contact"]
    assert face.tangential_force.shape == face.slip.shape == (len(report.time), 2)
    assert -face.tangential_force[-1] == pytest.approx([0.1, 0.2])
    assert "tangential force -0.1 and -0.2" in repr(face)
    assert "-0.1 and -0.2" in report._repr_html_()

"""Contact of half-spaces in three dimensions."""

from xml.etree import ElementTree

import cattaneo
import numpy as np
import pytest
from cattaneo import NodeState
from conftest import ROOT

MATERIAL = cattaneo.Material(young=2.0 * 1.3, poisson=0.3)  # G = 1
ONE = cattaneo.MarchSettings(increments=1)  # of each leg: slip hardly turns


def squares(across, edge):
    places = edge * (np.arange(across) - (across - 1) / 2)
    x, y = np.meshgrid(places, places)
    return np.column_stack([x.ravel(), y.ravel()])


def test_sphere_in_stick_and_slip():
    """Two spheres of one material: Hertz' approach a²/R, and the radius of stick a (1 - Q/fP)^⅓ of Cattaneo and Mindlin. At
    ν = 0.3 the latter is right to a few per cent: half the width of a square here."""
    a, radius, friction, share = 1.0, 20.0, 0.4, 0.7
    load = 4 / 3 / (1 - 0.3) * a**3 / radius  # E* = G/(1 - ν)
    edge = 2 * a / 15
    space = cattaneo.HalfSpace(MATERIAL, MATERIAL, size=edge, centres=squares(17, edge))
    problem = space.problem(gap=(space.centres**2).sum(axis=1) / (2 * radius))
    problem.friction = friction
    assert problem.loads == ["Q1", "Q2", "P"] and problem.components == 2 and not problem.coupled
    history = [{}, {"P": load}, {"Q2": share * friction * load}]
    state = cattaneo.march(problem, history, settings=ONE).state
    approach = cattaneo.conjugates(problem, state)[problem.loads.index("P")]
    assert approach == pytest.approx(a**2 / radius, rel=2e-3)
    stick = problem.weights[state.status == NodeState.stick].sum()
    assert np.sqrt(stick / np.pi) == pytest.approx(a * np.cbrt(1 - share), abs=edge / 2)
    q = state.q.reshape(2, -1)
    assert q[1].sum() == pytest.approx(-share * friction * load, rel=1e-9)  # against the far force on the same body
    slips = state.status == NodeState.slip
    assert np.hypot(*q)[slips] == pytest.approx(friction * state.p[slips], rel=1e-9)

    areas = cattaneo.readout.contact_areas(problem, state)
    assert float(areas.stick) == pytest.approx(stick) and areas.slip.nodes == slips.sum()
    for part, exact in ((areas.contact, a), (areas.stick, a * np.cbrt(1 - share))):
        assert abs(part.area - np.pi * exact**2) < part.error
    assert areas.contact.area + areas.separation.area == pytest.approx(problem.weights.sum())
    with pytest.raises(cattaneo.InputError, match="must have 2: on a line use zones"):
        plane = cattaneo.load_reduced_problem(ROOT / "problems" / "hertz.json")
        cattaneo.readout.contact_areas(plane, cattaneo.ContactState.virgin(plane))


def test_displacements_of_a_square():
    """Love: under a uniform pressure p the middle of a square of edge l sinks by (4/π) ln(1 + √2) (1 - ν²) p l/E."""
    space = cattaneo.HalfSpace(MATERIAL, size=[0.5, 0.5], centres=[[0.0, 0.0]])
    moved = space.displacements([[0.0, 0.0], [0.25, 0.25]], [0.0, 0.0, 0.25])
    sinks = 4 / np.pi * np.log(1 + np.sqrt(2)) * (1 - 0.3**2) * 0.5 / 2.6
    assert moved[:, 2] == pytest.approx([sinks, sinks / 2], rel=1e-13)
    assert space.other is None and space.material.young == 2.6 and not space.turns


def test_stresses_on_the_axis_of_a_sphere():
    """Hertz (Johnson 1985, 3.45): σ_zz = -p0/(1 + z²/a²) on the axis, in both bodies; radii are equal, so is all else."""
    edge, load = 2 / 15, 4 / 3 / 0.7 / 20
    space = cattaneo.HalfSpace(MATERIAL, MATERIAL, size=edge, centres=squares(17, edge))
    problem = space.problem(gap=(space.centres**2).sum(axis=1) / 40)
    state = cattaneo.march(problem, [{}, {"P": load}], settings=ONE).state
    z = np.array([0.3, 1.0, -0.3, -1.0])
    stresses = space.stresses(np.column_stack([0 * z, 0 * z, z]), np.concatenate([state.q, state.p]))
    peak = 1.5 * load / np.pi
    assert stresses[:, 2] == pytest.approx(-peak / (1 + z**2), abs=2e-3 * peak)
    assert np.abs(stresses[:, 3:]).max() < 1e-12 * peak


def test_torsion_of_squares_and_of_rings():
    """Two ways to one contact: squares, and the half-space about an axis whose kernels are elliptic integrals. Two equal
    spheres are pressed and twisted by half of what makes them spin, 3π f P a/16. Both paths are this library's own."""
    nu, a, radius, f = 0.3, 1.0, 20.0, 0.4
    load = 4 / 3 / (1 - nu) * a**3 / radius
    torque = 0.5 * 3 * np.pi / 16 * f * load * a
    edge = 2 * a / 21
    space = cattaneo.HalfSpace(MATERIAL, MATERIAL, size=edge, centres=squares(23, edge), turns=True)
    problem = space.problem(gap=(space.centres**2).sum(axis=1) / (2 * radius))
    problem.friction = f
    state = cattaneo.march(problem, [{}, {"P": load}, {"T": torque}], settings=ONE).state
    turn = cattaneo.conjugates(problem, state)[problem.loads.index("T")]

    line = np.linspace(0, 1.1 * a, 45)
    above = cattaneo.HalfPlane(MATERIAL, normal=(0, 1), forces={"P": (0, -1)})
    bodies = [
        [cattaneo.condense(each, line, 2, way) for each in (above, cattaneo.HalfPlane(MATERIAL))]
        for way in ("axisymmetric", "torsion")
    ]
    rings = cattaneo.reduce(*bodies[0], torsion=bodies[1]).problem
    r = rings.position[:, 0]
    n = len(r)
    # The far body turns by the angle that a displacement prescribes: all circumferential nodes by r.
    turning = -np.concatenate([np.zeros(n), rings.A[n:, n:] @ r])
    patterns = [*rings.patterns, cattaneo.LoadPattern("turn", turning, np.zeros(n), control="displacement")]
    twisted = cattaneo.ReducedProblem(
        rings.A, rings.B, rings.C, patterns, gap=r**2 / (2 * radius), friction=f, weights=rings.weights)
    state = cattaneo.march(twisted, [{}, {"P": load}, {"turn": turn}], settings=ONE).state
    assert abs(state.q[n:] @ r) == pytest.approx(torque, rel=5e-3)


def test_contact_at_the_rim_is_said_to_be_cut_off():
    """Squares that a sphere presses all of: the march warns, unless a body ends there. The resultant is the load."""
    gap = (squares(5, 0.2) ** 2).sum(axis=1) / 40
    for ends in (False, True):
        space = cattaneo.HalfSpace(MATERIAL, size=0.2, centres=squares(5, 0.2), ends=ends)
        problem = space.problem(gap)
        problem.friction = 0.3
        assert len(problem.rim) == (0 if ends else 16) and problem.position.shape == (25, 3)
        if ends:
            state = cattaneo.march(problem, [{}, {"P": 1.0}], settings=ONE).state
        else:
            with pytest.warns(cattaneo.OutcomeWarning, match="up to the rim of its surface"):
                state = cattaneo.march(problem, [{}, {"P": 1.0}], settings=ONE).state
        forces = np.concatenate([state.q, state.p])
        assert space.resultant(forces) == pytest.approx([0, 0, 1, 0, 0, 0], abs=1e-9)
        shear = cattaneo.readout.tractions(problem, state.q)
        assert shear * np.tile(problem.weights, 2) == pytest.approx(state.q) and shear.shape == (50,)


def test_rigid_motions_are_handed_over():
    """The half-space's own matrices with its three motions, sought or stated; one that is missing is named."""
    problem = cattaneo.HalfSpace(MATERIAL, size=0.2, centres=squares(3, 0.2)).problem(gap=0.0)
    parts = problem.A, problem.B, problem.C, problem.patterns
    motions = np.kron(np.eye(3), np.ones((9, 1)))
    stated = cattaneo.ReducedProblem(*parts, rigid_motions=motions)
    assert stated.rigid_motions.shape == cattaneo.ReducedProblem(*parts).rigid_motions.shape == (27, 3)
    with pytest.raises(cattaneo.InputError, match="it lists 2 rigid motions, must list all 3 that the stiffness does not resist"):
        cattaneo.ReducedProblem(*parts, rigid_motions=motions[:, :2])


def test_a_file_for_paraview(tmp_path):
    """What a reader of VTU finds: quadrilaterals that cover the surface once, and the values of the state."""
    space = cattaneo.HalfSpace(MATERIAL, size=[0.2, 0.3], centres=[[0.0, 0.0], [0.2, 0.0], [0.2, 0.3]], ends=True)
    problem = space.problem(gap=[0.0, 0.0, 1.0])
    problem.friction = 0.3
    state = cattaneo.march(problem, [{}, {"P": 0.1}, {"Q1": 0.01}], settings=ONE).state
    file = tmp_path / "contact.vtu"
    space.write_vtu(file, problem, state)
    root = ElementTree.parse(file).getroot()
    found = {
        each.get("Name"): np.array(each.text.split(), dtype=float).reshape(-1, int(each.get("NumberOfComponents")))
        for each in root.iter("DataArray")
    }
    assert list(found["types"].ravel()) == [9, 9, 9] and list(found["offsets"].ravel()) == [4, 8, 12]
    x, y = found["Points"][found["connectivity"].astype(int)][:, :, :2].transpose(2, 0, 1)
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)  # counter-clockwise
    assert area == pytest.approx(0.06) and np.column_stack([x.mean(axis=1), y.mean(axis=1)]) == pytest.approx(space.centres)
    assert (found["pressure"][:, 0] * area).sum() == pytest.approx(0.1)
    assert (found["shear"] * area[:, None]).sum(axis=0) == pytest.approx([-0.01, 0, 0], abs=1e-12)
    assert (found["slip"][:, :2] == state.v.reshape(2, 3).T).all() and (found["opening"][:, 0] == state.w + problem.gap).all()
    assert list(found["state"][:, 0]) == list(cattaneo.settled_states(problem, state))
    with pytest.raises(cattaneo.InputError, match="does not belong to these half-spaces"):
        space.write_vtu(file, cattaneo.load_reduced_problem(ROOT / "problems" / "hertz.json"), state)


def test_triangles_of_squares():
    """Squares cut into triangles and squares: two discretisations of one rigid sphere, whose closed form has the approach
    a²/R (Hertz, for a rigid sphere without friction). The mean gap over a triangle is exact by the middles of its edges."""
    a, radius = 1.0, 20.0
    load = 8 / 3 / (1 - 0.3) * a**3 / radius
    places = np.linspace(-1.2, 1.2, 13)
    x, y = np.meshgrid(places, places)
    vertices = np.column_stack([x.ravel(), y.ravel()])
    first = np.arange(13 * 12).reshape(12, 13)[:, :-1].ravel()
    triangles = np.concatenate([np.column_stack([first, first + 1, first + 14]), np.column_stack([first, first + 14, first + 13])])
    space = cattaneo.HalfSpace(MATERIAL, vertices=vertices, triangles=triangles)
    assert space.areas == pytest.approx(0.02) and space.centres.shape == (0, 2) and (space.triangles == triangles).all()
    assert space.middles == pytest.approx(vertices[triangles].mean(axis=1))
    edges = (vertices[triangles] + vertices[np.roll(triangles, 1, axis=1)]) / 2
    problem = space.problem(gap=(edges**2).sum(axis=2).mean(axis=1) / (2 * radius))
    problem.friction = 0.0
    state = cattaneo.march(problem, [{}, {"P": load}], settings=ONE).state
    approach = cattaneo.conjugates(problem, state)[problem.loads.index("P")]
    assert approach == pytest.approx(a**2 / radius, rel=2e-3)
    assert cattaneo.readout.contact_areas(problem, state).contact.area == pytest.approx(np.pi * a**2, abs=np.pi * a * 0.1)
    edge = cattaneo.readout.radial_edges(problem, state, centre=(0, 0)).contact
    assert abs(float(edge) - a) <= edge.error < 0.1
    closed = cattaneo.settled_states(problem, state) != NodeState.separation
    (line,) = space.outlines(closed)
    x, y = line.T
    assert (x[:-1] @ y[1:] - x[1:] @ y[:-1]) / 2 == pytest.approx(space.areas[closed].sum())
    with pytest.raises(cattaneo.InputError, match="rectangles have centres and no size"):
        cattaneo.HalfSpace(MATERIAL, centres=[[0.0, 0.0]])
    with pytest.raises(cattaneo.InputError, match="not whole numbers"):
        cattaneo.HalfSpace(MATERIAL, vertices=vertices, triangles=triangles + 0.5)


def test_what_is_refused():
    good = {"size": 0.1, "centres": squares(3, 0.1)}
    cattaneo.HalfSpace(MATERIAL, **good)
    for change, sentence in (
        ({"size": -1.0}, "must be positive"),
        ({"size": [0.1, 0.2, 0.3]}, "size"),
        ({"centres": np.zeros((2, 2))}, "is there twice"),
        ({"centres": [[0, 0], [0.15, 0]]}, "must be whole numbers of edges"),
        ({"other": cattaneo.Material(1.0, 0.3, plane_stress=True)}, "must be of plane strain"),
    ):
        with pytest.raises(cattaneo.InputError, match=sentence):
            cattaneo.HalfSpace(MATERIAL, **{**good, **change})
    with pytest.raises(cattaneo.InputError, match="gap"):
        cattaneo.HalfSpace(MATERIAL, **good).problem(gap=np.zeros(4))


def test_a_measured_surface(tmp_path):
    """A sphere that was measured every 0.05 is pressed as the sphere is: gaps differ by 0.05²/8R at most."""
    places = np.linspace(-1.2, 1.2, 49)
    sphere = -(places[:, None] ** 2 + places**2) / 20
    (tmp_path / "sphere.sdf").write_text(
        "aISO-1.0\nNumPoints = 49\nNumProfiles = 49\nXscale = 5e-5\nYscale = 5e-5\nZscale = 1e-3\n*\n"
        + "\n".join(" ".join(map(repr, row.tolist())) for row in sphere) + "\n*\n")
    heights = cattaneo.read_heights(tmp_path / "sphere.sdf", unit=1e-3)
    assert heights.step == pytest.approx([0.05, 0.05], rel=1e-12) and heights.z == pytest.approx(sphere, rel=1e-12)
    assert cattaneo.Heights(sphere, step=0.05).at([[0.1, -0.2]]) == pytest.approx([-0.05 / 20], rel=1e-12)
    space = cattaneo.HalfSpace(MATERIAL, MATERIAL, size=0.13, centres=squares(17, 0.13))
    gaps = heights.z.max() - heights.at(space.centres), (space.centres**2).sum(axis=1) / 20
    assert np.abs(gaps[0] - gaps[1]).max() <= 2 * 0.05**2 / 8 / 10
    approaches = []
    for gap in gaps:
        problem = space.problem(gap)
        state = cattaneo.march(problem, [{}, {"P": 0.19}], settings=ONE).state
        approaches.append(cattaneo.conjugates(problem, state)[problem.loads.index("P")])
    assert approaches[0] == pytest.approx(approaches[1], abs=2 * 0.05**2 / 8 / 10)

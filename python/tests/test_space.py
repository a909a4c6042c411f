"""Bodies in space: scikit-fem's hexahedra, their surfaces, pairs, obstacles and fields."""

import cattaneo
import numpy as np
import pytest

CORNERS = [0, 3, 6, 2, 1, 5, 7, 4]  # scikit-fem's corners of a hexahedron, one side after the other


def block(x, y, z, young=1.0, poisson=0.3, name="body"):
    """Hexahedra between planes at these places; rows of K are x, y and z of each node."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshHex.init_tensor(np.asarray(x, float), np.asarray(y, float), np.asarray(z, float))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    K = linear_elasticity(*lame_parameters(young, poisson)).assemble(basis)
    return cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t[CORNERS].T, name=name)


def plane_block(x, y, young=1.0, poisson=0.3):
    """The same in plane strain."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshQuad.init_tensor(np.asarray(x, float), np.asarray(y, float))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=2)
    K = linear_elasticity(*lame_parameters(young, poisson)).assemble(basis)
    return cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t.T)


def pressed(lower, upper, load):
    """The lower block held below, loads P and Q on top of the upper one."""
    lower.fix(lower.places[:, 1] == lower.places[:, 1].min(), load["all"])
    top = upper.places[:, 1] == upper.places[:, 1].max()
    upper.add_traction("P", top, load["P"])
    upper.add_traction("Q", top, load["Q"])


def test_extruded_block_is_the_plane_one():
    """Two blocks in plane strain, pressed and sheared to and fro: forces are those of the plane by thickness, to 1e-10."""
    x, low, up = np.linspace(0, 2, 9), np.linspace(-1, 0, 4), np.linspace(0, 1, 4)
    history = [{}, {"P": 1}, {"P": 1, "Q": 0.25}, {"P": 1, "Q": -0.25}, {"P": 1, "Q": 0.2}]
    lower, upper = plane_block(x, low, 5, 0.2), plane_block(x, up, 1, 0.3)
    pressed(lower, upper, {"all": "xy", "P": (0, -1), "Q": (1, 0)})
    flat = cattaneo.reduce(
        *(cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0)) for body in (upper, lower))
    )
    flat.problem.friction = 0.3
    report = cattaneo.march(flat.problem, history)
    place = flat.bodies[0].line.positions[:, 0]
    plane = {"p": dict(zip(np.round(place, 9), report.state.p)), "q": dict(zip(np.round(place, 9), report.state.q))}
    assert (np.abs(report.state.q) < 0.29 * report.state.p).any() and report.state.p.min() >= 0
    for layers in (1, 3):
        z = np.linspace(0, 0.6, layers + 1)
        lower, upper = block(x, low, z, 5, 0.2, "lower"), block(x, up, z, 1, 0.3, "upper")
        for body in (lower, upper):
            body.fix(np.ones(len(body.nodes), bool), "z")
        pressed(lower, upper, {"all": "xyz", "P": (0, -1, 0), "Q": (1, 0, 0)})
        bodies = [cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0)) for body in (upper, lower)]
        pairs = cattaneo.pair_surfaces(bodies[0].surface, bodies[1].surface)
        assert not pairs.gap.any()
        reduction = cattaneo.reduce(*bodies, pairs)
        problem = reduction.problem
        assert (problem.components, problem.position.shape) == (2, (len(place) * (layers + 1), 3))
        problem.friction = 0.3
        state = cattaneo.march(problem, history).state
        forces = reduction.contact_forces(0, state)
        assert forces == pytest.approx(-reduction.contact_forces(1, state)[pairs.partner], abs=1e-12)
        share = problem.weights / 0.25 * np.where((problem.position[:, 0] % 2) == 0, 2, 1)
        for node, where in enumerate(problem.position):
            key = round(where[0], 9)
            force = plane["p"][key] * share[node], plane["q"][key] * share[node]
            assert forces[node, 1] == pytest.approx(force[0], abs=1e-10)
            assert abs(forces[node, 0]) == pytest.approx(abs(force[1]), abs=1e-10)
            assert forces[node, 2] == 0
        # The top of both goes where it goes in the plane.
        u, of_plane = reduction.displacement(0, state), flat.displacement(0, report.state)
        corner = lambda body: np.flatnonzero((body.places[:, :2] == (2, 1)).all(axis=1))[0]
        flat_body = plane_block(x, up, 1, 0.3)
        assert u[upper.dofs[corner(upper), :2]] == pytest.approx(of_plane[flat_body.dofs[corner(flat_body)]], abs=1e-10)


def test_surfaces_by_masks_faces_and_sets():
    body = block([0, 1, 2], [0, 1], [0, 1, 3])
    bottom = body.places[:, 1] == 0
    by_mask = body.contact_surface(bottom)
    assert len(by_mask) == 9 and by_mask.weights.sum() == pytest.approx(6)
    assert by_mask.normals == pytest.approx(np.tile([0, 1, 0], (9, 1)))
    assert by_mask.frames[:, :3] == pytest.approx(np.tile([1, 0, 0], (9, 1)))
    numbers = {tuple(row): node for node, row in enumerate(body.places)}
    on = [[numbers[tuple(by_mask.positions[node])] for node in face] for face in by_mask.faces]
    without = cattaneo.NodalStiffness(body.K, body.places)
    by_faces = without.contact_surface(on)
    assert by_faces.weights == pytest.approx(by_mask.weights)
    assert by_faces.normals == pytest.approx(by_mask.normals)
    with pytest.raises(cattaneo.InputError, match="no elements are known"):
        without.contact_surface(bottom)
    with pytest.raises(cattaneo.InputError, match="contact_surface"):
        body.contact_line(bottom)


def test_block_on_plane_and_sphere():
    """A block bears its load on a plane, and on a sphere about the place where it is nearest."""
    body = block(np.linspace(-1, 1, 7), np.linspace(0, 1, 3), np.linspace(-1, 1, 7), 8, 0)
    body.add_traction("P", body.places[:, 1] == 1, (0, -0.01, 0))
    condensed = cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0))
    assert condensed.rigid_modes == 6
    reduction = cattaneo.reduce(condensed, cattaneo.gaps_to_plane(condensed.surface, (0, 0, 0), (0, 1, 0)))
    reduction.problem.friction = 0.2
    state = cattaneo.march(reduction.problem, [{}, {"P": 1}]).state
    assert state.p / reduction.problem.weights == pytest.approx(0.01)
    u = reduction.displacement(0, state)
    assert u[body.dofs[body.places[:, 1] == 1, 1]] == pytest.approx(-0.01 / 8)
    gaps = cattaneo.gaps_to_sphere(condensed.surface, (0, -300, 0), 300)
    x = condensed.surface.positions
    assert gaps == pytest.approx(300 - np.sqrt(300**2 - x[:, 0] ** 2 - x[:, 2] ** 2))
    ball = cattaneo.reduce(condensed, gaps)
    ball.problem.friction = 0.2
    # Friction holds the free block upright only where more than one node touches.
    state = cattaneo.march(ball.problem, [{}, {"P": 1}]).state
    assert state.p.sum() == pytest.approx(0.04) and state.p[gaps == gaps.max()] == pytest.approx(0)


def test_mistakes_are_named():
    with pytest.raises(cattaneo.InputError, match="two or three coordinates"):
        cattaneo.NodalStiffness(np.eye(4), np.zeros((1, 4)))
    with pytest.raises(cattaneo.InputError, match="no axisymmetric body"):
        cattaneo.NodalStiffness(np.eye(3), np.zeros((1, 3)), formulation="axisymmetric")
    body = block([0, 1], [0, 1], [0, 1])
    with pytest.raises(cattaneo.InputError, match="direction"):
        body.fix([0], "r")

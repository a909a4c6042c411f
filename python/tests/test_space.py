"""Bodies in space: scikit-fem's hexahedra, their surfaces, pairs, obstacles and fields."""

import shutil
import subprocess

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


def deck(kind, cells=(3, 2, 2)):
    """Two blocks of solids that touch at y = 0, the lower one held below: a deck of CalculiX, and the lower one's places and elements."""
    corners = {"C3D4": 4, "C3D10": 4, "C3D6": 6, "C3D15": 6}.get(kind, 8)
    lines, lower = [], None
    for name, low, first, young, poisson in (("LOWER", -1.0, 1, 200.0, 0.3), ("UPPER", 0.0, 1001, 100.0, 0.25)):
        x, y, z = (np.linspace(a, a + size, n + 1) for a, size, n in zip((0, low, 0), (1.5, 1, 1), cells))
        number = np.arange((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1)).reshape([n + 1 for n in cells])
        places = [np.array([x[i], y[j], z[k]]) for i, j, k in np.ndindex(number.shape)]
        elements = []
        for i, j, k in np.ndindex(*cells):
            low_side = [number[i, j, k], number[i + 1, j, k], number[i + 1, j + 1, k], number[i, j + 1, k]]
            h = [*low_side, *(node + 1 for node in low_side)]
            if corners == 8:
                elements.append(h)
            elif corners == 6:
                elements += [[h[a] for a in (0, 1, 3, 4, 5, 7)], [h[a] for a in (1, 2, 3, 5, 6, 7)]]
            else:
                elements += [[h[0], h[s], h[t], h[6]] for s, t in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1))]
        middles = {}
        for element in elements if kind in ("C3D10", "C3D15", "C3D20", "C3D20R") else []:
            for a, b in EDGES[corners]:
                ends = tuple(sorted((element[a], element[b])))
                if ends not in middles:
                    middles[ends] = len(places)
                    places.append((places[ends[0]] + places[ends[1]]) / 2)
                element.append(middles[ends])
        places = np.array(places)
        lower = (places, np.array(elements)) if lower is None else lower
        lines.append("*NODE")
        lines += [f"{first + node}, {at[0]!r}, {at[1]!r}, {at[2]!r}" for node, at in enumerate(places.tolist())]
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET={name}")
        for element in elements:
            words = [str(len(lines))] + [str(first + node) for node in element]
            rows = [", ".join(words[k : k + 10]) for k in range(0, len(words), 10)]
            lines.append(",\n".join(rows))
        for which, level in (("FACE", 0.0), ("FAR", -1.0 if name == "LOWER" else 1.0)):
            lines.append(f"*NSET, NSET={name}_{which}")
            lines += [str(first + node) for node in np.flatnonzero(np.abs(places[:, 1] - level) < 1e-12)]
        lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young}, {poisson}", "*DENSITY", "1.", f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]
    lines += ["*BOUNDARY", "LOWER_FAR, 1, 3", "*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*CLOAD", "UPPER_FAR, 2, -0.1", "*END STEP", ""]
    return "\n".join(lines), lower


EDGES = {
    4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    6: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    8: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
}
ELEMENTS = ["C3D4", "C3D6", "C3D8", "C3D8I", "C3D10", "C3D15", "C3D20", "C3D20R"]


@pytest.mark.parametrize("kind", ELEMENTS)
def test_decks_of_calculix(kind, tmp_path):
    """Two blocks by the matrix that ccx writes: pressed, sheared, in equilibrium; tetrahedra have the stiffness of scikit-fem's."""
    if shutil.which("ccx") is None:
        pytest.skip("there is no ccx (Debian: calculix-ccx) to write the matrix")
    text, (places, elements) = deck(kind)
    (tmp_path / "blocks.inp").write_text(text)
    subprocess.run(["ccx", "blocks"], cwd=tmp_path, check=True, capture_output=True, timeout=100)
    lower, upper = cattaneo.read_stiffness(str(tmp_path / "blocks.sti")).parts()
    assert (lower.name, upper.name) == ("LOWER", "UPPER")
    upper.add_traction("Q", "UPPER_FAR", (0.2, 0, 0.1))
    bodies = [cattaneo.condense(body, body.contact_surface(body.name + "_FACE")) for body in (upper, lower)]
    reduction = cattaneo.reduce(*bodies)
    reduction.problem.friction = 0.3
    report = cattaneo.march(reduction.problem, [{}, {"CLOAD1": 1}, {"CLOAD1": 1, "Q": 1}])
    forces = reduction.contact_forces(0, report.state)
    count = len(upper.nodes_of("UPPER_FAR"))
    assert forces.sum(axis=0) == pytest.approx([-0.2 * 1.5, 0.1 * count, -0.1 * 1.5], abs=1e-10)
    if kind not in ("C3D4", "C3D10"):
        return
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshTet(places[: elements[:, :4].max() + 1].T, elements[:, :4].T)
    element = skfem.ElementTetP1() if kind == "C3D4" else skfem.ElementTetP2()
    basis = skfem.Basis(mesh, skfem.ElementVector(element))
    K = linear_elasticity(*lame_parameters(200.0, 0.3)).assemble(basis)
    at = basis.doflocs.T[::3]
    own = cattaneo.NodalStiffness(K, at, elements=basis.element_dofs.T[:, ::3] // 3)
    own.fix(own.places[:, 1] == -1, "xyz")
    theirs, ours = bodies[1], cattaneo.condense(own, own.contact_surface(own.places[:, 1] == 0))
    order = [np.argmin(np.abs(ours.surface.positions - place).sum(axis=1)) for place in theirs.surface.positions]
    rows = np.concatenate([np.array(order) + len(order) * c for c in range(3)])
    assert theirs.S == pytest.approx(ours.S[np.ix_(rows, rows)], abs=1e-10 * ours.S.max())


def test_faces_of_order_two():
    """tri 6 and quad 8: a block on a plane bears a pressure at all of its unknowns, and nodes get the consistent forces of their own."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    grid = np.linspace(0, 1, 5)
    for mesh, element, nodes in (
        (skfem.MeshTet.init_tensor(grid, grid, grid), skfem.ElementTetP2(), 81),
        (skfem.MeshHex.init_tensor(grid, grid, grid), skfem.ElementHexS2(), 65),
    ):
        basis = skfem.Basis(mesh, skfem.ElementVector(element), intorder=4)
        K = linear_elasticity(*lame_parameters(1.0, 0.3)).assemble(basis)
        elements = basis.element_dofs.T[:, ::3] // 3
        if nodes == 65:
            elements[:, :8] = elements[:, CORNERS]
        body = cattaneo.NodalStiffness(K, basis.doflocs.T[::3], elements=elements)
        body.add_traction("P", body.places[:, 1] == 1, (0, -1, 0))
        condensed = cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0))
        surface = condensed.surface
        assert len(surface) == nodes and surface.weights.min() > 0
        reduction = cattaneo.reduce(condensed)
        state = cattaneo.march(reduction.problem, [{}, {"P": 1}]).state
        assert state.p / surface.weights == pytest.approx(1)
        forces = reduction.contact_forces(0, state)
        assert forces == pytest.approx(surface.forces_at_nodes(np.outer(state.p, (0, 1, 0))), abs=1e-12)
        assert (forces[:, 1] < 1e-12).sum() >= 9
        u = np.random.default_rng(1).normal(size=(nodes, 3))
        assert surface.of_nodes(surface.at_nodes(u)) == pytest.approx(u)


def test_stack_ties_and_obstacle_that_moves():
    """Three blocks pressed on a plane: two faces in contact, or tied as one block; and the plane that comes up instead."""
    grid, tall = np.linspace(0, 1, 4), np.linspace(0, 3, 7)

    def bottom(body):
        return body.contact_surface(body.places[:, 1] == 0)

    def marched(reduction):
        reduction.problem.friction = 0.3
        return cattaneo.march(reduction.problem, [{}, {"D": 1}]).state

    def by_place(reduction, state):
        order = np.lexsort(reduction.problem.position.T)
        return reduction.problem.position[order], state.p[order]

    whole = block(grid, tall, grid, 2, 0.3)
    top = whole.places[:, 1] == 3
    whole.add_displacement("D", top, "y", -0.02)
    whole.fix(top, "xz")
    single = cattaneo.reduce(cattaneo.condense(whole, bottom(whole)), 0.001)
    places, expected = by_place(single, marched(single))
    assert expected.sum() > 0.01
    for tied in (False, True):
        parts = [block(grid, np.linspace(k, k + 1, 3), grid, 2, 0.3, f"part {k}") for k in range(3)]
        top = parts[2].places[:, 1] == 3
        parts[2].add_displacement("D", top, "y", -0.02)
        parts[2].fix(top, "xz")
        faces = [[body.contact_surface(body.places[:, 1] == y) for y in (k, k + 1) if y < 3] for k, body in enumerate(parts)]
        bodies = [cattaneo.condense(body, cattaneo.joined(own)) for body, own in zip(parts, faces)]
        interfaces = [
            cattaneo.Interface("plane", (0, faces[0][0]), gap=lambda x, y, z: 0.001),
            cattaneo.Interface("low", (0, faces[0][1]), (1, faces[1][0]), tied=tied),
            cattaneo.Interface("high", (2, faces[2][0]), (1, faces[1][1]), tied=tied),
        ]
        reduction = cattaneo.reduce(bodies, interfaces)
        assert reduction.problem.nodes == (16 if tied else 48)
        state = marched(reduction)
        if tied:
            at, pressed = by_place(reduction, state)
            assert at == pytest.approx(places) and pressed == pytest.approx(expected, rel=1e-9)
            continue
        carried = [state.p[face.first : face.first + face.nodes].sum() for face in reduction.interfaces]
        assert carried == pytest.approx([carried[0]] * 3)
        assert reduction.contact_forces(1, state).sum(axis=0) == pytest.approx(0, abs=1e-12)
    rests = block(grid, tall, grid, 2, 0.3)
    rests.fix(rests.places[:, 1] == 3, "xyz")
    moving = cattaneo.reduce(cattaneo.condense(rests, bottom(rests)), 0.001)
    moving.add_obstacle_motion("D", 0, lambda x, y, z: 0.02, 0)
    assert by_place(moving, marched(moving))[1] == pytest.approx(expected, rel=1e-9)


def test_block_of_hexahedra_under_shear_in_two_directions():
    """Values of an independent program: nodes that stick after each leg, and the work of friction, of 10 increments a leg."""
    body = block(np.linspace(-1, 1, 9), np.linspace(0, 1, 5), np.linspace(-1, 1, 9))
    top = body.places[:, 1] == 1
    # Its z is our y: x, y, z are z, x, y here.
    for name, traction in (("P", (0, -1, 0)), ("X", (0, 0, 1)), ("Y", (1, 0, 0))):
        body.add_traction(name, top, traction)
    reduction = cattaneo.reduce(cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0)))
    problem = reduction.problem
    problem.friction = 0.3
    history = [{}, {"P": 1}, {"X": 0.18}, {"Y": 0.18}]
    sticking, work, done, q, v = [], [], 0.0, 0.0, 0.0
    # The first leg is proportional, and one increment.
    for state in cattaneo.march(problem, history, increments=10, keep_states=True).states:
        done -= 0.5 * ((q + state.q) * (state.v - v)).sum()
        q, v = np.array(state.q), np.array(state.v)
        if state.time == round(state.time):
            assert (state.p > 0).all()
            sticking.append((np.hypot(*q.reshape(2, -1)) < 0.3 * state.p * (1 - 1e-9)).sum())
            work.append(done)
    assert sticking == [49, 48, 7]
    assert work == pytest.approx([0.00910645051, 0.02152934667, 0.0846171764], rel=1e-8)


def test_equilibrium_in_long_double_and_restart():
    """K u of both bodies is the loads and the contact forces; a march taken up again has the same bits."""
    x, z = np.linspace(0, 2, 6), np.linspace(0, 1, 4)
    lower, upper = block(x, np.linspace(-1, 0, 4), z, 5, 0.2), block(x, np.linspace(0, 1, 4), z, 1, 0.3)
    loads = {"all": "xyz", "P": (0, -1, 0), "Q": (0.6, 0, 0.8)}
    pressed(lower, upper, loads)
    condensed = [cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0)) for body in (upper, lower)]
    reduction = cattaneo.reduce(*condensed)
    problem = reduction.problem
    problem.friction = 0.3
    points = [{}, {"P": 1}, {"Q": 0.28}, {"Q": -0.25}]
    state = cattaneo.march(problem, cattaneo.LoadHistory.through(problem, points)).state
    first = cattaneo.march(problem, cattaneo.LoadHistory.through(problem, points[:3])).state
    again = cattaneo.march(problem, cattaneo.LoadHistory.through(problem, points), first).state
    for name in ("q", "p", "v", "w"):
        assert np.array_equal(getattr(again, name), getattr(state, name)), name
    assert reduction.warnings(state) == []
    slip = np.hypot(*state.q.reshape(2, -1)) > 0.3 * state.p * (1 - 1e-9)
    assert slip.any() and not slip.all()
    long = np.longdouble
    on, places = [], []
    for number, body in enumerate((upper, lower)):
        u = reduction.displacement(number, state).astype(long)
        K = body.K.tocoo()
        internal = np.zeros(K.shape[0], long)
        np.add.at(internal, K.row, K.data.astype(long) * u[K.col])
        external = np.zeros(K.shape[0], long)
        for name, forces in body.loads.items():
            external += long({"P": 1, "Q": -0.25}[name]) * forces.astype(long)
        dofs = condensed[number].surface.dofs
        on.append((internal - external)[dofs])  # of the contact, by K u alone
        places.append(u[dofs])
        external[dofs] += reduction.contact_forces(number, state)
        free = np.setdiff1d(np.arange(K.shape[0]), body.fixed)
        assert np.abs(internal - external)[free].max() < 2e-12 * np.abs(external).max()
    # Laws between these forces and displacements: the normal is y, the gap 0.
    partner = cattaneo.pair_surfaces(condensed[0].surface, condensed[1].surface).partner
    force, opening, size = on[0], (places[0] - places[1][partner])[:, 1], np.abs(on[0]).max()
    assert np.abs(force + on[1][partner]).max() < 4e-12 * size
    assert force[:, 1].min() > -4e-12 * size and np.abs(opening[force[:, 1] > 1e-9 * size]).max() < 4e-12 and opening.min() > -4e-12
    excess = np.hypot(force[:, 0], force[:, 2]) - long(0.3) * force[:, 1]
    assert excess.max() < 4e-12 * size and np.abs(excess[slip]).max() < 4e-12 * size


def test_support_that_moves_with_contact_nodes():
    """A side of the upper block, contact nodes among it, is moved to and fro: supports are where the load is, each row without a support is in equilibrium, and the laws hold."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    x, z = np.linspace(0, 2, 4), np.linspace(0, 1, 3)
    for make, element in (
        (skfem.MeshHex, skfem.ElementHex1()),
        (skfem.MeshHex, skfem.ElementHexS2()),
        (skfem.MeshTet, skfem.ElementTetP2()),
    ):
        bodies = []
        for low, high, young in ((-1, 0, 3.0), (0, 1, 1.0)):
            basis = skfem.Basis(make.init_tensor(x, np.linspace(low, high, 3), z), skfem.ElementVector(element), intorder=4)
            K = linear_elasticity(*lame_parameters(young, 0.3)).assemble(basis)
            elements = basis.element_dofs.T[:, ::3] // 3
            if make is skfem.MeshHex:
                elements[:, :8] = elements[:, CORNERS]
            bodies.append(cattaneo.NodalStiffness(K, basis.doflocs.T[::3], elements=elements))
        lower, upper = bodies
        lower.fix(lower.places[:, 1] == -1, "xyz")
        side = upper.places[:, 0] == 0
        upper.add_displacement("U", side, "x", 1.0)
        upper.fix(upper.places[:, 2] == 0, "z")
        lower.fix(lower.places[:, 2] == 0, "z")
        upper.add_traction("P", upper.places[:, 1] == 1, (0, -0.05, 0))
        condensed = [cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0)) for body in (upper, lower)]
        reduction = cattaneo.reduce(*condensed)
        problem = reduction.problem
        problem.friction = 0.3
        report = cattaneo.march(problem, [{}, {"P": 1}, {"U": 0.05}, {"U": -0.02}], increments=4, keep_states=True)
        state = report.state
        n = problem.nodes
        q, free = np.hypot(*state.q.reshape(2, n)), np.setdiff1d(np.arange(n), np.asarray(problem.held) % n)
        assert (state.p > -1e-12).all() and (q[free] <= 0.3 * state.p[free] + 1e-12).all()
        assert (q[free] > 0.29 * state.p[free]).sum() > 3
        multipliers = dict(zip((load.name for load in problem.patterns), state.multipliers))
        for number, body in enumerate((upper, lower)):
            u = reduction.displacement(number, state)
            if number == 0:
                assert u[body.dofs[side, 0]] == pytest.approx(-0.02)
            external = np.zeros(len(u))
            if number == 0:
                external += multipliers["P"] * body.loads["P"]
            external[condensed[number].surface.dofs] += reduction.contact_forces(number, state)
            rows = np.setdiff1d(np.arange(len(u)), body.fixed)
            assert (body.K @ u - external)[rows] == pytest.approx(0, abs=1e-13)
        # The work of all loads, that of the support's reaction among it, is stored or lost, to second order in the increments.
        finer = cattaneo.march(problem, [{}, {"P": 1}, {"U": 0.05}, {"U": -0.02}], increments=16)
        assert abs(finer.energy_imbalance) < abs(report.energy_imbalance) / 8


def test_joint_in_relative_coordinates():
    """Two blocks condensed together have the forces and displacements of both condensed alone, with half the rows."""
    x, z = np.linspace(0, 2, 5), np.linspace(0, 1, 4)
    lower, upper = block(x, np.linspace(-1, 0, 3), z, 5, 0.2, "lower"), block(x, np.linspace(0, 1, 3), z, 1, 0.3, "upper")
    pressed(lower, upper, {"all": "xyz", "P": (0, -1, 0), "Q": (0.6, 0, 0.8)})
    faces = [body.contact_surface(body.places[:, 1] == 0) for body in (upper, lower)]
    pairs = cattaneo.pair_surfaces(*faces)
    joint = cattaneo.condense_joint(upper, faces[0], lower, faces[1], pairs)
    assert joint.S.shape == (3 * len(faces[0]), 3 * len(faces[0]))
    together = cattaneo.reduce(joint, pairs.gap)
    alone = cattaneo.reduce(cattaneo.condense(upper, faces[0]), cattaneo.condense(lower, faces[1]), pairs)
    states = []
    for reduction in (together, alone):
        reduction.problem.friction = 0.3
        states.append(cattaneo.march(reduction.problem, [{}, {"P": 1}, {"Q": 0.28}, {"Q": -0.2}], increments=2).state)
    assert together.contact_forces(0, states[0]) == pytest.approx(alone.contact_forces(0, states[1]), abs=1e-12)
    apart = np.concatenate([alone.displacement(number, states[1]) for number in (0, 1)])
    assert together.displacement(0, states[0]) == pytest.approx(apart, abs=1e-12)
    with pytest.raises(cattaneo.InputError, match="second body free"):
        cattaneo.condense_joint(lower, faces[1], upper, faces[0], cattaneo.pair_surfaces(faces[1], faces[0]))


@pytest.mark.parametrize("young", [(1, 1), (1, 10), (10, 1)])
def test_supports_of_one_body_alone(young):
    """Supports hold contact nodes of the lower block alone, softer or stiffer than the upper one: both bodies alone are the joint in relative coordinates, whichever is named first."""
    x, z = np.linspace(0, 2, 4), np.linspace(0, 1, 3)
    lower, upper = block(x, np.linspace(-1, 0, 3), z, young[0], 0.2, "lower"), block(x, np.linspace(0, 1, 3), z, young[1], 0.3, "upper")
    lower.fix(lower.places[:, 1] == -1, "xyz")
    lower.fix(lower.places[:, 2] == 0, "z")
    lower.fix(lower.places[:, 0] == 2, "x")
    upper.add_traction("P", upper.places[:, 1] == 1, (0.1, -1, 0.05))
    faces = [body.contact_surface(body.places[:, 1] == 0) for body in (upper, lower)]
    pairs = cattaneo.pair_surfaces(*faces)
    both = [cattaneo.condense(body, face) for body, face in zip((upper, lower), faces)]
    joint = cattaneo.condense_joint(upper, faces[0], lower, faces[1], pairs)
    forces = []
    for reduction, of_upper in ((cattaneo.reduce(joint, pairs.gap), 0), (cattaneo.reduce(*both), 0), (cattaneo.reduce(*both[::-1]), 1)):
        reduction.problem.friction = 0.2
        state = cattaneo.march(reduction.problem, [{}, {"P": 1}, {"P": 0.7}], increments=3).state
        forces.append(reduction.contact_forces(of_upper, state))
    assert forces[0].sum(axis=0) == pytest.approx([-0.14, 1.4, -0.07])
    assert forces[1] == pytest.approx(forces[0], abs=1e-11) and forces[2] == pytest.approx(forces[0], abs=1e-11)


def test_blocks_whose_nodes_do_not_match():
    """A column of two blocks with other elements each carries one pressure, whichever side has the nodes."""
    lower = block(np.linspace(0, 1, 4), np.linspace(-1, 0, 3), np.linspace(0, 1, 3), 1, 0, "lower")
    upper = block(np.linspace(0, 1, 3), np.linspace(0, 1, 3), np.linspace(0, 1, 5), 1, 0, "upper")
    pressed(lower, upper, {"all": "xyz", "P": (0, -1, 0), "Q": (0, 0, 0)})
    above, below = (cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 0)) for body in (upper, lower))
    with pytest.raises(cattaneo.InputError, match="without a partner"):
        cattaneo.pair_surfaces(above.surface, below.surface)
    for reduction in (
        cattaneo.reduce(above, below),
        *(
            cattaneo.reduce([above, below], [cattaneo.Interface("face", (0, above.surface), (1, below.surface), slave=slave)])
            for slave in ("first", "second")
        ),
    ):
        problem, face = reduction.problem, reduction.interfaces[0]
        assert not face.matching and face.left_out == 0
        assert problem.nodes == (12 if face.bodies == (1, 0) else 15)
        problem.friction = 0.3
        state = cattaneo.march(problem, [{}, {"P": 1}]).state
        assert state.p / problem.weights == pytest.approx(np.ones(problem.nodes), abs=1e-11)
        assert reduction.displacement(0, state)[upper.dofs[upper.places[:, 1] == 1, 1]] == pytest.approx(-2)
        assert reduction.contact_forces(1, state).sum(axis=0) == pytest.approx([0, -1, 0], abs=1e-12)

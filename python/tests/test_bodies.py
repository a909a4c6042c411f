"""Stiffness matrices of other programs: scikit-fem's, CalculiX's, and springs by hand."""

import cattaneo
import numpy as np
import pytest
import scipy.sparse as sparse
from cattaneo import readout


def strip(nodes=5, height=1.0, young=1.0, order=1):
    """A strip of unit width of scikit-fem, on y from 0 to height, with its mesh's nodes; Poisson's ratio is zero."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 1, nodes), np.linspace(0, height, 4))
    element = skfem.ElementQuad1() if order == 1 else skfem.ElementQuad2()
    basis = skfem.Basis(mesh, skfem.ElementVector(element))
    K = linear_elasticity(*lame_parameters(young, 0.0)).assemble(basis)
    places = basis.doflocs.T[::2]
    elements = basis.element_dofs.T[:, ::2] // 2
    return cattaneo.NodalStiffness(K, places, elements=elements)


@pytest.mark.parametrize("order", [1, 2])
def test_uniform_compression(order):
    """With ν = 0 a column under pressure 1 shortens by height/E, and its contact pressure is 1 at every node."""
    body = strip(height=2.0, young=8.0, order=order)
    top, bottom = body.places[:, 1] == 2.0, body.places[:, 1] == 0
    body.add_traction("P", top, (0, -1))
    condensed = cattaneo.condense(body, body.contact_line(bottom))
    assert condensed.rigid_modes == 3
    reduction = cattaneo.reduce(condensed)
    reduction.problem.friction = 0.2
    report = cattaneo.march(reduction.problem, [{}, {"P": 1}])
    assert readout.tractions(reduction.problem, report.state.p) == pytest.approx(np.ones(len(condensed.line)))
    u = reduction.displacement(0, report.state)
    assert u[body.dofs[top, 1]] == pytest.approx(-2.0 / 8.0)
    assert report.conjugates["P"] == pytest.approx([2.0 / 8.0])  # of unit width


def test_line_of_elements_and_of_ordered_nodes():
    body = strip()
    by_mask = body.contact_line(body.places[:, 1] == 0)
    bottom = np.flatnonzero(body.places[:, 1] == 0)
    ordered = bottom[np.argsort(body.places[bottom, 0])]
    without = cattaneo.NodalStiffness(body.K, body.places)
    by_order = without.contact_line(ordered, order=1)
    assert np.array_equal(by_mask.positions, by_order.positions)
    assert by_mask.normals == pytest.approx(np.tile([0, 1], (5, 1)))
    assert by_mask.weights == pytest.approx([1 / 8, 1 / 4, 1 / 4, 1 / 4, 1 / 8])
    assert by_mask.chains[0]["ends"] == ("corner", "corner")
    assert by_order.chains[0]["ends"] == ("unknown", "unknown")
    with pytest.raises(cattaneo.InputError, match="the other way round"):
        without.contact_line(ordered[::-1], order=1)


def test_two_bodies_whose_nodes_do_not_match():
    """Pressure is 1 on both sides of a mortar interface, and each body shortens by its own."""
    lower, upper = strip(5), strip(8)
    for node_places in (lower.places,):
        lower.fix(node_places[:, 1] == 0, "xy")
    shifted = cattaneo.NodalStiffness(
        upper.K, upper.places + (0, 1), elements=quads_of(upper, 8), name="upper"
    )
    shifted.add_traction("P", shifted.places[:, 1] == 2, (0, -1))
    below = lower.contact_line(lower.places[:, 1] == 1)
    above = shifted.contact_line(shifted.places[:, 1] == 1)
    interface = cattaneo.Interface("joint", (0, below), (1, above))
    reduction = cattaneo.reduce([cattaneo.condense(lower, below), cattaneo.condense(shifted, above)], [interface])
    problem = reduction.problem
    problem.friction = 0.5
    state = cattaneo.march(problem, [{}, {"P": 1}]).state
    assert readout.tractions(problem, state.p) == pytest.approx(np.ones(problem.nodes))
    assert problem.nodes == 5  # the coarser side
    top = shifted.places[:, 1] == 2
    assert reduction.displacement(1, state)[shifted.dofs[top, 1]] == pytest.approx(-2.0)
    assert reduction.interfaces[0].bodies == (0, 1) and reduction.interfaces[0].left_out == pytest.approx(0)


def quads_of(body, across):
    """Elements of strip(across) from its numbering: found by their places."""
    at = {tuple(np.round(place, 9)): k for k, place in enumerate(body.places)}
    x, y = np.unique(np.round(body.places[:, 0], 9)), np.unique(np.round(body.places[:, 1], 9))
    return [
        [at[x[i], y[j]], at[x[i + 1], y[j]], at[x[i + 1], y[j + 1]], at[x[i], y[j + 1]]]
        for i in range(len(x) - 1)
        for j in range(len(y) - 1)
    ]


def test_matching_bodies_are_paired():
    lower, upper = strip(5), strip(5)
    lower.fix(lower.places[:, 1] == 0, "xy")
    upper = cattaneo.NodalStiffness(upper.K, upper.places + (0, 1), elements=quads_of(upper, 5))
    upper.add_traction("P", upper.places[:, 1] == 2, (0, -1))
    below = cattaneo.condense(lower, lower.contact_line(lower.places[:, 1] == 1))
    above = cattaneo.condense(upper, upper.contact_line(upper.places[:, 1] == 1))
    problem = cattaneo.reduce(above, below).problem
    state = cattaneo.march(problem, [{}, {"P": 1}]).state
    assert readout.tractions(problem, state.p) == pytest.approx(np.ones(5))


def test_any_sparse_format_and_dense_are_one_matrix():
    body = strip(3)
    for K in (body.K, body.K.tocoo(), body.K.tocsc(), sparse.csr_matrix(body.K), body.K.toarray()):
        assert abs(cattaneo.NodalStiffness(K, body.places).K - body.K).max() == 0
    # Duplicates add up, as scipy means them.
    coo = body.K.tocoo()
    twice = sparse.coo_array(
        (np.tile(coo.data / 2, 2), (np.tile(coo.row, 2), np.tile(coo.col, 2))), shape=coo.shape
    )
    assert abs(cattaneo.NodalStiffness(twice, body.places).K - body.K).max() < 1e-15


def test_rows_in_another_order_are_noticed():
    """Such a matrix resists rigid motions, supports or not; so does one that was eliminated; springs to the ground may."""
    body = strip(4)
    first_x = np.concatenate([np.arange(0, 32, 2), np.arange(1, 32, 2)])
    blocks = body.K.toarray()[np.ix_(first_x, first_x)]
    dofs = np.column_stack([np.arange(16), 16 + np.arange(16)])
    right = cattaneo.NodalStiffness(blocks, body.places, dofs)
    assert np.array_equal(right.dofs, dofs)
    with pytest.raises(cattaneo.InputError, match="resists a translation along x .* in another order"):
        cattaneo.NodalStiffness(blocks, body.places, fixed=[0, 1])
    eliminated = body.K.toarray()
    eliminated[0], eliminated[:, 0], eliminated[0, 0] = 0, 0, 1
    with pytest.raises(cattaneo.InputError, match="row of an eliminated support"):
        cattaneo.NodalStiffness(eliminated, body.places)
    grounded = body.K + 0.1 * sparse.eye(32)
    top = cattaneo.NodalStiffness(grounded, body.places, supports_left_out=True).places[:, 1] == 1
    assert top.sum() == 4


def test_obstacle_that_moves():
    """A held column with ν = 0 that is lifted by 0.1 from below bears E 0.1/height."""
    body = strip(height=2.0, young=8.0)
    body.fix(body.places[:, 1] == 2.0, "xy")
    reduction = cattaneo.reduce(cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0)))
    reduction.add_obstacle_motion("lift", 0.0, 1.0)
    report = cattaneo.march(reduction.problem, [{}, {"lift": 0.1}])
    assert report.state.p.sum() == pytest.approx(8.0 * 0.1 / 2.0)
    assert report.conjugates["lift"] == pytest.approx([8.0 * 0.1 / 2.0])


def test_gap_as_a_function():
    """A punch with the gap 0.05 + 0 x touches when it has come down by that."""
    body = strip()
    body.add_displacement("down", body.places[:, 1] == 1, "y", -1.0)
    body.fix(body.places[:, 1] == 1, "x")
    line = body.contact_line(body.places[:, 1] == 0)
    problem = cattaneo.reduce(cattaneo.condense(body, line), lambda x, y: 0.05 + 0 * x + y).problem
    assert problem.gap == pytest.approx(np.full(5, 0.05))
    report = cattaneo.march(problem, [{}, {"down": 0.04}, {"down": 0.25}])
    assert report.state.p.sum() == pytest.approx(0.2)  # E = 1, height = 1
    with pytest.raises(ZeroDivisionError):
        cattaneo.reduce(cattaneo.condense(body, line), lambda x, y: 1 / 0)
    with pytest.raises(TypeError, match=r"gap\(0, 0\) is None, must be a number"):
        cattaneo.reduce(cattaneo.condense(body, line), lambda x, y: None)


def test_calculix_lap_joint(root):
    """The shipped deck: the clamp is 10 N at each node of ABOVE, which is the normal force of the joint."""
    laps = cattaneo.read_stiffness(root / "meshes" / "calculix" / "laps.sti")
    lower, upper = laps.parts()
    assert (lower.name, upper.name) == ("LOWER", "UPPER")
    below, above = lower.contact_line("LOWER_FACE"), upper.contact_line("UPPER_FACE")
    bodies = [cattaneo.condense(lower, below), cattaneo.condense(upper, above)]
    problem = cattaneo.reduce(bodies, [cattaneo.Interface("lap", (0, below), (1, above))]).problem
    problem.friction = 0.5
    state = cattaneo.march(problem, [{}, {"CLOAD1": 1}]).state
    assert state.p.sum() == pytest.approx(10 * len(upper.nodes_of("ABOVE")), rel=1e-9)


def test_written_files_come_back(tmp_path):
    body = strip(3)
    body.add_traction("P", body.places[:, 1] == 1, (0, -1))
    file = tmp_path / "strip.mtx"
    cattaneo.write_matrix_market(file, body)
    back = cattaneo.read_stiffness(file)
    assert abs(back.K - body.K).max() == 0 and np.array_equal(back.places, body.places)
    assert np.array_equal(back.loads["P"], body.loads["P"])
    condensed = cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0))
    problem = cattaneo.reduce(condensed).problem
    problem.friction = 0.1234567890123
    cattaneo.save(problem, tmp_path / "problem.json")
    again = cattaneo.load_reduced_problem(tmp_path / "problem.json")
    assert np.array_equal(again.K, problem.K) and np.array_equal(again.friction, problem.friction)
    cattaneo.write_npz(tmp_path / "problem.npz", problem)
    assert np.array_equal(np.load(tmp_path / "problem.npz")["K"], problem.K)
    state = cattaneo.march(problem, [{}, {"P": 1}]).state
    cattaneo.save(state, tmp_path / "state.json")
    assert np.array_equal(cattaneo.load_contact_state(tmp_path / "state.json").p, state.p)
    with pytest.raises(cattaneo.InputError, match="nowhere"):
        cattaneo.load_reduced_problem(tmp_path / "nowhere.json")


def test_alphabets_of_files(tmp_path):
    """A sentence may quote what is no UTF-8, of a file of text or of another."""
    (tmp_path / "m.sti").write_bytes(b"1 1 1.\n2 2 1.\n")
    (tmp_path / "m.dof").write_bytes(b"1.1\n1.\xe9\n")
    (tmp_path / "m.inp").write_bytes(b"** Gr\xf6\xdfe\n*NODE, NSET=FL\xc4CHE\n1, 0., 0.\n")
    with pytest.raises(cattaneo.InputError, match="line 2: a direction is 'é'"):
        cattaneo.read_stiffness(tmp_path / "m.sti")
    (tmp_path / "m.dof").write_bytes(b"1.1\n1.2\n")
    assert list(cattaneo.read_stiffness(tmp_path / "m.sti").sets) == ["FLÄCHE"]
    (tmp_path / "m.npy").write_bytes(b"\x93NUMPY\x01\x00\x08\x00{'\xff': 1}")
    with pytest.raises(cattaneo.InputError):
        cattaneo.read_stiffness(tmp_path / "m.npy")
    (tmp_path / "m.json").write_bytes(b'{"format": "\xff"}')
    for read in (cattaneo.load_reduced_problem, cattaneo.load_contact_state):
        with pytest.raises(cattaneo.InputError):
            read(tmp_path / "m.json")


def test_springs_may_be_said_later():
    """A stiffness that resists motions is refused until it is said why."""
    made = strip()
    K = made.K.toarray()
    K[0, 0] *= 1.1
    with pytest.raises(cattaneo.InputError, match="it resists a translation along x"):
        cattaneo.NodalStiffness(K, made.places)
    held = cattaneo.NodalStiffness(K, made.places, supports_left_out=True)
    assert held.supports_left_out
    held.supports_left_out = False
    with pytest.raises(cattaneo.InputError, match="it resists a translation along x"):
        cattaneo.condense(held, strip().contact_line(made.places[:, 1] == 0))


def column(*heights):
    """Strips of unit width on top of each other, of E = 8, condensed to their ends; P presses the last one's top."""
    bodies, lines, below = [], [], 0.0
    for height in heights:
        part = strip(height=height, young=8.0)
        places = part.places + [0, below]
        stacked = cattaneo.NodalStiffness(part.K, places, elements=strip_elements(), name=f"strip at {below}")
        ends = [places[:, 1] == below, places[:, 1] == below + height]
        if height is heights[-1]:
            stacked.add_traction("P", ends[1], (0, -1))
        lines.append([stacked.contact_line(end) for end in ends])
        bodies.append(stacked)
        below += height
    return bodies, lines


def strip_elements(nodes=5):
    skfem = pytest.importorskip("skfem")
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 1, nodes), np.linspace(0, 1, 4))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()))
    return basis.element_dofs.T[:, ::2] // 2


@pytest.mark.parametrize("paired", [False, True])
def test_a_column_in_two_parts_that_are_joined(paired):
    """Under pressure 1 it shortens by its height over E, and its joint transfers the force P = 1."""
    bodies, lines = column(1.0, 2.0)
    below, joint = lines[0]
    above = lines[1][0]
    pairing = cattaneo.pair_lines(above, joint) if paired else None
    interfaces = [
        cattaneo.Interface("floor", (0, below)),
        cattaneo.Interface("joint", (1, above), (0, joint), tied=True, pairing=pairing),
    ]
    condensed = [cattaneo.condense(bodies[0], cattaneo.joined([below, joint])), cattaneo.condense(bodies[1], above)]
    reduction = cattaneo.reduce(condensed, interfaces)
    assert len(reduction.problem.gap) == len(below)
    reduction.problem.friction = 0.2
    report = cattaneo.march(reduction.problem, [{}, {"P": 1}])
    assert report.conjugates["P"] == pytest.approx([3.0 / 8.0])
    forces = reduction.tied_forces(report.state).reshape(2, -1)
    assert forces[0] == pytest.approx(np.zeros(len(above)), abs=1e-12)
    assert abs(forces[1].sum()) == pytest.approx(1.0)
    with pytest.raises(TypeError, match="must be|incompatible function arguments"):
        cattaneo.Interface("joint", (0, joint), tied=1)
    with pytest.raises(TypeError, match="must be|incompatible function arguments"):
        cattaneo.Interface("joint", (0, joint), pairing=[])


def test_bodies_on_a_half_plane():
    """One on it, said as an interface of several, is one on it."""
    ground = cattaneo.HalfPlane(cattaneo.Material(8.0, 0.3), depth=100.0)
    bodies, lines = column(1.0)
    condensed, line = cattaneo.condense(bodies[0], lines[0][0]), lines[0][0]
    alone = cattaneo.reduce(condensed, ground).problem
    several = cattaneo.reduce([condensed], [cattaneo.Interface("foot", (0, line), 1)], half_plane=ground).problem
    assert several.K == pytest.approx(alone.K, abs=1e-9 * abs(alone.K).max())
    assert several.gap == pytest.approx(alone.gap)
    assert cattaneo.reduce(condensed, half_plane=ground).problem.gap == pytest.approx(alone.gap)
    for call in (
        lambda: cattaneo.reduce(condensed, 0.0, half_plane=ground),
        lambda: cattaneo.reduce([condensed], [cattaneo.Interface("foot", (0, line), 1)], half_plane=3),
        lambda: cattaneo.reduce([condensed], [], pairing=3),
    ):
        with pytest.raises(TypeError, match="must be|incompatible function arguments"):
            call()


def test_bodies_have_a_thickness():
    """Five times as thick, five times the forces, and the same pressures."""
    bodies, lines = column(1.0)
    thin, thick = cattaneo.condense(bodies[0], lines[0][0]), cattaneo.condense(bodies[0], lines[0][0])
    thick.thicken(5)
    assert thick.thickness == 5 and thick.S == pytest.approx(5 * thin.S)
    ground, deep = (cattaneo.HalfPlane(cattaneo.Material(8.0, 0.3), depth=100.0, thickness=t) for t in (1, 5))
    assert deep.thickness == 5
    one, five = cattaneo.reduce(thin, ground).problem, cattaneo.reduce(thick, deep).problem
    assert five.K == pytest.approx(5 * one.K, abs=1e-9 * abs(five.K).max())
    assert five.weights == pytest.approx(5 * one.weights)
    with pytest.raises(cattaneo.InputError, match="factor of the thickness is -1, must be positive and finite"):
        thick.thicken(-1)
    assert thin.moved.size == 0


def test_what_a_body_cannot_be():
    K, places = strip().K, strip().places
    skewed, turned = K.tolil(), K.tolil()
    skewed[0, 5] += 0.1
    turned[7, 7] *= -1
    line = strip().contact_line(places[:, 1] == 0)
    for changed, sentence in ((skewed, r"not symmetric: entry \((0, 5|5, 0)\) is"), (turned, r"entry \(7, 7\) of the stiffness is -")):
        with pytest.raises(cattaneo.InputError, match=sentence):
            cattaneo.condense(cattaneo.NodalStiffness(changed, places, supports_left_out=True), line)
    elements = strip_elements()
    with pytest.raises(cattaneo.InputError, match="element 12 and element 2 lie on the same side of their common edge"):
        cattaneo.NodalStiffness(K, places, elements=np.vstack([elements, elements[2]]))
    with pytest.raises(cattaneo.InputError, match="sets has 'TOP' twice"):
        cattaneo.NodalStiffness(K, places, sets={"top": [1], "Top": [2]})
    assert list(cattaneo.NodalStiffness(K, places, loads={"b\0": np.zeros(len(places) * 2), "a": np.ones(len(places) * 2)}).loads) == ["b\0", "a"]
    with pytest.raises(TypeError, match="a name in loads is 3, must be a str"):
        cattaneo.NodalStiffness(K, places, loads={3: np.zeros(len(places) * 2)})


def test_a_sparse_matrix_whose_arrays_were_changed():
    """SciPy would write outside of them."""
    K, places = strip().K, strip().places
    for form in ("csr", "csc", "bsr"):
        for name, place, value in (("indices", 0, 99_999), ("indices", 3, -1), ("indptr", 1, 10**6), ("indptr", -1, 10**6), ("indptr", 0, 5)):
            changed = K.copy().asformat(form)
            getattr(changed, name)[place] = value
            with pytest.raises(cattaneo.InputError, match="K is not a valid sparse matrix: "):
                cattaneo.NodalStiffness(changed, places)
    for k, name in enumerate(("row", "col")):
        changed = K.tocoo(copy=True)
        changed.coords[k][4] = 99_999
        with pytest.raises(cattaneo.InputError, match=rf"K.{name}\[4\] is 99999, must be from 0 to {K.shape[0] - 1}"):
            cattaneo.NodalStiffness(changed, places)
        assert changed.coords[k][4] == 99_999  # it is as it was
    for form in ("csr", "csc", "coo", "bsr", "lil", "dok", "dia"):
        made = cattaneo.NodalStiffness(K.asformat(form), places)
        assert abs(made.K - K).max() == 0


@pytest.mark.parametrize("diagonal", [1.0, 1e6, 0.0])
def test_eliminated_supports_are_supports(diagonal):
    """A strip whose left side is held: eliminated by its program it is the same body, and half of it as well."""
    made = strip()
    places, K = made.places, made.K.toarray()
    left, bottom, top = (np.flatnonzero(places[:, axis] == value) for axis, value in ((0, 0), (1, 0), (1, 1)))
    eliminated = K.copy()
    for row in 2 * left:
        eliminated[row, :] = eliminated[:, row] = 0
        eliminated[row, row] = diagonal

    def conjugates(stiffness, fix, **how):
        body = cattaneo.NodalStiffness(stiffness, places, elements=strip_elements(), **how)
        if fix:
            body.fix(left, "x")
        body.add_traction("P", top, (0.1, -1))
        problem = cattaneo.reduce(cattaneo.condense(body, body.contact_line(bottom))).problem
        problem.friction = 0.2
        report = cattaneo.march(problem, [{}, {"P": 1}])
        return report.conjugates["P"][-1], report.state.q

    right = conjugates(K, True)
    with pytest.warns(cattaneo.OutcomeWarning, match="rows of the stiffness hold nothing but their diagonal, the first is x of the node at"):
        got = conjugates(eliminated, False, supports_left_out=True)
    assert got[0] == pytest.approx(right[0], rel=1e-12)
    assert got[1] == pytest.approx(right[1], abs=1e-12)
    if diagonal > 0:
        with pytest.raises(cattaneo.InputError, match="holds nothing but its diagonal"):
            cattaneo.NodalStiffness(eliminated, places)


@pytest.mark.parametrize("noise", [1e-30, 1e-20, 1e-17, 1e-15, "turned"])
@pytest.mark.parametrize("diagonal", [1.0, 100.0])
def test_round_off_in_eliminated_rows_is_zero(noise, diagonal):
    """What elimination leaves beside diagonals is round-off where it is made by products; the body is that of named supports."""
    made = strip()
    places, K = made.places, made.K.toarray()
    left, bottom, top = (np.flatnonzero(places[:, axis] == value) for axis, value in ((0, 0), (1, 0), (1, 1)))
    rows = 2 * left
    eliminated = K.copy()
    if noise == "turned":  # the projection onto what is free, formed in a frame that is turned
        frame = np.kron(np.eye(len(places)), [[np.cos(0.5), np.sin(0.5)], [-np.sin(0.5), np.cos(0.5)]])
        free = np.eye(len(K))
        free[rows, rows] = 0
        free = frame.T @ (frame @ free @ frame.T) @ frame
        eliminated = free @ K @ free.T + diagonal * (np.eye(len(K)) - free)
        eliminated = (eliminated + eliminated.T) / 2
    else:
        left_over = noise * K.diagonal().mean() * np.random.default_rng(1).normal(size=K.shape)
        eliminated[rows, :], eliminated[:, rows] = left_over[rows, :], left_over[rows, :].T
        eliminated[np.ix_(rows, rows)] = diagonal * np.eye(len(rows))
    assert np.abs(np.delete(eliminated[rows[0]], rows[0])).max() > 0

    def conjugates(stiffness, fix, **how):
        body = cattaneo.NodalStiffness(stiffness, places, elements=strip_elements(), **how)
        if fix:
            body.fix(left, "x")
        body.add_traction("P", top, (0, -1))
        body.add_traction("Q", top, (0.1, 0))
        problem = cattaneo.reduce(cattaneo.condense(body, body.contact_line(bottom))).problem
        problem.friction = 0.2
        report = cattaneo.march(problem, [{}, {"P": 1}, {"P": 1, "Q": 1}])
        return report.conjugates["P"][-1], report.conjugates["Q"][-1], report.state.q

    right = conjugates(K, True)
    with pytest.warns(cattaneo.OutcomeWarning, match="rows of the stiffness hold nothing but their diagonal"):
        got = conjugates(eliminated, False, supports_left_out=True)
    for this, that in zip(got, right):
        assert this == pytest.approx(that, rel=1e-10, abs=1e-12)
    with pytest.raises(cattaneo.InputError, match="holds nothing but its diagonal|was it eliminated"):
        cattaneo.NodalStiffness(eliminated, places)


def test_round_off_in_eliminated_rows_connects_no_bodies():
    """Two strips in one matrix, the lower one 1e-5 as stiff, each with its left side eliminated but for round-off in all columns."""
    made = strip()
    places, K = made.places, made.K.toarray()
    n, nodes = len(K), len(places)
    both = np.zeros((2 * n, 2 * n))
    both[:n, :n], both[n:, n:] = K, 1e-5 * K
    left = np.flatnonzero(places[:, 0] == 0)
    rows = np.concatenate([2 * left, n + 2 * left])
    noise = 1e-16 * K.max() * np.random.default_rng(2).normal(size=both.shape)
    both[rows, :], both[:, rows] = noise[rows, :], noise[rows, :].T
    both[np.ix_(rows, rows)] = np.eye(len(rows))
    elements = np.asarray(strip_elements())
    body = cattaneo.NodalStiffness(
        both,
        np.vstack([places, places - [0, 5]]),
        elements=np.vstack([elements, elements + nodes]),
        supports_left_out=True,
    )
    parts = body.parts()
    assert [part.K.shape[0] for part in parts] == [n, n]
    for part, scale in zip(parts, (1, 1e-5)):
        right = scale * K
        right[2 * left, :], right[:, 2 * left] = 0, 0
        right[2 * left, 2 * left] = 1
        assert abs(part.K.toarray() - right).max() == 0


def patch(nx, order, below, name):
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    low = -2.0 if below else 0.0
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 6, nx + 1), np.linspace(low, low + 2, 3))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2() if order == 2 else skfem.ElementQuad1()))
    K = linear_elasticity(*lame_parameters(1e6 if below else 1e3, 0.3)).assemble(basis)
    places = basis.doflocs.T[::2]
    return cattaneo.NodalStiffness(K, places, elements=basis.element_dofs.T[:, ::2] // 2, name=name), places


def test_nodes_at_the_same_places_meet_as_their_elements_do():
    """Order 2 on order 1 whose nodes coincide: a pressure of 1 is 1 at every node, asked for in either way."""
    (upper, above), (lower, under) = patch(6, 2, False, "up"), patch(12, 1, True, "low")
    for body, places in ((upper, above), (lower, under)):
        body.fix(np.abs(places[:, 0]) < 1e-9, "x")
    lower.fix(np.abs(under[:, 1] + 2) < 1e-9, "y")
    upper.add_traction("P", np.abs(above[:, 1] - 2) < 1e-9, (0, -1.0))
    lines = upper.contact_line(np.abs(above[:, 1]) < 1e-9), lower.contact_line(np.abs(under[:, 1]) < 1e-9)
    assert len(lines[0]) == len(lines[1]) == 13
    condensed = [cattaneo.condense(body, line) for body, line in zip((upper, lower), lines)]
    several = cattaneo.reduce(condensed, [cattaneo.Interface("i", (0, lines[0]), (1, lines[1]))])
    for reduction in (several, cattaneo.reduce(*condensed)):
        report = cattaneo.march(reduction.problem, [{}, {"P": 1}])
        assert cattaneo.readout.tractions(reduction.problem, report.state.p) == pytest.approx(np.ones(13), abs=1e-12)
        assert reduction.warnings(report.state) == []
        assert reduction.interfaces[0].turn == pytest.approx(np.zeros(13), abs=1e-12)
    with pytest.warns(cattaneo.OutcomeWarning, match="pairs nodes one to one where the elements of the bodies differ"):
        paired = cattaneo.reduce(*condensed, cattaneo.pair_lines(*lines))
    report = cattaneo.march(paired.problem, [{}, {"P": 1}])
    assert "elements of the bodies differ" in paired.warnings(report.state)[0]


@pytest.mark.parametrize("order", [1, 2])
def test_gaps_are_of_curves_unless_as_meshed(order):
    """A shaft of radius 1 in a hole of radius 1.01, both of straight edges: the clearance, or as meshed that of the polygons."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    def quarter(inner, outer, edges):
        plain = skfem.MeshQuad.init_tensor(np.linspace(0, 1, edges + 1), np.linspace(0, 1, 3))
        angle, r = (1 - plain.p[0]) * np.pi / 2, inner + (outer - inner) * plain.p[1]
        mesh = skfem.MeshQuad(np.array([r * np.cos(angle), r * np.sin(angle)]), plain.t)
        element = skfem.ElementVector(skfem.ElementQuad1() if order == 1 else skfem.ElementQuad2())
        basis, flat = skfem.Basis(mesh, element), skfem.Basis(plain, element)
        K = linear_elasticity(*lame_parameters(1.0, 0.3)).assemble(basis)
        body = cattaneo.NodalStiffness(K, basis.doflocs.T[::2], elements=basis.element_dofs.T[:, ::2] // 2)
        return body, flat.doflocs[1][::2]  # how far each node is into the ring, 0 to 1

    edges, clearance = 8, 0.01
    chord = (1 + clearance) * (1 - np.cos(np.pi / 4 / edges))  # how high its arc is
    (shaft, into), (hole, beyond) = quarter(0.5, 1, 2 * edges), quarter(1 + clearance, 2, edges)
    shaft.fix(into == 0, "x"), shaft.fix(into == 0, "y"), hole.fix(beyond == 1, "x"), hole.fix(beyond == 1, "y")
    lines = shaft.contact_line(into == 1), hole.contact_line(beyond == 0)
    assert not lines[0].as_meshed

    def gap():
        bodies = [cattaneo.condense(shaft, lines[0]), cattaneo.condense(hole, lines[1])]
        return cattaneo.reduce(bodies, [cattaneo.Interface("fit", (0, lines[0]), (1, lines[1]), slave="first")]).problem.gap

    assert gap() == pytest.approx(clearance, abs=0.01 * chord)
    for line in lines:
        line.as_meshed = True
    assert np.abs(gap() - clearance).max() > 0.5 * chord
    with pytest.raises(TypeError):
        lines[0].as_meshed = "yes"


def test_a_bolt_that_is_tightened():
    """A column of compliance 3/8 with a bolt of stiffness 4 through it, tightened to 2, then pressed by 1: it gives 4 · 3/8 / (1 + 4 · 3/8) of
    it, and is nothing before it is tightened."""
    bodies, lines = column(1.0, 2.0)
    bodies[1].add_traction("bolt", bodies[1].places[:, 1] == 3.0, (0, -1))
    bodies[0].add_traction("bolt", bodies[0].places[:, 1] == 0.0, (0, 1))
    below, joint = lines[0]
    above = lines[1][0]
    condensed = [cattaneo.condense(bodies[0], cattaneo.joined([below, joint])), cattaneo.condense(bodies[1], above)]
    loose = cattaneo.reduce(condensed, [cattaneo.Interface("floor", (0, below)), cattaneo.Interface("joint", (1, above), (0, joint))])
    loose.problem.friction = 0.2
    joined = cattaneo.BoltedJoint(loose, {"bolt": 4.0})
    assert repr(joined) == "<BoltedJoint: 'bolt'>"
    points = [{}, {"P": 1}, {"bolt": 2}, {"P": 2}]
    report = joined.march(points, increments=2, keep_states=True)
    assert report.status == "converged"
    forces = {state.time: joined.forces(state)["bolt"] for state in report.states}
    assert forces[1.0] == pytest.approx(0.0, abs=1e-12)
    assert forces[2.0] == pytest.approx(2.0)
    assert forces[3.0] == pytest.approx(2.0 - 1.5 / 2.5)
    assert joined.tightened().displacement(1, report.state).shape == (len(bodies[1].places) * 2,)
    history = cattaneo.LoadHistory.through(joined.problem, points)
    again = joined.march(history, report.states[2])
    assert again.state.v == pytest.approx(report.state.v, abs=1e-10)
    with pytest.warns(cattaneo.OutcomeWarning, match="would be compressed"):
        pushed = joined.march([{}, {"bolt": 2}, {"P": 5}])
    assert pushed.status == "stopped"
    number = [load.name for load in joined.problem.patterns].index("P")
    assert pushed.event_multipliers[number] == pytest.approx(2.0 / 0.6)
    with pytest.raises(cattaneo.InputError, match="the bolt 'bolt' is never tightened"):
        joined.march([{}, {"P": 1}])


def test_bulk_stress_of_a_half_plane():
    """Where no force acts the surface is strained by σ (1 - ν²)/E; inside the stress is uniform."""
    ground = cattaneo.HalfPlane(cattaneo.Material(8.0, 0.3), depth=100.0, bulk={"Q": 3.0})
    body = cattaneo.condense(ground, [0.0, 0.5, 2.0], order=2)
    (pattern,) = cattaneo.reduce(body).problem.patterns
    assert pattern.name == "Q"
    moved = np.linalg.solve(body.S, -np.concatenate([pattern.q, pattern.p]))
    nodes = len(pattern.p)
    strain = 3.0 * (1 - 0.09) / 8.0
    assert np.sort(abs(moved[:nodes])) == pytest.approx(np.array([0, 0.25, 0.5, 1.25, 2.0]) * strain)
    assert moved[nodes:] == pytest.approx(np.zeros(nodes), abs=1e-12)
    field = cattaneo.HalfPlaneField(ground, body.line, np.zeros(2 * nodes), bulk=3.0)
    displacement, stress = field.at([[1.0, -2.0]])
    assert stress[0] == pytest.approx([3.0, 0.0, 0.0], abs=1e-12)
    assert displacement[0] == pytest.approx([strain, 2.0 * 0.3 / 0.7 * strain])
    with pytest.raises(cattaneo.InputError, match="bulk"):
        cattaneo.HalfPlane(cattaneo.Material(8.0, 0.3), depth=100.0, bulk={"Q": float("nan")})


def test_nothing_is_held_or_loaded_in_silence():
    """A mask that is true nowhere is a mistake, most often of a comparison with a coordinate."""
    body = strip()
    nowhere = body.places[:, 1] == 17.0
    for call in (
        lambda: body.fix(nowhere, "x"),
        lambda: body.fix([], "x"),
        lambda: body.add_forces("P", nowhere, "y", 1.0),
        lambda: body.add_displacement("P", nowhere, "y", 1.0),
        lambda: body.add_traction("P", nowhere, (0, 1)),
        lambda: body.contact_line(nowhere),
    ):
        with pytest.raises(cattaneo.InputError, match="nodes is .*, must name at least one node"):
            call()
    for call in (
        lambda: body.add_forces("", [0], "y", 1.0),
        lambda: body.add_displacement("", [0], "y", 1.0),
        lambda: body.add_traction("", body.places[:, 1] == 1, (0, 1)),
    ):
        with pytest.raises(cattaneo.InputError, match="load is '', a load must have a name"):
            call()
    assert len(body.fixed) == 0 and body.loads == {}

"""Vibration of joints: masses of other programs, modes, loops in space, and joints for programs of dynamics."""

import os
import shutil
import subprocess
import sys

import cattaneo
import numpy as np
import pytest
from cattaneo import joints
from conftest import ROOT
from scipy.io import loadmat
from scipy.linalg import eigh
from scipy.sparse import coo_array

CORNERS = [0, 3, 6, 2, 1, 5, 7, 4]  # scikit-fem's corners of a hexahedron, one side after the other
DENSITY = 0.7


def block(x, y, z, name="body"):
    """Hexahedra between planes at these places, with their mass."""
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshHex.init_tensor(np.asarray(x, float), np.asarray(y, float), np.asarray(z, float))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    K = linear_elasticity(*lame_parameters(2.0, 0.3)).assemble(basis)
    M = skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(basis)
    return cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t[CORNERS].T, M=M, name=name)


class Column:
    """Two blocks, one on the other at y = 1, that friction holds together: [0, 1] x [0, 2.5] x [0, 0.8]."""

    X, LOW, HIGH, Z = np.linspace(0, 1, 4), np.linspace(0, 1, 4), np.linspace(1, 2.5, 5), np.linspace(0, 0.8, 3)

    def __init__(self, held, friction=0.8, pressure=1e-3):
        self.bodies = [block(self.X, self.HIGH, self.Z, "upper"), block(self.X, self.LOW, self.Z, "lower")]
        upper, lower = self.bodies
        upper.add_traction("P", upper.places[:, 1] == 2.5, (0, -pressure, 0))
        if held:
            lower.fix(lower.places[:, 1] == 0, "xyz")
        else:
            lower.add_traction("P", lower.places[:, 1] == 0, (0, pressure, 0))
        self.reduction = cattaneo.reduce(*(cattaneo.condense(body, body.contact_surface(body.places[:, 1] == 1)) for body in self.bodies))
        self.problem = self.reduction.problem
        self.problem.friction = friction
        self.state = cattaneo.march(self.problem, [{}, {"P": 1}]).state
        self.structure = joints.VibratingStructure(self.reduction, self.bodies)


def free(body):
    rows = np.ones(body.K.shape[0], bool)
    rows[body.fixed] = False
    return rows


def squares_of_one(held):
    """Eigenvalues of both blocks as one, by a dense method."""
    one = block(Column.X, np.r_[Column.LOW, Column.HIGH[1:]], Column.Z)
    if held:
        one.fix(one.places[:, 1] == 0, "xyz")
    rows = free(one)
    return eigh(one.K.toarray()[np.ix_(rows, rows)], one.M.toarray()[np.ix_(rows, rows)], eigvals_only=True)


@pytest.mark.parametrize("held", [True, False])
def test_glued_blocks_vibrate_as_one(held):
    column = Column(held)
    modes = column.structure.modes(column.problem, column.state, 5)
    rigid = 0 if held else 6
    assert modes.rigid == rigid
    assert modes.omega**2 == pytest.approx(squares_of_one(held)[rigid : rigid + 5], rel=1e-8)
    assert column.structure.mass == pytest.approx(DENSITY * 2.5 * 0.8)
    for i in range(5):
        for j in range(i + 1):
            product = sum(a @ (body.M @ b) for a, b, body in zip(modes.shapes[i], modes.shapes[j], column.bodies))
            assert product == pytest.approx(float(i == j), abs=1e-9)


@pytest.mark.parametrize("held", [True, False])
def test_a_loop_without_slip_has_the_frequency_of_the_mode(held):
    column = Column(held)
    modes = column.structure.modes(column.problem, column.state, 3)
    problem, state = column.structure.with_modes(modes), column.structure.with_modes(modes, column.state)
    for k, omega in enumerate(modes.omega):
        [loop] = joints.modal_curve(problem, state, f"mode {k + 1}", omega, [1e-7], increments=4)
        assert loop.steady and loop.omega == pytest.approx(omega, rel=1e-6) and loop.zeta < 1e-9


def test_errors_of_increments_are_within_their_estimates():
    """A loop with slip is softer and loses work. Eight times as many increments agree within the errors of both."""
    column = Column(True, friction=0.3)
    modes = column.structure.modes(column.problem, column.state, 1)
    problem, state = column.structure.with_modes(modes), column.structure.with_modes(modes, column.state)
    [loop] = joints.modal_curve(problem, state, "mode 1", modes.omega[0], [5e-3], tolerance=1e-3, increments=8)
    assert loop.steady and loop.omega < 0.995 * modes.omega[0] and loop.zeta > 1e-4
    assert loop.omega_error < 0.002 * loop.omega and loop.zeta_error <= 0.02 * loop.zeta
    square = 2 * np.pi * (loop.omega * loop.amplitude) ** 2
    assert loop.zeta == pytest.approx(loop.dissipation / square)
    assert loop.area == pytest.approx(loop.dissipation, abs=square * loop.zeta_error)
    assert loop.node_dissipation.sum() == pytest.approx(loop.dissipation)
    [finer] = joints.modal_curve(problem, state, "mode 1", modes.omega[0], [loop.amplitude], tolerance=1e-6, increments=64)
    assert finer.omega == pytest.approx(loop.omega, abs=loop.omega_error + finer.omega_error)
    assert finer.zeta == pytest.approx(loop.zeta, abs=loop.zeta_error + finer.zeta_error)


def test_bodies_without_a_mass_are_refused():
    column = Column(True)
    bare = [cattaneo.NodalStiffness(body.K, body.places) for body in column.bodies]
    with pytest.raises(cattaneo.InputError, match="has no mass, must have one"):
        joints.VibratingStructure(column.reduction, bare)
    with pytest.raises(cattaneo.InputError, match="must be that of K"):
        bare[0].M = np.eye(3)
    skew = column.bodies[0].M.toarray()
    skew[0, 1] += 1
    with pytest.raises(cattaneo.InputError, match="M is not symmetric"):
        bare[0].M = skew


def test_masses_of_calculix(tmp_path):
    """The upper lap, 2 by 0.5 mm, is free and has its whole mass in the .mas that ccx writes."""
    if shutil.which("ccx") is None:
        pytest.skip("there is no ccx (Debian: calculix-ccx)")
    shutil.copy(ROOT / "meshes" / "calculix" / "laps.inp", tmp_path)
    subprocess.run(["ccx", "laps"], cwd=tmp_path, check=True, capture_output=True, timeout=100)
    laps = cattaneo.read_stiffness(tmp_path / "laps.sti", mass=tmp_path / "laps.mas")
    assert laps.M.shape == laps.K.shape
    [upper] = [part for part in laps.parts() if not len(part.fixed) and not part.supports_left_out]
    along = np.zeros(upper.K.shape[0])
    along[upper.dofs[:, 0]] = 1
    assert along @ (upper.M @ along) == pytest.approx(7.8e-9 * 2 * 0.5, rel=1e-6)


def test_bodies_must_be_those_of_the_reduction():
    column = Column(True)
    with pytest.raises(cattaneo.InputError, match="contact nodes of body 0 are at other places .* in the order of the reduction"):
        joints.VibratingStructure(column.reduction, column.bodies[::-1])


def bolted():
    """Two blocks of 2 by 1, one on the other at y = 0, with one bolt of stiffness 500: bodies, loose reduction, joint, state."""
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    bodies = []
    for y in (0, 1), (-1, 0):
        mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 2, 6), np.linspace(*y, 3))
        basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=3)
        K = linear_elasticity(*lame_parameters(1e3, 0.3)).assemble(basis)
        M = skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(basis)
        bodies.append(cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t.T, M=M))
    upper, lower = bodies
    for body, y, sign in ((upper, 1, -1), (lower, -1, 1)):
        places = np.flatnonzero(body.places[:, 1] == y)
        places = places[np.argsort(body.places[places, 0])]
        body.add_forces("B", places[2:4], "y", sign * 0.5)
        if sign > 0:
            body.fix(places[:2], "xy")
    loose = cattaneo.reduce(*(cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0)) for body in bodies))
    loose.problem.friction = 0.3
    joint = cattaneo.BoltedJoint(loose, {"B": 500.0})
    return bodies, loose, joint, joint.march([{}, {"B": 5.0}]).state


def test_shanks_and_states_must_be_those_of_the_reduction():
    bodies, loose, joint, state = bolted()
    tightened = joint.tightened()
    right = joints.VibratingStructure(tightened, bodies, {"B": 500.0})
    right.with_modes(right.modes(joint.problem, state, 2))
    for shanks in ({}, {"B": 5.0}, {"B": 5e5}):
        with pytest.raises(cattaneo.InputError, match="all bolts that are springs must be named"):
            joints.VibratingStructure(tightened, bodies, shanks)
    with pytest.raises(cattaneo.InputError, match="'B' has the stiffness -500, must be positive"):
        joints.VibratingStructure(tightened, bodies, {"B": -500.0})
    with pytest.raises(cattaneo.InputError, match=r"the reduction of a BoltedJoint is its tightened\(\)"):
        joints.VibratingStructure(loose, bodies, {"B": 500.0})
    # Without the bolt the structure is the loose one, of which the state of the joint is none.
    without = joints.VibratingStructure(loose, bodies)
    with pytest.raises(cattaneo.InputError, match="the problem has another stiffness than the structure"):
        without.modes(joint.problem, state, 2)


def test_a_body_that_is_held_otherwise_is_refused():
    """The same stiffness, but other supports than those of the reduction."""
    column = Column(True)
    upper, lower = column.bodies
    freed = cattaneo.NodalStiffness(lower.K, lower.places, M=lower.M)
    freed.fix(lower.places[:, 1] == 0, "xy")
    with pytest.raises(cattaneo.InputError, match="the supports of the bodies are not those"):
        joints.VibratingStructure(column.reduction, [upper, freed])


def test_masses_that_no_body_has_are_refused():
    """A mass is symmetric and definite, and a translation moves all of it along each axis."""
    column = Column(True)
    upper, lower = column.bodies

    def refused(M, match):
        other = cattaneo.NodalStiffness(upper.K, upper.places, M=M)
        with pytest.raises(cattaneo.InputError, match=match):
            joints.VibratingStructure(column.reduction, [other, lower])

    # Nodes in the right order, but all x before all y and z.
    size = upper.K.shape[0]
    order = np.arange(size).reshape(-1, 3).T.ravel()
    M = upper.M.toarray()
    refused(M[np.ix_(order, order)], "are the rows of the mass those of the stiffness")
    # A positive diagonal, but two nodes that move against each other have a negative mass.
    negative = np.diag(M.diagonal())
    negative[0, 3] = negative[3, 0] = 2 * max(M[0, 0], M[3, 3])
    refused(negative, "body 0: its mass is not positive definite at .* along")


def test_the_loss_of_loops_without_slip_is_none():
    """However small a loop is: nodes at the limit of friction slip by round-off. A size that is round-off itself is refused."""
    bodies, loose, joint, state = bolted()
    structure = joints.VibratingStructure(joint.tightened(), bodies, {"B": 500.0})
    modes = structure.modes(joint.problem, state, 1)
    problem, about = structure.with_modes(modes), structure.with_modes(modes, state)
    with pytest.raises(cattaneo.InputError, match="mode 1: amplitude 1e-30 must be at least") as refused:
        joints.modal_curve(problem, about, "mode 1", modes.omega[0], [1e-30, 1e-3])
    least = float(str(refused.value).split("at least ")[1].split(":")[0])
    for loop in joints.modal_curve(problem, about, "mode 1", modes.omega[0], [1.01 * least, 10 * least, 100 * least]):
        assert loop.converged and loop.zeta == loop.zeta_secant == loop.dissipation == 0 and not loop.node_dissipation.any()
        assert loop.omega == pytest.approx(modes.omega[0], rel=1e-5)


def test_sizes_beyond_sliding_are_not_converged():
    """Their loop is the largest before the joint slides, a steady one."""
    bodies, loose, joint, state = bolted()
    structure = joints.VibratingStructure(joint.tightened(), bodies, {"B": 500.0})
    modes = structure.modes(joint.problem, state, 1)
    problem, about = structure.with_modes(modes), structure.with_modes(modes, state)
    with pytest.warns(cattaneo.OutcomeWarning, match="slides as a whole"):
        small, *large = joints.modal_curve(problem, about, "mode 1", modes.omega[0], [1e-3, 10.0, 20.0])
    assert small.converged and small.steady
    for loop in large:
        assert not loop.converged and loop.steady and loop.amplitude < 10 and np.isfinite(loop.sliding_force)


def test_nodes_that_touch_without_a_force_are_open():
    """The lower block alone is held, so that the upper one is free: six rigid motions."""
    column = Column(True)
    with pytest.warns(cattaneo.OutcomeWarning, match="no contact node of the state carries a force"):
        modes = column.structure.modes(column.problem, cattaneo.ContactState.virgin(column.problem), 2)
    assert modes.rigid == 6


def test_craig_bampton_tends_to_the_whole_structure_from_above():
    """Nothing joins the blocks: the upper one is free, the lower one held."""
    column = Column(True)
    exact = []
    for body in column.bodies:
        rows = free(body)
        exact.extend(eigh(body.K.toarray()[np.ix_(rows, rows)], body.M.toarray()[np.ix_(rows, rows)], eigvals_only=True))
    exact = np.sort(exact)[6:14]
    before = np.full(8, np.inf)
    errors = []
    for count in (4, 12, 36):
        made = column.structure.craig_bampton(count)
        size = len(made.rows) + count
        assert made.K.shape == made.M.shape == (size, size) and len(made.omega) == count
        found = eigh(made.K, made.M, eigvals_only=True)[6:14]
        assert np.all(found >= exact * (1 - 1e-9)) and np.all(found <= before * (1 + 1e-9))
        before = found
        errors.append(np.abs(found / exact - 1).max())
    assert errors[2] < 1e-2 * errors[0] or errors[2] < 1e-4
    # Glued, they are the modes with closed nodes glued.
    glued = slice(len(made.rows), None)
    modes = column.structure.modes(column.problem, column.state, 4)
    assert eigh(made.K[glued, glued], made.M[glued, glued], eigvals_only=True)[:4] == pytest.approx(modes.omega**2, rel=1e-9)
    # A largest frequency leaves out the others.
    few = column.structure.craig_bampton(36, most=1.0001 * made.omega[9])
    assert few.omega == pytest.approx(made.omega[:10])
    # The stiffness of the relative displacements is that of the problem, as are its loads.
    contact = slice(0, len(made.rows))
    K = column.problem.K[np.ix_(made.rows, made.rows)]
    assert made.K[contact, contact] == pytest.approx(K, abs=1e-9 * np.abs(K).max())
    load = column.problem.patterns[0]
    assert made.loads == ["P"]
    assert made.F[contact, 0] == pytest.approx(-np.r_[load.q, load.p][made.rows], abs=1e-9)


def test_free_structures_keep_their_rigid_motions():
    made = Column(False).structure.craig_bampton(5)
    assert len(made.omega) == 11 and not made.omega[:6].any()
    # Two blocks apart have twelve.
    values = eigh(made.K, made.M, eigvals_only=True)
    assert np.abs(values[:12]).max() < 1e-8 * values[12]


def test_outputs_move_as_the_structure_does():
    """Statically, and without contact forces, a load moves outputs as it moves the held body by its own stiffness."""
    column = Column(True)
    lower = column.bodies[1]
    top = np.flatnonzero((lower.places == (1, 1 / 3, 0.8)).all(axis=1) | (np.abs(lower.places - (1, 1 / 3, 0.8)).max(axis=1) < 1e-9))
    dof = int(lower.dofs[top[0], 0])
    made = column.structure.craig_bampton(4, outputs=[(1, dof)])
    u = np.zeros(made.K.shape[0])
    u[: len(made.rows)] = np.sin(np.arange(len(made.rows)))
    # Relative displacements of all nodes: the body below follows without other forces.
    state = cattaneo.ContactState.with_slip(column.problem, np.zeros(column.problem.components * column.problem.nodes))
    whole = np.zeros(3 * column.problem.nodes)
    whole[made.rows] = u[: len(made.rows)]
    n = column.problem.nodes
    state = cattaneo.ContactState.with_slip(column.problem, whole[: 2 * n])
    u[: len(made.rows)][np.asarray(made.rows) >= 2 * n] = 0
    moved = column.reduction.displacement(1, state)
    assert (made.R @ u)[0] == pytest.approx(moved[dof], rel=1e-8)
    with pytest.raises(cattaneo.InputError, match="must be one of a body"):
        column.structure.craig_bampton(4, outputs=[(2, 0)])


def test_programs_of_dynamics_read_what_is_written(tmp_path):
    """As tmdsimpy's example of the Brake-Reuss beam reads its .mat: with stiff contact it has the glued frequencies."""
    column = Column(True)
    modes = column.structure.modes(column.problem, column.state, 3)
    made = column.structure.craig_bampton(40, outputs=[(0, 0), (0, 1), (0, 2)])
    joints.write_dynamics(tmp_path / "joint.mat", made, column.problem, {"P": 2.0})
    read = loadmat(tmp_path / "joint.mat")
    M, K, L, Fv, R = (read[name] for name in ("M", "K", "L", "Fv", "R"))
    Qm, Tm = np.array(read["Qm"].todense()), np.array(read["Tm"].todense())
    Nnl, nodes = Qm.shape
    assert (Nnl, nodes) == (column.problem.nodes, column.problem.nodes) and M.shape == K.shape
    assert Tm.sum() == pytest.approx(0.8)  # the area
    QL = np.kron(Qm, np.eye(3)) @ L[: 3 * nodes, :]
    LTT = L[: 3 * nodes, :].T @ np.kron(Tm, np.eye(3))
    assert QL.shape == LTT.T.shape == (3 * nodes, M.shape[0])
    assert Fv[:, 0] == pytest.approx(2 * made.F[:, 0]) and R[2, :] == pytest.approx(made.R[2])
    stiff = np.zeros((L.shape[0], L.shape[0]))
    stiff[: 3 * nodes, : 3 * nodes] = np.kron(Tm @ (1e7 * Qm), np.eye(3))
    found = eigh(K + L.T @ stiff @ L, M, eigvals_only=True)[:3]
    assert found == pytest.approx(modes.omega**2, rel=1e-5)
    # Forces that close the gap press.
    u = np.zeros(M.shape[0])
    u[list(made.rows).index(2 * nodes)] = -1
    assert (L @ u)[2] == 1 and np.count_nonzero(L @ u) == 1

    joints.write_dynamics(tmp_path / "joint.npz", made, column.problem)
    with np.load(tmp_path / "joint.npz") as stored:
        assert np.array_equal(stored["K"], made.K) and list(stored["loads"]) == ["P"] and not stored["Fv"].any()
    # As NLvib-py reads matrices: 'row column value' from 1.
    joints.write_dynamics(tmp_path / "joint.txt", made, column.problem)
    i, j, value = np.loadtxt(tmp_path / "joint_M.txt").T
    again = coo_array((value, (i.astype(int) - 1, j.astype(int) - 1)), shape=M.shape).toarray()
    assert np.array_equal(again, made.M)
    with pytest.raises(cattaneo.InputError, match="preload names 'Q', must be one of P"):
        joints.write_dynamics(tmp_path / "joint.mat", made, column.problem, {"Q": 1})
    with pytest.raises(cattaneo.InputError, match="must end with .mat, .npz, .txt, .inp or .bdf"):
        joints.write_dynamics(tmp_path / "joint.xls", made, column.problem)


def flat_joint():
    """Two plates of 2 by 1, one on the other at y = 0, that a pressure holds together, with their pair for programs of dynamics."""
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    bodies = []
    for y in (0, 1), (-1, 0):
        mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 2, 5), np.linspace(*y, 3))
        basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=3)
        K = linear_elasticity(*lame_parameters(2.0, 0.3)).assemble(basis)
        M = skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(basis)
        bodies.append(cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t.T, M=M))
    upper, lower = bodies
    upper.add_traction("P", upper.places[:, 1] == 1, (0.1, -1))
    lower.fix(lower.places[:, 1] == -1, "xy")
    reduction = cattaneo.reduce(*(cattaneo.condense(body, body.contact_line(body.places[:, 1] == 0)) for body in bodies))
    reduction.problem.friction = 0.5
    return reduction.problem, joints.VibratingStructure(reduction, bodies).craig_bampton(6)


def flat_and_in_space():
    column = Column(True)
    return [flat_joint(), (column.problem, column.structure.craig_bampton(5))]


def test_abaqus_takes_the_pair_as_matrix_input(tmp_path):
    """Lines of node, direction, node, direction and value of one triangle; this package reads those in the plane as ABAQUS's own."""
    for problem, made in flat_and_in_space():
        joints.write_dynamics(tmp_path / "joint.inp", made, problem, {"P": 3.0})
        n, N = problem.nodes, len(made.K)
        # The place of each coordinate, by hand.
        number = {(row % n + 1, row // n + 1): k for k, row in enumerate(made.rows)}
        number |= {(n + 1 + k, 1): len(made.rows) + k for k in range(len(made.omega))}
        for name, matrix in (("STIF1", made.K), ("MASS1", made.M)):
            read = np.zeros((N, N))
            for a, i, b, j, value in np.loadtxt(tmp_path / f"joint_{name}.mtx", delimiter=","):
                row, column = number[int(a), int(i)], number[int(b), int(j)]
                read[row, column] = read[column, row] = value
            assert np.array_equal(read, matrix)
        deck = (tmp_path / "joint.inp").read_text()
        assert "*MATRIX ASSEMBLE, STIFFNESS=STIFFNESS, MASS=MASS" in deck and "INPUT=joint_STIF1.mtx" in deck
        forces = np.zeros(N)
        for line in deck[deck.index("*CLOAD\n") + 7 : deck.index("*END STEP")].splitlines():
            node, direction, force = line.split(",")
            forces[number[int(node), int(direction)]] = float(force)
        assert np.array_equal(forces, 3 * made.F[:, 0])
    problem, made = flat_joint()
    joints.write_dynamics(tmp_path / "joint.inp", made, problem)
    back = cattaneo.read_stiffness(tmp_path / "joint_STIF1.mtx", mass=tmp_path / "joint_MASS1.mtx")
    assert eigh(back.K.toarray(), back.M.toarray(), eigvals_only=True) == pytest.approx(eigh(made.K, made.M, eigvals_only=True), rel=1e-9)
    assert np.array_equal(back.places[: problem.nodes], problem.position)


def test_nastran_takes_the_pair_as_dmig(tmp_path):
    """By the columns of Nastran's wide fields, and by pyNastran where it is there."""
    with_it = dict(os.environ, PYTHONPATH=os.environ.get("CATTANEO_PYNASTRAN", ""))
    there = not subprocess.run([sys.executable, "-c", "import pyNastran.bdf.bdf"], env=with_it, capture_output=True).returncode
    for problem, made in flat_and_in_space():
        joints.write_dynamics(tmp_path / "joint.bdf", made, problem, {"P": 3.0})
        n, N = problem.nodes, len(made.K)
        number = {(row % n + 1, row // n + 1): k for k, row in enumerate(made.rows)}
        number |= {(n + 1 + k, 0): len(made.rows) + k for k in range(len(made.omega))}
        lines = (tmp_path / "joint.bdf").read_text().splitlines()
        assert f"SPOINT  {n + 1:8d}THRU    {n + len(made.omega):8d}" in lines
        read = {"KAAX": np.zeros((N, N)), "MAAX": np.zeros((N, N)), "P2G": np.zeros((N, 1))}
        for line in lines:
            fields = [line[8 + 16 * k : 24 + 16 * k] for k in range(4)]
            if line.startswith("DMIG*"):
                name = fields[0].strip()
                column = 0 if name == "P2G" else number[int(fields[1]), int(fields[2])]
            elif line.startswith("*") and fields[1]:
                row, value = number[int(fields[0]), int(fields[1])], float(fields[2].replace("D", "E"))
                read[name][row, column] = value
                if name != "P2G":
                    read[name][column, row] = value
        expected = {"KAAX": made.K, "MAAX": made.M, "P2G": 3 * made.F[:, :1]}
        for name, matrix in expected.items():
            assert np.all(np.abs(read[name] - matrix) <= 0.5e-9 * 1.0001 * np.abs(matrix)), name
        if there:
            subprocess.run([sys.executable, "-c", READ_DMIG, tmp_path / "joint.bdf", tmp_path / "back.npz"], env=with_it, check=True)
            with np.load(tmp_path / "back.npz") as back:
                for name in ("KAAX", "MAAX"):
                    order = [number[tuple(end)] for end in back[name + "_rows"].tolist()]
                    assert np.allclose(back[name], expected[name][np.ix_(order, order)], rtol=1e-9, atol=0)


READ_DMIG = """
import sys
import numpy
from pyNastran.bdf.bdf import read_bdf
model = read_bdf(sys.argv[1], xref=False, punch=True, debug=None)
found = {}
for name in ("KAAX", "MAAX"):
    found[name], rows, columns = model.dmig[name].get_matrix(is_sparse=False)
    found[name + "_rows"] = [rows[k] for k in range(len(rows))]
numpy.savez(sys.argv[2], **found)
"""

"""A bolted joint in time: with the negative of its damping a mode keeps its amplitude, and it has the frequency of the first harmonic.

Two steel plates of 4 mm in plane strain are lapped by 30 mm and held by a bolt. Their condensed pair (Hurty, Craig and Bampton) is
integrated here by implicit steps (BDF2). In each step the states of the nodes are sought that obey the laws of contact and friction.
Nothing of the product is used for that but the pair, the loop's peak as the first state, and its damping ratio.

`python joint_in_time.py` prints the table of docs/joint_dynamics.md."""

import dataclasses

import cattaneo
import numpy as np
import pytest
from cattaneo import joints
from numpy.linalg import inv, solve
from scipy.linalg import eigh

LAP, REACH, THICK, WASHER = 15.0, 60.0, 4.0, 5.0  # mm
STIFFNESS, PRELOAD = 38e3, 500.0  # of the bolt, per thickness
AMPLITUDES = [5e-5, 1e-4, 2e-4]
CYCLES, STEPS = 16, 1000


def plate(sign):
    """The upper plate (1), or the lower one (-1), its half turn."""
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    x = np.r_[np.linspace(-LAP, LAP, 21), np.linspace(LAP, REACH, 16)[1:]]
    mesh = skfem.MeshQuad.init_tensor(x, np.linspace(0, THICK, 4))
    mesh = skfem.MeshQuad(sign * mesh.p, mesh.t)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=3)
    K = linear_elasticity(*lame_parameters(210e3, 0.3)).assemble(basis)
    M = skfem.BilinearForm(lambda u, v, w: 7.85e-9 * dot(u, v)).assemble(basis)
    body = cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t.T, M=M)
    x, y = sign * mesh.p
    under = (y > THICK - 1e-9) & (np.abs(x) < WASHER)
    body.add_forces("bolt", under, "y", -sign / under.sum())
    body.fix(x > REACH - 1e-9, "y" if sign == 1 else "xy")
    return body, (y < 1e-9) & (x < LAP + 1e-9)


@dataclasses.dataclass
class Loops:
    """The pair, the first mode in its coordinates, and the steady loops of the mode."""

    made: joints.CraigBampton
    problem: cattaneo.ReducedProblem
    phi: np.ndarray
    omega: float
    loops: list


def bolted_joint(amplitudes=AMPLITUDES):
    plates = [plate(1), plate(-1)]
    bodies = [body for body, _ in plates]
    reduction = cattaneo.reduce(*(cattaneo.condense(body, body.contact_line(faying)) for body, faying in plates))
    reduction.problem.friction = 0.3
    joint = cattaneo.BoltedJoint(reduction, {"bolt": STIFFNESS})
    problem, tightened = joint.problem, joint.tightened()
    state = joint.march([{}, {"bolt": PRELOAD}]).state
    structure = joints.VibratingStructure(tightened, bodies, {"bolt": STIFFNESS})
    modes = structure.modes(problem, state, 1)
    vibrating = structure.with_modes(modes)
    loops = joints.modal_curve(vibrating, structure.with_modes(modes, state), "mode 1", modes.omega[0], amplitudes, tolerance=1e-6)
    made = structure.craig_bampton(20)
    assert list(made.rows) == list(range(2 * problem.nodes))
    # The glued mode of the pair: closed nodes do not move, open ones do.
    free = np.flatnonzero(np.r_[state.p <= 0, state.p <= 0, np.ones(len(made.omega), bool)])
    squares, shapes = eigh(made.K[np.ix_(free, free)], made.M[np.ix_(free, free)], subset_by_index=[0, 0])
    assert np.sqrt(squares[0]) == pytest.approx(modes.omega[0], rel=1e-5)
    phi = np.zeros(made.K.shape[0])
    phi[free] = shapes[:, 0]
    # Its forces are those of the load "mode 1", the sign too.
    load = -np.r_[vibrating.patterns[-1].q, vibrating.patterns[-1].p]
    forces = (made.M @ phi)[: len(load)]
    phi *= np.sign(forces @ load)
    assert np.abs(forces * np.sign(forces @ load) - load).max() < 1e-3 * np.abs(load).max()
    return Loops(made, problem, phi, modes.omega[0], loops)


OPEN, STICK = 0, 2  # else the direction of slip, 1 or -1


def swept(S, g, before, gap, friction, states):
    """States by sweeps over the nodes, each of which is solved with the forces of all others as they are."""
    n = len(gap)
    G = inv(S)
    force = np.zeros(2 * n)
    states = states.copy()
    for _ in range(400):
        old = force.copy()
        for i in range(n):
            own = G[np.ix_([i, n + i], [i, n + i])]
            v, w = G[[i, n + i]] @ (force - g) - own @ force[[i, n + i]]
            q, p = solve(own, [before[i] - v, -gap[i] - w])
            if w + gap[i] >= 0:
                q, p, states[i] = 0.0, 0.0, OPEN
            elif p >= 0 and abs(q) <= friction[i] * p:
                states[i] = STICK
            else:
                states[i] = s = -np.sign(q)
                p = (-gap[i] - w) / (own[1, 1] - s * friction[i] * own[1, 0])
                q = -s * friction[i] * p
            force[[i, n + i]] = q, p
        if np.abs(force - old).max() <= 1e-12 * np.abs(force).max():
            break
    return states


def obey(S, g, before, gap, friction, states):
    """Displacements and forces {q; p} = S {v; w} + g after a step: p >= 0 or no contact, and |q| <= f p, against the slip.

    before: tangential displacements at the beginning of the step. states: first guess."""
    n = len(gap)
    for trial in range(100):
        closed, slides = states != OPEN, np.abs(states) == 1
        u = np.r_[np.where(states == STICK, before, 0), np.where(closed, -gap, 0)]
        sought = np.flatnonzero(np.r_[~closed | slides, ~closed])
        # Rows of the equations: no force on an open node, q + s f p = 0 on one that slips.
        pressed = np.where(slides, states * friction, 0)
        R, r = S[sought].copy(), g[sought].copy()
        turned = sought < n
        R[turned] += pressed[sought[turned], None] * S[n + sought[turned]]
        r[turned] += pressed[sought[turned]] * g[n + sought[turned]]
        if len(sought):
            u[sought] = solve(R[:, sought], -(r + R @ u))
        force = S @ u + g
        q, p, slip = force[:n], force[n:], u[:n] - before
        small, little = 1e-9 * np.abs(force).max(), 1e-10 * np.abs(u).max()
        now = states.copy()
        now[~closed & (u[n:] + gap < -little)] = STICK
        limit = (states == STICK) & (np.abs(q) > friction * p + small)
        now[limit] = -np.sign(q[limit])
        now[slides & (states * slip < -little)] = STICK
        now[closed & (p < -small)] = OPEN
        if np.array_equal(now, states):
            return u, force, states
        # Changes of all nodes at once may go in circles.
        states = swept(S, g, before, gap, friction, now) if trial in (15, 30, 60) else now
    raise AssertionError("no state obeys the laws")


def in_time(joint, loop, zeta, cycles=CYCLES, steps=STEPS):
    """Times and modal amplitudes from the peak of the loop on, with the damping ratio -zeta of the mode alone."""
    made, problem = joint.made, joint.problem
    n, m = problem.nodes, 2 * problem.nodes
    K, M, inertia = made.K, made.M, made.M @ joint.phi
    C = -2 * zeta * loop.omega * np.outer(inertia, inertia)
    preload = made.F[:, made.loads.index("bolt")] * loop.peak.multipliers[joint.problem.loads.index("bolt")]
    # The peak of the loop, at rest.
    peak = loop.peak
    x = np.r_[peak.v, peak.w, np.zeros(len(made.omega))]
    x[m:] = solve(K[m:, m:], (preload + inertia * loop.force)[m:])
    v = np.zeros_like(x)
    force = np.r_[peak.q, peak.p]
    states = np.where(peak.p > 0, STICK, OPEN)
    h = 2 * np.pi / loop.omega / steps
    times, amplitudes = [0.0], [inertia @ x]
    before = None
    systems = {}
    for step in range(1, cycles * steps + 1):
        # Velocity c x + rv and acceleration c v + ra at the end of the step: backward Euler once, then BDF2.
        c = 1 / h if before is None else 1.5 / h
        if before is None:
            rv, ra = -x / h, -v / h
        else:
            rv, ra = (before[0] - 4 * x) / (2 * h), (before[1] - 4 * v) / (2 * h)
        if c not in systems:
            A = c**2 * M + c * C + K
            W = solve(A[m:, m:], A[m:, :m]).T
            systems[c] = A, W, A[:m, :m] - W @ A[m:, :m]
        A, W, S = systems[c]
        b = preload - M @ (c * rv + ra) - C @ rv
        u, force, states = obey(S, W @ b[m:] - b[:m], x[:n], problem.gap, problem.friction, states)
        before = (x, v)
        x = np.r_[u, solve(A[m:, m:], b[m:] - A[m:, :m] @ u)]
        v = c * x + rv
        times.append(step * h)
        amplitudes.append(inertia @ x)
    return np.array(times), np.array(amplitudes)


def cycles_of(times, amplitudes):
    """Half ranges of the cycles between upward crossings of the middle, and the mean circular frequency."""
    middle = 0.5 * (amplitudes[-STEPS:].max() + amplitudes[-STEPS:].min())
    q = amplitudes - middle
    at = np.flatnonzero((q[:-1] < 0) & (q[1:] >= 0))
    crossed = times[at] - q[at] * (times[at + 1] - times[at]) / (q[at + 1] - q[at])
    ranges = [0.5 * np.ptp(q[a:b]) for a, b in zip(at, at[1:])]
    return np.array(ranges), 2 * np.pi * (len(at) - 1) / (crossed[-1] - crossed[0])


@pytest.fixture(scope="module")
def joint():
    return bolted_joint()


@pytest.mark.parametrize("k", range(len(AMPLITUDES)))
def test_the_mode_keeps_its_amplitude_and_has_the_frequency_of_the_first_harmonic(joint, k):
    loop = joint.loops[k]
    assert loop.steady and loop.zeta > 5e-4 and loop.amplitude == pytest.approx(AMPLITUDES[k], rel=1e-5)
    ranges, omega = cycles_of(*in_time(joint, loop, loop.zeta))
    assert ranges[-1] == pytest.approx(loop.amplitude, rel=0.02)
    assert omega == pytest.approx(loop.omega, rel=0.003)


def test_without_that_damping_the_amplitude_falls(joint):
    """By more than half of what the damping ratio of the first cycle says, and by no more than that."""
    loop = joint.loops[-1]
    ranges, _ = cycles_of(*in_time(joint, loop, 0))
    whole = 2 * np.pi * loop.zeta * (CYCLES - 1)
    assert np.exp(-1.02 * whole) < ranges[-1] / loop.amplitude < np.exp(-0.5 * whole)


if __name__ == "__main__":
    found = bolted_joint()
    print(f"{found.problem.nodes} contact nodes, glued {found.omega / 2 / np.pi:.5g} Hz")
    for loop in found.loops:
        ranges, omega = cycles_of(*in_time(found, loop, loop.zeta))
        cycles = len(ranges) - 1
        in_cycles = loop.zeta - np.log(ranges[-1] / ranges[0]) / (2 * np.pi * cycles)
        print(
            f"q {loop.amplitude:.3e}  frequency {loop.omega / found.omega - 1:+.5f} of glued, in time {omega / loop.omega - 1:+.2e} of it  "
            f"zeta {loop.zeta:.4e}, in time {in_cycles:.4e} ({in_cycles / loop.zeta - 1:+.3f})  amplitude {ranges[-1] / loop.amplitude - 1:+.4f}"
        )

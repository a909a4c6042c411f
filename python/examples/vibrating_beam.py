"""Frequency and damping of a bolted beam of the Brake–Reuß kind against amplitude, from scikit-fem's hexahedra.

Two half beams of steel, 25.4 mm square, are lapped by 120 mm and held by three bolts. The beam is 720 mm long and free. Run as
`python vibrating_beam.py [refinement] [modes] [amplitudes]`: refinement 1 has 110,922 degrees of freedom and 686 contact nodes."""

import sys
import time

import cattaneo
import numpy as np
import skfem
from cattaneo import joints
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

CORNERS = [0, 3, 6, 2, 1, 5, 7, 4]  # scikit-fem's corners of a hexahedron, one side after the other
LAP, WIDTH, HALF, REACH = 120.0, 25.4, 12.7, 300.0  # mm
BOLTS, WASHER, FORCE, STIFFNESS = (-30.0, 0.0, 30.0), 8.0, 4000.0, 3.5e5  # mm, half of its side in mm, N, N/mm
DENSITY = 7.85e-9  # t/mm³, so that frequencies are in Hz


def half_beam(refinement, sign):
    """Full height where |x| > LAP / 2, and half of it along the lap. sign: -1 left and below, 1 right and above."""
    along, across, high, far = (max(2, round(n * refinement)) for n in (97, 6, 8, 103))
    x = np.r_[np.linspace(-LAP / 2, LAP / 2, along + 1), LAP / 2 + np.linspace(0, REACH, far + 1)[1:]]
    y, z = np.linspace(-HALF, HALF, 2 * high + 1), np.linspace(0, WIDTH, across + 1)
    mesh = skfem.MeshHex.init_tensor(x, y, z)
    middle = mesh.p[:, mesh.t].mean(axis=1)
    mesh = mesh.restrict(np.flatnonzero((middle[0] > LAP / 2) | (middle[1] > 0)))
    mesh = skfem.MeshHex(mesh.p * [[sign], [sign], [1]], mesh.t)  # a half turn about z
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    K = linear_elasticity(*lame_parameters(200e3, 0.3)).assemble(basis)
    M = skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(basis)
    x, y, z = mesh.p
    face = np.flatnonzero((np.abs(x) <= LAP / 2 + 1e-9) & (y == 0))
    body = cattaneo.NodalStiffness(K, mesh.p.T, elements=mesh.t[CORNERS].T, M=M, sets={"FACE": face})
    for k, place in enumerate(BOLTS):  # a bolt pulls on the nodes under its washer
        outer = (np.abs(x) <= LAP / 2) & (sign * y > HALF - 1e-9)
        far = np.maximum(np.abs(x - place), np.abs(z - WIDTH / 2))
        under = outer & (far <= max(WASHER, far[outer].min() + 1e-9))
        body.add_forces(f"B{k + 1}", under, "y", -sign / under.sum())
    return body


def seconds(since):
    return f"{time.perf_counter() - since[0]:.1f} s, {time.process_time() - since[1]:.1f} s of CPU"


def now():
    return time.perf_counter(), time.process_time()


refinement = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
count = int(sys.argv[2]) if len(sys.argv) > 2 else 6
amplitudes = np.geomspace(*(float(a) for a in sys.argv[3:5]), int(sys.argv[5])) if len(sys.argv) > 5 else np.geomspace(1e-5, 1e-3, 10)
bodies = [half_beam(refinement, sign) for sign in (1, -1)]
start = now()
reduction = cattaneo.reduce(*(cattaneo.condense(body, body.contact_surface("FACE")) for body in bodies))
reduction.problem.friction = 0.6
bolts = {f"B{k + 1}": STIFFNESS for k in range(len(BOLTS))}
joint = cattaneo.BoltedJoint(reduction, bolts)
problem = joint.problem
print(f"{sum(len(body.dofs) * 3 for body in bodies)} degrees of freedom, {problem.nodes} contact nodes; reduction {seconds(start)}")

# The bolts are tightened together.
start = now()
state = joint.march([{}, dict.fromkeys(bolts, FORCE)]).state
closed = np.count_nonzero(state.p > 0)
print(f"tightening {seconds(start)}: {closed} nodes are closed, {joints.nodes_at_limit(problem, state)} of them at the limit of friction")

# Modes with closed nodes glued, and the loads M φ.
start = now()
tightened = joint.tightened()
structure = joints.VibratingStructure(tightened, bodies, bolts)
modes = structure.modes(problem, state, count)
vibrating, about = structure.with_modes(modes), structure.with_modes(modes, state)
print(f"modes {seconds(start)}: mass {structure.mass:.6g} t, {modes.rigid} rigid motions, Hz", *(f"{f:.5g}" for f in modes.omega / (2 * np.pi)))

# Loops of each mode.
start = now()
for k, omega in enumerate(modes.omega):
    its = now()
    for loop in joints.modal_curve(vibrating, about, f"mode {k + 1}", omega, amplitudes, tolerance=0.02, increments=8):
        print(
            f"mode {k + 1}  q {loop.amplitude:9.3e}  ω/ω₀ {loop.omega / omega:9.6f} ± {loop.omega_error / omega:7.1e}  "
            f"ζ {loop.zeta:9.3e} ± {loop.zeta_error:7.1e}  {loop.cycles} cycles {'steady' if loop.steady and loop.converged else loop.message}",
            flush=True,
        )
    print(f"  mode {k + 1}: {seconds(its)}", flush=True)
print(f"loops {seconds(start)}")

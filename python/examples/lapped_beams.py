"""A joint in space from scikit-fem's hexahedra: two half beams lapped, pressed together, and pulled to and fro.

The script writes the stiffness of both as files, as another program would; the rest starts from these and is timed. Run as
`python lapped_beams.py [refinement] [folder]`: refinement 1 has 110,922 degrees of freedom and 686 contact nodes, 0.25 few."""

import pathlib
import sys
import tempfile
import time

import cattaneo
import numpy as np
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

CORNERS = [0, 3, 6, 2, 1, 5, 7, 4]  # scikit-fem's corners of a hexahedron, one side after the other
LAP, WIDTH, HALF, REACH = 120.0, 25.0, 12.5, 130.0  # mm


def half_beam(refinement, sign):
    """Full height where |x| > LAP / 2, and half of it along the lap; steel, in N and mm. sign: -1 left and below, 1 right and above."""
    along, across, high, far = (max(2, round(n * refinement)) for n in (97, 6, 8, 103))
    x = np.r_[np.linspace(-LAP / 2, LAP / 2, along + 1), LAP / 2 + np.linspace(0, REACH, far + 1)[1:]]
    y, z = np.linspace(-HALF, HALF, 2 * high + 1), np.linspace(0, WIDTH, across + 1)
    mesh = skfem.MeshHex.init_tensor(x, y, z)
    middle = mesh.p[:, mesh.t].mean(axis=1)
    mesh = mesh.restrict(np.flatnonzero((middle[0] > LAP / 2) | (middle[1] > 0)))
    mesh = skfem.MeshHex(mesh.p * [[sign], [sign], [1]], mesh.t)  # a half turn about z
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    K = linear_elasticity(*lame_parameters(200e3, 0.3)).assemble(basis)
    x, y = mesh.p[:2]
    lap = np.abs(x) <= LAP / 2 + 1e-9
    sets = {"FACE": lap & (y == 0), "OUTER": lap & (sign * y > HALF - 1e-9), "END": sign * x > LAP / 2 + REACH - 1e-9}
    elements = mesh.t[CORNERS].T
    return cattaneo.NodalStiffness(K, mesh.p.T, elements=elements, sets={k: np.flatnonzero(v) for k, v in sets.items()})


refinement = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp())
for name, sign in (("left", -1), ("right", 1)):
    body = half_beam(refinement, sign)
    print(f"{name}: {body}")
    cattaneo.write_matrix_market(str(folder / f"{name}.mtx"), body)

# From the files to the reduced problem.
clock = time.perf_counter(), time.process_time()
left, right = (cattaneo.read_stiffness(str(folder / f"{name}.mtx")) for name in ("left", "right"))
read = time.perf_counter() - clock[0]
left.fix("END", "xyz")
for body, side in ((left, -1), (right, 1)):
    body.add_traction("BOLTS", "OUTER", (0, -side * 2.0, 0))  # N/mm²: 6 kN on the lap
right.add_traction("PULL", "END", (2.0, 0, 0))
bodies = [cattaneo.condense(body, body.contact_surface("FACE")) for body in (right, left)]
condensed = time.perf_counter() - clock[0]
reduction = cattaneo.reduce(*bodies)
problem = reduction.problem
problem.friction = 0.4
print(f"{problem.nodes} contact nodes; reading {read:.2f} s, condensing {condensed - read:.2f} s, reducing "
      f"{time.perf_counter() - clock[0] - condensed:.2f} s; together {time.process_time() - clock[1]:.2f} s of CPU")

# A cycle of partial slip of 60 increments.
clock = time.perf_counter(), time.process_time()
pulled = [{"BOLTS": 1, "PULL": pull} for pull in (1, -1, 1)]
history = cattaneo.LoadHistory.through(problem, [{}, {"BOLTS": 1}, *pulled], cycle_start=2, cycles=1)
report = cattaneo.march(problem, history, increments=30, loss_error=False)
print(f"march {time.perf_counter() - clock[0]:.2f} s, {time.process_time() - clock[1]:.2f} s of CPU")
print(report)
loop = report.cycles[-1].loops["PULL"]
print(f"loss of a cycle {loop.work:.6g} N mm, loss factor {loop.loss_factor:.4g}")
forces = reduction.contact_forces(0, report.state)
print("forces of the lap on the right beam", " ".join(f"{force:.6g}" for force in forces.sum(axis=0)), "N")

"""A CalculiX matrix to a hysteresis loop: two laps, clamped and pulled to and fro.

CalculiX writes the stiffness of a deck (*FREQUENCY, SOLVER=MATRIXSTORAGE); nothing is meshed or assembled here. Run as
`python calculix_loop.py laps.sti [loop.png]`; meshes/calculix has the deck and its matrix."""

import pathlib
import sys

import cattaneo

shipped = pathlib.Path(__file__).parents[2] / "meshes" / "calculix" / "laps.sti"
matrix = sys.argv[1] if len(sys.argv) > 1 else shipped

lower, upper = cattaneo.read_stiffness(matrix).parts()  # bodies are found and named by their sets
upper.add_loads("T traction PULLED 100 0")  # 100 N/mm² on the end
below, above = lower.contact_line("LOWER_FACE"), upper.contact_line("UPPER_FACE")
bodies = [cattaneo.condense(lower, below), cattaneo.condense(upper, above)]
reduction = cattaneo.reduce(bodies, [cattaneo.Interface("lap", (0, below), (1, above))])
problem = reduction.problem
problem.friction = 0.5
print(reduction)

clamped = {"CLOAD1": 1}
pulled = [clamped | {"T": t} for t in (0.3, -0.3, 0.3)]
history = cattaneo.LoadHistory.through(problem, [{}, clamped, *pulled], cycle_start=2, cycles=3)
report = cattaneo.march(problem, history)
print(report)
loop = report.cycles[-1].loops["T"]
print(f"loss of a cycle {loop.work:.6g}, secant stiffness {loop.stiffness:.6g}, loss factor {loop.loss_factor:.4g}")
u = reduction.displacement(1, report.state)  # of every row of the matrix of the upper lap
print(f"the pulled end moves by {u[upper.dofs[upper.nodes.searchsorted(upper.nodes_of('PULLED')), 0]].mean():.6g} mm")

if len(sys.argv) > 2:
    report.plot()[0].figure.savefig(sys.argv[2])

"""A CalculiX matrix of solids to forces in space: two blocks of C3D8, pressed on each other and sheared.

CalculiX writes the stiffness of a deck (*FREQUENCY, SOLVER=MATRIXSTORAGE); nothing is meshed or assembled here. Run as
`python calculix_blocks.py blocks.sti`; meshes/calculix has the deck and its matrix."""

import pathlib
import sys

import cattaneo

shipped = pathlib.Path(__file__).parents[2] / "meshes" / "calculix" / "blocks.sti"
lower, upper = cattaneo.read_stiffness(str(sys.argv[1] if len(sys.argv) > 1 else shipped)).parts()
upper.add_traction("Q", "UPPER_FAR", (0.2, 0, 0.1))  # N/mm² on its top, beside the forces of the deck
bodies = [cattaneo.condense(body, body.contact_surface(f"{body.name}_FACE")) for body in (upper, lower)]
reduction = cattaneo.reduce(*bodies)  # nodes of both faces match
reduction.problem.friction = 0.3
print(reduction)

report = cattaneo.march(reduction.problem, [{}, {"CLOAD1": 1}, {"CLOAD1": 1, "Q": 1}])
print(report)
forces = reduction.contact_forces(0, report.state)
print("forces on the upper block", " ".join(f"{force:.6g}" for force in forces.sum(axis=0)), "N")
u = reduction.displacement(0, report.state)  # of every row of the matrix of the upper block
far = upper.nodes.searchsorted(upper.nodes_of("UPPER_FAR"))
print("its top moves by", " ".join(f"{move:.6g}" for move in u[upper.dofs[far]].mean(axis=0)), "mm")

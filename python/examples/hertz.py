"""Hertz in ten lines: a block meshed by scikit-fem, with a parabolic gap, is pressed on an elastic half-plane.

The half-width and the peak pressure are those of Hertz for two half-planes, as far as the block is large:
a = sqrt(4 P R / (pi E*)), p0 = 2 P / (pi a), E* = E / (2 (1 - nu^2))."""

import cattaneo
import numpy as np
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad
from skfem.models.elasticity import lame_parameters, linear_elasticity

E, nu, R, P, size = 1.0, 0.3, 100.0, 0.01, 40.0

side = np.concatenate([np.linspace(0, 2, 25), np.geomspace(2, size, 15)[1:]])  # graded toward the contact
mesh = MeshQuad.init_tensor(np.concatenate([-side[:0:-1], side]), side)
basis = Basis(mesh, ElementVector(ElementQuad2()))
K = linear_elasticity(*lame_parameters(E, nu)).assemble(basis)

places = basis.doflocs.T[::2]  # scikit-fem's rows 2 i and 2 i + 1 are x and y of node i
body = cattaneo.NodalStiffness(K, places, elements=basis.element_dofs.T[:, ::2] // 2)
body.add_traction("P", places[:, 1] == size, (0, -P / (2 * size)))
line = body.contact_line((places[:, 1] == 0) & (abs(places[:, 0]) <= 2))
half_plane = cattaneo.HalfPlane(cattaneo.Material(E, nu), depth=1e4)
problem = cattaneo.reduce(cattaneo.condense(body, line), half_plane).problem
problem.gap = problem.position[:, 0] ** 2 / (2 * R)
report = cattaneo.march(problem, [{}, {"P": 1}])

modulus = cattaneo.fretting.contact_modulus(E, nu)
hertz = cattaneo.fretting.hertz_contact(P, R, modulus)
zone = cattaneo.readout.contact_zone(problem, report.state)
peak = cattaneo.readout.tractions(problem, report.state.p).max()
print(report)
print(f"half-width {zone.width / 2:.5f}, Hertz {hertz.half_width:.5f}")
print(f"peak pressure {peak:.6f}, Hertz {hertz.peak_pressure:.6f}")

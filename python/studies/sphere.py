"""Contact of spheres in three dimensions, beside closed forms: pressed, sheared, twisted, and sheared around a circle.

    python sphere.py [CELLS] [figure.png]      CELLS across the contact, 21 if not given

Two equal elastic spheres (Hertz, Cattaneo and Mindlin, torsion, circular paths), then a rigid one on an elastic
half-space (Spence). Lengths in mm, forces in N.
"""

import sys

import cattaneo
import numpy as np

ACROSS = int(sys.argv[1]) if len(sys.argv) > 1 else 21
YOUNG, POISSON, FRICTION, RADIUS, A = 210e3, 0.3, 0.3, 100.0, 1.0
STEEL = cattaneo.Material(young=YOUNG, poisson=POISSON)
SHEAR = YOUNG / (2 * (1 + POISSON))
ONE = cattaneo.MarchSettings(increments=1)  # of each leg: nothing couples, and slip hardly turns


def contact(material, other, turns=False, reach=1.2):
    """Squares within `reach` of the contact's radius, and the gap of a sphere."""
    edge = 2 * A / ACROSS
    half = int(np.ceil(reach * A / edge))
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [edge * np.arange(-half, half + 1)]))
    inside = np.hypot(x, y) < reach * A
    space = cattaneo.HalfSpace(material, other, size=edge, centres=np.column_stack([x[inside], y[inside]]), turns=turns)
    # Two spheres of 2 R each are as far apart as one of R and a plane.
    problem = space.problem(gap=(space.centres**2).sum(axis=1) / (2 * RADIUS))
    problem.friction = FRICTION
    return space, problem


def moved(problem, state, load):
    return cattaneo.conjugates(problem, state)[problem.loads.index(load)]


def row(what, computed, exact):
    print(f"{what:44} {computed:12.5e} {exact:12.5e} {100 * (computed / exact - 1):8.3f} %")


print(f"{'':44} {'computed':>12} {'closed form':>12} {'apart':>10}")

# 1. Hertz: two equal bodies, E* = E/(2 (1 - ν²)).
space, problem = contact(STEEL, STEEL, turns=True)
load = 4 / 3 * YOUNG / (2 * (1 - POISSON**2)) * A**3 / RADIUS
pressed = cattaneo.march(problem, [{}, {"P": load}], settings=ONE).state
row("Hertz: approach", moved(problem, pressed, "P"), A**2 / RADIUS)
row("Hertz: largest pressure", pressed.p.max() / problem.weights[0], 1.5 * load / (np.pi * A**2))
area = cattaneo.readout.contact_areas(problem, pressed).contact
row(f"Hertz: area (± {area.error:.2f})", area.area, np.pi * A**2)

# 2. Cattaneo and Mindlin: δ = 3 f P/16a Σ (2 - ν)/G (1 - (1 - Q/fP)^⅔), stick within a (1 - Q/fP)^⅓. Exact for ν = 0.
share = 0.7
full = 3 * FRICTION * load / (16 * A) * 2 * (2 - POISSON) / SHEAR
sheared = cattaneo.march(problem, [{}, {"P": load}, {"Q1": share * FRICTION * load}], settings=ONE).state
row("Cattaneo and Mindlin: shift", moved(problem, sheared, "Q1"), full * (1 - (1 - share) ** (2 / 3)))
stick = cattaneo.readout.contact_areas(problem, sheared).stick
row(f"Cattaneo and Mindlin: stick (± {stick.error:.2f})", stick.area, np.pi * A**2 * (1 - share) ** (2 / 3))

# 3. Torsion by a thousandth of the torque that spins them, 3π f P a/16 (Lubkin): stiffness 8 G a³/3 of two bodies that
# hardly slip (Reissner and Sagoci).
little = 1e-3 * 3 * np.pi / 16 * FRICTION * load * A
twisted = cattaneo.march(problem, [{}, {"P": load}, {"T": little}], settings=ONE).state
row("torsion: turn where little slips", moved(problem, twisted, "T"), little / (8 / 3 * SHEAR * A**3))

# 4. Around a circle: slip turns in every increment, and the loss of the second turn is extrapolated from three marches.
Q = 0.5 * FRICTION * load
corners = [{"Q1": Q * np.cos(angle), "Q2": Q * np.sin(angle)} for angle in np.linspace(0, 2 * np.pi, 9)]
settings = cattaneo.MarchSettings(increments=4, loss_error=True)
around = cattaneo.march(problem, [{}, {"P": load}, *corners], settings=settings)
print(f"once around a circle of Q = fP/2: lost {around.dissipation.sum():.4e} (± {around.loss_error:.1e}, {around.loss_error_is})", end="")
print("" if np.isnan(around.extrapolated_loss) else f", without increments {around.extrapolated_loss:.4e}")

# 5. Spence: a rigid sphere slips while it is pressed; the radius of stick stays in proportion to that of contact.
space, problem = contact(STEEL, None)
load = 4 / 3 * YOUNG / (1 - POISSON**2) * A**3 / RADIUS
stages = cattaneo.march(problem, [{}, *({"P": load * k**3} for k in np.linspace(0.4, 1, 4))], settings=ONE, keep_states=True)
print("Spence: radius of stick over that of contact", end="")
for state in stages.states:
    parts = cattaneo.readout.contact_areas(problem, state)
    print(f" {np.sqrt(parts.stick.area / parts.contact.area):.3f}", end="")
print()

if len(sys.argv) > 2:
    import matplotlib.pyplot as plt

    axes = plt.subplots(1, 3, figsize=(14, 4), layout="constrained")[1]
    problem = contact(STEEL, STEEL, turns=True)[1]
    for axis, state, title in zip(axes, (sheared, twisted, around.state), ("sheared", "twisted", "around a circle")):
        q = state.q.reshape(2, -1) / problem.weights
        x, y = problem.position[:, 0], problem.position[:, 1]
        drawn = axis.scatter(x, y, c=np.hypot(*q), s=2e4 / ACROSS**2, marker="s")
        axis.quiver(x, y, *q, color="white")
        axis.set(title=title, aspect="equal")
        plt.colorbar(drawn, ax=axis, label="shear")
    plt.savefig(sys.argv[2])

"""Chapter 8: what the thesis leaves to others."""

import figures as f
from chapter import Chapter

PAD = "design"
MISMATCH = 'shakedown -nodes 101 -find load -reversal -1 -mismatch "0.01 0.03 0.1 0.3 1 3 10 30 100"'
BOLTS = 'lap_joint -bolts "-1.5 0 1.5" -friction 0.4 -load 0.2 -spacing 0.0125'
LOWER = "shakedown -find load -nodes 101"

CHAPTER = Chapter(8, "Further work", """
The thesis ends with five proposals. What became of them here.
""")
figure = CHAPTER.figure


def mismatch(run):
    sheet, both = f.sheet(2)
    rows = run.rows("mismatch")
    at = [row["plane_stiffness"] for row in rows]
    f.curves(both[0], {"": (at, [row["coupling"] for row in rows])}, "E' of the half-plane over the block's", "degree of coupling", legend=False, marker="o")
    f.curves(both[1], {"R = -0.5": (at, [row["load_limit"] for row in rows]), "R = -1": (at, [row["load_limit_reversed"] for row in rows])},
             "E' of the half-plane over the block's", "largest λ, f = 0.85", marker="o")
    for axes in both:
        axes.set_xscale("log")
    return sheet


figure("8.2 (1)", "Optimised profiles", [PAD, "design --profile crown --loads \"0.3 1\" --weights \"2 1\""], """
The profile of the punch whose largest pressure is least, found by derivatives of the solved contact: from a flat pad, whose pressure is singular at its ends, to one that presses
uniformly. Another objective, the energy lost in a cycle, and limits of curvature: `docs/design.md`.""",
       lambda run, _: f.panels((run, "profile", {"title": "gap"}), (run, "pressure", {"title": "pressure", "limits_y": "0,3"})), rows="uniform|gap at")
figure("8.2 (2)", "Coupling", MISMATCH, """
The degree of coupling is the largest share of elastic energy that slip and opening can have in common, a number between 0 and 1 that doesn't depend on the mesh; for two half-planes it is
Dundurs' |β|. Here it and the limits, for blocks on softer and stiffer half-planes. The stiffer the half-plane, the more coupling and the less the contact bears.""", mismatch)
figure("8.2 (3)", "Order of tightening", BOLTS, """
Three bolts in a row, tightened from the middle outward, and from outside inward: the shear that is left after it, and what it does to the loss in a steady cycle.""",
       lambda run: f.panels((run, "residual", {"title": "Shear left by tightening"}), (run, "dissipation", {"title": "Loss a steady cycle"})))
CHAPTER.missing("8.2 (4)", "Lower limit of shakedown", "for the thesis' punch the program proves no lower limit; `./run shakedown -starts 20` searches starts that slip for ever")
CHAPTER.missing("8.2 (5)", "Shakedown of receding contact", "no study cycles the pressure of a receding contact yet; the theory assumes a set of nodes that stay closed, which a receding contact has only inside")

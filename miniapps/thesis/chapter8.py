"""Chapter 8: what the thesis leaves to others."""

import figures as f
from chapter import Chapter

PAD = "design"
FRICTIONS = (0.7, 0.85, 1)
MISMATCH = [f'shakedown -nodes 65 -find load -friction {friction:g} -mismatch "0.01 0.1 0.3 1 3 10 100" -mismatch-poisson "0 0.15 0.3 0.4 0.49"' for friction in FRICTIONS]
BOLTS = ['lap_joint -bolt-positions "-1.2 0 1.2" -lower-thickness 2 -load 0.1 -spacing 0.025', 'lap_joint -bolt-positions "-1.5 0 1.5" -friction 0.4 -load 0.2 -spacing 0.025']
LOWER = ["shakedown -find load -nodes 65 -lower -starts 8", "shakedown -find load -obstacle rigid -nodes 65 -friction 0.6 -lower -starts 8"]
MAP = "shakedown -find load -map -loads-over-friction -transposed -lower"
RECEDING = 'plane_receding -spacing 0.04 -corner 0.01 -increments 20 -cycles 40 -cycle-to "0.2 0.4 0.6 0.8 0.9 0.95"'

CHAPTER = Chapter(8, "Further work", """
The thesis ends with five proposals. This chapter shows what Cattaneo has made of them.
""")
figure = CHAPTER.figure


def mismatch(*all_runs):
    sheet, axes = f.sheet(4, height=3.6)
    rows = all_runs[0].rows("mismatch")
    stiffnesses, ratios = (sorted({row[key] for row in rows}) for key in ("plane_stiffness", "plane_poisson"))
    f.curves(axes[0], {f"E' ratio {one:g}": zip(*((row["beta"], row["coupling"]) for row in rows if row["plane_stiffness"] == one)) for one in stiffnesses},
             "Dundurs' β", "degree of coupling", marker="o", markersize=3)
    axes[0].plot([-0.3, 0, 0.45], [0.3, 0, 0.45], color="black", linewidth=0.8, label="|β|, two half-planes")
    f.curves(axes[1], {f"ν = {one:g}": zip(*((row["plane_stiffness"], row["coupling"]) for row in rows if row["plane_poisson"] == one)) for one in ratios},
             "E' of the half-plane over the block's", "degree of coupling", marker="o", markersize=3)
    for k, (run, friction) in enumerate(zip(all_runs, FRICTIONS)):
        rows = run.rows("mismatch")
        for key, word, style in (("load_limit", "-0.5", "-"), ("load_limit_reversed", "-1", (0, (5, 2)))):
            same = [row for row in rows if row["plane_poisson"] == 0.3]
            f.curves(axes[2], {f"f = {friction:g}, R = {word}": ([row["plane_stiffness"] for row in same], [row[key] / friction for row in same])},
                     "E' of the half-plane over the block's, ν = 0.3", "largest λ/f", color=f.COLOURS[k], linestyle=style)
        axes[3].plot([row["coupling"] for row in rows], [row["load_limit_reversed"] / friction for row in rows], f.plot.MARKERS[k], color=f.COLOURS[k], markersize=4,
                     label=f"f = {friction:g}")
    f.label(axes[3], "degree of coupling", "largest λ/f, R = -1, all pairs")
    for one in axes[1:3]:
        one.set_xscale("log")
    for one in (axes[0], axes[2]):
        f.label(one)
        one.legend(fontsize=6.5, loc="best", ncol=2)
    return sheet


def lower(*all_runs):
    """What is known of loads that shake down from every start."""
    sheet, (axes, proven) = f.sheet(2, height=3.4)
    names = ("half-plane,\nf = 0.85", "rigid plane,\nf = 0.6")
    for k, run in enumerate(all_runs[:2]):
        limit, quiet, found, opens = run["load_limit"], run.json.get("quiet_up_to") or 0, run.json.get("counter_example"), run.json.get("opens_at")
        axes.barh(k, limit, color="#DDEBF5", height=0.5, label=None if k else "λ2 (proven)")
        axes.barh(k, quiet, color="#9CC3E0", height=0.5, label=None if k else "no start of those tried slips\nfor ever where it stays closed")
        axes.plot([limit, limit], [k - 0.3, k + 0.3], color="black", linewidth=2)
        if found:
            axes.plot([found], [k], "X", color=f.COLOURS[1], markersize=9, label="some start slips for ever")
        if opens:
            axes.plot([opens], [k], "o", color=f.COLOURS[1], markersize=7, label=None if k else "some start leaves nodes that open and slip")
    axes.set_yticks(range(2), names)
    f.label(axes, "λ = Qmax/P0, R = -0.5", title="Marches")
    axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.4, -0.2), ncol=1, frameon=False)
    for run, words in ((all_runs[0], "half-plane, 65 nodes"), (all_runs[2], "half-plane, 201 nodes"), (all_runs[1], "rigid plane, f = 0.6, 65 nodes")):
        rows = run.rows("lower_limits_apart")
        f.curves(proven, {words: ([row["distance"] for row in rows], [row["load_factor"] for row in rows])}, marker="o", markersize=3)
    proven.axhline(all_runs[0]["load_limit"], color="black", linewidth=0.8, linestyle=":")
    proven.text(0.03, all_runs[0]["load_limit"] + 0.015, "λ2, half-plane", fontsize=7.5)
    f.label(proven, "distance δ from an end, over a", "λ", "Below: slip for ever needs slip within δ")
    proven.set_ylim(0, 0.95)
    proven.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=1, frameon=False)
    return sheet


figure("8.2 (1)", "Optimised profiles", [PAD, "design --profile crown --loads \"0.3 1\" --weights \"2 1\""], """
The profile of the punch with the smallest peak pressure, found by derivatives of the solved contact: from a flat pad, whose pressure is singular at its ends, to one that presses
uniformly. Another objective, the energy lost in a cycle, and limits of curvature: `docs/design.md`.""",
       lambda run, crown: f.panels((run, "profile", {"title": "gap, P alone"}), (run, "pressure", {"title": "pressure", "limits_y": "0,3"}),
                                   (crown, "profile", {"title": "gap, a crown for two loads"}), (crown, "pressure", {"title": "pressure", "limits_y": "0,3"})),
       rows="uniform|gap at")
figure("8.2 (2)", "Coupling", MISMATCH, """
The degree of coupling is the largest share of elastic energy that slip and opening can have in common, a number between 0 and 1; for two half-planes it is
Dundurs' |β|. Here it and the limits, for blocks (ν = 0.3) on half-planes of other stiffness and Poisson's ratio. Above: on a soft half-plane the block is nearly rigid, and its corners have little
influence: the coupling follows |β|, except for a small remainder. On stiffer ones the shape of the block decides, and β has little influence. Below: the limit for three coefficients of friction (λ =
f is gross sliding), and the limit over the coupling. The coupling doesn't decide the limit, because it doesn't depend on the loads. Only α and β count, not the four constants: blocks with ν = 0, 0.2
and 1/3 on half-planes that have the same α and β have the same limits to a few parts in ten thousand.

The number needs a fine mesh: for equal bodies it is 0.411 on 17 nodes, 0.430 on the 65 of the figure, 0.440 on 201 and 0.445 on 401, and still rises, because the corner is singular.""", mismatch)
figure("8.2 (3)", "Order of tightening", BOLTS, """
Three bolts in a row, tightened from the middle outward, and from outside inward: the residual shear after tightening, and the loss in a steady cycle. With laps of different thickness the order
changes the residual shear. Equal laps have none (second command), because by symmetry pressing doesn't shear them.""",
       lambda run, _: f.panels((run, "residual", {"title": "Shear left by tightening"}), (run, "dissipation", {"title": "Loss per steady cycle"})))
figure("8.2 (4)", "Lower limit of shakedown", [*LOWER, MAP], """
Below λ1 a coupled contact shakes down from every start, between λ1 and λ2 from some starts. The thesis proposes to solve the constraints of all combinations of states, of which there are too many.
Here is what is proven, and what was tried.

*Proven.* For the thesis' block no positive λ1 is known, because an admissible slip may take all pressure from the nodes at the corners under P alone, and friction can then hold nothing there. But a
weaker statement is proven. In a contact that stays closed, slip can go on for ever below the load on the right only if nodes within a distance δ of a corner slip for ever. For λ = 0.6, which is seven
tenths of λ2, this distance is 0.05 a. The proof is an energy of the remaining slip. It falls whenever a node slips whose pressure is certainly large enough.

*Tried* (left): marches from random and adversarial starts. None slips for ever at nodes that stay closed, up to 0.98 λ2. But from starts that take the pressure from the corners a few nodes there open and slip in every cycle, even at λ = 0.05; they
lose less than a ten-millionth of what the first cycle does. For a contact that may open, λ1 is no larger than that load, so there is nothing to prove. The mesh then decides the state of the corners.""", lower)
figure("8.2 (5)", "Shakedown of a receding contact", RECEDING, """
The strip of chapter 5 under a pressure that goes between p0 and less: loss in each cycle. The theory assumes a set of nodes that stay closed. It does not apply here, because nodes at the edge open
and close with the load (the table of the command counts them). These are marches from one start: an observation, not a proof. The loss that remains falls with the third power of the range if that is
small, with the fifth if it is large. It is there even when the load loses only a twentieth, because whatever makes the contact recede further makes its edge slip. Left: zones in the first two cycles,
down to 0.2.""",
       lambda run: f.panels((run, "load_cycle_zones", {"title": "", "limits_y": "-2,2"}), (run, "load_losses", {"title": ""})))

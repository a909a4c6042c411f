"""Chapter 2: what the edge of an incomplete contact does to a crack."""

import html
import json
import math

import figures as f
import runs
import sketches
from chapter import Chapter

EDGE = "fretting --friction 0.8"
FIELD = "./test -R NearEdgeField"  # the field against numerical integrals of its tractions
# Edges whose crack, at the length a0, is driven just as hard as the threshold: K_N for X = 0.2, K_T for its Y.
CRITICAL = ["fretting --pad kn --k-n 145.480218262 --k-t 39.142037 --friction 0.8", "fretting --pad kn --k-n 145.480218262 --k-t 75.593 --friction 0.3"]
DATA = "miniapps/data/fretting_records"
TESTS = {"a": (f"fretting --material Al --records {DATA}.csv", "aluminium alloy, cylinders"),
         "b": (f"fretting --material Ti6Al4V --records {DATA}_titanium.csv", "titanium alloy, cylinders"),
         "c": (f"fretting --material Ti6Al4V --pad flat-rounded --radius 3 --flat 3 --normal-load 1000 --shear-load 20 --records {DATA}_rounded.csv", "titanium alloy, flat pads with round edges")}
NICKEL = f"fretting --material Nickel --records {DATA}_nickel.csv"
TOGETHER = f"fretting --records {DATA}_together.csv"
REDUCED = TESTS["c"][0] + " --load-ratio 0.5"
DEPTHS = (0.05, 0.1, 0.2)
PLANES = [f"fretting --pad fe --shear-load 50 --bulk 0 --averaging-depth {depth}" for depth in DEPTHS]
PROOFS = {"2.9": "./test -R 'Measures|EdgeCrack'", "2.10": "./test -R SlipEnergy"}
INVENTED = "The tests shown are *invented*: those of the thesis are in papers whose numbers its text doesn't give. Put your own in such a file. "

CHAPTER = Chapter(2, "Correlation of fretting fatigue tests", """
Two bodies of the same material touch over a width 2a that grows with the load, and are sheared: near the edges they slip to and fro, and there cracks begin. Close to an edge all such contacts are
alike. The pressure rises as p = K_N √t with the distance t from the edge, and the shear would be q = K_T/√t if nothing slipped: these two numbers contain all effects of shape and loads. The slip zone
has the width d = 2 K_T/(f K_N).

From K_N, K_T and the friction coefficient f follow, in closed form: the stresses, and whether the slip zone yields (2.2 to 2.4); the stress at the edge, the classical measure of fatigue (2.5);
the stress intensity of a crack that grows from the edge, and with it the verdict of Kitagawa and Takahashi: does it go on growing when it has the critical length a0, or
does it stop (2.6 to 2.8)? The range of K_T as a mode II intensity (2.9), and the frictional energy of a cycle (2.10).

Several formulas of the thesis are misprinted or wrong; each one used here was checked against an independent numerical method. Lengths are in d, stresses in K_N √d, unless said.
""")
figure = CHAPTER.figure


def plain(series):
    return series.replace(" (design)", "")


def fields(run):
    """Of the run's own friction alone."""
    return f.panels((run, "field", {"title": "", "only": lambda s: s == f"f = {run['friction']:g} (design)"}))


def materials():
    shown = json.loads((runs.SOURCE / "miniapps/data/materials.json").read_text(encoding="utf-8"))["materials"]
    keys = {"name": "material", "young_GPa": "E, GPa", "poisson": "ν", "threshold_MPa_sqrt_m": "ΔK_th, MPa√m", "fatigue_limit_MPa": "σ_fl (range), MPa",
            "shear_yield_MPa": "k, MPa", "friction": "f", "source": "source"}

    def cell(value):
        return html.escape(" to ".join(map(str, value)) if isinstance(value, list) else str(value))

    body = "".join("<tr>" + "".join(f"<td>{cell(one[key])}</td>" for key in keys) + "</tr>" for one in shown)
    head = "".join(f"<th>{name}</th>" for name in keys.values())
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody class="plain">{body}</tbody></table></div>'


def spots(*all_runs):
    """Yield of the slip zone, with the tests as spots."""
    sheet, (axes,) = f.sheet(1, height=3.7)
    for name, curve in all_runs[0].series("yield").items():
        if name != "design":
            f.curves(axes, {name: curve})
    for k, (run, words) in enumerate(zip(all_runs, [*(words for _, words in TESTS.values()), "nickel, cylinders"])):
        rows = run.rows("records")
        axes.plot([row["friction"] for row in rows], [row["yield_load"] for row in rows], f.plot.MARKERS[k], color=f.COLOURS[2 + k], markersize=5, label=words + " (invented)")
    f.label(axes, "friction coefficient f", "K_N √d/k")
    axes.set_ylim(0, 6)
    return sheet


def together(run):
    """All tests of a file, legends where they hide none."""
    sheet = f.panels(*((run, panel, {"title": title}) for panel, title in (("stress", "2.5: stress at the edge, invented tests"), ("threshold_tests", "2.8: invented tests and threshold"),
                                                                          ("mode_two", "2.9: range of K_T, invented tests"), ("energy", "2.10: frictional energy, invented tests"))), height=4)
    for axes in sheet.axes:
        # Limits of several materials, and thresholds of several frictions, are told apart.
        for k, line in enumerate(line for line in axes.get_lines() if line.get_color() == "#555555"):
            line.set(color=("#333333", "#B00020", "#7A4FA3")[k % 3], linestyle=f.DASHES[1 + k % 3])
        axes.legend(fontsize=6.5, loc="upper center", bbox_to_anchor=(0.5, -0.19), ncol=2, frameon=False)
    return sheet


def kitagawa(run, critical, _):
    """Trajectories, and the boundary of Kitagawa and Takahashi for the edge whose trajectory passes its corner A."""
    sheet, (axes,) = f.sheet(1, height=4)
    for k, (name, curve) in enumerate(run.series("trajectory").items()):
        if "design" not in name or name.startswith("f = 0.8"):
            f.curves(axes, {plain(name): curve}, color=f.COLOURS[k], linestyle=f.DASHES[k])
    d, scale = critical["slip_zone"], math.sqrt(critical["k_n"] * critical["k_t_trailing"] * critical["slip_zone"])
    a0, threshold = critical["critical_length"] / d, critical["k_threshold"] / scale
    depth = [k / 200 for k in range(201)]
    boundary = [min(critical["fatigue_limit"] * math.sqrt(math.pi * c * d) / scale, threshold) for c in depth]
    axes.fill_between(depth, boundary, color="#FBE9DC")
    axes.plot(depth, boundary, color="#B00020", linewidth=2, label="threshold, X = 0.2")
    axes.plot([a0], [threshold], "o", color="#B00020", markersize=7, zorder=5)
    axes.annotate("A", (a0, threshold), xytext=(-12, 4), textcoords="offset points", fontsize=11, color="#B00020")
    axes.plot([a0, a0], [0, threshold], color="#B00020", linewidth=0.8, linestyle=":")
    axes.text(a0 + 0.01, 0.06, "a0", fontsize=9, color="#B00020")
    axes.text(0.55, 0.3 * threshold, "below: cracks stop", ha="center", fontsize=8.5)
    f.label(axes, "crack depth c/d", "K_I,max/√(K_N K_T d)")
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    return sheet


def drive(critical):
    return critical["drive"] / critical["k_threshold"]


def tests(panel):
    return lambda run: f.panels((run, panel, {"title": "invented tests"}))


def reduced(run, other):
    """The tests, and the same at the load ratio of the thesis' tests."""
    sheet = f.panels((run, "mode_two", {"title": "R = -1, invented tests"}), (other, "mode_two", {"title": "R = 0.5, invented tests"}), height=3.8)
    for axes in sheet.axes:
        for line in axes.get_lines():
            if line.get_label().startswith("reduced"):
                line.set_color("#B00020")
        axes.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=2, frameon=False)
    return sheet


def levels(*all_runs):
    """How many tests are on the wrong side of the level of each measure that divides them best."""
    names = [*(words for _, words in TESTS.values()), "all together"]
    head = "".join(f"<th>{html.escape(name)}</th>" for name in ("measure", *names))
    tables = [run.rows("dividing_levels") for run in all_runs]
    body = "".join("<tr>" + f"<td>{html.escape(rows[0]['measure'])}</td>" + "".join(f"<td>{row['wrong']} of {row['tests']}</td>" for row in rows) + "</tr>"
                   for rows in zip(*tables))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody class="plain">{body}</tbody></table></div>'


def planes(*all_runs):
    """Criteria on critical planes along the surface, and against the depth that stresses are averaged over, with those of the asymptote."""
    sheet, (along, worst) = f.sheet(2, height=3.8)
    f.draw(along, all_runs[1], "planes", title=f"averaged over {DEPTHS[1]} mm", y="share of the plain limit", style="line")
    names = [row["criterion"] for row in all_runs[0].rows("critical_planes") if row["edge"] == "trailing"]
    for k, name in enumerate(names):
        rows = [next(row for row in run.rows("critical_planes") if row["criterion"] == name and row["edge"] == "trailing") for run in all_runs]
        worst.errorbar(DEPTHS, [row["share"] for row in rows], yerr=[row["error_estimate"] for row in rows], color=f.COLOURS[k], linestyle=f.DASHES[k], marker=f.plot.MARKERS[k],
                       markersize=4, capsize=3, label=name)
    run = all_runs[0]
    for k, (words, share) in enumerate((("range of the edge stress (2.5)", run["edge_stress_range"] / run["fatigue_limit"]), ("range of K_II (2.9)", run["mode_two_utilisation"]),
                                        ("K_I at a0 (2.8)", run["drive"] / run["k_threshold"]))):
        worst.axhline(share, color="#555555", linewidth=1, linestyle=f.DASHES[k + 1])
        worst.text(DEPTHS[-1], share + 0.02, words, ha="right", fontsize=7.5)
    f.label(worst, "depth of averaging, mm", "share of what is endured, worst place", "trailing edge; grey: asymptotic")
    worst.legend(fontsize=7.5, loc=(0.5, 0.62))
    along.set_ylim(-0.3, None)
    along.legend(fontsize=7.5, loc="lower center")
    return sheet


CHAPTER.sketch("2.1", "The contact and its edge", """
A pad is pressed by P, sheared by Q, and the specimen below is pulled in phase (σ). Zoomed in on the trailing edge: the pressure, the singular shear of full adhesion, and the shear
with slip over the length d.""", sketches.edge)
for number, friction in (("2.2a", 0.8), ("2.2b", 0.6)):
    figure(number, f"Equivalent stress near the edge, f = {friction}", f"fretting --friction {friction}", """
Von Mises' stress over K_N √d below the surface; t > 0 is under the pad, 0 < t < d slips.""", fields)
figure("2.3", "Equivalent stress along the surface", EDGE, """
It is nearly constant over the slip zone, so that the whole zone yields almost at once. This holds less well for small f.""", lambda run: f.panels((run, "surface", {"title": "", "rename": plain})), wrong="""
The thesis' (2.12) has 2 for √2, its (2.14) is √2 too large, and (2.17) is three times the usual invariant; the curves are of the corrected field.""", proof=FIELD)
figure("2.4", "Load at which the slip zone yields", [*(command for command, _ in TESTS.values()), NICKEL], INVENTED + """
Lower curve: the load at which some point yields, upper one: the whole slip zone, 1/f whatever ν. They differ for little friction only.""", spots)
figure("2.4 (Hertz)", "Where a Hertz contact is severest", EDGE, """
The remark before figure 2.3: with little friction the severest point lies below the surface, with more at the edge. For a Hertz contact sheared by Q it is at the surface if f is at least about 0.26
in full slip, and more in partial slip.""", lambda run: f.panels((run, "transition", {"title": ""})), rows="severest")
figure("Table 2.1", "Materials", "fretting --material Al", "The records that the program ships; the thesis' values, with their sources in its bibliography.", lambda run: materials())
for letter, (command, words) in TESTS.items():
    figure("2.5" + letter, f"Stress at the edge against life: {words}", command, INVENTED + "Range of the stress along the surface at the contact's edge. At peak load this stress is √(8 f K_N K_T); for reversed loads its range is twice that. The line is the range at the fatigue limit. Hollow: not broken.",
           tests("stress"), wrong="""
The thesis has half of this stress, √(2 f K_N K_T) = f K_N √d: at the edge σ_xx is 2 f K_N √d, and the 2 is left out. The misprint in (2.12), 2 for √2, is another fault, which would make the stress √2 too large.""",
           proof=FIELD)
figure("2.6", "Stress intensity of a crack at the edge", [EDGE, *CRITICAL], """
Largest K_I over √(K_N K_T d) of a crack of depth c, normal to the surface, for reversed loads (R = -1). The pressure closes longer cracks. Red: the intensity that a crack needs to grow, after
Kitagawa and Takahashi, σ_fl √(πc) for short ones and ΔK_th for long ones, which meet at the length a0. It is drawn for the edge with f = 0.8 and X = 0.2 whose trajectory passes through the corner A:
with a slightly smaller K_T the crack stops. (In these axes the boundary moves with the loads and the material; figure 2.7 has all of its critical cases.)""", kitagawa,
       stated=[(f"K_I,max/ΔK_th at A, f = {friction:g}", 1, 2e-6, None, lambda *all_runs, k=k: drive(all_runs[1 + k])) for k, friction in ((0, 0.8), (1, 0.3))])
figure("2.6 (R)", "Other load ratios", EDGE, """
The part of the cycle of K_I in which the crack is open, for loads that go between R times their peak and the peak. Up to R = 0.3 nothing changes, since the crack is shut at the other end anyway: the weak
dependence on R that the thesis reports. Above that, short cracks are open in a smaller part of the range.""", lambda run: f.panels((run, "trajectory_ratios", {"title": ""})))
figure("2.7", "Threshold of fretting fatigue", [EDGE, *CRITICAL], """
Above its curve a crack still grows when it has the critical length a0 = (ΔK_th/σ_fl)²/π; below it stops. One diagram for all contacts and materials.""",
       lambda run, *_: f.panels((run, "threshold", {"title": "", "only": lambda s: s != "design", "rename": plain})),
       stated=[(f"Y at X = 0.2, f = {friction:g}", value, 2e-6, None, lambda *all_runs, k=k: all_runs[1 + k]["threshold_y"])
               for k, friction, value in ((0, 0.8, 1.178838), (1, 0.3, 2.276629))], wrong="""
The thesis doesn't say which part of K_I's cycle counts. Here it is the part in which the crack is open; `--criterion range` and `half-range` are the others.""", proof="fretting --criterion range")
for number, panel, title, text in (
        ("2.8", "threshold_tests", "Tests and threshold", "Filled: broken. The criterion says that those above the curve break and those below last. "
         "Invented tests needn't obey it. Those of (a) do. Three in four of the broken tests of (b) lie below the curve, and all of (c)."),
        ("2.9", "mode_two", "Range of K_T against life", "The line is the mode II threshold, 0.8 ΔK_th in K_II = √(2π) K_T."),
        ("2.10", "energy", "Frictional energy against life", "Largest energy per area and cycle, 4√3 K_T²/E* for reversed loads, a quarter into the slip zone. No measurement of the material says how much is endured; as in the thesis the line is put where "
         "it divides broken tests from lasting ones best: fewest on its wrong side, and in the middle of the gap.")):
    wrong = {"2.9": "The thesis compares ΔK_T itself with 0.8 ΔK_th, which is 2.5 times too much: K_II has a factor √(2π).",
             "2.10": "(2.22) of the thesis has the wrong dimension and lacks E*."}.get(number, "")
    for letter, (command, words) in TESTS.items():
        if number + letter == "2.9c":
            figure("2.9c", f"{title}: {words}", [command, REDUCED], INVENTED + text + """ The tests of the thesis had R = 0.5 to 0.6 by a steady tension, at which thresholds are lower than at the -1
of Table 2.1. It draws a reduced line without saying by how much. Right: the same tests at R = 0.5, with the largest reduction that is known, to the same largest K_II in the cycle. The true line lies
between the two dashed lines.""", reduced, wrong=wrong, proof=PROOFS[number])
        else:
            against = number == "2.8" and letter != "a"  # the numbers of the real tests are in no text at hand
            figure(number + letter, f"{title}: {words}" + (" (INVENTED tests, which contradict the criterion)" if against else ""), command,
                   ("*These tests are invented and contradict the criterion: they say nothing for or against it.* " if against else "") + INVENTED + text,
                   tests(panel), wrong=wrong, proof=PROOFS.get(number, ""))
figure("2.5 (together)", "All tests in one figure each", TOGETHER, INVENTED + """
Figures 2.5 and 2.8 to 2.10 with all materials and pads in one, as the thesis has some of its own: the records have material, pad and friction of each test. There is one limit for each material, and
one threshold for each friction. The classical stress (first) scatters over materials and pads, which the diagram of 2.7 (second) brings onto one pair of axes.""",
       together)
figure("2.10 (total)", "Total frictional energy against life", [command for command, _ in TESTS.values()], INVENTED + """
The energy of the whole slip zone, (8π/3) K_T³/(f K_N E*) a cycle for reversed loads; the thesis says that it orders the tests as the largest density does.""",
       lambda *all_runs: f.panels(*((run, "energy_all", {"title": words + " (invented)"}) for run, (_, words) in zip(all_runs, TESTS.values()))))
figure("2.10 (levels)", "Which measure separates broken tests from lasting ones", [*(command for command, _ in TESTS.values()), TOGETHER], INVENTED + """
The thesis compares its measures by eye. Counted here: tests on the wrong side of the level that divides them best. Nearly any measure that grows with the load divides a single series. A measure is
tested only by all materials and pads together (last column).""", levels)
figure("2.10 (planes)", "Critical planes beside the asymptotic criteria", PLANES, """
The thesis hopes that the asymptotes serve conventional multiaxial criteria too. Here they stand beside each other for one contact: a cylinder of aluminium alloy, R = 100 mm, pressed by 400 N/mm and sheared by 50 N/mm to and fro, solved by finite
elements. Findley's criterion, that of Smith, Watson and Topper, and that of Fatemi and Socie, each on its critical plane, from the stresses of the whole steady cycle, averaged over a depth below the
surface. Each is divided by its value in a plain specimen at the fatigue limit. Stresses fall so steeply that the depth decides the verdict (right; bars show the error of the mesh). The asymptotic
measures don't need a depth: they have a length of the material, a0 = 0.09 mm here. By the range of the stress at the edge the specimen fails, by K_I the crack that starts there stops, and K_II is at
its threshold. Any other solved body: `docs/python.md`.""", planes)
figure("A", "A flat pad with round edges", "fretting --pad flat-rounded --radius 3 --flat 3 --normal-load 1000 --shear-load 20 --bulk 20 --material Ti6Al4V", """
Appendix A: pressure of a pad with a flat of half-width b and edges of radius R; the edge alone, of a flat without end (A.1); and the limit of both very close to the edge, K_N √t.""",
       lambda run: f.panels((run, "profile", {"title": "whole"}), (run, "profile", {"title": "at the edge", "limits_x": "-1,-0.94"})), wrong="""
(A.2) has a minus sign too many, and the thesis has one symbol for two constants: far from the edge p = K_P/√x, at it p = K_N √x with K_N = 3 K_P/a_r.""",
       proof="./test -R Calibration")

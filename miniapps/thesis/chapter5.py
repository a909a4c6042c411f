"""Chapter 5: a strip pressed onto a half-plane, which lifts off at its end."""

import figures as f
import sketches
from chapter import Chapter

BONDED = 'plane_receding -domain 1e4 -overhang 0.8 -bonded "0.1 0.18 0.3 0.4 0.5 0.6 0.7 0.8"'
SMALL = 'plane_receding -map-overhang "0.2 0.4 0.6 0.8 0.9 1 1.1 1.2 1.3 1.4 1.6 1.8 2 2.5 3" -map-friction "0.3 0.5 0.7 1"'
LARGE = 'plane_receding -map-overhang 4 -map-friction "0.1 0.15 0.2 0.25 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1 1.2 1.4 1.7 2"'
LOADING = "plane_receding -friction 0.7"
UNLOADING = 'plane_receding -friction 0.7 -unload "0.9 0.5 0.2 0.1" -lowest 0.03'
BLOCK = "plane_receding -obstacle th0 -overhang 2 -friction 0.7 -unload 0.5"

CHAPTER = Chapter(5, "Plane receding contact", """
A long strip of thickness t lies on a half-plane of the same material and is pressed by p on its top, except for a length n t at its
end. The end lifts off: under an infinitesimal load the contact *recedes* to a smaller one, and then stays as it is, while stresses and displacements grow
in proportion to the load. Separation lies s beyond the edge of the load, toward the strip's end; between there and e the strip slips; the rest
sticks. ξ = x - n t is counted from the edge of the load, into it.

During unloading things are less simple: slip depends on the history, and five zones appear. The loading is one
increment; the unloading is followed exactly, from one change of a node's state to the next.

The problem needs a half-plane, here one without a mesh. The thesis has a block, whose size it doesn't say; a block of the size that it may have had (20 t long, 200 t deep, 80 t beyond the strip's
end) carries a remote tension, which changes e to first order: `./run plane_receding -domain-study` shows that. Units: t = p0 = E' = 1.
""")
figure = CHAPTER.figure
WRONG = """The thesis' border of stick is that of its finite block, whose remote tension shifts e by a fifth. (The references of e are of a block 10⁴ t deep, and e still changes
with the depth: blocks of 10⁵ and 10⁶ t give the values of the half-plane.)"""


def small(run):
    sheet, (axes,) = f.sheet(1, height=4.2)
    for k, friction in enumerate((0.3, 0.5, 0.7, 1.0)):
        n = run.column("map", "overhang", friction=friction)
        style = {"color": f.COLOURS[k], "linestyle": f.DASHES[k]}
        f.curves(axes, {f"f = {friction:g}": (n, run.column("map", "separation", friction=friction))}, **style)
        f.curves(axes, {None: (n, run.column("map", "stick_slip", friction=friction))}, "overhang n", "s/t (above), e/t (below)", **style)
    f.thesis(axes, [(1.6, 1.1), (1.6, -0.7), (1.2, 0.9), (1.2, -1.45)])
    axes.set_xlim(0, 3)
    return sheet


def large(run):
    sheet, (axes,) = f.sheet(1, height=3.8)
    at = run.column("map", "friction")
    f.curves(axes, {"separation s": (at, run.column("map", "separation")), "border of stick e": (at, run.column("map", "stick_slip"))},
             "friction coefficient f", "s/t, e/t")
    f.thesis(axes, list(zip([0.7, 0.7], f.marks(run, "s/t, n = 4, f = 0.7", "e/t, n = 4, f = 0.7"))))
    return sheet


def slip_of_point(k):
    """Slip of one point during loading and unloading."""
    def drawn(run):
        sheet, (axes,) = f.sheet(1, height=2.9)
        row = run.rows("slip_histories")[k]
        axes.plot(row["level"][:2], row["slip"][:2], color=f.COLOURS[1], linewidth=1.6, linestyle=f.DASHES[1], label="loading")
        axes.plot(row["level"][1:], row["slip"][1:], color=f.COLOURS[0], linewidth=1.6, label="unloading")
        f.label(axes, "p/p0", "v E'/(p0 t)")
        return sheet
    return drawn


CHAPTER.sketch("5.1a", "The strip and its loads", """
The lower body is a half-plane; the strip continues to the right until its length has no influence (100 t).""", sketches.strip)
figure("5.1b", "The mesh", "plane_receding --check", "The finite elements of the strip, finest where contact ends. The half-plane has none.",
       lambda run: f.panels((run, "mesh", {"title": ""})))
figure("5.2", "Traction ratio of the bonded strip", [BONDED, 'plane_receding -obstacle th0 -bonded "1.5 2"'], """
Strip and half-plane bonded together: the ratio of shear to pressure that friction would have to provide. All curves begin at the corner with Williams' 0.5431.
For small n this is the largest value. Then a maximum appears inside, and rises so quickly that full adhesion requires an unusual friction from n = 0.7 on.""",
       lambda run, _: f.panels((run, "bonded", {"limits_x": "0,2", "limits_y": "0,1.4", "title": ""})),
       rows="adhesion|rises|pulls|corner ratio", wrong="""
On a half-plane the bonded strip has no tension for any n. On a finite block there is tension from a value of n on that depends on the block: with the block of the second command from the n in the
table on, with the block of the thesis, which it doesn't describe, from 1.89. The largest ratio leaves the corner already at n = 0.12 (at 0.18 it is 0.59, 0.17 t away), so that f = 0.543 is not enough
from there on.""", proof='plane_receding -overhang 4 -bonded "2 3 4"')
figure("5.3a", "Separation and stick against the overhang", SMALL, """
s and e for four friction coefficients. Below a certain n nothing separates (no curve). Beyond n = 2 the strip's end no
longer matters.""", small, rows="n = 1.6|n = 1.2|n = 4, f = 0.7", wrong=WRONG, proof="plane_receding -obstacle th0 -friction 0.7")
figure("5.3b", "Separation and stick against friction", LARGE, """
The same for a long end (n = 4). With little friction slip reaches far under the load; with much friction the border of stick reaches the edge of the load and goes beyond.""", large, rows="n = 4", wrong="""
The thesis says that with little friction the strip separates about under the edge of the load, s → 0. It doesn't: a layer that is pressed onto a half-plane without friction separates 0.60 t from
there (its other limit is correct: with much friction the slip zone is about 2 t long).""" + WRONG, proof="plane_receding -obstacle th0 -friction 0.7",
       stated=[("s/t, n = 4, f = 0.1", None, None, 0, lambda run: run.rows("map", friction=0.1)[0]["separation"]),
               ("length of the slip zone s - e over t, n = 4, f = 2", None, None, 2, lambda run: (lambda row: row["separation"] - row["stick_slip"])(run.rows("map", friction=2)[0]))])
figure("5.4", "Tractions during loading", LOADING, """
Pressure, and shear over f (dashed), for f = 0.7; they grow in proportion to p. Where the curves meet, the strip slips.""",
       lambda run: f.panels((run, "tractions", {"title": ""})), rows="n = 4, f = 0.7", wrong=WRONG, proof=LOADING + " -domain-study")
figure("5.5", "Tractions during unloading", UNLOADING, """
Pressure and shear over f when the load falls to 0.9, 0.5, 0.2 and 0.1 of its maximum. The shear that slip left behind vanishes last.""",
       lambda run: f.panels((run, "tractions", {"title": ""})), rows="separation, unloaded", wrong=WRONG, proof=UNLOADING + " -domain 1e4")
figure("5.6", "Zones during unloading", [UNLOADING, BLOCK], """
Read from left to right: at p = p0 there are separation, slip and stick from loading. As p falls, the contact recedes further, with reverse slip behind it; most of the
slip zone sticks at once, and a second slip zone, in the sense of loading, grows inward. Diamonds: borders of the thesis.""",
       lambda run, _: f.panels((run, "zones", {"title": ""})), rows="border|separation, unloaded", wrong="""
The thesis' borders are those of a block (the second group of rows, n = 2, is of one); and not all of the slip zone sticks at the first instant: -0.17 < ξ/t < 0.44 continues to slip.""", proof=BLOCK)
figure("5.7a", "Slip of a point at ξ = -t/2", UNLOADING, """
It slips while the load grows, sticks at first on unloading, slips back, and separates.""", slip_of_point(0), rows="ξ/t = -0.5", wrong="""
The slip at full load is that of a half-plane. The reference is for a block 10⁴ t deep, and a run with such a block agrees with it.""", proof=UNLOADING + " -domain 1e4")
figure("5.7b", "Slip of a point at ξ = 0", UNLOADING, """
Under the edge of the load: it continues to slip, then sticks, and slips back when the load is small.""", slip_of_point(1))
figure("5.7c", "Slip of a point at ξ = t/2", UNLOADING, """
It sticks as long as the load grows, and slips in the sense of loading only when the load falls.""", slip_of_point(2))

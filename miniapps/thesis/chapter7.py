"""Chapter 7: a disc on a half-space, pressed and twisted."""

import math

import figures as f
import sketches
from chapter import Chapter

BONDED = 'axisymmetric_receding -bonded "0.5 1.5 2.1 3"'
ADHESION = 'axisymmetric_receding -bonded "3.75 4.25 4.7"'
SMALL = "axisymmetric_receding -load-radius 0.5 -friction 0.9"
CRITICAL = 'axisymmetric_receding -critical "2 3 4 5 6 8" -critical-friction "0 0.5 0.8" -critical-bonded'
LOADING = 'axisymmetric_receding -load-levels "0.25 0.5 0.75 1"'
MAP = 'axisymmetric_receding -map-load-radius "0.25 0.5 1 1.5 2 2.5 3 3.4 3.6 3.8 4 4.2 4.4 4.6 4.8 5"'
UNLOADING = 'axisymmetric_receding -unload "0.9 0.5 0.3 0.1"'
CYCLES = 'axisymmetric_receding -cycle-to "0.1 0.5 0.8 0.95" -cycles 40 -increments 40'
TORSION = 'axisymmetric_receding -torque "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9"'

CHAPTER = Chapter(7, "Axisymmetric receding contact", """
A disc of thickness t and radius b lies on a half-space of the same material. A pressure p0 on r < a presses it. Beyond r = d it lifts off, and between c and d it slips outward. As in chapter 5 the
zones appear at once and do not change while the load grows. Then the disc's top is turned about its axis while the pressure is held: slip gets a second component, and shear a direction. The contact
spins when the torque reaches T_s.

The limit of steady spinning follows from the pressure *without* friction, because there is then no shear in the radial direction:
T_s = 2πf ∫ p r² dr. Turning changes the direction of friction from radial to circumferential, so that the disc lifts off further.

The thesis doesn't say its Poisson's ratio; here it is 0.3, and the half-space has no mesh. Units: t = p0 = E = 1; b = 5 t unless said.
""")
figure = CHAPTER.figure
DOMAIN = " The references are of a cylinder of radius 100 t in place of the half-space, which changes the fourth digit; the thesis' radius is read off its figure."


def critical(run, frictions):
    sheet, (axes,) = f.sheet(1, height=3.9)
    f.curves(axes, {"loaded all over, a = b": ([2, 8], [2, 8])}, color="black")
    for friction in [*frictions, None]:
        rows = run.rows("bonded_critical") if friction is None else run.rows("critical_load_radius", friction=friction)
        f.curves(axes, {"bonded" if friction is None else f"f = {friction:g}": ([f.nan(row["load_radius"]) for row in rows], [row["disc_radius"] for row in rows])}, "radius of the load a/t",
                 "radius of the disc b/t", marker="o", markersize=4)
    axes.text(6.4, 4.2, "no separation\nto the right of a line", ha="center", fontsize=8.5)
    if not frictions:
        f.thesis(axes, [(2.1, 5)])
    return sheet


def regions(run, _):
    """The map with its regions: what contact never separates, and where that depends on friction."""
    sheet = critical(run, [0, 0.5, 0.8])
    (axes,) = sheet.axes
    frictionless, bonded = run.rows("critical_load_radius", friction=0), run.rows("bonded_critical")

    def line(rows):
        return zip(*((row["load_radius"], row["disc_radius"]) for row in rows if row["load_radius"] is not None))

    (c, at), (e, below) = line(frictionless), line(bonded)
    axes.fill_betweenx(at, c, at, color="#DDEBF5", zorder=0, label="never separates (ABCD)")
    between = [b for b in at if below[0] <= b <= below[-1]]
    edge = [e[below.index(b)] for b in between if b in below]
    axes.fill_betweenx([b for b in between if b in below], edge, [c[at.index(b)] for b in between if b in below], color="#FBE9DC", zorder=0,
                       label="depends on friction (CDEF)")
    for name, (x, y) in zip("ABCDEF", ((2, 2), (8, 8), (c[0], at[0]), (c[-1], at[-1]), (e[0], below[0]), (e[-1], below[-1]))):
        axes.annotate(name, (x, y), xytext=(-11, 3), textcoords="offset points", fontsize=11, fontweight="bold")
    for text in list(axes.texts):
        if "no separation" in text.get_text():
            text.remove()
    f.label(axes, legend=False)
    axes.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncol=3, frameon=False)
    return sheet


def rim(run):
    """Pressures, and in an inset those near the rim, which decide about separation."""
    only = lambda s: not s.startswith("q") and "0.5" not in s  # noqa: E731
    sheet = f.panels((run, "bonded_pressure", {"title": "", "only": only, "limits_y": "-0.02,1.2", "y": "p/p0"}), height=4)
    (axes,) = sheet.axes
    inset = axes.inset_axes((0.68, 0.5, 0.3, 0.38))
    for line in axes.get_lines():
        inset.plot(line.get_xdata(), line.get_ydata(), color=line.get_color(), linestyle=line.get_linestyle(), linewidth=1.2)
    inset.axhline(0, color="black", linewidth=0.6)
    inset.set_xlim(3.5, 5)
    inset.set_ylim(-0.004, 0.012)
    inset.tick_params(labelsize=7)
    inset.set_title("near the rim", fontsize=8)
    return sheet


def slips(run):
    """Slip where there is contact: each torque has a shade of its own."""
    sheet, (axes,) = f.sheet(1, height=3.9)
    ends = {0: run["separation"], **{row["wanted"]: row["separation"] for row in run.rows("torsion")}}
    series = run.series("slip")
    for k, (name, (radii, values)) in enumerate(series.items()):
        end = ends[float(name.rpartition("=")[2])]
        kept = [(r, v) for r, v in zip(radii, values) if end is None or r <= end]
        f.curves(axes, {name: zip(*kept)}, "r/t", "slip E/(p0 t)", color=f.plt.cm.viridis(0.9 * k / (len(series) - 1)), linestyle="-")
    axes.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncol=4, frameon=False)
    return sheet


def extents(run):
    sheet, (axes,) = f.sheet(1, height=3.9)
    for k, friction in enumerate((0.5, 0.8)):
        rows = run.rows("map", friction=friction)
        a, b = [row["load_radius"] for row in rows], 5
        d = [b if row["separation"] is None else row["separation"] for row in rows]
        c = [last if row["stick"] is None else row["stick"] for row, last in zip(rows, d)]
        style = {"color": f.COLOURS[k], "linestyle": f.DASHES[k]}
        f.curves(axes, {f"f = {friction:g}": (a, d)}, **style)
        f.curves(axes, {None: (a, c)}, "radius of the load a/t", "separation d/t (upper), stick c/t (lower)", **style)
    f.thesis(axes, [(2.5, 3.75)])
    return sheet


def first_tension(run):
    """Radius over that of the disc at which the pressure under a = 0.5 first changes its sign."""
    radii, pressures = run.series("bonded_pressure")["a = 0.5"]
    k = next(k for k, p in enumerate(pressures) if p < 0)
    return (radii[k - 1] + (radii[k] - radii[k - 1]) * pressures[k - 1] / (pressures[k - 1] - pressures[k])) / 5


def arrows(run):
    """Directions of slip over radius and torque, radial to the right and round upward."""
    sheet, (axes,) = f.sheet(1, height=4.4)
    series = run.series("slip_angles")
    rows = [{"torque": 0, **{key: run[key] for key in ("stick", "separation")}}, *run.rows("torsion")]
    f.curves(axes, {"separation d": ([r["separation"] for r in rows], [r["torque"] for r in rows]),
                    "border of stick c": ([r["stick"] for r in rows], [r["torque"] for r in rows])}, "r/t", "T/T_s")
    for prefix, colour, name in (("", "black", "rate of slip, which friction opposes"), ("total: ", f.COLOURS[2], "total slip, as in the thesis")):
        for row in rows:
            radii, angles = series[f"{prefix}T/T_s = {row.get('wanted') or 0:g}"]
            if not radii:
                continue
            chosen = [round((len(radii) - 1) * k / 7) for k in range(8)]
            axes.quiver([radii[k] for k in chosen], [row["torque"]] * 8, [math.cos(math.radians(angles[k])) for k in chosen],
                        [math.sin(math.radians(angles[k])) for k in chosen], color=colour, angles="uv", scale=26, width=0.003, pivot="tail")
        axes.plot([], [], color=colour, marker=r"$\rightarrow$", linestyle="", markersize=10, label=name)
    f.label(axes, legend=False)
    axes.legend(fontsize=7.5, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2, frameon=False)
    axes.set_ylim(-0.05, 1.05)
    normal = math.pi * 2.5**2 * 5  # P0 b of a = 2.5, b = 5
    share = run["torque_limit"] / normal
    axes.secondary_yaxis("right", functions=(lambda y: y * share, lambda y: y / share)).set_ylabel("T/(P0 b)")
    return sheet


def kinds(run, name, drop, y, **limits):
    """Two panels: the plain curves of one, and their dashed companions."""
    sheet, both = f.sheet(2)
    for axes, only, label in zip(both, (lambda s: not s.startswith(drop), lambda s: s.startswith(drop)), y):
        f.draw(axes, run, name, only=only, rename=lambda s: s.removeprefix(drop), title="", y=label, style="line", **limits)
        # Loads follow each other, and so do the colours: there are more loads than dashes.
        lines = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
        for k, line in enumerate(lines):
            line.set(color=f.plt.cm.viridis(0.92 * k / max(1, len(lines) - 1)), linestyle="-")
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncol=4, frameon=False)
    return sheet


CHAPTER.sketch("7.1", "Disc and half-space", "The disc may be wide or narrow; the load acts on its middle.", sketches.disc)
figure("7.2", "Disc, load and supports", "axisymmetric_receding --check", """
The disc in a plane through its axis, with its loads and supports, as the program gets it. Arrows are nodal forces: they grow with the radius, as does the ring that belongs to a node, although the
pressure is uniform. The half-space below needs no mesh.""",
       lambda run: f.panels((run, "scene", {"title": "bodies, loads, supports"}), (run, "mesh", {"title": "finite elements"}), columns=1, height=4.2))
figure("7.3", "Pressure under a bonded disc", BONDED, """
Disc and half-space bonded together: a load on r < a leaves hardly any pressure beyond about a + t.""",
       rim, rows="bonded", wrong="""
The thesis finds a = 2.1 t to be the least radius of load without tension. The pressure near the rim is then a thousandth of p0 and its sign depends on details of the mesh. The number is
ill-conditioned, so the profile is compared instead. (The radius at which tension vanishes, by our mesh and by the reference, is in the table of figure 7.4.)""", proof='axisymmetric_receding -bonded "0.8 2.1"')
figure("7.4", "Where a bonded disc separates", CRITICAL, """
Radius of the load below which the bonded disc has tension somewhere, against the radius of the disc: the line EF of figure 7.8. As said with figure 7.3 it is ill-conditioned: a thousandth of the
pressure moves it by more than t. Bonded discs of less than about 4.9 t have no tension at all.""", lambda run: critical(run, []),
       stated=[("bonded critical a/t, b = 5", 0.80, 0.05, 2.1, lambda run: run.rows("bonded_critical", disc_radius=5)[0]["load_radius"])], wrong="""
The thesis says that this line is straight. Our line bends, and begins at the smallest disc with tension. But the number is ill-conditioned, so neither place nor shape of the line is reliable.""", proof=CRITICAL)
CHAPTER.sketch("7.5", "Names", "d: radius of separation; c: border of stick.", lambda: sketches.disc(radii=True))
figure("7.6", "Tractions under a bonded disc, a = 0.5", BONDED, """
Pressure and shear of the monolith under a small load.""",
       lambda run: f.panels((run, "bonded_pressure", {"title": "", "only": lambda s: s.endswith("a = 0.5"), "limits_x": "0,5", "limits_y": "-0.12,0.32",
                                                      "rename": lambda s: s.replace("q: a = 0.5", "shear q").replace("a = 0.5", "pressure p")})), wrong="""
The tension of the monolith from 0.65 b on can't be confirmed: its pressure there is ten thousandths of p0. Here tension begins at 0.97 b.""", proof=BONDED,
       stated=[("first tension of the bonded disc at r/b, a = 0.5", 0.971, 0.005, 0.65, first_tension)])
figure("7.7", "Tractions with contact, a = 0.5", SMALL, "The same with contact and f = 0.9: the pressure ends at d, and slip begins at c." + DOMAIN,
       lambda run: f.panels((run, "tractions", {"title": "", "limits_x": "0,5"})), rows="a = 0.5")
figure("7.8", "When nothing separates", [CRITICAL, ADHESION], """
Discs and loads for which nothing lifts off, without friction (CD), with f = 0.5 and 0.8, and bonded (EF). To the right of CD, up to the disc that is loaded all over (AB), that holds for every friction; between CD and EF it
depends on friction.""",
       regions, rows="critical|full adhesion", wrong="""
The thesis adds that a friction above 0.543 keeps the rim from slipping then. It keeps the corner itself from slipping, but close to the corner the ratio of tractions is higher: full adhesion requires
the values in the table.""", proof=ADHESION)
figure("7.9", "Pressure during loading", LOADING, "a = 2.5 t, f = 0.5: pressures at four loads are proportional, and the disc separates at the same radius." + DOMAIN,
       lambda run: kinds(run, "loading_tractions", "q/f: ", ("p/p0", "q/(f p0)")), rows="loaded, a = 2.5, f = 0.5")
figure("7.10", "Separation and stick against the load's radius", MAP, """
Radii of separation and of stick for f = 0.5 and 0.8. When nothing separates any more (d = b), slip remains at the rim.""", extents, rows="loaded, a = 2.5", wrong="""
The thesis says that with f = 0.8 the disc adheres all over as soon as nothing separates. The rim's own ratio of tractions is below 0.8 then, but close to it the ratio is higher: here
slip remains from a = 3.6 to 4.4 t, and full adhesion begins between 4.4 and 4.6 t.""", proof=ADHESION)
figure("7.11", "Tractions during unloading", UNLOADING, "a = 2.5 t, f = 0.5: pressure and shear over f at 1, 0.9, 0.5, 0.3 and 0.1 of the load.",
       lambda run: kinds(run, "unloading_tractions", "q/f: ", ("p/p0", "q/(f p0)")), rows="^d/t at")
figure("7.12", "Zones during unloading", UNLOADING, """
As with the strip (figure 5.6), the contact recedes, reverse slip follows from the edge, and forward slip grows inward. Diamonds: the thesis at half of the load.""",
       lambda run: f.panels((run, "zones", {"title": ""})), rows="border", wrong="""
The thesis reads its borders off a figure, without saying ν or the extent of its half-space.""")
figure("7.12 (cycles)", "Unloading and reloading in cycles", CYCLES, """
The load falls and rises again, a = 2.5 t, f = 0.5. First: zones in the first two cycles between P0 (even steps) and 0.1 P0 (odd ones). Reloading sticks at once wherever unloading slipped, but not for
long: the contact closes again from inside, slipping outward as it did at first, and at P0 the separation is where it was, while the border of stick stays further out, because the residual shear of
unloading is still there. Third: pressure returns to its first values, but shear not quite. Second: the loss in each cycle of the load, down to 0.1, 0.5, 0.8 and 0.95 of it. It settles after some
cycles. Its final value grows with the third power of the range of the load for small ranges, and with the fifth for large ones, like that of the strip (8.2 (5)). None shakes down: the edge recedes
with every cycle and slips. That is observed, from this start, and not proven.""",
       lambda run: f.panels((run, "load_cycle_zones", {"title": ""}), (run, "load_losses", {"title": ""}), (run, "load_cycle_tractions", {"title": "", "limits_x": "0,4"}), columns=2),
       rows="loaded, a = 2.5, f = 0.5")
CHAPTER.sketch("7.13", "The torque", "P is held while the top of the disc is turned.", lambda: sketches.disc(torque=True))
figure("7.14", "Tractions under torsion", TORSION, "Pressure, and resultant shear over f, for growing torque. Slip spreads inward, and separation moves inward with it.",
       lambda run: kinds(run, "torsion_tractions", "|q|/f: ", ("p/p0", "|q|/(f p0)")), rows="T_s|without friction|T/T_s|T_max")
figure("7.15", "Slip under torsion", TORSION, "Resultant slip. It grows from the border of stick to that of separation, and everywhere with the torque.",
       slips)
figure("7.16", "Zones and directions of slip under torsion", TORSION, """
To the right radius, upward torque; arrows have the direction of slip: radial to the right, around the axis upward. At T = 0 slip is radial, at the spinning limit it is circumferential.""",
       arrows, rows="slip angle|T/T_s", wrong="""
The thesis draws the direction of the total slip (7.4). Friction is opposed to the *rate* of slip, which turns much sooner: in the middle of the annulus at half the torque by
49°, not 13°.""", proof=TORSION)
figure("7.17", "The contact from above", TORSION, "Zones and directions of slip before the disc is turned, and under half of the torque.",
       lambda run: f.panels((run, "plan_before"), (run, "plan_twisted"), height=4.6))

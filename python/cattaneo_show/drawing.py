"""Draws the panels of a run with matplotlib.

A panel has words and rows (panels.py). Kinds: lines (series, style, x, y; style: line, marked, dashed, points, hollow,
cross, star, band or thesis), zones (time, state, from, to; one row per zone, times in order), plan (a body of revolution:
rings with their state and radii, and arrows: rate or total, radius, angle from the radial direction), field (series, x,
y, value; one picture per series), scene (edges of bodies, contact nodes, normals, gaps, supports, loads), map (corners
of triangles of a surface with a value, and whether they are in contact and stick, and arrows), and table.

Words: title; x and y, the labels; limits x and limits y ("lo,hi", an empty side is left to the data); inside (limits of y by the
data inside, without that share at either end); reversed (x); scale (loglog, semilogx or semilogy); shade and shade y
("lo,hi,word"). A table is drawn as it says: over (a column), curve ("column=word"), by ("column=word": one curve for each of its
values), mark ("x,y": values of the thesis).

Colours are Okabe and Ito's, which the colour-blind can tell apart; lines differ in dashes and zones
in hatching as well, so that a black-and-white print can be read.
"""

import math
import re
from collections import OrderedDict, defaultdict

import matplotlib
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Annulus, Patch, Polygon
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.tri import Triangulation

from .panels import Refused, panel, panel_names, series_of, value

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]
DASHED = (0, (5, 2))  # of companions
DASHES = ["-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)), (0, (1, 1)), (0, (9, 3)), "-"]
MARKERS = ["o", "s", "D", "v", "P", "X"]
STATES = OrderedDict([
    ("stick", ("#BDBDBD", "")),
    ("forward slip", ("#E69F00", "////")),
    ("backward slip", ("#56B4E9", "\\\\\\\\")),
    ("slip", ("#E69F00", "////")),
    ("separation", ("#FFFFFF", "....")),
])
# In grey the two kinds of slip differ only by their hatching, dark and white.
HATCH = {"backward slip": "#FFFFFFDD"}


def hatch_of(state):
    return HATCH.get(state, "#00000066")


def state_patch(state):
    """The patch of a state in a legend."""
    colour, hatch = STATES[state]
    return Patch(facecolor=colour, edgecolor=hatch_of(state), hatch=hatch, label=state)


def dashes(k):
    """The dashes of curve k, which change when a colour is used again."""
    return DASHES[(k + k // len(COLOURS)) % len(DASHES)]


def draw_lines(axes, comments, rows):
    series = series_of(comments, rows)
    along, comments["x"] = along_line(comments, comments["x"], [name for name, _ in series])
    if along:
        series = OrderedDict((key, [(along(key[0], s), y) for s, y in points]) for key, points in series.items())
    # Curves with companions are told apart by colour, and the companions are the dashed ones.
    plain = any(style == "dashed" and ": " in name for name, style in series)
    curves = ("line", "marked", "points", "hollow", "band")
    names = list(OrderedDict.fromkeys(name for name, style in series if style in curves))
    labelled, bands, companions, first = set(), {}, {}, int((comments["colour"] or ["0"])[0])
    for (name, style), points in series.items():
        x, y = zip(*points)
        # A comparison has the colour of the curve to which it belongs ("closed form: q" goes with "q").
        owner = next((k for k, other in enumerate(names) if name == other or name.endswith(": " + other)), None)
        colour = COLOURS[(first + owner) % len(COLOURS)] if owner is not None else "#555555"
        label = name if name not in labelled else None
        labelled.add(name)
        if name.endswith("(design)"):
            axes.plot(x, y, color="black", linewidth=2.4, label=label)
        elif style in ("line", "marked"):
            axes.plot(x, y, color=colour, linestyle="-" if plain else dashes(owner), linewidth=1.6,
                      marker=MARKERS[owner % 6] if style == "marked" else None, markersize=4, label=label)
        elif style in ("points", "hollow"):
            full = style == "points"
            axes.plot(x, y, MARKERS[owner % 6], color=colour, markersize=3.5 if len(x) > 20 else 7,
                      markerfacecolor=colour if full else "none", label=label)
        elif style == "dashed":
            if owner is not None and name != names[owner]:  # one word for all of its kind
                companions[name[: -len(": " + names[owner])]] = True
                label = None
            axes.plot(x, y, color=colour, linestyle=DASHED, linewidth=1.2, label=label)
        elif style == "band":
            half = len(x) // 2  # below, then above
            axes.fill_between(x[:half], y[:half], y[half:], color=colour, alpha=0.3, label=label)
            bands[name] = True
        else:
            mark, size = {"star": ("*", 13), "cross": ("x", 5)}.get(style, ("D", 6))
            axes.plot(x, y, mark, color="black", markerfacecolor="black" if style == "star" else "none",
                      markersize=size, label=label, zorder=5)
    for kind in companions:
        axes.plot([], [], color="black", linestyle=DASHED, linewidth=1.2, label=kind)
    if any(style == "hollow" for name, style in series):
        axes.plot([], [], "o", color="black", markerfacecolor="none", label="run-out (hollow)")
    if comments["inside"]:
        share, inner = float(comments["inside"][0]), []
        for points in series.values():
            lo, hi = min(x for x, _ in points), max(x for x, _ in points)
            inner += [y for x, y in points if lo + share * (hi - lo) < x < hi - share * (hi - lo)]
        gap = 0.2 * (max(inner) - min(inner))
        axes.set_ylim(min(inner) - gap, max(inner) + gap)
    axes.grid(True, color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)
    for line in axes.get_lines():
        shown = [y for y in line.get_ydata() if math.isfinite(y)]
        if len(shown) == 1 and line.get_marker() in ("", "None", None):  # a line through one point is not visible
            line.set_marker("o")
            line.set_markersize(4)
        # Nor are values on a logarithmic axis that are not positive.
        if comments["scale"] and comments["scale"][0] != "semilogx" and len(line.get_ydata()) and not any(y > 0 for y in shown):
            line.set_label(f"{line.get_label()} (no loss, not on this axis)" if "loss" in "".join(comments["title"]).lower() else f"{line.get_label()} (0, not on this axis)")
    said = labelled - {""}
    if len(labelled) > 1 or said and not said & set(comments["y"][0].split()):  # the axis names a single curve
        legend_below(axes, -0.24 if comments["scale"] else -0.2)


def along_line(said, label, names=()):
    """If all contact lines are straight along one axis, as a panel says ("straight": NAME=x,way,start): a function from an arc
    length of a curve to its place in x or y, and the label of the axis. With several interfaces the names are those of the curves."""
    lines = {}
    for text in said["straight"]:
        name, _, place = text.rpartition("=")
        axis, way, start = place.split(",")
        lines[name] = (axis, float(way), float(start))
    axes, curves = {axis for axis, _, _ in lines.values()}, {interface_of(name) for name in names}
    known = len(lines) == 1 and len(curves) < 2 and not said["apart"] or curves <= set(lines)
    if len(axes) != 1 or not known or not label or not label[0].startswith("arc length"):
        return None, label

    def place(name, s):
        _, way, start = lines.get(interface_of(name), next(iter(lines.values())))
        return start + way * s

    return place, [axes.pop() + label[0].removeprefix("arc length")]


def interface_of(curve):
    """The interface in the name of a curve of tractions."""
    return curve.removeprefix("q/f: ")


def draw_zones(axes, comments, rows):
    along, comments["y"] = along_line(comments, comments["y"])
    if along:
        for row in rows:
            ends = sorted(along("", value(row[key])) for key in ("from", "to"))
            row.update(zip(("from", "to"), ends))
        rows = sorted(rows, key=lambda row: (value(row["time"]), row["from"]))
        way = float(comments["straight"][0].rpartition("=")[2].split(",")[1])
        if comments["title"] and any(row["state"].startswith(("forward", "backward")) for row in rows):
            comments["title"] = [f"{comments['title'][0]} (forward: to {'larger' if way > 0 else 'smaller'} {comments['y'][0][:1]})"]
    marks = [row for row in rows if row["state"] == "thesis"]
    steps = OrderedDict()
    for row in rows:
        if row["state"] != "thesis":
            steps.setdefault(value(row["time"]), []).append((row["state"], value(row["from"]), value(row["to"])))
    times = list(steps)
    runs = []  # stretches of time with the same zones: their states, and bounds at each time
    for k, time in enumerate(times):
        # The states at the end of an increment hold during it; edges move linearly where the same
        # zones were there before, and jump where they were not.
        states, bounds = [z[0] for z in steps[time]], [z[1:] for z in steps[time]]
        if not k or states != runs[-1][0]:
            start = times[k - 1] if k else (time if len(times) > 1 else 0)
            runs.append((states, [(start, bounds)]))
        runs[-1][1].append((time, bounds))
    seen = set()
    for states, points in runs:
        for j, state in enumerate(states):
            below, above = ([(time, bounds[j][side]) for time, bounds in points] for side in (0, 1))
            colour, hatch = STATES[state]
            axes.add_patch(Polygon(below + above[::-1], closed=True, facecolor=colour, edgecolor=colour, linewidth=0.4))
            if hatch:
                axes.add_patch(Polygon(below + above[::-1], closed=True, facecolor="none", edgecolor=hatch_of(state),
                                       hatch=hatch, linewidth=0))
            if j:
                axes.plot(*zip(*below), color="black", linewidth=0.7)
            seen.add(state)
    axes.set_xlim(min(times) if len(times) > 1 else 0, max(times))
    axes.set_ylim(min(z[1] for s in steps.values() for z in s), max(z[2] for s in steps.values() for z in s))
    handles = [state_patch(s)
               for s in STATES if s in seen]
    if marks:
        axes.plot([value(r["time"]) for r in marks], [value(r["from"]) for r in marks], "D", color="black",
                  markerfacecolor="white", markersize=5, label="thesis", zorder=5)
        handles.append(Line2D([], [], marker="D", color="black", markerfacecolor="white", linestyle="",
                                  markersize=5, label="thesis"))
    legend_above(axes, handles)


def legend_below(axes, under=-0.2):
    """Places the legend where it covers no curve, in as many columns as fit."""
    handles, labels = axes.get_legend_handles_labels()
    labels = [symbols(label) for label in labels]
    columns = max(1, min(len(labels), 62 // (max(map(len, labels)) + 7)))
    axes.legend(handles, labels, fontsize=8, ncol=columns, loc="upper center", bbox_to_anchor=(0.5, under), frameon=False,
                handlelength=2.6, columnspacing=1.4)


SYMBOL = re.compile(r"(?<!\w)(Δ?)([A-Za-zσξτ])_([A-Za-z0-9]+(?:,max|,min)?)")


def symbols(text):
    """Sets K_N as in a paper. Names of more letters, such as those of parts, are left as they are."""
    return SYMBOL.sub(lambda m: f"{m[1]}${m[2]}_{{\\mathrm{{{m[3]}}}}}$", text)


def legend_above(axes, handles):
    axes.legend(handles=handles, fontsize=8 if len(handles) < 4 else 7, ncol=len(handles), loc="lower center",
                bbox_to_anchor=(0.5, 1.0), frameon=False, handlelength=1.6, columnspacing=1.2)


def draw_plan(axes, comments, rows):
    rings = [row for row in rows if row["item"] in STATES]
    outer = max(value(row["to"]) for row in rings)
    for row in rings:
        lo, hi = value(row["from"]), value(row["to"])
        colour, hatch = STATES[row["item"]]
        for face, edge, pattern in ((colour, "black", None), ("none", hatch_of(row["item"]), hatch)):
            axes.add_patch(Annulus((0, 0), hi, (hi - lo) * 0.9999, facecolor=face, edgecolor=edge, hatch=pattern,
                                   linewidth=0.7))
    handles = [state_patch(s)
               for s in STATES if any(row["item"] == s for row in rings)]
    for kind, colour in (("rate", "black"), ("total", "#0072B2")):
        arrows = [(value(row["from"]), value(row["to"])) for row in rows if row["item"] == kind]
        if not arrows:
            continue
        # Four radii of the annulus, on twelve spokes; the two kinds on spokes of their own.
        chosen = [arrows[round((len(arrows) - 1) * share)] for share in (0.1, 0.37, 0.63, 0.9)]
        for spoke in range(12):
            turn = (spoke + (0.5 if kind == "total" else 0)) * math.pi / 6
            for radius, angle in chosen:
                axes.annotate("", xytext=(radius * math.cos(turn), radius * math.sin(turn)),
                              xy=(radius * math.cos(turn) + 0.09 * outer * math.cos(turn + angle),
                                  radius * math.sin(turn) + 0.09 * outer * math.sin(turn + angle)),
                              arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 1.0, "shrinkA": 0,
                                          "shrinkB": 0})
        handles.append(Line2D([], [], color=colour, marker=">", markersize=4,
                                  label="rate of slip" if kind == "rate" else "total slip"))
    axes.set_xlim(-1.05 * outer, 1.05 * outer)
    axes.set_ylim(-1.05 * outer, 1.05 * outer)
    axes.set_aspect("equal")
    legend_above(axes, handles)


def draw_field(axes, comments, rows):
    x, y = (sorted({value(row[key]) for row in rows}) for key in ("x", "y"))
    grid = [[float("nan")] * len(x) for _ in y]
    for row in rows:
        grid[y.index(value(row["y"]))][x.index(value(row["x"]))] = value(row["value"])
    # Levels are round numbers up to the largest value, because readers look for that value.
    values = [value(row["value"]) for row in rows]
    least, most = map(float, comments["range"][0].split(",")) if comments["range"] else (min(values), max(values))
    levels = [float(f"{level:.10g}") for level in MaxNLocator(14).tick_values(least, most)]
    shades = axes.contourf(x, y, grid, levels, cmap="viridis")
    labelled = axes.contour(x, y, grid, levels[2:-1:3], colors="white", linewidths=0.7)
    axes.clabel(labelled, fmt="%g", fontsize=8)
    axes.figure.colorbar(shades, ax=axes, ticks=levels[::2])
    axes.invert_yaxis()


def draw_scene(axes, comments, rows):
    items, arrows = OrderedDict(), 0
    for row in rows:
        items.setdefault(row["item"], []).append([value(row[key]) for key in ("x", "y", "dx", "dy")])
    bodies = [item for item in items if item.split()[0] == "body"]
    of_body = {item: COLOURS[k % len(COLOURS)] for k, item in enumerate(bodies)}
    named = not all(re.fullmatch(r"body \d+", item) for item in bodies)
    limits = [[float(end) if end else other for end, other in zip((comments[key] or [","])[0].split(","), (-math.inf, math.inf))] for key in ("limits x", "limits y")]
    for item, parts in items.items():
        x, y, dx, dy = zip(*parts)
        kind = item.split()[0]
        if kind == "gap" and not any(dx) and not any(dy):
            continue  # nothing to be seen of it
        if not any(all(lo <= at <= hi for at, (lo, hi) in zip((a + share * c, b + share * d), limits)) for a, b, c, d in parts for share in (0, 0.5, 1)):
            continue  # outside of the picture
        if kind in ("body", "gap"):
            colour = "black" if kind == "gap" else of_body[item]
            axes.add_collection(LineCollection([[(a, b), (a + c, b + d)] for a, b, c, d in parts], colors=colour,
                                               linewidths=0.8 if kind == "gap" else 0.35 if len(bodies) == len(items) else 1.4, label=item.removeprefix("body ") if named else item))
        elif kind == "contact":
            owner = item.removeprefix("contact of ")
            colour = of_body.get(owner, of_body.get("body " + owner, "black"))
            axes.plot(x, y, "+" if colour == "black" else "ox"[list(of_body.values()).index(colour) % 2], color=colour,
                      markersize=4, markerfacecolor="none", label=item)
        elif kind in ("guide", "turn"):
            axes.plot(x, y, "s" if kind == "guide" else "o", color="black", markersize=3 if kind == "guide" else 9, markerfacecolor="none", label=item)
        elif kind == "held":
            axes.plot(x, y, ">" if item == "held x" else "^", color="black", markersize=3.5, label=item)
        else:
            colour = "#777777" if kind == "normal" else COLOURS[(len(bodies) + arrows) % len(COLOURS)]
            arrows += kind == "load"
            axes.quiver(x, y, dx, dy, angles="xy", scale_units="xy", scale=1, width=0.004 if kind == "normal" else 0.008, color=colour, zorder=3)
            axes.plot([], [], color=colour, marker=r"$\rightarrow$", markersize=11, linestyle="", label=item)
    axes.set_aspect("equal", anchor="S")  # the legend stays below
    axes.legend(fontsize=7, ncol=3, loc="upper center", bbox_to_anchor=(0.5, -0.21), frameon=False)


def draw_map(axes, comments, rows):
    corners, arrows = ([row for row in rows if row["item"] == item] for item in ("corner", "arrow"))
    x, y, shade, contact, stick = ([value(row[key]) for row in corners] for key in ("x", "y", "value", "contact", "stick"))
    mesh = Triangulation(x, y, [(k, k + 1, k + 2) for k in range(0, len(corners), 3)])
    shades = axes.tripcolor(mesh, shade, shading="gouraud", cmap="viridis")
    handles = []
    for inside, style, word in ((contact, "-", "edge of contact"), (stick, "--", "edge of stick")):
        if min(inside) < 0.5 < max(inside):
            axes.tricontour(mesh, inside, [0.5], colors="white", linestyles=style, linewidths=1.2)
            handles.append(Line2D([], [], color="0.4", linestyle=style, label=word))
    longest = max((value(row["value"]) for row in arrows), default=0)
    if longest > 0:
        shown = arrows[:: -(-len(arrows) // 400)]
        sides = [said.split(",") for key in ("limits x", "limits y") for said in comments[key]] or [(min(c), max(c)) for c in (x, y)]
        size = 0.08 * max(float(hi) - float(lo) for lo, hi in sides) / longest
        axes.quiver(*([value(row[key]) for row in shown] for key in ("x", "y")),
                    *([size * value(row[key]) for row in shown] for key in ("dx", "dy")),
                    angles="xy", scale_units="xy", scale=1, width=0.004, color="white")
    axes.figure.colorbar(shades, ax=axes)
    axes.set_aspect("equal")
    if handles:
        legend_above(axes, handles)


def finish(axes, comments):
    one = {key: texts[0] for key, texts in comments.items() if texts}
    axes.set_title(symbols(one.get("title", "")), pad={"zones": 23, "map": 23, "plan": 34}.get(one["kind"], 6))
    axes.set_xlabel(symbols(one.get("x", "")))
    axes.set_ylabel(symbols(one.get("y", "")))
    scale = one.get("scale", "")
    if scale in ("loglog", "semilogx"):
        axes.set_xscale("log")
    if scale in ("loglog", "semilogy"):
        axes.set_yscale("log")
    for key, span, place in (("shade", axes.axvspan, axes.get_xaxis_transform()),
                             ("shade y", axes.axhspan, axes.get_yaxis_transform())):
        for text in comments[key]:
            lo, hi, word = text.split(",", 2)
            span(float(lo), float(hi), color="0.85", zorder=0)
            if word and key == "shade":
                axes.text((float(lo) + float(hi)) / 2, 0.98, word, transform=place, fontsize=8, rotation=90, ha="center", va="top",
                          clip_on=True)
    for axis, limit in (("x", axes.set_xlim), ("y", axes.set_ylim)):
        lo, _, hi = one.get("limits " + axis, ",").partition(",")
        limit(float(lo) if lo else None, float(hi) if hi else None)
    if one.get("reversed") == "x":
        axes.invert_xaxis()
    for axis, kind, limits in ((axes.xaxis, axes.get_xscale(), axes.get_xlim()), (axes.yaxis, axes.get_yscale(), axes.get_ylim())):
        if kind == "linear":
            if axis is axes.xaxis:
                axis.set_major_locator(MaxNLocator(6, steps=[1, 2, 2.5, 5, 10], integer=one.get("x") in ("cycle", "cycles")))
            one_power(axis, max(map(abs, limits)))


def one_power(axis, largest):
    """One power of ten for all ticks, which would overlap: it stands before the unit."""
    power = math.floor(math.log10(largest)) if 0 < largest < math.inf else 0
    if -2 <= power < 5:
        return
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x / 10.0**power:.6g}".replace("-", "−")))
    name, bracket, unit = axis.get_label_text().rpartition(" [")
    ten = f"$10^{{{power}}}$"
    axis.set_label_text(f"{name} [{ten} {unit}" if bracket else f"{unit} [{ten}]")


def less_elastic(said, rows):
    """Loops without their elastic part, which lies beside them: displacement less force times the least slope of a loop, which
    is that after a reversal. The rest is slip. None if there is no rest."""
    loops = {}
    for row in rows:
        loops.setdefault((row["series"], row["style"]), []).append((value(row["x"]), value(row["y"])))
    made = []
    for (series, style), points in loops.items():
        most = max(abs(force) for _, force in points)
        slopes = [(d1 - d0) / (f1 - f0) for (d0, f0), (d1, f1) in zip(points, points[1:]) if abs(f1 - f0) > 1e-6 * most]
        slopes = [slope for slope in slopes if slope > 0]
        if not slopes:
            continue
        left = [d - min(slopes) * force for d, force in points]
        whole = [d for d, _ in points]
        if max(left) - min(left) > 1e-6 * (max(whole) - min(whole)):
            made += [{"series": series, "style": style, "x": d, "y": force} for d, (_, force) in zip(left, points)]
    if not made:
        return None
    x = said["x"][0] if said["x"] else ""
    name, bracket, unit = x.partition(" [")
    return defaultdict(list, said, title=["The same less its elastic part (force/steepest slope)"], x=[f"{name} less elastic part{bracket}{unit}"]), made


DRAW = {"lines": draw_lines, "table": draw_lines, "zones": draw_zones, "plan": draw_plan, "field": draw_field,
        "scene": draw_scene, "map": draw_map}


def caption(run):
    """The case and the study of a run."""
    case = run["shown"]["options"].get("case") or ""
    title = case.replace("\\", "/").rpartition("/")[2].removesuffix(".json")
    if title:
        return f"{title} ({run['shown']['study']})"
    given = " ".join(f"--{name} {text}" for name, text in run["shown"].get("given", {}).items() if not isinstance(text, bool) and text not in (None, ""))
    return f"{run['shown']['study']} {given}".strip()[:110]


# Text of 9 points, and letters that stay letters in a PDF.
STYLE = {"pdf.fonttype": 42, "font.size": 9, "axes.titlesize": 10, "hatch.linewidth": 0.8, "font.family": "DejaVu Sans"}


def drawn_panels(run, names=None):
    """Words and rows of all panels of a run, or those of these names, in the order in which they are drawn."""
    panels = []
    for name in panel_names(run) if names is None else names:
        said, rows = panel(run, name)
        if said["apart"]:  # one panel an interface, each in its colour
            of_curve = OrderedDict.fromkeys(interface_of(row["series"]) for row in rows)
            for k, name in enumerate(of_curve):
                own = defaultdict(list, said, title=[f"{said['title'][0]}, {name}"], colour=[str(k)])
                panels.append((own, [row for row in rows if interface_of(row["series"]) == name]))
            continue
        if said["kind"] != ["field"]:
            panels.append((said, rows))
            less = less_elastic(said, rows) if name.startswith("loops") and said["kind"] == ["lines"] else None
            if less:
                panels.append(less)
            continue
        for series in OrderedDict.fromkeys(row["series"] for row in rows):
            values = [value(row["value"]) for row in rows]  # one scale of colours for all of them
            own = defaultdict(list, said, title=[f"{said['title'][0]}, {series}"], range=[f"{min(values):.9g},{max(values):.9g}"])
            panels.append((own, [row for row in rows if row["series"] == series]))
    return panels


def sheet(panels, title=""):
    """A figure of panels, side by side."""
    columns = 1 if len(panels) == 1 else 2 if len(panels) < 7 else 3
    height = -(-len(panels) // columns)
    with matplotlib.rc_context(STYLE):
        made = Figure(figsize=(5.6 if columns == 1 else 4.8 * columns, 3.7 * height))
        grid = made.subplots(height, columns, squeeze=False)
        for axes in grid.flat[len(panels):]:
            axes.remove()
        for axes, (said, rows) in zip(grid.flat, panels):
            DRAW[said["kind"][0]](axes, said, rows)
            finish(axes, said)
        if title:
            made.suptitle(title, fontsize=11, fontweight="bold", x=0.01, ha="left")
        made.tight_layout(rect=(0, 0, 1, 1 - 0.06 / height if title else 1))
    return made


def figure(run, names=None):
    """All panels of a run, or those of these names. Chosen ones are for a paper, and have no title of the run."""
    panels = drawn_panels(run, names)
    if not panels:
        raise Refused("the run has nothing to draw")
    return sheet(panels, "" if names or len(panels) == 1 else caption(run))


def save(made, file, **options):
    """Writes a figure. Matplotlib reads the width of hatches only now."""
    with matplotlib.rc_context(STYLE):
        made.savefig(file, **options)

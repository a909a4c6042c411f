"""Sketches of the problems: bodies, loads, names and load histories."""

from figures import COLOURS, label, sheet

BODY, OTHER, FORCE = "#DCE6F0", "#EFE6DA", COLOURS[1]


class Sketch:
    def __init__(self, axes, title=""):
        self.axes = axes
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set_title(title)

    def body(self, x, y, colour=BODY):
        self.axes.fill(x, y, facecolor=colour, edgecolor="black", linewidth=1)
        return self

    def box(self, x0, x1, y0, y1, colour=BODY):
        return self.body([x0, x1, x1, x0], [y0, y0, y1, y1], colour)

    def reach(self, *points):
        """Widens the limits of the axes to these points: arrows and words do not, and are left out where they lie beyond."""
        self.axes.update_datalim(points)
        self.axes.autoscale_view()

    def arrow(self, x, y, dx, dy, name="", colour=FORCE, at=1.25):
        self.reach((x, y), (x + dx, y + dy))
        self.axes.annotate("", xy=(x + dx, y + dy), xytext=(x, y), arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.4})
        return self.text(x + at * dx, y + at * dy, name, colour) if name else self

    def pressure(self, x0, x1, y, length, name="", count=9):
        """Arrows that press down (or up, if length is negative) on a line."""
        for k in range(count):
            self.arrow(x0 + (x1 - x0) * k / (count - 1), y + length, 0, -length)
        self.axes.plot([x0, x1], [y + length] * 2, color=FORCE, linewidth=1)
        return self.text(0.5 * (x0 + x1), y + 1.35 * length, name, FORCE)

    def size(self, x0, y0, x1, y1, name, dx=0.0, dy=0.0):
        self.reach((x0, y0), (x1, y1))
        self.axes.annotate("", xy=(x1, y1), xytext=(x0, y0), arrowprops={"arrowstyle": "<->", "color": "#555555", "linewidth": 0.8})
        return self.text(0.5 * (x0 + x1) + dx, 0.5 * (y0 + y1) + dy, name)

    def line(self, x, y, style="-", colour="black", width=1.0):
        self.axes.plot(x, y, style, color=colour, linewidth=width)
        return self

    def text(self, x, y, words, colour="#222222"):
        self.reach((x, y))
        self.axes.text(x, y, words, color=colour, ha="center", va="center", fontsize=9)
        return self


def histories(loads, x="time", points=()):
    """Load histories {name: (times, values)}; points: (time, value, name)."""
    figure, (axes,) = sheet(1, height=2.7)
    for k, (name, (at, values)) in enumerate(loads.items()):
        axes.plot(at, values, color=COLOURS[k], linewidth=1.8, linestyle=["-", (0, (6, 2))][k % 2], label=name)
    for at, value, name in points:
        axes.plot([at], [value], "o", color="black", markersize=4)
        axes.annotate(name, (at, value), xytext=(4, 5), textcoords="offset points", fontsize=9)
    axes.axhline(0, color="black", linewidth=0.8)
    label(axes, x, "load")
    return figure


def block(axes, title="", lower="half-plane"):
    """A square block on a plane, pressed and sheared."""
    s = Sketch(axes, title)
    if lower == "rigid plane":
        s.line([-2.2, 2.2], [0, 0], width=2)
        for k in range(16):
            s.line([-2.1 + 0.28 * k, -2.3 + 0.28 * k], [0, -0.22], width=0.7)
        s.text(0, -0.5, "rigid plane")
    else:
        s.box(-2.6, 2.6, -1.6, 0, OTHER).text(0, -1.1, "half-plane of the same material")
    s.box(-1, 1, 0, 2).pressure(-1, 1, 2, 0.45, "P0, uniform")
    s.arrow(1.15, 2.0, 0.8, 0, "Q(t)", COLOURS[0])
    s.size(-1, 1.3, 1, 1.3, "2a", dy=0.16).size(1.25, 0, 1.25, 1.85, "2a", dx=0.25)
    s.arrow(0, 0, 0.55, 0, "x", "black", 1.3).arrow(0, 0, 0, 0.8, "y", "black", 1.15)
    return s


def strip():
    figure, (axes,) = sheet(1, height=2.9)
    s = Sketch(axes)
    s.box(-1.5, 7, -1.8, 0, OTHER).box(0, 7, 0, 1).text(3.5, -1.2, "half-plane of the same material")
    s.pressure(3, 7, 1, 0.6, "p, p0 at most").size(0, 1.25, 3, 1.25, "n t", dy=0.2).size(-0.25, 0, -0.25, 1, "t", dx=-0.25)
    s.line([3, 3], [-0.6, 1], ":").size(3, -0.35, 1.6, -0.35, "s", dy=-0.25).size(3, 0.35, 2.2, 0.35, "e", dy=0.2)
    s.line([1.6, 1.6], [-0.5, 0.1], "-").line([2.2, 2.2], [0, 0.5], "-")
    s.arrow(3, 0, 0.9, 0, "ξ", "black", 1.2).arrow(0, 0, 0.7, 0, "x", "black", 1.25)
    return figure


def block_sheet(lower="half-plane"):
    figure, (axes,) = sheet(1, height=3.2)
    block(axes, "", lower)
    return figure


def receding():
    figure, both = sheet(2, height=2.2)
    for axes, gap, title in zip(both, (0, 0.35), ("put together", "pressed")):
        s = Sketch(axes, title)
        x = [k / 10 - 3 for k in range(61)]
        bent = [gap * max(0, abs(a) - 0.8) ** 1.5 / 3.3 for a in x]
        s.body([*x, *x[::-1]], [*bent, *[b + 0.7 for b in bent[::-1]]])
        s.body([*x, *x[::-1]], [*[-b for b in bent], *[-b - 0.7 for b in bent[::-1]]], OTHER)
        if gap:
            s.arrow(0, 1.5, 0, -0.8).arrow(0, -1.5, 0, 0.8).text(0.25, 1.25, "P", FORCE).text(0.25, -1.25, "P", FORCE)
    return figure


def lap():
    figure, (axes,) = sheet(1, height=2.6)
    s = Sketch(axes)
    s.box(-6, 1.95, 0, 0.5).box(-1.95, 6, -0.5, 0, OTHER)
    s.pressure(-0.5, 0.5, 0.5, 0.45, "", 6).pressure(-0.5, 0.5, -0.5, -0.45, "", 6).text(-2.4, 0.8, "p0 over w", FORCE)
    s.arrow(-6, 0.25, -0.9, 0, "T").arrow(6, -0.25, 0.9, 0, "T")
    s.size(-6, -1.15, 0, -1.15, "16 t", dy=-0.25).size(0, 1.15, 1.95, 1.15, "1.95 t", dy=0.25).size(2.3, -0.5, 2.3, 0.5, "t", dx=0.2)
    s.arrow(0, 0, 0.7, 0, "x", "black", 1.3)
    return figure


def disc(radii=False, torque=False):
    figure, (axes,) = sheet(1, height=3)
    s = Sketch(axes)
    s.box(-4, 4, -2.2, 0, OTHER).box(-2.5, 2.5, 0, 1).text(0, -1.6, "half-space of the same material")
    s.pressure(-1.2, 1.2, 1, 0.55, "", 9).line([0, 0], [-1.3, 2.0], "-.")
    s.size(0, 0.6, 2.5, 0.6, "b", dy=0.2).size(-2.75, 0, -2.75, 1, "t", dx=-0.2).size(0, 1.8, 1.2, 1.8, "a", dx=0.8)
    if not torque:
        s.text(-2.2, 1.75, "p, P0 = π a² p0", FORCE)
    if radii:
        s.size(0, -0.3, 0.9, -0.3, "c", dy=-0.2).size(0, -0.75, 1.8, -0.75, "d", dy=-0.2).line([0.9, 0.9], [-0.4, 0]).line([1.8, 1.8], [-0.85, 0])
    if torque:
        s.text(0, 2.35, "T, turns the top about the axis", COLOURS[0])
        axes.annotate("", xy=(-0.8, 2.05), xytext=(0.8, 2.05), arrowprops={"arrowstyle": "-|>", "color": COLOURS[0], "connectionstyle": "arc3,rad=-0.35"})
    return figure


def signs(displacements=False):
    """Forces on both bodies, or displacements, of a contact node."""
    figure, both = sheet(2, height=2.6)
    for axes, side, name in zip(both, (1, -1), ("body 1", "body 2, turned by 180°")):
        s = Sketch(axes, name)
        x = [-1.6, 1.6, 1.6, -1.6]
        s.body(x, [0, 0, 1.3 * side, 1.3 * side], BODY if side > 0 else OTHER)
        axes.plot([0], [0], "o", color="black", markersize=5)
        if displacements:
            s.arrow(0, 0, 0.8 * side, 0, "v", COLOURS[0]).arrow(0, 0, 0, 0.8 * side, colour=COLOURS[0]).text(0.2, 0.6 * side, "w", COLOURS[0])
        else:
            s.arrow(-0.8 * side, 0, 0.8 * side, 0).text(-0.55 * side, 0.2 * side, "q", FORCE)
            s.arrow(0, -0.8 * side, 0, 0.8 * side, "p", at=-0.2)
        s.text(0, 1.08 * side, "y into the body")
        axes.set_xlim(-2, 2)
        axes.set_ylim(-1.7, 1.7)
    return figure


def gap(title="", load=False):
    figure, (axes,) = sheet(1, height=2.8)
    s = Sketch(axes, title)
    x = [k / 10 - 2 for k in range(41)]
    s.box(-2.6, 2.6, -1, 0, OTHER)
    s.body([*x, 2, -2], [*[a * a / 6 for a in x], 2.2 if load else 1.6, 2.2 if load else 1.6])
    for a in (-1.6, -0.8, 0.8, 1.6):
        s.size(a, 0, a, a * a / 6, "")
    s.text(1.8, 0.2, "g").arrow(0, 0, 0.6, 0, colour="black").text(0.5, -0.18, "s, x")
    if load:
        s.pressure(-2, 2, 2.2, 0.5, "P").text(0, 1.4, "punch, g = x²/2R").text(0, -0.6, "half-plane of the same material")
    return figure


def edge():
    figure, (left, right) = sheet(2, height=2.8)
    s = Sketch(left)
    x = [k / 10 - 2 for k in range(41)]
    s.box(-3, 3, -1.2, 0, OTHER).body([*x, 2, -2], [*[max(0, abs(a) - 0.9) ** 2 / 3 for a in x], 1.4, 1.4])
    s.arrow(0, 2.3, 0, -0.9, "P", at=-0.2).arrow(0.3, 1.0, 0.9, 0, "Q", COLOURS[0]).arrow(3, -0.6, 0.7, 0, "σ").arrow(-3, -0.6, -0.7, 0, "σ")
    s.size(-0.9, 0.2, 0.9, 0.2, "2a", dy=0.2)
    t = [k / 100 for k in range(1, 301)]
    root = [a ** 0.5 for a in t]
    right.plot([0, *t], [0, *root], color=COLOURS[0], linewidth=1.8, label="p = K_N √t")
    right.plot(t[4:], [0.5 / r for r in root[4:]], color=COLOURS[1], linestyle=(0, (2, 1.5)), label="q/f = K_T/(f √t), adhered")
    right.plot([0, *t], [0, *[r - max(0, a - 1) ** 0.5 for r, a in zip(root, t)]], color=COLOURS[2], linestyle=(0, (6, 2)), label="q/f with slip, 0 < t < d")
    label(right, "t/d", "p, q/f near the edge")
    return figure

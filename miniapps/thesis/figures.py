"""Drawing in the style of cattaneo_show, with the thesis' axes."""

from collections import defaultdict

import matplotlib
from runs import nan  # noqa: F401  first: it knows where cattaneo_show is

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from cattaneo_show import drawing as plot  # noqa: E402

COLOURS, DASHES = plot.COLOURS, plot.DASHES
plt.rcParams.update({"font.size": 9, "axes.titlesize": 10, "hatch.linewidth": 0.8, "font.family": "DejaVu Sans",
                     "svg.hashsalt": "thesis"})


def sheet(count=1, columns=0, width=4.4, height=3.3):
    """A figure with some axes."""
    columns = columns or min(count, 2)
    rows = -(-count // columns)
    wide = 5.6 if columns == 1 else width * columns
    figure, grid = plt.subplots(rows, columns, figsize=(wide, height * rows), squeeze=False)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, list(grid.flat[:count])


def panels(*chosen, columns=0, height=3.3):
    """A figure of panels that runs wrote: (run, name, changes) each, changes as in draw()."""
    figure, all_axes = sheet(len(chosen), columns, height=height)
    for axes, (run, name, *changes) in zip(all_axes, chosen):
        draw(axes, run, name, **(changes[0] if changes else {}))
    return figure


def draw(axes, run, name, only=None, rename=None, style="", **comments):
    """A panel as cattaneo_show draws it. `only`: the series whose names it accepts; `rename`: what they are called instead;
    `style`: of all of them; comments replace its words: title, x, y, limits_x="0,1", scale, reversed."""
    said, rows = run.panel(name)
    said = defaultdict(list, said)
    for key, text in comments.items():
        said[key.replace("_", " ")] = [text] if text else []
    if only:
        rows = [row for row in rows if only(row["series"])]
    if rename:
        rows = [dict(row, series=rename(row["series"])) for row in rows]
    if style:
        rows = [dict(row, style=style) for row in rows]
    plot.DRAW[said["kind"][0]](axes, said, rows)
    plot.finish(axes, said)


def curves(axes, named, x="", y="", title="", legend=True, **style):
    """Curves {name: (x, y)}, told apart by colour and dashes."""
    first = len(axes.get_lines())
    for k, (name, (at, values)) in enumerate(named.items()):
        axes.plot(at, values, **{"color": COLOURS[(first + k) % 7], "linestyle": plot.dashes(first + k),
                                 "linewidth": 1.6, "label": name, **style})
    label(axes, x, y, title, legend)
    return axes


def label(axes, x="", y="", title="", legend=True):
    axes.set_xlabel(plot.symbols(x) or axes.get_xlabel())
    axes.set_ylabel(plot.symbols(y) or axes.get_ylabel())
    axes.set_title(plot.symbols(title) or axes.get_title())
    if axes.get_xscale() == "linear":
        axes.locator_params(axis="x", nbins=7)
    axes.grid(True, color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)
    if legend and axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=8 if len(axes.get_lines()) < 9 else 6.5, framealpha=0.9)


def thesis(axes, points, name="thesis"):
    """Values of the thesis, as diamonds."""
    axes.plot([x for x, _ in points], [y for _, y in points], "D", color="black", markerfacecolor="white", markersize=6,
              label=name, zorder=5)
    label(axes)


def marks(run, *quantities):
    """The thesis' values of some rows of a run's table of references."""
    rows = {row["quantity"]: row for row in run.references()}
    return [rows[name]["thesis"] for name in quantities]

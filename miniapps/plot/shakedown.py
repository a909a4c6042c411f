"""Figures of the miniapp shakedown: python3 shakedown.py DIRECTORY (with the tables it wrote)."""
import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Okabe and Ito's colours, told apart by line style as well.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"]
STYLES = ["-", "--", "-.", ":"]
plt.rcParams.update({"font.size": 11, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
                     "figure.figsize": (6.4, 4.8), "savefig.dpi": 150})

folder = pathlib.Path(sys.argv[1])
results = json.loads((folder / "results.json").read_text(encoding="utf-8"))


def table(name):
    """Columns by name; None if the table was not written."""
    if not (folder / name).exists():
        return None
    with open(folder / name, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {column: np.array([float(row[column]) for row in rows]) for column in rows[0]}


def finish(figure, axes, name, xlabel, ylabel):
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1))
    figure.savefig(folder / name, bbox_inches="tight")
    plt.close(figure)


def values(rows, key):
    return np.array([np.nan if row[key] is None else row[key] for row in rows], float)


def bounded(axes, data, *columns):
    """Limits of y from the middle of the contact: tractions are singular at its ends."""
    inside = slice(len(data["x"]) // 10, -(len(data["x"]) // 10))
    low = min(data[c][inside].min() for c in columns)
    high = max(data[c][inside].max() for c in columns)
    axes.set_ylim(low - 0.2 * (high - low), high + 0.2 * (high - low))


if "adhesion_map" in results:
    rows = results["adhesion_map"]
    figure, axes = plt.subplots()
    axes.plot(values(rows, "load_factor"), values(rows, "friction"), color="k")
    axes.text(0.1, 0.85, "full adhesion", transform=axes.transAxes)
    axes.text(0.6, 0.15, "slip", transform=axes.transAxes)
    axes.set_ylim(bottom=0)
    if any(row["open"] for row in rows):
        # No friction adheres where the contact has opened: the border ends there.
        axes.axvspan(results["adhesion_opens"], rows[-1]["load_factor"], color="0.85")
        axes.text(0.5 * (results["adhesion_opens"] + rows[-1]["load_factor"]), 0.1, "corner open",
                  rotation=90, ha="center")
    finish(figure, axes, "figure_4_03_adhesion.png", r"$\lambda = Q_{max}/P$", r"friction coefficient $f$")

band = table("method2.csv")
if band:
    figure, axes = plt.subplots()
    axes.fill_between(band["x"], band["lowest"], band["highest"], alpha=0.3, color=COLOURS[0],
                      label="permissible, method 1")
    axes.plot(band["x"], band["chosen"], "k--", label="one without resultant")
    bounded(axes, band, "lowest", "highest")
    finish(figure, axes, "figure_4_09_permissible.png", "$x/a$", r"$a q_{res}/P$")

optimal = table("optimal.csv")
if optimal:
    x = optimal["x"]
    figure, axes = plt.subplots()
    axes.plot(x, optimal["slip"], color="k")
    finish(figure, axes, "figure_4_15_optimal_slip.png", "$x/a$", r"optimal slip $v E'/P$")
    figure, axes = plt.subplots()
    axes.plot(x, optimal["q_residual"], STYLES[0], color=COLOURS[0], label="shear")
    axes.plot(x, optimal["p_residual"], STYLES[1], color=COLOURS[1], label="pressure")
    bounded(axes, optimal, "q_residual", "p_residual")
    finish(figure, axes, "figure_4_16_residual_tractions.png", "$x/a$", r"residual tractions $\times a/P$")
    figure, axes = plt.subplots()
    axes.fill_between(x, optimal["lowest"], optimal["highest"], alpha=0.3, color=COLOURS[0],
                      label="permissible")
    axes.plot(x, optimal["q_residual"], "k--", label="optimal")
    bounded(axes, optimal, "lowest", "highest")
    finish(figure, axes, "figure_4_17_optimal_residual.png", "$x/a$", r"$a q_{res}/P$")

if "map" in results:
    rows = results["map"]
    figure, axes = plt.subplots()
    reversals = sorted({row["reversal"] for row in rows})
    for k, reversal in enumerate(reversals):
        own = [row for row in rows if row["reversal"] == reversal]
        axes.plot(values(own, "load_limit") / values(own, "friction"), values(own, "friction"),
                  linestyle=STYLES[k % 4], color=COLOURS[k % 4], label=f"$R$ = {reversal:g}")
    finish(figure, axes, "figure_4_18_map.png", r"$Q_{max}/fP$", r"friction coefficient $f$")

if "marches" in results:
    figure, axes = plt.subplots()
    for k, run in enumerate(results["marches"]):
        loss = np.array(run["dissipation"], float)
        if (loss > 0).any():
            axes.semilogy(np.arange(1, len(loss) + 1), np.where(loss > 0, loss, np.nan),
                          linestyle=STYLES[k % 4], color=COLOURS[k % 4],
                          label=f"from {run['start']} slip")
        else:
            axes.plot([], [], linestyle=STYLES[k % 4], color=COLOURS[k % 4],
                      label=f"from {run['start']} slip: none")
    finish(figure, axes, "figure_4_19_dissipation.png", "cycle", r"dissipation in the cycle $\times E'/P^2$")

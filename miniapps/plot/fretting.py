"""Figures of the miniapp fretting: python3 fretting.py DIRECTORY (with the tables it wrote)."""
import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Okabe and Ito's colours, told apart by line style as well.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]
STYLES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2))]
MARKERS = ["o", "s", "D", "v", "P", "X"]
plt.rcParams.update({"font.size": 11, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
                     "figure.figsize": (6.4, 4.8), "savefig.dpi": 150})


def table(path):
    """Columns by name; numbers where all of a column are."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    for name, values in columns.items():
        try:
            columns[name] = np.array(values, float)
        except ValueError:
            columns[name] = np.array(values)
    return columns


def legend_beside(axes):
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1))


def curves(axes, data, x, y, design):
    """One curve for each friction coefficient; the design's own is the thick black one."""
    k = 0
    for friction in dict.fromkeys(data["friction"]):
        use = data["friction"] == friction
        label = f"$f$ = {friction:g}"
        if np.isclose(friction, design["friction"]):
            axes.plot(data[x][use], data[y][use], color="black", lw=2.5, label=label + " (design)")
        else:
            axes.plot(data[x][use], data[y][use], color=COLOURS[k], ls=STYLES[k], label=label)
            k += 1


def save(figure, directory, name):
    figure.savefig(directory / name, bbox_inches="tight")
    plt.close(figure)


def field(directory, design):
    data = table(directory / "field.csv")
    frictions = sorted(set(data["friction"]))
    figure, all_axes = plt.subplots(len(frictions), 1, sharex=True, squeeze=False,
                                    figsize=(6.4, 3.0 * len(frictions)), constrained_layout=True)
    levels = np.arange(0.1, 1.61, 0.1)
    for axes, friction in zip(all_axes[:, 0], frictions):
        use = data["friction"] == friction
        t, y = np.unique(data["t_over_d"][use]), np.unique(data["y_over_d"][use])
        values = data["von_mises"][use].reshape(len(y), len(t))
        shades = axes.contourf(t, y, values, levels, cmap="viridis", extend="both")
        lines = axes.contour(t, y, values, levels[1::2], colors="white", linewidths=0.7)
        axes.clabel(lines, fmt="%.1f", fontsize=8)
        axes.plot([0, 1], [0, 0], color="#D55E00", lw=5, clip_on=False, solid_capstyle="butt",
                  label="slip zone")
        axes.plot([1, 2], [0, 0], color="black", lw=5, clip_on=False, solid_capstyle="butt",
                  label="stick zone")
        own = " (design)" if np.isclose(friction, design["friction"]) else ""
        axes.set(ylabel="depth $y/d$", ylim=(1.5, 0), xlim=(-1, 2), title=f"$f$ = {friction:g}{own}")
        axes.grid(False)
    all_axes[-1, 0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncol=2)
    all_axes[-1, 0].set_xlabel("distance into the contact $t/d$")
    figure.colorbar(shades, ax=all_axes, label=r"von Mises stress $\sigma_{vM}/(K_N\sqrt{d})$")
    save(figure, directory, "fig_2_2_field.png")


def surface(directory, design):
    figure, axes = plt.subplots()
    curves(axes, table(directory / "surface.csv"), "t_over_d", "von_mises", design)
    axes.axvspan(0, 1, color="#D55E00", alpha=0.1)
    axes.text(0.5, 0.03, "slip zone", ha="center", transform=axes.get_xaxis_transform())
    axes.set(xlabel="distance into the contact $t/d$", xlim=(-1, 2), ylim=(0, None),
             ylabel=r"surface von Mises stress $\sigma_{vM}/(K_N\sqrt{d})$")
    legend_beside(axes)
    save(figure, directory, "fig_2_3_surface.png")


def yield_map(directory, design):
    data = table(directory / "yield.csv")
    figure, axes = plt.subplots()
    axes.plot(data["friction"], data["full"], color=COLOURS[1], ls="--",
              label="whole slip zone yields")
    axes.plot(data["friction"], data["first"], color=COLOURS[0], label="elastic limit")
    if design["yield_ratio_full"] > 0:
        load = design["yield_ratio_full"] / design["friction"]
        axes.plot(design["friction"], load, "k*", ms=14, label="design")
    axes.set(xlabel="friction coefficient $f$", ylabel=r"load $K_N\sqrt{d}/k$", xlim=(0.1, 1),
             ylim=(0, 6))
    axes.legend()
    save(figure, directory, "fig_2_4_yield.png")


def trajectory(directory, design):
    figure, axes = plt.subplots()
    curves(axes, table(directory / "trajectory.csv"), "c_over_d", "k_i", design)
    axes.axhline(0, color="grey", lw=0.8)
    axes.set(xlabel="crack depth $c/d$", ylabel=r"$K_{I,\max}/\sqrt{K_N K_T d}$", xlim=(0, 1))
    axes.legend()
    save(figure, directory, "fig_2_6_trajectories.png")


CRITERIA = {"open": "open part of the cycle", "range": "range of $K_I$",
            "half-range": "half range of $K_I$"}


def diagram(directory, design):
    data = table(directory / "diagram.csv")
    figure, axes = plt.subplots()
    c = data["c_over_a0"]
    if design["edge_width"]:
        # Where the crack is no longer small against the contact the field is another one.
        limit = 0.25 * design["edge_width"] / design["critical_length"]
        if limit < c[-1]:
            axes.axvspan(limit, c[-1], color="white", zorder=3)
            axes.axvspan(limit, c[-1], color="0.5", alpha=0.15, hatch="//", zorder=3,
                         label="too deep for the near-edge field")
    axes.fill_between(c, 1e-3, np.minimum(1, np.sqrt(c)), color="#009E73", alpha=0.15)
    axes.plot(c, np.minimum(1, np.sqrt(c)), color=COLOURS[2], ls="--",
              label="threshold (no growth below)")
    positive = lambda y: np.where(y > 0, y, np.nan)
    if not np.allclose(data["drive"], data["drive_edge_alone"]):
        axes.plot(c, positive(data["drive_edge_alone"]), color=COLOURS[0], ls=":",
                  label="crack, edge field alone")
    axes.plot(c, positive(data["drive"]), color="black", lw=2.5, label="crack of the design")
    at_a0 = design["drive"] / design["k_threshold"]
    if at_a0 > 0.05:
        axes.plot(1, at_a0, "k*", ms=14, zorder=4, label="design at $a_0$")
    inside = c <= limit if design["edge_width"] else c > 0
    top = 2 * max(1, np.nanmax(data["drive"][inside]))
    axes.set(xscale="log", yscale="log", xlim=(c[0], c[-1]), ylim=(0.05, top),
             xlabel=f"crack depth $c/a_0$   ($a_0$ = {1e3 * design['critical_length']:.3g} µm)",
             ylabel=r"driving force$/\Delta K_{th}$  (" + CRITERIA[design["criterion"]] + ")",
             title=f"Kitagawa–Takahashi diagram: {design['verdict'].replace('a0', '$a_0$')}")
    legend_beside(axes)
    save(figure, directory, "kitagawa_takahashi.png")


X_LABEL = r"$X = \Delta K_{th} K_N/(\pi\sigma_{fl}^2)$"
Y_LABEL = r"$Y = \Delta K_T/\Delta K_{th}$"


def threshold(directory, design):
    data = table(directory / "threshold.csv")
    figure, axes = plt.subplots()
    curves(axes, data, "x", "y", design)
    axes.plot(design["threshold_x"], design["design_y"], "k*", ms=14, label="design")
    visible = np.interp(0.05 * data["x"].max(), data["x"][data["friction"] == data["friction"].min()],
                        data["y"][data["friction"] == data["friction"].min()])
    axes.set(xlabel=X_LABEL, ylabel=Y_LABEL, xlim=(0, data["x"].max()),
             ylim=(0, max(visible, 1.2 * design["design_y"])),
             title=f"Threshold, {CRITERIA[design['criterion']]}, edge field alone")
    axes.legend()
    save(figure, directory, "fig_2_7_threshold.png")


def scatter(axes, data, x, y):
    """Tests by series; hollow markers are run-outs, those not to be trusted are crossed."""
    for k, series in enumerate(dict.fromkeys(data["series"])):
        use = data["series"] == series
        broken, out = use & (data["runout"] == 0), use & (data["runout"] == 1)
        style = {"marker": MARKERS[k % 6], "ls": "", "color": COLOURS[k % 6], "ms": 8}
        axes.plot(data[x][broken], data[y][broken], **style, label=f"{series}")
        axes.plot(data[x][out], data[y][out], **style, mfc="none", mew=1.8)
    axes.plot([], [], "ko", mfc="none", mew=1.8, ls="", label="run-out (hollow)")
    poor = data["trust"] == "not to be trusted"
    if poor.any():
        axes.plot(data[x][poor], data[y][poor], "kx", ms=5, ls="",
                  label="outside the method's validity")


def correlations(directory, design):
    data = table(directory / "records.csv")
    line = {"color": "black", "ls": "--", "lw": 1.2}
    threshold_k_t = design["mode_two_k_t"]
    for name, y, label, level, text in [
            ("fig_2_5_stress.png", "edge_stress_range", r"edge stress range $\Delta\sigma_{xx}$ (MPa)",
             design["fatigue_limit"], r"plain fatigue limit $\sigma_{fl}$"),
            ("fig_2_9_mode_two.png", "k_t_range", r"$\Delta K_T$ (MPa$\sqrt{\mathrm{mm}}$)",
             threshold_k_t, r"mode II threshold, $\Delta K_{II,th}/\sqrt{2\pi}$"),
            ("fig_2_10_energy.png", "energy_max", r"largest frictional energy per cycle (mJ/mm$^2$)",
             None, "")]:
        figure, axes = plt.subplots()
        scatter(axes, data, "cycles", y)
        if level is not None:
            axes.axhline(level, **line, label=text)
        axes.set(xscale="log", xlabel="life (cycles)", ylabel=label, ylim=(0, None))
        legend_beside(axes)
        save(figure, directory, name)

    figure, axes = plt.subplots()
    scatter(axes, data, "threshold_x", "design_y")
    curve = table(directory / "threshold.csv")
    use = np.isclose(curve["friction"], design["friction"])
    axes.plot(curve["x"][use], curve["y"][use], "k-", lw=2,
              label=f"threshold, $f$ = {design['friction']:g}")
    axes.set(xlabel=X_LABEL, ylabel=Y_LABEL, xlim=(0, 1.4 * data["threshold_x"].max()),
             ylim=(0, 1.3 * max(data["design_y"].max(),
                                np.interp(data["threshold_x"].min(), curve["x"][use],
                                          curve["y"][use]))))
    legend_beside(axes)
    save(figure, directory, "fig_2_8_threshold_tests.png")


def main():
    directory = pathlib.Path(sys.argv[1])
    design = json.loads((directory / "assessment.json").read_text(encoding="utf-8"))
    figures = [field, surface, yield_map, trajectory, diagram, threshold]
    if (directory / "records.csv").exists():
        figures.append(correlations)
    for figure in figures:
        figure(directory, design)
    print(f"figures in {directory}: " +
          ", ".join(sorted(path.name for path in directory.glob("*.png"))))


main()

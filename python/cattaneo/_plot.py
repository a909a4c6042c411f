"""Figures of reports; matplotlib is asked for only here."""

import numpy as np

from . import readout


def _pyplot():
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("plot() needs matplotlib: pip install cattaneo[plot]") from error
    return pyplot


def march(report, axes=None):
    """Tractions and slip at the end of a march, and the loops of the loads that vary.

    axes: as many as there are figures, from left to right, or None for new ones. Returns them."""
    problem, state = report.problem, report.state
    loops = [name for name, load in report.multipliers.items() if len(load) > 1 and np.ptp(load) > 0]
    count = 2 + len(loops)
    if axes is None:
        _, axes = _pyplot().subplots(1, count, figsize=(4.5 * count, 3.6), layout="constrained")
    axes = np.ravel(axes)
    if len(axes) != count:
        raise ValueError(f"axes are {len(axes)}, must be {count}: tractions, slip, and a loop each of {loops}")
    lies = len(problem.arc_length) == problem.nodes
    x = problem.arc_length if lies else np.arange(problem.nodes)
    tractions = len(problem.weights) == problem.nodes
    weights = problem.weights if tractions else np.ones(problem.nodes)
    order = np.argsort(x, kind="stable")

    def draw(axis, values, label, style):
        axis.plot(x[order], values[order], style, label=label, markersize=3)

    draw(axes[0], state.p / weights, "p", "k.-")
    for c in range(problem.components):
        q = state.q[c * problem.nodes : (c + 1) * problem.nodes]
        draw(axes[0], q / weights, "q" if problem.components == 1 else f"q{c + 1}", ("C0.-", "C1.-")[c])
        v = state.v[c * problem.nodes : (c + 1) * problem.nodes]
        draw(axes[1], v, "slip v" if problem.components == 1 else f"slip v{c + 1}", ("C0.-", "C1.-")[c])
    if problem.components > 0:
        draw(axes[0], problem.friction * state.p / weights, "f p", "k:")
    draw(axes[1], state.w + problem.gap, "opening w + g", "k.-")
    axes[0].set_ylabel("traction" if tractions else "nodal force")
    axes[1].set_ylabel("relative displacement")
    for axis in axes[:2]:
        axis.set_xlabel("arc length" if lies else "node")
        axis.legend()
    controls = {pattern.name: pattern.control for pattern in problem.patterns}
    for axis, name in zip(axes[2:], loops):
        load, conjugate = report.multipliers[name], report.conjugates[name]
        if controls[name] == "force":
            axis.plot(conjugate, load, ".-", markersize=3)
            axis.set(xlabel=f"displacement of {name}", ylabel=name)
        else:
            axis.plot(load, conjugate, ".-", markersize=3)
            axis.set(xlabel=name, ylabel=f"reaction of {name}")
    return axes

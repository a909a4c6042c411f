"""Figures of reports. Only this file needs matplotlib."""

import numpy as np

from . import readout


def _pyplot():
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("plot() needs matplotlib: pip install cattaneo[plot]") from error
    return pyplot


#: Loads with a resultant, whose displacement or reaction is in the units of the problem.
_RESULTANTS = ("force", "opposite forces", "displacement", "moment", "torque", "rotation", "bolt")


def size_of(pattern):
    """The size of a load's resultant at multiplier 1, and the words after "displacement" or "reaction". The size is 1
    if there is no resultant or it is not known; results are then per unit of the load."""
    size = pattern.size
    return (size["value"], f" of {pattern.name}") if size and size["kind"] in _RESULTANTS else (1.0, f" per unit of {pattern.name}")


def march(report, axes=None):
    """Tractions and slip at the end of a march, of each interface, and the loops of the loads that vary.

    axes: one for each figure, from left to right, or None for new ones. Returns the axes."""
    problem, state = report.problem, report.state
    loops = [name for name, load in report.multipliers.items() if len(load) > 1 and np.ptp(load) > 0]
    # Reports that are made from states have no interfaces: all nodes are drawn together.
    faces = {name: each.nodes for name, each in report.interfaces.items()} or {"": np.arange(problem.nodes)}
    count = 2 * len(faces) + len(loops)
    if axes is None:
        _, axes = _pyplot().subplots(1, count, figsize=(4.5 * count, 3.6), layout="constrained")
    axes = np.ravel(axes)
    if len(axes) != count:
        of_each = "tractions, slip, " if len(faces) == 1 else f"tractions and slip of each of {list(faces)}, "
        raise ValueError(f"axes are {len(axes)}, must be {count}: {of_each}and a loop each of {loops}")
    for k, (name, nodes) in enumerate(faces.items()):
        _interface(axes[2 * k : 2 * k + 2], problem, state, nodes)
        if len(faces) > 1:
            axes[2 * k].set_title(name)
            axes[2 * k + 1].set_title(name)
    patterns = {pattern.name: pattern for pattern in problem.patterns}
    for axis, name in zip(axes[2 * len(faces) :], loops):
        size, behind = size_of(patterns[name])
        load, conjugate = report.multipliers[name] * size, report.conjugates[name] / size
        if patterns[name].control == "force":
            axis.plot(conjugate, load, ".-", markersize=3)
            axis.set(xlabel=f"displacement{behind}", ylabel=name)
        else:
            axis.plot(load, conjugate, ".-", markersize=3)
            axis.set(xlabel=name, ylabel=f"reaction{behind}")
    return axes


def _interface(axes, problem, state, nodes):
    """Tractions and slip of some nodes, along their line."""
    lies = len(problem.arc_length) == problem.nodes
    x = problem.arc_length[nodes] if lies else nodes
    tractions = len(problem.weights) == problem.nodes
    weights = problem.weights[nodes] if tractions else np.ones(len(nodes))
    order = np.argsort(x, kind="stable")

    def draw(axis, values, label, style):
        axis.plot(x[order], values[order], style, label=label, markersize=3)

    draw(axes[0], state.p[nodes] / weights, "p", "k.-")
    for c in range(problem.components):
        own = nodes + c * problem.nodes
        alone = problem.components == 1
        draw(axes[0], state.q[own] / weights, "q" if alone else f"q{c + 1}", ("C0.-", "C1.-")[c])
        draw(axes[1], state.v[own], "slip v" if alone else f"slip v{c + 1}", ("C0.-", "C1.-")[c])
    if problem.components > 0:
        draw(axes[0], problem.friction[nodes] * state.p[nodes] / weights, "f p", "k:")
    draw(axes[1], state.w[nodes] + problem.gap[nodes], "opening w + g", "k.-")
    axes[0].set_ylabel("traction" if tractions else "nodal force")
    axes[1].set_ylabel("relative displacement")
    for axis in axes:
        axis.set_xlabel("arc length" if lies else "node")
        axis.legend()

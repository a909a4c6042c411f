"""Objects in notebooks: their sentence, and tables of their loads, interfaces and cycles."""

import html
from typing import Any

from ._plot import size_of


def _cell(value: Any) -> str:
    return html.escape(f"{value:.6g}" if isinstance(value, float) else str(value))


def _table(head: list[str], rows: list[list[Any]]) -> str:
    if not rows:
        return ""
    titles = "".join(f"<th>{html.escape(title)}</th>" for title in head)
    body = "".join("<tr>" + "".join(f"<td>{_cell(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{titles}</tr></thead><tbody>{body}</tbody></table>"


def _loads(report: Any) -> list[list[Any]]:
    rows = []
    for pattern in report.problem.patterns:
        size, behind = size_of(pattern)
        all_ = report.conjugates[pattern.name]
        last = float(all_[-1]) / size if len(all_) else float("nan")
        kind = "displacement" if pattern.control == "force" else "reaction"
        rows.append([pattern.name, report.loads[pattern.name], last, kind + behind])
    return rows


def _interfaces(report: Any) -> list[list[Any]]:
    rows = []
    for name, each in report.interfaces.items():
        if len(each.normal_force):
            shear = each.tangential_force[-1] if len(each.tangential_force) else 0.0
            shown = " and ".join(f"{s:.6g}" for s in shear) if hasattr(shear, "__len__") else float(shear)
            rows.append([name, float(each.normal_force[-1]), shown, int(each.sticking[-1]), int(each.slipping[-1]),
                         int(each.open[-1])])  # fmt: skip
    return rows


def of_march(report: Any) -> str:
    """The outcome and its residuals; loads, interfaces at the end, and the last cycles."""
    told = [f"{report.status} at time {report.state.time:.6g}"]
    if report.message:
        told.append(report.message)
    told.append(f"dissipation {report.state.dissipation:.6g}, largest residual {report.largest_residual:.3g}")
    cycles = [[each.cycle, each.dissipation, each.external_work, each.slip_change] for each in report.cycles[-10:]]
    return (
        f"<div><b>MarchReport</b>: {html.escape('; '.join(told))}"
        + _table(["load", "multiplier", "displacement or reaction", "which is the"], _loads(report))
        + _table(["interface", "normal force", "tangential force", "stick", "slip", "open"], _interfaces(report))
        + _table(["cycle", "dissipation", "external work", "slip change"], cycles)
        + "</div>"
    )


def of_any(value: Any) -> str:
    """The printed text, with its lines."""
    text = repr(value)
    return f"<pre>{html.escape(text[1:-1] if text.startswith('<') and text.endswith('>') else text)}</pre>"

"""The panels of a run, as its JSON has them."""

import json
import pathlib
from collections import OrderedDict, defaultdict


class Refused(ValueError):
    """One sentence about a file or a name that cannot be used."""


def read(file):
    """A run: the JSON that a program wrote (--json), as a dictionary. Refused if the file is not a run."""
    try:
        with open(file, encoding="utf-8") as text:
            run = json.load(text)
    except OSError as error:
        raise Refused(f"file '{file}' cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise Refused(f"file '{file}' is not JSON: {error}") from error
    if not isinstance(run, dict) or not isinstance(run.get("shown"), dict):
        raise Refused(f"file '{file}' is not a run: it has no key 'shown', which programs write with --json")
    marches = run["shown"].get("marches")
    if isinstance(marches, str):  # long ones are in a file beside it
        beside = pathlib.Path(file).with_name(marches)
        try:
            run["shown"]["marches"] = json.loads(beside.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise Refused(f"file '{beside}' with the increments of '{file}' cannot be read: {getattr(error, 'strerror', error)}") from error
    return run


def panel_names(run):
    """Names of the panels of a run, in the order of its figure."""
    return [panel["name"] for panel in run["shown"]["panels"]]


def panel(run, name):
    """Words and rows of one panel of a run.

    Words: for each key (kind, title, x, y, limits x, …) a list of texts. Rows: dictionaries, by column. Of a table that
    is drawn they are the table's own. Unknown names are refused."""
    for one in run["shown"]["panels"]:
        if one["name"] == name:
            return words(one), rows(run, one)
    raise Refused(f"there is no panel '{name}', must be one of {', '.join(panel_names(run)) or 'none: the run has nothing to draw'}")


def words(one):
    said = defaultdict(list)
    for key, text in one.items():
        if key not in ("name", "parts"):
            said[key] = list(text) if isinstance(text, list) else [text]
    return said


def rows(run, one):
    if one["kind"] == "table":
        return run[one["name"]]
    made = []
    for part in one["parts"]:
        count = max(len(column) for column in part.values() if isinstance(column, list))
        columns = {key: column if isinstance(column, list) else [column] * count for key, column in part.items()}
        made += [dict(zip(columns, row)) for row in zip(*columns.values())]
    return made


def value(x):
    """A number for a drawing. Other values leave a gap."""
    return float("nan") if x is None else float(x)


def series_of(said, rows):
    """Points of each (series, style), of a panel of lines or of a table."""
    series = OrderedDict()
    if said["kind"] == ["lines"]:
        for row in rows:
            series.setdefault((row["series"], row["style"]), []).append((value(row["x"]), value(row["y"])))
        return series
    over, curves = said["over"][0], [text.split("=", 1) for text in said["curve"]]
    by, word = (said["by"] or ["="])[0].split("=", 1)
    for column, name in curves:
        begun = set()  # the curves of one value are one series, with a gap between them
        for row in rows:
            points = series.setdefault((f"{word} = {number(row[by])}" if by else name, "line"), [])
            if id(points) not in begun and points:
                points.append((float("nan"), float("nan")))
            begun.add(id(points))
            points.append((value(row.get(over)), value(row.get(column))))
    marks = [tuple(map(float, text.split(","))) for text in said["mark"]]
    if marks:
        series[("thesis", "thesis")] = marks
    return series


def number(x):
    """A number for a legend: up to ten digits, without trailing zeros."""
    return f"{x:.10g}" if isinstance(x, float) else str(x)


def pieces(option, text, between):
    """Pieces of an option's text between these characters; text in quotes is one piece. No piece is empty."""
    made, quote = [""], ""
    for mark in text:
        if not quote and mark in between:
            made.append("")
            continue
        begins = mark in "\"'" and not quote and (not made[-1] or made[-1][-1] == ".")
        made[-1] += mark
        if begins or mark == quote:
            quote = mark if begins else ""
    if quote:
        raise Refused(f"{option}: the quote in '{text}' has no end")
    return [piece for piece in made if piece]


def unquoted(word):
    return word[1:-1] if len(word) > 1 and word[0] == word[-1] and word[0] in "\"'" else word

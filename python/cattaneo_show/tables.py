"""Tables that are printed, and CSV files, as the programs make them."""

import math
import os

from .panels import Refused
from .panels import rows as rows_of_panel
from .panels import words as words_of_panel


def text_of(x):
    """A number without digits that are not needed."""
    return f"{x:g}" if isinstance(x, float) else str(x)


class Table:
    """Rows that are printed, and written as JSON (by the keys of their columns) and as CSV.

    columns: (key, heading, format of a number) each; without a heading the column is only in files, without a key it is only
    printed."""

    def __init__(self, name, columns):
        self.name, self.columns, self.rows, self.cells = name, columns, [], []

    def row(self, values, more):
        """Values in the order of the columns; `more` goes only to JSON."""
        self.rows.append({**{key: x for (key, _, _), x in zip(self.columns, values) if key}, **more})
        self.cells.append([cell(x, form) for (_, heading, form), x in zip(self.columns, values) if heading])

    def printed(self):
        return {"name": self.name, "head": [heading for _, heading, _ in self.columns if heading], "rows": self.cells}

    def show(self):
        heads = self.printed()["head"]
        print()
        for line in [heads, *self.cells] if self.cells else []:
            print("".join("  " + text.rjust(max(10, len(head))) for text, head in zip(line, heads)))

    def keys(self):
        return [key for key, _, _ in self.columns if key]


def cell(x, form):
    if isinstance(x, str):
        return x
    if isinstance(x, bool):
        return "yes" if x else "no"
    if isinstance(x, int):
        return str(x)
    return form % x if x is not None and math.isfinite(x) else "-"


def field(x):
    """A value in a CSV file. Anything that is not a single value is left out."""
    if isinstance(x, str):
        return quoted(x)
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, float):
        return f"{x:.10g}" if math.isfinite(x) else ""
    return "" if x is None or isinstance(x, (dict, list)) else str(x)


def quoted(text):
    return '"' + text.replace('"', '""') + '"' if any(mark in text for mark in ',"\n\r') else text


def csv_of(words, keys, rows):
    """The CSV file of rows: words as comments, the keys of the columns, and a line per row."""
    lines = [f"# {key}: {text}" for key, texts in words.items() for text in texts]
    lines += [",".join(map(quoted, keys)), *(",".join(field(row.get(key)) for key in keys) for row in rows)]
    return "\n".join(lines) + "\n"


def flat(row, path=""):
    """Values in a result by their places: "k_n.value" for nested ones, "notes.0" for lists."""
    if not row or not isinstance(row, (dict, list)):
        return {path: None if isinstance(row, (dict, list)) else row}
    inner = row.items() if isinstance(row, dict) else enumerate(row)
    return {place: x for key, value in inner for place, x in flat(value, f"{path}.{key}" if path else str(key)).items()}


def csv_files(run):
    """Text of a CSV file for each table and panel of a run, by their names: all that --csv writes at the end of a run."""
    panels, files = {one["name"]: one for one in run["shown"]["panels"]}, {}
    for one in run["shown"].get("csv", []):
        name, rows = one["name"], one.get("rows")
        rows = run[name] if rows is None else [flat(row) for row in rows]
        keys = one.get("columns") or list(dict.fromkeys(key for row in rows for key in row))
        files[name] = csv_of(words_of_panel(panels.get(name, {})), keys, rows)
    for name, one in panels.items():
        if name not in files:
            rows = rows_of_panel(run, one)
            keys = sorted(dict.fromkeys(key for row in rows for key in row), key=lambda key: key != "time")
            files[name] = csv_of(words_of_panel(one), keys, rows)
    return files


def cannot_write(file, error):
    """A sentence about a file that an OSError is about."""
    folder = os.path.dirname(file or "") or "."
    return f"file '{file}' cannot be written: " + (error.strerror if os.path.isdir(folder) else f"there is no folder '{folder}'")


def write(file, text):
    """Writes a file, whole or not at all; a device or a pipe as it is. Refused if it cannot be written."""
    end = os.path.realpath(file)  # a link stays
    part = end if os.path.exists(end) and not os.path.isfile(end) else f"{end}.part"
    try:
        with open(part, "w", encoding="utf-8") as out:
            out.write(text)
        if part != end:
            os.replace(part, end)
    except OSError as error:
        if part != end and os.path.exists(part):
            os.unlink(part)
        raise Refused(cannot_write(file, error)) from error

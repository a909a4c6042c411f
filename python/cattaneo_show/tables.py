"""Tables that are printed, and CSV files, as the programs make them."""

import math
import os

from .panels import Refused


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

    def csv(self):
        keys = [key for key, _, _ in self.columns if key]
        return "".join(",".join(line) + "\n" for line in [map(quoted, keys), *([field(row[key]) for key in keys] for row in self.rows)])


def cell(x, form):
    if isinstance(x, str):
        return x
    if isinstance(x, bool):
        return "yes" if x else "no"
    if isinstance(x, int):
        return str(x)
    return form % x if x is not None and math.isfinite(x) else "-"


def field(x):
    if isinstance(x, str):
        return quoted(x)
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, float):
        return f"{x:.10g}" if math.isfinite(x) else ""
    return "" if x is None else str(x)


def quoted(text):
    return '"' + text.replace('"', '""') + '"' if any(mark in text for mark in ',"\n\r') else text


def csv_of_lines(panel):
    """The CSV file of a panel of lines: its words as comments, then a row per point."""
    lines = [f"# {key}: {text}" for key, text in panel.items() if key not in ("name", "parts")] + ["series,style,x,y"]
    for part in panel["parts"]:
        lines += [f"{quoted(part['series'])},{part['style']},{x:.9g},{y:.9g}" for x, y in zip(part["x"], part["y"])]
    return "\n".join(lines) + "\n"


def csv_of(words, rows):
    """The CSV file of any panel: its words as comments, then its rows."""
    lines = [f"# {key}: {text}" for key, texts in words.items() for text in texts]
    columns = list(dict.fromkeys(key for row in rows for key in row))
    lines += [",".join(map(quoted, columns)), *(",".join(field(row.get(key)) for key in columns) for row in rows)]
    return "\n".join(lines) + "\n"


def write(file, text):
    """Writes a file, whole or not at all. Refused if it cannot be written."""
    part = f"{file}.part"
    try:
        with open(part, "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(part, file)
    except OSError as error:
        raise Refused(f"file '{file}' cannot be written: {error.strerror}") from error

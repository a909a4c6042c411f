"""A chapter of the page, declared: its figures, each with what it shows, the commands that make it, and how it is drawn."""

import re
from dataclasses import dataclass, field


@dataclass
class Figure:
    number: str                 # "4.5", "Table 2.1", "8.2 (3)"
    title: str
    text: str                   # what it shows, in sentences of our own
    commands: list = field(default_factory=list)
    draw: object = None         # takes the runs of the commands, in their order; returns a figure of matplotlib
    rows: str = ""              # rows of the runs' own tables of references that belong to it: a regular expression
    wrong: str = ""             # where the thesis is wrong: the reason, ...
    proof: str = ""             # ... and the command that proves it
    missing: str = ""           # why it cannot be made
    stated: list = field(default_factory=list)  # values of its text alone: (quantity, reference or None, its ±, thesis, computed(*runs))

    @property
    def name(self):
        return self.number if self.number.startswith("Table") else "Appendix " + self.number if self.number in "ABCD" else "Figure " + self.number

    def comparisons(self, runs):
        """Rows of references of its runs, each once."""
        found = {}
        for run in runs:
            for row in run.references():
                if self.rows and re.search(self.rows, row["quantity"]):
                    found.setdefault((row["quantity"], row["reference"]), row)
        for quantity, reference, spread, thesis, computed in self.stated:
            value = computed(*runs)
            outside = reference is not None and value is not None and abs(value - reference) > spread
            found[quantity] = {"quantity": quantity, "reference": reference, "spread": spread, "thesis": thesis, "computed": value, "tolerance": None,
                               "outside": outside}
        return list(found.values())


class Chapter:
    def __init__(self, number, title, text):
        self.number, self.title, self.text, self.figures = number, title, text, []

    def figure(self, number, title, commands, text, draw, **rest):
        commands = [commands] if isinstance(commands, str) else list(commands)
        self.figures.append(Figure(number, title, text, commands, draw, **rest))

    def sketch(self, number, title, text, draw):
        """A figure that needs no run."""
        self.figures.append(Figure(number, title, text, [], draw))

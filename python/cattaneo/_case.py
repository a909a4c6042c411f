"""Case files of the program `contact`, which has the meshes that this package does not read."""

import csv
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping
from typing import Any

from ._core import (
    ContactState,
    InputError,
    LoadHistory,
    OutcomeWarning,
    ReducedProblem,
    conjugates,
    load_contact_state,
    load_reduced_problem,
)


@dataclasses.dataclass(repr=False)
class Case:
    """A case file that the program `contact` has marched."""

    file: str  #: the case
    problem: ReducedProblem  #: with all bolts as springs
    state: ContactState  #: where the march of the program ended
    #: Points of the march, with its cycle. Multipliers of bolts with a `preload` are the pretensions that tightening
    #: has given: march(problem, history) is the march of the case, unless other loads act before a bolt is tightened.
    #: A warning says so: in `problem` the spring of that bolt is there from the beginning. Continue from `state` then.
    history: LoadHistory
    #: By name: the row of each bolt in the table of bolts at the end of the march, with `stiffness` and the `unit` of
    #: the multiplier, which is the preload or pretension.
    bolts: dict[str, dict[str, Any]]
    results: dict[str, Any]  #: what `contact --json` has; its `warnings` are those of the run

    @property
    def loads(self) -> list[str]:
        """Names of the loads, those of bolts among them."""
        return self.problem.loads

    def bolt_forces(self, state: ContactState) -> dict[str, float]:
        """The force of each bolt in a state of `problem`, by name. Tension is positive."""
        displacement = dict(zip(self.loads, conjugates(self.problem, state)))
        multiplier = dict(zip(self.loads, state.multipliers))
        # The displacement of a bolt is how far its ends have come together, times `unit`.
        return {
            name: float(bolt["unit"] * multiplier[name] - bolt["stiffness"] * displacement[name] / bolt["unit"])
            for name, bolt in self.bolts.items()
        }

    def __repr__(self) -> str:
        bolts = f", bolts: {' '.join(self.bolts)}" if self.bolts else ""
        return (
            f"<Case '{self.file}': {self.results.get('status', 'no status')} at time {self.state.time:g}{bolts}\n"
            f"  {self.problem}\n  {self.history}>"
        )


def _program() -> list[str]:
    """The command that runs `contact`; InputError if the program is not found."""
    named = os.environ.get("CATTANEO_BIN")
    if named:
        place = pathlib.Path(named)
        for found in (place, place / "contact"):
            if found.is_file() and os.access(found, os.X_OK):
                return [str(found)] + (["contact"] if found.name == "cattaneo" else [])
        if os.access(place / "cattaneo", os.X_OK):
            return [str(place / "cattaneo"), "contact"]
        raise InputError(
            f"the environment variable CATTANEO_BIN is '{named}', where there is no program 'contact': it must name "
            "the folder that has it (build/release/miniapps of the repository, bin of an installed copy)"
        )
    package = pathlib.Path(__file__).resolve().parent
    # In a build Python's package is <build>/python/cattaneo, of links to the sources; else it is installed.
    core = pathlib.Path(sys.modules["cattaneo._core"].__file__ or package).resolve().parent
    for folder in (package, core, core.parent.parent / "miniapps"):
        if os.access(folder / "contact", os.X_OK) and (folder / "contact").is_file():
            return [str(folder / "contact")]
    driver = shutil.which("cattaneo", path=os.pathsep.join([str(pathlib.Path(sys.prefix) / "bin"), os.defpath,
                                                             os.environ.get("PATH", "")]))  # fmt: skip
    if driver:
        return [driver, "contact"]
    raise InputError(
        "case() runs the program 'contact', which is not beside this package: build the repository (./run contact) or "
        "install its programs, and set the environment variable CATTANEO_BIN to the folder that has 'contact'"
    )


def _read(file: str) -> dict[str, Any]:
    """Reads a case file, whose comments are those of C++."""
    text = pathlib.Path(file).read_text(encoding="utf-8-sig")
    plain = re.sub(
        r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda found: found.group(1) or " ", text, flags=re.DOTALL
    )
    found: dict[str, Any] = json.loads(plain)
    return found


def _history(problem: ReducedProblem, table: pathlib.Path, cycles: int) -> LoadHistory:
    """The points of a march from its table: rows at times 1, 2, …, with the cycle once."""
    points: list[dict[str, float]] = [{}]
    start = None
    with open(table, newline="", encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            time, cycle = float(row["time"]), int(row["cycle"])
            if cycle > 1:
                break
            if abs(time - round(time)) > 1e-9 or round(time) != len(points):
                continue
            if cycle == 1 and start is None:
                start = len(points) - 1
            points.append({name: float(row[f"load {name}"]) for name in problem.loads})
    if start is not None and points[-1] != {**dict.fromkeys(problem.loads, 0.0), **points[start]}:
        start = None  # the march ended within its first cycle
    if len(points) < 2:
        points.append({})
    return LoadHistory.through(problem, points, start, cycles if start is not None else 1)


def case(file: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None, **options: Any) -> Case:
    """Runs the program `contact` on a case file, and returns its reduced problem with its loads, bolts and history.

    file: the case, JSON (docs/contact.md).
    set: other values of places within keys, as --set of the program: {"interfaces.face.friction": 0.4}.
    options: other values of keys of the case, such as order=1 or history="P=0; P=1"; cycle_start stands for
    cycle-start.

    The program marches the history and ends where the case says; `results` has what it found. This function looks for
    the program in the folder that the environment variable CATTANEO_BIN names, beside this package, in the build to
    which the package belongs, and where the command `cattaneo` is. If a case is wrong, InputError has the program's
    sentence. An outcome other than 'converged' is an OutcomeWarning, a warning of the program a UserWarning."""
    try:
        name = os.fspath(file)
    except TypeError:
        raise TypeError(f"file is {file!r}, must be the name of a case file or a path") from None
    program = _program()
    with tempfile.TemporaryDirectory() as folder:
        at = pathlib.Path(folder)
        words = [*program, "--case", name, "--save", str(at / "problem.json"), "--json", str(at / "results.json")]
        words += ["--csv", str(at / "run"), "--save-state", str(at / "state.json")]
        if set is not None and not hasattr(set, "items"):
            raise TypeError(f"set is {set!r}, must be a dict, as {{'interfaces.face.friction': 0.5}}")
        for place, value in (set or {}).items():
            words += ["--set", f"{place}={_word(value)}"]
        for key, value in options.items():
            words += ["--" + key.replace("_", "-"), _word(value)]
        done = subprocess.run(words, capture_output=True, text=True, errors="replace")
        if done.returncode not in (0, 2) or not (at / "problem.json").exists():
            said = [line for line in done.stderr.splitlines() if line.strip()]
            sentence = said[-1].removeprefix("error: ") if said else f"it ended with {done.returncode}"
            raise InputError(sentence if f"'{name}'" in sentence else f"case '{name}': {sentence}")
        results: dict[str, Any] = json.loads((at / "results.json").read_text(encoding="utf-8"))
        problem = load_reduced_problem(at / "problem.json")
        state = load_contact_state(at / "state.json")
        said_of = _read(name)
        cycles = int(options.get("cycles", (set or {}).get("cycles", said_of.get("cycles", 1))))
        history = _history(problem, at / "run_history.csv", cycles)
    bolts = {}
    for row in results.get("bolts", []):
        said_bolt = _bolt(said_of, options, set or {}, row["bolt"])
        bolts[row["bolt"]] = {**{key: value for key, value in row.items() if key != "bolt"}, **said_bolt}
    if done.returncode == 2:
        warnings.warn(f"case '{name}': {results.get('status')} {results.get('message', '')}", OutcomeWarning, stacklevel=2)
    for sentence in [*results.get("warnings", []), *_of_late_bolts(problem, history, bolts)]:
        warnings.warn(f"case '{name}': {sentence}", stacklevel=2)
    return Case(name, problem, state, history, bolts, results)


def _of_late_bolts(problem: ReducedProblem, history: LoadHistory, bolts: Mapping[str, Any]) -> list[str]:
    """A sentence about bolts that are tightened after other loads."""
    loads = [k for k, name in enumerate(problem.loads) if name not in bolts]
    late = []
    for name, bolt in bolts.items():
        points = [int(word) for word in re.findall(r"\d+", str(bolt.get("tightened_at") or ""))]
        if points and (history.multipliers[loads, : points[-1]] != 0).any():
            late.append(f"'{name}' at point {points[-1]}")
    if not late:
        return []
    return [
        f"other loads act before a bolt is tightened ({', '.join(late)}): in `problem` its spring is there from the "
        "beginning, so that march(problem, history) is not the march of the case, and must go on from `state`"
    ]


def _word(value: Any) -> str:
    """A value for the command line: points of a history between semicolons, times between spaces, other values as JSON."""
    if isinstance(value, str):
        return value
    if isinstance(value, (list, tuple)) and all(isinstance(each, (str, int, float)) for each in value):
        return ("; " if any(isinstance(each, str) for each in value) else " ").join(map(str, value))
    return json.dumps(value)


def _bolt(said: dict[str, Any], options: Mapping[str, Any], places: Mapping[str, Any], name: str) -> dict[str, float]:
    """The stiffness of a bolt and the unit of its multiplier, from the case and the options."""
    bolts = options.get("bolts", said.get("bolts", {}))
    bolt = (json.loads(bolts) if isinstance(bolts, str) else bolts)[name]
    values = {key: places.get(f"bolts.{name}.{key}", bolt.get(key)) for key in ("stiffness", "preload", "pretension")}
    unit = values["preload"] if values["preload"] is not None else values["pretension"]
    return {"stiffness": float(values["stiffness"]), "unit": float(1 if unit is None else unit)}

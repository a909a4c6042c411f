"""Sweeps: many runs of one program, as many at a time as there are cores, and a table of their results.

The program has checked keys and values of all points, and says how each is run (--sweep). A point is a process of its own
with one thread. Ctrl-C keeps the points that were computed."""

import ctypes
import json
import math
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time

from .page import page
from .panels import Refused, pieces, unquoted
from .tables import Table, csv_files, text_of, write

# Sizes and times of a run, and residuals. They are listed only on request.
NO_RESULTS = {"contact_nodes", "dofs", "seconds", "seconds_condensation", "time", "event_time", "largest_residual", "energy_imbalance"}
EARLY = "; values in parentheses are of a run that ended early, at its end"
NOT_SHOWN = {"thickness", "first_cycle", "state_changes", "steady_cycle", "steady_period"}  # unasked: an input, and how a run went
MOST_SHOWN = 9  # columns on the screen, and panels


class Point:
    """One run: its values, its command and its results."""

    def __init__(self, values, words):
        self.values, self.words = values, words
        self.results, self.status, self.message, self.ran, self.ended_well = {}, "", "", False, False

    def finish(self, code, results, errors):
        """The exit code of a process that has ended. A signal is a negative exit code."""
        self.ran, self.ended_well = True, code == 0
        if results.exists():
            self.results = json.loads(results.read_text(encoding="utf-8"))
            self.status, self.message = self.results["status"], self.results.get("message", "")
            return
        said = [line[7:] for line in errors.read_text(encoding="utf-8", errors="replace").splitlines() if line.startswith("error: ")]
        self.message = said[-1] if said else ""
        self.status = "refused" if code == 1 else "stopped" if code == -signal.SIGINT else f"ended by signal {max(0, -code)}"


def places(wanted):
    """Places of results (dissipation.0) between blanks or commas, as their words; those with blanks are in quotes."""
    names = [unquoted(piece) for piece in pieces("option --sweep-results", wanted, " \t,")]
    return {name: [unquoted(word) for word in pieces("option --sweep-results", name, ".")] for name in names}


def result(results, path):
    """A number or a word by its place (dissipation.0); None if there is none."""
    at = results
    for part in path:
        if isinstance(at, dict) and part in at:
            at = at[part]
        elif isinstance(at, list) and part.isdigit() and int(part) < len(at):
            at = at[int(part)]
        else:
            return None
    return None if isinstance(at, (dict, list)) else at


def is_number(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool)


def die_with_parent():
    """In a new process: only the sweep gets Ctrl-C and passes it on, and no point continues after the sweep."""
    os.setpgid(0, 0)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGTERM)


class Interrupt:
    """The first Ctrl-C stops the sweep, a second one ends it at once."""

    def __init__(self):
        self.came = False
        signal.signal(signal.SIGINT, self)

    def __call__(self, *_):
        self.came = True
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def run_points(program, points, wanted, warn):
    """Runs all points in their order, unless Ctrl-C comes. If the first point that ends well lacks a result that was asked for,
    a warning says so."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_"))}
    environment["OPENBLAS_NUM_THREADS"] = "1"
    cores, begun, ended, running, interrupt, told = os.cpu_count() or 1, time.monotonic(), 0, {}, Interrupt(), False
    waiting, line = iter(enumerate(points)), Progress()
    with tempfile.TemporaryDirectory(prefix="cattaneo_sweep_") as folder:
        folder = pathlib.Path(folder)

        def start(number, point):
            results, errors = folder / f"{number}.json", folder / f"{number}.err"
            with open(errors, "wb") as file:
                process = subprocess.Popen([program, *point.words, "--json", str(results)], stdin=subprocess.DEVNULL, env=environment,
                                           stdout=subprocess.DEVNULL, stderr=file, preexec_fn=die_with_parent)
            running[process] = (point, results, errors)

        left = True
        while left or running:
            while left and len(running) < cores:
                following = None if interrupt.came else next(waiting, None)
                left = following is not None
                if left:
                    start(*following)
            if interrupt.came and not told:
                told = True
                for process in running:
                    process.send_signal(signal.SIGINT)
            for process in [process for process in running if process.poll() is not None]:
                point, results, errors = running.pop(process)
                point.finish(process.returncode, results, errors)
                ended += 1
                if point.ended_well and wanted is not None:
                    for name, path in wanted.items():
                        if result(point.results, path) is None:
                            warn(f"option --sweep-results: the first point that ended has no number or word of the name '{name}'")
                    wanted = None
            line.show(f"sweep: {ended} of {len(points)} points, {time.monotonic() - begun:.0f} s "
                      + ("(stops; Ctrl-C ends it now)" if interrupt.came else "(Ctrl-C writes what there is)"))
            time.sleep(0.01)
    line.clear()


class Progress:
    """A line on a terminal, after two seconds and twice a second."""

    def __init__(self):
        self.begun = self.last = time.monotonic()
        self.shown = False

    def show(self, text):
        now = time.monotonic()
        if sys.stderr.isatty() and now - self.begun > 2 and now - self.last > 0.5:
            print(f"\r{text}\x1b[K", end="", file=sys.stderr, flush=True)
            self.last, self.shown = now, True

    def clear(self):
        if self.shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def single_numbers(points, keys):
    """Names of results that are single numbers in any point, except sizes, times, errors and residuals."""
    known = {*NO_RESULTS, *(key["name"] for key in keys)}
    return list(dict.fromkeys(name for point in points for name, x in point.results.items()
                              if is_number(x) and "_error" not in name and name not in known))


def varies(points, path):
    """Does a result differ from point to point that ended well (from all that have it, if fewer than two did), by more than
    round-off?"""
    well = [point for point in points if point.ended_well]
    points = well if len(well) > 1 else [point for point in points if result(point.results, path) is not None] or points
    first = result(points[0].results, path)
    for point in points:
        x = result(point.results, path)
        if is_number(x) and is_number(first):
            if abs(x - first) > 1e-9 * max(abs(x), abs(first)):
                return True
        elif x != first:
            return True
    return False


def drawn_over(keys):
    """The key with the most numbers (of several, the last one); None if no key has two."""
    best = None
    for key in keys:
        if len(key["values"]) > 1 and all(map(is_number, key["values"])) and (best is None or len(key["values"]) >= len(best["values"])):
            best = key
    return best


def called(key):
    """A key in words: several places of a history are one load, `history.2.Q,-history.3.Q` the amplitude of Q."""
    parts = [unquoted(piece) for piece in pieces("option --sweep", key, ",")]
    places = [pieces("option --sweep", part.lstrip("-"), ".") for part in parts]
    if any(len(place) != 3 or place[0] != "history" for place in places) or len({place[2] for place in places}) > 1:
        return key
    load = unquoted(places[0][2])
    return f"amplitude of {load}" if any(part.startswith("-") for part in parts) else f"{load} at point {', '.join(place[1] for place in places)}"


def words_of(points, name):
    """A result as the program's own output calls it, and its unit: label, then " [unit]" or nothing."""
    for point in points:
        for value in point.results.get("shown", {}).get("values", []):
            if value.get("key") == name and value["label"]:
                label, bracket, unit = value["label"].partition(" [")
                label += " at the end" if name == "peak_pressure" else ""
                return label, f" [{value['unit']}]" if value["unit"] else bracket + unit
    energy = next((point.results["shown"]["units"].get("energy", "") for point in points if "shown" in point.results), "")
    word = "energy lost in the whole history" if name == "total_dissipation" else name.replace("_", " ")
    return word, energy if name.endswith("dissipation") else ""


def scale(parts):
    """Axes on which values of both signs, or within two decades, are linear, and others logarithmic."""
    def wide(values):
        return min(values) > 0 and max(values) >= 100 * min(values)

    x, y = (wide([value for part in parts for value in part[axis]]) for axis in "xy")
    return {"scale": "loglog" if x and y else "semilogx" if x else "semilogy"} if x or y else {}


def slopes(parts, said):
    """On two logarithmic axes a curve that is nearly a straight line has its slope beside its name."""
    for part in parts.values() if said.get("scale") == "loglog" else ():
        x, y = ([math.log(value) for value in part[axis]] for axis in "xy")
        if len(x) < 3:
            continue
        mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
        slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
        off = max(abs(b - mean_y - slope * (a - mean_x)) for a, b in zip(x, y))
        if off < 0.05 * (max(y) - min(y)):
            part["series"] = ", ".join([*filter(None, [part["series"]]), f"slope {slope:.3g}"])


def curves(keys, points, names, study=""):
    """A panel for each result over one key, with a curve for each value of the other keys."""
    over, panels = drawn_over(keys), []
    if over is None:
        return panels
    k = keys.index(over)
    label = called(over["name"])
    if label == "amplitude" and lead(study, keys):
        label = "amplitude (factor on the cycle, from its start)"
    for name, path in names.items():
        parts = {}
        slides = {}  # the status of each value at which a run ended early
        for point in points:
            y = result(point.results, path)
            if not point.ended_well and point.ran and point.status != "stopped":  # Ctrl-C says nothing of the joint
                slides[point.values[k]] = point.status
            if not is_number(y) or not point.ended_well:
                continue
            series = ", ".join(f"{called(key['name'])} = {text_of(value)}" for j, (key, value) in enumerate(zip(keys, point.values)) if j != k)
            part = parts.setdefault(series, {"series": series, "style": "marked", "x": [], "y": []})
            part["x"].append(float(f"{point.values[k]:.9g}"))
            part["y"].append(float(f"{y:.9g}"))
        shaded = {}
        if slides and len(parts) == 1:  # the value from which on the joint slides, or another reason why runs ended
            good = [x for part in parts.values() for x in part["x"] if x < min(slides)]
            begin, why = max(good) if good else min(slides), slides[min(slides)].replace("_", " ")
            word = f"{why} begins between {begin:.9g} and {min(slides):.9g}" if good else why
            shaded = {"shade": f"{begin:.9g},{max(slides):.9g},{word}", "limits x": f",{max(slides):.9g}"}
        if parts:
            slopes(parts, scale(parts.values()))
            said, unit = words_of(points, name)
            panels.append({"name": f"over_{over['name']}_{name}", "kind": "lines", "title": said[:1].upper() + said[1:] + (" (depends on the mesh)" if "depends on the mesh" in unit else ""), "x": label, "y": said + unit.partition(" (")[0],
                           **scale(parts.values()), **shaded, "parts": list(parts.values())})
    return panels


def sweep(plan, draws):
    """Runs the points of a plan and reports them: prints a table, writes JSON, CSV, picture and page. Returns the exit code:
    0 if all points converged, else 2.

    plan: what the program wrote (program, study, keys, points, options, blas_kernels). draws: is there matplotlib?"""
    begun, options, keys = time.monotonic(), plan["options"], plan["keys"]
    points = [Point(point["values"], point["words"]) for point in plan["points"]]
    asked, wanted, warnings = len(points), places(options["sweep-results"]), []
    if options["plot"] and drawn_over(keys) is None:
        raise Refused("option --plot: results are drawn over a key with two values or more, all of them numbers, and the sweep has none")

    def warn(sentence):
        if sentence not in warnings:
            warnings.append(sentence)
            print("warning: " + sentence, flush=True)

    run_points(plan["program"], points, wanted or None, warn)
    points = [point for point in points if point.ran]
    if points and all(point.status == "refused" for point in points):
        raise Refused("every point of the sweep is refused, the first one: " + points[0].message)
    singles = single_numbers(points, keys)
    names = wanted or {name: [name] for name in singles}
    missing = [name for name, path in names.items() if points and all(result(point.results, path) is None for point in points)]
    allowed = f"must be one of {', '.join(singles)}, or a place as levels.0.slip, with blanks in quotes"
    if names and len(missing) == len(names) and any(point.ended_well for point in points):
        raise Refused(f"option --sweep-results: no point has a number or a word of the name '{missing[0]}', {allowed}")
    run = {}
    for name in missing:  # computed results stay, and the other results that were asked for
        run["message"] = f"option --sweep-results: no point has a number or a word of the name '{name}', {allowed}"
        print("\n" + run["message"])
    shown = [name for name, path in names.items() if wanted or (name not in NOT_SHOWN and points and varies(points, path))][:MOST_SHOWN]
    table = table_of(keys, points, names, shown)
    table.show()
    for sentence in dict.fromkeys(sentence for point in points for sentence in point.results.get("warnings", [])):
        warn(sentence)
    for message in sorted({point.message for point in points if point.status == "refused"}):
        print("refused: " + message)
    if len(shown) < len(names):
        print(f"{len(names) - len(shown)} more results, which do not vary or are too many, are only in --json and --csv; "
              "--sweep-results names those to be shown")
    converged = sum(point.ended_well for point in points)
    panels = curves(keys, points, {name: names[name] for name in shown or [name for name in names if name not in NOT_SHOWN][:1]}, plan["study"])
    run.update(points=len(points), status="ended early" if missing else "converged")
    if converged < asked:
        run["status"] = "stopped" if len(points) < asked else "ended early"
        run["message"] = f"{converged} of {asked} points converged" + (EARLY if len(points) == asked else "")
        print("\n" + run["message"])
    counters = {}
    for point in points:
        for name, count in point.results.get("counters", {}).items():
            counters[name] = counters.get(name, 0) + count
    run.update(sweep=table.rows, references=[], seconds=time.monotonic() - begun, counters=counters, blas_kernels=plan["blas_kernels"],
               warnings=warnings)
    units = next((point.results["shown"]["units"] for point in points if "shown" in point.results), {"length": "", "pressure": ""})
    run["shown"] = {"study": plan["study"], "event": "", "units": units, "options": options, "values": [], "lead": lead(plan["study"], keys, points), "tables": [in_words(table.printed(), keys, points)] if points else [],
                    "csv": [{"name": "sweep", "columns": table.keys()}], "panels": panels, "marches": [], "more_marches": 0}
    if options["verbose"]:
        print(f"\nWhat it took, {run['seconds']:.3g} s")
        for name, count in counters.items():
            if count > 0:
                print(f"   {name.replace('_', ' '):40} {count}")
    sys.stdout.flush()
    report(run, options, draws)
    return 0 if converged == asked and not missing else 2


def lead(study, keys, points=()):
    """A sentence of the page on a key whose name alone says too little, and the loads."""
    sizes = next((point.results["load_sizes"] for point in points if point.results.get("load_sizes")), [])
    if study in ("contact", "march") and any(key["name"] == "amplitude" for key in keys):
        return {"sentence": "The amplitude is a factor on the differences of the cycle's loads from those where the cycle starts, which stay. "
                            "A cycle from Q = 1 to -1 and back goes with the amplitude 1.2 from 1 to -1.4.",
                "rows": [[f"{load['load']} = 1", f"{load['size']:g}", load["force"] if load["kind"] != "displacement" else load["displacement"]] for load in sizes]}
    return None


def in_words(printed, keys, points):
    """The table of the page: columns as the program calls them, with units."""
    known = {key["name"] for key in keys}
    head = [called(name) if name in known else "at (loads as factors)" if name == "at" else "".join(words_of(points, name)) for name in printed["head"]]
    return {**printed, "head": head}


def table_of(keys, points, names, shown):
    """A row for each point, in their order."""
    events = any("event_loads" in point.results for point in points)
    table = Table("sweep", [(key["name"], key["name"], "%g") for key in keys]
                  + [("status", "status", "")]
                  + [(name, name if name in shown else "", "%.5g") for name in names] + ([("event_time", "", ""), ("", "at", "")] if events else []) + [("message", "", "")])
    for point in points:
        row = [*point.values, point.status, *(result(point.results, path) for path in names.values())]
        if events:
            ended = "event_loads" in point.results
            row += [point.results["event_time"] if ended else None, point.results["shown"]["event"] if ended else ""]
        more = {"event_loads": point.results["event_loads"]} if "event_loads" in point.results else {}
        table.row([*row, point.message], more)
        if not point.ended_well:
            cells, first = table.cells[-1], len(keys) + 1
            cells[first:first + len(shown)] = [f"({text})" if text not in ("", "-") else text for text in cells[first:first + len(shown)]]
    return table


def report(run, options, draws):
    """Writes JSON, CSV, page and picture, as requested. A run that cannot be drawn keeps its JSON."""
    from . import plot

    def wanted(name):
        return options[name] or ""

    picture = wanted("plot")
    kept = wanted("json") or (picture + ".json" if picture and not draws else "")
    if kept:
        write(kept, json.dumps(run, ensure_ascii=False, indent=1) + "\n")
    if wanted("csv"):
        for name, text in csv_files(run).items():
            write(f"{wanted('csv')}_{name}.csv", text)
    if wanted("html"):
        page(run, wanted("html"), figure=draws)
        if not draws and run["shown"]["panels"]:
            print("the page has no figures: they need matplotlib (Debian: python3-matplotlib)")
    if not picture:
        return
    if not run["shown"]["panels"]:
        print("no picture: no point ended with a result to draw")
        return
    if not draws:
        raise Refused(f"option --plot: '{picture}' was not made; it needs matplotlib (Debian: python3-matplotlib); the sweep is in "
                      f"'{kept}', and this makes it later: python3 {shlex.quote(os.path.dirname(os.path.abspath(__file__)))} {shlex.quote(kept)} "
                      f"--plot {shlex.quote(picture)}")
    plot(run, picture)

"""The command: pictures and pages of a run's JSON."""

import argparse
import json
import os
import shutil
import subprocess
import sys

from . import Refused, page, panel, panel_names, plot, read
from .panels import pieces, unquoted
from .sweep import sweep
from .tables import cannot_write, csv_files, write

WITHOUT_MATPLOTLIB = 3


def find_matplotlib(arguments):
    """Is matplotlib here? If only another Python has it, that one replaces this process."""
    try:
        import matplotlib  # noqa: F401

        return True
    except ImportError:
        pass
    tried = os.environ.get("CATTANEO_TRIED_PYTHONS", "").split(":")
    here = os.path.dirname(os.path.abspath(__file__))
    for other in ("python3", "/usr/bin/python3"):
        if other in tried or not shutil.which(other):
            continue
        if subprocess.run([other, "-c", "import matplotlib"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            os.environ["CATTANEO_TRIED_PYTHONS"] = ":".join([*tried, other])
            os.execvp(other, [other, here, *arguments])
    return False


def of_sweep(file, arguments):
    """Runs the plan that a program wrote, and deletes the plan."""
    with open(file, encoding="utf-8") as text:
        plan = json.load(text)
    try:
        draws = bool(plan["options"]["plot"] or plan["options"]["html"]) and find_matplotlib(arguments)
    finally:
        os.unlink(file)
    return sweep(plan, draws)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Refused(message + " (-h lists the options)")


def main(arguments=None):
    arguments = sys.argv[1:] if arguments is None else arguments
    parser = Parser(
        prog="show", description="Draws a run of Cattaneo's programs, from the JSON that --json wrote. Without --plot, --html and --csv: the names of its panels.")
    parser.add_argument("run", metavar="RUN.json", nargs="?")
    parser.add_argument("--plot", metavar="FILE", help="picture: png, pdf or svg (needs matplotlib)")
    parser.add_argument("--panels", metavar="NAMES", help="panels of the picture, in this order, between blanks, those with blanks in quotes (default: all)")
    parser.add_argument("--each", action="store_true", help="a picture for each panel: FILE_panel.pdf of --plot FILE.pdf")
    parser.add_argument("--csv", metavar="PREFIX", help="each table and panel as a CSV file: PREFIX_name.csv")
    parser.add_argument("--html", metavar="FILE", help="page of the run (its figures need matplotlib; its slider, that the run had --html)")
    parser.add_argument("--sweep", metavar="PLAN", help=argparse.SUPPRESS)  # of a program's option --sweep
    try:
        options = parser.parse_args(arguments)
        if options.sweep:
            return of_sweep(options.sweep, arguments)
        if options.run is None:
            raise Refused("the file of a run must be named, which a program writes with --json RUN.json")
        draws = bool(options.plot or options.html) and find_matplotlib(arguments)
        run = read(options.run)
        if options.panels is not None and not options.plot and not options.csv:
            raise Refused("option --panels does nothing: it goes with --plot and --csv")
        if options.each and not options.plot:
            raise Refused("option --each does nothing: it goes with --plot")
        names = None if options.panels is None else [unquoted(name) for name in pieces("option --panels", options.panels, " \t,")]
        if options.csv:
            files = csv_files(run)
            for name in files if names is None else [one for one in names if panel(run, one)]:
                write(f"{options.csv}_{name}.csv", files[name])
        if options.html:
            page(run, options.html, figure=draws)
            if not run["shown"]["marches"] and "CATTANEO_PROGRAM" not in os.environ:
                print("the page has no slider over increments: the JSON of a run has them that was written with --html")
            if not draws and run["shown"]["panels"]:
                print("the page has no figures: they need matplotlib (Debian: python3-matplotlib)")
        if options.plot and not draws:
            if "CATTANEO_PROGRAM" not in os.environ:  # a program says it itself
                print("error: --plot needs matplotlib (Debian: python3-matplotlib)", file=sys.stderr)
            return WITHOUT_MATPLOTLIB
        if options.plot and options.each:
            base, end = os.path.splitext(options.plot)
            for name in panel_names(run) if names is None else names:
                plot(run, f"{base}_{name}{end}", [name])
        elif options.plot:
            plot(run, options.plot, names)
        if not options.plot and not options.html and not options.csv:
            print("\n".join(panel_names(run)))
    except (Refused, OSError, ValueError) as error:
        told = cannot_write(error.filename, error) if isinstance(error, OSError) and error.filename else error
        print(f"error: {told}", file=sys.stderr)
        return 1
    return 0

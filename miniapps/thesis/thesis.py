#!/usr/bin/env python3
"""./run thesis [options] [4 | 4.5 | "Table 2.1" ...]   figures and tables of the thesis, chapters 2 to 8, on one page

Without a part the whole, into results/thesis/index.html; with chapters or figures these alone, into a page
beside it. Runs are kept: a second call is quick. Ctrl-C leaves a page with what was made."""

import argparse
import importlib
import os
import pathlib
import re
import sys
import time

try:
    from runs import Run, Runs
    from page import page
except SystemExit:
    sys.exit("cattaneo: ./run thesis needs Python 3 with matplotlib (Debian: python3-matplotlib)")

CHAPTERS = [2, 3, 4, 5, 6, 7, 8]
HEADING = "Studies in partial slip contacts, computed anew"
ABOUT = """
This page goes through a doctoral thesis on frictional contact and fretting (A. Thaitirarot, *Studies in partial slip
contacts applied to fretting fatigue*, Oxford 2013), figure by figure, with curves that Cattaneo computed on
converged meshes. Every section says what its figure shows, and the command that makes it.

Tables compare with *references*: closed forms, and values found independently of this program, with their own ±. Values
are marked that are outside of it by more than the errors of the mesh and the increments of the run, which are known. Values of the thesis are those that its text states. In figures they are hollow diamonds. Where the thesis is
wrong, the reason stands below the table. Quantities are dimensionless as each chapter says.
"""


def chosen(parts):
    """Chapters with the figures that were asked for: by number, as the page calls them, or by what their numbers begin with
    (2.2 is 2.2a and 2.2b)."""
    chapters = [importlib.import_module(f"chapter{number}").CHAPTER for number in CHAPTERS]
    figures = [(chapter, figure) for chapter in chapters for figure in chapter.figures]
    wanted = []
    for part in parts:
        name = part.removeprefix("Figure ").removeprefix("Chapter ").strip()
        if not name:
            sys.exit(f"cattaneo: '{part}' is no part of the thesis, must be a chapter (4) or a figure (4.5)")
        found = [figure for chapter, figure in figures if name in (str(chapter.number), figure.number, figure.name)]
        found = found or [figure for _, figure in figures if re.match(re.escape(name) + r"(?!\d)", figure.number)]
        if not found:
            known = [str(chapter.number) for chapter in chapters] + [figure.number for _, figure in figures]
            sys.exit(f"cattaneo: the thesis has no chapter or figure '{part}'; there are " + ", ".join(known))
        wanted += found
    if parts:
        for chapter in chapters:
            chapter.figures = [figure for figure in chapter.figures if figure in wanted]
    return [chapter for chapter in chapters if chapter.figures]


def main():
    parser = argparse.ArgumentParser(prog="./run thesis", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="a chapter (4), a figure (4.5), or all whose numbers begin so (2.2)")
    parser.add_argument("--only", action="append", default=[], metavar="PART", help="the same")
    parser.add_argument("--list", action="store_true", help="figures and commands, without running anything")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time (default: the processors)")
    parser.add_argument("--folder", default="results/thesis", help="where the page and the kept runs go")
    parser.add_argument("--programs", default="build/release/miniapps", help="folder of the built miniapps")
    parser.error = lambda said: sys.exit(f"cattaneo: ./run thesis: {said} (--help lists the options)")  # bad input is 1
    options = parser.parse_args()
    if options.jobs < 1:
        sys.exit(f"cattaneo: --jobs is {options.jobs}, must be at least 1")
    parts = options.parts + options.only
    chapters = chosen(parts)
    if options.list:
        for chapter in chapters:
            for figure in chapter.figures:
                print(f"{figure.name}: {figure.title}" + (f"   (missing: {figure.missing})" if figure.missing else ""))
                for command in figure.commands:
                    print("    ./run " + command)
        return 0

    def say(text):
        print(text, file=sys.stderr, flush=True)

    lost = sorted({command.split()[0] for chapter in chapters for figure in chapter.figures for command in figure.commands
                   if not (pathlib.Path(options.programs) / command.split()[0]).is_file()})
    if lost:
        sys.exit(f"cattaneo: --programs is '{options.programs}', which has no {', '.join(lost)}: must be the folder of the built miniapps; "
                 "without it ./run thesis builds them")
    begun = time.monotonic()
    folder = pathlib.Path(options.folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        sys.exit(f"cattaneo: --folder is '{options.folder}', which cannot be made: {error.strerror}")
    runs = Runs(pathlib.Path(options.programs).resolve(), folder.resolve() / "runs", options.jobs, say)
    runs.make([command for chapter in chapters for figure in chapter.figures for command in figure.commands])

    def found(figure):
        its = [runs.done.get(command) or Run(command, None, 0, "it was stopped before it ran") for command in figure.commands]
        fault = next((f"./run {run.command}: {run.fault}" for run in its if run.fault), "")
        return its, fault

    if not parts:
        runs.forget_others()
    say("drawing")
    text, faults = page(chapters, found, HEADING, ABOUT)
    file = folder / (re.sub(r"[^\w.-]", "", "-".join(parts)) + ".html" if parts else "index.html")
    file.write_text(text, encoding="utf-8")
    for figure, fault in faults:
        say(f"missing: {figure.name}: {fault}")
    count = sum(len(chapter.figures) for chapter in chapters)
    say(f"{count - len(faults)} of {count} figures and tables are in {file}, after {time.monotonic() - begun:.0f} s")
    # In the whole a figure that is declared as missing is said so; one that was asked for, or should have been made, is a failure.
    return 2 if any(parts or not figure.missing for figure, _ in faults) else 0


if __name__ == "__main__":
    sys.exit(main())

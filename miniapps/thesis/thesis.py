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

Tables compare with *references*: closed forms, and values found independently of this program, with their own ±. What is
outside of it is marked; "within the mesh's ±" says that the mesh and the increments of the run, whose errors are known,
explain it. Values of the thesis are those that its text states; hollow diamonds are they in figures. Where it is
wrong, the reason stands below the table. Quantities are dimensionless as each chapter says.
"""


def chosen(parts):
    """Chapters with the figures that were asked for."""
    chapters = [importlib.import_module(f"chapter{number}").CHAPTER for number in CHAPTERS]
    if not parts:
        return chapters
    for part in parts:
        known = {str(chapter.number) for chapter in chapters} | {f.number for chapter in chapters for f in chapter.figures}
        if part not in known:
            sys.exit(f"cattaneo: the thesis has no chapter or figure '{part}'; there are " + ", ".join(sorted(known)))
    for chapter in chapters:
        if str(chapter.number) not in parts:
            chapter.figures = [figure for figure in chapter.figures if figure.number in parts]
    return [chapter for chapter in chapters if chapter.figures]


def main():
    parser = argparse.ArgumentParser(prog="./run thesis", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="a chapter (4) or a figure (4.5)")
    parser.add_argument("--only", action="append", default=[], metavar="PART", help="the same")
    parser.add_argument("--list", action="store_true", help="figures and commands, without running anything")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time (default: the processors)")
    parser.add_argument("--folder", default="results/thesis", help="where the page and the kept runs go")
    parser.add_argument("--programs", default="build/release/miniapps", help="folder of the built miniapps")
    options = parser.parse_args()
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

    begun = time.monotonic()
    folder = pathlib.Path(options.folder)
    runs = Runs(pathlib.Path(options.programs).resolve(), folder.resolve() / "runs", max(1, options.jobs), say)
    runs.make([command for chapter in chapters for figure in chapter.figures for command in figure.commands])

    def found(figure):
        its = [runs.done.get(command) or Run(command, None, 0, "it was stopped before it ran") for command in figure.commands]
        fault = next((f"./run {run.command}: {run.fault}" for run in its if run.fault), "")
        return its, fault

    if not parts:
        runs.forget_others()
    say("drawing")
    text, faults = page(chapters, found, HEADING, ABOUT)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / (re.sub(r"[^\w.-]", "", "-".join(parts)) + ".html" if parts else "index.html")
    file.write_text(text, encoding="utf-8")
    for figure, fault in faults:
        say(f"missing: {figure.name}: {fault}")
    count = sum(len(chapter.figures) for chapter in chapters)
    say(f"{count - len(faults)} of {count} figures and tables are in {file}, after {time.monotonic() - begun:.0f} s")
    # A figure that is declared as missing is said so; one that should have been made and was not is a failure.
    return 2 if any(not figure.missing for figure, _ in faults) else 0


if __name__ == "__main__":
    sys.exit(main())

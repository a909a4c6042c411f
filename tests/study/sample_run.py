"""Runs a sample run of a miniapp's header in a folder of its own and compares its results.

sample_run.py EXPECTATIONS PROGRAM FOLDER SOURCE 'COMMAND LINE'

EXPECTATIONS (sample_runs.json) has a list for every command line: of numbers (words, null) at a
path of the --json output or in a row of the study's table of references, each within the
tolerance and with the source that both come from, none of which is the program; and of files
that are written, not empty, a CSV with so many rows below its header.
"""

import json
import pathlib
import shlex
import shutil
import subprocess
import sys


def found(results, expected):
    """What the program says, or a word for its absence."""
    if "row" in expected:
        rows = [r["computed"] for r in results.get("references", []) if r["quantity"] == expected["row"]]
        return rows[0] if len(rows) == 1 else f"{len(rows)} such rows"
    value = results
    for key in expected["path"].split("/")[1:]:
        try:
            value = value[int(key)] if isinstance(value, list) else value[key]
        except (KeyError, IndexError, ValueError, TypeError):
            return "nothing there"
    return value


def agrees(value, expected):
    wanted = expected["value"]
    if not isinstance(wanted, (int, float)) or isinstance(wanted, bool):
        return value == wanted and type(value) is type(wanted)
    return isinstance(value, (int, float)) and abs(value - wanted) <= expected["tolerance"]


def main():
    expectations, program, folder, source, sample = sys.argv[1:]
    expected = json.loads(pathlib.Path(expectations).read_text(encoding="utf-8"))[sample]
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for data in ("meshes", "miniapps", "problems"):  # that sample runs name
        (folder / data).symlink_to(pathlib.Path(source) / data)
    run = subprocess.run([program, *shlex.split(sample)[1:], "--json", "results.json"], cwd=folder,
                         text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    wrong = run.returncode != 0
    if wrong:
        print(f"{run.stdout}\nexit code {run.returncode}")
    else:
        results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
        for row in results.get("references", []):  # what is printed and what is stored say the same
            said = row["verdict"].startswith("outside")
            if row["outside"] != said:
                wrong = True
                print(f"WRONG  {row['quantity']}: outside is {row['outside']}, printed is '{row['verdict']}'")
    for one in expected if not wrong else []:
        if "file" in one:
            file = folder / one["file"]
            text = file.read_bytes() if file.is_file() else b""
            value = text.count(b"\n") - 1 if "rows" in one else len(text)
            right = value == one["rows"] if "rows" in one else value > 0
            wanted = f"{one['rows']} rows" if "rows" in one else "not empty"
        else:
            value = found(results, one)
            right = agrees(value, one)
            wanted = f"{one['value']} ± {one['tolerance']}" if "tolerance" in one else one["value"]
        wrong = wrong or not right
        name = one.get("row") or one.get("path") or one["file"]
        print(f"{'ok   ' if right else 'WRONG'}  {name}: {value}, expected {wanted} ({one['source']})")
    sys.exit(wrong or not expected)


main()

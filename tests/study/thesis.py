"""thesis.py SOURCE PROGRAMS FOLDER: the page of ./run thesis, of a few cheap figures.

Every figure and table of the thesis has its section or is named as missing; the page needs nothing from elsewhere; the
numbers of its tables are those of the runs; a second call runs nothing; what is not there is told."""

import html
import json
import pathlib
import re
import shutil
import subprocess
import sys

# The thesis' own lists of figures and tables, chapters 2 to 8; of 8.2 its five proposals.
FIGURES = {
    2: "1 2a 2b 3 4 5a 5b 5c 6 7 8a 8b 8c 9a 9b 9c 10a 10b 10c", 3: "1 2 3 4a 4b 5 6 7 8 9 10a 10b 11 12", 4: " ".join(map(str, range(1, 20))),
    5: "1a 1b 2 3a 3b 4 5 6 7a 7b 7c", 6: "1 2a 2b 3 4 5 6a 6b 7 8a 8b 9a 9b 10 11", 7: " ".join(map(str, range(1, 18)))}
OTHERS = ["Table 2.1", *(f"8.2 ({k})" for k in range(1, 6))]
PARTS = sys.argv[4:] or ["2.3", "2.6", "2.7", "3.6", "4.1", "4.3", "4.4", "5.4", "6.3", "7.6", "7.7"]
# Rows that the page itself computes: reference, its ± (or half of the last digit shown) and value of the thesis (studies' notes D; notes on
# chapter 2; A is where the threshold is just met).
STATED = {"K_I,max/ΔK_th at A, f = 0.8": (1, 5e-5, "–"), "K_I,max/ΔK_th at A, f = 0.3": (1, 5e-5, "–"),
          "Y at X = 0.2, f = 0.8": (1.178838, 5e-5, "–"), "Y at X = 0.2, f = 0.3": (2.276629, 5e-5, "–"),
          "first tension of the bonded disc at r/b, a = 0.5": (0.971, 0.005, "0.65")}


def python():
    for name in ("python3", "/usr/bin/python3"):
        if shutil.which(name) and subprocess.run([name, "-c", "import matplotlib"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return name
    print("skipped: there is no Python with matplotlib")
    sys.exit(77)


def rows(page):
    """(section, cells) of the rows of all tables."""
    page = re.sub(r'<tbody class="plain">.*?</tbody>', "", page, flags=re.S)  # of data, not of references
    for section in re.findall(r'<section id="(.*?)">(.*?)</section>', page, re.S):
        for row in re.findall(r"<tr>(<td>.*?)</tr>", section[1], re.S):
            cells = [re.sub("<sub>(.*?)</sub>", r"_\1", cell) for cell in re.findall(r"<td>(.*?)</td>", row, re.S)]
            yield section[0], [html.unescape(re.sub("<.*?>", "", cell)) for cell in cells]


def main():
    source, programs, folder = map(pathlib.Path, sys.argv[1:4])
    shutil.rmtree(folder, ignore_errors=True)
    call = [python(), str(source / "miniapps/thesis/thesis.py"), "--programs", str(programs), "--folder", str(folder)]

    def run(*words):
        return subprocess.run([*call, *words], text=True, capture_output=True, check=False)

    listed = run("--list").stdout
    for name in [f"Figure {c}.{k}" for c, numbers in FIGURES.items() for k in numbers.split()] + OTHERS:
        assert re.search(rf"^(Figure )?{re.escape(name)}: ", listed, re.M), f"{name} has no section"

    made = run(*PARTS)
    assert made.returncode == 0, made.stderr
    file = folder / ("-".join(PARTS).replace(" ", "") + ".html")
    page = file.read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and page.rstrip().endswith("</html>")
    # Nothing from elsewhere: no address but those of the page itself and of images in it.
    for address in re.findall(r'(?:src|href|url)\s*[=(]\s*["\']?([^"\')\s>]+)', page):
        assert address.startswith(("#", "data:image/")), address
    assert "<script" not in page and "@import" not in page
    sections = re.findall(r"<h3>(.*?): ", page)
    assert len(sections) == len(PARTS) and page.count("data:image") == len(PARTS), sections
    assert "Missing: " not in page

    # Each row is one of a run's table of references, to the digits shown. Marked is what neither its ± nor the mesh's explains.
    known = {}
    for results in folder.glob("runs/*/run.json"):
        for row in json.loads(results.read_text(encoding="utf-8")).get("references", []):
            known.setdefault(row["quantity"], []).append(row)
    count = 0
    for section, (quantity, reference, _, thesis, computed, difference, mark) in rows(page):
        if quantity in STATED:
            value, spread, stated = STATED[quantity]
            assert thesis == stated and abs(float(computed) - value) <= spread and not mark, (quantity, computed)
            continue
        right = [row for row in known[quantity] if f"{row['computed']:.5g}" == computed]
        assert right, (section, quantity, computed)
        row = right[0]
        assert reference == ("–" if row["reference"] is None else f"{row['reference']:.5g}"), (quantity, reference)
        assert thesis == ("–" if row["thesis"] is None else f"{row['thesis']:.4g}"), (quantity, thesis)
        # A closed form has no ±, so that the mesh alone may explain a difference.
        off = row["reference"] is not None and abs(row["computed"] - row["reference"]) > max(row["spread"] or 0, row["tolerance"] or 0)
        assert bool(mark) == off and (row["outside"] or not off), (quantity, mark)
        if row["reference"] is not None:
            assert difference == f"{row['computed'] - row['reference']:+.2g}", (quantity, difference)
        count += 1
    assert count >= 10, count

    again = run(*PARTS)
    assert again.returncode == 0 and "runs are kept" in again.stderr and "./run " not in again.stderr, again.stderr
    strange = run("4.99")
    assert strange.returncode == 1 and "no chapter or figure '4.99'" in strange.stderr, strange.stderr
    # A name as the page has it, and what numbers begin with: all parts of a figure, none of 6.10.
    for words, names in (("Figure 6.5", ["6.5"]), ("2.2", ["2.2a", "2.2b"]), ("6.1", ["6.1"]), ("8.2", [f"8.2 ({k})" for k in range(1, 6)])):
        some = re.findall(r"^Figure (.*?):", run("--list", words).stdout, re.M)
        assert some == names, (words, some)
    for words, said in ((["--jobs", "0", "6.1"], "--jobs is 0"), ([""], "'' is no part"), (["--jobs", "x"], "invalid int"), (["--nope"], "--nope"), (["--folder", "/dev/null/there", "6.1"], "cannot be made")):
        bad = run(*words)
        assert bad.returncode == 1 and said in bad.stderr and len(bad.stderr.splitlines()) == 1, bad.stderr
    nowhere = subprocess.run([*call[:3], str(folder / "nowhere"), "6.4"], text=True, capture_output=True, check=False)
    assert nowhere.returncode == 1 and "which has no lap_joint" in nowhere.stderr and len(nowhere.stderr.splitlines()) == 1, nowhere.stderr
    # A program that fails leaves a page that says so.
    broken = folder / "programs"
    broken.mkdir()
    for program in programs.iterdir():
        if program.is_file():
            (broken / program.name).write_text("#!/bin/sh\necho 'error: nothing works today' >&2\nexit 1\n", encoding="utf-8")
            (broken / program.name).chmod(0o755)
    failed = subprocess.run([*call[:3], str(broken), "--folder", str(folder / "failed"), "4.4"], text=True, capture_output=True, check=False)
    assert failed.returncode == 2 and "nothing works today" in (folder / "failed/4.4.html").read_text(encoding="utf-8"), failed.stderr
    print(f"{len(PARTS)} figures, {count} rows")


main()

"""Pictures and pages are made from the JSON of a run by cattaneo_show, at once or later; where that cannot be the JSON stands."""

import json
import os
import subprocess
import sys

import pytest

from programs import ROOT

SHOW = ROOT / "python" / "cattaneo_show"
HERTZ = ["-nodes", "33"]


def show(*words, code=0, **environment):
    """The reader, run by the Python that programs run it with, or by another one that it finds to have matplotlib."""
    done = subprocess.run(["python3", SHOW, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, env={**os.environ, **environment})
    assert done.returncode == code, done.stdout
    return done.stdout


def program(run, *words, path, code):
    """What hertz prints where the only Python is the one of this path."""
    done = subprocess.run([run.programs / "hertz", *HERTZ, *map(str, words)], cwd=run.folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False, env={**os.environ, "PATH": str(path)})
    assert done.returncode == code, done.stdout
    return done.stdout


def refused(output, *words):
    """One sentence that holds all words."""
    error = output[output.index("error: "):]
    assert error.count("\n") == 1 and all(word in error for word in words), error
    return error


def bare_python(run):
    """A folder with a python3 that has no packages, and finds no other Python."""
    folder = run.folder / "bin"
    folder.mkdir()
    bare = folder / "python3"
    bare.write_text(f"#!/bin/sh\nCATTANEO_TRIED_PYTHONS=python3:/usr/bin/python3 exec '{sys.executable}' -S \"$@\"\n", encoding="utf-8")
    bare.chmod(0o755)
    return folder


@pytest.mark.rest
def test_what_is_drawn_later_is_the_same(run):
    """The picture and the page of a kept JSON are those that the run itself left; the JSON is no other with them."""
    kept, names = run.folder / "kept.json", ("now.svg", "now.html", "later.svg", "later.html")
    now, page, later, later_page = (run.folder / name for name in names)
    subprocess.run([run.programs / "hertz", *HERTZ, "--json", kept, "--plot", now, "--html", page], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    assert show(kept, "--plot", later, "--html", later_page) == ""

    def drawn(file):  # matplotlib writes the time, and names that are drawn by lot
        return [line for line in file.read_text(encoding="utf-8").splitlines() if "<path d=" in line or line.startswith("L ")]

    assert len(drawn(now)) > 100 and drawn(now) == drawn(later)
    data = [file.read_text(encoding="utf-8").split('id="run">')[1].split("</script>")[0] for file in (page, later_page)]
    assert data[0] == data[1] and json.loads(data[0])["films"], data[0][:200]
    assert sorted(file.name for file in run.folder.iterdir()) == sorted(["kept.json", *names])


@pytest.mark.rest
def test_panels_are_chosen_by_name(run):
    """Without options their names are listed; the chosen ones alone are drawn, and no others are known."""
    kept, picture = run.folder / "kept.json", run.folder / "one.svg"
    subprocess.run([run.programs / "march", "-case", "problems/sliders.case.json", "--json", kept], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    names = show(kept).splitlines()
    titles = {panel["name"]: panel["title"] for panel in json.loads(kept.read_text(encoding="utf-8"))["shown"]["panels"]}
    assert names == list(titles) and len(names) > 1
    show(kept, "--plot", picture, "--panels", f"'{names[-1]}'")
    text = picture.read_text(encoding="utf-8")
    assert f"<!-- {titles[names[-1]]} -->" in text and f"<!-- {titles[names[0]]} -->" not in text
    # A run that had no --html has kept no increments, which is said.
    assert "no slider" in show(kept, "--html", run.folder / "page.html")
    refused(show(kept, "--plot", picture, "--panels", "pressur", code=1), "no panel 'pressur'", names[0])
    refused(show(kept, "--panels", names[0], code=1), "--panels", "goes with --plot")
    # A picture and a table for each panel, for papers.
    assert show(kept, "--plot", run.folder / "of.pdf", "--each", "--csv", run.folder / "of", "--panels", f"'{names[0]}' '{names[1]}'") == ""
    for name in names[:2]:
        assert (run.folder / f"of_{name}.pdf").read_bytes()[:5] == b"%PDF-"
        table = (run.folder / f"of_{name}.csv").read_text(encoding="utf-8")
        assert f"# title: {titles[name]}\n" in table and len(table.splitlines()) > 8
    refused(show(kept, "--each", code=1), "--each", "goes with --plot")
    refused(show(kept, "--pannels", "x", code=1), "--pannels", "-h lists the options")
    for option, file in (("--plot", "x.png"), ("--html", "x.html"), ("--csv", "x")):
        refused(show(kept, option, run.folder / "no" / file, code=1), "no/x", "cannot be written: there is no folder", str(run.folder / "no"))


def test_tables_that_are_made_later_are_the_same(run):
    """With --csv alone the run leaves no JSON. A kept JSON gives the same files later, besides those that are written during the march."""
    line = [run.programs / "march", "-case", "problems/sliders.case.json", "--csv"]
    subprocess.run([*line, run.folder / "now"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([*line, run.folder / "other", "--json", run.folder / "kept.json"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    show(run.folder / "kept.json", "--csv", run.folder / "later")
    now, later = ({file.name.removeprefix(prefix): file.read_bytes() for file in run.folder.glob(prefix + "*")} for prefix in ("now", "later"))
    assert set(now) - set(later) == {"_history.csv", "_nodes.csv"} and "_zones.csv" in later, list(now)
    assert all(now[name] == text for name, text in later.items())
    zones = next(text.decode() for name, text in later.items() if name.startswith("_zones_in_time"))
    assert next(line for line in zones.splitlines() if line[0] != "#") == "time,state,from,to"


def test_what_is_no_run_is_refused(run):
    nothing, text, other = run.folder / "no.json", run.write("text.json", "x"), run.write("other.json", '{"a": 1}')
    for file, words in ((nothing, ["cannot be read"]), (text, ["is not JSON"]), (other, ["is not a run", "--json"])):
        refused(show(file, "--html", run.folder / "x.html", code=1), str(file), *words)
    assert not (run.folder / "x.html").exists()


def test_without_matplotlib_the_run_is_not_lost(run):
    """The page needs none; of a picture the JSON stands, and the sentence has the command that draws it later."""
    path = bare_python(run)
    made = program(run, "--html", "page.html", path=path, code=0)
    assert "no figures" in made, made
    page = run.text("page.html")
    assert "<svg width" in page and "matplotlib" not in page and not (run.folder / "page.html.json").exists()
    failed = program(run, "--plot", "picture.png", path=path, code=1)
    error = refused(failed, "option --plot", "'picture.png' was not made", "python3-matplotlib", "picture.png.json")
    assert json.loads(run.text("picture.png.json"))["status"] == "converged"
    later = error[error.index("python3 '"):].strip()
    subprocess.run(later, shell=True, check=True, cwd=run.folder)
    assert (run.folder / "picture.png").stat().st_size > 5000


def test_without_python_the_run_is_not_lost(run):
    empty = run.folder / "empty"
    empty.mkdir()
    for option, file, kept in (("--plot", "x.png", "x.png.json"), ("--html", "x.html", "x.html.json"), ("--csv", "x", "x.csv.json")):
        failed = program(run, option, file, path=empty, code=1)
        refused(failed, "option " + option, file, "needs Python 3", kept)
        assert json.loads(run.text(kept))["status"] == "converged" and not (run.folder / file).exists()
    # One sentence for all files that are missing.
    refused(program(run, "--plot", "z.png", "--csv", "z", path=empty, code=1), "'z_….csv' was not made", "'z.png' was not made", "--csv 'z' --plot 'z.png'")
    # What --json named is what stands.
    failed = program(run, "--json", "kept.json", "--plot", "y.png", path=empty, code=1)
    refused(failed, "'kept.json'")
    assert (run.folder / "kept.json").exists() and not (run.folder / "y.png.json").exists()


def test_without_python_nothing_is_compared(run):
    """The run ends as it should, says so, and its values are there; with Python they stand beside their references."""
    empty, kept = run.folder / "empty", run.folder / "kept.json"
    empty.mkdir()
    said = "nothing is compared with references: that needs Python 3"
    done = subprocess.run([run.programs / "hertz", "--json", kept], cwd=run.folder, stdout=subprocess.PIPE, text=True, check=True,
                          env={**os.environ, "PATH": str(empty)})
    assert said in done.stdout
    alone = json.loads(kept.read_text(encoding="utf-8"))
    assert alone["references"] == [] and alone["half_width"] > 0
    with_python = run("hertz")
    assert said not in with_python.output
    assert [row["computed"] for row in with_python["references"] if row["quantity"] == "half-width / b Hertz"] == [alone["half_width"]]


@pytest.mark.rest
def test_long_increments_are_in_a_file_beside_the_run(run):
    """The page that is drawn of it later has all of them; without that file the sentence names it."""
    kept, page, later = (run.folder / name for name in ("kept.json", "now.html", "later.html"))
    subprocess.run([run.programs / "hertz", "-nodes", "201", "-increments", "400", "--json", kept, "--html", page], cwd=ROOT, check=True,
                   stdout=subprocess.DEVNULL)
    frames = run.folder / "kept.json.frames"
    assert json.loads(kept.read_text(encoding="utf-8"))["shown"]["marches"] == frames.name and frames.stat().st_size > 1 << 20
    show(kept, "--html", later)
    data = [file.read_text(encoding="utf-8").split('id="run">')[1].split("</script>")[0] for file in (page, later)]
    assert data[0] == data[1] and len(json.loads(data[0])["films"][0]["frames"]) > 100
    frames.unlink()
    refused(show(kept, "--html", later, code=1), "kept.json.frames", "cannot be read")

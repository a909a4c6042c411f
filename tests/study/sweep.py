"""sweep.py PROGRAMS: the points of --sweep are those of single runs, in their order; outcomes are rows; Ctrl-C leaves what there is."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as each point has: sums in another order have other last bits
ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(sys.argv[1])


def run(program, *options, code=0):
    done = subprocess.run([PROGRAMS / program, *map(str, options)], cwd=ROOT, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    assert done.returncode == code, (options, done.returncode, done.stdout)
    return done.stdout


def read(file):
    return json.loads(file.read_text(encoding="utf-8"))


def agrees(folder):
    """A study's own options; all values are those of single runs, to the last bit."""
    out = folder / "s.json"
    run("square_punch", "-nodes", 33, "-shear", "0.5", "--sweep", "obstacle=rigid half-plane", "--sweep", "friction=0.2:0.6:3",
        "--json", out, "--csv", folder / "s", "--plot", folder / "s.png", "--html", folder / "s.html",
        "--sweep-results", "peak_pressure levels.0.stick_right")
    rows = read(out)["sweep"]
    order = [(obstacle, friction) for obstacle in ("rigid", "half-plane") for friction in (0.2, 0.4, 0.6)]
    assert [(row["obstacle"], row["friction"]) for row in rows] == order, rows
    for row in rows:
        run("square_punch", "-nodes", 33, "-shear", "0.5", "-obstacle", row["obstacle"], "-friction", row["friction"],
            "--json", folder / "one.json")
        one = read(folder / "one.json")
        assert row["status"] == "converged" and row["peak_pressure"] == one["peak_pressure"], (row, one["peak_pressure"])
        assert row["levels.0.stick_right"] == one["levels"][0]["stick_right"] is not None, row
    table = list(csv.DictReader((folder / "s_sweep.csv").open(encoding="utf-8")))
    assert [(line["obstacle"], float(line["friction"])) for line in table] == order
    assert (folder / "s.png").stat().st_size > 5000
    assert "half-plane" in (folder / "s.html").read_text(encoding="utf-8")


def outcomes(folder):
    """Gross sliding where Q > f P: that is a row, and the exit code says that there is one. A place in a history is swept."""
    case = folder / "case.json"
    case.write_text(json.dumps({"reduced": str(ROOT / "problems/hertz.json"), "history": ["P=0", "P=1", "Q=0.1"],
                                "sweep": ["friction=0.2 0.4", "history.2.Q=0.1:0.26:3"]}), encoding="utf-8")
    out = folder / "o.json"
    shown = run("march", "--case", case, "--json", out, code=2)
    results = read(out)
    assert "(P = 1, Q = 0.2)" in shown, shown
    assert "5 of 6 points converged" in shown and results["status"] == "ended early", shown
    for row in results["sweep"]:
        holds = row["history.2.Q"] < row["friction"]
        assert row["status"] == ("converged" if holds else "gross sliding"), row
        assert (row["message"] == "") == holds, row
        assert ("event_loads" in row) != holds and (row["event_time"] is None) == holds, row
        if not holds: # it slides at Q = f P
            assert abs(row["event_loads"]["Q"] - row["friction"]) < 1e-6, row
        if holds: # equilibrium
            assert abs(row["tangential_force"] + row["history.2.Q"] * row["normal_force"]) < 1e-12, row
    # A case of contact, by keys of a body and of an interface.
    run("contact", "--case", "meshes/dovetail.json", "--cycles", 1, "--sweep", "bodies.root.young=100 200", "--sweep", "interfaces.flank.friction=0.2 0.3",
        "--json", out)
    pressures = [row["peak_pressure"] for row in read(out)["sweep"]]
    assert len(set(pressures)) == 4, pressures
    # What a case file shows of its sweep; a result with a blank in its name.
    case.write_text(json.dumps({"reduced": str(ROOT / "problems/hertz.json"), "history": ["P=0", "P=1", "Q=0.1", "Q=-0.1", "Q=0.1"],
                                "cycle-start": 2, "sweep": "friction=0.2 0.4", "sweep-results": "'cycles.0.loss_factor Q' \"cycles.0.work Q\""}),
                    encoding="utf-8")
    run("march", "--case", case, "--json", out)
    for row in read(out)["sweep"]:
        run("march", "--case", case, "--sweep", "none", "--friction", row["friction"], "--json", folder / "one.json")
        cycle = read(folder / "one.json")["cycles"][0]
        assert cycle["work Q"] > 0 and all(row["cycles.0." + key] == cycle[key] for key in ("work Q", "loss_factor Q")), (row, cycle)
    # An amplitude is in several places.
    ways = ["march", "-reduced", "problems/hertz.json", "-cycle-start", "2", "-history"]
    key = "history.2.Q,-history.3.Q,history.4.Q"
    run(*ways, "P=0; P=1; Q=0.1; Q=-0.1; Q=0.1", "--sweep", key + "=0.1:0.2:2", "--sweep-results", "total_dissipation", "--json", out)
    for row in read(out)["sweep"]:
        q = row[key]
        run(*ways, f"P=0; P=1; Q={q}; Q={-q}; Q={q}", "--json", folder / "one.json")
        assert row["total_dissipation"] == read(folder / "one.json")["total_dissipation"] > 0, row
    assert "must be a number" in run(*ways, "P=0; P=1; Q=0.1; Q=-0.1; Q=0.1", "--sweep", "-friction=much", code=1)
    # Names of loads with commas, blanks and = are in quotes, where they are swept and beside that.
    bolts = " ".join(f"'bolt {k}, w = 1'={1 if k < 3 else 0.9}" for k in (1, 2, 3))
    key = "history.1.'bolt 3, w = 1'"
    run("march", "-reduced", "problems/bolt_row.json", "-history", f"T=0; {bolts}", "--sweep", key + "=0.9 1", "--json", out)
    last = read(out)["sweep"]
    assert [row[key] for row in last] == [0.9, 1], last
    run("march", "-reduced", "problems/bolt_row.json", "-history", f"T=0; {bolts}; T=0.01", "--sweep", "history.2.T=0 0.01", "--json", out)
    assert [row["peak_pressure"] for row in read(out)["sweep"]][0] == last[0]["peak_pressure"], (read(out)["sweep"], last)

    # A limit that is found is an outcome as good as any.
    shown = run("shakedown", "--reduced", "problems/square_punch.json", "--find", "load", "--sweep", "friction=0.8 0.9", "--json", out)
    assert [row["status"] for row in read(out)["sweep"]] == 2 * ["certified"] and "points converged" not in shown, shown
    hertz = ["-reduced", "problems/hertz.json", "-history", "P=0; P=1; Q=0.1"]
    # A misspelt result is said at the first point, and what was computed stays.
    shown = run("march", *hertz, "--sweep", "friction=0.2 0.3", "--sweep-results", "peak_presure normal_force",
                "--json", out, code=2)
    assert "the first point that ended has no number or word of the name 'peak_presure'" in shown and "must be one of" in shown, shown
    results = read(out)
    assert results["status"] == "ended early" and "'peak_presure', must be one of" in results["message"], results
    assert all(isinstance(row["normal_force"], float) for row in results["sweep"]), results["sweep"]
    # Where no point has any result that is asked for, there is nothing to be kept.
    shown = run("march", *hertz, "--sweep", "friction=0.2 0.3", "--sweep-results", "nonsense", code=1)
    assert "error: option --sweep-results: no point has" in shown and "'nonsense', must be one of" in shown, shown


def refused():
    """One sentence, before anything is run."""
    hertz = ["-reduced", "problems/hertz.json", "--sweep"]
    for sweep, words in (("frction=0.2", "there is no option 'frction'"), ("friction=0.2 -1", "option --friction is -1"),
                         ("friction=0.2 much", "'much' is not a number"), ("friction", "must be KEY=VALUE"),
                         ("friction=", "has no values"), ("friction=0:1:1", "at least 2"), ("increments=1.5", "not an integer"),
                         ("method=newton", "'newton' is not one of"), ("history.4.Q=1", "has 0 entries"), ("friction.1=2", "has no entries"),
                         ("json=a b", "there is no option 'json'"), ("sweep=a", "there is no option 'sweep'"),
                         ("friction=0.1; friction=0.2", "'friction' is there twice"),
                         ("history.1.'P=1", "is not closed")):
        begun = time.monotonic()
        shown = run("march", *hertz, sweep, code=1)
        error = shown[shown.index("error:"):]
        assert words in error and error.count("\n") == 1, (sweep, error)
        assert time.monotonic() - begun < 5
    # A value that is none, not the figure that there can't be.
    assert "'x' is not a number" in run("march", *hertz, "friction=0.1 x", "--plot", "nowhere.png", code=1)
    assert "a key with two values or more, all of them numbers" in run("march", *hertz, "stepping=exact fixed", "--plot", "nowhere.png", code=1)
    assert "--check checks one run" in run("march", *hertz, "friction=0.2", "--check", code=1)
    for option in ("--save", "--save-state"):
        assert "a sweep has many" in run("march", *hertz, "friction=0.2", option, "nowhere.json", code=1)
    # What only the runs themselves can tell: no row, if it is all of them.
    shown = run("march", *hertz, "friction=0.2 0.3", "-history", "P=0; R=1", code=1)
    assert "every point of the sweep is refused" in shown and "there is no load 'R'" in shown, shown


def interrupted(folder):
    """What has been computed stays, what was running says that it was stopped, and no process is left."""
    out = folder / "i.json"
    sweep = subprocess.Popen([PROGRAMS / "lap_joint", "-all-cycles", "-spacing", "0.05", "--sweep",
                              "cycles=2 3 4 100000:100199:200", "--json", out], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                             start_new_session=True)

    def of_cycles(number):
        """Runs of points of this sweep that are going on."""
        return subprocess.run(["pgrep", "-s", str(sweep.pid), "-f", f"lap_joint.* --?cycles {number}( |$)"], stdout=subprocess.PIPE, check=False).stdout

    try:
        begun = time.monotonic()
        while of_cycles("[234]") or not of_cycles("100[01][0-9][0-9]"):
            assert sweep.poll() is None and time.monotonic() - begun < 60
            time.sleep(0.1)
        time.sleep(0.5)
        sweep.send_signal(signal.SIGINT)
        assert sweep.wait(60) == 2
        results = read(out)
        states = [row["status"] for row in results["sweep"]]
        assert results["status"] == "stopped" and 3 < len(states) < 203, results
        assert states[:3] == 3 * ["converged"] and set(states[3:]) == {"stopped"}, states
        left = of_cycles("100[01][0-9][0-9]")
        assert not left, left
    finally:  # a test that fails leaves nothing behind either
        subprocess.run(["pkill", "-KILL", "-s", str(sweep.pid)], check=False)


with tempfile.TemporaryDirectory() as name:
    agrees(pathlib.Path(name))
    outcomes(pathlib.Path(name))
    refused()
    interrupted(pathlib.Path(name))

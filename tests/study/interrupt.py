"""interrupt.py PROGRAMS PROBLEMS: Ctrl-C leaves what was computed, and a march goes on from there as if nothing had
happened; progress is shown on a terminal and nowhere else."""

import concurrent.futures
import csv
import json
import math
import os
import pathlib
import pty
import signal
import subprocess
import sys
import tempfile
import time

# Minutes, if nobody interrupts them. How many iterations a limit takes nobody knows: it shows no share.
LONG = {"lap_joint": "-all-cycles -cycles 100000 -spacing 0.05",
        "axisymmetric_receding": "-twist-cycles 10000 -amplitude 0.6 -spacing 0.05",
        "shakedown": "-nodes 401 -map"}


def interrupted(program, options, folder, terminal, seconds=None):
    """What is left of a run that is interrupted once it shows progress, or after some seconds: exit code, stdout,
    what it showed, results, and when it was interrupted."""
    results = folder / "results.json"
    results.unlink(missing_ok=True)
    ours, theirs = pty.openpty() if terminal else os.pipe()
    os.set_blocking(ours, False)
    shown, start = b"", time.monotonic()
    with open(folder / "out", "w", encoding="utf-8") as out:
        run = subprocess.Popen([program, *options.split(), "--json", str(results), "--csv", str(folder / "i")], stdout=out, stderr=theirs)
        os.close(theirs)
        while (b" steps, " not in shown) if terminal else time.monotonic() < start + seconds:
            assert run.poll() is None, f"{program} ended by itself: " + (folder / "out").read_text(encoding="utf-8")
            assert time.monotonic() < start + 60, f"{program} shows no progress"
            time.sleep(0.05)
            shown += read(ours)
        took = time.monotonic() - start
        run.send_signal(signal.SIGINT)
        code = run.wait(60)
    shown += read(ours)
    os.close(ours)
    return (code, (folder / "out").read_text(encoding="utf-8"), shown.decode(),
            json.loads(results.read_text(encoding="utf-8")), took)


def read(source):
    """All that there is now."""
    found = b""
    try:
        while chunk := os.read(source, 65536):
            found += chunk
    except OSError:  # nothing yet, or a terminal whose other side is closed
        pass
    return found


def check(programs, program, options):
    seconds = None
    with tempfile.TemporaryDirectory() as folder:
        # A limit shows progress late, and in a pipe it is as quiet as the others.
        for terminal in (True,) if program == "shakedown" else (True, False):
            code, out, shown, results, took = interrupted(str(programs / program), options, pathlib.Path(folder), terminal, seconds)
            seconds = took + 1
            assert code == 2, (program, code, out)
            assert results["status"] == "stopped", (program, results["status"])
            assert "topped" in out, (program, out)
            assert (" steps, " in shown and ("%" in shown or program == "shakedown")) if terminal else shown == "", (program, terminal, shown)
            assert " steps, " not in out, (program, out)
            if program != "shakedown":  # two points of the load's history a cycle, after all that the study marched before
                before = [row[0] for row in rows(pathlib.Path(folder) / "i_history.csv")[1:] if row[1] == 0][-1]
                whole = int((results["event_time"] - before) / 2)
                assert len(results["dissipation"]) == len(results["cycles"]) == whole > 0, (program, whole, len(results["cycles"]))


def rows(file):
    """Rows of a CSV file; cells that are numbers become numbers."""
    def value(cell):
        try:
            return float(cell)
        except ValueError:
            return cell
    with open(file, encoding="utf-8") as text:
        return [[value(cell) for cell in row] for row in csv.reader(text)]


# Each step has its own, which are judged when it is accepted.
RESIDUALS = ("residual_normal", "residual_tangential", "round_off")


def alike(one, other):
    """Are two results the same? A path that is taken up has a new factor, and agrees to round-off."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(alike(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(alike, one, other))
    return one == other or (isinstance(one, float) and math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-12))


def check_going_on(programs, problems):
    """A march that is interrupted within a cycle and gone on with writes the tables of one that was not."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def march(name, *options, after=None, state="last"):
            # The first third of the time goes by before its first cycle.
            run = subprocess.Popen([programs / "march", "--reduced", problems / "punch_on_half_plane.json", "--history", "P=0; P=1; Q=.2; Q=-.2; Q=.2",
                                    "--cycle-start", "2", "--cycles", "3", "--increments", "3000", "--csv", folder / name, "--json", folder / f"{name}.json",
                                    "--save-state", folder / state, *options], stdout=subprocess.PIPE, text=True, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
            if after is not None:
                time.sleep(after)
                run.send_signal(signal.SIGINT)
            out, _ = run.communicate(timeout=120)
            assert run.returncode == 0 or after is not None and run.returncode in (2, -signal.SIGINT), (name, run.returncode, out)
            return json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) if run.returncode != -signal.SIGINT else {}

        begun = time.monotonic()
        whole = march("whole")
        took = time.monotonic() - begun
        for share in (0.55, 0.45, 0.65, 0.75, 0.35, 0.55, 0.55):  # how quickly it goes on depends on what else runs
            cut = march("cut", after=share * took, state="first").get("event_time", 0)
            if cut > 2 and cut % 2:
                break
        else:
            raise AssertionError(f"never interrupted within a cycle, at last at {cut}")
        rest = march("cut", "--load-state", folder / "first")
        for key in ("first_cycle", "steady_cycle", "steady_period", "time", "zones", "total_dissipation"):
            assert alike(rest[key], whole[key]), (key, cut, rest[key], whole[key])
        assert len(whole["cycles"]) > 1
        for table in ("cycles", "history", "nodes"):
            one, other = rows(folder / f"whole_{table}.csv"), rows(folder / f"cut_{table}.csv")
            assert len(one) == len(other), (table, cut, len(one), len(other))
            for a, b in zip(one, other):
                assert len(a) == len(b), (table, cut, a, b)
                assert all(name in RESIDUALS or alike(x, y) for name, x, y in zip(one[0], a, b)), (table, cut, a, b)


def main():
    programs, problems = map(pathlib.Path, sys.argv[1:])
    check_going_on(programs, problems)
    with concurrent.futures.ThreadPoolExecutor() as pool:  # most of the time is waiting
        for done in [pool.submit(check, programs, program, options) for program, options in LONG.items()]:
            done.result()


main()

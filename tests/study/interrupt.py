"""interrupt.py PROGRAMS: Ctrl-C leaves what was computed; progress is shown on a terminal and nowhere else."""

import concurrent.futures
import json
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
        "axisymmetric_receding": "-cycles 10000 -amplitude 0.6 -spacing 0.05",
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
        run = subprocess.Popen([program, *options.split(), "--json", str(results)], stdout=out, stderr=theirs)
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
            if program != "shakedown":  # two points of the load's history a cycle, after the tightening or from the start
                whole = int((results["event_time"] - (program == "lap_joint")) / 2)
                assert len(results["dissipation"]) == len(results["cycles"]) == whole > 0, (program, whole, len(results["cycles"]))


def main():
    programs = pathlib.Path(sys.argv[1])
    with concurrent.futures.ThreadPoolExecutor() as pool:  # most of the time is waiting
        for done in [pool.submit(check, programs, program, options) for program, options in LONG.items()]:
            done.result()


main()

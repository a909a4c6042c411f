"""Runs of the miniapps: each once, several at a time, kept by their command and the program that made them."""

import hashlib
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(SOURCE / "python"))
from cattaneo_show import panels  # noqa: E402


class Run:
    """The results of a command, `json`, with its panels, or why there is nothing."""

    def __init__(self, command, folder, seconds, fault=""):
        self.command, self.folder, self.seconds, self.fault = command, folder, seconds, fault
        self.json = {}
        if not fault:
            self.json = json.loads((folder / "run.json").read_text(encoding="utf-8"))

    def __getitem__(self, key):
        """A result by its key; parts of it behind dots, rows of tables by their number."""
        found = self.json
        for part in key.split("."):
            found = found[int(part)] if isinstance(found, list) else found[part]
        return found

    def panel(self, name):
        """Words and rows of a panel, as cattaneo_show.panel() gives them."""
        return panels.panel(self.json, name)

    def series(self, name):
        """Curves of a panel of lines: {series: (x, y)}."""
        curves = {}
        for (series, _), points in panels.series_of(*self.panel(name)).items():
            curves.setdefault(series, ([], []))
            for axis, value in zip(curves[series], zip(*points)):
                axis += value
        return curves

    def rows(self, table, **fixed):
        """Rows of a table of the results, those with the fixed values of some columns."""
        return [row for row in self.json.get(table) or []
                if all(row[key] is not None and abs(row[key] - value) < 1e-9 for key, value in fixed.items())]

    def column(self, table, key, **fixed):
        return [nan(row[key]) for row in self.rows(table, **fixed)]

    def references(self):
        return self.json.get("references", [])


def nan(value):
    return float("nan") if value is None else value


class Runs:
    """Runs commands ("shakedown -map") with the programs of a build. What is kept is the folder of a run; its name
    is the hash of the command, the program and the shipped data."""

    def __init__(self, programs, folder, jobs, say):
        self.programs, self.folder, self.jobs, self.say = pathlib.Path(programs), pathlib.Path(folder), jobs, say
        self.done, self.processes, self.stopped = {}, set(), False
        self.lock = threading.Lock()
        self.digests = {}
        data = hashlib.sha256()
        for file in sorted((HERE.parent / "data").iterdir()):
            data.update(file.read_bytes())
        self.data = data.digest()

    def key(self, command):
        name = command.split()[0]
        if name not in self.digests:
            self.digests[name] = hashlib.sha256((self.programs / name).read_bytes()).digest()
        return hashlib.sha256(self.digests[name] + self.data + command.encode()).hexdigest()[:16]

    def make(self, commands):
        """Makes those that are not there yet, the ones that took longest the last time first. Ctrl-C ends what runs
        and leaves the rest undone."""
        known = self.folder / "seconds.json"
        try:
            seconds = json.loads(known.read_text())
        except (OSError, ValueError):
            seconds = {}
        for command in list(dict.fromkeys(commands)):
            kept = self.folder / self.key(command)
            if (kept / "seconds").exists():
                try:
                    self.done[command] = Run(command, kept, float((kept / "seconds").read_text()))
                except (OSError, ValueError):  # cut off when it was written: once more
                    shutil.rmtree(kept, ignore_errors=True)
        left = [command for command in dict.fromkeys(commands) if command not in self.done]
        left.sort(key=lambda command: -seconds.get(command, 5))
        total, begun = len(left), time.monotonic()
        if len(self.done):
            self.say(f"{len(self.done)} runs are kept from before")
        try:
            with ThreadPoolExecutor(self.jobs) as pool:
                waiting = {pool.submit(self.run, command) for command in left}
                try:
                    count = 0
                    while waiting:
                        finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                        for future in finished:
                            run, count = future.result(), count + 1
                            self.done[run.command] = run
                            seconds[run.command] = round(run.seconds, 2)
                            self.say(f"[{count:3d}/{total}, {time.monotonic() - begun:4.0f} s] {run.seconds:6.1f} s  ./run "
                                     f"{run.command}" + (f"\n      {run.fault}" if run.fault else ""))
                except KeyboardInterrupt:
                    self.stop()
                    raise
        except KeyboardInterrupt:
            self.say("stopped: the page has what was made by now")
        self.folder.mkdir(parents=True, exist_ok=True)
        known.write_text(json.dumps(seconds, indent=1, sort_keys=True) + "\n")

    def forget_others(self):
        """Removes runs of other commands and of former programs."""
        kept = {run.folder.name for run in self.done.values() if run.folder}
        for folder in self.folder.iterdir():
            if folder.is_dir() and folder.name not in kept:
                shutil.rmtree(folder)

    def stop(self):
        with self.lock:
            self.stopped = True
            for process in self.processes:
                process.send_signal(signal.SIGKILL)

    def run(self, command):
        words = shlex.split(command)
        target = self.folder / self.key(command)
        part = target.with_suffix(".part")
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir(parents=True)
        begun = time.monotonic()
        with open(part / "output.txt", "w", encoding="utf-8") as output:
            with self.lock:
                if self.stopped:
                    return Run(command, part, 0, "it was stopped before it ran")
                process = subprocess.Popen(
                    [str(self.programs / words[0]), *words[1:], "--json", str(part / "run.json")],
                    stdout=output, stderr=subprocess.STDOUT, cwd=SOURCE, start_new_session=True,
                    env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
                self.processes.add(process)
            code = process.wait()
        with self.lock:
            self.processes.discard(process)
        seconds = time.monotonic() - begun
        lines = (part / "output.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
        if self.stopped:
            shutil.rmtree(part, ignore_errors=True)
            return Run(command, part, seconds, "it was stopped")
        if code not in (0, 2) or not (part / "run.json").exists():
            return Run(command, part, seconds, f"it ended with code {code}: " + (lines[-1] if lines else "no output"))
        (part / "seconds").write_text(f"{seconds:.2f}\n")
        shutil.rmtree(target, ignore_errors=True)
        part.rename(target)
        return Run(command, target, seconds)

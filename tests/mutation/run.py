#!/usr/bin/python3
"""Single-line faults, drawn over the library's executed lines, and which of them the tests notice.

    ./test --mutation                  the list of the fixed seed: a table by room, exit code 2 if a goal is missed
    ./test --mutation -sample 10       ten of it; exit code 2 if fewer than six of the ten are noticed
    ./test --mutation -core            the core and its tests alone: nothing of MFEM is brought, built or used
    ./test --mutation -list            what would be drawn, without building or running
    ./test --mutation -fault 17        one fault by its number: what every test that reaches it says

A pool of faults a room is compiled into a copy of the sources behind one switch (environment variable
CATTANEO_FAULT), so that one build serves all; a trace of every test says which faults it reaches; the list is the
first of those reached, in an order that the seed draws over operators and then over lines. A fault is noticed when a
test that reaches it fails, crashes or takes ten times as long. `equivalent.json` names those of the list that cannot
change anything that is stated, each with the reason; they are not counted."""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pickle
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.append("/usr/lib/python3/dist-packages")
import faults  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CORE = "-core" in sys.argv
HOME = os.path.join(ROOT, "build", "mutation-core" if CORE else "mutation")
SOURCE, BUILD = os.path.join(HOME, "source"), os.path.join(HOME, "build")
LIBRARY = "plugin"
KINDS = ["core"] if CORE else ["core", "unit", "verification", "study", "stress"]
MEMORY = 6 << 30
# A sample is small: of ten faults of which nine in ten are noticed, fewer than six would be by chance once in 600.
GOAL, ROOM_GOAL, SAMPLE_GOAL = 0.9, 0.8, 0.6

SWITCH = """#pragma once
#if defined(__GNUC__)
extern "C" int cattaneo_fault_switch; // the fault that is on; 0: none; -1: reached ones are written down
extern "C" bool cattaneo_fault_reached(int);
inline bool cattaneo_fault(int k)
{
   return cattaneo_fault_switch == k || (cattaneo_fault_switch < 0 && cattaneo_fault_reached(k));
}
#endif
"""
SWITCH_SOURCE = """#include <atomic>
#include <cattaneo/fault_switch.hpp>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <unistd.h>
int cattaneo_fault_switch = 0;
static int trace = -1;
static std::atomic<bool> seen[100000];
__attribute__((constructor(101))) static void read_switch()
{
   if (const char *fault = std::getenv("CATTANEO_FAULT")) { cattaneo_fault_switch = std::atoi(fault); }
   if (const char *file = std::getenv("CATTANEO_FAULT_TRACE"))
   {
      trace = open(file, O_WRONLY | O_CREAT | O_APPEND, 0644);
      cattaneo_fault_switch = -1;
   }
}
bool cattaneo_fault_reached(int k)
{
   if (seen[k].exchange(true)) { return false; }
   const std::string line = std::to_string(k) + "\\n";
   if (write(trace, line.data(), line.size()) < 0) { std::abort(); }
   return false;
}
"""


def say(text):
    print(text, flush=True)


def sha(data):
    return hashlib.sha256(data).hexdigest()


def room_of(file):
    parts = file.split("cattaneo/")[1].split("/")
    return parts[0] if len(parts) > 1 else "root"


def write_changed(path, data):
    """Files that do not change keep their time, and are not built again."""
    if os.path.exists(path) and open(path, "rb").read() == data:
        return
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as out:
        out.write(data)


def tracked():
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    return [f for f in listed if f and os.path.isfile(os.path.join(ROOT, f))]


def copy_sources(edits):
    """The tree as it is, with `edits` (file -> points) behind the switch."""
    kept = set()
    for file in tracked():
        data = open(os.path.join(ROOT, file), "rb").read()
        if edits.get(file):
            data = faults.rewritten(data, edits[file])
        write_changed(os.path.join(SOURCE, file), data)
        kept.add(os.path.join(SOURCE, file))
    for name, text in (("fault_switch.hpp", SWITCH), ("fault_switch.cpp", SWITCH_SOURCE)):
        write_changed(os.path.join(SOURCE, LIBRARY, "cattaneo", name), text.encode())
        kept.add(os.path.join(SOURCE, LIBRARY, "cattaneo", name))
    for folder, _, names in os.walk(SOURCE):
        for name in names:
            path = os.path.join(folder, name)
            if path not in kept and "/results/" not in path:
                os.remove(path)


def configure(options):
    # Tests that start programs are pytest's; ./test --mutation brings it.
    pytest = [] if CORE else ["-DCATTANEO_PYTEST=" + os.path.join(ROOT, "build", "deps", "python", "bin", "python")]
    cache = os.path.join(BUILD, "CMakeCache.txt")
    known = open(cache).read() if os.path.exists(cache) else ""
    if not os.path.exists(os.path.join(BUILD, "build.ninja")) or any(option[2:].split("=")[1] not in known for option in pytest):
        say("configuring")
        command = ["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                   "-DCATTANEO_BENCHMARKS=OFF", "-DCMAKE_UNITY_BUILD=ON",
                   "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"]
        command += ["-DCATTANEO_MFEM=OFF" if CORE else "-DMFEM_DIR=" + options.mfem, *pytest]
        if shutil.which("ccache"):
            command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache")
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def compiled():
    """(command, sources) of all that is compiled; a unity build compiles several sources as one."""
    for entry in json.load(open(os.path.join(BUILD, "compile_commands.json"))):
        file = entry["file"]
        yield entry["command"], re.findall(r'#include "(.+?)"', open(file).read()) if "/Unity/" in file else [file]


def parser_arguments():
    """The library's flags as libclang wants them, with the long headers read once."""
    arguments, pair = ["-x", "c++", "-w"], ""
    # Core is compiled without MFEM, and each library with flags of its own: what both have goes for both.
    for word in " ".join(c for c, files in compiled() if f"/{LIBRARY}/" in files[0]).split():
        if pair and word not in arguments:
            arguments += [pair, word]
        elif re.match(r"-[DI]|-std", word) and word not in arguments:
            arguments.append(word)
        pair = word if word == "-isystem" else ""
    header = os.path.join(HOME, "long_headers.hpp")
    text = ("" if CORE else "#include <mfem.hpp>\n") + "#include <Eigen/Dense>\n"
    write_changed(header, text.encode())
    # Made anew by every run: a header read once is not valid any more when a package has been installed again.
    ready = os.path.join(HOME, "long_headers.pch")
    unit = faults.clang.Index.create().parse(header, args=["-x", "c++-header"] + arguments[2:], options=2)
    if errors := [str(d) for d in unit.diagnostics if d.severity >= faults.clang.Diagnostic.Error]:
        raise RuntimeError(f"{header} cannot be parsed: {errors[0]}")
    unit.save(ready)
    return arguments + ["-include-pch", ready]


def parallel(function, jobs, processes):
    with concurrent.futures.ProcessPoolExecutor(processes) as pool:
        return list(pool.map(function, jobs))


def remembered_points(files, arguments, processes):
    """The points of all files; a file is parsed again when it, a header or the operators change."""
    texts = {f: open(os.path.join(ROOT, f), "rb").read() for f in files}
    arguments = [a.replace(SOURCE, ROOT) for a in arguments]
    common = hashlib.sha256(open(faults.__file__, "rb").read() + b"".join(texts[f] for f in files if f.endswith(".hpp")))

    def key(file):
        own = common.copy()
        own.update(file.encode() + texts[file])
        return own.hexdigest()

    memory = os.path.join(HOME, "points.pickle")
    known = pickle.load(open(memory, "rb")) if os.path.exists(memory) else {}
    missing = [f for f in files if key(f) not in known]
    found = parallel(faults.points, [(f, os.path.join(ROOT, f), arguments) for f in missing], processes)
    known.update({key(f): points for f, points in zip(missing, found)})
    known = {key(f): known[key(f)] for f in files}
    write_changed(memory, pickle.dumps(known))
    return [known[key(f)] for f in files]


def draw_pool(options, arguments):
    """Points in the seed's order, room by room: round the operators, one point a line, at most `pool` a room."""
    files = [f for f in tracked() if f.startswith(LIBRARY + "/") and f.endswith((".cpp", ".hpp"))]
    if CORE:  # what it is built of, and the headers of these
        built = {file for _, files in compiled() for file in files}
        files = [f for f in files if os.path.join(SOURCE, f[:-4].replace("/private/", "/") + ".cpp") in built]
    found = remembered_points(files, arguments, options.jobs)
    rooms = {}
    for point in (p for points in found for p in points):
        rooms.setdefault(room_of(point.file), []).append(point)
    order = {}
    for room in sorted(rooms):
        counts, lanes = {}, {}
        for point in rooms[room]:
            counts[point.key()] = counts.get(point.key(), 0) + 1
            lanes.setdefault(point.operator, []).append((faults.rank(point, options.seed, counts[point.key()]), point))
        # Each operator's points by rank; the operators by the rank of their n-th points, round after round.
        rounds = {}
        for lane in lanes.values():
            for n, entry in enumerate(sorted(lane, key=lambda e: e[0])):
                rounds.setdefault(n, []).append(entry)
        order[room] = [e[1] for n in sorted(rounds) for e in sorted(rounds[n], key=lambda e: e[0])]
    return order, len(files)


def first_of_each_line(points, count):
    chosen, lines = [], set()
    for point in points:
        if (point.file, point.line) not in lines and len(chosen) < count:
            lines.add((point.file, point.line))
            chosen.append(point)
    return chosen


def instrument(options, arguments, order):
    """The pool compiled in; what does not compile goes, and the next come up."""
    unfit_file = os.path.join(HOME, "unfit.json")
    unfit = {tuple(k) for k in json.load(open(unfit_file))} if os.path.exists(unfit_file) else set()
    built = os.path.join(HOME, "built.json")
    checked = json.load(open(built)) if os.path.exists(built) else {}
    for _ in range(12):
        pool = []
        for room in order:
            pool += first_of_each_line([p for p in order[room] if p.key() not in unfit], options.pool)
        edits = {}
        for number, point in enumerate(pool, 1):
            point.number = number
            edits.setdefault(point.file, []).append(point)
        copy_sources(edits)
        # libclang is quick and finds nearly all; it need not look at a file twice.
        bad, now = set(), {f: sha(open(os.path.join(SOURCE, f), "rb").read()) for f in edits}
        jobs = [(f, os.path.join(SOURCE, f), arguments) for f in sorted(edits) if now[f] != checked.get(f)]
        checked = now
        for lines in parallel(faults.errors, jobs, options.jobs):
            bad |= lines
        if not bad:
            say(f"building with {len(pool)} faults behind the switch")
            log = os.path.join(HOME, "build.log")
            targets = [kind + "_tests" for kind in options.kinds.split(",")]
            rest = [kind + "_rest_tests" for kind in options.kinds.split(",")]
            targets += [t for t in rest if f"\nbuild {t}: " in open(os.path.join(BUILD, "build.ninja")).read()]
            targets += ["campaign"] if "stress" in options.kinds else []
            targets += ["miniapps"] if "study" in options.kinds else []  # which pytest runs
            with open(log, "w") as out:
                failed = subprocess.run(["ninja", "-C", BUILD, "-k", "0", "-j", str(options.jobs), *targets], stdout=out,
                                        stderr=subprocess.STDOUT).returncode
            if not failed:
                write_changed(built, json.dumps(now).encode())
                return {p.number: p for p in pool}
            for m in re.finditer(r"(%s/\S+?):(\d+):\d+: error" % LIBRARY, open(log).read()):
                bad.add((m[1], int(m[2])))
        dropped = {p.key() for p in pool if any((p.file, n) in bad for n in range(p.line, p.last + 1))}
        if not dropped:
            sys.exit(f"mutation: the copy does not build for another reason than a fault: {bad} (see {HOME}/build.log)")
        say(f"{len(dropped)} faults do not compile and are drawn again")
        unfit |= dropped
        checked = {f: keys for f, keys in checked.items() if f not in {g for g, _ in bad}}
        write_changed(unfit_file, json.dumps(sorted(unfit)).encode())
    sys.exit("mutation: faults that do not compile do not come to an end")


class Tests:
    """All tests, and what is known of test × fault: remembered as long as neither changes."""

    def __init__(self, options, pool):
        self.options = options
        self.file = os.path.join(HOME, "known.jsonl")
        self.lock = threading.Lock()
        self.known, self.checked = {}, {}
        self.checking = threading.Lock()
        if os.path.exists(self.file):
            for line in open(self.file):
                key, *value = json.loads(line)
                self.known[key] = value
        listed = json.loads(subprocess.run(["ctest", "--test-dir", BUILD, "-C", "All", "--show-only=json-v1"], check=True,
                                           capture_output=True, text=True).stdout)
        everything = hashlib.sha256()
        for file in tracked():
            if file.startswith((LIBRARY, "miniapps", "meshes", "problems", "tests/support")) or \
               file.endswith((".hpp", "programs/programs.py")):
                everything.update(open(os.path.join(SOURCE, file), "rb").read())
        self.tests = {}
        for test in listed["tests"]:
            properties = {p["name"]: p["value"] for p in test.get("properties", [])}
            label = (properties.get("LABELS") or [""])[0]
            if label not in options.kinds.split(",") or "command" not in test or properties.get("DISABLED") or test["name"].endswith(".long"):
                continue
            own = everything.copy()
            own.update(self.text_of(label, test["name"]))
            self.tests[test["name"]] = (test["command"], properties.get("WORKING_DIRECTORY", BUILD), own.hexdigest()[:20])

    def text_of(self, label, name):
        """The text of the file that holds a test, or of all of its kind."""
        folder = os.path.join(SOURCE, "tests", label)
        texts = [open(os.path.join(folder, f), "rb").read() for f in sorted(os.listdir(folder))
                 if f.endswith(".cpp")]
        suite = name.split(".")[0].split("/")[-1]
        # Contact.BadInput is in programs/contact_test.py.
        words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", suite).lower()
        script = os.path.join(SOURCE, "tests", "programs", words + "_test.py")
        if label == "study" and os.path.exists(script):
            texts.append(open(script, "rb").read())
            its = [t for t in texts if re.search(rb"\bTEST(_F)?\(%s," % suite.encode(), t)]
            return b"".join([texts[-1], *its])
        own = [t for t in texts if re.search(rb"\b(TEST|TEST_F|TEST_P)\(%s," % suite.encode(), t)]
        return b"".join(own or texts)

    def run(self, name, fault=0, limit=900.0):
        """(failed, seconds, reached faults) of a test with a fault on, or with none and the trace."""
        command, folder, key = self.tests[name]
        key = f"{key} {name} {fault}"
        if key in self.known:
            return self.known[key]
        scratch = tempfile.mkdtemp(prefix="cattaneo-fault-")
        trace = os.path.join(scratch, "trace")
        environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", TEST_TMPDIR=scratch + "/", TMPDIR=scratch)
        environment.update({"CATTANEO_FAULT": str(fault)} if fault else {"CATTANEO_FAULT_TRACE": trace})

        def limits():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        start = time.time()
        with open(os.path.join(scratch, "log"), "w") as log:
            process = subprocess.Popen(command, cwd=folder, env=environment, stdout=log, stderr=log,
                                       stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=limits)
            try:
                failed = process.wait(limit) != 0
            except subprocess.TimeoutExpired:
                failed = True
            try:
                os.killpg(process.pid, signal.SIGKILL)  # a study's program may still run
            except ProcessLookupError:
                pass
            process.wait()
        seconds = time.time() - start
        reached = sorted({int(n) for n in open(trace)}) if os.path.exists(trace) else []
        with open(os.path.join(scratch, "log"), errors="replace") as log:
            if "[  SKIPPED ]" in log.read() and not fault:
                reached = []
        shutil.rmtree(scratch, ignore_errors=True)
        with self.lock:
            self.known[key] = [failed, seconds, reached]
            with open(self.file, "a") as out:
                out.write(json.dumps([key, failed, seconds, reached]) + "\n")
        return self.known[key]

    def steady(self, name):
        """A test that noticed something is asked once whether it still passes without a fault."""
        with self.checking:
            if name not in self.checked:
                key = f"{self.tests[name][2]} {name} 0"
                was = self.known.pop(key)
                self.checked[name] = not self.run(name)[0]
                self.known[key] = was
            return self.checked[name]


def clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def trace_all(tests, jobs):
    """fault -> [(seconds, test)], and the tests that fail without a fault."""
    reach, broken, start = {}, [], time.time()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = {pool.submit(tests.run, name): name for name in tests.tests}
        for done, future in enumerate(concurrent.futures.as_completed(results), 1):
            failed, seconds, reached = future.result()
            if failed:
                broken.append(results[future])
            else:
                for fault in reached:
                    reach.setdefault(fault, []).append((seconds, results[future]))
            if done % 100 == 0 or done == len(results):
                say(f"  traced {done} of {len(results)} tests, {clock(time.time() - start)}")
    return reach, broken


def judge(tests, fault, reaching, budget, everything=False):
    """The test that notices the fault, seconds spent, and the tests for which the time did not suffice."""
    spent, noticed, left = 0.0, [], 0
    for seconds, name in sorted(reaching):
        if spent + seconds > budget:
            left += 1
            continue
        failed, took, _ = tests.run(name, fault, limit=10 * seconds + 10)
        spent += took
        if failed and tests.steady(name):
            noticed.append(name)
            if not everything:
                break
    return noticed, spent, left


def excused(point, named):
    for entry in named:
        if (entry["file"], entry["line"], entry["operator"], entry["change"]) == point.key():
            return entry["reason"]
    return None


def table(verdicts):
    say(f"\n{'room':12}{'drawn':>7}{'noticed':>9}{'unnoticed':>11}{'equivalent':>12}{'share':>8}")
    missed, total = [], [0, 0, 0, 0]
    for room in sorted({v["room"] for v in verdicts}):
        own = [v for v in verdicts if v["room"] == room]
        count = [len(own)] + [sum(v["verdict"] == w for v in own) for w in ("noticed", "unnoticed", "equivalent")]
        total = [a + b for a, b in zip(total, count)]
        share = count[1] / max(1, count[1] + count[2])
        if share < ROOM_GOAL and count[2]:
            missed.append(room)
        say(f"{room:12}{count[0]:7}{count[1]:9}{count[2]:11}{count[3]:12}{share:8.0%}")
    share = total[1] / max(1, total[1] + total[2])
    say(f"{'all':12}{total[0]:7}{total[1]:9}{total[2]:11}{total[3]:12}{share:8.0%}")
    return missed, share


def show(v):
    return f"{v['fault']:4}  {v['file']}:{v['line']}  {v['operator']}: {v['change']}"


def main():
    parser = argparse.ArgumentParser(prog="./test --mutation", description=__doc__, add_help=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("-h", "-help", action="help", help="say this")
    add("-mfem", help=argparse.SUPPRESS)
    add("-seed", type=int, default=1, help="another list of faults (default: 1)")
    add("-per-room", type=int, default=8, help="faults of each room (default: 8)")
    add("-pool", type=int, default=12, help="faults of each room that are compiled in, from which the list comes (default: 12)")
    add("-core", action="store_true", help="the core and its tests alone, without MFEM")
    add("-sample", type=int, metavar="N", help="N of the list, the same for the same seed; fails (exit code 2) only if "
        "fewer than six in ten of them are noticed, goals are not asked for")
    add("-fault", type=int, metavar="K", help="only fault number K, with all tests that reach it")
    add("-room", help="only this room's")
    add("-list", action="store_true", help="only the candidates in their order; nothing is built")
    add("-budget", type=float, default=60, help="seconds of tests for one fault, quickest first; tests left out are counted (default: 60)")
    add("-kinds", default=",".join(KINDS), help="kinds of tests that are asked (default: %(default)s)")
    add("-jobs", type=int, default=2, help="processes (default: 2)")
    options = parser.parse_args()
    begin = time.time()
    os.makedirs(HOME, exist_ok=True)
    if not os.path.exists(os.path.join(BUILD, "build.ninja")):
        copy_sources({})
    configure(options)
    arguments = parser_arguments()
    order, files = draw_pool(options, arguments)
    say(f"{sum(map(len, order.values()))} points in {files} files")
    if options.list:
        for room in order:
            for point in first_of_each_line(order[room], options.per_room):
                say(f"{point.file}:{point.line}  {point.operator}: {point.change}")
        return 0
    pool = instrument(options, arguments, order)
    tests = Tests(options, pool)
    say(f"tracing {len(tests.tests)} tests")
    reach, broken = trace_all(tests, options.jobs)
    drawn, count = [], {}
    for number, point in sorted(pool.items()):
        room = room_of(point.file)
        if number in reach and count.get(room, 0) < options.per_room:
            count[room] = count.get(room, 0) + 1
            drawn.append(number)
    if options.room:
        drawn = [n for n in drawn if room_of(pool[n].file) == options.room]
    if options.sample:
        drawn = sorted(random.Random(options.seed).sample(drawn, min(options.sample, len(drawn))))
    if options.fault:
        if options.fault not in pool:
            sys.exit(f"mutation: there is no fault {options.fault}, the last is {len(pool)}")
        drawn = [options.fault]
    named = json.load(open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "equivalent.json")))
    say(f"{len(pool)} faults compiled in, {sum(n in reach for n in pool)} reached, {len(drawn)} drawn")
    verdicts, start = [], time.time()

    def examine(number):
        point = pool[number]
        reason = excused(point, named)
        verdict = {"fault": number, "room": room_of(point.file), "file": point.file, "line": point.line,
                   "text": point.text, "operator": point.operator, "change": point.change}
        if reason and not options.fault:
            return dict(verdict, verdict="equivalent", reason=reason)
        noticed, spent, left = judge(tests, number, reach.get(number, []), options.budget, bool(options.fault))
        return dict(verdict, verdict="noticed" if noticed else "unnoticed", by=noticed, seconds=round(spent, 1),
                    tests=len(reach.get(number, [])), tests_left=left)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as workers:
        # Those that few seconds of tests reach come first.
        rooms_mixed = sorted(drawn, key=lambda n: sum(s for s, _ in reach.get(n, [])))
        for done, future in enumerate(concurrent.futures.as_completed([workers.submit(examine, n) for n in rooms_mixed]), 1):
            v = future.result()
            verdicts.append(v)
            spent = time.time() - start
            say(f"{done:4}/{len(drawn)} {clock(spent)}, about {clock(spent / done * (len(drawn) - done))} left  "
                f"{v['verdict']:10} {show(v)}" + (f"  [{', '.join(v['by'])}]" if v.get("by") else ""))
    verdicts.sort(key=lambda v: v["fault"])
    unsteady = [name for name, good in tests.checked.items() if not good]
    missed, share = table(verdicts)
    for title, which in (("equivalent", "equivalent"), ("unnoticed", "unnoticed")):
        own = [v for v in verdicts if v["verdict"] == which]
        if own:
            say(f"\n{title}:")
        for v in own:
            say(show(v) + (f"\n      {v['reason']}" if which == "equivalent" else
                           f"  ({v['tests']} tests, {v['seconds']} s" +
                           (f", {v['tests_left']} slow ones left out)" if v["tests_left"] else ")")))
    drawn_keys = {p.key() for p in pool.values()}
    stale = [e for e in named if (e["file"], e["line"], e["operator"], e["change"]) not in drawn_keys]
    if stale and options.seed == 1:
        say(f"\nequivalent.json names {len(stale)} that are not in the pool any more:")
        for e in stale:
            say(f"      {e['file']}: {e['line']}: {e['change']}")
    for name in broken:
        say(f"\nleft out, fails without a fault: {name}")
    for name in unsteady:
        say(f"\nleft out, does not always pass without a fault: {name}")
    with open(os.path.join(HOME, "report.json"), "w") as out:
        json.dump({"seed": options.seed, "faults": verdicts, "broken": broken, "unsteady": unsteady,
                   "share": share, "rooms_missed": missed}, out, indent=1)
    say(f"\n{clock(time.time() - begin)} in all; {os.path.relpath(HOME, ROOT)}/report.json")
    if options.sample:
        return 2 if share < SAMPLE_GOAL else 0
    return 0 if options.fault else 2 if missed or share < GOAL else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""This library and other programs on the same problems: runs the peers that are installed, says which are not, prints
tables. docs/peers.md says what is compared, and how fairly.

    python3 benchmarks/peers/peers.py [--build build/release] [--picture profile.png] [--times times.png]
                                      [condensation|studies|space|cycles|solvers]...

Peers: CalculiX (Debian: calculix-ccx), GetFEM (python3-getfem), Siconos numerics (libsiconos-numerics-dev). Times are CPU
seconds of whole processes with one thread; python3-matplotlib draws the pictures."""
import argparse
import csv
import glob
import json
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, HERE)
import calculix  # noqa: E402
from calculix import solids  # noqa: E402

PUNCH = {"stick half-width": 0.471, "corner slip": 0.0496, "stick end at Q": -0.203}
LAP = {"contact half-length": 0.7011, "contact half-length at T": 0.6596, "stick half-length at T": 0.760 * 0.6596}
LIMIT = 240  # seconds of CPU for one run of a peer

# Loading and cycles, over meshes: the length that is compared after loading with its reference, the steady loss of a cycle
# with its own (STUDIES of Hertz have none), and how the programs are asked.
CYCLES = (0, 1, 10, 100)
CYCLING = {
    "punch": {"length": "stick end at Q", "reference": -0.203, "loss": 9.17e-4, "getfem": ((1, 40), (1, 80), (2, 40)),
              "ours": ((1, 41), (1, 81), (2, 41))},
    "lap_joint": {"length": "contact half-length at T", "reference": 0.6596, "loss": 1.938e-4,
                  "getfem": ((1, 0.05), (1, 0.025), (2, 0.05)), "ours": ((1, 0.05), (1, 0.025), (2, 0.05))},
    "hertz": {"length": "stick half-length", "reference": 0.4 ** 0.5, "loss": None,
              "getfem": ((1, 40), (1, 80), (2, 40)), "ours": ((1, 41), (1, 81), (2, 41))}}


def ours(build, program, options, keys):
    """One of our studies as a process: CPU seconds, MB, dofs, and the named results."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "r.json")
        process = subprocess.Popen([os.path.join(build, "miniapps", program)] + options.split() + ["--json", file],
                                   stdout=subprocess.DEVNULL, env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        with open(file) as f:
            results = json.load(f)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, results["dofs"], {k: get(results) for k, get in keys.items()}


def line(program, mesh, seconds, memory, dofs, values, references):
    errors = "  ".join("%9.4f %+6.2f%%" % (values[k], 100 * (values[k] / r - 1)) for k, r in references.items())
    print("%-10s %-26s %8d %9.3f %7.0f  %s" % (program, mesh, dofs, seconds, memory, errors), flush=True)


def table(title, references):
    """Values beside the reference and their difference from it."""
    title += "; references: " + ", ".join("%s %g" % (k, r) for k, r in references.items())
    print("\n%s\n%-10s %-26s %8s %9s %7s  %s" % (title, "", "mesh", "dofs", "CPU s", "MB",
          "  ".join("%18s" % k[:18] for k in references)))


def peer(deck, read, name, folder):
    position = deck(folder, name)
    result, output = calculix.run(folder, name, LIMIT)
    if result is None:
        errors = [text.strip() for text in output.split("\n") if "*ERROR" in text]
        return None, errors[0] if errors else "ended without results"
    return result, read(result, position)


def studies(build):
    has_ccx = shutil.which("ccx") is not None
    if not has_ccx:
        print("CalculiX (ccx) is not installed: its rows are missing")
    table("Square punch on a rigid plane, f = 0.2: P in 5 increments, then Q = 0.5 fP in 10", PUNCH)
    keys = {"stick half-width": lambda r: r["stick_right"], "corner slip": lambda r: abs(r["slip_edge"]),
            "stick end at Q": lambda r: r["levels"][0]["stick_right"]}
    for order, intervals in ((1, 20), (1, 40), (1, 80), (2, 20), (2, 40), (2, 80)):
        seconds, memory, dofs, values = ours(build, "square_punch", "-shear 0.5 -increments 10 -grading 0.05 -order %d -nodes %d"
                                             % (order, order * intervals + 1), keys)
        line("ours", "order %d, %d edges" % (order, intervals), seconds, memory, dofs, values, PUNCH)
    cases = ((1, 20, 50), (1, 40, 50), (1, 40, 500), (1, 80, 50), (2, 20, 50))
    for order, intervals, penalty in cases if has_ccx else ():
        calculix.PENALTY = penalty
        with tempfile.TemporaryDirectory() as folder:
            result, values = peer(lambda f, n: calculix.punch(f, order, intervals, n), calculix.punch_results, "punch", folder)
        mesh = "order %d, %d edges, k %d" % (order, intervals, penalty)
        if result is None:
            print("%-10s %-26s %s" % ("CalculiX", mesh, values))
        else:
            line("CalculiX", mesh, result["seconds"], result["MB"], result["dofs"], values, PUNCH)
    table("Lap joint, f = 0.2: pinched in 5 increments, pulled by T = 0.04 in 10 (ours: 20, and back)", LAP)
    keys = {"contact half-length": lambda r: r["a0"], "contact half-length at T": lambda r: r["a"],
            "stick half-length at T": lambda r: r["c_first"]}
    for order, spacing in ((1, 0.05), (1, 0.025), (2, 0.05), (2, 0.025)):
        seconds, memory, dofs, values = ours(build, "lap_joint", "-cycles 1 -order %d -spacing %g" % (order, spacing), keys)
        line("ours", "order %d, h = %g" % (order, spacing), seconds, memory, dofs, values, LAP)
    calculix.PENALTY = 50
    for order, spacing in ((1, 0.05), (1, 0.025), (2, 0.05)) if has_ccx else ():
        with tempfile.TemporaryDirectory() as folder:
            result, values = peer(lambda f, n: calculix.lap_joint(f, order, spacing, n), calculix.lap_joint_results, "lap", folder)
        mesh = "order %d, h = %g, k 50" % (order, spacing)
        if result is None:
            print("%-10s %-26s %s" % ("CalculiX", mesh, values))
        else:
            line("CalculiX", mesh, result["seconds"], result["MB"], result["dofs"], values, LAP)


def our_case(build, case, columns):
    """A case of `contact` as a process: CPU seconds, MB, results, and its contact nodes at each time."""
    with tempfile.TemporaryDirectory() as folder:
        for name, body in case["bodies"].items():
            with open(os.path.join(folder, name + ".msh"), "w") as f:
                f.write(solids.gmsh_text(body["mesh"]))
            body["mesh"] = name + ".msh"
        with open(os.path.join(folder, "case.json"), "w") as f:
            json.dump({"version": 2, "analysis": "space", "order": 1, **case}, f)
        run = subprocess.Popen([os.path.join(build, "miniapps", "contact"), "--case", os.path.join(folder, "case.json"), "--csv",
                                os.path.join(folder, "c"), "--frames", "1 2", "--json", os.path.join(folder, "r.json")], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, env=dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1"))
        output = run.stdout.read()
        _, status, usage = os.wait4(run.pid, 0)
        run.returncode = status
        if status:
            sys.exit(output)
        with open(os.path.join(folder, "r.json")) as f:
            results = json.load(f)
        with open(os.path.join(folder, "c_nodes.csv"), newline="") as f:
            nodes = [{key: float(value) for key, value in row.items() if key in columns}
                     for row in csv.DictReader(line for line in f if not line.startswith("# "))]
    times = {}
    for node in nodes:
        times.setdefault(node["time"], []).append(node)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, results, times


READ = ("time", "x", "y", "z", "p", "q1", "q2", "opening", "slip1", "slip2")


def our_sphere(build, across):
    pin, block = calculix.sphere_meshes(across)
    half, f = calculix.PRESS / 2, calculix.SPHERE_FRICTION
    guide = {"on": "far", "x": {"force": "Q", "value": calculix.SHEAR * f * half}, "y": "held", "z": {"force": "P", "value": -half}}
    steel = {"young": calculix.YOUNG, "poisson": 0}
    seconds, memory, results, times = our_case(build, {
        "bodies": {"pin": {"mesh": pin, "support": "cut:y", "guides": guide, **steel}, "block": {"mesh": block, "support": "cut:y far:xyz", **steel}},
        "interfaces": {"face": {"between": ["pin:contact", "block:contact,rim"], "friction": f}},
        "history": ["P=0", "P=1", "Q=1"], "increments": 10}, READ)
    line_of = [sorted((n for n in times[t] if abs(n["y"]) < 1e-9 and n["x"] > -1e-9), key=lambda n: n["x"]) for t in (1, 2)]
    shear = math.hypot(*(line_of[1][0][q] - line_of[0][0][q] for q in ("q1", "q2")))
    return seconds, memory, results["dofs"], calculix.sphere_lengths([n["x"] for n in line_of[0]], [n["p"] for n in line_of[0]], shear)


def our_slice(build, spacing):
    upper, lower = calculix.slice_meshes(spacing)
    steel, T, z = {"young": 0.91, "poisson": 0.3}, 0.04, (0, 0.1)
    hold = lambda x, y, c: " ".join("@%g,%g,%g:%s" % (x, y, at, c) for at in z)
    seconds, memory, results, times = our_case(build, {
        "bodies": {"upper": {"mesh": upper, "support": "wall:z " + hold(-16, 0.25, "y"), "load": "P pressure pinch 1; T traction pull %g 0 0" % (-2 * T), **steel},
                   "lower": {"mesh": lower, "support": "wall:z " + hold(16, -0.25, "y") + " " + hold(0, -0.5, "x"),
                             "load": "P pressure pinch 1; T traction pull %g 0 0" % (2 * T), **steel}},
        "interfaces": {"face": {"between": ["upper:face", "lower:face"], "friction": 0.2}},
        "history": ["P=0", "P=1", "T=1"], "increments": 10}, READ)
    pairs, tables = {}, []
    for t in (1, 2):
        row = sorted((n for n in times[t] if n["x"] > -1e-9 and abs(n["z"]) < 1e-9), key=lambda n: n["x"])
        tables.append(row)
    xs = [n["x"] for n in tables[0]]
    change = [math.hypot(*(b[v] - a[v] for v in ("slip1", "slip2"))) for a, b in zip(*tables)]
    opening = [[n["opening"] for n in row] for row in tables]
    return seconds, memory, results["dofs"], calculix.lap_lengths(xs, opening, change)


def space(build):
    """Meshes of hexahedra, which both programs read."""
    has_ccx = shutil.which("ccx") is not None
    if not has_ccx:
        print("CalculiX (ccx) is not installed: its rows are missing")
    for title, references, sizes, peers, ours_, deck, read in (
            ("Sphere on a block, f = 0.3, ν = 0, elements across 0.6 mm: P in 5 increments (ours: 10), then Q = 0.5 fP in 10", calculix.sphere_references(),
             (4, 6), ((6, 50),), our_sphere, calculix.sphere, calculix.sphere_results),
            ("Lap joint, a slice of hexahedra between walls: pinched in 5 increments (ours: 10), pulled in 10", LAP,
             (0.05, 0.025), ((0.05, 50), (0.025, 50)), our_slice, calculix.lap_slice, calculix.lap_joint_results)):
        table(title, references)
        for size in sizes:
            line("ours", "%g" % size, *ours_(build, size), references)
        for size, penalty in peers if has_ccx else ():
            calculix.PENALTY = penalty
            with tempfile.TemporaryDirectory() as folder:
                result, values = peer(lambda f, n: deck(f, size, n), read, "space", folder)
            mesh = "%g, k %d" % (size, penalty)
            if result is None:
                print("%-10s %-26s %s" % ("CalculiX", mesh, values))
            else:
                line("CalculiX", mesh, result["seconds"], result["MB"], result["dofs"], values, references)


def process(command, limit):
    """CPU seconds of a process and its output; None where it fails or takes more than `limit` seconds of CPU."""
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                           env=dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1"),
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1)))
    output = run.stdout.read()
    _, status, usage = os.wait4(run.pid, 0)
    run.returncode = status
    return (usage.ru_utime + usage.ru_stime, output) if status == 0 else (None, output)


def our_cycles(build, study, order, size, cycles):
    """CPU seconds, dofs, length after loading, loss of the last cycle."""
    program = lambda name: os.path.join(build, "miniapps", name)
    with tempfile.TemporaryDirectory() as folder:
        file, saved = os.path.join(folder, "r.json"), os.path.join(folder, "p.json")
        mesh = {"punch": "square_punch -grading 0.05 -increments 10 -order %d -nodes %d -shear %s" % (order, size, 0.5 if not cycles else "") +
                         (" -cycles %d -amplitude 0.8" % cycles if cycles else ""),
                "lap_joint": "lap_joint -increments 10 -order %d -spacing %g -all-cycles -cycles %d" % (order, size, max(cycles, 1)),
                "hertz": "hertz -increments 10 -order %d -nodes %d -shear 0.6" % (order, size)}[study].split(" ")
        seconds, _ = process([program(mesh[0])] + mesh[1:] + ["--json", file] + (["--save", saved] if study == "hertz" else []), LIMIT)
        with open(file) as f:
            r = json.load(f)
        if study == "hertz" and cycles:
            history = "P=0; P=1; P=1, Q=0.24; P=1, Q=-0.24; P=1, Q=0.24"
            more, _ = process([program("march"), "--reduced", saved, "--history", history, "--cycle-start", "2", "--cycles", str(cycles),
                               "--increments", "20"], LIMIT)
            seconds += more
    losses = [c["dissipation"] for c in r.get("cycles", [])]
    length = {"punch": lambda: r["levels"][0]["stick_right"] if not cycles else None, "lap_joint": lambda: r["a"],
              "hertz": lambda: r["levels"][0]["stick_half_width"]}[study]()
    return seconds, r["dofs"], length, losses[-1] if len(losses) > 1 else None


def getfem_cycles(study, order, size, cycles):
    seconds, output = process(["/usr/bin/python3", os.path.join(HERE, "getfem_peer.py"), study, str(order), str(size), str(cycles)], LIMIT)
    if seconds is None:
        return None
    r = json.loads(output.strip().split("\n")[-1])
    return seconds, r["dofs"], r[CYCLING[study]["length"]] if study != "punch" or not cycles else None, r["loss"] if cycles > 1 else None


def cycles(build, picture):
    """Error against run time of whole programs, loading alone and with cycles."""
    has_getfem = subprocess.run(["/usr/bin/python3", "-c", "import getfem"], stderr=subprocess.DEVNULL).returncode == 0
    if not has_getfem:
        print("GetFEM (python3-getfem) is not installed: its rows are missing")
    points = []
    for study, case in CYCLING.items():
        print("\n%s: %s %.4f%s; CPU s of loading alone and with cycles" % (study, case["length"], case["reference"],
              ", steady loss of a cycle %g" % case["loss"] if case["loss"] else ""))
        print("%-8s %-18s %8s %9s %9s " % ("", "mesh", "dofs", "length", "loss") + "".join("%10d" % n for n in CYCLES), flush=True)
        for name, ask in (("ours", lambda *at: our_cycles(build, study, *at)), ("GetFEM", lambda *at: getfem_cycles(study, *at))):
            for order, size in case["ours" if name == "ours" else "getfem"] if name == "ours" or has_getfem else ():
                dofs, errors, times = 0, {}, []
                for n in CYCLES:
                    found = ask(order, size, n) if None not in times else None
                    times.append(found[0] if found else None)
                    if not found:
                        continue
                    dofs = found[1]
                    for key, value, reference in (("length", found[2], case["reference"]), ("loss", found[3], case["loss"])):
                        if value is not None and reference:
                            errors[key] = 100 * (value / reference - 1)
                    quantity = "loss" if n > 1 and case["loss"] else "length"
                    if quantity in errors:
                        points.append({"study": study, "program": name, "cycles": n, "seconds": found[0], "quantity": quantity,
                                       "error": abs(errors[quantity]) / 100})
                shown = ["%+8.2f%%" % errors[k] if k in errors else "%9s" % "" for k in ("length", "loss")]
                print("%-8s %-18s %8d %s %s " % (name, "order %d, %g" % (order, size), dofs, *shown) +
                      "".join("%10.3f" % t if t else "%10s" % ("> %d" % LIMIT) for t in times), flush=True)
    if picture:
        draw(os.path.join(HERE, "error_against_time.py"), picture, [json.dumps(points)])


def draw(script, picture, arguments):
    """By a Python that has matplotlib."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import matplotlib"], stderr=subprocess.DEVNULL).returncode == 0:
            break
    subprocess.run([python, script, picture] + arguments, check=True)


def condensation(build):
    print("\nStatic condensation: the usual way (a solve for each contact unknown) and ours", flush=True)
    subprocess.run([os.path.join(build, "benchmarks", "peers", "naive_condensation")],
                   env=dict(os.environ, OPENBLAS_NUM_THREADS="1"), check=True)


def solvers(build, picture):
    program = os.path.join(build, "benchmarks", "peers", "siconos_peer")
    if not os.path.exists(program):
        print("\nSiconos: %s is not built (needs libsiconos-numerics-dev; then ninja -C %s siconos_peer)" % (program, build))
        return
    problems = sorted(set(glob.glob(os.path.join(ROOT, "problems", "*.json"))) - set(glob.glob(os.path.join(ROOT, "problems", "*.solution.json"))))
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        for title, arguments in (("public set", problems), ("public set, held by springs", ["--held"] + problems),
                                 ("random, dense, definite", ["--random"])):
            file = os.path.join(folder, "%d.csv" % len(panels))
            subprocess.run([program, file] + arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
            panels.append("%s=%s" % (title, file))
        print(flush=True)
        draw(os.path.join(HERE, "performance_profile.py"), picture, panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build", "release"))
    parser.add_argument("--picture", default="", help="file for the performance profile")
    parser.add_argument("--times", default="", help="file for errors against run times")
    parser.add_argument("what", nargs="*", default=["condensation", "studies", "space", "cycles", "solvers"])
    options = parser.parse_args()
    for what in options.what:
        if what == "condensation":
            condensation(options.build)
        elif what == "studies":
            studies(options.build)
        elif what == "space":
            space(options.build)
        elif what == "cycles":
            cycles(options.build, options.times)
        elif what == "solvers":
            solvers(options.build, options.picture)
        else:
            sys.exit("error: '%s' is none of condensation, studies, space, cycles, solvers" % what)


if __name__ == "__main__":
    main()

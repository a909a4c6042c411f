#!/usr/bin/env python3
"""Mutation fuzzer of the programs that read a user's files: contact (options, JSON cases, meshes,
saved states) and shakedown --reduced (reduced problems).

    python3 tests/fuzz/fuzz.py --programs build/release/miniapps --seconds 600 --keep finds

Every run must end in one of three ways: 0 with finite numbers; 2, an outcome of the solver; 1 with
exactly one line on stderr and no file written. A signal, another code, 20 s of CPU without an end, or
nan in the results of a run that ended with 0 is a find. Finds are kept in --keep as folders in the
form of tests/fuzz/cases, which the test suite runs: `command` holds the program and its arguments,
one a line; `expected`, if there is one, the exit code and words of the message. With
--replay FOLDER... only these are run and judged."""
import argparse
import copy
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIMIT = 20  # seconds of CPU that a run may take
MEMORY = 3 << 30

NUMBERS = ["0", "-0", "1", "-1", "2", "3", "0.5", "1e-300", "1e300", "-1e300", "1e308", "1e-9", "1e9", "1e16",
           "2147483647", "2147483648", "-2147483648", "4294967296", "9223372036854775807", "18446744073709551616",
           "1e999", "nan", "inf", "-inf", "0x10", "1e", ".", "+-1", "1.5"]
WORDS = ["", " ", ";", "=", "3[", "3[]", "3[0<x<", "3[1<x<0]", "[0<x<1]", "3,,4", "-3", "@", "@0,0:x", "@0,0,0:x",
         "1:xyx", ":", "1:", "P", "P=1", "P pressure 3 x*x", "P pressure 3 1e308*x", "\x01", "\u00e4", "\udcff", "P\udcff pressure 3 1", "%s%n", "../..",
         "/dev/null", "/", "a" * 5000, "none", "all", "P=0;P=1;P=0", "P=0;P=-1", "Q=1", "1 2 3", "1,2", "--", "-1"]
VALUES = [None, True, False, 0, -1, 2.5, 1e300, -1e300, 1e-300, 10**30, "", "x", [], {}, [[]], [1, "2"], ["P=0"], [None],
          [1e308, 1e308], {"a": 1}, "3", "P=0; P=1"]
CASE_KEYS = ["bodies", "interfaces", "bolts", "analysis", "mesh", "matrix", "half-plane", "young", "poisson", "expansion",
             "support", "load", "guides", "between", "friction", "strength", "gap", "pairing", "slave", "tied", "overlap",
             "obstacle", "motion", "order", "history", "cycle-start", "cycles", "increments", "edges", "stepping", "version",
             "set", "unknown", "case"]

MFEM_MESH = """MFEM mesh v1.0

dimension
2

elements
7
1 3 0 1 5 4
1 3 1 2 6 5
1 3 2 3 7 6
2 3 4 5 9 8
1 3 5 6 10 9
1 2 6 7 11
1 2 6 11 10

boundary
10
1 1 0 1
1 1 1 2
1 1 2 3
2 1 3 7
2 1 7 11
3 1 11 10
3 1 10 9
3 1 9 8
4 1 8 4
4 1 4 0

vertices
12
2
0 0
1 0
2 0
3 0
0 1
1 1
2 1
3 1
0 2
1 2
2 2
3 2
"""


def gmsh_mesh(height):
    """A strip of triangles, 3 x height, with curved edges of order 2 (straight in place), format 2.2."""
    sign = 1 if height > 0 else -1
    nodes, ids = [], {}

    def node(x, y):
        if (x, y) not in ids:
            ids[x, y] = len(nodes) + 1
            nodes.append((x, y))
        return ids[x, y]

    elements = []

    def add(kind, tag, points):
        elements.append((kind, tag, [node(*p) for p in points]))

    for i in range(3):
        a, b, c, d = (i, 0), (i + 1, 0), (i + 1, height), (i, height)
        for t in ((a, b, c), (a, c, d)):
            t = t if sign > 0 else (t[0], t[2], t[1])
            mid = [((t[k][0] + t[(k + 1) % 3][0]) / 2, (t[k][1] + t[(k + 1) % 3][1]) / 2) for k in range(3)]
            add(9, 1, list(t) + mid)
        for tag, (p, q) in ((1, (a, b)), (3, (c, d))):
            add(8, tag, [p, q, ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)])
    for x in (0, 3):
        add(8, 2, [(x, 0), (x, height), (x, height / 2)])
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes)
    text += "".join("%d %g %g 0\n" % (i + 1, x, y) for i, (x, y) in enumerate(nodes))
    text += "$EndNodes\n$Elements\n%d\n" % len(elements)
    text += "".join("%d %d 2 %d %d %s\n" % (i + 1, kind, tag, tag, " ".join(map(str, points)))
                    for i, (kind, tag, points) in enumerate(elements))
    return text + "$EndElements\n"


def seeds(programs):
    """Each: program, arguments, files by name. The shipped cases, and small ones that are quick to run."""
    rigid = {"version": 2, "analysis": "plane strain",
             "bodies": {"block": {"mesh": "block.mesh", "young": 1.0, "poisson": 0.3,
                                  "load": ["P pressure 3 1", "Q traction 3 1 0", "Q pressure 3 -2*x+3"]}},
             "interfaces": {"floor": {"between": "block:1", "friction": 0.3}},
             "history": ["P=0", "P=1", "Q=0.1", "Q=-0.1", "Q=0"], "cycle-start": 1, "cycles": 2, "increments": 3,
             "order": 2, "stepping": "fixed"}
    pair = {"version": 2,
            "bodies": {"upper": {"mesh": "upper.msh", "young": [2.0], "poisson": 0.2, "support": "@1.5,1:x",
                                 "load": "P pressure 3[0.5<x<2.5] 1; Q displacement-x 3 0.1"},
                       "lower": {"mesh": "lower.msh", "young": 1.0, "poisson": 0.3, "support": "3:xy"}},
            "interfaces": {"face": {"between": ["upper:1", "lower:1[-1<x<4]"], "friction": 0.5, "gap": "closed", "pairing": 0.1}},
            "history": "P=0; P=1; Q=1", "increments": 2, "order": 2, "edges": [1, 2], "stepping": "exact"}
    meshes = {"block.mesh": MFEM_MESH, "upper.msh": gmsh_mesh(1), "lower.msh": gmsh_mesh(-1)}
    options = ["--case", "rigid.json", "--set", "interfaces.floor.friction=0.2", "--increments", "2"]
    list_ = [
        ("contact", ["--case", "rigid.json"], {"rigid.json": json.dumps(rigid, indent=1), **meshes}),
        ("contact", ["--case", "pair.json"], {"pair.json": json.dumps(pair, indent=1), **meshes}),
        ("contact", options + ["--frames", "all"], {"rigid.json": json.dumps(rigid, indent=1), **meshes}),
        ("contact", ["--case", "rigid.json", "--load-state", "state.json"],
         {"rigid.json": json.dumps(rigid, indent=1), "state.json": None, **meshes}),
        ("shakedown", ["--reduced", "saved.json", "--held", "P", "--cycled", "Q", "--friction", "0.3", "--find", "load",
                       "--load-ratio", "-1"], {"saved.json": None}),
        ("shakedown", ["--reduced", "saved.json", "--held", "P", "--cycled", "Q", "--march", "--cycles", "3", "--closed",
                       "--lambda-max", "0.1", "--load-ratio", "-1"], {"saved.json": None}),
    ]
    for name, meshes_of in (("dovetail", ("dovetail_root", "dovetail_disc")),
                            ("rounded_punch", ("rounded_punch", "rounded_punch_block"))):
        files = {}
        for file in [name + ".json"] + [m + ".msh" for m in meshes_of]:
            with open(os.path.join(ROOT, "meshes", file)) as f:
                files[file] = f.read()
        list_.append(("contact", ["--case", name + ".json", "--cycles", "1"], files))
    # A state and a reduced problem, as the program writes them.
    with tempfile.TemporaryDirectory() as folder:
        write(folder, list_[0][2])
        subprocess.run([os.path.join(programs, "contact"), "--case", "rigid.json", "--history", "P=0;P=1", "--cycle-start",
                        "-1", "--cycles", "1", "--save-state", "state.json", "--save", "saved.json"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        for file in ("state.json", "saved.json"):
            with open(os.path.join(folder, file)) as f:
                text = f.read()
            for _, _, files in list_:
                if file in files:
                    files[file] = text
    return list_


def write(folder, files):
    for name, text in files.items():
        if text is not None:
            with open(os.path.join(folder, name), "w", encoding="utf-8", errors="surrogateescape", newline="") as f:
                f.write(text)


# --- mutations ----------------------------------------------------------------------------------

def mutate_text(text, rng):
    """Numbers, lines, bytes, spans."""
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        kind = rng.randrange(7)
        if kind <= 2:  # a number
            found = list(re.finditer(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", text))
            if not found:
                continue
            at = rng.choice(found)
            if rng.random() < 0.4:
                try:
                    new = repr(float(at.group()) * rng.choice([-1, 0.5, 2, 1e3, 1 + 1e-9, 1e-9]))
                    if "." not in at.group():
                        new = str(int(float(at.group())) + rng.choice([-1, 1, 2, 100, -100]))
                except (ValueError, OverflowError):
                    new = "0"
            else:
                new = rng.choice(NUMBERS)
            text = text[:at.start()] + new + text[at.end():]
        elif kind == 3:  # lines
            lines = text.split("\n")
            i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
            action = rng.randrange(3)
            if action == 0:
                del lines[i]
            elif action == 1:
                lines.insert(i, lines[j])
            else:
                lines[i], lines[j] = lines[j], lines[i]
            text = "\n".join(lines)
        elif kind == 4:  # bytes
            i = rng.randrange(len(text) + 1)
            text = text[:i] + chr(rng.choice([0, 9, 10, 13, 32, 34, 39, 44, 45, 46, 91, 93, 123, 125, 127, 233, rng.randrange(128)])) \
                + text[i + rng.randrange(2):]
        elif kind == 5:  # a span is left out or doubled
            i = rng.randrange(len(text) + 1)
            j = min(len(text), i + rng.choice([1, 3, 10, 100, 1000]))
            text = text[:i] + text[j:] if rng.random() < 0.5 else text[:j] + text[i:j] + text[j:]
        else:  # cut off
            text = text[:rng.randrange(len(text) + 1)]
    return text


def mutate_word(word, rng):
    kind = rng.randrange(4)
    if kind == 0:
        return rng.choice(WORDS)
    if kind == 1:
        return rng.choice(NUMBERS)
    return mutate_text(word, rng).replace("\0", "") if word else rng.choice(WORDS)


def mutate_json(text, rng, keys):
    try:
        tree = json.loads(text)
    except ValueError:
        return mutate_text(text, rng)
    for _ in range(rng.choice([1, 1, 2, 3])):
        # A random place: the deeper the likelier, so that lists of numbers are reached too.
        parent, key, node = None, None, tree
        while isinstance(node, (dict, list)) and len(node) and (parent is None or rng.random() < 0.7):
            parent, key = node, rng.choice(list(node)) if isinstance(node, dict) else rng.randrange(len(node))
            node = parent[key]
        if parent is None:
            return rng.choice(["[]", "{}", "3", "null", "[" * 200000, '{"order":' + "[" * 200000 + "]" * 200000 + "}"])
        kind = rng.randrange(6)
        if kind == 0:
            del parent[key]
        elif kind == 1:
            parent[key] = copy.deepcopy(rng.choice(VALUES))
        elif kind == 2 and isinstance(node, str):
            parent[key] = mutate_word(node, rng)
        elif kind == 2 and isinstance(node, (int, float)) and not isinstance(node, bool):
            parent[key] = rng.choice([-node, node * 2, node + 1, node * 1e-9, node * 1e9, 0, 1e-320])
        elif kind == 3 and isinstance(parent, dict) and keys:
            parent[rng.choice(keys)] = copy.deepcopy(rng.choice(VALUES + list(tree.values())))
        elif kind == 4 and isinstance(parent, list):
            parent.insert(key, copy.deepcopy(node))
        elif kind == 5 and isinstance(parent, dict) and len(parent) > 1:
            other = rng.choice(list(parent))
            parent[key], parent[other] = parent[other], parent[key]
    text = json.dumps(tree)
    return mutate_text(text, rng) if rng.random() < 0.1 else text


def mutate(seed, rng):
    program, arguments, files = seed[0], list(seed[1]), dict(seed[2])
    used = [name for name in files if name.endswith(".json")]
    mesh = [name for name in files if not name.endswith(".json")]
    choice = rng.random()
    if used and choice < 0.5:
        name = rng.choice(used)
        case = "between" in files[name]
        files[name] = mutate_json(files[name], rng, CASE_KEYS if case else []) if rng.random() < 0.8 \
            else mutate_text(files[name], rng)
    elif mesh and choice < 0.75:
        name = rng.choice(mesh)
        files[name] = mutate_text(files[name], rng)
    else:
        for _ in range(rng.choice([1, 1, 2])):
            kind = rng.randrange(4)
            at = rng.randrange(len(arguments)) if arguments else 0
            if kind == 0 and arguments:
                del arguments[at]
            elif kind == 1 and program == "contact":
                arguments += ["--" + rng.choice(CASE_KEYS), rng.choice(WORDS + NUMBERS)]
            elif arguments:
                arguments[at] = mutate_word(arguments[at], rng)
    arguments = [a.replace("\0", "") for a in arguments]
    return program, arguments, files


# --- one run ------------------------------------------------------------------------------------

def too_much_asked(arguments, files):
    """Work that the user asked for may take as long as it takes."""
    said = " ".join(arguments) + " ".join(t for n, t in files.items() if t and n.endswith(".json") and "between" in t)
    for key, most in (("increments", 100), ("cycles", 100), ("starts", 3), ("order", 4)):
        for value in re.findall(r'%s"?:?\s+\[?(\S{1,30})' % key, said):
            number = re.match(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", value)
            if number and float(number.group()) > most:
                return True
    return False


def limit_resources():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (200 << 20, 200 << 20))


def outputs(program):
    if program == "contact":
        return ["--json", "out/r.json", "--csv", "out/t", "--paraview", "out/fields", "--save-state", "out/state.json",
                "--save", "out/reduced.json"]
    return ["--json", "out/r.json", "--save", "out/reduced.json"]


def judge(programs, program, arguments, files, folder):
    """What is wrong with a run (None: nothing), its exit code and its message."""
    write(folder, files)
    os.makedirs(os.path.join(folder, "out"))
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1")
    try:
        run = subprocess.run([os.path.join(programs, program)] + arguments + outputs(program), cwd=folder, timeout=10 * LIMIT,
                             capture_output=True, preexec_fn=limit_resources, env=environment, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return "no end within %d s" % (10 * LIMIT), None, ""
    error = run.stderr.decode("utf-8", "replace")
    written = sorted(os.path.join(d, f)[len(folder) + 1:] for d, _, names in os.walk(os.path.join(folder, "out")) for f in names)
    code = run.returncode
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "no end within %d s of CPU" % LIMIT, code, error
    if code < 0:
        return "signal %d: %s" % (-code, error[-300:]), code, error
    if code not in (0, 1, 2):
        return "exit code %d: %s" % (code, error[-300:]), code, error
    if code == 1:
        if not re.fullmatch(r"error: [^\n]+\n", error):
            return "not one sentence: " + error[:400], code, error
        if any(ord(c) < 32 and c != "\n" or ord(c) == 127 for c in error):
            return "control characters in the message: " + repr(error[:300]), code, error
        if "MFEM abort" in error and "mesh file cannot be read" not in error:
            return "an abort of MFEM: " + error[:400], code, error
        if written:
            return "files after bad input: %s (%s)" % (written, error.strip()[:200]), code, error
    elif error.strip():
        return "exit code %d with a message: %s" % (code, error[:300]), code, error
    if any(name.endswith(".part") for name in written):
        return "half-written: %s" % written, code, error
    if code == 0 and "-h" not in arguments and "--help" not in arguments:
        shown = run.stdout.decode("utf-8", "replace")
        for name in written:
            if name.endswith((".csv", ".json")):
                with open(os.path.join(folder, name), errors="replace") as f:
                    shown += f.read()
        # The echo of the options ends at the first empty line.
        shown = shown.partition("\n\n")[2]
        # A limit may be unbounded; no result of contact is.
        at = re.search(r"(?<![\w-])-?%s(?![\w-])" % ("(nan|inf)" if program == "contact" else "nan"), shown, re.IGNORECASE)
        if at:
            return "not finite: ..." + shown[max(0, at.start() - 80):at.end() + 20].replace("\n", " | "), code, error
    return None, code, error


def keep(target, name, program, arguments, files, why):
    folder = os.path.join(target, name)
    os.makedirs(folder, exist_ok=True)
    needed = dict(files)
    write(folder, needed)
    with open(os.path.join(folder, "command"), "w", encoding="utf-8", errors="surrogateescape") as f:
        f.write("\n".join([program] + arguments) + "\n")
    with open(os.path.join(folder, "why"), "w") as f:
        f.write(why + "\n")


def replay(programs, folders):
    bad = 0
    for case in folders:
        with open(os.path.join(case, "command"), encoding="utf-8", errors="surrogateescape") as f:
            program, *arguments = f.read()[:-1].split("\n")
        with tempfile.TemporaryDirectory() as folder:
            for name in os.listdir(case):
                if name not in ("command", "why", "expected"):
                    shutil.copy(os.path.join(case, name), folder)
            what, code, error = judge(programs, program, arguments, {}, folder)
        if what is None and os.path.exists(os.path.join(case, "expected")):
            with open(os.path.join(case, "expected")) as f:
                wanted, _, words = f.read().strip().partition(" ")
            if str(code) != wanted or words not in error:
                what = "expected %s '%s', not '%s'" % (wanted, words, error.strip())
        print("%-50s exit code %s%s" % (os.path.basename(case), code, "" if what is None else ": " + what))
        bad += what is not None
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build", "release", "miniapps"))
    parser.add_argument("--seconds", type=float, default=60, help="CPU time of the runs")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="seeds whose arguments hold this word")
    parser.add_argument("--keep", default="fuzz_finds")
    parser.add_argument("--replay", nargs="+")
    options = parser.parse_args()
    options.programs = os.path.abspath(options.programs)
    if options.replay:
        sys.exit(1 if replay(options.programs, options.replay) else 0)
    rng = random.Random(options.seed)
    all_seeds = [s for s in seeds(options.programs) if options.only in " ".join((s[0],) + tuple(s[1]))]
    for seed in all_seeds:
        with tempfile.TemporaryDirectory() as folder:
            what, code, _ = judge(options.programs, *seed, folder)
            if what or code == 1:
                sys.exit("the seed %s is itself bad: %s, exit code %s" % (seed[1], what, code))
    counts, finds, seen, runs = {}, 0, {}, 0

    def spent():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    began = spent()
    weights = [4, 4, 4, 2, 2, 2] + [1] * (len(all_seeds) - 6) if len(all_seeds) > 6 else [1] * len(all_seeds)
    while spent() - began < options.seconds:
        program, arguments, files = mutate(rng.choices(all_seeds, weights)[0], rng)
        if too_much_asked(arguments, files):
            continue
        runs += 1
        with tempfile.TemporaryDirectory() as folder:
            what, code, _ = judge(options.programs, program, arguments, files, folder)
        counts[code] = counts.get(code, 0) + 1
        if what:
            finds += 1
            kind = re.sub(r"[^a-z ]", "", what.lower())[:60]
            seen[kind] = seen.get(kind, 0) + 1
            if seen[kind] <= 3:
                keep(options.keep, "seed%d_%05d" % (options.seed, runs), program, arguments, files, what)
                print("%6d  %s" % (runs, what[:230].replace("\n", " | ")), flush=True)
    print("%d runs in %.0f s of CPU, exit codes %s, %d finds" %
          (runs, spent() - began, {str(k): v for k, v in sorted(counts.items(), key=str)}, finds))
    sys.exit(1 if finds else 0)


if __name__ == "__main__":
    main()

"""Programs, run as their users run them: what they print and write, and cases and meshes for them."""

import copy
import csv
import json
import math
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Run:
    """A run that has ended: exit code, what it printed, and its results (None if it wrote none)."""

    def __init__(self, code, output, results):
        self.code, self.output, self.results = code, output, results

    def __getitem__(self, key):
        return self.results[key]

    def interface(self, name):
        """Its row in the table of interfaces."""
        found = [row for row in self.results["interfaces"] if row["interface"] == name]
        assert len(found) == 1, self.output
        return found[0]

    def warned(self):
        """What was warned of, a sentence a line."""
        return "".join(sentence + "\n" for sentence in self.results["warnings"])

    @property
    def error(self):
        """The one sentence after bad input, which is all from 'error: ' on."""
        at = self.output.find("error: ")
        assert at >= 0, self.output
        message = self.output[at:]
        assert message.count("\n") == 1 and message.endswith("\n"), "one line: " + message
        return message


class Runner:
    """Runs programs from the source folder; files of a test are in its folder."""

    def __init__(self, folder, programs):
        self.folder, self.programs = folder, programs

    def __call__(self, program, *words, code=0, threads=None):
        """A run with --json; its exit code must be `code` (None: any). It computes with so many threads, if it is said."""
        file = self.folder / (program + "_results.json")
        file.unlink(missing_ok=True)
        done = subprocess.run([self.programs / program, *map(str, words), "--json", file], cwd=ROOT, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False,
                              env={**os.environ, **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), str(threads))} if threads else None)
        output = done.stdout.decode("utf-8", "replace")
        assert code is None or done.returncode == code, f"{program} {' '.join(map(str, words))}\n{output}"
        results = json.loads(file.read_text(encoding="utf-8")) if file.exists() else None
        file.unlink(missing_ok=True)
        return Run(done.returncode, output, results)

    def case(self, keys, *words, code=0, program="contact"):
        """A run of a case: a dictionary, to which its version is added, or the text of a file."""
        text = keys if isinstance(keys, str) else json.dumps({"version": 2, **keys})
        self.write("case.json", text)
        return self(program, "--case", self.folder / "case.json", *words, code=code)

    def refused(self, keys, *words):
        """The sentence about a case that is refused."""
        run = self.case(keys, *words, code=1)
        assert run.results is None
        return run.error

    def refuses(self, program, options, words):
        """A run is refused by a sentence that holds all words, and leaves no file in the folder of the test."""
        before = set(self.folder.iterdir())
        run = self(program, *options, code=1)
        assert run.results is None and set(self.folder.iterdir()) == before, options
        for word in words:
            assert str(word) in run.error, f"{program} {options} should say '{word}': {run.error}"

    def text(self, name):
        """A file in the folder of the test."""
        return (self.folder / name).read_text(encoding="utf-8")

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return str(self.folder / name)

    def block(self, name, x0, x1, nx, y0, y1, ny, place=lambda x, y: (x, y)):
        """A mesh of nx by ny quadrilaterals, boundary 1 below, 2 right, 3 above, 4 left."""
        self.write(name, rectangle(even(x0, x1, nx), even(y0, y1, ny), place))

    def columns(self, name):
        """Columns of a CSV table in the folder of the test; numbers where all of a column are."""
        with open(self.folder / name, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        assert rows, name

        def values(key):
            words = [row[key] for row in rows]
            try:
                return [float(word) for word in words]
            except ValueError:
                return words

        return {key: values(key) for key in rows[0]}


def near(value, expected, tolerance):
    """Is it within this of what is expected? Bounds are absolute."""
    assert abs(value - expected) <= tolerance, f"{value} is not {expected} ± {tolerance}"


def near_all(values, expected, tolerance):
    """Is each of them?"""
    assert values
    for value in values:
        near(value, expected, tolerance)


def alike(values, others, tolerance):
    """Are two columns alike, each to this?"""
    assert len(values) == len(others)
    for value, other in zip(values, others):
        near(value, other, tolerance)


def body(mesh, support=None, load=(), young=1000, poisson=0):
    """What a case says of a body."""
    made = {"mesh": mesh, "young": young, "poisson": poisson}
    if support:
        made["support"] = support
    if load:
        made["load"] = list(load)
    return made


def face(one, other, friction=0.5):
    """What a case says of an interface of two parts."""
    return {"between": [one, other], "friction": friction}


def changed(case, changes):
    """A case with other values in places such as 'bodies.pad.load'; None takes a key away."""
    made = copy.deepcopy(case)
    for place, value in changes.items():
        *path, key = [int(step) if step.isdigit() else step for step in place.split(".")]
        inner = made
        for step in path:
            inner = inner[step] if isinstance(inner, list) else inner.setdefault(step, {})
        if value is None:
            del inner[key]
        else:
            inner[key] = copy.deepcopy(value)
    return made


def read_case(file):
    """A case file, in which comments are allowed as in C++."""
    text = pathlib.Path(file).read_text(encoding="utf-8")
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda found: found[1] or " ", text, flags=re.DOTALL))


def shipped(name):
    """A case of meshes/ that can stand in another folder."""
    file = ROOT / "meshes" / (name + ".json")
    case = read_case(file)
    case.pop("$schema", None)
    for body in case["bodies"].values():
        for key in ("mesh", "matrix"):
            if key in body:
                body[key] = str(file.parent / body[key])
    return case


def even(first, last, count):
    """Places of `count` elements of one length."""
    return [first + (last - first) * k / count for k in range(count + 1)]


def to_ends(half, count, smallest):
    """Places of `count` elements (even) over [-half, half], the smallest at the ends, in a geometric series."""
    n = count // 2
    low, high = 1.0, 10.0
    while high - low > 1e-14 * high:
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if smallest * sum(ratio**k for k in range(n)) < half else (low, ratio)
    reach = [0.0]
    for k in range(n):
        reach.append(reach[-1] + smallest * low**k)
    left = [-half + r * half / reach[-1] for r in reach]
    return left + [-x for x in reversed(left[:-1])]


def rectangle(x, y, place=lambda x, y: (x, y), attribute=lambda i, j: 1):
    """An MFEM mesh of quadrilaterals over places x and y, each vertex moved; boundary 1 below, 2 right, 3 above, 4 left."""
    columns, rows = len(x) - 1, len(y) - 1

    def at(i, j):
        return i + j * (columns + 1)

    elements = [f"{attribute(i, j)} 3 {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}"
                for j in range(rows) for i in range(columns)]
    boundary = [f"1 1 {at(i, 0)} {at(i + 1, 0)}" for i in range(columns)]
    boundary += [f"2 1 {at(columns, j)} {at(columns, j + 1)}" for j in range(rows)]
    boundary += [f"3 1 {at(i + 1, rows)} {at(i, rows)}" for i in range(columns)]
    boundary += [f"4 1 {at(0, j + 1)} {at(0, j)}" for j in range(rows)]
    vertices = ["%.17g %.17g" % place(a, b) for b in y for a in x]
    return mesh_text(elements, boundary, vertices)


def curved(nx, ny, place):
    """A mesh in Gmsh's format of nx by ny quadrilaterals of order 2 over the unit square, all nodes moved; boundary as above."""
    wide = 2 * nx + 1

    def at(i, j):
        return i + j * wide + 1

    nodes = ["%d %.17g %.17g 0" % (at(i, j), *place(i / (2 * nx), j / (2 * ny))) for j in range(2 * ny + 1) for i in range(wide)]
    lines = [(1, at(i, 0), at(i + 2, 0), at(i + 1, 0)) for i in range(0, 2 * nx, 2)]
    lines += [(2, at(2 * nx, j), at(2 * nx, j + 2), at(2 * nx, j + 1)) for j in range(0, 2 * ny, 2)]
    lines += [(3, at(i + 2, 2 * ny), at(i, 2 * ny), at(i + 1, 2 * ny)) for i in range(0, 2 * nx, 2)]
    lines += [(4, at(0, j + 2), at(0, j), at(0, j + 1)) for j in range(0, 2 * ny, 2)]
    elements = [f"8 2 {tag} {tag} {a} {b} {c}" for tag, a, b, c in lines]
    for j in range(0, 2 * ny, 2):
        for i in range(0, 2 * nx, 2):
            own = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
            elements.append("10 2 1 1 " + " ".join(str(at(i + a, j + b)) for a, b in own))
    numbered = [f"{k} {line}" for k, line in enumerate(elements, 1)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements",
                      str(len(numbered)), *numbered, "$EndElements"]) + "\n"


def mesh_text(elements, boundary, vertices, dimension=2):
    """An MFEM mesh of its lines."""
    lines = ["MFEM mesh v1.0", "", "dimension", str(dimension), "", "elements", str(len(elements)), *elements, "", "boundary",
             str(len(boundary)), *boundary, "", "vertices", str(len(vertices)), str(dimension), *vertices]
    return "\n".join(lines) + "\n"


def turned(angle):
    """For rectangle(): each place turned about (0, 0)."""
    c, s = math.cos(angle), math.sin(angle)
    return lambda x, y: (c * x - s * y, s * x + c * y)

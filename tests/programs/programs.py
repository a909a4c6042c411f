"""Programs, run as their users run them: what they print and write, and cases and meshes for them."""

import copy
import csv
import json
import math
import os
import pathlib
import re
import shlex
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

    def meets(self, expected):
        """Has the study's table these values? By quantity: a value of a source that owes the program nothing, the ± of that
        source, and what mesh, read-out and increments of this run may add."""
        for quantity, (value, spread, mesh) in expected.items():
            rows = [row for row in self.results["references"] if row["quantity"] == quantity]
            assert rows, f"no row of '{quantity}' in\n{self.output}"
            for row in rows:
                assert abs(row["computed"] - value) <= spread + mesh, f"{quantity} is not {value} ± {spread} ± {mesh}: {row}"

    def warned(self):
        """Its warnings, a sentence a line."""
        return self.listed("warnings")

    def listed(self, key):
        """Its warnings or notes, a sentence a line; nothing where it has none."""
        return "".join(sentence + "\n" for sentence in self.results.get(key, []))

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

    def __call__(self, program, *words, code=0, threads=None, launcher=()):
        """A run with --json; its exit code must be `code` (None: any). It computes with so many threads, if it is said. The
        words of a launcher go before the program."""
        file = self.folder / (program + "_results.json")
        file.unlink(missing_ok=True)
        done = subprocess.run([*launcher, self.programs / program, *map(str, words), "--json", file], cwd=ROOT, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False,
                              env={**os.environ, **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), str(threads))} if threads else None)
        output = done.stdout.decode("utf-8", "replace")
        assert code is None or done.returncode == code, f"{program} {' '.join(map(str, words))}\n{output}"
        results = json.loads(file.read_text(encoding="utf-8")) if file.exists() else None
        file.unlink(missing_ok=True)
        return Run(done.returncode, output, results)

    def line(self, text, code=0):
        """A run of a line as it is typed into a shell: program and options, with quotes."""
        return self(*shlex.split(text), code=code)

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
        """Columns of a CSV table in the folder of the test, without its comments; numbers where all of a column are."""
        with open(self.folder / name, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("# ")))
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


def near_relative(value, expected, share):
    """Is it within this share of what is expected?"""
    near(value, expected, share * abs(expected))


def meshes(usual, finer):
    """Meshes of a convergence test: the first ones, and the finer ones too where CATTANEO_STRESS=full asks for them."""
    return usual + finer if in_full() else usual


def in_full():
    """Is everything asked for (./test --all and ./test --room)?"""
    return os.environ.get("CATTANEO_STRESS") == "full"


def problem(name):
    """A reduced problem of problems/, or of a path."""
    file = pathlib.Path(name) if "/" in str(name) else ROOT / "problems" / (name + ".json")
    return json.loads(file.read_text(encoding="utf-8"))


def twice(one):
    """A reduced problem twice, side by side: both are loaded alike and know nothing of each other. Where the arc length of the
    second begins is arbitrary."""
    def columns(matrix):
        values, rows = matrix["values"], matrix["rows"]
        return [values[k:k + rows] for k in range(0, len(values), rows)]

    def matrix_of(lists):
        return {"rows": len(lists[0]), "cols": len(lists), "values": [value for column in lists for value in column]}

    two, nodes = copy.deepcopy(one), one["gap"]["rows"]
    none = [0] * nodes
    for block in ("A", "B", "C"):
        its = columns(one[block])
        two[block] = matrix_of([column + none for column in its] + [none + column for column in its])
    # Tangential components of all nodes, then normal ones.
    motions = [(column[:nodes], column[nodes:]) for column in columns(one["rigid_motions"])]
    two["rigid_motions"] = matrix_of([t + none + n + none for t, n in motions] + [none + t + none + n for t, n in motions])
    for pattern, its in zip(two["patterns"], one["patterns"]):
        for forces in ("p", "q"):
            pattern[forces] = matrix_of([column * 2 for column in columns(its[forces])])
    two["H"]["values"] = [2 * value for value in one["H"]["values"]]
    for name in ("gap", "friction", "weights", "position", "dofs"):
        two[name] = matrix_of([column * 2 for column in columns(one[name])])
    arcs = one["arc_length"]["values"]
    two["arc_length"] = matrix_of([arcs + [arc + 100 for arc in arcs]])
    two["chains"].append({**one["chains"][0], "first": nodes, "interface": '"other"'})
    return two


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


def rectangle(x, y, place=lambda x, y: (x, y), attribute=lambda i, j: 1, split=False):
    """An MFEM mesh of quadrilaterals (split: each of two triangles) over places x and y, each vertex moved; boundary 1 below,
    2 right, 3 above, 4 left."""
    columns, rows = len(x) - 1, len(y) - 1

    def at(i, j):
        return i + j * (columns + 1)

    elements = []
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            shapes = [(2, a, b, c), (2, a, c, d)] if split else [(3, a, b, c, d)]
            elements += [" ".join(map(str, (attribute(i, j), *shape))) for shape in shapes]
    boundary = [f"1 1 {at(i, 0)} {at(i + 1, 0)}" for i in range(columns)]
    boundary += [f"2 1 {at(columns, j)} {at(columns, j + 1)}" for j in range(rows)]
    boundary += [f"3 1 {at(i + 1, rows)} {at(i, rows)}" for i in range(columns)]
    boundary += [f"4 1 {at(0, j + 1)} {at(0, j)}" for j in range(rows)]
    vertices = ["%.17g %.17g" % place(a, b) for b in y for a in x]
    return mesh_text(elements, boundary, vertices)


def curved(nx, ny, place):
    """A mesh in Gmsh's format of nx by ny quadrilaterals of order 2 over the unit square, all nodes moved; boundary as above."""
    x, y = even(0, 1, nx), even(0, 1, ny)
    elements = [(i + j * (nx + 1), i + 1 + j * (nx + 1), i + 1 + (j + 1) * (nx + 1), i + (j + 1) * (nx + 1))
                for j in range(ny) for i in range(nx)]
    top = ny * (nx + 1)
    boundary = [(1, i, i + 1) for i in range(nx)]
    boundary += [(2, nx + j * (nx + 1), nx + (j + 1) * (nx + 1)) for j in range(ny)]
    boundary += [(3, top + i + 1, top + i) for i in range(nx)] + [(4, (j + 1) * (nx + 1), j * (nx + 1)) for j in range(ny)]
    return quadratic(elements, boundary, [(a, b) for b in y for a in x], place)


def quadratic(elements, boundary, vertices, place):
    """A mesh in Gmsh's format of quadrilaterals of order 2, given by four vertices each, with edges (attribute, from, to) on the
    boundary: all nodes are moved, those between vertices from half-way between them."""
    nodes = list(vertices)
    between = {}

    def middle(*ends):
        key = tuple(sorted(ends))
        if key not in between:
            between[key] = len(nodes)
            nodes.append(tuple(sum(nodes[k][c] for k in ends) / len(ends) for c in (0, 1)))
        return between[key]

    lines = [("8", tag, (a, b, middle(a, b))) for tag, a, b in boundary]
    lines += [("10", 1, (a, b, c, d, middle(a, b), middle(b, c), middle(c, d), middle(d, a), middle(a, b, c, d))) for a, b, c, d in elements]
    numbered = [f"{k} {kind} 2 {tag} {tag} " + " ".join(str(node + 1) for node in own) for k, (kind, tag, own) in enumerate(lines, 1)]
    placed = ["%d %.17g %.17g 0" % (k, *place(*node)) for k, node in enumerate(nodes, 1)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(placed)), *placed, "$EndNodes", "$Elements",
                      str(len(numbered)), *numbered, "$EndElements"]) + "\n"


def graded(first, last, step, growth, largest=math.inf):
    """Places from first to last in steps that grow up to the largest; the last ones are scaled so that they end there."""
    steps, step = [], min(step, largest)
    while not steps or last - first - sum(steps) > 0.5 * step:
        steps.append(step)
        step = min(step * growth, largest)
    missing, k = last - first - sum(steps), len(steps)
    while k > 0 and sum(steps[k:]) < 4 * abs(missing):
        k -= 1
    factor = 1 + missing / sum(steps[k:]) if k < len(steps) else 1
    steps[k:] = [step * factor for step in steps[k:]]
    return [first + sum(steps[:n]) for n in range(len(steps))] + [last]


def graded_to_ends(half, count, ratio):
    """Places of `count` elements (even) over [-half, half], in a geometric series to the ends, where they are `ratio` times as long
    as in the middle."""
    steps = [ratio ** (k / (count // 2 - 1)) for k in range(count // 2)]  # from the middle outward
    right = [half * sum(steps[:n]) / sum(steps) for n in range(1, len(steps) + 1)]
    return [-x for x in reversed(right)] + [0] + right


def half_plane(contact, depth, domain, growth):
    """Quadrilaterals of a half-plane below a contact at the places -a … a: a box over places of depth (from 0), and around it copies
    of its outline up to `domain`, at distances that begin as the first element of the contact and grow, beyond 3 a twice as fast.
    Returns elements, edges (attribute, from, to) and vertices; attributes are 1 the contact, 2 the free surface beside it, 3 the far
    bottom, 4 the far sides."""
    a, nx, ny = contact[-1], len(contact) - 1, len(depth) - 1
    near_by = graded(a, 3 * a, contact[1] - contact[0], growth)
    far = graded(3 * a, domain, max(near_by[-1] - near_by[-2], 0.1 * a), 1 + 2 * (growth - 1))
    scales = [radius / a for radius in near_by[1:] + far[1:]]
    vertices = [(x, -y) for y in depth for x in contact]

    def at(i, j):
        return i + j * (nx + 1)

    elements = [(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j), at(i, j)) for j in range(ny) for i in range(nx)]
    # Down the left side of the box, along its bottom and up the right side.
    ring = [at(0, j) for j in range(ny)] + [at(i, ny) for i in range(nx + 1)] + [at(nx, j) for j in reversed(range(ny))]
    outline = [vertices[k] for k in ring]
    edges = [(1, at(i, 0), at(i - 1, 0)) for i in range(nx, 0, -1)]
    for scale in scales:
        outer = range(len(vertices), len(vertices) + len(ring))
        vertices += [(scale * x, scale * y) for x, y in outline]
        elements += [(ring[m], outer[m], outer[m + 1], ring[m + 1]) for m in range(len(ring) - 1)]
        edges += [(2, ring[0], outer[0]), (2, outer[-1], ring[-1])]
        ring = outer
    edges += [(3 if ny <= m < ny + nx else 4, ring[m], ring[m + 1]) for m in range(len(ring) - 1)]
    return elements, edges, vertices


def straight(elements, boundary, vertices):
    """An MFEM mesh of quadrilaterals of four vertices each and edges (attribute, from, to)."""
    return mesh_text([f"1 3 {a} {b} {c} {d}" for a, b, c, d in elements], [f"{tag} 1 {a} {b}" for tag, a, b in boundary],
                     ["%.17g %.17g" % vertex for vertex in vertices])


def mesh_text(elements, boundary, vertices, dimension=2):
    """An MFEM mesh of its lines."""
    lines = ["MFEM mesh v1.0", "", "dimension", str(dimension), "", "elements", str(len(elements)), *elements, "", "boundary",
             str(len(boundary)), *boundary, "", "vertices", str(len(vertices)), str(dimension), *vertices]
    return "\n".join(lines) + "\n"


def turned(angle):
    """For rectangle(): each place turned about (0, 0)."""
    c, s = math.cos(angle), math.sin(angle)
    return lambda x, y: (c * x - s * y, s * x + c * y)

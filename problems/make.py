#!/usr/bin/env python3
"""Writes this set of reduced problems and their solutions again, with the programs of this tree:

    ./run square_punch -h >/dev/null; . cmake/setup.sh; prepare miniapps solve_reduced   (once)
    python3 problems/make.py [build/release]

docs/reduced_problems.md describes the files."""
import json
import os
import random
import shlex
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)

# name: how the problem is made, its load history, increments of each piece of the history
SET = {
    # Complete contact of a free block on a rigid plane, f = 0.2: slip from both ends, then shear to and fro.
    "square_punch": ("square_punch -nodes 41 -grading 0.05 -shear none",
                     "0 0; 1 0; 1 0.16; 1 -0.16; 1 0.16", 5),
    # The same block on a similar half-plane, f = 0.4.
    "punch_on_half_plane": ("square_punch -nodes 41 -grading 0.05 -shear none -obstacle half-plane",
                            "0 0; 1 0; 1 0.32; 1 -0.32; 1 0.32", 5),
    # Equal half-planes, parabolic gap, f = 0.4: contact advances, then partial slip; B = 0.
    "hertz": ("hertz -domain 1e4 -nodes 41 -shear none", "0 0; 1 0; 1 0.24; 1 -0.24; 1 0.24", 5),
    # The same with another law of friction, which saturates, and a weaker one for slip backward.
    "hertz_two_laws": ("march -reduced %s/hertz.json -history 'P=0; P=0' -strength '0.001 0.0005 0.003 0.0011' "
                       "-strength-backward '0.001 0.0003 0.003 0.0007'" % HERE,
                       "0 0; 1 0; 1 0.24; 1 -0.2; 1 0.24", 5),
    # A strip that lifts off a half-plane, f = 0.7, loaded and unloaded: five zones.
    "receding_strip": ("plane_receding -overhang 2 -length 6 -domain 60 -side 24 -spacing 0.2 -corner 0.05",
                       "0; 1; 0.2", 10),
    # Two laps pinched by a bolt and pulled in cycles, f = 0.2.
    "lap_joint": ("lap_joint -spacing 0.1 -cycles 1", "0 0; 1 0; 1 0.04; 1 0; 1 0.04", 5),
    # A wedge of 15 degrees pressed into a block and let go, f = 0.6: it stays stuck; then pulled and pressed again.
    "wedge": (None, "0; 1; 0; -0.1; 0.5", 8),
    # A random dense problem, positive definite, friction 0.95 of the least critical A_ii/|B_ii|.
    "random_near_critical": (None, "0 0; 1 0; 1 3; 1 -3; 1 3", 5),
}


def wedge(programs, file):
    """Half of a symmetric wedge (x = 0: u_x = 0) whose flank leans by 15 degrees, in a block."""
    slope, n, height = 0.26794919243112270647, 24, 2.0  # tan 15 degrees

    def mesh(name, left, right, columns, attributes):
        bottom, side, top, other = attributes
        lines = ["MFEM mesh v1.0", "", "dimension", "2", "", "elements", str(columns * n)]
        at = lambda i, j: j * (columns + 1) + i
        lines += ["1 3 %d %d %d %d" % (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
                  for j in range(n) for i in range(columns)]
        lines += ["", "boundary", str(2 * (columns + n))]
        lines += ["%d 1 %d %d" % (bottom, at(i, 0), at(i + 1, 0)) for i in range(columns)]
        lines += ["%d 1 %d %d" % (side, at(columns, j), at(columns, j + 1)) for j in range(n)]
        lines += ["%d 1 %d %d" % (top, at(i + 1, n), at(i, n)) for i in range(columns)]
        lines += ["%d 1 %d %d" % (other, at(0, j + 1), at(0, j)) for j in range(n)]
        lines += ["", "vertices", str((columns + 1) * (n + 1)), "2"]
        for j in range(n + 1):
            y = height * j / n
            for i in range(columns + 1):
                s = i / columns
                lines.append("%.17g %.17g" % ((1 - s) * left(y) + s * right(y), y))
        with open(name, "w") as f:
            f.write("\n".join(lines) + "\n")

    flank = lambda y: 1 + slope * y
    with tempfile.TemporaryDirectory() as folder:
        inner, outer = os.path.join(folder, "wedge.mesh"), os.path.join(folder, "block.mesh")
        mesh(inner, lambda y: 0.0, flank, 12, (4, 3, 2, 1))
        mesh(outer, flank, lambda y: 4.0, 24, (2, 1, 4, 3))
        case = os.path.join(folder, "case.json")
        with open(case, "w") as f:
            json.dump({"version": 2, "order": 1, "history": ["P=0", "P=1"],
                       "bodies": {"wedge": {"mesh": inner, "young": 1, "poisson": 0.3, "support": "1:x", "load": "P pressure 2 1"},
                                  "block": {"mesh": outer, "young": 1, "poisson": 0.3, "support": "1:xy"}},
                       "interfaces": {"flank": {"between": ["wedge:3", "block:3"], "friction": 0.6, "pairing": 1e-6}}}, f)
        subprocess.run([os.path.join(programs, "contact"), "--case", case, "--save", file], check=True,
                       stdout=subprocess.DEVNULL)


def random_near_critical(file):
    rng, n = random.Random(2013), 24
    normal = lambda rows, cols: [[rng.gauss(0, 1) for _ in range(cols)] for _ in range(rows)]
    root = normal(2 * n, 2 * n)
    K = [[sum(a * b for a, b in zip(x, y)) / (2 * n) + (0.1 if x is y else 0) for y in root] for x in root]
    A, B, C = [r[:n] for r in K[:n]], [r[:n] for r in K[n:]], [r[n:] for r in K[n:]]
    dense = lambda M: {"rows": len(M), "cols": len(M[0]), "values": [M[i][j] for j in range(len(M[0])) for i in range(len(M))]}
    column = lambda x: {"rows": len(x), "cols": 1, "values": x}
    empty = lambda cols: {"rows": 0, "cols": cols, "values": []}
    f = 0.95 * min(A[i][i] / abs(B[i][i]) for i in range(n))
    patterns = [{"name": "press", "displacement": False, "q": column([0.1 * rng.gauss(0, 1) for _ in range(n)]),
                 "p": column([1 + 0.5 * rng.gauss(0, 1) for _ in range(n)])},
                {"name": "shear", "displacement": False, "q": column([rng.gauss(0, 1) for _ in range(n)]),
                 "p": column([0.3 * rng.gauss(0, 1) for _ in range(n)])}]
    gap = column([max(0.0, 0.2 * rng.gauss(0, 1)) for _ in range(n)])
    with open(file, "w") as out:
        json.dump({"format": "cattaneo reduced problem 2", "coupled": True, "chains": [], "held": [],
                   "rigid_motions": {"rows": 2 * n, "cols": 0, "values": []}, "A": dense(A), "B": dense(B), "C": dense(C),
                   "H": dense([[1.0, 0.0], [0.0, 1.0]]), "gap": gap, "friction": column([f] * n),
                   "weights": column([1.0] * n), "arc_length": empty(1), "position": empty(2), "dofs": empty(2),
                   "patterns": patterns}, out, separators=(",", ":"))
        out.write("\n")


def main():
    build = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build", "release"))
    programs = os.path.join(build, "miniapps")
    for name, (command, history, increments) in SET.items():
        file = os.path.join(HERE, name + ".json")
        if command:
            words = shlex.split(command)
            subprocess.run([os.path.join(programs, words[0])] + words[1:] + ["--save", file], check=True, stdout=subprocess.DEVNULL)
        elif name == "wedge":
            wedge(programs, file)
        else:
            random_near_critical(file)
        subprocess.run([os.path.join(build, "benchmarks", "peers", "solve_reduced"), file, history, str(increments),
                        os.path.join(HERE, name + ".solution.json")], check=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Files of other programs for core/exchange_test.cpp, and what must be found in them.

  python3 make.py [ccx]     needs NumPy and SciPy; with the name of a CalculiX (2.20) it also writes
                            laps.sti, quadratic.sti and ring.sti anew by running it

Stiffnesses here are integrals of this script's own over 4-node and 6-node elements, and expected.json
their Schur complements: nothing comes from Cattaneo. CalculiX's files are CalculiX's own.
"""
import json
import subprocess
import sys

import numpy as np
import scipy.io
import scipy.sparse

E, NU = 1000.0, 0.3
WIDE, HIGH = 4, 2


def shapes(kind, a, b):
    """Values and derivatives (2 x nodes) at a point of the reference element."""
    if kind == 4:
        s, t = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
        return ((1 + s * a) * (1 + t * b) / 4,
                np.array([s * (1 + t * b), t * (1 + s * a)]) / 4)
    c = np.array([1 - a - b, a, b])
    d = np.array([[-1.0, 1, 0], [-1, 0, 1]])
    pairs = [(0, 1), (1, 2), (2, 0)]
    value = np.concatenate([c * (2 * c - 1), [4 * c[i] * c[j] for i, j in pairs]])
    slope = np.hstack([d * (4 * c - 1),
                       np.array([4 * (d[:, i] * c[j] + c[i] * d[:, j]) for i, j in pairs]).T])
    return value, slope


def points(kind):
    if kind == 4:
        g = 1 / np.sqrt(3)
        return [(a, b, 1.0) for a in (-g, g) for b in (-g, g)]
    return [(1 / 6, 1 / 6, 1 / 6), (2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6)]


def element(x, kind, axisymmetric):
    """Stiffness of an element with nodes at these places (nodes x 2). Dofs are x, y of the first node, of the second, ..."""
    D = E / (1 + NU) / (1 - 2 * NU) * np.array(
        [[1 - NU, NU, NU, 0], [NU, 1 - NU, NU, 0], [NU, NU, 1 - NU, 0], [0, 0, 0, 0.5 - NU]])
    K = np.zeros((2 * len(x), 2 * len(x)))
    for a, b, weight in points(kind):
        value, slope = shapes(kind, a, b)
        J = slope @ x
        slope = np.linalg.solve(J, slope)
        B = np.zeros((4, 2 * len(x)))  # xx, yy, zz (around), xy
        B[0, 0::2], B[1, 1::2] = slope
        B[3, 0::2], B[3, 1::2] = slope[::-1]
        r = value @ x[:, 0]
        if axisymmetric:
            B[2, 0::2] = value / r
        K += B.T @ D @ B * np.linalg.det(J) * weight * (2 * np.pi * r if axisymmetric else 1)
    return K


def assembled(places, elements, kind, axisymmetric=False):
    numbers = sorted(places)
    at = {node: k for k, node in enumerate(numbers)}
    K = np.zeros((2 * len(numbers), 2 * len(numbers)))
    for nodes in elements.values():
        rows = [2 * at[n] + c for n in nodes for c in (0, 1)]
        K[np.ix_(rows, rows)] += element(np.array([places[n] for n in nodes]), kind, axisymmetric)
    return numbers, (K + K.T) / 2


def grid(first, x0, y0, first_element, skew):
    """Quadrilaterals on 2 x 1; rows of nodes from left to right."""
    places, elements = {}, {}
    for j in range(HIGH + 1):
        for i in range(WIDE + 1):
            inside = 0 < i < WIDE and 0 < j < HIGH
            places[first + j * (WIDE + 1) + i] = (x0 + 0.5 * i + (skew if inside else 0), y0 + 0.5 * j)
    for j in range(HIGH):
        for i in range(WIDE):
            n = first + j * (WIDE + 1) + i
            elements[first_element + j * WIDE + i] = (n, n + 1, n + WIDE + 2, n + WIDE + 1)
    return places, elements


def deck(name, blocks, kind, sets, supports, loads, step):
    text = ["** two blocks that touch" if len(blocks) > 1 else "** one block"]
    for block, (places, elements) in blocks.items():
        text += ["*NODE"] + [f"{n}, {x:.17g}, {y:.17g}" for n, (x, y) in places.items()]
        text += [f"*ELEMENT, TYPE={kind}, ELSET={block}"]
        text += [", ".join(map(str, (e, *nodes))) for e, nodes in elements.items()]
    for called, nodes in sets.items():
        text += [f"*NSET, NSET={called}", ", ".join(map(str, nodes))]
    text += ["*MATERIAL, NAME=ELASTIC", "*ELASTIC", f"{E}, {NU}", "*DENSITY", "1."]
    for block in blocks:
        text += [f"*SOLID SECTION, ELSET={block}, MATERIAL=ELASTIC"]
    if supports:
        text += ["*BOUNDARY"] + [f"{n}, {a}, {b}" for n, a, b in supports]
    text += ["*STEP", step]
    for cards in loads:
        text += ["*CLOAD"] + [f"{n}, {d}, {value}" for n, d, value in cards]
    text += ["*END STEP", ""]
    with open(name + ".inp", "w") as out:
        out.write("\n".join(text))


def schur(K, numbers, nodes, held=()):
    """On {x; y} of the nodes, with (node, direction) held."""
    row = {(n, c): 2 * k + c - 1 for k, n in enumerate(numbers) for c in (1, 2)}
    contact = [row[n, c] for c in (1, 2) for n in nodes]
    inner = [r for key, r in row.items() if r not in contact and key not in held]
    return K[np.ix_(contact, contact)] - K[np.ix_(contact, inner)] @ np.linalg.solve(
        K[np.ix_(inner, inner)], K[np.ix_(inner, contact)])


def abaqus_sparse(name, numbers, K, supports):
    with open(name + ".mtx", "w") as out:
        for i in range(len(K)):
            for j in range(i + 1):
                value = K[i, j]
                key = (numbers[i // 2], i % 2 + 1)
                if i == j and key in supports:
                    value += 1e36
                if value:
                    print(*key, numbers[j // 2], j % 2 + 1, f"{value:.15e}", sep=",", file=out)


def main():
    calculix = sys.argv[1] if len(sys.argv) > 1 else None
    matrix_step = "*FREQUENCY, SOLVER=MATRIXSTORAGE"
    expected = {}

    # Two laps in one file: the upper one free, the lower one held below.
    upper, upper_elements = grid(101, 0.5, 0, 1, 0.05)
    lower, lower_elements = grid(1, 0, -1, 11, -0.03)
    faces = {"UPPER_FACE": range(101, 106), "LOWER_FACE": range(15, 10, -1), "FLOOR": range(1, 6),
             "TOP": range(111, 116)}
    held = [(n, c) for n in range(1, 6) for c in (1, 2)]
    deck("laps", {"UPPER": (upper, upper_elements), "LOWER": (lower, lower_elements)}, "CPE4", faces,
         [("FLOOR", 1, 2)], [[("TOP", 2, -1.5)], [(115, 1, 2.0), (110, 1, 1.0)]], matrix_step)
    numbers, K_upper = assembled(upper, upper_elements, 4)
    expected["upper"] = schur(K_upper, numbers, range(101, 106))
    numbers, K_lower = assembled(lower, lower_elements, 4)
    expected["lower"] = schur(K_lower, numbers, range(15, 10, -1), held)

    # The lower one as ABAQUS writes it, and its rows in other forms.
    deck("abaqus", {"LOWER": (lower, lower_elements)}, "CPE4", {"FLOOR": range(1, 6), "FACE": range(11, 16)},
         [("FLOOR", "ENCASTRE", "")], [], "*MATRIX GENERATE, STIFFNESS")
    abaqus_sparse("abaqus", numbers, K_lower, held)
    free = [2 * k + c for k, n in enumerate(numbers) for c in (0, 1) if n > 5]
    sparse = scipy.sparse.csr_matrix(K_lower)
    scipy.io.mmwrite("rows.mtx", sparse, symmetry="symmetric", precision=17)
    scipy.sparse.save_npz("rows_csr.npz", sparse, compressed=False)
    scipy.sparse.save_npz("rows_compressed.npz", sparse)
    np.savez("rows_dense.npz", K=K_lower)
    for damaged, indices, start in (("index", [0, 1, 0.5, 1], [0, 2, 4]), ("start", [0, 1, 0, 1], [0, np.nan, 4])):
        np.savez(f"damaged_{damaged}.npz", data=np.ones(4), indices=indices, indptr=start, shape=[2, 2])
    np.save("rows.npy", np.asfortranarray(K_lower))
    with open("rows.dofs", "w") as out:
        print("# node direction x y", file=out)
        for n in numbers:
            for c in (1, 2):
                print(n, c, *lower[n], file=out)
        print("set FACE", *range(15, 10, -1), file=out)
        for n, c in held:
            print("fixed", n, c, file=out)

    # A dense superelement on the face of the lower one, by hand in the form of *USER ELEMENT.
    S = schur(K_lower, numbers, range(11, 16), held)
    by_nodes = [k + 5 * c for k in range(5) for c in (0, 1)]
    with open("superelement.mtx", "w") as out:
        print("**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT, NODES=         5, LINEAR", file=out)
        print("** ELEMENT NODES\n** 11, 12, 13,\n** 14, 15\n         1,         2\n*MATRIX,TYPE=STIFFNESS", file=out)
        for i, a in enumerate(by_nodes):
            row = [f"{S[a, b]:.16e}" for b in by_nodes[:i + 1]]
            for k in range(0, len(row), 4):
                print(" , ".join(row[k:k + 4]), file=out)
    with open("superelement.inp", "w") as out:
        print("*NODE, NSET=FACE", file=out)
        for n in range(11, 16):
            print(n, *lower[n], sep=", ", file=out)

    # Straight 6-node triangles, of half the squares' diagonals; and rings of 4-node elements.
    places, triangles, number = {}, {}, {}
    for j in range(2 * HIGH + 1):
        for i in range(2 * WIDE + 1):
            number[i, j] = 1 + len(places)
            places[number[i, j]] = (0.25 * i, 0.25 * j)
    for j in range(0, 2 * HIGH, 2):
        for i in range(0, 2 * WIDE, 2):
            a, b, c, d = (i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)
            for corners in ((a, b, c), (a, c, d)):
                middles = [((p[0] + q[0]) // 2, (p[1] + q[1]) // 2)
                           for p, q in zip(corners, corners[1:] + corners[:1])]
                triangles[len(triangles) + 1] = [number[p] for p in (*corners, *middles)]
    bottom = [number[i, 0] for i in range(2 * WIDE + 1)]
    deck("quadratic", {"BLOCK": (places, triangles)}, "CPE6", {"BOTTOM": bottom}, [], [], matrix_step)
    numbers, K = assembled(places, triangles, 6)
    expected["quadratic"] = schur(K, numbers, bottom)

    rings, ring_elements = grid(1, 0, 0, 1, 0.05)
    deck("ring", {"RING": (rings, ring_elements)}, "CAX4", {"BOTTOM": range(1, 6)}, [],
         [[(15, 2, -3.0)]], matrix_step)
    numbers, K = assembled(rings, ring_elements, 4, axisymmetric=True)
    axis = [(n, 1) for n, (r, z) in rings.items() if r == 0]
    # The contact nodes are those off the axis; the one on it moves along it.
    expected["ring"] = schur(K, numbers, range(2, 6), axis)

    with open("expected.json", "w") as out:
        json.dump({name: S.tolist() for name, S in expected.items()}, out)
    if calculix:
        for job in ("laps", "quadratic", "ring"):
            subprocess.run([calculix, job], check=True, stdout=subprocess.DEVNULL)
            for left in ("12d", "cvg", "dat", "frd", "mas", "sta"):
                subprocess.run(["rm", "-f", f"{job}.{left}"], check=True)


if __name__ == "__main__":
    main()

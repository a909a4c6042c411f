"""Chapter 3: static reduction, and three contacts that test it."""

import figures as f
import sketches
from chapter import Chapter

RIGID = "square_punch"
SIMILAR = 'square_punch -obstacle half-plane --shear "0.25 0.5 0.75"'
PARABOLA = 'hertz -body block -ratio 0.8 -shear none -load-levels "0.1 0.25 0.5 0.75 1"'

CHAPTER = Chapter(3, "Static reduction for frictional contact", """
A finite element model has thousands of unknowns, and only those of the contact nodes take part in contact. All others follow from them linearly: they are
eliminated once, exactly, and the result is a dense relation between the forces of the contact nodes (shear q, pressure p) and the relative displacements there (slip v, opening w),
q = A v + Bᵀ w + q^w(t), p = B v + C w + p^w(t), where q^w and p^w are the forces that the loads would cause if nothing moved. For two bodies the
relations are added through their flexibilities. Contact is *coupled* unless B = 0.

Each node is in one of four states. A node that *sticks* has w + g = 0, v constant and |q| ≤ f p. In *separation* p = q = 0 and w + g > 0. In *forward slip* q = -f p and v grows, in *backward slip* q = f p and v falls.
Here g is the initial gap. The loads are followed in increments, and in each of them states are sought that satisfy all these conditions to round-off. There are no contact elements, and no stiffness
of contact or of stick to choose. The thesis goes from node to node until nothing changes (Gauss-Seidel); here whole sets of states change at a time (an active set), and if that fails, a path changes
single nodes.

Three problems test it. Units: a = P0 = E' = 1 (the parabola: the half-width b and the largest pressure p0 of Hertz).
""")
figure = CHAPTER.figure


def pressed(run, name, only, **changes):
    return f.panels((run, name, {"only": only, "title": "", **changes}))


def alone(series):
    return series == "Q/fP = 0"


def times(*all_runs):
    """The thesis' seconds, and those of the runs."""
    rows = (("I, block on a rigid plane", 120, 2), ("II, block on a half-plane", 130, 2), ("III, parabola", 160, 4))
    body = "".join(f"<tr><td>{name}</td><td>{whole}</td><td>{reduced}</td><td>{run['dofs']}</td><td>{run['seconds']:.2g}</td></tr>"
                   for (name, whole, reduced), run in zip(rows, all_runs))
    head = "".join(f"<th>{word}</th>" for word in ("case", "thesis: finite elements, s", "thesis: reduced, s", "unknowns here", "here in all, s"))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def matrix_mesh():
    """A small mesh with its nodes numbered along the contact first."""
    sheet, (axes,) = f.sheet(1, height=2.6)
    s = sketches.Sketch(axes)
    columns, rows = 10, 4
    for i in range(columns + 1):
        s.line([i, i], [0, rows], width=0.6)
    for j in range(rows + 1):
        s.line([0, columns], [j, j], width=0.6)
    for i in range(columns + 1):
        s.text(i, -0.35, str(i + 1)).text(i, rows + 0.35, str(columns + 2 + i))
    s.text(columns / 2, -0.95, "contact: nodes 1 to 11").text(columns / 2, rows + 0.95, "loads: nodes 12 to 22")
    return sheet


def convention():
    """Entries of a file and their places."""
    lines = ((1, 1, 1, 1), (1, 2, 1, 1), (2, 1, 1, 2), (2, 2, 2, 1))
    body = "".join(f"<tr><td>{i}, {p}, {j}, {q}, s</td><td>{2 * (i - 1) + p}</td><td>{2 * (j - 1) + q}</td></tr>" for i, p, j, q in lines)
    return f'<div class="scroll"><table><thead><tr><th>line i, p, j, q, s</th><th>row k</th><th>column l</th></tr></thead><tbody class="plain">{body}</tbody></table></div>'


def flow():
    """Boxes from top to bottom, with the way back."""
    sheet, (axes,) = f.sheet(1, height=4.6)
    s = sketches.Sketch(axes)
    words = ("next increment of the loads", "every node keeps its state", "solve for slips, openings and forces", "does a node break the law of its state?", "no: the increment is done")
    for k, word in enumerate(words):
        s.box(-4, 4, -2 * k, -2 * k + 1.2, sketches.OTHER if k == 3 else sketches.BODY).text(0, -2 * k + 0.6, word)
        if k:
            s.arrow(0, -2 * k + 2, 0, -0.8, colour="black")
    s.line([4, 5.6, 5.6], [-5.4, -5.4, -3.4]).arrow(5.6, -3.4, -1.6, 0, colour="black").text(7.2, -4.4, "yes: change\nits state")
    s.line([-4, -5.6, -5.6], [-7.4, -7.4, 0.6]).arrow(-5.6, 0.6, 1.6, 0, colour="black")
    return sheet


CHAPTER.sketch("3.1", "Signs of forces", """
Shear q and pressure p of a contact node, on each body in its own frame: x along the contact, y into the body. The forces on both are then equal.""", sketches.signs)
CHAPTER.sketch("3.2", "Signs of displacements", "In the same frames the displacements of both bodies add up: slip v = v1 + v2, opening w = w1 + w2.", lambda: sketches.signs(True))
CHAPTER.sketch("3.3", "Gap of a contact node", "An initial gap g(s) is measured between nodes that face each other; nodes with w + g = 0 are in contact.", sketches.gap)
figure("3.4a", "Case I: a block on a rigid plane", f"{RIGID} --check", "The block with its loads and its contact nodes, as the program gets them.",
       lambda run: f.panels((run, "scene", {"title": ""}), height=4.2))
figure("3.4b", "Case I: the mesh", f"{RIGID} --check", "The finite elements of the block, finer toward the corners.",
       lambda run: f.panels((run, "mesh", {"title": ""}), height=4.2))
CHAPTER.sketch("3.5", "Load history", "P is applied and held, then Q grows; it acts on the top, with a linear pressure that balances its moment.",
               lambda: sketches.histories({"P": ([0, 1, 3], [0, 1, 1]), "Q": ([0, 1, 3], [0, 0, 0.9])}))
figure("3.6", "Case I: slip under P alone", RIGID, "Friction f = 0.2. The slip is antisymmetric; the middle sticks.",
       lambda run: pressed(run, "slip", alone), rows="P only")
figure("3.7", "Case I: slip under P and Q", RIGID, """
As soon as Q acts the trailing (left) side, whose slip it would reverse, sticks with its present slip. The slip zone of the leading side grows inward.""",
       lambda run: pressed(run, "slip", None), rows="right end")
figure("3.8", "Case II: slip under P alone", SIMILAR, "The same block on a half-plane of its own material, f = 0.4: much less slip.",
       lambda run: pressed(run, "slip", alone), rows="P only")
figure("3.9", "Case II: slip under P and Q", SIMILAR, "The block on the half-plane under growing shear.",
       lambda run: pressed(run, "slip", None), rows="right end")
CHAPTER.sketch("3.10a", "Case III: a parabolic punch", "The face of the block is a parabola: contact grows with the load.", lambda: sketches.gap(load=True))
figure("3.10b", "Case III: the mesh", f"{PARABOLA} --check", "The finite elements of the punch. The half-plane has none.",
       lambda run: f.panels((run, "mesh", {"title": ""}), height=4.2))
figure("3.11", "Case III: gap during loading", PARABOLA, "The distance of facing nodes while the load grows to that of b = 0.8 a. Where the distance is zero, there is contact.",
       lambda run: f.panels((run, "gaps", {"title": "", "limits_y": "-0.02,"})), rows="half-width")
figure("3.12", "Case III: pressure during loading", [PARABOLA, "hertz"], """
Pressures at the same loads. On a square block the contact is not that of Hertz, because the block is not a half-plane. Where both bodies are half-planes (second row of peak pressure) it is, to
five digits.""", lambda run, _: f.panels((run, "pressures", {"title": ""})), rows="peak|half-width")
LAWS = [f'march --reduced problems/punch_on_half_plane.json --history "P=0; P=1; Q=0.25; Q=-0.25" {law}'
        for law in ("--friction 0.4", "--strength '0.75 0.3 1 0.3'", "--strength '1 0.4' --strength-backward '1 0.28'")]
figure("3.9 (laws)", "Other laws of friction", LAWS, """
The method leaves the law of friction to its user, says the thesis. The square punch of 41 nodes under P and Q = −0.25 P after Q = 0.25 P, with Coulomb's law (f = 0.4); with a shear strength of at
most 0.3 P/a, like that of a soft coating, which limits the shear at the corners; and with f = 0.4 forward and 0.28 backward. Shear (dashed) is divided by the steepest slope of the law, so that
Coulomb's limit is reached where both curves meet.""", lambda *runs: f.panels(*((run, "tractions", {"title": title, "inside": "0.04",
                                                                             "rename": lambda s: s.replace("time 3", "pressure")}) for run, title in zip(
    runs, ("Coulomb", "Shear strength of 0.3 P/a", "Forward 0.4, backward 0.28"))), columns=2))
figure("3.7 (times)", "What the reduction saves", [RIGID, SIMILAR, PARABOLA], """
The thesis counts seconds of its three cases in a commercial program and by static reduction. Ours are of this page's run: meshes, elimination of all other unknowns, and all
increments. Other machines have other times; the ratio is what counts.""", times)
figure("3.9 (dislocations)", "Dislocation solutions", 'square_punch -obstacle half-plane -nodes 401 --shear none -dislocation "0 0.7"', """
A by-product that the thesis names: tractions of a glide dislocation, a jump of the slip by 1 at a place of the contact with everything else bonded. They are A v and B v. Close to the jump the
shear is that of an infinite body, E'/4πr (dashed); farther away the sides of the block have an influence, and there is pressure too.""", lambda run: f.panels((run, "dislocations", {"title": ""})))
CHAPTER.sketch("B", "A stiffness matrix from another program", """
The thesis draws a body in ABAQUS, numbers the nodes of its contact one after another, and asks for the stiffness matrix as a file of its own (`*MATRIX GENERATE, STIFFNESS`). Such files are read as they are, with the deck beside them
that has the places of the nodes; nodes need no order of their own. Matrices of CalculiX, MatrixMarket and NumPy do as well: `docs/exchange.md`. A case that stands on one: `./run contact --case meshes/calculix/laps.json`.""", matrix_mesh)
CHAPTER.sketch("C", "From lines of a file to a matrix", """
A line `i, p, j, q, s` of such a file is an entry of the lower triangle: s is the stiffness between direction p of node i and direction q of node j. The thesis' rows and columns are k = 2 (i - 1) + p and l = 2 (j - 1) + q, and the entry is
put at (k, l) and (l, k). Here internal nodes, which have negative numbers, are eliminated.""", convention)
CHAPTER.sketch("D", "The algorithm from increment to increment", """
The flow chart of the thesis: guess that every node keeps its state, solve, look for a node that breaks the law of its state, change it, and solve again until none does. Here a step goes from one change of a state to the next on a path that is exact in the plane; only where there is
no such path are increments solved as in the chart.""", flow)

"""The program for a user's own meshes on straight edges along curved sides, beside closed forms."""

import math

import pytest

from programs import curved, even, meshes, near, rectangle

NU = 0.3
MODULUS = 1 / (1 - NU * NU)  # of Young's modulus 1
CHORDS = "are taken for chords of smooth curves"


def mesh(run, name, along, into, place, nodes_on_curves=False, turn=0, split=False):
    """A body of straight edges, or with the nodes of its quadratic elements on the curves, over numbers from 0 to 1 along the side
    and into the body; attributes 1 (the side), 2, 3 (opposite of it) and 4, turned about the origin."""
    def at(s, t):
        x, y = place(s, t)
        c, d = math.cos(turn), math.sin(turn)
        return c * x - d * y, d * x + c * y

    run.write(name, curved(along, into, at) if nodes_on_curves else rectangle(even(0, 1, along), even(0, 1, into), at, split=split))


def body(name, support, load=None):
    made = {"mesh": name, "young": 1, "poisson": NU, "support": support}
    return {**made, "load": load} if load else made


def solved(run, case):
    """A run of a case, and the pressures of its nodes."""
    got = run.case({"history": ["P=0", "P=1"], "increments": 1, **case}, "--csv", run.folder / "out")
    return got, run.columns("out_nodes.csv")["p"]


def rings(order):
    """A quarter of two rings with an interference at radius 1."""
    return {"order": order,
            "bodies": {"in": body("in.mesh", "2:x 4:y"), "out": body("out.mesh", "2:y 4:x", "P pressure 3 1e-12")},
            "interfaces": {"fit": {"between": ["in:1", "out:1"], "friction": 0}}}


def arc(radius, into):
    def place(s, t):
        r, angle = radius + into * t, math.pi / 2 * (s if into < 0 else 1 - s)
        return r * math.cos(angle), r * math.sin(angle)

    return place


INNER, OUTER, FIT = 0.5, 2, 1e-3
# Lamé's pressure of two rings in a shrink fit.
LAME = FIT * MODULUS / ((OUTER * OUTER + 1) / (OUTER * OUTER - 1) + (1 + INNER * INNER) / (1 - INNER * INNER))


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.rest
def test_of_a_shrink_fit_have_lames_pressure(run, order):
    """Lamé's pressure in a shrink fit, of every order, everywhere closed, with a note; as meshed the pressure is that of polygons,
    and the estimate of it is right to a factor of two. The outer ring has two thirds more edges than the inner one."""
    for edges in meshes([9, 18], [6, 36, 60]):
        mesh(run, "in.mesh", edges, 6, arc(1 + FIT, INNER - 1 - FIT))
        mesh(run, "out.mesh", edges * 5 // 3, 8, arc(1, OUTER - 1))
        smooth, p = solved(run, rings(order))
        assert max(abs(value / LAME - 1) for value in p) < (0.02 if order > 1 else 0.6 / edges), edges
        assert CHORDS in smooth.listed("notes")
        assert smooth.listed("warnings") == ""
        polygons, p = solved(run, {**rings(order), "geometry": "as meshed"})
        assert polygons.listed("notes") == ""
        most = max(p)
        if most == 0:
            assert "no node carries a force now, but some may on the curves" in polygons.listed("warnings")
            continue
        # Errors of the node with the largest error, and of the largest pressure.
        wrong = {"node": max(abs(value - LAME) for value in p) / most, "peak": 1 - LAME / most}
        for which, share in wrong.items():
            # Linear elements have errors of their own, and their peak moves from node to node.
            if order == 1 and which == "peak":
                continue
            told = polygons.results.get(f"chords_{which}_pressure_change_estimate", 0)  # of the largest pressure
            assert told < max(2 * share, 0.1), (which, edges)
            if share > 0.1:
                assert told > share / 2, (which, edges)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("half", [False, True])
def test_of_a_cylinder_have_hertz_pressure(run, half, order):
    """A cylinder on a block, turned as a whole: the pressure of the mesh with curved edges, node for node; half of it at its plane of
    symmetry too."""
    w, load, turn = 0.5, 4e-3, 0 if half else 0.7

    def cylinder(s, t):
        x = w * (s if half else 2 * s - 1)
        low = 1 - math.sqrt(1 - x * x)
        return x, low + (0.9 - low) * t

    found = {}
    for on_curves in (True, False):
        mesh(run, "u.mesh", 20 if half else 40, 8, cylinder, on_curves, turn)
        mesh(run, "l.mesh", 24 if half else 48, 8, lambda s, t: (0.55 * (1 - s if half else 1 - 2 * s), -0.6 * t), turn=turn)
        on_axis = f"@{-0.9 * math.sin(turn)!r},{0.9 * math.cos(turn)!r}:x"
        got, found[on_curves] = solved(run, {
            "order": order,
            "bodies": {"u": body("u.mesh", "4:x" if half else on_axis, f"P pressure 3 {load}"),
                       "l": body("l.mesh", "3:xy 2:x" if half else "3:xy")},
            "interfaces": {"i": {"between": ["u:1", "l:1"], "friction": 0}}})
        assert (got.listed("notes") == "") == on_curves
    most = max(found[True])
    # Hertz, of a cylinder that is pressed by the load over its width.
    near(most, math.sqrt(2 * w * load * MODULUS / 2 / math.pi), 0.05 * most)
    for straight, on_curve in zip(found[False], found[True], strict=True):
        near(straight, on_curve, 2e-3 * most)


def test_do_not_fold_thin_elements(run):
    """Elements along the side that are thinner than the arc is high take the next ones with them."""
    for name, along, place in (("in.mesh", 9, arc(1.001, -0.5)), ("out.mesh", 15, arc(1, 1))):
        mesh(run, name, along, 10, lambda s, t, place=place: place(s, t**4))
    got, p = solved(run, rings(2))
    assert "smooth curves" in got.listed("notes")
    assert min(p) > 0.9 * max(p)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("others", [8, 6])
def test_do_not_fold_thin_triangles(run, others, order):
    """Layers of triangles, too: vertices stay where they are. Lamé's pressure everywhere, with as many edges on both sides, which
    meet at vertices, and with others."""
    def thin(t):
        return 0.06 * t if t < 0.1 else 0.006 + (t - 0.1) * 0.994 / 0.9

    for name, along, place in (("in.mesh", 8, arc(1 + FIT, INNER - 1 - FIT)), ("out.mesh", others, arc(1, OUTER - 1))):
        mesh(run, name, along, 10, lambda s, t, place=place: place(s, thin(t)), split=True)
    for pressure in solved(run, rings(order))[1]:
        near(pressure, LAME, 0.05 * LAME)


@pytest.mark.parametrize("order", [2, 3])
def test_only_edges_beside_folding_elements_stay_straight(run, order):
    """An element with two edges on a circle has no angle between them once they are curved: these edges stay straight, with the gaps
    of the circle, and the others do not."""
    lame = FIT * MODULUS / ((OUTER * OUTER + 1) / (OUTER * OUTER - 1) + 1)
    mesh(run, "in.mesh", 6, 6, lambda s, t: ((1 + FIT) * s * math.sqrt(1 - t * t / 2), (1 + FIT) * t * math.sqrt(1 - s * s / 2)))
    mesh(run, "out.mesh", 20, 8, arc(1, OUTER - 1))
    case = rings(order)
    case["bodies"]["in"] = body("in.mesh", "1:y 4:x")
    case["interfaces"]["fit"]["between"] = ["in:2,3", "out:1"]
    got, p = solved(run, case)
    assert "elements beside 2 of the 12 of in would fold" in got.listed("notes")
    for pressure in p:
        near(pressure, lame, 0.1 * lame)

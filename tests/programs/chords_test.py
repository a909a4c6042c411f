"""Sides of straight edges that stand for curves."""

import math
import re

import pytest

from programs import body, even, rectangle


def disc(run, name, angles, depth=1.0, radius=1.0, layers=6):
    """A part of a ring under its lowest point, boundary 1 on the outside; angles in degrees from there."""
    def place(angle, y):
        r, a = radius - depth * y, math.radians(angle)
        return r * math.sin(a), -r * math.cos(a)

    run.write(name, rectangle(angles, even(0, 1, layers), place))


def told(said):
    """What chords take of the largest pressure."""
    return float(re.search(r"to close that takes (\S+) of the largest pressure", said)[1])


@pytest.mark.parametrize("order", (1, 2, 3))
def test_that_bear_with_a_vertex_alone_are_told(run, order):
    """A polygon on a rigid line touches it with its vertices, where no chord is off its curve; from order 2 on it is off at the
    open nodes beside them. As meshed this ended in a fault of memory."""
    disc(run, "disc.mesh", even(-40, 40, 8), 0.5)
    keys = {"order": order, "geometry": "as meshed", "history": ["D=0", "D=1"],
            "bodies": {"disc": body("disc.mesh", None, ["D displacement-y 3 -7e-3", "D displacement-x 3 0"])},
            "interfaces": {"c": {"between": ["disc:1"], "friction": 0.1, "obstacle": {"line": [[-2, -1], [2, -1]]}}}}
    got = run.case(keys, "--csv", run.folder / "out")
    p = run.columns("out_nodes.csv")["p"]
    assert max(p) > 0
    if order > 1:
        assert sum(x > 0 for x in p) == 1
        assert told(got.warned()) > 0.05

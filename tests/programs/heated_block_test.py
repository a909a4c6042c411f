"""The program that stands alone."""

import pytest


@pytest.mark.parametrize("options", ["-n 0", "-n -3", "-o 0", "-o -1", "-nu 0.5", "-nu -1", "-E 0"])
def test_bad_options_are_one_sentence_and_exit_code_one(run, options):
    got = run("heated_block", *options.split(), code=1)
    assert "heated_block: option --" in got.output
    assert got.results is None


def test_says_that_it_does_not_reach_the_plane(run):
    """It grows by (1 + nu) alpha dT h = 0.0065 toward a plane at 1: nothing presses."""
    got = run("heated_block", "-g", 1)
    assert "does not reach the plane" in got.output
    assert "pressure from" not in got.output


def test_says_where_it_is_not_unique(run):
    """Friction so large has several answers from the first contact on, which is at no gap the first load."""
    got = run("heated_block", "-f", "1e6", code=2)
    assert "from heat = " in got.output and "at node " in got.output

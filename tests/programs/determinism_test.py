"""The same input gives the same bits, run by run, as separate processes."""

import json
import os

import pytest


def without_times(value):
    """Without what is measured in seconds."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if "seconds" not in key}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def test_the_same_threads_give_the_same_bits(run):
    """Two meshes, coupled contact, two cycles; the last state has every double to the last bit."""
    def dovetail(threads):
        got = run("contact", "--case", "meshes/dovetail.json", "--save-state", run.folder / "state.json", threads=threads)
        return without_times(got.results), json.loads(run.text("state.json"))

    one, two = dovetail(1), dovetail(2)
    assert "total_dissipation" in one[0] and "seconds" not in one[0]
    assert len(one[1]["v"]) > 10
    assert dovetail(1) == one
    assert dovetail(2) == two
    # So small a problem is done by one thread, however many there are.
    assert one == two


def test_threads_that_share_large_factors_give_the_same_bits_again(run):
    """3,002 unknowns, whose factors two threads share. Half a minute: ./test --all."""
    if os.environ.get("CATTANEO_STRESS") != "full":
        pytest.skip("CATTANEO_STRESS=full runs it")
    first, again = (without_times(run("hertz", "-nodes", "1501", threads=2).results) for _ in range(2))
    assert first == again

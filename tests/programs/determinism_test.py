"""The same input gives the same bits, run by run, as separate processes."""

import json

from programs import near


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
    # Another number of threads changes the order of the factorisation's sums.
    for name in ("total_dissipation", "peak_pressure"):
        near(one[0][name], two[0][name], 1e-10 * abs(one[0][name]))
    assert one[1]["status"] == two[1]["status"]

"""Linear elements as Poisson's ratio goes to 0.5."""


def test_linear_elements_are_warned_of(run):
    words = ["contact", "--case", "meshes/dovetail.json", "--cycles", 1, "--set", "bodies.root.poisson=0.495", "--order"]
    linear, quadratic = run(*words, 1), run(*words, 2)
    assert "warning: linear elements lock" in linear.output
    assert quadratic.output.find("lock") == quadratic.output.find("lock itself")
    # A dovetail is keyed: above this friction it can stay where it was pulled to.
    assert 0.1 < quadratic["critical_friction"]["locking"] <= 1 + 1e-9  # tan 45° of its flank

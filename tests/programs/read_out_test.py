"""Numbers that are read out between nodes: within the errors that are printed with them."""

import pytest

from programs import in_full, meshes, near


@pytest.mark.parametrize("load, c, spread", [
    ("-friction 0.2 -load 0.04", 0.5809, 5e-5),
    ("-friction 0.5 -load -0.04", 0.6685, 5e-5),
    ("-friction 0.8 -load 0.01", 0.685, 5e-4),
    ("-friction 0.8 -load 0.03", 0.6605, 5e-5),
    ("-friction 0.8 -load 0.04", 0.650, 5e-4),
])
def test_steady_stick_of_the_lap_joint_depends_on_mechanics_alone(run, load, c, spread):
    """Border of the nodes that slip at all within a steady cycle, from an independent program with a far finer mesh (the studies'
    notes, C). At a reload peak the nodes between the first and the steady border lie on the friction limit and do not slip: their
    states are ties, which once made c/t 0.6308 with 40 increments and 0.6501 with 41."""
    for spacing in meshes([0.02, 0.01], [0.005]):
        # The finer meshes take most of the time: all of them in ./test --all.
        marches = ["-stepping fixed -increments 20", ""]
        if in_full() or spacing >= 0.02:
            marches += [f"-stepping fixed -increments {count}" for count in (40, 41, 80)]
        found = []
        for march in marches:
            got = run.line(f"lap_joint {load} -spacing {spacing} {march}")
            error = got["c_steady_error_estimate"]
            # The error that is printed bounds the difference, and is no more than a spacing.
            near(got["c_steady"], c, error + spread)
            assert error <= spacing * (1 + 1e-9)
            found.append(got["c_steady"])
        for other in found:
            near(other, found[0], 0.01 * spacing)  # whatever the increments


@pytest.mark.parametrize("pulled", [True, False])
def test_edges_of_the_lap_joint_are_within_their_errors(run, pulled):
    """Frictionless extents and the first stick zone: the notes' values."""
    values = {"a0": (0.7011, 0.0005), "a": (0.6596, 0.0005) if pulled else (0.763, 0.001)}
    if pulled:
        values["c_first"] = (0.760 * 0.6596, 0.0005)
    for spacing in meshes([0.04, 0.02, 0.01], [0.005]):
        got = run.line(f"lap_joint {'' if pulled else '-load -0.04'} -increments 20 -spacing {spacing}")
        for key, (value, spread) in values.items():
            error = got[key + "_error_estimate"]
            near(got[key], value, error + spread)
            assert error <= spacing * (1 + 1e-9), key


def test_intensities_of_the_lap_joint_are_within_their_errors(run):
    """Intensities at the edges, fitted over a window that is chosen, against the finest mesh's."""
    def intensities(spacing):
        return run("lap_joint", "-friction", 0.4, "-spacing", spacing)["edges"][-1]

    finest = intensities(0.0025 if in_full() else 0.005)
    for spacing in meshes([0.04, 0.02, 0.01], [0.005]):
        edge = intensities(spacing)
        for key in ("k_n", "k_t"):
            one, best = edge[key], finest[key]
            near(one["value"], best["value"], sum(fit["relative_error_estimate"] * abs(fit["value"]) for fit in (one, best)))


@pytest.mark.parametrize("friction, s, e", [(0.3, 0.903, -1.858), (0.5, 1.169, -0.883), (0.7, 1.406, -0.442), (1, 1.730, -0.046)])
def test_edges_of_the_strip_are_within_their_errors(run, friction, s, e):
    """On a block of 1e4 t, n = 4 (± 0.003)."""
    for spacing in meshes([0.08, 0.04], [0.02]):
        within(run.line(f"plane_receding -domain 1e4 -corner 0.005 -friction {friction} -spacing {spacing}"),
               {"separation": s, "stick_slip": e}, 0.003, spacing)


@pytest.mark.parametrize("load, d, c", [
    ("-load-radius 0.5 -friction 0.9", 2.625, 0.849),
    ("-load-radius 2.5 -friction 0.5", 3.728, 1.879),
    ("-load-radius 2.5 -friction 0.8", 4.046, 2.384),
])
def test_edges_of_the_disc_are_within_their_errors(run, load, d, c):
    for spacing in meshes([0.1, 0.05], [0.025]):
        within(run.line(f"axisymmetric_receding {load} -domain 100 -spacing {spacing}"),
               {"separation": d, "stick": c}, 0.001, spacing)


def within(got, values, spread, spacing):
    """Are edges where they should be, to their errors, which are no more than a spacing?"""
    for key, value in values.items():
        error = got[key + "_error_estimate"]
        near(got[key], value, error + spread)
        assert error <= spacing * (1 + 1e-9), key


def test_half_widths_of_hertz_are_within_their_errors(run):
    for nodes in meshes([41, 65, 101], [161]):
        got = run("hertz", "-nodes", nodes)
        near(got["half_width"], 1, got["half_width_error_estimate"])
        assert got["half_width_error_estimate"] <= 3.34 / (nodes - 1)


def test_loads_that_look_alike_are_not_added(run):
    """Loads whose numbers look alike in six digits are two loads, each of its own size."""
    disc = "axisymmetric_receding -spacing 0.1 -bonded "
    bonded = run.line(disc + "'2.1 2.1000001 4.2'")["bonded"]
    assert len(bonded) == 3
    alone = run.line(disc + "2.1")["bonded"][0]["lowest_pressure"]
    for row in bonded[:2]:
        near(row["lowest_pressure"], alone, 1e-4 * alone)
    # The bonded ratio does not depend on the size of the load, its strength does.
    strip = "plane_receding -spacing 0.1 -corner 0.02"
    near(run.line(strip + " -map-overhang '4 4.0000001' -map-friction 0.7")["lowest_bonded_pressure"],
         run.line(strip)["lowest_bonded_pressure"], 1e-9)
    joint = run.line("lap_joint -map-load 0.02 -map-width '1 1.0000001' -spacing 0.05 -increments 10")
    assert joint["sweep"]
    for row in joint["sweep"]:
        near(row["a0"], joint["a0"], 1e-5)
    near(joint["peak_pressure"], 1.0468, 0.01)


@pytest.mark.parametrize("line, components", [
    ("lap_joint -spacing 0.05 -increments 5", 1),
    ("lap_joint -spacing 0.05 -increments 5 -bolt-positions '-1.2 0 1.2' -touch", 1),
    ("lap_joint -spacing 0.05 -increments 5 -map-load 0.02 -map-friction '0.2 0.4'", 1),
    ("plane_receding -spacing 0.1 -corner 0.02", 1),
    ("plane_receding -spacing 0.1 -corner 0.02 -map-overhang '2 3' -unload 0.5 -increments 5", 1),
    ("axisymmetric_receding -spacing 0.1 -map-load-radius '1 2'", 1),
    ("axisymmetric_receding -spacing 0.1 -friction 0", 0),
    ("axisymmetric_receding -spacing 0.1 -increments 10 -torque 0.3", 2),
    ("square_punch -nodes 33", 1),
    ("square_punch -nodes 33 -friction 0 -shear none", 0),
    ("hertz -nodes 33", 1),
    ("contact -case meshes/rounded_punch.json --cycles 1", 1),
    ("fretting --pad fe --friction 0.6 --material Ti6Al4V -nodes 41", 1),
])
def test_every_study_counts_its_friction_problem(run, line, components):
    """What a study did, whichever it is: tangential unknowns are one a contact node and component with friction, none without; the
    friction solver worked."""
    got = run.line(line)
    if line.startswith("fretting"):
        assert got["fe"]["counters"]["tangential_unknowns"] == 41
        return
    counters = got["counters"]
    assert counters["tangential_unknowns"] == components * got["contact_nodes"]
    for key in ("increments", "newton_steps", "dense_factorisations"):
        assert counters[key] > 0, key
    # Half-planes without a mesh have nothing to solve for.
    assert (counters["back_substitutions"] > 0) == (not line.startswith("hertz"))

"""Frequency and damping of a joint against amplitude: the table, its outcomes, and what is refused."""

import math

from programs import changed, near, near_relative, shipped

STEEL = 7.85e-9


def rows(got, mode):
    return [row for row in got["loops"] if row["mode"] == mode]


def test_small_loops_have_the_frequency_of_the_glued_mode(run):
    got = run.case(shipped("bolted_joint"), "--modes", 2, "--amplitudes", "2e-7 1e-5", program="joint")
    near(got["total_mass"], 700 * STEEL, 1e-15)
    assert got["rigid_modes_left_out"] == 0
    for mode in got["modes"]:
        assert mode["residual"] < 1e-7
        small, large = rows(got, mode["mode"])
        # Vibration has shaken off the shear that tightening has left.
        near_relative(small["omega"], mode["omega"], 1e-6)
        near_relative(small["omega_secant"], mode["omega"], 1e-6)
        assert small["zeta"] < 1e-9
        # Before that the first loading is softer.
        assert small["omega_first_loading"] < (1 - 5e-4) * mode["omega"]
        # The area of a steady loop is its loss, which is shared by the interfaces.
        near_relative(large["area"], large["dissipation"], 2e-9)
        near_relative(sum(face["loss"] for face in large["interfaces"].values()), large["dissipation"], 1e-12)
        for face in large["interfaces"].values():
            near(sum(face["node_losses"]), face["loss"], 1e-12 * large["dissipation"])
        near_relative(large["amplitude"], 1e-5, 1e-3)
        near_relative(large["zeta"], large["dissipation"] / (2 * math.pi * (large["omega"] * large["amplitude"])**2), 1e-12)


def test_a_joint_that_ratchets_or_slides_has_no_result(run):
    got = run.case(changed(shipped("bolted_joint"), {"interfaces.under_head.friction": 0.02}), "--modes", 1, "--amplitudes", "1e-3",
                   program="joint", code=None)
    [row] = got["loops"]
    assert row["status"] != "converged" and row["omega"] is None and row["zeta"] is None


def test_a_body_without_density_is_refused(run):
    case = shipped("bolted_joint")
    del case["bodies"]["nut"]["density"]
    error = run.case(case, program="joint", code=1).error
    assert "nut" in error and "density" in error, error


def test_it_is_said_where_units_cannot_be(run):
    case = changed(shipped("bolted_joint"), {"units": {"length": "mm", "force": "N"}, "bodies.nut.density": 7850})
    got = run.case(case, "--modes", 1, "--amplitudes", "1e-9", program="joint")
    assert "speed of sound" in got.warned() and "body nut" in got.warned()
    assert "speed of sound" not in run.case(changed(shipped("bolted_joint"), {"units": {"length": "mm", "force": "N"}}),
                                            "--modes", 1, "--amplitudes", "1e-7", program="joint").warned()


def test_bodies_in_space_are_refused(run):
    error = run.case(shipped("sphere_on_block"), program="joint", code=1).error
    assert "key 'analysis' is 'space', must be plane strain, plane stress or axisymmetric" in error, error

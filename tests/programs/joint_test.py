"""Frequency and damping of a joint against amplitude: the table, its outcomes, and what is refused."""

import math
import shutil
import subprocess

import pytest

from programs import ROOT, changed, near, near_relative, shipped

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
    got = run.case(case, "--modes", 1, "--amplitudes", "1e-4", program="joint")
    assert "speed of sound" in got.warned() and "body nut" in got.warned()
    assert "speed of sound" not in run.case(changed(shipped("bolted_joint"), {"units": {"length": "mm", "force": "N"}}),
                                            "--modes", 1, "--amplitudes", "1e-7", program="joint").warned()


def test_densities_of_no_solid_are_said(run):
    """Steel in kg/mm³ where mm and N ask for t/mm³: the speed of sound is a metal's no more, but a soft solid's could be so."""
    named = {"units": {"length": "mm", "force": "N"}}
    got = run.case(changed(shipped("bolted_joint"), named | {"bodies.nut.density": 7.85e-6}), "--modes", 1, "--amplitudes", "1e-4",
                   program="joint")
    [said] = got.results["warnings"]
    assert said.startswith("body nut: density 7.85e-06 is 7.85e+06 kg/m³") and "steel has 7.85e-09" in said, said
    speeds = got["speeds_of_sound"]
    near_relative(speeds["nut"]["least"], math.sqrt(210e9 / 7850e3), 1e-12)
    near_relative(speeds["head"]["most"], math.sqrt(210e9 / 7850), 1e-12)
    assert "in upper, lower, head: 5172 m/s" in got.output and "in nut: 163.6 m/s" in got.output, got.output
    # Steel in inches and pounds, in lbf s²/in⁴, is no reason for a warning.
    inches = {f"bodies.{body}.{key}": value for body in ("upper", "lower", "head", "nut")
              for key, value in (("young", 30.5e6), ("density", 7.345e-4))}
    got = run.case(changed(shipped("bolted_joint"), inches | {"units": {"length": "in", "force": "lbf"}}), "--modes", 1, "--amplitudes",
                   "1e-6", program="joint")
    assert "density" not in got.warned() and 5170 < got["speeds_of_sound"]["nut"]["least"] < 5180


@pytest.mark.rest
def test_a_range_without_amplitudes_ends_where_the_joint_ratchets(run):
    """And an energy at which it ratchets, which has no loop, is in the column of energies and not in that of amplitudes."""
    got = run.case(shipped("bolted_joint"), "--modes", 1, "--amplitude-of", "energy", program="joint")
    assert len(got["loops"]) >= 2 and all(row["status"] == "converged" for row in got["loops"]), got.output
    ratios = [two["energy"] / one["energy"] for one, two in zip(got["loops"], got["loops"][1:])]
    near_relative(max(ratios), min(ratios), 1e-2)
    [said] = [line for line in got.results["warnings"] if "the range ends at energy" in line]
    beyond = float(said.split("since at ")[1].split()[0])
    near_relative(beyond, got["loops"][-1]["energy"] * ratios[0], 1e-2)
    got = run.case(shipped("bolted_joint"), "--modes", 1, "--amplitude-of", "energy", "--amplitudes", f"1e-3 {beyond}", program="joint", code=2)
    small, large = got["loops"]
    near_relative(small["energy"], 1e-3, 1e-2)
    near_relative(small["energy"], (small["omega_secant"] * small["amplitude"])**2 / 2, 1e-9)
    assert large["status"].startswith("moves on") and large["energy"] == beyond and large["amplitude"] is None
    assert f"mode 1, energy {beyond:g}: " in got.warned(), got.warned()


def test_without_friction_there_are_modes_and_no_loops(run):
    """A head and a nut without friction slide freely on the plates: two more motions that nothing resists."""
    got = run.case(changed(shipped("bolted_joint"), {"interfaces.under_head.friction": 0, "interfaces.under_nut.friction": 0}), "--modes", 2,
                   program="joint", code=2)
    assert got["rigid_modes_left_out"] == 2 and len(got["modes"]) == 2 and "loops" not in got.results
    assert "friction is 0 at interface under_head, under_nut" in got.warned(), got.warned()
    assert got["message"] in got.warned()


def test_round_off_is_no_result(run):
    """Where all nodes stick nothing is lost, however small the amplitude is, down to one that is refused."""
    case = shipped("bolted_joint")
    error = run.case(case, "--modes", 1, "--amplitudes", "1e-30", program="joint", code=1).error
    assert "mode 1: amplitude 1e-30 must be at least" in error, error
    least = float(error.split("at least ")[1].split(":")[0])
    got = run.case(case, "--modes", 1, "--amplitudes", f"{1.01 * least} {10 * least} {100 * least}", program="joint")
    for row in got["loops"]:
        near_relative(row["omega"], got["modes"][0]["omega"], 1e-5)
        assert row["zeta"] == row["dissipation"] == 0 and row["interfaces"]["under_head"]["nodes_that_slip"] == 0


def test_nothing_presses(run):
    case = changed(shipped("bolted_joint"), {"history": ["bolt=0", "bolt=0", "Q=0"]})
    error = run.case(case, "--at-point", 1, program="joint", code=1).error
    assert "at point 1 of the history no contact node carries a force" in error, error


def test_a_sweep_has_the_amplitudes_of_its_run(run):
    got = run.case(shipped("bolted_joint"), "--modes", 1, "--amplitudes", "1e-6 2e-6", "--sweep", "order=1 2", "--sweep-results",
                   "loops.1.amplitude", program="joint")
    assert len(got["sweep"]) == 2, got.results
    for row in got["sweep"]:
        near_relative(row["loops.1.amplitude"], 2e-6, 2e-3)


def column(friction=0.8, density=0.7, poisson=0.0):
    """A column of E = 2 in space, of two blocks that a pressure on top holds together at z = 1, on a held bottom."""
    def block(z, cells, **more):
        return {"block": {"x": {"points": [0, 1], "cells": 3}, "y": {"points": [0, 0.8], "cells": 2}, "z": {"points": z, "cells": cells}},
                "young": 2, "poisson": poisson, "density": density, **more}
    return {"analysis": "space", "order": 1,
            "bodies": {"high": block([1, 2.5], 3, load="P pressure top 1e-3"), "low": block([0, 1], 2, support="bottom:xyz")},
            "interfaces": {"seam": {"between": ["high:bottom", "low:top"], "friction": friction}},
            "points": {"tip": [0.5, 0.4, 2.5]}, "history": ["P=0", "P=1"]}


def test_a_column_in_space_vibrates_as_a_rod(run):
    """Without Poisson's ratio five equal elements on end have their mode along z in closed form."""
    got = run.case(column(), "--modes", 5, "--amplitudes", "1e-9 1e-7", program="joint")
    near_relative(got["total_mass"], 0.7 * 2.5 * 0.8, 1e-12)
    assert got["rigid_modes_left_out"] == 0 and got["nodes_glued"] == 12 and got["nodes_open"] == 0
    h, k = 0.5, math.pi / (2 * 2.5)
    omega = math.sqrt(6 / h**2 * 2 / 0.7 * (1 - math.cos(k * h)) / (2 + math.cos(k * h)))
    [along] = [mode for mode in got["modes"] if mode["effective_mass_z"] > 0.5]
    near_relative(along["omega"], omega, 1e-8)
    # Of a continuous rod it is 8/π².
    near(along["effective_mass_z"], 8 / math.pi**2, 0.02)
    near(along["effective_mass_x"] + along["effective_mass_y"], 0, 1e-9)
    for way in "xyz":
        assert sum(mode[f"effective_mass_{way}"] for mode in got["modes"]) <= 1
    for mode in got["modes"]:
        for loop in rows(got, mode["mode"]):
            assert loop["status"] == "converged" and loop["zeta"] < 1e-9
            near_relative(loop["omega"], mode["omega"], 1e-6)


def test_tetrahedra_of_order_2_on_hexahedra(run):
    """Unknowns in the middle of their edges are not displacements. The frequency is that of finer hexahedra on hexahedra."""
    case = changed(column(poisson=0.3), {"bodies.high.block.elements": "tetrahedra", "order": 2})
    got = run.case(case, "--modes", 1, "--amplitudes", "1e-5", program="joint")
    near_relative(got["loops"][0]["omega"], got["modes"][0]["omega"], 1e-6)
    fine = run.case(changed(column(poisson=0.3), {"order": 2}), "--modes", 1, "--amplitudes", "1e-5", program="joint")
    near_relative(got["modes"][0]["omega"], fine["modes"][0]["omega"], 0.02)


def test_equal_frequencies_are_said(run):
    """A square column bends alike both ways."""
    square = column()
    for body in square["bodies"].values():
        body["block"]["y"] = {"points": [0, 1], "cells": 3}
    square["points"]["tip"] = [0.5, 0.5, 2.5]
    got = run.case(square, "--modes", 2, "--amplitudes", "1e-7", program="joint")
    one, two = got["modes"]
    near_relative(one["omega"], two["omega"], 1e-8)
    assert "modes 1 and 2 have the same frequency" in got.warned(), got.warned()
    assert "same frequency" not in run.case(column(), "--modes", 2, "--amplitudes", "1e-7", program="joint").warned()


def test_a_column_in_space_loses_work_where_it_slips(run):
    got = run.case(column(friction=0.3, poisson=0.3), "--modes", 1, "--amplitudes", "5e-3", "--amplitude-at", "tip",
                   "--csv", run.folder / "out", program="joint")
    [row] = got["loops"]
    [mode] = got["modes"]
    assert row["status"] == "converged" and row["omega"] < 0.999 * mode["omega"] and row["zeta"] > 1e-4
    near_relative(row["amplitude"], 5e-3, 0.02)
    # The mode moves the tip by its own length: the modal mass is 1.
    assert row["amplitude"] / math.sqrt(got["total_mass"]) < row["at_point"] < 3 * row["amplitude"] / math.sqrt(got["total_mass"])
    square = 2 * math.pi * (row["omega"] * row["amplitude"])**2
    near_relative(row["zeta"], row["dissipation"] / square, 1e-9)
    near(row["area"], row["dissipation"], square * row["zeta_error_estimate"])
    near_relative(sum(row["interfaces"]["seam"]["node_losses"]), row["dissipation"], 1e-12)
    assert row["zeta_error_estimate"] <= 0.02 * row["zeta"] and row["omega_error_estimate"] <= 0.002 * row["omega"]
    # Where it loses is drawn as a map.
    assert (run.folder / "out_losses_1.csv").exists()


def bolted_plates(history, **more_bolts):
    """Two plates in space and bolts through them, B and others."""
    def plate(z, **more):
        return {"block": {"x": {"points": [-3, -1, 1, 3], "cells": [2, 2, 2]}, "y": {"points": [-1, 1], "cells": 2},
                          "z": {"points": z, "cells": 2}},
                "young": 200, "poisson": 0.3, "density": 1e-3, **more}
    return {"analysis": "space", "order": 1,
            "bodies": {"high": plate([0, 0.5]), "low": plate([-0.5, 0], support="left:xyz")},
            "interfaces": {"seam": {"between": ["high:bottom", "low:top"], "friction": 0.3}},
            "bolts": {"B": {"between": ["high:top", "low:bottom"], "stiffness": 20, "preload": 0.5}, **more_bolts}, "history": history}


def test_bolts_in_space_lose_force(run):
    """Two plates and a bolt through the middle of them, which bend together."""
    case = bolted_plates(["B=0", "B=1"])
    got = run.case(case, "--modes", 1, "--amplitudes", "1e-6 1e-3", program="joint")
    small, large = got["loops"]
    near_relative(small["omega"], got["modes"][0]["omega"], 1e-6)
    near_relative(small["bolts"]["B"]["force"], 0.5, 1e-9)
    near(small["bolts"]["B"]["lost"], 0, 1e-6)
    assert large["zeta"] > 1e-6 and large["bolts"]["B"]["least"] < 0.5


def test_a_bolt_that_is_not_tightened_yet_is_left_out(run):
    """Before its tightening a joint is that of a case without the bolt, also where a point names its force of zero."""
    other = {"between": ["high:top", "low:bottom"], "stiffness": 50, "preload": 0.2}
    words = ("--modes", 2, "--amplitudes", "1e-5 1e-3")
    alone = run.case(bolted_plates(["B=0", "B=1"]), *words, program="joint")
    for history in (["B=0", "B=1", "C=1"], ["B=0", "B=1; C=0", "C=1"]):
        half = run.case(bolted_plates(history, C=other), *words, "--at-point", 1, program="joint")
        assert half["bolts_not_tightened"] == ["C"] and "left out: C" in half.output and half["loads"] == alone["loads"]
        assert len(half["loops"]) == 4
        for key in ("modes", "loops"):
            for one, two in zip(half[key], alone[key]):
                near_relative(one["omega"], two["omega"], 1e-9)
        near_relative(half["loops"][1]["zeta"], alone["loops"][1]["zeta"], 1e-6)
    both = run.case(bolted_plates(["B=0", "B=1", "C=1"], C=other), *words, program="joint")
    assert "bolts_not_tightened" not in both.results and set(both["loops"][0]["bolts"]) == {"B", "C"}
    # A bolt that the history forgets is an error, also before.
    error = run.case(bolted_plates(["B=0", "B=1"], C=other), *words, "--at-point", 1, program="joint", code=1).error
    assert "'C' is never tightened" in error, error


def test_obstacles_free_to_move_have_no_mass(run):
    case = changed(shipped("sphere_on_block"), {"bodies.block.density": STEEL})
    error = run.case(case, program="joint", code=1).error
    assert "no obstacle may be free to move, since it has no mass" in error, error


def test_matrices_with_a_mass(run):
    """The laps of CalculiX, whose stiffness and mass ccx writes now."""
    case = shipped("calculix/laps")
    error = run.case(case, program="joint", code=1).error
    assert "key 'bodies.upper.mass' is missing" in error, error
    if shutil.which("ccx") is None:
        pytest.skip("there is no ccx (Debian: calculix-ccx)")
    shutil.copy(ROOT / "meshes" / "calculix" / "laps.inp", run.folder)
    subprocess.run(["ccx", "laps"], cwd=run.folder, check=True, capture_output=True, timeout=100)
    for name in ("upper", "lower"):
        case["bodies"][name] |= {"matrix": "laps.sti", "mass": "laps.mas"}
    got = run.case(case, "--modes", 2, "--amplitudes", "1e-9", "--at-point", 1, program="joint")
    # Held nodes have no rows. They are at the end of elements 0.125 wide, of which they have the mass ∫(1 - (x/h)²).
    near_relative(got["total_mass"], 7.8e-9 * 0.5 * (4 - 0.125 * 2 / 3), 1e-6)
    for mode in got["modes"]:
        [loop] = rows(got, mode["mode"])
        near_relative(loop["omega"], mode["omega"], 1e-6)
    # Four times the mass at half of the frequencies.
    lines = [line.split() for line in run.text("laps.mas").splitlines()]
    run.write("laps.mas", "".join(f"{i} {j} {4 * float(value):.14e}\n" for i, j, value in lines))
    slow = run.case(case, "--modes", 2, "--amplitudes", "1e-9", "--at-point", 1, program="joint")
    for one, other in zip(slow["modes"], got["modes"]):
        near_relative(one["omega"], other["omega"] / 2, 1e-6)
    case["bodies"]["lower"]["mass"] = "other.mas"
    error = run.case(case, program="joint", code=1).error
    assert "key 'bodies.lower.mass' is" in error and "must be the same" in error, error


def test_a_load_of_forces_and_displacements_moves_both(run):
    """The displacements of such a load go with its forces to the point about which the joint vibrates."""
    case = changed(shipped("bolted_joint"), {"bodies.lower.support": "end:x", "history": ["Q=0", "bolt=1", "Q=1"]})
    case["bodies"]["lower"]["load"] = "Q displacement-y end 1e-4"
    got = run.case(case, "--modes", 1, "--amplitudes", "1e-9", "--at-point", 2, program="joint")
    loads = got["loads"]
    assert loads["Q"] == 1 and loads["Q.moved"] == 1, loads

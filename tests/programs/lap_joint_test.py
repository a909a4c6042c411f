"""A lap joint with bolts: work, edges, losses and what is said of them."""

import math

import numpy
import pytest

from programs import near, near_relative


def test_work_error_falls_with_the_increments(run):
    error = 1
    for increments in (10, 30, 90):
        got = run("lap_joint", "-spacing", 0.02, "-stepping", "fixed", "-increments", increments)
        last = got["cycles"][-1]
        near(got["work_error"], last["external_work"] / last["dissipation"] - 1, 1e-9)  # its sign is that of the table
        assert abs(got["work_error"]) < 0.5 * error, increments  # a third, at first order
        error = abs(got["work_error"])


def test_it_is_said_where_free_ends_touch(run):
    """By the closed sweep of --touch: beyond that compression the ends press, before it they do not."""
    narrow = "lap_joint -width 0.5 -friction 0.5 -spacing 0.05 -increments 10 "
    touch = run.line(narrow + "-load -0.02 -touch")["touch_load"]
    assert touch < -0.03
    for share in (0.8, 1.2):
        load = f"{share * touch:f}"
        for way in (f"-load {load}", f"-load 0.01 -map-load {load}"):
            assert ("free end of the laps touches" in run.line(narrow + way).output) == (share > 1), (share, way)


def test_edges_of_the_receding_contact_have_intensities(run):
    small, large, coarse = (run.line("lap_joint -increments 20 " + more)
                            for more in ("-load 0.01", "-load 0.02", "-load 0.02 -spacing 0.01"))
    for got in (small, large, coarse):
        assert len(got["edges"]) == 2
    for e, (half, edge, other) in enumerate(zip(small["edges"], large["edges"], coarse["edges"])):
        assert edge["complete"] is False
        k_n, k_t = edge["k_n"]["value"], edge["k_t"]["value"]
        # The tractions at a spacing of 1/1600, divided by √(a² - x²) and expanded in even powers of x up to x¹⁰ to x¹⁸, have
        # K_N = 0.9218 ± 0.0008; K_T of spacings of 1/800 and 1/1600 is 0.01097 and 0.01098.
        for one in (edge, other):
            n, t = one["k_n"], one["k_t"]
            near(n["value"], 0.9218, n["relative_error_estimate"] * n["value"])
            near(abs(t["value"]), 0.01098, t["relative_error_estimate"] * abs(t["value"]))
        # The error of the edge's position, a quarter of a spacing, is half of these.
        assert edge["k_n"]["relative_error_estimate"] < 0.04
        assert edge["k_t"]["relative_error_estimate"] < 0.04
        # Half the spacing, half the error at most.
        assert edge["k_t"]["relative_error_estimate"] < 0.5 * other["k_t"]["relative_error_estimate"]
        near(k_n, 0.9218, 0.005 * k_n)
        near(abs(k_t), 0.01098, 0.01 * abs(k_t))
        near(other["k_n"]["value"], k_n, 0.02 * k_n)
        near(other["k_t"]["value"], k_t, 0.03 * abs(k_t))
        # The upper lap drags the lower one to the left: into the contact at the right edge.
        assert k_t * (-1 if e == 0 else 1) > 0
        # The stuck shear is linear in the load, but for the edge that recedes.
        near(k_t, 2 * half["k_t"]["value"], 0.05 * abs(k_t))
        # The receding edge leaves a part of the slip zone behind: the prediction, for constant K_N, is too long, and the program
        # says so.
        predicted, d = edge["slip_zone_predicted"], edge["slip_zone"]
        near(predicted, 2 * abs(k_t) / (0.2 * k_n), 1e-12 * d)
        assert d < predicted < 1.4 * d
        assert "edge moves" in edge["notes"][0]
    # Both edges together lose what the cycle loses, and are alike.
    left, right = large["edges"]
    near(left["energy"] + right["energy"], large["dissipation_steady"], 1e-9 * left["energy"])
    near(left["k_n"]["value"], right["k_n"]["value"], 1e-5)


@pytest.mark.parametrize("cycles, steady", [(1, False), (5, True)])
def test_only_what_is_steady_is_called_so(run, cycles, steady):
    """One cycle alone can be no steady one: its figures have another name than those that are."""
    got = run("lap_joint", "--spacing", 0.05, "--cycles", cycles)
    assert (got["steady_cycle"] > 0) == steady
    for name in ("c", "dissipation"):
        assert (name + "_steady" in got.results) == steady
        assert (name + "_last" in got.results) == (not steady)


def test_zones_do_not_depend_on_poissons_ratio(run):
    a, b = (run("lap_joint", "-spacing", 0.0125, "-poisson", poisson) for poisson in (0, 0.4))
    for key in ("a0", "a", "c_first", "c_steady"):
        near(a[key], b[key], 1e-3)


def test_sweep_knows_nothing_of_what_slid_away(run):
    """A pull above f P0 is no row of zeros: where the march did not come to is not known."""
    held, slid = run.line("lap_joint -spacing 0.05 -increments 5 -map-load '0.05 0.3' -map-friction 0.2")["sweep"][:2]
    assert slid["status"] == "gross sliding"
    assert slid["a0"] == held["a0"]  # both were pinched alike
    assert slid["a0"] > 0.5
    for key in ("a", "c_first", "c_steady", "dissipation_first", "dissipation_steady", "steady_cycle"):
        assert slid[key] is None, key
        assert held[key] > 0, key


def test_what_nothing_pulls_has_no_shear(run):
    """Equal laps that nothing pulls are sheared nowhere: the rest of it is round-off, and shown as none."""
    got = run.line("lap_joint -load 0 -spacing 0.025")
    assert got["asymmetry"] < 1e-7  # of p
    assert got["residual_shear"] == 0
    assert len(got["edges"]) == 2
    for edge in got["edges"]:
        assert edge["k_t"]["value"] == 0
        assert edge["slip_zone_predicted"] == 0


def test_dissipation_falls_with_friction_and_rises_with_load(run):
    got = run.line("lap_joint -map-load '0.02 0.04' -map-friction '0.2 0.4 0.8' -spacing 0.00625")
    losses = [row["dissipation_steady"] for row in got["sweep"]]
    assert len(losses) == 6
    low, high = losses[::2], losses[1::2]
    # The notes: 1.938e-4 at f = 0.2, T = 0.04, ±0.3 %, with 20 increments 0.2 % and the mesh less; and about T^2.9, two digits of
    # an exponent that a mesh of few slipping nodes shifts.
    near_relative(high[0], 1.938e-4, 0.006)
    for one, other in zip(high, low):
        near(math.log2(one / other), 2.9, 0.15)
    # A slip zone that stays near its edge loses ΔK_T³/(f K_N): half at twice the friction. The edge recedes by more than short
    # zones are long, which costs them more; a zone wider than near the edge loses 5 % less of the difference.
    for less, more in zip(high, high[1:]):
        assert 1.9 < less / more < 4.0
    assert got["counters"]["factorisations"] == 1


def test_order_of_tightening_matters_only_for_unequal_laps(run):
    words = "lap_joint -bolt-positions '-1.2 0 1.2' -friction 0.2 -load 0.1 -spacing 0.025 -increments 20"
    equal, unequal = run.line(words), run.line(words + " -lower-thickness 2")
    assert len(equal["tightening"]) == len(unequal["tightening"]) == 2
    for same, other in zip(equal["tightening"], unequal["tightening"]):
        assert same["residual_shear"] < 1e-3
        assert other["residual_shear"] > 1e-2
    assert unequal["counters"]["factorisations"] == 2


def beam(x, height, mass, count):
    """Circular frequencies of a beam of E' = 1 and density 1 between simple supports at its ends, by cubic elements between x."""
    n = len(x)
    K, M = numpy.zeros((2 * n, 2 * n)), numpy.zeros((2 * n, 2 * n))
    for k in range(n - 1):
        h, at = x[k + 1] - x[k], slice(2 * k, 2 * k + 4)
        K[at, at] += height[k]**3 / 12 / h**3 * numpy.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                                                             [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])
        M[at, at] += mass[k] * h / 420 * numpy.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                                                      [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]])
    free = [i for i in range(2 * n) if i not in (0, 2 * n - 2)]
    L = numpy.linalg.inv(numpy.linalg.cholesky(M[numpy.ix_(free, free)]))
    return numpy.sqrt(numpy.linalg.eigvalsh(L @ K[numpy.ix_(free, free)] @ L.T))[:count]


def test_modes_are_those_of_a_beam(run):
    """The laps between the supports are beams of t/2, where they are pinched one of t. Free ends of the overlap add their mass."""
    density = 4.0
    got = run("lap_joint", "--spacing", 0.05, "--modes", 2, "--amplitudes", "1 30", "--density", density)
    near_relative(got["total_mass"], density * 2 * (16 + 1.95) * 0.5, 1e-12)
    assert got["rigid_modes_left_out"] == 1  # along x
    a = got["a0"]
    x = numpy.concatenate([numpy.linspace(-16, -1.95, 40), [-a, 0, a], numpy.linspace(1.95, 16, 40)])
    middle = abs(x[1:] + x[:-1]) / 2
    height, mass = numpy.where(middle < a, 1, 0.5), density * numpy.where(middle < 1.95, 1, 0.5)
    for mode, omega in zip(got["modes"], beam(x, height, mass, 2)):
        near_relative(mode["omega"], omega, 0.03)
        small, large = (row for row in got["loops"] if row["mode"] == mode["mode"])
        near_relative(small["omega"], mode["omega"], 1e-6)
        assert small["zeta"] < 1e-9 and small["status"] == large["status"] == "converged"
    # A larger bending of the first mode opens and closes the edges of contact, where nodes then slip.
    large = got["loops"][1]
    assert large["zeta"] > 1e-5 and large["omega"] < (1 - 1e-4) * got["modes"][0]["omega"]
    near_relative(large["area"], large["dissipation"], 2e-9)
    # Steel, said in the output, has frequencies in Hz for t = 1 mm.
    steel = run("lap_joint", "--spacing", 0.05, "--modes", 1, "--amplitudes", 1e-7)
    near_relative(steel["density"], 7.85e-9 * 0.91 / 210e3, 1e-12)
    near_relative(steel["modes"][0]["omega"], got["modes"][0]["omega"] * math.sqrt(density / steel["density"]), 1e-8)
    run.refuses("lap_joint", ["--density", 1], ["option --density does nothing in this run", "goes with --modes"])

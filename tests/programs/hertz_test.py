"""A cylinder and a block: closed forms of Hertz, Cattaneo and Mindlin."""

import math

import pytest

from programs import near

# 101 nodes over ±1.67 b: edges are read out to a tenth of the spacing.
READ_OUT = 0.1 * 2 * 1.67 / 100


@pytest.mark.parametrize("domain", ["0", "1e4"])
@pytest.mark.parametrize("order", [1, 2])
def test_half_planes_meet_the_closed_forms_at_both_orders(run, order, domain):
    got = run.line(f"hertz --shear '0.3 0.6 0.9' -order {order} -domain {domain}")
    # Closed forms. Peak: what the studies' notes measured of bilinear and quadratic elements.
    got.meets({"peak pressure / p0 Hertz": (1, 0, 2e-3 if order == 1 else 8e-5),
               "half-width / b Hertz": (1, 0, READ_OUT),
               **{f"stick half-width / b, Q/fP = {shear}": (math.sqrt(1 - shear), 0, READ_OUT) for shear in (0.3, 0.6, 0.9)}})
    # Half-planes have no mesh. Of two equal bodies one is factored.
    meshed = domain != "0"
    assert got["counters"]["assemblies"] == (2 if meshed else 0)
    assert got["counters"]["factorisations"] == (1 if meshed else 0)


@pytest.mark.parametrize("domain", [0, 1000])
def test_tractions_converge_to_the_closed_forms(run, domain):
    """Mean over the line: of first order at least; single steps vary with where the edge of contact lies in its element."""
    deviations = []
    for nodes in (51, 451):
        got = run("hertz", "-domain", domain, "-nodes", nodes)
        deviations.append(got["pressure_deviation_mean"])
        near(got["levels"][0]["stick_half_width"], math.sqrt(1 - 0.6), 3.34 / (nodes - 1) * 0.15)
    coarse, fine = deviations
    assert fine < coarse / 9


@pytest.mark.parametrize("ratio, half_width, peak", [(0.4, 0.989, 1.011), (0.8, 0.959, 1.047)])
@pytest.mark.parametrize("order", [1, 2])
def test_block_meets_the_references_at_both_orders(run, order, ratio, half_width, peak):
    got = run.line(f"hertz -body block --shear '' -ratio {ratio} -order {order}")
    got.meets({"half-width / b Hertz": (half_width, 0.003, READ_OUT), "peak pressure / p0 Hertz": (peak, 0.003, 0)})


def test_coupled_contact_grows_node_by_node_however_it_is_cut(run):
    """The block's contact advances from one change of state to the next: a single increment comes to what twenty come to."""
    once, often = (run.line(f"hertz -body block --shear '' -increments {count}") for count in (1, 20))
    assert once["counters"]["increments"] == 1
    assert once["counters"]["newton_steps"] > 15
    for value in ("half_width", "peak_pressure"):
        near(once[value], often[value], 1e-12)


@pytest.mark.parametrize("options", ["-body ball", "-ratio 1.5", "-span 0.5", "-nodes 8", "-domain 5", "-friction -1",
                                     "-poisson 0.7", "--unknown"])
def test_bad_options_are_one_sentence_and_exit_code_one(run, options):
    run.refuses("hertz", options.split(), [])


def test_frictionless_is_pressed_alone(run):
    """Without friction there is no f P that Q could be a share of: it is pressed alone."""
    got = run.line("hertz -friction 0")
    assert got["levels"] == []
    assert not [row for row in got["references"] if "Q/fP" in row["quantity"]]
    near(got["half_width"], 1, 0.01)
    run.line("hertz -friction 0 -shear 0.3", code=1)


def test_stick_of_one_node_is_known_to_a_spacing(run):
    """At Q = f P nothing sticks but the node where the mesh ends: it says nothing within its spacing, 2 * 1.67 b over 100
    intervals."""
    got = run.line("hertz -shear 1")
    row, = [row for row in got["references"] if row["quantity"] == "stick half-width / b, Q/fP = 1"]
    assert row["computed"] <= 0.0334
    assert row["mesh"] >= 0.0333
    assert row["outside"] is False

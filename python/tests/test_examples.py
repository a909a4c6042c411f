"""The examples and the study `sphere`, and every Python example of README.md, docs/python.md and docs/half_space.md, as a user runs them."""

import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

EXAMPLES = ROOT / "python" / "examples"


def run(*words, cwd=ROOT):
    """Its output; fails with all of it if it does not end well."""
    done = subprocess.run([sys.executable, *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def numbers(text):
    return [float(word) for word in re.findall(r"-?\d+\.?\d*(?:e[-+]\d+)?", text)]


def test_hertz():
    """Against Hertz's own figures, in the output; the block is forty half-widths wide, not a half-plane."""
    pytest.importorskip("skfem")
    out = run(EXAMPLES / "hertz.py")
    for line in ("half-width", "peak pressure"):
        computed, exact = numbers(next(each for each in out.splitlines() if each.startswith(line)).split(line)[1])
        assert computed == pytest.approx(exact, rel=2e-3)


def test_calculix_loop(tmp_path):
    """The loss of a cycle is the area of the loop, from a matrix that was shipped; and from one that ccx writes now."""
    shipped = run(EXAMPLES / "calculix_loop.py")
    assert "converged" in shipped and "loss of a cycle" in shipped
    if shutil.which("ccx") is None:
        pytest.skip("there is no ccx (Debian: calculix-ccx) to write the matrix anew")
    shutil.copy(ROOT / "meshes" / "calculix" / "laps.inp", tmp_path)
    subprocess.run(["ccx", "laps"], cwd=tmp_path, check=True, capture_output=True, timeout=100)
    figure = tmp_path / "loop.png"
    again = run(EXAMPLES / "calculix_loop.py", tmp_path / "laps.sti", figure)
    assert figure.stat().st_size > 10000

    def loss(out):
        return numbers(out[out.index("loss of a cycle") :])[0]

    assert loss(again) == pytest.approx(loss(shipped), rel=1e-5)


def test_calculix_blocks():
    """The forces of the deck and of the traction, 12 nodes by 0.1 N and 1.5 mm² by (0.2, 0, 0.1) N/mm²."""
    out = run(EXAMPLES / "calculix_blocks.py")
    assert "converged" in out
    line = next(each for each in out.splitlines() if each.startswith("forces on the upper block"))
    assert numbers(line) == pytest.approx([-0.3, 1.2, -0.15])


def test_lapped_beams(tmp_path):
    """A coarse joint: it bears what is pulled and pressed, 2 N/mm² on 25 by 25 and on 120 by 25 mm, and loses work by slip."""
    pytest.importorskip("skfem")
    out = run(EXAMPLES / "lapped_beams.py", 0.2, tmp_path)
    line = next(each for each in out.splitlines() if each.startswith("forces of the lap"))
    assert "converged" in out and (tmp_path / "left.mtx").exists()
    assert numbers(line) == pytest.approx([-1250, 6000, 0], abs=1e-8)
    assert numbers(next(each for each in out.splitlines() if each.startswith("loss of a cycle")))[0] > 1


def test_vibrating_beam():
    """A coarse beam: the first loop without slip has the frequency of the mode, and all loops are steady."""
    pytest.importorskip("skfem")
    out = run(EXAMPLES / "vibrating_beam.py", 0.2, 1, "1e-6", "3e-4", 3)
    loops = [line for line in out.splitlines() if " q " in line]
    assert "6 rigid motions" in out and len(loops) == 3 and all(line.endswith("steady") for line in loops)
    ratios = [float(line.split("ω/ω₀")[1].split()[0]) for line in loops]
    assert ratios[0] == pytest.approx(1, abs=1e-6) and ratios[-1] < 0.999
    # Steel of 7.85e-9 t/mm³: 720 mm of 25.4 mm square.
    mass = float(out.split("mass ")[1].split()[0])
    assert mass == pytest.approx(7.85e-9 * 25.4**2 * 720, rel=1e-5)


def test_sphere(tmp_path):
    """The study by few squares and by triangles: closed forms of displacements to one per cent, of radii within their ±."""
    pytest.importorskip("matplotlib")
    study = ROOT / "python" / "studies" / "sphere.py"
    figure, file = tmp_path / "sphere.png", tmp_path / "sphere.json"
    run(study, "-cells", 15, "-shear", 0.9, "-poisson", 0, "-friction", 0.2986, "-plot", figure, "--json", file, "-vtu", tmp_path / "state")
    assert figure.stat().st_size > 10000 and (tmp_path / "state_twisted.vtu").stat().st_size > 10000
    result = json.loads(file.read_text())
    assert result["options"]["cells"] == 15 and len(result["loop"]["shift"]) == len(result["loop"]["force"])
    triangles = tmp_path / "triangles.json"
    run(study, "-cells", 15, "-shear", 0.9, "-poisson", 0, "-triangles", "-json", triangles, "-stages", 2, "-increments", 1)
    for values in (result["values"], json.loads(triangles.read_text())["values"]):
        compared = {name: row for name, row in values.items() if row["closed_form"] is not None}
        assert len(compared) == 8
        for name, row in compared.items():
            allowed = row["error_estimate"] or (0.03 if "loss" in name else 0.01) * row["closed_form"]
            assert row["computed"] == pytest.approx(row["closed_form"], abs=allowed), name
    # Kalker's CONTACT has 61 of 241 squares in stick in stage 18 of the same contact, and any stage has the same ratio.
    ratios = [row for name, row in result["values"].items() if name.startswith("Spence")]
    assert len(ratios) == 6 and all(abs(row["computed"] - np.sqrt(61 / 241)) < row["error_estimate"] for row in ratios)
    failed = subprocess.run([sys.executable, study, "-shear", "2"], capture_output=True, text=True)
    assert failed.returncode != 0 and "2 must be from 0 to 1" in failed.stderr


def test_monte_carlo():
    out = run(EXAMPLES / "monte_carlo.py", ROOT / "problems" / "hertz.json", 40)
    assert out.startswith("40 marches of 41 nodes") and "0 of them did not converge" in out
    low, high = numbers(out[out.index("nine of ten") :])[:2]
    # Spread of the friction, against the closed form's: with x = Q/fP the loss is f² ((1-x) ln(1-x) + x - x²/2).
    assert 0 < low < high


def test_shakedown_map():
    """At f = 0.8 and R = -1 the limit is known from elsewhere (README): 0.8040 is that of f = 0.85; it falls with f."""
    from cattaneo import load_reduced_problem, shakedown

    problem = load_reduced_problem(ROOT / "problems" / "punch_on_half_plane.json")
    cycle = shakedown.held_and_cycled(problem, "P", 1.0, "Q", -1.0)
    if shakedown.load_limit(shakedown.limit_problem(problem, cycle)).status == "unavailable":
        pytest.skip("built without Ipopt")
    out = run(EXAMPLES / "shakedown_map.py")
    rows = [numbers(line.split("=")[1]) for line in out.splitlines() if line.startswith("f =")]
    assert len(rows) == 5
    for _, fully_reversed, half, from_zero in rows:
        assert fully_reversed <= half + 1e-6 <= from_zero + 2e-6  # a smaller range is borne at least as well


BLOCKS = [
    block
    for page in ("README.md", "docs/python.md", "docs/half_space.md")
    for block in re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.S)
]


@pytest.mark.parametrize("k", range(len(BLOCKS)))
def test_page(k, tmp_path):
    """Each block of the pages is a script of its own, run in the repository."""
    if "skfem" in BLOCKS[k]:
        pytest.importorskip("skfem")
    if "cattaneo.case(" in BLOCKS[k]:
        from cattaneo import InputError, _case

        try:
            _case._program()
        except InputError:
            pytest.skip("there is no program contact")
    script = tmp_path / f"block{k}.py"
    script.write_text("import warnings, cattaneo\nwarnings.simplefilter('error', cattaneo.OutcomeWarning)\n" + BLOCKS[k])
    run(script)


def test_page_names_what_there_is():
    """What the table of the page calls by name exists."""
    import cattaneo

    table = (ROOT / "docs" / "python.md").read_text(encoding="utf-8").split("## Overview")[1].split("`help(")[0]
    for row in table.splitlines():
        if not row.startswith("| `"):
            continue
        cell = row.split("|")[1]
        inside = {f"`cattaneo.{name}`": getattr(cattaneo, name) for name in ("readout", "shakedown", "wear", "design", "fretting", "joints")}
        room = inside.get(cell.strip())
        # What stands in brackets behind a function is none of the module.
        names = re.sub(r"\([^)]*\)", "", row.split("|")[2]) if room else cell
        for word in re.findall(r"`([A-Za-z_]+)[^`]*`", names):
            assert hasattr(room or cattaneo, word) or word == "cattaneo", word

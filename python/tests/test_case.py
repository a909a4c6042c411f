"""Case files from Python, by the program `contact`. Where there is no program these tests are left out."""

import json
import os

import cattaneo
import numpy as np
import pytest
from cattaneo import _case


@pytest.fixture(autouse=True)
def program():
    try:
        return _case._program()
    except cattaneo.InputError:
        pytest.skip("there is no program contact")


def test_a_march_of_what_it_returns_is_the_march_of_the_case(root):
    """Also with bolts that are tightened: their multipliers are pretensions."""
    joint = cattaneo.case(root / "meshes" / "bolted_joint_drawing.json")
    assert joint.loads == ["Q", "bolt"] and joint.results["status"] == "converged"
    report = cattaneo.march(joint.problem, joint.history)
    assert report.state.time == joint.state.time == joint.results["time"]
    assert report.state.p == pytest.approx(joint.state.p, abs=1e-9 * joint.state.p.max())
    assert report.state.dissipation == pytest.approx(joint.results["total_dissipation"], rel=1e-9)
    for row in joint.results["interfaces"]:  # of the program's own table
        assert report.interfaces[row["interface"]].normal_force[-1] == pytest.approx(row["normal"], rel=1e-9)
    assert joint.bolt_forces(report.state)["bolt"] == pytest.approx(joint.bolts["bolt"]["force"], rel=1e-9)
    tightened = cattaneo.march(joint.problem, [{}, {"bolt": joint.history.multipliers[1, 1]}]).state
    assert joint.bolt_forces(tightened)["bolt"] == pytest.approx(10000, rel=1e-9)  # the drawing's preload
    assert (joint.history.cycle_start, joint.history.cycles) == (2, 3)


@pytest.mark.filterwarnings("ignore:case:UserWarning")
def test_other_values(root):
    file = root / "meshes" / "rounded_punch.json"
    usual = cattaneo.case(file, history="P=0; P=1", cycle_start=-1, cycles=1)
    assert usual.history.multipliers.shape == (2, 2) and usual.history.cycle_start == -1
    other = cattaneo.case(file, set={"interfaces.face.friction": 0.25}, history=["P=0", "P=0.5"], cycle_start=-1, cycles=1)
    with pytest.warns(UserWarning, match="load 'Q' is zero throughout the history"):
        cattaneo.case(file, history="P=0; P=1", cycle_start=-1, cycles=1)
    assert set(other.problem.friction) == {0.25} and set(usual.problem.friction) == {0.6}
    assert dict(zip(other.loads, other.state.multipliers))["P"] == 0.5 and other.state.time == 1
    assert np.array_equal(usual.problem.K, other.problem.K)


@pytest.mark.filterwarnings("ignore:case:UserWarning")
def test_sentences(root, tmp_path, monkeypatch):
    with pytest.raises(cattaneo.InputError, match=r"^case file: cannot read file '.*nowhere.json': there is no such file$"):
        cattaneo.case(tmp_path / "nowhere.json")
    with pytest.raises(cattaneo.InputError, match="unknown option|color"):
        cattaneo.case(root / "meshes" / "rounded_punch.json", color="red")
    # An outcome is a warning, and what was reached is returned.
    with pytest.warns(cattaneo.OutcomeWarning, match="gross sliding"):
        slid = cattaneo.case(root / "meshes" / "rounded_punch.json", history="P=0; P=1; Q=1", cycle_start=-1, cycles=1)
    assert slid.results["status"] == "gross sliding" and slid.state.time < 2
    monkeypatch.setenv("CATTANEO_BIN", str(tmp_path))
    with pytest.raises(cattaneo.InputError, match="CATTANEO_BIN is '.*', where there is no program 'contact'"):
        cattaneo.case(root / "meshes" / "rounded_punch.json")
    # Beside the package, in a build, or where the command cattaneo is: nowhere.
    monkeypatch.delenv("CATTANEO_BIN")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setattr(_case.shutil, "which", lambda *_, **__: None)
    with pytest.raises(cattaneo.InputError, match="case.. runs the program 'contact', which is not beside this package"):
        cattaneo.case(root / "meshes" / "rounded_punch.json")


def test_a_program_that_is_named(root, monkeypatch, program):
    """By its folder, or itself."""
    monkeypatch.setenv("CATTANEO_BIN", program[0])
    assert _case._program() == [program[0]]
    monkeypatch.setenv("CATTANEO_BIN", os.path.dirname(program[0]))
    assert _case._program()[0].startswith(os.path.dirname(program[0]))


def test_comments_of_cases(tmp_path):
    text = '{ // as in C++\n "a": "//no /* comment */ \\" // here", /* but\n here */ "b": [1]}'
    (tmp_path / "case.json").write_text(text, encoding="utf-8")
    assert _case._read(str(tmp_path / "case.json")) == {"a": '//no /* comment */ " // here', "b": [1]}
    assert json.loads('{"a": 1}') == {"a": 1}


@pytest.mark.filterwarnings("ignore:case:UserWarning")
def test_a_bolt_that_is_tightened_after_other_loads(root):
    """In the problem that is returned its spring acts from the beginning, which is said; from the state that is returned a march
    goes on."""
    file = root / "meshes" / "bolted_joint_drawing.json"
    with pytest.warns(UserWarning, match=r"other loads act before a bolt is tightened \('bolt' at point 3\): .* must go on from `state`"):
        late = cattaneo.case(file, history=["Q=0", "bolt=1", "Q=0.5", "bolt=1"], cycle_start=-1, cycles=1)
    on = cattaneo.case(file, history=["Q=0", "bolt=1", "Q=0.5", "bolt=1", "Q=1"], cycle_start=-1, cycles=1)
    then = {"bolt": late.state.multipliers[late.loads.index("bolt")], "Q": 1.0}
    points = [dict(zip(late.loads, late.state.multipliers)), then]
    history = cattaneo.LoadHistory.through(late.problem, [{}, *points], times=[0.0, late.state.time, late.state.time + 1])
    report = cattaneo.march(late.problem, history, late.state)
    assert report.state.p == pytest.approx(on.state.p, abs=1e-9 * on.state.p.max())


def test_set_that_is_no_dict(root):
    with pytest.raises(TypeError, match=r"set is 'order=1', must be a dict"):
        cattaneo.case(root / "meshes" / "rounded_punch.json", set="order=1")

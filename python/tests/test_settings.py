"""Settings are the structs of the C++ library: the same members, defaults, words and checks."""

import copy
import inspect
import pickle
import re

import cattaneo
import numpy as np
import pytest
from cattaneo import design, fretting, readout, shakedown, wear
from conftest import ROOT

# Where each struct is, and what a script has as arguments of the functions instead.
STRUCTS = {
    cattaneo.FrictionSettings: ("friction/friction_solver.hpp", set()),
    cattaneo.MarchSettings: ("friction/march.hpp", {"monitor"}),
    wear.WearSettings: ("wear/wear_march.hpp", {"observed"}),
    design.DesignSettings: ("design/design.hpp", set()),
    shakedown.LimitSettings: ("shakedown/limit.hpp", {"start", "monitor"}),
    shakedown.TransientSettings: ("shakedown/transient.hpp", set()),
    readout.FitSettings: ("readout/edge_fit.hpp", {"least_nodes"}),
    fretting.FrettingSettings: ("fretting/assessment.hpp", set()),
    fretting.PlaneWeights: ("fretting/critical_plane.hpp", set()),
}
CHANGED = [
    (cattaneo.MarchSettings, {"increments": 7, "stepping": "fixed", "increments_of_piece": (3, 4), "stop_at_steady_state": False}),
    (cattaneo.FrictionSettings, {"method": "gauss_seidel", "tolerance": 1e-9}),
    (wear.WearSettings, {"update": "piece", "tolerance": 1e-3}),
    (design.DesignSettings, {"tolerance": 1e-6, "max_iterations": 3}),
    (shakedown.LimitSettings, {"largest_friction": 3.0, "every_start": True}),
    (shakedown.TransientSettings, {"cycles": 3, "upper": 2.0}),
    (readout.FitSettings, {"window": (0.1, 0.4), "skip": 0}),
    (fretting.FrettingSettings, {"criterion": "half_range"}),
    (fretting.PlaneWeights, {"findley": 0.2}),
]  # fmt: skip


def members(struct):
    """(kind, name, default as it is written) of a struct's members, as they stand in its header."""
    text = (ROOT / "plugin" / "cattaneo" / STRUCTS[struct][0]).read_text(encoding="utf-8")
    body = re.search(rf"^struct {struct.__name__}\n{{\n(.*?)^}};", text, re.M | re.S)[1]
    code = re.sub(r"/\*.*?\*/|//[^\n]*", "", body, flags=re.S)
    found = re.findall(r"([\w:<>, ()*]+?) \*?(\w+)(?: = ([^;]+))?;", code)
    return [(kind.split()[-1], name, default) for kind, name, default in found if name != "const"]


@pytest.mark.parametrize("struct", STRUCTS)
def test_members_and_defaults_are_those_of_the_header(struct):
    left_out, made = STRUCTS[struct][1], struct()
    names = {name for name, each in inspect.getmembers(struct) if isinstance(each, property)}
    stored = members(struct)
    assert names == {name for _, name, _ in stored} - left_out and names
    for kind, name, default in stored:
        if name in left_out:
            continue
        value = getattr(made, name)
        if kind in ("double", "int", "long", "bool"):
            default = default.replace("std::numeric_limits<double>::infinity()", "inf")
            assert value == {"true": True, "false": False}.get(default) if kind == "bool" else value == float(default)
        elif default:
            assert value == default.split("::")[-1]  # the word of an enumerator
        else:
            assert value in ((), None) or type(value).__name__ == kind
        assert len(getattr(struct, name).__doc__) > 3, name


@pytest.mark.parametrize("struct, changed", CHANGED)
def test_members_are_arguments_and_attributes(struct, changed):
    made, by_hand = struct(**changed), struct()
    for name, value in changed.items():
        setattr(by_hand, name, value)
        assert getattr(made, name) == getattr(by_hand, name) == value != getattr(struct(), name)
    assert repr(made) == repr(by_hand) != repr(struct()) == f"{struct.__name__}()"
    for again in (pickle.loads(pickle.dumps(made)), copy.copy(made), copy.deepcopy(made)):
        assert repr(again) == repr(made) and again is not made
    assert all(f"{name}={value!r}" in repr(made) for name, value in changed.items())


@pytest.mark.parametrize("struct", STRUCTS)
def test_a_name_that_is_misspelt_is_said_with_those_that_there_are(struct):
    made = struct()
    listed = ", ".join(f"'{name}'" for _, name, _ in members(struct) if name not in STRUCTS[struct][1])
    sentence = re.escape(f"{struct.__name__} has no 'incremnts', it has {listed}")
    with pytest.raises(TypeError, match=sentence):
        struct(incremnts=3)
    with pytest.raises(AttributeError, match=sentence):
        made.incremnts = 3
    with pytest.raises(AttributeError, match=sentence):
        made.incremnts
    with pytest.raises(TypeError):
        struct(3)


def test_a_value_that_is_not_allowed_is_not_taken():
    """By the check of the C++ library, as soon as it is set."""
    settings = cattaneo.MarchSettings(increments=5)
    for name, value, kind, sentence in (
        ("increments", 0, ValueError, "march settings: increments is 0, must be at least 1"),
        ("increments", 2.5, TypeError, "MarchSettings.increments is 2.5, must be int"),
        ("increments", "5", TypeError, "MarchSettings.increments is '5', must be int"),
        ("increments", 10**30, TypeError, "MarchSettings.increments is 10*, must be int"),
        ("stepping", "euler", ValueError, "MarchSettings.stepping is 'euler', must be one of 'fixed', "),
        ("stepping", 1, TypeError, "MarchSettings.stepping is 1, must be one of 'fixed', "),
        ("loss_error", 1, TypeError, "MarchSettings.loss_error is 1, must be bool"),
        ("steady_tolerance", np.nan, ValueError, "march settings: steady_tolerance is nan"),
        ("increments_of_piece", [3, 0], ValueError, "an entry of increments_of_piece is 0"),
        ("friction", None, TypeError, "MarchSettings.friction is None, must be cattaneo._core.FrictionSettings"),
    ):
        before = repr(settings)
        with pytest.raises(kind, match=sentence):
            setattr(settings, name, value)
        assert repr(settings) == before
    with pytest.raises(ValueError, match="the window of the fit is 0.4 to 0.1"):
        readout.FitSettings(window=(0.4, 0.1))
    settings.loss_error = np.bool_(True)
    assert settings.loss_error is True
    fit = readout.FitSettings(window=(0.1, 0.4))
    fit.window = None
    assert repr(fit) == "FitSettings()"


def test_settings_within_settings_are_no_copies():
    settings = wear.WearSettings()
    settings.march.friction.tolerance = 1e-9
    settings.march.increments = 4
    assert settings.march.friction.tolerance == 1e-9
    assert repr(settings) == "WearSettings(march=MarchSettings(friction=FrictionSettings(tolerance=1e-09), increments=4))"
    inner = settings.march
    del settings
    assert inner.increments == 4  # which keeps what it is in
    with pytest.raises(ValueError, match="friction settings: tolerance is 2"):
        inner.friction.tolerance = 2
    with pytest.raises(AttributeError):
        inner.increments_of_piece.append(3)  # a tuple: it would be in vain


def test_settings_are_heard():
    """By the numbers of increments that a march takes."""
    problem = cattaneo.load_reduced_problem(ROOT / "problems" / "hertz.json")
    points = [{}, {"P": 1.0}, {"Q": 0.2}]
    settings = cattaneo.MarchSettings(stepping="fixed", increments=3, single_increment_if_exact=False)
    assert len(cattaneo.march(problem, points, settings=settings).time) == 6
    settings.increments_of_piece = [2, 5]
    report = cattaneo.march(problem, points, settings=settings)
    assert len(report.time) == 7 and np.isnan(report.loss_error) and "was not requested" in report.loss_error_by
    settings.loss_error = True
    assert cattaneo.march(problem, points, settings=settings).loss_error > 0
    settings.keep_increments = False
    assert len(cattaneo.march(problem, points, settings=settings).time) == 0


def test_members_may_be_given_by_their_names_alone():
    """A call takes members of its settings, and of settings within, as keywords; they are the same as settings made of them."""
    problem = cattaneo.load_reduced_problem(ROOT / "problems/hertz.json")
    history = cattaneo.LoadHistory.through(problem, [{}, {"P": 1}, {"Q": 0.2}, {"Q": -0.2}, {"Q": 0.2}], cycle_start=2)
    one = cattaneo.march(problem, history, increments=7, stepping="fixed", tolerance=1e-10)
    friction = cattaneo.FrictionSettings(tolerance=1e-10)
    other = cattaneo.march(problem, history, settings=cattaneo.MarchSettings(increments=7, stepping="fixed", friction=friction, loss_error=True))
    assert one.state.dissipation == other.state.dissipation > 0
    assert one.loss_error == other.loss_error
    law = wear.WearLaw.uniform(problem, 1e-6)
    worn = wear.wear(problem, law, history, 20, update="piece", increments=3, stepping="fixed")
    march = cattaneo.MarchSettings(increments=3, stepping="fixed")
    same = wear.wear(problem, law, history, 20, settings=wear.WearSettings(update="piece", march=march))
    assert worn.volume[-1] == same.volume[-1] > 0
    # What both are given, the name alone says.
    assert cattaneo.march(problem, history, settings=march, increments=7).state.dissipation == one.state.dissipation
    with pytest.raises(TypeError, match=r"MarchSettings has no 'incremnts', it has 'friction', 'increments'"):
        cattaneo.march(problem, history, incremnts=7)
    with pytest.raises(cattaneo.InputError, match="increments"):
        cattaneo.march(problem, history, increments=0)

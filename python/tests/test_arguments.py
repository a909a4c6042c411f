"""What does not fit is refused in one sentence that names the argument and the entry, and nothing ends the interpreter."""

import inspect
import subprocess
import sys
import threading

import cattaneo
import numpy as np
import pytest
import scipy.sparse as sparse
from cattaneo import design, fretting, readout, shakedown, wear


def triangle():
    """The stiffness of one triangle of plane strain, E = 1 and ν = 0, corners (0, 0), (1, 0), (0, 1)."""
    B = np.array([[-1, 0, 1, 0, 0, 0], [0, -1, 0, 0, 0, 1], [-1, -1, 0, 1, 1, 0]])
    return B.T @ np.diag([1, 1, 0.5]) @ B / 2


PLACES = [[0, 0], [1, 0], [0, 1]]


def body():
    made = cattaneo.NodalStiffness(triangle(), PLACES, elements=[[0, 1, 2]])
    made.add_forces("P", [2], "y", -1.0)
    made.fix([2], "x")
    return made


def problem():
    patterns = [cattaneo.LoadPattern("P", [0, 0], [1, 1]), cattaneo.LoadPattern("Q", [-1, -1], [0, 0])]
    return cattaneo.ReducedProblem(
        np.diag([2.0, 2.0]), np.zeros((2, 2)), np.eye(2), patterns, friction=0.5, weights=1.0, arc_length=[0, 1]
    )


def history():
    return cattaneo.LoadHistory.through(problem(), [{}, {"P": 1}, {"Q": 0.2}, {"Q": 0}], cycle_start=1)


def law():
    return wear.WearLaw.uniform(problem(), 1e-3)


def case():
    return design.DesignCase("pressed", cattaneo.LoadHistory.through(problem(), [{}, {"P": 1}]))


def chosen():
    return design.DesignProblem(problem(), [case()], np.eye(2), 0, 1)


def changed(matrix, i, j, value):
    matrix = np.array(matrix, dtype=float)
    matrix[i, j] = value
    return matrix


K = triangle()
SAID = [
    (lambda: cattaneo.NodalStiffness("K", PLACES), TypeError, "K is 'K', must be"),
    (lambda: cattaneo.NodalStiffness(K[:4], PLACES), ValueError, r"K has shape \(4, 6\), must be square"),
    (lambda: cattaneo.NodalStiffness(sparse.csr_array(K[:4]), PLACES), ValueError, r"K has shape \(4, 6\)"),
    (lambda: cattaneo.NodalStiffness(changed(K, 1, 2, np.nan), PLACES), ValueError, r"K\[1, 2\] is nan, must be finite"),
    (lambda: cattaneo.NodalStiffness(K * 1j, PLACES), TypeError, "K is of dtype complex128, must be"),
    (lambda: cattaneo.NodalStiffness(K, PLACES[:2]), ValueError, "K has 6 rows and places 2 nodes"),
    (lambda: cattaneo.NodalStiffness(K, [[0, 0, 0]] * 3), ValueError, r"K has 6 rows and places 3 nodes: .* there must be 3 times as many rows as nodes"),
    (lambda: cattaneo.NodalStiffness(K, [[0, 0], [1], [2, 2]]), ValueError, "places cannot be made an array"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, [[0, 1], [2, 3], [4, 4]]), ValueError, r"dofs\[2, 1\] is row 4, which is dofs\[2, 0\]"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, [[0, 1], [2, 3], [4, -1]]), ValueError, "row 5 of K is in no entry of dofs"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, [[0, 1], [2, 3], [4, 6]]), ValueError, r"dofs\[2, 1\] is 6, must be from -1 to 5"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, [[0.0, 1], [2, 3], [4, 5]]), TypeError, "dofs is of dtype float64, must be whole"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, elements=[[0, 1, 3]]), ValueError, r"elements\[0, 2\] is 3, must be from 0 to 2"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, elements=[[0, 1]]), ValueError, "element 0 has 2 nodes, must have 3"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, elements=[[0, 1, 2, 0, 1, 2]]), ValueError, "element 0: node 0 is not between its corners 0 and 1"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, fixed=[-1]), ValueError, r"fixed\[0\] is -1, must be from 0 to 5"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, fixed=[10**30]), TypeError, "fixed is a list of 1 entries, must be whole"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, fixed=[True] * 5), ValueError, r"fixed is a mask of shape \(5,\), must have 6"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, loads={"P": [1, 2]}), ValueError, r"loads\['P'\] has 2 entries, must have 6"),
    (lambda: cattaneo.NodalStiffness(K, PLACES, formulation="torsion"), ValueError, "formulation is 'torsion', must be one of 'plane'"),
    (lambda: cattaneo.condense(cattaneo.NodalStiffness(changed(K, 0, 1, 9), PLACES), body().contact_line([0, 1])), ValueError, "."),
    (lambda: body().fix([0], "z"), ValueError, "direction is 'z', must be one of 'x', 'y', 'xy'"),
    (lambda: body().fix([7], "x"), ValueError, "there is no node 7"),
    (lambda: body().fix("TOP", "x"), ValueError, "there is no set 'TOP'"),
    (lambda: body().contact_line([0, 1], order=9), ValueError, "order is 9, must be from 0 to 8"),
    (lambda: body().contact_line([0]), ValueError, "no outer edge"),
    (lambda: cattaneo.Material(1.0, 0.5), ValueError, "."),
    (lambda: cattaneo.ReducedProblem([[1.0]], [[0.0, 0]], [[1.0]], []), ValueError, r"B has shape \(1, 2\), must have \(1, 1\)"),
    (lambda: cattaneo.ReducedProblem([[1, 2], [0, 1]], np.zeros((2, 2)), np.eye(2), []), ValueError, r"A\[.*\] is .*, must be equal"),
    (lambda: setattr(problem(), "friction", [0.1, -0.1]), ValueError, r"friction\[1\] is -0.1, must not be negative"),
    (lambda: setattr(problem(), "gap", [1, 2, 3]), ValueError, "gap has 3 entries, must have 2"),
    (lambda: cattaneo.march(problem(), []), ValueError, "history has no point, must have two at least"),
    (lambda: cattaneo.march(problem(), {"P": 1}), TypeError, "history is a dict, must be a list of loads by name"),
    (lambda: cattaneo.march(problem(), ["P=0", "P=1"]), TypeError, r"history\[0\] is 'P=0', must be loads by name"),
    (lambda: cattaneo.march(problem(), [{}, {"P": "1"}]), TypeError, r"history\[1\]\['P'\] is '1', must be a number"),
    (lambda: cattaneo.LoadHistory.through(problem(), [{}, {1: 2}]), TypeError, r"a name in points\[1\] is 1, must be a str"),
    (lambda: body().add_loads(3), TypeError, "loads is 3, must be a str, or a list of them"),
    (lambda: cattaneo.march(problem(), [{}]), ValueError, "history has one point, must have two at least, the first without load"),
    (lambda: cattaneo.march(problem(), [{}, {"R": 1}]), ValueError, "'R'"),
    (lambda: cattaneo.march(problem(), [{}, {"P": np.inf}]), ValueError, r"history\[1\]\['P'\] is inf, must be finite"),
    (lambda: cattaneo.MarchSettings(increments=0), ValueError, "march settings: increments is 0, must be at least 1"),
    (lambda: cattaneo.MarchSettings(increments=2.5), TypeError, "MarchSettings.increments is 2.5, must be int"),
    (lambda: cattaneo.MarchSettings(stepping="euler"), ValueError, "MarchSettings.stepping is 'euler', must be one of 'fixed', "),
    (lambda: cattaneo.march(problem(), [{}, {"P": 1}], progress=3), TypeError, "progress is 3, must be True, False or a function"),
    (lambda: cattaneo.march(problem(), [{}, {"P": 1}], stop=3), TypeError, "stop is 3, must be None or an object with is_set"),
    (lambda: readout.tractions(problem(), [1, 2, 3]), ValueError, "nodal_forces has 3 entries, must have 2"),
    (lambda: shakedown.LoadCycle.through(problem(), {}, []), ValueError, "vertices has no entries"),
    (lambda: shakedown.closed_contact(problem(), [2]), ValueError, r"nodes\[0\] is 2, must be from 0 to 1"),
    (lambda: fretting.pressure(fretting.Edge(1, 0, 0.5), [1, np.nan]), ValueError, r"t\[1\] is nan, must be finite"),
    (lambda: fretting.hertz_slip_energy([1, 2], [1, 2, 3], 0.5, 1), ValueError, "do not fit each other, must broadcast"),
    (lambda: cattaneo.load_reduced_problem(""), ValueError, "file is '', must be the name of a file"),
    (lambda: wear.WearLaw([1, np.nan]), ValueError, r"coefficient\[1\] is nan, must be finite"),
    (lambda: wear.WearLaw([1.0, 2.0], threshold=[1.0]), ValueError, "threshold has 1 entries, must have 2"),
    (lambda: wear.WearLaw([1.0]).set(problem(), "", 2.0), ValueError, "wear law: 1 coefficients, must be one for each of the 2 contact nodes"),
    (lambda: wear.WearLaw.uniform(problem(), -1.0), ValueError, "wear law: the coefficient is -1, must be finite and at least 0"),
    (lambda: law().set(problem(), "", -1.0), ValueError, "wear law: the coefficient at interface '' is -1, must be finite and at least 0"),
    (lambda: wear.wear(problem(), law(), history(), 1.5), ValueError, "wear: cycles is 1.5, must be a whole number"),
    (lambda: wear.WearSettings(tolerance=1), ValueError, "tolerance is 1, must be 0 or from 1e-8 to 0.1"),
    (lambda: wear.WearSettings(update="never"), ValueError, "WearSettings.update is 'never', must be one of 'cycle', 'piece'"),
    (lambda: wear.worn_volume(problem(), [1.0]), ValueError, "depth has 1 entries, must have 2"),
    (lambda: wear.WearState(cattaneo.ContactState.virgin(problem()), [1, 2, 3]), ValueError, "depth has 3 entries, must have 2"),
    (lambda: design.Parameters(gap=[[1.0]]), ValueError, "gap is a list of 1 entries, must be of one dimension"),
    (lambda: design.Response(1, {0: {"force": [1]}}), ValueError, r"a name in weights\[0\] is 'force', must be one of 'displacements'"),
    (lambda: design.Response(1, {}) / 0, ValueError, "the divisor is zero"),
    (lambda: design.DesignProblem(problem(), [], np.eye(2), 0, 1), ValueError, "there is no load case"),
    (lambda: design.DesignProblem(problem(), [case()], np.eye(3), 0, 1), ValueError, r"variables has shape \(3, 3\), must have \(2, any\)"),
    (lambda: design.DesignProblem(problem(), [case()], np.eye(2), 1, 0), ValueError, "variable 0 has the bounds 1 and 0"),
    (lambda: design.DesignProblem(problem(), [case()], np.eye(2), 0, 1, limits=np.eye(2), most=np.nan), ValueError, r"most\[0\] is nan"),
    (lambda: design.DesignSettings(tolerance=1e-20), ValueError, "design settings: tolerance is 1e-20, must be from 1e-14 to 1"),
    (lambda: design.design(chosen(), [9, 9]), ValueError, "variable 0 starts at 9, must lie between 0 and 1"),
    (lambda: cattaneo.load_reduced_problem(__file__), ValueError, "is not a reduced problem: it is not JSON, must be a file that"),
    (lambda: cattaneo.load_contact_state(__file__), ValueError, "is not a contact state: it is not JSON, must be a file that a march has saved"),
    # Calls that fit no signature.
    (cattaneo.ContactState, TypeError, "ContactState cannot be called: such objects are made by functions or static methods"),
    (lambda: wear.wear(problem(), law(), [{}, {"P": 1}], 3), TypeError, r"^wear\(\): argument 'history' is of type list, must be of type LoadHistory$"),
    (lambda: cattaneo.march(problem(), history(), state=law()), TypeError, r"argument 'state' is of type WearLaw, must be of type ContactState \| None$"),
    (lambda: problem().copy(1), TypeError, r"^ReducedProblem.copy\(\): there is 1 argument without a name, must be none$"),
    (lambda: wear.WearLaw.uniform(problem(), "a"), TypeError, r"^uniform\(\): argument 'coefficient' is of type str, must be of type float$"),
    (lambda: cattaneo.march(problem()), TypeError, r"^march\(\): argument 'history' is missing, must be of type LoadHistory | Sequence"),
    (lambda: wear.WearLaw.uniform(problem(), k=1), TypeError, r"^uniform\(\): it has no argument 'k', must be \(problem: ReducedProblem, coefficient: float\)$"),
    (lambda: wear.WearLaw.uniform(problem(), 1, 2), TypeError, r"^uniform\(\): there are 3 arguments without a name, must be at most 2: "),
    (lambda: law().set(problem(), 3, 1.0), TypeError, r"^WearLaw.set\(\): argument 'interface' is of type int, must be of type str$"),
    (lambda: fretting.Edge("a", 0, 0.5), TypeError, r"^Edge\(\): argument 'k_n' is of type str, must be of type float$"),
    (lambda: cattaneo.condense(1, line=2), TypeError, r"^condense\(\): the arguments are \(int, line: int\), must be \(body: NodalStiffness, line: ContactLine\) or "),
]


@pytest.mark.parametrize("k", range(len(SAID)))
def test_what_is_said(k):
    call, kind, sentence = SAID[k]
    with pytest.raises(kind, match=sentence) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text and "incompatible function arguments" not in text
    assert kind is TypeError or isinstance(caught.value, cattaneo.InputError)


def test_what_is_of_another_kind():
    """The binding library says which arguments there are, of which classes."""
    p = problem()
    for call in (
        lambda: cattaneo.NodalStiffness(None, PLACES),
        lambda: cattaneo.condense(body(), None),
        lambda: cattaneo.condense(3, None),
        lambda: cattaneo.reduce([]),
        lambda: cattaneo.reduce([None], []),
        lambda: cattaneo.Interface("a", (0, None)),
        lambda: setattr(problem(), "friction", None),
        lambda: cattaneo.march(None, []),
        lambda: cattaneo.save(None, "x.json"),
        lambda: wear.wear(problem(), 1e-3, history(), 1),
        lambda: wear.wear(problem(), law(), [{}, {"P": 1}], 1),
        lambda: design.Response(1, {-1: {}}),
        lambda: design.Response(1, {}) + "a",
        lambda: design.Responses(problem(), None),
        lambda: design.DesignCase("a", None),
        lambda: design.DesignProblem(problem(), [case()], np.eye(2), 0, 1, objective=3),
        lambda: cattaneo.march(p),
        lambda: cattaneo.march(p, [{}, {"P": 1}], incremnts=3),
        lambda: cattaneo.march(p, [{}, {"P": 1}], settings={"increments": 3}),
        lambda: cattaneo.NodalStiffness(K, PLACES, element=[[0, 1, 2]]),
        lambda: cattaneo.Material(1.0),
        lambda: body().fix([0], direction="x", node=[0]),
        lambda: cattaneo.LoadHistory.through(p, [{}, {"P": 1}], cycle=2),
        lambda: p.copy(1),
        lambda: wear.wear(p, law(), history(), cycle=3),
        lambda: shakedown.load_limit(problem=None, tol=1),
        lambda: fretting.pressure(fretting.Edge(1, 0, 0.5)),
    ):
        with pytest.raises(TypeError, match="must be|incompatible function arguments|unsupported operand|has no '"):
            call()
    with pytest.raises(TypeError, match="MarchSettings has no 'incremnts', it has 'friction', 'increments', "):
        cattaneo.march(p, [{}, {"P": 1}], incremnts=3)


def test_a_mask_is_not_numbers():
    """[True, False, …] are the nodes where it is True, not nodes 1 and 0."""
    made = body()
    made.fix(made.places[:, 1] == 0, "y")
    assert list(made.fixed) == [1, 3, 4]


def test_numbers_of_numpy_are_numbers():
    made = problem()
    made.friction = np.float32(0.5)
    assert cattaneo.march(made, [{}, {"P": np.int64(1)}], settings=cattaneo.MarchSettings(increments=np.int32(3), steady_tolerance=np.float32(1e-6))).converged


def callables():
    """Every function, class and method of the package, with arguments that it takes."""
    p = problem()
    report = cattaneo.march(p, [{}, {"P": 1}, {"P": 1, "Q": 0.2}])
    line = body().contact_line([0, 1])
    condensed = cattaneo.condense(body(), line)
    reduction = cattaneo.reduce(condensed)
    cycle = shakedown.LoadCycle.through(p, {"P": 1}, [{"Q": 1}])
    good = [
        p, report, report.state, line, condensed, reduction, body(), cycle, cattaneo.Material(1, 0.3),
        cattaneo.HalfPlane(cattaneo.Material(1, 0.3), depth=9), cattaneo.LoadHistory.through(p, [{}, {"P": 1}]),
        shakedown.limit_problem(p, cycle), fretting.Edge(1, 0.1, 0.5), cattaneo.Interface("a", (0, line)),
        law(), wear.WearState.virgin(p), design.trace_march(p, [{}, {"P": 1}]), design.Parameters(gap=[1, 0]), case(), chosen(),
        design.Response(1.0, {0: {"forces": [1, 0, 0, 0]}}), design.stiffness_scale(p),
    ]  # fmt: skip
    found = []
    for room in (cattaneo, readout, shakedown, fretting, wear, design):
        for name in dir(room):
            thing = getattr(room, name)
            if name.startswith("_"):
                continue
            # A figure takes long, and what writes files is not given names at random.
            if callable(thing) and not name.startswith(("write", "save")) and not inspect.ismodule(thing):
                found.append((f"{room.__name__}.{name}", thing))
    for thing in good:
        for name in dir(type(thing)):
            if name.startswith("__") or name == "plot":
                continue
            attribute = getattr(thing, name)
            if callable(attribute):
                found.append((f"{type(thing).__name__}.{name}", attribute))
            else:
                found.append((f"{type(thing).__name__}.{name} =", lambda value, t=thing, n=name: setattr(t, n, value)))
    return good, found


def odd(random, good):
    """An argument, most of which fit nowhere."""
    n = int(random.integers(0, 5))
    kinds = [
        lambda: None,
        lambda: random.choice(["", "P", "x", "plane", "exact", "\ud800", "a\0b", "P=1;Q=2", "T traction TOP 0 -1", "z" * 999]),
        lambda: bool(random.integers(2)),
        lambda: int(random.choice([0, 1, -1, 2, 7, 2**31 - 1, 2**31, -(2**63)])),
        lambda: 10**40,
        lambda: float(random.choice([0, 1, -1, 0.5, np.nan, np.inf, 1e308, 5e-324])),
        lambda: 1j,
        lambda: random.normal(size=n),
        lambda: random.normal(size=(n, int(random.integers(0, 4)))),
        lambda: random.normal(size=(2, 2, 2)),
        lambda: np.eye(n),
        lambda: random.integers(-2, 5, n),
        lambda: random.integers(0, 2, n).astype(bool),
        lambda: np.array([np.nan, 1.0]),
        lambda: np.array(["a", "b"]),
        lambda: np.array([None, 1], dtype=object),
        lambda: np.ma.masked_array([1.0, 2.0], [0, 1]),
        lambda: np.zeros((3, 0)),
        lambda: np.array(1.5, dtype=np.float16),
        lambda: np.eye(6)[::-1, ::2],
        lambda: sparse.random(6, 6, 0.5, random_state=1),
        lambda: sparse.csr_array((6, 6)),
        lambda: sparse.eye(4, format="dia"),
        lambda: {},
        lambda: {"P": 1.0},
        lambda: {"P": None, 3: 4},
        lambda: [],
        lambda: [{}, {"P": 1}],
        lambda: [[0, 1], [2]],
        lambda: (0, good[3]),
        lambda: [good[4]],
        lambda: b"bytes",
        lambda: object(),
        lambda: lambda *values: None,
        lambda: lambda x, y: float("nan"),
        lambda: threading.Event(),
        lambda: good[int(random.integers(len(good)))],
        lambda: good[int(random.integers(len(good)))],
        lambda: type(good[0]).__new__(type(good[0])),  # never initialised
    ]
    return kinds[int(random.integers(len(kinds)))]()


def nearly_right():
    """Calls that are right, of which one argument is then replaced."""
    p = problem()
    at = cattaneo.LoadHistory.through(p, [{}, {"P": 1}, {"P": 1, "Q": 0.2}])
    state = cattaneo.march(p, at).state
    line = body().contact_line([0, 1])
    condensed = cattaneo.condense(body(), line)
    reduction = cattaneo.reduce(condensed)
    cycle = shakedown.LoadCycle.through(p, {"P": 1}, [{"Q": 1}, {"Q": -1}])
    limit = shakedown.limit_problem(p, cycle)
    half_plane = cattaneo.HalfPlane(cattaneo.Material(1, 0.3), depth=9)
    edge = fretting.Edge(1, 0.1, 0.5)
    trace = design.trace_march(p, at)
    of = design.Responses(p, trace)
    change = design.Parameters(friction=[1, 0], gap=[0, 1])
    return [
        (wear.WearLaw, [[1e-3, 1e-3]], {"threshold": 0.1, "of_energy": True}),
        (wear.wear, [p, law(), history(), 2], {"state": None, "settings": wear.WearSettings(update="piece", tolerance=1e-3, march=cattaneo.MarchSettings(increments=2)), "observer": None, "stop": None}),
        (wear.worn_out, [p, history()], {"contact": None, "settings": cattaneo.MarchSettings(increments=2)}),
        (wear.worn_depth, [p, law(), state, state], {}),
        (wear.WearState, [state, [0.0, 1.0]], {"dissipation": 1.0, "cycles": 3}),
        (design.trace_march, [p, at], {"state": None, "settings": cattaneo.MarchSettings(increments=2, stepping="exact")}),
        (design.Response, [1.0, {0: {"forces": [1, 0, 0, 0]}}], {}),
        (lambda *a: of.dissipation(*a), [0, 1, 0], {}),
        (lambda *a: of.shear_resultant(*a), [1, [1.0, 2.0], 0], {}),
        (lambda *a: of.multiplier(*a), [1, "P"], {}),
        (design.Parameters, [], {"friction": [1, 0], "gap": [0, 1], "multipliers": np.zeros((2, 3)), "stiffness": [1.0]}),
        (design.Sensitivity, [p, trace], {"stiffness": [design.stiffness_scale(p)]}),
        (lambda *a: design.Sensitivity(p, trace).gradient(*a), [of.shear(1, 0)], {}),
        (lambda *a: design.Sensitivity(p, trace).along(*a), [change], {}),
        (lambda *a: design.Sensitivity(p, trace).along(change).of(*a), [of.shear(1, 0)], {}),
        (lambda *a: trace.other_side(*a), [design.ties(p, trace)], {}),
        (design.DesignCase, ["a", at], {"weight": 2.0, "from_": 1.0}),
        (design.DesignProblem, [p, [case()], np.eye(2), 0, 1], {"limits": np.eye(2), "least": [0, -np.inf], "most": 1.0, "goal": "least_sum", "objective": lambda of, states: []}),
        (design.design, [chosen(), [0.1, 0.2]], {"settings": design.DesignSettings(tolerance=1e-6, max_iterations=3)}),
        (cattaneo.NodalStiffness, [triangle(), PLACES, [[0, 1], [2, 3], [4, 5]], [[0, 1, 2]]], {"fixed": [4], "loads": {"P": np.ones(6)}, "sets": {"A": [0, 1]}, "name": "b"}),
        (lambda *a: body().fix(*a), [[0], "x"], {}),
        (lambda *a: body().add_forces(*a), ["P", [0], "y", 1.0], {}),
        (lambda *a: body().add_displacement(*a), ["D", [0], "y", 1.0], {}),
        (lambda *a: body().add_traction(*a), ["T", [0, 1], (0, 1)], {}),
        (lambda *a: body().contact_line(*a), [[0, 1], 1], {}),
        (cattaneo.condense, [body(), line], {}),
        (cattaneo.MarchSettings, [], {"increments": 2, "stepping": "exact", "friction": cattaneo.FrictionSettings(tolerance=1e-10), "increments_of_piece": [1, 2], "loss_error": True}),
        (readout.FitSettings, [], {"window": (0.1, 0.2), "skip": 1}),
        (lambda *a: setattr(cattaneo.MarchSettings(), *a), ["increments", 3], {}),
        (cattaneo.condense, [half_plane, [0, 1, 2]], {"order": 2, "formulation": "plane"}),
        (cattaneo.reduce, [condensed, 0.1], {}),
        (cattaneo.reduce, [[condensed], [cattaneo.Interface("a", (0, line))]], {}),
        (cattaneo.Interface, ["a", (0, line), (0, line)], {"slave": "finer", "gap": 0.0, "most_overlap": 0.1}),
        (cattaneo.ReducedProblem, [np.eye(2), np.zeros((2, 2)), np.eye(2), p.patterns], {"gap": [0, 1], "friction": 0.3, "weights": [1, 1], "arc_length": [0, 1], "position": np.eye(2), "H": np.zeros((2, 2))}),
        (cattaneo.LoadHistory.through, [p, [{}, {"P": 1}, {"P": 1}]], {"cycle_start": 1, "cycles": 2, "times": [0, 1, 2]}),
        (cattaneo.march, [p, [{}, {"P": 1}, {"P": 1, "Q": 0.2}]], {"settings": cattaneo.MarchSettings(increments=2, stepping="exact"), "keep_states": True, "observer": None, "stop": None}),
        (cattaneo.march, [p, at, state], {}),
        (cattaneo.ContactState.with_slip, [p, [0.1, 0.2]], {}),
        (reduction.displacement, [0, cattaneo.ContactState.virgin(reduction.problem)], {}),
        (reduction.problem.copy().clamped_forces, [{"P": 1.0}], {}),
        (condensed.recover, [np.ones(4), np.ones(1)], {}),
        (cattaneo.hold, [problem(), [0]], {}),
        (readout.zones, [p, state], {}),
        (readout.tractions, [p, state.p], {}),
        (shakedown.load_limit, [limit], {"settings": shakedown.LimitSettings(tolerance=1e-4, max_iterations=50), "start": None}),
        (shakedown.friction_limit, [limit, 0.3], {"settings": shakedown.LimitSettings(largest_friction=3.0)}),
        (shakedown.closed_contact, [p, [0, 1]], {}),
        (shakedown.stay_closed, [p, cycle, 0.2, 2], {}),
        (shakedown.transient, [limit, 0.2], {"start": [0.0, 0.1], "settings": shakedown.TransientSettings(cycles=3)}),
        (fretting.stress, [edge, [0.1, 0.2], 0.3], {}),
        (fretting.hertz_slip_energy, [0.3, 1.0, [0.2, 0.5], 1.0], {}),
        (cattaneo.HalfPlaneField, [half_plane, cattaneo.condense(half_plane, [0.0, 1.0, 2.0]).line, np.zeros(6)], {}),
    ]  # fmt: skip


def fuzz(seed, calls):
    """Calls everything with anything; what comes back is an answer or an exception of Python's."""
    import warnings

    warnings.simplefilter("ignore")
    random = np.random.default_rng(seed)
    good, found = callables()
    nearly = nearly_right()
    for call, arguments, named in nearly:
        call(*arguments, **named)
    answers, refusals = 0, 0
    for k in range(calls):
        named = {}
        if k % 2:
            name, call = found[int(random.integers(len(found)))]
            arguments = [odd(random, good) for _ in range(int(random.integers(1, 5)))]
        else:
            call, arguments, named = nearly[int(random.integers(len(nearly)))]
            arguments, named, name = list(arguments), dict(named), str(call)
            place = int(random.integers(len(arguments) + len(named)))
            if place < len(arguments):
                arguments[place] = odd(random, good)
            else:
                named[list(named)[place - len(arguments)]] = odd(random, good)
        try:
            result = call(*arguments, **named)
            repr(result)
            answers += 1
        except (ValueError, TypeError, KeyError, AttributeError, ImportError, MemoryError) as error:
            assert not isinstance(error, cattaneo.InputError) or "\n" not in str(error), (name, str(error))
            refusals += 1
    print(answers, refusals)


@pytest.mark.parametrize("seed", range(4))
def test_fuzz(seed):
    """In a process of its own, whose end would show a crash."""
    words = [sys.executable, "-X", "faulthandler", __file__, str(seed), "1500"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    answers, refusals = map(int, done.stdout.split())
    assert refusals > 500 and answers > 20  # neither all is refused nor all taken


if __name__ == "__main__":
    fuzz(int(sys.argv[1]), int(sys.argv[2]))

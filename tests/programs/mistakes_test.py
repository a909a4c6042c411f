"""Mistakes that users make with files of their own: one sentence each, which names interface, body and side, and the cure."""

import pytest
from programs import body, changed, face, shipped

PAD, BASE = {"load": ["P pressure 3 1", "Q traction 3 0.1 0"]}, {"support": "1:xy"}


@pytest.fixture
def two(run):
    """A pad on a base; boundary 1 below, 2 right, 3 above, 4 left."""
    run.block("pad.mesh", -1, 1, 8, 0, 2, 8)
    run.block("base.mesh", -2, 2, 16, -2, 0, 8)
    return {
        "version": 2, "order": 1,
        "bodies": {"pad": body("pad.mesh", **PAD), "base": body("base.mesh", **BASE)},
        "interfaces": {"face": face("pad:1", "base:3")},
        "history": ["P=0", "P=1", "Q=1"],
    }  # fmt: skip


CHANGES = {
    # A side that reaches into a guide or a support.
    "a side in a guide": (
        {"bodies.base.support": None, "bodies.base.guides": [{"on": "3", "x": "held", "y": "held"}]},
        ["interface 'face': its side '3' of body base is all of it in the guide on '3'", "must be another part"],
    ),
    "a side that ends at a guide": (
        {"bodies.pad.guides": [{"on": "4", "x": "free", "y": "free"}]},
        ["interface 'face': its side '1' of body pad reaches into the guide on '4' at (-1, 0)", "one of them must end before the other",
         "1[0<x<1]"],
    ),
    "a side that supports hold": (
        {"bodies.base.support": "3:xy"},
        ["interface 'face': its side '3' of body base is held in all components by supports of the body (3:xy)"],
    ),
    # One mesh for two bodies.
    "one mesh twice": (
        {"bodies.base.mesh": "pad.mesh", "bodies.base.support": "3:xy", "interfaces.face.between": ["pad:1", "base:3"]},
        ["interface 'face': bodies pad and base are the same mesh '", "pad.mesh' at the same place, so that they overlap wholly",
         "give each a mesh at its own place"],
    ),
    "what nothing holds": ({"bodies.base.support": None}, ["load pattern 'P' pushes body 'pad' and body 'base'", "support one of them"]),
    "a part that there is not": (
        {"interfaces.face.between.0": "pad 1"}, ["between.0': 'pad 1': there is no body 'pad 1', must be one of pad, base", "as BODY:PART"],
    ),
    "an empty list of bodies": ({"bodies": {}}, ["key 'bodies' is empty, must be names with values in braces, as {\"NAME\": …}, one at least"]),
    "a first point with a load": ({"history": ["P=1", "Q=1"]}, ["P is 1 at the first point, must be 0", "begin with 'P=0'"]),
    "a mesh without materials": (
        {"bodies.pad.young": None, "bodies.pad.poisson": None}, ["key 'bodies.pad' has neither 'young' nor 'poisson', must have both", "only decks (.inp)"],
    ),
    "a load without a name": ({"bodies.pad.load": "pressure 3 1"}, ["kind '3' is not one of pressure", ": a load begins with its name, as P pressure"]),
    "sides that are numbers": ({"interfaces.face.between": [1, 3]}, ["between.0' is 1, must be BODY:PART, or a list of two"]),
    "a folder": ({"bodies.pad.mesh": "."}, ["body pad ('", "mesh file cannot be read: it is a folder"]),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_changes_of_a_case(run, two, name):
    changes, words = CHANGES[name]
    refused = run.case(changed(two, changes), code=1)
    for word in words:
        assert word in refused.error, refused.error
    assert not any(inside in refused.error for inside in ("dofs", "rows", "(part "))


@pytest.mark.parametrize("small", ["pad", "base"])
def test_metres_beside_millimetres(run, two, small):
    """Refused or warned of, whichever body has the other unit."""
    extents = {"pad": (-1, 1, 8, 0, 2, 8), "base": (-2, 2, 16, -2, 0, 8)}[small]
    run.block("small.mesh", *[x if k in (2, 5) else 1e-3 * x for k, x in enumerate(extents)])
    got = run.case(changed(two, {f"bodies.{small}.mesh": "small.mesh"}), code=None)
    said = got.output
    assert "interface 'face': body pad is " in said and "are both meshes in the same unit of length" in said
    usual = run.case(two)
    assert "same unit" not in usual.output


def test_what_moves_before_anything_presses(run, two):
    for history in (["P=0", "Q=1", "P=1"], ["P=0", "Q=0", "Q=1", "P=1"]):
        got = run.case({**two, "history": history}, code=2)
        assert got["status"] == "gross sliding"
        assert f"no load presses the bodies together yet: load 'P' grows on the way to point {len(history) - 1} of the history" in got["message"], got["message"]
    pulled = run.case(changed(two, {"bodies.pad.load": ["P pressure 3 -1"], "history": ["P=0", "P=1"]}), code=2)
    assert "no load presses the bodies together, and no other load comes later: does a load have the wrong sign?" in pulled["message"]
    # Where something presses nothing of the kind is said.
    slid = run.case(changed(two, {"history": ["P=0", "P=1", "Q=20"]}), code=2)
    assert slid["status"] == "gross sliding" and "presses" not in slid["message"]


def test_bolts_that_are_tightened_too_late(run):
    case = shipped("bolted_joint_drawing")
    case.pop("cycle-start")
    case.pop("cycles")
    got = run.case({**case, "history": ["Q=0", "Q=1", "bolt=1"]}, code=2)
    assert "no load presses the bodies together yet: bolt 'bolt' is tightened at point 2 of the history" in got["message"], got["message"]


@pytest.mark.parametrize("text, words", [
    ('{"version": 2, "bodies": {"pad": {"mesh": "pad.mesh",}}}', "line 1, column 54: unexpected '}', must be a name in double quotes, or no comma before it"),
    ('{"version": 2,\n "bodies": {', "line 2, column 13: unexpected end of input, must be"),
    ("{'version': 2}", "line 1, column 2: invalid literal; last read: '{''"),
    ("", "is empty"),
])  # fmt: skip
def test_json_that_is_broken(run, text, words):
    run.write("case.json", text)
    error = run("contact", "--case", run.folder / "case.json", code=1).error
    assert words in error and "json.exception" not in error and "syntax error" not in error, error


def part_deck(*instances):
    """A part of 4 × 2 squares, [0, 2] × [0, 1], and its instances in a deck as CAE writes it."""
    lines = ["*Part, name=BRICK", "*Node"]
    lines += [f"{1 + i + 5 * j}, {0.5 * i}, {0.5 * j}" for j in range(3) for i in range(5)]
    lines += ["*Element, type=CPE4"]
    lines += [f"{1 + i + 4 * j}, {1 + i + 5 * j}, {2 + i + 5 * j}, {7 + i + 5 * j}, {6 + i + 5 * j}" for j in range(2) for i in range(4)]
    lines += ["*Elset, elset=_ALL", "1, 2, 3, 4, 5, 6, 7, 8", "*Elset, elset=_B_S1, internal", "1, 2, 3, 4", "*Elset, elset=_T_S3, internal",
              "5, 6, 7, 8", "*Surface, type=ELEMENT, name=BOTTOM", "_B_S1, S1", "*Surface, type=ELEMENT, name=TOP", "_T_S3, S3",
              "*Nset, nset=MIDDLE", "3,", "*Solid Section, elset=_ALL, material=M", ",", "*End Part", "*Assembly, name=A"]  # fmt: skip
    for name, motion in instances:
        lines += [f"*Instance, name={name}, part=BRICK", *motion, "*End Instance"]
    return "\n".join([*lines, "*End Assembly", "*Material, name=M", "*Elastic", "1000., 0.", ""])


def test_instances_by_the_names_of_the_bodies(run):
    """One part twice, once upside down, with no key 'part': they are two bodies at two places."""
    turned = ["0., 0., 0.", "1., 0.5, 0., 1., 0.5, 1., 180."]
    run.write("two.inp", part_deck(("UP", turned), ("LOW", ["0., -1., 0."])))
    case = {
        "order": 1,
        "bodies": {"up": {"mesh": "two.inp", "load": ["P pressure BOTTOM 3"]}, "low": {"mesh": "two.inp", "support": "BOTTOM:xy"}},
        "interfaces": {"joint": {"between": ["up:TOP", "low:TOP"], "friction": 0.3}},
    }
    got = run.case(case)
    assert abs(got.interface("joint")["normal"] - 3 * 2) < 1e-12 and abs(got["peak_pressure"] - 3) < 1e-12
    # Plane elements in a case about an axis are warned of.
    spun = run.case(changed(case, {"analysis": "axisymmetric", "bodies.low.support": "BOTTOM:rz"}))
    assert "body up ('" in spun.warned() and "its elements are plane (CPE), the case computes bodies of revolution" in spun.warned()
    assert "bodies of revolution" not in got.warned()
    # Two instances at one place overlap, whatever they are called; so do two files of the same nodes.
    run.write("one.inp", part_deck(("UP", []), ("LOW", [])))
    same = {"bodies.up.mesh": "one.inp", "bodies.low.mesh": "one.inp"}
    assert "bodies up and low are the same mesh '" in run.case(changed(case, same), code=1).error
    run.write("other.inp", part_deck(("UP", []), ("LOW", ["0., -1., 0."])))
    refused = run.case(changed(case, {"bodies.up.mesh": "one.inp", "bodies.low.mesh": "other.inp", "bodies.low.part": "UP"}), code=1)
    assert "bodies up and low have the same nodes, '" in refused.error and "they overlap wholly" in refused.error


def test_supports_of_an_abaqus_matrix(run):
    """1e36 on a diagonal is a support whose forces are lost with it: one row has all that is left over."""
    np = pytest.importorskip("numpy")
    places = [(x, y) for y in (0, 1) for x in (0, 1, 2)]
    K = np.zeros((12, 12))
    for a, b in [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5), (0, 4), (1, 3), (1, 5), (2, 4)]:
        along = np.subtract(places[b], places[a])
        stretch = np.zeros(12)
        stretch[2 * a : 2 * a + 2], stretch[2 * b : 2 * b + 2] = -along / np.linalg.norm(along), along / np.linalg.norm(along)
        K += np.outer(stretch, stretch)
    for dof in (6, 10):  # x of both upper corners
        K[dof, dof] = 1e36
    run.write("job_STIF1.mtx", "".join(f"{i // 2 + 1},{i % 2 + 1}, {j // 2 + 1},{j % 2 + 1}, {K[i, j]:.16e}\n"
                                       for i in range(12) for j in range(i, 12) if K[i, j] != 0))  # fmt: skip
    run.write("job.inp", "*Node\n" + "".join(f"{k + 1}, {x}, {y}\n" for k, (x, y) in enumerate(places))
              + "*Element, type=CPE4, elset=PAD\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*Nset, nset=FOOT\n1, 2, 3\n*Nset, nset=TOP\n4, 5, 6\n")  # fmt: skip
    got = run.case({
        "bodies": {"pad": {"matrix": "job_STIF1.mtx", "load": ["P force TOP 0 -1", "Q force FOOT 0.1 0"]}},
        "interfaces": {"floor": {"between": ["pad:FOOT"], "friction": 0}}, "history": ["P=0", "P=1", "Q=1"],
    })  # fmt: skip
    supports = [row for row in got["reactions"] if row["kind"] == "support"]
    assert [row["name"] for row in supports] == ["left out of the matrix"], got.output
    assert abs(supports[0]["force_x"] + 3 * 0.1) < 1e-12


def test_numbers_that_mean_something_else(run):
    """A percentage, a force where a factor stands, a bolt that leans, and what is refused."""
    run.block("up.mesh", 0, 4, 8, 0, 1, 2)
    run.block("low.mesh", 0, 4, 8, -1, 0, 2)
    bolt = {"between": ["up:3[1<x<3]", "low:1[1<x<3]"], "stiffness": 100, "preload": 1}
    case = {"bodies": {"up": body("up.mesh", "@0,1:x"), "low": body("low.mesh", "1:x @0,-1:y @4,-1:y")}, "interfaces": {"flat": face("up:1", "low:3", 0.3)},
            "bolts": {"M8": bolt}, "history": ["M8=0", "M8=1"]}
    assert run.case(case).warned() == ""
    assert "friction' is 30: it is a coefficient such as 0.3, not a percentage" in run.case(changed(case, {"interfaces.flat.friction": 30})).warned()
    assert "history tightens bolt 'M8' to 30 times its preload" in run.case(changed(case, {"history": ["M8=0", "M8=30"]}), code=None).warned()
    leaning = run.case(changed(case, {"bolts.M8.between": ["up:3[1<x<3]", "low:1[0<x<3]"]}), code=None).warned()
    assert "bolt 'M8' leans by 14 degrees" in leaning and "key 'direction'" in leaning, leaning
    guided = changed(case, {"bodies.up.guides": [{"on": "4", "x": "held"}]})
    assert "key 'bodies.up.guides.0.on' '4': " in run.refused(guided)
    floor = {"bodies": {"up": body("up.mesh", None, ["P pressure 3 1"])}, "interfaces": {"floor": {"between": ["up:1"], "friction": 0.3}}, "history": ["P=0", "P=1"]}
    assert "motion.turn' turns the obstacle, it must have the key centre" in run.refused(changed(floor, {"interfaces.floor.motion": {"turn": {"angle": 0.1}}}))
    free = run.refused({**changed(floor, {"interfaces.floor.guide": {"x": {"force": "Q"}, "y": {"force": "P2"}}}), "history": ["P=0", "P=1"]})
    assert "the bodies do not resist all motions of the obstacles of interface 'floor'" in free, free
    assert "'1:4' is no range, must be FROM:TO:COUNT" in run.refused(case, "--sweep", "order=1:4")
    run.write("mesh.inp", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
    assert "a mesh of Gmsh must be called .msh" in run.refused(changed(case, {"bodies.up.mesh": str(run.folder / "mesh.inp")}))
    run.refuses("contact", ["--case", run.write("empty.json", "\n")], ["case file", "is empty"])

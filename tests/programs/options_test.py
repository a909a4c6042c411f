"""Mistakes that can be made with any program: one sentence that names the option, exit code 1 and no file."""

import json

import pytest

PROGRAMS = ["square_punch", "hertz", "plane_receding", "shakedown", "lap_joint", "axisymmetric_receding"]


@pytest.mark.parametrize("program", PROGRAMS)
def test_numbers_are_named_with_their_option(run, program):
    for words, said in (("--friction abc", ["option --friction", "'abc'", "not a number"]),
                        ("--friction 0,3", ["option --friction", "'0,3'", "not a number"]),
                        ("--friction nan", ["option --friction", "'nan'"]),
                        ("--friction -0.5", ["option --friction", "-0.5"]),
                        ("--order 1.5", ["option --order", "'1.5'", "an integer"]),
                        ("--order 99999999999", ["option --order", "too large"]),
                        ("--poisson -2", ["Poisson's ratio", "-2", "above -1"])):
        run.refuses(program, words.split(), said)
    run.refuses(program, ["--friction", ""], ["option --friction", "''", "not a number"])
    if program == "square_punch":  # -1 is no longer "as the obstacle has it"
        run.refuses(program, ["--friction", -1], ["option --friction", "-1"])
        run.refuses("fretting", ["--normal-load", "abc"], ["option --normal-load", "'abc'", "not a number"])
        run.refuses("fretting", ["-nodes", 1.5], ["option -nodes", "'1.5'", "an integer"])


def test_every_option_has_a_value(run):
    for program in PROGRAMS:
        run.refuses(program, ["--save", "--order", 2], ["option --save has no value"])
        run.refuses(program, ["--friction", "--order", 2], ["option --friction has no value"])
    run.refuses("fretting", ["--plot", "--normal-load", 3], ["option --plot has no value"])
    run.refuses("hertz", ["-friction", 0.1, "--friction", 0.2], ["option --friction", "twice"])


@pytest.mark.parametrize("program, options, option, goes_with", [
    ("hertz", "--sweep-results half_width", "--sweep-results", "--sweep"),
    ("march", "-reduced problems/hertz.json -frames all", "--frames", "--csv"),
    ("march", "-reduced problems/hertz.json -max-sweeps 7", "--max-sweeps", "--method"),
    ("axisymmetric_receding", "-critical-bonded", "--critical-bonded", "--critical"),
    ("axisymmetric_receding", "-map-friction 0.5", "--map-friction", "--map-load-radius"),
    ("axisymmetric_receding", "-amplitude 0.5", "--amplitude", "--twist-cycles"),
    ("axisymmetric_receding", "-cycles 5", "--cycles", "--cycle-to"),
    ("axisymmetric_receding", "-twist rim", "--twist", "--torque"),
    ("plane_receding", "-map-friction 0.5", "--map-friction", "--map-overhang"),
    ("plane_receding", "-cycles 5", "--cycles", "--cycle-to"),
    ("square_punch", "-amplitude 0.5", "--amplitude", "--cycles"),
    ("lap_joint", "-map-friction 0.5", "--map-friction", "--map-load"),
    ("lap_joint", "-frame-intervals 3", "--frame-intervals", "--paraview"),
    ("fretting", "--pad fe -findley 0.2", "--findley", "--averaging-depth"),
    ("lap_joint", "-snug 0.1", "--snug", "--bolt-positions"),
    ("shakedown", "-reduced problems/square_punch.json -nodes 51", "--nodes", "punch"),
    ("shakedown", "-mismatch-poisson 0.2", "--mismatch-poisson", "--mismatch"),
    ("shakedown", "-load-ratio -1 -lambda-min -0.2", "--lambda-min", "--load-ratio"),
])
def test_what_a_run_does_not_use_is_refused(run, program, options, option, goes_with):
    """An option that the chosen way of running does not use would change nothing, without a word."""
    run.refuses(program, options.split(), [f"option {option} does nothing", goes_with])


def test_empty_names_and_scenes_that_are_none_are_refused(run):
    """Nothing is computed for what would then not be written or shown."""
    for written in ("--csv", "--html", "--plot", "--save"):
        run.refuses("hertz", [written, ""], [written, "is empty"])
    run.refuses("hertz", ["--json", "", "--order", 2], ["--json", "is empty"])
    for program, *words in (["design"], ["wear"], ["fretting"], ["fretting", "--pad", "fe"]):
        run.refuses(program, [*words, "--check"], ["option --check", "no meshes to show"])
    run.refuses("lap_joint", ["--bolt-positions", 100000], ["--bolt-positions", "contact nodes", "20000"])
    run.refuses("lap_joint", ["-spacing", 0.05, "--cycles", 2147483647], ["cycles", "at most"])


def test_help_lists_them(run):
    """-h says what the program is for, its units and how it is called, then lists every option with its name; nothing is computed."""
    got = run("fretting", "--normal-load", 300, "-h")
    assert got.results is None
    for words in ("will a crack grow", "Units: N, mm, MPa", "fretting --pad fe --shear-load 50\n", "   --normal-load <number>, default 400\n",
                  "   --friction <number>\n", "   --pad <hertz|flat-rounded|fe|kn>, default hertz\n", "   --plane-stress or --plane-strain\n",
                  "   --json <text>\n"):
        assert words in got.output, words
    headings = [line for line in got.output.splitlines() if line.endswith(":") and line[:1].isupper()]
    assert headings == ["Sample runs:", "A case file:", "The pad:", "The loads:", "Finite elements:", "The criteria:", "The material:",
                        "Results, and how they are shown:", "Many runs:"], headings


OLD_NAMES = {
    "lap_joint": {"march": "stepping", "bolts": "bolt-positions", "frames": "frame-intervals", "sweep-load": "map-load",
                  "sweep-friction": "map-friction", "sweep-width": "map-width"},
    "plane_receding": {"march": "stepping", "steps": "increments", "map": "map-overhang"},
    "axisymmetric_receding": {"steps": "increments", "load-cycles": "cycles", "map": "map-load-radius"},
    "square_punch": {"march": "stepping"},
    "shakedown": {"reversal": "load-ratio", "load-ratios": "loads-over-friction", "corner": "left-out"},
    "wear": {"shear": "amplitude", "tolerance": "depth-error", "threshold": "least-pressure"},
    "design": {"shear": "amplitude", "tolerance": "optimality-error"},
    "fretting": {"p": "pad", "P": "normal-load", "Q": "shear-load", "f": "friction", "no-ps": "plane-strain", "j": "json"},
}


@pytest.mark.parametrize("program", OLD_NAMES)
def test_old_names_are_refused_with_the_new_ones(run, program):
    """On the command line, in a case file and in a sweep; every new name is an option of the program."""
    helped = run(program, "-h").output
    for old, new in OLD_NAMES[program].items():
        said = [f"is called --{new} now"]
        run.refuses(program, ["--" + old, 1], [f"option --{old}", *said])
        run.refuses(program, ["-" + old, 1], [f"option -{old}", *said])
        case = run.folder / "old.json"
        case.write_text(json.dumps({old: 1}), encoding="utf-8")
        run.refuses(program, ["--case", case], [f"key '{old}'", "old.json", *said])
        run.refuses(program, ["--sweep", f"{old}=1 2"], ["option --sweep", f"'{old}'", *said])
        assert f"--{new} " in helped or f"--{new}\n" in helped, new
    if program == "axisymmetric_receding":  # whose cycles of the load had another name
        run.refuses(program, ["--cycles", 3], ["option --cycles does nothing", "--cycle-to", "cycles of torsion are --twist-cycles"])


def test_files_are_checked_before_the_work(run):
    none = run.folder / "none" / "x"
    for program in PROGRAMS:
        run.refuses(program, ["--save", none], ["option --save", "no folder"])
        run.refuses(program, ["--save", run.folder], ["option --save", "a folder of that name"])
    endless = 300 * "x"
    for option in ("save", "csv", "plot", "html"):
        run.refuses("hertz", ["--" + option, endless], ["option --" + option, "File name too long"])
    dovetail = ["--case", "meshes/dovetail.json"]
    run.refuses("contact", [*dovetail, "--paraview", endless], ["option --paraview", "File name too long"])
    run.refuses("contact", [*dovetail, "--set", "bodies.root.mesh=" + endless], ["mesh file cannot be read"])
    for program in ("fretting", "contact", "shakedown", "lap_joint", "hertz", "square_punch", "plane_receding", "axisymmetric_receding"):
        what = dovetail if program == "contact" else []
        run.refuses(program, [*what, "--csv", none], ["option --csv", "no folder"])
        run.refuses(program, [*what, "--plot", f"{none}.png"], ["option --plot", "no folder"])
        run.refuses(program, [*what, "--plot", run.folder / "x.xyz"], ["option --plot", ".png"])
    run.refuses("fretting", ["--young", 210000], ["option --young", "210000", "GPa, not MPa"])
    run.refuses("fretting", ["--threshold", -1], ["option --threshold", "-1", "positive"])
    run.refuses("lap_joint", ["--paraview", "meshes/README.md/fields"], ["option --paraview", "no folder"])
    run.refuses("hertz", ["--save", run.folder / "hertz_results.json"], ["--json", "--save", "name another"])
    # What would write over a table of the run, or write nothing.
    run.refuses("hertz", ["--csv", run.folder / "t", "--save", run.folder / "t_pressure.csv"], ["option --save", "t_pressure.csv", "tables of option --csv"])
    run.refuses("fretting", ["--save", run.folder / "none.json"], ["--save", "no reduced problem"])
    run.refuses("hertz", ["--check", "--save", run.folder / "none.json"], ["--save", "cannot be used with --check"])


def test_every_study_takes_a_case_file(run):
    """By the long names of its options, overridden by the command line; what is written is no part of a case."""
    def case(keys):
        return ["--case", run.write("study.json", json.dumps(keys))]

    got = run("square_punch", *case({"obstacle": "half-plane", "nodes": 33, "shear": [0.25, 0.75], "friction": 0.3}), "--friction", 0.4)
    assert got["contact_nodes"] == 33 and got["friction"] == 0.4
    assert len(got["levels"]) == 2 and got["levels"][1]["shear"] == 0.75
    assert not run("square_punch", *case({"nodes": 33, "shear": "none"}))["levels"]
    run.refuses("square_punch", case({"shear": "some"}), ["key 'shear'", "some", "array of numbers", "none"])
    for program in PROGRAMS:
        run.refuses(program, case({"friction": "much"}), ["key 'friction'", "a number"])
        run.refuses(program, case({"friction": -1}), ["key 'friction'", "-1"])
        run.refuses(program, case({"json": "x.json"}), ["unknown key 'json'"])
    run.refuses("fretting", case({"pad": "ball"}), ["key 'pad'", "'ball'", "hertz"])
    run.refuses("hertz", case({"body": 3}), ["key 'body'", "3", "a string"])


@pytest.mark.rest
def test_every_study_draws_a_picture(run):
    """--plot FILE of every study, in every format, is a picture and leaves nothing else behind."""
    folder = run.folder / "pictures"
    folder.mkdir()
    reduced = run.folder / "drawn.json"
    runs = [f"square_punch -nodes 33 -save {reduced}", "shakedown -nodes 17 -cycles 3",
            f"shakedown -find load -friction 0.8 -cycles 3 -reduced {reduced}", "hertz -nodes 33", "plane_receding -spacing 0.1 -corner 0.02",
            "axisymmetric_receding -spacing 0.1", "lap_joint -spacing 0.05 -increments 5", "contact --case meshes/rounded_punch.json --cycles 1",
            "march -case problems/sliders.case.json", "fretting --shear-load 50"]
    for number, command in enumerate(runs):
        picture = folder / (str(number) + (".png", ".pdf", ".svg")[number % 3])
        run(*command.split(), "--plot", picture)
        assert picture.stat().st_size > 5000, command
        assert len(list(folder.iterdir())) == number + 1, command


def test_lists_and_choices_say_what_is_allowed(run):
    for program, words, said in (
            ("lap_joint", ["--bolt-positions", "0 0"], ["option --bolt-positions", "two bolts at 0"]),
            ("lap_joint", ["--bolt-positions", ""], ["option --bolt-positions"]),
            ("lap_joint", ["--remote", -1], ["option --remote is -1"]),
            ("lap_joint", ["--map-load", 0.01, "--map-friction", -1], ["option --map-friction", "-1"]),
            ("lap_joint", ["--map-load", 0.02, "--map-width", 0], ["--map-width", "0", "positive"]),
            ("plane_receding", ["--length", 1], ["--overhang", "4", "length 1"]),
            ("plane_receding", ["--length", -1], ["--length", "-1"]),
            ("plane_receding", ["--unload", 0.5, "--slip", 99], ["--slip", "99", "on the strip"]),
            ("plane_receding", ["--map-overhang", 4, "--map-friction", ""], ["--map-friction"]),
            ("plane_receding", ["--map-overhang", 4, "--map-friction", -1], ["--map-friction", "-1"]),
            ("shakedown", ["--lambda-max", 0.2, "--lambda-min", 0.5], ["--lambda-min", "0.5", "0.2"]),
            ("shakedown", ["--load-ratio", 2], ["--load-ratio", "2", "-1 and 1"]),
            ("shakedown", ["--held", "Q"], ["--held", "--cycled", "'Q'"])):
        run.refuses(program, words, said)

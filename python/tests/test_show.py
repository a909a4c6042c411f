"""cattaneo.show: what is drawn are the numbers of the JSON, and a page holds them."""

import json
import os
import re
import stat

import cattaneo
import pytest
from cattaneo import show

RUN = {
    "status": "converged", "seconds": 0.5, "warnings": ["a <b> & c"],
    "loop": [{"load": 0.0, "way": 0.0, "f": 0.2}, {"load": 1.0, "way": 2.5, "f": 0.2}, {"load": 1.0, "way": 2.0, "f": 0.4}],
    "shown": {
        "study": "made", "event": "", "units": {"length": " [mm]", "pressure": " [MPa]"}, "options": {"nodes": 3}, "values": [], "tables": [], "marches": [], "more_marches": 0,
        "panels": [
            {"name": "p", "kind": "lines", "title": "Pressure", "x": "x/a", "y": "p", "limits y": "0,",
             "parts": [{"series": "now", "style": "line", "x": [0, 1, 2], "y": [1, None, 3]}, {"series": "then", "style": "points", "x": [0], "y": [2]}]},
            {"name": "zones in time", "kind": "zones", "title": "Zones", "x": "t", "y": "s",
             "parts": [{"state": ["stick", "slip", "stick"], "time": [1, 1, 2], "from": [0, 1, 0], "to": [1, 4, 4]}]},
            {"name": "loop", "kind": "table", "title": "Loop", "x": "way", "y": "load", "over": "way", "curve": "load=load", "by": "f=f"},
        ],
    },
}  # fmt: skip


@pytest.fixture
def kept(tmp_path):
    file = tmp_path / "run.json"
    file.write_text(json.dumps(RUN), encoding="utf-8")
    return file


def test_panels_are_those_of_the_run(kept):
    run = show.read(kept)
    assert show.panel_names(run) == ["p", "zones in time", "loop"]
    words, rows = show.panel(run, "zones in time")
    assert words["title"] == ["Zones"]
    assert rows[1] == {"state": "slip", "time": 1, "from": 1, "to": 4}
    assert show.panel(run, "loop")[1] == RUN["loop"]
    with pytest.raises(show.Refused, match="no panel 'q', must be one of p, zones in time, loop"):
        show.panel(run, "q")


def test_what_is_drawn_are_its_numbers(kept, tmp_path):
    pytest.importorskip("matplotlib")
    figure = show.plot(kept, tmp_path / "p.png", panels=["p", "loop"])
    assert (tmp_path / "p.png").stat().st_size > 5000
    pressure, loop = figure.axes
    assert pressure.get_title() == "Pressure" and pressure.get_ylim()[0] == 0
    drawn = [line.get_xydata().tolist() for line in pressure.get_lines()]
    assert drawn[0][::2] == [[0, 1], [2, 3]] and drawn[0][1][1] != drawn[0][1][1]  # not known: a gap
    assert drawn[1] == [[0, 2]]
    # A curve for each value of the column that tells them apart.
    curves = {line.get_label(): line.get_xydata().tolist() for line in loop.get_lines()}
    assert curves == {"f = 0.2": [[0, 0], [2.5, 1]], "f = 0.4": [[2, 1]]}


def test_a_page_holds_the_run(kept, tmp_path):
    page = tmp_path / "page.html"
    show.page(kept, page, figure=False)
    text = page.read_text(encoding="utf-8")
    data = json.loads(re.search(r'id="run">(.*?)</script>', text, re.S)[1])
    assert data["study"] == "made" and data["units"]["length"] == " [mm]" and data["warnings"] == RUN["warnings"] and data["options"] == {"nodes": 3}
    with pytest.raises(show.Refused, match="cannot be written"):
        show.page(kept, tmp_path / "none" / "page.html", figure=False)


def test_it_is_a_package_of_its_own():
    import cattaneo_show

    assert cattaneo.show.plot is cattaneo_show.plot


@pytest.mark.parametrize(
    "key, said",
    [
        ("friction", "friction"),
        ("history.2.Q,-history.3.Q,history.4.Q", "amplitude of Q"),
        ("history.1.'bolt 3, w = 1'", "bolt 3, w = 1 at point 1"),
        ("history.1.P,history.2.Q", "history.1.P,history.2.Q"),
    ],
)
def test_keys_of_a_sweep_are_read_as_loads(key, said):
    from cattaneo_show.sweep import called

    assert called(key) == said


def test_axes_of_a_sweep_follow_their_values():
    from cattaneo_show.sweep import curves

    def drawn(values, results):
        key = {"name": "k", "values": values}
        points = [type("P", (), {"values": [x], "results": {"y": y}, "ended_well": True})() for x, y in zip(values, results)]
        (panel,) = curves([key], points, {"y": ["y"]})
        return panel.get("scale", "")

    assert drawn([1.0, 2.0], [1.0, 3.0]) == ""
    assert drawn([1.0, 200.0], [1.0, 3.0]) == "semilogx"
    assert drawn([1.0, 2.0], [1e-3, 1.0]) == "semilogy"
    assert drawn([1.0, 200.0], [1e-3, 1.0]) == "loglog"
    assert drawn([-1.0, 200.0], [0.0, 1.0]) == ""


def test_loops_lie_beside_the_same_less_their_elastic_part(kept):
    """A spring of stiffness 4 in series with a slider of force 1: without the spring a cycle is the slider's rectangle, as high as
    twice its force and as wide as its slip."""
    pytest.importorskip("matplotlib")
    forces, slips = [-1, 1, 1, -1, -1], [0, 0, 3, 3, 0]
    loop = {"name": "loops", "kind": "lines", "title": "Loops", "x": "displacement of Q [mm]", "y": "force Q [N]",
            "parts": [{"series": "Q", "style": "line", "x": [f / 4 + s for f, s in zip(forces, slips)], "y": forces}]}  # fmt: skip
    run = {**RUN, "shown": {**RUN["shown"], "panels": [loop]}}
    whole, less = show.plot(run).axes
    assert whole.get_xlabel() == "displacement of Q [mm]" and less.get_xlabel() == "displacement of Q less elastic part [mm]"
    assert less.get_lines()[0].get_xdata() == pytest.approx(slips) and list(less.get_lines()[0].get_ydata()) == forces
    # A straight line is no loop, and has nothing to be less.
    run["shown"]["panels"] = [{**loop, "parts": [{"series": "Q", "style": "line", "x": [0, 1, 0], "y": [0, 2, 0]}]}]
    assert len(show.plot(run).axes) == 1


def test_symbols_are_set_as_in_a_paper():
    pytest.importorskip("matplotlib")
    from cattaneo_show.drawing import symbols

    assert symbols("σ_vM/(K_N √d)") == r"$σ_{\mathrm{vM}}$/($K_{\mathrm{N}}$ √d)"
    assert symbols("ΔK_th, K_I,max") == r"Δ$K_{\mathrm{th}}$, $K_{\mathrm{I,max}}$"
    assert symbols("zones of under_head and bolt_1") == "zones of under_head and bolt_1"


def test_a_straight_line_in_logarithmic_axes_has_its_slope():
    from cattaneo_show.sweep import slopes

    parts = {"": {"series": "", "x": [1, 10, 100], "y": [2, 2000, 2e6]}, "f": {"series": "f = 1", "x": [1, 10, 100], "y": [1, 50, 60]}}
    slopes(parts, {"scale": "loglog"})
    assert [part["series"] for part in parts.values()] == ["slope 3", "f = 1"]



def test_places_are_named_by_x_where_a_line_is_straight():
    pytest.importorskip("matplotlib")
    zones = {"name": "zones_in_time", "kind": "zones", "title": "Zones", "x": "time", "y": "arc length [mm]", "straight": "face=x,-1,5",
             "parts": [{"state": ["stick", "slip", "stick", "slip"], "time": [1, 1, 2, 2], "from": [0, 4, 0, 6], "to": [4, 10, 6, 10]}]}  # fmt: skip
    curves = {"name": "tractions", "kind": "lines", "title": "Tractions", "x": "arc length [mm]", "y": "p", "apart": "interfaces",
              "straight": ["a=x,1,-5", "b=x,1,-1"],
              "parts": [{"series": name, "style": style, "x": [0, 2], "y": [1, 2]}
                        for name, style in (("a", "line"), ("q/f: a", "dashed"), ("b", "line"), ("q/f: b", "dashed"))]}  # fmt: skip
    run = {**RUN, "shown": {**RUN["shown"], "panels": [zones, curves]}}
    in_time, a, b = show.plot(run).axes  # one panel an interface
    assert in_time.get_ylabel() == "x [mm]" and sorted(in_time.get_ylim()) == [-5, 5]
    assert [axes.get_xlabel() for axes in (a, b)] == ["x [mm]"] * 2 and [axes.get_title() for axes in (a, b)] == ["Tractions, a", "Tractions, b"]
    assert a.get_lines()[0].get_xdata().tolist() == [-5, -3] and b.get_lines()[1].get_xdata().tolist() == [-1, 1]
    assert a.get_lines()[0].get_color() != b.get_lines()[0].get_color()
    # One that lies along y beside one along x: arc length is all that they share.
    curves["straight"] = ["a=x,1,-5", "b=y,1,-1"]
    del curves["apart"]
    run["shown"]["panels"] = [curves]
    (both,) = show.plot(run).axes
    assert both.get_xlabel() == "arc length [mm]" and both.get_lines()[0].get_xdata().tolist() == [0, 2]


def test_ticks_have_one_power_of_ten_beside_the_unit():
    pytest.importorskip("matplotlib")
    line = {"name": "l", "kind": "lines", "title": "l", "x": "slip [mm]", "y": "share", "limits x": "0,4e-4", "limits y": "0,1",
            "parts": [{"series": "", "style": "line", "x": [0, 4e-4], "y": [0, 1]}]}  # fmt: skip
    (axes,) = show.plot({**RUN, "shown": {**RUN["shown"], "panels": [line]}}).axes
    assert axes.get_xlabel() == "slip [$10^{-4}$ mm]" and axes.xaxis.get_major_formatter()(2e-4) == "2"
    assert axes.get_ylabel() == "share"


def test_results_of_a_sweep_are_called_as_the_program_calls_them():
    from cattaneo_show.sweep import varies, words_of

    def point(value, ended_well):
        return type("P", (), {"ended_well": ended_well, "results": {
            "peak": value, "total_dissipation": 1.0,
            "shown": {"values": [{"key": "peak", "label": "peak pressure [MPa]", "value": value, "unit": ""}], "units": {"energy": " [N mm]"}}}})()

    points = [point(1.0, True), point(1.0, True), point(2.0, False)]
    assert words_of(points, "peak") == ("peak pressure", " [MPa]")
    assert words_of(points, "total_dissipation") == ("energy lost in the whole history", " [N mm]") and words_of(points, "none_such") == ("none such", "")
    assert not varies(points, ["peak"])  # where a run slides it says nothing


def test_a_sweep_with_one_good_point_shows_what_differs_from_the_others():
    from cattaneo_show.sweep import Point, varies

    points = [Point([friction], []) for friction in (0.3, 0.05, 0.01)]
    for point, results in zip(points, ({"peak": 112.0, "dofs": 25}, {"peak": 93.0, "dofs": 25}, {})):  # the last one was refused
        point.results = results
    points[0].ended_well = True
    assert varies(points, ["peak"]) and not varies(points, ["dofs"]) and not varies(points, ["nothing"])
    points[1].ended_well, points[1].results = True, {"peak": 112.0, "dofs": 25}
    points[2].results = {"peak": 90.0}
    assert not varies(points, ["peak"])  # two ended well, and they agree


def test_links_and_devices_stay_what_they_are(tmp_path):
    from cattaneo_show.tables import write

    link, target = tmp_path / "link.csv", tmp_path / "target.csv"
    link.symlink_to(target)
    write(link, "a\n")
    assert link.is_symlink() and target.read_text(encoding="utf-8") == "a\n"
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    with open(os.open(pipe, os.O_RDWR), encoding="utf-8") as reader:
        write(pipe, "b\n")
        assert reader.readline() == "b\n" and stat.S_ISFIFO(pipe.stat().st_mode)
    (tmp_path / "folder").mkdir()
    with pytest.raises(show.Refused, match="folder' cannot be written"):
        write(tmp_path / "folder", "c")
    with pytest.raises(show.Refused, match="there is no folder"):
        write(tmp_path / "no" / "file", "c")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["folder", "link.csv", "pipe.csv", "target.csv"]

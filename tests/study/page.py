"""page.py PROGRAMS: the page of --html in a browser: its slider is moved, and what it shows then are the numbers of the CSV."""

import csv
import html
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

RUN = ["-reduced", "problems/hertz.json", "-history", "P=0; P=1; Q=.24; Q=-.24; Q=.24", "-cycle-start", "2", "-frames", "all"]
# What a hand does: the slider is put somewhere, and says so itself. What the page is then is kept in it.
MOVE = """<script>
const slider = document.getElementById("increment"), kept = [];
for (const place of %s) {
  slider.value = place - 1;
  slider.dispatchEvent(new Event("input"));
  kept.push(document.documentElement.outerHTML);
}
const keeper = document.createElement("script");
keeper.type = "application/json";
keeper.id = "kept";
keeper.textContent = JSON.stringify(kept).replaceAll("<", "\\\\u003c");
document.body.append(keeper);
</script></body>"""


def shown(browser, page, fragment=""):
    """The page as the browser has it when its scripts have run."""
    run = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", f"file://{page}{fragment}"],
                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, timeout=100)
    return run.stdout.decode("utf-8")


def cells(dom, name):
    """Rows of a table, as text."""
    table = re.search(rf'<table id="{name}">(.*?)</table>', dom, re.S).group(1)
    return [[html.unescape(re.sub("<.*?>", "", cell)) for cell in re.findall(r"<td.*?>(.*?)</td>", row)]
            for row in table.split("<tr>") if "<td" in row]


def points(dom, name):
    """Ordinates of a curve, in pixels."""
    path = re.search(rf'<path [^>]*id="{name}"[^>]*>', dom).group(0)
    return [float(y) for _, y in re.findall(r"[ML](\S+) ([-\d.]+)", re.search(r' d="(.*?)"', path).group(1))]


def attribute(dom, name, key):
    return float(re.search(rf' {key}="(.*?)"', re.search(rf'<[^>]*id="{name}"[^>]*>', dom).group(0)).group(1))


def near(a, b, error=1e-5):
    return abs(a - b) <= error * max(abs(a), abs(b)) + 1e-300


def check(dom, number, history, nodes):
    row, last = history[number - 1], len(history)
    assert f"increment {number} of {last}" in dom, re.search(r'id="state".*?<', dom).group(0)
    for name, multiplier, _, conjugate, word in cells(dom, "loads"):
        assert word.startswith("displacement"), word
        assert near(float(multiplier), float(row["load " + name])), (number, name, multiplier)
        # Zero is what is round-off of its largest value in the history.
        column = "displacement per unit of " + name
        largest = max(abs(float(one[column])) for one in history)
        found = float(row[column]) if abs(float(row[column])) >= 1e-9 * largest else 0
        assert near(float(conjugate), found), (number, name, conjugate)
    these = [node for node in nodes if node["time"] == row["time"]]
    pressure = [float(node["p"]) for node in these]
    shown_pressure, lost = (float(line[1]) for line in cells(dom, "more"))
    assert near(shown_pressure, max(pressure)) and near(lost, float(row["dissipation"])), (shown_pressure, lost)
    # The curves are drawn to scale: pixels are one linear function of both tractions.
    heights = points(dom, "pressure") + points(dom, "shear")
    values = pressure + [float(node["q"]) / 0.4 for node in these]
    assert len(heights) == len(values), (len(heights), len(values))
    low, high = values.index(min(values)), values.index(max(values))
    scale = (heights[high] - heights[low]) / (values[high] - values[low])
    assert scale < 0 # upwards
    assert all(abs(heights[low] + scale * (v - values[low]) - y) < 0.03 for v, y in zip(values, heights))
    # Zones: each node lies in a zone of its state, but for those next to a border.
    states = [(state, float(a), float(b)) for state, a, b in cells(dom, "zones")]
    right = sum(any(state == node["state"] and a <= float(node["x"]) <= b for state, a, b in states) for node in these)
    assert right >= len(these) - len(states), (number, right, states)
    return [attribute(dom, "cursor", "x1"), attribute(dom, "dot", "cx"), attribute(dom, "dot", "cy")]


def main():
    programs = pathlib.Path(sys.argv[1])
    root = pathlib.Path(__file__).resolve().parents[2]
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        page = folder / "page.html"
        run = subprocess.run([programs / "march", *RUN, "--html", page, "--csv", folder / "t"], cwd=root, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        assert run.returncode == 0, run.stdout
        text = page.read_text(encoding="utf-8")
        outside = re.findall(r'(?:src|href)="(?!#)[^"]*"|@import|url\((?!#)', text)
        assert not outside, f"the page asks for {outside}"
        assert "<svg" in text and not (folder / "page.html.svg").exists()
        json.loads(re.search(r'<script type="application/json" id="run">(.*?)</script>', text, re.S).group(1))
        bad = subprocess.run([programs / "march", *RUN, "--html", folder / "page.txt"], cwd=root, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        assert bad.returncode == 1 and "must end in .html" in bad.stdout, bad.stdout
        sliding = subprocess.run([programs / "march", "-reduced", "problems/hertz.json", "-history", "P=0; P=1; Q=.5", "--html", folder / "slides.html"],
                                 cwd=root, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        assert sliding.returncode == 2, sliding.stdout
        at = "time 1.8 (P = 1, Q = 0.4)" # it slides where Q = f P
        data = re.search(r'<script type="application/json" id="run">(.*?)</script>', (folder / "slides.html").read_text(encoding="utf-8"), re.S)
        assert json.loads(data.group(1))["event"] == at, data.group(1)[:300]
        assert not browser or f"gross sliding at {at}" in shown(browser, folder / "slides.html")
        if not browser:
            print("no chromium: the page is not opened")
            sys.exit(77)
        # Each interface has panels of its own, with its own nodes and zones; the loop is that of the load that cycles.
        joint = folder / "joint.html"
        subprocess.run([programs / "contact", "--case", "meshes/bolted_joint.json", "--cycles", "1", "--html", joint], cwd=root, stdout=subprocess.DEVNULL, check=True)
        dom = shown(browser, joint)
        for k, name in enumerate(("faying", "under_head", "under_nut")):
            assert f"Zones, {name}<" in dom and re.search(rf'id="pressure{f"-{k}" if k else ""}"', dom), name
        assert "<h1 id=\"name\">bolted_joint (contact)</h1>" in dom and ">displacement of upper:end along x [mm]<" in dom and "Displacements are drawn" in dom
        assert {row[3] for row in cells(dom, "zones")} == {"faying", "under_head", "under_nut"}
        # Contact on a surface has maps, and the areas of its states; bodies in space are drawn.
        surface, results = folder / "surface.html", folder / "surface.json"
        subprocess.run([programs / "contact", "--case", "meshes/sphere_on_block.json", "--cycles", "1", "--increments", "4", "--html", surface, "--json", results],
                       cwd=root, stdout=subprocess.DEVNULL, check=True)
        dom = shown(browser, surface)
        assert "Slip of block" in dom and "Drag to turn the bodies" in dom and ">displacement of the obstacle of ball along x [mm]<" in dom
        areas = {row["state"]: row["area"] for row in json.loads(results.read_text(encoding="utf-8"))["areas"]}
        (name, *shown_areas), = cells(dom, "zones")
        assert name == "ball" and all(near(float(a), areas[state], 1e-4) for a, state in zip(shown_areas, ("stick", "slip", "separation"), strict=True)), (shown_areas, areas)
        history, nodes = (list(csv.DictReader(open(folder / f"t_{table}.csv", encoding="utf-8"))) for table in ("history", "nodes"))
        seen = []
        seen.append(check(shown(browser, page), len(history), history, nodes)) # it begins at the end
        seen.append(check(shown(browser, page, "#increment=12"), 12, history, nodes))
        places, moved = [1, 30, 45], folder / "moved.html"
        moved.write_text(text.replace("</body>", MOVE % places), encoding="utf-8")
        kept = re.search(r'<script type="application/json" id="kept">(.*?)</script>', shown(browser, moved, "#increment=12"), re.S)
        for number, dom in zip(places, json.loads(kept.group(1)), strict=True):
            seen.append(check(dom, number, history, nodes))
        cursors, ways, loads = zip(*seen)
        by_number = [seen[k] for k in (2, 1, 3, 4, 0)]
        assert [x for x, _, _ in by_number] == sorted(set(cursors)), cursors
        # The dot is where the load is: Q = 0.24 at the end is the top of the loop, 0 its middle.
        assert loads[0] == min(loads) and len(set(ways)) > 3, (ways, loads)


main()

"""Published cases as case files of contact: writes them with their meshes, runs them, prints what comes out.

verification.py [FOLDER] [--json FILE]

Run it from the top of the repository. FOLDER, results/verification unless given, holds the cases afterwards:
./run contact --case results/verification/SSNV128.json is one of them. docs/verification.md has its numbers.
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys


def block(file, x0, x1, nx, y0, y1, ny, turned=0.0):
    """A rectangle in MFEM's format: boundary attributes 1 bottom, 2 right, 3 top, 4 left."""
    def number(i, j):
        return i + j * (nx + 1)

    elements = [f"1 3 {number(i, j)} {number(i + 1, j)} {number(i + 1, j + 1)} {number(i, j + 1)}"
                for j in range(ny) for i in range(nx)]
    boundary = [f"1 1 {number(i, 0)} {number(i + 1, 0)}" for i in range(nx)]
    boundary += [f"2 1 {number(nx, j)} {number(nx, j + 1)}" for j in range(ny)]
    boundary += [f"3 1 {number(i + 1, ny)} {number(i, ny)}" for i in range(nx)]
    boundary += [f"4 1 {number(0, j + 1)} {number(0, j)}" for j in range(ny)]
    c, s = math.cos(turned), math.sin(turned)
    vertices = []
    for j in range(ny + 1):
        for i in range(nx + 1):
            x, y = x0 + (x1 - x0) * i / nx, y0 + (y1 - y0) * j / ny
            vertices.append(f"{c * x - s * y!r} {s * x + c * y!r}")
    file.write_text("\n".join(["MFEM mesh v1.0", "", "dimension", "2", "", "elements", str(len(elements)), *elements, "",
                               "boundary", str(len(boundary)), *boundary, "", "vertices", str(len(vertices)), "2",
                               *vertices, ""]))


def body(mesh, support=None, load=(), young=1000.0, poisson=0.0):
    made = {"mesh": mesh, "young": young, "poisson": poisson}
    if support:
        made["support"] = support
    if load:
        made["load"] = list(load)
    return made


class Cases:
    def __init__(self, folder):
        self.folder = folder
        self.rows = []
        folder.mkdir(parents=True, exist_ok=True)
        self.programs = os.environ.get("PROGRAMS")  # built already; else ./run builds them

    def program(self, name, *options):
        command = [f"{self.programs}/{name}"] if self.programs else ["./run", name]
        done = subprocess.run([*command, *options], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode not in (0, 2):  # 2: gross sliding
            sys.exit(f"{name} {' '.join(options)}\n{done.stdout}")

    def run(self, name, case):
        """Results, and the last state of each contact node by x."""
        file = self.folder / f"{name}.json"
        file.write_text(json.dumps({"version": 2, **case}, indent=3) + "\n")
        out = self.folder / name
        self.program("contact", "--case", str(file), "--json", f"{out}_results.json", "--csv", str(out))
        with open(f"{out}_nodes.csv", encoding="utf-8") as table:
            nodes = list(csv.DictReader(table))
        last = nodes[-1]["time"]
        return json.loads(pathlib.Path(f"{out}_results.json").read_text()), [n for n in nodes if n["time"] == last]

    def says(self, quantity, reference, computed):
        self.rows.append({"quantity": quantity, "reference": reference, "computed": computed})

    def pressures(self, name, case, pressure):
        """Least and largest over the contact."""
        _, nodes = self.run(name, case)
        p = [float(node["p"]) for node in nodes]
        self.says(f"{name}, least pressure", pressure, min(p))
        self.says(f"{name}, largest pressure", pressure, max(p))

    def ssnv128(self):
        """mm, MPa; slip in µm."""
        block(self.folder / "SSNV128_plate.mesh", 0, 40, 64, 0, 40, 64)
        _, nodes = self.run("SSNV128", {
            "order": 1,
            "bodies": {"plate": body("SSNV128_plate.mesh", "2:x", ["P pressure 4 150", "P pressure 3 50"], 130e3, 0.2)},
            "interfaces": {"plane": {"between": ["plate:1"], "friction": 1}}})
        for at, published in ((0, 28.6), (1.25, 27.2), (5, 22.8), (7.5, 19.8), (11.25, 15.0)):
            slip = [float(n["slip"]) for n in nodes if abs(float(n["x"]) - at) < 1e-9]
            self.says(f"SSNV128, u_x at {at} mm", published, 1e3 * slip[0])

    def ssnp121(self):
        block(self.folder / "SSNP121_low.mesh", 0, 1, 3, 0, 1, 2)
        block(self.folder / "SSNP121_high.mesh", 0, 1, 4, 1, 2, 3)
        # The load "probe", a pressure on the interface of the lower block, never acts: its conjugate is the sinking.
        self.pressures("SSNP121", {
            "bodies": {"low": body("SSNP121_low.mesh", "1:y 4:x", ["probe pressure 3 1"], 2e6),
                       "high": body("SSNP121_high.mesh", "4:x", ["D displacement-y 3 -0.1"], 2e6)},
            "interfaces": {"joint": {"between": ["high:1", "low:3"]}},
            "history": ["D=0", "D=1"]}, 1e5)
        with open(self.folder / "SSNP121_history.csv", encoding="utf-8") as table:
            sinking = float(list(csv.DictReader(table))[-1]["displacement probe"])
        self.says("SSNP121, u_y of the interface", -0.05, -sinking)

    def ssnp152(self):
        """Rings about the axis x = 0."""
        block(self.folder / "SSNP152_inner.mesh", 0.2, 0.6, 8, 0, 0.3, 5)
        block(self.folder / "SSNP152_outer.mesh", 0.6, 1, 8, 0, 0.3, 7)
        self.pressures("SSNP152", {
            "analysis": "axisymmetric", "order": 3,
            "bodies": {"inner": body("SSNP152_inner.mesh", "1:z 3:z", (), 1e9, 0.2),
                       "outer": body("SSNP152_outer.mesh", "1:z 3:z", ["P pressure 2 1e6"], 1e9, 0.2)},
            "interfaces": {"joint": {"between": ["inner:2", "outer:4"]}}}, 925925.926)

    def ssnp154(self):
        """The shipped case, whose load "probe" never acts: its conjugate is the sinking of the block under the middle."""
        shipped = pathlib.Path(__file__).resolve().parent
        for friction in (0, 0.1):
            case = json.loads((shipped / "SSNP154.json").read_text())
            for one in case["bodies"].values():
                one["mesh"] = str(shipped / one["mesh"])
            case["interfaces"]["joint"]["friction"] = friction
            results, _ = self.run(f"SSNP154_{friction}", case)
            with open(self.folder / f"SSNP154_{friction}_history.csv", encoding="utf-8") as table:
                sinking = float(list(csv.DictReader(table))[-1]["displacement probe"])
            name = f"SSNP154, f = {friction}"
            if not friction:
                width = sum(zone["to"] - zone["from"] for zone in results["zones"] if zone["state"] != "separation")
                self.says(f"{name}, half-width", 6.21, width)
                self.says(f"{name}, peak pressure", 3585, results["peak_pressure"])
            self.says(f"{name}, u_y of the block's top", -1.302 if friction else -1.307, -sinking)

    def ssnp170(self):
        block(self.folder / "SSNP170_low.mesh", 0, 3, 7, 0, 1, 3)
        block(self.folder / "SSNP170_high.mesh", 0, 3, 11, 1, 2, 3)
        self.pressures("SSNP170", {
            "bodies": {"low": body("SSNP170_low.mesh", "1:y 4:x", (), 2000, 0.3),
                       "high": body("SSNP170_high.mesh", "4:x", ["P pressure 3 25"], 2000, 0.3)},
            "interfaces": {"joint": {"between": ["high:1", "low:3"]}}}, 25)

    def ssnv503(self):
        """Forces in the ratio 0.297 stick, 0.303 slide, f = 0.3; turned as a whole as well."""
        for degrees in (0, 30):
            turn = math.radians(degrees)
            name = "SSNV503" + (f" turned by {degrees}°" if degrees else "")
            file = "SSNV503" + (f"_{degrees}" if degrees else "")
            block(self.folder / f"{file}_pad.mesh", -20, 20, 16, 0, 20, 8, turn)
            block(self.folder / f"{file}_base.mesh", -40, 40, 21, -20, 0, 6, turn)
            for push in (178.2, 181.8):
                results, _ = self.run(f"{file}_{push}", {
                    "bodies": {"pad": body(f"{file}_pad.mesh", None, ["P pressure 3 300", f"Q pressure 4 {push}"], 2.1e5),
                               "base": body(f"{file}_base.mesh", "1:xy", (), 1e5)},
                    "interfaces": {"joint": {"between": ["pad:1", "base:3"], "friction": 0.3}},
                    "history": ["P=0", "P=1", "Q=1"]})
                if push < 180:
                    self.says(f"{name}, pressure that it carries", push, push * results["loads"]["Q"])
                else:
                    self.says(f"{name}, pressure at which it slides", 180, push * results["event_loads"]["Q"])

    def patch(self):
        """Three plates of 8, 11 and 3 elements in a stack, of each order: pressure 0.9, shear 0.4."""
        for k, elements in enumerate((8, 11, 3)):
            block(self.folder / f"patch_{k}.mesh", 0, 2, elements, k, k + 1, 2)
        for order in (1, 2, 3, 4):
            ends = ["Q traction 2 0 0.4", "Q traction 4 0 -0.4"]
            _, nodes = self.run(f"patch_{order}", {
                "order": order,
                "bodies": {"low": body("patch_0.mesh", "1:xy", ends), "middle": body("patch_1.mesh", None, ends),
                           "high": body("patch_2.mesh", None, [*ends, "Q traction 3 0.4 0", "P pressure 3 0.9"])},
                "interfaces": {"lower": {"between": ["middle:1", "low:3"], "friction": 0.5},
                               "upper": {"between": ["high:1", "middle:3"], "friction": 0.5}},
                "history": ["P=0", "P=1", "Q=1"]})
            self.says(f"patch, order {order}, pressure with the largest error", 0.9,
                      max((float(n["p"]) for n in nodes), key=lambda p: abs(p - 0.9)))
            self.says(f"patch, order {order}, shear with the largest error", 0.4,
                      max((abs(float(n["q"])) for n in nodes), key=lambda q: abs(q - 0.4)))

    def rigid_motion(self):
        """The stack, pressed, is then moved and turned as a whole by its two ends: nothing else happens."""
        def end(**also):
            return {"x": {"displacement": "X", "value": 0.3}, "rotation": {"angle": "turn", "value": 0.1}, "centre": [0, 0], **also}
        for order in (1, 2, 3, 4):
            low, high = body("patch_0.mesh"), body("patch_2.mesh")
            low["guides"] = [end(on="1", y={"displacement": "Y", "value": -0.2})]
            high["guides"] = [end(on="3", y={"force": "P", "value": -1.8})]
            _, nodes = self.run(f"rigid_motion_{order}", {
                "order": order, "bodies": {"low": low, "middle": body("patch_1.mesh"), "high": high},
                "interfaces": {"lower": {"between": ["middle:1", "low:3"], "friction": 0.5},
                               "upper": {"between": ["high:1", "middle:3"], "friction": 0.5}},
                "history": ["P=0", "P=1", "X=1, Y=1, turn=1"]})
            # By so much strain as a motion is that isn't rigid: the angle, at E = 1000.
            self.says(f"rigid motion, order {order}, tractions that it causes", 0,
                      max(max(abs(float(n["p"]) - 0.9), abs(float(n["q"]))) for n in nodes) / (1000 * 0.1))
            self.says(f"rigid motion, order {order}, slip that it causes", 0, max(abs(float(n["slip"])) for n in nodes))

    def uniform_punch(self):
        """The profile that half-planes press on uniformly: those of the study hertz (E* = 1/2, of which P = 1
        presses a parabola of radius 100 to the half-width 1) with another gap."""
        file = self.folder / "uniform.json"
        self.program("hertz", "-shear", "none", "-friction", "0", "-nodes", "201", "--save", str(file))
        problem = json.loads(file.read_text())
        x = problem["position"]["values"][:problem["position"]["rows"]]
        a, load = min(x, key=lambda at: abs(at - 1)), math.pi / 800

        def gap(at):
            def term(y):
                return y * math.log(y / a) if y > 0 else 0.0
            return load / (math.pi * 0.5 * a) * (term(a + at) + term(a - at)) if abs(at) < a * (1 + 1e-9) else 1.0
        problem["gap"]["values"] = [gap(at) for at in x]
        file.write_text(json.dumps(problem))
        out = self.folder / "uniform"
        self.program("march", "--reduced", str(file), "--history", "P=0; P=1", "--csv", str(out))
        with open(f"{out}_nodes.csv", encoding="utf-8") as table:
            nodes = [n for n in csv.DictReader(table) if abs(float(n["x"])) < 0.9 * a]
        pressure = [float(n["p"]) * 2 * a / load for n in nodes if float(n["time"]) > 0]
        self.says("punch with uniform pressure, least within 0.9 a", 1, min(pressure))
        self.says("punch with uniform pressure, largest within 0.9 a", 1, max(pressure))


def main():
    arguments = sys.argv[1:]
    output = None
    if "--json" in arguments:
        at = arguments.index("--json")
        output = arguments[at + 1]
        del arguments[at:at + 2]
    cases = Cases(pathlib.Path(arguments[0] if arguments else "results/verification"))
    for case in (cases.ssnv128, cases.ssnp121, cases.ssnp152, cases.ssnp154, cases.ssnp170, cases.ssnv503, cases.patch,
                 cases.rigid_motion, cases.uniform_punch):
        case()
    print(f"{'quantity':<45} {'published':>12} {'computed':>15}")
    for row in cases.rows:
        print(f"{row['quantity']:<45} {row['reference']:>12g} {row['computed']:>15.9g}")
    if output:
        pathlib.Path(output).write_text(json.dumps({"references": cases.rows}))


main()

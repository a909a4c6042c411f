"""Random joints of contact: bodies, bolts, guides, supports, obstacles and loads. Each body must be in equilibrium under what the
results say, summed here from the JSON and the case alone."""

import math
import random

import numpy
import pytest

from programs import even, rectangle


class Joint:
    """A case with what acts on each body: forces and moments about the origin of its loads, per unit multiplier."""

    def __init__(self, run, seed):
        self.run, self.random = run, random.Random(seed)
        self.bodies, self.interfaces, self.bolts, self.loads, self.sizes = {}, {}, {}, {}, {}
        self.thickness = self.random.choice([None, None, 5.0, 12.5])
        self.make()

    def pick(self, low, high):
        return round(self.random.uniform(low, high), 3)

    def chance(self, share):
        return self.random.random() < share

    def add_load(self, body, load, x, y, fx, fy):
        """A resultant (fx, fy) at (x, y)."""
        its = self.loads.setdefault((body, load), numpy.zeros(3))
        its += self.times * numpy.array([fx, fy, x * fy - y * fx])

    @property
    def times(self):
        return self.thickness or 1.0

    def block(self, name, x0, x1, y0, y1):
        nx, ny = self.random.randint(8, 16), self.random.randint(2, 5)
        self.run.write(name + ".mesh", rectangle(even(x0, x1, nx), even(y0, y1, ny)))
        self.sizes[name] = (x0, x1, y0, y1, nx)
        self.bodies[name] = {"mesh": name + ".mesh", "young": self.pick(500, 5000), "poisson": self.pick(0, 0.4), "support": [], "load": []}
        return self.bodies[name]

    def edge_part(self, name, side, wide=True):
        """An interval of the upper or lower side that ends at its nodes, with its ends."""
        x0, x1, _, _, nx = self.sizes[name]
        nodes = even(x0, x1, nx)
        first = self.random.randint(0, nx - 2)
        last = self.random.randint(first + 1, nx) if wide else first + 1
        low, high = nodes[first], nodes[last]
        return f"{side}[{low!r}<x<{high!r}]", low, high

    def make(self):
        stress = self.chance(0.5)
        base = self.block("base", -3, 3, -2, 0)
        on_floor = self.chance(0.3)
        if on_floor:
            self.interfaces["floor"] = {"between": ["base:1"], "friction": self.pick(0.5, 0.9)}
            base["support"] = ["@-3,-2:x"]
        else:
            base["support"] = [self.random.choice(["1:xy", "@-3,-2:xy @3,-2:y", "1:y @0,-2:x" if self.sizes["base"][4] % 2 == 0 else "1:y @-3,-2:x", "4:xy"])]
        tops = [("left", -2.5, -0.4), ("right", 0.3, 2.6)] if self.chance(0.6) else [("middle", -2, 1.7)]
        names = []
        for name, x0, x1 in tops:
            high = self.pick(0.8, 1.6)
            body = self.block(name, x0, x1, 0, high)
            names.append(name)
            face = {"between": [name + ":1", "base:3"], "friction": self.pick(0.3, 0.9)}
            if self.chance(0.2) and name == "left":  # one interface at least has a law to obey
                face = {"between": face["between"], "tied": True}
            elif self.chance(0.2):
                face["gap"] = -self.pick(0, 0.01) if self.chance(0.5) else "closed"
                face["overlap"] = 1
            self.interfaces[name] = face
            weight = self.pick(2, 20)
            if self.chance(0.25):
                # A rigid block on top takes what is put there, and moves or is pushed.
                body["load"].append(f"P body-force 0 {-weight}")
                self.add_load(name, "P", (x0 + x1) / 2, high / 2, 0, -weight * (x1 - x0) * high)
                along = {"force": "Q", "value": self.pick(-3, 3)} if self.chance(0.5) else {"displacement": "Q", "value": self.pick(-2e-3, 2e-3)}
                turn = self.random.choice(["free", "held", {"moment": "M", "value": 0.5}])
                body["guides"] = [{"on": "3", "x": along, "y": "free", "rotation": turn}]
            else:
                body["load"].append(f"P pressure 3 {weight}")
                self.add_load(name, "P", (x0 + x1) / 2, high, 0, -weight * (x1 - x0))
                if self.chance(0.3):
                    body["load"].append(f"Q displacement-x {self.random.choice(['2', '4'])} {self.pick(-2e-3, 2e-3)}")
                else:
                    t = (self.pick(-2, 2), self.pick(-1, 1))
                    where, low, up = self.edge_part(name, 3)
                    body["load"].append(f"Q traction {where} {t[0]} {t[1]}")
                    self.add_load(name, "Q", (low + up) / 2, high, t[0] * (up - low), t[1] * (up - low))
            if self.chance(0.5) and "guides" not in body:
                bolt = "bolt_" + name
                top, low, up = self.edge_part(name, 3, False)
                ends = [f"{name}:{top}"]
                base_x = even(-3, 3, self.sizes["base"][4])
                k = min(range(len(base_x) - 1), key=lambda k: abs(base_x[k] + base_x[k + 1] - low - up))
                if self.chance(0.7):
                    ends.append(f"base:1[{base_x[k]!r}<x<{base_x[k + 1]!r}]")
                self.bolts[bolt] = {"between": ends, "stiffness": self.pick(50, 500), "direction": [0, 1],
                                    self.random.choice(["preload", "preload", "pretension"]): self.pick(1, 10)}
                self.bolts[bolt]["ends"] = [((low + up) / 2, high), ((base_x[k] + base_x[k + 1]) / 2, -2)]
        turned = any("moment" in guide["rotation"] for body in self.bodies.values() for guide in body.get("guides", []))
        history = ["P=0", "P=1", *(f"{bolt}=1" for bolt in self.bolts), *(f"{load}={self.random.choice([1, 1, 8]) * self.pick(-1, 1)}" for load in ("Q", *(["M"] if turned else [])))]
        bolts = {name: {key: value for key, value in bolt.items() if key != "ends"} for name, bolt in self.bolts.items()}
        self.case = {"analysis": "plane stress" if stress else "plane strain", "order": self.random.choice([1, 2]), "bodies": self.bodies, "interfaces": self.interfaces, "history": history}
        if bolts:
            self.case["bolts"] = bolts
        if self.thickness:
            self.case["thickness"] = self.thickness

    def imbalances(self, got):
        """Of each body, forces and moment about the origin over the largest force: all that the results and the case say."""
        sums = {name: numpy.zeros(3) for name in self.bodies}
        largest = dict.fromkeys(self.bodies, 0.0)

        def add(body, fx, fy, moment):
            sums[body] += (fx, fy, moment)
            largest[body] = max(largest[body], abs(fx), abs(fy))

        def about_origin(row):
            return row["moment"] + row["about_x"] * row["force_y"] - row["about_y"] * row["force_x"]

        for row in got["interfaces"]:
            sides = [side.split(":")[0] for side in self.interfaces[row["interface"]]["between"]]
            moment = about_origin(row)
            add(sides[0], row["force_x"], row["force_y"], moment)
            if len(sides) > 1:
                add(sides[1], -row["force_x"], -row["force_y"], row["moment_defect"] - moment)
        for row in got["reactions"]:
            if row["kind"] not in ("obstacle", "tie"):
                add(row["body"], row["force_x"], row["force_y"], about_origin(row))
        for (body, load), its in self.loads.items():
            add(body, *(got["loads"].get(load, 0) * its))
        for row in got.results.get("bolts", []):
            ends = self.bolts[row["bolt"]]["between"]
            for k, end in enumerate(ends):
                x, _ = self.bolts[row["bolt"]]["ends"][k]
                force = -row["force"] if k == 0 else row["force"]
                add(end.split(":")[0], 0, force, x * force)
        return {name: max(abs(sums[name])) / largest[name] for name in sums if largest[name] > 0}


@pytest.mark.parametrize("seed", range(100))
def test_bodies_of_random_joints_are_in_equilibrium(run, seed):
    """Whether the march ends well or not, its last state is one of equilibrium."""
    joint = Joint(run, seed)
    got = run.case(joint.case, code=None)
    assert got.code in (0, 2), got.output
    assert joint.imbalances(got)
    for name, imbalance in joint.imbalances(got).items():
        assert imbalance < 1e-9, f"{name}: {imbalance} {got['status']}"
    for row in got["balance"]:
        assert math.isnan(row["imbalance"] or 0) or (row["imbalance"] or 0) < 1e-9

"""case_schema.py PROGRAM SCHEMA CASE...: the schema of case files says what the program accepts, no more and no less.

Every key that the program or the schema knows is tried with values of all kinds, and so are case files with a random
choice of keys: both must agree. What no schema can say (a sweep of no option, loads of a pattern that is not there, …)
is the program's own. Bodies, interfaces and bolts are tried key by key with values of a wrong kind. Each is a run of the program: a sixth of them in the usual tests, drawn with a fixed seed, all of them in ./test --all.
"""

import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "programs"))
from programs import read_case

VALUES = [None, True, False, 0, -1, 1, 2, 3, 8, 9, -2, 2.0, 1.5, 0.25, 0.5, 0.499, 1e-9, -0.1, 2147483647, 2147483648,
          10**30, "", "x", "3", "plane strain", "axisymmetric", "exact", "fixed", [], [1], [1, 2], [0], [-3], [1.5],
          ["a"], ["a", "b"], ["a", 1], [None], [[1]], {}, {"a": 1}]
# Keys with objects by names, which are tried by themselves.
NAMED = {"bodies", "interfaces", "bolts", "points", "units"}
# How a schema may say things here: a keyword that is not read would be taken for granted.
KEYWORDS = {"description", "$ref", "type", "enum", "const", "oneOf", "items", "minimum", "maximum", "exclusiveMinimum",
            "exclusiveMaximum", "properties", "required", "additionalProperties", "minItems", "maxItems", "minProperties", "minLength"}


DRAW = random.Random(1)


def some(values):
    return values if os.environ.get("CATTANEO_STRESS") == "full" else DRAW.sample(values, -(-len(values) // 6))


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


TYPES = {"string": lambda v: isinstance(v, str), "boolean": lambda v: isinstance(v, bool), "number": is_number,
         "integer": lambda v: is_number(v) and v == int(v), "array": lambda v: isinstance(v, list), "object": lambda v: isinstance(v, dict)}


def fits(schema, value, definitions):
    assert set(schema) <= KEYWORDS, schema
    if "$ref" in schema:
        return fits(definitions[schema["$ref"].split("/")[-1]], value, definitions)
    if "oneOf" in schema:
        return sum(fits(one, value, definitions) for one in schema["oneOf"]) == 1
    if "enum" in schema:
        return value in schema["enum"]
    if "const" in schema:
        return value == schema["const"] and not isinstance(value, bool)
    if not TYPES[schema["type"]](value):
        return False
    if schema["type"] == "object":
        inner, others = schema.get("properties", {}), schema["additionalProperties"]
        return set(schema.get("required", ())) <= set(value) and len(value) >= schema.get("minProperties", 0) and all(
            fits(inner[key], item, definitions) if key in inner else others and fits(others, item, definitions)
            for key, item in value.items())
    if schema["type"] == "array":
        return schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)) and all(
            fits(schema["items"], item, definitions) for item in value)
    return all(holds(schema[word], value) for word, holds in (
        ("minLength", lambda bound, x: len(x) >= bound), ("minimum", lambda bound, x: x >= bound), ("maximum", lambda bound, x: x <= bound),
        ("exclusiveMinimum", lambda bound, x: x > bound), ("exclusiveMaximum", lambda bound, x: x < bound))
        if word in schema)


class Program:
    """The program, asked what it makes of a case. No mesh of these is there: what it says of a key comes before."""

    def __init__(self, program, folder):
        self.program, self.case = program, pathlib.Path(folder) / "case.json"

    def says(self, case):
        self.case.write_text(json.dumps(case), encoding="utf-8")
        run = subprocess.run([self.program, "--case", str(self.case)], text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, check=False)
        assert run.returncode == 1, (case, run.stdout)
        return run.stdout[run.stdout.index("error: "):]

    def refuses(self, case):
        """The key that it does not accept as such, if there is one."""
        found = re.match(r"error: (?:case file '.*?'(?: is of version 1, which is no longer read, |: (?:unknown )?)key '|key '(?!bodies|interfaces|bolts|points|\S+' does nothing|edges' has \d+ times)"
                         r"|option --(?!sweep:|\S+ does nothing))([\w$-]+)", self.says(case))
        return found and found[1]

    def keys(self):
        return set(self.says({"version": 2, "nonsense": 1}).split("must be one of ")[1].strip().split(", "))


def of_objects(asked, schema, definitions):
    """Bodies, interfaces and bolts: each key, missing and of all kinds of values."""
    sound = {"version": 2,
             "bodies": {"pad": {"mesh": "no.mesh", "young": 1, "poisson": 0.3, "support": "1:x", "load": "P pressure 3 1", "expansion": 1e-5},
                        "base": {"mesh": "no.mesh", "young": [1, 2], "poisson": 0.3},
                        "ground": {"half-plane": {"young": 1, "poisson": 0.3, "depth": 100}},
                        "other": {"matrix": "no.sti", "support": ["A:x"], "load": ["P force A 0 1"]}},
             "interfaces": {"flat": {"between": ["pad:1", "base:3"], "friction": 0.3, "gap": "geometry", "slave": "first", "overlap": 1},
                            "cut": {"between": ["pad:2", "base:2"], "tied": True},
                            "pairs": {"between": "pad:3", "pairing": 0.1, "strength": [[1, 0.5], [2, 0.6]]},
                            "ways": {"between": "pad:3", "strength": {"forward": [[1, 0.5]], "backward": [[1, 0.5], [2, 0.6]]}},
                            "floor": {"between": "pad:4", "obstacle": {"line": [[0, 0], [1, 0]]}, "motion": {"D": {"y": -1, "angle": 1, "centre": [0, 1]}}}},
             "bolts": {"bolt": {"between": ["pad:1", "base:3"], "direction": [0, 1], "stiffness": 1, "pretension": 1}}}
    wrong = []
    places = [(kind, name) for kind in ("bodies", "interfaces", "bolts") for name in sound[kind]] + [("bodies", "ground", "half-plane")]
    for place in places:
        keys = sound
        for step in place:
            keys = keys[step]
        for key in [*keys, "nonsense"]:
            for value in some([None, True, 0, 2.5, -1, "x", "geometry", [], [1], ["a"], [[0, 1], [1, 2]], {}]):
                case = json.loads(json.dumps(sound))
                inner = case
                for step in place:
                    inner = inner[step]
                inner[key] = value
                said = asked.says(case)
                # What no schema says: what goes with what, names that are not there, numbers of Poisson.
                if re.search(r"which do not go together|there is no body|must be the name|a body and a part|goes without|for one side alone|an interface with an obstacle|must have one of the keys|is not a number or a function|must be geometry, closed|must be left out|must grow from above 0|has both|has none of the keys|it must have a direction|has \d of the keys", said):
                    continue
                refuses = re.match(r"error: key '", said) is not None
                if refuses == fits(schema, case, definitions):
                    wrong.append(f"{'.'.join(place)}.{key}: {json.dumps(value)} is accepted by one alone: {said}")
    return wrong


def main():
    program, schema_file, *cases = sys.argv[1:]
    schema = json.loads(pathlib.Path(schema_file).read_text(encoding="utf-8"))
    for key in ("$schema", "title"):
        del schema[key]
    keys, definitions = schema["properties"], schema.pop("$defs")
    wrong = []

    def refused(case):
        return {key for key, value in case.items() if key not in keys or not fits(keys[key], value, definitions)}

    with tempfile.TemporaryDirectory() as folder:
        asked = Program(program, folder)
        for key in asked.keys() ^ (set(keys) - {"$schema", "version"}):
            wrong.append(f"'{key}' is a key of one alone, of the program or of the schema")
        for key in set(keys) - NAMED:
            for value in some(VALUES if key != "$schema" else ["case.schema.json"]):
                case = {"version": 2, key: value}
                if bool(asked.refuses(case)) != bool(refused(case)):
                    wrong.append(f"'{key}': {json.dumps(value)} is accepted by one alone: {asked.says(case)}")
        for _ in some(range(150)):
            # The analysis is asked for last, when a number of edges has been refused that no schema tells.
            drawn = DRAW.sample(sorted(set(keys) - {"$schema", "analysis"} - NAMED), 3)
            case = {"version": 2, **{key: DRAW.choice(VALUES) for key in drawn}}
            found, expected = asked.refuses(case), refused(case)
            if found not in (expected or {None}):
                wrong.append(f"{json.dumps(case)}: the program refuses {found}, the schema {expected}")
        wrong += of_objects(asked, schema, definitions)
    for case in cases:
        if not fits(schema, read_case(case), definitions):
            wrong.append(f"{case} does not fit the schema")
    print("\n".join(wrong))
    sys.exit(bool(wrong) or not cases)


main()

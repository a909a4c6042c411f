"""Compares values of a run with the references of its study (miniapps/data/references.json, whose head says how they are written).

    python3 compare.py FILE

FILE has the study, its values by name (results and options), the values to be compared (found: key, computed, error, row) and
closed forms (name, value, spread, mesh, computed). It is overwritten with rows and notes. Programs call this script at their end.
It needs only Python itself."""

import json
import math
import pathlib
import sys

REFERENCES = pathlib.Path(__file__).resolve().parents[2] / "miniapps" / "data" / "references.json"


def is_number(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool)


def holds(found, condition):
    """Does a value meet the condition?"""
    if isinstance(condition, list):
        return any(holds(found, one) for one in condition)
    if isinstance(condition, str) and condition[:1] in "<>":
        sign, bound = condition.split()
        return is_number(found) and {"<=": found <= float(bound), ">=": found >= float(bound), "<": found < float(bound), ">": found > float(bound)}[sign]
    if condition == "*":
        return found is not None and found != ""
    if is_number(found) and is_number(condition):
        return abs(found - condition) < 1e-9  # a level that was reached in steps may differ by round-off
    return found == condition


def mesh_share(term, meaning):
    """A number, "name", "number * name" or "number / name", or a sum of such in a list."""
    if isinstance(term, list):
        return sum(mesh_share(one, meaning) for one in term)
    if is_number(term):
        return term
    factor, sign, name = term.split() if term[0].isdigit() else (1, "*", term)
    found = meaning(name)
    if not is_number(found):
        raise SystemExit(f"references.json: the mesh share '{term}' is not the name of a number of this run")
    return float(factor) * found if sign == "*" else float(factor) / found


def row(name, value, spread, mesh, thesis, computed):
    """A line of the table. A value outside of the reference's own ± is marked, whether or not the mesh explains the difference.
    A closed form has no ±, so its limit is the ± of the mesh. If only the thesis has a value, it is never outside."""
    def apart(least):
        return value is not None and not abs((math.nan if computed is None else computed) - value) <= least

    own = math.nan if spread is None else spread
    outside = apart(mesh if own == 0 else own)
    verdict = "no reference" if value is None else "" if not apart(own) else "within the mesh's ±" if not outside else "outside" if apart(own + mesh) else "outside, within the mesh's ±"
    return {"name": name, "value": value, "spread": spread, "mesh": mesh, "thesis": thesis, "computed": computed, "verdict": verdict,
            "tolerance": None if spread is None else spread + mesh, "outside": outside}


def compare(run):
    """Rows and notes of a run."""
    entries = [entry for entry in json.loads(REFERENCES.read_text(encoding="utf-8"))["references"] if entry["study"] == run["study"]]
    rows = {one["name"]: row(one["name"], one["value"], one["spread"], one["mesh"], None, one["computed"]) for one in run["closed"]}

    def meaning(name, of):
        return of.get(name) if name in of else run["values"].get(name)

    def fits(entry, of):
        return all(holds(meaning(name, of), condition) for name, condition in entry.get("when", {}).items())

    for found in run["found"]:
        of = found["row"] or {}
        for entry in entries:
            name = entry.get("name")
            if "key" not in entry or not holds(found["key"], entry["key"]) or name in rows or not fits(entry, of):
                continue  # a value that is found twice is compared once
            mesh = mesh_share(entry.get("mesh", 0.0), lambda word: meaning(word, of)) + (found["error"] or 0.0)
            rows[name] = row(name, entry.get("value"), entry.get("spread"), mesh, entry.get("thesis"), found["computed"])
    return {"rows": list(rows.values()), "notes": [entry["note"] for entry in entries if "note" in entry and fits(entry, {})] if rows else []}


if __name__ == "__main__":
    file = pathlib.Path(sys.argv[1])
    answer = compare(json.loads(file.read_text(encoding="utf-8")))
    file.write_text(json.dumps(answer), encoding="utf-8")

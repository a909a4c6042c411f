"""references.py REFERENCES SAMPLES: the studies' references are well formed, and sample runs reach them.

SAMPLES is the folder that the sample runs left: SAMPLES/STUDY.NUMBER/results.json.
"""

import json
import pathlib
import sys

KEYS = {"study", "key", "name", "when", "value", "spread", "mesh", "thesis", "source"}


def mistakes(entry):
    """What is wrong with the shape of one entry."""
    if "note" in entry:
        return set(entry) - {"study", "when", "note"}
    wrong = (set(entry) - KEYS) | (KEYS - {"mesh", "thesis"} - set(entry))
    for key in ("value", "spread"):
        if not isinstance(entry.get(key), (int, float)) or isinstance(entry.get(key), bool):
            wrong.add(key)
    if "spread" not in wrong and entry["spread"] < 0:
        wrong.add("spread")
    for key in ("study", "name", "source"):
        if not isinstance(entry.get(key), str) or not entry[key]:
            wrong.add(key)
    return wrong


def main():
    file, samples = map(pathlib.Path, sys.argv[1:])
    entries = json.loads(file.read_text(encoding="utf-8"))["references"]
    bad = 0
    for entry in entries:
        for key in sorted(mistakes(entry)):
            print(f"{entry.get('study')}, {entry.get('name')}: '{key}' is wrong, missing or unknown")
            bad += 1
    reached = set()
    for results in samples.glob("*/results.json"):
        study = results.parent.name.split(".")[0]
        for row in json.loads(results.read_text(encoding="utf-8")).get("references", []):
            reached.add((study, row["quantity"], row["reference"]))
    for entry in entries:
        if "note" not in entry and (entry["study"], entry["name"], entry["value"]) not in reached:
            print(f"{entry['study']}: no sample run reaches '{entry['name']}', {entry['value']}")
            bad += 1
    print(f"{len(entries)} entries, {bad} mistakes")
    sys.exit(bad != 0 or not entries)


main()

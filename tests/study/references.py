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
    # A value of the thesis for which there is no reference stands alone.
    free = {"mesh", "value", "spread"} if "thesis" in entry and "value" not in entry else {"mesh", "thesis"}
    wrong = (set(entry) - KEYS) | (KEYS - free - set(entry))
    for key in {"value", "spread", "thesis"} & set(entry):
        if not isinstance(entry.get(key), (int, float)) or isinstance(entry.get(key), bool):
            wrong.add(key)
    if "spread" not in wrong and entry.get("spread", 0) < 0:
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
        if "note" not in entry and (entry["study"], entry["name"], entry.get("value")) not in reached:
            print(f"{entry['study']}: no sample run reaches '{entry['name']}', {entry.get('value')}")
            bad += 1
    print(f"{len(entries)} entries, {bad} mistakes")
    sys.exit(bad != 0 or not entries)


main()

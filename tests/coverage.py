"""Lines and branches of plugin/ that the tests have reached, by room, after ./test --coverage.

usage: python3 tests/coverage.py BUILD_FOLDER

Branches are those that the source states; what exceptions would do is not counted. The lines that no
test reaches are listed in BUILD_FOLDER/unreached.txt.
"""

import collections
import json
import subprocess
import sys

build = sys.argv[1]
answer = subprocess.run(
    ["gcovr", "--root", ".", "--object-directory", build, "--filter", "plugin/", "--json", "-",
     "--exclude-throw-branches", "--exclude-unreachable-branches", "-j", "2", build],
    check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

lines, branches, unreached = (collections.defaultdict(list) for _ in range(3))
for file in json.loads(answer.stdout)["files"]:
    parts = file["file"].split("cattaneo/")[1].split("/")  # ROOM/name
    room = parts[0] if len(parts) > 1 else "(top)"
    for line in file["lines"]:
        if line.get("gcovr/noncode") or line.get("gcovr/excluded"):
            continue
        lines[room].append(line["count"] > 0)
        branches[room] += [branch["count"] > 0 for branch in line.get("branches", [])]
        if line["count"] == 0:
            unreached[file["file"]].append(line["line_number"])
if not lines:
    sys.exit("coverage: nothing was counted in " + build)


def share(reached):
    return f"{100 * sum(reached) / len(reached):7.1f} %" if reached else f"{'-':>9}"


print(f"{'room':<12}{'lines':>8}{'reached':>9}{'branches':>10}{'reached':>9}")
for room in sorted(lines):
    print(f"{room:<12}{len(lines[room]):>8}{share(lines[room])}{len(branches[room]):>10}{share(branches[room])}")
all_lines, all_branches = sum(lines.values(), []), sum(branches.values(), [])
print(f"{'all':<12}{len(all_lines):>8}{share(all_lines)}{len(all_branches):>10}{share(all_branches)}")

with open(build + "/unreached.txt", "w") as out:
    for name in sorted(unreached):
        for number, text in enumerate(open(name), 1):
            if number in unreached[name]:
                out.write(f"{name}:{number}: {text.strip()}\n")
print(f"lines that no test reaches: {build}/unreached.txt")

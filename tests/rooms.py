"""Which tests belong to which room of plugin/cattaneo, and to which tier; rooms.txt is the table.

    rooms.py list                           the rooms
    rooms.py targets ROOM…                  what a build needs for all tests of these rooms
    rooms.py numbers BUILD [--rest] ROOM…   their numbers, as `ctest -C All -I` takes them
    rooms.py touched RANGE                  the rooms of the files that a range of commits changes
    rooms.py count BUILD [README [--write]] how many tests each tier has; README.md must say so, --write makes it
    rooms.py check BUILD                    every test has a line, every line something that it is about

A line of rooms.txt names a file of tests (core/march_test.cpp), or what names of tests in ctest begin with
(sample.wear), or one test of GoogleTest (Wear.ToleranceHolds), then a tier and rooms. Tiers are everyday (./test),
rest (./test --all and ./test --room) and sample: everyday a sample, the whole with the rest. Beside the folders of
plugin/cattaneo there are the rooms `root` (its own files), `programs` (miniapps, meshes, problems), `benchmarks`,
`python`, `docs` and `build`.
"""

import json
import pathlib
import re
import subprocess
import sys

TESTS = pathlib.Path(__file__).resolve().parent
ROOT = TESTS.parent
OTHERS = {"root": r"plugin/cattaneo/[^/]*$", "programs": r"(miniapps|meshes|problems|tests/fuzz)/", "benchmarks": r"benchmarks/", "python": r"python/|pyproject",
          "docs": r"docs/|README|tests/docs/", "build": r"(cmake|\.ci|tests/install)/|CMake|(.*/)?CMakeLists.txt$|run$|test$"}
TIERS = ("everyday", "sample", "rest")


class Line:
    def __init__(self, text):
        self.name, self.tier, *self.rooms = text.split()
        self.file = TESTS / self.name if "/" in self.name else None
        self.pattern = re.compile(re.escape(self.name) + r"(\.|$)")
        if self.file and self.file.is_file():
            code = self.file.read_text(encoding="utf-8")
            if self.file.suffix == ".py":
                # Contact.BadInput is in programs/contact_test.py.
                suites = ["".join(word[:1].upper() + word[1:] for word in self.file.stem.removesuffix("_test").split("_"))]
            else:
                suites = re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),", code, re.M)
            self.pattern = re.compile(rf"([^/.]+/)?({'|'.join(sorted(set(suites))) or '(?!)'})(/\d+)?\.")

    def targets(self):
        """What is built for it."""
        kind = self.name.split("/")[0]
        if self.file and self.file.suffix == ".cpp" and kind != "run":
            return {"campaign"} if self.file.stem == "campaign" else {kind + ("_rest_tests" if self.tier == "rest" else "_tests")}
        if self.name[0].isupper() and "." in self.name: # one test of a file that has its own line
            return set()
        if self.name.startswith("stress.campaign"):
            return {"campaign"}
        if self.name.startswith("sample."):
            return {self.name.split(".")[1]}
        if self.name == "study.template":
            return {"pressed_layer"}
        if self.name == "kernels":
            return {f"{kind}_tests" for kind in ("core", "core_rest", "unit", "unit_rest", "stress")} | {"blas_kernels"}
        wanted = {"python": "cattaneo_python_stubs", "build": "all", "install": "all", "mpi": "all"}
        return {wanted.get(kind.split(".")[0], "miniapps")}


def rooms():
    folders = [f.name for f in (ROOT / "plugin/cattaneo").iterdir() if f.is_dir()]
    return sorted(folders) + list(OTHERS)


def table():
    text = (TESTS / "rooms.txt").read_text(encoding="utf-8")
    return [Line(line) for line in text.splitlines() if line.strip() and not line.startswith("#")]


def of_rooms(names):
    for name in names:
        if name not in rooms():
            sys.exit(f"cattaneo: there is no room '{name}', must be one of: {', '.join(rooms())}")
    return [line for line in table() if set(line.rooms) & set(names)]


def tests_of(build, tier):
    """(name, labels) in the order of ctest's numbers."""
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *(["-C", "All"] if tier == "all" else [])],
                            check=True, capture_output=True, text=True)
    return [(test["name"], next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), ["other"]))
            for test in json.loads(listed.stdout)["tests"]]


def numbers(build, names, rest):
    lines = of_rooms(names)
    everyday = {name for name, _ in tests_of(build, "everyday")} if rest else set()
    chosen = [k for k, (name, _) in enumerate(tests_of(build, "all"), 1)
              if any(line.pattern.match(name) for line in lines if name not in everyday or line.tier == "sample")]
    return "0,0,0," + ",".join(map(str, chosen)) if chosen else ""


def touched(commits):
    listed = subprocess.run(["git", "diff", "--name-only", commits], cwd=ROOT, check=True, capture_output=True, text=True)
    files, found = listed.stdout.split("\n"), set()
    for file in filter(None, files):
        folder = re.match(r"plugin/(?:private/)?cattaneo/(\w+)/", file)
        found |= {folder[1]} if folder else {room for room, pattern in OTHERS.items() if re.match(pattern, file)}
        found |= {room for line in table() if line.file and file == f"tests/{line.name}" for room in line.rooms}
    return [room for room in rooms() if room in found]


def count(build, readme=None, write=False):
    tiers = {tier: tests_of(build, tier) for tier in ("everyday", "all")}
    missing = [name for name, _ in tiers["all"] if name.endswith("_NOT_BUILT")]
    if missing:
        sys.exit(f"cattaneo: {', '.join(missing)}: tests can be counted where all of them are built (./test --count does)")
    labels = sorted({labels[0] for _, labels in tiers["all"]})
    print(f"{'':14}{'everyday':>10}{'all':>8}")
    for label in labels:
        print(f"{label:14}" + "".join(f"{sum(own[0] == label for _, own in tests):{width}}" for tests, width in zip(tiers.values(), (10, 8))))
    both = [len(tests) for tests in tiers.values()]
    print(f"{'':14}{both[0]:10}{both[1]:8}")
    if not readme:
        return 0
    page = pathlib.Path(readme)
    text = page.read_text(encoding="utf-8")
    sentence = re.compile(r"(everyday suite, )([\d,]+)( tests.*?everything, )([\d,]+)", re.S)
    found = sentence.search(text)
    if not found:
        sys.exit(f"cattaneo: {readme} does not say how many tests there are: 'everyday suite, N tests … everything, M'")
    said = [int(found[k].replace(",", "")) for k in (2, 4)]
    if write:
        page.write_text(sentence.sub(rf"\g<1>{both[0]:,}\g<3>{both[1]:,}", text, count=1), encoding="utf-8")
    elif said != both:
        print(f"README.md says that there are {said[0]} and {said[1]} (./test --count --write mends it)")
        return 1
    return 0


def check(build):
    faults, lines = [], table()
    for line in lines:
        if line.file and not line.file.is_file():
            faults.append(f"rooms.txt names {line.name}, which is not there")
        if line.tier not in TIERS:
            faults.append(f"rooms.txt: the tier of {line.name} is '{line.tier}', must be one of: {', '.join(TIERS)}")
        faults += [f"rooms.txt: {line.name} has the room '{room}', must be of: {', '.join(rooms())}" for room in line.rooms if room not in rooms()]
        if not line.rooms:
            faults.append(f"rooms.txt: {line.name} has no room")
    for room in rooms():
        if not any(room in line.rooms and line.tier != "rest" for line in lines):
            faults.append(f"the room {room} has no test every day")
    for name, _ in tests_of(build, "all"):
        if not name.endswith("_NOT_BUILT") and not any(line.pattern.match(name) for line in lines):
            faults.append(f"{name} is of no line of rooms.txt, so that `./test --room` does not know it")
    print(*(faults or [f"{len(lines)} lines of rooms.txt, {len(rooms())} rooms"]), sep="\n")
    return 1 if faults else 0


def main(task="", *words):
    if task == "list":
        print(*rooms())
    elif task == "targets":
        print(*sorted(set(words) & {"benchmarks"} | set().union(*(line.targets() for line in of_rooms(words)))))
    elif task == "numbers":
        print(numbers(words[0], [word for word in words[1:] if word != "--rest"], "--rest" in words))
    elif task == "touched":
        print(*touched(words[0]))
    elif task == "count":
        return count(words[0], next((word for word in words[1:] if word != "--write"), None), "--write" in words)
    elif task == "check":
        return check(words[0])
    else:
        sys.exit(__doc__)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

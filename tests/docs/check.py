"""Checks the guide: links, commands, numbers, outcomes and citations of README.md, docs/ and meshes/README.md.

check.py SOURCE PROGRAMS FOLDER [--all | --measure | --write]

SOURCE is the repository, PROGRAMS the folder of the built miniapps (benchmarks are beside it), FOLDER one
to run commands in. What is checked:

* Links lead to files that exist, and to headings (or <a id="…">) in them.
* Every command that begins with ./run names a study and options that it has. Commands are code spans, and
  lines of indented or fenced blocks, that begin with it; one with a word in capitals or "…" stands for others.
* Commands run, each page's in its order in one folder, as do those of python3 and gmsh (where there is one) after
  "$ " in a block "console". Of these every line that is shown below them is one of their output, in its order; "…"
  stands for any text.
* Numbers are what commands print. A table behind the comment

      <!-- numbers of ./run square_punch -cycles 3 -->

  has columns "computed", one for each command of the comment (several are separated by ";"); behind "numbers of
  rows" the command is that in code font in the row, or in one above. A row names what
  it is of: by a key of --json in code font (`final_stick`, `levels.0.stick_right`), or as the run's own table of
  references does. The number is right if it is within one unit of its last digit. --write writes them anew.
  Behind "numbers of tests" a row, or one above, names a test, as `core_tests Suite.Name`, that records the number
  (tests/record.hpp).
* Tests that are named as `core_tests Suite.Name` or `./test -R Suite.Name` are there.
* docs/faq.md explains each outcome that the library has a name for.
* Keys of citations, as [Hertz 1882] in headers, are in docs/references.md, and all that are there are cited.
  Years beside names without brackets are no citation.
* Sentences, cells of tables and terms of README.md, docs/ and messages are as words.py asks.

seconds.json has the processor time of each command. Without --all the shortest ones run, each below two seconds
and together below six. --measure writes it.
"""

import json
import os
import pathlib
import re
import resource
import shlex
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import rooms  # noqa: E402
import words  # noqa: E402

SECONDS_OF_ONE, SECONDS_OF_ALL = 2.0, 6.0


class Guide:
    def __init__(self, source, programs, folder, mode):
        self.source = pathlib.Path(source).resolve()
        self.programs = pathlib.Path(programs).resolve()
        self.folder = pathlib.Path(folder).resolve()
        self.mode = mode
        self.faults = []
        self.pages = [self.source / "README.md", self.source / "CONTRIBUTING.md",
                      self.source / "meshes/README.md", *sorted(self.source.glob("docs/*.md"))]
        self.timing = self.source / "tests/docs/seconds.json"
        self.seconds = json.loads(self.timing.read_text()) if self.timing.exists() else {}
        self.measured = {}
        self.options = {}
        listing = subprocess.run([str(self.source / "run")], text=True, capture_output=True, check=True).stdout
        self.studies = set(re.findall(r"^  (\w+) ", listing, re.M)) | set(re.findall(r"\./run (\w+) ", listing))

    def fault(self, page, text):
        self.faults.append(f"{page.relative_to(self.source)}: {text}")

    # -- links ------------------------------------------------------------------------------------

    def anchors(self, page):
        text = page.read_text(encoding="utf-8")
        headings = re.findall(r"^#+ +(.*)$", without_blocks(text), re.M)
        slugs = [re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings]
        return set(slugs) | set(re.findall(r'<a id="([^"]+)">', text))

    def check_links(self, page, text):
        for target in re.findall(r"\]\(([^)\s]+)\)", without_blocks(text)):
            if re.match(r"https?:", target):
                continue
            file, _, anchor = target.partition("#")
            to = (page.parent / file).resolve() if file else page
            if not to.exists():
                self.fault(page, f"the link {target} leads to no file")
            elif anchor and anchor not in self.anchors(to):
                self.fault(page, f"the link {target} leads to no heading of {file or 'this page'}")

    # -- commands ---------------------------------------------------------------------------------

    def program(self, name):
        """The file of a study or benchmark, None if it is not built."""
        for folder in (self.programs, self.programs.parent / "benchmarks"):
            if (folder / name).is_file():
                return folder / name
        return None

    def has(self, name, option):
        if name not in self.options:
            program = self.program(name)
            help_text = subprocess.run([program, "-h"], text=True, capture_output=True, check=False).stdout if program else ""
            self.options[name] = set(re.findall(r"--?[a-zA-Z][\w-]*", help_text))
        # -h lists two dashes; one will do in place of them.
        return not self.options[name] or option in self.options[name] or f"-{option}" in self.options[name]

    def check_command(self, page, text, command):
        words = shlex.split(command)[1:]
        if words[:1] == ["--mpi"]:
            words = words[1:]
            if "-np" in words:
                at = words.index("-np")
                del words[at:at + 2]
        if not words or words[0].isupper():
            return
        name = words[0]
        if name not in self.studies and not re.search(rf"^//  {name}:", text, re.M):  # a study the page shows
            self.fault(page, f"'{command}': ./run knows no {name}")
            return
        for word in words[1:]:
            if re.match(r"--?[a-zA-Z]", word) and not self.has(name, word.split("=")[0]):
                self.fault(page, f"'{command}': {name} has no option {word}")

    def run(self, command, folder):
        """Output and --json of a command; None if it is not one to run here, or now."""
        words = shlex.split(command)
        if words[0] == "./run":
            if words[1] in ("--mpi", "benchmark", "docs", "thesis") or not (self.source / f"miniapps/{words[1]}.cpp").exists():
                return None
            if not self.program(words[1]):
                sys.exit(f"{words[1]} is not built in {self.programs}")
            words[:2] = [str(self.program(words[1]))]
        elif words[0] == "python3":
            words[0] = sys.executable
        elif words[0].endswith("_tests"):
            if not (self.programs.parent / "tests" / words[0]).is_file():
                return None
            words = [str(self.programs.parent / "tests" / words[0]), f"--gtest_filter={words[1]}", "--gtest_output=json:results.json"]
        elif not shutil.which(words[0]):
            return None
        if "-h" not in words and words[0] != "gmsh" and "--json" not in words and not command.split()[0].endswith("_tests"):
            words += ["--json", "results.json"]
        results = folder / (words[words.index("--json") + 1] if "--json" in words else "results.json")
        if self.mode is None and command not in self.quick:
            return None
        results.unlink(missing_ok=True)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              check=False, env={"OPENBLAS_NUM_THREADS": "1", **os.environ, "PROGRAMS": str(self.programs)})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.measured[command] = round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 2)
        return done.returncode, done.stdout, recorded(json.loads(results.read_text())) if results.exists() else {}

    def choose(self, all_commands):
        """The commands of the short test: the shortest ones, as long as time is left."""
        self.quick, left = set(), SECONDS_OF_ALL
        for command in sorted(set(all_commands) & set(self.seconds), key=self.seconds.get):
            left -= self.seconds[command]
            if left >= 0 and self.seconds[command] < SECONDS_OF_ONE:
                self.quick.add(command)

    def check_runs(self, page, text):
        folder = self.folder / page.stem
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for data in ("meshes", "miniapps", "problems", "docs"):
            (folder / data).symlink_to(self.source / data)
        done = {}
        for command, shown in commands_of(text):
            if command.startswith("./run"):
                self.check_command(page, text, command)
            if stands_for_others(command):
                continue
            if command not in done:
                if self.mode is None and command not in self.seconds and runs(command, self.source):
                    self.fault(page, f"'{command}' is not in tests/docs/seconds.json (check.py --measure)")
                done[command] = self.run(command, folder)
            if done[command]:
                self.check_output(page, command, done[command], shown)
        return self.check_tables(page, text, done)

    def check_output(self, page, command, run, shown):
        code, output, _ = run
        wanted = re.search(r"\[exit code (\d)\]", "\n".join(shown))
        if code != (int(wanted[1]) if wanted else 0):
            self.fault(page, f"'{command}' ended with {code}:\n{output[-600:]}")
        lines = [" ".join(line.split()) for line in output.splitlines()]
        at = 0
        for line in shown:
            line = " ".join(line.split())
            if line in ("", "…") or line.startswith("[exit code"):
                continue
            pattern = re.compile(re.escape(line).replace("…", ".*"))
            found = [k for k in range(at, len(lines)) if pattern.fullmatch(lines[k])]
            if not found:
                self.fault(page, f"'{command}' does not print '{line}'")
                continue
            at = found[0] + 1

    # -- numbers ----------------------------------------------------------------------------------

    def check_tables(self, page, text, done):
        lines = text.split("\n")
        commands = columns = of_rows = None
        for number, line in enumerate(lines):
            marker = re.match(r" *<!-- numbers of (.*) -->$", line)
            if marker:
                commands, columns = listed(marker[1]), None
            elif commands and line.strip().startswith("|"):
                cells = line.split("|")
                if columns is None:
                    columns = [k for k, cell in enumerate(cells) if cell.strip().startswith("computed")]
                    if len(columns) != len(commands):
                        self.fault(page, f"line {number + 1}: {len(columns)} columns 'computed' of {len(commands)} commands")
                elif not re.match(r"[\s|:-]+$", line):
                    of_row = re.findall(r"`(\w+_tests [^`]*)`" if commands == ["tests"] else r"`(\./run [^`]*)`", line)
                    of_rows = of_row or of_rows
                    for command, column in zip(of_rows if commands in (["rows"], ["tests"]) else commands, columns):
                        if done.get(command):
                            cells[column] = self.check_number(page, number + 1, cells, column, done[command][2])
                    lines[number] = "|".join(cells)
            elif commands and columns:
                commands = None
        return "\n".join(lines)

    def check_number(self, page, number, cells, column, results):
        cell = cells[column]
        value = value_of(cells, results)
        shown = re.search(r"-?\d[\d,]*\.?\d*(?:e[-+]?\d+)?|…", cell)
        if value is None or not shown:
            self.fault(page, f"line {number}: nothing that the command prints is called as a cell of '{'|'.join(cells)}'")
            return cell
        if self.mode == "--write":
            return cell.replace(shown[0], as_shown(value, shown[0]), 1)
        if shown[0] == "…" or abs(float(shown[0].replace(",", "")) - value) > last_digit(shown[0]) * 1.001:
            self.fault(page, f"line {number}: {shown[0]} is printed as {value:.8g}")
        return cell

    # -- citations --------------------------------------------------------------------------------

    def check_citations(self):
        page = self.source / "docs/references.md"
        keys = set(re.findall(r'<a id="[^"]+"></a>\*\*\[([^\]]+)\]\*\*', page.read_text(encoding="utf-8")))
        cited = set()
        folders = ("plugin", "miniapps", "tests", "python", "docs")
        for path in [*self.pages, *(f for folder in folders for f in sorted((self.source / folder).rglob("*.*")))]:
            if path == page or path.suffix not in (".hpp", ".cpp", ".py", ".md"):
                continue
            text = path.read_text(encoding="utf-8")
            found = set(re.findall(r"\[([A-Z][^\[\]\d\n]* (?:18|19|20)\d\d)\]", text))
            cited |= found
            for key in sorted(found - keys):
                self.fault(path, f"[{key}] is not in docs/references.md")
            if self.source / "plugin" in path.parents and re.search(r"[A-Z]\w+,? \(?(?:18|19|20)\d\d\)?(?![\d\]])\b", re.sub(r"\[[^\]]*\]", "", text)):
                self.fault(path, "names a paper by its year without a key in brackets")
        for key in sorted(keys - cited):
            self.fault(page, f"[{key}] is cited nowhere")

    def check_tests(self, page, text):
        for kind, suite, name in re.findall(r"`(\w+)_tests (\w+)\.(\w+)`", text):
            # A kind has two programs, the everyday one and that of the rest.
            folder, rest = kind.removesuffix("_rest"), kind.endswith("_rest")
            code = "".join(line.file.read_text(encoding="utf-8") for line in rooms.table()
                           if line.name.startswith(folder + "/") and line.file.is_file() and (line.tier == "rest") == rest)
            if not re.search(rf"^TEST(_F|_P)?\({suite}, {name}\)", code, re.M):
                self.fault(page, f"there is no test {kind}_tests {suite}.{name}")

        def in_capitals(words):
            return "".join(word[:1].upper() + word[1:] for word in words.split("_"))

        # `./test -R Contact.BadInput` is test_bad_input() of tests/programs/contact_test.py.
        scripts = {in_capitals(f.stem[:-len("_test")]): f for f in self.source.glob("tests/programs/*_test.py")}
        for suite, name in re.findall(r"`\./test -R (\w+)\.(\w+)`", text):
            code = scripts[suite].read_text(encoding="utf-8") if suite in scripts else ""
            if name not in map(in_capitals, re.findall(r"^def test_(\w+)", code, re.M)):
                self.fault(page, f"there is no test {suite}.{name} in tests/programs")

    # -- outcomes ---------------------------------------------------------------------------------

    def check_outcomes(self):
        """docs/faq.md says of every outcome what it means."""
        page = self.source / "docs/faq.md"
        text = page.read_text(encoding="utf-8")
        for file in ("friction/friction_solver", "shakedown/limit", "shakedown/transient"):
            code = (self.source / f"plugin/cattaneo/{file}.cpp").read_text(encoding="utf-8")
            for name in re.findall(r'"([^"]+)"', re.search(r"names\[\] = \{([^}]*)\}", code)[1]):
                if f"`{name}`" not in text:
                    self.fault(page, f"says nothing of the outcome '{name}' of {file}.cpp")

    def check(self):
        texts = {page: page.read_text(encoding="utf-8") for page in self.pages}
        self.choose([c for text in texts.values() for c, _ in commands_of(text) if not stands_for_others(c)])
        for page, text in texts.items():
            self.check_links(page, text)
            self.check_tests(page, text)
            written = self.check_runs(page, text)
            if self.mode == "--write" and written != text:
                page.write_text(written, encoding="utf-8")
        self.check_citations()
        self.check_outcomes()
        self.faults += words.faults(self.source)[0]
        if self.mode == "--measure":
            self.timing.write_text(json.dumps(dict(sorted(self.measured.items())), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{len(self.pages)} pages, {len(self.measured)} commands in {sum(self.measured.values()):.1f} s")
        for fault in self.faults:
            print(fault)
        return 1 if self.faults else 0


def without_blocks(text):
    return re.sub(r"^( *)```.*?^\1```$", "", text, flags=re.M | re.S)


def commands_of(text):
    """(command, lines that are shown below it), in the order of the page; those of tables' comments too."""
    found = []
    block = None
    tests = False  # in a table of numbers that tests record
    for line in text.split("\n"):
        tests = tests and (line.startswith("|") or not line.strip()) or line == "<!-- numbers of tests -->"
        if tests:
            found += [(c, []) for c in re.findall(r"`(\w+_tests [^`]*)`", line)]
        fence = re.match(r" *```(\w*)", line)
        if fence:
            block = None if block is not None else fence[1]
        elif block == "console":
            if line.startswith("$ "):
                found.append((clean(line[2:]), []))
            elif found:
                found[-1][1].append(line)
        elif block is None or block in ("", "sh"):
            marker = re.match(r" *<!-- numbers of (.*) -->$", line)
            if marker:
                found += [(clean(c), []) for c in listed(marker[1]) if c not in ("rows", "tests")]
            elif re.match(r"(    |)\./run ", line):
                found.append((clean(line), []))
            else:
                found += [(clean(c), []) for c in re.findall(r"`(\./run [^`]*)`", line)]
    return [(c, shown) for c, shown in found if re.match(r"\./run |python3 |gmsh |\w+_tests ", c)]


def listed(comment):
    """Commands in a comment. A semicolon may also be a part of a history, so only those before a command separate."""
    return [command.strip() for command in re.split(r"; *(?=\./run |python3 |rows)", comment)]


def clean(command):
    return re.split(r"&&|  #", command)[0].strip()


def stands_for_others(command):
    return "…" in command or any(
        re.fullmatch(r"(.*/)?[A-Z]{2,}(\.\w+)?", word) for word in shlex.split(command))


def runs(command, source):
    words = shlex.split(command)
    return words[0] != "./run" or (source / f"miniapps/{words[1]}.cpp").exists()


def recorded(results):
    """What a test of gtest recorded, as numbers; results of a program as they are."""
    tests = [test for suite in results.get("testsuites", []) for test in suite["testsuite"]]
    if not tests:
        return results
    return {key: float(value) for test in tests for key, value in test.items() if re.fullmatch(r"[-+.\de]*\d[-+.\de]*", str(value)) and key != "line"}


def value_of(cells, results):
    """The number of a row: by a key in code font, or by the name of a row of the run's references."""
    rows = {row["quantity"]: row["computed"] for row in results.get("references", [])}
    for cell in cells:
        if cell.strip() in rows:
            return rows[cell.strip()]
    for key in re.findall(r"`([\w. ]+)`", "|".join(cells)):
        value = results
        for part in key.split("."):
            try:
                value = value[int(part)] if isinstance(value, list) else value[part]
            except (KeyError, IndexError, ValueError, TypeError):
                value = None
                break
        if isinstance(value, (int, float)):
            return value
    return None


def last_digit(shown):
    digits, _, exponent = shown.replace(",", "").partition("e")
    return 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))


def as_shown(value, shown):
    """With as many digits as the number that stands there, four of a new one."""
    if shown == "…":
        return f"{value:.4g}"
    digits, _, exponent = shown.partition("e")
    if exponent:
        mantissa, power = f"{value:.{len(digits.partition('.')[2])}e}".split("e")
        return f"{mantissa}e{int(power)}"
    return f"{value:.{len(digits.partition('.')[2])}f}"


if __name__ == "__main__":
    sys.exit(Guide(*sys.argv[1:4], sys.argv[4] if len(sys.argv) > 4 else None).check())

"""Type stubs: mypy in strict mode has nothing to say of the package and of scripts that use it."""

import pathlib
import re
import subprocess
import sys

import cattaneo
import pytest
from conftest import ROOT
from test_bodies import column


def test_scripts_are_typed(tmp_path):
    pytest.importorskip("mypy")
    words = ["--strict", "--allow-untyped-defs", "--allow-untyped-calls", "--ignore-missing-imports"]
    scripts = [ROOT / "python" / "examples" / f"{name}.py" for name in ("calculix_loop", "monte_carlo", "shakedown_map")]
    package = pathlib.Path(cattaneo.__file__).parent
    # Where packages are installed mypy looks of its own, and must not be told to.
    path = {} if package.parent.name == "site-packages" else {"MYPYPATH": str(package.parent)}
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", tmp_path, *words, *scripts],
        cwd=tmp_path, env={**path, "PATH": ""}, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_say_what_may_be_none():
    """And settings let no name pass that they have not."""
    stubs = sorted((pathlib.Path(cattaneo.__file__).parent / "_core").glob("*.pyi"))
    assert [stub.stem for stub in stubs] == ["__init__", "design", "fretting", "joints", "readout", "shakedown", "wear"]
    for stub in stubs:
        text = stub.read_text(encoding="utf-8")
        compile(text, stub, "exec")
        assert not re.search(r"\| None(?=\)|, (?!/))", text)
        assert "std::" not in text  # a type of C++ that no header makes one of Python's
        assert not re.search("def __[gs]etattr__", text)
    assert "state: ContactState | None = None" in stubs[0].read_text(encoding="utf-8")


def classes(module, seen):
    """Of the module and of those within it."""
    for each in vars(module).values():
        if isinstance(each, type) and each.__module__.startswith("cattaneo"):
            yield each
        elif isinstance(each, type(module)) and each.__name__.startswith("cattaneo") and each.__name__ not in seen:
            seen.add(each.__name__)
            yield from classes(each, seen)


def test_every_class_says_what_it_is():
    """Where there is nothing better the values that it has; none its address."""
    found = set(classes(cattaneo._core, set()))
    assert len(found) > 60
    assert [each.__name__ for each in found if each.__repr__ is object.__repr__] == []
    _, lines = column(1.0, 2.0)
    said = repr(cattaneo.pair_lines(lines[1][0], lines[0][1]))
    assert said.startswith("<cattaneo Pairing: ") and " 0x" not in said, said

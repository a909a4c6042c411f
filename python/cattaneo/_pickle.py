"""Pickles reduced problems and states as the files that save() writes, to the last bit."""

import copyreg
import pathlib
import tempfile
from collections.abc import Callable
from typing import Any

from . import _core


def _text(of: _core.ReducedProblem | _core.ContactState | _core.wear.WearState) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "saved.json")
        _core.save(of, file)
        return file.read_text(encoding="utf-8")


def _loaded(load: Callable[[pathlib.Path], Any], text: str) -> Any:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "saved.json")
        file.write_text(text, encoding="utf-8")
        return load(file)


def _load_problem(text: str) -> _core.ReducedProblem:
    problem: _core.ReducedProblem = _loaded(_core.load_reduced_problem, text)
    return problem


def _load_state(text: str) -> _core.ContactState:
    state: _core.ContactState = _loaded(_core.load_contact_state, text)
    return state


def _load_wear_state(text: str) -> _core.wear.WearState:
    state: _core.wear.WearState = _loaded(_core.wear.load_wear_state, text)
    return state


copyreg.pickle(_core.ReducedProblem, lambda problem: (_load_problem, (_text(problem),)))
copyreg.pickle(_core.ContactState, lambda state: (_load_state, (_text(state),)))
copyreg.pickle(_core.wear.WearState, lambda state: (_load_wear_state, (_text(state),)))

"""What is said of a call that fits no signature."""

import difflib
from collections.abc import Callable
from typing import Any


def _split(text: str) -> list[str]:
    """Of the parameters of a signature, at its commas outside of brackets and quotes."""
    parts, depth, quote = [""], 0, ""
    for letter in text[text.index("(") + 1 :]:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "([{":
            depth += 1
        elif letter in ")]}":
            if depth == 0:
                break
            depth -= 1
        elif letter == "," and depth == 0:
            parts.append("")
            continue
        parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]


def _listed(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def sentence(function: Callable[..., Any], by_place: int, named: tuple[str, ...]) -> str:
    """by_place: how many arguments have no name."""
    of = function.__qualname__.removesuffix(".__init__")
    signature = function.__nb_signature__[0][0]  # type: ignore[attr-defined]
    parameters = _split(signature.splitlines()[-1])
    places = parameters[: parameters.index("*")] if "*" in parameters else parameters
    names = [part.split(":")[0].split("=")[0].strip() for part in parameters if part not in "*/"]
    in_place = [part.split(":")[0].split("=")[0].strip() for part in places if part != "/"]
    if in_place[:1] == ["self"]:
        names, in_place, by_place = names[1:], in_place[1:], by_place - 1
    must = f"must be one of {_listed(names)}" if names else "it takes none"
    for name in named:
        if name not in names:
            close = difflib.get_close_matches(name, names, 1)
            meant = f" (is '{close[0]}' meant?)" if close else ""
            return f"{of}: there is no argument '{name}'{meant}, {must}"
    if by_place > len(in_place):
        by_name = names[len(in_place) :]
        rest = f"; by their names: {_listed(by_name)}" if by_name else ""
        given = f"{of}: {by_place} argument{'s are' if by_place > 1 else ' is'} given by place"
        return f"{given}, must be at most {len(in_place)}{': ' if in_place else ''}{_listed(in_place)}{rest}"
    for name in named:
        if name in in_place[:by_place]:
            return f"{of}: argument '{name}' is given twice, by its place and by its name"
    for part, name in zip([part for part in parameters if part not in ("*", "/", "self")], names):
        if "=" not in part and name not in named and name not in in_place[:by_place]:
            return f"{of}: argument '{name}' is missing, {must.replace('must be one of', 'its arguments are')}"
    return f"{of}: an argument does not fit, its arguments are {_listed(names)}"

"""Texts of objects that have none of their own: their values, and the sizes of their arrays. Also what notebooks
show of all objects."""

import inspect
from types import ModuleType
from typing import Any


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "shape"):  # NumPy's. Stubs are made without NumPy
        return "×".join(map(str, value.shape)) + " values"
    if isinstance(value, (list, tuple, dict)):
        return f"{len(value)} values"
    return repr(value)


def _repr(self: Any) -> str:
    said = []
    for name, member in inspect.getmembers(type(self), lambda member: isinstance(member, property)):
        if not name.startswith("_"):
            try:
                said.append(f"{name} {_text(getattr(self, name))}")
            except ValueError as error:  # cattaneo.InputError: an attribute that exists only in other cases
                said.append(f"{name}: {error}")
    return f"<cattaneo {type(self).__name__}{': ' if said else ''}{', '.join(said)}>"


def _html(self: Any) -> str:
    from . import _html

    shown: str = _html.of_march(self) if type(self).__name__ == "MarchReport" else _html.of_any(self)
    return shown


def teach(module: ModuleType) -> None:
    """Gives all classes of a module and of its submodules what a notebook shows, and a text to those
    that would print an address."""
    for each in vars(module).values():
        if inspect.isclass(each) and each.__module__.startswith(module.__name__.split(".")[0]):
            if each.__repr__ is object.__repr__:
                each.__repr__ = _repr  # type: ignore[method-assign]
            if not issubclass(each, (int, BaseException)):
                each._repr_html_ = _html
        elif inspect.ismodule(each) and each.__name__.startswith(module.__name__ + "."):
            teach(each)

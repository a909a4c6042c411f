"""help() says what each argument is: its name stands in the text of its function or class."""

import inspect
import re

import cattaneo
from cattaneo import _core

# What the package's own text explains once.
EVERYWHERE = {"self", "problem", "state", "settings", "progress", "stop", "members", "file"}


def functions(module):
    """Of the module itself and of readout: their texts with that of the class."""
    for name, each in sorted(vars(module).items()):
        if isinstance(each, type):
            if each.__module__.startswith("cattaneo") and not issubclass(each, (BaseException, int)):
                for method, bound in sorted(vars(each).items()):
                    bound = getattr(bound, "__func__", bound)
                    if hasattr(bound, "__nb_signature__") and (method == "__init__" or not method.startswith("_")):
                        yield f"{name}.{method}", bound, each.__doc__ or ""
        elif hasattr(each, "__nb_signature__"):
            yield name, each, ""
        elif inspect.isfunction(each) and not name.startswith("_"):
            yield name, each, ""


def arguments(function):
    if inspect.isfunction(function):
        return set(inspect.signature(function).parameters), function.__doc__ or ""
    names, texts = set(), []
    for signature in function.__nb_signature__:
        head = signature[0].split("->")[0]
        names |= set(re.findall(r"\W(\w+): ", head[head.index("(") :]))
        texts.append(signature[1] or "")
    return names, " ".join(texts)


def test_every_argument_is_explained():
    missing, seen = [], 0
    for module in (_core, _core.readout, cattaneo):
        for name, function, of_class in functions(module):
            names, text = arguments(function)
            seen += 1
            settings = name.endswith("Settings.__init__")  # whose members have a text each
            for argument in sorted(names - EVERYWHERE):
                if not settings and not re.search(rf"\b{argument}\b", text + of_class):
                    missing.append(f"{name}: {argument}")
            if not text and not settings and not name.endswith("__init__"):
                missing.append(f"{name}: nothing at all")
    assert seen > 100 and missing == []


def test_the_package_explains_the_rest():
    for argument in EVERYWHERE - {"self", "members"}:
        assert re.search(rf"\b{argument}\b", cattaneo.__doc__), argument

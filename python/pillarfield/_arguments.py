"""One line for arguments of a wrong type, in place of pybind11's list of overloads."""

from __future__ import annotations

import functools
import numbers
import re
from collections.abc import Callable
from typing import Any

from . import _core
from ._error import ArgumentError

_KINDS: dict[str, tuple[Any, str]] = {
    "int": (numbers.Integral, "a whole number"), "float": (numbers.Real, "a number"),
    "str": (str, "text"), "bool": (bool, "True or False")}


def _complaint(text: str, given: tuple[Any, ...], named: dict[str, Any]) -> tuple[str, str]:
    """What is wrong with the arguments, and the mend, by the signature in pybind11's message."""
    signature = re.search(r"1\. [\w.]+\((.*)\)(?: -> [^\n]*)?\n", text)
    parts = re.findall(r"(?:^|, )(\*|\w+)(?:: ((?:[^,\[\]=]|\[[^=]*?\])+?))?(?: ?= ?([^,]+))?(?=, |$)",
                       signature.group(1) if signature else "")
    parameters = [name for name, _, _ in parts if name != "*"]
    values = dict(zip(parameters, given)) | named
    for name, kind, default in parts:
        if name not in values and name not in ("*", "args", "kwargs", "self") and not default:
            return f"{name} is not given", f"give {name}"
    for name, kind, _ in parts:
        wanted, words = _KINDS.get(re.sub(r"Optional\[(.*)\]", r"\1", kind), (object, ""))
        value = values.get(name)
        if value is None and "Optional" in kind or name not in values:
            continue
        if not isinstance(value, wanted) or (wanted is numbers.Integral and value < 0):
            return f"{name} is {value!r:.60}", f"give {words}"
    return "an argument is of a wrong type", f"it takes {', '.join(filter('self'.__ne__, parameters))}"


def _told(function: Callable[..., Any], place: str) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        try:
            return function(*given, **named)
        except TypeError as error:
            if "incompatible" not in str(error).split("\n")[0]:
                raise
            if function.__name__ != "__init__":
                raise ArgumentError(place, *_complaint(str(error), given, named)) from None
            raise ArgumentError(type(given[0]).__name__, *_complaint(str(error), given[1:], named)) from None
    return call


def _wrap_all() -> None:
    """Wraps all functions, constructors and methods of the compiled module."""
    for name, value in list(vars(_core).items()):
        if isinstance(value, type):
            for member, method in list(vars(value).items()):
                if isinstance(method, staticmethod):
                    setattr(value, member, staticmethod(_told(method.__func__, f"{name}.{member}")))
                elif member == "__init__" or (callable(method) and member[0] != "_"):
                    setattr(value, member, _told(method, f"{name}.{member}"))
        elif callable(value):
            setattr(_core, name, _told(value, name))


_wrap_all()

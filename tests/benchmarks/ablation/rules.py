"""The switches of a room, listed from what its functions return.

A function that decides returns a truth, a mask, something or nothing, or the same kind of thing as
it was given. Each of these can be switched off without knowing what it is for, and a truth or a
mask in two ways: a rule is worth nothing if either of them changes nothing.
"""

from __future__ import annotations

import inspect
from collections.abc import Collection, Iterator
from types import ModuleType
from typing import Any

from tests.benchmarks.ablation.patching import (
    Off,
    Switch,
    UnknownNameError,
    keeps,
    list_files,
    marks_all,
    marks_none,
    says,
)

_TAKEN = ("Corners", "Lattice", "XCornerFit", "XCornerModel", "Markers", "GreyImage")
"""Types of which a function may return what it was given first."""


def list_rules(rooms: Collection[str], besides: Collection[Switch] = ()) -> list[Switch]:
    """List the switches of all functions of some rooms that decide.

    Args:
        rooms: names of folders of the engine, or of files.
        besides: switches of which each function is left out.

    Raises:
        UnknownNameError: if a room is neither a folder nor a file of the engine.
    """
    if unknown := set(rooms) - {part for file in list_files() for part in _list_rooms(file)}:
        raise UnknownNameError(f"no such rooms: {', '.join(sorted(unknown))}")
    known = {name.rpartition(".")[2] for switch in besides for name in switch.functions}
    found = [
        (name, word, off)
        for name, function in _list_functions(rooms)
        if name.rpartition(".")[2] not in known
        for word, off in _list_offs(function)
    ]
    return [Switch(f"{name}: {word}", {name: off}) for name, word, off in found]


def _list_rooms(module: ModuleType) -> list[str]:
    """List the folders and the file of a module of the engine, but of none that draws boards."""
    _, house, *rooms = module.__name__.split(".")
    return rooms if house == "engine" and rooms[:1] != ["boards"] else []


def _list_functions(rooms: Collection[str]) -> Iterator[tuple[str, Any]]:
    """List the functions and methods that the files of some rooms define, by their names."""
    for module in list_files():
        if not set(_list_rooms(module)) & set(rooms):
            continue
        file = module.__name__.rpartition(".")[2]
        for name, value in vars(module).items():
            if getattr(value, "__module__", "") != module.__name__:
                continue
            if isinstance(value, type):
                for method, function in vars(value).items():
                    if inspect.isfunction(function) and not method.startswith("__"):
                        yield f"{file}.{name}.{method}", function
            elif inspect.isfunction(value) or hasattr(value, "reference"):
                yield f"{file}.{name}", getattr(value, "reference", value)


def _list_offs(function: Any) -> Iterator[tuple[str, Off]]:
    """List the ways in which a function can be switched off, by what it then says."""
    told = str(inspect.signature(function).return_annotation)
    taken = [str(each.annotation) for each in inspect.signature(function).parameters.values()]
    if told == "bool":
        yield "no", says(False)
        yield "yes", says(True)
    elif told == "BoolArray":
        yield "none", marks_none
        yield "all", marks_all
    elif told.endswith("| None"):
        yield "nothing", says(None)
    elif told == "str":
        yield "nothing", says("")
    elif told in _TAKEN and told in taken:
        yield "as it was", keeps(taken.index(told))

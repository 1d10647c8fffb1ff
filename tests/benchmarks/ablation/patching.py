"""Switching functions and numbers of the product off by name, wherever they stand.

The product holds no switches. A `Switch` names functions, and says what each returns instead, and
numbers, and says what they are instead. The files of `calibgui` are loaded, the one that defines a
name is looked up among them, and so is every file that imported it: a function may move to another
room, and its switch still finds it. A name that no file defines, or several do, is an error.

A kernel is switched off by its Python face: compiled code that calls another kernel's parts is not
reached, nor are numbers that compiled code or a default argument took over when it was loaded.
"""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import cache, update_wrapper
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

import calibgui

Call = Callable[[], Any]
Off = Callable[..., Any]
"""A function of a call of what is switched off, and of its arguments, that returns what is returned
instead."""
_PREFIX = f"{calibgui.__name__}."
_KERNELS = f"{_PREFIX}engine.kernels."
_FINDERS = {"detection", "features", "lattices", "corner_fit"}
"""The rooms whose functions keep results."""


class UnknownNameError(LookupError):
    """A switch names what no file of the product defines, or what several do."""


class Switch(NamedTuple):
    """A rule or a pass that can be switched off."""

    name: str
    functions: Mapping[str, Off] = {}
    """What functions return instead, by their names; a method is named with its class, and where
    several files define a name, one that defines or imports it stands before: "file.name",
    "Class.name" or "file.Class.name"."""
    numbers: Mapping[str, float] = {}
    """What numbers are instead: "Class.field" of a record that a file keeps, or a constant."""
    parts: tuple[Switch, ...] = ()
    """The switches of a group."""


def says(value: Any) -> Off:
    """Return always the same."""
    return lambda *_, **__: value


def keeps(position: int) -> Off:
    """Return an argument as it is."""
    return lambda *arguments, **__: arguments[position + 1]


def marks_none(call: Call, *_: Any, **__: Any) -> Any:
    """Mark none, in a mask or a list of numbers as long as it would have been."""
    return np.zeros_like(call())


def marks_all(call: Call, *_: Any, **__: Any) -> Any:
    """Mark all."""
    return np.ones_like(call())


def combine(name: str, switches: Iterable[Switch]) -> Switch:
    """Combine switches to a group that switches all of them off."""
    parts = tuple(switches)
    functions: dict[str, Off] = {}
    numbers: dict[str, float] = {}
    for switch in parts:
        functions |= switch.functions
        numbers |= switch.numbers
    return Switch(name, functions, numbers, parts)


@cache
def load_product() -> None:
    """Load every file of the engine."""
    for _, name, _ in pkgutil.walk_packages(calibgui.__path__, _PREFIX):
        if name.startswith(f"{_PREFIX}engine."):
            importlib.import_module(name)


def list_files() -> list[ModuleType]:
    """List the files of the product that are loaded, but for the compiled ones."""
    load_product()
    files = [module for name, module in sys.modules.items() if name.startswith(_PREFIX)]
    return [
        module
        for module in files
        if isinstance(module, ModuleType) and not module.__name__.startswith(_KERNELS)
    ]


class _Place(NamedTuple):
    """An attribute that holds what is patched."""

    owner: Any
    name: str

    def put(self, value: Any) -> None:
        """Set the attribute, be its owner frozen or not."""
        if dataclasses.is_dataclass(type(self.owner)):
            object.__setattr__(self.owner, self.name, value)
        else:
            setattr(self.owner, self.name, value)


def find_function(name: str) -> tuple[Any, list[_Place]]:
    """Find a function, and all places at which it is called by a name.

    Raises:
        UnknownNameError: no file defines it, or several do.
    """
    *file, last = name.split(".")
    if file and file[-1].lstrip("_")[:1].isupper():
        owner = _find_class(*reversed(file))
        if last not in vars(owner):
            raise UnknownNameError(f"the class {file[-1]} has no function {last}")
        return vars(owner)[last], [_Place(owner, last)]
    found = {
        id(value): value
        for module in list_files()
        if (value := vars(module).get(last)) is not None
        and callable(value)
        and (
            module.__name__.rpartition(".")[2] == file[0]
            if file
            else getattr(value, "__module__", "") == module.__name__
        )
    }
    function = _take_only(name, list(found.values()))
    places = [
        _Place(module, key)
        for module in list_files()
        for key, value in list(vars(module).items())
        if value is function
    ]
    return function, places


def find_number(name: str) -> tuple[float, list[_Place]]:
    """Find a number, and all places that hold it; see `find_function`."""
    *owner, last = name.split(".")
    if owner and owner[0].lstrip("_")[:1].isupper():
        kind = _find_class(owner[0])
        records = {id(each): each for each in _list_records() if type(each) is kind}
        record = _take_only(name, list(records.values()))
        if not hasattr(record, last):
            raise UnknownNameError(f"{owner[0]} has no number {last}")
        return getattr(record, last), [_Place(record, last)]
    holding = [module for module in list_files() if is_number(vars(module).get(last))]
    defining = [
        module
        for module in holding
        if does_set(module, last) and (not owner or module.__name__.rpartition(".")[2] == owner[0])
    ]
    value = vars(_take_only(name, defining))[last]
    places = [
        _Place(module, last)
        for module in holding
        if module in defining or (vars(module)[last] == value and not does_set(module, last))
    ]
    return value, places


@cache
def does_set(module: ModuleType, name: str) -> bool:
    """Return whether a file gives a constant its value, rather than import it."""
    text = Path(str(module.__file__)).read_text(encoding="utf-8")
    return re.search(rf"^{name}\b.*=", text, re.MULTILINE) is not None


def _find_class(name: str, file: str = "") -> type:
    """Find a class, among all files or in one."""
    kinds = {
        id(value): value
        for module in list_files()
        if isinstance(value := vars(module).get(name), type)
        and (not file or module.__name__.rpartition(".")[2] == file)
    }
    return _take_only(name, list(kinds.values()))


def _list_records() -> Iterator[Any]:
    """List the records of numbers that files keep, and those inside of them."""
    rest = [value for module in list_files() for value in vars(module).values()]
    while rest:
        value = rest.pop()
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            yield value
            rest += [getattr(value, field.name, None) for field in dataclasses.fields(value)]


def is_number(value: Any) -> bool:
    """Return whether a value is a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _take_only(name: str, found: list[Any]) -> Any:
    """Return the only one that was found."""
    if not found:
        raise UnknownNameError(f"no file of the product defines {name}")
    if len(found) > 1:
        raise UnknownNameError(f"several files of the product define {name}")
    return found[0]


def check_switch(switch: Switch) -> None:
    """Raise an `UnknownNameError` if anything that a switch names is not there."""
    for name in switch.functions:
        find_function(name)
    for name in switch.numbers:
        find_number(name)


@contextmanager
def switched_off(switch: Switch) -> Iterator[None]:
    """Switch a rule off in the `with` block, and forget what was kept of it before and after."""
    with ExitStack() as undo:
        undo.callback(_forget_kept)
        for name, off in switch.functions.items():
            function, places = find_function(name)
            _put_all(undo, places, function, _replace(function, off))
        for name, value in switch.numbers.items():
            before, places = find_number(name)
            _put_all(undo, places, before, value)
        _forget_kept()
        yield


def _forget_kept() -> None:
    """Forget the results that functions of detection keep: some may be those of a switch."""
    for module in list_files():
        if set(module.__name__.split(".")) & _FINDERS:
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear"):
                    value.cache_clear()


def _put_all(undo: ExitStack, places: list[_Place], before: Any, value: Any) -> None:
    """Put a value in some places until `undo` ends."""
    for place in places:
        undo.callback(place.put, before)
        place.put(value)


def _replace(function: Any, off: Off) -> Any:
    """Make the function that stands in for one that is switched off."""

    def replaced(*arguments: Any, **named: Any) -> Any:
        return off(lambda: function(*arguments, **named), *arguments, **named)

    return update_wrapper(replaced, function)


class Watch:
    """What tells which switches matter: those whose functions return anything else than they would
    if they were switched off. Without such a return the product does the same."""

    def __init__(self, switches: Iterable[Switch]) -> None:
        self._switches = list(switches)
        self.mattering: set[str] = set()
        """Names of the switches that mattered since the last `start`."""
        self.called: set[str] = set()
        """Names of the switches of which any function was ever called."""
        self.start()

    def start(self) -> None:
        """Forget what mattered so far; a number always may."""
        self.mattering.clear()
        self.mattering |= {switch.name for switch in self._switches if switch.numbers}
        self.called |= self.mattering

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Watch in the `with` block."""
        by_function: dict[str, list[tuple[str, Off]]] = {}
        for switch in self._switches:
            for name, off in switch.functions.items():
                by_function.setdefault(name, []).append((switch.name, off))
        with ExitStack() as undo:
            for name, offs in by_function.items():
                function, places = find_function(name)
                _put_all(undo, places, function, self._watch(function, offs))
            yield

    def _watch(self, function: Any, offs: list[tuple[str, Off]]) -> Any:
        """Make a function that returns the same and compares it with what its switches return."""

        def watched(*arguments: Any, **named: Any) -> Any:
            result = function(*arguments, **named)
            for name, off in offs:
                self.called.add(name)
                if name not in self.mattering:
                    try:
                        instead = off(lambda: result, *arguments, **named)
                        is_other = not is_same(instead, result)
                    except Exception:  # what the switch makes of it is seen when it is used
                        is_other = True
                    if is_other:
                        self.mattering.add(name)
            return result

        return update_wrapper(watched, function)


def is_same(one: Any, other: Any) -> bool:
    """Return whether two results are equal in all that can be compared."""
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        a, b = np.asarray(one), np.asarray(other)
        if a.shape != b.shape or a.dtype == object or b.dtype == object:
            return False
        return np.array_equal(a, b, equal_nan=a.dtype.kind == "f" and b.dtype.kind == "f")
    if isinstance(one, bool | int | float | str | np.generic | None):
        return type(one) is type(other) and (one == other or (one != one and other != other))
    if type(one) is not type(other):
        return False
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(is_same, one, other))
    if dataclasses.is_dataclass(one):
        names = [field.name for field in dataclasses.fields(one) if field.init]
        return all(is_same(getattr(one, name), getattr(other, name)) for name in names)
    return False

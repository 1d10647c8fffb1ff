"""Faces of rooms, which load a file when one of its names is first asked for.

A face that imported all it offers would load the whole engine for the few records that a program
starts with: the window would be there a sixth later.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from types import ModuleType


def load_on_demand(face: str, names: Mapping[str, Sequence[str]]) -> None:
    """Let the package `face` offer `names`, by the files below it that define them."""
    package = sys.modules[face]
    file_of = {name: f"{face}.{file}" for file, defined in names.items() for name in defined}
    package.__dict__.update(__all__=sorted(file_of), _file_of=file_of)
    package.__class__ = _Face


class _Face(ModuleType):
    """A package that loads the file of a name when that is first asked for."""

    _file_of: Mapping[str, str]

    def __getattr__(self, name: str) -> object:
        if name not in self._file_of:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        value = getattr(import_module(self._file_of[name]), name)
        setattr(self, name, value)
        return value

    def __setattr__(self, name: str, value: object) -> None:
        # Python puts each loaded file here. Where a function has its file's name, that is meant.
        if name not in self._file_of or not isinstance(value, ModuleType):
            super().__setattr__(name, value)

    def __dir__(self) -> Iterable[str]:
        return {*super().__dir__(), *self._file_of}

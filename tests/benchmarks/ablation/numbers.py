"""The tuned numbers of the product, halved and doubled, as switches."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from tests.benchmarks.ablation.patching import Switch, does_set, is_number, list_files

_FACTORS = (0.5, 2.0)
_ROOMS = {
    "checkerboard": ("checkerboard", "features", "lattices", "corner_fit"),
    "charuco": ("charuco",),
    "aprilgrid": ("apriltags",),
    "puzzleboard": ("puzzleboard",),
    "circles": ("circles",),
    "assessment": ("assessment",),
}
"""The folders of the engine whose numbers matter for a kind of board, or for assessment."""


def list_scalings(kind: str) -> list[Switch]:
    """List the scalings of the numbers of a kind's rooms.

    Integers are rounded and stay above 0. A number that is read only while its file is loaded, as
    the default of an argument is, does not change when it is scaled here: its rows are empty.
    """
    return [
        Switch(f"{name} x {factor:g}", numbers={name: scaled})
        for name, value in _list_numbers(kind)
        for factor in _FACTORS
        if (scaled := max(round(value * factor), 1) if isinstance(value, int) else value * factor)
        != value
    ]


def _list_numbers(kind: str) -> Iterator[tuple[str, float]]:
    """List the numbers that a kind's rooms define, by their names."""
    listed = set()
    for module in list_files():
        parts = module.__name__.split(".")
        if not set(parts[:-1]) & set(_ROOMS[kind]) or "kernels" in parts:
            continue
        for name, value in vars(module).items():
            numbers = (
                _list_fields(value)
                if dataclasses.is_dataclass(value) and not isinstance(value, type)
                else _list_constant(module, name, value)
            )
            for number, at in numbers:
                if number not in listed:
                    listed.add(number)
                    yield number, at


def _list_fields(record: Any) -> Iterator[tuple[str, float]]:
    """List the numbers of a record of thresholds and of those inside of it."""
    for field in dataclasses.fields(record):
        value = getattr(record, field.name, None)
        if dataclasses.is_dataclass(value):
            yield from _list_fields(value)
        elif _is_tuned(value) and type(record).__name__.endswith("Thresholds"):
            yield f"{type(record).__name__}.{field.name}", value


def _list_constant(module: ModuleType, name: str, value: Any) -> Iterator[tuple[str, float]]:
    """List a constant of a file, if it is a number that the file itself sets."""
    if name.isupper() and _is_tuned(value) and does_set(module, name):
        yield f"{module.__name__.rpartition('.')[2]}.{name}", value


def _is_tuned(value: Any) -> bool:
    return is_number(value) and value > 0

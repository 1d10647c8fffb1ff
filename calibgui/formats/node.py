"""A value that was read from a file, with its place there, and readers that check it.

A `Node` is a value with its place in the file ("views[2].uv[17]"). Each of its readers returns a
checked value or raises a CalibrationError with the file, the place and the expected value.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np

from calibgui.engine.arrays import Array, GridSize, IntArray, Size, freeze_array, freeze_ints
from calibgui.engine.camera import check_image_size
from calibgui.engine.errors import CalibrationError

MAX_LINES = 1000
"""Largest number of a board's rows or columns: arrays of all its points must fit into memory."""
_MAX_INTEGER = 2**53
"""Size of the largest integer up to which a float64 holds all."""
_MAX_ASYMMETRY = 1e-6
"""Largest difference of a covariance from its transpose, over the standard deviations: what is
beyond rounding to six digits is an error of the file."""


@dataclass(frozen=True, slots=True)
class Node:
    """A value in a JSON file, and its place there."""

    value: Any
    where: str
    """Its place in the file, for messages; empty at the top."""
    file: str

    def fail(self, expected: str) -> NoReturn:
        """Raise a CalibrationError that says that this value is not `expected`."""
        place = self.where or "the content"
        raise CalibrationError(
            f"{self.file}: {place} is not {expected}.", "Correct the file or write it again."
        )

    def get(self, key: str) -> Node | None:
        """Return a member of this object; None if it is absent or null."""
        if not isinstance(self.value, dict):
            self.fail("an object")
        value = self.value.get(key)
        return None if value is None else Node(value, self._place(key), self.file)

    def __getitem__(self, key: str) -> Node:
        """Return a member of this object that must be there."""
        if not isinstance(self.value, dict):
            self.fail("an object")
        if key not in self.value:
            raise CalibrationError(
                f"{self.file}: {self._place(key)} is missing.",
                "Correct the file or write it again.",
            )
        return Node(self.value[key], self._place(key), self.file)

    def _place(self, key: str) -> str:
        return f"{self.where}.{key}" if self.where else key

    def named(self, where: str) -> Node:
        """Return the same value with another description of its place."""
        return Node(self.value, where, self.file)

    def items(self, count: int | None = None) -> list[Node]:
        """Return the entries of this list, of which there must be `count` if that is given."""
        if not isinstance(values := _get_plain(self.value), list):
            self.fail("a list")
        if count not in (None, len(values)):
            self.fail(f"a list of {count} entries (it has {len(values)})")
        return [Node(v, f"{self.where}[{i}]", self.file) for i, v in enumerate(values)]

    def members(self) -> dict[str, Node]:
        """Return the members of this object."""
        if not isinstance(self.value, dict):
            self.fail("an object")
        return {key: self[key] for key in self.value}

    def text(self) -> str:
        """Return this text."""
        if not isinstance(self.value, str):
            self.fail("text")
        return self.value

    def file_name(self) -> str:
        """Return this text, which no file has for a name if it holds a NUL."""
        if "\0" in self.text():
            self.fail("the name of a file: it holds a NUL")
        return self.text()

    def flag(self) -> bool:
        """Return this truth value."""
        if not isinstance(self.value, bool):
            self.fail("true or false")
        return self.value

    def choice(self, allowed: Sequence[str]) -> str:
        """Return this text, which must be one of `allowed`."""
        if not isinstance(self.value, str) or self.value not in allowed:
            self.fail(f"one of {', '.join(allowed)}")
        return self.value

    def number(self, nullable: bool = False) -> float:
        """Return this finite number; NaN for null if `nullable`."""
        return float(self.numbers(nullable=nullable))

    def integer(self) -> int:
        """Return this integer."""
        number = self.number()
        if not number.is_integer() or abs(number) > _MAX_INTEGER:
            self.fail("an integer")
        return int(number)

    def numbers(self, *shape: int | None, nullable: bool = False) -> Array:
        """Return this array of finite numbers, with NaN for null if `nullable`.

        `shape` may begin with None for any length.
        """
        if not (isinstance(self.value, np.ndarray) and _has_shape(self.value, shape)):
            misfit = _find_misfit(_get_plain(self.value), shape, nullable)
            if misfit is not None:
                place, expected = misfit
                self.named(self.where + place).fail(expected)
        # An empty list hides the lengths of its entries.
        lengths = [len(self.value) if n is None else n for n in shape]
        return freeze_array(np.reshape(np.array(self.value, dtype=np.float64), lengths))

    def integers(self, *shape: int | None) -> IntArray:
        """Return this array of integers; `shape` may begin with None for any length."""
        numbers = self.numbers(*shape)
        if (numbers != np.rint(numbers)).any() or (np.abs(numbers) > _MAX_INTEGER).any():
            self.fail("an array of integers")
        return freeze_ints(numbers)

    def grid_size(self) -> GridSize:
        """Return the rows and columns of a board's points."""
        rows, cols = self.integers(2).tolist()
        if not 1 <= min(rows, cols) <= max(rows, cols) <= MAX_LINES:
            self.fail(f"the rows and columns of a board, from 1 to {MAX_LINES}")
        return rows, cols

    def image_size(self) -> Size:
        """Return the width and height of an image, px."""
        width, height = self.integers(2).tolist()
        try:
            return check_image_size((width, height))
        except CalibrationError:
            self.fail("the width and height of an image")

    def covariances(self, *shape: int, nullable: bool = False) -> Array:
        """Return covariances (..., n, n), with NaN for null if `nullable`.

        They are symmetric, and no variance is negative nor a correlation beyond 1.
        """
        cov = self.numbers(*shape, nullable=nullable)
        variance = np.diagonal(cov, axis1=-2, axis2=-1)
        with np.errstate(invalid="ignore", over="ignore"):
            if (variance < 0).any():
                self.fail("a covariance: it has a variance below 0")
            sigma = np.sqrt(variance)
            scale = sigma[..., :, None] * sigma[..., None, :]
            if (np.abs(cov - np.swapaxes(cov, -2, -1)) > _MAX_ASYMMETRY * scale).any():
                self.fail("a covariance: it is not symmetric")
            if (np.abs(cov) > (1 + _MAX_ASYMMETRY) * scale).any():
                self.fail("a covariance: it has a correlation beyond 1")
        return cov


def _get_plain(value: Any) -> Any:
    """Return `value`, with the lists of the file in place of an array."""
    return value.tolist() if isinstance(value, np.ndarray) else value


def _has_shape(table: Array, shape: tuple[int | None, ...]) -> bool:
    return table.ndim == len(shape) and all(
        wanted in (None, length) for wanted, length in zip(shape, table.shape, strict=True)
    )


def _find_misfit(
    value: Any, shape: tuple[int | None, ...], nullable: bool
) -> tuple[str, str] | None:
    """Return the place of the first entry of `value` that does not fit `shape`, and what would."""
    if not shape:
        return (
            None
            if _is_finite_number(value) or (nullable and value is None)
            else ("", "a finite number")
        )
    if not isinstance(value, list):
        return "", "a list"
    if shape[0] not in (None, len(value)):
        return "", f"a list of {shape[0]} entries (it has {len(value)})"
    for i, item in enumerate(value):
        misfit = _find_misfit(item, shape[1:], nullable)
        if misfit is not None:
            return f"[{i}]{misfit[0]}", misfit[1]
    return None


def _is_finite_number(value: Any) -> bool:
    return (
        isinstance(value, (int, float))
        and not isinstance(value, bool)
        and abs(value) <= sys.float_info.max
    )

"""JSON as this program writes it, and a cursor that reads it with errors that say where.

Written: numbers in the shortest form that reads back as the same float64; numbers that are
not finite as null; points, and rows of matrices, on a line each, so that two files compare
line by line.

Read: `Node` is a value with its place in the file ("views[2].uv[17]"). Each of its readers
returns a checked value or raises a CalibrationError with file, place and what was expected.
Tables of numbers become arrays while the file is parsed: as hundreds of thousands of small lists
they would hold up the garbage collector, and with it every thread.
"""

from __future__ import annotations

import json
import math
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze_array, freeze_ints
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import replacing

_UNFINISHED = re.compile(r"(-|\.|[eE][-+]?|tr?u?|fa?l?s?|nu?l?)?\s*")
"""What JSON's parser stumbles over at the end of a file that is cut within a number or word."""
_LINE = 100
"""Length up to which a list of lists is kept on one line."""


def dumps(value: Any, depth: int = 0) -> str:
    """`value` as JSON: mappings, sequences, arrays of numbers, text, numbers, True, False, None."""
    if isinstance(value, np.ndarray):
        # Of finite numbers and lists of them JSON and Python's repr are the same, repr is quicker.
        write_row = repr if np.isfinite(value).all() else dumps
        return _list([write_row(row) for row in value.tolist()], depth)
    if _has_members(value):
        return "".join(_pieces(value, depth))
    if isinstance(value, Mapping):
        return "{}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return _list([dumps(item, depth + 1) for item in value], depth)
    if isinstance(value, float) and not math.isfinite(value):
        return "null"
    # A file name that is not valid Unicode holds surrogates, which only \u can write.
    return json.dumps(value, ensure_ascii=isinstance(value, str) and not value.isprintable())


def _has_members(value: Any) -> bool:
    """Whether it is an object, or a list of some, with anything in it."""
    if isinstance(value, Mapping):
        return bool(value)
    return isinstance(value, list | tuple) and any(map(_has_members, value))


def _pieces(value: Any, depth: int) -> Iterator[str]:
    """The text of `value`, member by member.

    Putting that of a large file together would hold up every thread, at each depth anew.
    """
    if not _has_members(value):
        yield dumps(value, depth)
    elif isinstance(value, Mapping):
        named = ((f"{dumps(str(key))}: ", item) for key, item in value.items())
        members = (chain([name], _pieces(item, depth + 1)) for name, item in named)
        yield from _block("{", members, "}", depth)
    else:
        yield from _block("[", (_pieces(item, depth + 1) for item in value), "]", depth)


def _list(items: list[str], depth: int) -> str:
    nested = any(item[0] in "[{" for item in items)
    if nested and sum(len(item) + 2 for item in items) > _LINE:
        return "".join(_block("[", ([item] for item in items), "]", depth))
    return f"[{', '.join(items)}]"


def _block(
    opening: str, members: Iterable[Iterable[str]], closing: str, depth: int
) -> Iterator[str]:
    """Members, of which there is one at least, on lines of their own."""
    before = opening
    for member in members:
        yield f"{before}\n{' ' * (depth + 1)}"
        yield from member
        before = ","
    yield f"\n{' ' * depth}{closing}"


def write(path: str | os.PathLike[str], value: Any) -> None:
    """Write `value` as the file `path`, completely or not at all.

    Raises:
        CalibrationError: if it cannot be written.
    """
    with replacing(path) as file:
        for piece in chain(_pieces(value, 0), ["\n"]):
            file.write(piece.encode())


@dataclass(frozen=True, slots=True)
class Node:
    """A value in a JSON file."""

    value: Any
    where: str
    """Its place in the file, for messages; empty at the top."""
    file: str

    def fail(self, expected: str) -> NoReturn:
        """Raise the error that this value is not `expected`."""
        place = self.where or "the content"
        raise CalibrationError(
            f"{self.file}: {place} is not {expected}.", "Correct the file or write it again."
        )

    def get(self, key: str) -> Node | None:
        """A member of this object; None if it is absent or null."""
        if not isinstance(self.value, dict):
            self.fail("an object")
        value = self.value.get(key)
        return None if value is None else Node(value, self._place(key), self.file)

    def __getitem__(self, key: str) -> Node:
        """A member of this object that must be there."""
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
        """The same value under a name that says more than its place."""
        return Node(self.value, where, self.file)

    def items(self) -> list[Node]:
        """The entries of this list."""
        if not isinstance(values := _plain(self.value), list):
            self.fail("a list")
        return [Node(v, f"{self.where}[{i}]", self.file) for i, v in enumerate(values)]

    def members(self) -> dict[str, Node]:
        """The members of this object."""
        if not isinstance(self.value, dict):
            self.fail("an object")
        return {key: self[key] for key in self.value}

    def text(self) -> str:
        """This text."""
        if not isinstance(self.value, str):
            self.fail("text")
        return self.value

    def flag(self) -> bool:
        """This truth value."""
        if not isinstance(self.value, bool):
            self.fail("true or false")
        return self.value

    def choice(self, allowed: Sequence[str]) -> str:
        """This text, one of `allowed`."""
        if not isinstance(self.value, str) or self.value not in allowed:
            self.fail(f"one of {', '.join(allowed)}")
        return self.value

    def number(self, nullable: bool = False) -> float:
        """This finite number; NaN for null if `nullable`."""
        return float(self.numbers(nullable=nullable))

    def integer(self) -> int:
        """This integer."""
        number = self.number()
        if not number.is_integer():
            self.fail("an integer")
        return int(number)

    def numbers(self, *shape: int | None, nullable: bool = False) -> Array:
        """This array of finite numbers; `shape` may begin with None for any length.

        Null is NaN if `nullable`.
        """
        if not (isinstance(self.value, np.ndarray) and _fits(self.value, shape)):
            misfit = _misfit(_plain(self.value), shape, nullable)
            if misfit is not None:
                place, expected = misfit
                self.named(self.where + place).fail(expected)
        # An empty list hides the lengths of its entries.
        lengths = [len(self.value) if n is None else n for n in shape]
        return freeze_array(np.reshape(np.array(self.value, dtype=np.float64), lengths))

    def integers(self, *shape: int | None) -> IntArray:
        """This array of integers; `shape` may begin with None for any length."""
        numbers = self.numbers(*shape)
        if (numbers != np.rint(numbers)).any():
            self.fail("an array of integers")
        return freeze_ints(numbers)


def _plain(value: Any) -> Any:
    """`value`, a table of numbers as the lists that are in the file."""
    return value.tolist() if isinstance(value, np.ndarray) else value


def _fits(table: Array, shape: tuple[int | None, ...]) -> bool:
    return table.ndim == len(shape) and all(
        wanted in (None, length) for wanted, length in zip(shape, table.shape, strict=True)
    )


def _misfit(value: Any, shape: tuple[int | None, ...], nullable: bool) -> tuple[str, str] | None:
    """Place of the first entry of `value` that is not what `shape` wants there, and that."""
    if not shape:
        return None if _finite(value) or (nullable and value is None) else ("", "a finite number")
    if not isinstance(value, list):
        return "", "a list"
    if shape[0] not in (None, len(value)):
        return "", f"a list of {shape[0]} entries (it has {len(value)})"
    for i, item in enumerate(value):
        misfit = _misfit(item, shape[1:], nullable)
        if misfit is not None:
            return f"[{i}]{misfit[0]}", misfit[1]
    return None


def _finite(value: Any) -> bool:
    return (
        isinstance(value, (int, float))
        and not isinstance(value, bool)
        and abs(value) <= sys.float_info.max
    )


def read(path: str | os.PathLike[str]) -> Node:
    """The content of the JSON file `path`.

    Raises:
        CalibrationError: if it cannot be read, is cut short or is not JSON.
    """
    file = os.fspath(path)
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
        # Between objects other threads can run; the parser itself holds them all up.
        return Node(json.loads(text, object_hook=_with_arrays), "", file)
    except OSError as error:
        raise CalibrationError(
            f"{file} cannot be read: {error.strerror or error}.", "Check its name and permissions."
        ) from error
    except json.JSONDecodeError as error:
        rest = error.doc[error.pos :]
        if _UNFINISHED.fullmatch(rest) or error.msg.startswith("Unterminated string"):
            raise CalibrationError(
                f"{file} is cut short in line {error.lineno}.", "Copy or write it again."
            ) from error
        raise _not_json(file, f"{error.msg} in line {error.lineno}") from error
    except UnicodeDecodeError as error:
        raise _not_json(file, "it is not text in UTF-8") from error
    except (ValueError, RecursionError) as error:
        raise _not_json(file, "it holds an endless number or nests too deeply") from error


def _with_arrays(members: dict[str, Any]) -> dict[str, Any]:
    """The members of an object, those that are tables of finite numbers as arrays."""
    return {key: _as_array(value) for key, value in members.items()}


def _as_array(value: Any) -> Any:
    """`value`, as an array if it is lists in lists, all of finite numbers and of one length."""
    leaves = value
    while isinstance(leaves, list) and all(isinstance(leaf, list) for leaf in leaves) and leaves:
        leaves = list(chain.from_iterable(leaves))
    if leaves is value or not set(map(type, leaves)) <= {int, float}:
        return value
    try:
        table = np.array(value, dtype=np.float64)
    except (ValueError, OverflowError):  # rows of different lengths, or too large a number
        return value
    return table if np.isfinite(table).all() else value


def same(a: Any, b: Any) -> bool:
    """Whether two values read from files are the same, number for number."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(same, a, b))
    return np.array_equal(a, b)


def _not_json(file: str, reason: str) -> CalibrationError:
    return CalibrationError(f"{file} is not a JSON file: {reason}.", "Choose another file.")


def check_format(node: Node, name: str, version: int) -> None:
    """Refuse a file of another format, or of a version that this program does not know.

    Raises:
        CalibrationError: with what to do instead.
    """
    found = node.get("format")
    if found is None or str(found.value) != name:  # an array would compare number by number
        raise CalibrationError(
            f"{node.file} is not a file of the format {name!r}.", "Choose another file."
        )
    number = node["version"].integer()
    if number < 1:
        node["version"].fail("a version of this format, which are counted from 1")
    if number > version:
        raise CalibrationError(
            f"{node.file} has version {number} of the format {name!r}; "
            f"this program knows versions up to {version}.",
            "Install a newer calibgui to read it.",
        )

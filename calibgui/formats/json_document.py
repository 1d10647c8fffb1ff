"""Writing of JSON, and reading with errors that name the place.

Numbers are written in the shortest form that reads back as the same float64, and as null if they
are not finite. Points, and rows of matrices, have a line each, so that two files can be compared
line by line.

A `Node` is a value with its place in the file ("views[2].uv[17]"). Each of its readers returns a
checked value or raises a CalibrationError with the file, the place and the expected value. Tables
of numbers become arrays while the file is parsed: hundreds of thousands of small lists would keep
the garbage collector, and with it every thread, busy.

The standard library's parser is used because names of files that are not valid Unicode are kept as
lone surrogates, which the faster msgspec neither reads nor writes, and because it lets other
threads run between objects: msgspec reads 25 MB in one call that stops the window for 160 ms.
"""

from __future__ import annotations

import io
import json
import math
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, NoReturn

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze_array, freeze_ints, is_unchangeable
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_read_error, open_replacement, read_regular

_CUT_OFF = re.compile(r"(-|\.|[eE][-+]?|tr?u?|fa?l?s?|nu?l?)?\s*")
"""The rest of a file that is cut within a number or word."""
MAX_JSON_SIZE = 512 << 20
"""Size of the largest JSON files that are read, bytes: results of a million corners have 400 MB."""
_MAX_INTEGER = 2**53
"""Size of the largest integer up to which a float64 holds all."""
_MAX_LINE_LENGTH = 100
"""Largest length of a list of lists on one line, in characters."""
_LEAVES = (str, float, int, np.ndarray, type(None))
"""Types of values without members, which most are."""
_AS_IT_IS, _IN_ASCII = json.JSONEncoder(ensure_ascii=False), json.JSONEncoder()
_ArrayTexts = dict[int, tuple[Array | IntArray, str]]
"""Arrays with their texts; the keys are their ids, which are theirs as long as they are here."""


class JsonWriter:
    """Writes documents of which most is the same as in the one before.

    The text of a read-only array says all that it ever will: it is kept until a document is
    written without the array. Everything else, of which there is little, is written anew.
    """

    def __init__(self) -> None:
        self._kept: _ArrayTexts = {}

    def write_file(self, path: str | os.PathLike[str], value: Any) -> None:
        """Write `value` as the file `path`, completely or not at all.

        Raises:
            CalibrationError: if it cannot be written.
        """
        with open_replacement(path) as file:
            text = io.TextIOWrapper(file, encoding="utf-8", newline="\n")
            document = _Document(text.write, self._kept)
            document.write(value)
            text.write("\n")
            text.detach()
        self._kept = document.texts


def write_json(path: str | os.PathLike[str], value: Any) -> None:
    """Write `value` as the file `path`. Raises as ``JsonWriter.write_file``."""
    JsonWriter().write_file(path, value)


def dumps(value: Any) -> str:
    """Write mappings, sequences, arrays of numbers, text, numbers, True, False or None as JSON."""
    text = io.StringIO()
    _Document(text.write, {}).write(value)
    return text.getvalue()


class _Document:
    """A document that is written piece by piece: to join a large one would stop every thread."""

    def __init__(self, put: Callable[[str], object], kept: _ArrayTexts) -> None:
        """`put` takes the pieces; `kept` has the arrays of the document before."""
        self._put, self._kept = put, kept
        self.texts: _ArrayTexts = {}
        """The read-only arrays of this document that have more than one line."""

    def write(self, value: Any, depth: int = 0) -> None:
        """Write a value whose further lines are indented by `depth` spaces."""
        if not _has_members(value):
            self._put(self._format(value, depth))
            return
        if isinstance(value, Mapping):
            opening, closing = "{}"
            members = [(f"{_format_scalar(str(key))}: ", item) for key, item in value.items()]
        else:
            opening, closing = "[]"
            members = [("", item) for item in value]
        before = opening
        for name, item in members:
            self._put(f"{before}\n{' ' * (depth + 1)}{name}")
            self.write(item, depth + 1)
            before = ","
        self._put(f"\n{' ' * depth}{closing}")

    def _format(self, value: Any, depth: int) -> str:
        """Return the text of a value that holds no members."""
        if isinstance(value, np.ndarray):
            return self._format_array(value).replace("\n", f"\n{' ' * depth}")
        if isinstance(value, Mapping):
            return "{}"
        if isinstance(value, Sequence) and not isinstance(value, str):
            return _format_list([self._format(item, depth + 1) for item in value], depth)
        return _format_scalar(value)

    def _format_array(self, value: Array | IntArray) -> str:
        known = self.texts.get(id(value)) or self._kept.get(id(value))
        text = known[1] if known else _format_array(value)
        if known or ("\n" in text and is_unchangeable(value)):
            self.texts[id(value)] = value, text
        return text


def _has_members(value: Any) -> bool:
    """Return whether `value` is a non-empty object, or a list that contains one."""
    if isinstance(value, _LEAVES):
        return False
    if isinstance(value, Mapping):
        return bool(value)
    return isinstance(value, Sequence) and any(map(_has_members, value))


def _format_array(value: Array | IntArray) -> str:
    # Of finite numbers and lists of them JSON and Python's repr are the same, repr is quicker.
    format_row = repr if np.isfinite(value).all() else dumps
    rows = list(map(format_row, value.tolist()))
    return _format_list(rows, 0) if value.ndim > 1 else f"[{', '.join(rows)}]"


def _format_list(items: list[str], depth: int) -> str:
    """Return a list on one line, or on a line for each of its lists if it is too long for one."""
    nested = any(item[0] in "[{" for item in items)
    if nested and sum(len(item) + 2 for item in items) > _MAX_LINE_LENGTH:
        margin = f"\n{' ' * depth}"
        return f"[{margin} {f',{margin} '.join(items)}{margin}]"
    return f"[{', '.join(items)}]"


def _format_scalar(value: str | float | int | None) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return "null"
    # A file name that is not valid Unicode holds surrogates, which only \u can write.
    printable = isinstance(value, str) and value.isprintable()
    return (_AS_IT_IS if printable else _IN_ASCII).encode(value)


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


def read_json(path: str | os.PathLike[str]) -> Node:
    """Read the JSON file `path`.

    Raises:
        CalibrationError: if it cannot be read, is no regular file or too large, is cut short or is
            not JSON.
    """
    file = os.fspath(path)
    try:
        text = read_regular(path, MAX_JSON_SIZE).decode("utf-8-sig")
    except OSError as error:
        raise describe_read_error(path, error) from error
    except UnicodeDecodeError as error:
        raise _make_error(file, "it is not text in UTF-8") from error
    return parse_json(text, file)


def parse_json(text: str, file: str) -> Node:
    """Return the content of a JSON text.

    Args:
        text: the text.
        file: name of its file, for messages.

    Raises:
        CalibrationError: if it is cut short or is not JSON.
    """
    try:
        # Other threads can run between objects, but not within the parser.
        return Node(json.loads(text, object_hook=_convert_tables), "", file)
    except json.JSONDecodeError as error:
        if not text.strip():
            raise CalibrationError(f"{file} is empty.", "Copy or write it again.") from error
        rest = error.doc[error.pos :]
        if _CUT_OFF.fullmatch(rest) or error.msg.startswith("Unterminated string"):
            raise CalibrationError(
                f"{file} is cut short in line {error.lineno}.", "Copy or write it again."
            ) from error
        raise _make_error(file, f"{error.msg} in line {error.lineno}") from error
    except (ValueError, RecursionError) as error:
        raise _make_error(file, "it holds an endless number or nests too deeply") from error


def _convert_tables(members: dict[str, Any]) -> dict[str, Any]:
    """Return the members of an object, with arrays in place of tables of finite numbers."""
    return {key: _convert_table(value) for key, value in members.items()}


def _convert_table(value: Any) -> Any:
    """Return an array if `value` is lists of lists of finite numbers, all of one length."""
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


def are_same_values(a: Any, b: Any) -> bool:
    """Return whether two values read from files are equal, number for number."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(are_same_values(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(are_same_values, a, b))
    return np.array_equal(a, b)


def _make_error(file: str, reason: str) -> CalibrationError:
    return CalibrationError(f"{file} is not a JSON file: {reason}.", "Choose another file.")


def check_format(
    node: Node, name: str, version: int, title: str, remedy: str = "Choose another file."
) -> None:
    """Refuse a file of another format, or of a version that is not known.

    Args:
        node: the content of the file.
        name: of the format.
        version: the newest one that is known.
        title: what such a file is, as "a project".
        remedy: if it is of another format.

    Raises:
        CalibrationError: with a hint.
    """
    found = node.get("format")
    if found is None or str(found.value) != name:  # an array would compare number by number
        raise CalibrationError(f"{node.file} is not {title}.", remedy)
    number = node["version"].integer()
    if number < 1:
        node["version"].fail("a version of this format, which are counted from 1")
    if number > version:
        raise CalibrationError(
            f"{node.file} has version {number} of its format; "
            f"this program knows versions up to {version}.",
            "Install a newer calibgui to read it.",
        )

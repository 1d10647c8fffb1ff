"""Writing of JSON, and its way through the gate (``gate.py``) into `Node`.

Numbers are written in the shortest form that reads back as the same float64, and as null if they
are not finite. Points, and rows of matrices, have a line each, so that two files can be compared
line by line.

Tables of numbers become arrays while the file is parsed: hundreds of thousands of small lists would
keep the garbage collector, and with it every thread, busy.

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
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, IntArray, is_unchangeable
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import open_replacement
from calibgui.formats.gate import (
    DamagedError,
    Language,
    NotOfLanguageError,
    parse_text,
    read_text,
    refuse_repeated,
)
from calibgui.formats.node import Node

_CUT_OFF = re.compile(r"(-|\.|[eE][-+]?|tr?u?|fa?l?s?|nu?l?)?\s*")
"""The rest of a file that is cut within a number or word."""
MAX_JSON_SIZE = 512 << 20
"""Size of the largest JSON files that are read, bytes: results of a million corners have 400 MB."""
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


def read_json(path: str | os.PathLike[str], max_size: int = MAX_JSON_SIZE) -> Node:
    """Read the JSON file `path` of at most `max_size` bytes.

    Raises:
        CalibrationError: as ``gate.read_text`` and ``gate.parse_text``; if it is cut short.
    """
    return parse_json(read_text(path, max_size, _JSON.title), os.fspath(path))


def parse_json(text: str, file: str) -> Node:
    """Return the content of a JSON text from a file. Raises as ``gate.parse_text``."""
    return parse_text(text, file, _JSON)


def _parse(text: str) -> Any:
    """Return the content of a JSON text."""
    try:
        # Other threads can run between objects, but not within the parser.
        return json.loads(text, object_pairs_hook=_convert_members)
    except json.JSONDecodeError as error:
        if not text.strip():
            raise DamagedError("is empty") from error
        rest = error.doc[error.pos :]
        if _CUT_OFF.fullmatch(rest) or error.msg.startswith("Unterminated string"):
            raise DamagedError(f"is cut short in line {error.lineno}") from error
        raise NotOfLanguageError(f"{error.msg} in line {error.lineno}") from error
    except ValueError as error:
        raise NotOfLanguageError("it holds an endless number") from error


_JSON = Language("a JSON file", _parse, MAX_JSON_SIZE)


def _convert_members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return the members of an object, with arrays in place of tables of finite numbers."""
    members = {key: _convert_table(value) for key, value in pairs}
    if len(members) < len(pairs):
        refuse_repeated(key for key, _ in pairs)
    return members


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
    # An array would compare number by number.
    if found is None or not isinstance(found.value, str) or found.value != name:
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

"""Arrays of numbers, and texts, in MATLAB's MAT files, versions 5 to 7.

MathWorks, "MAT-File Format": a header of 128 bytes, of which the last two tell the order of bytes,
and elements: a type and a number of bytes, four bytes each, and then these, padded to eight. Up to
four bytes may stand in the tag's second half, and their number in that of its first. A compressed
element (zlib) holds another one. A matrix holds elements itself: its class, its sides, its name,
and its numbers or letters column by column, or, of a cell, its matrices. Structures are passed
over.

Own rather than SciPy's, whose compiled reader ends the program on some damaged files.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator

import numpy as np

from calibgui.engine.arrays import Array

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {
    **{1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4"},
    **{9: "f8", 12: "i8", 13: "u8"},
}
"""Types of numbers as NumPy writes them."""
_LETTERS = {1: "ascii", 2: "ascii", 4: "utf-16", 16: "utf-8", 17: "utf-16"}
"""Encodings of letters, by the type of their numbers."""
_CELL, _TEXT, _FIRST_NUMERIC, _LAST_NUMERIC = 1, 4, 6, 15
"""Classes of matrices."""
_COMPLEX = 0x0800
_MAX_SIZE = 16 << 20
"""Number of bytes to which an element may unfold, at most: a pose has 128, a corner 16."""


class NotMatError(Exception):
    """An error: the content is no MAT file of these versions. Says why, as a clause."""


def read_mat_variables(content: bytes) -> list[tuple[str, Array | str]]:
    """Return all arrays of real numbers and lines of text, those in cells included, with the names
    of their variables, in the order of the file.

    Raises:
        NotMatError: if the content is damaged, of version 7.3, or no MAT file.
    """
    order = {b"IM": "<", b"MI": ">"}.get(content[126:128])
    if order is None:
        raise NotMatError("it is not a MAT file")
    if struct.unpack(f"{order}H", content[124:126])[0] != 0x0100:
        raise NotMatError("it is of version 7.3")
    found: list[tuple[str, Array | str]] = []
    for kind, data in _list_elements(content[_HEADER:], order):
        if kind == _COMPRESSED:
            inside = _list_elements(_unfold(data), order)
            found += [each for k, d in inside if k == _MATRIX for each in _list_values(d, order)]
        elif kind == _MATRIX:
            found += _list_values(data, order)
    return found


def _unfold(data: bytes) -> bytes:
    unfolder = zlib.decompressobj()
    try:
        unfolded = unfolder.decompress(data, _MAX_SIZE)
    except zlib.error as error:
        raise NotMatError("it is damaged") from error
    if unfolder.unconsumed_tail:
        raise NotMatError("it holds too many numbers")
    return unfolded


def _list_elements(content: bytes, order: str) -> Iterator[tuple[int, bytes]]:
    """List the elements of a content, each with its type."""
    at = 0
    while at + 8 <= len(content):
        kind, size = struct.unpack(f"{order}II", content[at : at + 8])
        if kind >> 16:
            kind, size, begin, end = kind & 0xFFFF, kind >> 16, at + 4, at + 8
        else:
            begin = at + 8
            end = begin + size + (0 if kind == _COMPRESSED else -size % 8)
        if begin + size > len(content):
            raise NotMatError("it is damaged")
        yield kind, content[begin : begin + size]
        at = end


def _list_values(
    content: bytes, order: str, cell: str | None = None
) -> list[tuple[str, Array | str]]:
    """List the values of a matrix: itself, or those of a cell, none of which is a cell."""
    parts = list(_list_elements(content, order))
    if len(parts) < 3 or len(parts[0][1]) < 4:
        raise NotMatError("it is damaged")
    (flags,) = struct.unpack(f"{order}I", parts[0][1][:4])
    kind = flags & 0xFF
    name = parts[2][1].decode("ascii", "replace") if cell is None else cell
    if kind == _CELL and cell is None:
        cells = [data for k, data in parts[3:] if k == _MATRIX and data]
        return [each for data in cells for each in _list_values(data, order, name)]
    if len(parts) < 4 or flags & _COMPLEX:
        return []
    sides = np.frombuffer(parts[1][1][: len(parts[1][1]) // 4 * 4], f"{order}i4").tolist()
    stored, data = parts[3]
    if kind == _TEXT and sides[:1] == [1]:
        return [(name, _decode_text(stored, data, order))]
    if not _FIRST_NUMERIC <= kind <= _LAST_NUMERIC:
        return []
    if stored not in _NUMBERS or min(sides, default=0) < 0:
        raise NotMatError("it is damaged")
    numbers = np.dtype(f"{order}{_NUMBERS[stored]}")
    if math.prod(sides) * numbers.itemsize != len(data):
        raise NotMatError("it is damaged")
    array = np.frombuffer(data, numbers).astype(np.float64).reshape(sides, order="F")
    return [(name, array)]


def _decode_text(stored: int, data: bytes, order: str) -> str:
    """Return the text of a line of letters."""
    if stored not in _LETTERS:
        raise NotMatError("it is damaged")
    encoding = _LETTERS[stored]
    if encoding == "utf-16":
        encoding += {"<": "-le", ">": "-be"}[order]
    return data.decode(encoding, "replace")

"""Values in a text of MATLAB's language, which is read and never run."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.formats.gate import parse_number
from calibgui.formats.importer import CameraText

_COMMENT = re.compile(r"%.*|\.\.\..*\n?")
"""A comment, or the end of a line that goes on in the next."""
_ASSIGNMENT = re.compile(
    r"^[ \t]*(\w+)[ \t]*=[ \t]*(\[[^\[\]]*\]|[-+.\w]+)('?)[ \t]*(?:;[ \t]*)?$", re.MULTILINE
)
"""A variable and the matrix or number that it gets."""


def remove_comments(text: str) -> str:
    """Return a text without its comments, with each statement on one line."""
    return _COMMENT.sub(" ", text)


def find_assignments(text: str) -> dict[str, str]:
    """Return the matrices and numbers, as they are written, that a text without comments assigns
    last, by their variables."""
    return {name: value + transposed for name, value, transposed in _ASSIGNMENT.findall(text)}


def parse_matrix(source: CameraText, name: str, word: str) -> Array:
    """Return the matrix (rows, columns) of numbers that `word` writes.

    Raises:
        CalibrationError: if it writes none, or one that is not finite; it names `name`.
    """
    content = word.rstrip("'")
    rows = re.split(r"[;\n]+", content.strip("[] \t\n"))
    try:
        matrix = np.array(
            [[parse_number(n) for n in row.replace(",", " ").split()] for row in rows]
        )
    except ValueError:
        source.fail(f"has a {name} that is no matrix of numbers: {word or 'nothing'}.")
    if not np.isfinite(matrix).all():
        source.fail(f"has a {name} with numbers that are not finite.")
    return matrix.T if (len(word) - len(content)) % 2 else matrix


def format_row(values: Sequence[float] | Array) -> str:
    """Return numbers as a matrix of one row."""
    return f"[{' '.join(repr(value) for value in np.asarray(values).tolist())}]"

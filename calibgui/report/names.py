"""Names of files as people read them."""

from __future__ import annotations

from pathlib import PurePath

_MAX_NAME_CHARACTERS = 28
"""Number of characters above which a name in a table is shortened."""


def make_printable(text: str) -> str:
    """Return `text` with line breaks, control codes, broken Unicode as \\n, \\x1b, \\udcff."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def shorten_name(path: str) -> str:
    """Return the file's name on one line, its middle replaced by dots if it is too long."""
    name = make_printable(PurePath(path).name)
    half = (_MAX_NAME_CHARACTERS - 1) // 2
    return name if len(name) <= _MAX_NAME_CHARACTERS else f"{name[:half]}..{name[-half:]}"

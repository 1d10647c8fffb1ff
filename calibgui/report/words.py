"""Names as people read them."""

from __future__ import annotations

from pathlib import PurePath

_LONGEST = 28
"""Characters of a name in a table."""


def printable(text: str) -> str:
    """`text` with line breaks, control characters and broken Unicode as \\n, \\x1b, \\udcff."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def short_name(path: str) -> str:
    """The file's name on one line, its middle replaced by dots if it is too long for a table."""
    name = printable(PurePath(path).name)
    half = (_LONGEST - 1) // 2
    return name if len(name) <= _LONGEST else f"{name[:half]}..{name[-half:]}"

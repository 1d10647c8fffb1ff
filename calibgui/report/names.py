"""Names of files as people read them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePath

_MAX_NAME_CHARACTERS = 28
"""Number of characters above which a name in a table is shortened."""
_DIGITS = "0123456789"


def make_printable(text: str) -> str:
    """Return `text` with line breaks, control codes, broken Unicode as \\n, \\x1b, \\udcff."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def shorten_name(path: str) -> str:
    """Return the file's name on one line, its middle replaced by dots if it is too long."""
    name = make_printable(PurePath(path).name)
    half = (_MAX_NAME_CHARACTERS - 1) // 2
    return name if len(name) <= _MAX_NAME_CHARACTERS else f"{name[:half]}..{name[-half:]}"


def join_words(words: Iterable[str]) -> str:
    """Join words to "a, b and c"."""
    *first, last = list(words) or [""]
    return f"{', '.join(first)} and {last}" if first else last


def distinguish_paths(paths: Sequence[str]) -> list[str]:
    """Return the ends of paths, of as few folders and names as tell all of them apart.

    >>> distinguish_paths(["18mm/result.json", "35mm/result.json"])
    ['18mm/result.json', '35mm/result.json']
    """
    parts = [PurePath(path).parts for path in paths]
    most = max(map(len, parts), default=1)
    for count in range(1, most + 1):
        ends = [PurePath(*part[-count:]).as_posix() for part in parts]
        if len(set(ends)) == len(set(paths)):
            return ends
    return list(paths)


def number_names(paths: Sequence[str]) -> list[str]:
    """Return a short number for each file: the one that its name ends with, or its place.

    The names' own numbers are taken if the names differ in nothing else; digits that all begin
    with are left out of numbers of one length. Places are counted from 1.
    """
    stems = [PurePath(path).stem for path in paths]
    heads = [stem.rstrip(_DIGITS) for stem in stems]
    numbers = [stem.removeprefix(head) for stem, head in zip(stems, heads, strict=True)]
    if len(set(heads)) != 1 or len(set(numbers)) != len(numbers) or not all(numbers):
        return [str(place) for place in range(1, len(paths) + 1)]
    while len(numbers) > 1 and len({n[0] for n in numbers}) == len({len(n) for n in numbers}) == 1:
        numbers = [number[1:] for number in numbers]
    return numbers

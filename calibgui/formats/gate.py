"""The gate through which every file that is read becomes data.

A file may be damaged, of another kind, or made to do harm. Whatever its language, it passes:

1. `read_text`: a regular file of at most a stated size, as text in UTF-8. Pipes, devices, folders
   and large files are refused before anything of them is read. A binary format that is read becomes
   the text that says the same.
2. `parse_text`: lists, objects, texts and numbers by the parser of a `Language`. Whatever that
   raises refuses the file, as it sees nothing but the text; so does a lack of stack or memory.
   Content that nests deeper than `MAX_DEPTH` is refused as well, so that what comes later may
   follow it by recursion: comparing, copying, writing.
3. `Node` (``node.py``): a value with its place in the file, whose readers check type, shape and
   range. No reader takes a value that it has not asked for in this way.

A refusal is a CalibrationError that names the file.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_read_error, read_regular
from calibgui.formats.node import Node

MAX_DEPTH = 50
"""Number of lists and objects within each other, at most: a project has 12. Python's stack has
room for some hundred, and PyYAML's parser in C crashes at some ten thousand."""
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
_MAX_DIGITS = 1000
"""Length of the longest number in words, characters: more digits take time and mean nothing."""
_MAX_QUOTE = 60
"""Length of the longest part of a file that a message repeats, characters."""
_REMEDY = "Choose another file."


class NotOfLanguageError(Exception):
    """An error of a parser: the text is not of its language. Says why, as a clause."""


class DamagedError(Exception):
    """An error of a parser: the text was of its language once. Says what it is now: "is empty"."""


@dataclass(frozen=True, slots=True)
class Language:
    """A language that data are written in."""

    title: str
    """What such a file is, as "a JSON file"."""
    parse: Callable[[str], Any]
    """The function from a text to its content. It raises NotOfLanguageError or DamagedError where
    it can say more than that the text holds something impossible."""
    max_length: int
    """Length of the longest text that is parsed, characters."""


def read_text(
    path: str | os.PathLike[str],
    max_size: int,
    title: str,
    remedy: str = _REMEDY,
    binary: Sequence[tuple[Callable[[bytes], bool], Callable[[bytes], str]]] = (),
) -> str:
    """Return the text of a file, without a byte order mark.

    Args:
        path: the file.
        max_size: its largest size, bytes.
        title: what it is expected to be, as "a JSON file".
        remedy: if it is no text.
        binary: binary formats that are read as the texts that say the same: a function that tells
            by its content whether a file is of the format, and one that returns the text or raises
            ValueError with the reason.

    Raises:
        CalibrationError: if it cannot be read, is no regular file, is too large, or is neither text
            in UTF-8 nor of a binary format.
    """
    file = os.fspath(path)
    try:
        content = read_regular(path, max_size)
        translate = next((translate for is_of, translate in binary if is_of(content)), None)
        return content.decode("utf-8-sig") if translate is None else translate(content)
    except OSError as error:
        raise describe_read_error(path, error) from error
    except UnicodeDecodeError as error:
        raise _refuse(file, title, "it is not text in UTF-8", remedy) from error
    except ValueError as error:
        raise _refuse(file, title, str(error), remedy) from error
    except MemoryError as error:
        raise _refuse(file, title, "it takes more memory than there is") from error


def parse_text(text: str, file: str, language: Language) -> Node:
    """Return the content of a text.

    Args:
        text: the text.
        file: the name of its file, for messages.
        language: what it is written in.

    Raises:
        CalibrationError: if it is too long, is not of the language, nests too deeply, or takes too
            much memory.
    """
    if len(text) > language.max_length:
        raise _refuse(file, language.title, "it is too long")
    try:
        content = language.parse(text)
        _check_depth(content)
    except DamagedError as error:
        raise CalibrationError(f"{file} {error}.", "Copy or write it again.") from error
    except NotOfLanguageError as error:
        raise _refuse(file, language.title, str(error)) from error
    except RecursionError as error:
        raise _refuse(file, language.title, "it nests too deeply") from error
    except MemoryError as error:
        raise _refuse(file, language.title, "it takes more memory than there is") from error
    except Exception as error:  # a parser sees the text alone: whatever it raises is the text's
        raise _refuse(file, language.title, "it holds an impossible value") from error
    return Node(content, "", file)


def parse_number(word: str) -> float:
    """Return the number that a word writes in decimal digits; it may be infinite by its exponent.

    Python's ``float`` would also take underscores, digits of other scripts, and "nan".

    Raises:
        ValueError: if it writes none.
    """
    if len(word) > _MAX_DIGITS or not _NUMBER.fullmatch(word):
        raise ValueError(f"{word[:_MAX_QUOTE]!r} is not a number")
    return float(word)


def check_depth(depth: int) -> None:
    """Refuse content that nests too deeply, for a parser that counts by itself.

    Raises:
        NotOfLanguageError: beyond `MAX_DEPTH`.
    """
    if depth > MAX_DEPTH:
        raise NotOfLanguageError("it nests too deeply")


def refuse_repeated(keys: Iterable[Any]) -> None:
    """Refuse members of an object that have one name: a reader would take one, and drop others.

    Raises:
        NotOfLanguageError: if one of `keys` is repeated; it names the key.
    """
    seen = set()
    for key in keys:
        if key in seen:
            raise NotOfLanguageError(f"it has two entries {str(key)[:_MAX_QUOTE]!r} in one place")
        seen.add(key)


def _check_depth(content: Any) -> None:
    """Refuse content that nests too deeply, level by level and without recursion."""
    level, depth = [content], 0
    while level:
        depth += 1
        check_depth(depth)
        level = [
            member
            for value in level
            if isinstance(value, dict | list | tuple)
            for member in (value.values() if isinstance(value, dict) else value)
            if isinstance(member, dict | list | tuple)
        ]


def _refuse(file: str, title: str, reason: str, remedy: str = _REMEDY) -> CalibrationError:
    return CalibrationError(f"{file} is not {title}: {reason}.", remedy)

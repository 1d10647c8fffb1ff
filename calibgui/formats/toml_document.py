"""TOML's way through the gate (``gate.py``) into `Node`."""

from __future__ import annotations

import os
import tomllib
from typing import Any

from calibgui.formats.gate import Language, NotOfLanguageError, parse_text, read_text
from calibgui.formats.node import Node

_TITLE = "a TOML file"


def read_toml(path: str | os.PathLike[str], max_size: int) -> Node:
    """Read the TOML file `path` of at most `max_size` bytes.

    Raises:
        CalibrationError: as ``gate.read_text`` and ``gate.parse_text``.
    """
    return parse_toml(read_text(path, max_size, _TITLE), os.fspath(path), max_size)


def parse_toml(text: str, file: str, max_length: int) -> Node:
    """Return the content of a TOML text of at most `max_length` characters.

    Raises:
        CalibrationError: as ``gate.parse_text``.
    """
    return parse_text(text, file, Language(_TITLE, _parse, max_length))


def _parse(text: str) -> dict[str, Any]:
    """Return the content of a TOML text."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise NotOfLanguageError(str(error)) from error

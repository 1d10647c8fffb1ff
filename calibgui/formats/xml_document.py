"""XML's way through the gate (``gate.py``): the elements of a text, which declares nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from calibgui.formats.gate import NotOfLanguageError, parse_number

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


def parse_elements(text: str) -> Element:
    """Return the outermost element of an XML text, for the parser of a `Language`.

    Raises:
        NotOfLanguageError: if it is none, or has declarations, by which a short text can grow
            beyond all memory or read other files.
    """
    from xml.etree import ElementTree  # late: a window that reads no camera starts without it

    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise NotOfLanguageError("it has declarations, which no program writes here")
    try:
        return ElementTree.fromstring(text.lstrip())
    except (ElementTree.ParseError, ValueError) as error:
        raise NotOfLanguageError(str(error)) from error


def convert_number(word: str) -> Any:
    """Return a number if `word` is one, else the word."""
    try:
        return parse_number(word)
    except ValueError:
        return word

"""Reading of what cv2.FileStorage writes, in YAML, XML or JSON, into `Node`.

A matrix is an object of rows, cols, dt and data in all three; OpenCV 5 writes an array of one
dimension with its sizes in place of rows and cols. OpenCV's own reader is not used: it
says neither where a file is damaged nor what is missing, and reads no YAML but its own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.formats.gate import Language, parse_text, refuse_repeated
from calibgui.formats.json_document import parse_json
from calibgui.formats.node import Node
from calibgui.formats.xml_document import convert_number, parse_elements
from calibgui.formats.yaml_document import parse_yaml

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_MAX_XML_LENGTH = 2 << 20
"""Length of the longest XML text that is read, characters; one of 25 views has some thousands."""


def parse_storage(text: str, file: str) -> Node:
    """Return the content of a cv2.FileStorage file, or of any YAML or JSON file.

    Args:
        text: its text.
        file: its name, for messages.

    Raises:
        CalibrationError: if it cannot be parsed.
    """
    start = text.lstrip()[:1]
    if start == "<":
        return parse_text(text, file, _XML)
    return parse_json(text, file) if start == "{" else parse_yaml(text, file)


def read_matrix(node: Node) -> Array:
    """Return the numbers of a matrix row by row: of an object of its sizes and data, or of a list.

    Raises:
        CalibrationError: if it is neither, or holds another number of entries than it says.
    """
    if isinstance(node.value, dict):
        if (sizes := node.get("sizes")) is not None:
            return node["data"].numbers(math.prod(sizes.integers(None).tolist()))
        return node["data"].numbers(node["rows"].integer() * node["cols"].integer())
    rows = node.items()
    if rows and isinstance(rows[0].value, list | np.ndarray):
        return np.concatenate([row.numbers(None) for row in rows])
    return node.numbers(None)


def _parse_xml(text: str) -> dict[str, Any]:
    """Return the entries of an XML file of OpenCV: matrices, numbers and texts."""
    root = parse_elements(text)
    refuse_repeated(entry.tag for entry in root)
    return {entry.tag: _convert_entry(entry) for entry in root}


_XML = Language("an XML file of OpenCV", _parse_xml, _MAX_XML_LENGTH)


def _convert_entry(entry: Element) -> Any:
    """Return an object for a matrix, and otherwise a number, a list of numbers, or the text."""
    if entry.get("type_id") in ("opencv-matrix", "opencv-nd-matrix"):
        refuse_repeated(part.tag for part in entry)
        members = {part.tag: _convert_numbers(part.text) for part in entry}
        for name in ("data", "sizes"):  # a list of one number is not told from a number
            if name in members and not isinstance(members[name], list):
                members[name] = [members[name]]
        return members
    return _convert_numbers(entry.text)


def _convert_numbers(text: str | None) -> Any:
    """Return the number, or the numbers, of a text; the text if there are others."""
    words = (text or "").split()
    return convert_number(words[0]) if len(words) == 1 else list(map(convert_number, words))

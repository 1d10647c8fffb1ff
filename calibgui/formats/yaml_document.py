"""YAML's way through the gate (``gate.py``) into `Node`, and numbers that every YAML reader takes.

PyYAML reads YAML 1.1, in which 1e-05 is a text because it has no point. People and programs write
such numbers, so they are read as YAML 1.2 reads them. Only data are read: tags that make Python
objects are refused. So are aliases, which let a short file stand for more than any memory holds:
no program writes cameras with them.

OpenCV's files are YAML with a head of its own and tags for its matrices (!!opencv-matrix), which
are read as the objects of rows, cols, dt and data that they mark.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from calibgui.formats.gate import (
    Language,
    NotOfLanguageError,
    check_depth,
    parse_text,
    refuse_repeated,
)
from calibgui.formats.node import Node

MAX_YAML_LENGTH = 1 << 19
"""Length of the longest YAML text that is read, characters: PyYAML takes some 3 s for it. OpenCV's
sample writes the corners of a hundred views in a half of it."""
_OPENCV_HEAD = re.compile(r"\A%YAML[: ]1\.\d\s*\n")
"""The first line of OpenCV's files: YAML would have a space in place of the colon."""
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+")
"""The numbers that only YAML 1.2 takes for numbers."""


def parse_yaml(text: str, file: str) -> Node:
    """Return the content of a YAML text from a file.

    Raises:
        CalibrationError: as ``gate.parse_text``; if it holds more than data.
    """
    return parse_text(text, file, Language("a YAML file", _parse, MAX_YAML_LENGTH))


def _parse(text: str) -> Any:
    """Return the content of a YAML text."""
    import yaml  # late: a window that reads no camera starts without it

    text = _OPENCV_HEAD.sub("", text)
    try:
        _check_events(text)
        return yaml.load(text, _make_loader())
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" in line {mark.line + 1}" if mark else ""
        reason = f"{getattr(error, 'problem', None) or error}{place}"
        raise NotOfLanguageError(reason) from error


@cache
def _make_loader() -> Any:
    """Return PyYAML's reader of data, with numbers as in YAML 1.2 and OpenCV's tags."""
    import yaml

    class Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
        """The reader, in C where PyYAML has it."""

        def flatten_mapping(self, node: yaml.MappingNode) -> None:
            """Follow no merge key."""

        def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> Any:
            """Return an object, none of whose keys is repeated."""
            members = super().construct_mapping(node, deep)
            if len(members) < len(node.value):
                refuse_repeated(self.construct_object(key, deep=True) for key, _ in node.value)
            return members

        def construct_opencv(self, _suffix: str, node: yaml.Node) -> Any:
            """Return the object that a tag of OpenCV marks."""
            if not isinstance(node, yaml.MappingNode):
                raise yaml.constructor.ConstructorError(
                    problem="a matrix is not an object", problem_mark=node.start_mark
                )
            return self.construct_mapping(node, deep=True)

    Loader.add_implicit_resolver("tag:yaml.org,2002:float", _NUMBER, list("-+.0123456789"))
    Loader.add_multi_constructor("tag:yaml.org,2002:opencv-", Loader.construct_opencv)
    return Loader


def _check_events(text: str) -> None:
    """Refuse a text that nests too deeply, on which PyYAML's reader in C crashes, or has aliases.

    Raises:
        NotOfLanguageError: with the reason.
        yaml.YAMLError: if it is not YAML.
    """
    import yaml

    depth = 0
    for event in yaml.parse(text, _make_loader()):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        check_depth(depth)
        if isinstance(event, yaml.AliasEvent):
            raise NotOfLanguageError(
                f"it has the alias *{str(event.anchor)[:20]}, and aliases are not followed: write "
                "out what it stands for"
            )


def format_number(value: float) -> str:
    """Write a float so that every YAML reader takes it for a number: YAML 1.1 demands a point."""
    mantissa, exponent, power = repr(float(value)).partition("e")
    return mantissa + (".0" if exponent and "." not in mantissa else "") + exponent + power

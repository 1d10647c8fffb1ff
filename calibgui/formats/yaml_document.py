"""Reading of YAML into `Node`, and numbers that every YAML reader takes for numbers.

PyYAML reads YAML 1.1, in which 1e-05 is a text because it has no point. People and programs write
such numbers, so they are read as YAML 1.2 reads them. Only data are read: tags that make Python
objects are refused, and merge keys, which let a short file grow without limit, are not followed.

OpenCV's files are YAML with a head of its own and tags for its matrices (!!opencv-matrix), which
are read as the objects of rows, cols, dt and data that they mark.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import Node

MAX_YAML_LENGTH = 2 << 20
"""Length of the longest YAML text that is read, characters: PyYAML takes some 10 s for it."""
_MAX_DEPTH = 50
"""Number of lists and objects within each other, at most; a camera file has five."""
_OPENCV_HEAD = re.compile(r"\A%YAML[: ]1\.\d\s*\n")
"""The first line of OpenCV's files: YAML would have a space in place of the colon."""
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+")
"""The numbers that only YAML 1.2 takes for numbers."""


def parse_yaml(text: str, file: str) -> Node:
    """Return the content of a YAML text.

    Args:
        text: the text.
        file: name of its file, for messages.

    Raises:
        CalibrationError: if it is not YAML, holds more than data, or is too long.
    """
    import yaml  # late: a window that reads no camera starts without it

    if len(text) > MAX_YAML_LENGTH:
        raise _make_error(file, "it is too long")
    text = _OPENCV_HEAD.sub("", text)
    try:
        _check_depth(text, file)
        content = yaml.load(text, _make_loader())
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" in line {mark.line + 1}" if mark else ""
        raise _make_error(file, f"{getattr(error, 'problem', None) or error}{place}") from error
    except (ValueError, TypeError, RecursionError) as error:
        raise _make_error(file, "it holds an impossible value or nests too deeply") from error
    return Node(content, "", file)


@cache
def _make_loader() -> Any:
    """Return PyYAML's reader of data, with numbers as in YAML 1.2 and OpenCV's tags."""
    import yaml

    class Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
        """The reader, in C where PyYAML has it."""

        def flatten_mapping(self, node: yaml.MappingNode) -> None:
            """Follow no merge key."""

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


def _check_depth(text: str, file: str) -> None:
    """Refuse a text that nests too deeply: PyYAML's reader in C would crash."""
    import yaml

    depth = 0
    for event in yaml.parse(text, _make_loader()):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if depth > _MAX_DEPTH:
            raise _make_error(file, "it nests too deeply")


def _make_error(file: str, reason: str) -> CalibrationError:
    return CalibrationError(f"{file} is not a YAML file: {reason}.", "Choose another file.")


def format_number(value: float) -> str:
    """Write a float so that every YAML reader takes it for a number: YAML 1.1 demands a point."""
    mantissa, exponent, power = repr(float(value)).partition("e")
    return mantissa + (".0" if exponent and "." not in mantissa else "") + exponent + power

"""The errors that the engine raises on purpose, and the type of progress callbacks."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import TypeVar

_Choice = TypeVar("_Choice", bound=StrEnum)


class CalibrationError(Exception):
    """An error that the user can act on: an operation that cannot be done, and why.

    Args:
        message: the fault, with the file or view concerned.
        hint: the remedy.
    """

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message} {self.hint}".rstrip()


class NoBoardError(CalibrationError):
    """An error: no acceptable board was found in an image."""


class OtherSizeError(NoBoardError):
    """An error: there are checkerboards in an image, but none of the stated size."""


class UnknownPartError(NoBoardError):
    """An error: marks of a board were read, but they do not tell its corners in this image."""


class MirroredError(NoBoardError):
    """An error: the marks on a board can be read in a mirror only."""

    def __init__(self) -> None:
        super().__init__(
            "The board is mirrored here: left is right.",
            "Turn mirroring off in the camera or in the program that takes the pictures, or print "
            "the board unmirrored, and take it again.",
        )


class WriteError(CalibrationError):
    """An error: the disk or the system refuses to write a file."""


class Cancelled(Exception):  # noqa: N818 - a request, not an error
    """The request of a progress callback to abandon the work and discard its result."""


def parse_choice(kind: type[_Choice], value: str, what: str) -> _Choice:
    """Return `value` as a member of an enumeration.

    Args:
        kind: the enumeration.
        value: the text to convert.
        what: what the enumeration is of, for the message.

    Raises:
        CalibrationError: if there is no such member, with the list of members.
    """
    try:
        return kind(value)
    except ValueError:
        raise CalibrationError(
            f"There is no {what} {value!r}.", f"Choose from {', '.join(kind)}."
        ) from None


Progress = Callable[[int, int], None]
"""A function of the number of parts of the work that are done and of all parts; it may raise
``Cancelled``."""

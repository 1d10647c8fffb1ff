"""The failures that the engine names.

What a solve reports on its way, and what it results in.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import TypeVar

_Choice = TypeVar("_Choice", bound=StrEnum)


class CalibrationError(Exception):
    """An operation that cannot be done, said so that its reader can act.

    Args:
        message: what is wrong, naming the file or view concerned.
        hint: what to do about it.
    """

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message} {self.hint}".rstrip()


class NoBoardError(CalibrationError):
    """No acceptable checkerboard was found in an image."""


class Cancelled(Exception):  # noqa: N818 - a request, not an error
    """Raised by a progress callback to abandon the work and discard its result."""


def one_of(kind: type[_Choice], value: str, what: str) -> _Choice:
    """`value` as one of the choices that there are of `what`.

    Raises:
        CalibrationError: if it is none of them, naming them.
    """
    try:
        return kind(value)
    except ValueError:
        raise CalibrationError(
            f"There is no {what} {value!r}.", f"Choose from {', '.join(kind)}."
        ) from None


Progress = Callable[[int, int], None]
"""Told how many parts of the work are done, of how many; may raise ``Cancelled``."""

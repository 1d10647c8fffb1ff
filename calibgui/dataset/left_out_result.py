"""A result that a series cannot use."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A result of a series whose photographs do not determine its camera."""

    file: str
    """Path of the result."""
    value: float
    """Value of the scalar; NaN if it is not known."""
    reason: str
    """Sentences that say what is wrong with the photographs."""
    remedy: str
    """A sentence that says what to photograph."""

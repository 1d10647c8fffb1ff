"""What every exporter provides, and what it tells of a file that it wrote."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from calibgui.dataset.result import Result

FRAME = "Pixels count from 0 at the centre of the first pixel, u right, v down."
"""What a file in the array frame says of it."""


@dataclass(frozen=True, slots=True)
class ExportReport:
    """A file that was written."""

    path: Path
    note: str
    """What the user should know of it, in one or two sentences."""
    largest_error_px: float | None = None
    """Of the exported camera against the calibrated one, over the whole image, px; NaN where
    it cannot follow it everywhere; None if nothing was refitted."""


@dataclass(frozen=True, slots=True)
class Exporter:
    """A file format that results can be written in."""

    name: str
    """By which the command line knows it."""
    title: str
    """By which a menu knows it."""
    suffixes: tuple[str, ...]
    """Of its files, the usual one first."""
    limits: str
    """Conventions, what is refitted and what the format cannot hold."""
    write: Callable[[Result, Path], ExportReport]
    """Raises CalibrationError if the file cannot be written."""
    partial: bool = False
    """Whether it says of a camera what was assumed, or holds no camera."""

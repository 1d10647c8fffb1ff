"""The description of a file format that results can be written in, and of a written file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from calibgui.dataset import Result

FRAME = "Pixels count from 0 at the centre of the first pixel, u right, v down."
"""The sentence with which a file in the array frame states its convention."""


@dataclass(frozen=True, slots=True)
class ExportReport:
    """A file that was written."""

    path: Path
    note: str
    """One or two sentences that the user should know about the file."""
    largest_error_px: float | None = None
    """Largest distance between the exported camera and the calibrated one over the whole image,
    px; NaN if the exported one is not defined everywhere; None if nothing was refitted."""


@dataclass(frozen=True, slots=True)
class Exporter:
    """A file format that results can be written in."""

    name: str
    """Name of the format on the command line."""
    title: str
    """Name of the format in a menu."""
    suffixes: tuple[str, ...]
    """Suffixes of its files, the usual one first."""
    models: tuple[str, ...]
    """Names of the lens models that it holds as calibrated. A camera of another model is refitted
    in the first of them, and not written if that cannot follow the lens."""
    limits: str
    """Conventions, what is refitted and what the format cannot hold."""
    write: Callable[[Result, Path], ExportReport]
    """Function that writes a file; it raises CalibrationError if it cannot."""
    partial: bool = False
    """True if the format states what was assumed of a camera, or holds no camera."""

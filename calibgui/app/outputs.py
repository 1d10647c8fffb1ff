"""Checks of output files before long work, and writing of figures."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_write_error, refuse_special_file, write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # slow to import, and not needed to check


FIGURE_SUFFIXES = (".png", ".svg", ".pdf")
"""Suffixes of the files that `save_figure` writes."""


def check_figure(path: Path) -> None:
    """Refuse the file of a figure that could not be written.

    Raises:
        CalibrationError: if its format is unknown, or as `check_writable`.
    """
    if path.suffix.lower() not in FIGURE_SUFFIXES:
        raise CalibrationError(
            f"{path} is not named as a figure.",
            f"Give it the suffix {' or '.join(FIGURE_SUFFIXES)}.",
        )
    check_writable(path)


def check_writable(path: Path) -> None:
    """Refuse an output file that could not be written.

    Raises:
        CalibrationError: if it is a folder, a device or a pipe, or its folder is missing or
            closed to writing.
    """
    folder = path.parent
    try:
        if path.is_dir():
            raise CalibrationError(f"{path} is a folder.", "Name a file in it.")
        refuse_special_file(path)
        if not folder.is_dir():
            raise CalibrationError(f"The folder {folder} does not exist.", "Create it first.")
    except OSError as error:  # a folder on the way is closed, or the name too long
        raise describe_write_error(path, error) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise CalibrationError(
            f"{path} cannot be written: you may not write to {folder}.", "Choose another folder."
        )


def check_outputs(outputs: Iterable[Path], inputs: Iterable[str | Path]) -> None:
    """Refuse output files that could not be written, or would replace an input or one another.

    Raises:
        CalibrationError: naming the first.
    """
    taken = {os.path.realpath(path): "is one of the files to read" for path in inputs}
    for path in outputs:
        check_writable(path)
        place = os.path.realpath(path)
        if place in taken:
            raise CalibrationError(f"{path} {taken[place]}.", "Choose another name to write to.")
        taken[place] = "would be written twice"


def make_folder(path: Path) -> None:
    """Create a folder to write to, with those above it, unless it is there.

    Raises:
        CalibrationError: if it cannot be made or written to.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CalibrationError(
            f"The folder {path} cannot be made: {error.strerror or error}.",
            "Choose another folder that you may write to.",
        ) from error
    check_writable(path / "any")


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure in the format of the path's suffix, completely or not at all.

    Raises:
        CalibrationError: if it cannot be written.
    """
    content = io.BytesIO()
    figure.savefig(content, format=path.suffix.removeprefix("."), dpi=110)
    write_atomically(path, content.getvalue())

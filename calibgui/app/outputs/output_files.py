"""Checks of output files before long work, and writing of figures."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_write_error, refuse_special_file, write_atomically
from calibgui.formats.origin import FIGURE, describe_kind, is_own, make_mark

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # slow to import, and not needed to check


FIGURE_SUFFIXES = (".png", ".svg", ".pdf")
"""Suffixes of the files that `save_figure` writes."""


def check_figures(
    paths: Iterable[Path], inputs: Iterable[str | Path], overwrite: bool = False
) -> None:
    """Refuse files of figures that could not be written, or would replace what must be kept.

    Raises:
        CalibrationError: if a format is unknown, or as `check_outputs`.
    """
    figures = list(paths)
    for path in figures:
        check_figure_name(path)
    check_outputs([(path, FIGURE) for path in figures], inputs, overwrite)


def check_figure_name(path: Path) -> None:
    """Refuse a name that does not tell the format of a figure.

    Raises:
        CalibrationError: with the suffixes that do.
    """
    check_suffix(path, FIGURE_SUFFIXES, "a figure")


def check_suffix(path: Path, suffixes: Iterable[str], what: str) -> None:
    """Refuse a name whose suffix tells no format of what is to be written, such as "a figure".

    Raises:
        CalibrationError: with the suffixes that do.
    """
    if path.suffix.lower() not in suffixes:
        raise CalibrationError(
            f"{path} is not named as {what}.", f"Give it the suffix {' or '.join(suffixes)}."
        )


def check_writable(path: Path) -> None:
    """Refuse an output file that could not be written.

    Raises:
        CalibrationError: if it is a folder, a device, a pipe or a file closed to writing, or its
            folder is missing or closed to writing.
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
            f"{path} cannot be written: you may not write to {folder.absolute()}.",
            "Choose another folder.",
        )
    if path.exists() and not os.access(path, os.W_OK):  # the folder alone would allow it
        raise CalibrationError(
            f"{path} is protected: you may not write to it.",
            "Choose another name, or allow it first.",
        )


def check_outputs(
    outputs: Iterable[tuple[Path, str]], inputs: Iterable[str | Path], overwrite: bool = False
) -> None:
    """Refuse output files that could not be written, or would replace what must be kept.

    That is the files to read, by whatever name or link, one another, and files that this program
    did not write or wrote as something else. With `overwrite` the latter are replaced under their
    own names, and never through a link.

    Args:
        outputs: the files, each with its kind (``formats.origin``).
        inputs: the files that will be read.
        overwrite: whether the user allows to replace any other file.

    Raises:
        CalibrationError: naming the first.
    """
    read = {identify_file(path) for path in inputs} - {None}
    taken: set[str] = set()
    for path, kind in outputs:
        check_writable(path)
        place = os.path.realpath(path)
        if place in taken:
            raise CalibrationError(
                f"{path} would be written twice.", "Choose another name to write to."
            )
        taken.add(place)
        if identify_file(path) in read:
            raise CalibrationError(
                f"{path} is one of the files to read.", "Choose another name to write to."
            )
        if path.exists() and (path.is_symlink() or not overwrite):
            _refuse_foreign(path, kind)


def identify_file(path: str | Path) -> tuple[int, int] | None:
    """Return what is the same for all names of a file; None if there is no such file."""
    try:
        state = os.stat(path)  # noqa: PTH116 - takes text as well
    except OSError:
        return None
    return state.st_dev, state.st_ino


def _refuse_foreign(path: Path, kind: str) -> None:
    """Refuse a file that this program did not write as a file of a kind."""
    try:
        if is_own(path, kind):
            return
    except OSError as error:
        raise describe_write_error(path, error) from error
    what = describe_kind(kind)
    if path.is_symlink():
        raise CalibrationError(
            f"{path} leads to {os.path.realpath(path)}, which is not {what} that calibgui wrote.",
            "Choose another name, or remove the link.",
        )
    raise CalibrationError(
        f"{path} exists, and is not {what} that calibgui wrote.",
        "Choose another name, or add --overwrite to replace it.",
    )


def make_folder(path: Path) -> None:
    """Create a folder to write to, with those above it, unless it is there.

    Raises:
        CalibrationError: if it cannot be made or written to.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise CalibrationError(
            f"The folder {path} cannot be made: a file has that name.", "Name another folder."
        ) from error
    except OSError as error:
        raise CalibrationError(
            f"The folder {path} cannot be made: {error.strerror or error}.",
            "Choose another folder that you may write to.",
        ) from error
    if not os.access(path, os.W_OK | os.X_OK):
        raise CalibrationError(
            f"You may not write to the folder {path.absolute()}.", "Choose another folder."
        )


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure in the format of the path's suffix, completely or not at all.

    Raises:
        CalibrationError: if it cannot be written.
    """
    content = io.BytesIO()
    suffix = path.suffix.lower().removeprefix(".")
    key = "Software" if suffix == "png" else "Creator"
    figure.savefig(content, format=suffix, dpi=110, metadata={key: make_mark(FIGURE)})
    write_atomically(path, content.getvalue())

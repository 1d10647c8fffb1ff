"""From what a user names (files, folders, patterns) to the images meant."""

from __future__ import annotations

import glob
import os
import re
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS


def find_images(names: Iterable[str]) -> tuple[Path, ...]:
    """The image files that `names` stand for, each once, in natural order (Image2 before Image10).

    A file is taken whatever it holds, a folder for the images directly in it, anything else
    as a pattern (*, ?, [..], ** for folders at any depth).

    Raises:
        CalibrationError: if a name stands for nothing, or for what may not be looked at.
    """
    found: dict[str, Path] = {}
    for name in names:
        for path in _meant(name):
            found.setdefault(os.path.realpath(path), path)
    return tuple(sorted(found.values(), key=natural_key))


def natural_key(path: Path) -> list[tuple[str, int]]:
    """Sorting key that compares runs of digits as numbers, and letters without their case."""
    text = unicodedata.normalize("NFC", str(path)).casefold()
    return [(word, int(digits or -1)) for word, digits in re.findall(r"([^0-9]*)([0-9]*)", text)]


def _meant(name: str) -> list[Path]:
    """The files that one name stands for."""
    try:
        return _listed(name)
    except OSError as error:
        raise CalibrationError(
            f"{error.filename} cannot be read: {error.strerror}.",
            "Check the name and that you may read it.",
        ) from error


def _listed(name: str) -> list[Path]:
    """The files that one name stands for, as the system tells."""
    path = Path(name)
    if name and path.is_dir():
        images = [p for p in path.iterdir() if _is_image(p)]
        if not images:
            raise CalibrationError(
                f"The folder {name} holds no images.",
                f"Name a folder with files that end in {', '.join(FORMATS)}.",
            )
        return images
    if path.is_file():
        return [path]
    if name and path.exists():
        raise CalibrationError(f"{name} is a device or a pipe.", "Name an image file or a folder.")
    if not glob.has_magic(name):
        raise CalibrationError(f"{name or repr(name)} does not exist.", "Check its spelling.")
    matches = glob.glob(name, recursive=True)  # noqa: PTH207 - Path.glob takes no absolute ones
    files = [path for path in map(Path, matches) if path.is_file()]
    if not files:
        raise CalibrationError(f"No file matches {name}.", "Check the pattern and its folder.")
    return files


def _is_image(path: Path) -> bool:
    """Whether an entry of a folder is meant; hidden ones are other programs' notes.

    A link to nowhere is: it would be missed if nobody told that it cannot be read.
    """
    hidden = path.name.startswith(".")
    image = not hidden and path.suffix.lower() in FORMATS
    return image and (path.is_file() or not path.exists())

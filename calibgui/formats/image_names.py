"""Names of photographs in files of other programs, which look for them in folders of their own."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path, PurePath


def shorten_names(images: Sequence[str]) -> list[str]:
    """Return absolute paths from the innermost folder that holds them all, others as they are."""
    paths = [PurePath(image) for image in images]
    if not paths or not all(path.is_absolute() for path in paths):
        return list(images)
    try:
        folder = os.path.commonpath([path.parent for path in paths])
    except ValueError:  # on several drives
        return list(images)
    return [path.relative_to(folder).as_posix() for path in paths]


def locate_from(folder: Path, image: str) -> str:
    """Return the path of an image from a folder, or its name as it is if there is no such file."""
    if not Path(image).is_file():
        return image
    try:
        return Path(os.path.relpath(image, folder)).as_posix()
    except ValueError:  # on another drive
        return Path(image).absolute().as_posix()

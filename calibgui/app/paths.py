"""The image files that a user means by names of files, folders and patterns."""

from __future__ import annotations

import glob
import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from pathlib import Path, PurePath

from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS, read_image_header


def find_images(names: Iterable[str]) -> tuple[Path, ...]:
    """Return the image files that `names` mean, once each, naturally sorted (Image2, Image10).

    The name of a file means this file whatever it holds, that of a folder the images directly in
    it, and any other name is a pattern (*, ?, [..], ** for folders at any depth).

    Raises:
        CalibrationError: if a name means no file, or one that must not be read.
    """
    found: dict[str, Path] = {}
    resolve_folder = cache(os.path.realpath)
    for name in names:
        for path in _find_files(name):
            # A folder is resolved once for its files, of which a thousand cameras have thousands.
            is_plain = path.name not in ("", "..") and not path.is_symlink()
            place = f"{resolve_folder(path.parent)}{os.sep}{path.name}" if is_plain else ""
            found.setdefault(place or os.path.realpath(path), path)
    return tuple(sorted(found.values(), key=make_natural_key))


def choose_images(names: Sequence[str]) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Return the image files in a selection of files and folders, and what in it holds none.

    All that lies in a folder is soon selected, notes and videos with the photographs. So a file
    that is not named as an image is taken only if it holds one.

    Args:
        names: one or more names, each as for `find_images`.

    Raises:
        CalibrationError: why the first of `names` cannot be taken, if none can.
    """
    taken, refused = [], {}
    for name in names:
        path = Path(name)
        try:
            if not path.is_file():
                find_images([name])
            elif path.suffix.lower() not in FORMATS:
                read_image_header(path)
            taken.append(name)
        except CalibrationError as error:
            refused[name] = error
    if not taken:
        raise next(iter(refused.values()))
    return find_images(taken), tuple(refused)


def is_remote(path: str) -> bool:
    """Return whether a path is an address, as s3:// or http://, where a fleet's photographs are."""
    return "://" in path


@lru_cache(maxsize=10_000)
def make_natural_key(path: Path) -> tuple[tuple[str, int], ...]:
    """Return a sorting key that compares runs of digits as numbers and ignores case.

    Keys are kept: every image is sorted again when others are added.
    """
    text = unicodedata.normalize("NFC", str(path)).casefold()
    words = re.findall(r"([^0-9]*)([0-9]*)", text)
    return tuple((word, int(digits or -1)) for word, digits in words)


def _find_files(name: str) -> list[Path]:
    """Return the files that one name means."""
    try:
        return _list_files(name)
    except OSError as error:
        raise CalibrationError(
            f"{error.filename} cannot be read: {error.strerror}.",
            "Check the name and that you may read it.",
        ) from error


def _list_files(name: str) -> list[Path]:
    """Return the files that one name means; raise OSError if a folder cannot be read."""
    path = Path(name)
    if name and path.is_dir():
        with os.scandir(path) as entries:
            images = [path / entry.name for entry in entries if _is_image(entry)]
        if not images:
            raise CalibrationError(
                f"The folder {name} holds no images that can be read{_describe_others(path)}.",
                f"Name a folder with files that end in {', '.join(FORMATS)}; save pictures of "
                "other formats, and pictures of videos, as PNG or as JPEG in full size.",
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


def _describe_others(folder: Path) -> str:
    """Say which files a folder holds that are no images: cameras write formats of their own."""
    suffixes = Counter(p.suffix.lower() for p in folder.iterdir() if p.is_file() and p.suffix)
    listed = ", ".join(f"{count} of {suffix}" for suffix, count in suffixes.most_common(3))
    return f", but files of other formats: {listed}" if listed else ""


def _is_image(entry: os.DirEntry[str]) -> bool:
    """Return whether an entry of a folder is an image; hidden files are other programs' notes.

    A broken link counts as an image, so that the user is told that it cannot be read.
    """
    hidden = entry.name.startswith(".")
    if hidden or PurePath(entry.name).suffix.lower() not in FORMATS:
        return False
    path = Path(entry)
    return entry.is_file(follow_symlinks=False) or path.is_file() or not path.exists()

"""The image files that a user means by names of files, folders and patterns."""

from __future__ import annotations

import glob
import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path
from types import MappingProxyType

from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS, SUFFIXES, list_suffixes, read_image_header

_MAX_FOLDERS = 200
"""Number of folders that are looked through for images at most, where none were expected."""
_MAX_LISTED = 5
"""Number of folders that a message names at most."""


class NoImagesError(CalibrationError):
    """An error: a folder holds no images itself.

    Args:
        message, hint: as for `CalibrationError`.
        folders: numbers of images in the folders below it that have some.
    """

    def __init__(
        self, message: str, hint: str, folders: Mapping[Path, int] = MappingProxyType({})
    ) -> None:
        super().__init__(message, hint)
        self.folders = folders


def find_images(names: Iterable[str]) -> tuple[Path, ...]:
    """Return the image files that `names` mean, once each, naturally sorted (Image2, Image10).

    The name of a file means this file whatever it holds, that of a folder the images directly in
    it, and any other name is a pattern (*, ?, [..], ** for folders at any depth).

    Raises:
        CalibrationError: if a name means no file, or one that must not be read.
    """
    return _sort_files(path for name in names for path in _find_files(name))


def choose_images(names: Sequence[str]) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Return the image files in a selection of files and folders, and what in it holds none.

    All that lies in a folder is soon selected, notes and videos with the photographs. So a file
    that is not named as an image is taken only if it holds one.

    Args:
        names: one or more names, each as for `find_images`.

    Raises:
        CalibrationError: why the first of `names` cannot be taken, if none can.
    """
    taken: list[Path] = []
    refused: dict[str, CalibrationError] = {}
    for name in names:
        path = Path(name)
        try:
            if path.is_file() and path.suffix.lower() not in FORMATS:
                read_image_header(path)
            taken += _find_files(name)
        except CalibrationError as error:
            refused[name] = error
    if not taken:
        raise next(iter(refused.values()))
    return _sort_files(taken), tuple(refused)


def count_images_below(folder: Path) -> dict[Path, int]:
    """Count the images in each folder below another one, at any depth; those without have no count.

    Hidden folders, links and what may not be read are left out, and after some hundreds of folders
    no more are looked at.
    """
    counts: dict[Path, int] = {}
    suffixes = FORMATS + list_suffixes()
    waiting = [folder]
    for _ in range(_MAX_FOLDERS):
        if not waiting:
            break
        place = waiting.pop(0)
        try:
            with os.scandir(place) as entries:
                listed = list(entries)
        except OSError:
            continue
        below = [
            place / entry.name
            for entry in listed
            if not entry.name.startswith(".") and entry.is_dir(follow_symlinks=False)
        ]
        waiting += sorted(below, key=make_natural_key)
        count = sum(_is_image(entry, suffixes) for entry in listed)
        if count and place != folder:
            counts[place] = count
    return dict(sorted(counts.items(), key=lambda one: make_natural_key(one[0])))


def describe_unread_folders(names: Sequence[str], known: Iterable[Path] = ()) -> str:
    """Say which folders with images lie below those that `names` mean, and are not read with them;
    empty if there are none. `known` are images that have been read before."""
    named = [Path(name) for name in names if Path(name).is_dir()]
    read = {folder.resolve() for folder in {path.parent for path in (*find_images(names), *known)}}
    unread = {
        below: count
        for folder in named
        for below, count in count_images_below(folder).items()
        if below.resolve() not in read
    }
    if not unread:
        return ""
    return (
        f"Not read: {_list_counts(unread)}. Of a folder only the images directly in it are read: "
        "add these folders as well if they are of the same camera and board."
    )


def describe_unread_photographs(names: Sequence[str]) -> str:
    """Say which photographs in the folders among `names` are of a format that is not read; empty if
    there are none. Those that lie beside an image of the same name are copies of it."""
    folders = [Path(name) for name in names if Path(name).is_dir()]
    read = {path.with_suffix("").name.casefold() for path in find_images(names)}
    unread = {suffix for each in SUFFIXES.values() for suffix in each} - set(list_suffixes())
    suffixes = Counter(
        path.suffix.lower()
        for folder in folders
        for path in folder.iterdir()
        if path.suffix.lower() in unread
        and not path.name.startswith(".")
        and path.stem.casefold() not in read
    )
    if not suffixes:
        return ""
    listed = ", ".join(f"{count} of {suffix}" for suffix, count in suffixes.most_common())
    return (
        f"Not read: photographs in other formats, {listed}. Save them as JPEG or PNG in full size, "
        "without correcting the lens, or `pip install 'calibgui[photos]'`, which reads them."
    )


def is_remote(path: str) -> bool:
    """Return whether a path is an address, as s3:// or http://, where a fleet's photographs are."""
    return "://" in path


def make_natural_key(path: str | Path) -> tuple[tuple[str, int], ...]:
    """Return a sorting key that compares runs of digits as numbers and ignores case."""
    return _split_at_digits(str(path))


@lru_cache(maxsize=10_000)
def _split_at_digits(path: str) -> tuple[tuple[str, int], ...]:
    """Return words and the numbers behind them; kept, as images are sorted whenever some come."""
    text = unicodedata.normalize("NFC", path).casefold()
    words = re.findall(r"([^0-9]*)([0-9]*)", text)
    return tuple((word, int(digits or -1)) for word, digits in words)


def _sort_files(files: Iterable[Path]) -> tuple[Path, ...]:
    """Return files once each, naturally sorted."""
    found: dict[str, Path] = {}
    resolve_folder = cache(os.path.realpath)
    for path in files:
        # A folder is resolved once for its files, of which a thousand cameras have thousands.
        is_plain = path.name not in ("", "..") and not path.is_symlink()
        place = f"{resolve_folder(path.parent)}{os.sep}{path.name}" if is_plain else ""
        found.setdefault(place or os.path.realpath(path), path)
    return tuple(sorted(found.values(), key=make_natural_key))


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
            listed = list(entries)
        images = [path / entry.name for entry in listed if _is_image(entry)]
        suffixes = list_suffixes()
        others = [path / entry.name for entry in listed if _is_image(entry, suffixes)]
        stems = {image.stem.casefold() for image in images}  # a camera writes both
        images += [other for other in others if other.stem.casefold() not in stems]
        if not images:
            raise _explain_lack(name, path)
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


def _explain_lack(name: str, folder: Path) -> NoImagesError:
    """Say of a folder without images where there are some below it, or what it holds instead."""
    counts = count_images_below(folder)
    if not counts:
        return NoImagesError(
            f"The folder {name} holds no images that can be read{_describe_others(folder)}.",
            f"Name a folder with files that end in {', '.join(FORMATS)}, or videos by their own "
            "names; save pictures of other formats as PNG or as JPEG in full size.",
        )
    listed = _list_counts({below.relative_to(folder): count for below, count in counts.items()})
    first = next(iter(counts))
    several = "; name several only if they are of one camera" if len(counts) > 1 else ""
    return NoImagesError(
        f"The folder {name} itself holds no images, but there are some in {listed}.",
        f"Name the folder that holds the photographs, as {first}{several}.",
        counts,
    )


def _list_counts(counts: Mapping[Path, int]) -> str:
    """List folders with the numbers of their images, as "left (12 images), right (1 image)"."""
    listed = [
        f"{folder} ({count} {'image' if count == 1 else 'images'})"
        for folder, count in list(counts.items())[:_MAX_LISTED]
    ]
    more = f" and {len(counts) - _MAX_LISTED} more" if len(counts) > _MAX_LISTED else ""
    return ", ".join(listed) + more


def _describe_others(folder: Path) -> str:
    """Say which files a folder holds that are no images: cameras write formats of their own."""
    suffixes = Counter(p.suffix.lower() for p in folder.iterdir() if p.is_file() and p.suffix)
    listed = ", ".join(f"{count} of {suffix}" for suffix, count in suffixes.most_common(3))
    return f", but files of other formats: {listed}" if listed else ""


def _is_image(entry: os.DirEntry[str], suffixes: tuple[str, ...] = FORMATS) -> bool:
    """Return whether an entry of a folder is an image; hidden files are other programs' notes.

    A broken link counts as an image, so that the user is told that it cannot be read.
    """
    hidden = entry.name.startswith(".")
    if hidden or not entry.name.lower().endswith(suffixes):
        return False
    if entry.is_file(follow_symlinks=False):
        return True
    path = Path(entry)
    return path.is_file() or not path.exists()


def find_photograph(result: Path, image: str) -> Path | None:
    """Find a photograph that a result names: by that name, or beside the file of the result.

    Args:
        result: the file; its photographs may be named from the folder in which it was made.
        image: the name.

    Returns:
        None if it is at none of these places.
    """
    places = Path(image), result.parent / image, result.parent / Path(image).name
    return next((place for place in places if place.is_file()), None)

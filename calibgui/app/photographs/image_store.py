"""Pixels of the project's images: thumbnails of all, whole images of those used last."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Size
from calibgui.engine.files import open_regular
from calibgui.engine.images import (
    Field,
    Header,
    Image,
    read_image,
    read_small_image,
    stretch_levels,
)

MAX_MEMORY_BYTES = 100_000_000
"""Memory that whole images may take together, bytes: 8 of 12 megapixels. Chosen so that the window
with 300 of these stays below 800 MB (`tests.benchmarks.responsiveness`)."""
_MIN_THUMBNAIL_SIDE = 96
"""Least long side of a thumbnail, px, unless the image itself is smaller."""


@dataclass(frozen=True, eq=False, slots=True)
class Thumbnail:
    """A small picture of an image file, with the size and the digest of the file."""

    grey: npt.NDArray[np.uint8]
    """(h, w)"""
    header: Header
    """The header of the file."""
    digest: str
    """SHA-256 of the file, as hexadecimal digits."""

    @property
    def size(self) -> Size:
        """Width and height of the image itself, px."""
        return self.header.size


def read_thumbnail(path: str) -> Thumbnail:
    """Read an image file small.

    Raises:
        CalibrationError: as ``read_image``.
    """
    least = 4 * _MIN_THUMBNAIL_SIDE
    pixels, header = read_small_image(path, least)
    while max(pixels.shape) >= least:
        pixels = opencv.halve_image(pixels)
    return Thumbnail(stretch_levels(pixels), header, compute_file_digest(path))


Signature = tuple[int, int]
"""Time of a file's last change, ns, and its length; zeros where there is no file."""


def read_signature(path: str | Path) -> Signature:
    """Return a value that changes when a file is written to, without reading the file."""
    try:
        state = Path(path).stat()
    except OSError:
        return (0, 0)
    return state.st_mtime_ns, state.st_size


def compute_file_digest(path: str | Path) -> str:
    """Compute the SHA-256 of a file's content. Raises as ``engine.files.open_regular``."""
    with open_regular(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class ImageStore:
    """Images in memory, those used last within a limit; safe to use from any thread.

    Args:
        memory: the limit, bytes.
        find_orientation: returns the EXIF orientation by which the image of a path is turned, None
            for that which its file states.
        find_field: returns the field of it that is shown, None for all rows.
    """

    def __init__(
        self,
        memory: int = MAX_MEMORY_BYTES,
        find_orientation: Callable[[str], int | None] = lambda _: None,
        find_field: Callable[[str], Field | None] = lambda _: None,
    ) -> None:
        self._memory = memory
        self._find_orientation = find_orientation
        self._find_field = find_field
        self._kept: OrderedDict[str, Image] = OrderedDict()
        self._lock = threading.Lock()

    def kept(self, path: str) -> Image | None:
        """Return the image if it is in memory, else None."""
        with self._lock:
            if path in self._kept:
                self._kept.move_to_end(path)
            return self._kept.get(path)

    def read(self, path: str) -> Image:
        """Return the image, from memory or from its file.

        Raises:
            CalibrationError: as ``read_image``.
        """
        image = self.kept(path)
        orientation, field = self._find_orientation(path), self._find_field(path)
        is_turned = image is not None and orientation not in (None, image.orientation)
        if image is None or is_turned or image.field != field:
            image = read_image(path, orientation, field)
            with self._lock:
                self._kept[path] = image
                while self.size > self._memory and len(self._kept) > 1:
                    self._kept.popitem(last=False)
        return image

    def forget(self, path: str) -> None:
        """Drop an image from memory, so that it is read again."""
        with self._lock:
            self._kept.pop(path, None)

    @property
    def size(self) -> int:
        """Memory that the kept images take, bytes."""
        return sum(image.pixels.nbytes for image in self._kept.values())

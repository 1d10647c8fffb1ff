"""Pictures of the project's images: small ones of all, whole ones of those looked at lately."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Size
from calibgui.engine.images import Image, read_image, stretched

MEMORY = 400_000_000
"""Bytes that whole images may take together."""
_SIDE = 96
"""Least long side of a thumbnail, px, if the image has as much."""


@dataclass(frozen=True, eq=False, slots=True)
class Thumbnail:
    """A small picture of an image file, and what reading it told."""

    grey: npt.NDArray[np.uint8]
    """(h, w)"""
    size: Size
    """Of the image itself, px."""
    digest: str
    """SHA-256 of the file, as hexadecimal digits."""


def read_thumbnail(path: str) -> Thumbnail:
    """Read an image file and shrink it.

    Raises:
        CalibrationError: as ``read_image``.
    """
    image = read_image(path)
    pixels = image.pixels
    while max(pixels.shape) >= 4 * _SIDE:
        pixels = opencv.half(pixels)
    return Thumbnail(stretched(pixels), image.size, file_digest(path))


Signature = tuple[int, int]
"""Time of a file's last change, ns, and its length; zeros where there is no file."""


def signature(path: str | Path) -> Signature:
    """What changes when a file is written to, without reading it."""
    try:
        state = Path(path).stat()
    except OSError:
        return (0, 0)
    return state.st_mtime_ns, state.st_size


def file_digest(path: str | Path) -> str:
    """SHA-256 of a file's content."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class ImageStore:
    """Reads images and keeps those used last, within bounds; safe to use from any thread."""

    def __init__(self, memory: int = MEMORY) -> None:
        self._memory = memory
        self._kept: OrderedDict[str, Image] = OrderedDict()
        self._lock = threading.Lock()

    def kept(self, path: str) -> Image | None:
        """The image if it is in memory."""
        with self._lock:
            if path in self._kept:
                self._kept.move_to_end(path)
            return self._kept.get(path)

    def read(self, path: str) -> Image:
        """The image, from memory or from its file.

        Raises:
            CalibrationError: as ``read_image``.
        """
        image = self.kept(path)
        if image is None:
            image = read_image(path)
            with self._lock:
                self._kept[path] = image
                while self.size > self._memory and len(self._kept) > 1:
                    self._kept.popitem(last=False)
        return image

    def forget(self, path: str) -> None:
        """Read the image anew when it is wanted next."""
        with self._lock:
            self._kept.pop(path, None)

    @property
    def size(self) -> int:
        """Bytes that the kept images take."""
        return sum(image.pixels.nbytes for image in self._kept.values())

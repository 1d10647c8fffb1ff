"""EXIF: how an image is turned, and which camera and lens took it when.

EXIF is a small TIFF, held in a JPEG's APP1 segment, a PNG's eXIf or a WebP's EXIF chunk. Pillow
reads its directories: the first one names the camera and the orientation, the one that it
points to (tag 0x8769) the lens and the date.

Tags: Exif 2.32 (CIPA DC-008-2019), 4.6.
"""

from __future__ import annotations

import contextlib
import io
import struct
import warnings
from dataclasses import dataclass
from datetime import datetime
from enum import IntEnum
from mmap import mmap
from typing import Any

from calibgui.engine.arrays import Size


class _Tag(IntEnum):
    """Tags of directories."""

    SUBFILE_TYPE = 254
    WIDTH = 256
    HEIGHT = 257
    MAKE = 271
    MODEL = 272
    ORIENTATION = 274
    DATE_OF_CHANGE = 306
    EXIF_DIRECTORY = 34665
    DATE_OF_EXPOSURE = 36867
    FOCAL_LENGTH = 37386
    FRACTION_OF_CHANGE = 37520
    FRACTION_OF_EXPOSURE = 37521
    EQUIVALENT_FOCAL_LENGTH = 41989
    LENS_MAKE = 42035
    LENS_MODEL = 42036
    DNG_VERSION = 50706


_SMALLER_COPY, _NO_PAGE = 0b001, 0b101
"""Bits of the subfile type of a smaller copy of a page, and of that and of a mask."""

_DAMAGE = (
    ArithmeticError,
    LookupError,
    OSError,
    SyntaxError,
    TypeError,
    ValueError,
    Warning,
    struct.error,
)
"""Errors that Pillow raises on damaged directories; warnings where they are made errors."""

# A damaged directory is no news to somebody who opens a photograph: it counts as none.
warnings.filterwarnings("ignore", category=UserWarning, module=r"PIL\.TiffImagePlugin")


@dataclass(frozen=True, slots=True)
class Exif:
    """Orientation, camera, lens and date that a photograph states; None where it does not."""

    orientation: int = 1
    """1 upright, 2 to 4 mirrored or upside down, 5 to 8 with rows and columns exchanged."""
    make: str | None = None
    """Maker of the camera."""
    model: str | None = None
    """Model of the camera."""
    lens: str | None = None
    """Model of the lens."""
    focal_length_mm: float | None = None
    """Nominal focal length, mm."""
    date: datetime | None = None
    """Local time of the exposure, or of the last change of the file, with its fraction of a second
    if that is stated."""
    lens_maker: str | None = None
    """Maker of the lens."""
    equivalent_focal_length_mm: float | None = None
    """Focal length of the same field of view on a film of 36 mm x 24 mm, mm."""

    @property
    def is_of_camera(self) -> bool:
        """True if the file states a camera: programs that drop this may have turned the pixels."""
        return self.make is not None or self.model is not None


def read_exif(block: bytes) -> Exif:
    """Read an EXIF block; a damaged one counts as empty, as decoders take it."""
    try:
        return _read_tags(block)[1]
    except _DAMAGE:
        return Exif()


def read_tiff(data: bytes | mmap) -> tuple[Size, Exif, int]:
    """Read stored width and height, px, EXIF and number of pages of a TIFF or BigTIFF file.

    Pages of another size than the first one's are no photographs beside it, and do not count.

    Raises:
        ValueError: if its first directory is damaged or states no size.
    """
    try:
        tags, exif = _read_tags(data)
        width, height = tags.get(_Tag.WIDTH), tags.get(_Tag.HEIGHT)
    except _DAMAGE as error:
        raise ValueError("damaged directory") from error
    if not (isinstance(width, int) and isinstance(height, int)):
        raise ValueError("no size")
    return (width, height), exif, 1 + _count_further_pages(data, tags)


def is_raw_tiff(data: bytes | mmap) -> bool:
    """Return whether a TIFF is a camera's raw image: its first directory, which decoders read, is
    that of a preview, or it is a DNG."""
    try:
        first = _load_directory(data)
        is_preview = bool(first.get(_Tag.SUBFILE_TYPE, 0) & _SMALLER_COPY)
    except _DAMAGE:
        return False
    return is_preview or _Tag.DNG_VERSION in first or data[8:10] == b"CR"


def _count_further_pages(data: bytes | mmap, first: Any) -> int:
    """Count the pages behind the `first` directory of a TIFF that have its size."""
    count, offset, seen = 0, first.next, {0}
    while offset not in seen:  # a damaged chain may be a circle
        seen.add(offset)
        try:
            page = _load_directory(data, offset)
            is_page = not page.get(_Tag.SUBFILE_TYPE, 0) & _NO_PAGE
        except _DAMAGE:
            break
        count += is_page and all(
            page.get(tag) == first.get(tag) for tag in (_Tag.WIDTH, _Tag.HEIGHT)
        )
        offset = page.next
    return count


def _load_directory(data: bytes | mmap, offset: int | None = None, group: int | None = None) -> Any:
    """Load the directory at `offset` of a TIFF, the first one if None."""
    # It loads in 18 ms, which the window's start need not wait for.
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

    file: Any = io.BytesIO(data) if isinstance(data, bytes) else data
    head = data[:16] if data[2:4] in (b"+\0", b"\0+") else data[:8]
    directory = ImageFileDirectory_v2(head, group=group)
    file.seek(directory.next if offset is None else offset)
    directory.load(file)
    return directory


def _read_tags(data: bytes | mmap) -> tuple[Any, Exif]:
    """Read the first directory of a TIFF, and the EXIF in it and in the one it points to."""
    first = _load_directory(data)
    tags = {
        key: first.get(key)
        for key in (_Tag.MAKE, _Tag.MODEL, _Tag.ORIENTATION, _Tag.DATE_OF_CHANGE)
    }
    with contextlib.suppress(*_DAMAGE):  # absent or damaged: what the first directory says stands
        tags |= dict(_load_directory(data, first[_Tag.EXIF_DIRECTORY], _Tag.EXIF_DIRECTORY))
    orientation = tags[_Tag.ORIENTATION]
    return first, Exif(
        orientation if isinstance(orientation, int) and 1 <= orientation <= 8 else 1,
        _read_text(tags[_Tag.MAKE]),
        _read_text(tags[_Tag.MODEL]),
        _read_text(tags.get(_Tag.LENS_MODEL)),
        _read_length(tags.get(_Tag.FOCAL_LENGTH)),
        _read_date(tags.get(_Tag.DATE_OF_EXPOSURE), tags.get(_Tag.FRACTION_OF_EXPOSURE))
        or _read_date(tags[_Tag.DATE_OF_CHANGE], tags.get(_Tag.FRACTION_OF_CHANGE)),
        _read_text(tags.get(_Tag.LENS_MAKE)),
        _read_length(tags.get(_Tag.EQUIVALENT_FOCAL_LENGTH)),
    )


def _read_text(value: object) -> str | None:
    """Return a tag's text without padding; None if it is empty or no text."""
    return value.strip("\0 ") or None if isinstance(value, str) else None


def _read_length(value: Any) -> float | None:
    """Return a tag's length, mm; None if it is unknown, which EXIF states as 0."""
    try:
        length = float(value)
    except _DAMAGE:
        return None
    return length if 0 < length < float("inf") else None


def _read_date(value: object, fraction: object) -> datetime | None:
    """Return a tag's date with the digits of its fraction of a second, if there are any; None if it
    is unknown or damaged."""
    try:
        date = datetime.strptime(_read_text(value) or "", "%Y:%m:%d %H:%M:%S")
    except ValueError:
        return None
    digits = _read_text(fraction) or ""
    if not (digits.isascii() and digits.isdecimal()):
        return date
    return date.replace(microsecond=int(digits[:6].ljust(6, "0")))

"""Photographs are read as grey or colour arrays, and written, through any path.

OpenCV's imdecode, the same in 4.14 and 5.0, decodes the pixels. Three of its habits matter here:

* It returns nothing for most truncated files, where imread returns half an image. So only
  memory is decoded, and a JPEG, PNG or WebP without its end is refused beforehand.
* It honours the EXIF orientation of JPEG and PNG and that of most, not all, WebP files, and
  ignores it with a flag; that of TIFF it honours always. So the flag is given and the image
  turned here, except a TIFF.
* It leaves 16-bit samples as they are, in grey too, and drops transparency.
"""

from __future__ import annotations

import mmap
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Size
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import open_regular, read_regular, write_atomically
from calibgui.engine.images.fields import Field, keep_field
from calibgui.engine.images.headers import ForeignKind, Header, find_foreign_kind, read_header
from calibgui.engine.images.photo_libraries import (
    decode_photo,
    is_library_installed,
    read_photo_header,
)

Pixels = npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
PathLike = str | os.PathLike[str]

FORMATS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".pgm", ".ppm")
"""Suffixes of the image files that can be read and written."""
_DEEP_FORMATS = (".png", ".tif", ".tiff", ".pgm", ".ppm")
"""Suffixes of the formats that hold 16 bits a sample."""
MAX_PIXELS = 400_000_000
"""Number of pixels above which an image is refused: no camera has more, a damaged header may."""
_MAX_FILE_SIZE = 8 * MAX_PIXELS
"""Size of the largest files that are read, bytes: four samples of 16 bits a pixel."""
_PAGE = bytes(4096)
"""The fewest zeros that an interrupted copy leaves at the end of a file: systems write pages."""
_STRETCH_PERCENTILES = (0.5, 99.5)
"""Percentiles of 16-bit levels that become black and white for display and detection."""
_INVERSE = {6: 8, 8: 6}
"""EXIF orientations that another one takes back; each of the others takes back itself."""
_FORMAT_HINT = "Use PNG, JPEG, TIFF, BMP, WebP or PGM with 8 or 16 bits."
_HINTS = {
    ForeignKind.VIDEO: "What takes photographs to calibrate takes frames of a video as well; for "
    "anything else save frames of it as PNG: `calibgui detect VIDEO` does so.",
    ForeignKind.HEIF: "`pip install 'calibgui[photos]'` reads it. Or save it as JPEG or PNG first, "
    "and set the phone to the compatible format.",
    ForeignKind.RAW: "`pip install 'calibgui[photos]'` reads it. Or save it as JPEG or TIFF in "
    "full size first, without correcting the lens.",
}
_KINDS = {"HEIC": ForeignKind.HEIF, "raw": ForeignKind.RAW}
"""Kinds of the photographs that libraries read, by the format in their headers."""


@dataclass(frozen=True, eq=False, slots=True)
class Image:
    """A photograph in grey, upright."""

    pixels: Pixels
    """(h, w) uint8 or uint16 as stored, read-only: full precision, for corner work."""
    path: Path
    """File that was read."""
    orientation: int = 1
    """EXIF orientation by which `pixels` are turned, 1 to 8."""
    field: Field | None = None
    """The field of an interlaced frame that `pixels` show; None for all of its rows."""
    zero_tail: float = 0.0
    """Share of the file that is only zeros, at its end: black pixels, or a copy that was
    interrupted. 0 if it is shorter than a page of memory."""

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Pixels:
        """Return the pixels, so that functions of arrays take a photograph as it is."""
        return np.array(self.pixels, dtype=dtype, copy=copy)

    @property
    def size(self) -> Size:
        """Width and height, px."""
        return self.pixels.shape[1], self.pixels.shape[0]

    @property
    def depth(self) -> int:
        """Bits per sample, 8 or 16."""
        return 8 * self.pixels.itemsize

    @property
    def grey(self) -> npt.NDArray[np.uint8]:
        """(h, w) uint8, for display and detection; 16 bits are stretched to the image's range."""
        return stretch_levels(self.pixels)


def stretch_levels(pixels: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Return `pixels` in 8 bits: levels of other types between two percentiles become 0 to 255."""
    if pixels.dtype == np.uint8:
        return np.asarray(pixels, dtype=np.uint8)
    thin = max(1, int(np.sqrt(pixels.size / 1e6)))
    low, high = np.percentile(pixels[::thin, ::thin], _STRETCH_PERCENTILES)
    if pixels.dtype != np.uint16:
        levels = (pixels - low) * (255 / (high - low if high > low else 1.0))
        return np.clip(np.rint(levels), 0, 255).astype(np.uint8)
    levels = (np.arange(1 << 16) - low) * (255 / max(high - low, 1.0))
    return np.clip(np.rint(levels), 0, 255).astype(np.uint8)[pixels]


def read_image(path: PathLike, orientation: int | None = None, field: Field | None = None) -> Image:
    """Read a photograph in grey, turned upright.

    Args:
        path: the file.
        orientation: EXIF orientation by which the stored pixels are turned, 1 to 8; that which the
            file states if None.
        field: the field of an interlaced frame to read; all rows if None.

    Raises:
        CalibrationError: if `path` is missing, empty, no image, cut short, damaged or too
            large, has several pages, or neither 8 nor 16 bits a sample.

    Example:
        >>> import tempfile
        >>> import numpy as np
        >>> from calibgui.engine.images import read_image, write_image
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     write_image(f"{folder}/view.png", np.full((3, 4), 7, np.uint8))
        ...     image = read_image(f"{folder}/view.png")
        >>> image.size, image.depth, int(image.pixels[2, 3])
        ((4, 3), 8, 7)
    """
    pixels, header, zero_tail = _read_turned(Path(path), orientation, colour=False, field=field)
    pixels.flags.writeable = False
    return Image(pixels, Path(path), orientation or header.exif.orientation, field, zero_tail)


def read_colour(path: PathLike, orientation: int | None = None) -> Pixels:
    """Read a photograph as (h, w, 3) RGB, or as (h, w) if the file is grey, turned upright.

    `orientation` is as for `read_image`.

    Raises:
        CalibrationError: as `read_image`.
    """
    return _read_turned(Path(path), orientation, colour=True)[0]


def read_small_image(path: PathLike, least: int) -> tuple[Pixels, Header]:
    """Read a photograph in grey, turned upright, and its header.

    Args:
        path: the file.
        least: length of the longer side from which the image may be halved while it is read, px;
            it is no shorter than half of that then.

    Raises:
        CalibrationError: as `read_image`.
    """
    return _read_turned(Path(path), None, colour=False, least=least)[:2]


def read_image_size(path: PathLike) -> Size:
    """Read the width and height that `read_image` will deliver, px, without decoding the image.

    Raises:
        CalibrationError: if `path` is missing, empty, no image, too large or of several pages.
    """
    return read_image_header(path).size


def read_image_header(path: PathLike) -> Header:
    """Read the header of a photograph: format, size, orientation, camera, lens and date.

    Raises:
        CalibrationError: if `path` is missing, empty, no image, too large or of several pages.
    """
    path = Path(path)
    try:
        with open_regular(path) as file:
            if os.fstat(file.fileno()).st_size == 0:
                raise _make_empty_error(path)
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                return _read_checked_header(path, data)
    except OSError as error:
        raise _make_unreadable_error(path, error) from error


def is_video(path: PathLike) -> bool:
    """Return whether a file is a video, by its first bytes.

    Raises:
        CalibrationError: if `path` cannot be read.
    """
    try:
        with open_regular(path) as file:
            return find_foreign_kind(file.read(16)) is ForeignKind.VIDEO
    except OSError as error:
        raise _make_unreadable_error(Path(path), error) from error


def write_image(path: PathLike, pixels: Pixels) -> None:
    """Write (h, w) grey or (h, w, 3) RGB pixels in the format of the path's suffix, atomically.

    Raises:
        CalibrationError: if the format is unknown or cannot hold the pixels, or the disk
            refuses; an existing file is then as before.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    # OpenCV would clip deeper samples to 8 bits without a word.
    holds = suffix in {np.uint8: FORMATS, np.uint16: _DEEP_FORMATS}.get(pixels.dtype.type, ())
    content = opencv.encode_image(suffix, pixels) if holds else None
    if content is None:
        raise CalibrationError(
            f"{path} cannot be written: {suffix or 'a name without suffix'} does not hold "
            f"{'colour' if pixels.ndim == 3 else 'grey'} {pixels.dtype} pixels.",
            "Choose a name that ends in .png or .tif.",
        )
    write_atomically(path, content)


def _read_turned(
    path: Path,
    orientation: int | None,
    colour: bool,
    field: Field | None = None,
    least: int | None = None,
) -> tuple[Pixels, Header, float]:
    """Read the pixels of the image file `path`, turned, its header, and `Image.zero_tail`."""
    try:
        data = read_regular(path, _MAX_FILE_SIZE)
    except OSError as error:
        raise _make_unreadable_error(path, error) from error
    if not data:
        raise _make_empty_error(path)
    header = _read_checked_header(path, data)
    pixels = _decode(data, header, colour, least) if header.is_complete else None
    if pixels is None:
        raise CalibrationError(
            f"{path} cannot be decoded: the {header.format} image is cut short, damaged, or packed "
            "in a rare way.",
            "Copy it from the camera again, or save it as PNG.",
        )
    if pixels.dtype not in (np.uint8, np.uint16):
        raise CalibrationError(f"{path} holds {pixels.dtype} samples.", _FORMAT_HINT)
    if field is not None:
        pixels = keep_field(pixels, field)
    stated = header.exif.orientation
    if header.format not in ("TIFF", "HEIC"):
        pixels = _turn(pixels, orientation or stated)
    elif orientation is not None:  # its decoder has turned it
        pixels = _turn(_turn(pixels, _INVERSE.get(stated, stated)), orientation)
    zeros = len(data) - len(data.rstrip(b"\0")) if data.endswith(_PAGE) else 0
    return np.ascontiguousarray(pixels), header, zeros / len(data)


def _decode(data: bytes, header: Header, colour: bool, least: int | None) -> Any:
    """Return the pixels of an image file, smaller if that is quick; None if it is damaged."""
    if least is not None and header.format == "JPEG":
        longer = max(header.size)
        times = max((each for each in (2, 4, 8) if 2 * longer >= each * least), default=None)
        if times is not None:
            return opencv.decode_small(data, times)
    kind = _KINDS.get(header.format)
    return decode_photo(kind, data, colour) if kind else opencv.decode_image(data, colour)


def mirror_orientation(orientation: int) -> int:
    """Return the EXIF orientation whose image is that of another one with left and right exchanged.

    Example:
        >>> from calibgui.engine.images import mirror_orientation
        >>> [mirror_orientation(each) for each in range(1, 9)]
        [2, 1, 4, 3, 6, 5, 8, 7]
    """
    return (orientation - 1 ^ 1) + 1


def _turn(pixels: Pixels, orientation: int) -> Pixels:
    """Return `pixels` turned as EXIF says: transposed from 5 on, then mirrored along u or v."""
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return pixels


def _read_checked_header(path: Path, data: bytes | mmap.mmap) -> Header:
    """Read the header of `data`; refuse an unknown format, an impossible size, several pages."""
    header = read_header(data)
    if header is None:
        kind = find_foreign_kind(data)
        header = read_photo_header(kind, data) if kind and is_library_installed(kind) else None
        if kind is not None and header is None:
            raise CalibrationError(f"{path} is {kind.value}.", _HINTS[kind])
    if header is None:
        raise CalibrationError(
            f"{path} is not an image of a known format, or cut short.", _FORMAT_HINT
        )
    width, height = header.size
    if not 0 < width * height <= MAX_PIXELS:
        raise CalibrationError(
            f"{path} declares {width} x {height} pixels.",
            f"Use images of 1 to {MAX_PIXELS // 1_000_000} million pixels.",
        )
    if header.pages > 1:
        raise CalibrationError(
            f"{path} holds {header.pages} images, and only files of one image are read.",
            "Save each page of it as a file of its own: 'magick stack.tif page%03d.tif' does so.",
        )
    return header


def _make_empty_error(path: Path) -> CalibrationError:
    return CalibrationError(f"{path} is empty.", "Copy it from the camera again.")


def _make_unreadable_error(path: Path, error: OSError) -> CalibrationError:
    return CalibrationError(
        f"{path} cannot be read: {error.strerror or error}.",
        "Check the name and that you may read it.",
    )

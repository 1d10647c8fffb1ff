"""Photographs as grey arrays, read and written through any path.

What OpenCV's imdecode does, the same in 4.14 and 5.0, and what this module makes of it:

* It returns nothing for most truncated files, where imread returns half an image. Only
  memory is decoded here, and a JPEG, PNG or WebP without its end is refused beforehand.
* It honours the EXIF orientation of JPEG and PNG and that of most, not all, WebP files, and
  ignores it with a flag; that of TIFF it honours always. So the flag is given and the image
  turned here, except a TIFF.
* 16-bit samples stay as they are, in grey too. Transparency is dropped: a photograph has none.
"""

from __future__ import annotations

import mmap
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Size
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.images.headers import Header, read_header

Pixels = npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
PathLike = str | os.PathLike[str]

FORMATS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".pgm", ".ppm")
"""Suffixes of the image files that can be read and written."""
_DEEP = (".png", ".tif", ".tiff", ".pgm", ".ppm")
"""Those of them that hold 16 bits a sample."""
MAX_PIXELS = 400_000_000
"""Images above this are refused: larger than any camera's, or a damaged header."""
_STRETCH = (0.5, 99.5)
"""Percentiles of a 16-bit image that become black and white for display and detection."""
_KNOWN = "Use PNG, JPEG, TIFF, BMP, WebP or PGM with 8 or 16 bits."


@dataclass(frozen=True, eq=False, slots=True)
class Image:
    """A photograph in grey, upright."""

    pixels: Pixels
    """(h, w) uint8 or uint16 as stored, read-only: full precision, for corner work."""
    path: Path
    orientation: int = 1
    """EXIF orientation as found in the file, 1 to 8; `pixels` are upright already."""

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
        return stretched(self.pixels)


def stretched(pixels: Pixels) -> npt.NDArray[np.uint8]:
    """`pixels` in 8 bits: 16-bit levels between two percentiles become 0 to 255."""
    if pixels.dtype == np.uint8:
        return np.asarray(pixels, dtype=np.uint8)
    thin = max(1, int(np.sqrt(pixels.size / 1e6)))
    low, high = np.percentile(pixels[::thin, ::thin], _STRETCH)
    levels = (np.arange(1 << 16) - low) * (255 / max(high - low, 1.0))
    return np.clip(np.rint(levels), 0, 255).astype(np.uint8)[pixels]


def read_image(path: PathLike) -> Image:
    """Read a photograph in grey.

    Raises:
        CalibrationError: if `path` is missing, empty, no image, cut short, damaged or too
            large, or has neither 8 nor 16 bits a sample.
    """
    pixels, header = _decode(Path(path), colour=False)
    pixels.flags.writeable = False
    return Image(pixels, Path(path), header.orientation)


def read_colour(path: PathLike) -> Pixels:
    """(h, w, 3) RGB, or (h, w) if the file is grey: upright. Raises as `read_image`."""
    return _decode(Path(path), colour=True)[0]


def image_size(path: PathLike) -> Size:
    """Width and height that `read_image` will deliver, from the file's header alone.

    Raises:
        CalibrationError: if `path` is missing, empty, no image or too large.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            if os.fstat(file.fileno()).st_size == 0:
                raise _empty(path)
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                return _header(path, data).size
    except OSError as error:
        raise _unreadable(path, error) from error


def write_image(path: PathLike, pixels: Pixels) -> None:
    """Write (h, w) grey or (h, w, 3) RGB pixels in the format of the path's suffix, atomically.

    Raises:
        CalibrationError: if the format is unknown or cannot hold the pixels, or the disk
            refuses; an existing file is then as before.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    # OpenCV would clip deeper samples to 8 bits without a word.
    holds = suffix in {np.uint8: FORMATS, np.uint16: _DEEP}.get(pixels.dtype.type, ())
    content = opencv.encode(suffix, pixels) if holds else None
    if content is None:
        raise CalibrationError(
            f"{path} cannot be written: {suffix or 'a name without suffix'} does not hold "
            f"{'colour' if pixels.ndim == 3 else 'grey'} {pixels.dtype} pixels.",
            "Choose a name that ends in .png or .tif.",
        )
    write_atomically(path, content)


def _decode(path: Path, colour: bool) -> tuple[Pixels, Header]:
    """Pixels, upright, of the image file `path`, and its header."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise _unreadable(path, error) from error
    if not data:
        raise _empty(path)
    header = _header(path, data)
    pixels = opencv.decode(data, colour) if header.complete else None
    if pixels is None:
        raise CalibrationError(
            f"{path} cannot be decoded: the {header.format} image is cut short, damaged, or packed "
            "in a rare way.",
            "Copy it from the camera again, or save it as PNG.",
        )
    if pixels.dtype not in (np.uint8, np.uint16):
        raise CalibrationError(f"{path} holds {pixels.dtype} samples.", _KNOWN)
    if header.format != "TIFF":
        pixels = _upright(pixels, header.orientation)
    return np.ascontiguousarray(pixels), header


def _upright(pixels: Pixels, orientation: int) -> Pixels:
    """`pixels` turned as EXIF says: transposed from 5 on, then mirrored along u or v."""
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return pixels


def _header(path: Path, data: bytes | mmap.mmap) -> Header:
    header = read_header(data)
    if header is None:
        raise CalibrationError(f"{path} is not an image of a known format, or cut short.", _KNOWN)
    width, height = header.size
    if not 0 < width * height <= MAX_PIXELS:
        raise CalibrationError(
            f"{path} declares {width} x {height} pixels.",
            f"Use images of 1 to {MAX_PIXELS // 1_000_000} million pixels.",
        )
    return header


def _empty(path: Path) -> CalibrationError:
    return CalibrationError(f"{path} is empty.", "Copy it from the camera again.")


def _unreadable(path: Path, error: OSError) -> CalibrationError:
    return CalibrationError(
        f"{path} cannot be read: {error.strerror or error}.",
        "Check the name and that you may read it.",
    )

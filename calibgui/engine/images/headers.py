"""The header of an image file: what it says of itself before its pixels are decoded.

Size and orientation are needed before the pixels are: to list a folder quickly, to refuse
what would not fit in memory, and to tell a damaged image from a file that is none.

The containers are walked here, their EXIF is read by Pillow (``exif.py``). Pillow opens
containers too, but does not serve here: it notices a truncated file only when it decodes it,
and so with an eXIf chunk behind a PNG's pixels; it creates a WebP's decoder, with its canvas, to
learn the size; it refuses TIFF samples that OpenCV reads; and its limit of 179 million pixels
is raised only for the whole process. Camera raw formats and HEIC are read by libraries that may be
installed (``photo_libraries.py``).
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from enum import Enum
from mmap import mmap

from calibgui.engine.arrays import Size
from calibgui.engine.images.exif import Exif, is_raw_tiff, read_exif, read_tiff

Data = bytes | mmap

_NO_EXIF = Exif()
_ZEROS = bytes(64)
"""Compressed pixels do not end in so many zeros, unless a copy was interrupted."""


class ForeignKind(Enum):
    """Kinds of files that people take for photographs, and that are not read without more."""

    VIDEO = "a video"
    HEIF = "a HEIC or AVIF image, which cannot be read here"
    RAW = "a camera's raw image, which cannot be read here"


_TIFF = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_RAW = (b"FUJIFILMCCD-RAW", b"IIRO", b"IIRS", b"MMOR", b"IIU\0")
"""First bytes of TIFF, and of raw images of Fujifilm, Olympus and Panasonic."""


def find_foreign_kind(data: Data) -> ForeignKind | None:
    """Find out what a file is that is no image; None if that is not known."""
    start = bytes(data[:16])
    if start.startswith(_RAW) or start[4:12] == b"ftypcrx " or _is_raw(data):
        return ForeignKind.RAW
    if start[4:8] == b"ftyp":
        is_image = start[8:12] in (b"heic", b"heix", b"mif1", b"msf1", b"avif")
        return ForeignKind.HEIF if is_image else ForeignKind.VIDEO
    is_video = start[8:12] == b"AVI " or start.startswith((b"\x1aE\xdf\xa3", b"\0\0\1\xba"))
    return ForeignKind.VIDEO if is_video else None


def _is_raw(data: Data) -> bool:
    """Return whether a file is a TIFF that holds a camera's raw image."""
    return bytes(data[:4]) in _TIFF and is_raw_tiff(data)


@dataclass(frozen=True, slots=True)
class Header:
    """Format, stored size and EXIF of an image file."""

    format: str
    """Name of the format: JPEG, PNG, WebP, TIFF, BMP, PNM, HEIC or raw."""
    stored: Size
    """Width and height as stored, px."""
    exif: Exif = _NO_EXIF
    """Orientation, camera, lens and date as the file states them."""
    is_complete: bool = True
    """False if the file is known to end before its image does."""
    pages: int = 1
    """Number of images of this size in the file, of which only a TIFF may hold several."""

    @property
    def size(self) -> Size:
        """Width and height upright, px."""
        return self.turned_size(self.exif.orientation)

    def turned_size(self, orientation: int) -> Size:
        """Return width and height turned by an EXIF orientation, px."""
        return self.stored if orientation < 5 else self.stored[::-1]


def read_header(data: Data) -> Header | None:
    """Return the header of the image file whose content is `data`; None if its format is unknown.

    The result is None for a file that ends within its header, too.
    """
    for magic, parse in _PARSERS:
        if re.match(magic, data[:16], re.DOTALL):
            try:
                return parse(data)
            except (struct.error, LookupError, ValueError):
                return None  # the file ends within its header
    return None


def _parse_jpeg(data: Data) -> Header:
    """Read the segments up to the scan, where the compressed data begin."""
    exif, stored, at = _NO_EXIF, None, 2
    while True:
        marker, length = struct.unpack_from(">HH", data, at)
        if marker < 0xFF00:
            raise ValueError("no marker where one must be")
        body = data[at + 4 : at + 2 + length]
        if marker == 0xFFE1 and body.startswith(b"Exif\0\0"):
            exif = read_exif(body[6:])
        elif 0xFFC0 <= marker <= 0xFFCF and marker not in (0xFFC4, 0xFFC8, 0xFFCC):
            height, width = struct.unpack_from(">HH", body, 1)
            stored = (width, height)
        elif marker == 0xFFDA:  # start of scan
            break
        at += 2 + length
    if stored is None:
        raise ValueError("no frame before the scan")
    # Compressed data cannot contain FFD9, the end of the image.
    return Header("JPEG", stored, exif, data.find(b"\xff\xd9", at) >= 0)


def _parse_png(data: Data) -> Header:
    """Read the chunks up to the one that ends the file."""
    width, height = struct.unpack_from(">II", data, 16)
    exif, at, name = _NO_EXIF, 8, b""
    while name != b"IEND" and at + 12 <= len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        if name == b"eXIf":
            exif = read_exif(data[at + 8 : at + 8 + length])
        at += 12 + length
    return Header("PNG", (width, height), exif, name == b"IEND" and at <= len(data))


def _parse_webp(data: Data) -> Header:
    """Read the chunks; the size of VP8X is that of the canvas, which all others lie in."""
    stored, exif, at, is_whole = None, _NO_EXIF, 12, True
    while at + 8 <= len(data):
        name, length = struct.unpack_from("<4sI", data, at)
        at += 8
        if name == b"VP8X":
            stored = tuple(int.from_bytes(data[at + i : at + i + 3], "little") + 1 for i in (4, 7))
        elif name == b"VP8L" and stored is None:
            bits = struct.unpack_from("<I", data, at + 1)[0]
            stored = ((bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1)
        elif name == b"VP8 " and stored is None:
            stored = tuple(n & 0x3FFF for n in struct.unpack_from("<HH", data, at + 6))
        elif name == b"EXIF":
            exif = read_exif(data[at : at + length].removeprefix(b"Exif\0\0"))
        if name in (b"VP8 ", b"VP8L"):  # which the decoder takes for an image all the same
            is_whole = not data[at : at + length].endswith(_ZEROS)
        at += length + length % 2  # RIFF pads to even lengths
    if stored is None:
        raise ValueError("no picture")
    declared = struct.unpack_from("<I", data, 4)[0] + 8
    return Header("WebP", (stored[0], stored[1]), exif, is_whole and len(data) >= declared)


def _parse_bmp(data: Data) -> Header:
    width, height = struct.unpack_from("<ii", data, 18)
    return Header("BMP", (width, abs(height)))


def _parse_pnm(data: Data) -> Header:
    # Magic, width and height, apart by blanks and comments.
    blank = rb"(?:\s|#[^\n]*\n)+"
    match = re.match(rb"P[1-6]" + blank + rb"(\d+)" + blank + rb"(\d+)", data[:4096])
    if match is None:
        raise ValueError("no size")
    return Header("PNM", (int(match[1]), int(match[2])))


def _parse_tiff(data: Data) -> Header:
    if is_raw_tiff(data):
        raise ValueError("a preview, not the photograph")
    stored, exif, pages = read_tiff(data)
    return Header("TIFF", stored, exif, pages=pages)


_PARSERS = (
    (rb"\xff\xd8\xff", _parse_jpeg),
    (rb"\x89PNG\r\n\x1a\n", _parse_png),
    (rb"RIFF....WEBP", _parse_webp),
    (rb"II[*+]\0|MM\0[*+]", _parse_tiff),
    (rb"BM", _parse_bmp),
    (rb"P[1-6]\s", _parse_pnm),
)
"""Regular expression of the first bytes of each format, and the function that parses it."""

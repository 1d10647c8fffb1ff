"""What an image file says about itself in its first bytes, without decoding it.

Size and orientation are needed before the pixels are: to list a folder quickly, to refuse
what would not fit in memory, and to tell a damaged image from a file that is none.

Orientation is the TIFF/EXIF tag 0x0112: 1 upright, 2 to 4 mirrored or upside down, 5 to 8
with rows and columns exchanged. EXIF is itself a small TIFF, held in a JPEG's APP1 segment, a
PNG's eXIf or a WebP's EXIF chunk.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from mmap import mmap

from calibgui.engine.arrays import Size

Data = bytes | mmap

_ORIENTATION = 0x0112
_INTEGERS = {3: "H", 4: "I", 16: "Q"}
"""TIFF's types of unsigned integers."""


@dataclass(frozen=True, slots=True)
class Header:
    """Format, stored size and orientation of an image file."""

    format: str
    stored: Size
    """Width and height as stored, px."""
    orientation: int = 1
    """EXIF orientation, 1 to 8, as found."""
    complete: bool = True
    """False if the file is known to end before its image does."""

    @property
    def size(self) -> Size:
        """Width and height upright, px."""
        return self.stored if self.orientation < 5 else self.stored[::-1]


def read_header(data: Data) -> Header | None:
    """Header of the image file whose content is `data`; None if it is of no known format."""
    for magic, parse in _PARSERS:
        if re.match(magic, data[:16], re.DOTALL):
            try:
                return parse(data)
            except (struct.error, LookupError, ValueError):
                return None  # the file ends within its header
    return None


def _jpeg(data: Data) -> Header:
    orientation, stored, at = 1, None, 2
    while True:
        marker, length = struct.unpack_from(">HH", data, at)
        if marker < 0xFF00:
            raise ValueError("no marker where one must be")
        body = data[at + 4 : at + 2 + length]
        if marker == 0xFFE1 and body.startswith(b"Exif\0\0"):
            orientation = _exif(body[6:])
        elif 0xFFC0 <= marker <= 0xFFCF and marker not in (0xFFC4, 0xFFC8, 0xFFCC):
            height, width = struct.unpack_from(">HH", body, 1)
            stored = (width, height)
        elif marker == 0xFFDA:  # start of scan
            break
        at += 2 + length
    if stored is None:
        raise ValueError("no frame before the scan")
    # Compressed data cannot contain FFD9, the end of the image.
    return Header("JPEG", stored, orientation, data.find(b"\xff\xd9", at) >= 0)


def _png(data: Data) -> Header:
    width, height = struct.unpack_from(">II", data, 16)
    orientation, at, name = 1, 8, b""
    while name != b"IEND" and at + 12 <= len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        if name == b"eXIf":
            orientation = _exif(data[at + 8 : at + 8 + length])
        at += 12 + length
    return Header("PNG", (width, height), orientation, name == b"IEND" and at <= len(data))


def _webp(data: Data) -> Header:
    stored, orientation, at = None, 1, 12
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
            orientation = _exif(data[at : at + length].removeprefix(b"Exif\0\0"))
        at += length + length % 2  # RIFF pads to even lengths
    if stored is None:
        raise ValueError("no picture")
    declared = struct.unpack_from("<I", data, 4)[0] + 8
    return Header("WebP", (stored[0], stored[1]), orientation, len(data) >= declared)


def _bmp(data: Data) -> Header:
    width, height = struct.unpack_from("<ii", data, 18)
    return Header("BMP", (width, abs(height)))


def _pnm(data: Data) -> Header:
    # Magic, width and height, apart by blanks and comments.
    blank = rb"(?:\s|#[^\n]*\n)+"
    match = re.match(rb"P[1-6]" + blank + rb"(\d+)" + blank + rb"(\d+)", data[:4096])
    if match is None:
        raise ValueError("no size")
    return Header("PNM", (int(match[1]), int(match[2])))


def _tiff(data: Data) -> Header:
    tags = _tags(data)
    return Header("TIFF", (tags[256], tags[257]), _orientation(tags))


def _exif(data: bytes) -> int:
    """Orientation in an EXIF block; 1 if it is damaged, as decoders take it."""
    try:
        return _orientation(_tags(data))
    except (struct.error, KeyError):
        return 1


def _orientation(tags: dict[int, int]) -> int:
    value = tags.get(_ORIENTATION, 1)
    return value if 1 <= value <= 8 else 1


def _tags(data: Data) -> dict[int, int]:
    """First value of each 16-, 32- or 64-bit tag in the first directory of a TIFF or BigTIFF."""
    order = {b"II": "<", b"MM": ">"}.get(data[:2], "<")
    big = struct.unpack_from(order + "H", data, 2)[0] == 43
    # Width of offsets, of the number of tags, of a tag, and where a tag holds its value.
    offset, number, width, value = ("Q", "Q", 20, 12) if big else ("I", "H", 12, 8)
    start = struct.unpack_from(order + offset, data, 8 if big else 4)[0]
    count = struct.unpack_from(order + number, data, start)[0]
    first = start + struct.calcsize(number)
    tags = {}
    for at in range(first, first + width * count, width):
        tag, kind = struct.unpack_from(order + "HH", data, at)
        if kind in _INTEGERS:
            tags[tag] = struct.unpack_from(order + _INTEGERS[kind], data, at + value)[0]
    return tags


_PARSERS = (
    (rb"\xff\xd8\xff", _jpeg),
    (rb"\x89PNG\r\n\x1a\n", _png),
    (rb"RIFF....WEBP", _webp),
    (rb"II[*+]\0|MM\0[*+]", _tiff),
    (rb"BM", _bmp),
    (rb"P[1-6]\s", _pnm),
)

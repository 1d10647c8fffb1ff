"""Headers of files that Pillow writes."""

from __future__ import annotations

import io
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as Pillow

from calibgui.engine.images.headers import read_header

WRITTEN = {
    "JPEG": {},
    "PNG": {},
    "TIFF": {},
    "BMP": {},
    "WebP": {"lossless": True},
    "PNM": {"format": "PPM"},
}


def content(name: str, size: tuple[int, int], orientation: int = 1, **options: object) -> bytes:
    """A file of the format `name`, with its EXIF orientation unless that is 1."""
    picture = Pillow.fromarray(np.arange(size[0] * size[1], dtype=np.uint8).reshape(size[::-1]))
    if orientation != 1:
        exif = Pillow.Exif()
        exif[0x0112] = orientation
        options["exif"] = exif
    stream = io.BytesIO()
    picture.save(stream, **{"format": name, **WRITTEN[name], **options})
    return stream.getvalue()


@pytest.mark.parametrize("name", WRITTEN)
def test_format_and_size(name: str) -> None:
    header = read_header(content(name, (17, 9)))
    assert header is not None
    assert (header.format, header.stored, header.size) == (name, (17, 9), (17, 9))
    assert (header.exif.orientation, header.is_complete) == (1, True)


@pytest.mark.parametrize("name", ["JPEG", "PNG", "TIFF", "WebP"])
@pytest.mark.parametrize("orientation", range(2, 9))
def test_orientation(name: str, orientation: int) -> None:
    header = read_header(content(name, (17, 9), orientation))
    assert header is not None
    assert (header.exif.orientation, header.stored) == (orientation, (17, 9))
    assert header.size == ((17, 9) if orientation < 5 else (9, 17))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("JPEG", {"progressive": True}),
        ("WebP", {"lossless": False}),
        ("TIFF", {"compression": "tiff_lzw"}),
        ("TIFF", {"big_tiff": True}),
    ],
)
def test_other_encodings(name: str, options: dict[str, object]) -> None:
    header = read_header(content(name, (33, 20), **options))
    assert header is not None
    assert (header.size, header.is_complete) == ((33, 20), True)


@pytest.mark.parametrize(
    ("sizes", "types", "count"),
    [
        ([(33, 20)], [0], 1),
        ([(33, 20)] * 3, [0, 0, 0], 3),
        ([(33, 20)] * 3, [0, 2, 4], 2),  # the last one is a mask
        ([(33, 20), (16, 10)], [0, 0], 1),
    ],
)
@pytest.mark.parametrize("big", [False, True])
def test_pages(sizes: list[tuple[int, int]], types: list[int], count: int, big: bool) -> None:
    pages = [Pillow.new("L", size) for size in sizes]
    for page, kind in zip(pages, types, strict=True):
        page.encoderinfo = {"tiffinfo": {254: kind}}
    stream = io.BytesIO()
    pages[0].save(stream, "TIFF", save_all=True, append_images=pages[1:], big_tiff=big)
    header = read_header(stream.getvalue())
    assert header is not None
    assert (header.size, header.pages) == ((33, 20), count)


def test_pages_in_a_circle_end() -> None:
    stream = io.BytesIO()
    page = Pillow.new("L", (33, 20))
    page.save(stream, "TIFF", save_all=True, append_images=[page])
    whole = bytearray(stream.getvalue())
    first = int.from_bytes(whole[4:8], "little")
    link = first + 2 + 12 * int.from_bytes(whole[first : first + 2], "little")
    second = int.from_bytes(whole[link : link + 4], "little")
    link = second + 2 + 12 * int.from_bytes(whole[second : second + 2], "little")
    assert whole[link : link + 4] == bytes(4)
    whole[link : link + 4] = second.to_bytes(4, "little")
    header = read_header(bytes(whole))
    assert header is not None
    assert header.pages == 2


def test_a_comment_in_a_pgm() -> None:
    header = read_header(b"P5\n# made by hand 99 99\n12 # width\n 7\n255\n")
    assert header is not None
    assert header.size == (12, 7)


def test_webp_exif_with_the_jpeg_prefix() -> None:
    plain = content("WebP", (17, 9), 6)
    at = plain.index(b"EXIF") + 4
    length = struct.unpack_from("<I", plain, at)[0]
    exif = b"Exif\0\0" + plain[at + 4 : at + 4 + length]
    header = read_header(plain[:at] + struct.pack("<I", len(exif)) + exif)
    assert header is not None
    assert header.exif.orientation == 6


@pytest.mark.parametrize("name", ["JPEG", "PNG", "WebP"])
@pytest.mark.parametrize("kept", [0.5, 0.9, 0.99])
def test_a_truncated_file_is_known_incomplete(name: str, kept: float) -> None:
    data = content(name, (200, 90))
    header = read_header(data[: int(kept * len(data))])
    assert header is not None
    assert not header.is_complete


def test_a_thumbnail_does_not_complete_a_jpeg() -> None:
    thumbnail = content("JPEG", (16, 8))
    empty_tiff = struct.pack("<2sHIH", b"II", 42, 8, 0)
    whole = content("JPEG", (200, 90), exif=b"Exif\0\0" + empty_tiff + thumbnail)
    assert b"\xff\xd9" in whole[:-2]
    header = read_header(whole[:-100])
    assert header is not None
    assert not header.is_complete


@given(st.sampled_from(sorted(WRITTEN)), st.data())
def test_damage_never_raises(name: str, data: st.DataObject) -> None:
    whole = content(name, (17, 9), 6 if name != "BMP" and name != "PNM" else 1)
    damaged = bytearray(whole[: data.draw(st.integers(0, len(whole)))])
    for at, value in data.draw(st.lists(st.tuples(st.integers(0, 99), st.integers(0, 255)))):
        if at < len(damaged):
            damaged[at] = value
    header = read_header(bytes(damaged))
    assert header is None or 1 <= header.exif.orientation <= 8


@given(st.binary(max_size=200))
def test_other_files_are_no_images(data: bytes) -> None:
    assert read_header(b"?" + data) is None

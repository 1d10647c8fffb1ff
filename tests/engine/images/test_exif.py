"""EXIF against blocks that Pillow writes, whole and damaged."""

from __future__ import annotations

import io
import warnings
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as Pillow
from PIL.TiffImagePlugin import IFDRational

from calibgui.engine.images.exif import Exif, read_exif, read_tiff
from calibgui.engine.images.headers import read_header

FULL = Exif(
    orientation=6,
    make="Nikon",
    model="D800",
    lens="50 mm f/1.8",
    focal_length_mm=50.5,
    date=datetime(2024, 2, 29, 13, 37, 5),
)
POINTER = 0x8769


def write_exif(first: dict[int, object], second: dict[int, object]) -> Pillow.Exif:
    exif = Pillow.Exif()
    exif.update(first)
    exif.get_ifd(POINTER).update(second)
    return exif


def full() -> Pillow.Exif:
    return write_exif(
        {0x010F: "Nikon\0\0", 0x0110: "D800 ", 0x0112: 6, 0x0132: "2025:01:01 00:00:00"},
        {
            0x9003: "2024:02:29 13:37:05",
            0x920A: IFDRational(101, 2),
            0xA434: "50 mm f/1.8",
        },
    )


def block(exif: Pillow.Exif) -> bytes:
    return exif.tobytes().removeprefix(b"Exif\0\0")


@pytest.mark.parametrize("name", ["JPEG", "PNG", "WebP", "TIFF"])
def test_camera_lens_and_date_are_read(name: str) -> None:
    stream = io.BytesIO()
    Pillow.fromarray(np.zeros((9, 17), np.uint8)).save(stream, name, exif=full().tobytes())
    header = read_header(stream.getvalue())
    assert header is not None
    assert header.exif == FULL


def test_a_photograph_without_exif_states_nothing() -> None:
    stream = io.BytesIO()
    Pillow.fromarray(np.zeros((9, 17), np.uint8)).save(stream, "JPEG")
    header = read_header(stream.getvalue())
    assert header is not None
    assert header.exif == Exif(1, None, None, None, None, None)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({0x0112: 0}, {}),
        ({0x0112: 9}, {}),
        ({0x010F: "\0"}, {0xA434: "  "}),
        ({0x0132: "    :  :     :  :  "}, {0x9003: "yesterday"}),
        ({}, {0x920A: IFDRational(0, 1), 0xA405: 0}),
        ({}, {0x920A: IFDRational(1, 0)}),
    ],
)
def test_unknown_values_are_absent(first: dict[int, object], second: dict[int, object]) -> None:
    assert read_exif(block(write_exif(first, second))) == Exif()


def test_the_date_of_a_file_stands_in_for_that_of_the_exposure() -> None:
    exif = read_exif(block(write_exif({0x0132: "2025:01:01 00:00:00"}, {})))
    assert exif.date == datetime(2025, 1, 1)


def test_a_lost_second_directory_leaves_the_first() -> None:
    whole = block(full())
    at = int.from_bytes(whole[whole.index(b"\x87\x69") + 8 :][:4], "big")  # value of the pointer
    # Pillow stores the second directory before the first one's long values: it is blanked.
    whole = whole[:at] + bytes(2) + whole[at + 2 :]
    read = read_exif(whole)
    assert (read.orientation, read.make, read.model, read.lens) == (6, "Nikon", "D800", None)


@pytest.mark.parametrize("content", [b"", b"II*\0", b"no TIFF at all", b"II*\0\xff\xff\xff\xff"])
def test_a_damaged_block_counts_as_empty(content: bytes) -> None:
    assert read_exif(content) == Exif()
    with pytest.raises(ValueError, match=r"damaged|no size"):
        read_tiff(content)


@pytest.mark.parametrize("action", ["error", "ignore"])
@given(st.data())
def test_damage_never_raises(action: str, data: st.DataObject) -> None:
    damaged = bytearray(block(full()))
    places = st.tuples(st.integers(0, len(damaged) - 1), st.integers(0, 255))
    for at, value in data.draw(st.lists(places, max_size=6)):
        damaged[at] = value
    with warnings.catch_warnings():
        warnings.simplefilter(action)
        assert 1 <= read_exif(bytes(damaged)).orientation <= 8


@pytest.mark.data
def test_a_phone_photograph(data_dir: Path) -> None:
    header = read_header(next((data_dir / "phone_iphonex").glob("*.[jJ]*")).read_bytes())
    assert header is not None
    exif = header.exif
    assert (exif.make, exif.model, exif.lens) == (
        "Apple",
        "iPhone X",
        "iPhone X back dual camera 4mm f/1.8",
    )
    assert exif.focal_length_mm == 4.0
    assert exif.date is not None
    assert exif.date.year == 2023


@pytest.mark.parametrize(
    ("fraction", "microseconds"), [("25", 250000), ("0071234", 7123), ("x", 0), ("", 0)]
)
def test_a_fraction_of_a_second_is_of_the_date(fraction: str, microseconds: int) -> None:
    exif = block(write_exif({}, {36867: "2026:03:01 10:20:30", 37521: fraction}))
    assert read_exif(exif).date == datetime(2026, 3, 1, 10, 20, 30, microseconds)

"""HEIC and raw photographs, where the libraries of the extra `photos` are installed."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.photographs.paths import describe_unread_photographs, find_images
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import (
    photo_libraries,
    read_colour,
    read_image,
    read_image_header,
    write_image,
)
from calibgui.engine.images.headers import ForeignKind
from calibgui.engine.images.photo_libraries import decode_photo

_RAMP = np.add.outer(np.arange(48) * 2, np.arange(64)).astype(np.uint8) + 30
"""Grey levels (48, 64) that differ along rows and columns."""


@pytest.fixture
def heic(tmp_path: Path) -> Path:
    """A photograph of a phone that was held upright, as it writes it."""
    pillow_heif = pytest.importorskip("pillow_heif")
    from PIL import Image

    exif = Image.Exif()
    exif[271], exif[272], exif[274] = "Maker", "Phone 1", 6
    image = Image.fromarray(np.dstack([_RAMP] * 3))
    pillow_heif.register_heif_opener()
    image.save(tmp_path / "a.heic", quality=-1, exif=exif.tobytes())
    return tmp_path / "a.heic"


def test_a_phones_photograph_is_read_upright(heic: Path) -> None:
    """The encoder keeps the turn as the file's own, which the decoder applies."""
    header = read_image_header(heic)
    assert (header.format, header.stored, header.size) == ("HEIC", (64, 48), (48, 64))
    assert (header.exif.make, header.exif.model, header.exif.orientation) == ("Maker", "Phone 1", 6)
    upright = np.rot90(_RAMP, -1).astype(int)
    image = read_image(heic)
    assert image.size == (48, 64)
    assert np.abs(image.pixels - upright).max() <= 3
    assert np.abs(read_colour(heic)[..., 2] - upright).max() <= 3
    assert np.abs(read_image(heic, orientation=1).pixels - _RAMP.astype(int)).max() <= 3


def _write_dng(file: Path, cells: np.ndarray) -> None:
    """Write a raw image (h, w) of 16 bits with a Bayer pattern of red at its first cell."""
    height, width = cells.shape
    identity = [v for k in range(9) for v in (int(k % 4 == 0), 1)]
    entries = [
        (254, 4, [0]), (256, 4, [width]), (257, 4, [height]), (258, 3, [16]), (259, 3, [1]),
        (262, 3, [32803]), (271, 2, b"Maker\0"), (272, 2, b"Camera 1\0"), (273, 4, [8]),
        (274, 3, [8]), (277, 3, [1]), (278, 4, [height]), (279, 4, [2 * cells.size]),
        (33421, 3, [2, 2]), (33422, 1, bytes([0, 1, 1, 2])), (50706, 1, bytes([1, 4, 0, 0])),
        (50708, 2, b"Maker Camera 1\0"), (50714, 3, [0]), (50717, 3, [65535]),
        (50721, 10, identity), (50728, 5, [1, 1] * 3), (50778, 3, [21]),
    ]  # fmt: skip
    at = 8 + 2 * cells.size
    values, directory = b"", struct.pack("<H", len(entries))
    codes = {1: "B", 2: "B", 3: "H", 4: "I", 5: "I", 10: "i"}
    behind = at + 2 + 12 * len(entries) + 4
    for tag, kind, value in entries:
        packed = bytes(value) if kind < 3 else struct.pack(f"<{len(value)}{codes[kind]}", *value)
        count = len(value) // 2 if kind in (5, 10) else len(value)
        place = packed.ljust(4, b"\0")
        if len(packed) > 4:
            place, values = struct.pack("<I", behind + len(values)), values + packed
            values += bytes(len(values) % 2)
        directory += struct.pack("<HHI", tag, kind, count) + place
    head = b"II*\0" + struct.pack("<I", at) + cells.astype("<u2").tobytes()
    file.write_bytes(head + directory + bytes(4) + values)


def test_a_cameras_raw_image_is_developed_in_full(tmp_path: Path) -> None:
    pytest.importorskip("rawpy")
    cells = 200 * np.add.outer(np.arange(64), 2 * np.arange(96))
    _write_dng(tmp_path / "a.dng", cells)
    header = read_image_header(tmp_path / "a.dng")
    assert (header.format, header.stored, header.size) == ("raw", (96, 64), (64, 96))
    assert (header.exif.make, header.exif.model, header.exif.orientation) == (
        "Maker",
        "Camera 1",
        8,
    )
    image = read_image(tmp_path / "a.dng")
    assert (image.size, image.depth) == ((64, 96), 16)
    stored = read_image(tmp_path / "a.dng", orientation=1).pixels.astype(float)
    assert np.array_equal(np.rot90(stored), image.pixels), "8 is a quarter to the left"
    inner = stored[4:-4, 4:-4]
    assert (np.diff(inner, axis=1) > 0).mean() > 0.99
    assert (np.diff(inner, axis=0) > 0).mean() > 0.99
    assert read_colour(tmp_path / "a.dng").shape == (96, 64, 3)


@pytest.mark.parametrize(("planes", "shape"), [(1, (4, 5)), (2, (4, 5)), (4, (4, 5, 3))])
def test_planes_that_are_no_colours_are_left_out(
    monkeypatch: pytest.MonkeyPatch, planes: int, shape: tuple[int, ...]
) -> None:
    """Cameras without colours have one plane, and transparency is one more."""
    pixels = np.full((4, 5, planes), 7, np.uint16)
    monkeypatch.setattr(photo_libraries, "_decode_raw", lambda _: pixels)
    assert decode_photo(ForeignKind.RAW, b"", colour=True).shape == shape
    grey = decode_photo(ForeignKind.RAW, b"", colour=False)
    assert grey.dtype == np.uint16
    assert grey.tolist() == [[7] * 5] * 4


def test_a_folder_gives_what_can_be_read_once(heic: Path) -> None:
    write_image(heic.with_name("b.png"), _RAMP)
    heic.with_name("b.heic").write_bytes(heic.read_bytes())
    assert [path.name for path in find_images([str(heic.parent)])] == ["a.heic", "b.png"]
    assert not describe_unread_photographs([str(heic.parent)])


@pytest.mark.parametrize("cut", [20, 200, -50])
def test_damage_is_named(heic: Path, cut: int) -> None:
    heic.write_bytes(heic.read_bytes()[:cut])
    with pytest.raises(CalibrationError, match=r"a\.heic (is a HEIC|cannot be decoded)"):
        read_image(heic)


def test_without_the_library_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(photo_libraries, "find_spec", lambda _: None)
    (tmp_path / "a.heic").write_bytes(b"\0\0\0\x18ftypheic\0\0\0\0mif1heic")
    write_image(tmp_path / "b.png", _RAMP)
    with pytest.raises(CalibrationError, match="HEIC or AVIF image, which cannot") as caught:
        read_image(tmp_path / "a.heic")
    assert "calibgui[photos]" in caught.value.hint
    assert [path.name for path in find_images([str(tmp_path)])] == ["b.png"]
    assert "calibgui[photos]" in describe_unread_photographs([str(tmp_path)])

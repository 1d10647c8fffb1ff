"""Reading and writing photographs, against arrays and files written by Pillow."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from calibgui.engine import files
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import (
    FORMATS,
    read_colour,
    read_image,
    read_image_size,
    write_image,
)

Pixels = np.ndarray


def ramp(height: int = 24, width: int = 40) -> Pixels:
    """Smooth, so that JPEG keeps it, and without any symmetry."""
    v, u = np.mgrid[:height, :width]
    return np.rint(20 + 2 * u + 4 * v + 0.03 * u * v).astype(np.uint8)


@pytest.mark.parametrize("suffix", [s for s in FORMATS if s != ".ppm"])
def test_grey_round_trip(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"Brett №7 – 写真{suffix}"
    write_image(path, ramp())
    image = read_image(path)
    tolerance = 2 if suffix.startswith(".j") else 1 if suffix == ".webp" else 0
    np.testing.assert_allclose(image.pixels.astype(int), ramp(), atol=tolerance)
    assert (image.size, image.depth, image.orientation, image.path) == ((40, 24), 8, 1, path)
    assert read_image_size(path) == (40, 24)
    assert not image.pixels.flags.writeable


@pytest.mark.parametrize("suffix", [".png", ".tiff", ".ppm", ".bmp", ".webp"])
def test_colour_round_trip(tmp_path: Path, suffix: str) -> None:
    rgb = np.stack([ramp(), 255 - ramp(), ramp()[::-1]], axis=-1)
    write_image(tmp_path / f"a{suffix}", rgb)
    np.testing.assert_array_equal(read_colour(tmp_path / f"a{suffix}"), rgb)
    np.testing.assert_array_equal(np.asarray(Pillow.open(tmp_path / f"a{suffix}")), rgb)
    luminance = rgb @ [0.299, 0.587, 0.114]
    np.testing.assert_allclose(read_image(tmp_path / f"a{suffix}").pixels, luminance, atol=1.5)


@pytest.mark.parametrize("suffix", [".png", ".tif", ".pgm"])
def test_sixteen_bits_are_kept_and_stretched(tmp_path: Path, suffix: str) -> None:
    # A 12-bit camera's levels in the lower bits, which 8 bits would crush to 16 levels.
    deep = np.arange(4000, dtype=np.uint16).reshape(50, 80)
    write_image(tmp_path / f"a{suffix}", deep)
    image = read_image(tmp_path / f"a{suffix}")
    assert image.depth == 16
    np.testing.assert_array_equal(image.pixels, deep)
    assert image.grey.dtype == np.uint8
    expected = np.clip((deep - 20.0) / (3979 - 20) * 255, 0, 255)
    np.testing.assert_allclose(image.grey, expected, atol=1)


def test_sixteen_bits_of_colour_become_sixteen_bits_of_grey(tmp_path: Path) -> None:
    rgb = np.stack(
        [ramp() * np.uint16(200), ramp() * np.uint16(90), ramp() * np.uint16(7)], axis=-1
    )
    write_image(tmp_path / "a.png", rgb)
    pixels = read_image(tmp_path / "a.png").pixels
    assert pixels.dtype == np.uint16
    np.testing.assert_allclose(pixels, rgb @ [0.299, 0.587, 0.114], atol=2)


def test_a_flat_sixteen_bit_image_does_not_divide_by_zero(tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", np.full((8, 9), 300, np.uint16))
    assert np.ptp(read_image(tmp_path / "a.png").grey) == 0


@pytest.mark.parametrize("mode", ["RGBA", "LA"])
def test_transparency_is_dropped(tmp_path: Path, mode: str) -> None:
    picture = Pillow.fromarray(ramp()).convert(mode)
    picture.putalpha(Pillow.fromarray(ramp()[::-1]))
    picture.save(tmp_path / "a.png")
    np.testing.assert_allclose(read_image(tmp_path / "a.png").pixels.astype(int), ramp(), atol=1)
    assert read_colour(tmp_path / "a.png").shape in ((24, 40), (24, 40, 3))


@pytest.mark.parametrize("mode", ["1", "P", "CMYK"])
def test_other_modes_are_grey_at_last(tmp_path: Path, mode: str) -> None:
    suffix = ".jpg" if mode == "CMYK" else ".png"
    picture = Pillow.fromarray(ramp()).convert(mode)
    picture.save(tmp_path / f"a{suffix}")
    expected = np.asarray(picture.convert("L")).astype(int)
    assert np.mean(np.abs(read_image(tmp_path / f"a{suffix}").pixels - expected)) < 3


# Where EXIF puts the upper left corner of `ramp`'s upright picture, by the definition of the tag:
# (row 0, column 0) of what is stored is at the visual ...
STORED = {
    1: lambda a: a,  # top left
    2: lambda a: a[:, ::-1],  # top right
    3: lambda a: a[::-1, ::-1],  # bottom right
    4: lambda a: a[::-1],  # bottom left
    5: lambda a: a.T,  # left top
    6: lambda a: np.rot90(a, 1),  # right top
    7: lambda a: a[::-1, ::-1].T,  # right bottom
    8: lambda a: np.rot90(a, -1),  # left bottom
}


@pytest.mark.parametrize("suffix", [".jpg", ".png", ".tif", ".webp"])
@pytest.mark.parametrize("orientation", STORED)
def test_orientation_is_honoured_once(tmp_path: Path, suffix: str, orientation: int) -> None:
    exif = Pillow.Exif()
    exif[0x0112] = orientation
    options = {".jpg": {"quality": 98}, ".webp": {"lossless": True}}.get(suffix, {})
    path = tmp_path / f"a{suffix}"
    picture = Pillow.fromarray(np.ascontiguousarray(STORED[orientation](ramp())))
    picture.save(path, exif=exif, **options)
    image = read_image(path)
    np.testing.assert_allclose(image.pixels.astype(int), ramp(), atol=3)
    np.testing.assert_allclose(
        read_colour(path).reshape(24, 40, -1)[..., 0].astype(int), ramp(), atol=3
    )
    assert image.orientation == orientation
    assert image.size == read_image_size(path) == (40, 24)


@pytest.mark.parametrize("suffix", [".png", ".tif"])
@pytest.mark.parametrize("stated", STORED)
def test_another_orientation_turns_the_stored_pixels(
    tmp_path: Path, suffix: str, stated: int
) -> None:
    exif = Pillow.Exif()
    exif[0x0112] = stated
    path = tmp_path / f"a{suffix}"
    for wanted, store in STORED.items():
        Pillow.fromarray(np.ascontiguousarray(store(ramp()))).save(path, exif=exif)
        image = read_image(path, wanted)
        np.testing.assert_array_equal(image.pixels, ramp())
        np.testing.assert_array_equal(read_colour(path, wanted), ramp())
        assert image.orientation == wanted


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".bmp", ".webp", ".pgm"])
@pytest.mark.parametrize("kept", [0.5, 0.97])
def test_truncated_files_are_refused(tmp_path: Path, suffix: str, kept: float) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (120, 160)).astype(np.uint8)
    path = tmp_path / f"half{suffix}"
    write_image(path, noise)
    data = path.read_bytes()
    path.write_bytes(data[: int(kept * len(data))])
    with pytest.raises(CalibrationError, match=f"half{suffix}") as caught:
        read_image(path)
    assert "cut short" in str(caught.value) or "not an image" in str(caught.value)


def test_numbers_written_out_may_end_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.pgm"
    path.write_bytes(b"P2 3 2 255\n0 1 2\n30 40 255")
    assert np.array_equal(read_image(path).pixels, [[0, 1, 2], [30, 40, 255]])


def test_a_preallocated_download_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "half.jpg"
    write_image(path, np.random.default_rng(1).integers(0, 255, (120, 160)).astype(np.uint8))
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2].ljust(len(data), b"\0"))
    with pytest.raises(CalibrationError, match="cut short"):
        read_image(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"# Notes\nno picture here\n", "not an image"),
        (b"\x89PNG\r\n\x1a\n", "not an image"),
        (b"\0\0\0\x18ftypmp42\0\0\0\0mp42isom", "is a video"),
        (b"RIFF\x8c\x16\0\0AVI LIST", "is a video"),
        (b"\x1aE\xdf\xa3\x9fB\x86\x81\x01B\xf7\x81", "is a video"),
        (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "HEIC"),
        (b"\0\0\0\x18ftypcrx \0\0\0\1crx isom", "raw image"),
        (b"FUJIFILMCCD-RAW 0201FF393103", "raw image"),
        (b"P5 0 7 255\n", "0 x 7"),
        (b"P5 60000 60000 255\n", "60000 x 60000"),
    ],
)
def test_what_is_no_photograph_is_named(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "view 3.png"
    path.write_bytes(content)
    for read in (read_image, read_image_size, read_colour):
        with pytest.raises(CalibrationError, match=message) as caught:
            read(path)
        assert str(path) in caught.value.message
        assert caught.value.hint


def test_the_preview_in_a_raw_image_is_not_taken_for_the_photograph(tmp_path: Path) -> None:
    """Nikon's, Sony's and Adobe's raw images are TIFF, with a small copy as their first page."""
    path = tmp_path / "view.tif"
    pixels = np.zeros((5, 7), np.uint8)
    Pillow.fromarray(pixels).save(path, tiffinfo={254: 1})
    with pytest.raises(CalibrationError, match="a camera's raw image"):
        read_image(path)
    Pillow.fromarray(pixels).save(path, tiffinfo={254: 0})
    assert read_image(path).size == (7, 5)


def test_missing_files_and_folders_are_named(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.png", tmp_path):
        for read in (read_image, read_image_size):
            with pytest.raises(CalibrationError, match="cannot be read"):
                read(path)


def test_an_image_of_several_pages_is_refused(tmp_path: Path) -> None:
    page = Pillow.fromarray(ramp())
    page.save(tmp_path / "a.tif", save_all=True, append_images=[page, page])
    for read in (read_image, read_image_size):
        with pytest.raises(CalibrationError, match="holds 3 images") as caught:
            read(tmp_path / "a.tif")
        assert "file of its own" in str(caught.value)


def test_floating_point_images_are_refused(tmp_path: Path) -> None:
    Pillow.fromarray(ramp().astype(np.float32)).save(tmp_path / "a.tif")
    with pytest.raises(CalibrationError, match="float32"):
        read_image(tmp_path / "a.tif")


@pytest.mark.parametrize(
    ("name", "pixels"),
    [
        ("a.jpg", np.zeros((4, 4), np.uint16)),
        ("a.bmp", np.zeros((4, 4), np.uint16)),
        ("a.pgm", np.zeros((4, 4, 3), np.uint8)),
        ("a.png", np.zeros((4, 4), np.float64)),
        ("a.xyz", np.zeros((4, 4), np.uint8)),
        ("a", np.zeros((4, 4), np.uint8)),
    ],
)
def test_what_a_format_cannot_hold_is_refused(tmp_path: Path, name: str, pixels: Pixels) -> None:
    with pytest.raises(CalibrationError, match="does not hold"):
        write_image(tmp_path / name, pixels)
    assert not list(tmp_path.iterdir())


def test_a_full_disk_keeps_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.png"
    write_image(path, ramp())
    before = path.read_bytes()

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(CalibrationError, match="No space left") as caught:
        write_image(path, ramp()[::-1])
    assert "Free some space" in caught.value.hint
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_writing_into_no_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="cannot be written"):
        write_image(tmp_path / "absent" / "a.png", ramp())


def test_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", ramp())
    (tmp_path / "b").write_bytes(b"")
    assert (tmp_path / "a.png").stat().st_mode == (tmp_path / "b").stat().st_mode
    (tmp_path / "a.png").chmod(0o640)
    write_image(tmp_path / "a.png", ramp())
    assert (tmp_path / "a.png").stat().st_mode & 0o777 == 0o640


@pytest.mark.data
def test_a_phone_photograph(data_dir: Path) -> None:
    image = read_image(next((data_dir / "phone_iphonex").glob("*.[jJ]*")))
    assert (image.orientation, image.size) == (6, (3024, 4032))


@pytest.mark.parametrize("kind", ["jpg", "png", "tif-lzw", "webp", "webp-lossless"])
@pytest.mark.parametrize("part", [0.5, 0.9])
def test_a_compressed_image_whose_tail_is_only_zeros_is_refused(
    tmp_path: Path, kind: str, part: float
) -> None:
    suffix, _, option = kind.partition("-")
    options = {"lzw": {"compression": "tiff_lzw"}, "lossless": {"lossless": True}}.get(option, {})
    noise = np.random.default_rng(0).integers(0, 256, (120, 160), np.uint8)
    path = tmp_path / f"a.{suffix}"
    Pillow.fromarray(noise).save(path, **options)
    assert read_image(path).zero_tail == 0
    content = path.read_bytes()
    whole = int(part * len(content))
    path.write_bytes(content[:whole] + bytes(len(content) - whole))
    with pytest.raises(CalibrationError, match="cut short"):
        read_image(path)


@pytest.mark.parametrize("suffix", ["bmp", "pgm", "tif"])
def test_zeros_at_the_end_of_uncompressed_pixels_are_measured(tmp_path: Path, suffix: str) -> None:
    noise = np.random.default_rng(0).integers(1, 256, (120, 160), np.uint8)
    path = tmp_path / f"a.{suffix}"
    Pillow.fromarray(noise).save(path)
    assert read_image(path).zero_tail == 0
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2] + bytes(len(content) - len(content) // 2))
    assert read_image(path).zero_tail == pytest.approx(0.5, abs=1e-3)


def test_a_file_that_is_larger_than_any_image_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    write_image(path, ramp())
    os.truncate(path, 1 << 40)  # takes no place on the disk
    with pytest.raises(CalibrationError, match=r"a\.png is too large"):
        read_image(path)


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_a_pipe_is_no_image(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.png")
    for read in (read_image, read_colour, read_image_size):
        with pytest.raises(CalibrationError, match="a device or a pipe"):
            read(tmp_path / "a.png")

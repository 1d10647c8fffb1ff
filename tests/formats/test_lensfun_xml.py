"""Lenses in XML, read by lensfun itself."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import lensfunpy
import numpy as np
import PIL.Image as Pillow
import pytest

from calibgui.dataset import Hardware, Result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.sampling import make_mesh
from calibgui.formats import EXPORTERS
from calibgui.formats.camera_conversion import export_camera
from calibgui.formats.lensfun_xml import EXPORTER, write_lensfun, write_lensfun_zoom
from tests.formats.cameras import example, holding

SIZES = [(640, 480), (480, 641)]
_PRECISION_PX = 5e-3
"""Lensfun computes in single precision: 2e-3 px were seen."""


def radial(
    size: tuple[int, int] = (640, 480), focal: float = 600.0, k1: float = -0.2, k2: float = 0.05
) -> Camera:
    """A camera that lensfun's model holds exactly, its centre off the middle."""
    cx, cy = (size[0] - 1) / 2 + 6.5, (size[1] - 1) / 2 - 4.25
    return Camera(size, [focal, focal, cx, cy, k1, k2, 0, 0], "brown-conrady-4")


def read(path: Path) -> tuple[lensfunpy.Lens, lensfunpy.Camera]:
    db = lensfunpy.Database(paths=[str(path)], load_common=False, load_bundled=False)
    (lens,), (camera,) = db.lenses, db.cameras
    return lens, camera


def correct(path: Path, size: tuple[int, int], focal: float, to_pinhole: bool = False) -> Array:
    """Lensfun's map: (height, width, 2) pixels of the photograph behind the corrected ones."""
    lens, camera = read(path)
    modifier = lensfunpy.Modifier(lens, camera.crop_factor, *size)
    flags = lensfunpy.ModifyFlags.DISTORTION
    if to_pinhole:
        flags |= lensfunpy.ModifyFlags.GEOMETRY
    modifier.initialize(focal, 8.0, 10.0, pixel_format=np.uint8, flags=flags)
    return modifier.apply_geometry_distortion().astype(float)


def expected(camera: Camera) -> Array:
    """Pixels of the rays that a pinhole camera of the same focal length has."""
    width, height = camera.size
    uv = make_mesh(np.arange(width), np.arange(height)).astype(float)
    rays = np.dstack([(uv - camera.centre) / camera.focal, np.ones((height, width))])
    return pixels_from_rays(rays, camera)


def list_focals(path: Path) -> list[tuple[float, float]]:
    """Nominal and calibrated focal lengths, mm, of the file."""
    entries = ET.parse(path).getroot().iter("real-focal-length")
    return [(float(e.attrib["focal"]), float(e.attrib["real-focal"])) for e in entries]


@pytest.mark.parametrize("size", SIZES)
def test_lensfun_corrects_to_the_pixels_of_our_rays(size: tuple[int, int], tmp_path: Path) -> None:
    camera = radial(size)
    report = export_camera(camera, EXPORTER, tmp_path / "lens.xml")
    assert report.largest_error_px == pytest.approx(0.0, abs=1e-5)
    ((focal, _),) = list_focals(report.path)
    assert np.abs(correct(report.path, size, focal) - expected(camera)).max() < _PRECISION_PX


def test_lensfun_turns_a_fisheye_into_a_pinhole_by_its_true_focal_length(tmp_path: Path) -> None:
    """The geometry needs the focal length in mm, the crop factor and the aspect ratio."""
    camera = Camera((640, 480), [320, 320, 322, 237, 0.03, -0.004, 0, 0], "kannala-brandt")
    report = export_camera(camera, EXPORTER, tmp_path / "lens.xml")
    assert "fisheye lens" in report.note
    ((focal, real),) = list_focals(report.path)
    assert focal == pytest.approx(real, rel=1e-5)
    found = correct(report.path, camera.size, focal, to_pinhole=True)
    assert np.abs(found - expected(camera)).max() < 0.02


def barrel() -> Camera:
    """A rectilinear lens of 55 degrees with the barrel distortion that a fisheye has as well."""
    return Camera((640, 480), [640, 640, 320, 240, -0.3, 0.11, 0, 0, -0.02], "brown-conrady")


def test_a_narrow_lens_is_rectilinear_although_a_fisheye_fits_better(tmp_path: Path) -> None:
    """A photo editor corrects the distortion alone: straight lines stay straight to 0.5 px."""
    report = export_camera(barrel(), EXPORTER, tmp_path / "lens.xml")
    assert "rectilinear lens" in report.note
    stated = export_camera(
        barrel(), EXPORTER, tmp_path / "stated.xml", hardware=Hardware(type="fisheye")
    )
    assert "fisheye lens" in stated.note and stated.largest_error_px < report.largest_error_px
    for path, straight in ((report.path, True), (stated.path, False)):
        ((focal, _),) = list_focals(path)
        found = correct(path, barrel().size, focal)
        rays = rays_from_pixels(found, barrel())
        top = rays[10, 10:-10]  # of a row of the new image
        row = top[:, :2] / top[:, 2:] * barrel().focal
        along = np.linalg.svd(row - row.mean(axis=0))[1]
        assert bool(along[1] / np.sqrt(len(row)) < 0.2) is straight


@pytest.mark.parametrize("focal", [420, 500, 640, 900])
@pytest.mark.parametrize(("k1", "k2"), [(-0.3, 0.11), (-0.18, 0.05), (-0.05, 0.0), (0.08, -0.03)])
def test_lenses_below_a_hundred_degrees_are_rectilinear(
    tmp_path: Path, focal: float, k1: float, k2: float
) -> None:
    lens = Camera((640, 480), [focal, focal, 322, 237, k1, k2, 0, 0, 0], "brown-conrady")
    assert "rectilinear lens" in export_camera(lens, EXPORTER, tmp_path / "lens.xml").note


def test_a_narrow_lens_that_is_not_rectilinear_is_a_fisheye(tmp_path: Path) -> None:
    lens = Camera((640, 480), [320, 320, 320, 240, 0.03, -0.004, 0, 0], "kannala-brandt")
    cut = Camera((480, 480), [360, 360, 240, 240, 0.3, -0.9, 0, 0], "kannala-brandt")
    for camera in (lens, cut):
        assert "fisheye lens" in export_camera(camera, EXPORTER, tmp_path / "lens.xml").note


def test_camera_and_lens_are_named_by_exif_and_by_the_user(tmp_path: Path, result: Result) -> None:
    exif = Pillow.Exif()
    exif[271], exif[272] = "Fuji & Co", "X-1"
    directory = exif.get_ifd(0x8769)
    directory |= {42036: "XF 18mm", 37386: 18.0, 41989: 27}
    photograph = tmp_path / "a.jpg"
    Pillow.new("RGB", (640, 480)).save(photograph, exif=exif)
    views = [replace(view, image=str(photograph)) for view in result.views]
    named = replace(result, views=tuple(views), hardware=Hardware(mount="Fuji X", model="X-1 II"))
    report = write_lensfun(named, tmp_path / "lens.xml")
    assert "yours to set" not in report.note
    lens, camera = read(report.path)
    assert (camera.maker, camera.model, camera.mount) == ("Fuji & Co", "X-1 II", "Fuji X")
    assert (lens.maker, lens.model, lens.mounts) == ("Fuji & Co", "XF 18mm", ["Fuji X"])
    assert camera.crop_factor == pytest.approx(1.5)
    unknown = write_lensfun(result, tmp_path / "unknown.xml")
    assert unknown.note.endswith("yours to set: maker, model, lens, mount, crop.")


def test_lensfun_reads_every_focal_length_of_a_zoom_lens(tmp_path: Path) -> None:
    """Nominal focal lengths are of a sensor of 24 x 18 mm, and one of them is rounded."""
    px_per_mm = 479 / 18
    cameras = [
        (mm, radial(focal=px_per_mm * real, k1=-0.004 * mm))
        for mm, real in [(40.0, 40.0), (18.0, 18.0), (25.0, 25.6)]
    ]
    report = write_lensfun_zoom(cameras, tmp_path / "zoom.xml")
    crop = np.hypot(36, 24) / np.hypot(18 * 639 / 479, 18)
    assert read(report.path)[1].crop_factor == pytest.approx(crop, rel=1e-5)
    assert np.allclose(list_focals(report.path), [(18, 18), (25, 25.6), (40, 40)], rtol=1e-6)
    for mm, camera in cameras:
        assert np.abs(correct(report.path, (640, 480), mm) - expected(camera)).max() < _PRECISION_PX


def test_what_the_model_lacks_is_stated(tmp_path: Path, result: Result) -> None:
    """The stated error is that of the lens in the file, as any rotation leaves it."""
    camera = Camera(
        (640, 480), [600, 600.5, 330, 236, -0.2, 0.05, 1e-4, 2e-4, -0.02], "brown-conrady"
    )
    report = export_camera(camera, EXPORTER, tmp_path / "lens.xml")
    lens, _ = read(report.path)
    ((focal, real),) = list_focals(report.path)
    half = 479 / 2
    half_mm = np.hypot(36, 24) / 2 / np.hypot(639 / 479, 1)
    f = real / half_mm * half
    k1, k2 = lens.interpolate_distortion(focal).terms[:2]
    params = [f, f, *camera.centre, k1 * (f / half) ** 2, k2 * (f / half) ** 4, 0, 0]
    held = Camera(camera.size, params, "brown-conrady-4")
    worst = compare_cameras(camera, held).worst
    assert 0.01 < report.largest_error_px < 0.3
    assert report.largest_error_px == pytest.approx(worst, rel=0.3)
    assert f"{report.largest_error_px:.2g} px" in report.note
    seen = write_lensfun(result, tmp_path / "seen.xml")
    assert "where corners were seen" in seen.note


def test_a_lens_that_the_model_cannot_follow_is_not_written(tmp_path: Path, result: Result) -> None:
    with pytest.raises(CalibrationError, match=r"no decentering, cannot follow this lens"):
        write_lensfun(holding(result, example("brown-conrady")), tmp_path / "lens.xml")
    assert not list(tmp_path.iterdir())
    assert EXPORTERS["lensfun"].holds(example("brown-conrady", skew=0.1)), "it is fitted instead"


def test_pixels_that_are_not_square_are_named(tmp_path: Path) -> None:
    wide = Camera((640, 480), [800, 600, 320, 240, -0.2, 0.05, 0, 0, 0], "brown-conrady")
    with pytest.raises(CalibrationError, match=r"square pixels \(here fx is 1\.333 times fy\)"):
        export_camera(wide, EXPORTER, tmp_path / "lens.xml")

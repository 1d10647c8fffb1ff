"""Reading cameras: what the exporters write comes back, and whatever else is a named error."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.formats import (
    EXPORTERS,
    IMPORTERS,
    camera_import,
    export,
    read_camera,
)
from tests.formats.cameras import example, holding, rays_for, splined

_READ_BACK = (
    "opencv",
    "ros",
    "kalibr",
    "orb-slam3",
    "mrcal",
    "colmap",
    "nerfstudio",
    "metashape",
    "matlab",
    "bouguet",
    "basalt",
    "anipose",
    "caliscope",
    "gyroflow",
)
"""Formats of other programs whose cameras are both written and read."""
_HELD = [
    (name, model)
    for name in _READ_BACK
    for model in EXPORTERS[name].models
    if model != "splined-stereographic"
]


def _assert_same(read: Camera, camera: Camera) -> None:
    """The two cameras have images of one size, and image all rays at the same pixels."""
    assert read.size == camera.size
    rays = rays_for(camera)
    expected = pixels_from_rays(rays, camera)
    assert np.isfinite(expected).all()
    assert np.abs(pixels_from_rays(rays, read) - expected).max() < 1e-9


@pytest.mark.parametrize(("name", "model"), _HELD)
def test_a_camera_that_a_format_holds_is_read_back(
    tmp_path: Path, result: Result, name: str, model: str
) -> None:
    camera = example(model)
    for suffix in EXPORTERS[name].suffixes:
        report = export(holding(result, camera), name, tmp_path / f"camera{suffix}")
        assert "as calibrated" in report.note
        read = read_camera(report.path)
        assert read.title == EXPORTERS[name].title
        assert read.covariance is None
        _assert_same(read.camera, camera)


def test_a_splined_camera_is_read_back(tmp_path: Path, result: Result) -> None:
    report = export(holding(result, splined()), "mrcal", tmp_path / "a.cameramodel")
    read = read_camera(report.path).camera
    assert read.model == splined().model
    np.testing.assert_array_equal(read.params, splined().params)


def test_skew_is_read_back(tmp_path: Path, result: Result) -> None:
    camera = example("brown-conrady", skew=3e-3)
    report = export(holding(result, camera), "matlab", tmp_path / "a.m")
    assert read_camera(report.path).camera.params[-1] == pytest.approx(3e-3, rel=1e-12)


@pytest.mark.parametrize("name", _READ_BACK)
def test_a_refitted_camera_is_read_back(tmp_path: Path, result: Result, name: str) -> None:
    """The camera read differs from the calibrated one by what the report states."""
    report = export(result, name, tmp_path / f"camera{EXPORTERS[name].suffixes[0]}")
    read = read_camera(report.path).camera
    corners = np.concatenate([view.uv for view in result.observations()])
    error = measure_error(result.calibration.camera, read, corners)
    assert 0 < error < report.largest_error_px


def measure_error(calibrated: Camera, read: Camera, uv: np.ndarray) -> float:
    """Largest distance of pixels uv (n, 2) from the images of their rays in another camera, px."""
    return float(np.abs(pixels_from_rays(rays_from_pixels(uv, calibrated), read) - uv).max())


def test_our_own_result_is_read_with_its_covariance(tmp_path: Path, weighted: Result) -> None:
    report = export(weighted, "result", tmp_path / "result.json")
    read = read_camera(report.path, size=(640, 480))
    np.testing.assert_array_equal(read.camera.params, weighted.calibration.camera.params)
    np.testing.assert_array_equal(read.covariance, weighted.calibration.covariance)
    with pytest.raises(CalibrationError, match="640 x 480 px, not 320 x 240 px"):
        read_camera(report.path, size=(320, 240))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\x89PNG\r\n\x1a\n\xff", "is not text in UTF-8"),
        (b"image;row;col;u_px\n", "is not a camera file"),
        (b'{"format": "calibgui-corners", "version": 1}', "is not a camera file"),
    ],
)
def test_other_files_are_refused_with_a_list_of_what_is_read(
    tmp_path: Path, content: bytes, message: str
) -> None:
    file = tmp_path / "camera.dat"
    file.write_bytes(content)
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message
    assert all(importer.title in caught.value.hint for importer in IMPORTERS)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("camera.yaml", "", "is empty"),
        ("camera.json", "{camera", "in line 1"),
        ("camera.json", '{"a": 1}', "is not a camera file"),
    ],
)
def test_damage_is_named_where_no_format_is_known(
    tmp_path: Path, name: str, text: str, message: str
) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(CalibrationError, match=message):
        read_camera(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("lensfun", "is a lensfun database, which holds no camera in pixels"),
        ("lcp", "is a lens profile of Adobe's"),
        ("python", "is a script in Python"),
        ("opencv-python", "is a script in Python"),
        ("corners", "holds corners, but no camera"),
        ("corners-csv", "holds corners, but no camera"),
        ("corners-vnl", "holds corners, but no camera"),
    ],
)
def test_our_own_files_without_a_camera_name_the_result(
    tmp_path: Path, result: Result, name: str, message: str
) -> None:
    report = export(result, name, tmp_path / f"own{EXPORTERS[name].suffixes[0]}")
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(report.path)
    assert "result.json" in caught.value.hint


def test_all_of_our_own_files_are_read_or_named() -> None:
    without = {"lensfun", "lcp", "python", "opencv-python", "corners", "corners-csv", "corners-vnl"}
    by_another_format = {"colmap-model", "openvins", "metashape-cameras"}
    of_undistorted_images = {"map", "usd"}
    read = {"result", *_READ_BACK} | by_another_format
    assert read | without | of_undistorted_images == set(EXPORTERS)


def test_files_that_cannot_be_read_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path, problem in ((tmp_path / "absent.yaml", "does not exist"), (tmp_path, "is a folder")):
        with pytest.raises(CalibrationError, match=problem) as caught:
            read_camera(path)
        assert str(path) in caught.value.message
    monkeypatch.setattr(camera_import, "MAX_FILE_SIZE", 100)
    (tmp_path / "large.yaml").write_bytes(bytes(101))
    with pytest.raises(CalibrationError, match=r"large\.yaml is too large"):
        read_camera(tmp_path / "large.yaml")


def test_a_name_is_for_files_that_name_their_cameras(tmp_path: Path, result: Result) -> None:
    export(result, "ros", tmp_path / "a.yaml")
    with pytest.raises(CalibrationError, match=r"one camera without a name \(ROS camera_info\)"):
        read_camera(tmp_path / "a.yaml", name="left")


def test_a_byte_order_mark_is_no_error(tmp_path: Path, result: Result) -> None:
    for name in _READ_BACK:
        file = tmp_path / f"a{EXPORTERS[name].suffixes[0]}"
        export(result, name, file)
        file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())
        assert read_camera(file).title == EXPORTERS[name].title


_DOUBLING = "a0: &a0 [x, x]\n" + "".join(
    f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]\n" for k in range(1, 30)
)
_KALIBR = (
    "cam0:\n  camera_model: pinhole\n  intrinsics: [1, 1, 1, 1]\n  distortion_model: {}\n"
    "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [640, 480]\n"
)
_OPENCV = (
    "camera_matrix: {{rows: 3, cols: 3, data: [600, 0, 320, 0, 600, 240, 0, 0, 1]}}\n"
    "dist_coeffs: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}\n"
    "image_width: 640\nimage_height: 480\nmodel: {}\n"
)


_ROS = (
    "image_width: 640\nimage_height: 480\ncamera_name: cam\ndistortion_model: plumb_bob\n"
    "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [600, 0, 320, 0, 600, 240, 0, 0, 1]\n"
    "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n"
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (_KALIBR, "{}"),
        (_KALIBR, "pinhole"),
        (_KALIBR, "[1, 1, 1, 1]"),
        (_KALIBR, "[0, 0, 0, 0]"),
        (_KALIBR, "[640, 480]"),
        (_OPENCV, "{}"),
        (_OPENCV, "640"),
        (_OPENCV, "480"),
        (_ROS, "cam"),
        (_ROS, "plumb_bob"),
        (_ROS, "640"),
        (_ROS, "[600, 0, 320, 0, 600, 240, 0, 0, 1]"),
    ],
)
def test_aliases_that_double_at_each_level_are_refused(
    tmp_path: Path, text: str, value: str
) -> None:
    """Written out they would take all memory."""
    file = tmp_path / "camera.yaml"
    file.write_text(_DOUBLING + text.replace(value, "*a29", 1).replace("{}", "radtan"))
    with pytest.raises(CalibrationError, match=r"camera\.yaml .* alias \*a0, .* not followed"):
        read_camera(file)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.yaml", _OPENCV.format("x").replace("640", "640.5")),
        ("a.xml", "<r><camera_matrix>600 0 320 0 600 240 0 0 1</camera_matrix><dist>0 0 0 0</dist>"
         "<image_size>640.5 480</image_size></r>"),
        ("a.m", "cameraIntrinsics([600 600], [320 240], [480 640.5])"),
        ("a.m", "cameraIntrinsics([600 600], [320 240], [480 1e9])"),
        ("cameras.txt", f"1 PINHOLE {'9' * 400} 480 600 600 320 240"),
    ],
)  # fmt: skip
def test_sizes_of_no_image_are_refused(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(CalibrationError, match=r"no image|not an( array of)? integer") as caught:
        read_camera(tmp_path / name)
    assert name in caught.value.message


def test_a_line_of_dots_takes_no_time_in_a_script(tmp_path: Path) -> None:
    """Dots go on in the next line, of which there is none: each of them was tried to its end."""
    (tmp_path / "a.m").write_text("cameraIntrinsics(" + "." * 1_000_000)
    with pytest.raises(CalibrationError, match="no matrix of numbers"):
        read_camera(tmp_path / "a.m")

"""Reading cameras: what the exporters write comes back, and whatever else is a named error."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from calibgui.dataset import Result
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.formats import (
    EXPORTERS,
    IMPORTERS,
    ImportedCamera,
    camera_import,
    export,
    read_camera,
)
from tests.formats.cameras import example, holding, rays_for, splined

_READ_BACK = ("opencv", "ros", "kalibr", "mrcal", "colmap", "matlab", "basalt", "gyroflow")
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
        ("python", "is a script in Python"),
        ("opencv-python", "is a script in Python"),
        ("corners", "holds corners, but no camera"),
        ("corners-csv", "holds corners, but no camera"),
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
    without = {"lensfun", "python", "opencv-python", "corners", "corners-csv"}
    assert {"result", *_READ_BACK} | without == set(EXPORTERS)


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


def _text(result: Result, name: str, suffix: str, folder: Path) -> str:
    return export(result, name, folder / f"a{suffix}").path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def texts(forward_result: Result, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """A file of each format."""
    folder = tmp_path_factory.mktemp("texts")
    made = [
        _text(forward_result, name, suffix, folder)
        for name in _READ_BACK
        for suffix in EXPORTERS[name].suffixes
        if suffix != ".yml"
    ]
    fisheye = holding(forward_result, example("kannala-brandt"))
    made += [_text(fisheye, name, EXPORTERS[name].suffixes[0], folder) for name in _READ_BACK[:3]]
    made.append(_text(holding(forward_result, example("scaramuzza")), "matlab", ".m", folder))
    return [*made, json.dumps(json.loads(made[2]))]


_PIECES = st.sampled_from([*"[]{}<>'\":,;&*\n01-", "", "1e400", "nan", ".nan", "null", "\x00"])
_PIECES |= st.sampled_from(["99999999999999999999", "!!python/object:os.system ", "true", "é"])
_PIECES |= st.sampled_from(["&a ", "*a", "- ", "1_0", "[[1, 2]]"])


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=400)
@given(data=st.data())
def test_no_damage_ends_in_anything_but_a_named_error(
    texts: list[str], tmp_path: Path, data: st.DataObject
) -> None:
    text = data.draw(st.sampled_from(texts))
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text)))
        end = min(len(text), start + data.draw(st.integers(0, 12)))
        text = text[:start] + data.draw(_PIECES) + text[end:]
    file = tmp_path / "damaged.txt"
    file.write_text(text, encoding="utf-8")
    try:
        read = read_camera(file)
    except CalibrationError as error:
        assert str(file) in error.message
    else:
        assert isinstance(read, ImportedCamera)


def test_a_file_cut_anywhere_is_refused_or_whole(texts: list[str], tmp_path: Path) -> None:
    file = tmp_path / "cut.txt"
    for text in texts:
        for end in range(0, len(text), 23):
            file.write_text(text[:end], encoding="utf-8")
            try:
                read_camera(file)
            except CalibrationError as error:
                assert str(file) in error.message

"""OpenCV's files, read by cv2.FileStorage of this and of the other major version."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotations
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.opencv_file import EXPORTER, format_storage, write_opencv
from tests.formats.cameras import RAYS, example, holding, rays_for
from tests.formats.readers import in_other_python

_SUFFIXES = pytest.mark.parametrize("suffix", [".yaml", ".yml", ".xml", ".json"])
_MATRICES = (
    "camera_matrix",
    "distortion_coefficients",
    "extrinsic_parameters",
    "camera_matrix_std_dev",
    "distortion_coefficients_std_dev",
)


def _read(file: Path) -> dict[str, Array]:
    storage = cv2.FileStorage(str(file), cv2.FILE_STORAGE_READ)
    assert storage.isOpened()
    values = {name: storage.getNode(name).mat() for name in _MATRICES}
    values["size"] = np.array(
        [storage.getNode(name).real() for name in ("image_width", "image_height")]
    )
    values["rms"] = np.array(storage.getNode("avg_reprojection_error").real())
    return values


@_SUFFIXES
@pytest.mark.parametrize("name", ["result", "forward_result"])
def test_opencv_projects_what_it_reads_to_our_pixels(
    tmp_path: Path, suffix: str, name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    file = tmp_path / f"camera{suffix}"
    report = write_opencv(result, file)
    read = _read(file)
    fitted = express_in_format(result, EXPORTER).calibration
    assert read["size"].tolist() == list(result.calibration.camera.size)
    assert len(read["extrinsic_parameters"]) == len(result.used)
    squares = []
    for row, pose, residuals, (uv, xy, _) in zip(
        read["extrinsic_parameters"],
        fitted.poses,
        fitted.residuals,
        result.observations(),
        strict=True,
    ):
        theirs = cv2.projectPoints(
            np.append(xy, np.zeros((len(xy), 1)), axis=1),
            row[:3],
            row[3:],
            read["camera_matrix"],
            read["distortion_coefficients"],
        )[0].reshape(-1, 2)
        X = xy @ rotations.rotation_from_vector(pose.rvec)[:, :2].T + pose.tvec
        assert np.abs(theirs - pixels_from_rays(X, fitted.camera)).max() < 1e-9
        assert np.abs(uv - theirs - residuals.image).max() < 1e-9
        squares.append(np.sum((uv - theirs) ** 2, axis=1))
    assert read["rms"] == pytest.approx(np.sqrt(np.concatenate(squares).mean()), rel=1e-9)
    sigma = np.hstack([read["camera_matrix_std_dev"], read["distortion_coefficients_std_dev"]])
    assert np.array_equal(sigma[0], fitted.sigma[:9])
    assert report.note in file.read_text()


@_SUFFIXES
def test_the_other_major_version_reads_the_same_numbers(
    tmp_path: Path, suffix: str, result: Result
) -> None:
    file = tmp_path / f"camera{suffix}"
    write_opencv(result, file)
    script = (
        "import cv2, json, sys\n"
        "fs = cv2.FileStorage(sys.argv[1], cv2.FILE_STORAGE_READ)\n"
        "print(json.dumps([fs.getNode(n).mat().tolist() for n in sys.argv[2:]]))"
    )
    major = cv2.__version__.split(".")[0]
    needs = f"import cv2; assert cv2.__version__.split('.')[0] != {major!r}"
    read = in_other_python(script, file, *_MATRICES, needs=needs)
    for name, values in zip(_MATRICES, read, strict=True):
        assert np.array_equal(values, _read(file)[name])


def test_any_json_reader_reads_the_json_file(tmp_path: Path, result: Result) -> None:
    report = write_opencv(result, tmp_path / "camera.json")
    content = json.loads((tmp_path / "camera.json").read_text())
    assert report.note in content["note"]
    assert (
        content["camera_matrix"]["data"]
        == express_in_format(result, EXPORTER).calibration.camera.matrix.ravel().tolist()
    )


def test_an_undetermined_deviation_leaves_the_deviations_out(result: Result) -> None:
    """A NaN would make the file unreadable for others than OpenCV."""
    fitted = express_in_format(result, EXPORTER).calibration
    sigma = fitted.sigma.copy()
    sigma[8] = np.nan
    text = format_storage(replace(fitted, sigma=sigma), ".json", "note")
    assert "std_dev" not in text and "nan" not in text.lower()
    assert "std_dev" in format_storage(fitted, ".json", "note")


@_SUFFIXES
@pytest.mark.parametrize("model", EXPORTER.models)
def test_opencv_projects_what_each_model_writes_to_our_pixels(
    tmp_path: Path, suffix: str, model: str, result: Result
) -> None:
    camera = example(model)
    write_opencv(holding(result, camera), tmp_path / f"camera{suffix}")
    storage = cv2.FileStorage(str(tmp_path / f"camera{suffix}"), cv2.FILE_STORAGE_READ)
    K, D = (storage.getNode(name).mat() for name in _MATRICES[:2])
    fisheye = storage.getNode("fisheye_model")
    assert (not fisheye.empty() and fisheye.real() == 1) is (model == "kannala-brandt")
    rays = rays_for(camera)
    project = cv2.fisheye.projectPoints if model == "kannala-brandt" else cv2.projectPoints
    theirs = project(rays[:, None], np.zeros(3), np.zeros(3), K, D)[0].reshape(-1, 2)
    assert np.abs(theirs - pixels_from_rays(rays, camera)).max() < 1e-9
    sigma = storage.getNode("distortion_coefficients_std_dev").mat()
    assert sigma.shape == D.shape
    assert set(sigma.ravel()) == ({0.0} if model == "pinhole" else {0.5})


def _store(file: Path, **values: object) -> Path:
    """A file as OpenCV itself writes it."""
    storage = cv2.FileStorage(str(file), cv2.FILE_STORAGE_WRITE)
    for name, value in values.items():
        storage.write(name, value)
    storage.release()
    return file


_K = np.array([[800.0, 0, 320.5], [0, 810, 240.25], [0, 0, 1]])
_SIZE = {"image_width": 640, "image_height": 480}
_D14 = np.array([0.1, -0.2, 1e-3, -2e-3, 0.3, 0.4, -0.1, 0.05, 1e-3, 2e-3, -1e-3, -2e-3, 0, 0])


@_SUFFIXES
@pytest.mark.parametrize(
    ("count", "model"),
    [
        (4, "brown-conrady-4"),
        (5, "brown-conrady"),
        (8, "rational"),
        (12, "thin-prism"),
        (14, "thin-prism"),
    ],
)
def test_the_number_of_coefficients_tells_the_model(
    tmp_path: Path, suffix: str, count: int, model: str
) -> None:
    D = _D14[:count]
    file = _store(
        tmp_path / f"a{suffix}", **_SIZE, camera_matrix=_K, distortion_coefficients=D[:, None]
    )
    camera = read_camera(file).camera
    assert camera.model == model and camera.size == (640, 480)
    theirs = cv2.projectPoints(RAYS, np.zeros(3), np.zeros(3), _K, D)[0].reshape(-1, 2)
    assert np.abs(theirs - pixels_from_rays(RAYS, camera)).max() < 1e-9


@_SUFFIXES
def test_other_names_of_the_entries_are_known(tmp_path: Path, suffix: str) -> None:
    D = np.array([[-0.05, 4e-3, -3e-3, 4e-4]])
    file = _store(tmp_path / f"a{suffix}", K=_K, D=D, fisheye_model=1)
    with pytest.raises(CalibrationError, match="does not say how large its images are"):
        read_camera(file)
    read = read_camera(file, size=(640, 480))
    assert read.camera.model == "kannala-brandt" and not read.notes
    assert read.camera.params.tolist() == [800, 810, 320.5, 240.25, *D[0]]
    older = {"image_Width": 640, "image_Height": 480, "Camera_Matrix": _K}
    file = _store(tmp_path / f"b{suffix}", **older, Distortion_Coefficients=D)
    read = read_camera(file)
    assert read.camera.model == "brown-conrady-4"
    assert "four coefficients are taken for k1 k2 p1 p2" in read.notes[0]
    text = file.read_text()
    assert "fisheye_model" not in text


@pytest.mark.parametrize(
    "text",
    [
        "image_size: [640, 480]\ndistortion_model: equidistant\n"
        "K: [[800, 0, 320.5], [0, 810, 240.25], [0, 0, 1]]\nD: [-5e-2, 4e-3, -3e-3, 4e-4]\n",
        '{"camera_matrix": [800, 0, 320.5, 0, 810, 240.25, 0, 0, 1], "fisheye": true, '
        '"dist_coeffs": [[-5e-2, 4e-3, -3e-3, 4e-4]], "width": 640, "height": 480}',
        '{"mtx": [[800, 0, 320.5], [0, 810, 240.25], [0, 0, 1]], "camera_model": "fisheye", '
        '"dist": [[-5e-2], [4e-3], [-3e-3], [4e-4]], "img_size": [640, 480]}',
    ],
)
def test_files_that_people_write_are_read(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.txt").write_text(text)
    camera = read_camera(tmp_path / "a.txt").camera
    assert camera.model == "kannala-brandt" and camera.size == (640, 480)
    assert camera.params.tolist() == [800, 810, 320.5, 240.25, -5e-2, 4e-3, -3e-3, 4e-4]


def _skewed(skew: float) -> Array:
    return np.array([[800.0, skew, 320.5], [0, 810, 240.25], [0, 0, 1]])


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"camera_matrix": _K}, "has no distortion_coefficients"),
        ({"camera_matrix": _K, "D": _D14[:7]}, "7 coefficients of the distortion.*4, 5, 8 or 12"),
        ({"camera_matrix": _K, "D": _D14 + 0.01}, "the tilt .* is not 0"),
        ({"camera_matrix": _K, "D": _D14[:5], "fisheye_model": 1}, "fisheye model has 4"),
        ({"camera_matrix": _K, "D": _D14[:4], "fisheye_model": 2}, "fisheye_model is not 0 or 1"),
        ({"camera_matrix": _K[:2], "D": _D14[:5]}, "camera_matrix is not a matrix of 3 x 3"),
        ({"camera_matrix": _K + 1, "D": _D14[:5]}, r"is not \[fx s cx; 0 fy cy; 0 0 1\]"),
        ({"camera_matrix": -_K, "D": _D14[:5]}, r"is not \[fx s cx; 0 fy cy; 0 0 1\]"),
        ({"camera_matrix": _K * [[0], [1], [1]], "D": _D14[:5]}, "No camera has the parameters"),
        ({"camera_matrix": _skewed(1.0), "D": _D14[:4], "fisheye_model": 1}, "skew 1 px"),
        ({"camera_matrix": _K, "D": _D14[:5], "image_width": 0}, "no image of 0 x 480"),
    ],
)
@pytest.mark.parametrize("suffix", [".yaml", ".xml"])
def test_errors_name_file_and_fault(
    tmp_path: Path, suffix: str, values: dict, message: str
) -> None:
    file = _store(tmp_path / f"a{suffix}", **(_SIZE | values))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message


def test_skew_of_a_camera_matrix_is_read(tmp_path: Path) -> None:
    file = _store(tmp_path / "a.yml", **_SIZE, camera_matrix=_skewed(1.6), D=_D14[:5])
    assert read_camera(file).camera.params[-1] == 1.6 / 800


def test_xml_with_declarations_is_refused(tmp_path: Path) -> None:
    head = '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "aaaa">]>'
    (tmp_path / "a.xml").write_text(f"{head}<x><camera_matrix>&a;</camera_matrix></x>")
    with pytest.raises(CalibrationError, match="declarations"):
        read_camera(tmp_path / "a.xml")

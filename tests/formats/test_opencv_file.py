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
from calibgui.engine.geometry import rotations
from calibgui.formats.camera_refit import express_in_models
from calibgui.formats.opencv_file import format_storage, write_opencv
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
    fitted = express_in_models(result).calibration
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
        assert np.abs(theirs - pixels_from_rays(X[:, :2] / X[:, 2:], fitted.camera)).max() < 1e-9
        assert np.abs(uv - theirs - residuals.image).max() < 1e-9
        squares.append(np.sum((uv - theirs) ** 2, axis=1))
    assert read["rms"] == pytest.approx(np.sqrt(np.concatenate(squares).mean()), rel=1e-9)
    sigma = np.hstack([read["camera_matrix_std_dev"], read["distortion_coefficients_std_dev"]])
    assert np.array_equal(sigma[0], fitted.sigma)
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
    assert content["note"].startswith(report.note)
    assert (
        content["camera_matrix"]["data"]
        == express_in_models(result).calibration.camera.matrix.ravel().tolist()
    )


def test_an_undetermined_deviation_leaves_the_deviations_out(result: Result) -> None:
    """A NaN would make the file unreadable for others than OpenCV."""
    fitted = express_in_models(result).calibration
    sigma = fitted.sigma.copy()
    sigma[8] = np.nan
    text = format_storage(replace(fitted, sigma=sigma), ".json", "note")
    assert "std_dev" not in text and "nan" not in text.lower()
    assert "std_dev" in format_storage(fitted, ".json", "note")

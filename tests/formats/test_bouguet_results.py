"""Calib_Results of Bouguet's toolbox: the script is run, and the file loaded, by GNU Octave."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import scipy.io

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import export, read_camera
from calibgui.formats.bouguet_results import EXPORTER
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.corner_import import read_corner_file
from tests.formats.cameras import RAYS, example, holding, seen_points

_OCTAVE = """
{load}
last = n_ima;
R = eval(sprintf('omc_%d', last));
T = eval(sprintf('Tc_%d', last));
printf('%s', jsonencode(struct('fc', fc, 'cc', cc, 'alpha_c', alpha_c, 'kc', kc, 'nx', nx, ...
    'ny', ny, 'omc', R, 'Tc', T, 'fc_error', fc_error)));
"""


def load_in_octave(path: Path) -> dict[str, np.ndarray]:
    """The variables of a file, which GNU Octave runs or loads and prints."""
    octave = shutil.which("octave-cli")
    if octave is None:
        pytest.skip("GNU Octave is not installed")
    verb = "load" if path.suffix == ".mat" else "source"
    script = path.with_name("print.m")
    script.write_text(_OCTAVE.format(load=f"{verb}('{path}');"))
    command = [octave, "--norc", "--quiet", str(script)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.startswith("{"), done.stderr
    return {name: np.ravel(value) for name, value in json.loads(done.stdout).items()}


@pytest.mark.parametrize("name", ["Calib_Results.m", "Calib_Results.mat"])
def test_octave_reads_the_camera_and_the_last_pose(
    tmp_path: Path, result: Result, name: str
) -> None:
    export(result, "bouguet", tmp_path / name)
    read = load_in_octave(tmp_path / name)
    calibration = express_in_format(result, EXPORTER).calibration
    assert (read["nx"], read["ny"]) == calibration.camera.size
    K = np.array([[read["fc"][0], 0, read["cc"][0]], [0, read["fc"][1], read["cc"][1]], [0, 0, 1]])
    board, uv = seen_points(result, calibration)[-1]
    seen = cv2.projectPoints(board, read["omc"], read["Tc"], K, read["kc"])[0].reshape(-1, 2)
    # Octave prints numbers to 15 digits.
    assert np.abs(seen - uv).max() < 1e-9
    np.testing.assert_allclose(read["fc_error"], 3 * calibration.sigma[:2], rtol=1e-9)


def test_skew_is_the_toolboxs(tmp_path: Path, result: Result) -> None:
    """u = fc(1) (xd + alpha_c yd) + cc(1)."""
    camera = example("brown-conrady", skew=3e-3)
    path = export(holding(result, camera), "bouguet", tmp_path / "Calib_Results.mat").path
    read = scipy.io.loadmat(path)
    none = np.zeros(3)
    xd, yd = cv2.projectPoints(RAYS, none, none, np.eye(3), read["kc"])[0].reshape(-1, 2).T
    fc, cc, alpha = read["fc"].ravel(), read["cc"].ravel(), read["alpha_c"].item()
    seen = np.column_stack([fc[0] * (xd + alpha * yd) + cc[0], fc[1] * yd + cc[1]])
    assert np.abs(seen - pixels_from_rays(RAYS, camera)).max() < 1e-9


def test_a_mat_gives_the_corners_back(tmp_path: Path, result: Result) -> None:
    path = export(result, "bouguet", tmp_path / "Calib_Results.mat").path
    read = read_corner_file(path)
    assert read.size == (640, 480) and read.lengths_confirmed
    for view, expected in zip(read.views, result.observations(), strict=True):
        assert np.array_equal(view.observation(None).uv, expected.uv)
        assert np.array_equal(view.observation(None).xy, expected.xy)


def save(path: Path, **changed: object) -> Path:
    """A .mat as the toolbox writes it, of two photographs."""
    x = np.array([[10.0, 60, 10, 60], [20, 20, 70, 70]])
    X = np.array([[0.0, 30, 0, 30], [0, 0, 30, 30], [0, 0, 0, 0]])
    values = {
        "fc": [[600.0], [601.0]],
        "cc": [[320.0], [240.0]],
        "alpha_c": 0,
        "kc": [[-0.2], [0.1], [1e-3], [2e-3], [0]],
        "nx": 640,
        "ny": 480,
        **{f"x_{k}": x + k for k in (1, 2)},
        **{f"X_{k}": X for k in (1, 2)},
        "active_images": [[1, 0]],
        "calib_name": "Image",
        "format_image": "tif",
        "image_numbers": [[3, 7]],
        "I_1": np.zeros((48, 64), np.uint8),
        "ind_active": [[1]],
    }
    scipy.io.savemat(path, values | changed, do_compression=True)
    return path


def test_the_toolboxs_own_variables_are_understood(tmp_path: Path) -> None:
    file = save(tmp_path / "Calib_Results.mat")
    camera = read_camera(file).camera
    assert camera.params.tolist() == [600, 601, 320, 240, -0.2, 0.1, 1e-3, 2e-3, 0, 0]
    read = read_corner_file(file)
    assert [view.image for view in read.views] == ["Image3.tif", "Image7.tif"]
    assert [view.enabled for view in read.views] == [True, False]
    nan = {"x_2": np.full((2, 1), np.nan), "X_2": np.full((3, 1), np.nan)}
    assert len(read_corner_file(save(file, **nan)).views) == 1


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"kc": np.zeros((3, 1))}, "has a kc of 3 numbers"),
        ({"fc": np.array([[np.inf], [600]])}, "is not a camera file"),
        ({"nx": 640.5}, "no image"),
        ({"fc": np.zeros((3000, 3000))}, "holds too many numbers"),
    ],
)
def test_errors_name_file_and_fault(
    tmp_path: Path, changed: dict[str, object], message: str
) -> None:
    file = save(tmp_path / "Calib_Results.mat", **changed)
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"X_1": np.zeros((3, 5))}, "an x_1 or X_1 that is not that of corners"),
        ({"X_2": np.eye(3, 4)}, "X_2 that do not lie on a plane"),
    ],
)
def test_corners_that_are_none_are_refused(
    tmp_path: Path, changed: dict[str, object], message: str
) -> None:
    file = save(tmp_path / "Calib_Results.mat", **changed)
    with pytest.raises(CalibrationError, match=message):
        read_corner_file(file)


def test_damaged_and_newer_files_are_refused(tmp_path: Path) -> None:
    file = save(tmp_path / "Calib_Results.mat")
    content = file.read_bytes()
    file.write_bytes(content[:400])
    with pytest.raises(CalibrationError, match=r"Calib_Results\.mat is not a camera file"):
        read_camera(file)
    file.write_bytes(b"MATLAB 7.3 MAT-file" + content[19:])
    with pytest.raises(CalibrationError, match="save it with -v7"):
        read_camera(file)


def test_errors_that_are_not_known_are_left_out(tmp_path: Path, result: Result) -> None:
    camera = example("brown-conrady")
    held = holding(result, camera).calibration
    calibration = replace(held, sigma=np.full(len(held.sigma), np.nan))
    file = export(replace(result, calibration=calibration), "bouguet", tmp_path / "a.m").path
    assert "fc_error" not in file.read_text() and "omc_error_1" in file.read_text()
    assert read_camera(file).camera.model == "brown-conrady"

"""Camera files with the rectification of a stereo pair: it is kept, or said to be left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from calibgui.cli.main import main
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera

Capture = pytest.CaptureFixture[str]
R = [0.9995, -0.008, 0.03, 0.0078, 0.99995, 0.007, -0.03, -0.0067, 0.9995]
P = [409.4, 0, 158.9, 40.2, 0, 409.4, 113.9, 0, 0, 0, 1, 0]
K = [430.2, 0, 156.9, 0, 430.5, 117.2, 0, 0, 1]


def write(file: Path, R: list[float], P: list[float], header: str = "") -> Path:
    matrices = {
        "camera_matrix": (3, K),
        "rectification_matrix": (3, R),
        "projection_matrix": (3, P),
        "distortion_coefficients": (1, [-0.33, 0.14, 8e-4, 5e-4, 0.0]),
    }
    content = {
        "image_width": 320,
        "image_height": 240,
        "camera_name": "left",
        "distortion_model": "plumb_bob",
    } | {
        name: {"rows": rows, "cols": len(data) // rows, "data": data}
        for name, (rows, data) in matrices.items()
    }
    file.write_text(header + yaml.safe_dump(content))
    return file


@pytest.fixture
def stereo_file(tmp_path: Path) -> Path:
    return write(tmp_path / "left.yaml", R, P)


def test_ros_to_ros_keeps_it(stereo_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out.yaml"
    command = ["convert", str(stereo_file), "--model", "kannala-brandt"]
    assert main([*command, "--export", f"ros={out}", "-q"]) == 0
    assert "left out" not in capsys.readouterr().err
    written = yaml.safe_load(out.read_text())
    assert written["rectification_matrix"]["data"] == R
    assert written["projection_matrix"]["data"] == P


def test_formats_without_it_are_named(stereo_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out, kept = tmp_path / "out.xml", tmp_path / "kept.yaml"
    exports = ["--export", f"opencv={out}", "--export", f"ros={kept}"]
    assert main(["convert", str(stereo_file), *exports, "-q"]) == 0
    assert f"(R, P), which is left out of {out}." in capsys.readouterr().err


def test_it_follows_the_sensor_mode(stereo_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out.yaml"
    command = ["convert", str(stereo_file), "--export", f"ros={out}", "-q"]
    assert main([*command, "--scale", "0.5"]) == 0
    written = yaml.safe_load(out.read_text())
    assert written["rectification_matrix"]["data"] == R
    # The rectified image, halved as well: a point is imaged at (u + 0.5) / 2 - 0.5.
    point = np.array([0.1, -0.2, 1.0, 1.0])
    full, half = (
        np.reshape(matrix, (3, 4)) @ point for matrix in (P, written["projection_matrix"]["data"])
    )
    np.testing.assert_allclose(half[:2] / half[2], (full[:2] / full[2] + 0.5) / 2 - 0.5)
    assert main([*command, "--flip", "both"]) == 0
    assert f"left out of {out}" in capsys.readouterr().err


def test_undistort_says_that_it_is_left_out(
    stereo_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = ["-o", str(tmp_path / "undistorted"), "-q"]
    assert main(["undistort", str(stereo_file), str(photographs / "view1.png"), *out]) == 0
    assert "rectification of a stereo pair (R, P), which is left out" in capsys.readouterr().err


def test_opencv_files_have_it_too(tmp_path: Path) -> None:
    file = write(tmp_path / "left.yml", R, P, "%YAML:1.0\n---\n")
    text = file.read_text().replace("distortion_model: plumb_bob\n", "")
    file.write_text(text)
    found = read_camera(file)
    assert found.title.startswith("OpenCV")
    assert found.rectification is not None
    np.testing.assert_array_equal(found.rectification.R.ravel(), R)
    np.testing.assert_array_equal(found.rectification.P.ravel(), P)


@pytest.mark.parametrize(
    ("R", "P"),
    [
        (np.eye(3).ravel().tolist(), [*K[:3], 0.0, *K[3:6], 0.0, *K[6:], 0.0]),
        ([0.0] * 9, [0.0] * 12),
    ],
    ids=["one camera", "zeros"],
)
def test_one_camera_has_none(R: list[float], P: list[float], tmp_path: Path) -> None:
    assert read_camera(write(tmp_path / "camera.yaml", R, P)).rectification is None


def test_matrices_of_other_sizes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match=r"projection_matrix.*3 x 4"):
        read_camera(write(tmp_path / "camera.yaml", R, P[:9]))
    with pytest.raises(CalibrationError, match=r"rectification_matrix.*3 x 3"):
        read_camera(write(tmp_path / "camera.yaml", R[:6], P))

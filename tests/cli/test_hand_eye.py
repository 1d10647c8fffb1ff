"""calibgui hand-eye: the camera in a robot's hand, from the sample's photographs."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from calibgui.cli.main import main
from calibgui.engine.arrays import Array
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye.motions import Motions
from calibgui.formats.result_json import read_result
from tests.engine.hand_eye.arms import W, X

Capture = pytest.CaptureFixture[str]
Write = Callable[..., Path]


@pytest.fixture
def hands(result_file: Path) -> tuple[list[str], Motions]:
    """Names of the photographs, and base_from_hand of a robot that takes them."""
    result = read_result(result_file)
    rvecs = np.array([pose.rvec for pose in result.calibration.poses])
    tvecs = np.array([pose.tvec for pose in result.calibration.poses])
    boards = Motions(rotation_from_vector(rvecs), tvecs)
    return [view.name for view in result.used], W.after(boards.invert()).after(X.invert())


@pytest.fixture
def write_poses(hands: tuple[list[str], Motions], tmp_path: Path) -> Write:
    """Write the poses, x y z mm and angles of Rz(a) Ry(b) Rx(c), degrees, by the photographs' names
    and in another order."""

    def write(change: Callable[[Array], Array] = lambda rows: rows, names: bool = True) -> Path:
        called, poses = hands
        angles = Rotation.from_matrix(poses.R).as_euler("ZYX", degrees=True)
        rows = change(np.column_stack([poses.t, angles])).tolist()
        lines = [[name, *row] if names else row for name, row in zip(called, rows, strict=False)]
        file = tmp_path / "robot.csv"
        with file.open("w", newline="") as text:
            csv.writer(text).writerows(lines[::-1] if names else lines)
        return file

    return write


def find(*words: object) -> int:
    return main(["hand-eye", *map(str, words)])


def read_words(capsys: Capture) -> str:
    return " ".join(capsys.readouterr().out.split())


def test_a_result_with_poses(
    result_file: Path, write_poses: Write, tmp_path: Path, capsys: Capture
) -> None:
    outputs = [tmp_path / name for name in ("a.json", "a.calib", "a.yaml")]
    options = [word for path in outputs for word in ("-o", path)]
    assert find(result_file, "--poses", write_poses(), *options) == 0
    out = read_words(capsys)
    assert "tool ± " in out and "(k = 2); robot " in out
    assert "poses are angles a, b, c of Rz(a) Ry(b) Rx(c) in degrees, millimetres" in out
    assert "base from hand" in out and "Wrote " in out and "camera in the hand" in out
    content = json.loads(outputs[0].read_text())
    matrix = np.array(content["hand_from_camera"]["matrix"])
    np.testing.assert_allclose(matrix[:3, :3], X.R, atol=1e-3)
    np.testing.assert_allclose(matrix[:3, 3], X.t, atol=1.0)
    storage = cv2.FileStorage(str(outputs[2]), cv2.FILE_STORAGE_READ)
    np.testing.assert_allclose(storage.getNode("cam2gripper").mat(), matrix, atol=1e-9)


def test_photographs_of_a_known_camera(
    result_file: Path, photographs: Path, write_poses: Write, tmp_path: Path, capsys: Capture
) -> None:
    """A camera's file of another program knows no errors, and that is said."""
    camera = tmp_path / "camera.yaml"
    assert main(["convert", str(result_file), "--export", f"opencv={camera}", "-q"]) == 0
    poses = write_poses()
    words = [photographs, "--square", 30, "--with", camera, "--poses", poses]
    assert find(*words, "--tool", "0,0,100") == 0
    assert "No ± counts the camera's errors" in read_words(capsys)
    assert find(*words, "--mount", "base", "--json") == 0
    content: Any = json.loads(capsys.readouterr().out)
    assert "hand from base" in content["reading"] and content["eye_in_hand"] is False
    assert find(*words, "-q") == 0
    assert capsys.readouterr().out.count("\n") == 1


def test_corners_are_calibrated_first(
    corners_file: Path, write_poses: Write, capsys: Capture
) -> None:
    assert find(corners_file, "--poses", write_poses(names=False)) == 0
    assert "camera in the hand" in read_words(capsys)


def test_a_shifted_order_and_what_is_left_out(
    result_file: Path, write_poses: Write, capsys: Capture
) -> None:
    poses = write_poses(lambda rows: np.roll(rows, 1, axis=0), names=False)
    assert find(result_file, "--poses", poses) == 0
    assert "The order is shifted: each pose stands one line late" in read_words(capsys)
    poses = write_poses(lambda rows: rows[:-1])
    poses.write_text(poses.read_text() + "other.png,1,2,3,4,5,6\n")
    assert find(result_file, "--poses", poses) == 0
    out = read_words(capsys)
    assert "it has no pose" in out and "other.png: there is no such photograph" in out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("RESULT --poses FEW", "has 2 poses, and there are"),
        ("RESULT --poses OTHERS", "names none of the photographs"),
        ("RESULT --poses MISSING", "missing.csv"),
        ("RESULT --poses POSES -o OUT.txt", "is not named as a file of hand and eye"),
        ("RESULT --poses POSES -o POSES", "is not named as a file of hand and eye"),
        ("PHOTOGRAPHS --poses POSES --with RESULT", "The side of a square is not known"),
    ],
)
def test_what_cannot_be_done_is_refused(
    words: str,
    message: str,
    result_file: Path,
    photographs: Path,
    write_poses: Write,
    tmp_path: Path,
    capsys: Capture,
) -> None:
    (tmp_path / "few.csv").write_text("1,2,3,4,5,6\n2,3,4,5,6,7\n")
    (tmp_path / "others.csv").write_text("a.png,1,2,3,4,5,6\nb.png,2,3,4,5,6,7\n")
    files = {"RESULT": result_file, "PHOTOGRAPHS": photographs, "POSES": write_poses()}
    files |= {name: tmp_path / f"{name.lower()}.csv" for name in ("FEW", "OTHERS", "MISSING")}
    given = [
        str(files.get(word, word.replace("OUT", str(tmp_path / "o")))) for word in words.split()
    ]
    assert find(*given) == 1
    assert message in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("RESULT --poses POSES --with RESULT", "a result has its own"),
        ("RESULT --poses POSES --tool 1,2", "is not X,Y,Z"),
        ("RESULT --poses POSES --tool a,b,c", "is not X,Y,Z"),
    ],
)
def test_misuse_is_refused(
    words: str, message: str, result_file: Path, write_poses: Write, capsys: Capture
) -> None:
    files = {"RESULT": result_file, "POSES": write_poses()}
    with pytest.raises(SystemExit):
        find(*(files.get(word, word) for word in words.split()))
    assert message in " ".join(capsys.readouterr().err.split())

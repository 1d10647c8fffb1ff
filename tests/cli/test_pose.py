"""calibgui pose: the board's poses with a camera that is known."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.engine.camera import pixels_from_rays
from calibgui.engine.images import read_colour
from calibgui.formats import read_camera
from calibgui.formats.poses_json import read_pose

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def opencv_file(result_file: Path, tmp_path: Path) -> Path:
    """The result's camera in a file that knows no errors."""
    file = tmp_path / "camera.yaml"
    assert main(["convert", str(result_file), "--export", f"opencv={file}", "-q"]) == 0
    return file


def locate(camera: Path, photographs: Path, *options: str) -> int:
    return main(["pose", str(camera), str(photographs), "--square", "30", *options])


def test_poses_are_those_of_the_calibration(
    result_file: Path, photographs: Path, tmp_path: Path
) -> None:
    table, file = tmp_path / "poses.csv", tmp_path / "poses.json"
    assert locate(result_file, photographs, "-o", str(table), "-o", str(file), "-q") == 0
    stored = {view["image"]: view for view in json.loads(result_file.read_text())["views"]}
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert len(rows) == len(stored)
    camera = read_camera(result_file).camera
    for row in rows:
        view = stored[row["image"]]
        sigma = np.array([float(row[f"sigma_{axis}_mm"]) for axis in "xyz"])
        place = [float(row[f"{axis}_mm"]) for axis in "xyz"]
        turn = np.radians([float(row[f"r{axis}_deg"]) for axis in "xyz"])
        np.testing.assert_allclose(place, view["tvec_mm"], atol=3 * sigma.max())
        np.testing.assert_allclose(turn, view["rvec"], atol=3e-3)
        pose = read_pose(file, camera, Path(row["image"]).name).pose
        np.testing.assert_allclose(pose.tvec, place)
        np.testing.assert_allclose(pose.rvec, turn)


def test_camera_without_errors_is_said(
    opencv_file: Path, photographs: Path, capsys: Capture
) -> None:
    assert locate(opencv_file, photographs) == 0
    out = capsys.readouterr().out
    assert "counts the corners' noise alone" in " ".join(out.split())
    assert "view1.png" in out
    assert max(map(len, out.splitlines())) <= 84  # of rendered photographs, with many digits


def test_json_is_what_is_written(
    opencv_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "poses.json"
    assert locate(opencv_file, photographs, "-o", str(file), "--json") == 0
    assert json.loads(capsys.readouterr().out) == json.loads(file.read_text())


def test_axes_are_drawn_and_nothing_is_overwritten(
    opencv_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    folder, file = tmp_path / "drawn", tmp_path / "poses.json"
    assert locate(opencv_file, photographs, "--draw", str(folder), "-o", str(file), "-q") == 0
    name = "view1.png"
    before = read_colour(photographs / name)
    after = read_colour(folder / name)
    changed = np.argwhere((after != (before if before.ndim == 3 else before[..., None])).any(-1))
    camera = read_camera(opencv_file).camera
    origin = pixels_from_rays(read_pose(file, camera, name).pose.tvec, camera)
    assert np.linalg.norm(changed[:, ::-1] - origin, axis=1).min() < 3
    assert len(changed) < 0.05 * before.shape[0] * before.shape[1]

    # What calibgui drew is drawn again; what somebody else has put there stays.
    assert locate(opencv_file, photographs, "--draw", str(folder), "-q") == 0
    shutil.copy(photographs / name, folder / name)
    assert locate(opencv_file, photographs, "--draw", str(folder), "-q") == 1
    assert "--overwrite" in capsys.readouterr().err
    assert locate(opencv_file, photographs, "--draw", str(photographs), "-q") == 1


def test_wrong_camera_is_said(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    content = json.loads(result_file.read_text())
    content["camera"]["params"]["fx"] *= 1.2
    other = tmp_path / "other.json"
    other.write_text(json.dumps(content))
    assert locate(other, photographs, "-q") == 0
    assert "another camera, zoom or focus" in capsys.readouterr().err


def test_refusals(opencv_file: Path, photographs: Path, tmp_path: Path, capsys: Capture) -> None:
    assert locate(opencv_file, photographs, "-o", str(tmp_path / "poses.txt")) == 1
    assert ".json or .csv" in capsys.readouterr().err
    assert locate(opencv_file, photographs, "-o", str(opencv_file)) == 1
    assert locate(photographs, photographs) == 1
    assert "expect the camera's file first" in capsys.readouterr().err


def test_held_camera_leads_here(corners_file: Path, capsys: Capture) -> None:
    held = ["--model", "pinhole", "--fix", "fx=650,fy=650,cx=320,cy=240"]
    assert main(["calibrate", str(corners_file), *held]) == 1
    assert "calibgui pose" in capsys.readouterr().err

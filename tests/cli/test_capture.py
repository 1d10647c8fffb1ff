"""calibgui capture: a film of a hand becomes pictures, and these a camera."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture import Frame
from calibgui.engine.geometry.pose import Pose
from calibgui.formats.corners_json import read_corners
from calibgui.formats.rig_json import read_rig
from tests.scenes.hand import FRAMES_PER_SECOND, Film, RenderedCamera, Walk, spread_places

CAMERA = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
BOARD = Board(6, 8, 20.0)
POSES = [
    Pose([0.1, -0.1, 0.0], [-75, -50, 330]),
    Pose([0.6, 0.1, 0.1], [-70, -45, 280]),
    Pose([-0.6, 0.2, 0.0], [-75, -55, 330]),
    Pose([0.1, 0.7, 0.05], [-60, -50, 300]),
    Pose([0.0, -0.7, 0.0], [-75, -50, 260]),
]


@pytest.fixture
def film(tmp_path: Path) -> Path:
    frames = Film(CAMERA, BOARD)
    return write_film(
        tmp_path / "film.avi", (frame for pose in POSES for frame in [frames.take(pose)] * 8)
    )


def write_film(file: Path, frames: Iterable[Frame]) -> Path:
    fourcc = cv2.VideoWriter_fourcc(*"FFV1")
    writer = cv2.VideoWriter(str(file), fourcc, FRAMES_PER_SECOND, CAMERA.size)
    if not writer.isOpened():
        pytest.skip("this OpenCV writes no FFV1")
    for frame in frames:
        writer.write(np.repeat(frame.image[:, :, None], 3, axis=2))
    writer.release()
    return file


def test_a_film_becomes_pictures_and_a_camera(
    film: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "pictures"
    assert main(["capture", str(film), "-o", str(folder), "--square", "20", "--until", "0.01"]) == 0
    said = capsys.readouterr().out
    pictures = sorted(folder.glob("*.png"))
    assert 3 <= len(pictures) <= len(POSES)
    assert said.count(" taken") == len(pictures)
    assert "Next: Hold the board towards" in said
    corner_set = read_corners(folder / "corners.json")
    assert [Path(view.image).name for view in corner_set.views] == [p.name for p in pictures]
    assert corner_set.board == BOARD
    assert main(["calibrate", str(folder / "corners.json"), "-q"]) == 0
    assert main(["capture", str(film), "-o", str(folder)]) != 0
    assert "holds pictures of another capture" in capsys.readouterr().err


def test_two_films_become_the_pictures_of_a_rig(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    beside = Pose([0.01, -0.12, 0.0], [-60.0, 1.0, 6.0])
    walk = Walk(spread_places(BOARD, 5, np.array([30.0, 0.0, 330.0])), hold=0.32, move=0.0)
    films = []
    for name, pose in (("left", Pose([0, 0, 0], [0, 0, 0])), ("right", beside)):
        camera = RenderedCamera(CAMERA, pose, BOARD, walk, seconds=walk.seconds)
        films.append(write_film(tmp_path / f"{name}.avi", iter(camera.read, None)))
    folder = tmp_path / "pictures"
    options = ["--square", "20", "--until", "0.3"]
    assert main(["capture", *map(str, films), "-o", str(folder), *options]) == 0
    said = capsys.readouterr().out
    assert "cam0 and cam1: 1 common view." in said
    assert f"Now: calibgui rig {folder}" in said
    names = [sorted(file.name for file in (folder / f"cam{c}").glob("*.png")) for c in (0, 1)]
    assert 3 <= len(names[0]) <= 5
    assert names[0] == names[1]
    rows = (folder / "times.csv").read_text().splitlines()
    assert rows[0] == "file,time_s"
    assert len(rows) == 1 + 2 * len(names[0])
    rig = tmp_path / "rig.json"
    assert main(["rig", str(folder), "--square", "20", "-o", str(rig), "-q"]) == 0
    (_, pose) = read_rig(rig).rig.poses
    assert pose.tvec == pytest.approx(beside.tvec, abs=2.0)


def test_a_source_that_shows_no_board_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    out = str(tmp_path / "out")
    assert main(["capture", str(folder), "-o", out, "--patience", "0.3"]) != 0
    assert "showed no board" in capsys.readouterr().err

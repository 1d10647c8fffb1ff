"""calibgui rig with several boards, from photographs in which cameras see different ones."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import calibgui
from calibgui.cli.main import main
from calibgui.engine.errors import CalibrationError
from calibgui.formats.rig_json import read_rig
from tests.engine.rig.drawn_boards import FIRST, PLACE, POSE, SECOND, write_photographs

Capture = pytest.CaptureFixture[str]
BOARDS = ["--target", "charuco", "--dictionary", "DICT_4X4_50", "--board", "4x5", "--square", "28"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("boards")
    write_photographs(folder)
    return folder


def calibrate(folder: Path, *options: str) -> int:
    return main(["rig", str(folder), *BOARDS, "--model", "pinhole", *options])


def test_cameras_that_never_see_one_board_are_joined_by_two(
    folder: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "rig.json"
    assert calibrate(folder, "--another", "--first-marker 15", "-o", str(file)) == 0
    printed = capsys.readouterr().out
    assert re.search(r"board 2\s+board 1\s+mm\s+1[56]\d\.\d", printed)
    result = read_rig(file)
    rig = result.rig
    assert [board.name for board in rig.placed_boards] == ["board 1", "board 2"]
    assert [board.pattern.first_marker for board in result.boards] == [0, 15]
    for found, sigma, true in (
        (rig.poses[1], rig.pose_sigma(1), POSE),
        (rig.placed_boards[1].pose, rig.board_sigma(1), PLACE),
    ):
        away = np.r_[found.rvec - true.rvec, found.tvec - true.tvec]
        assert (np.abs(away) < 4 * sigma).all()
        assert (0 < sigma).all() and (sigma[3:] < 5).all()
    assert {(view.camera, view.board) for view in rig.views} == {(0, 0), (0, 1), (1, 1)}
    assert len(json.loads(file.read_text())["boards"]) == 2
    assert main(["stereo", str(file), "-o", str(tmp_path / "stereo")]) == 0
    assert "They never see a corner together; the cameras are 70" in capsys.readouterr().out


def test_a_place_that_is_stated_is_held(folder: Path, tmp_path: Path) -> None:
    file = tmp_path / "rig.json"
    turn = np.degrees(PLACE.rvec).tolist()
    place = ",".join(map(str, [*PLACE.tvec.tolist(), *turn]))
    assert calibrate(folder, "--another", f"--first-marker 15 --place {place}", "-q",
                     "-o", str(file)) == 0  # fmt: skip
    rig = read_rig(file).rig
    np.testing.assert_allclose(rig.placed_boards[1].pose.tvec, PLACE.tvec)
    assert not rig.board_sigma(1).any()


def test_in_python(folder: Path) -> None:
    rig = calibgui.calibrate_rig(folder, boards=[FIRST, SECOND], model="pinhole", board_shape="bow")
    first, second = rig.boards
    assert np.linalg.norm(second.pose.tvec - PLACE.tvec) < 1.0
    assert first.shape is not None and first.shape.rms < 0.5
    assert "Translation and rotation vector of boards" in str(rig)
    with pytest.raises(CalibrationError, match="'bent'"):
        calibgui.calibrate_rig(folder, boards=[FIRST, SECOND], board_shape="bent")


@pytest.mark.parametrize(
    ("another", "says"),
    [
        ("", "markers 0 to 14 of DICT_4X4 are on board 1 and on board 2"),
        ("--first-marker 10", "markers 10 to 14 of DICT_4X4.*from 15 on.*--first-marker N"),
        ("--dictionary DICT_4X4_1000", "markers 0 to 14 of DICT_4X4 are"),
        ("--target checkerboard --board 5x6", "Nothing is stated of board 2 that tells it"),
        ("--target aprilgrid --family t36h11", "The kind or the size of board 2 is not stated"),
        ("--first-marker 15 --first-marker 30 --target aprilgrid", "--first-marker is for"),
    ],
)
def test_boards_that_are_not_told_apart(
    folder: Path, capsys: Capture, another: str, says: str
) -> None:
    try:
        assert calibrate(folder, "--another", another) == 1
    except SystemExit as ended:
        assert ended.code == 2
    assert re.search(says, " ".join(capsys.readouterr().err.split()))


@pytest.mark.parametrize("another", ["--place 1,2,3", "--bord 4x5", "'--board 4x5"])
def test_wrong_options_of_another_board(folder: Path, capsys: Capture, another: str) -> None:
    with pytest.raises(SystemExit) as ended:
        calibrate(folder, "--another", another)
    assert ended.value.code == 2
    assert "--another" in capsys.readouterr().err


def test_a_board_that_no_photograph_shows(folder: Path, capsys: Capture) -> None:
    assert calibrate(folder, "--another", "--first-marker 15",
                     "--another", "--first-marker 30") == 1  # fmt: skip
    assert "No photograph shows board 3" in capsys.readouterr().err


def test_boards_that_leave_cameras_apart(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    """Without the instants at which left sees both boards nothing joins the cameras."""
    for path in folder.iterdir():
        if int(re.findall(r"\d+", path.stem)[0]) > 6:
            (tmp_path / path.name).write_bytes(path.read_bytes())
    assert calibrate(tmp_path, "--another", "--first-marker 15") == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "left (see board 1); right (see board 2)" in said
    assert "state how these boards stand to each other" in said

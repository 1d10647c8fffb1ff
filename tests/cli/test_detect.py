"""calibgui detect: photographs to corners.json."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.photographs.detection import Detection
from calibgui.cli import corners
from calibgui.cli.arguments import search_images
from calibgui.cli.main import main
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.images import Field
from calibgui.engine.images.reading import write_image
from calibgui.formats.corners_json import read_corners
from tests.engine.conftest import Scene
from tests.photographs import BOARD, CAMERA, COUNT

Capture = pytest.CaptureFixture[str]


def test_corners_are_written_and_listed(photographs: Path, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "corners.json"
    assert main(["detect", str(photographs), "--square", "30", "-o", str(file)]) == 0
    corner_set = read_corners(file)
    assert corner_set.size == CAMERA.size and corner_set.board == BOARD
    assert [view.image for view in corner_set.views] == [
        str(photographs / f"view{k}.png") for k in range(1, COUNT + 1)
    ]
    printed = capsys.readouterr().out
    assert f"The board was found in {COUNT} of {COUNT} images." in printed
    assert "6 x 7" in printed


def test_without_a_square_it_says_what_to_do(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "corners.json"
    assert main(["detect", str(photographs), "-o", str(file)]) == 0
    assert "Squares count as 30 mm until --square states" in capsys.readouterr().out
    assert not read_corners(file).lengths_confirmed


@pytest.mark.parametrize("command", ["detect", "calibrate"])
def test_how_the_size_was_counted_is_said(
    command: str, photographs: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def search(*args: object) -> Detection:
        return replace(search_images(*args), remark="Counted so.")  # type: ignore[arg-type]

    monkeypatch.setattr(corners, "search_images", search)
    assert main([command, str(photographs), "--square", "30"]) == 0
    assert "Counted so." in capsys.readouterr().out


@pytest.mark.parametrize("command", ["detect", "calibrate"])
def test_folders_that_were_not_read_are_said(
    command: str, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    shutil.copytree(photographs, tmp_path / "all")
    shutil.copytree(photographs, tmp_path / "all" / "more")
    assert main([command, str(tmp_path / "all"), "--square", "30"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert f"Not read: {tmp_path / 'all' / 'more'} (" in said


def test_of_a_folder_of_folders_those_with_images_are_named(
    tmp_path: Path, capsys: Capture
) -> None:
    (tmp_path / "left").mkdir()
    (tmp_path / "left" / "1.png").touch()
    assert main(["detect", str(tmp_path), "-o", str(tmp_path / "corners.json")]) == 1
    problems = " ".join(capsys.readouterr().err.split())
    assert "but there are some in left (1 image)." in problems
    assert f"as {tmp_path / 'left'}." in problems


def test_json_is_the_content_of_the_file(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "corners.json"
    assert main(["detect", str(photographs), "--json", "-o", str(file)]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(file.read_text())


def test_no_board_is_a_failure_with_every_reason(tmp_path: Path, capsys: Capture) -> None:
    write_image(tmp_path / "blank.png", np.full((240, 320), 99, np.uint8))
    file = tmp_path / "corners.json"
    assert main(["detect", str(tmp_path), "-o", str(file)]) == 1
    printed, problems = capsys.readouterr()
    assert printed == "" and not file.exists()
    assert "blank.png: No checkerboard was found." in problems
    assert "found in none of the images" in problems


@pytest.mark.parametrize("command", [["detect"], ["calibrate", "--square", "30"]])
def test_a_board_of_another_size_is_said_once(
    command: list[str], photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    shutil.copy(photographs / "view1.png", tmp_path)
    shutil.copy(photographs / "view2.png", tmp_path)
    (tmp_path / "text.png").write_text("no image")
    assert main([*command, str(tmp_path), "--board", "5x9"]) == 1
    printed, problems = capsys.readouterr()
    assert printed == ""
    head, unreadable, *_, last = problems.splitlines()
    assert head == "Left out" and "text.png" in unreadable and "view1.png" not in problems
    assert last == (
        "calibgui: The images show a board of 6x7, not of 5x9. State --board 6x7, or leave --board "
        "out."
    )


def test_a_board_of_another_kind_is_named(tmp_path: Path, capsys: Capture) -> None:
    scene = Scene(Board(5, 6, 16.0, Charuco("DICT_4X4_50", 0.75)))
    write_image(tmp_path / "a.png", scene.image(noise=2.0))
    assert main(["detect", str(tmp_path), "--target", "checkerboard"]) == 1
    printed, problems = capsys.readouterr()
    assert printed == ""
    assert problems == (
        "calibgui: The images show a ChArUco board, not a checkerboard. State --target charuco; if "
        "another board is meant, --roi says where it is.\n"
    )


def test_quiet_is_one_line(photographs: Path, capsys: Capture) -> None:
    assert main(["detect", str(photographs), "-q"]) == 0
    assert capsys.readouterr() == (f"The board was found in {COUNT} of {COUNT} images.\n", "")


def test_no_readable_image_is_a_failure(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "text.png").write_text("no image")
    assert main(["detect", str(tmp_path)]) == 1
    assert "text.png is not an image" in capsys.readouterr().err


def test_one_field_of_interlaced_frames_is_used(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "corners.json"
    image = str(photographs / "view1.png")
    assert main(["detect", image, "--square", "30", "--field", "even", "-o", str(file)]) == 0
    (view,) = read_corners(file).views
    assert view.field is Field.EVEN and view.corners is not None
    with pytest.raises(SystemExit):
        main(["calibrate", str(file), "--field", "odd"])
    assert "for photographs" in capsys.readouterr().err

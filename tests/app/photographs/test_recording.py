"""A board that showed but a part of itself at first is known as soon as all of it is seen."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from calibgui.app.photographs.recording import BoardFinder, Recorder, begin_session
from calibgui.engine.boards import CHECKERBOARD, Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture import PairedFrames
from calibgui.engine.errors import OtherSizeError
from calibgui.engine.geometry.pose import Pose
from tests.scenes.hand import Film

CAMERA = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
BOARD = Board(6, 8, 20.0)
WHOLE, PART = Pose([0.1, -0.1, 0], [-75, -50, 330]), Pose([0.1, -0.1, 0], [60, -50, 320])


def test_pictures_of_a_part_are_found_again_when_the_whole_board_is_seen(tmp_path: Path) -> None:
    film = Film(CAMERA, BOARD)
    frames = iter([film.take(pose) for pose in (PART, PART, WHOLE, WHOLE)])
    source = SimpleNamespace(
        title="a folder",
        remark="",
        is_continuous=False,
        is_live=False,
        read=lambda: next(frames, None),
        close=lambda: None,
    )
    session = begin_session(1, BoardFinder(CHECKERBOARD, None), BOARD.square, 0.01)
    recorder = Recorder(session, tmp_path)
    sizes = []
    for recorded in recorder.record(PairedFrames([source], 1.0), lambda: False):
        (taken,) = recorded.state.taken
        assert taken is not None
        sizes.append(taken.corners.shape)
        if len(sizes) in (2, 3):  # taken back when a part is known, and again when all of it is
            recorder.ask_to_toggle(tmp_path / "picture-001.png")
    assert sizes[0] == sizes[1] < sizes[2] == sizes[3] == BOARD.grid_size
    found = [view.corners for view in recorder.list_views() if view.corners]
    assert [each.shape for each in found] == 4 * [BOARD.grid_size]
    assert [each.complete for each in found] == [False, False, True, True]
    (camera,) = session.cameras
    assert camera.calibration is not None
    assert len(camera.calibration.poses) == 4


def test_a_stated_size_is_not_doubted() -> None:
    with pytest.raises(OtherSizeError):
        BoardFinder(CHECKERBOARD, (6, 5))(Film(CAMERA, BOARD).take(WHOLE).image)

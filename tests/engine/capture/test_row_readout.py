"""The time in which rows are read is told by a moving board, and only where it takes time."""

from __future__ import annotations

import re

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.board_poses import locate_board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.capture.row_readout import RowReadout
from calibgui.engine.capture.session import CaptureSession
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.geometry.pose import Pose
from tests.scenes.hand import Film, Walk, spread_places

CAMERA = Camera((640, 480), [600, 600, 317, 243, -0.1, 0.02, 0, 0, 0], "brown-conrady")
BOARD = Board(7, 10, 25.0)
XY = BOARD.points()
FRAME_SECONDS = 0.04


def _see(begin: Pose, velocity: Array, seconds: float, readout: float) -> Array:
    """The corners of a board that moves by (rad/s, mm/s), in rows read one after the other."""
    begins, middles, ends = (
        project_points(XY, CAMERA, _move(begin, velocity, seconds + part * readout))
        for part in (0.0, 0.5, 1.0)
    )
    uv = begins
    for _ in range(4):  # a parabola through the three, at the time of each row
        row = uv[:, 1:] / CAMERA.size[1]
        bend = begins - 2 * middles + ends
        uv = begins + row * (ends - begins) + 2 * row * (row - 1) * bend
    return uv


def _move(begin: Pose, velocity: Array, seconds: float) -> Pose:
    return Pose(begin.rvec + seconds * velocity[:3], begin.tvec + seconds * velocity[3:])


@pytest.mark.parametrize("readout", [0.02, -0.02, 0.0])
def test_rows_that_take_time_are_told_in_ms(readout: float) -> None:
    rng = np.random.default_rng(1)
    found = RowReadout()
    for k in range(6):
        begin = Pose(rng.normal(0, 0.3, 3), [-110, -75, 420 + 20 * k])
        velocity = np.concatenate([rng.normal(0, 0.5, 3), rng.normal(0, 150, 3)])
        before, after = (
            _see(begin, velocity, t, readout) + rng.normal(0, 0.03, (len(XY), 2))
            for t in (0.0, FRAME_SECONDS)
        )
        pose = locate_board(CAMERA, (after, XY)).pose
        found.add_frame(CAMERA, pose, XY, after, (after - before) / FRAME_SECONDS)
    time, sigma = found.estimate()
    assert sigma < 1e-3
    assert time == pytest.approx(readout, abs=0.1 * abs(readout) + 3 * sigma)
    assert ("over 20 ± " in found.describe()) == bool(readout)
    assert bool(found.describe()) == bool(readout)


def test_a_board_at_rest_tells_nothing() -> None:
    found = RowReadout()
    pose = Pose([0.1, -0.1, 0], [-110, -75, 420])
    for _ in range(3):
        found.add_frame(CAMERA, pose, XY, project_points(XY, CAMERA, pose), np.zeros((len(XY), 2)))
    assert found.describe() == ""


@pytest.mark.parametrize("readout", [0.025, 0.0])
def test_a_rendered_film_tells_it_from_the_tracked_motion(readout: float) -> None:
    camera = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
    board = Board(6, 8, 20.0)
    places = spread_places(board, 9, np.array([0.0, 0.0, 330.0]))
    film = Film(camera, board)
    session = CaptureSession(lambda image: find_corners(image, board.grid_size), 20.0, 1e-3)
    for pose in places[:6]:
        assert session.take(film.take(pose)) is not None
    walk = Walk(places[6:], hold=0.0, move=2.0)
    for k in range(14):
        session.observe(film.roll(walk, 0.21 * k, readout), is_live=False)
    said = session.describe_readout()
    if not readout:
        assert said == ""
    else:
        found = re.match(r"Rolling shutter: rows are read over (\d+) ± (\d+) ms", said)
        assert found, said
        assert abs(float(found[1]) - 25) <= 2 * float(found[2]) + 1

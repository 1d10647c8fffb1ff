"""A board whose white or black is cut off is said, however marks or a lamp's reflection lie."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.capture.exposure import TOO_BRIGHT, TOO_DARK, judge_exposure
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import render_view

BOARD = Board(6, 8, 20.0)
CAMERA = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
POSE = Pose([0.1, -0.1, 0.0], [-75, -50, 330])


@pytest.mark.parametrize(
    ("gain", "offset", "said"),
    [(1.0, 0.0, ""), (1.6, 0.0, TOO_BRIGHT), (1.0, -60.0, TOO_DARK), (0.2, 0.0, "")],
)
def test_levels_that_are_cut_off_are_said(gain: float, offset: float, said: str) -> None:
    uv = project_points(BOARD.points(), CAMERA, POSE)
    corners = Corners(BOARD.grid_size, np.indices(BOARD.grid_size).reshape(2, -1).T, uv, uv)
    grey = render_view(CAMERA, POSE, BOARD, blur=0.7, noise=4.0, seed=1)
    exposed = np.clip(gain * grey.astype(float) + offset, 0, 255).round().astype(np.uint8)
    assert judge_exposure(exposed, corners) == said

"""A result whose views are quickly rendered and searched."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui import engine
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from tests.engine import scenes

BOARD = Board(rows=6, cols=7, square=30.0)
CAMERA = Camera((200, 150), [200.0, 204.0, 97.0, 76.0, 0.2, 0.05, 0.0, 1e-3, -1e-3, 0.0])


def small_result(board: Board = BOARD, turned: bool = False) -> Result:
    """Five small views of which the second has lost corners, after an image without a board.

    `turned` holds the board upside down.
    """
    rng = np.random.default_rng(3)
    poses = [scenes.looking(CAMERA, rng, fill=(0.7, 0.8), board=board) for _ in range(5)]
    if turned:
        poses = [_turned(pose, board) for pose in poses]
    scene = scenes.seen(CAMERA, poses, board, partial=True)
    views = [View("blank.png", ViewStatus.NO_BOARD, "No board.")]
    for k, view in enumerate(scene.noisy(0.05, rng)):
        kept = slice(7 if k == 1 else 0, None)
        grid = np.rint(view.xy[kept, ::-1] / board.square)
        corners = Corners((board.rows, board.cols), grid, view.uv[kept], view.uv[kept])
        views.append(View(f"{k}.png", ViewStatus.FOUND, corners=corners))
    observations = [view.observation(board) for view in views if view.usable]
    calibration = engine.calibrate(observations, CAMERA.size, fix={"k3": 0.0, "k2": 0.05})
    return Result(calibration, tuple(views), board)


def _turned(pose: Pose, board: Board) -> Pose:
    """The pose with the board turned by half about its middle."""
    R = Rotation.from_rotvec(np.array(pose.rvec))
    farthest = np.array([board.cols - 1, board.rows - 1, 0]) * board.square
    half = Rotation.from_euler("z", np.pi)
    return Pose((R * half).as_rotvec(), pose.tvec + R.apply(farthest))

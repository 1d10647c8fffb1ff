"""A result whose views are quickly rendered and searched."""

from __future__ import annotations

import numpy as np

from calibgui import engine
from calibgui.engine.types import Camera, Corners, Target, View, ViewStatus
from calibgui.formats.result import Result
from tests.engine import scenes

BOARD = Target(rows=6, cols=7, square=30.0)
CAMERA = Camera((200, 150), [200.0, 204.0, 97.0, 76.0, 0.2, 0.05, 0.0, 1e-3, -1e-3, 0.0])


def small_result() -> Result:
    """Five small views of which the second has lost corners, after an image without a board."""
    rng = np.random.default_rng(3)
    poses = [scenes.looking(CAMERA, rng, fill=(0.7, 0.8), board=BOARD) for _ in range(5)]
    scene = scenes.seen(CAMERA, poses, BOARD, partial=True)
    views = [View("blank.png", ViewStatus.NO_BOARD, "No board.")]
    for k, view in enumerate(scene.noisy(0.05, rng)):
        kept = slice(7 if k == 1 else 0, None)
        grid = np.rint(view.xy[kept, ::-1] / BOARD.square)
        corners = Corners((6, 7), grid, view.uv[kept], view.uv[kept])
        views.append(View(f"{k}.png", ViewStatus.FOUND, corners=corners))
    observations = [view.observation(BOARD) for view in views if view.usable]
    calibration = engine.calibrate(observations, CAMERA.size, fix={"k3": 0.0, "k2": 0.05})
    return Result(calibration, tuple(views), BOARD)

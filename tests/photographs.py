"""A folder of small rendered photographs of a board, with known truth."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes

BOARD = Board(rows=6, cols=7, square=30.0)
CAMERA = Camera((320, 240), [330.0, 333.0, 155.0, 122.0, 0.2, 0.05, 0.0, 3e-4, -4e-4, 0.0])
COUNT = 6


def draw_poses() -> list[Pose]:
    """Return the pose of the board in each photograph."""
    rng = np.random.default_rng(5)
    return [scenes.looking(CAMERA, rng, fill=(0.5, 0.6), board=BOARD) for _ in range(COUNT)]


def write_photographs(folder: Path) -> None:
    """Write view1.png to view6.png."""
    for number, pose in enumerate(draw_poses(), start=1):
        image = render_view(CAMERA, pose, BOARD, blur=0.7, noise=1.0, seed=number)
        write_image(folder / f"view{number}.png", image)

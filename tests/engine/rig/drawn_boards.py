"""Photographs of two boards that stand fast to each other, which two cameras never see together."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.engine.boards import Board, Charuco
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.images import write_image
from calibgui.engine.images.rendering import Appearance, render_view
from tests.engine.rig.scenes import compose

FIRST = Board(4, 5, 28.0, Charuco("DICT_4X4_50", 0.7, False, 0))
SECOND = Board(4, 5, 28.0, Charuco("DICT_4X4_50", 0.7, False, 15))
LEFT = Camera((480, 360), [420, 420, 240, 180], "pinhole")
RIGHT = Camera((480, 360), [430, 430, 236, 184], "pinhole")
POSE = Pose([0.01, -0.08, 0.02], [-70.0, 2.0, 4.0])
PLACE = Pose([0.05, 0.35, 0.1], [160.0, 8.0, -15.0])
"""Where the second board stands beside the first."""
INSTANTS = 12
_SHOWN = Appearance(background=220.0)


def _draw(camera: Camera, first: Pose, boards: tuple[Board, ...]) -> np.ndarray:
    """A photograph of some of the boards; what is around them is as bright as paper."""
    places = {FIRST: Pose(np.zeros(3), np.zeros(3)), SECOND: PLACE}
    images = [
        render_view(camera, compose(first, places[board]), board, blur=0.7, appearance=_SHOWN)
        for board in boards
    ]
    return np.min(images, axis=0)


def write_photographs(folder: Path) -> None:
    """Write photographs of two cameras: at the last instants left sees the first board only and
    right the second one, at the others left sees both and right none."""
    rng = np.random.default_rng(2)
    middle = np.array([135.0, 45.0, 0.0])
    for k in range(INSTANTS):
        tilt = 0.4 * np.array([np.cos(2.4 * k), np.sin(2.4 * k), 0.1])
        at = np.array([10 + 20 * np.cos(k), 25 * np.sin(2 * k), 360.0 + 12 * k])
        first = Pose(tilt, at - rotation_from_vector(tilt) @ middle)
        is_shared = k >= 6
        shown = {"left": (FIRST,) if is_shared else (FIRST, SECOND)}
        shown |= {"right": (SECOND,)} if is_shared else {}
        for name, boards in shown.items():
            camera = LEFT if name == "left" else RIGHT
            image = _draw(camera, first if name == "left" else compose(POSE, first), boards)
            noisy = np.clip(image + rng.normal(0, 2, image.shape), 0, 255).astype(np.uint8)
            write_image(folder / f"{name}{k + 1}.png", noisy)

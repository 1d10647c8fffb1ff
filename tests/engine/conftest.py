"""Targets of every pattern, seen by a camera with known truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.rendering import render_view
from tests.engine.drawn_boards import Draw, draw_board

CAMERA = Camera((1000, 750), [860.0, 863.0, 500.0, 370.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])


@dataclass(frozen=True)
class Scene:
    """A target in front of a camera."""

    board: Board
    camera: Camera = CAMERA
    rvec: tuple[float, float, float] = (0.5, 0.3, 0.2)
    distance: float = 320.0
    aside: tuple[float, float] = (0.0, 0.0)
    """Of the target's middle, mm."""

    @property
    def pose(self) -> Pose:
        R = rotation_from_vector(np.array(self.rvec))
        middle = R[:, :2] @ self.board.points().mean(axis=0)
        return Pose(self.rvec, np.array([*self.aside, self.distance]) - middle)

    def image(self, blur: float = 0.7, noise: float = 2.0, seed: int = 0) -> GreyImage:
        return _rendered(self, blur, noise, seed).copy()

    def error(self, corners: Corners) -> Array:
        """(n, 2) px, found minus true."""
        xy = self.board.points(corners.grid)
        return corners.uv - project_points(xy, self.camera, self.pose)


@cache
def _rendered(scene: Scene, blur: float, noise: float, seed: int) -> GreyImage:
    """Takes seconds, and several tests look at the same."""
    return render_view(scene.camera, scene.pose, scene.board, blur=blur, noise=noise, seed=seed)


@pytest.fixture
def scene() -> type[Scene]:
    return Scene


@pytest.fixture(scope="session")
def draw() -> Draw:
    return draw_board

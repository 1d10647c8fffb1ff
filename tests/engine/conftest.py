"""Targets of every pattern, seen by a camera with known truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.rendering import compute_irradiance
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
        """As `render_view`; draws of the noise share the light, whose rendering takes long."""
        levels = _light(self, blur)
        if noise > 0:
            levels = levels + noise * np.random.default_rng(seed).standard_normal(levels.shape)
        return np.clip(np.rint(levels), 0, 255).astype(np.uint8)

    def error(self, corners: Corners) -> Array:
        """(n, 2) px, found minus true."""
        xy = self.board.points(corners.grid)
        return corners.uv - project_points(xy, self.camera, self.pose)


@lru_cache(maxsize=16)
def _light(scene: Scene, blur: float) -> Array:
    """Several tests look at the same."""
    return compute_irradiance(scene.camera, scene.pose, scene.board, blur=blur)


@pytest.fixture
def scene() -> type[Scene]:
    return Scene


@pytest.fixture(scope="session")
def draw() -> Draw:
    return draw_board

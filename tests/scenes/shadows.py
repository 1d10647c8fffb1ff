"""Photographs of boards of any pattern, with the edge of a shadow over them."""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.rendering import Appearance, compute_irradiance
from tests.scenes.photograph import Array, Photograph, add_noise, as_bytes

_SIZE = (640, 480)
_PARTS = 3
"""Into which each pixel is divided both ways."""
_INK = 45.0


def cast_shadow(board: Board, seed: int, depth: float, penumbra: float) -> Photograph:
    """A board that fills two thirds of the image, over which the bent edge of a shadow runs.

    Args:
        board: of any pattern.
        seed: of pose, edge and noise.
        depth: how much of the light the shadow takes; the ink keeps its level.
        penumbra: width of the edge, px.
    """
    rng = np.random.default_rng([seed, 111])
    light, corners = _draw_lit(board, (*rng.uniform(-0.45, 0.45, 2), rng.uniform(-0.5, 0.5)))

    v, u = np.mgrid[: light.shape[0], : light.shape[1]]
    place = corners[rng.integers(len(corners))] + rng.uniform(-10, 10, 2) * _PARTS
    turn, bend = rng.uniform(0, 2 * np.pi), rng.uniform(-1e-3, 1e-3) / _PARTS
    du, dv = u - place[0], v - place[1]
    along = np.cos(turn) * dv - np.sin(turn) * du
    across = np.cos(turn) * du + np.sin(turn) * dv + bend * along**2
    share = np.clip(across / (penumbra * _PARTS) + 0.5, 0, 1)
    share = share**2 * (3 - 2 * share)
    levels = _INK + (light - _INK) * (1 - depth * share)
    levels = cv2.GaussianBlur(levels, (0, 0), 0.7 * _PARTS)
    levels = np.asarray(cv2.resize(levels, _SIZE, interpolation=cv2.INTER_AREA))
    uv: Array = ((corners + 0.5) / _PARTS - 0.5).reshape(board.rows, board.cols, 2)
    return Photograph(as_bytes(add_noise(levels, 2.0, seed)), (uv,))


@lru_cache(maxsize=1)
def _draw_lit(board: Board, rvec: tuple[float, float, float]) -> tuple[Array, Array]:
    """Return the levels of the parts of the pixels without a shadow, and the corners (n, 2) in
    them; it takes most of the time, and several shadows fall on the same board."""
    middle = (np.array(_SIZE) * _PARTS - 1) / 2
    focal = 560.0 * _PARTS
    lens = np.array([focal, focal, *middle, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
    camera = Camera((_SIZE[0] * _PARTS, _SIZE[1] * _PARTS), lens)
    points = board.points()
    distance = 560.0 * float(np.ptp(points, axis=0).max()) / (0.62 * _SIZE[0])
    aside = rotation_from_vector(np.array(rvec))[:, :2] @ points.mean(axis=0)
    pose = Pose(rvec, np.array([0.0, 0.0, distance]) - aside)
    light = compute_irradiance(camera, pose, board, appearance=Appearance(_INK, 205.0))
    return light, project_points(points, camera, pose)

"""Lens and pose of the camera of the rendered photographs, both ways in closed form."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]


class Camera:
    """Lens and pose, both ways."""

    def __init__(self, conditions: Conditions, rng: np.random.Generator) -> None:
        self._conditions = conditions
        width, height = conditions.size
        self._centre = np.array([(width - 1) / 2, (height - 1) / 2])
        self._half = np.hypot(width, height) / 2
        self._f = conditions.focal * width
        turn = np.radians(conditions.turn) * rng.uniform(-1, 1)
        about = rng.uniform(0, 2 * np.pi)
        axis = np.array([np.cos(about), np.sin(about), 0.0]) * np.radians(conditions.tilt)
        tilt, _ = cv2.Rodrigues(axis)
        spin, _ = cv2.Rodrigues(np.array([0.0, 0.0, turn]))
        rows, cols = conditions.grid_size
        down = conditions.aspect
        origin = np.array([(cols - 1) / 2, down * (rows - 1) / 2, 0.0])
        shift = conditions.shift * rng.uniform(-1, 1, 2)
        R = tilt @ spin
        distance = self._f / conditions.square
        t = distance * np.append((shift + conditions.centre) / self._f, 1.0) - R @ origin
        self._H = np.column_stack([R[:, 0], down * R[:, 1], t])

    def board_from_image(self, u: Array, v: Array) -> tuple[Array, Array]:
        """The board's points at pixels: `u` (1, w) and `v` (h, 1) stand for a whole image."""
        qx, qy = u - self._centre[0], v - self._centre[1]
        if self._conditions.fisheye:
            theta = np.sqrt(qx * qx + qy * qy) / self._f
            scale, depth = np.sinc(theta / np.pi) / self._f, np.cos(theta)
        elif self._conditions.distortion:
            r2 = qx * qx + qy * qy
            scale = (1 + self._conditions.distortion * r2 / self._half**2) / self._f
            depth = 1.0
        elif self._conditions.k1:
            r = np.sqrt(qx * qx + qy * qy) / self._f
            scale, depth = _invert_cubic(r, self._conditions.k1) / self._f, 1.0
        else:
            scale, depth = 1 / self._f, 1.0
        ray = (scale * qx, scale * qy, depth)
        px, py, pz = (a * ray[0] + b * ray[1] + c * ray[2] for a, b, c in np.linalg.inv(self._H))
        with np.errstate(divide="ignore", invalid="ignore"):
            x, y = px / pz, py / pz
        behind = pz <= 0
        x[behind] = y[behind] = np.inf
        return x, y

    def image_from_board(self, x: Array, y: Array) -> Array:
        ray = np.stack([x, y, np.ones_like(x)], axis=-1) @ self._H.T
        if self._conditions.fisheye:
            r = np.linalg.norm(ray[..., :2], axis=-1)
            theta = np.arctan2(r, ray[..., 2])
            q = ray[..., :2] * (self._f * theta / np.maximum(r, 1e-300))[..., None]
            return q + self._centre
        ideal = self._f * ray[..., :2] / ray[..., 2:]
        if self._conditions.k1:
            r2 = np.sum(ideal**2, axis=-1, keepdims=True) / self._f**2
            return np.asarray(ideal * (1 + self._conditions.k1 * r2) + self._centre)
        goal = np.linalg.norm(ideal, axis=-1)
        d = self._conditions.distortion / self._half**2
        r = goal.copy()
        for _ in range(50):  # Newton on r (1 + d r^2) = goal
            r -= (r * (1 + d * r * r) - goal) / (1 + 3 * d * r * r)
        return ideal * (r / np.maximum(goal, 1e-300))[..., None] + self._centre


def _invert_cubic(r: Array, k1: float) -> Array:
    """x / r, where x (1 + k1 x^2) = `r`, by Newton's steps; infinite where no point is seen."""
    last = np.sqrt(-1 / (3 * k1)) if k1 < 0 else np.inf
    x = np.minimum(r, last)
    for _ in range(30):
        x = np.minimum(x - (x * (1 + k1 * x * x) - r) / np.maximum(1 + 3 * k1 * x * x, 0.01), last)
    seen = np.abs(x * (1 + k1 * x * x) - r) < 1e-9
    return np.where(seen, x / np.maximum(r, 1e-300), np.inf)

"""What hides a part of the board: an object that lies on it, a hand that holds it."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.scenes.camera import Camera
from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]
_FRACTION = 16
"""Of a pixel, to which cv2 draws."""


def occluder(
    conditions: Conditions, camera: Camera, rng: np.random.Generator
) -> tuple[NDArray[np.bool_], Array]:
    """Where the finely divided image (h, w) shows it, and its reflectance there."""
    width, height = conditions.size
    mask = np.zeros((height * conditions.parts, width * conditions.parts), np.uint8)
    draw = {"object": _object, "hand": _hand}[conditions.occluder]
    draw(mask, conditions, camera, rng)
    v, u = np.mgrid[: mask.shape[0], : mask.shape[1]] / (conditions.square * conditions.parts)
    about, waves = rng.uniform(0, 2 * np.pi), rng.uniform(1, 4, 2)
    shade = 0.5 + 0.05 * (np.cos(about) * u + np.sin(about) * v)
    shade += 0.2 * np.sin(waves[0] * u + waves[1] * v) + rng.uniform(-0.2, 0.2)
    return mask.astype(np.bool_), np.clip(shade, 0, 1)


def _object(
    mask: NDArray[np.uint8], conditions: Conditions, camera: Camera, rng: np.random.Generator
) -> None:
    """A smooth blob of 1.2 to 2.2 squares' radius near the board's middle."""
    rows, cols = conditions.grid_size
    x, y = np.array([cols - 1, rows - 1]) / 2 + rng.uniform(-1, 1, 2)
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    radius = rng.uniform(1.2, 2.2) * (1 + 0.2 * np.sin(2 * angle) + 0.1 * np.cos(5 * angle + 1))
    outline = camera.image_from_board(x + radius * np.cos(angle), y + radius * np.sin(angle))
    cv2.fillPoly(mask, [_fixed(outline, conditions)], 1, shift=4)


def _hand(
    mask: NDArray[np.uint8], conditions: Conditions, camera: Camera, rng: np.random.Generator
) -> None:
    """Four fingers that reach 1 to 2.5 squares of corners in from a side, and a palm outside."""
    rows, cols = conditions.grid_size
    side = int(rng.integers(4))
    start = rng.uniform(0, (cols, rows)[side % 2] - 4)
    fingers = np.arange(4) * 0.9 + start
    reach = rng.uniform(1.0, 2.5) + np.array([-0.4, 0.1, 0.2, -0.2])
    palm = _from_side(camera, side, float(fingers.mean()), np.array([-2.5, -6.0]), (rows, cols))
    _stroke(mask, palm, 3.5, conditions)
    for along, depth in zip(fingers, reach, strict=True):
        finger = _from_side(camera, side, along, np.array([depth - 0.4, -3.0]), (rows, cols))
        _stroke(mask, finger, 0.8, conditions)


def _from_side(
    camera: Camera, side: int, along: float, depth: Array, grid_size: tuple[int, int]
) -> Array:
    """Positions (n, 2) px `depth` (n,) squares inside one of the board's four sides, straight on
    in the image as from 1 to 0."""
    rows, cols = grid_size
    inside = np.array([0.0, 1.0])
    same = np.full(2, along)
    x, y = [
        (same, inside),
        (inside, same),
        (same, rows - 1 - inside),
        (cols - 1 - inside, same),
    ][side]
    border, first = camera.image_from_board(x, y)
    return np.asarray(border + depth[:, None] * (first - border))


def _stroke(mask: NDArray[np.uint8], line: Array, width: float, conditions: Conditions) -> None:
    """A thick line between two points (2, 2) px, `width` squares wide."""
    ends = _fixed(line, conditions)
    thickness = round(width * conditions.square * conditions.parts)
    cv2.line(mask, ends[0].tolist(), ends[1].tolist(), 1, thickness, shift=4)


def _fixed(uv: Array, conditions: Conditions) -> NDArray[np.int32]:
    """Positions (n, 2) px in cv2's fractions of the finely divided image's pixels."""
    fine = np.clip((uv + 0.5) * conditions.parts - 0.5, -1e5, 1e5)
    return np.rint(fine * _FRACTION).astype(np.int32)

"""Boards drawn with exact truth, independent of the engine's own renderer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

Array = NDArray[np.float64]
_ROWS_PER_BAND = 8
"""Number of rows of pixels that are drawn at a time: their arrays stay in the cache."""


@dataclass(frozen=True)
class Scene:
    image: NDArray[np.uint8]
    uv: Array
    """(rows, cols, 2) true corners, px."""


Draw = Callable[..., Scene]
"""`draw_board`, as the fixture `draw` hands it to a test."""


@cache
def draw_board(
    grid_size: tuple[int, int] = (6, 9),
    size: tuple[int, int] = (640, 480),
    *,
    step: float = 40.0,
    turn: float = 0.0,
    tilt: tuple[float, float] = (0.0, 0.0),
    shift: tuple[float, float] = (0.0, 0.0),
    barrel: float = 0.0,
    first: int = 0,
    blur: float = 0.7,
    noise: float = 0.0,
    levels: tuple[float, float] = (40.0, 210.0),
    seed: int = 0,
) -> Scene:
    """Draw a board of `grid_size` = (rows, cols) inner corners, in an image (width, height).

    Args:
        step: side of a square at the image's centre, px.
        turn: of the board in the image, degrees, clockwise as seen.
        tilt: perspective, gain of 1/distance per half image width and height.
        shift: of the board's centre, px.
        barrel: radial distortion at the half diagonal; the distorted point p is at the ideal
            p (1 + barrel r^2).
        first: colour of the first square, 0 dark, 1 bright.
    """
    rows, cols = grid_size
    width, height = size
    centre = np.array([(width - 1) / 2, (height - 1) / 2])
    half = np.hypot(width, height) / 2
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    H = np.array([[c, -s, shift[0]], [s, c, shift[1]], [0.0, 0.0, 1.0]])
    H[2, :2] = np.array([2 * tilt[0] / width, 2 * tilt[1] / height])
    H = (
        H
        @ np.diag([step, step, 1.0])
        @ np.array([[1, 0, -(cols - 1) / 2], [0, 1, -(rows - 1) / 2], [0, 0, 1.0]])
    )

    def ideal(p: Array) -> Array:
        q = (p - centre) / half
        return np.asarray((p - centre) * (1 + barrel * np.sum(q * q, axis=-1, keepdims=True)))

    sub = (np.arange(4) + 0.5) / 4 - 0.5
    fine_v, fine_u = ((np.arange(n)[:, None] + sub).ravel() for n in (height, width))
    inverse = np.linalg.inv(H)
    image = np.empty((height, width))
    for k in range(0, height, _ROWS_PER_BAND):
        v = fine_v[4 * k : 4 * (k + _ROWS_PER_BAND), None] - centre[1]
        u = fine_u[None] - centre[0]
        if barrel:
            scale = 1 + barrel * ((u / half) ** 2 + (v / half) ** 2)
            u, v = u * scale, v * scale
        x, y, z = (row[0] * u + row[1] * v + row[2] for row in inverse)
        x, y = x / z, y / z
        on = (x > -1) & (x < cols) & (y > -1) & (y < rows) & (z > 0)
        dark = on & ((np.floor(x) + np.floor(y)) % 2 == first)
        fine = np.where(dark, levels[0], levels[1])
        image[k : k + _ROWS_PER_BAND] = fine.reshape(-1, 4, width, 4).mean(axis=(1, 3))
    image = gaussian_filter(image, blur)
    image += noise * np.random.default_rng(seed).standard_normal(image.shape)

    n, m = np.meshgrid(np.arange(cols), np.arange(rows))
    corner = np.stack([n, m, np.ones_like(n)], axis=-1) @ H.T
    board = corner[..., :2] / corner[..., 2:]
    uv = board + centre
    for _ in range(100):
        uv = uv + board - ideal(uv)
    return Scene(np.clip(np.rint(image), 0, 255).astype(np.uint8), uv)


def random_squares(seed: int, side: int, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """Squares of `side` px, dark or bright by chance, in an image (h, w) at most."""
    dark = np.random.default_rng(seed).random((shape[0] // side, shape[1] // side)) < 0.5
    return np.kron(255 * dark, np.ones((side, side))).astype(np.uint8)

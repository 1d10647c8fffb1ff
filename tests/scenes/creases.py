"""Two checkerboards on two walls that meet in a room's corner, with exact truth."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.scenes.camera import Camera
from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]
_MARGIN = 0.7
"""Width of the paper around a board away from the crease, squares."""


class Walls(Camera):
    """A camera before two walls. The first wall is the plane of `Camera`; the second rises from it
    towards the camera at the line x = crease, its own x being the way from there."""

    def __init__(
        self, conditions: Conditions, crease: float, fold: float, rng: np.random.Generator
    ) -> None:
        """
        Args:
            conditions: the first wall's.
            crease: x of the line where the walls meet, squares.
            fold: angle by which the second wall is turned, degrees.
            rng: for the pose.
        """
        super().__init__(conditions, rng)
        first = self._H
        across = np.cross(first[:, 0], first[:, 1])
        c, s = np.cos(np.radians(fold)), np.sin(np.radians(fold))
        second = np.column_stack(
            [c * first[:, 0] - s * across, first[:, 1], first[:, 2] + crease * first[:, 0]]
        )
        self.crease, self._walls = crease, (first, second)

    def select(self, wall: int) -> None:
        """Look at one of the walls from now on."""
        self._H = self._walls[wall]


def draw_corner_of_room(
    conditions: Conditions,
    cols: tuple[int, int],
    gap: tuple[float, float],
    fold: float,
    seed: int,
) -> tuple[Array, tuple[Array, Array]]:
    """Draw two boards of `conditions.grid_size[0]` rows on two walls.

    Args:
        conditions: the photograph's; light, ink, response and clutter are left out.
        cols: columns of inner corners of either board.
        gap: width of the paper between the crease and either board, squares.
        fold: angle between the walls' planes, degrees; 0 is flat.
        seed: of the pose.

    Returns:
        Grey levels (h, w) before noise, and the true corners (rows, cols, 2) px of either board.
    """
    rng = np.random.default_rng(seed)
    rows, parts = conditions.grid_size[0], conditions.parts
    walls = Walls(conditions, cols[0] + gap[0], fold, rng)
    width, height = conditions.size
    u, v = ((np.arange(n * parts) + 0.5) / parts - 0.5 for n in (width, height))
    uu, vv = np.meshgrid(u, v)
    x1, y1 = walls.board_from_image(uu, vv)
    walls.select(1)
    x2, y2 = walls.board_from_image(uu, vv)
    first = x1 < walls.crease
    # The second board's own first column is `gap` and a square away from the crease.
    x = np.where(first, x1, x2 - gap[1] - 1)
    y = np.where(first, y1, y2)
    count = np.where(first, cols[0], cols[1])
    seen = np.isfinite(x) & np.isfinite(y) & (first | (x2 >= 0))
    x, y = np.where(seen, x, -1e3), np.where(seen, y, -1e3)
    on_paper = (x > -1 - _MARGIN) & (x < count + _MARGIN) & (y > -1 - _MARGIN)
    on_paper &= y < rows + _MARGIN
    on_board = (x > -1) & (x < count) & (y > -1) & (y < rows)
    dark = on_board & ((np.floor(x) + np.floor(y)) % 2 == 0)
    share = np.where(dark, 0.0, np.where(on_paper, 1.0, 0.55))
    # Two walls are lit differently.
    share *= np.where(first, 1.0, rng.uniform(0.6, 1.0))
    share = cv2.GaussianBlur(share, (0, 0), conditions.blur * parts)
    share = share.reshape(height, parts, width, parts).mean(axis=(1, 3))
    levels = conditions.dark + (conditions.bright - conditions.dark) * share
    boards = []
    for wall, n in enumerate(cols):
        walls.select(wall)
        start = 0.0 if wall == 0 else gap[1] + 1
        at_x, at_y = np.meshgrid(start + np.arange(n), np.arange(rows).astype(np.float64))
        boards.append(walls.image_from_board(at_x, at_y))
    return levels, (boards[0], boards[1])

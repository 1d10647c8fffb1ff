"""Checkerboards in images of any size, drawn fast: for what depends on the size alone."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

_SQUARE = 32
"""Side of a square in the drawing that is warped, px."""


def photograph_board(
    size: tuple[int, int], grid_size: tuple[int, int], square: float, blur: float
) -> NDArray[np.uint8]:
    """Return a checkerboard in perspective, `square` px a square: right to a pixel."""
    width, height = size
    rows, cols = grid_size
    v, u = np.mgrid[: (rows + 3) * _SQUARE, : (cols + 3) * _SQUARE] // _SQUARE
    on_board = (v > 0) & (v < rows + 2) & (u > 0) & (u < cols + 2)
    drawing = np.where(on_board & ((u + v) % 2 == 0), 45, 205).astype(np.uint8)
    half = np.array([cols + 3, rows + 3]) * square / 2
    outline = half * [(-1, -0.9), (1, -1), (0.95, 1), (-1, 1.02)]
    turn = np.radians(12.0)
    turned = outline @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    ends = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * drawing.shape[::-1]
    H = cv2.getPerspectiveTransform(
        ends.astype(np.float32), (turned + np.array(size) / 2).astype(np.float32)
    )
    image = cv2.GaussianBlur(
        cv2.warpPerspective(drawing, H, size, borderValue=(150,)), (0, 0), blur
    )
    noise = np.random.default_rng(0).standard_normal((height, width), dtype=np.float32)
    return np.clip(np.rint(image + 2 * noise), 0, 255).astype(np.uint8)

"""Boards in images of any size, drawn fast: for what depends on the size alone."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board

_SQUARE = 32
"""Side of a square in the drawing that is warped, px."""
_PITCH = 64
"""Pitch in the drawing of a pattern that is warped, px."""
_MARGIN = 1.0
"""Paper around the pattern, pitches."""
_INK, _PAPER, _AROUND = 45, 205, 150
"""Grey levels of the board and of what is around it."""


def photograph_board(
    size: tuple[int, int], grid_size: tuple[int, int], square: float, blur: float
) -> NDArray[np.uint8]:
    """Return a checkerboard in perspective, `square` px a square: right to a pixel."""
    rows, cols = grid_size
    v, u = np.mgrid[: (rows + 3) * _SQUARE, : (cols + 3) * _SQUARE] // _SQUARE
    on_board = (v > 0) & (v < rows + 2) & (u > 0) & (u < cols + 2)
    drawing = np.where(on_board & ((u + v) % 2 == 0), _INK, _PAPER).astype(np.uint8)
    return _photograph(drawing, size, square * (cols + 3), square * (rows + 3), blur)


def photograph_pattern(
    size: tuple[int, int], board: Board, share: float, blur: float
) -> NDArray[np.uint8]:
    """Return a board of any pattern in perspective, whose paper takes `share` of the width or the
    height of the image."""
    print_ = board.pattern.draw(board.grid_size)
    left, top, right, bottom = print_.extent
    x, y = (
        np.arange(low - _MARGIN, high + _MARGIN, 1 / _PITCH) + 0.5 / _PITCH
        for low, high in ((left, right), (top, bottom))
    )
    XY = np.stack(np.meshgrid(x, y), axis=-1)
    gradient = np.broadcast_to(np.eye(2) / _PITCH, (*XY.shape[:2], 2, 2))
    ink, _ = print_.compute_ink_share(XY, gradient)
    drawing = np.rint(_PAPER + (_INK - _PAPER) * ink).astype(np.uint8)
    across = share * min(size[0], size[1] * len(x) / len(y))
    return _photograph(drawing, size, across, across * len(y) / len(x), blur)


def _photograph(
    drawing: NDArray[np.uint8], size: tuple[int, int], across: float, down: float, blur: float
) -> NDArray[np.uint8]:
    """Return a drawing in perspective, `across` and `down` px large, a little noisy."""
    width, height = size
    half = np.array([across, down]) / 2
    outline = half * [(-1, -0.9), (1, -1), (0.95, 1), (-1, 1.02)]
    turn = np.radians(12.0)
    turned = outline @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    ends = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * drawing.shape[::-1]
    H = cv2.getPerspectiveTransform(
        ends.astype(np.float32), (turned + np.array(size) / 2).astype(np.float32)
    )
    image = cv2.GaussianBlur(
        cv2.warpPerspective(drawing, H, size, borderValue=(_AROUND,)), (0, 0), blur
    )
    noise = np.random.default_rng(0).standard_normal((height, width), dtype=np.float32)
    return np.clip(np.rint(image + 2 * noise), 0, 255).astype(np.uint8)

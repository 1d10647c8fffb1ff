"""Photographs of boards of any pattern in trouble, warped from a drawing within milliseconds."""

from __future__ import annotations

from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board
from tests.scenes.photograph import Array, Photograph, as_bytes
from tests.scenes.without_board import draw_without_board

BEFORE_TEXTURE, COVERED, CUT, BLURRED = "before a texture", "covered", "cut by the image", "blurred"
BOARD_TROUBLES = (BEFORE_TEXTURE, COVERED, CUT, BLURRED)
"""The troubles; in each the board is small, tilted and noisy, and lies before a texture."""
_SIZE = (640, 480)
_FOCAL = 600.0
_PITCH = 48
"""Pitch of the pattern in the drawing, px."""
_MARGIN = 0.6
"""Paper around the pattern, pitches."""
_PARTS = 3
"""Number of parts of a pixel along either axis that the photograph is warped in."""
_CLEARANCE = 6
"""Distance from the image's frame and from covers at which a corner can be found, px."""


def photograph_in_trouble(board: Board, seed: int, trouble: str) -> Photograph:
    """Photograph a board in one of `BOARD_TROUBLES`."""
    rng = np.random.default_rng([seed, BOARD_TROUBLES.index(trouble)])
    ink, points = _draw(board)
    H = _choose_view(ink.shape, trouble, rng)
    parts = np.array([[_PARTS, 0, (_PARTS - 1) / 2], [0, _PARTS, (_PARTS - 1) / 2], [0, 0, 1.0]])
    fine = (_SIZE[0] * _PARTS, _SIZE[1] * _PARTS)
    share = cv2.warpPerspective(ink, parts @ H, fine)
    is_paper = cv2.warpPerspective(np.ones_like(ink), parts @ H, fine) > 0.5
    dark, bright = rng.uniform(15, 60), rng.uniform(120, 220)
    texture = cv2.resize(draw_without_board(seed).astype(np.float32), fine)
    levels = np.where(is_paper, bright + (dark - bright) * share, texture).astype(np.float32)
    uv = cv2.perspectiveTransform(points[None], H)[0].astype(np.float64)
    hidden = np.zeros((_SIZE[1], _SIZE[0]), np.uint8)
    if trouble == COVERED:
        for _ in range(rng.integers(1, 4)):
            _cover(levels, hidden, uv, (dark, bright), rng)
    blur = rng.uniform(0.4, 1.5) + (rng.uniform(0.8, 2.0) if trouble == BLURRED else 0.0)
    levels = cv2.GaussianBlur(levels, (0, 0), _PARTS * blur)
    levels = cv2.resize(levels, _SIZE, interpolation=cv2.INTER_AREA)
    noise = rng.uniform(0.5, 3.0) if trouble == BLURRED else rng.uniform(2.0, 22.0)
    image = as_bytes(levels + noise * rng.standard_normal(levels.shape))
    reach = np.ones((2 * _CLEARANCE + 1,) * 2, np.uint8)
    hidden = cv2.copyMakeBorder(cv2.dilate(hidden, reach), *[1] * 4, cv2.BORDER_CONSTANT, value=1)
    hidden[:_CLEARANCE] = hidden[-_CLEARANCE:] = 1
    hidden[:, :_CLEARANCE] = hidden[:, -_CLEARANCE:] = 1
    at = np.rint(uv).astype(np.int64).clip(-1, _SIZE) + 1
    corners: Array = uv.reshape(board.rows, board.cols, 2)
    return Photograph(
        image, (corners,), (hidden[at[:, 1], at[:, 0]] > 0).reshape(corners.shape[:2])
    )


@cache
def _draw(board: Board) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The share of ink (h, w) in a drawing of a board, and the places (n, 2) px of its points."""
    drawn = board.pattern.draw(board.grid_size)
    left, top, right, bottom = drawn.extent
    x, y = (
        np.arange(low - _MARGIN, high + _MARGIN, 1 / _PITCH) + 0.5 / _PITCH
        for low, high in ((left, right), (top, bottom))
    )
    places = np.stack(np.meshgrid(x, y), axis=-1)
    gradient = np.broadcast_to(np.eye(2) / _PITCH, (*places.shape[:2], 2, 2))
    ink, _ = drawn.compute_ink_share(places, gradient)
    start = np.array([left, top]) - _MARGIN
    points = (board.points()[:, :2] / board.square - start) * _PITCH - 0.5
    return ink.astype(np.float32), points.astype(np.float32)


def _choose_view(shape: tuple[int, ...], trouble: str, rng: np.random.Generator) -> Array:
    """A homography from the drawing (h, w) to the image, at chance."""
    h, w = shape
    middle = np.array(_SIZE) / 2 + rng.uniform(-1, 1, 2) * (90, 60)
    if trouble == CUT:
        middle[0] += rng.choice([-1, 1]) * 0.35 * _SIZE[0]
    scale = rng.uniform(0.3, 0.75) * _SIZE[0] / w
    R = cv2.Rodrigues(np.append(rng.uniform(-0.8, 0.8, 2), rng.uniform(-0.6, 0.6)))[0]
    K = np.array([[_FOCAL, 0, middle[0]], [0, _FOCAL, middle[1]], [0, 0, 1.0]])
    centred = np.array([[1, 0, -w / 2], [0, 1, -h / 2], [0, 0, 1.0]])
    return np.asarray(K @ np.column_stack([R[:, :2], [0, 0, _FOCAL / scale]]) @ centred)


def _cover(
    levels: NDArray[np.float32],
    hidden: NDArray[np.uint8],
    uv: Array,
    print_levels: tuple[float, float],
    rng: np.random.Generator,
) -> None:
    """Cover a part of the board near one of its points (n, 2) px by a disc or a card, which may be
    as bright as the paper or as dark as the ink."""
    middle = uv[rng.integers(len(uv))] + rng.normal(0, 8, 2)
    box = (middle.tolist(), rng.uniform(10, 90, 2).tolist(), float(rng.uniform(0, 180)))
    level = rng.choice([*print_levels, rng.uniform(*print_levels)])
    mask = np.zeros_like(hidden)
    if rng.random() < 0.5:
        cv2.ellipse(mask, box, 1, -1)
    else:
        cv2.fillConvexPoly(mask, np.rint(cv2.boxPoints(box)).astype(np.int32), 1)
    hidden |= mask
    levels[cv2.resize(mask, levels.shape[::-1], interpolation=cv2.INTER_NEAREST) > 0] = level

"""Kernels made ready before they are needed, so that nothing is compiled twice.

A kernel is compiled at its first call for each type of image. If that is in several processes at
once, each of them compiles it. Set-up scripts compile those of all detectors, for images of 8 and
of 16 bits, by ``python -m calibgui.app.system.kernel_preparation``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from calibgui.engine import boards, camera, detection, geometry, images

_SQUARE_PX = 20
"""Side of the squares of the drawn board, px."""
_PARTS = 4
"""Number of parts of a pixel, along either axis, that the board is drawn in."""
_CLOTH_COLUMNS = 6
"""Number of columns of squares that are drawn beside the board's border: enough for corners that
are not the board's to be seen there."""
_BARREL = 0.4
"""Distortion of the drawing at the diagonal: as much as it takes for a lens to be fitted."""
_SHADE = 0.3
"""Part of the light that is lost at the darkest places: as much as it takes for the light of single
corners to be fitted."""
_TILT = 0.1
"""Turn of the rendered boards about both axes, rad: as much as it takes for no line to be straight
along the pixels."""


def prepare_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of a small board drawn through a lens in uneven light, beside a chequered
    cloth, which loads or compiles the finder's kernels.

    Args:
        depth: type of the grey levels, np.uint8 or np.uint16.
    """
    rows, cols, parts = 9, 10, _SQUARE_PX * _PARTS  # a border of one square included
    size = np.array([rows, cols])
    width = cols + _CLOTH_COLUMNS
    place = np.moveaxis(np.indices((rows * parts, width * parts)), 0, -1) / parts - size / 2
    place *= 1 + _BARREL * np.sum(place**2, axis=-1, keepdims=True) / np.sum(size**2)
    row, col = np.moveaxis(np.floor(place + size / 2).astype(np.int64), -1, 0)
    is_printed = (row > 0) & (col > 0) & (row < rows - 1) & (col != cols - 1)
    shade = 1 - _SHADE * np.sin(place[..., 0]) ** 2 * np.sin(place[..., 1]) ** 2
    fine = np.where(is_printed & ((row + col) % 2 == 0), 40, 200) * shade
    levels = fine.reshape(rows * _SQUARE_PX, _PARTS, -1, _PARTS).mean(axis=(1, 3))
    detection.find_corners((levels * (np.iinfo(depth).max // 255)).astype(depth))


def prepare_circle_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the circles of a small grid; otherwise as `prepare_finder`."""
    _find_rendered(boards.Board(5, 6, 1.0, boards.Circles(diameter=0.5)), depth)


def prepare_tag_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of small AprilGrids with and without dark squares between their tags;
    otherwise as `prepare_finder`."""
    prepare_finder(depth)
    for corner_squares in (True, False):
        pattern = boards.AprilGrid("t36h11", 0.3, 2, False, corner_squares)
        _find_rendered(boards.Board(6, 6, 1.0, pattern), depth)


def prepare_every_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Prepare the detectors of all kinds of boards."""
    prepare_tag_finder(depth)
    prepare_circle_finder(depth)


def _find_rendered(board: boards.Board, depth: npt.DTypeLike) -> None:
    """Find the points of a `board` rendered through a lens, with a margin of a pitch."""
    points = board.points()
    span = float(np.ptp(points, axis=0).max()) + 2 * board.square
    side = round(span / board.square * _SQUARE_PX)
    params = [side, side, side / 2, side / 2, _BARREL, *[0.0] * 5]
    lens = camera.Camera((side, side), np.array(params))
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    pose = geometry.Pose(np.array([_TILT, _TILT, 0.0]), np.array([*-middle, span]))
    levels = images.render_view(lens, pose, board, blur=0.5)
    levels = levels.astype(depth) * (np.iinfo(depth).max // 255)
    detection.find_corners(levels, pattern=board.pattern)


_PREPARATIONS = {
    "circles": prepare_circle_finder,
    "asymmetric-circles": prepare_circle_finder,
    "aprilgrid": prepare_tag_finder,
}
"""Functions that prepare detectors which need other kernels than that of checkerboards, by the kind
of their boards."""
_SECONDS = {prepare_finder: 25, prepare_circle_finder: 7, prepare_tag_finder: 35}
"""Rough times, s, that compiling takes, once after an installation."""


def choose_preparation(pattern: boards.Pattern) -> Callable[..., None]:
    """Return the function that prepares the detector of boards of a `pattern`."""
    return _PREPARATIONS.get(pattern.kind, prepare_finder)


def estimate_preparation(pattern: boards.Pattern) -> int:
    """Estimate the time that preparing this detector takes if it has to be compiled, s."""
    return _SECONDS[choose_preparation(pattern)]


if __name__ == "__main__":
    prepare_every_finder()
    prepare_every_finder(np.uint16)

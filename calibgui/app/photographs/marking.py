"""Correction of corners by hand: marking a board, and moving, removing or restoring corners."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from calibgui.engine import detection, features, lattices
from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.boards import CHECKERBOARD, Pattern, checkerboard_symmetry
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features import METHODS, Corners
from calibgui.engine.geometry import fit_homography

_MIN_CONTRAST_RATIO = 0.1
"""Least contrast of a corner, as a fraction of the range of grey levels around the cursor."""
_BORDER_PX = 8
"""Width of the border beyond the reach that the tests of a corner need, px."""
_CORNER_ARRAYS = ("grid", "uv", "estimate", "cov", "blur", "contrast", "residual")


def find_nearest_corner(image: GreyImage, uv: Array, reach: float) -> Array | None:
    """Return the corner (2,) px nearest to `uv` (2,) px, within `reach` px; None if none is."""
    half = int(np.ceil(reach)) + _BORDER_PX
    u, v = np.rint(uv).astype(int)
    left, top = max(u - half, 0), max(v - half, 0)
    part = image[top : v + half + 1, left : u + half + 1]
    if min(part.shape, default=0) < 2 * _BORDER_PX:
        return None
    floor = _MIN_CONTRAST_RATIO * float(np.ptp(part))
    if floor <= 0:
        return None
    saddles = lattices.find_saddles(part, floor)
    good, _ = lattices.classify_saddles(saddles)
    at = saddles.uv[good] + [left, top]
    distance = np.linalg.norm(at - uv, axis=1)
    if not len(at) or distance.min() > reach:
        return None
    return refine_corner(image, at[np.argmin(distance)], 2.0)


def refine_corner(image: GreyImage, uv: Array, limit: float) -> Array | None:
    """Return the saddle point (2,) px within `limit` px of `uv` (2,) px; None if there is none."""
    at, good = features.refine_saddles(image, uv[None], np.array([1.2]), np.array([limit]))
    return at[0] if good[0] else None


def mark_board(
    image: GreyImage,
    points: Array,
    grid_size: GridSize | None,
    usual: GridSize | None,
    pattern: Pattern = CHECKERBOARD,
    method: str = METHODS[0],
) -> Corners:
    """Find the corners of the board whose four outermost corners are `points` (4, 2) px.

    Args:
        image: (h, w) grey levels.
        points: in order around the board; the first is the origin where the pattern allows it.
        grid_size: rows and columns if the user states them; counted if None.
        usual: rows and columns to try if counting fails.
        pattern: of the board.
        method: of locating corners, one of ``features.METHODS``.

    Raises:
        NoBoardError: if no board is found there.
        CalibrationError: if the points do not go around a region.
    """
    try:
        return detection.find_corners(image, grid_size, points, method, pattern=pattern)
    except NoBoardError:
        if grid_size is not None or usual is None:
            raise
        return detection.find_corners(image, usual, points, method, pattern=pattern)
    except ValueError as error:
        raise CalibrationError(
            "The four points do not go around the board.",
            "Mark its outermost inner corners one after the other, clockwise or counterclockwise.",
        ) from error


def project_marked_board(points: Array, grid_size: GridSize) -> Array:
    """Return (rows, cols, 2) px, the corners of a board whose outermost ones are `points` (4, 2).

    Rows run from the first point to the second. Distortion is ignored: the result is a preview.
    """
    rows, cols = grid_size
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    H = fit_homography(corners[None], points[None], np.ones((1, 4)))[0]
    t, s = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing="ij")
    q = np.stack([s, t, np.ones_like(s)], axis=-1) @ H.T
    return np.asarray(q[..., :2] / q[..., 2:])


def move_corner(corners: Corners, k: int, uv: Array) -> Corners:
    """Return the corners with the k-th at `uv` (2,) px, with its covariance unchanged."""
    places = corners.uv.copy()
    places[k] = uv
    return replace(corners, uv=places)


def remove_corners(corners: Corners, k: int | IntArray) -> Corners:
    """Return the corners without the k-th, or without several."""
    return _change_arrays(corners, lambda values: np.delete(values, k, axis=0))


def find_missing_corners(corners: Corners) -> tuple[IntArray, Array]:
    """Return the places (n, 2) = (row, column) without a corner, and their predictions, px."""
    rows, cols = corners.shape
    found = {(int(m), int(n)) for m, n in corners.grid}
    places = [(m, n) for m in range(rows) for n in range(cols) if (m, n) not in found]
    grid = np.array(places, dtype=np.int64).reshape(-1, 2)
    if not len(grid) or not corners.determine_pose:
        return grid, np.empty((0, 2))
    return grid, np.array([_predict_corner(corners, place) for place in grid])


def restore_corner(image: GreyImage, corners: Corners, place: IntArray) -> Corners:
    """Return the corners with one more, found in the image at `place` (row, column).

    Raises:
        NoBoardError: if there is no corner where it should be.
        CalibrationError: if the board is no checkerboard.
    """
    _check_has_plain_squares(corners)
    expected = _predict_corner(corners, place)
    spacing = np.sort(np.linalg.norm(corners.uv - expected, axis=1))[1]
    uv = find_nearest_corner(
        image, expected, spacing / 3
    )  # a neighbour out of place misleads by some px
    if uv is None:  # too blurred to look like a corner from afar
        uv = refine_corner(image, expected, spacing / 3)
    if uv is None:
        raise NoBoardError(
            f"There is no corner in row {place[0]}, column {place[1]}.",
            "It may be hidden or blurred: calibrate without it.",
        )
    # Values that are not measured again are those of the nearest corner.
    nearest = int(np.argmin(np.linalg.norm(corners.uv - expected, axis=1)))
    longer = _change_arrays(
        corners, lambda values: np.append(values, values[nearest : nearest + 1], axis=0)
    )
    grid, places = longer.grid.copy(), longer.uv.copy()
    grid[-1], places[-1] = place, uv
    return replace(longer, grid=grid, uv=places)


def turn_board(corners: Corners) -> Corners:
    """Return the same corners numbered from the next corner of the board: a quarter turn."""
    _check_has_plain_squares(corners)
    rows, cols = corners.shape
    grid = np.column_stack([corners.grid[:, 1], rows - 1 - corners.grid[:, 0]])
    return replace(
        corners, shape=(cols, rows), grid=grid, ambiguity=checkerboard_symmetry((cols, rows))
    )


def flip_board(corners: Corners) -> Corners:
    """Return the same corners with columns numbered from the other end, for mirrored images."""
    _check_has_plain_squares(corners)
    grid = corners.grid.copy()
    grid[:, 1] = corners.shape[1] - 1 - grid[:, 1]
    return replace(corners, grid=grid)


def _check_has_plain_squares(corners: Corners) -> None:
    """Raise CalibrationError unless the board shows plain squares.

    Points that say which they are need no renumbering, and circles are no corners.
    """
    if not corners.pattern.has_squares or corners.pattern.identifies_points:
        raise CalibrationError(
            "Only the corners of a checkerboard can be renumbered or added by hand.",
            "Detect the image again, or remove wrong points.",
        )


def _predict_corner(corners: Corners, place: IntArray) -> Array:
    """Predict the corner (2,) px at `place` by the homography of the twelve nearest corners."""
    near = np.argsort(np.abs(corners.grid - place).sum(axis=1), kind="stable")[:12]
    xy, uv = corners.grid[near].astype(np.float64), corners.uv[near]
    H = fit_homography(xy[None], uv[None], np.ones((1, len(near))))[0]
    q = H @ np.append(place.astype(np.float64), 1.0)
    return np.asarray(q[:2] / q[2])


def _change_arrays(corners: Corners, change: Callable[[Any], Any]) -> Corners:
    """Return the corners with `change` applied to every array that has a row per corner."""
    values = {name: getattr(corners, name) for name in _CORNER_ARRAYS}
    return replace(corners, **{k: change(v) for k, v in values.items() if v is not None})

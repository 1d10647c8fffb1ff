"""Corners put right by hand: the board pointed at, single corners moved, removed, restored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.boards import CHECKERBOARD, Pattern, checkerboard_ambiguity
from calibgui.engine.detection import (
    METHODS,
    Corners,
    classify,
    find_corners,
    find_saddles,
    refine_saddles,
)
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.geometry import fit_homography

_CONTRAST = 0.1
"""Least contrast of a corner over the range of grey levels around the cursor."""
_BORDER = 8
"""What a corner's tests need to see beyond the reach, px."""
_PER_CORNER = ("grid", "uv", "estimate", "cov", "blur", "contrast", "residual")


def snapped(image: GreyImage, uv: Array, reach: float) -> Array | None:
    """The corner (2,) px nearest to `uv` (2,) px within `reach`; None if there is none."""
    half = int(np.ceil(reach)) + _BORDER
    u, v = np.rint(uv).astype(int)
    left, top = max(u - half, 0), max(v - half, 0)
    part = image[top : v + half + 1, left : u + half + 1]
    if min(part.shape, default=0) < 2 * _BORDER:
        return None
    floor = _CONTRAST * float(np.ptp(part))
    if floor <= 0:
        return None
    saddles = find_saddles(part, floor)
    good, _ = classify(saddles)
    at = saddles.uv[good] + [left, top]
    distance = np.linalg.norm(at - uv, axis=1)
    if not len(at) or distance.min() > reach:
        return None
    return refined(image, at[np.argmin(distance)], 2.0)


def refined(image: GreyImage, uv: Array, limit: float) -> Array | None:
    """The saddle point (2,) px within `limit` of `uv` (2,) px; None if there is none."""
    at, good = refine_saddles(image, uv[None], np.array([1.2]), np.array([limit]))
    return at[0] if good[0] else None


def marked(
    image: GreyImage,
    points: Array,
    grid_size: GridSize | None,
    usual: GridSize | None,
    pattern: Pattern = CHECKERBOARD,
    method: str = METHODS[0],
) -> Corners:
    """The corners of the board whose four outermost ones are `points` (4, 2) px.

    Args:
        image: (h, w) grey levels.
        points: in order around the board; the first is the origin where the pattern allows it.
        board: rows and columns if the user states them; counted if None.
        usual: rows and columns to suppose where counting fails.
        pattern: of the target.
        method: of locating corners, one of ``corners.METHODS``.

    Raises:
        NoBoardError: nothing there fits.
        CalibrationError: the points do not go around a region.
    """
    try:
        return find_corners(image, grid_size, points, method, pattern=pattern)
    except NoBoardError:
        if grid_size is not None or usual is None:
            raise
        return find_corners(image, usual, points, method, pattern=pattern)
    except ValueError as error:
        raise CalibrationError(
            "The four points do not go around the board.",
            "Mark its outermost inner corners one after the other, clockwise or counterclockwise.",
        ) from error


def projected(points: Array, grid_size: GridSize) -> Array:
    """(rows, cols, 2) px of the corners of a board whose outermost ones are `points` (4, 2).

    Rows run from the first point to the second; distortion is ignored: a picture to judge by.
    """
    rows, cols = grid_size
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    H = fit_homography(corners[None], points[None], np.ones((1, 4)))[0]
    t, s = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing="ij")
    q = np.stack([s, t, np.ones_like(s)], axis=-1) @ H.T
    return np.asarray(q[..., :2] / q[..., 2:])


def moved(corners: Corners, k: int, uv: Array) -> Corners:
    """The corners with the k-th at `uv` (2,) px; its covariance is taken to be as it was."""
    places = corners.uv.copy()
    places[k] = uv
    return replace(corners, uv=places)


def removed(corners: Corners, k: int | IntArray) -> Corners:
    """The corners without the k-th, or without several."""
    return _each(corners, lambda values: np.delete(values, k, axis=0))


def missing(corners: Corners) -> tuple[IntArray, Array]:
    """Places (n, 2) = (row, column) of the board without a corner, and where they would be, px."""
    rows, cols = corners.shape
    found = {(int(m), int(n)) for m, n in corners.grid}
    places = [(m, n) for m in range(rows) for n in range(cols) if (m, n) not in found]
    grid = np.array(places, dtype=np.int64).reshape(-1, 2)
    if not len(grid) or len(corners) < 4:
        return grid, np.empty((0, 2))
    return grid, np.array([_expected(corners, place) for place in grid])


def restored(image: GreyImage, corners: Corners, place: IntArray) -> Corners:
    """The corners with the one at `place` (row, column) found anew.

    Raises:
        NoBoardError: there is no corner where it should be.
    """
    _check_squares(corners)
    expected = _expected(corners, place)
    spacing = np.sort(np.linalg.norm(corners.uv - expected, axis=1))[1]
    uv = snapped(image, expected, spacing / 3)  # a neighbour out of place misleads by some px
    if uv is None:  # too blurred to look like a corner from afar
        uv = refined(image, expected, spacing / 3)
    if uv is None:
        raise NoBoardError(
            f"There is no corner in row {place[0]}, column {place[1]}.",
            "It may be hidden or blurred: calibrate without it.",
        )
    # What is not measured anew is as for the nearest corner.
    nearest = int(np.argmin(np.linalg.norm(corners.uv - expected, axis=1)))
    longer = _each(corners, lambda values: np.append(values, values[nearest : nearest + 1], axis=0))
    grid, places = longer.grid.copy(), longer.uv.copy()
    grid[-1], places[-1] = place, uv
    return replace(longer, grid=grid, uv=places)


def turned(corners: Corners) -> Corners:
    """The same corners counted from the board's next corner: a quarter turn of its axes."""
    _check_squares(corners)
    rows, cols = corners.shape
    grid = np.column_stack([corners.grid[:, 1], rows - 1 - corners.grid[:, 0]])
    return replace(
        corners, shape=(cols, rows), grid=grid, ambiguity=checkerboard_ambiguity((cols, rows))
    )


def flipped(corners: Corners) -> Corners:
    """The same corners with columns counted from the other end: for mirrored images."""
    _check_squares(corners)
    grid = corners.grid.copy()
    grid[:, 1] = corners.shape[1] - 1 - grid[:, 1]
    return replace(corners, grid=grid)


def _check_squares(corners: Corners) -> None:
    """Refuse what only a checkerboard allows: other points say which they are, or are no
    corners."""
    if corners.pattern != CHECKERBOARD:
        raise CalibrationError(
            "Only a checkerboard's corners can be counted anew or put in by hand.",
            "Detect the image again, or remove what is wrong.",
        )


def _expected(corners: Corners, place: IntArray) -> Array:
    """Where the corner at `place` must be, by the homography of the nine nearest ones, px."""
    near = np.argsort(np.abs(corners.grid - place).sum(axis=1), kind="stable")[:12]
    xy, uv = corners.grid[near].astype(np.float64), corners.uv[near]
    H = fit_homography(xy[None], uv[None], np.ones((1, len(near))))[0]
    q = H @ np.append(place.astype(np.float64), 1.0)
    return np.asarray(q[:2] / q[2])


def _each(corners: Corners, change: Callable[[Any], Any]) -> Corners:
    """The corners with `change` applied to every array that has a row per corner."""
    values = {name: getattr(corners, name) for name in _PER_CORNER}
    return replace(corners, **{k: change(v) for k, v in values.items() if v is not None})

"""The detector of grids of circles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize
from calibgui.engine.boards.circle_grid import Circles, grid_indices
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.checkerboard.find_checkerboard import grey_levels, rejections
from calibgui.engine.detection.circles import ellipse_fit
from calibgui.engine.detection.circles.blobs import blobs
from calibgui.engine.detection.circles.ellipse_fit import Ellipses
from calibgui.engine.detection.circles.grid_labelling import arranged
from calibgui.engine.detection.corners import Corners
from calibgui.engine.detection.grid_map import fit_circle_map
from calibgui.engine.errors import NoBoardError
from calibgui.engine.images.reading import stretched

_COARSE = 1200
"""Longer side of the image in which the grid is looked for first, px."""
_WINDOWS = (4, 16)
"""Of which part of the image's shorter side ink must be darker than the mean."""
_MOST = 400
"""Parts that are looked at where the number of circles is not known."""
_TURNS = 3
"""How often the map and the centres are found from each other."""
_DIFFERENT = 0.05
"""Difference of the diameter from the stated one that is no error of print, pitches."""
_MISPLACED = 0.1
"""Farthest that a circle may be from where the others expect it, pitches."""
_MISSHAPEN = 0.2
"""Greatest difference of an ellipse from what the others expect, over its size."""
_WEAKEST = 0.3
"""Least contrast over the median."""
_MISFIT = 0.12
"""Greatest residual over the contrast, or ..."""
_UNEXPLAINED = 4.0
"""... over the median residual."""
_FAILING = 0.25
"""Share of circles that may fail before the grid does."""


def find_circles(
    image: npt.ArrayLike,
    pattern: Circles,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",  # noqa: ARG001 - circles have but one
) -> Corners:
    """Locate the circles of a grid in an image; see ``find_corners``."""
    grey = grey_levels(image)
    outline = None if roi is None else region.outline(roi)
    coarse = _found(pattern, stretched(grey), grid_size, outline)
    grid_size = coarse.shape[0], coarse.shape[1]
    grid = grid_indices(grid_size)
    xy = pattern.places(grid.astype(np.float64))
    first = _numbered(pattern, coarse, xy, outline)
    start = fit_circle_map(xy, first)
    beside = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
    if not pattern.asymmetric:
        beside = np.array([(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)])
    fit = ellipse_fit.fit(grey, first, start.jacobian(xy), pattern.reach, beside)
    good, uv, radius = _verified(fit, xy, grey)
    if pattern.diameter is not None and abs(2 * radius - pattern.diameter) > _DIFFERENT:
        raise NoBoardError(
            f"The circles measure {2 * radius:.2f} of their distance, not {pattern.diameter:.2f}.",
            "State diameter and distance as measured, or leave the diameter out.",
        )
    whole = uv.reshape(*grid_size, 2)
    return Corners(
        shape=grid_size,
        grid=grid[good],
        uv=uv[good],
        estimate=first[good],
        cov=fit.covariance[good],
        ambiguity=pattern.ambiguity(grid_size),
        roi=whole[[0, 0, -1, -1], [0, -1, -1, 0]] if outline is None else outline,
        method="ellipses",
        blur=fit.blur[good],
        contrast=fit.contrast[good],
        residual=fit.residual[good],
        rejected=tuple(rejections(fit.uv[~good], "not the image of a circle there")),
        pattern=Circles(pattern.asymmetric, 2 * radius),
    )


def _found(
    pattern: Circles, image: GreyImage, grid_size: GridSize | None, outline: Array | None
) -> Array:
    """(rows, cols, 2) px, the circles' centres, coarsely, in an 8-bit image (h, w)."""
    left, top = 0, 0
    if outline is not None:
        marked = region.enlarged(outline)
        left, top = np.maximum(np.floor(marked.min(axis=0)), 0).astype(int)
        right, bottom = np.ceil(marked.max(axis=0)).astype(int)
        image = image[top : bottom + 1, left : right + 1]
    levels = [image]
    while max(levels[-1].shape) > _COARSE:
        levels.append(opencv.half(levels[-1]))
    most = _MOST if grid_size is None else 2 * grid_size[0] * grid_size[1] + 60
    largest = np.zeros((0, 0, 2))
    for depth in reversed(range(len(levels))):
        for seen in (levels[depth], 255 - levels[depth]):
            for part in _WINDOWS:
                points = blobs(seen, max(int(min(seen.shape) / part), 9), most)
                grid = arranged(points, grid_size, asymmetric=pattern.asymmetric)
                if grid is None or (grid.shape != grid_size and 2 * grid.size <= largest.size):
                    continue
                largest = (points[grid] + 0.5) * 2**depth - 0.5 + [left, top]
                if grid.shape == grid_size:
                    return largest
    if grid_size is None and largest.size:
        return largest
    which = "" if grid_size is None else f"{grid_size[0]} x {grid_size[1]} "
    instead = ", but one of {} x {}".format(*largest.shape) if largest.size else ""
    raise NoBoardError(
        f"No grid of {which}circles was found{instead}.",
        "All of it must be in view, sharp and evenly lit, with white around it."
        + (" Check the numbers of rows and columns." if grid_size else ""),
    )


def _numbered(pattern: Circles, dense: Array, xy: Array, outline: Array | None) -> Array:
    """The centres (rows, cols, 2) as the pattern counts them, for each of its places (n, 2)."""
    ways = [dense, dense[::-1], dense[:, ::-1], dense[::-1, ::-1]]
    if dense.shape[0] == dense.shape[1] and not pattern.asymmetric:
        ways += [way.transpose(1, 0, 2) for way in ways]
    rated = []
    for way in ways:
        flat = way.reshape(-1, 2)
        through = fit_circle_map(xy, flat)
        J = through.jacobian(xy)
        if not (np.isfinite(J).all() and (np.linalg.det(J) > 0).all()):
            continue
        off = float(np.sqrt(np.mean((through.at(xy) - flat) ** 2)))
        right = J[..., 0].mean(axis=0)
        start = 0.0 if outline is None else float(np.linalg.norm(way[0, 0] - outline[0]))
        rated.append((off, start, -right[0] / np.linalg.norm(right), flat))
    if not rated:
        raise _untrusted()
    least = min(rate[0] for rate in rated)
    same = [rate for rate in rated if rate[0] < 2 * least + 0.1]
    return min(same, key=lambda rate: (rate[1], round(rate[2], 6)))[3]


def _verified(fit: Ellipses, xy: Array, image: GreyImage) -> tuple[BoolArray, Array, float]:
    """Which circles pass, the images of their centres (n, 2) px, and their radius, pitches.

    Every ellipse must lie inside the image, be what a circle of the common radius looks like there,
    where the others expect it, with a contrast like theirs and no more unexplained.
    """
    if not (np.isfinite(fit.unknowns).all() and np.isfinite(fit.covariance).all()):
        raise _untrusted()
    half = np.sqrt(np.einsum("nii->ni", fit.spread)) + fit.blur[:, None]
    good = ((fit.uv > half) & (fit.uv + half < np.array(image.shape[::-1]) - 1)).all(axis=1)
    contrast, residual = fit.contrast, fit.residual
    sign = np.sign(np.median(fit.unknowns[:, 7]))
    good &= (sign * fit.unknowns[:, 7] > 0) & (contrast > _WEAKEST * np.median(contrast))
    good &= residual < np.maximum(_UNEXPLAINED * np.median(residual), _MISFIT * contrast)
    uv = fit.uv
    for _ in range(_TURNS):
        # What fails is not to bend the map for the others.
        if np.count_nonzero(~good) > _FAILING * len(good):
            raise _untrusted()
        through = fit_circle_map(xy[good], uv[good])
        J = through.jacobian(xy)
        spread = np.linalg.solve(J, np.linalg.solve(J, fit.spread).transpose(0, 2, 1))
        radii2 = np.sqrt(np.maximum(np.linalg.det(spread), 0.0))
        radius = float(np.sqrt(np.median(radii2[good])))
        uv = fit.uv - through.bias(xy, radius)
        off = np.linalg.solve(J, (uv - through.at(xy))[..., None])[..., 0]
        shape = np.abs(spread / radius**2 - np.eye(2)).max(axis=(1, 2))
        good = good & (np.linalg.norm(off, axis=1) < _MISPLACED) & (shape < _MISSHAPEN)
    enough = np.count_nonzero(~good) <= _FAILING * len(good)
    if not enough or np.median(residual / contrast) > _MISFIT:
        raise _untrusted()
    return good, uv, radius


def _untrusted() -> NoBoardError:
    return NoBoardError(
        "What looks like a grid of circles is not regular enough to be trusted.",
        "Take the picture again, sharp and evenly lit, or leave it out.",
    )

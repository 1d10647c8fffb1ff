"""Corners as saddle points of the intensity surface (paper 4.1, the yellow marks of figure 6).

**One saddle point** (`refine_saddles`). Around a corner the surface is fitted by the quadratic

    I(x, y) = g + d x + e y + a x^2 + b x y + c y^2,    x, y from the current estimate,

by least squares with Gaussian weights, and the estimate moves to its stationary point

    [2a  b] [x]     [d]
    [ b 2c] [y] = - [e],

a saddle where 4ac - b^2 < 0. This is repeated until it converges.

The weights are centred on the estimate itself, between the pixels. A corner's surface is point
symmetric, hence so is the weighted problem at the true corner, and the fit has no bias however
far from quadratic the surface is; with weights fixed to whole pixels the result would lean with the
corner's sub-pixel phase. Their width follows the squares: wide enough to average noise, never
so wide that the neighbours' edges come in. The weights being separable, the normal equations
hold products of one-dimensional moments, and all corners are solved at once.

**The saddle points of a lattice** (`refine_lattice`). Squares that overlap or part by more than the
blur have none: what is printed between them is flat, and a saddle found there is noise. It shows in
the grey level at the corner, which is then not midway between those of the squares.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_lengths, compute_median
from calibgui.engine.features.corner_template import OrientedCorners, orient_corners, sample_around
from calibgui.engine.features.lattice import Lattice

_MIN_STEP = 1e-4
"""Length of a step at which an estimate has converged, px."""
_MAX_ITERATIONS = 20
"""Number of steps after which an estimate has failed."""
_MAX_OFF_MIDDLE = 0.42
"""Greatest median distance of the grey level at the corners from the middle of their squares',
over the contrast: beyond it the squares overlap or part and have no saddle point."""
_POWERS = np.array([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)])
"""Powers of x and y of the terms g, d, e, a, b, c."""
_SQUARE_POSITIONS = 0.2 * np.array([(1, 1), (-1, -1), (1, -1), (-1, 1)])
"""Where the grey levels of the four squares are sampled, steps."""
_CORNER_POSITIONS = 0.05 * np.array([(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)])
"""Where that of the corner is sampled, steps."""


def choose_weight_sigma(spacing: Array) -> Array:
    """Choose the standard deviation (n,) px of the weights for squares of `spacing` (n,) px."""
    return np.clip(spacing / 8, 0.8, 2.0)


def refine_saddles(
    image: GreyImage,
    uv: Array,
    sigma: Array,
    limit: Array,
    min_step: float = _MIN_STEP,
) -> tuple[Array, BoolArray]:
    """Find the saddle points nearest to the estimates `uv` (n, 2) px.

    Args:
        image: (h, w) grey levels.
        uv: first estimates.
        sigma: (n,) standard deviation of the weights, px; halved where that finds no saddle.
        limit: (n,) farthest acceptable distance from the estimate, px.
        min_step: length of a step at which an estimate has converged, px.

    Returns:
        Positions (n, 2), and whether (n,) each converged to a saddle within its limit; the
        estimate is returned where it did not.
    """
    uv = uv.copy()
    good = np.zeros(len(uv), dtype=np.bool_)
    for factor in (1.0, 0.5):
        rest = np.flatnonzero(~good)
        if len(rest):
            uv[rest], good[rest] = _iterate(
                image,
                uv[rest],
                factor * sigma[rest],
                limit[rest],
                min_step,
                _MAX_ITERATIONS,
            )
    return uv, good


@kernels.with_kernel("saddle", "iterate")
def _iterate(
    image: GreyImage, start: Array, sigma: Array, limit: Array, tolerance: float, most: int
) -> tuple[Array, BoolArray]:
    """Iterate `refine_saddles` with one width of the weights.

    Args:
        image, start, sigma, limit: as there.
        tolerance: length of a step at which an estimate has converged, px.
        most: number of steps.
    """
    uv = start.copy()
    good = np.ones(len(uv), dtype=np.bool_)
    active = np.arange(len(uv))
    for _ in range(most):
        step, is_saddle = _compute_step(image, uv[active], sigma[active])
        uv[active] += step
        near = compute_lengths(uv[active] - start[active]) <= limit[active]
        good[active] = is_saddle & near
        active = active[good[active] & (compute_lengths(step) > tolerance)]
        if not len(active):
            break
    good[active] = False
    uv[~good] = start[~good]
    return uv, good


def _compute_step(image: GreyImage, uv: Array, sigma: Array) -> tuple[Array, BoolArray]:
    """Compute the step (n, 2) px from each estimate to its fitted stationary point, at most sigma
    long, and whether that is a saddle."""
    reach = np.ceil(3 * sigma + 0.5)[:, None]
    half = int(reach.max())
    tiles, origin = opencv.cut_tiles(image, uv, half)
    height, width = image.shape
    pixel = np.arange(2 * half + 1)
    moments, weighted = [], []
    for axis, extent in ((0, width), (1, height)):
        at = origin[:, axis, None] + pixel
        x = (at - uv[:, axis, None]) / sigma[:, None]
        w = np.exp(-0.5 * x * x) * ((at >= 0) & (at < extent) & (abs(pixel - half) <= reach))
        powers = x[:, None] ** np.arange(5)[:, None]
        moments.append(np.sum(w[:, None] * powers, axis=2))
        weighted.append(w[:, None] * powers[:, :3])
    p, q = _POWERS.T
    N = moments[0][:, p[:, None] + p] * moments[1][:, q[:, None] + q]
    projected = weighted[1] @ tiles.astype(np.float64) @ weighted[0].transpose(0, 2, 1)
    inside = np.all((uv >= 0) & (uv <= (width - 1, height - 1)), axis=1)
    N[~inside] = np.eye(len(_POWERS))
    fit = np.linalg.solve(N, projected[:, q, p][..., None])[..., 0]
    _, d, e, a, b, c = fit.T
    det = 4 * a * c - b * b
    is_saddle = (det < 0) & inside
    det = np.where(is_saddle, det, -1.0)
    step = np.column_stack([b * e - 2 * c * d, b * d - 2 * a * e]) / det[:, None]
    step *= (sigma * is_saddle)[:, None]
    longest = np.maximum(compute_lengths(step), sigma)
    return step * (sigma / longest)[:, None], is_saddle


def refine_lattice(
    image: GreyImage,
    lattice: Lattice,
    farthest: float = np.inf,
    bare_reach: float = 0.5,
    min_step: float = _MIN_STEP,
) -> tuple[Lattice, BoolArray]:
    """Move the corners of a lattice to their saddle points.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        farthest: longest way that one may move, px; never more than a quarter of a step.
        bare_reach: how far from the corners nothing is printed in the squares and on their edges.
        min_step: length of a step at which a saddle point has converged, px.

    Returns:
        The lattice, and a mask (rows, cols) of the corners that have a saddle point; the others
        keep their places.
    """
    corners = orient_corners(lattice)
    spacing = np.fmin(compute_lengths(corners.right), compute_lengths(corners.down))
    limit = np.minimum(spacing / 4, farthest)
    sigma = choose_weight_sigma(2 * bare_reach * spacing)
    moved, good = refine_saddles(image, corners.uv, sigma, limit, min_step)
    good &= not _do_squares_overlap_or_part(image, corners)
    at_saddle = lattice.found
    at_saddle[at_saddle] = good
    uv = lattice.uv.copy()
    uv[at_saddle] = moved[good]
    return Lattice(uv, lattice.dark), at_saddle


def _do_squares_overlap_or_part(image: GreyImage, corners: OrientedCorners) -> bool:
    """Return whether the squares at most of the corners overlap, or part, by more than the blur."""
    uv, right, down, _ = corners
    squares = sample_around(image, uv, right, down, _SQUARE_POSITIONS)
    contrast = abs(squares @ np.array([0.5, 0.5, -0.5, -0.5]))
    level = sample_around(image, uv, right, down, _CORNER_POSITIONS).mean(axis=1)
    off = level - squares.mean(axis=1)
    return bool(abs(compute_median(off)) > _MAX_OFF_MIDDLE * compute_median(contrast))

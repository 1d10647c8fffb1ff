"""What a map leaves of edges, followed along their lines from corner to corner.

No lens of a few coefficients bends as uneven paper does, nor as a lens where it hardly reaches any
farther. There the edges tell themselves how they bend: of each the mean place and the direction are
known at every corner of its line (``edge_lens``). To what a map leaves of those of a corner and of
some before and after it a polynomial f(t) of degree four is fitted. The line nearest to it over
what was read at the corner, t = 0, meets the edge

    mean of f - sqrt(3) m / h S - f(0)

off. Few corners follow what is rough, many are less disturbed by noise: that number is taken whose
polynomials predict best what is left out of each, r / (1 - l) for a residual r of leverage l. What
they leave unexplained says how well the bends are known. Where there are fewer than three corners
none is, and such an edge may be bent aside as far as others are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.detection.checkerboard.edge_bend import ReadEdges
from calibgui.engine.detection.checkerboard.edge_lens import PLACES, PRODUCTS

_DEGREE = 4
"""Degree of the polynomials."""
_REACHES = (2, 3, 4)
"""Numbers of corners before, and after, one that its polynomial may be fitted to. With the first
alone corners on paper of slow waves lie 1.2 times off the bound, with the last alone those on paper
of fast ones 1.3 times."""
_MIN_CORNERS = 3
"""Least number of corners that a polynomial is fitted to."""
_DAMPING = 1e-9
"""What is added to the diagonal of the normal equations, over its own entries."""
_MAX_LEVERAGE = 0.95
"""Leverage that counts as greatest: what alone decides a polynomial is not predicted by it."""


class LineBends(NamedTuple):
    """How far edges at n corners are bent aside beyond what a map says."""

    misfit: float
    """Rms by which the polynomials would miss a mean or slope left out, px."""
    bend: Array
    """(n, 2) px."""
    variance: Array
    """(n, 2) px^2, what the bends add to the variance of the corners across their edges."""


def follow_lines(found: BoolArray, edges: ReadEdges, rest: Array) -> LineBends:
    """Follow edges along their lines.

    Args:
        found: (rows, cols) True where a lattice has one of its n corners.
        edges: what was read there.
        rest: (2, 2, n) px, what a map leaves of the means and of the slopes of edges 1 and 2.
    """
    return min(
        (_fit_polynomials(_list_windows(found, reach), edges, rest) for reach in _REACHES),
        key=lambda bends: bends.misfit,
    )


def _fit_polynomials(windows: IntArray, edges: ReadEdges, rest: Array) -> LineBends:
    """Fit the polynomials to the corners numbered `windows` (2, n, k); see `follow_lines`."""
    _, n, k = windows.shape
    own = np.array([k // 2, k // 2 + k])
    bend, gain = np.empty((2, 2, n))
    square, missed, free = 0.0, 0.0, 0
    for edge, tangent in enumerate(edges.compute_tangents().transpose(1, 0, 2)):
        at, known = windows[edge], windows[edge] >= 0
        middle, half = edges.middle[:, edge], edges.half[:, edge]
        along = np.einsum("nkj,nj->nk", edges.uv[at] - edges.uv[:, None], tangent)
        unit = np.maximum(np.max(abs(along) * known, axis=1), half)[:, None]
        J = _compute_rows((along + middle[at]) / unit, half[at] / unit)
        J = (J * known[:, None, :, None]).reshape(n, 2 * k, -1)
        values = (rest[:, edge, at] * known).transpose(1, 0, 2).reshape(n, 2 * k, 1)
        N = J.transpose(0, 2, 1) @ J
        damped = N + _DAMPING * np.einsum("nii->ni", N)[:, None] * np.eye(_DEGREE + 1)
        to_terms = np.linalg.solve(damped, J.transpose(0, 2, 1))
        terms = to_terms @ values
        off = values - J @ terms
        line = np.zeros((n, 1, 2 * k))
        line[:, 0, own] = np.stack([np.ones(n), -(3**0.5) * middle / half], axis=1)
        at_corner = line @ J - np.eye(_DEGREE + 1)[0]
        bend[edge] = (at_corner @ terms)[:, 0, 0]
        gain[edge] = np.sum((line - at_corner @ to_terms) ** 2 - line**2, axis=(1, 2))
        leverage = np.einsum("nij,nji->ni", J[:, own], to_terms[:, :, own])
        left = 1 - np.minimum(leverage, _MAX_LEVERAGE)
        missed += float(np.sum((off[:, own, 0] / left) ** 2))
        square += float(np.sum(off**2))
        free += int(np.sum(np.maximum(2 * np.count_nonzero(known, axis=1) - _DEGREE - 1, 0)))
    variance = square / max(free, 1) * np.maximum(gain, 0.0)
    is_known = np.count_nonzero(windows >= 0, axis=2) >= _MIN_CORNERS
    usual = float(np.mean(bend[is_known] ** 2)) if is_known.any() else 0.0
    return LineBends(
        (missed / rest.size) ** 0.5,
        np.where(is_known, bend, 0.0).T,
        np.where(is_known, variance, usual).T,
    )


def _compute_rows(middle: Array, half: Array) -> Array:
    """Compute means and slopes (n, 2, k, terms) of the powers of t over |t - middle| <= half, both
    (n, k)."""
    t = middle[..., None] + half[..., None] * PLACES
    powers = np.ones((_DEGREE + 1, *t.shape))
    for degree in range(1, _DEGREE + 1):
        powers[degree] = powers[degree - 1] * t
    return np.asarray((powers @ PRODUCTS.T).transpose(1, 3, 2, 0))


def _list_windows(found: BoolArray, reach: int) -> IntArray:
    """List the numbers (2, n, 2 * reach + 1) of the corners around each in its row, and in its
    column; -1 where there is none."""
    numbers = np.full(np.array(found.shape) + 2 * reach, -1)
    row, col = np.argwhere(found).T[..., None] + reach
    numbers[row[:, 0], col[:, 0]] = np.arange(len(row))
    shifts = np.arange(-reach, reach + 1)
    return np.stack([numbers[row, col + shifts], numbers[row + shifts, col]])

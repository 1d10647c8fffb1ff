"""The edges of large squares, followed from corner to corner by their places and directions.

Over an arm of length L a curvature kappa moves an edge's mean by kappa L^2 / 6 (``edge_lens_fit``),
which a corner of large squares feels long before its neighbours tell: a curvature takes three
corners in a line, its change five, and small boards have no more. But the fit knows the directions
of such edges as well as it knows their corners. With arms of half a square, the two directions at
the ends of one edge tell its kappa L^2 / 6 to a fifth of a corner's standard deviation.

So the map of cells to the image is fitted to both. It is a homography through a radial lens
(``edge_lens_fit``), linear in its parameters once these are near, plus a polynomial p: with the
normals n_1 and n_2 of the edges at the cell x_i, p adds to their means and slopes, read over
|x - M| <= A squares,

    n_1 . (p + M p' + (A^2 / 3 + M^2) p'' / 2),      w n_1 . (p' + M p''),      p' = dp/dcol,

and the like with n_2 and rows. Here x is the length of the edge, in steps at the corner: where
perspective stretches the steps by a share g from one column to the next, p'' is d^2p/dcol^2 - g p'.
Else what a homography moves straight would be bent. A slope has sqrt(3) / A times the standard
deviation of its mean, in px per square; so w is A / sqrt(3). Whether there is a lens, of how many
coefficients, and a polynomial, of what degree, is decided by the generalised cross-validation
score, as in ``board_priors``. What the map leaves unexplained says how well its parameters are
known, and with them how edges bend.

Along a row only the corners tell how far a point lies, as many as there are columns; how far it
lies across is told by the directions as well. So the polynomial has other powers along the mean
step to the next column than along that to the next row.

**Along the lines.** No lens of a few coefficients bends as uneven paper does, nor as a lens where
it hardly reaches any farther. Where edges miss the map by far more than the corners' covariances,
they tell themselves how they bend: of each the mean place and the direction are known at every
corner of its line. To what a map leaves of those of a corner and of some before and after it a
polynomial f(t) of degree four is fitted. The line nearest to it over what was read at the corner, t
= 0, meets the edge

    mean of f - sqrt(3) m / h S - f(0)

off. Few corners follow what is rough, many are less disturbed by noise: that number is taken whose
polynomials predict best what is left out of each, r / (1 - l) for a residual r of leverage l. What
they leave unexplained says how well the bends are known. Where there are fewer than three corners
none is, and such an edge may be bent aside as far as others are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray
from calibgui.engine.corner_fit.edge_lens_fit import (
    LENS,
    MIN_CORNERS,
    MORE_COEFFICIENTS,
    PLACES,
    PRODUCTS,
    EdgeLens,
    ReadEdges,
    fit_lenses_to_edges,
)
from calibgui.engine.lattices import grid_map

MAX_TOLD_MISFIT = 1.2
"""Greatest rms miss, over the corners' standard deviation, up to which what many corners tell
is believed, or what a lens does."""
_MIN_EDGE_DEGREE = 3
"""Lowest degree of the polynomials tried that follow edges, too, beside none: a lens and a
homography come before."""
_MAX_EDGE_DEGREE = 5
"""The highest degree of those."""
TERM_COST = 1.4
"""Cost of a term in the cross-validation, as Kim and Gu (2004) advise: with 1 it takes too high
a degree by chance now and then."""
_MIN_EDGE_INDEPENDENCE = 0.02
"""The same as `_MIN_INDEPENDENCE` of terms that follow edges, too: what depends on less of a
term is noise."""
_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2))
"""Numbers of derivatives by column and by row that are needed."""
_MIN_PARAMETER = 1e-4
"""Least part of a parameter of the lens that those before it do not have in common with it."""
_DAMPING = 1e-12
"""What is added to the diagonal of the normal equations, over its own entries."""
_LINE_DEGREE = 4
"""Degree of the polynomials along lines."""
_REACHES = (2, 3, 4)
"""Numbers of corners before, and after, one that its polynomial may be fitted to. With the first
alone corners on paper of slow waves lie 1.2 times off the bound, with the last alone those on paper
of fast ones 1.3 times."""
_MIN_LINE_CORNERS = 3
"""Least number of corners that a polynomial is fitted to."""
_LINE_DAMPING = 1e-9
"""What is added to the diagonal of their normal equations, over its own entries."""
_MAX_LEVERAGE = 0.95
"""Leverage that counts as greatest: what alone decides a polynomial is not predicted by it."""


@dataclass(frozen=True, eq=False, slots=True)
class EdgeGeometry:
    """Steps and bends of the edges at n corners."""

    steps: Array
    """(n, 2, 2) derivatives of the position by column and by row, px."""
    bend: Array
    """(n, 2) how far the edges along both are bent aside, px; see ``edge_lens_fit``."""
    variance: Array
    """(n, 2) of the bends, px^2; 0 where it does not matter."""
    curvature_change: Array
    """(n, 2) by how much the edges' curvatures change along them, 1/px^2; 0 where it does not
    matter."""


class _LineBends(NamedTuple):
    """The bends of edges at n corners beyond what a map says."""

    misfit: float
    """Rms by which the polynomials would miss a mean or slope left out, px."""
    bend: Array
    """(n, 2) px."""
    variance: Array
    """(n, 2) px^2, what the bends add to the variance of the corners across their edges."""


class _Terms(NamedTuple):
    """The k terms of the polynomial at n corners, ordered by degree."""

    values: Array
    """(5, n, k) the terms and their derivatives, in the order of `_ORDERS`."""
    axis: IntArray
    """(k,) 0 for terms along the mean step to the next column, 1 along that to the next row."""
    degree: IntArray
    """(k,)"""


@lru_cache(maxsize=4)
def _compute_terms(shape: GridSize, found: bytes) -> _Terms:
    """Compute the terms for the corners found in a lattice of a shape; they are kept, since most
    images of a set show the same corners."""
    cells = np.argwhere(np.frombuffer(found, dtype=np.bool_).reshape(shape))[:, ::-1]
    extent = np.ptp(cells, axis=0)
    centre, half = cells.mean(axis=0), np.maximum(extent / 2, 1.0)
    highest = _MAX_EDGE_DEGREE
    powers = np.array([(d - r, r) for d in range(highest + 1) for r in range(d + 1)])
    limit = np.where(np.eye(2, dtype=np.bool_), extent, 2 * extent + 1)
    term, axis = np.nonzero(np.all(powers[:, None] <= limit, axis=2))
    table = np.polynomial.polynomial.polyvander((cells - centre) / half, highest)
    values = [
        grid_map.compute_polynomial_terms(table, powers[term], half, order) for order in _ORDERS
    ]
    return _Terms(np.stack(values), axis, powers.sum(axis=1)[term])


def follow_edges(found: BoolArray, edges: ReadEdges, sigma: float = np.inf) -> EdgeGeometry:
    """Fit the map, and differentiate it at the corners.

    Args:
        found: (rows, cols) True where a lattice has one of its n corners.
        edges: what was read there.
        sigma: standard deviation of the corners, px. If the map misses edges by clearly more, what
            it leaves is followed along their lines where that predicts better.
    """
    cells = np.argwhere(found)[:, ::-1].astype(np.float64)
    maps = fit_lenses_to_edges(cells, edges)
    fits = [_fit_polynomial(found, lens, edges) for lens in maps]
    score, geometry = min(fits, key=lambda fit: fit[0])
    misfit = float(np.sqrt(score / (4 * len(cells))))
    if len(cells) >= MIN_CORNERS and misfit > MAX_TOLD_MISFIT * sigma:
        for lens in maps:
            lines = _follow_lines(found, edges, lens.rest)
            if lines.misfit < misfit:
                misfit = lines.misfit
                bend = lens.bend.T + lines.bend
                geometry = EdgeGeometry(
                    lens.first,
                    bend,
                    lines.variance,
                    lens.curvature_change,
                )
    return geometry


def _fit_polynomial(
    found: BoolArray, lens: EdgeLens, edges: ReadEdges
) -> tuple[float, EdgeGeometry]:
    """Fit the polynomial that is added to a map, if any, and return the score of both with the
    geometry; arguments as in `follow_edges`."""
    rest = lens.rest.ravel()
    step = np.linalg.norm(lens.first, axis=2).T
    middle, half = (length.T[..., None] / step[..., None] for length in (edges.middle, edges.half))
    terms, axis, degree = _compute_terms(found.shape, found.tobytes())
    across = np.einsum("naj,kj->ank", edges.normals, lens.first.mean(axis=0)[axis])
    value, first, second = across * terms[0], across * terms[1:3], across * terms[3:]
    second -= lens.stretch.T[..., None] * first
    bends = (half**2 / 3 - middle**2) / 2 * second
    slopes = first + middle * second
    # The line nearest to an edge meets the corner `bends` off.
    means = value + bends + middle * slopes
    by_terms = np.stack([means, half / 3**0.5 * slopes])
    J = np.concatenate([lens.columns, by_terms], axis=3).reshape(len(rest), -1)
    bends = np.concatenate([lens.bend_columns, bends], axis=2)
    degree = np.concatenate([lens.degree, degree])
    # Of the lens all but the scale of its equations counts; a polynomial has much of it in common.
    least = np.where(degree < MORE_COEFFICIENTS, _MIN_PARAMETER, _MIN_EDGE_INDEPENDENCE)
    scale = np.linalg.norm(J, axis=0)
    J, bends = J / scale, bends / scale
    independent = np.diag(_factorise(J.T @ J)) > least
    J, bends, degree = J[:, independent], bends[..., independent], degree[independent]
    polynomials = range(_MIN_EDGE_DEGREE, degree[-1] + 1)
    tried = np.array([LENS, *range(MORE_COEFFICIENTS), *polynomials])
    counts = np.searchsorted(degree, tried, side="right")
    most = 2 * len(rest) // 3
    counts = np.append(min(counts[0], most), counts[1:][counts[1:] <= most])
    inverse = np.linalg.inv(_factorise(J.T @ J))
    share = inverse.T @ (J.T @ rest)
    rss = np.maximum(rest @ rest - np.cumsum(share**2)[counts - 1], 0.0)
    scores = rss / (1 - TERM_COST * counts / (len(rest) + 1)) ** 2
    best = int(np.argmin(scores))
    used = slice(counts[best])
    inverse, bends = inverse[used, used], bends[..., used]
    spread = np.sum((bends @ inverse) ** 2, axis=2)
    return float(scores[best]), EdgeGeometry(
        lens.first,
        (lens.bend + bends @ (inverse @ share[used])).T,
        rss[best] / (len(rest) - counts[best]) * spread.T,
        lens.curvature_change,
    )


def _factorise(N: Array) -> Array:
    """Factorise normal equations N = R^T R, R upper triangular."""
    return np.asarray(np.linalg.cholesky(N + _DAMPING * np.diag(np.diag(N)))).T


def _follow_lines(found: BoolArray, edges: ReadEdges, rest: Array) -> _LineBends:
    """Follow edges along their lines.

    Args:
        found: (rows, cols) True where a lattice has one of its n corners.
        edges: what was read there.
        rest: (2, 2, n) px, what a map leaves of the means and of the slopes of edges 1 and 2.
    """
    return min(
        (_fit_along_lines(_list_windows(found, reach), edges, rest) for reach in _REACHES),
        key=lambda bends: bends.misfit,
    )


def _fit_along_lines(windows: IntArray, edges: ReadEdges, rest: Array) -> _LineBends:
    """Fit the polynomials to the corners numbered `windows` (2, n, k); see `_follow_lines`."""
    _, n, k = windows.shape
    at_middle = np.array([k // 2, k // 2 + k])
    bend, gain = np.empty((2, 2, n))
    square, missed, free = 0.0, 0.0, 0
    for edge, tangent in enumerate(edges.compute_tangents().transpose(1, 0, 2)):
        at, is_there = windows[edge], windows[edge] >= 0
        middle, half = edges.middle[:, edge], edges.half[:, edge]
        along = np.einsum("nkj,nj->nk", edges.uv[at] - edges.uv[:, None], tangent)
        unit = np.maximum(np.max(abs(along) * is_there, axis=1), half)[:, None]
        J = _compute_rows((along + middle[at]) / unit, half[at] / unit)
        J = (J * is_there[:, None, :, None]).reshape(n, 2 * k, -1)
        values = (rest[:, edge, at] * is_there).transpose(1, 0, 2).reshape(n, 2 * k, 1)
        N = J.transpose(0, 2, 1) @ J
        damped = N + _LINE_DAMPING * np.einsum("nii->ni", N)[:, None] * np.eye(_LINE_DEGREE + 1)
        to_terms = np.linalg.solve(damped, J.transpose(0, 2, 1))
        terms = to_terms @ values
        off = values - J @ terms
        line = np.zeros((n, 1, 2 * k))
        line[:, 0, at_middle] = np.stack([np.ones(n), -(3**0.5) * middle / half], axis=1)
        at_corner = line @ J - np.eye(_LINE_DEGREE + 1)[0]
        bend[edge] = (at_corner @ terms)[:, 0, 0]
        gain[edge] = np.sum((line - at_corner @ to_terms) ** 2 - line**2, axis=(1, 2))
        leverage = np.einsum("nij,nji->ni", J[:, at_middle], to_terms[:, :, at_middle])
        unfitted = 1 - np.minimum(leverage, _MAX_LEVERAGE)
        missed += float(np.sum((off[:, at_middle, 0] / unfitted) ** 2))
        square += float(np.sum(off**2))
        free += int(
            np.sum(np.maximum(2 * np.count_nonzero(is_there, axis=1) - _LINE_DEGREE - 1, 0))
        )
    variance = square / max(free, 1) * np.maximum(gain, 0.0)
    is_known = np.count_nonzero(windows >= 0, axis=2) >= _MIN_LINE_CORNERS
    usual = float(np.mean(bend[is_known] ** 2)) if is_known.any() else 0.0
    return _LineBends(
        (missed / rest.size) ** 0.5,
        np.where(is_known, bend, 0.0).T,
        np.where(is_known, variance, usual).T,
    )


def _compute_rows(middle: Array, half: Array) -> Array:
    """Compute means and slopes (n, 2, k, terms) of the powers of t over |t - middle| <= half, both
    (n, k)."""
    t = middle[..., None] + half[..., None] * PLACES
    powers = np.ones((_LINE_DEGREE + 1, *t.shape))
    for degree in range(1, _LINE_DEGREE + 1):
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

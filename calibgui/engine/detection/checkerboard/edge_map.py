"""Curvatures of the edges of large squares, from the corners and from the directions of the edges.

Over an arm of length L a curvature kappa moves an edge's mean by kappa L^2 / 6 (``edge_bend``),
which a corner of large squares feels long before its neighbours tell: a curvature takes three
corners in a line, its change five, and small boards have no more. But the fit knows the directions
of such edges as well as it knows their corners. With arms of half a square, the two directions at
the ends of one edge tell its kappa L^2 / 6 to a fifth of a corner's standard deviation.

So the map of cells to the image is fitted to both. It is a homography through a radial lens
(``edge_lens``), linear in its parameters once these are near, plus a polynomial p: with the normals
n_1 and n_2 of the edges at the cell x_i, p adds to their means and slopes, read over |x - M| <= A
squares,

    n_1 . (p + M p' + (A^2 / 3 + M^2) p'' / 2),      w n_1 . (p' + M p''),      p' = dp/dcol,

and the like with n_2 and rows. Here x is the length of the edge, in steps at the corner: where
perspective stretches the steps by a share g from one column to the next, p'' is d^2p/dcol^2 - g p'.
Else what a homography moves straight would be bent. A slope has sqrt(3) / A times the standard
deviation of its mean, in px per square; so w is A / sqrt(3). Whether there is a lens, of how many
coefficients, and a polynomial, of what degree, is decided by the generalised cross-validation
score, as in ``board_priors``. What the map leaves unexplained says how well its parameters are
known, and with them how edges bend. If that is far more than the corners' covariances, as on uneven
paper, it is followed along the lines (``edge_lines``).

Along a row only the corners tell how far a point lies, as many as there are columns; how far it
lies across is told by the directions as well. So the polynomial has other powers along the mean
step to the next column than along that to the next row.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.edge_bend import ReadEdges
from calibgui.engine.detection.checkerboard.edge_lens import (
    LENS,
    MIN_CORNERS,
    MORE_COEFFICIENTS,
    EdgeLens,
    fit_edge_lenses,
)
from calibgui.engine.detection.checkerboard.edge_lines import follow_lines
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS

_THRESHOLDS = FIT_THRESHOLDS.priors
_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2))
"""Numbers of derivatives by column and by row that are needed."""
_MIN_PARAMETER = 1e-4
"""Least part of a parameter of the lens that those before it do not have in common with it."""
_DAMPING = 1e-12
"""What is added to the diagonal of the normal equations, over its own entries."""


@dataclass(frozen=True, eq=False, slots=True)
class EdgeGeometry:
    """Steps and bends of the edges at n corners."""

    steps: Array
    """(n, 2, 2) derivatives of the position by column and by row, px."""
    bend: Array
    """(n, 2) how far the edges along both are bent aside, px; see ``edge_bend``."""
    variance: Array
    """(n, 2) of the bends, px^2; 0 where it does not matter."""
    curvature_change: Array
    """(n, 2) by how much the edges' curvatures change along them, 1/px^2; 0 where it does not
    matter."""


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
    highest = _THRESHOLDS.max_edge_degree
    powers = np.array([(d - r, r) for d in range(highest + 1) for r in range(d + 1)])
    limit = np.where(np.eye(2, dtype=np.bool_), extent, 2 * extent + 1)
    term, axis = np.nonzero(np.all(powers[:, None] <= limit, axis=2))
    table = np.polynomial.polynomial.polyvander((cells - centre) / half, highest)
    values = [
        grid_map.compute_polynomial_terms(table, powers[term], half, order) for order in _ORDERS
    ]
    return _Terms(np.stack(values), axis, powers.sum(axis=1)[term])


def fit_edge_map(found: BoolArray, edges: ReadEdges, sigma: float = np.inf) -> EdgeGeometry:
    """Fit the map, and differentiate it at the corners.

    Args:
        found: (rows, cols) True where a lattice has one of its n corners.
        edges: what was read there.
        sigma: standard deviation of the corners, px. If the map misses edges by clearly more, what
            it leaves is followed along their lines where that predicts better.
    """
    cells = np.argwhere(found)[:, ::-1].astype(np.float64)
    lenses = fit_edge_lenses(cells, edges)
    fits = [_fit_polynomial(found, lens, edges) for lens in lenses]
    score, geometry = min(fits, key=lambda fit: fit[0])
    misfit = float(np.sqrt(score / (4 * len(cells))))
    if len(cells) >= MIN_CORNERS and misfit > _THRESHOLDS.max_told_misfit * sigma:
        for lens in lenses:
            lines = follow_lines(found, edges, lens.rest)
            if lines.misfit < misfit:
                misfit = lines.misfit
                bend = lens.bend.T + lines.bend
                geometry = EdgeGeometry(lens.first, bend, lines.variance, lens.curvature_change)
    return geometry


def _fit_polynomial(
    found: BoolArray, lens: EdgeLens, edges: ReadEdges
) -> tuple[float, EdgeGeometry]:
    """Fit the polynomial that is added to a lens, if any, and return the score of both with the
    geometry; arguments as in `fit_edge_map`."""
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
    least = np.where(degree < MORE_COEFFICIENTS, _MIN_PARAMETER, _THRESHOLDS.min_edge_independence)
    scale = np.linalg.norm(J, axis=0)
    J, bends = J / scale, bends / scale
    independent = np.diag(_factorise(J.T @ J)) > least
    J, bends, degree = J[:, independent], bends[..., independent], degree[independent]
    polynomials = range(_THRESHOLDS.min_edge_degree, degree[-1] + 1)
    tried = np.array([LENS, *range(MORE_COEFFICIENTS), *polynomials])
    counts = np.searchsorted(degree, tried, side="right")
    most = 2 * len(rest) // 3
    counts = np.append(min(counts[0], most), counts[1:][counts[1:] <= most])
    inverse = np.linalg.inv(_factorise(J.T @ J))
    share = inverse.T @ (J.T @ rest)
    rss = np.maximum(rest @ rest - np.cumsum(share**2)[counts - 1], 0.0)
    scores = rss / (1 - _THRESHOLDS.term_cost * counts / (len(rest) + 1)) ** 2
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

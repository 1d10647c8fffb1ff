"""Curvatures of the edges of large squares, from the corners and from the directions of the edges.

Over an arm of length L a curvature kappa moves an edge's mean by kappa L^2 / 6, which a corner of
large squares feels long before its neighbours tell: a curvature takes three corners in a line, its
change five, and small boards have no more. But the fit knows the directions of such edges as well
as it knows their corners. With arms of half a square, the two directions at the ends of one edge
tell its kappa L^2 / 6 to a fifth of a corner's standard deviation.

So the map p of cells to the image is fitted to both, by least squares: with the corner c_i at the
cell x_i, and the normals n_1 and n_2 of the edges there,

    p(x_i) = c_i,      w n_1 . dp/dcol (x_i) = 0,      w n_2 . dp/drow (x_i) = 0.

Read over A squares to both sides, a direction has sqrt(3) / A times the standard deviation of its
corner, in px per square; so w is A / sqrt(3). p is a homography through a radial lens
(``grid_map``) plus a polynomial, whose degree is the one of the least generalised cross-validation
score, as in ``board_priors``, but at least 3: so it holds what is uncertain of the homography and
the lens, too. What it leaves unexplained says how well the curvatures are known.

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
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS

_THRESHOLDS = FIT_THRESHOLDS.priors
_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2))
"""Numbers of derivatives by column and by row that are needed."""
_DAMPING = 1e-12
"""What is added to the diagonal of the normal equations, over its own entries."""


@dataclass(frozen=True, eq=False, slots=True)
class EdgeGeometry:
    """Steps and curvatures of the edges at n corners."""

    steps: Array
    """(n, 2, 2) derivatives of the position by column and by row, px."""
    curvature: Array
    """(n, 2) of the edges along both, 1/px; see ``BoardPriors.estimate_geometry``."""
    variance: Array
    """(n, 2) of the curvatures, 1/px^2; 0 where it does not matter."""


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
    """Compute the terms for the corners found in a lattice of a shape, as many as their equations
    carry; they are kept, since most images of a set show the same corners."""
    cells = np.argwhere(np.frombuffer(found, dtype=np.bool_).reshape(shape))[:, ::-1]
    extent = np.ptp(cells, axis=0)
    centre, half = cells.mean(axis=0), np.maximum(extent / 2, 1.0)
    highest = _THRESHOLDS.max_edge_degree
    powers = np.array([(d - r, r) for d in range(highest + 1) for r in range(d + 1)])
    limit = np.where(np.eye(2, dtype=np.bool_), extent, 2 * extent + 1)
    term, axis = np.nonzero(np.all(powers[:, None] <= limit, axis=2))
    degree = powers.sum(axis=1)[term]
    count = np.searchsorted(degree, degree + 1)
    carried = count <= 2 * 4 * len(cells) / 3
    term, axis, degree = term[carried], axis[carried], degree[carried]
    table = np.polynomial.polynomial.polyvander((cells - centre) / half, highest)
    values = [
        grid_map.compute_polynomial_terms(table, powers[term], half, order) for order in _ORDERS
    ]
    return _Terms(np.stack(values), axis, degree)


def fit_edge_map(
    found: BoolArray, uv: Array, normals: Array, arm: Array, curvature: Array
) -> EdgeGeometry:
    """Fit the map, and differentiate it at the corners.

    Args:
        found: (rows, cols) True where a lattice has one of its n corners.
        uv: (n, 2) the corners, px.
        normals: (n, 2, 2) unit normals of the row's edge towards the next row, and of the column's
            edge towards the next column.
        arm: (n, 2) how far the edges were read to both sides, px.
        curvature: (n, 2) that the edges were taken to have there, 1/px.
    """
    cells = np.argwhere(found)[:, ::-1].astype(np.float64)
    flat = grid_map.fit_radial_homography(cells, uv, are_exact=True)
    first, second = flat.differentiate(cells)
    along = np.sum(first * first, axis=2)
    bend = np.sum(second * normals, axis=2) / along
    third = arm**2 / 6
    offset = np.sum(normals * (uv - flat.locate(cells))[:, None], axis=2)
    offset += third * (curvature - bend)
    weight = arm / np.sqrt(3 * along)
    turn = -weight * np.sum(normals * first, axis=2)
    rest = np.concatenate([*offset.T, *turn.T])
    terms, axis, degree = _compute_terms(found.shape, found.tobytes())
    axes = first.mean(axis=0)[axis]
    across = np.einsum("naj,kj->ank", normals, axes)
    mean = terms[0] + (third / along).T[..., None] * terms[3:]
    J = np.concatenate([*(across * mean), *(weight.T[..., None] * across * terms[1:3])])
    N = J.T @ J
    R = _factorise(N)
    independent = np.diag(R) ** 2 > _THRESHOLDS.min_edge_independence**2 * np.diag(N)
    if not independent.all():  # lines with gaps do not tell all terms apart
        terms, across, J = terms[..., independent], across[..., independent], J[:, independent]
        axes, degree = axes[independent], degree[independent]
        R = _factorise(J.T @ J)
    tried = np.arange(min(_THRESHOLDS.min_edge_degree, degree[-1]), degree[-1] + 1)
    counts = np.searchsorted(degree, tried, side="right")
    inverse = np.linalg.inv(R)
    share = inverse.T @ (J.T @ rest)
    rss = np.maximum(rest @ rest - np.cumsum(share**2)[counts - 1], 0.0)
    best = np.argmin(rss / (1 - _THRESHOLDS.term_cost * counts / (len(rest) + 1)) ** 2)
    used = slice(counts[best])
    inverse = inverse[used, used]
    weights = inverse @ share[used]
    steps = first + (terms[1:3, :, used] @ (weights[:, None] * axes[used])).transpose(1, 0, 2)
    bends = across[..., used] * terms[3:, :, used]
    curvature = bend + (bends @ weights).T / along
    spread = np.sum((bends @ inverse) ** 2, axis=2).T / along**2
    return EdgeGeometry(steps, curvature, rss[best] / (len(rest) - counts[best]) * spread)


def _factorise(N: Array) -> Array:
    """Factorise normal equations N = R^T R, R upper triangular."""
    return np.asarray(np.linalg.cholesky(N + _DAMPING * np.diag(np.diag(N)))).T

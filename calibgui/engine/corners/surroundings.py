"""What the board as a whole says about each corner's surroundings.

Fitted to a single corner, the curvature of its edges and the gradients of light, blur and scale
are hard to tell from a displacement: all are odd under point reflection, and freeing them costs
40 % of the accuracy. Left out they bias it. They vary slowly over the board, so they are taken
from the lattice: of the lines p(n) of corners p'' normal to p' over |p'|^2 is the curvature, and
the gradient of a quantity f known at every corner follows from its derivatives along both lines,

    (df/dcol, df/drow) = (right, down)^T grad f.

Both are smoothed over the board by polynomials in column and row. Their degree is what the
values support: the one of the least generalised cross-validation score, RSS / (1 - k/n)^2 for k
terms and n values, which estimates how badly the polynomial would predict a corner left out.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import homography
from calibgui.engine.corners.lattice import Lattice, axes
from calibgui.engine.types import Array, IntArray

_HIGHEST = 7
"""Highest degree tried."""


def curvatures(lattice: Lattice) -> Array:
    """(n, 2) curvature of the row's and of the column's edge at each corner found, 1/px.

    An edge is p(s) = c + s t + kappa s^2 / 2 n, with the normal n of a row's edge towards the
    next row and that of a column's edge towards the next column. Perspective keeps the edges
    straight: p is a homography of (col, row) plus a polynomial for what the lens has bent.
    Differentiating p d = a, with a and d linear in (col, row), twice gives p'' = -2 p' d' / d.
    """
    at = np.argwhere(lattice.found)
    uv = lattice.uv[lattice.found]
    cells = at[:, ::-1].astype(np.float64)
    H = homography.dlt(cells, uv, np.ones(len(at)))
    flat = homography.apply(H, cells)
    bent = _Polynomial(at, lattice.shape, uv - flat)
    d = cells @ H[2, :2] + H[2, 2]
    first, second = [], []
    for axis, order in ((0, (0, 1)), (1, (1, 0))):
        slope = (H[:2, axis] - flat * H[2, axis]) / d[:, None]
        first.append(slope + bent.derivative(order))
        twice = (2 * order[0], 2 * order[1])
        second.append(-2 * slope * (H[2, axis] / d)[:, None] + bent.derivative(twice))
    kappa = [
        np.sum(p2 * _normal(p1, across), axis=1) / np.sum(p1 * p1, axis=1)
        for p1, p2, across in zip(first, second, reversed(first), strict=True)
    ]
    return np.column_stack(kappa)


def gradients(lattice: Lattice, values: Array) -> Array:
    """(n, k, 2) gradients over the image of `values` (n, k) known at the corners found, per px."""
    right, down = axes(lattice.uv)
    at = np.argwhere(lattice.found)
    polynomial = _Polynomial(at, lattice.shape, values)
    slopes = np.stack([polynomial.derivative(order) for order in ((0, 1), (1, 0))], axis=1)
    basis = np.stack([right[lattice.found], down[lattice.found]], axis=1)
    return np.asarray(np.linalg.solve(basis, slopes).transpose(0, 2, 1))


def _normal(along: Array, across: Array) -> Array:
    """Unit normal of `along` on the side of `across`."""
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    side = np.sign(np.sum(normal * across, axis=-1, keepdims=True))
    return np.asarray(side * normal / np.linalg.norm(normal, axis=-1, keepdims=True))


class _Polynomial:
    """Least-squares polynomials in row and column through k quantities at n cells (n, 2)."""

    def __init__(self, cells: IntArray, shape: tuple[int, int], values: Array) -> None:
        self._half = np.maximum(np.array(shape) - 1, 1) / 2
        limit = np.minimum(_HIGHEST, np.ptp(cells, axis=0))
        powers = np.argwhere(np.ones(limit + 1))
        degree = powers.sum(axis=1)
        order = np.argsort(degree, kind="stable")
        order = order[: max(2 * len(cells) // 3, 1)]
        self._powers, degree = powers[order], degree[order]
        x = cells / self._half - 1
        self._table = x[..., None] ** np.arange(_HIGHEST + 1)
        Q, R = np.linalg.qr(self._basis((0, 0)))
        weights = Q.T @ values
        # The terms are nested: dropping the last ones leaves the others' weights on Q unchanged.
        explained = np.cumsum(weights**2, axis=0)
        counts = np.searchsorted(degree, np.unique(degree[degree <= _HIGHEST]), side="right")
        rss = np.sum(values**2, axis=0) - explained[counts - 1]
        score = np.maximum(rss, 0.0) / (1 - counts[:, None] / (len(cells) + 1)) ** 2
        best = counts[np.argmin(score, axis=0)]
        weights[np.arange(len(weights))[:, None] >= best] = 0.0
        self._terms = np.linalg.solve(R, weights)

    def derivative(self, order: tuple[int, int]) -> Array:
        """(n, k) derivatives at the cells, of `order` by row and by column."""
        return np.asarray(self._basis(order) @ self._terms)

    def _basis(self, order: tuple[int, int]) -> Array:
        """(n, terms) at the cells, differentiated."""
        basis = np.ones((len(self._table), len(self._powers)))
        for axis in (0, 1):
            power, factor = self._powers[:, axis], np.ones(len(self._powers))
            for _ in range(order[axis]):
                factor, power = factor * power / self._half[axis], np.maximum(power - 1, 0)
            basis *= factor * self._table[:, axis, power]
        return basis

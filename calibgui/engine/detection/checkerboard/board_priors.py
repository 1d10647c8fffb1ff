"""What the board as a whole says about each corner's surroundings.

Fitted to a single corner, the curvature of its edges and the gradients of light, blur and scale
are hard to tell from a displacement: all are odd under point reflection, and freeing them costs
40 % of the accuracy. Left out they bias it. They vary slowly over the board, so they are taken
from the lattice: of the lines p(n) of corners p'' normal to p' over |p'|^2 is the curvature, and
the gradient of a quantity f known at every corner follows from its derivatives along both lines,

    (df/dcol, df/drow) = (right, down)^T grad f.

Both are smoothed over the board by polynomials in column and row. Their degree is what the
values support: the one of the least generalised cross-validation score, RSS / (1 - 1.4 k/n)^2 for
k terms and n values, which estimates how badly the polynomial would predict a corner left out.

No polynomial follows light that breaks, at the edge of a shadow or of a reflection: it would ring
all over the board. That shows where it misses the values by more than their second differences
along the lines let expect, of which a break spoils only a few. The derivatives are then the lesser
of the differences to both sides, the one that has no break in it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray
from calibgui.engine.detection import grid_map

_HIGHEST = 7
"""Highest degree tried."""
_CAUTION = 1.4
"""What a term costs in the cross-validation, as Kim and Gu (2004) advise: with 1 it takes too high
a degree by chance now and then."""
_OWN = 1e-6
"""Least part of a term that those of lower degree do not have in common with it."""
_BROKEN = 3.0
"""Rms miss of the polynomial over the values' noise, by their second differences, in light that
breaks."""
_NOISE = 1 / (0.6745 * 6**0.5)
"""Standard deviation of what is independent over the median of its absolute second differences."""
_ORDERS = ((0, 1), (1, 0), (0, 2), (2, 0))
"""Derivatives by row and by column that are needed."""


class _Terms(NamedTuple):
    """The polynomials' terms at n corners."""

    orthonormal: Array
    """(n, terms)"""
    derivatives: Array
    """(4, n, terms) of these, in the order of `_ORDERS`."""
    counts: IntArray
    """How many of the terms make up the polynomials of one degree after another."""


@lru_cache(maxsize=4)
def _terms(shape: GridSize, found: bytes) -> _Terms:
    """The terms for the corners found in a lattice of a shape: most images of a set show the
    same."""
    at = np.argwhere(np.frombuffer(found, dtype=np.bool_).reshape(shape))
    half = np.maximum(np.array(shape) - 1, 1) / 2
    limit = np.minimum(_HIGHEST, np.ptp(at, axis=0))
    powers = np.argwhere(np.ones(limit + 1))
    degree = powers.sum(axis=1)
    order = np.argsort(degree, kind="stable")
    order = order[: max(2 * len(at) // 3, 1)]
    powers, degree = powers[order], degree[order]
    x = at / half - 1
    table = x[..., None] ** np.arange(_HIGHEST + 1)
    basis = _basis(table, powers, half, (0, 0))
    Q, R = np.linalg.qr(basis)
    own = abs(np.diag(R)) > _OWN * np.linalg.norm(basis, axis=0)
    if not own.all():  # where lines have gaps the corners do not tell all terms apart
        powers, degree = powers[own], degree[own]
        Q, R = np.linalg.qr(basis[:, own])
    # The terms are nested: these many make up the polynomials of one degree after another.
    counts = np.searchsorted(degree, np.unique(degree[degree <= _HIGHEST]), side="right")
    inverse = np.linalg.inv(R)
    derivatives = np.stack([_basis(table, powers, half, order) @ inverse for order in _ORDERS])
    return _Terms(Q, derivatives, counts)


def _basis(table: Array, powers: IntArray, half: Array, order: tuple[int, int]) -> Array:
    """(n, terms) products of the `powers` (terms, 2) of row and column at the corners, of which
    `table` (n, 2, degrees) holds all, differentiated so often by either."""
    basis = np.ones((len(table), len(powers)))
    for axis in (0, 1):
        power, factor = powers[:, axis], np.ones(len(powers))
        for _ in range(order[axis]):
            factor, power = factor * power / half[axis], np.maximum(power - 1, 0)
        basis *= factor * table[:, axis, power]
    return basis


class Surroundings:
    """The polynomials over the corners of a lattice."""

    def __init__(self, found: BoolArray) -> None:
        """
        Args:
            found: (rows, cols) where the lattice has its n corners.
        """
        self._found = found
        self._terms = _terms(found.shape, found.tobytes())
        self._cells = np.argwhere(found)[:, ::-1].astype(np.float64)

    def geometry(self, uv: Array) -> tuple[Array, Array]:
        """Steps to the next column and row, and curvatures of the row's and column's edges.

        An edge is p(s) = c + s t + kappa s^2 / 2 n, with the normal n of a row's edge towards the
        next row and that of a column's edge towards the next column. p is the lattice's perspective
        (`perspective`) plus a polynomial for what the lens has bent otherwise.

        Args:
            uv: (n, 2) the corners, px.

        Returns:
            (n, 2, 2) derivatives of the position by column and by row, px, and (n, 2) kappa, 1/px.
        """
        flat = grid_map.fit_perspective(self._cells, uv)
        first, second = flat.derivatives(self._cells)
        bent, _ = self._differentiated(uv - flat.at(self._cells))
        by_col, by_row, by_col2, by_row2 = bent
        steps = first + np.stack([by_col, by_row], axis=1)
        return steps, curvatures(steps, second + np.stack([by_col2, by_row2], axis=1))

    def gradients(self, steps: Array, values: Array) -> Array:
        """(n, k, 2) gradients over the image of `values` (n, k) known at the corners, per px.

        Args:
            steps: (n, 2, 2) to the next column and row, px.
        """
        derivatives, missed = self._differentiated(values)
        slopes = derivatives[:2].transpose(1, 0, 2)
        before, after, second = self._differences(values)
        known = np.isfinite(second[..., 0])
        if known.any():
            noise = _NOISE * np.median(abs(second[known]), axis=0)
            lesser = np.where(abs(before) < abs(after), before, after)
            slopes = np.where(missed > _BROKEN * noise, np.nan_to_num(lesser), slopes)
        return np.asarray(np.linalg.solve(steps, slopes).transpose(0, 2, 1))

    def _differences(self, values: Array) -> tuple[Array, Array, Array]:
        """Of `values` (n, k) the differences (n, 2, k) from the neighbours before, by column and by
        row, those to the neighbours after, at the ends of lines the next ones instead, and the
        second differences; NaN where there is none."""
        rows, cols = self._found.shape
        around = np.full((rows + 4, cols + 4, values.shape[1]), np.nan)
        around[2:-2, 2:-2][self._found] = values
        lines = [
            [
                around[r : r + rows, 2 : cols + 2] if axis else around[2 : rows + 2, r : r + cols]
                for r in range(5)
            ]
            for axis in (0, 1)
        ]
        steps = [np.diff([place[self._found] for place in line], axis=0) for line in lines]
        earlier, before, after, later = np.stack(steps, axis=2)
        start, end = np.isnan(before), np.isnan(after)
        return np.where(start, later, before), np.where(end, earlier, after), after - before

    def _differentiated(self, values: Array) -> tuple[Array, Array]:
        """(4, n, k) derivatives `_ORDERS` of the polynomials through `values` (n, k), and by how
        much (k,) these would miss a value left out, rms."""
        Q, derivatives, counts = self._terms
        weights = Q.T @ values
        # Dropping the last terms leaves the others' weights on Q unchanged.
        explained = np.cumsum(weights**2, axis=0)[counts - 1]
        rss = np.maximum(np.sum(values**2, axis=0) - explained, 0.0)
        score = rss / (1 - _CAUTION * counts[:, None] / (len(values) + 1)) ** 2
        best = counts[np.argmin(score, axis=0)]
        weights[np.arange(len(weights))[:, None] >= best] = 0.0
        return derivatives @ weights, np.sqrt(score.min(axis=0) / len(values))


class Foreseen(Surroundings):
    """The same with steps and curvatures that a calibrated camera expects."""

    def __init__(self, found: BoolArray, geometry: tuple[Array, Array]) -> None:
        """
        Args:
            found: as above.
            geometry: what is expected, as below.
        """
        super().__init__(found)
        self._geometry = geometry

    def geometry(self, uv: Array) -> tuple[Array, Array]:
        """As expected, wherever the corners were found."""
        del uv
        return self._geometry


def curvatures(first: Array, second: Array) -> Array:
    """(n, 2) kappa, 1/px, of lines from the first and second derivatives (n, 2, 2) of positions by
    column and by row, px."""
    normal = _normal(first, first[:, ::-1])
    return np.asarray(np.sum(second * normal, axis=2) / np.sum(first * first, axis=2))


def _normal(along: Array, across: Array) -> Array:
    """Unit normal of `along` on the side of `across`."""
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    side = np.sign(np.sum(normal * across, axis=-1, keepdims=True))
    return np.asarray(side * normal / np.linalg.norm(normal, axis=-1, keepdims=True))

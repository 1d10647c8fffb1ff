"""Curvatures and gradients at every corner, taken from the board as a whole.

Fitted to a single corner, the curvature of its edges and the gradients of light, blur and scale
are hard to tell from a displacement: all are odd under point reflection, and freeing them costs
40 % of the accuracy. Left out they bias it. They vary slowly over the board, so they are taken
from the lattice: the curvature of a line p(n) of corners is its p'' normal to p' over |p'|^2, and
the gradient of a quantity f known at every corner follows from its derivatives along both lines,

    (df/dcol, df/drow) = (right, down)^T grad f.

Both are smoothed over the board by polynomials in column and row. Their degree is what the
values support: the one of the least generalised cross-validation score, RSS / (1 - 1.4 k/n)^2 for
k terms and n values, which estimates how badly the polynomial would predict a corner left out
(Kim and Gu 2004).

No polynomial follows light that breaks, at the edge of a shadow or of a reflection: it would ring
all over the board. Such a break shows where the polynomial misses the values by more than their
second differences along the lines predict, of which it spoils only a few. The derivatives are then
the lesser of the differences to both sides, the one that does not cross the break.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GridSize,
    IntArray,
    compute_lengths,
    compute_median,
    invert_2x2,
)
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.edge_bend import ReadEdges
from calibgui.engine.detection.checkerboard.edge_map import EdgeGeometry, fit_edge_map
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS

_THRESHOLDS = FIT_THRESHOLDS.priors
_NOISE_PER_DIFFERENCE = 1 / (0.6745 * 6**0.5)
"""Standard deviation of independent values over the median of their absolute second differences."""
_ORDERS = ((0, 1), (1, 0), (0, 2), (2, 0))
"""Numbers of derivatives by row and by column that are needed."""


class _Terms(NamedTuple):
    """The polynomials' terms at n corners."""

    orthonormal: Array
    """(n, terms)"""
    derivatives: Array
    """(4, n, terms) derivatives of these, in the order of `_ORDERS`."""
    neighbours: IntArray
    """(5, n, 2) numbers of the corners from two places before to two after, by column and by row;
    n where there is none."""
    triples: IntArray
    """(3, m) numbers of corners that follow each other in a row or a column."""
    counts: IntArray
    """(degrees,) numbers of the terms that make up the polynomials of one degree after another."""
    spreads: Array
    """(degrees, n, 2, 2) sums, over the terms of these, of the products of their derivatives by
    column and by row."""


@lru_cache(maxsize=4)
def _compute_terms(shape: GridSize, found: bytes) -> _Terms:
    """Compute the terms for the corners found in a lattice of a shape; they are kept, since most
    images of a set show the same corners."""
    at = np.argwhere(np.frombuffer(found, dtype=np.bool_).reshape(shape))
    half = np.maximum(np.array(shape) - 1, 1) / 2
    limit = np.minimum(_THRESHOLDS.max_degree, np.ptp(at, axis=0))
    powers = np.argwhere(np.ones(limit + 1))
    degree = powers.sum(axis=1)
    order = np.argsort(degree, kind="stable")
    order = order[: max(2 * len(at) // 3, 1)]
    powers, degree = powers[order], degree[order]
    x = at / half - 1
    table = x[..., None] ** np.arange(_THRESHOLDS.max_degree + 1)
    basis = grid_map.compute_polynomial_terms(table, powers, half)
    Q, R = np.linalg.qr(basis)
    independent = abs(np.diag(R)) > _THRESHOLDS.min_independence * np.linalg.norm(basis, axis=0)
    if not independent.all():  # lines with gaps do not tell all terms apart
        powers, degree = powers[independent], degree[independent]
        Q, R = np.linalg.qr(basis[:, independent])
    # The terms are nested by degree.
    counts = np.searchsorted(
        degree, np.unique(degree[degree <= _THRESHOLDS.max_degree]), side="right"
    )
    inverse = np.linalg.inv(R)
    derivatives = np.stack(
        [
            grid_map.compute_polynomial_terms(table, powers, half, order) @ inverse
            for order in _ORDERS
        ]
    )
    products = derivatives[:2, None] * derivatives[:2]
    spreads = np.cumsum(products, axis=3)[..., counts - 1].transpose(3, 2, 0, 1)
    neighbours = _list_neighbours(shape, at)
    triples = neighbours[1:4].reshape(3, -1)
    triples = triples[:, (triples < len(at)).all(axis=0)]
    return _Terms(Q, derivatives, neighbours, triples, counts, np.ascontiguousarray(spreads))


def _list_neighbours(shape: GridSize, at: IntArray) -> IntArray:
    """List `_Terms.neighbours` of the corners at (n, 2) places of a lattice of a shape."""
    numbers = np.full((shape[0] + 4, shape[1] + 4), len(at))
    numbers[tuple(at.T + 2)] = np.arange(len(at))
    row, col = at.T + 2
    places = [[numbers[row, col + k], numbers[row + k, col]] for k in range(-2, 3)]
    return np.moveaxis(np.array(places), 1, 2)


class BoardPriors:
    """Geometry and gradients at the corners of a lattice, from polynomials over all of them."""

    def __init__(self, found: BoolArray) -> None:
        """
        Args:
            found: (rows, cols) True where the lattice has one of its n corners.
        """
        self._found = found
        self._terms = _compute_terms(found.shape, found.tobytes())
        self._cells = np.argwhere(found)[:, ::-1].astype(np.float64)

    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Estimate steps to the next column and row, and curvatures of the edges along both.

        An edge is p(s) = c + s t + kappa s^2 / 2 n, with the normal n of a row's edge towards the
        next row and that of a column's edge towards the next column. p is a homography through a
        radial lens (``grid_map``) plus a polynomial for what the lens bends otherwise.

        Args:
            uv: (n, 2) the corners, px.

        Returns:
            (n, 2, 2) derivatives of the position by column and by row, px, and (n, 2) kappa, 1/px.
        """
        flat = grid_map.fit_radial_homography(
            self._cells, uv, are_exact=len(uv) < grid_map.MIN_LENS_POINTS
        )
        first, second = flat.differentiate(self._cells)
        weights, _, _ = self._fit_polynomials(uv - flat.locate(self._cells))
        rest = (self._terms.derivatives @ weights).transpose(1, 0, 2)
        steps = first + rest[:, :2]
        return steps, compute_curvatures(steps, second + rest[:, 2:])

    def follow_edges(self, edges: ReadEdges, sigma: float) -> EdgeGeometry:
        """Estimate the geometry again from the `edges` that were read; of few corners from the
        directions of these, too.

        Of more corners the directions count only if the polynomials, which err most at the ends of
        lines, miss them by clearly more than the standard deviation `sigma`, px, that they have.
        """
        if len(edges.uv) < _THRESHOLDS.many_corners:
            return fit_edge_map(self._found, edges, sigma)
        if np.isfinite(sigma):
            flat = grid_map.fit_radial_homography(self._cells, edges.uv)
            _, _, misses = self._fit_polynomials(edges.uv - flat.locate(self._cells))
            if np.mean(misses**2) > (_THRESHOLDS.max_told_misfit * sigma) ** 2:
                return fit_edge_map(self._found, edges, sigma)
        return self._bend_edges(edges)

    def _bend_edges(self, edges: ReadEdges) -> EdgeGeometry:
        """Return the geometry that the corners alone give."""
        steps, curvature = self.estimate_geometry(edges.uv)
        zeros = np.zeros_like(curvature)
        return EdgeGeometry(steps, edges.measure_bend(curvature), zeros, zeros)

    def estimate_gradients(self, steps: Array, values: Array) -> Array:
        """Estimate gradients (n, k, 2) over the image, per px, of `values` (n, k) at the corners.

        Args:
            steps: (n, 2, 2) to the next column and row, px.
        """
        weights, _, misfit = self._fit_polynomials(values)
        slopes = (self._terms.derivatives[:2] @ weights).transpose(1, 0, 2)
        is_broken = find_broken(misfit, self._estimate_noise(values))
        if is_broken.any():
            before, after = self._take_differences(values)
            lesser = np.where(abs(before) < abs(after), before, after)
            slopes = np.where(is_broken, np.nan_to_num(lesser), slopes)
        return _solve_steps(steps, slopes).transpose(0, 2, 1)

    def estimate_gradient_covariances(self, steps: Array, values: Array) -> Array:
        """Estimate the covariances (k, n, 2, 2) over the image, per px^2, that the gradients of
        `values` (n, k) have from their scatter about the polynomials, or where they break from that
        of their differences.

        Args:
            steps: (n, 2, 2) to the next column and row, px.
        """
        weights, degrees, misfit = self._fit_polynomials(values)
        noise = self._estimate_noise(values)
        inverse = invert_2x2(steps)
        rss = np.sum((values - self._terms.orthonormal @ weights) ** 2, axis=0)
        variance = rss / np.maximum(len(values) - self._terms.counts[degrees], 1)
        spreads = variance[:, None, None, None] * self._terms.spreads[degrees]
        is_broken = find_broken(misfit, noise)
        # The difference of two neighbours.
        spreads[is_broken] = 2 * noise[is_broken, None, None, None] ** 2 * np.eye(2)
        return np.asarray(inverse @ spreads @ inverse.transpose(0, 2, 1))

    def _estimate_noise(self, values: Array) -> Array:
        """Estimate the noise (k,) of `values` (n, k) from their differences along the lines."""
        before, here, after = values[self._terms.triples]
        return estimate_noise((after - here) - (here - before))

    def _take_differences(self, values: Array) -> tuple[Array, Array]:
        """Take differences (n, 2, k) of `values` (n, k), by column and by row, from the neighbours
        before and to the neighbours after, at the ends of lines the next ones instead; NaN where
        there is none."""
        nothing = np.full((1, values.shape[1]), np.nan)
        around = np.concatenate([values, nothing])[self._terms.neighbours]
        earlier, before, after, later = around[1:] - around[:-1]
        start, end = np.isnan(before), np.isnan(after)
        return np.where(start, later, before), np.where(end, earlier, after)

    def _fit_polynomials(self, values: Array) -> tuple[Array, IntArray, Array]:
        """Fit polynomials to `values` (n, k).

        Returns:
            (terms, k) the weights of their terms, (k,) their degrees, and (k,) the rms by which
            they would miss a value left out.
        """
        weights, counts = self._terms.orthonormal.T @ values, self._terms.counts
        degrees, misfit = _choose_degrees(values, weights, counts, _THRESHOLDS.term_cost)
        # Dropping the last terms leaves the others' weights on Q unchanged.
        weights[np.arange(len(weights))[:, None] >= counts[degrees]] = 0.0
        return weights, degrees, misfit


@kernels.with_kernel("board_priors", "choose_degrees")
def _choose_degrees(
    values: Array, weights: Array, counts: IntArray, term_cost: float
) -> tuple[IntArray, Array]:
    """Choose the degrees of polynomials by generalised cross-validation.

    Args:
        values: (n, k) that they are fitted to.
        weights: (terms, k) of orthonormal terms.
        counts: (degrees,) numbers of terms that make up the polynomials of each degree.
        term_cost: how much of a value a term costs.

    Returns:
        (k,) the places of the degrees among those counted, and (k,) the rms by which the
        polynomials would miss a value left out.
    """
    explained = np.cumsum(weights**2, axis=0)[counts - 1]
    rss = np.maximum(np.sum(values**2, axis=0) - explained, 0.0)
    score = rss / (1 - term_cost * counts[:, None] / (len(values) + 1)) ** 2
    return np.argmin(score, axis=0), np.sqrt(score.min(axis=0) / len(values))


def find_broken(misfit: Array, noise: Array) -> BoolArray:
    """Find the values (k,) that polynomials miss by a `misfit` (k,) far beyond their `noise` (k,):
    they break."""
    return np.asarray(misfit > _THRESHOLDS.max_relative_misfit * noise)


def estimate_noise(second: Array) -> Array:
    """Estimate the noise (k,) of values from their `second` differences (..., k), NaN where there
    are none; it is endless where there are none at all."""
    known = second[np.isfinite(second[..., 0])]
    if not len(known):
        return np.full(second.shape[-1], np.inf)
    median = compute_median(np.ascontiguousarray(abs(known).T))
    return np.asarray(_NOISE_PER_DIFFERENCE * median)


def _solve_steps(steps: Array, slopes: Array) -> Array:
    """Solve ``steps[i] @ x[i] = slopes[i]`` for x (n, 2, k), given steps (n, 2, 2) and slopes
    (n, 2, k): gradients over the image from derivatives by column and by row."""
    (a, b), (c, d) = steps.transpose(1, 2, 0)[..., None]
    by_col, by_row = slopes[:, 0], slopes[:, 1]
    solution = np.empty(slopes.shape)
    np.subtract(d * by_col, b * by_row, out=solution[:, 0])
    np.subtract(a * by_row, c * by_col, out=solution[:, 1])
    solution /= (a * d - b * c)[:, None]
    return solution


class PredictedBoardPriors(BoardPriors):
    """Board priors whose steps and curvatures are predicted by a calibrated camera."""

    def __init__(self, found: BoolArray, geometry: tuple[Array, Array]) -> None:
        """
        Args:
            found: as `BoardPriors`.
            geometry: the predicted steps (n, 2, 2) and curvatures (n, 2), as `estimate_geometry`
                returns them.
        """
        super().__init__(found)
        self._geometry = geometry

    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Return the predicted geometry, wherever the corners were found."""
        del uv
        return self._geometry

    def follow_edges(self, edges: ReadEdges, sigma: float) -> EdgeGeometry:
        """Return the predicted geometry, whatever the edges show."""
        del sigma
        return self._bend_edges(edges)


def compute_curvatures(first: Array, second: Array) -> Array:
    """Compute kappa (n, 2), 1/px, of lines from the first and second derivatives (n, 2, 2) of
    positions by column and by row, px."""
    turn = np.sign(_cross(first, first[:, ::-1]))
    return np.asarray(turn * _cross(first, second) / compute_lengths(first) ** 3)


def _cross(one: Array, other: Array) -> Array:
    """Compute the areas (...,) that vectors (..., 2) span, positive where the second turns from u
    towards v."""
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])

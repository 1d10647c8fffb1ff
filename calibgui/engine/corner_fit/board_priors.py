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

The edge fit looks at half a square around a corner. Around the corner of a tag less than that is
plain: the tag's border, the gap. There the fit is made in units of `unit` pitches, twice what is
plain around every corner, and wants steps and gradients per unit at places that lie in no even rows
and columns (`ScatteredPriors`). Both come from the map of the board's places to the image and from
polynomials in the place on the board.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property, lru_cache
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
from calibgui.engine.corner_fit.edge_lens_fit import ReadEdges
from calibgui.engine.corner_fit.followed_edges import (
    MAX_TOLD_MISFIT,
    TERM_COST,
    EdgeGeometry,
    follow_edges,
)
from calibgui.engine.lattices import grid_map

_MAX_DEGREE = 7
"""Highest degree of the polynomials tried."""
MANY_CORNERS = 40
"""Number of corners from which on they tell how edges bend, without their directions."""
_MIN_INDEPENDENCE = 1e-6
"""Least part of a term that those of lower degree do not have in common with it."""
_MAX_RELATIVE_MISFIT = 3.0
"""Greatest rms miss of a polynomial, over the noise of the values' second differences; beyond
it the values break, as light does at the edge of a shadow."""
_NOISE_PER_DIFFERENCE = 1 / (0.6745 * 6**0.5)
"""Standard deviation of independent values over the median of their absolute second differences."""
_ORDERS = ((0, 1), (1, 0), (0, 2), (2, 0))
"""Numbers of derivatives by row and by column that are needed."""
_DIFFERENCE_STEP = 0.5
"""Step of the central differences of the grid map at scattered places, units."""
_AROUND = np.array([(0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)])
"""(5, 2) the places (row, column) around a corner that they are taken at, and its own."""
_SAME_LINE = 1e-3
"""Distance across a line up to which scattered places count as on it, units."""
_MAX_SCATTERED_DEGREE = 4
"""Greatest degree of the polynomials that gradients at scattered places are taken from."""


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
    limit = np.minimum(_MAX_DEGREE, np.ptp(at, axis=0))
    powers = np.argwhere(np.ones(limit + 1))
    degree = powers.sum(axis=1)
    order = np.argsort(degree, kind="stable")
    order = order[: max(2 * len(at) // 3, 1)]
    powers, degree = powers[order], degree[order]
    x = at / half - 1
    table = x[..., None] ** np.arange(_MAX_DEGREE + 1)
    basis = grid_map.compute_polynomial_terms(table, powers, half)
    Q, R = np.linalg.qr(basis)
    independent = abs(np.diag(R)) > _MIN_INDEPENDENCE * np.linalg.norm(basis, axis=0)
    if not independent.all():  # lines with gaps do not tell all terms apart
        powers, degree = powers[independent], degree[independent]
        Q, R = np.linalg.qr(basis[:, independent])
    # The terms are nested by degree.
    counts = np.searchsorted(degree, np.unique(degree[degree <= _MAX_DEGREE]), side="right")
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


class BoardPriors(ABC):
    """The priors of geometry and gradients at each corner of a board that all corners give."""

    @abstractmethod
    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Estimate steps to the next column and row, and curvatures of the edges along both.

        An edge is p(s) = c + s t + kappa s^2 / 2 n, with the normal n of a row's edge towards the
        next row and that of a column's edge towards the next column.

        Args:
            uv: (n, 2) the corners, px.

        Returns:
            (n, 2, 2) derivatives of the position by column and by row, px, and (n, 2) kappa, 1/px.
        """

    def follow_edges(self, edges: ReadEdges, sigma: float) -> EdgeGeometry:
        """Estimate the geometry again from the `edges` that were read at corners of a standard
        deviation `sigma`, px; here from the corners alone."""
        del sigma
        steps, curvature = self.estimate_geometry(edges.uv)
        zeros = np.zeros_like(curvature)
        return EdgeGeometry(steps, edges.measure_bend(curvature), zeros, zeros)

    def estimate_gradients(self, steps: Array, values: Array) -> Array:
        """Estimate gradients (n, k, 2) over the image, per px, of `values` (n, k) at the corners.

        Args:
            steps: (n, 2, 2) to the next column and row, px.
        """
        slopes, misfit = self._fit_slopes(values)
        is_broken = _find_broken(misfit, self._estimate_noise(values))
        if is_broken.any():
            before, after = self._take_slopes(values)
            lesser = np.where(abs(before) < abs(after), before, after)
            slopes = np.where(is_broken, np.nan_to_num(lesser), slopes)
        return _solve_steps(steps, slopes).transpose(0, 2, 1)

    def estimate_gradient_covariances(self, steps: Array, values: Array) -> Array:
        """Estimate the covariances (k, n, 2, 2) over the image, per px^2, of the gradients of
        `values` (n, k); here they are zeros: over short arms they do not matter.

        Args:
            steps: (n, 2, 2) to the next column and row, px.
        """
        return np.zeros((values.shape[1], *steps.shape))

    @abstractmethod
    def _fit_slopes(self, values: Array) -> tuple[Array, Array]:
        """Fit polynomials to `values` (n, k); return their derivatives (n, 2, k) by column and by
        row, and the rms (k,) by which they would miss a value left out."""

    @abstractmethod
    def _take_slopes(self, values: Array) -> tuple[Array, Array]:
        """Take slopes (n, 2, k) of `values` (n, k), by column and by row, from the neighbours
        before and to the neighbours after, at the ends of lines the next ones instead; NaN where
        there is none."""

    @abstractmethod
    def _estimate_noise(self, values: Array) -> Array:
        """Estimate the noise (k,) of `values` (n, k) from their differences along the lines."""


class LatticePriors(BoardPriors):
    """Board priors at the corners of a lattice, from polynomials in column and row."""

    def __init__(self, found: BoolArray) -> None:
        """
        Args:
            found: (rows, cols) True where the lattice has one of its n corners.
        """
        self._found = found
        self._terms = _compute_terms(found.shape, found.tobytes())
        self._cells = np.argwhere(found)[:, ::-1].astype(np.float64)

    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Estimate the geometry of a homography through a radial lens (``grid_map``) plus a
        polynomial for what the lens bends otherwise."""
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
        if len(edges.uv) < MANY_CORNERS:
            return follow_edges(self._found, edges, sigma)
        if np.isfinite(sigma):
            flat = grid_map.fit_radial_homography(self._cells, edges.uv)
            _, _, misses = self._fit_polynomials(edges.uv - flat.locate(self._cells))
            if np.mean(misses**2) > (MAX_TOLD_MISFIT * sigma) ** 2:
                return follow_edges(self._found, edges, sigma)
        return super().follow_edges(edges, sigma)

    def estimate_gradient_covariances(self, steps: Array, values: Array) -> Array:
        """Estimate the covariances that the gradients have from the scatter of the values about the
        polynomials, or where they break from that of their differences."""
        weights, degrees, misfit = self._fit_polynomials(values)
        noise = self._estimate_noise(values)
        inverse = invert_2x2(steps)
        rss = np.sum((values - self._terms.orthonormal @ weights) ** 2, axis=0)
        variance = rss / np.maximum(len(values) - self._terms.counts[degrees], 1)
        spreads = variance[:, None, None, None] * self._terms.spreads[degrees]
        is_broken = _find_broken(misfit, noise)
        # The difference of two neighbours.
        spreads[is_broken] = 2 * noise[is_broken, None, None, None] ** 2 * np.eye(2)
        return np.asarray(inverse @ spreads @ inverse.transpose(0, 2, 1))

    def _fit_slopes(self, values: Array) -> tuple[Array, Array]:
        weights, _, misfit = self._fit_polynomials(values)
        return (self._terms.derivatives[:2] @ weights).transpose(1, 0, 2), misfit

    def _take_slopes(self, values: Array) -> tuple[Array, Array]:
        nothing = np.full((1, values.shape[1]), np.nan)
        around = np.concatenate([values, nothing])[self._terms.neighbours]
        earlier, before, after, later = around[1:] - around[:-1]
        start, end = np.isnan(before), np.isnan(after)
        return np.where(start, later, before), np.where(end, earlier, after)

    def _estimate_noise(self, values: Array) -> Array:
        before, here, after = values[self._terms.triples]
        return _estimate_noise((after - here) - (here - before))

    def _fit_polynomials(self, values: Array) -> tuple[Array, IntArray, Array]:
        """Fit polynomials to `values` (n, k).

        Returns:
            (terms, k) the weights of their terms, (k,) their degrees, and (k,) the rms by which
            they would miss a value left out.
        """
        weights, counts = self._terms.orthonormal.T @ values, self._terms.counts
        degrees, misfit = _choose_degrees(values, weights, counts, TERM_COST)
        # Dropping the last terms leaves the others' weights on Q unchanged.
        weights[np.arange(len(weights))[:, None] >= counts[degrees]] = 0.0
        return weights, degrees, misfit


class PredictedPriors(LatticePriors):
    """Board priors whose steps and curvatures are predicted by a calibrated camera."""

    def __init__(self, found: BoolArray, geometry: tuple[Array, Array]) -> None:
        """
        Args:
            found: (rows, cols) True where the lattice has one of its n corners.
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
        return BoardPriors.follow_edges(self, edges, sigma)


class _Polynomial(NamedTuple):
    """A polynomial of k terms in the places of n corners."""

    terms: Array
    """(n, k)"""
    inverse: Array
    """(k, n) from values to the terms' weights, by least squares."""
    derivatives: Array
    """(n, 2, k) of the terms by X and by Y."""
    share: float
    """Cost of its terms, of all that the values allow."""


class _Lines(NamedTuple):
    """The lines of n corners along one axis."""

    order: IntArray
    """(n,) indices of the corners, line after line."""
    is_same: BoolArray
    """(n - 1, 1) whether a corner and the next are on one line."""
    distance: Array
    """(n - 1, 1) from a corner to the next, 1 if that is on another line, units."""
    is_inner: BoolArray
    """(n - 2,) whether a corner and those before and after it are on one line."""
    weight: Array
    """(m, 1) of the differences of slopes there, which makes them as large as of even lines."""

    def compute_slopes(self, values: Array) -> Array:
        """Compute slopes (n - 1, k) of `values` (n, k) from a corner to the next, NaN if that is on
        another line."""
        steps = np.diff(values[self.order], axis=0) / self.distance
        return np.where(self.is_same, steps, np.nan)


class ScatteredPriors(BoardPriors):
    """Board priors at given places of a board, in a given unit; steps are those along its X and Y,
    one unit long."""

    def __init__(self, places: Array, unit: float) -> None:
        """
        Args:
            places: (n, 2) = (X, Y) of the corners on the board, pitches.
            unit: side of the square around a corner that is looked at, pitches.
        """
        self._places = places / unit

    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Estimate the geometry of a radial homography with a smooth residual (``grid_map``)."""
        cells = self._places[:, ::-1]  # the map counts (row, column)
        board = grid_map.fit_cells(cells, uv)
        around = np.concatenate([cells + step for step in _DIFFERENCE_STEP * _AROUND])
        here, left, right, up, down = board.locate(around).reshape(5, -1, 2)
        steps = np.stack([right - left, down - up], axis=1) / (2 * _DIFFERENCE_STEP)
        second = np.stack([right - 2 * here + left, down - 2 * here + up], axis=1)
        return steps, compute_curvatures(steps, second / _DIFFERENCE_STEP**2)

    def _fit_slopes(self, values: Array) -> tuple[Array, Array]:
        best = np.full(values.shape[1], np.inf)
        slopes = np.zeros((len(values), 2, values.shape[1]))
        for terms, inverse, derivatives, share in self._polynomials:
            weights = inverse @ values
            score = np.sum((values - terms @ weights) ** 2, axis=0) / (1 - share) ** 2
            better = score < best
            best = np.where(better, score, best)
            slopes = np.where(better, derivatives @ weights, slopes)
        return slopes, np.sqrt(best / len(values))

    def _take_slopes(self, values: Array) -> tuple[Array, Array]:
        n, k = values.shape
        before, after = np.full((2, n, 2, k), np.nan)
        for axis, line in enumerate(self._lines):
            slopes = line.compute_slopes(values)
            before[line.order[1:], axis], after[line.order[:-1], axis] = slopes, slopes
        return (
            np.where(np.isnan(before), after, before),
            np.where(np.isnan(after), before, after),
        )

    def _estimate_noise(self, values: Array) -> Array:
        second = [
            np.diff(line.compute_slopes(values), axis=0)[line.is_inner] * line.weight
            for line in self._lines
        ]
        return _estimate_noise(np.concatenate(second))

    @cached_property
    def _lines(self) -> list[_Lines]:
        """The lines of corners along X and along Y."""
        lines, both = np.rint(self._places / _SAME_LINE), []
        for axis in (0, 1):
            order = np.lexsort((lines[:, axis], lines[:, 1 - axis]))
            same = np.diff(lines[order, 1 - axis]) == 0
            distance = np.diff(self._places[order, axis])
            inner = same[1:] & same[:-1]
            before, after = distance[:-1][inner, None], distance[1:][inner, None]
            # of values of a variance 1 the slopes' difference has that below, and of even lines 6
            variance = 1 / before**2 + 1 / after**2 + (1 / before + 1 / after) ** 2
            apart = np.where(same, distance, 1.0)[:, None]
            both.append(_Lines(order, same[:, None], apart, inner, np.sqrt(6 / variance)))
        return both

    @cached_property
    def _polynomials(self) -> list[_Polynomial]:
        """The polynomials of all degrees that the number of places allows."""
        n = len(self._places)
        centre = self._places.mean(axis=0)
        half = np.maximum(np.ptp(self._places, axis=0) / 2, 1.0)
        table = ((self._places - centre) / half)[..., None] ** np.arange(_MAX_SCATTERED_DEGREE + 1)
        powers = np.argwhere(np.ones((_MAX_SCATTERED_DEGREE + 1, _MAX_SCATTERED_DEGREE + 1)))
        all_terms = [
            grid_map.compute_polynomial_terms(table, powers, half, order)
            for order in ((0, 0), (1, 0), (0, 1))
        ]
        polynomials = []
        for degree in range(_MAX_SCATTERED_DEGREE + 1):
            chosen = powers.sum(axis=1) <= degree
            share = TERM_COST * np.count_nonzero(chosen) / n
            if share >= 1:
                break
            terms, *derivatives = (np.compress(chosen, each, axis=1) for each in all_terms)
            least = np.finfo(np.float64).eps * max(terms.shape)
            inverse = np.asarray(np.linalg.pinv(terms, rcond=least), dtype=np.float64)
            polynomials.append(_Polynomial(terms, inverse, np.stack(derivatives, axis=1), share))
        return polynomials


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


def _find_broken(misfit: Array, noise: Array) -> BoolArray:
    """Find the values (k,) that polynomials miss by a `misfit` (k,) far beyond their `noise` (k,):
    they break."""
    return np.asarray(misfit > _MAX_RELATIVE_MISFIT * noise)


def _estimate_noise(second: Array) -> Array:
    """Estimate the noise (k,) of values from their `second` differences (..., k), NaN where there
    are none; it is endless where there are none at all."""
    usable = second[np.isfinite(second[..., 0])]
    if not len(usable):
        return np.full(second.shape[-1], np.inf)
    median = compute_median(np.ascontiguousarray(abs(usable).T))
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


def compute_curvatures(first: Array, second: Array) -> Array:
    """Compute kappa (n, 2), 1/px, of lines from the first and second derivatives (n, 2, 2) of
    positions by column and by row, px."""
    turn = np.sign(_cross(first, first[:, ::-1]))
    return np.asarray(turn * _cross(first, second) / compute_lengths(first) ** 3)


def _cross(one: Array, other: Array) -> Array:
    """Compute the areas (...,) that vectors (..., 2) span, positive where the second turns from u
    towards v."""
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])

"""Steps, curvatures and gradients at corners that do not lie in even rows and columns.

The edge fit looks at half a square around a corner. Around the corner of a tag less than that is
plain: the tag's border, the gap. So the fit is made in units of `unit` pitches, twice what is plain
around every corner, and wants steps and gradients per unit there. Both come from the map of the
board's places to the image, a radial homography with a smooth residual (`grid_map`), whatever the
distances of its lines, and from polynomials in the place on the board; where light breaks, from
the lesser of the slopes to both sides, as in `board_priors`.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.board_priors import (
    BoardPriors,
    compute_curvatures,
    estimate_noise,
    find_broken,
)
from calibgui.engine.detection.checkerboard.edge_bend import ReadEdges
from calibgui.engine.detection.checkerboard.edge_map import EdgeGeometry

_DIFFERENCE_STEP = 0.5
"""Step of the central differences of the grid map, units."""
_AROUND = np.array([(0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)])
"""(5, 2) the places (row, column) around a corner that they are taken at, and its own."""
_SAME_LINE = 1e-3
"""Distance across a line up to which places count as on it, units."""
_MAX_DEGREE = 4
"""Greatest degree of the polynomials that gradients are taken from."""
_TERM_COST = 1.4
"""Cost of a term in the generalised cross-validation of their degrees (Kim and Gu 2004)."""


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


class NearPriors(BoardPriors):
    """Board priors at given places of a board, in a given unit."""

    def __init__(self, places: Array, unit: float) -> None:
        """
        Args:
            places: (n, 2) = (X, Y) of the corners on the board, pitches.
            unit: side of the square around a corner that is looked at, pitches.
        """
        self._places = places / unit

    def estimate_geometry(self, uv: Array) -> tuple[Array, Array]:
        """Estimate steps (n, 2, 2) px along X and Y, one unit long, and curvatures (n, 2), 1/px, of
        the edges along both; see ``BoardPriors.estimate_geometry``."""
        cells = self._places[:, ::-1]  # the map counts (row, column)
        board = grid_map.fit_cells(cells, uv)
        around = np.concatenate([cells + step for step in _DIFFERENCE_STEP * _AROUND])
        here, left, right, up, down = board.locate(around).reshape(5, -1, 2)
        steps = np.stack([right - left, down - up], axis=1) / (2 * _DIFFERENCE_STEP)
        second = np.stack([right - 2 * here + left, down - 2 * here + up], axis=1)
        return steps, compute_curvatures(steps, second / _DIFFERENCE_STEP**2)

    def follow_edges(self, edges: ReadEdges, sigma: float) -> EdgeGeometry:
        """Estimate the geometry from the corners alone, which do not lie in even rows."""
        del sigma
        return self._bend_edges(edges)

    def estimate_gradients(self, steps: Array, values: Array) -> Array:
        """Estimate gradients (n, k, 2) over the image, per px, of `values` (n, k) at the corners.

        Args:
            steps: (n, 2, 2) px along X and Y, one unit long.
        """
        best = np.full(values.shape[1], np.inf)
        slopes = np.zeros((len(values), 2, values.shape[1]))
        for terms, inverse, derivatives, share in self._polynomials:
            weights = inverse @ values
            score = np.sum((values - terms @ weights) ** 2, axis=0) / (1 - share) ** 2
            better = score < best
            best = np.where(better, score, best)
            slopes = np.where(better, derivatives @ weights, slopes)
        before, after, second = self._take_slopes(values)
        misfit = np.sqrt(best / len(values))
        is_broken = find_broken(misfit, estimate_noise(second))
        if is_broken.any():
            lesser = np.where(abs(before) < abs(after), before, after)
            slopes = np.where(is_broken, np.nan_to_num(lesser), slopes)
        return np.asarray(np.linalg.solve(steps, slopes).transpose(0, 2, 1))

    def _take_slopes(self, values: Array) -> tuple[Array, Array, Array]:
        """Take slopes of `values` (n, k) between the corners of a line.

        Returns:
            (n, 2, k) slopes by X and by Y from the corner before and to the one after, where there
            is none the other one; and second differences of the values, as large as of even
            lines, NaN at the ends.
        """
        n, k = values.shape
        before, after, second = (np.full((n, 2, k), np.nan) for _ in range(3))
        for axis, line in enumerate(self._lines):
            order, same, inner = line.order, line.is_same, line.is_inner
            slope = np.where(same, np.diff(values[order], axis=0) / line.distance, np.nan)
            before[order[1:], axis], after[order[:-1], axis] = slope, slope
            second[order[1:-1][inner], axis] = (slope[1:] - slope[:-1])[inner] * line.weight
        return (
            np.where(np.isnan(before), after, before),
            np.where(np.isnan(after), before, after),
            second,
        )

    @cached_property
    def _lines(self) -> list[_Lines]:
        """The lines of corners along X and along Y."""
        lines, found = np.rint(self._places / _SAME_LINE), []
        for axis in (0, 1):
            order = np.lexsort((lines[:, axis], lines[:, 1 - axis]))
            same = np.diff(lines[order, 1 - axis]) == 0
            distance = np.diff(self._places[order, axis])
            inner = same[1:] & same[:-1]
            one, other = distance[:-1][inner, None], distance[1:][inner, None]
            # of values of a variance 1 the slopes' difference has that below, and of even lines 6
            variance = 1 / one**2 + 1 / other**2 + (1 / one + 1 / other) ** 2
            apart = np.where(same, distance, 1.0)[:, None]
            found.append(_Lines(order, same[:, None], apart, inner, np.sqrt(6 / variance)))
        return found

    @cached_property
    def _polynomials(self) -> list[_Polynomial]:
        """The polynomials of all degrees that the number of places allows."""
        n = len(self._places)
        centre = self._places.mean(axis=0)
        half = np.maximum(np.ptp(self._places, axis=0) / 2, 1.0)
        table = ((self._places - centre) / half)[..., None] ** np.arange(_MAX_DEGREE + 1)
        powers = np.argwhere(np.ones((_MAX_DEGREE + 1, _MAX_DEGREE + 1)))
        all_terms = [
            grid_map.compute_polynomial_terms(table, powers, half, order)
            for order in ((0, 0), (1, 0), (0, 1))
        ]
        polynomials = []
        for degree in range(_MAX_DEGREE + 1):
            chosen = powers.sum(axis=1) <= degree
            share = _TERM_COST * np.count_nonzero(chosen) / n
            if share >= 1:
                break
            terms, *derivatives = (np.compress(chosen, each, axis=1) for each in all_terms)
            least = np.finfo(np.float64).eps * max(terms.shape)
            inverse = np.asarray(np.linalg.pinv(terms, rcond=least), dtype=np.float64)
            polynomials.append(_Polynomial(terms, inverse, np.stack(derivatives, axis=1), share))
        return polynomials

    def estimate_gradient_covariances(self, steps: Array, values: Array) -> Array:
        """Return zeros (k, n, 2, 2) for `values` (n, k): over the short arms that are read here it
        does not matter."""
        return np.zeros((values.shape[1], *steps.shape))

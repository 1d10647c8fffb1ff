"""Steps, curvatures and gradients at corners that do not lie in even rows and columns.

The edge fit looks at half a square around a corner. Around the corner of a tag less than that is
plain: the tag's border, the gap. So the fit is made in units of `unit` pitches, twice what is plain
around every corner, and wants steps and gradients per unit there. Both come from the map of the
board's places to the image, a radial homography with a smooth residual (`grid_map`), whatever the
distances of its lines, and from polynomials in the place on the board.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.board_priors import BoardPriors, compute_curvatures
from calibgui.engine.detection.checkerboard.edge_map import EdgeGeometry

_DIFFERENCE_STEP = 0.5
"""Step of the central differences of the grid map, units."""
_MAX_DEGREE = 4
"""Greatest degree of the polynomials that gradients are taken from."""
_TERM_COST = 1.4
"""Cost of a term in the generalised cross-validation of their degrees (Kim and Gu 2004)."""


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
        board = grid_map.fit_cells(self._places[:, ::-1], uv)
        here = board.locate(self._places[:, ::-1])
        first, second = [], []
        for axis in (1, 0):  # the map counts (row, column)
            step = _DIFFERENCE_STEP * np.eye(2)[axis]
            before, after = (board.locate(self._places[:, ::-1] + s * step) for s in (-1, 1))
            first.append((after - before) / (2 * _DIFFERENCE_STEP))
            second.append((after - 2 * here + before) / _DIFFERENCE_STEP**2)
        steps = np.stack(first, axis=1)
        return steps, compute_curvatures(steps, np.stack(second, axis=1))

    def follow_edges(self, uv: Array, normals: Array, arm: Array, curvature: Array) -> EdgeGeometry:
        """Estimate the geometry from the corners alone, which do not lie in even rows."""
        del normals, arm, curvature
        return EdgeGeometry(*self.estimate_geometry(uv), np.zeros((len(uv), 2)))

    def estimate_gradients(self, steps: Array, values: Array) -> Array:
        """Estimate gradients (n, k, 2) over the image, per px, of `values` (n, k) at the corners.

        Args:
            steps: (n, 2, 2) px along X and Y, one unit long.
        """
        centre = self._places.mean(axis=0)
        half = np.maximum(np.ptp(self._places, axis=0) / 2, 1.0)
        table = ((self._places - centre) / half)[..., None] ** np.arange(_MAX_DEGREE + 1)
        best = np.full(values.shape[1], np.inf)
        slopes = np.zeros((len(values), 2, values.shape[1]))
        for degree in range(_MAX_DEGREE + 1):
            powers = np.argwhere(np.ones((degree + 1, degree + 1)))
            powers = powers[powers.sum(axis=1) <= degree]
            share = _TERM_COST * len(powers) / len(values)
            if share >= 1:
                break
            terms = grid_map.compute_polynomial_terms(table, powers, half)
            weights = np.linalg.lstsq(terms, values)[0]
            score = np.sum((values - terms @ weights) ** 2, axis=0) / (1 - share) ** 2
            better = score < best
            best = np.where(better, score, best)
            for axis, order in enumerate(((1, 0), (0, 1))):
                derivative = grid_map.compute_polynomial_terms(table, powers, half, order)
                slopes[:, axis] = np.where(better, derivative @ weights, slopes[:, axis])
        return np.asarray(np.linalg.solve(steps, slopes).transpose(0, 2, 1))

    def estimate_gradient_covariance(self, steps: Array, values: Array) -> Array:
        """Return zeros (n, 2, 2): over the short arms that are read here it does not matter."""
        del values
        return np.zeros_like(steps)

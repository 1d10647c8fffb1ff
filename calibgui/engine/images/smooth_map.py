"""Interpolation of a smooth map of pixels, which is exact at knots, by cubics between them.

To trace every pixel of an image through a lens takes an iteration each. The map is smooth, so
it is solved on a grid of knots only.

Along each axis a pixel at (i + t) step, 0 <= t < 1, takes the cubic through the knots i - 1 to
i + 2, with Lagrange's weights

    -t(t-1)(t-2)/6,   (t+1)(t-1)(t-2)/2,   -(t+1)t(t-2)/2,   (t+1)t(t-1)/6.

Their error is greatest in the middle of a cell, where it is measured. Cells that it makes
unfit, or that the edge of the map's domain crosses, are solved pixel by pixel; where they are
many the knots are set closer first.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.images.sampling import make_mesh

MAP_TOLERANCE_PX = 0.005
"""Largest error of interpolation, px: a third of the 1/64 px to which OpenCV 4 rounds."""
_KNOT_SPACINGS_PX = (32, 16, 8, 4, 2)
"""Distances between knots that are tried in turn, px."""

Source = Callable[[Array], Array]
"""Function from points (..., 2) to points (..., 2), NaN outside its domain."""


def interpolate_map(
    size: Size, source: Source, low: Array, high: Array
) -> Callable[[slice], Array]:
    """Prepare the evaluation of `source` at whole rows of pixels.

    Args:
        size: width and height of the image whose pixels are mapped.
        source: the map, exact but slow.
        low, high: (2,) corners of the rectangle where mapped points are wanted.

    Returns:
        A function from a slice of rows to their mapped pixels (rows, width, 2), each within
        about `TOLERANCE` of the map, or NaN if outside its domain or well outside the rectangle.
    """
    for step in _KNOT_SPACINGS_PX:
        knots = _KnotMap(size, step, source, low, high)
        # To halve the step costs 8 / step^2 solutions a pixel, knots and middles.
        if knots.unfit.mean() <= 8 / step**2:
            break
    u, v = (np.arange(n, dtype=np.float64) for n in size)
    return lambda band: knots.evaluate(u, v[band])


class _KnotMap:
    """Values of a map at knots `step` px apart, from one step before the first pixel.

    `unfit` marks the cells where interpolation errs too much, `unwanted` those that are mapped
    outside the rectangle of interest.
    """

    def __init__(self, size: Size, step: int, source: Source, low: Array, high: Array) -> None:
        self.step, self.source = step, source
        u, v = (np.arange(-1.0, (n - 1) // step + 3) * step for n in size)
        self.values = source(make_mesh(u, v))
        middle = u[1:-2] + step / 2, v[1:-2] + step / 2
        exact = source(make_mesh(*middle))
        with np.errstate(invalid="ignore"):  # NaN knots make the cells around them unfit
            error = np.abs(exact - self._interpolate(*middle)).max(axis=-1)
        ends = slice(1, -2), slice(2, -1)
        corners = [self.values[i, j] for i in ends for j in ends]
        least = np.fmin.reduce([exact, *corners])
        greatest = np.fmax.reduce([exact, *corners])
        wanted = ((least <= high) & (greatest >= low)).all(axis=-1)
        self.unwanted: BoolArray = ~wanted
        self.unfit: BoolArray = wanted & ~(error < MAP_TOLERANCE_PX)

    def evaluate(self, u: Array, v: Array) -> Array:
        """Return the map (len(v), len(u), 2) at columns `u` and rows `v`."""
        mapped = self._interpolate(u, v)
        cells = np.ix_(*(np.floor(x / self.step).astype(int) for x in (v, u)))
        mapped[self.unwanted[cells]] = np.nan
        unfit = self.unfit[cells]
        if unfit.any():
            mapped[unfit] = self.source(make_mesh(u, v)[unfit])
        return mapped

    def _interpolate(self, u: Array, v: Array) -> Array:
        """Return the interpolated map (len(v), len(u), 2), fit or not."""
        by_v, by_u = self._compute_weights(v, axis=0), self._compute_weights(u, axis=1)
        parts = [(by_u @ (by_v @ self.values[..., i]).T).T for i in (0, 1)]
        return np.stack(parts, axis=-1)

    def _compute_weights(self, x: Array, axis: int) -> scipy.sparse.csr_array:
        """Return the weights (len(x), knots) of the knots along one axis."""
        i = np.floor(x / self.step).astype(int)
        t = x / self.step - i
        a, b, c = t + 1, t - 1, t - 2
        weights = np.stack([-t * b * c / 6, a * b * c / 2, -a * t * c / 2, a * t * b / 6], axis=1)
        columns = i[:, None] + np.arange(4)
        ends = np.arange(0, 4 * len(x) + 1, 4)
        shape = (len(x), self.values.shape[axis])
        return scipy.sparse.csr_array((weights.ravel(), columns.ravel(), ends), shape=shape)

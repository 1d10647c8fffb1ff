"""Interpolation of a smooth map of pixels, which is exact at knots, by cubics between them.

To trace every pixel of an image through a lens takes hundreds of operations each. The map is
smooth, so it is solved on a grid of knots only.

Along each axis a pixel at (i + t) step, 0 <= t < 1, takes the cubic through the knots i - 1 to
i + 2, with Lagrange's weights

    -t(t-1)(t-2)/6,   (t+1)(t-1)(t-2)/2,   -(t+1)t(t-2)/2,   (t+1)t(t-1)/6.

The weights are the same in every cell between knots, so a row of pixels is one small product: the
four knots around each cell times the weights of the places within it. It is formed in single
precision, whose rounding, a few 1e-4 px, is that of the positions OpenCV resamples at.

The interpolation's error is greatest in the middle of a cell, where it is measured. Cells that it
makes unfit, or that the edge of the map's domain crosses, are solved pixel by pixel; where they
are many the knots are set closer first.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, FloatImage, IntArray, Size
from calibgui.engine.images.sampling import make_mesh

MAP_TOLERANCE_PX = 0.005
"""Largest error of interpolation, px: a third of the 1/64 px to which OpenCV 4 rounds."""
_KNOT_SPACINGS_PX = (128, 64, 32, 16, 8, 4, 2)
"""Distances between knots that are tried in turn, px."""
_SAFE_SPACING_PX = 32
"""Distance between knots that is tried in images of any size, px."""
_KNOTS_ACROSS = 16
"""Number of knots across the shorter side that a wider distance must leave, lest a small part of
the image that alone sees anything falls between them."""

Source = Callable[[Array], Array]
"""Function from points (..., 2) to points (..., 2), NaN outside its domain."""


def interpolate_map(
    size: Size, source: Source, low: Array, high: Array
) -> Callable[[slice], FloatImage]:
    """Prepare the evaluation of `source` at whole rows of pixels.

    Args:
        size: width and height of the image whose pixels are mapped.
        source: the map, exact but slow.
        low, high: (2,) corners of the rectangle where mapped points are wanted.

    Returns:
        A function from a slice of rows to their mapped pixels (2, rows, width), u and v, each
        within about `MAP_TOLERANCE_PX` of the map, or NaN if outside its domain or well outside
        the rectangle.
    """
    widest = max(min(size) / _KNOTS_ACROSS, _SAFE_SPACING_PX)
    for step in (spacing for spacing in _KNOT_SPACINGS_PX if spacing <= widest):
        knots = _KnotMap(size, step, source, low, high)
        # To halve the step costs 8 / step^2 solutions a pixel, knots and middles.
        if knots.unfit.mean() <= 8 / step**2:
            break
    return knots.evaluate


class _KnotMap:
    """Values of a map at knots `step` px apart, from one step before the first pixel.

    `unfit` marks the cells where interpolation errs too much, `unwanted` those that are mapped
    outside the rectangle of interest.
    """

    def __init__(self, size: Size, step: int, source: Source, low: Array, high: Array) -> None:
        self.step, self.source = step, source
        self._width = size[0]
        self._weights = _compute_weights(np.arange(step) / step).astype(np.float32)
        u, v = (np.arange(-1.0, (n - 1) // step + 3) * step for n in size)
        self.values = np.moveaxis(source(make_mesh(u, v)), -1, 0)
        middle = u[1:-2] + step / 2, v[1:-2] + step / 2
        exact = np.moveaxis(source(make_mesh(*middle)), -1, 0)
        rows = np.arange(step // 2, (len(v) - 3) * step, step)
        interpolated = self._interpolate(rows, _compute_weights(np.array([0.5])))[..., 0]
        error = np.abs(exact - interpolated).max(axis=0)
        ends = slice(1, -2), slice(2, -1)
        samples = np.stack([exact, *(self.values[:, i, j] for i in ends for j in ends)])
        is_blind = np.isnan(samples).any(axis=1)
        wanted = _may_reach(samples, np.where(is_blind.any(axis=0), 2.0 * step, 0.0), low, high)
        # The edge of the domain may bulge into cells of which no sample is inside it.
        edge = opencv.dilate_image(
            (wanted & is_blind.any(axis=0)).astype(np.float32), np.ones((3, 3), bool)
        )
        self.unwanted: BoolArray = ~wanted
        self.unfit: BoolArray = wanted & ~(error < MAP_TOLERANCE_PX)
        self.unfit |= (edge > 0) & is_blind.all(axis=0)

    def evaluate(self, band: slice) -> FloatImage:
        """Return the map (2, rows, width) at a slice of rows."""
        v = np.arange(band.start, band.stop)
        mapped = self._interpolate(v, self._weights)
        cells = v // self.step
        mapped[:, self.unwanted[cells]] = np.nan
        row, cell = np.nonzero(self.unfit[cells])
        if len(row):
            u = cell[:, None] * self.step + np.arange(self.step)
            points = np.stack(np.broadcast_arrays(u, v[row, None]), axis=-1).astype(np.float64)
            mapped[:, row, cell] = np.moveaxis(self.source(points), -1, 0)
        return np.asarray(mapped.reshape(2, len(v), -1)[..., : self._width])

    def _interpolate(self, v: IntArray, weights: npt.NDArray[np.floating]) -> npt.NDArray[Any]:
        """Return the interpolated map (2, len(v), cells, places), fit or not.

        Args:
            v: rows of pixels, in their order.
            weights: (4, places) of the four knots around a cell, for each place in it; the
                result has their type.
        """
        i, t = np.divmod(v, self.step)
        by_row = _compute_weights(t / self.step).T.astype(weights.dtype)
        values = self.values[:, i[0] : i[-1] + 4].astype(weights.dtype)
        with np.errstate(invalid="ignore"):  # NaN knots make the cells around them unfit
            around = np.lib.stride_tricks.sliding_window_view(values, 4, axis=-1)
            along = np.ascontiguousarray(around).reshape(-1, 4) @ weights
            along = along.reshape(2, values.shape[1], -1)
            mapped = np.empty((2, len(v), along.shape[-1]), weights.dtype)
            starts = np.flatnonzero(np.diff(i, prepend=-1))
            for start, end in pairwise([*starts.tolist(), len(v)]):
                k = i[start] - i[0]
                np.matmul(by_row[start:end], along[:, k : k + 4], out=mapped[:, start:end])
        return mapped.reshape(2, len(v), -1, weights.shape[1])


def _may_reach(samples: Array, extent: Array, low: Array, high: Array) -> BoolArray:
    """Return (rows, cells) whether cells may be mapped into a rectangle, by samples of each.

    The map is curved: between the samples it may reach beyond them, by less than a quarter of their
    extent.

    Args:
        samples: (5, 2, rows, cells), the middle and the corners.
        extent: (rows, cells) least reach, px, of cells of which not all samples are known.
        low, high: (2,) corners of the rectangle.
    """
    least, greatest = np.fmin.reduce(samples), np.fmax.reduce(samples)
    margin = np.maximum((greatest - least) / 4, extent)
    reaches_u, reaches_v = (least - margin <= high[:, None, None]) & (
        greatest + margin >= low[:, None, None]
    )
    return np.asarray(reaches_u & reaches_v)


def _compute_weights(t: Array) -> Array:
    """Return Lagrange's weights (4, n) of the knots around places t (n,) in a cell."""
    a, b, c = t + 1, t - 1, t - 2
    return np.stack([-t * b * c / 6, a * b * c / 2, -a * t * c / 2, a * t * b / 6])

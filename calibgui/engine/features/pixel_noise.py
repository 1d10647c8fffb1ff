"""The noise of an image from pixel to pixel, and its dead pixels.

**Noise** is read where what is printed is flat. What an edge model leaves unexplained is noise and
whatever is no edge. Waves, moire and textures vary smoothly over several pixels, noise from one to
the next: the second difference along rows of the second difference along columns (J. Immerkaer,
Fast noise variance estimation, 1996) sees little of the former, and nothing of even light.

**Dead pixels** are dark or bright whatever they see. A sensor's dead and hot pixels, in a dim
picture far brighter than its paper, mislead what is read of the corner beside them. No print shows
such: even at the corner of a square of a few pixels there are two more beside it that see the same.
One that stands out from all of its eight neighbours, or from all but one that is dead as well, by
half of the board's contrast is none of the board's, nor noise in which the board could be seen.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median
from calibgui.engine.features.corner_template import estimate_contrast, orient_corners
from calibgui.engine.features.lattice import Lattice

ROUNDING_VARIANCE = 1 / 12
"""Variance that grey levels have at least, levels^2 (Widrow 1956). A drawn or saturated image shows
no noise, but its levels are rounded, by up to half of one, evenly; without it corners in such
images would seem to be free of error."""
_GAIN = 6.0
"""Standard deviation of such a difference where that of the noise is 1: the squares of its weights,
(1, -2, 1) times (1, -2, 1), sum to 36."""
_NORMAL_MEDIAN = 0.6745
"""Median of the magnitude of a standard normal variable."""
_MIN_SQUARES = 6
"""Number of squares below which nothing is said of the noise."""
_MIN_RELATIVE_STEP = 0.5
"""Least difference of a dead pixel from its neighbours, over the board's contrast."""
_MAX_DEAD_SHARE = 0.02
"""Share of pixels that differ so much from the median of those around them, beyond which that is
the picture's texture: sensors are sold with far fewer that are dead."""
_NEIGHBOURS = np.array([0, 1, 2, 3, 5, 6, 7, 8])
"""Indices of the pixels around the middle one of 3 x 3."""


def estimate_pixel_noise(lattice: Lattice, image: GreyImage) -> float:
    """Estimate the standard deviation of the noise in the middles of a lattice's squares, grey
    levels; 0 if there are too few squares to tell."""
    uv = lattice.uv
    centres = (uv[:-1, :-1] + uv[1:, :-1] + uv[:-1, 1:] + uv[1:, 1:]).reshape(-1, 2) / 4
    inside = find_readable(centres, image)
    if np.count_nonzero(inside) < _MIN_SQUARES:
        return 0.0
    return float(estimate_noise_at(centres[inside], image))


def find_readable(places: Array, image: GreyImage) -> BoolArray:
    """Find the places (..., 2) px whose noise can be read in an image (h, w)."""
    limit = np.array(image.shape[::-1]) - 3
    with np.errstate(invalid="ignore"):
        return np.asarray(np.all((places >= 2) & (places <= limit), axis=-1))


def estimate_noise_at(places: Array, image: GreyImage) -> Array:
    """Estimate the standard deviation (...) of the noise at sets of places (..., k, 2) px, around
    which 5 x 5 pixels are flat, grey levels."""
    u, v = np.moveaxis(np.rint(places).astype(np.int64), -1, 0)[..., None, None]
    # 5 x 5 pixels hold 3 x 3 differences.
    near = np.arange(-2, 3)
    values = image[v + near[:, None], u + near].astype(np.float64)
    differences = np.abs(np.diff(np.diff(values, 2, axis=-2), 2, axis=-1))
    median = compute_median(differences.reshape(*places.shape[:-2], -1))
    return median / (_NORMAL_MEDIAN * _GAIN)


def repair_dead_pixels(image: GreyImage, lattice: Lattice) -> GreyImage | None:
    """Replace the dead pixels around the corners of a lattice by the median of their surroundings.

    Returns:
        The repaired image (h, w), None if there are no such pixels, or too many.
    """
    uv = lattice.uv[lattice.found]
    margin = np.nanmax(lattice.spacing())
    low = np.maximum(np.floor(uv.min(axis=0) - margin), 0).astype(np.int64)
    high = np.ceil(uv.max(axis=0) + margin).astype(np.int64) + 1
    window = np.s_[low[1] : high[1], low[0] : high[0]]
    levels = image[window]
    median = opencv.filter_median(levels)
    step = _MIN_RELATIVE_STEP * estimate_contrast(orient_corners(lattice), image)
    v, u = np.nonzero(np.abs(levels - median.astype(np.float32)) > step)
    if len(u) > _MAX_DEAD_SHARE * levels.size:
        return None
    tiles, _ = opencv.cut_tiles(levels, np.column_stack([u, v]), 1)
    pixel = levels[v, u].astype(np.float64)
    around = np.sort(tiles.reshape(-1, 9)[:, _NEIGHBOURS].astype(np.float64), axis=1)
    is_dead = (pixel > around[:, -2] + step) | (pixel < around[:, 1] - step)
    if not is_dead.any():
        return None
    repaired = image.copy()
    repaired[window][v[is_dead], u[is_dead]] = median[v[is_dead], u[is_dead]]
    return repaired

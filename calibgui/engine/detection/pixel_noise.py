"""The noise of an image from pixel to pixel, read where what is printed is flat.

What an edge model leaves unexplained is noise and whatever is no edge. Waves, moire and textures
vary smoothly over several pixels, noise from one to the next: the second difference along rows of
the second difference along columns (J. Immerkaer, Fast noise variance estimation, 1996) sees little
of the former, and nothing of even light.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median
from calibgui.engine.detection.lattice import Lattice

_GAIN = 6.0
"""Standard deviation of such a difference where that of the noise is 1: the squares of its weights,
(1, -2, 1) times (1, -2, 1), sum to 36."""
_NORMAL_MEDIAN = 0.6745
"""Median of the magnitude of a standard normal variable."""
_MIN_SQUARES = 6
"""Number of squares below which nothing is said of the noise."""


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

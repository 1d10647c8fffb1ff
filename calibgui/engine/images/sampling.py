"""Meshes of points over an image, and grey levels between its pixels."""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage


def make_mesh(u: Array, v: Array) -> Array:
    """Return the points (len(v), len(u), 2) of all columns `u` and rows `v`."""
    return np.stack(np.meshgrid(u, v), axis=-1)


def _is_photograph(image: GreyImage, _uv: Array) -> bool:
    """Return whether an image is as read from a file: a kernel is compiled for each type, and few
    points of others are asked for."""
    return image.dtype.kind == "u"


@kernels.with_kernel("sampling", "sample_image", _is_photograph)
def sample_image(image: GreyImage, uv: Array) -> Array:
    """Return bilinear values of `image` (h, w) at `uv` (..., 2) px, the border replicated.

    OpenCV's remap would round positions to 1/32 px in some versions, and 8-bit values to whole
    grey levels.
    """
    last = np.array(image.shape[::-1]) - 1
    at = np.clip(uv, 0, last)
    before = np.minimum(np.nan_to_num(at).astype(np.int64), last - 1)  # NaN stays in a and b
    a, b = np.moveaxis(at - before, -1, 0)
    u, v = np.moveaxis(before, -1, 0)
    above = (1 - a) * image[v, u] + a * image[v, u + 1]
    below = (1 - a) * image[v + 1, u] + a * image[v + 1, u + 1]
    return np.asarray((1 - b) * above + b * below)

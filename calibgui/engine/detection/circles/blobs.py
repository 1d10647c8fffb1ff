"""Dark parts of an image that may be images of discs.

An ellipse filled evenly has the area A = 4 pi sqrt(det C), where C is the covariance of its
points: whatever its size and axes. Any other shape has less of an area for its spread. Of the
parts that pass, those are taken whose sizes lie together, and no more than can be searched in
bounded time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage

_LEAST = 12
"""Area of the smallest parts, px."""
_ROUND = (0.85, 1.1)
"""Between which A / (4 pi sqrt(det C)) must lie; pixels count as squares."""
_SIZES = 8.0
"""Ratio of the largest area to the smallest in one grid: a tilt's and a lens's."""


def blobs(image: GreyImage, window: int, most: int) -> Array:
    """(n, 2) px, the centres of at most `most` parts of an 8-bit image (h, w).

    A part is darker than the mean of the `window` px around.
    """
    labels, end = opencv.dark_parts(image, window)
    v, u = np.nonzero(labels)
    part = labels[v, u]
    area = np.bincount(part, minlength=end).astype(np.float64)
    large = area >= _LEAST
    kept = large[part]
    part, x, y = part[kept], u[kept] * 1.0, v[kept] * 1.0

    def mean(values: npt.NDArray[np.floating[Any]]) -> Array:
        return np.asarray(np.bincount(part, values, minlength=end) / np.maximum(area, 1))

    cu, cv = mean(x), mean(y)
    # A pixel's own variance is 1/12 along each axis.
    C = (
        np.stack([mean(x * x) - cu * cu, mean(y * y) - cv * cv, mean(x * y) - cu * cv])
        + (np.array([1 / 12, 1 / 12, 0.0])[:, None])
    )
    fill = area / (4 * np.pi * np.sqrt(np.maximum(C[0] * C[1] - C[2] ** 2, 1e-9)))
    round_ = np.flatnonzero(large & (fill > _ROUND[0]) & (fill < _ROUND[1]))
    if not len(round_):
        return np.zeros((0, 2))
    sizes = np.sort(area[round_])
    count = np.searchsorted(sizes, _SIZES * sizes, side="right") - np.arange(len(sizes))
    smallest = sizes[np.argmax(count)]
    alike = round_[(area[round_] >= smallest) & (area[round_] <= _SIZES * smallest)]
    best = alike[np.argsort(np.abs(fill[alike] - 1), kind="stable")[:most]]
    return np.column_stack([cu[best], cv[best]])

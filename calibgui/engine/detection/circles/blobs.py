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
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS


def find_blobs(image: GreyImage, window: int, most: int) -> Array:
    """Find the centres (n, 2) px of at most `most` parts of an 8-bit image (h, w).

    A part is darker than the mean of the `window` px around.
    """
    limits = CIRCLE_THRESHOLDS
    labels, end = opencv.label_dark_parts(image, window)
    v, u = np.nonzero(labels)
    part = labels[v, u]
    area = np.bincount(part, minlength=end).astype(np.float64)
    large = area >= limits.min_blob_area
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
    is_round = large & (fill > limits.min_blob_fill) & (fill < limits.max_blob_fill)
    candidates = np.flatnonzero(is_round)
    if not len(candidates):
        return np.zeros((0, 2))
    sizes, ratio = np.sort(area[candidates]), limits.max_area_ratio
    count = np.searchsorted(sizes, ratio * sizes, side="right") - np.arange(len(sizes))
    smallest = sizes[np.argmax(count)]
    alike = candidates[(area[candidates] >= smallest) & (area[candidates] <= ratio * smallest)]
    best = alike[np.argsort(np.abs(fill[alike] - 1), kind="stable")[:most]]
    return np.column_stack([cu[best], cv[best]])

"""Dark parts of an image that may be images of discs.

An ellipse filled evenly has the area A = 4 pi sqrt(det C), where C is the covariance of its
points: whatever its size and axes. Any other shape has less of an area for its spread. Of the
parts that pass, those are taken whose sizes lie together, with those larger that may be marks among
them, and no more than can be searched in bounded time.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS

FOG_SHARE = 1 / 16
"""Light that scatters in a lens, over the brightest level: it is added to all levels before their
logarithm is taken, as below it lies noise."""
_STEPS_PER_E = 255 / np.log1p(1 / FOG_SHARE)
"""Number of steps of the compressed levels by which they differ where light differs by e."""


def compress_levels(image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return the logarithm of an 8-bit image, in 8 bits: there ink differs from paper by as much in
    a shadow as beside it, and bright discs from dark paper by as much as dark ones from bright."""
    fog = FOG_SHARE * max(int(image.max()), 1)
    table = np.minimum(_STEPS_PER_E * np.log1p(np.arange(256) / fog), 255)
    return np.asarray(np.rint(table).astype(np.uint8)[image])


def find_blobs(image: GreyImage, window: int, most: int, *, is_shaded: bool = False) -> Array:
    """Find the centres (n, 2) px of at most `most` parts of an 8-bit image (h, w).

    A part is darker than the mean of the `window` px around, or, if the image `is_shaded`, one of
    `compress_levels`, than the paper beside it, on either side of a shadow's edge.
    """
    limits = CIRCLE_THRESHOLDS
    depth = round(-_STEPS_PER_E * np.log(limits.max_ink_share)) if is_shaded else None
    labels, size = opencv.label_dark_parts(image, window, depth)
    area = size[:, 2].astype(np.float64)
    large = area >= limits.min_blob_area
    large &= area > limits.min_box_fill * size[:, 0] * size[:, 1]
    large &= area < labels.size / limits.min_grid_circles
    large[0] = False  # all that is in no part
    area = area[large]
    (cu, cv), C = _measure_parts(labels, large)
    fill = area / (4 * np.pi * np.sqrt(np.maximum(C[0] * C[1] - C[2] ** 2, 1e-9)))
    is_round = (fill > limits.min_blob_fill) & (fill < limits.max_blob_fill)
    candidates = np.flatnonzero(is_round)
    if not len(candidates):
        return np.zeros((0, 2))
    sizes, ratio = np.sort(area[candidates]), limits.max_area_ratio
    count = np.searchsorted(sizes, ratio * sizes, side="right") - np.arange(len(sizes))
    smallest = sizes[np.argmax(count)]
    alike = candidates[(area[candidates] >= smallest) & (area[candidates] <= ratio * smallest)]
    largest = max(ratio * smallest, limits.max_mark_area_ratio * float(np.median(area[alike])))
    alike = candidates[(area[candidates] >= smallest) & (area[candidates] <= largest)]
    best = alike[np.argsort(np.abs(fill[alike] - 1), kind="stable")[:most]]
    return np.column_stack([cu[best], cv[best]])


def _measure_parts(labels: npt.NDArray[np.int32], chosen: BoolArray) -> tuple[Array, Array]:
    """Compute the centres (2, m) and the covariances (3, m) = (uu, vv, uv) of parts, px and px^2.

    The sums are taken over runs, neighbouring pixels in a row that belong to one part: from u on,
    n pixels have the sums n u + n (n - 1) / 2 and n u^2 + u n (n - 1) + (n - 1) n (2 n - 1) / 6.
    Sums of whole numbers, they are exact.

    Args:
        labels: (h, w) the number of each pixel's part.
        chosen: (n,) mask of the m parts that are measured.
    """
    begins = np.empty(labels.shape, dtype=bool)
    begins[:, 0] = True
    np.not_equal(labels[:, 1:], labels[:, :-1], out=begins[:, 1:])
    start = np.flatnonzero(begins)
    part, length = labels.ravel()[start], np.diff(start, append=labels.size)
    kept = chosen[part]
    part, n = (np.cumsum(chosen) - 1)[part[kept]], length[kept].astype(np.float64)
    v, u = np.divmod(start[kept], labels.shape[1])
    along = n * u + n * (n - 1) / 2
    squares = n * u * u + u * n * (n - 1) + (n - 1) * n * (2 * n - 1) / 6
    m = int(np.count_nonzero(chosen))
    area = np.bincount(part, n, m)
    cu, cv, uu, vv, uv = (
        np.bincount(part, sums, m) / area for sums in (along, n * v, squares, n * v * v, along * v)
    )
    # A pixel's own variance is 1/12 along each axis.
    C = np.stack([uu - cu * cu + 1 / 12, vv - cv * cv + 1 / 12, uv - cu * cv])
    return np.stack([cu, cv]), C

"""Dark parts of an image that may be images of discs.

An ellipse filled evenly has the area A = 4 pi sqrt(det C), where C is the covariance of its
points: whatever its size and axes. Any other shape has less of an area for its spread. Of the
parts that pass, those are taken whose sizes lie together, with those larger that may be marks among
them, and no more than can be searched in bounded time.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.features.pixel_noise import estimate_noise_at
from calibgui.engine.images.sampling import make_mesh

FOG_SHARE = 1 / 16
"""Light that scatters in a lens, over the brightest level: it is added to all levels before their
logarithm is taken, as below it lies noise."""
_STEPS_PER_E = 255 / np.log1p(1 / FOG_SHARE)
"""Number of steps of the compressed levels by which they differ where light differs by e."""
MIN_DIFFERENCE = 8
"""Least difference of a part from the mean around, grey levels ..."""
_FAINT_SIGMAS, _MIN_FAINT_DIFFERENCE = 3.0, 2
"""... and for faint parts, standard deviations of the noise, but no fewer grey levels than that."""
_ADDED_LINES = 6
"""Number of lines of discs that may be added at the border of those of like sizes."""
_BESIDE = 3
"""Number of the chosen parts nearest to another one, of which all but one must be like it ..."""
_MAX_STEPS_AWAY = 2.5
"""... and no farther away than that, distances of these from the next ones."""
_NOISE_PLACES = 32
"""Number of places along each side of an image at which its noise is read."""


def compress_levels(image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return the logarithm of an 8-bit image, in 8 bits: there ink differs from paper by as much in
    a shadow as beside it, and bright discs from dark paper by as much as dark ones from bright."""
    fog = FOG_SHARE * max(int(image.max()), 1)
    table = np.minimum(_STEPS_PER_E * np.log1p(np.arange(256) / fog), 255)
    return np.asarray(np.rint(table).astype(np.uint8)[image])


def find_faint_difference(image: GreyImage) -> int:
    """Find the least difference, grey levels, that is no noise in an 8-bit image (h, w): in most
    pictures less than what is asked of parts otherwise, which leaves out what is faint."""
    v, u = (np.linspace(2, size - 3, _NOISE_PLACES) for size in image.shape)
    noise = float(estimate_noise_at(make_mesh(u, v).reshape(-1, 2), image))
    return max(int(np.ceil(_FAINT_SIGMAS * noise)), _MIN_FAINT_DIFFERENCE)


def find_blobs(
    image: GreyImage,
    window: int,
    most: int,
    *,
    are_bright: bool = False,
    is_shaded: bool = False,
    difference: int = MIN_DIFFERENCE,
    are_of_any_size: bool = False,
) -> Array:
    """Find the centres (n, 2) px of at most `most` parts of an 8-bit image (h, w).

    A part is darker than the mean of the `window` px around by a `difference`, or brighter if they
    `are_bright`. If the image `is_shaded`, the logarithm of its levels is compared with that of the
    paper beside the part, on either side of a shadow's edge. Parts of like sizes are taken, and if
    they `are_of_any_size` also those beside them that are little larger or smaller.
    """
    limits = CIRCLE_THRESHOLDS
    side = 2 * (window // 2) + 1
    if is_shaded:
        image = compress_levels(image)
        around = opencv.fill_narrow_parts(image, side, are_bright=are_bright)
        least = round(-_STEPS_PER_E * np.log(limits.max_ink_share)) + 1
    else:
        around, least = opencv.average_around(image, side), difference
    upper, lower = (image, around) if are_bright else (around, image)
    u, v, area, fill = _find_round_parts(
        upper,
        lower,
        least,
        (limits.min_blob_area, image.size / limits.min_grid_circles),
        limits.min_box_fill,
        (limits.min_blob_fill, limits.max_blob_fill),
    ).T
    if not len(area):
        return np.zeros((0, 2))
    sizes, ratio = np.sort(area), limits.max_area_ratio
    count = np.searchsorted(sizes, ratio * sizes, side="right") - np.arange(len(sizes))
    smallest = sizes[np.argmax(count)]
    alike = area[(area >= smallest) & (area <= ratio * smallest)]
    largest = max(ratio * smallest, limits.max_mark_area_ratio * float(np.median(alike)))
    at, is_chosen = np.column_stack([u, v]), (area >= smallest) & (area <= largest)
    if are_of_any_size:
        is_chosen = _add_neighbours(at, area, is_chosen, most)
    chosen = np.flatnonzero(is_chosen)
    best = chosen[np.argsort(np.abs(fill[chosen] - 1), kind="stable")[:most]]
    return at[best]


def _add_neighbours(at: Array, area: Array, is_chosen: BoolArray, most: int) -> BoolArray:
    """Add to the parts (n,) that are chosen by their size those beside them that are little larger
    or smaller than these, one after the other: towards its border a fisheye shows discs many times
    smaller. Nothing is added where `most` are chosen already.

    Args:
        at: (n, 2) the parts' centres, px.
        area: (n,) their areas, px.
    """
    is_chosen = is_chosen.copy()
    for _ in range(_ADDED_LINES):
        chosen, others = np.flatnonzero(is_chosen), np.flatnonzero(~is_chosen)
        if not (_BESIDE < len(chosen) < most and len(others)):
            break
        tree = scipy.spatial.cKDTree(at[chosen])
        distance, index = map(np.asarray, tree.query(at[others], k=_BESIDE))
        spacing = np.asarray(tree.query(at[chosen], k=2)[0])[:, 1]
        change = np.abs(np.log(area[chosen][index] / area[others][:, None]))
        is_near = distance < _MAX_STEPS_AWAY * spacing[index]
        is_like = is_near & (change < np.log(CIRCLE_THRESHOLDS.max_neighbour_area_ratio))
        added = others[is_like.sum(axis=1) >= _BESIDE - 1]
        if not len(added):
            break
        is_chosen[added] = True
    return is_chosen


@kernels.with_kernel("round_parts", "find_round_parts")
def _find_round_parts(
    upper: GreyImage,
    lower: GreyImage,
    least: int,
    area: tuple[float, float],
    least_share: float,
    fill: tuple[float, float],
) -> Array:
    """Find evenly filled ellipses among the parts, connected along rows and columns, in which one
    8-bit image (h, w) exceeds another by `least` levels or more.

    The sums are taken over runs, neighbouring pixels in a row that belong to one part: from u on,
    n pixels have the sums n u + n (n - 1) / 2 and n u^2 + u n (n - 1) + (n - 1) n (2 n - 1) / 6.
    Sums of whole numbers, they are exact.

    Args:
        upper: the image that exceeds the other.
        lower: the other image.
        least: levels.
        area: least area of a part, px, and that from which on it is too large.
        least_share: share of its upright bounding box that it must exceed.
        fill: least and greatest area over that of the ellipse of its covariance, exclusively.

    Returns:
        (m, 4) centre u and v, px, area and fill of each, in the order of their first pixels row by
        row.
    """
    inside = upper.astype(np.int16) - lower >= least
    labels, m = opencv.label_parts(inside)
    begins = np.diff(labels, axis=1, prepend=-1) != 0
    start = np.flatnonzero(begins & inside)
    part = labels.ravel()[start] - 1
    ends = np.append(np.flatnonzero(begins), labels.size)
    n = (ends[np.searchsorted(ends, start, side="right")] - start).astype(np.float64)
    v, u = np.divmod(start, labels.shape[1])
    along = n * u + n * (n - 1) / 2
    squares = n * u * u + u * n * (n - 1) + (n - 1) * n * (2 * n - 1) / 6
    total = np.bincount(part, n, m)
    cu, cv, uu, vv, uv = (
        np.bincount(part, sums, m) / total for sums in (along, n * v, squares, n * v * v, along * v)
    )
    # A pixel's own variance is 1/12 along each axis.
    det = (uu - cu * cu + 1 / 12) * (vv - cv * cv + 1 / 12) - (uv - cu * cv) ** 2
    filled = total / (4 * np.pi * np.sqrt(np.maximum(det, 1e-9)))
    first, last = np.full((2, m), max(labels.shape)), np.zeros((2, m))
    for axis, begin, end in ((0, u, u + n), (1, v, v + 1)):
        np.minimum.at(first[axis], part, begin)
        np.maximum.at(last[axis], part, end)
    chosen = (total >= area[0]) & (total < area[1])
    chosen &= total > least_share * (last - first).prod(axis=0)
    chosen &= (filled > fill[0]) & (filled < fill[1])
    return np.column_stack([cu, cv, total, filled])[chosen]

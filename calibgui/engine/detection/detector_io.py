"""The entry and exit of every detector: its image and the noise of that, the rejected corners.

Detectors take grey levels of any of three types and list the corners that they saw but do not
trust; they share the functions here. Those that read markers look at 8 bits, and at the negative
where the print is bright on dark.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.corners import RejectedCorner
from calibgui.engine.errors import NoBoardError
from calibgui.engine.images.reading import stretch_levels

_MIN_READABLE_RANGE = 100
"""Range of 8-bit grey levels from which on markers are read in them as they are: OpenCV looks for
squares darker than their surroundings by 7 levels or more."""
_MIN_IMAGE_SIDE = 16
"""Short side of the smallest image that can show a board, px; a smaller one is refused."""


def check_grey_levels(image: npt.ArrayLike) -> GreyImage:
    """Check an image (h, w) of grey levels and return it contiguous.

    Returns:
        The image as uint8 or uint16 if it is of that type, otherwise as float32.

    Raises:
        NoBoardError: the image is too small to show a board.
        ValueError: the array has another number of dimensions, or levels that are not finite.
    """
    grey = np.asarray(image)
    if grey.ndim != 2:
        raise ValueError(f"an image of grey levels (h, w) is needed, not of shape {grey.shape}")
    if min(grey.shape) < _MIN_IMAGE_SIDE:
        raise NoBoardError(
            f"An image of {grey.shape[1]} x {grey.shape[0]} pixels is too small for a board.",
            "Take the original picture, not a thumbnail of it.",
        )
    if grey.dtype in (np.uint8, np.uint16):
        return np.ascontiguousarray(grey)
    grey = np.ascontiguousarray(grey, dtype=np.float32)
    if not np.isfinite(grey).all():
        raise ValueError("the image has grey levels that are not finite")
    return grey


def estimate_least_noise(image: GreyImage) -> float:
    """Estimate the variance that the grey levels of an image have at least, levels^2.

    A drawn or saturated image shows no noise, but its levels are rounded: whole levels are off by
    up to half of one, evenly, which is a variance of 1/12 (Widrow 1956); levels of type float32 by
    their last digit. Without it corners in such images would seem to be free of error.
    """
    if image.dtype in (np.uint8, np.uint16):
        return 1 / 12
    return float(np.spacing(max(np.abs(image).max(), np.finfo(np.float32).tiny)) ** 2 / 12)


def convert_for_reading(image: GreyImage) -> npt.NDArray[np.uint8]:
    """Return an image (h, w) in 8 bits with contrast enough for markers to be read."""
    if image.dtype == np.uint8 and np.ptp(image) < _MIN_READABLE_RANGE:
        return stretch_levels(image.astype(np.uint16))  # these are stretched by a table
    return stretch_levels(image)


def invert_levels(image: GreyImage) -> GreyImage:
    """Return an image (h, w) of the same type with dark for bright levels."""
    return np.asarray(image.max() - image + image.min(), dtype=image.dtype)


def list_rejected_corners(uv: Array, reason: str) -> list[RejectedCorner]:
    """List the corners `uv` (n, 2) px as rejected, all for one reason."""
    return [RejectedCorner(float(u), float(v), reason) for u, v in uv]

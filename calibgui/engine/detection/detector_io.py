"""The entry and exit of every detector: its image, and the rejected corners.

Detectors take grey levels of 8 or 16 bits and list the corners that they saw but do not
trust; they share the functions here. Those that read markers look at 8 bits, and at the negative
where the print is bright on dark.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import RejectedCorner
from calibgui.engine.images.reading import stretch_levels

_MIN_READABLE_RANGE = 100
"""Range of 8-bit grey levels from which on markers are read in them as they are: OpenCV looks for
squares darker than their surroundings by 7 levels or more."""
_COLOUR_WEIGHTS = np.array([0.2065, 0.587, 0.2065])
"""Weights of the colours: those of ITU-R BT.601, of red and blue their mean, as OpenCV has them the
other way round than others."""
_MIN_IMAGE_SIDE = 16
"""Short side of the smallest image that can show a board, px; a smaller one is refused."""


def check_grey_levels(image: npt.ArrayLike) -> GreyImage:
    """Check an image (h, w) of grey levels, or (h, w, 3) of colours, and return it in grey.

    Returns:
        The image as uint8 or uint16 if it is of that type. Others become uint16, from their
        darkest level to their brightest: their steps are finer than the noise of any camera, and
        each type that detectors take would be compiled by itself.

    Raises:
        NoBoardError: the image is too small to show a board.
        ValueError: the array has another number of dimensions, or levels that are not finite.
    """
    grey = np.asarray(image)
    if grey.ndim == 3 and grey.shape[2] == 3:
        grey = _average_colours(grey)
    if grey.ndim != 2:
        raise ValueError(
            "an image of grey levels (h, w), or of colours (h, w, 3), is needed, not of shape "
            f"{grey.shape}; engine.read_image reads a file"
        )
    if min(grey.shape) < _MIN_IMAGE_SIDE:
        raise NoBoardError(
            f"An image of {grey.shape[1]} x {grey.shape[0]} pixels is too small for a board.",
            "Take the original picture, not a thumbnail of it.",
        )
    if grey.dtype in (np.uint8, np.uint16):
        return np.ascontiguousarray(grey)
    levels = grey.astype(np.float64)
    if not np.isfinite(levels).all():
        raise ValueError("the image has grey levels that are not finite")
    levels -= levels.min()
    levels *= np.iinfo(np.uint16).max / max(levels.max(), np.finfo(np.float64).tiny)
    return np.rint(levels).astype(np.uint16)


def _average_colours(image: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Average an image (h, w, 3) of the type that it has, whether red is first or last."""
    if image.dtype == np.uint8:  # live images: the same levels ten times as fast
        return opencv.average_colours(image, _COLOUR_WEIGHTS)
    grey = image @ _COLOUR_WEIGHTS
    whole = np.issubdtype(image.dtype, np.integer)
    return np.rint(grey).astype(image.dtype) if whole else np.asarray(grey)


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

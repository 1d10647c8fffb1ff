"""The entry and exit of every detector: the check of its image, the list of rejected corners.

The detectors of checkerboards, ChArUco boards and grids of circles take grey levels of any of
three types and list the corners that they saw but do not trust; they share the two functions here.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.corners import RejectedCorner
from calibgui.engine.errors import NoBoardError

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


def list_rejected_corners(uv: Array, reason: str) -> list[RejectedCorner]:
    """List the corners `uv` (n, 2) px as rejected, all for one reason."""
    return [RejectedCorner(float(u), float(v), reason) for u, v in uv]

"""Pixels of a board's image that are dark or bright whatever they see.

A sensor's dead and hot pixels, in a dim picture far brighter than its paper, mislead what is read
of the corner beside them. No print shows such: even at the corner of a square of a few pixels
there are two more beside it that see the same. One that stands out from all of its eight
neighbours, or from all but one that is dead as well, by half of the board's contrast is none of the
board's, nor noise in which the board could be seen.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.detection.checkerboard.corner_template import estimate_contrast, orient_corners
from calibgui.engine.detection.lattice import Lattice

_MIN_RELATIVE_STEP = 0.5
"""Least difference of a dead pixel from its neighbours, over the board's contrast."""
_MAX_SHARE = 0.02
"""Share of pixels that differ so much from the median of those around them, beyond which that is
the picture's texture: sensors are sold with far fewer that are dead."""
_NEIGHBOURS = np.array([0, 1, 2, 3, 5, 6, 7, 8])
"""Indices of the pixels around the middle one of 3 x 3."""


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
    if len(u) > _MAX_SHARE * levels.size:
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

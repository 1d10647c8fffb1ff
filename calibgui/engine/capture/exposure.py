"""The exposure of a board: whether its white and black are grey levels that a camera can hold.

Where white paper has the greatest level, light that it sent more of is cut off, and with it the
bright half of each edge's blur: edges seem to lie farther in the dark than they do. Black that is
cut off moves them the other way. The middles of the squares, half of them white and half black on a
plain board, tell: of each kind half may be cut off, so that a lamp's reflection or the black of a
marker decides nothing.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.features.corners import Corners

TOO_BRIGHT = "Too bright: white is cut off. Less light, or a shorter exposure."
TOO_DARK = "Too dark: black is cut off. More light, or a longer exposure."


def judge_exposure(grey: GreyImage, corners: Corners) -> str:
    """Say what is wrong with the exposure of a board; "" if nothing is.

    Args:
        grey: (h, w) grey levels; those of floating images have no ends.
        corners: of the board in it.
    """
    middles = _find_middles(corners)
    if not np.issubdtype(grey.dtype, np.integer) or not len(middles):
        return ""
    u, v = np.round(middles).astype(np.int64).T
    levels = grey[np.clip(v, 0, grey.shape[0] - 1), np.clip(u, 0, grey.shape[1] - 1)]
    half = (int(levels.max()) + int(levels.min())) / 2
    if np.median(levels[levels >= half]) == np.iinfo(grey.dtype).max:
        return TOO_BRIGHT
    dark = levels[levels < half]
    return TOO_DARK if len(dark) and np.median(dark) == 0 else ""


def _find_middles(corners: Corners) -> Array:
    """Find the middles (n, 2), px, of all squares whose four corners were found."""
    places = np.full((*corners.shape, 2), np.nan)
    places[corners.grid[:, 0], corners.grid[:, 1]] = corners.uv
    middles = (places[:-1, :-1] + places[1:, :-1] + places[:-1, 1:] + places[1:, 1:]) / 4
    flat = middles.reshape(-1, 2)
    return flat[np.isfinite(flat).all(axis=1)]

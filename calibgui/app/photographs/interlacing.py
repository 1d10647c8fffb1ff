"""Interlaced frames: two fields, the even and the odd rows, taken one after the other.

Between the fields the camera or the board may have moved: edges then are combed, and corners lie
between two places. Rows of one field are alike where neighbouring rows are not, while in other
images neighbouring rows are the more alike ones. So the second differences of the rows, whose
energy noise raises alike whatever rows are compared, tell a comb: with the rows I(v),

    one apart   E1 = sum (I(v - 1) - 2 I(v) + I(v + 1))^2,
    two apart   E2 = sum (I(v - 2) - 2 I(v) + I(v + 2))^2.

The fields of one frame have two poses: whoever needs corners of it uses one field
(``engine/images/fields.py``), records progressively, or holds both still.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.images import Pixels

_TILE = 32
"""Side of the parts of an image that are judged each, px: a choice."""
_COMB_RATIO = 2.0
"""E1 over E2 from which on a tile is combed: it is 1 in noise, less at edges that did not move,
and far more at those that did."""
_MIN_COMBED = 0.3
"""Share of combed tiles, among those of the strongest edges, from which on a frame is interlaced.
Of rendered boards that moved by 2 px it is 0.5 and more, by 1 px 0: less is not told. Of 316 other
images, 226 of them photographs, it is 0.11 at most."""
_MAX_ROWS = 1088
"""Number of rows of the largest interlaced video, 1080i as it is coded."""
_STRONGEST = 0.1
"""Share of the tiles that are those of the strongest edges."""
INTERLACED = (
    "This frame is interlaced: its even and its odd rows were taken one after the other, and edges "
    "that moved in between are combed. Search one of the two fields alone, record progressive "
    "frames, or hold camera and board still."
)
"""Sentence on an interlaced frame."""


def measure_combed_share(pixels: Pixels) -> float:
    """Measure which share of the tiles of strong edges in an image (h, w) is combed, 0 to 1."""
    image = pixels.astype(np.float32)
    near, far = (_measure_energies(image, apart) for apart in (1, 2))
    strength = np.maximum(near, far)
    if not strength.any():
        return 0.0
    strong = strength >= np.quantile(strength, 1 - _STRONGEST)
    return float(np.mean(near[strong] > _COMB_RATIO * far[strong]))


def is_interlaced(pixels: Pixels) -> bool:
    """Return whether an image (h, w) is a frame of two fields between which something moved."""
    return len(pixels) <= _MAX_ROWS and measure_combed_share(pixels) > _MIN_COMBED


def _measure_energies(image: GreyImage, apart: int) -> Array:
    """Measure the energy of the second differences of rows `apart` in tiles of an image (h, w)."""
    middle = image[2:-2]
    above, below = (np.roll(image, sign * apart, axis=0)[2:-2] for sign in (1, -1))
    energy = (above - 2 * middle + below) ** 2
    h, w = (side // _TILE for side in energy.shape)
    tiles = energy[: h * _TILE, : w * _TILE].reshape(h, _TILE, w, _TILE)
    return np.asarray(tiles.sum(axis=(1, 3)))

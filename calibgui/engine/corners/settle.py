"""Corners of a lattice moved to their saddle points, where they have one.

Squares that overlap or part by more than the blur have none: what is printed between them is flat,
and a saddle found there is noise. It shows in the grey level at the corner, which is not midway
between those of the squares then.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.corners import saddle
from calibgui.engine.corners.appearance import Placed, around, placed
from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.opencv import Image
from calibgui.engine.types import BoolArray

_SQUARES = 0.2 * np.array([(1, 1), (-1, -1), (1, -1), (-1, 1)])
"""Where the levels of the squares are taken, steps both ways ..."""
_CORNER = 0.05 * np.array([(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)])
"""... and where that of the corner is."""
_OFF_MIDDLE = 0.42
"""Greatest distance of a crossing's level from the middle, over the contrast."""


def at_saddles(
    image: Image, lattice: Lattice, farthest: float = np.inf
) -> tuple[Lattice, BoolArray]:
    """The lattice with its corners moved to their saddle points, at most a quarter of a step and
    `farthest` px, and which (rows, cols) have one there."""
    corners = placed(lattice)
    spacing = np.fmin(np.linalg.norm(corners.right, axis=1), np.linalg.norm(corners.down, axis=1))
    limit = np.minimum(spacing / 4, farthest)
    moved, good = saddle.refine(image, corners.uv, saddle.window(spacing), limit)
    good &= not _parted(image, corners)
    at_saddle = lattice.found
    at_saddle[at_saddle] = good
    uv = lattice.uv.copy()
    uv[at_saddle] = moved[good]
    return Lattice(uv, lattice.dark), at_saddle


def _parted(image: Image, corners: Placed) -> bool:
    """Whether the squares at most of the corners overlap, or part, by more than the blur."""
    uv, right, down, _ = corners
    squares = around(image, uv, right, down, _SQUARES)
    contrast = abs(squares @ np.array([0.5, 0.5, -0.5, -0.5]))
    off = around(image, uv, right, down, _CORNER).mean(axis=1) - squares.mean(axis=1)
    return bool(abs(np.median(off)) > _OFF_MIDDLE * np.median(contrast))

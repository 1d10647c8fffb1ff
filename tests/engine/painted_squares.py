"""Boards that are painted square by square, so that any square may have any colour.

A square is 20 px wide; the corner in row r and column c, between the squares r and r + 1 by c and
c + 1, is at `MARGIN` + 20 (c + 1), `MARGIN` + 20 (r + 1), less half a pixel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from calibgui.engine.features.lattice import Lattice

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
SQUARE, MARGIN = 20, 30
DARK, BRIGHT = 40.0, 210.0


def alternate(rows: int, cols: int) -> Array:
    """Return the levels (rows + 1, cols + 1) of the squares of a board, the first one dark."""
    row, col = np.indices((rows + 1, cols + 1))
    return np.where((row + col) % 2 == 0, DARK, BRIGHT)


def invert(levels: Array) -> Array:
    return DARK + BRIGHT - levels


def paint(levels: Array, margin: int = MARGIN) -> Image:
    """Paint squares, in front of a bright margin."""
    image = np.kron(levels, np.ones((SQUARE, SQUARE)))
    image = np.pad(image, margin, constant_values=BRIGHT)
    return np.rint(gaussian_filter(image, 0.7)).astype(np.uint8)


def place(rows: int, cols: int, margin: int = MARGIN) -> Lattice:
    """Return the corners between painted squares."""
    row, col = np.indices((rows, cols))
    uv = margin - 0.5 + SQUARE * np.stack([col + 1.0, row + 1.0], axis=-1)
    return Lattice(uv, dark=True)


def move(lattice: Lattice, cell: tuple[int, int], offset: tuple[float, float]) -> Lattice:
    """Return the lattice with one corner moved by so many squares."""
    uv = lattice.uv.copy()
    uv[cell] += SQUARE * np.array(offset)
    return Lattice(uv, lattice.dark)


def drop(lattice: Lattice, *cells: tuple[int, int]) -> Lattice:
    """Return the lattice without some of its corners."""
    found = lattice.found
    for cell in cells:
        found[cell] = False
    return lattice.select(found)

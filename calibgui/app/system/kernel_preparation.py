"""Kernels made ready before they are needed, so that nothing is compiled twice.

A kernel is compiled at its first call for each type of image. If that is in several processes at
once, each of them compiles it. Set-up scripts compile the corner finder's for images of 8 and of 16
bits by ``python -m calibgui.app.system.kernel_preparation``.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine import detection

_SQUARE_PX = 20
"""Side of the squares of the drawn board, px."""
_PARTS = 4
"""Number of parts of a pixel, along either axis, that the board is drawn in."""
_BARREL = 0.4
"""Distortion of the drawing at the diagonal: as much as it takes for a lens to be fitted."""
_SHADE = 0.3
"""Part of the light that is lost at the darkest places: as much as it takes for the light of single
corners to be fitted."""


def prepare_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of a small board drawn through a lens in uneven light, which loads or
    compiles the finder's kernels.

    Args:
        depth: type of the grey levels, np.uint8 or np.uint16.
    """
    rows, cols, parts = 9, 10, _SQUARE_PX * _PARTS  # a border of one square included
    size = np.array([rows, cols])
    place = np.moveaxis(np.indices((rows * parts, cols * parts)), 0, -1) / parts - size / 2
    place *= 1 + _BARREL * np.sum(place**2, axis=-1, keepdims=True) / np.sum(size**2)
    row, col = np.moveaxis(np.floor(place + size / 2).astype(np.int64), -1, 0)
    is_on_board = (row > 0) & (col > 0) & (row < rows - 1) & (col < cols - 1)
    shade = 1 - _SHADE * np.sin(place[..., 0]) ** 2 * np.sin(place[..., 1]) ** 2
    fine = np.where(is_on_board & ((row + col) % 2 == 0), 40, 200) * shade
    levels = fine.reshape(rows * _SQUARE_PX, _PARTS, -1, _PARTS).mean(axis=(1, 3))
    detection.find_corners((levels * (np.iinfo(depth).max // 255)).astype(depth))


if __name__ == "__main__":
    prepare_finder()
    prepare_finder(np.uint16)

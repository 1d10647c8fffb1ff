"""Kernels made ready before they are needed, so that nothing is compiled twice.

A kernel is compiled at its first call for each type of image. If that is in several processes at
once, each of them compiles it. ``python -m calibgui.app.kernel_preparation`` compiles the corner
finder's for images of 8 and of 16 bits; set-up scripts call it.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.detection import find_corners

_SQUARE_PX = 20
"""Side of the squares of the drawn board, px."""


def prepare_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of a small drawn board, which loads or compiles the finder's kernels.

    Args:
        depth: type of the grey levels, np.uint8 or np.uint16.
    """
    squares = np.indices((7, 8)).sum(axis=0) % 2
    board = np.kron(squares, np.ones((_SQUARE_PX, _SQUARE_PX)))
    levels = np.pad(40 + 160 * board, _SQUARE_PX, constant_values=200)
    find_corners((levels * (np.iinfo(depth).max // 255)).astype(depth))


if __name__ == "__main__":
    prepare_finder()
    prepare_finder(np.uint16)

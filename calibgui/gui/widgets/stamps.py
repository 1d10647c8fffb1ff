"""Small pictures copied to thousands of places at once: Qt is asked a single time for all."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import shiboken6
from PySide6.QtGui import QPainter, QPixmap

from calibgui.engine.arrays import Array


def draw_stamps(painter: QPainter, at: Array, sheet: QPixmap, source: Array, side: int) -> None:
    """Copy squares of a sheet to places in the painter's coordinates.

    Args:
        painter: that draws.
        at: (n, 2) middles of the copies; finite.
        sheet: picture that holds the squares; its device pixel ratio tells their size when drawn.
        source: (n, 2), or (2,) for all, left upper corners of the squares, pixels of the sheet.
            Squares must lie on it: Qt does not check.
        side: of the squares, pixels of the sheet.
    """
    # The fields of QPainter::PixmapFragment: place, source, its size, scale, rotation, opacity.
    stamps = np.empty((len(at), 10))
    stamps[:, :2], stamps[:, 2:4] = at, source
    stamps[:, 4:] = [side, side, *[1 / sheet.devicePixelRatio()] * 2, 0, 1]
    if len(stamps):
        first = cast(Any, shiboken6.wrapInstance(stamps.ctypes.data, QPainter.PixmapFragment))
        painter.drawPixmapFragments(first, len(stamps), sheet)

"""A frame of a camera as an image of Qt's, about as large as it is shown."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QSizeF
from PySide6.QtGui import QImage

from calibgui.engine import opencv
from calibgui.engine.arrays import GreyImage


def make_frame_image(image: GreyImage, room: QSizeF) -> QImage:
    """Shrink an image by a whole factor, to no less than what fills a room, px of the screen.

    Args:
        image: grey (h, w) or RGB (h, w, 3), of 8 bits or 16.
        room: what it is shown in.
    """
    height, width = image.shape[:2]
    step = max(1, int(max(width / room.width(), height / room.height())))
    small = opencv.shrink_image(image, step)
    pixels = np.ascontiguousarray(small >> 8 if small.dtype != np.uint8 else small, dtype=np.uint8)
    kind = QImage.Format.Format_Grayscale8 if pixels.ndim == 2 else QImage.Format.Format_RGB888
    rows, cols = pixels.shape[:2]
    return QImage(pixels.data, cols, rows, pixels.strides[0], kind).copy()

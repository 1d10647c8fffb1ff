"""A board's axes drawn into a photograph of it, as the camera images them.

X is red and runs along the rows, Y green along the columns, Z blue and away from the camera where
the board is seen from its front: the frame of the board's pose. A lens bends the axes, so each is
drawn through many points.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.reading import Pixels
from calibgui.engine.images.resampling import check_image

_COLOURS = np.array([[235, 60, 60], [40, 190, 70], [60, 110, 245]]) / 255
"""RGB of X, Y and Z, over the brightest level."""
_ALONG = np.linspace(0.0, 1.0, 33)
"""Places along an axis through which it is drawn, over its length."""


def draw_axes(image: Pixels, camera: Camera, pose: Pose, length: float) -> Pixels:
    """Return the photograph in colour with the axes of the board in it.

    Args:
        image: (h, w) or (h, w, 3), 8 or 16 bits, of the camera's size.
        camera: the camera that took it.
        pose: the pose of the board.
        length: length of the axes, mm.

    Raises:
        CalibrationError: if the image has another size than the camera.
    """
    check_image(image, camera)
    drawn = cast(
        Pixels, np.repeat(image[..., None], 3, axis=2) if image.ndim == 2 else image.copy()
    )
    brightest = np.iinfo(drawn.dtype).max
    width = max(2, max(camera.size) // 250)
    R = rotation_from_vector(pose.rvec)
    for axis in (2, 1, 0):  # Z lies behind the board
        points = pose.tvec + length * _ALONG[:, None] * R[:, axis]
        opencv.draw_line(drawn, _find_imaged(points, camera), brightest * _COLOURS[axis], width)
    return drawn


def _find_imaged(points: Array, camera: Camera) -> Array:
    """Return (n, 2) the pixels of points (n, 3) along an axis, up to the first without image."""
    uv = pixels_from_rays(points, camera)
    missing = ~np.isfinite(uv).all(axis=1)
    return uv[: int(np.argmax(missing))] if missing.any() else uv

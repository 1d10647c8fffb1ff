"""The rectification of a camera of a stereo pair, as camera files of ROS and OpenCV hold it.

R turns the camera's rays into those of the rectified camera, X_rect = R X_cam, and P (3, 4) images
them: (u, v, 1) ~ P (X_rect, 1). P's last column is the baseline times the focal length, in the
unit that the file's author has chosen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.camera import Camera, SensorMode


@dataclass(frozen=True, eq=False, slots=True)
class StereoRectification:
    """The matrices R and P of a camera."""

    R: Array
    """(3, 3) rectified_from_camera."""
    P: Array
    """(3, 4) projection of the rectified image."""

    def __post_init__(self) -> None:
        freeze(self, "R", "P")

    def is_of_one_camera(self, camera: Camera) -> bool:
        """Return whether the rectified image is the camera's own without distortion: R is the
        identity and P is [K | 0]."""
        own = np.hstack([camera.matrix, np.zeros((3, 1))])
        return np.array_equal(self.R, np.eye(3)) and bool(
            np.allclose(self.P, own, rtol=1e-6, atol=1e-6)
        )

    def adapt(self, mode: SensorMode) -> StereoRectification | None:
        """Return the rectification of another stream of the camera, whose rectified images are made
        from the others in the same way; None if it is flipped, as the pair would be another."""
        if (mode.factor < 0).any():
            return None
        A = np.diag([*mode.factor, 1.0])
        A[:2, 2] = mode.offset
        return StereoRectification(self.R, A @ self.P)

"""The places of cameras in the axes and units of programs that reconstruct scenes.

The world is the board. To nerfstudio its axes, and the camera's, are those of OpenGL and Blender: X
right, Y up, Z out of the board and behind the camera. Those of the array frame are turned by half
about X: Y down, Z ahead. Lengths are metres.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry import Pose, rotation_from_vector

M_PER_MM = 1e-3
"""Metres in a millimetre."""
WORLD = Pose(np.zeros(3), np.zeros(3))
"""Pose of a camera that is the world itself."""
Y_UP_FROM_Y_DOWN = np.diag([1.0, -1.0, -1.0, 1.0])
"""The turn by half about X between both, either way, in homogeneous coordinates."""


def world_from_camera_upright(pose: Pose) -> Array:
    """Return the motion (4, 4) from the camera, m, to the board, m, in the axes of OpenGL."""
    R, t = rotation_from_vector(pose.rvec), pose.tvec * M_PER_MM
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = R.T, -R.T @ t
    return Y_UP_FROM_Y_DOWN @ motion @ Y_UP_FROM_Y_DOWN


def list_motion(pose: Pose) -> list[float]:
    """Return the unit quaternion, its real part first, and the translation, m, of a pose."""
    angle = float(np.linalg.norm(pose.rvec))
    imaginary: Array = pose.rvec / 2 * np.sinc(angle / (2 * np.pi))
    return [float(np.cos(angle / 2)), *imaginary.tolist(), *(pose.tvec * M_PER_MM).tolist()]

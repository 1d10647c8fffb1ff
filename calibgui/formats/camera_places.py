"""Programs that reconstruct scenes are told where the camera was at each photograph.

The world is the board. Its axes, and the camera's, are either those of the array frame (X right, Y
down, Z ahead, into the board), or those of OpenGL and Blender, which turn both by half about X: X
right, Y up, Z out of the board and behind the camera. Lengths are metres.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry import Pose, rotation_from_vector

M_PER_MM = 1e-3
_HALF_TURN = np.diag([1.0, -1.0, -1.0, 1.0])
"""The turn by half about X, in homogeneous coordinates."""


def camera_from_world(pose: Pose) -> Array:
    """Return the motion (4, 4) from the board, m, to the camera, m, in the axes of the array
    frame."""
    motion = np.eye(4)
    motion[:3, :3] = rotation_from_vector(pose.rvec)
    motion[:3, 3] = pose.tvec * M_PER_MM
    return motion


def world_from_camera_upright(pose: Pose) -> Array:
    """Return the motion (4, 4) from the camera, m, to the board, m, in the axes of OpenGL."""
    R, t = rotation_from_vector(pose.rvec), pose.tvec * M_PER_MM
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = R.T, -R.T @ t
    return _HALF_TURN @ motion @ _HALF_TURN

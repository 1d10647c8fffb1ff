"""Scenes that do not determine a camera."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import BOARD, Scene, barrel, looking, seen

LONG = barrel(focal=900.0)
"""Far from as long as its image is wide, which is what is assumed."""


def turned_in_place(camera: Camera, tilt: float) -> Scene:
    """A board turned about its own normal, its middle where it was."""
    first = looking(camera, np.random.default_rng(3), (tilt, tilt), fill=(0.5, 0.5), towards=40)
    R = Rotation.from_rotvec(np.array(first.rvec))
    middle = np.append(BOARD.points().mean(axis=0), 0.0)
    poses = []
    for angle in (0, 20, 45, 80, 130):
        turned = R * Rotation.from_euler("z", angle, degrees=True)
        poses.append(Pose(turned.as_rotvec(), first.tvec + R.apply(middle) - turned.apply(middle)))
    return seen(camera, poses)


def in_one_spot(camera: Camera) -> Scene:
    """Small boards in all tilts, low on the right of the image."""
    rng = np.random.default_rng(1)
    aim = (np.array(camera.size) * 0.7 - camera.centre) / camera.focal
    poses = []
    for _ in range(8):
        pose = looking(camera, rng, (20, 40), fill=(0.15, 0.2))
        R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()[:, :2]
        middle = R @ BOARD.points().mean(axis=0)
        poses.append(Pose(pose.rvec, (middle + pose.tvec)[2] * np.append(aim, 1.0) - middle))
    return seen(camera, poses)


def parallel(camera: Camera, tilt: float) -> Scene:
    """Five boards in one orientation."""
    rng = np.random.default_rng(1)
    return seen(
        camera,
        [looking(camera, rng, (tilt, tilt), fill=(0.4, 0.7), towards=40) for _ in range(5)],
    )


def one_view(camera: Camera, towards: float = 40.0) -> Scene:
    """One tilted board."""
    pose = looking(camera, np.random.default_rng(1), (35, 35), fill=(0.7, 0.7), towards=towards)
    return seen(camera, [pose])

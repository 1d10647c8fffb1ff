"""Faults of the choice of views: few, in one spot of the image, or in one orientation."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import BOARD, barrel, looking
from tests.faults.sets import (
    VIEWS,
    FaultySet,
    PhotographedSet,
    Rng,
    add_noise,
    draw_log,
    draw_set,
    photograph,
    state_fault,
)


def _make(photographed: PhotographedSet, story: str) -> FaultySet:
    return state_fault(photographed, photograph(photographed), story)


def take_none(rng: Rng) -> FaultySet:
    """Take a set as it is: no fault."""
    return _make(draw_set(rng), "no fault")


def take_few(rng: Rng) -> FaultySet:
    """Take two or three views."""
    count = int(rng.integers(2, 4))
    photographed = draw_set(rng)
    chosen = rng.choice(len(photographed.poses), count, replace=False).tolist()
    return _make(photographed.select(chosen), f"{count} views")


def stay_in_one_spot(rng: Rng) -> FaultySet:
    """Photograph small boards in one spot of the image, in all orientations."""
    camera = barrel()
    size = draw_log(rng, 0.06, 0.25)
    aim = (np.array(camera.size) * rng.uniform(0.25, 0.75, 2) - camera.centre) / camera.focal
    poses = []
    for _ in range(int(rng.integers(VIEWS[0], VIEWS[1] + 1))):
        pose = looking(camera, rng, (15, 45), fill=(0.8 * size, size))
        R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()[:, :2]
        middle = R @ BOARD.points().mean(axis=0)
        poses.append(Pose(pose.rvec, (middle + pose.tvec)[2] * np.append(aim, 1.0) - middle))
    return _make(add_noise(camera, poses, rng), f"boards of {size:.2f} of the width in one spot")


def stay_in_one_orientation(rng: Rng) -> FaultySet:
    """Photograph boards whose planes are parallel."""
    camera, tilt, towards = barrel(), float(rng.uniform(0, 40)), float(rng.uniform(0, 360))
    count = int(rng.integers(VIEWS[0], VIEWS[1] + 1))
    poses = [looking(camera, rng, (tilt, tilt), towards=towards) for _ in range(count)]
    return _make(add_noise(camera, poses, rng), f"{count} boards, all tilted by {tilt:.0f} degrees")

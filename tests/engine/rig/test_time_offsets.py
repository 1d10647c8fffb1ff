"""Cameras that are late are found out by a board that moves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.rig import RigCamera, calibrate_rig
from tests.engine.rig.scenes import (
    BOARD,
    RigScene,
    compose,
    make_rig,
    measure_pose_error,
    photograph_board,
)

RATE = 20.0
"""Photographs per second."""
LATE = (0.0, 0.013, -0.021)
"""Times, s, by which the cameras are late."""


def film(
    scene: RigScene, instants: int, rng: np.random.Generator, sigma: float = 0.02
) -> list[RigCamera]:
    """The scene's cameras with views of a board that moves smoothly, each at its own times."""

    def place_board(t: float) -> Pose:
        tilt = np.array([0.4 * np.sin(1.1 * t), 0.35 * np.cos(1.7 * t), 0.3 * np.sin(0.7 * t)])
        R = rotation_from_vector(tilt)
        where = [100 + 70 * np.sin(0.9 * t), 40 * np.cos(1.3 * t), 620 + 90 * np.sin(0.5 * t)]
        return Pose(vector_from_rotation(R), np.array(where) - R[:, :2] @ BOARD.points().mean(0))

    cameras = []
    for c, camera in enumerate(scene.cameras):
        views, times = {}, {}
        for k in range(instants):
            board = place_board(k / RATE + LATE[c])
            seen = photograph_board(camera.camera, compose(scene.poses[c], board))
            if seen is not None:
                views[k] = seen._replace(uv=seen.uv + rng.normal(0, sigma, seen.uv.shape))
                times[k] = k / RATE
        cameras.append(replace(camera, views=views, times=times))
    return cameras


def test_offsets_and_the_rig_are_found_together() -> None:
    scene = make_rig(3, instants=2, turn=0.05)
    cameras = film(scene, 120, np.random.default_rng(1))
    late = calibrate_rig(cameras, estimate_offsets=True)
    plain = calibrate_rig(cameras)
    for c in (1, 2):
        assert abs(late.offsets[c] - LATE[c]) < max(4 * late.offset_sigma(c), 2e-4)
        assert late.offset_sigma(c) < 1e-3
    assert late.rms < 1.2 * late.rms_alone < 0.3 * plain.rms
    assert measure_pose_error(late.poses, scene.poses)[1] < 1.0
    assert plain.disagreement > 2


def test_clocks_that_are_known_leave_nothing_to_find() -> None:
    scene = make_rig(2, instants=2, turn=0.05)
    cameras = film(scene, 60, np.random.default_rng(2))
    told = [
        replace(camera, times={k: t + late for k, t in camera.times.items()})
        for camera, late in zip(cameras, LATE, strict=False)
    ]
    rig = calibrate_rig(told, estimate_offsets=True)
    assert abs(rig.offsets[1]) < max(4 * rig.offset_sigma(1), 3e-4)


def test_photographs_that_are_far_apart_tell_no_offset() -> None:
    scene = make_rig(2, instants=12)
    cameras = [
        replace(camera, views={10 * k: view for k, view in camera.views.items()})
        for camera in scene.cameras
    ]
    with pytest.raises(CalibrationError, match="cam0 has no view of the board with one before"):
        calibrate_rig(cameras, estimate_offsets=True)

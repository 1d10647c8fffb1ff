"""Coverage against poses and points made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui import engine
from calibgui.dataset.sensor_coverage import count_corners_per_cell
from calibgui.engine.geometry import rotations
from calibgui.report.coverage import measure_attitudes
from tests.engine import scenes


def test_density_counts_every_corner_once() -> None:
    uv = np.array([[-0.5, -0.5], [0.0, 0.0], [639.4, 479.4], [319.4, 0.0], [319.6, 0.0]])
    counts = count_corners_per_cell(uv, (640, 480), (2, 3))
    assert counts.tolist() == [[3, 1], [0, 0], [0, 1]]


@pytest.mark.parametrize("towards", [0.0, 70.0, 160.0, 250.0])
def test_tilt_and_the_side_that_recedes(towards: float) -> None:
    """The depth of the farthest of four points around the board's middle."""
    rng = np.random.default_rng(1)
    camera = scenes.barrel()
    poses = [
        scenes.looking(camera, rng, tilt=(angle, angle), towards=towards, roll=0)
        for angle in (20.0, 30.0, 40.0)
    ] + [scenes.looking(camera, rng) for _ in range(5)]
    scene = scenes.seen(camera, poses)
    calibration = engine.calibrate(scene.views, scene.size)
    attitude = measure_attitudes(calibration, scene.views)
    np.testing.assert_allclose(np.rad2deg(attitude.tilt[:3]), [20, 30, 40], atol=1e-4)

    # Rotation about (cos a, sin a, 0) lowers depth along (-sin a, cos a) of the board: v down.
    a = np.deg2rad(towards)
    recedes = np.array([-np.sin(a), np.cos(a)])  # (u, v), where depth sin(tilt) grows
    expected = np.arctan2(-recedes[1], recedes[0])
    turn = np.angle(np.exp(1j * (attitude.direction[:3] - expected)))
    np.testing.assert_allclose(turn, 0.0, atol=1e-5)


def test_distance_is_to_the_middle_of_the_board() -> None:
    scene = scenes.scene(scenes.barrel(), 6, 2)
    calibration = engine.calibrate(scene.views, scene.size)
    distance = measure_attitudes(calibration, scene.views).distance
    for pose, view, d in zip(scene.poses, scene.views, distance, strict=True):
        centre = (view.xy.min(axis=0) + view.xy.max(axis=0)) / 2
        R = rotations.rotation_from_vector(pose.rvec)
        assert d == pytest.approx(float(np.linalg.norm(R[:, :2] @ centre + pose.tvec)), rel=1e-6)

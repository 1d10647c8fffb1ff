"""Poses of planes from rays, up to 90 degrees off the axis and beyond."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.planar_pose import poses_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector

XY = np.stack(np.meshgrid(np.arange(8) * 30.0, np.arange(6) * 30.0), axis=-1).reshape(1, -1, 2)


def _rays(R: Array, T: Array) -> Array:
    """(1, n, 3) of length 1 of the board's points under a pose."""
    points = XY @ R[:, :2].T + T
    return points / np.linalg.norm(points, axis=-1, keepdims=True)


@pytest.mark.parametrize("angle", [0, 40, 80, 90, 105, 150])
@pytest.mark.parametrize("distance", [150.0, 600.0, 1e4])
def test_the_pose_is_exact_in_every_direction(angle: float, distance: float) -> None:
    turn = rotation_from_vector(np.array([0.0, np.deg2rad(angle), 0.0]))
    R = turn @ rotation_from_vector(np.array([0.4, -0.3, 0.2]))
    T = turn @ np.array([0.0, 0.0, distance]) - R[:, :2] @ XY[0].mean(axis=0)
    found_R, found_T = poses_from_rays(_rays(R, T), XY, np.ones(XY.shape[:2]))
    miss = Rotation.from_matrix(found_R[0] @ R.T).magnitude()
    assert miss < 1e-13 * (distance / 30) ** 2
    np.testing.assert_allclose(found_T[0], T, rtol=1e-11 * distance, atol=1e-13 * distance**2)


def test_points_without_ray_and_padding_do_not_count() -> None:
    R, T = rotation_from_vector(np.array([0.3, 0.2, 0.1])), np.array([-100.0, -70.0, 400.0])
    rays, mask = _rays(R, T), np.ones(XY.shape[:2])
    rays[0, :3] = np.nan
    rays[0, 40:] = [0.0, 1.0, 0.0]
    mask[0, 40:] = 0.0
    found_R, found_T = poses_from_rays(rays, XY, mask)
    np.testing.assert_allclose(found_R[0], R, atol=1e-11)
    np.testing.assert_allclose(found_T[0], T, atol=1e-8)

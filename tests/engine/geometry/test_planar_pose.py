"""The pose of a plane from its homography, and the mirrored pose."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.geometry.planar_pose import mirror_planar_poses, poses_from_homographies
from calibgui.engine.geometry.rotations import rotation_from_vector

R = rotation_from_vector(np.array([[0.3, -0.2, 0.1], [-0.5, 0.4, 1.0]]))
T = np.array([[10.0, -20.0, 500.0], [-40.0, 5.0, 300.0]])


def test_exact_homographies_of_any_scale_give_the_poses() -> None:
    f = np.array([650.0, 600.0])
    M = np.diag([*f, 1.0]) @ np.concatenate([R[:, :, :2], T[:, :, None]], axis=2)
    M *= np.array([2.5, -0.01])[:, None, None]
    rotations, translations = poses_from_homographies(M, f, np.zeros((2, 2)))
    np.testing.assert_allclose(rotations, R, atol=1e-12)
    np.testing.assert_allclose(translations, T, rtol=1e-12)


def test_the_rotation_is_the_closest_one() -> None:
    M = np.random.default_rng(0).normal(size=(50, 3, 3))
    found, _ = poses_from_homographies(M, np.ones(2), np.zeros((50, 2)))
    A = M[:, :, :2] * np.sign(M[:, 2, 2])[:, None, None]
    U, _, Vt = np.linalg.svd(A, full_matrices=False)
    np.testing.assert_allclose(found[:, :, :2], U @ Vt, atol=1e-12)
    np.testing.assert_allclose(found[:, :, 2], np.cross(*np.moveaxis(U @ Vt, -1, 0)), atol=1e-12)


@pytest.mark.parametrize("second", [2.0, np.nan])
def test_no_pose_without_a_plane(second: float) -> None:
    M = np.array([[[1.0, second, 0.0], [1.0, second, 0.0], [0.0, 0.0, 1.0]]])
    with pytest.raises(np.linalg.LinAlgError):
        poses_from_homographies(M, np.ones(2), np.zeros((1, 2)))


def test_mirroring_reverses_depth_along_the_ray_alone() -> None:
    middle, point = np.array([[20.0, 30.0], [0.0, 15.0]]), np.array([[70.0, -10.0], [25.0, 60.0]])
    mirrored_R, mirrored_T = mirror_planar_poses(R, T, middle)
    np.testing.assert_allclose(np.linalg.det(mirrored_R), 1.0, rtol=1e-12)
    centre = (R[:, :, :2] @ middle[..., None])[..., 0] + T
    np.testing.assert_allclose(
        (mirrored_R[:, :, :2] @ middle[..., None])[..., 0] + mirrored_T, centre, rtol=1e-12
    )
    v = centre / np.linalg.norm(centre, axis=1, keepdims=True)
    offset = (R[:, :, :2] @ (point - middle)[..., None])[..., 0]
    mirrored = (mirrored_R[:, :, :2] @ (point - middle)[..., None])[..., 0]
    along = np.sum(offset * v, axis=1, keepdims=True)
    np.testing.assert_allclose(mirrored, offset - 2 * along * v, atol=1e-12)


def test_mirroring_twice_changes_nothing() -> None:
    middle = np.array([[20.0, 30.0, 0.0], [0.0, 15.0, 0.0]])
    back = mirror_planar_poses(*mirror_planar_poses(R, T, middle), middle)
    np.testing.assert_allclose(back[0], R, atol=1e-12)
    np.testing.assert_allclose(back[1], T, atol=1e-10)

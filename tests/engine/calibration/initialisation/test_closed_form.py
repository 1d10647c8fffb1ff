"""The start of Stage II: exact where the lens is, near where it is not."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.initialisation.stage_one import (
    StageOneRegistration,
    register_views,
)
from calibgui.engine.calibration.initialisation.start import check_facing, convert_to_paper_frame
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry import frames, rotations
from calibgui.engine.geometry.planar_pose import poses_from_homographies
from tests.engine.scenes import VGA, Scene, barrel, scene


def pinhole(aspect: float = 1.0, k1: float = 0.0) -> Camera:
    return Camera(VGA, [650, 650 * aspect, 310, 245, k1, 0, 0, 0, 0, 0])


def first(observations: Observations) -> StageOneRegistration:
    facing = check_facing(observations, [str(k) for k in range(len(observations.uv))])
    return register_views(*convert_to_paper_frame(observations, 1.0, VGA, facing))


def start(observations: Observations, centre: Array, k1: float) -> tuple[Array, Array, Array]:
    """Focal lengths and poses."""
    M = closed_form.fit_homographies(observations, centre, k1)
    f = closed_form.estimate_focal_lengths(M, VGA)
    assert f is not None
    return f, *poses_from_homographies(M, f, observations.xy[:, 0])


@pytest.mark.parametrize("aspect", [0.7, 1.0, 1.4])
def test_a_pinhole_is_exact(aspect: float) -> None:
    made = scene(pinhole(aspect), 5)
    found = start(pack_observations(made.views), made.camera.centre, 0.0)
    check(found, made, 1e-7)


def test_k1_in_square_pixels_is_exact() -> None:
    made = scene(pinhole(k1=0.25), 5)
    observations = pack_observations(made.views)
    centre, k1 = closed_form.estimate_centre_and_k1(first(observations), VGA)
    np.testing.assert_allclose(centre, made.camera.centre, atol=1e-3)
    assert k1 == pytest.approx(0.25 / 650**2, rel=1e-4)
    check(start(observations, centre, k1), made, 1e-4)


def check(found: tuple[Array, Array, Array], made: Scene, rtol: float) -> None:
    f, R, T = found
    np.testing.assert_allclose(f, made.camera.focal, rtol=rtol)
    for k, pose in enumerate(made.poses):
        np.testing.assert_allclose(R[k], rotations.rotation_from_vector(pose.rvec), atol=10 * rtol)
        np.testing.assert_allclose(T[k], pose.tvec, rtol=10 * rtol, atol=10 * rtol * 600)


def test_frontal_views_tell_no_focal_length() -> None:
    made = scene(pinhole(), 4, tilt=(0.0, 0.0))
    noisy = pack_observations(made.noisy(0.5, np.random.default_rng(0)))
    M = closed_form.fit_homographies(noisy, made.camera.centre, 0.0)
    assert closed_form.estimate_focal_lengths(M, VGA) is None
    R, T = poses_from_homographies(M, np.array([650.0, 650.0]), noisy.xy[:, 0])
    np.testing.assert_allclose(R @ np.swapaxes(R, 1, 2), np.tile(np.eye(3), (4, 1, 1)), atol=1e-12)
    assert (T[:, 2] > 0).all()


def prealignment(centre: Array, k1: Array, spread: Array) -> StageOneRegistration:
    K = len(k1)
    return StageOneRegistration(
        centre, k1, np.zeros((K, 3, 3)), spread, np.ones(K), np.ones(K, np.int64), np.ones(K, bool)
    )


def test_a_wild_view_does_not_move_the_start() -> None:
    centre = np.array([[-16.0, -3.0], [-17.0, -2.5], [900.0, 400.0], [np.nan, np.nan]])
    k1 = np.array([6e-7, 5.8e-7, -1e-4, np.nan])
    spread = np.array([[1, 1, 1e-8], [1, 1, 1e-8], [90, 90, 1e-5], [np.nan] * 3])
    found, value = closed_form.estimate_centre_and_k1(prealignment(centre, k1, spread), VGA)
    back = frames.paper_from_array(found, VGA)
    assert back[0] in (-16.0, -17.0)
    assert back[1] in (-3.0, -2.5)
    assert value in (6e-7, 5.8e-7)


def test_a_centre_outside_the_image_is_not_believed() -> None:
    spread = np.ones((2, 3))
    at = prealignment(np.full((2, 2), 400.0), np.zeros(2), spread)
    np.testing.assert_array_equal(closed_form.estimate_centre_and_k1(at, VGA)[0], [319.5, 239.5])


def test_stage_two_starts_near_the_minimum() -> None:
    """Within some pixels even for k1 in pixels that are not square."""
    made = scene(barrel(0.8), 8)
    found = calibrate(made.noisy(0.1, np.random.default_rng(0)), VGA)
    assert found.history[0].rms < 5.0
    assert len(found.history) <= 8

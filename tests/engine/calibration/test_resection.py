"""Poses under a known camera, against the truth and OpenCV."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.choices.cross_validation import resect_views
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import pack_observations
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry import rotations
from tests.engine.scenes import barrel, brown, relative, scene


@pytest.mark.parametrize("camera", [barrel(aspect=1.1), brown()])
def test_closed_form_is_exact_without_noise(camera: Camera) -> None:
    true = scene(camera, 5)
    state = estimate_poses(camera, pack_observations(true.views))
    for R, T, pose in zip(state.R, state.T, true.poses, strict=True):
        assert relative(R, rotations.rotation_from_vector(pose.rvec)) < 1e-8
        assert relative(T, pose.tvec) < 1e-8


@pytest.mark.parametrize("cost", list(Cost))
def test_views_of_the_calibration_itself_keep_their_residuals(cost: Cost) -> None:
    views = scene(barrel(), 6).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size, cost=cost)
    again = resect_views(result, views)
    for mine, theirs in zip(again, result.residuals, strict=True):
        assert relative(mine.image, theirs.image) < 1e-4


def test_unseen_views_show_the_noise() -> None:
    rng = np.random.default_rng(2)
    result = calibrate(scene(barrel(), 20).noisy(0.2, rng), barrel().size)
    unseen = scene(barrel(), 10, seed=8).noisy(0.2, rng)
    image = np.concatenate([view.image for view in resect_views(result, unseen)])
    corners = len(unseen[0].uv)
    assert image.std() == pytest.approx(0.2 * np.sqrt(1 - 3 / corners), rel=0.05)


def test_one_view_is_enough() -> None:
    views = scene(barrel(), 5).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size)
    alone = resect_views(result, views[2:3])[0]
    assert relative(alone.image, result.residuals[2].image) < 1e-4

"""All of a camera held: poses as of one view by itself, and nothing said of the camera's errors."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.board_poses import locate_board
from calibgui.engine.calibration.held_camera import hold_camera
from calibgui.engine.calibration.problem import find_free_parameters, is_held
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from tests.engine.scenes import LENSES, example, scene

NOISE = 0.05


@pytest.mark.parametrize("model", [name for name in LENSES if name != "lucchese-pixels"])
def test_poses_are_those_of_each_view_by_itself(model: str) -> None:
    camera = example(model)
    views = scene(camera, 2, seed=3).noisy(NOISE, np.random.default_rng(0))
    covariance = np.diag(np.full(len(camera.params), 1e-8))
    found = hold_camera(camera, views, covariance)
    assert is_held(found)
    for view, pose, sigma, residuals in zip(
        views, found.poses, found.pose_covariances, found.residuals, strict=True
    ):
        alone = locate_board(camera, view, covariance)
        np.testing.assert_allclose(pose.tvec, alone.pose.tvec, rtol=1e-9)
        np.testing.assert_allclose(sigma, alone.covariance, rtol=1e-9)
        np.testing.assert_allclose(residuals.image, alone.residuals, atol=1e-6)
        assert residuals.rms == pytest.approx(NOISE * 2**0.5, rel=0.3)
    assert len(found.stage_one) == 2


def test_nothing_is_said_of_the_errors_of_a_held_camera() -> None:
    camera = example("brown-conrady")
    views = scene(camera, 3, seed=3).noisy(NOISE, np.random.default_rng(0))
    found = hold_camera(camera, views)
    assert np.isnan(found.sigma).all()
    for ask in (find_free_parameters, lambda each: estimate_projection_uncertainty(each, views)):
        with pytest.raises(CalibrationError, match="known from a file"):
            ask(found)

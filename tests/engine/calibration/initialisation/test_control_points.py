"""The control points of a splined lens: chosen to cover the corners, or refused."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation.control_points import choose_control_points
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, scene

FISHEYE = Camera(VGA, [190, 191, 322, 236, -0.03, 0.004, -0.001, 0], "kannala-brandt")
VIEWS = scene(FISHEYE, 12).views


def test_the_control_points_cover_the_corners_and_little_more() -> None:
    lens = find_model(choose_control_points(pack_observations(VIEWS), VGA))
    assert isinstance(lens, SplinedStereographic)
    rays = rays_from_pixels(np.concatenate([view.uv for view in VIEWS]), FISHEYE)
    reach = np.abs(2 * rays[:, :2] / (1 + rays[:, 2:])).max(axis=0)
    covered = 2 * np.tan(np.deg2rad(lens.fov) / 4) * np.array([1.0, 8 / 13])
    assert (reach < covered).all()
    assert (1.15 * reach > covered).any()


def test_a_calibration_without_an_angle_names_the_one_it_took() -> None:
    rng = np.random.default_rng(1)
    views = [Observation(view.uv + rng.normal(0, 0.1, view.uv.shape), view.xy) for view in VIEWS]
    found = calibrate(views, VGA, model="splined-stereographic")
    assert found.camera.model.startswith("splined-stereographic-16x11-")
    residuals = np.concatenate([view.image for view in found.residuals])
    assert np.sqrt(np.mean(residuals**2)) < 0.1


def test_control_points_that_do_not_cover_the_corners_are_refused() -> None:
    with pytest.raises(CalibrationError, match="times as far from the axis as the control points"):
        calibrate(VIEWS, VGA, model="splined-stereographic-16x11-60")


def test_no_board_shape_is_estimated_with_a_splined_lens() -> None:
    with pytest.raises(CalibrationError, match="not estimated together"):
        calibrate(VIEWS, VGA, model="splined-stereographic", board_shape="free")

"""A board of longer squares: scaled numbers are those of another calibration."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.scaling import scale_lengths
from tests.engine.scenes import VGA, barrel, scene

RATIO = 2.5


@pytest.mark.parametrize("shape", [BoardShapeModel.NOMINAL, BoardShapeModel.FREE])
def test_scaled_numbers_are_those_of_a_calibration_with_longer_squares(
    shape: BoardShapeModel,
) -> None:
    views = scene(barrel(), 8, seed=2).noisy(0.1, np.random.default_rng(1))
    longer = [view._replace(xy=RATIO * view.xy) for view in views]
    scaled = scale_lengths(calibrate(views, VGA, board_shape=shape), RATIO)
    asked = calibrate(longer, VGA, board_shape=shape)
    for name in ("sigma", "covariance", "pose_covariances", "noise", "reference_scale"):
        np.testing.assert_allclose(
            getattr(scaled, name), getattr(asked, name), rtol=2e-3, atol=1e-12, err_msg=name
        )
    for a, b in zip(scaled.poses, asked.poses, strict=True):
        np.testing.assert_allclose(a.tvec, b.tvec, rtol=1e-7)
    if shape is BoardShapeModel.NOMINAL:
        return
    assert scaled.board_shape is not None and asked.board_shape is not None
    for field in fields(scaled.board_shape):
        if field.name not in ("model", "views"):
            a, b = (getattr(each.board_shape, field.name) for each in (scaled, asked))
            np.testing.assert_allclose(a, b, rtol=1e-3, atol=0.02 * np.abs(b).max())


def test_a_calibration_that_was_told_other_lengths_is_not_scaled() -> None:
    views = scene(barrel(), 6, seed=2).noisy(0.1, np.random.default_rng(1))
    prior = BoardShapePrior(0.1, 0.3)
    with pytest.raises(ValueError, match="made anew"):
        scale_lengths(calibrate(views, VGA, prior=prior), RATIO)

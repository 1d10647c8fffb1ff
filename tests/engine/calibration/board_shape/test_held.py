"""What the errors of a held board shape do to the camera is in its standard deviations.

200 draws of each stand in ``tests/benchmarks/standard_deviations.py``. A root mean square of 24 is
known to 15 %.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.refit import refit
from tests.engine.bent_boards import Bend, Use, draw_calibrations
from tests.engine.calibration.board_shape.test_parametrisation import SIZE, deviation, photographed

DRAWS = 24
BENT, LITTLE, DRAWN = Bend(0.2, 0.05, 0.02), Bend(0.03, 0.01, 0.005), Bend()


@pytest.mark.parametrize(
    ("bend", "use"),
    [(BENT, Use.OTHERS), (BENT, Use.SAME), (LITTLE, Use.OTHERS), (DRAWN, Use.FREE)],
)
def test_errors_are_as_large_as_stated(bend: Bend, use: Use) -> None:
    ratios = draw_calibrations(bend, use, DRAWS, views=8).ratios
    assert (ratios > 0.65).all()
    assert (ratios < 1.6).all()
    assert 0.8 < np.exp(np.log(ratios).mean()) < 1.25


def test_the_same_views_give_the_joint_estimate_and_are_recognised() -> None:
    views = photographed(deviation(), 12, 0.1)
    joint = calibrate(views, SIZE, board_shape="free")
    shape = joint.board_shape
    assert shape is not None
    held = calibrate(views, SIZE, board_shape=shape)
    np.testing.assert_allclose(held.sigma, joint.sigma, rtol=0.06)
    by_pose, by_pose_jointly = (
        np.sqrt(np.diagonal(found.pose_covariances, axis1=1, axis2=2)) for found in (held, joint)
    )
    np.testing.assert_allclose(by_pose, by_pose_jointly, rtol=0.15)
    assert held.sigma[3] > 2 * held.sigma_by_noise[3]
    assert held.warnings[0].startswith("12 of 12 photographs are those that the board's shape")
    others = calibrate([*views[:4], *photographed(deviation(), 8, 0.1, 9)], SIZE, board_shape=shape)
    assert others.warnings[0].startswith("4 of 12 photographs")
    assert calibrate(views, SIZE, board_shape=replace(shape, views=())).warnings == ()
    again = refit(views, joint, "brown-conrady").calibration  # which holds the shape
    np.testing.assert_allclose(again.sigma[:4], joint.sigma[:4], rtol=0.2)


def test_a_shape_without_its_covariance_says_so() -> None:
    views = photographed(deviation(), 12, 0.1)
    shape = calibrate(views, SIZE, board_shape="free").board_shape
    assert shape is not None
    known, unknown = (
        calibrate(photographed(deviation(), 8, 0.1, 9), SIZE, board_shape=held)
        for held in (shape, replace(shape, covariance=None))
    )
    assert known.warnings == ()
    assert "does not say how the errors of its corners are correlated" in unknown.warnings[0]
    assert (unknown.sigma[:9] > unknown.sigma_by_noise[:9]).all()
    assert (unknown.sigma[:4] < known.sigma[:4]).all()


def test_a_board_as_drawn_is_eased_back_to_the_drawing() -> None:
    views = photographed(np.zeros_like(deviation()), 12, 0.1)
    found = calibrate(views, SIZE, board_shape="free")
    nominal = calibrate(views, SIZE)
    assert found.board_shape is not None
    assert found.board_shape.rms < 0.02  # mm; with every corner by itself noise makes 0.05
    off = found.camera.params - nominal.camera.params
    assert (np.abs(off[:9]) < nominal.sigma_by_noise[:9]).all()
    assert (found.sigma[:9] < 1.5 * nominal.sigma_by_noise[:9]).all()

"""Each view as the others predict it, against calibrations without it."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.choices.cross_validation import cross_validate
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.leave_one_out import leave_views_out
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DegenerateError
from tests.engine.scenes import barrel, scene

SIZE = barrel().size


def make_views(count: int) -> list[Observation]:
    """Return views of two kinds of corners, one of them a part of the board."""
    views = scene(barrel(), count, seed=2).noisy(0.2, np.random.default_rng(2))
    views = [
        view._replace(
            cov=np.where(np.arange(len(view.uv)) % 2, 0.02, 0.08)[:, None, None] * np.eye(2)
        )
        for view in views
    ]
    views[-1] = Observation(*(array[:-6] for array in views[-1] if array is not None))
    return views


@pytest.mark.parametrize(
    ("model", "shape", "tolerance"),
    [
        ("lucchese", "nominal", 2e-3),
        ("kannala-brandt", "nominal", 2e-3),
        ("lucchese", "affine", 2e-3),
        ("lucchese", "free", 2e-2),  # its variances are learnt anew without a view
    ],
)
def test_it_says_what_calibrations_without_a_view_say(
    model: str, shape: str, tolerance: float
) -> None:
    views = make_views(9)
    calibration = calibrate(views, SIZE, model=model, board_shape=shape)
    left_out = leave_views_out(calibration, views)
    refits = cross_validate(views, SIZE, len(views), calibration, model=model, board_shape=shape)
    np.testing.assert_allclose(left_out.by_view, refits.by_view, rtol=tolerance)
    np.testing.assert_allclose(left_out.held_out, refits.held_out, rtol=tolerance)
    assert len(left_out.lengths) == sum(len(view.uv) for view in views)


def test_a_view_without_which_nothing_is_determined_is_named() -> None:
    views = make_views(1)
    calibration = calibrate(views, SIZE, fix=["fy", "cx", "cy", "k2", "k3", "p1", "p2"])
    with pytest.raises(DegenerateError, match="Without view 1"):
        leave_views_out(calibration, views)

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
    ("model", "shape", "tolerance", "sigmas"),
    [
        ("lucchese", "nominal", 2e-3, 0.1),
        ("kannala-brandt", "nominal", 2e-3, 0.1),
        ("lucchese", "affine", 2e-3, 0.1),
        ("lucchese", "free", 2e-2, 0.5),  # its variances are learnt anew without a view
    ],
)
def test_it_says_what_calibrations_without_a_view_say(
    model: str, shape: str, tolerance: float, sigmas: float
) -> None:
    views = make_views(9)
    calibration = calibrate(views, SIZE, model=model, board_shape=shape)
    left_out = leave_views_out(calibration, views)
    refits = cross_validate(views, SIZE, len(views), calibration, model=model, board_shape=shape)
    np.testing.assert_allclose(left_out.by_view, refits.by_view, rtol=tolerance)
    np.testing.assert_allclose(left_out.held_out, refits.held_out, rtol=tolerance)
    moves = [fold.camera.params - calibration.camera.params for fold in refits.folds]
    error = np.abs(left_out.moves - moves) / np.maximum(calibration.sigma, 1e-12)
    assert error[:, calibration.sigma > 0].max() < sigmas
    assert len(left_out.lengths) == sum(len(view.uv) for view in views)


def test_held_parameters_do_not_move() -> None:
    views = make_views(6)
    calibration = calibrate(views, SIZE, fix={"k3": 0.0, "cx": None})
    moves = leave_views_out(calibration, views).moves
    is_held = np.isin(calibration.camera.names, calibration.fixed)
    assert not moves[:, is_held].any()
    assert moves[:, ~is_held].all()


def test_a_view_that_does_not_belong_has_the_most_influence() -> None:
    views = make_views(9)
    w, h = SIZE
    turned = views[4]._replace(uv=np.array([w - 1, h - 1]) - views[4].uv)
    shifted = views[4]._replace(uv=views[4].uv * 1.03)
    for odd in (shifted, turned):
        odd_views = [*views[:4], odd, *views[5:]]
        influence = leave_views_out(calibrate(odd_views, SIZE), odd_views).influence
        assert int(np.argmax(influence)) == 4


def test_a_view_without_which_nothing_is_determined_is_named() -> None:
    views = make_views(1)
    calibration = calibrate(views, SIZE, fix=["fy", "cx", "cy", "k2", "k3", "p1", "p2"])
    with pytest.raises(DegenerateError, match="Without view 1"):
        leave_views_out(calibration, views)

"""What causes of each view's own would explain, and the fit that they are tested on."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.residuals import systematic_errors
from calibgui.engine.assessment.residuals.cause_fits import CauseFit, fit_nothing, fit_own_cause
from calibgui.engine.assessment.residuals.residual_causes import CAUSES, Family
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Cost
from calibgui.engine.calibration.score_tests import LENS, SharedCauses
from tests.engine.scenes import barrel, relative, scene

SIZE = barrel().size


@pytest.mark.parametrize("cost", list(Cost))
def test_every_cost_can_be_examined(cost: Cost) -> None:
    views = scene(barrel(), 8, 1).noisy(0.1, np.random.default_rng(2))
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE, cost=cost), views)
    residual = fit.linearise(slice(0, 8)).residual
    assert np.sqrt(np.mean(residual**2)) == pytest.approx(0.1, rel=0.1)
    assert SharedCauses(fit, [LENS]).explain(LENS).probability > 0.001
    without = fit_nothing(fit)
    start = CauseFit(float(np.sum(residual**2)), 0)
    for cause in CAUSES:
        if isinstance(cause.adds, str):
            continue
        if cause.family is not Family.OPEN:
            found = fit_own_cause(fit, cause.adds).judge(without, fit.degrees_of_freedom)
            assert found.probability > 0.001
    steps = systematic_errors.take_open_steps(fit)
    for step in (steps.smooth, steps.lines):
        assert step.judge(start, fit.degrees_of_freedom).probability > 0.001
    assert 1.0 <= steps.dispersion < 1.5


def test_errors_that_are_alike_along_rows_are_dispersed() -> None:
    rng, views = np.random.default_rng(2), []
    for view in scene(barrel(), 8, 1).noisy(0.05, rng):
        shift = np.interp(view.uv[:, 1], np.arange(0, 481, 20), rng.normal(0, 0.1, 25))
        views.append(Observation(view.uv + np.column_stack([shift, 0 * shift]), view.xy))
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE), views)
    assert systematic_errors.take_open_steps(fit).dispersion > 2


def test_weights_divide_the_residuals() -> None:
    views = scene(barrel(), 4, 1).noisy(0.1, np.random.default_rng(2))
    views = [v._replace(uv=v.uv[: 40 + k], xy=v.xy[: 40 + k]) for k, v in enumerate(views)]
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE, fix=["k2", "k3"]), views)
    sigma, whole = np.array([1.0, 2.0, 4.0, 8.0]), slice(0, 4)
    weighed = systematic_errors.weigh_views(fit, sigma)
    plain, weighted = (f.linearise(whole).residual for f in (fit, weighed))
    assert relative(weighted * sigma[:, None, None], plain) < 1e-12
    assert np.array_equal(fit.predict_corners(whole), weighed.predict_corners(whole))


def test_smooth_columns_are_orthonormal_and_follow_a_bending_board() -> None:
    views = scene(barrel(), 6, 1).noisy(0.1, np.random.default_rng(2))
    views[2] = Observation(views[2].uv[::17], views[2].xy[::17])  # 14 rows: too few for all columns
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE), views)
    Q = systematic_errors.make_smooth_columns(fit)
    for k, columns in enumerate(Q):
        used = columns[:, np.abs(columns).max(axis=0) > 0]
        # A cubic may be all but a motion of the board.
        assert used.shape[1] == 14 if k == 2 else 24 <= used.shape[1] <= 26
        np.testing.assert_allclose(used.T @ used, np.eye(used.shape[1]), atol=1e-9)
        assert not columns[2 * len(views[k].uv) :].any()  # padding
        x = (fit.observations.xy[k] @ [1e-3, 2e-3]) ** 2
        bent = np.stack([x, -0.5 * x], axis=-1) * fit.observations.mask[k, :, None]
        pose = fit.linearise(slice(k, k + 1)).by_pose[0].reshape(len(columns), 6)
        for wanted, tolerance in ((bent.ravel(), 1e-4), *((column, 1e-9) for column in pose.T)):
            left = wanted - used @ (used.T @ wanted)
            assert np.linalg.norm(left) < tolerance * np.linalg.norm(wanted)

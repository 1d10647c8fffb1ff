"""What single views say about xp, yp and k1, against the engine's Stage I."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration.initialisation.stage_one import register_points, register_views
from calibgui.engine.geometry.frames import paper_from_array
from calibgui.report.paper_stage_one import examine_stage_one
from calibgui.report.paper_tables import stack_stage_one
from tests.report.paper_run import calibrate_paper_views


@pytest.fixture(scope="module")
def result() -> Result:
    return calibrate_paper_views(seed=1, views=6)


@pytest.fixture(scope="module")
def points(result: Result) -> tuple[Array, Array]:
    """(K, N, 2) corners in the paper's frame, and x', y' on the reference plane."""
    views = result.observations()
    size, scale = result.calibration.camera.size, result.calibration.reference_scale
    reference = scale * np.array([(view.xy - view.xy.mean(axis=0)) * [1, -1] for view in views])
    return np.array([paper_from_array(view.uv, size) for view in views]), reference


def test_the_standard_deviations_are_those_of_stage_one(
    result: Result, points: tuple[Array, Array]
) -> None:
    registration = register_views(*points, np.ones(points[0].shape[:2]))
    evidence = examine_stage_one(result, stack_stage_one(result))
    np.testing.assert_allclose(evidence.sd, registration.spread, rtol=1e-4)


def test_a_views_own_values_leave_its_own_residual(result: Result) -> None:
    evidence = examine_stage_one(result, stack_stage_one(result))
    rms = [row.rms for row in result.calibration.stage_one]
    np.testing.assert_allclose(evidence.held_rms, rms, rtol=1e-9)


def test_with_other_values_held_the_homography_is_fitted_again(
    result: Result, points: tuple[Array, Array]
) -> None:
    """The residual of eq. 33 as Stage I computes it, minimised by its homography alone."""
    held = stack_stage_one(result) + np.array([8.0, -5.0, 1e-8])
    evidence = examine_stage_one(result, held)
    for values, x, reference, rms in zip(held, *points, evidence.held_rms, strict=True):

        def residual(rest: Array, z: Array = values, x: Array = x, to: Array = reference) -> Array:
            return (register_points(np.append(z, rest)[None], x[None])[0][0] - to).ravel()

        start = np.array([1.0, 0, 0, 1, 0, 0, 0, 0])  # eq. 32 for no tilt
        fit = scipy.optimize.least_squares(residual, start, method="lm", x_scale="jac")
        assert rms == pytest.approx(np.sqrt(2 * fit.cost / len(x)), rel=1e-6)

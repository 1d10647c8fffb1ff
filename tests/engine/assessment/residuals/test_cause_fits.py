"""Causes are fitted to the minimum, and compared with each other whatever unknowns they have."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.residuals.cause_fits import (
    CauseFit,
    fit_board,
    fit_nothing,
    fit_own_cause,
)
from calibgui.engine.assessment.residuals.systematic_errors import (
    make_centre_columns,
    make_focus_columns,
    prepare_fit,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from tests.engine.scenes import barrel, scene

CAMERA = barrel()
NOISE = 0.05


def draw_views(seed: int) -> list[Observation]:
    return scene(CAMERA, 10, seed).noisy(NOISE, np.random.default_rng(seed))


def measure_rms(cost: float, count: int) -> float:
    return float(np.sqrt(cost / count))


@pytest.mark.parametrize("name", ["focus", "centre"])
def test_what_a_large_cause_of_each_view_leaves_is_noise(name: str) -> None:
    rng, views = np.random.default_rng(7), []
    for view in draw_views(3):
        if name == "focus":
            uv = CAMERA.centre + (1 + rng.normal(0, 0.03)) * (view.uv - CAMERA.centre)
        else:
            uv = view.uv + rng.normal(0, 20.0, 2)
        views.append(Observation(uv, view.xy))
    fit = prepare_fit(calibrate(views, CAMERA.size), views)
    count = fit.degrees_of_freedom
    found = fit_own_cause(fit, make_focus_columns if name == "focus" else make_centre_columns)
    assert found.unknowns == (10 if name == "focus" else 20)
    assert measure_rms(fit_nothing(fit).cost, count) > 4 * NOISE
    assert measure_rms(found.cost, count - found.unknowns) == pytest.approx(NOISE, rel=0.05)


@pytest.mark.parametrize("stretch", [1.02, 1.3])
def test_a_stretched_board_is_fitted_as_the_calibration_does(stretch: float) -> None:
    views = [Observation(view.uv, view.xy / [1.0, stretch]) for view in draw_views(3)]
    calibration = calibrate(views, CAMERA.size)
    fit = prepare_fit(calibration, views)
    found = fit_board(fit, BoardShapeModel.AFFINE)
    estimated = calibrate(views, CAMERA.size, board_shape="affine")
    cost = sum(float(np.sum(view.image**2)) for view in estimated.residuals)
    assert found.unknowns == 2
    if stretch < 1.1:
        assert found.cost == pytest.approx(cost, rel=0.01)
    else:  # far from where it began, and yet most of it is explained
        assert found.cost < 0.1 * fit_nothing(fit).cost


def test_nothing_is_lower_than_the_minimum_of_views_that_are_not_weighed() -> None:
    views = draw_views(4)
    fit = prepare_fit(calibrate(views, CAMERA.size), views)
    cost = float(np.sum(fit.linearise(slice(0, 10)).residual ** 2))
    assert fit_nothing(fit) == CauseFit(pytest.approx(cost, rel=1e-6), 0)


def test_a_cause_must_be_worth_its_unknowns() -> None:
    """An unknown that explains what it does of noise alone is worth less than it costs."""
    without = CauseFit(1000.0, 0)
    few, many = without.lower(100.0, 2), without.lower(110.0, 60)
    assert few.compute_akaike(without, 1000, 1.0) < many.compute_akaike(without, 1000, 1.0)
    assert without.lower(5.0, 5).compute_akaike(without, 1000, 1.0) > 0
    assert without.compute_akaike(without, 1000, 1.0) == 0
    # Errors that are not independent let each unknown explain more.
    noisy = without.lower(50.0, 20)
    assert noisy.compute_akaike(without, 1000, 1.0) < 0 < noisy.compute_akaike(without, 1000, 4.0)

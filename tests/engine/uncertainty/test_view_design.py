"""Uncertainty of sets of views, against calibrations from these sets."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.uncertainty.view_design import build_design
from tests.engine.scenes import TRUE_BOARD, barrel, relative, scene

SIZE = barrel().size


def _calibrated(count: int, noise: float = 0.2) -> tuple[Calibration, list[Observation]]:
    views = scene(barrel(), count, seed=1).noisy(noise, np.random.default_rng(2))
    return calibrate(views, SIZE, prior=TRUE_BOARD), views


def test_a_set_is_known_as_well_as_its_calibration_says() -> None:
    whole, views = _calibrated(12)
    chosen = np.zeros(12)
    chosen[[0, 2, 3, 7, 8, 11]] = 1
    found = build_design(whole, views)
    part = calibrate([views[k] for k in np.flatnonzero(chosen)], SIZE, prior=TRUE_BOARD)
    predicted = np.sqrt(np.diag(found.compute_covariance(chosen))) / whole.noise
    assert predicted == pytest.approx(part.sigma[found.free] / part.noise, rel=0.05)
    assert found.compute_sigmas(chosen)[0] == pytest.approx(
        np.sqrt(np.mean(part.sigma[2:4] ** 2)) * whole.noise / part.noise, rel=0.05
    )


def test_all_views_have_the_reported_covariance() -> None:
    whole, views = _calibrated(12)
    found = build_design(whole, views)
    reported = whole.covariance[np.ix_(found.free, found.free)]
    unit = np.sqrt(np.outer(np.diag(reported), np.diag(reported)))
    assert relative(found.compute_covariance(np.ones(12)) / unit, reported / unit) < 2e-3


def test_the_uncertainty_of_a_board_shape_stays() -> None:
    views = [
        Observation(view.uv, view.xy * np.array([0.99, 1.0]))
        for view in scene(barrel(), 12, 1).noisy(0.1, np.random.default_rng(2))
    ]
    nominal, affine = (
        calibrate(views, SIZE, board_shape=board_shape)
        for board_shape in (BoardShapeModel.NOMINAL, BoardShapeModel.AFFINE)
    )
    twice = np.full(12, 2.0)
    doubted, estimated = (build_design(result, views) for result in (nominal, affine))
    assert doubted.compute_sigmas(twice)[1] > 0.9 * doubted.compute_sigmas(twice / 2)[1]
    falls = estimated.compute_sigmas(twice)[1] / estimated.compute_sigmas(twice / 2)[1]
    assert falls == pytest.approx(np.sqrt(0.5), abs=0.02)
    assert affine.board_shape is not None
    shape = affine.board_shape.scale_errors(100.0)
    given = build_design(calibrate(views, SIZE, board_shape=shape), views)
    assert given.compute_sigmas(twice)[1] > 0.9 * given.compute_sigmas(twice / 2)[1]


def test_held_parameters_count_as_known() -> None:
    views = scene(barrel(), 6, 1).noisy(0.2, np.random.default_rng(2))
    result = calibrate(views, SIZE, fix=["cx", "cy"])
    assert build_design(result, views).compute_sigmas(np.ones(6))[0] == 0.0

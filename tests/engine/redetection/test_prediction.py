"""Predicted corners against the truth, and their scatter against what is claimed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.corner_fit.board_priors import LatticePriors
from calibgui.engine.redetection.prediction import resect_view
from tests.engine import scenes

SIGMA = 0.05
POINTS = scenes.BOARD.points()
PART = np.flatnonzero((POINTS[:, 0] < 130) & (POINTS[:, 1] < 100))
"""Corners that are seen: those near the origin."""


@pytest.fixture(scope="module")
def calibration() -> Calibration:
    scene = scenes.scene(scenes.barrel(), count=8)
    noisy = scene.noisy(SIGMA, np.random.default_rng(1))
    cov = np.broadcast_to(SIGMA**2 * np.eye(2), (len(POINTS), 2, 2))
    return calibrate([Observation(view.uv, view.xy, cov) for view in noisy], scene.size)


def test_predicts_what_it_has_not_seen(calibration: Calibration) -> None:
    pose = calibration.poses[0]
    uv = scenes.imaged(calibration.camera, pose, POINTS)
    cov = np.broadcast_to(1e-4 * np.eye(2), (len(PART), 2, 2))
    known = replace(calibration, covariance=np.zeros_like(calibration.covariance))
    expected, spread = resect_view(known, uv[PART], POINTS[PART], cov).predict_corners(POINTS)
    np.testing.assert_allclose(expected, uv, atol=1e-6)
    far, near = (np.trace(spread, axis1=1, axis2=2)[i] for i in (-1, 0))
    assert far > 4 * near  # across the board from what was seen


def test_scatters_as_claimed(calibration: Calibration) -> None:
    known = replace(calibration, covariance=np.zeros_like(calibration.covariance), model_error=0.0)
    rng = np.random.default_rng(2)
    uv = scenes.imaged(known.camera, known.poses[0], POINTS)
    cov = np.broadcast_to(SIGMA**2 * np.eye(2), (len(PART), 2, 2))
    squares = []
    for _ in range(200):
        seen = uv[PART] + rng.normal(scale=SIGMA, size=(len(PART), 2))
        view = resect_view(known, seen, POINTS[PART], cov)
        at, spread = view.predict_corners(POINTS[-1:])
        off = at[0] - uv[-1]
        squares.append(off @ np.linalg.solve(spread[0], off) / (1 + view.tau2 / SIGMA**2) ** 0)
    assert np.mean(squares) == pytest.approx(2, rel=0.3)


def test_a_wrong_corner_stands_out(calibration: Calibration) -> None:
    uv = scenes.imaged(calibration.camera, calibration.poses[0], POINTS)[PART]
    uv[3] += [1.0, 0.0]
    cov = np.broadcast_to(SIGMA**2 * np.eye(2), (len(PART), 2, 2))
    view = resect_view(calibration, uv, POINTS[PART], cov)
    assert int(np.argmax(view.deviation)) == 3
    assert view.deviation[3] > 10


def test_edges_run_and_bend_as_the_camera_sees_them(calibration: Calibration) -> None:
    uv = scenes.imaged(calibration.camera, calibration.poses[0], POINTS)
    cov = np.broadcast_to(1e-4 * np.eye(2), (len(POINTS), 2, 2))
    steps, kappa = resect_view(calibration, uv, POINTS, cov).predict_edges(
        POINTS, scenes.BOARD.square
    )
    found = np.ones((scenes.BOARD.rows, scenes.BOARD.cols), dtype=np.bool_)
    by_corners = LatticePriors(found).estimate_geometry(uv)
    np.testing.assert_allclose(steps, by_corners[0], atol=0.02)
    np.testing.assert_allclose(kappa, by_corners[1], atol=2e-5)
    assert abs(kappa).max() > 2e-4

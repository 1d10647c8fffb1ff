"""Contributions to the residuals against what was put into the views."""

from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.residuals.error_sources import ErrorSources, separate_error_sources
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Cost
from tests.engine.scenes import BOARD, VGA, barrel, scene, uneven

XY = BOARD.points()
NOISE = 0.1
SCENE = scene(barrel(), 20, seed=3)


def _exact(rms_of_views: float = 0.0, seed: int = 0) -> list[Array]:
    """Corners (n, 2) of every view, each with a smooth displacement of its own, px rms."""
    rng = np.random.default_rng(seed)
    x, y = ((XY - XY.mean(axis=0)) / (np.ptp(XY, axis=0) / 2)).T
    images = []
    for view in SCENE.views:
        shift = rng.normal(size=(2, 3)) @ np.stack([x * x, x * y, y * y])
        shift -= shift.mean(axis=1, keepdims=True)
        shift *= rms_of_views / max(float(np.sqrt(np.mean(np.sum(shift**2, axis=0)))), 1e-300)
        images.append(view.uv + shift.T)
    return images


def _noisy(images: list[Array], seed: int = 1) -> list[Observation]:
    rng = np.random.default_rng(seed)
    return [Observation(uv + rng.normal(scale=NOISE, size=uv.shape), XY) for uv in images]


def _check_sum(sources: ErrorSources) -> None:
    rms, *parts, _ = astuple(sources)
    assert rms**2 == pytest.approx(sum(part**2 for part in parts), rel=1e-9)


def test_noise_alone_is_noise() -> None:
    views = _noisy(_exact())
    sources = separate_error_sources(calibrate(views, VGA), views)
    assert sources == ErrorSources(sources.rms, 0.0, 0.0, 0.0, sources.rms, False)
    assert sources.rms == pytest.approx(NOISE * np.sqrt(2), rel=0.05)


def test_a_lens_error_is_that_of_views_without_noise() -> None:
    exact = [Observation(uv, XY) for uv in _exact()]
    expected = calibrate(exact, VGA, model="pinhole", model_errors=False)
    views = _noisy(_exact())
    sources = separate_error_sources(calibrate(views, VGA, model="pinhole"), views)
    assert sources.is_lens_at_fault
    rms = np.sqrt(np.mean([view.rms**2 for view in expected.residuals]))
    assert sources.lens == pytest.approx(rms, rel=0.02)
    assert sources.noise == pytest.approx(NOISE * np.sqrt(2), rel=0.2)
    assert sources.board < 0.1 * rms
    _check_sum(sources)


def test_a_rough_board_is_the_boards() -> None:
    deviation = 0.2
    views = uneven(barrel(), BOARD, 20, deviation)
    calibration = calibrate(views, VGA)
    sources = separate_error_sources(calibration, views)
    # A deviation of the board is magnified to the image by focal length over distance.
    distance = np.mean([pose.tvec[2] for pose in calibration.poses])
    expected = np.sqrt(2) * deviation * calibration.camera.focal[0] / distance
    assert sources.board == pytest.approx(expected, rel=0.2)
    assert sources.noise == pytest.approx(NOISE * np.sqrt(2), rel=0.1)
    assert not sources.is_lens_at_fault
    assert sources.lens < 0.1 * sources.board
    _check_sum(sources)


def test_displacements_of_single_views_are_the_views() -> None:
    views = _noisy(_exact(0.3))
    sources = separate_error_sources(calibrate(views, VGA), views)
    # The poses take a part of a quadratic displacement, and noise is left as it was.
    assert 0.5 * 0.3 < sources.views < 0.3
    assert sources.noise == pytest.approx(NOISE * np.sqrt(2), rel=0.1)
    assert sources.lens < sources.views
    assert sources.board < 0.5 * sources.views
    assert not sources.is_lens_at_fault
    _check_sum(sources)


def test_a_shape_that_was_estimated_contributes_nothing_more() -> None:
    views = uneven(barrel(), BOARD, 20, 0.2)
    sources = separate_error_sources(calibrate(views, VGA, board_shape="free"), views)
    assert sources.board == 0
    assert sources.noise == pytest.approx(NOISE * np.sqrt(2), rel=0.1)


@pytest.mark.parametrize("cost", list(Cost))
def test_every_cost_can_be_examined(cost: Cost) -> None:
    views = _noisy(_exact())
    sources = separate_error_sources(calibrate(views, VGA, cost=cost), views)
    assert sources.noise == pytest.approx(NOISE * np.sqrt(2), rel=0.05)
    assert not sources.is_lens_at_fault


def test_two_views_of_few_corners_tell_nothing_but_their_rms() -> None:
    views = [v._replace(uv=v.uv[::9], xy=v.xy[::9]) for v in _noisy(_exact())[:3]]
    sources = separate_error_sources(calibrate(views, VGA, fix=["k2", "k3", "p1", "p2"]), views)
    assert sources.noise == sources.rms
    assert not sources.is_lens_at_fault

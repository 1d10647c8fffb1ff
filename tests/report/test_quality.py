"""What the tables and sentences about trust say, and the figures that go with them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.choices.board_shape_choice import choose_board_shape
from calibgui.engine.assessment.choices.cross_validation import (
    Bootstrap,
    bootstrap_views,
    cross_validate,
)
from calibgui.engine.assessment.finding import find_explanation
from calibgui.engine.assessment.residuals.residual_checks import check_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.uncertainty import QUANTITIES
from calibgui.engine.uncertainty.number_of_views import ViewCountStudy, study_number_of_views
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty
from calibgui.report import quality, quality_figures
from tests.engine.scenes import barrel, scene

Calibrated = tuple[Calibration, list[Observation]]


@pytest.fixture(scope="module")
def calibrated() -> Calibrated:
    views = scene(barrel(), 8, seed=1).noisy(0.2, np.random.default_rng(2))
    return calibrate(views, barrel().size), views


def test_tables_fit_a_terminal(calibrated: Calibrated) -> None:
    result, views = calibrated
    size = barrel().size
    texts = [
        quality.tabulate_projection_uncertainty(
            estimate_projection_uncertainty(result, views, 500.0), 0.1
        ),
        quality.tabulate_noise_report(check_residuals(result, views), None),
        quality.tabulate_cross_validation(cross_validate(views, size, 4)),
        quality.tabulate_board_shape_choice(choose_board_shape(views, size)),
        quality.tabulate_bootstrap(bootstrap_views(views, size, 12), result),
        quality.tabulate_camera_difference(compare_cameras(barrel(), result.camera, 500.0), 0.1),
        quality.tabulate_number_of_views(study_number_of_views(result, views, solved=4), 0.5),
    ]
    for text in texts:
        assert max(map(len, text.splitlines())) <= 80, text
    assert "verdict's error of a pixel is another" in texts[0]
    assert "Nothing speaks against" in texts[1]


def test_the_cause_of_residuals_is_that_of_the_findings() -> None:
    views = scene(barrel(), 8, seed=1).noisy(0.2, np.random.default_rng(2))
    errors = np.random.default_rng(3).normal(scale=8.0, size=views[3].uv.shape)
    views[3] = Observation(views[3].uv + errors, views[3].xy)
    result = calibrate(views, barrel().size)
    report = check_residuals(result, views)
    finding = find_explanation(list_findings(result, views))
    assert finding is not None
    text = quality.tabulate_noise_report(report, finding)
    assert "NOT noise" in text
    assert "Corners are not where the others say, in View 4" in text
    assert "rolling shutter" not in text
    assert "no cause" in quality.tabulate_noise_report(report, None)


def test_a_held_parameter_is_not_resampled(calibrated: Calibrated) -> None:
    _, views = calibrated
    result = calibrate(views, barrel().size, fix=["cx", "cy"])
    text = quality.tabulate_bootstrap(
        bootstrap_views(views, barrel().size, 12, fix=["cx", "cy"]), result
    )
    assert "fx" in text
    assert "cx" not in text


def test_views_that_scatter_too_much_are_named(calibrated: Calibrated) -> None:
    result, _ = calibrated
    params = np.array([result.camera.params])
    for factor, said in ((1.0, "no more than is reported"), (3.0, "scatter 3.0 times as much")):
        ratio = np.where(result.sigma > 0, factor, np.nan)
        found = Bootstrap(params, factor * result.sigma, ratio, 0)
        assert said in quality.tabulate_bootstrap(found, result)


def test_a_value_that_scatters_alone_is_named(calibrated: Calibrated) -> None:
    result, _ = calibrated
    ratio = np.where(result.sigma > 0, 1.0, np.nan)
    ratio[0] = 10.0
    found = Bootstrap(np.array([result.camera.params]), ratio * result.sigma, ratio, 0)
    for poses, said in ((result.poses[:5], "more, but draws"), (2 * result.poses, "more: believe")):
        text = quality.tabulate_bootstrap(found, replace(result, poses=poses))
        assert f"reported. fx scatter {said}" in text


@pytest.mark.parametrize(("counts", "first"), [((3, 4, 5), 3), ((3, 6, 10), 6)])
def test_the_scatter_is_told_of_two_numbers_of_views(counts: tuple[int, ...], first: int) -> None:
    n = len(counts)
    study = SimpleNamespace(
        counts=np.array(counts),
        scatter=np.outer(1 / np.sqrt(counts), np.ones(len(QUANTITIES))),
        random=np.full((n, 3, len(QUANTITIES)), 178.8),
        find_sufficient_count=lambda *_: None,
    )
    *known, scatter = quality.describe_number_of_views(cast(ViewCountStudy, study), 0.5)
    assert all("180 px from all" in text for text in known)
    assert f"sets of {first} and " in scatter and f"sets of {counts[-1]}, falling" in scatter


def test_a_difference_of_unknown_uncertainty_says_so(calibrated: Calibrated) -> None:
    found = compare_cameras(barrel(), calibrated[0].camera)
    assert "explain is not known" in quality.tabulate_camera_difference(found, None)
    assert "not known" not in quality.tabulate_camera_difference(found, found.median)


def _count(scatter: float) -> ViewCountStudy:
    counts = np.arange(2, 17)
    sigma = np.repeat((2 / np.sqrt(counts))[:, None], 3, axis=1)
    return ViewCountStudy(
        counts=counts,
        random=np.stack([sigma, sigma, sigma], axis=1),
        chosen=0.5 * sigma,
        sets=(),
        scatter=np.repeat(4.0 * counts[:, None] ** scatter, 2, axis=1),
    )


def test_sentences_about_the_number_of_views() -> None:
    said = quality.describe_number_of_views(_count(-0.5), 0.8)
    assert "known to 0.8 px from 7 random views, or 2 well-chosen ones" in said[0]
    assert "to 0.5 px from all 16" in said[0]
    assert "1.6 px between sets of 6 and 1 px between sets of 16" in said[3]
    assert "no number is special" in said[3]
    assert "no number is special" not in quality.describe_number_of_views(_count(-1.5), 0.8)[3]
    assert (
        "is not known to 0.1 px: 0.50 px from all 16 views"
        in quality.describe_number_of_views(_count(-1.0), 0.1)[0]
    )


def test_figures_can_be_drawn(calibrated: Calibrated) -> None:
    result, views = calibrated
    found = estimate_projection_uncertainty(result, views)
    assert quality_figures.draw_projection_uncertainty(found, views, found.median).axes
    region = compare_cameras(barrel(), result.camera, views=views)
    assert quality_figures.draw_camera_difference(region).axes
    assert quality_figures.draw_camera_difference(compare_cameras(barrel(), barrel())).axes
    assert len(quality_figures.draw_number_of_views(_count(-0.5), 0.5).axes) == 3

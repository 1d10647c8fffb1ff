"""A shear of all images is told from a lens and from a sheared print."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.action import ActionKind
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import (
    judge_together,
    multiply_by_skew,
    prepare_fit,
)
from calibgui.engine.assessment.verdict import Grade, judge_calibration
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import VGA, brown, looking, scene, seen
from tests.faults.campaign import inject_fault

_SHEAR = 0.005


def shear_images(count: int) -> list[Observation]:
    """Return views whose rows are shifted sideways by 2.4 px from the first to the last."""
    views = scene(brown(), count, seed=3).noisy(0.1, np.random.default_rng(1))
    return [Observation(v.uv + v.uv[:, 1:] * [_SHEAR, 0.0], v.xy) for v in views]


def test_sheared_images_are_no_lens_and_mended_by_a_skew() -> None:
    views = shear_images(12)
    verdict = judge_calibration(calibrate(views, VGA), views)
    assert verdict.grade is Grade.CAN_BE_BETTER
    (finding,) = verdict.findings
    assert finding.cause is Cause.SHEARED_IMAGES
    assert finding.action is not None
    assert finding.action.kind is ActionKind.ESTIMATE_SKEW
    assert finding.times_better > 5
    assert f"{np.degrees(_SHEAR):.2g} degrees" in finding.evidence
    mended = calibrate(views, VGA, model=finding.action.model, free=finding.action.parameters)
    assert list_findings(mended, views) == ()
    truth: Camera = brown()
    assert np.abs(mended.camera.params[:2] - truth.params[:2]).max() < 1.0


def test_what_a_skew_explains_is_what_a_fit_with_it_finds() -> None:
    views = scene(brown(), 8, seed=3).noisy(0.2, np.random.default_rng(1))
    views = [Observation(v.uv + v.uv[:, 1:] * [0.0005, 0.0], v.xy) for v in views]
    held = calibrate(views, VGA, model="brown-conrady", model_errors=False)
    freed = calibrate(views, VGA, model="brown-conrady", free=["skew"], model_errors=False)
    before, after = (summarise_residuals(each.residuals).rms for each in (held, freed))
    share = judge_together(multiply_by_skew(prepare_fit(held, views))).share
    by_noise = 1 / (2 * sum(len(view.uv) for view in views))  # which the share is counted beyond
    assert share + by_noise == pytest.approx(1 - (after / before) ** 2, rel=0.03)
    again = judge_together(multiply_by_skew(prepare_fit(freed, views)))
    assert again.share == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(("name", "seed"), [("affine-print", 15), ("affine-print", 19)])
def test_a_sheared_print_stays_the_board(name: str, seed: int) -> None:
    made = inject_fault(name, seed)
    (finding,) = list_findings(calibrate(made.views, made.size), made.views)
    assert finding.cause is Cause.BOARD_SHAPE


def test_a_faint_shear_in_few_views_is_no_board() -> None:
    made = inject_fault("sheared-images", 26)
    (finding,) = list_findings(calibrate(made.views, made.size), made.views)
    assert finding.cause is Cause.SHEARED_IMAGES


@pytest.mark.parametrize("is_board", [False, True])
def test_few_upright_views_leave_open_whether_board_or_images_are_sheared(is_board: bool) -> None:
    camera, rng = brown(), np.random.default_rng(1)
    poses = [looking(camera, rng, (10, 20), roll=1.0) for _ in range(5)]
    views = seen(camera, poses).noisy(0.1, rng)
    of_image, of_board = (0.0, 1e-3) if is_board else (1e-3, 0.0)
    sheared = [
        Observation(v.uv + v.uv[:, 1:] * [of_image, 0.0], v.xy - v.xy[:, 1:] * [of_board, 0.0])
        for v in views
    ]
    (finding,) = list_findings(calibrate(sheared, VGA), sheared)
    assert finding.cause is Cause.DISAGREEMENT
    assert finding.message.startswith("Either all images or the board are sheared")

"""A roll that all images share is told from a decentred lens where it can be."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.assessment.verdict import Verdict, judge_calibration
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import VGA, barrel
from tests.faults.faults_of_cameras import make_roll
from tests.faults.sets import draw_rendered_set, photograph

_CENTRED = Camera(VGA, [700.0, 700.0, 318.0, 243.0], "pinhole")


def judge(camera: Camera, degrees: float | Array, **settings: str) -> tuple[Verdict, float]:
    """Judge a set whose rows are rolled; return the verdict and the true error, px."""
    photographed = draw_rendered_set(np.random.default_rng([0, 10]), camera)
    views = photograph(photographed, shift=make_roll(camera, degrees))
    found = calibrate(views, VGA, **settings)  # type: ignore[arg-type]
    true = compare_cameras(camera, found.camera, views=views).rms
    return judge_calibration(found, views), true


@pytest.mark.parametrize(
    ("camera", "degrees", "model"),
    [(barrel(), 1.0, "lucchese"), (_CENTRED, -1.0, "lucchese"), (_CENTRED, 1.0, "kannala-brandt")],
)
def test_a_roll_of_all_images_is_named_and_its_error_stated(
    camera: Camera, degrees: float, model: str
) -> None:
    verdict, true = judge(camera, degrees, model=model)
    (finding,) = verdict.findings
    assert finding.cause is Cause.ROLLED_IMAGES
    assert finding.message.startswith("The camera rolled alike")
    assert "roll of 1" in finding.evidence or "roll of 0.9" in finding.evidence
    assert true > 0.5
    assert 0.9 * true < verdict.error.covered < 1.7 * true


def test_a_small_roll_is_either_that_or_a_decentred_lens() -> None:
    verdict, true = judge(_CENTRED, 0.3)
    (finding,) = verdict.findings
    assert finding.message.startswith("Either the lens is decentred")
    assert verdict.error.covered == pytest.approx(true, rel=0.5)


def test_a_decentred_lens_whose_views_tell_is_no_roll() -> None:
    lens = [814.0, 814.0, 335.0, 243.0, -0.29, 0.05, 0.0, 5e-3, 0.0]
    assert judge(Camera(VGA, lens, "brown-conrady"), 0.0, model="brown-conrady")[0].findings == ()


def test_rolls_that_differ_and_have_a_mean_are_a_motion_with_the_error_of_both() -> None:
    degrees = 1 + np.random.default_rng(5).normal(0, 0.2, 30)
    verdict, true = judge(barrel(), degrees)
    (finding,) = verdict.findings
    assert finding.cause is Cause.ROLLING_SHUTTER
    assert true / 2 < verdict.error.covered < 2 * true

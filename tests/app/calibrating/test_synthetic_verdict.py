"""The synthetic check with noise passes for the right model, and fails for a wrong one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui import engine
from calibgui.app.calibrating.synthetic import (
    SyntheticCheck,
    measure_corner_noise,
    run_synthetic_check,
)
from calibgui.app.calibrating.synthetic_verdict import (
    describe_synthetic_verdict,
    judge_synthetic_check,
)
from calibgui.dataset import Result
from tests.app.rendered import CAMERA, small_result

pytestmark = pytest.mark.usefixtures("search_here")

NOISE = 0.05
"""Of the corners of `small_result`, px."""


@pytest.fixture(scope="module")
def result() -> Result:
    return small_result()


@pytest.fixture(scope="module")
def check(result: Result) -> SyntheticCheck:
    return run_synthetic_check(result, corner_noise=measure_corner_noise(result))


def test_the_noise_that_was_added_is_measured(result: Result) -> None:
    assert measure_corner_noise(result) == pytest.approx(NOISE, rel=0.1)


def test_the_rendered_corners_have_that_noise(check: SyntheticCheck, result: Result) -> None:
    rms = [
        engine.summarise_residuals(r.calibration.residuals).rms for r in (result, check.synthetic)
    ]
    assert rms[1] == pytest.approx(rms[0], rel=0.1)
    again = run_synthetic_check(result, corner_noise=check.noise)
    np.testing.assert_array_equal(  # the noise is always the same
        again.synthetic.calibration.camera.params, check.synthetic.calibration.camera.params
    )


def test_the_right_model_passes(check: SyntheticCheck) -> None:
    verdict = judge_synthetic_check(check)
    assert verdict.is_method_right and verdict.is_model_right
    assert verdict.worst_sigmas < 4
    words = describe_synthetic_verdict(check, verdict)
    assert words.startswith("Passed") and f"{check.noise:.3f} px of noise" in words


def test_a_lens_model_that_does_not_fit_fails(result: Result) -> None:
    """The views have distortion (k1 = 0.2), and are calibrated without."""
    calibration = engine.calibrate(result.observations(), CAMERA.size, model="pinhole")
    wrong = replace(result, calibration=calibration)
    check = run_synthetic_check(wrong, corner_noise=measure_corner_noise(wrong))
    verdict = judge_synthetic_check(check)
    assert verdict.is_method_right and not verdict.is_model_right
    words = describe_synthetic_verdict(check, verdict)
    assert words.startswith("Failed: the real residuals are") and "The method passed" in words


def test_a_method_that_misses_the_camera_fails(check: SyntheticCheck) -> None:
    found = check.synthetic.calibration
    params = found.camera.params.copy()
    params[0] += 8 * found.sigma[0]
    off = replace(found, camera=replace(found.camera, params=params))
    missed = replace(check, synthetic=replace(check.synthetic, calibration=off))
    verdict = judge_synthetic_check(missed)
    assert not verdict.is_method_right and verdict.worst_name == "fx"
    assert describe_synthetic_verdict(missed, verdict).startswith("Failed: from pictures")


def test_standard_deviations_that_are_too_small_fail(check: SyntheticCheck) -> None:
    found = check.synthetic.calibration
    proud = replace(found, sigma=found.sigma / 6, covariance=found.covariance / 36)
    claimed = replace(check, synthetic=replace(check.synthetic, calibration=proud))
    assert not judge_synthetic_check(claimed).is_method_right

"""A length that is stated scales the results, their verdicts and what was said of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.projects.lengths import set_square, set_square_sigma
from calibgui.app.projects.project import record_result
from calibgui.dataset.judging import judge_result, keep_verdict, recall_verdict
from calibgui.engine.assessment import Cause, Finding
from calibgui.engine.boards import BoardShapePrior
from calibgui.engine.errors import CalibrationError
from tests.app import examples


def test_a_stated_length_scales_results_that_stay_current(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    before = project.results["k3 held"]
    before = replace(before, improvements=("The board is not flat (0.50 mm).",))
    project = record_result(project, "k3 held", project.views, before)
    after = set_square(project, 45.0)
    result = after.results["k3 held"]
    assert after.is_current(result) and result.condition == ""
    assert result.board is not None and result.board.square == 45.0
    assert result.calibration.camera is before.calibration.camera
    for a, b in zip(result.calibration.poses, before.calibration.poses, strict=True):
        np.testing.assert_allclose(a.tvec, 1.5 * b.tvec)
    assert result.improvements == ("The board is not flat (0.75 mm).",)


def test_the_verdict_is_scaled_with_its_result(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    before = project.results["Calibration 1"]
    finding = Finding(Cause.BLUR, "3 of 6", "Off by 0.2 mm, 0.3 px.", "Take it again.", 0.1)
    verdict = replace(judge_result(before), findings=(finding,))
    keep_verdict(before, verdict)
    scaled = recall_verdict(set_square(project, 60.0).results["Calibration 1"])
    assert scaled is not None
    assert scaled.distance == pytest.approx(2 * verdict.distance)
    assert scaled.mm_per_pixel == pytest.approx(2 * verdict.mm_per_pixel)
    assert scaled.error is verdict.error
    assert scaled.findings[0].evidence == "Off by 0.4 mm, 0.3 px."


def test_results_of_other_lengths_stay_as_they_are(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    twice = set_square(set_square(project, 60.0), 60.0)
    assert twice.results["k3 held"].board == twice.board
    result = project.results["k3 held"]
    told = replace(result.calibration.settings, prior=BoardShapePrior(0.1, 0.3))
    told_result = replace(result, calibration=replace(result.calibration, settings=told))
    project = record_result(project, "told", project.views, told_result)
    after = set_square(project, 60.0)
    assert after.results["told"] is project.results["told"]
    assert not after.is_current(after.results["told"])


def test_how_uncertain_squares_are_is_stated_of_results_too(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    before = project.results["Calibration 1"]
    keep_verdict(before, judge_result(before))
    after = set_square_sigma(project, 0.06)
    result = after.results["Calibration 1"]
    assert after.is_current(result) and result.scale_sigma == pytest.approx(0.002)
    assert recall_verdict(result) is recall_verdict(before)
    k = 0
    added = result.pose_covariances[k] - before.calibration.pose_covariances[k]
    tvec = before.calibration.poses[k].tvec
    np.testing.assert_allclose(added[3:, 3:], 0.002**2 * np.outer(tvec, tvec), rtol=1e-6)
    np.testing.assert_allclose(added[:3], 0.0, atol=1e-12)
    longer = set_square(after, 60.0)
    assert longer.square_sigma == 0.06 and longer.board is not None
    assert longer.results["Calibration 1"].board == longer.board
    assert set_square(after, 0.05).square_sigma == 0.0
    with pytest.raises(CalibrationError, match="cannot be uncertain by 31 mm"):
        set_square_sigma(project, 31.0)

"""Residuals are the engine's; points, bars and the threshold lead to their views."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import cast

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.assessment.residuals.residual_checks import NoiseReport, check_residuals
from calibgui.engine.assessment.residuals.residual_statistics import (
    stack_residuals,
    summarise_residuals,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.evidence import residuals
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.window.progress import Progress
from calibgui.report.quality import tabulate_noise_report
from tests.gui.panels.conftest import Shown, click, made

Show = Callable[[Result], ResidualsPanel]


@pytest.fixture
def show(shown: Shown[ResidualsPanel], monkeypatch: pytest.MonkeyPatch) -> Show:
    """Shows a result; what the residuals look like takes long, and is left to one test."""
    monkeypatch.setattr(residuals, "check_residuals", lambda *_: NoiseReport(()))
    return lambda result: shown(ResidualsPanel, result)


def drawn(panel: ResidualsPanel) -> Array:
    """All points on the plot, in order of x."""
    points = np.transpose(panel.scatter._cloud.getData())
    return points[np.lexsort(points.T)]


@pytest.mark.parametrize("on_reference", [False, True])
def test_scatter_holds_every_residual(
    show: Show, result: Result, qtbot: QtBot, on_reference: bool
) -> None:
    panel = show(result)
    if on_reference:
        panel.plane.setFocus()
        qtbot.keyClick(panel.plane, Qt.Key.Key_Down)
    expected = stack_residuals(result.calibration, on_reference)
    np.testing.assert_array_equal(drawn(panel), expected[np.lexsort(expected.T)])
    summary = summarise_residuals(result.calibration.residuals)
    title = panel.scatter.area.title.text
    value = summary.reference_mean if on_reference else summary.sigma_x
    assert f"{value:.3f}" in title


def test_a_point_picks_its_corner(show: Show, result: Result, qtbot: QtBot) -> None:
    panel = show(result)
    # The point that lies farthest out has no neighbour to be mistaken for.
    lengths = [np.linalg.norm(v.image, axis=1) for v in result.calibration.residuals]
    k = int(np.argmax([length.max() for length in lengths]))
    corner = int(np.argmax(lengths[k]))
    with qtbot.waitSignal(panel.picked) as signal:
        click(qtbot, panel.scatter, *result.calibration.residuals[k].image[corner])
    assert result.views[signal.args[0]] is result.used[k]
    assert signal.args[1] == corner


def test_a_click_beside_the_points_picks_nothing(show: Show, result: Result, qtbot: QtBot) -> None:
    panel = show(result)
    with qtbot.assertNotEmitted(panel.picked, wait=50):
        box = panel.scatter.box.viewRect()
        click(
            qtbot, panel.scatter, box.left() + 0.02 * box.width(), box.top() + 0.02 * box.height()
        )


def test_selection_is_highlighted(show: Show, result: Result) -> None:
    panel = show(result)
    panel.select(6, 17)
    image = result.calibration.residuals[5].image
    np.testing.assert_array_equal(np.transpose(panel.scatter._view.getData()), image)
    np.testing.assert_array_equal(np.transpose(panel.scatter._ring.getData()), image[17:18])
    panel.select(1)  # an image that was not used
    assert len(panel.scatter._view.getData()[0]) == 0


def disturb(result: Result, view: int, sigma: float) -> Result:
    """The result with random errors of `sigma` px added to the corners of one view."""
    views = list(result.views)
    corners = views[view].corners
    assert corners is not None
    errors = np.random.default_rng(1).normal(scale=sigma, size=corners.uv.shape)
    views[view] = replace(views[view], corners=replace(corners, uv=corners.uv + errors))
    assert result.board is not None
    seen = [each.observation(result.board) for each in views if each.usable]
    return Result(calibrate(seen, result.calibration.camera.size), tuple(views), result.board)


@pytest.mark.parametrize(
    ("disturbed", "cause"),
    [
        (lambda _: made(bow=0.6), Cause.BOARD_SHAPE),
        (lambda sound: disturb(sound, 3, 8.0), Cause.MISPLACED_CORNERS),
        (lambda _: made(bow=0.06), None),
    ],
    ids=["bowed board", "one view of 8 px", "harmless bow"],
)
def test_the_cause_of_residuals_is_that_of_the_verdict(
    shown: Shown[ResidualsPanel],
    result: Result,
    jobs: Jobs,
    qtbot: QtBot,
    disturbed: Callable[[Result], Result],
    cause: Cause | None,
) -> None:
    found = disturbed(result)
    panel = shown(ResidualsPanel, found)
    assert "Working" in panel.verdict.text()
    qtbot.waitUntil(lambda: not jobs.running, timeout=60_000)
    text = panel.verdict.text()
    assert text.startswith("The residuals are not just noise")
    report = check_residuals(found.calibration, found.observations(), shorten_names(found.used))
    failed = [check for check in report.checks if not check.passed]
    assert failed
    assert not any(check.advice in text for check in failed), "tests blame any cause"
    assert all(check.name in panel.verdict.toolTip() for check in report.checks)
    assert "Why is being tried" in text
    findings = judge_result(found).findings
    panel.note_verdict()
    text = panel.verdict.text()
    assert [finding.cause for finding in findings[:1]] == [cause] * (cause is not None)
    if findings:
        assert findings[0].message in text
        assert findings[0].remedy in text
    else:
        assert "no cause" in text
    panel.plane.setCurrentIndex(1)
    assert not jobs.running, "another plane asks nothing new"


def test_noise_is_called_noise(show: Show, result: Result, jobs: Jobs, qtbot: QtBot) -> None:
    panel = show(result)
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.verdict.text().startswith("The residuals look like noise")


def test_uncertain_corners_far_off_are_counted(
    show: Show, result: Result, jobs: Jobs, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    report = NoiseReport((), far_corners=7, far_views=1)
    monkeypatch.setattr(residuals, "check_residuals", lambda *_: report)
    panel = show(result)
    qtbot.waitUntil(lambda: not jobs.running)
    assert "Beyond 5 σ: 7 corners in 1 view, each within" in panel.verdict.text()
    assert "Beyond 5 sigma: 7 corners in 1 view" in " ".join(
        tabulate_noise_report(report, None).split()
    )


def test_the_user_need_not_wait_for_the_verdict(
    shown: Shown[ResidualsPanel],
    result: Result,
    jobs: Jobs,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def endless(*_: object) -> NoiseReport:
        progress = cast(Callable[[int, int], None], _[-1])
        while True:
            progress(0, 6)
            time.sleep(0.001)

    monkeypatch.setattr(residuals, "check_residuals", endless)
    panel = shown(ResidualsPanel, result)
    bar = Progress(jobs)
    qtbot.addWidget(bar)
    bar.cancel.click()
    qtbot.waitUntil(lambda: not jobs.running)
    assert "not examined" in panel.verdict.text()
    monkeypatch.setattr(residuals, "check_residuals", check_residuals)
    panel.plane.setCurrentIndex(1)
    qtbot.waitUntil(lambda: not jobs.running, timeout=60_000)
    assert panel.verdict.text().startswith("The residuals look like noise")

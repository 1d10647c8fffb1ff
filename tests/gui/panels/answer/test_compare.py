"""Two results side by side, against the engine's numbers and against undistortion by itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from calibgui.app.outputs.previews import undistort_alike
from calibgui.dataset import Result
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.reading import Image
from calibgui.engine.images.rendering import render_view
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.answer.compare import ComparePanel
from calibgui.gui.panels.services import Services
from calibgui.report.comparison import compare_parameters
from tests.engine import scenes
from tests.gui.panels.conftest import made, read_table

WAIT = 30_000


def photograph(result: Result) -> Image:
    """Stand in for the photograph of the first view."""
    camera, pose = result.calibration.camera, result.calibration.poses[0]
    return Image(render_view(camera, pose, scenes.BOARD), Path("view1.png"))


@pytest.fixture
def panel(result: Result, other: Result, jobs: Jobs, qtbot: QtBot) -> ComparePanel:
    panel = ComparePanel(Services(jobs, lambda _: photograph(result)))
    qtbot.addWidget(panel)
    panel.resize(560, 620)
    panel.offer_results({"first": result, "second": other})
    panel.show_result(other)
    panel.show()
    qtbot.waitUntil(lambda: not jobs.running, timeout=WAIT)
    return panel


def test_the_shown_result_stands_beside_the_one_before(
    panel: ComparePanel, result: Result, other: Result
) -> None:
    assert panel.names == ("first", "second")
    table = read_table(panel.parameters)
    changes = compare_parameters(result.calibration, other.calibration)
    for row, change in zip(table, changes, strict=True):
        assert float(row["Difference"]) == change.change
        assert float(row["in σ"]) == pytest.approx(change.sigmas, nan_ok=True)
    assert {"first ± 1σ", "second ± 1σ"} <= table[0].keys()


def test_the_map_is_the_cameras_difference_in_px(
    panel: ComparePanel, result: Result, other: Result
) -> None:
    expected = compare_cameras(
        result.calibration.camera, other.calibration.camera, views=other.observations()
    )
    np.testing.assert_array_equal(panel.map.plot.image.image, expected.length)
    assert f"{format_two_digits(expected.worst)} px apart" in panel.words.text()
    assert f"{format_two_digits(expected.rms)} px RMS" in panel.words.text()


def test_any_two_results_can_be_chosen(
    panel: ComparePanel, result: Result, other: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    third = made(seed=9)
    panel.offer_results({"first": result, "second": other, "third": third})
    assert panel.names == ("first", "second")  # what was chosen stays
    panel.compare("third", "first")
    qtbot.waitUntil(lambda: not jobs.running, timeout=WAIT)
    row = read_table(panel.parameters)[0]
    fx = result.calibration.camera.params[0] - third.calibration.camera.params[0]
    assert float(row["Difference"]) == fx
    panel.offer_results({"first": result, "again": other})
    assert set(panel.names) == {"first", "again"}


def test_one_result_alone_says_what_to_do(result: Result, services: Services, qtbot: QtBot) -> None:
    panel = ComparePanel(services)
    qtbot.addWidget(panel)
    panel.offer_results({"first": result})
    panel.show_result(result)
    panel.show()
    assert "Calibrate again" in panel._empty.text()


def test_results_of_two_sizes_say_why_there_is_no_map(
    panel: ComparePanel, result: Result, other: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    camera = result.calibration.camera
    smaller = Camera((320, 240), camera.params, camera.model)
    calibration = replace(result.calibration, camera=smaller)
    panel.offer_results({"small": replace(result, calibration=calibration), "second": other})
    panel.compare("small", "second")
    qtbot.waitUntil(lambda: not jobs.running, timeout=WAIT)
    assert "different sizes" in panel.words.text()


def test_the_split_image_follows_the_choice(panel: ComparePanel, jobs: Jobs, qtbot: QtBot) -> None:
    panel.tabs.setCurrentWidget(panel.images)
    qtbot.waitUntil(lambda: not jobs.running and len(panel.images._images) == 2, timeout=WAIT)
    assert panel.images._names == ("first", "second")
    assert panel.images._images[0].size() == panel.images._images[1].size()


def test_both_halves_show_the_same_directions(result: Result) -> None:
    """A principal point 8 px off looks like a turn of the camera, which the halves make up for."""
    grey = photograph(result)
    camera = result.calibration.camera
    shifted = replace(camera, params=camera.params + np.array([0, 0, 8, -5] + [0] * 6))
    other = replace(result, calibration=replace(result.calibration, camera=shifted))
    turn = compare_cameras(camera, shifted, views=result.observations()).turn

    def miss(by: float) -> float:
        left, right = undistort_alike(result, other, by * turn, "", lambda _: grey)
        return float(np.abs(left.astype(float) - right)[60:-60, 60:-60].mean())

    same = undistort_alike(result, result, np.zeros(3), "", lambda _: grey)
    np.testing.assert_array_equal(*same)
    assert miss(1.0) < 0.2 * miss(0.0) < 0.2 * miss(-1.0)

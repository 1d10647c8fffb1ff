"""Coverage plots hold the report's numbers and lead to the views."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any, NoReturn

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.boards import Circles
from calibgui.engine.calibration.result import Degeneracy, Diagnosis
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty.next_view import NextView, propose_views
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.evidence import coverage
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.report.coverage import measure_attitudes
from tests.gui.panels.conftest import Shown, click


@pytest.fixture(scope="module")
def best(result: Result) -> NextView:
    return propose_views(result.calibration, result.observations(), 1)[0]


@pytest.fixture
def panel(
    shown: Shown[CoveragePanel],
    result: Result,
    best: NextView,
    monkeypatch: pytest.MonkeyPatch,
) -> CoveragePanel:
    """Of the result; the next view, which takes long, is found once."""
    monkeypatch.setattr(coverage, "propose_views", lambda *_: (best,))
    return shown(CoveragePanel, result)


def test_density_counts_the_corners(panel: CoveragePanel, result: Result) -> None:
    counts = panel.density.image.image
    uv = np.concatenate([view.uv for view in result.observations()])
    inside = ((uv >= -0.5) & (uv < [639.5, 479.5])).all(axis=1)
    assert counts.sum() == inside.sum()
    rows, cols = counts.shape
    one = uv[inside][17] + 0.5
    assert counts[int(one[1] / 480 * rows), int(one[0] / 640 * cols)] >= 1


def test_circles_are_called_circles(panel: CoveragePanel, result: Result) -> None:
    assert panel.density.accessibleName() == "corners in a cell"
    board = result.board
    assert board is not None
    panel.show_result(replace(result, board=replace(board, pattern=Circles(False, 0.5))))
    assert panel.density.accessibleName() == "circles in a cell"


def test_tilts_and_distances(panel: CoveragePanel, result: Result) -> None:
    attitude = measure_attitudes(result.calibration, result.observations())
    x, y = panel.tilts._cloud.getData()
    np.testing.assert_allclose(np.hypot(x, y), np.rad2deg(attitude.tilt))
    np.testing.assert_allclose(np.arctan2(y, x), attitude.direction)
    views, distance = panel.distances._cloud.getData()
    np.testing.assert_array_equal(views, np.arange(1, 10))
    np.testing.assert_array_equal(distance, attitude.distance)


def test_points_pick_their_view(panel: CoveragePanel, qtbot: QtBot) -> None:
    for plot in (panel.tilts, panel.distances):
        x, y = plot.points[7]
        with qtbot.waitSignal(panel.picked) as signal:
            click(qtbot, plot, x, y)
        assert signal.args == [8, -1]


def test_selection_is_ringed(panel: CoveragePanel) -> None:
    panel.select(3)
    for plot in (panel.tilts, panel.distances):
        np.testing.assert_array_equal(np.ravel(plot._ring.getData()), plot.points[2])
    panel.select(-1)
    assert len(panel.tilts._ring.getData()[0]) == 0


def test_a_gain_that_two_digits_do_not_show_is_not_said_to_be_one(
    shown: Shown[CoveragePanel],
    result: Result,
    best: NextView,
    jobs: Jobs,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    little = replace(best, before=3.31, after=3.28)
    monkeypatch.setattr(coverage, "propose_views", lambda *_: (little,))
    panel = shown(CoveragePanel, result)
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.advice.text().endswith("It hardly lowers the uncertainty of 3.3 px.")


def test_the_next_view_is_drawn_and_told(
    panel: CoveragePanel, jobs: Jobs, best: NextView, qtbot: QtBot
) -> None:
    qtbot.waitUntil(lambda: not jobs.running)
    np.testing.assert_array_equal(np.transpose(panel.next_corners.getData()), best.corners)
    line = np.transpose(panel.next_board.getData())
    assert (line[0] == line[-1]).all()
    assert (line.min(axis=0) == best.corners.min(axis=0)).all()
    assert best.instruction in panel.advice.text()
    assert f"to {format_two_digits(best.after)} px" in panel.advice.text()


def test_what_determines_the_camera_is_told_where_views_do_not(
    panel: CoveragePanel, result: Result, jobs: Jobs, best: NextView, qtbot: QtBot
) -> None:
    diagnosis = Diagnosis(Degeneracy.ONE_VIEW, "One view.", "Add two.")
    partial = replace(result, calibration=replace(result.calibration, diagnosis=diagnosis))
    panel.show_result(partial)
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.advice.text() == f"The next view (red): {best.instruction} Add two."


def test_the_map_ends_with_the_image(panel: CoveragePanel, qtbot: QtBot) -> None:
    def ends() -> None:
        (left, right), (low, high) = panel.density.box.viewRange()
        np.testing.assert_allclose([left, right, low, high], [-0.5, 639.5, -0.5, 479.5], atol=8)

    for size in ((900, 650), (400, 700)):
        panel.resize(*size)
        qtbot.waitUntil(ends)


def test_rings_and_their_numbers_are_all_in_view_away_from_the_points(
    panel: CoveragePanel, qtbot: QtBot
) -> None:
    rings = np.transpose(panel.rings.getData())
    at = np.array([[number.pos().x(), number.pos().y()] for number in panel.ring_numbers])
    numbers = [number.toPlainText() for number in panel.ring_numbers]
    assert numbers[:3] == ["15°", "30°", "45°"]
    tilts = np.linalg.norm(panel.tilts.points, axis=1)
    outermost = np.linalg.norm(at[-1])
    assert max(tilts.max(), 45) <= outermost < max(tilts.max() + 15, 46)
    away = np.linalg.norm(at[:, None] - panel.tilts.points, axis=-1)
    assert away.min() > 4

    def ends() -> None:
        for low, high in panel.tilts.box.viewRange():
            assert low < np.nanmin(rings) and np.nanmax(rings) < high
            assert high - low < 2.6 * outermost

    for size in ((440, 600), (900, 650)):
        panel.resize(*size)
        qtbot.waitUntil(ends)


def test_a_condition_on_lengths_leaves_the_height_of_the_distances_as_it_is(
    panel: CoveragePanel, result: Result
) -> None:
    panel.show_result(replace(result, lengths_confirmed=True))
    height = panel.distances.minimumSizeHint().height()
    panel.show_result(replace(result, lengths_confirmed=False))
    assert panel.distances.minimumSizeHint().height() == height
    assert "if squares are 30 mm" in panel.distances.area.bottom.labelText


def test_the_user_need_not_wait_for_the_next_view(
    shown: Shown[CoveragePanel],
    result: Result,
    jobs: Jobs,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def endless(*_: Any) -> NoReturn:
        while True:
            _[-1](0, 100)
            time.sleep(0.001)

    monkeypatch.setattr(coverage, "propose_views", endless)
    panel = shown(CoveragePanel, result)
    for job in jobs.running:
        job.cancel()
    qtbot.waitUntil(lambda: not jobs.running)
    assert "not examined" in panel.advice.text()

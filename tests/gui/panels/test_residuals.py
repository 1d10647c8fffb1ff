"""Residuals are the engine's; points, bars and the threshold lead to their views."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.engine.statistics import stacked, summarise
from calibgui.engine.types import Array
from calibgui.formats.result import Result
from calibgui.gui.panels.residuals import ResidualsPanel
from tests.gui.panels.conftest import Shown, click, drag, made, place


def drawn(panel: ResidualsPanel) -> Array:
    """All points on the plot, in order of x."""
    points = np.concatenate([np.transpose(cloud.getData()) for cloud in panel.scatter._clouds])
    return points[np.lexsort(points.T)]


@pytest.mark.parametrize("on_reference", [False, True])
def test_scatter_holds_every_residual(
    shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot, on_reference: bool
) -> None:
    panel = shown(ResidualsPanel, result)
    if on_reference:
        panel.plane.setFocus()
        qtbot.keyClick(panel.plane, Qt.Key.Key_Down)
    expected = stacked(result.calibration, on_reference)
    np.testing.assert_array_equal(drawn(panel), expected[np.lexsort(expected.T)])
    summary = summarise(result.calibration.residuals)
    title = panel.scatter.getPlotItem().titleLabel.text
    value = summary.reference_mean if on_reference else summary.sigma_x
    assert f"{value:.3f}" in title


def test_a_point_picks_its_corner(
    shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(ResidualsPanel, result)
    # The point that lies farthest out has no neighbour to be mistaken for.
    lengths = [np.linalg.norm(v.image, axis=1) for v in result.calibration.residuals]
    k = int(np.argmax([length.max() for length in lengths]))
    corner = int(np.argmax(lengths[k]))
    with qtbot.waitSignal(panel.picked) as signal:
        click(qtbot, panel.scatter, *result.calibration.residuals[k].image[corner])
    assert result.views[signal.args[0]] is result.used[k]
    assert signal.args[1] == corner


def test_a_click_beside_the_points_picks_nothing(
    shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(ResidualsPanel, result)
    with qtbot.assertNotEmitted(panel.picked, wait=50):
        box = panel.scatter.getPlotItem().getViewBox().viewRect()
        click(
            qtbot, panel.scatter, box.left() + 0.02 * box.width(), box.top() + 0.02 * box.height()
        )


def test_bars_are_the_views_rms(shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(ResidualsPanel, result)
    rms = [view.rms for view in result.calibration.residuals]
    np.testing.assert_array_equal(panel.views._bars.opts["height"], rms)
    assert panel.views._overall.value() == summarise(result.calibration.residuals).rms
    with qtbot.waitSignal(panel.picked) as signal:
        click(qtbot, panel.views.plot, 3, rms[2] / 2)
    assert signal.args == [3, -1]  # the second image has no board


def test_dragging_the_threshold_excludes_the_views_above(
    shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(ResidualsPanel, result)
    views = panel.views
    rms = np.array([view.rms for view in result.calibration.residuals])
    assert views.above == () and not views.exclude.isEnabled()
    second, third = np.sort(rms)[[-2, -3]]
    target = (second + third) / 2
    start, end = (place(views.plot, 4.5, y) for y in (views.line.value(), target))
    drag(qtbot, views.plot.viewport(), start, end)
    worst = sorted(np.argsort(rms)[-2:].tolist())
    assert views.above == tuple(worst)
    assert views.threshold.value() == pytest.approx(target, abs=2e-3)
    with qtbot.waitSignal(panel.excluded) as signal:
        qtbot.mouseClick(views.exclude, Qt.MouseButton.LeftButton)
    assert [result.views[i] for i in signal.args[0]] == [result.used[k] for k in worst]


def test_the_threshold_can_be_typed(
    shown: Shown[ResidualsPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(ResidualsPanel, result)
    panel.views.threshold.setFocus()
    panel.views.threshold.selectAll()
    qtbot.keyClicks(panel.views.threshold, "0")
    qtbot.keyClick(panel.views.threshold, Qt.Key.Key_Return)
    assert panel.views.line.value() == 0.0
    assert len(panel.views.above) == 9
    assert not panel.views.exclude.isEnabled()  # nothing would be left


def test_selection_is_highlighted(shown: Shown[ResidualsPanel], result: Result) -> None:
    panel = shown(ResidualsPanel, result)
    panel.select(6, 17)
    image = result.calibration.residuals[5].image
    np.testing.assert_array_equal(np.transpose(panel.scatter._view.getData()), image)
    np.testing.assert_array_equal(np.transpose(panel.scatter._ring.getData()), image[17:18])
    panel.select(1)  # an image that was not used
    assert len(panel.scatter._view.getData()[0]) == 0


def test_many_views_take_few_items(shown: Shown[ResidualsPanel]) -> None:
    result = made(count=70)
    panel = shown(ResidualsPanel, result)
    assert len(panel.scatter._clouds) <= 56
    assert len(drawn(panel)) == 70 * 108

"""Coverage plots hold the report's numbers and lead to the views."""

from __future__ import annotations

import numpy as np
from pytestqt.qtbot import QtBot

from calibgui.formats.result import Result
from calibgui.gui.panels.coverage import CoveragePanel
from calibgui.report.coverage import attitudes
from tests.gui.panels.conftest import Shown, click


def test_density_counts_the_corners(shown: Shown[CoveragePanel], result: Result) -> None:
    panel = shown(CoveragePanel, result)
    counts = panel.density.image.image
    uv = np.concatenate([view.uv for view in result.observations()])
    inside = ((uv >= -0.5) & (uv < [639.5, 479.5])).all(axis=1)
    assert counts.sum() == inside.sum()
    rows, cols = counts.shape
    one = uv[inside][17] + 0.5
    assert counts[int(one[1] / 480 * rows), int(one[0] / 640 * cols)] >= 1


def test_tilts_and_distances(shown: Shown[CoveragePanel], result: Result) -> None:
    panel = shown(CoveragePanel, result)
    attitude = attitudes(result.calibration, result.observations())
    x, y = panel._points[0].getData()
    np.testing.assert_allclose(np.hypot(x, y), np.rad2deg(attitude.tilt))
    np.testing.assert_allclose(np.arctan2(y, x), attitude.direction)
    views, distance = panel._points[1].getData()
    np.testing.assert_array_equal(views, np.arange(1, 10))
    np.testing.assert_array_equal(distance, attitude.distance)


def test_points_pick_their_view(shown: Shown[CoveragePanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(CoveragePanel, result)
    for plot, points in zip((panel.tilts, panel.distances), panel._points, strict=True):
        x, y = np.transpose(points.getData())[7]
        with qtbot.waitSignal(panel.picked) as signal:
            click(qtbot, plot, x, y)
        assert signal.args == [8, -1]


def test_selection_is_ringed(shown: Shown[CoveragePanel], result: Result) -> None:
    panel = shown(CoveragePanel, result)
    panel.select(3)
    for ring, points in zip(panel._rings, panel._points, strict=True):
        np.testing.assert_array_equal(np.ravel(ring.getData()), np.transpose(points.getData())[2])
    panel.select(-1)
    assert len(panel._rings[0].getData()[0]) == 0

"""What the cursor is over in one place is seen in all others, in the view's colour."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.canvas.layers import trace_hull
from calibgui.gui.images.image_model import Role
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.modes import Mode
from calibgui.gui.widgets.picture import make_qimage
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples


@pytest.fixture
def shown(full: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with poses beside the first image, which is left out, and the second chosen."""
    views = full.session.project.views
    full.need_analysis().show_panel(PosesPanel)
    full.images.follows.setChecked(True)
    full.images.exclude([views[0].image])
    qtbot.waitUntil(
        lambda: (
            full.session.project.is_current(full.session.result) and not full.session.jobs.running
        ),
        timeout=60_000,
    )
    full.session.select(views[1].image)
    qtbot.waitUntil(lambda: not full.session.jobs.running)
    width, height = examples.CAMERA.size
    full.page.canvas.show_image((make_qimage(np.full((height, width), 128, np.uint8)),))
    return full


def point_at(window: MainWindow, row: int, qtbot: QtBot) -> None:
    """Move the cursor onto a thumbnail."""
    strip = window.images.list
    at = strip.visualRect(strip.model().index(row, 0)).center()
    qtbot.mouseMove(strip.viewport(), at - QPoint(3, 3))
    qtbot.mouseMove(strip.viewport(), at)


def leave(window: MainWindow) -> None:
    """Move the cursor off the film strip."""
    for part in (window.images.list.viewport(), window.images.list):
        QApplication.sendEvent(part, QEvent(QEvent.Type.Leave))


def test_every_view_has_one_colour(shown: MainWindow) -> None:
    panel = shown.need_analysis().panel(PosesPanel)
    strip = shown.images.list.model()
    in_strip = {
        strip.index(row, 0).data(Role.PATH): strip.index(row, 0).data(Role.VIEW_COLOUR)
        for row in range(strip.rowCount())
    }
    assert shown.session.result is not None
    used = [view.image for view in shown.session.result.used]
    assert len(used) == 5
    assert [in_strip[image] for image in used] == list(panel.space._colours)


def test_a_photograph_in_the_strip_is_seen_among_the_poses(shown: MainWindow, qtbot: QtBot) -> None:
    panel = shown.need_analysis().show_panel(PosesPanel)
    before = panel.space.grab().toImage()
    point_at(shown, 3, qtbot)
    assert panel.words.text().startswith("3.png: ")
    assert panel.space.grab().toImage() != before
    shown.show_mode(Mode.PHOTOGRAPHS)
    leave(shown)
    assert shown.session.hovered_image == ""
    shown.show_mode(Mode.SPACE)
    assert panel.words.text().startswith("1.png: ")  # the selected one


def test_the_board_in_the_photograph_is_seen_in_the_strip(shown: MainWindow, qtbot: QtBot) -> None:
    canvas, view = shown.page.canvas, shown.session.view
    shown.show_mode(Mode.PHOTOGRAPHS)
    assert view is not None and view.corners is not None
    shown.session.corner = -1
    middle = canvas.to_screen(view.corners.uv.mean(axis=0, keepdims=True))[0]
    qtbot.mouseMove(canvas.viewport(), QPointF(*middle).toPoint())
    assert shown.session.hovered_image == view.image
    assert shown.images.list.hovered == view.image
    qtbot.mouseMove(canvas.viewport(), QPoint(1, 1))
    assert shown.images.list.hovered == ""


def test_a_view_pointed_at_stands_out_in_plots(shown: MainWindow, qtbot: QtBot) -> None:
    result = shown.session.result
    assert result is not None
    analysis = shown.need_analysis()
    residuals, coverage = analysis.panel(ResidualsPanel), analysis.panel(CoveragePanel)
    first, fourth = (result.calibration.residuals[k].image for k in (0, 3))
    for panel, item in ((residuals, residuals.scatter._view), (coverage, coverage.distances._ring)):
        analysis.show_panel(type(panel))
        places = (first, fourth) if panel is residuals else coverage.distances.points[[[0], [3]]]
        for at, points in ((places[1], True), (places[0], False)):
            if points:
                point_at(shown, 4, qtbot)
            else:
                leave(shown)
            np.testing.assert_allclose(np.transpose(item.getData()), at)


def test_a_view_and_its_row_stand_out_together(shown: MainWindow, qtbot: QtBot) -> None:
    panel = shown.need_analysis().show_panel(StageOnePanel)
    QApplication.processEvents()  # it is painted a turn after it was filled
    assert shown.session.result is not None
    used = [view.image for view in shown.session.result.used]
    plain, selected = panel.table.grab().toImage(), panel._current.getData()
    for row, image in ((1, 2), (4, 5)):  # the first image is left out
        point_at(shown, image, qtbot)
        assert panel.table.grab().toImage() != plain
        aspect = shown.session.result.calibration.stage_one[row].aspect
        assert np.ravel(panel._current.getData()).tolist() == [row + 1, aspect]
        leave(shown)
        assert panel.table.grab().toImage() == plain
        np.testing.assert_array_equal(panel._current.getData(), selected)
        cell = panel.table.visualRect(panel.table.model().index(row, 0)).center()
        qtbot.mouseMove(panel.table.viewport(), cell)
        assert shown.images.list.hovered == used[row]
        for part in (panel.table.viewport(), panel.table):
            QApplication.sendEvent(part, QEvent(QEvent.Type.Leave))
        assert shown.images.list.hovered == ""


def test_the_hull_goes_around_the_points() -> None:
    square = np.array([[0.0, 0], [4, 0], [4, 3], [0, 3]])
    points = np.vstack([square, [[1, 1], [2, 0], [3, 2]], square[:1]])
    hull = trace_hull(points)
    assert {tuple(p) for p in hull} == {tuple(p) for p in square}
    x, y = (hull - hull.mean(axis=0)).T
    turns = np.diff(np.unwrap(np.arctan2(y, x)))
    assert (turns > 0).all() or (turns < 0).all()
    assert len(trace_hull(square[:2])) == 2  # no area

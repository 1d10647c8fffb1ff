"""Marking boards by four clicks, one image after the other."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.document import Document
from calibgui.app.project import Project
from calibgui.app.resources import find_resource
from calibgui.dataset import View, ViewStatus
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images.reading import read_image
from calibgui.gui.window.main_window import MainWindow
from tests.gui.hand import Hand, outermost


def test_enter_accepts_and_goes_on_with_the_next_image_that_needs_it(
    window: MainWindow, qtbot: QtBot
) -> None:
    paths = [find_resource("sample") / f"view0{k}.png" for k in (1, 2, 3)]
    found = [find_corners(read_image(path).grey) for path in paths]
    nothing = [View(str(path), ViewStatus.NO_BOARD, "too dark") for path in paths]
    views = (nothing[0], View(str(paths[1]), ViewStatus.FOUND, corners=found[1]), nothing[2])
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(Project(views=views, size=(640, 480))))
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for k in (0, 2):
        hand.wait(lambda path=paths[k]: page.shown_path == str(path))
        hand.wait(lambda: page.canvas.tool is not None)
        assert page.tools[0].isChecked() and page.marker.roi_bar.isVisible()
        for point in outermost(found[k]):
            hand.click(point)
        hand.wait(page.marker.roi_bar.accept.isEnabled)
        hand.key(Qt.Key.Key_Return)
    assert all(view.usable for view in window.session.project.views)
    assert page.canvas.tool is None and not page.tools[0].isChecked()
    assert window.session.image == str(paths[2])


def test_an_excluded_image_is_not_offered_to_be_marked(window: MainWindow, qtbot: QtBot) -> None:
    paths = [find_resource("sample") / f"view0{k}.png" for k in (1, 2, 3)]
    corners = find_corners(read_image(paths[0]).grey)
    first, excluded, last = (View(str(p), ViewStatus.NO_BOARD, "too dark") for p in paths)
    views = (first, replace(excluded, enabled=False), last)
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(Project(views=views, size=(640, 480))))
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for point in outermost(corners):
        hand.click(point)
    hand.wait(page.marker.roi_bar.accept.isEnabled)
    hand.key(Qt.Key.Key_Return)
    assert window.session.image == str(paths[2])
    hand.wait(lambda: page.shown_path == str(paths[2]))
    hand.wait(lambda: page.canvas.tool is not None)
    page.marker.leave()

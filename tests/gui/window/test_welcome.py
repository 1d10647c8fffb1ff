"""Recent projects and folders stand on the welcome page with a picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.app.projects.recent import Recent, list_recent
from calibgui.engine.images.reading import write_image
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.welcome import Welcome


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with one white image."""
    folder = tmp_path / "Studio & Labor"
    folder.mkdir()
    write_image(folder / "1.png", np.full((240, 320), 255, np.uint8))
    return folder


@pytest.fixture
def welcome(jobs: Jobs, qtbot: QtBot) -> Welcome:
    page = Welcome(jobs)
    qtbot.addWidget(page)
    page.resize(1280, 660)
    page.show()
    return page


def middle(welcome: Welcome, place: int) -> QColor:
    """The colour in the middle of a button's picture."""
    button = welcome.recent[place]
    return QColor(button.icon().pixmap(button.iconSize()).toImage().pixelColor(32, 24))


def test_a_folder_is_offered_with_its_first_image(
    welcome: Welcome, folder: Path, jobs: Jobs, qtbot: QtBot
) -> None:
    welcome.show_recent([Recent(folder, str(folder / "1.png"))])
    assert middle(welcome, 0) != QColor("white")
    qtbot.waitUntil(lambda: not jobs.running)
    assert middle(welcome, 0) == QColor("white")
    button = welcome.recent[0]
    assert button.text() == "Studio && Labor" and button.toolTip() == str(folder)
    with qtbot.waitSignal(welcome.recent_wanted) as signal:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert signal.args == [folder]


def test_an_image_that_is_gone_leaves_the_icon(
    welcome: Welcome, folder: Path, jobs: Jobs, qtbot: QtBot
) -> None:
    welcome.show_recent([Recent(folder, str(folder / "2.png"))])
    qtbot.waitUntil(lambda: not jobs.running)
    assert not welcome.recent[0].icon().isNull()


def test_pictures_that_come_late_are_dropped(
    welcome: Welcome, folder: Path, jobs: Jobs, qtbot: QtBot
) -> None:
    entry = Recent(folder, str(folder / "1.png"))
    welcome.show_recent([entry])
    welcome.show_recent([])
    qtbot.wait(20)
    qtbot.waitUntil(lambda: not jobs.running)
    assert not welcome._recent_part.isVisible()


def test_names_fit_their_buttons(welcome: Welcome, tmp_path: Path, qtbot: QtBot) -> None:
    deep = tmp_path / "a very long name of a folder of photographs" / "another long name of one"
    deep.mkdir(parents=True)
    welcome.show_recent([Recent(deep, "")] * 9)
    qtbot.wait(20)
    assert len(welcome.recent) == 6
    for button in welcome.recent:
        room = button.width() - button.iconSize().width()
        assert button.fontMetrics().horizontalAdvance(button.description()) < room
        assert welcome.rect().contains(button.geometry())


def test_an_opened_folder_is_remembered_and_opens_again(
    window: MainWindow, folder: Path, qtbot: QtBot
) -> None:
    window.files.open_paths([str(folder)])
    qtbot.waitUntil(lambda: bool(window.session.project.views))
    assert list_recent() == [Recent(folder, str(folder / "1.png"))]
    window.session.document.mark_saved(window.session.project, window.files.saver.file)
    window.files.new()
    assert [button.toolTip() for button in window.welcome.recent] == [str(folder)]
    qtbot.mouseClick(window.welcome.recent[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(window.session.project.views))
    for job in window.session.jobs.running:
        job.cancel()


def test_the_icons_follow_the_theme(welcome: Welcome, qapp: QApplication) -> None:
    for scheme, colours in ((theme.Scheme.DARK, theme.DARK), (theme.Scheme.LIGHT, theme.LIGHT)):
        theme.apply(qapp, scheme)
        QApplication.processEvents()
        for button in welcome.buttons:
            icon = button.icon().pixmap(button.iconSize()).toImage()
            pixels = [
                icon.pixelColor(x, y) for x in range(icon.width()) for y in range(icon.height())
            ]
            drawn = max(pixels, key=QColor.alpha)
            accent = QColor(colours.accent)
            assert np.allclose(drawn.getRgb()[:3], accent.getRgb()[:3], atol=3), button.text()


def test_a_good_set_is_shown_by_photographs_of_the_sample(welcome: Welcome, qtbot: QtBot) -> None:
    shots = welcome.good_set.shots.values()
    qtbot.waitUntil(lambda: all(not shot.pixmap().isNull() for shot in shots))
    assert len({shot.pixmap().toImage().pixelColor(20, 20).rgb() for shot in shots}) > 3
    assert all(shot.accessibleName() for shot in shots)


@pytest.mark.parametrize(("width", "columns"), [(1280, 3), (960, 2), (600, 1)])
def test_the_parts_stand_side_by_side_where_there_is_room(
    welcome: Welcome, folder: Path, qtbot: QtBot, width: int, columns: int
) -> None:
    welcome.show_recent([Recent(folder, "")])
    welcome.resize(width, 660)
    qtbot.wait(20)
    assert len({part.x() for part in welcome._parts}) == columns
    assert all(part.geometry().right() <= welcome.viewport().width() for part in welcome._parts)

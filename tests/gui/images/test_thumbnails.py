"""Pictures of the images; a file that changes after the search is noticed and searched again."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from calibgui.app.photographs.image_store import compute_file_digest
from calibgui.app.system.resources import find_resource
from calibgui.dataset import ViewStatus
from calibgui.gui.images.image_model import Role
from calibgui.gui.window.main_window import MainWindow

NAMES = ("view01.png", "view02.png", "view03.png", "view04.png")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    images = tmp_path / "photographs"
    images.mkdir()
    for name in NAMES:
        shutil.copy(find_resource("sample") / name, images)
    return images


def idle(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(
        lambda: not window.session.jobs.running and not window.calibrator.running, timeout=60_000
    )


def statuses(window: MainWindow) -> list[str]:
    model = window.images.list.model()
    return [model.index(row, 0).data(Role.STATUS) for row in range(model.rowCount())]


@pytest.mark.slow
def test_an_image_that_changed_is_shown_as_such_until_it_is_searched_again(
    window: MainWindow, qtbot: QtBot, folder: Path
) -> None:
    session, path = window.session, folder / "calibgui.json"
    window.files.open_paths([str(folder)])
    idle(window, qtbot)
    window.files.saver.save_beside(path)
    idle(window, qtbot)
    image = str(folder / NAMES[1])
    assert session.project.digests[image] == compute_file_digest(image)
    assert not window.banner.isVisible()

    # Another photograph takes its place; the project is opened again.
    shutil.copy(find_resource("sample") / "view09.png", image)
    window.files.new()
    window.files.open_project(path)
    qtbot.waitUntil(lambda: "1 of 4 images changed" in window.banner.text.text())
    assert NAMES[1] in window.banner.text.text()
    assert (
        statuses(window)
        == ["70 of 70 corners", "changed · 70 of 70 corners"] + ["70 of 70 corners"] * 2
    )
    assert not window.isWindowModified()
    old = session.project.views[1].corners

    # Its remedy: search it again.
    session.select(image)
    window.banner.buttons[0].click()
    idle(window, qtbot)
    assert session.project.views[1].status is ViewStatus.FOUND
    assert session.project.views[1].corners is not old
    assert statuses(window) == ["70 of 70 corners"] * 4
    assert session.project.digests[image] == compute_file_digest(image)
    session.document.undo()
    assert session.project.views[1].corners is old
    assert statuses(window)[1] == "changed · 70 of 70 corners"


def test_a_change_is_noticed_when_the_user_comes_back(
    window: MainWindow, qtbot: QtBot, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(window.calibrator, "calibrate", lambda: None)
    window.files.open_paths([str(folder)])
    idle(window, qtbot)
    image = str(folder / NAMES[0])
    window.session.select(image)
    idle(window, qtbot)
    other = QImage(640, 480, QImage.Format.Format_Grayscale8)
    other.fill(77)
    other.save(image)
    window.images.thumbnails.look_for_changes()
    qtbot.waitUntil(lambda: window.images.thumbnails.altered(image))
    idle(window, qtbot)
    kept = window.session.images.kept(image)
    assert kept is not None and (kept.grey == 77).all()
    assert window.page.shown_path == image
    window.images.thumbnails.look_for_changes()
    idle(window, qtbot)
    assert window.images.thumbnails.altered(image)

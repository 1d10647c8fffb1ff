"""The window as a whole: what it prepares before it is asked for."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.app.projects.project import remove_result
from calibgui.app.projects.project_file import write_project
from calibgui.gui.panels.evidence.board_shape import BoardShapePanel
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.window import preparation
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.menus import Menus
from tests.app import examples


def test_every_module_that_is_imported_soon_exists() -> None:
    missing = [name for name in preparation._NEEDED_SOON if find_spec(name) is None]
    assert missing == []
    assert len(preparation._NEEDED_SOON) > 2


def test_panels_are_built_one_by_one_in_pauses(full: MainWindow, qtbot: QtBot) -> None:
    full.need_analysis().show_panel(BoardShapePanel)
    panels = full.need_analysis().findChildren(Panel)
    full.preparation.start()
    full.session.show_result(next(iter(full.session.project.results)))
    for count in (len(panels) + 1, len(panels) + 2):
        qtbot.waitUntil(lambda: len(full.need_analysis().findChildren(Panel)) >= count)  # noqa: B023
    assert isinstance(full.need_analysis().shown, BoardShapePanel), "what is seen stays"


def test_no_panel_is_built_while_somebody_looks_through_the_images(
    full: MainWindow, qtbot: QtBot
) -> None:
    full.preparation.start()
    full.session.show_result(next(iter(full.session.project.results)))
    pause = full.preparation._building
    pause.setTimerType(Qt.TimerType.PreciseTimer)
    pause.setInterval(60_000)
    bar = full.images.list.horizontalScrollBar()
    for use in (lambda: full.session.select_next(1), lambda: bar.valueChanged.emit(1)):
        qtbot.wait(20)
        left = pause.remainingTime()
        use()
        assert pause.remainingTime() > left, "the pause begins anew"
    pause.stop()
    full.session.select_next(1)
    assert not pause.isActive(), "all that is built stays so"


def test_a_panel_is_filled_in_one_turn_and_painted_in_the_next(
    full: MainWindow, qtbot: QtBot
) -> None:
    analysis = full.need_analysis()
    panel = analysis.show_panel(CoveragePanel)

    def is_painted_next() -> bool:
        assert panel.isVisible() and panel.advice.text(), "it is filled at once"
        QApplication.sendPostedEvents()  # what else this turn of the event loop does
        return not panel.updatesEnabled()

    assert is_painted_next()
    qtbot.waitUntil(panel.updatesEnabled)
    panel.advice.clear()
    full.session.show_result("Calibration 1")
    assert is_painted_next(), "as at another result"
    qtbot.waitUntil(panel.updatesEnabled)


def test_an_edit_and_its_undo_refresh_the_menus_once_each(
    full: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    times: list[int] = []
    refresh = Menus.refresh
    monkeypatch.setattr(Menus, "refresh", lambda menus: (times.append(1), refresh(menus)))
    document = full.session.document
    name = full.session.result_name
    document.edit("Delete", lambda p: remove_result(p, name))  # another result is shown then
    assert full.session.result_name != name and len(times) == 1
    document.undo()
    assert full.session.result_name == name and len(times) == 2


@pytest.mark.parametrize("are_kept", [False, True])
def test_kernels_that_are_not_kept_are_compiled_while_the_window_can_be_used(
    are_kept: bool, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(preparation, "_load_ahead", lambda: are_kept)
    monkeypatch.setattr(preparation, "compile_kernels", lambda *_: asked.append("compile"))
    loaded: list[None] = []
    monkeypatch.setattr(preparation.gc, "freeze", lambda: loaded.append(None))
    window.preparation.start()
    qtbot.waitUntil(lambda: bool(loaded) and not window.session.jobs.running)
    assert asked == ([] if are_kept else ["compile"])


def test_a_photograph_that_is_gone_says_so_where_it_would_be(
    full: MainWindow, qtbot: QtBot
) -> None:
    full.session.select(full.session.project.views[1].image)
    qtbot.waitUntil(full.page.reason.isVisible)
    assert "1.png cannot be read: No such file" in full.page.reason.text()


def test_a_project_among_other_files_is_said_to_be_opened_alone(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    write_project(examples.calibrated(tmp_path), tmp_path / "p.json")
    window.files.open_paths([str(tmp_path / "p.json"), *(f"{k}.png" for k in range(9))])
    told = "Only the project p.json is opened, without the 9 other files."
    assert window.banner.text.text() == told
    qtbot.waitUntil(lambda: bool(window.session.project.views))
    qtbot.waitUntil(lambda: not window.session.jobs.running)


def test_a_project_that_takes_long_to_open_is_said_to_be_opened(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    write_project(examples.calibrated(tmp_path), tmp_path / "p.json")
    window.files.open_project(tmp_path / "p.json")
    assert window.banner.isVisible() and window.banner.text.text() == "Opening p.json…"
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert window.banner.text.text() != "Opening p.json…"

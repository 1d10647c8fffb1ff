"""Widgets without a screen; a test fails on a Qt warning, a thread or a timer left behind."""

from __future__ import annotations

import gc
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

pytest.importorskip("PySide6.QtWidgets", reason="Qt's system libraries are missing")

from PySide6.QtCore import QEvent, QSettings, QTimer
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples


@pytest.fixture(scope="session")
def qapp_args() -> list[str]:
    """The name that the window's settings are kept under while testing."""
    return ["calibgui-test"]


_frozen_modules = 0


def collect_garbage() -> None:
    """Collect what tests leave; what is imported stays, and later collections need not look at it.

    A panel imports what it needs when it is first shown.
    """
    global _frozen_modules
    gc.collect()
    if len(sys.modules) > _frozen_modules:
        _frozen_modules = len(sys.modules)
        gc.freeze()


@pytest.fixture(scope="session", autouse=True)
def keep_large_blocks() -> Iterator[None]:
    """The window does not undo for all later tests what `pytest_configure` has set."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("calibgui.gui.jobs.jobs.return_large_blocks", lambda: None)
        yield


@pytest.fixture
def qtbot(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> QtBot:
    """Keep the widgets that a test hands over until they are closed.

    The robot itself refers to them weakly. Its last turn of the event loop still paints those that
    a test has let go of, and a collection in the midst of that would take their pixels away.
    """
    kept: list[QWidget] = []
    hand_over = qtbot.addWidget

    def keep(widget: QWidget, **options: Any) -> None:
        kept.append(widget)
        hand_over(widget, **options)

    monkeypatch.setattr(qtbot, "addWidget", keep)
    return qtbot


@pytest.fixture(autouse=True)
def search_in_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Photographs are searched in the threads of the jobs, as tests/conftest.py has it.

    Modules that are about the processes themselves put a fixture of this name in its place.
    """
    monkeypatch.setattr("calibgui.app.system.workers._serial", SimpleNamespace(is_on=True))


@pytest.fixture(autouse=True)
def clean(
    qapp: QApplication, qtlog: pytest.LogCaptureFixture, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[None]:
    """The program's look, settings of its own, and nothing left behind."""
    home = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        for name in ("XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME"):
            patch.setenv(name, str(home))
        for scope in QSettings.Scope:
            QSettings.setPath(QSettings.Format.NativeFormat, scope, str(home))
        theme.apply(qapp, theme.Scheme.LIGHT)
        threads = set(threading.enumerate())
        yield
        # The robot has closed what it was given; a plot must not be closed twice.
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        for widget in qapp.topLevelWidgets():
            widget.close()
        # Plots that are gone hang together in cycles: their end is not left to another test.
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        collect_garbage()
    left = [t.name for t in set(threading.enumerate()) - threads if t.is_alive() and not t.daemon]
    assert not left, f"threads left behind: {left}"
    running = [
        timer
        for widget in qapp.topLevelWidgets()
        for timer in widget.findChildren(QTimer)
        if timer.isActive()
    ]
    assert not running, f"timers left behind: {running}"
    # The offscreen platform says this of every window that is shown.
    warnings = [r.message for r in qtlog.records if "propagateSizeHints" not in r.message]
    assert not warnings, f"Qt warned: {warnings}"


@pytest.fixture
def jobs() -> Iterator[Jobs]:
    """Work beside the window, ended with the test."""
    running = Jobs()
    yield running
    running.close()


@pytest.fixture
def window(qtbot: QtBot) -> Iterator[MainWindow]:
    """The program's window, empty; what a test leaves unsaved is given up."""
    window = MainWindow()
    window.resize(1280, 720)
    window.show()
    qtbot.waitExposed(window)
    yield window
    window.session.document.mark_saved(window.session.project, window.files.saver.file)
    window.close()
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture
def full(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> MainWindow:
    """The window with six found views, one without a board, and two results."""
    window.session.begin(Document(examples.calibrated(tmp_path)))
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    return window

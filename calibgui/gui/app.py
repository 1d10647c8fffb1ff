"""Starting the window."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

import shiboken6
from PySide6.QtCore import (
    QLibraryInfo,
    QLocale,
    QMessageLogContext,
    QTimer,
    QtMsgType,
    QTranslator,
    qInstallMessageHandler,
)
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QApplication

from calibgui.app.system.missing_library import describe_missing_library
from calibgui.app.system.resources import find_resource
from calibgui.engine.errors import CalibrationError
from calibgui.gui.termination import TerminationNotifier
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow


def run(arguments: Sequence[str]) -> int:
    """Open the window, with a folder, images or a project if they are named; its exit code."""
    app = _create_application()
    app.setApplicationName("calibgui")
    app.setApplicationDisplayName("calibgui")
    app.setOrganizationName("calibgui")
    app.setDesktopFileName("calibgui")
    with contextlib.suppress(CalibrationError):  # a window without its icon is still a window
        app.setWindowIcon(QIcon(str(find_resource("icons/calibgui.svg"))))
    _translate(app)
    theme.apply(app, theme.chosen())
    theme.follow_system(app)
    window = MainWindow()
    sys.excepthook = lambda kind, error, trace: _report(window, kind, error, trace)
    TerminationNotifier(lambda code: _end(window, code), window)
    window.open_up()
    QTimer.singleShot(0, window, window.preparation.start)
    if arguments:
        QTimer.singleShot(0, window, lambda: window.files.open_paths(arguments))
    code = app.exec()
    sys.excepthook = sys.__excepthook__  # the other one holds the window
    shiboken6.delete(window)  # before the application, without which its timers cannot end
    return code


def _end(window: MainWindow, code: int) -> None:
    """End the program with an exit code; nothing is asked, and unsaved work is kept."""
    window.files.keep_work()
    window.session.jobs.close()
    QApplication.exit(code)


def _create_application() -> QApplication:
    """Return Qt's application; end the program with a plain reason where Qt would abort it."""
    said: list[str] = []

    def explain(kind: QtMsgType, _: QMessageLogContext, text: str) -> None:
        if kind is not QtMsgType.QtFatalMsg:
            said.append(text)
            return
        missing = describe_missing_library(_try_to_load_plugin())
        reason = missing or f"There is no display that Qt can open: {said[0] if said else text}."
        print(
            f"calibgui: the window cannot be opened. {reason}\n"
            "calibgui --help lists the commands that need no window.",
            file=sys.stderr,
            flush=True,
        )
        os._exit(1)  # Qt aborts when this returns

    usual = qInstallMessageHandler(explain)
    try:
        app = QApplication([sys.argv[0]])
    finally:
        qInstallMessageHandler(usual)
    for text in said:
        print(text, file=sys.stderr)
    return app


def _try_to_load_plugin() -> str:
    """Return why the system cannot load what opens windows on X11; empty if it can, or has none."""
    folder = Path(QLibraryInfo.path(QLibraryInfo.LibraryPath.PluginsPath), "platforms")
    plugin = folder / "libqxcb.so"
    try:
        if plugin.exists():
            ctypes.CDLL(str(plugin))
    except OSError as error:
        return str(error)
    return ""


def _translate(app: QApplication) -> None:
    """Speak the user's language as far as Qt and resources/translations/calibgui_<language> do."""
    places = [QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)]
    with contextlib.suppress(CalibrationError):
        places.append(str(find_resource("translations")))
    for name, place in zip(("qtbase", "calibgui"), places, strict=False):
        translator = QTranslator(app)
        if translator.load(QLocale(), name, "_", place):
            app.installTranslator(translator)


def _report(
    window: MainWindow,
    kind: type[BaseException],
    error: BaseException,
    trace: TracebackType | None,
) -> None:
    sys.__excepthook__(kind, error, trace)
    window.show_failure(error)

"""The window opens whatever has become of its own files."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QSettings
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project
from calibgui.app.system.state_folder import find_state_folder
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.kept_settings import (
    keep,
    read_kept_bytes,
    read_kept_text,
)
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

_NAMES = ("geometry", "layout", "scheme", "by%20hand", "last%20format")
_PICKLE = r"@Variant(\0\0\0\x7f\0\0\0\x9PyObject\0)"
"""What Qt takes for an object of Python, and fails to make."""
_VALUES = ("text", "a, b", "@ByteArray(x)", "@Size(10 10)", "@Variant(\\0\\0\\0)", _PICKLE, "")


@pytest.mark.parametrize("value", _VALUES)
def test_the_window_opens_with_settings_of_any_kind(
    value: str, qtbot: QtBot, tmp_path: Path
) -> None:
    text = "".join(f"{name}={value}\n" for name in _NAMES)
    Path(QSettings().fileName()).parent.mkdir(parents=True, exist_ok=True)
    Path(QSettings().fileName()).write_text(f"[General]\n{text}")
    _open_window(qtbot, examples.calibrated(tmp_path))


def test_the_window_opens_with_damaged_notes_of_recent_projects(
    qtbot: QtBot, tmp_path: Path
) -> None:
    (find_state_folder() / "recent.json").write_text("[" * 5000)
    _open_window(qtbot, examples.calibrated(tmp_path))


def _open_window(qtbot: QtBot, project: Project) -> None:
    assert theme.chosen() is theme.Scheme.SYSTEM
    window = MainWindow()
    qtbot.addWidget(window)
    window.open_up()
    window.session.begin(Document(project))
    assert window.isVisible() and window.images.isVisible()
    assert window.inspector.isVisible() or window.header.grade.isVisible()


def test_what_is_kept_is_read_as_what_it_was() -> None:
    keep("bytes", QByteArray(b"\x00\x01"))
    keep("text", "dark")
    QSettings().sync()
    assert read_kept_bytes("bytes") == QByteArray(b"\x00\x01")
    assert read_kept_text("text") == "dark"
    assert read_kept_bytes("text") is None and read_kept_text("bytes") is None

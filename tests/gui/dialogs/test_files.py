"""Undistorted images replace photographs of the same names only if the user says so."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox
from pytestqt.qtbot import QtBot

from calibgui.app.outputs.resampling import GEOMETRY_FILE, Undistortion
from calibgui.app.projects.document import Document
from calibgui.engine.images.reading import write_image
from calibgui.gui.widgets import questions
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples


@pytest.mark.parametrize("button", ["Yes", "No"])
def test_the_window_asks_before_it_replaces_photographs(
    window: MainWindow,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    button: str,
) -> None:
    project = examples.calibrated(tmp_path)
    window.session.begin(Document(project))
    result = window.session.result
    assert result is not None
    width, height = result.calibration.camera.size
    source = Path(result.used[0].image)
    write_image(source, np.full((height, width), 99, np.uint8))
    folder = tmp_path / "others"
    folder.mkdir()
    (folder / source.name).write_bytes(b"an old photograph")
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(folder))
    asked: list[str] = []

    def question(*arguments: object) -> QMessageBox.StandardButton:
        asked.append(str(arguments[2]))
        return getattr(QMessageBox.StandardButton, button)

    monkeypatch.setattr(questions, "ask", question)
    k = next(k for k, view in enumerate(result.views) if view.image == str(source))
    window.files.save_changed_images((k,), Undistortion())
    qtbot.waitUntil(lambda: bool(asked))
    assert source.name in asked[0] and "Replace them?" in asked[0]
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    is_kept = (folder / source.name).read_bytes() == b"an old photograph"
    assert is_kept == (button == "No")
    assert (folder / GEOMETRY_FILE).exists() == (button == "Yes")

"""A process that cannot start is told in the window each time, and nothing waits for it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.system.resources import find_resource
from calibgui.dataset import ViewStatus
from calibgui.gui.window.main_window import MainWindow

pytestmark = pytest.mark.slow
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(autouse=True)
def search_in_threads() -> None:
    """Photographs are searched in processes, as they are for the user."""


def test_a_process_that_cannot_import_is_told_each_time(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    photographs, broken = tmp_path / "photographs", tmp_path / "broken"
    for folder in (photographs, broken):
        folder.mkdir()
    for source in sorted(find_resource("sample").glob("*.png"))[:3]:
        shutil.copy(source, photographs)
    # What a worker imports is found there first; this process has the real one already.
    (broken / "cv2.py").write_text("raise ImportError('half a file')", encoding="utf-8")
    with monkeypatch.context() as patch:
        patch.syspath_prepend(str(broken))
        window.files.open_paths([str(photographs)])
        for _ in range(2):
            qtbot.waitUntil(window.banner.isVisible, timeout=60_000)
            said = window.banner.text.text()
            assert said.startswith("A process that should do part of the work ended before")
            assert "Try again." in said and "start this program anew" in said
            qtbot.waitUntil(lambda: not window.session.jobs.running)
            assert not window.calibrator.running
            assert window.verdict.headline.text() == "NOT CALIBRATED"
            qtbot.mouseClick(window.banner.dismiss, LEFT)
            qtbot.mouseClick(window.calibrate, LEFT)
        qtbot.waitUntil(window.banner.isVisible, timeout=60_000)
    qtbot.mouseClick(window.calibrate, LEFT)
    found = ViewStatus.FOUND
    qtbot.waitUntil(
        lambda: [v.status for v in window.session.project.views] == [found] * 3, timeout=120_000
    )
    window.calibrator.stop()
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)

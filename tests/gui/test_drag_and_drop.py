"""Files dragged from another program onto the window, over the protocol of X11 (XDND)."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from calibgui.app.system.resources import find_resource

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not (shutil.which("Xvfb") and shutil.which("xdotool")), reason="needs Xvfb and xdotool"
    ),
]
SOURCE = """
import sys
from PySide6.QtCore import QMimeData, Qt, QUrl
from PySide6.QtGui import QDrag
from PySide6.QtWidgets import QApplication, QLabel

class Source(QLabel):
    def mousePressEvent(self, event):
        pass

    def mouseMoveEvent(self, event):
        drag, data = QDrag(self), QMimeData()
        data.setUrls([QUrl.fromLocalFile(name) for name in sys.argv[1:]])
        drag.setMimeData(data)
        print(drag.exec(Qt.CopyAction | Qt.MoveAction).name, flush=True)

app = QApplication([])
source = Source()
source.setGeometry(1700, 400, 150, 100)
source.show()
print("ready", flush=True)
app.exec()
"""
PATIENCE = 60.0
"""Time after which a program is taken to hang, s."""


@pytest.fixture
def display(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A screen without a person, and a home for the program."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1920x1080x24"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    with os.fdopen(read) as told:
        monkeypatch.setenv("DISPLAY", f":{told.readline().strip()}")
    monkeypatch.setenv("QT_QPA_PLATFORM", "xcb")
    for name in ("HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    yield
    os.close(write)
    server.terminate()
    server.wait()


def xdotool(*words: object) -> None:
    subprocess.run(["xdotool", *map(str, words)], check=True)
    time.sleep(0.25)


def drag(start: tuple[int, int], end: tuple[int, int]) -> None:
    """Drag by the mouse, in steps as a hand does."""
    xdotool("mousemove", *start, "mousedown", 1)
    for k in range(1, 6):
        share = k / 5
        xdotool("mousemove", *(round(a + share * (b - a)) for a, b in zip(start, end, strict=True)))
    xdotool("mousemove", end[0] + 3, end[1])
    xdotool("mouseup", 1)


@pytest.mark.usefixtures("display")
def test_photographs_dropped_by_another_program_are_opened_and_stay_where_they_are(
    tmp_path: Path,
) -> None:
    photographs = [tmp_path / f"view{k:02d}.png" for k in range(1, 4)]
    for photograph in photographs:
        shutil.copy(find_resource("sample") / photograph.name, photograph)
    window = subprocess.Popen([sys.executable, "-m", "calibgui"])
    command = [sys.executable, "-c", SOURCE, *map(str, photographs)]
    source = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert source.stdout is not None
    try:
        assert source.stdout.readline() == "ready\n"
        end = time.monotonic() + PATIENCE
        search = ["xdotool", "search", "--onlyvisible", "--name", "Untitled"]
        while subprocess.run(search, stdout=subprocess.DEVNULL, check=False).returncode:
            assert time.monotonic() < end, "the window does not open"
            time.sleep(0.2)
        time.sleep(1)
        drag((1770, 450), (600, 400))
        assert source.stdout.readline() == "CopyAction\n", "a move would delete the originals"
        kept = "*unsaved*.json*"
        while not any("view03.png" in file.read_text() for file in tmp_path.rglob(kept)):
            assert time.monotonic() < end, "nothing was opened"
            time.sleep(0.2)
        assert all(photograph.exists() for photograph in photographs)
    finally:
        for program in (source, window):
            program.terminate()
            program.communicate()  # which closes what it writes to

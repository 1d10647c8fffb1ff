"""What must hold whatever happens: odd files, and being killed at any step."""

from __future__ import annotations

import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QInputDialog
from pytestqt.qtbot import QtBot

from calibgui.app.projects.autosave import find_unsaved_work, get_autosave_path, read_unsaved_work
from calibgui.app.projects.project import Project, add_images, set_grid_size
from calibgui.app.projects.project_file import encode_project, read_project, write_project
from calibgui.app.system.resources import find_resource
from calibgui.dataset import ViewStatus
from calibgui.engine.calibration.result import Cost
from calibgui.formats.json_document import dumps
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.window.main_window import MainWindow
from tests.gui.hand import Hand

pytestmark = pytest.mark.slow


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Five of the sample's images."""
    images = tmp_path / "photographs"
    images.mkdir()
    for source in sorted(find_resource("sample").glob("*.png"))[:5]:
        shutil.copy(source, images)
    return images


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_a_project_that_names_devices_and_pipes_as_images(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, folder: Path
) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    odd = ["/dev/zero", str(tmp_path / "pipe.png"), str(tmp_path)]
    project = add_images(Project(), [*odd, *map(str, sorted(folder.iterdir()))])
    write_project(project, tmp_path / "project.json")
    window.files.open_project(tmp_path / "project.json")
    qtbot.waitUntil(lambda: len(window.session.project.views) == 8)
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.session.result is not None, timeout=60_000)
    statuses = [view.status for view in window.session.project.views]
    assert statuses == [ViewStatus.UNREADABLE] * 3 + [ViewStatus.FOUND] * 5
    for view in window.session.project.views:
        window.session.select(view.image)
        qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=10_000)


_STEPS = """
import hashlib, signal, sys
from pathlib import Path
from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtWidgets import QApplication
from calibgui.app.projects.project_file import encode_project
from calibgui.formats.json_document import dumps
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.window.main_window import MainWindow

signal.alarm(300)  # a step that never ends
app = QApplication([])
window = MainWindow()
window.show()
session, saver = window.session, window.files.saver
saver._timer.setInterval(50)
folder, project_file = Path(sys.argv[1]), Path(sys.argv[2])

def wait(condition):
    while not condition():
        app.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents, 20)

def open_folder():
    window.files.open_paths([str(folder)])
    wait(lambda: session.result is not None)

def exclude():
    window.images.exclude([session.project.views[1].image])

def calibrate():
    window.calibrate.click()
    wait(lambda: len(session.project.results) == 2)

def save():
    saver.save_beside(project_file)
    wait(lambda: session.document.saved)

def state_size():
    window.board.inferred.click()
    window.board.square.setValue(25.0)

def undo():
    session.document.undo()

for step in (open_folder, exclude, calibrate, save, state_size, undo):
    step()
    wait(lambda: not session.jobs.running)
    wait(lambda: session.document.saved or saver._autosaved is session.project)
    wait(lambda: not session.jobs.running)
    text = dumps({**encode_project(session.project, Path("/")), "verdicts": None})
    print(step.__name__, hashlib.sha256(text.encode()).hexdigest(), flush=True)
    sys.stdin.readline()
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="the system has no SIGKILL")
def test_killed_after_any_step_nothing_is_lost(tmp_path: Path, folder: Path) -> None:
    """The program stands still after each step: what then lies on the disk is what a kill leaves.
    After the last one it is killed."""
    state, file = tmp_path / "state", tmp_path / "project.json"
    env = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_STATE_HOME": str(state)}
    arguments = [sys.executable, "-c", _STEPS, str(folder), str(file)]
    pipe = subprocess.PIPE
    with subprocess.Popen(arguments, env=env, stdin=pipe, stdout=pipe, text=True) as process:
        assert process.stdin is not None and process.stdout is not None
        steps = []
        for line in process.stdout:
            step, told = line.split()
            if step == "undo":
                process.send_signal(signal.SIGKILL)
                process.wait()
            assert digest_what_is_left(state, file, is_saved=step == "save") == told, step
            steps.append(step)
            if step != "undo":
                process.stdin.write("\n")
                process.stdin.flush()
    assert steps == ["open_folder", "exclude", "calibrate", "save", "state_size", "undo"]


def digest_what_is_left(state: Path, file: Path, is_saved: bool) -> str:
    """Digest the project that the next start would open or offer."""
    where = file if file.exists() else state / "calibgui" / "unsaved-1.json"
    work = find_unsaved_work(where)
    assert (work is None) is is_saved
    project = read_project(file) if work is None else read_unsaved_work(work, where)
    assert work in (None, get_autosave_path(where))
    # A verdict that was found out since is found out again.
    text = dumps({**encode_project(project, Path("/")), "verdicts": None})
    return hashlib.sha256(text.encode()).hexdigest()


def describe(window: MainWindow) -> str:
    """All that edits change: a verdict is found out by the program itself."""
    return dumps({**encode_project(window.session.project, Path("/")), "verdicts": None})


def list_edits(window: MainWindow) -> list[Callable[[], object]]:
    """Return what a user can do to the settings, the list of images and the results."""
    board, settings = window.board, window.settings
    images = [view.image for view in window.session.project.views]

    def choose(box: QComboBox, row: int) -> None:
        box.setFocus()
        while box.currentIndex() != row:
            QTest.keyClick(box, Qt.Key.Key_Down if box.currentIndex() < row else Qt.Key.Key_Up)

    return [
        board.by_hand.click,
        lambda: window.images.exclude(images[1:2]),
        board.inferred.click,
        lambda: board.square.setValue(25.0),
        lambda: choose(board.unit, 1),
        lambda: choose(board.method, 1),
        settings.robust.click,
        settings.weigh.click,
        settings.again.click,
        lambda: settings.choose_model("brown-conrady", ()),
        lambda: settings.choose_method("zhang", Cost.IMAGE),
        lambda: window.images.remove(images[3:4]),
        lambda: window.files.rename_result("Calibration 1"),
        lambda: window.files.delete_result("the only one"),
        lambda: choose(board.pattern.kind, 2),
        lambda: window.images.remove(images[:3] + images[4:]),
    ]


def test_every_edit_is_undone_to_the_empty_window_and_done_again(
    window: MainWindow, qtbot: QtBot, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(QInputDialog, "getText", lambda *_: ("the only one", True))
    hand, session = Hand(window, qtbot), window.session
    empty = describe(window)
    window.files.open_paths([str(folder)])
    hand.wait(lambda: session.result is not None)
    hand.wait(lambda: not session.jobs.running)
    states = {session.document.edits: describe(window)}
    for edit in list_edits(window):
        before = describe(window)
        edit()
        session.document.end_sliding_edit()
        hand.wait(lambda: not session.jobs.running)
        assert describe(window) != before, session.document.undo_label
        states[session.document.edits] = describe(window)
    last = session.document.edits
    assert last >= 18 and not session.project.views
    for _ in range(last):
        window.setFocus()
        hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        if session.document.edits in states:
            assert describe(window) == states[session.document.edits]
    assert session.document.edits == 0 and describe(window) == empty
    assert window.pages.currentWidget() is window.welcome
    while session.document.redo_label:
        session.document.redo()
        if session.document.edits in states:
            assert describe(window) == states[session.document.edits]
    assert session.document.edits == last
    hand.wait(lambda: not session.jobs.running)


@pytest.mark.parametrize("seed", range(2))
def test_after_a_storm_of_cancelling_everything_still_works(
    window: MainWindow, qtbot: QtBot, folder: Path, seed: int
) -> None:
    """Work is started, stopped and cancelled, and what it is about changes, faster than it ends."""
    session, chance = window.session, random.Random(seed)
    images = sorted(map(str, folder.iterdir()))

    def cancel() -> None:
        for job in session.jobs.running:
            job.cancel()

    def change() -> None:
        row, col = chance.choice([(7, 10), (6, 9)])
        session.edit("Size", lambda p: set_grid_size(p, (row, col)))

    deeds = [
        window.calibrate.click,
        window.calibrate.click,
        cancel,
        change,
        lambda: window.files.open_paths(chance.sample(images, 3)),
        lambda: window.images.remove(images[:2]),
        lambda: window.detector.search_again([view.image for view in session.project.views[:2]]),
        lambda: session.document.undo(),
        lambda: session.document.redo(),
        lambda: window.need_analysis().show_panel(chance.choice(PANELS)),
    ]
    for _ in range(60):
        chance.choice(deeds)()
        qtbot.wait(chance.choice([0, 0, 5, 50, 200]))
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=120_000)
    assert not window.calibrator.running and not window.detector.running
    assert window.calibrate.text() == "C&alibrate"

    # From there on it is as if nothing had been.
    while session.document.undo_label:
        session.document.undo()
    window.files.open_paths([str(folder)])
    qtbot.waitUntil(lambda: session.result is not None and not session.jobs.running, timeout=60_000)
    views = session.project.views
    assert [view.image for view in views] == images
    assert [view.status for view in views] == [ViewStatus.FOUND] * 5
    assert session.result is not None
    params = session.result.calibration.camera.params
    truth = json.loads((find_resource("sample") / "truth.json").read_text())["camera"]["params"]
    assert params[0] == pytest.approx(truth["fx"], abs=1.0)

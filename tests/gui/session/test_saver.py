"""Nothing is lost: autosave, recovery, and being killed in the middle of it all."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QLocale
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.projects.autosave import (
    AUTOSAVE_DELAY_S,
    autosave,
    find_unsaved_work,
    get_autosave_path,
    get_discarded_folder,
)
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, add_images
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.gui.session.saver import Saver
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import questions
from calibgui.gui.widgets.questions import Answer
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

_WORK = """
import itertools, os, sys, time
from pathlib import Path
from PySide6.QtCore import QCoreApplication, QTimer
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import add_images
from calibgui.app.projects.project_file import read_project
from calibgui.gui.session.saver import Saver
from calibgui.gui.session.session import Session

app = QCoreApplication([])
session = Session()
saver = Saver(session)
path = Path(sys.argv[1])
session.begin(Document(read_project(path), path))
numbers = itertools.count()

def edit():
    n = next(numbers)
    session.edit("Add", lambda p: add_images(p, [f"{time.monotonic()}/{n}.png"]))
    if n % 40 == 39:
        saver.save(path)

timer = QTimer(interval=10)
timer.timeout.connect(edit)
timer.start()
print("ready", flush=True)
app.exec()
"""


def newest_edit(project_file: Path) -> float:
    """When the last edit in the file was made; minus infinity if it holds none."""
    views = read_project(project_file).views
    times = [
        float(Path(view.image).parent.name)
        for view in views
        if "/" in view.image[1:] and Path(view.image).parent.name.replace(".", "").isdigit()
    ]
    return max(times, default=-float("inf"))


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="the system has no SIGKILL")
@pytest.mark.parametrize("lifetime", [0.4, 3.1])
def test_killed_at_any_time_all_but_the_last_two_seconds_is_offered(
    tmp_path: Path, lifetime: float
) -> None:
    path = tmp_path / "project.json"
    write_project(examples.calibrated(tmp_path), path)
    env = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_STATE_HOME": str(tmp_path)}
    with subprocess.Popen(
        [sys.executable, "-c", _WORK, str(path)], env=env, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(lifetime)
        process.send_signal(signal.SIGKILL)
        killed = time.monotonic()
    latest = newest_edit(path)
    if (work := find_unsaved_work(path)) is not None:
        latest = max(latest, newest_edit(work))
    if lifetime > AUTOSAVE_DELAY_S:
        assert killed - latest < AUTOSAVE_DELAY_S + 1.0, "a second for a slow machine to write it"
    # Whatever there is can be read, and the results are whole.
    assert len(read_project(work or path).results) == 2


def test_steady_work_is_kept_though_it_never_pauses(qtbot: QtBot, tmp_path: Path) -> None:
    session = Session()
    saver = Saver(session)
    saver._timer.setInterval(100)
    session.begin(Document(examples.calibrated(tmp_path), tmp_path / "project.json"))
    for number in range(30):
        session.edit("Add", lambda p, n=number: add_images(p, [str(tmp_path / f"{n}.new")]))
        qtbot.wait(10)
    kept = get_autosave_path(tmp_path / "project.json")
    assert len(read_project(kept).views) > 7
    qtbot.waitUntil(lambda: len(read_project(kept).views) == 37)
    session.jobs.close()
    saver.close()
    assert not kept.exists()
    session.deleteLater()


def test_saving_leaves_nothing_to_recover(window: MainWindow, tmp_path: Path) -> None:
    path = tmp_path / "project.json"
    window.session.begin(Document(examples.calibrated(tmp_path)))
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "new.png")]))
    assert window.isWindowModified()
    window.files.keep_work()
    slot = window.files.saver.file
    assert get_autosave_path(slot).exists()
    window.files.saver.save(path)
    assert not window.isWindowModified()
    assert window.windowTitle().startswith("project.json")
    assert not get_autosave_path(slot).exists()
    assert find_unsaved_work(path) is None
    assert json.loads(path.read_text(encoding="utf-8"))["format"] == "calibgui-project"


def test_unsaved_work_is_offered_and_recovered(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    project = examples.calibrated(tmp_path)
    write_project(project, path)
    more = add_images(project, [str(tmp_path / "new.png")])
    write_project(more, get_autosave_path(path))
    later = path.stat().st_mtime + 5
    os.utime(get_autosave_path(path), (later, later))
    window.files.open_project(path)
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 2)
    assert len(window.session.project.views) == 7
    assert f"ended without saving {path}." in window.banner.text.text()
    window.banner.buttons[0].click()
    qtbot.waitUntil(lambda: len(window.session.project.views) == 8)
    assert window.session.document.path == path
    assert window.isWindowModified(), "recovered work still has to be saved"


def test_work_on_a_project_in_a_read_only_folder_is_kept_elsewhere(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    folder = tmp_path / "photographs"
    folder.mkdir()
    path = folder / "project.json"
    write_project(examples.calibrated(folder), path)
    get_autosave_path(path).mkdir()  # as a folder that is read-only, for any user
    window.files.open_project(path)
    qtbot.waitUntil(lambda: window.session.document.path == path)
    window.session.edit("Add", lambda p: add_images(p, [str(folder / "new.png")]))
    window.files.keep_work()
    kept = find_unsaved_work(path)
    assert kept is not None and folder not in kept.parents
    left = kept.read_bytes()
    window.session.begin(Document())  # as if the program had been killed
    kept.write_bytes(left)
    window.files.open_project(path)
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 2)
    window.banner.buttons[0].click()
    qtbot.waitUntil(lambda: len(window.session.project.views) == 8)
    views = window.session.project.views
    assert [Path(view.image).parent for view in views] == [folder] * 8
    assert window.session.document.path == path and window.isWindowModified()


def test_work_on_a_file_stays_until_it_is_decided_about(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    project = examples.calibrated(tmp_path)
    write_project(project, path)
    autosave(add_images(project, [str(tmp_path / "new.png")]), path)
    kept = get_autosave_path(path).read_bytes()
    window.files.open_project(path)
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 2)
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "other.png")]))
    window.files.keep_work()
    slot = window.files.saver.file
    assert slot != path and get_autosave_path(path).read_bytes() == kept
    assert len(read_project(get_autosave_path(slot)).views) == 8
    window.banner.buttons[1].click()  # given up: the edit is kept beside the file from now on
    qtbot.waitUntil(lambda: window.files.saver.file == path)
    assert not get_autosave_path(slot).exists()
    qtbot.waitUntil(lambda: find_unsaved_work(path) is not None)
    assert "other.png" in read_project(get_autosave_path(path)).views[-1].image


def test_the_time_of_unsaved_work_is_told_as_the_users_language_has_it(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    autosave(examples.calibrated(tmp_path), path)
    noon = datetime(2026, 11, 22, 12, 30).timestamp()
    os.utime(get_autosave_path(path), (noon, noon))
    before = QLocale()
    try:
        for language, told in (("de_DE", "22.11.26 12:30"), ("en_GB", "22/11/2026 12:30")):
            QLocale.setDefault(QLocale(language))
            window.files.recoverable.emit(path)
            qtbot.waitUntil(lambda told=told: told in window.banner.text.text())
    finally:
        QLocale.setDefault(before)


def test_work_that_was_given_up_can_be_brought_back(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    project = examples.calibrated(tmp_path)
    write_project(project, path)
    autosave(add_images(project, [str(tmp_path / "new.png")]), path)
    window.files.open_project(path)
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 2)
    assert "The project was saved" in window.banner.text.text()
    window.banner.buttons[1].click()
    qtbot.waitUntil(lambda: "are not where they were" in window.banner.text.text())
    window.banner.dismiss.click()
    assert find_unsaved_work(path) is None
    (kept,) = get_discarded_folder().iterdir()
    assert str(kept) in window.banner.text.text()
    window.banner.buttons[0].click()
    qtbot.waitUntil(lambda: len(window.session.project.views) == 8)
    assert window.session.document.path == path and window.isWindowModified()


def test_an_offer_to_recover_comes_back_until_it_is_decided(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    project = examples.calibrated(tmp_path)
    write_project(project, path)
    get_autosave_path(path).write_text('{"format": "calibgui-pro', encoding="utf-8")
    window.files.open_project(path)
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 2)
    offer = window.banner.text.text()
    window.files.images_missing.emit(["gone.png"])
    window.files.open_paths(["no such folder"])
    assert "does not exist" in window.banner.text.text()
    for _ in range(2):
        window.banner.dismiss.click()
    assert window.banner.text.text() == offer
    window.banner.buttons[0].click()
    qtbot.waitUntil(lambda: "cut short" in window.banner.text.text())
    window.banner.dismiss.click()
    assert window.banner.text.text() == offer


@pytest.fixture
def other(qapp: QApplication) -> Iterator[Saver]:
    """Another window on the same computer, as far as files go."""
    session = Session(qapp)
    saver = Saver(session)
    yield saver
    session.jobs.close()
    saver.close()
    session.deleteLater()


def test_two_windows_on_one_project_keep_their_work_apart(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, other: Saver
) -> None:
    path = tmp_path / "project.json"
    write_project(examples.calibrated(tmp_path), path)
    theirs = other.parent()
    assert isinstance(theirs, Session)
    other.open(path)
    qtbot.waitUntil(lambda: theirs.document.path == path)
    theirs.edit("Add", lambda p: add_images(p, [str(tmp_path / "theirs.png")]))
    other.autosave_now()
    window.files.open_project(path)
    qtbot.waitUntil(lambda: bool(window.banner.buttons))  # it asks for the images, which are gone
    window.banner.dismiss.click()
    assert "open in another window" in window.banner.text.text() and not window.banner.buttons
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "mine.png")]))
    window.files.keep_work()
    assert "theirs.png" in read_project(get_autosave_path(path)).views[-1].image
    assert window.files.saver.file != path
    theirs.begin(Document())
    window.session.begin(Document())
    window.files.open_project(path)
    qtbot.waitUntil(lambda: window.session.document.path == path)
    assert window.files.saver.file != path, "what the other left has to be decided about"


def test_the_lock_of_a_window_that_was_closed_is_taken_over(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, other: Saver
) -> None:
    path = tmp_path / "project.json"
    write_project(examples.calibrated(tmp_path), path)
    theirs = other.parent()
    assert isinstance(theirs, Session)
    theirs.begin(Document(examples.calibrated(tmp_path), path))
    window.files.open_project(path)
    qtbot.waitUntil(lambda: window.session.document.path == path)
    assert window.files.saver.file != path
    other.close()
    window.files.open_project(path)
    qtbot.waitUntil(lambda: window.files.saver.file == path)


@pytest.mark.parametrize("answer", ["Yes", "SaveAll", "Cancel"])
def test_what_another_program_saved_is_not_replaced_without_a_question(
    window: MainWindow,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    answer: str,
) -> None:
    path, aside = tmp_path / "project.json", tmp_path / "aside.json"
    project = examples.calibrated(tmp_path)
    write_project(project, path)
    asked: list[str] = []

    def ask(_: object, __: str, text: str, *___: object) -> Answer:
        asked.append(text)
        return Answer[answer]

    monkeypatch.setattr(questions, "ask", ask)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(aside), ""))
    window.files.open_project(path)
    qtbot.waitUntil(lambda: window.session.document.path == path)
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "mine.png")]))
    path.touch()  # the same content: no reason to ask
    window.files.save()
    qtbot.waitUntil(lambda: window.session.document.saved)
    assert not asked
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "mine too.png")]))
    write_project(project, path)
    theirs = path.read_bytes()
    window.files.save()
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert len(asked) == 1 and "another window or program" in asked[0]
    assert (path.read_bytes() == theirs) is (answer != "Yes")
    assert aside.exists() is (answer == "SaveAll")
    assert window.session.document.saved is (answer != "Cancel")


def test_work_without_a_name_is_known_by_its_photographs(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    slot = window.files.saver.file
    autosave(examples.calibrated(tmp_path), slot)
    window.files.recoverable.emit(slot)
    qtbot.waitUntil(lambda: f"7 photographs in {tmp_path}" in window.banner.text.text())
    get_autosave_path(slot).write_text('{"format": "calibgui-pro', encoding="utf-8")
    window.banner.dismiss.click()
    window.files.recoverable.emit(slot)
    qtbot.waitUntil(lambda: "had no name yet. Its state" in window.banner.text.text())
    get_autosave_path(slot).unlink()


def test_what_is_discarded_is_kept(
    full: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(questions, "ask", lambda *_: Answer.Discard)
    full.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "new.png")]))
    full.files.keep_work()
    slot = full.files.saver.file
    full.files.new()
    assert not full.session.project.views
    assert find_unsaved_work(slot) is None
    (kept,) = get_discarded_folder().iterdir()
    assert "new.png" in read_project(kept).views[-1].image


def test_the_window_opens_without_a_home_and_says_so(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "file" / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    window = MainWindow()
    window.show()
    qtbot.waitExposed(window)
    assert "Check HOME" in window.banner.text.text()
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "new.png")]))
    window.files.keep_work()
    assert tmp_path in get_autosave_path(window.files.saver.file).parents
    window.session.document.undo()
    window.close()
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def test_work_left_without_a_file_is_offered_until_it_is_decided_about(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    left = window.files.saver.file
    window.files.saver.close()  # as if the program had been killed then
    autosave(examples.calibrated(tmp_path), left)
    for answered in (False, True):
        session = Session()
        saver = Saver(session)
        offered: list[Path] = []
        saver.recoverable.connect(offered.append)
        saver.check_slot()
        assert offered == [left]
        session.begin(Document(add_images(Project(), [str(tmp_path / "1.png")]), saved=False))
        saver.autosave_now()
        assert len(read_project(get_autosave_path(left)).views) == 7
        if answered:
            saver.recover(left)
            qtbot.waitUntil(lambda session=session: len(session.project.views) == 7)
            assert session.document.path is None and not session.document.saved
            assert find_unsaved_work(left) is None
            assert len(read_project(get_autosave_path(saver.file)).views) == 7
        session.jobs.close()
        saver.close()
        session.deleteLater()


def test_a_file_that_cannot_be_written_is_reported(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    window.session.begin(Document(examples.calibrated(tmp_path), tmp_path / "gone" / "p.json"))
    window.files.save()
    qtbot.waitUntil(window.banner.isVisible)
    assert "p.json cannot be written" in window.banner.text.text()


@pytest.mark.usefixtures("qapp")
def test_two_programs_do_not_share_a_slot() -> None:
    savers = [Saver(Session()) for _ in range(2)]
    assert savers[0].file != savers[1].file
    for saver in savers:
        saver.close()
        saver.parent().jobs.close()


def test_saving_twice_at_once_keeps_the_later_state(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "project.json"
    window.session.begin(Document(examples.calibrated(tmp_path), path, saved=False))
    window.files.save()
    window.session.edit("Add", lambda p: add_images(p, [str(tmp_path / "new.png")]))
    window.files.save()
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert window.session.document.saved
    assert len(read_project(path).views) == 8


def spoil(text: str) -> dict[str, bytes]:
    """Return contents that are no project, by what is wrong with them."""
    content = json.loads(text)
    return {
        "nothing": b"",
        "cut short": text[: len(text) // 2].encode(),
        "no text": bytes(range(256)),
        "nested": b'{"format": "calibgui-project", "version": 4, "views": ' + b"[" * 100_000,
        "a list": b"[1, 2]",
        "results": json.dumps(content | {"results": []}).encode(),
        "later": json.dumps(content | {"version": 99}).encode(),
        "huge": json.dumps(content | {"size": [10**400, 1]}).encode(),
    }


def test_a_spoilt_file_is_refused_in_the_banner_and_the_work_stays(
    full: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    project = full.session.project
    write_project(project, tmp_path / "whole.json")
    text = (tmp_path / "whole.json").read_text(encoding="utf-8")
    full.session.document.mark_saved(project, full.files.saver.file)
    for what, content in spoil(text).items():
        (tmp_path / "spoilt.json").write_bytes(content)
        full.files.open_project(tmp_path / "spoilt.json")
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=20_000)
        assert QApplication.activeModalWidget() is None, what
        assert full.banner.isVisible() and "spoilt.json" in full.banner.text.text(), what
        assert full.session.project is project, what
        full.banner.dismiss.click()

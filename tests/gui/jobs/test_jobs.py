from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest
import shiboken6
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs


@pytest.fixture
def jobs(qapp: QApplication) -> Iterator[Jobs]:
    jobs = Jobs(qapp)
    yield jobs
    jobs.close()


def test_everything_but_the_work_happens_on_the_main_thread(qtbot: QtBot, jobs: Jobs) -> None:
    seen: dict[str, threading.Thread] = {}

    def note(name: str) -> Any:
        return lambda *_: seen.setdefault(name, threading.current_thread())

    def work(job: Job) -> int:
        note("work")()
        assert job.send("half way")
        return 7

    results: list[int] = []
    jobs.start(
        "Counting",
        work,
        lambda result: (note("done")(), results.append(result)),
        received=note("received"),
        ended=note("ended"),
    )
    qtbot.waitUntil(lambda: "ended" in seen)
    assert results == [7]
    assert seen.pop("work") is not threading.main_thread()
    assert seen.keys() == {"received", "done", "ended"}
    assert set(seen.values()) == {threading.main_thread()}
    assert not jobs.running


def test_a_job_says_what_it_does_now(qtbot: QtBot, jobs: Jobs) -> None:
    labels: list[str] = []
    jobs.changed.connect(lambda: labels.extend(job.label for job in jobs.running))
    going = threading.Event()

    def work(job: Job) -> None:
        job.rename("Preparing")
        going.wait(10)

    job = jobs.start("Counting", work)
    qtbot.waitUntil(lambda: job.label == "Preparing", timeout=5000)
    assert labels[0] == "Counting" and labels[-1] == "Preparing"
    going.set()
    qtbot.waitUntil(lambda: not jobs.running, timeout=5000)


def test_results_of_changed_inputs_are_dropped_item_by_item(qtbot: QtBot, jobs: Jobs) -> None:
    revision = {"a": 1, "b": 1}
    go = threading.Event()
    found: list[str] = []

    def work(item: str) -> str:
        go.wait(5)
        return item

    job = jobs.each(
        "Finding", ["a", "b"], work, lambda item, _: found.append(item), inputs=revision.__getitem__
    )
    revision["a"] = 2
    go.set()
    qtbot.waitUntil(lambda: not jobs.running)
    assert found == ["b"]
    assert job.finished == 2


def test_cancel_drops_and_stop_keeps(qtbot: QtBot, jobs: Jobs) -> None:
    def until_stopped(job: Job) -> str:
        while job.send("still at it"):
            threading.Event().wait(0.001)
        return "best so far"

    kept: list[str] = []
    ended: list[str] = []
    for end in (Job.stop, Job.cancel):
        job = jobs.start("Solving", until_stopped, kept.append, ended=lambda: ended.append(""))
        qtbot.wait(50)
        end(job)
        qtbot.waitUntil(lambda: not jobs.running)
    assert kept == ["best so far"]
    assert len(ended) == 2


def test_a_failure_without_a_taker_is_announced(qtbot: QtBot, jobs: Jobs) -> None:
    def fails(_: Job) -> None:
        raise RuntimeError("by design")

    with qtbot.waitSignal(jobs.failed) as announced:
        jobs.start("Failing", fails)
    assert str(announced.args[0]) == "by design"
    taken: list[Exception] = []
    jobs.start("Failing", fails, failed=taken.append)
    qtbot.waitUntil(lambda: bool(taken))


def test_delayed_work_counts_as_running_and_begins_later(qtbot: QtBot, jobs: Jobs) -> None:
    done: list[int] = []
    jobs.each("Doubling", [1, 2], lambda item: 2 * item, lambda _, r: done.append(r), delay=60)
    assert jobs.running
    qtbot.wait(20)
    assert done == []
    qtbot.waitUntil(lambda: not jobs.running)
    assert sorted(done) == [2, 4]


def test_delayed_work_does_not_begin_once_the_jobs_are_closed(
    qtbot: QtBot, qapp: QApplication
) -> None:
    jobs, begun = Jobs(qapp), threading.Event()
    jobs.each("Never", [1], lambda _: begun.set(), delay=20)
    jobs.close()
    with qtbot.captureExceptions() as raised:
        qtbot.wait(60)
    assert not raised and not begun.is_set()


def test_no_items_is_no_work(qtbot: QtBot, jobs: Jobs) -> None:
    ended: list[int] = []
    job = jobs.each("Nothing", [], str, ended=lambda: ended.append(1))
    assert job.seconds_left is None
    qtbot.waitUntil(lambda: bool(ended))


def test_nobody_is_told_after_the_owner_is_gone(qtbot: QtBot, jobs: Jobs) -> None:
    owner, go, heard = QObject(), threading.Event(), []

    def work(job: Job) -> None:
        go.wait(5)
        job.send("a record")

    def hear(*_: object) -> None:
        heard.append(1)

    jobs.start("Working", work, hear, received=hear, ended=lambda: hear(), owner=owner)
    shiboken6.delete(owner)
    go.set()
    qtbot.waitUntil(lambda: not jobs.running)
    assert not heard


def test_a_callback_that_fails_does_not_keep_the_job_alive(qtbot: QtBot, jobs: Jobs) -> None:
    def fails(*_: object) -> None:
        raise RuntimeError("by design")

    with qtbot.capture_exceptions() as caught:
        jobs.start("Failing", lambda _: 1, fails, failed=fails)
        qtbot.waitUntil(lambda: not jobs.running)
    assert [str(error[1]) for error in caught] == ["by design"]


def test_the_time_left_is_told_once_it_is_known(
    jobs: Jobs, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two workers start for 10 s, then each part takes 0.2 or 0.6 s."""
    now = 0.0
    job = jobs.start("Parts", lambda _: None)
    monkeypatch.setattr("calibgui.gui.jobs.job.time.monotonic", lambda: now)
    told: list[tuple[float, float]] = []
    now = 10.0
    for finished in range(1, 41):
        job.note_finished(finished, 40)
        if (left := job.seconds_left) is not None:
            told.append((left, 0.4 * (40 - finished)))
        now += 0.2 if finished % 2 else 0.6
    assert 30 < len(told) < 39
    assert all(abs(left - true) <= true / 3 + 0.2 for left, true in told)
    monkeypatch.undo()
    qtbot.waitUntil(lambda: not jobs.running)

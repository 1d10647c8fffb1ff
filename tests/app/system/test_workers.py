"""Work in other processes: complete, stoppable, and no worse than the item that breaks it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from functools import partial
from multiprocessing.process import BaseProcess
from pathlib import Path
from threading import Event
from types import ModuleType

import pytest

from calibgui.app.system import workers
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.engine.errors import CalibrationError, Cancelled


@pytest.fixture(params=["forked", "spawned"], autouse=True)
def _start(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers are started in both ways, whatever threads the tests themselves have."""
    forks = request.param == "forked"
    if forks and sys.platform != "linux":
        pytest.skip("processes are forked on Linux only")
    monkeypatch.setattr(workers, "_can_fork", lambda: forks)


def _note_process() -> None:
    """Leave a trace of the process that prepares."""
    prepared_in.append(os.getpid())


prepared_in: list[int] = []


def test_every_item_is_done_and_told_with_its_index() -> None:
    items = [4.0, 9.0, 16.0]
    assert dict(map_in_processes(partial(pow, exp=2), items)) == {0: 16.0, 1: 81.0, 2: 256.0}
    assert not multiprocessing.active_children()


def test_nothing_to_do_starts_nothing() -> None:
    assert list(map_in_processes(abs, [])) == []


def test_each_worker_keeps_to_one_thread() -> None:
    asked = [
        "__import__('cv2').getNumThreads()",
        "max(x['num_threads'] for x in __import__('threadpoolctl').threadpool_info())",
    ]
    assert dict(map_in_processes(eval, asked)) == {0: 1, 1: 1}


def test_a_set_event_ends_work_under_way() -> None:
    stop = Event()
    work = map_in_processes(time.sleep, [0.0, 3600.0, 3600.0], stop)
    next(work)
    stop.set()
    with pytest.raises(Cancelled):
        next(work)
    assert not multiprocessing.active_children()


def test_closing_ends_work_under_way() -> None:
    work = map_in_processes(time.sleep, [0.0, 3600.0, 3600.0])
    next(work)
    work.close()
    assert not multiprocessing.active_children()


def test_a_process_that_dies_costs_its_item_only() -> None:
    expressions = ["1", "__import__('os')._exit(3)", "__import__('os')._exit(3)", "2", "3"]
    results = dict(map_in_processes(eval, expressions))
    assert isinstance(results.pop(1), Crashed)
    assert isinstance(results.pop(2), Crashed)
    assert results == {0: 1, 3: 2, 4: 3}


def test_a_process_that_dies_before_it_begins_costs_nothing() -> None:
    """It follows the only one that has begun, which is killed at its second item."""
    work = map_in_processes(eval, ["1", "__import__('time').sleep(3600)", "3"], count=1)
    assert next(work) == (0, 1)
    (first,) = multiprocessing.active_children()
    first.kill()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(workers, "_run_worker", _end_at_once)
        index, crashed = next(work)
    assert index == 1 and isinstance(crashed, Crashed)
    assert list(work) == [(2, 3)]


def _end_at_once(*_: object) -> None:
    os._exit(3)


def test_an_exception_comes_through_with_its_traceback() -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        list(map_in_processes(eval, ["1 / 0"]))
    assert "Traceback" in "".join(caught.value.__notes__)


def test_what_is_prepared_is_prepared_once_before_the_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where workers are forked, this process prepares, and they have what it left; others load what
    they need themselves."""
    monkeypatch.setattr(workers, "_prepared", set())
    prepared_in.clear()
    asked = [f"__import__({__name__!r}, fromlist=['prepared_in']).prepared_in"] * 4
    found = [here for _, here in map_in_processes(eval, asked, prepare=_note_process)]
    assert found == ([[os.getpid()]] * 4 if workers._can_fork() else [[]] * 4)
    again = [here for _, here in map_in_processes(eval, asked, prepare=_note_process)]
    assert all(here == prepared_in for here in again)


def test_workers_that_cannot_start_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    if workers._can_fork():
        pytest.skip("a fork has the modules of its parent")
    only_here = ModuleType("only_here")
    exec("def task(item):\n    return item\n", only_here.__dict__)
    monkeypatch.setitem(sys.modules, "only_here", only_here)
    with pytest.raises(CalibrationError, match="ended before it could begin") as caught:
        list(map_in_processes(only_here.task, [1, 2, 3]))
    assert "start this program anew" in caught.value.hint
    assert not multiprocessing.active_children()


def test_processes_that_the_system_refuses_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first is started, and ends with the error about the second."""
    start, begun = BaseProcess.start, []

    def start_one(process: BaseProcess) -> None:
        if begun:
            raise BlockingIOError("Resource temporarily unavailable")
        begun.append(process)
        start(process)

    monkeypatch.setattr(BaseProcess, "start", start_one)
    with pytest.raises(CalibrationError, match="ended before it could begin"):
        list(map_in_processes(abs, [1, 2, 3], count=2))
    assert begun and not multiprocessing.active_children()


def test_a_process_that_dies_within_its_answer_costs_its_item_only() -> None:
    answers = dict(map_in_processes(eval, [_HALF_AN_ANSWER, "2"], count=1))
    assert isinstance(answers[0], Crashed) and answers[1] == 2


_HALF_AN_ANSWER = (
    "[__import__('os').write(c.fileno(), b'\\0\\0\\0\\x64half') "
    "for c in __import__('gc').get_objects() "
    "if type(c) is __import__('multiprocessing.connection').connection.Connection "
    "and not c.closed and c.writable] and __import__('os')._exit(3)"
)
"""Writes the length of a message and its beginning to the parent, and dies."""


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="needs POSIX signals")
def test_the_first_worker_is_as_deaf_to_ctrl_c_as_the_others(tmp_path: Path) -> None:
    """Python starts a process of its own with it, and unblocks the signal after that."""
    script = tmp_path / "first.py"
    script.write_text(
        "from calibgui.app.system.workers import map_in_processes\n"
        "blocked = \"__import__('signal').pthread_sigmask(0, [])\"\n"
        "if __name__ == '__main__':\n"
        "    print([sorted(mask) for _, mask in map_in_processes(eval, [blocked])])\n",
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert "SIGINT" in done.stdout


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
def test_a_worker_ends_on_sigterm_without_a_word(tmp_path: Path) -> None:
    """What its parent does then, which a forked worker has a copy of, is not for it."""
    script = tmp_path / "asked.py"
    script.write_text(
        "import signal\n"
        "from calibgui.app.system.workers import map_in_processes\n"
        "asked = [\"__import__('os').kill(__import__('os').getpid(), 15)\", '2']\n"
        "if __name__ == '__main__':\n"
        "    signal.signal(signal.SIGTERM, signal.default_int_handler)\n"
        "    found = dict(map_in_processes(eval, asked, count=1))\n"
        "    print(type(found[0]).__name__, found[1])\n",
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("Crashed 2\n", "")


def test_one_process_of_many_does_its_tasks_itself() -> None:
    asked = ["__import__('os').getpid()"] * 3
    with workers.do_tasks_here():
        assert list(map_in_processes(eval, asked)) == [(k, os.getpid()) for k in range(3)]
        stop = Event()
        stop.set()
        with pytest.raises(Cancelled):
            list(map_in_processes(eval, asked, stop))
    assert os.getpid() not in dict(map_in_processes(eval, asked)).values()


def test_no_more_processes_than_asked_for() -> None:
    asked = ["__import__('os').getpid()"] * 4
    assert len(set(dict(map_in_processes(eval, asked, count=1)).values())) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="processes have no niceness there")
def test_the_workers_of_a_window_come_after_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = ["__import__('os').getpriority(0, 0)"]
    own = os.getpriority(os.PRIO_PROCESS, 0)
    monkeypatch.setattr(workers, "_has_window", lambda: False)
    assert dict(map_in_processes(eval, asked)) == {0: own}
    monkeypatch.setattr(workers, "_has_window", lambda: True)
    assert dict(map_in_processes(eval, asked)) == {0: min(19, own + 5)}


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_workers_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    """They wait for the next item, and hear of no more: forked ones hold each other's pipes."""
    script = tmp_path / "parent.py"
    start = "fork" if workers._can_fork() else "spawn"
    script.write_text(
        "import os, signal, sys\n"
        "from calibgui.app.system import workers\n"
        f"workers._can_fork = lambda: {start == 'fork'}\n"
        "if __name__ == '__main__':\n"
        "    asked = [\"__import__('os').getpid()\"] * 2 + [\"__import__('time').sleep(1)\"] * 2\n"
        "    for k, number in workers.map_in_processes(eval, asked, count=2):\n"
        "        print(number, flush=True)\n"
        "        if k == 1: os.kill(os.getpid(), signal.SIGKILL)\n",
        encoding="utf-8",
    )
    printed = tmp_path / "printed.txt"
    with printed.open("w") as file:  # a pipe would be open for as long as a worker lives
        done = subprocess.run([sys.executable, script], stdout=file, check=False)
    assert done.returncode == -signal.SIGKILL
    left = {int(line) for line in printed.read_text().split()}
    deadline = time.monotonic() + 20
    while left and time.monotonic() < deadline:
        time.sleep(0.05)
        left = {number for number in left if Path(f"/proc/{number}").exists()}
    for number in left:
        os.kill(number, signal.SIGKILL)
    assert not left

"""SIGTERM at any moment: no traceback, no process that is left, nothing torn, the exit code 143."""

from __future__ import annotations

import importlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from calibgui.cli.main import main
from calibgui.cli.termination import TerminationRequest
from calibgui.formats.fleet_ledger import open_ledger
from tests.scenes.fleet import write_fleet

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

_MOMENTS = 4
_WITH_WORKERS = 3
"""Processes of a window that searches: its own, Python's resource tracker, and a worker."""
_BY_THE_HANDLER, _BY_THE_SYSTEM = 143, -signal.SIGTERM
"""Exit codes: 143 once a command is loaded; before that the system ends it, which a shell calls
143 as well."""


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fleet")
    write_fleet(folder, range(3))
    return folder


def start(arguments: Sequence[str | Path], out: Path, **environment: str) -> subprocess.Popen[str]:
    """Start a command in a session of its own, which names all that comes from it."""
    out.mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, "-m", "calibgui", *map(str, arguments)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env=os.environ | {"PYTHONFAULTHANDLER": "1"} | environment,
    )


def read_errors(process: subprocess.Popen[str]) -> str:
    """Wait for the end of a command, and return what it wrote on its standard error.

    One that does not end is made to say what it is doing.
    """
    try:
        return process.communicate(timeout=60)[1]
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGABRT)
        said = process.communicate(timeout=60)[1]
        for number in list_session(process.pid):
            os.kill(number, signal.SIGKILL)
        raise AssertionError(f"It did not end.\n{said}") from None


def list_session(session: int) -> list[int]:
    """Return the numbers of the processes of a session that have not ended."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            cells = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(cells[3]) == session and cells[0] != "Z":
            found.append(int(folder.name))
    return found


def wait_for_end(session: int) -> list[int]:
    """Return what is left of a session when it has had time to end."""
    deadline = time.monotonic() + 30
    while (left := list_session(session)) and time.monotonic() < deadline:
        time.sleep(0.05)
    for number in left:
        os.kill(number, signal.SIGKILL)
    return left


def check_json(out: Path) -> None:
    for file in out.rglob("*.json"):
        json.loads(file.read_text())


def check_files(out: Path) -> None:
    check_json(out)
    assert not list(out.rglob(".calibgui.*"))


def check_fleet(out: Path) -> None:
    """What is in the ledger is whole; SQLite makes it so when it is opened next. A worker that is
    killed while it writes leaves a temporary file."""
    check_json(out)
    if (out / "fleet.db").exists():
        with open_ledger(out / "fleet.db", create=True) as ledger:
            assert all(camera.passed for camera in ledger.read())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "check"),
    [
        ("calibrate {fleet}/c0 --square 30 -o {out}/result.json", check_files),
        ("batch {fleet} --square 30 --board 6x7 --workers 2 -o {out}/fleet.db", check_fleet),
    ],
)
def test_a_command_ends_at_any_moment(
    command: str, check: Callable[[Path], None], fleet: Path, tmp_path: Path
) -> None:
    def begin(out: Path) -> subprocess.Popen[str]:
        return start([part.format(fleet=fleet, out=out) for part in command.split()], out)

    clock = time.monotonic()
    with begin(tmp_path / "whole") as process:
        _, said = process.communicate()
    assert process.returncode == 0, said
    whole = time.monotonic() - clock
    codes = []
    for moment in range(_MOMENTS):
        rng = random.Random(moment)
        out = tmp_path / str(moment)
        with begin(out) as process:
            time.sleep(rng.uniform(0.05, 1) * whole)
            # Half the time all of its processes are asked, as by a terminal or a service manager.
            ask = os.killpg if moment % 2 else os.kill
            ask(process.pid, signal.SIGTERM)
            said = read_errors(process)
        assert "Traceback" not in said, (moment, said)
        if process.returncode not in (0, _BY_THE_HANDLER, _BY_THE_SYSTEM):
            pytest.fail(f"moment {moment}: code {process.returncode}\n{said}")  # the whole stack
        assert not wait_for_end(process.pid), moment
        check(out)
        shutil.rmtree(out)
        codes.append(process.returncode)
    assert _BY_THE_HANDLER in codes


@pytest.mark.slow
def test_the_window_ends_at_any_moment(fleet: Path, tmp_path: Path) -> None:
    pytest.importorskip("PySide6.QtWidgets", exc_type=ImportError)
    codes = []
    for moment in range(3):
        with start([fleet / "c0"], tmp_path, QT_QPA_PLATFORM="offscreen", DISPLAY=":0") as process:
            time.sleep(random.Random(moment).uniform(0.5, 8))
            process.terminate()
            said = read_errors(process)
        assert "Traceback" not in said, (moment, said)
        assert process.returncode in (_BY_THE_HANDLER, _BY_THE_SYSTEM), (moment, said)
        assert not wait_for_end(process.pid), moment
        codes.append(process.returncode)
    assert _BY_THE_HANDLER in codes


@pytest.mark.slow
def test_the_window_keeps_what_is_not_saved(fleet: Path, tmp_path: Path) -> None:
    """It is asked once the corners are searched, sooner than its clock would write them."""
    pytest.importorskip("PySide6.QtWidgets", exc_type=ImportError)
    state = tmp_path / "state"
    environment = {"QT_QPA_PLATFORM": "offscreen", "DISPLAY": ":0", "XDG_STATE_HOME": str(state)}
    with start([fleet / "c0"], tmp_path, **environment) as process:
        while len(list_session(process.pid)) < _WITH_WORKERS:
            time.sleep(0.01)
        process.terminate()
        said = read_errors(process)
    assert process.returncode == _BY_THE_HANDLER, said
    (work,) = state.rglob("*.autosave")
    kept = work.read_text()
    assert all(file.name in kept for file in (fleet / "c0").glob("*.png"))


def test_a_request_that_python_drops_is_made_again() -> None:
    """It is raised where an object is freed, from where no exception gets out."""

    class Freed:
        def __del__(self) -> None:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(0.01)

    request = TerminationRequest()
    with pytest.raises(KeyboardInterrupt), request.heed():
        Freed()
        time.sleep(10)
    assert request.is_made


def test_a_request_waits_while_a_module_is_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A module that takes every error for a missing part would go on without it."""
    (tmp_path / "module_that_hides_errors.py").write_text(
        "import os, signal, time\n"
        "try:\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    time.sleep(0.05)\n"
        "    is_whole = True\n"
        "except BaseException:\n"
        "    is_whole = False\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    module = None
    with pytest.raises(KeyboardInterrupt), TerminationRequest().heed():
        module = importlib.import_module("module_that_hides_errors")
        time.sleep(10)
    assert module is not None
    assert module.is_whole


def test_an_error_in_place_of_the_request_is_no_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As of a library in C that calls back into Python."""

    def run(*_: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(10)
        except KeyboardInterrupt:
            raise SystemError("error return without exception set") from None

    monkeypatch.setattr("calibgui.cli.detect.run", run)
    assert main(["detect", "a.png"]) == 143
    assert capsys.readouterr().err == "calibgui: interrupted.\n"

"""Every ending of the program: its exit code, and what it prints and leaves behind."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import re
import select
import shlex
import signal
import struct
import subprocess
import sys
import tomllib
import warnings
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from calibgui import __version__
from calibgui.app.system import missing_library
from calibgui.app.system.missing_library import describe_missing_library
from calibgui.app.system.resources import find_resource
from calibgui.cli import corners, detect
from calibgui.cli.main import main
from calibgui.cli.parser import COMMANDS
from calibgui.engine.kernels import NumbaWarning
from tests.photographs import COUNT

Capture = pytest.CaptureFixture[str]
_PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"

posix = pytest.mark.skipif(os.name != "posix", reason="signals and terminals of POSIX")


def program(*arguments: str | Path) -> list[str]:
    return [sys.executable, "-m", "calibgui", *map(str, arguments)]


def test_without_arguments_or_screen_it_shows_its_commands(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    assert main([]) == 2
    printed, problems = capsys.readouterr()
    for command in COMMANDS:
        assert command in printed
    assert problems.startswith("calibgui: there is no display: ")


def test_all_versions(capsys: Capture) -> None:
    """Those of every package that pyproject.toml lists for users."""
    assert main(["--version", "--json"]) == 0
    versions = json.loads(capsys.readouterr().out)
    assert versions["calibgui"] == __version__
    assert versions["numpy"] == np.__version__ and versions["system"]
    project = tomllib.loads(_PYPROJECT.read_text(encoding="utf-8"))["project"]
    extras = {
        name: each for name, each in project["optional-dependencies"].items() if name != "dev"
    }
    listed = [*project["dependencies"], *itertools.chain(*extras.values())]
    assert {re.split(r"[^\w-]", each)[0] for each in listed} <= versions.keys()


def test_its_version(capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert __version__ in capsys.readouterr().out


def test_a_warning_of_ours_is_a_sentence_without_lines_of_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def warn(*_: object) -> None:
        for category in (NumbaWarning, RuntimeWarning):
            print(warnings.formatwarning("something is slow", category, "a.py", 7))

    monkeypatch.setattr(detect, "run", warn)
    assert main(["detect", str(tmp_path), "-o", str(tmp_path / "corners.json")]) == 0
    ours, other = capsys.readouterr().out.split("\n\n", 1)
    assert ours == "calibgui: something is slow"
    assert other.startswith("a.py:7: RuntimeWarning: something is slow")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_describes_itself(command: str, capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    printed = capsys.readouterr().out
    assert f"usage: calibgui {command}" in printed
    lines = printed.splitlines()
    assert max(map(len, lines)) <= 80 and len(lines) <= 110


def test_help_lists_what_is_used_most_and_all_if_that_is_asked_for(capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["calibrate", "photographs", "--help"])
    short = capsys.readouterr().out
    assert "--square MM" in short and "--weigh-views" not in short
    assert len(short.splitlines()) < 80
    with pytest.raises(SystemExit):
        main(["calibrate", "-h", "all"])
    whole = capsys.readouterr().out
    options = set(re.findall(r"^  (?:-\w.*?, )?(--[\w-]+)", whole, re.MULTILINE))
    more = int(re.search(r"calibrate --help all describes (\d+) more", short)[1])
    listed = set(re.findall(r"^  (?:-\w.*?, )?(--[\w-]+)", short, re.MULTILINE))
    assert listed < options and len(options - listed) - 1 == more  # and help itself


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ("calibarte", "calibgui: 'calibarte' is neither a command nor a file or folder. Did you "
         "mean calibgui calibrate?"),
        ("photos/samle", "calibgui: there is no such file or folder: photos/samle. Did you mean "
         "photos/sample?"),
        ("photos/sample nowhere", "calibgui: there is no such file or folder: nowhere."),
        ("photos/sample --square 30", "calibgui: --square belongs to a command, and none is named. "
         "Did you mean calibgui calibrate photos/sample --square ...?"),
        ("--versoin", "calibgui: there is no option --versoin. Did you mean --version?"),
        ("-q calibrate photos", "calibgui: options follow the command: calibgui calibrate -q ..."),
        ("help", "calibgui: 'help' is an option. Did you mean calibgui --help?"),
        ("calibrate photos --sqare=30", "calibgui calibrate: there is no option --sqare. Did you "
         "mean --square?"),
        ("calibrate photos -Z", "calibgui calibrate: there is no option -Z."),
        ("diff a b c", "calibgui diff: 'c' is one argument too many."),
        ("paper", "calibgui paper: the following arguments are required: DIR, -o/--output"),
    ],
)  # fmt: skip
def test_wrong_usage_is_two_lines_with_what_was_meant(
    arguments: str,
    problem: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    (tmp_path / "photos/sample").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("DISPLAY", ":0")
    with pytest.raises(SystemExit) as ended:
        main(arguments.split())
    assert ended.value.code == 2
    said, usage = capsys.readouterr().err.splitlines()
    assert said == problem
    assert usage.startswith("usage: calibgui ") and len(usage) <= 80


def test_without_a_display_it_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    assert main([str(tmp_path)]) == 1
    problem = capsys.readouterr().err
    assert problem.startswith("calibgui: there is no display: neither DISPLAY nor WAYLAND_DISPLAY")
    assert problem.endswith(f"calibgui calibrate {tmp_path} --square MM\n")


@pytest.fixture
def with_x11() -> None:
    """Skip where the libraries are missing that the window needs on X11, as tests do not."""
    if not sys.platform.startswith("linux"):
        pytest.skip("X11 is of Linux here")
    module = pytest.importorskip("calibgui.gui.app", reason="Qt's system libraries are missing")
    if problem := module._try_to_load_plugin():
        pytest.skip(problem)


@pytest.mark.usefixtures("with_x11")
def test_a_display_that_cannot_be_reached_is_said(tmp_path: Path) -> None:
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("QT_", "WAYLAND"))}
    done = subprocess.run(
        program(tmp_path),
        env=environment | {"DISPLAY": ":4711", "QT_QPA_PLATFORM": "xcb"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == (
        "calibgui: the window cannot be opened. There is no display that Qt can open: could not "
        "connect to display :4711.\ncalibgui --help lists the commands that need no window.\n"
    )


@pytest.mark.usefixtures("with_x11")
def test_a_library_that_the_window_needs_is_named_with_its_package(tmp_path: Path) -> None:
    (tmp_path / "libxcb-cursor.so.0").touch()  # is found first, and is none
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("QT_", "WAYLAND"))}
    done = subprocess.run(
        program(tmp_path),
        env=environment | {"DISPLAY": ":4711", "LD_LIBRARY_PATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == (
        "calibgui: the window cannot be opened. The library libxcb-cursor.so.0 is missing. On "
        "Debian and Ubuntu: apt install libxcb-cursor0\n"
        "calibgui --help lists the commands that need no window.\n"
    )


@pytest.mark.parametrize(
    ("problem", "package"),
    [
        ("libxkbcommon-x11.so.0: cannot open shared object file", "libxkbcommon-x11-0"),
        ("libEGL.so.1: cannot open shared object file", "libegl1"),
        ("/lib/libX11-xcb.so.1: file too short", "libx11-xcb1"),
        ("libgthread-2.0.so.0: cannot open shared object file", "libglib2.0-0"),
        ("libgssapi_krb5.so.2: cannot open shared object file", "libgssapi-krb5-2"),
    ],
)
def test_packages_of_libraries(problem: str, package: str) -> None:
    assert describe_missing_library(problem).endswith(f"apt install {package}")
    listed = find_resource("system/debian-packages.txt").read_text("utf-8")
    assert package in listed.split()


def test_all_libraries_that_are_missing_are_named_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = tmp_path / "packages.txt"
    listed.write_text(
        "# package library purpose\nlibc6 libc.so.6 qt\n"
        "absent1 libabsent.so.1 qt\nother1 libother.so.1 window\n"
    )
    monkeypatch.setattr(missing_library, "find_resource", lambda _: listed)
    said = describe_missing_library("libabsent.so.1: cannot open shared object file")
    assert said == (
        "These libraries are missing: libabsent.so.1, libother.so.1. On Debian and Ubuntu: "
        "apt install absent1 other1"
    )
    assert "libnew7" in describe_missing_library("libnew.so.7: cannot open shared object file")
    assert describe_missing_library("the disk is full") == ""


def test_without_qt_it_says_how_to_get_the_window(tmp_path: Path) -> None:
    lines = (
        "import sys; sys.modules.update(PySide6=None, shiboken6=None);"
        "from calibgui.cli.main import main"
    )
    done = subprocess.run(
        [sys.executable, "-c", f"{lines}; sys.exit(main(sys.argv[1:]))", tmp_path],
        env=os.environ | {"DISPLAY": ":0"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == (
        "calibgui: the window is not installed. Give this command in the folder that calibgui was "
        f"installed from: {shlex.quote(sys.executable)} -m pip install '.[gui]'\n"
    )


@pytest.mark.parametrize("package", ["PySide6.QtGui", None])
def test_a_library_that_the_window_lacks_is_named(
    package: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    reason = "libEGL.so.1: cannot open shared object file: No such file or directory"

    def fail(name: str) -> object:
        if name == "calibgui.gui.app":
            raise ImportError(reason, name=package)
        return import_module(name)

    monkeypatch.setattr("calibgui.cli.main.import_module", fail)
    monkeypatch.setenv("DISPLAY", ":0")
    assert main([str(tmp_path)]) == 1
    assert capsys.readouterr().err == (
        "calibgui: the window cannot be loaded. The library libEGL.so.1 is missing. On Debian and "
        "Ubuntu: apt install libegl1\n"
    )


def test_a_bug_shows_traceback_and_versions(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(corners, "search_images", lambda *_, **__: 1 / 0)
    assert main(["detect", "a.png"]) == 70
    problems = capsys.readouterr().err
    for word in ("Traceback", "ZeroDivisionError", "bug", f"calibgui {__version__}", "numpy"):
        assert word in problems


def test_an_interruption_is_not_a_bug(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(corners, "search_images", interrupt)
    assert main(["detect", "a.png"]) == 130
    assert capsys.readouterr() == ("", "calibgui: interrupted.\n")


@posix
def test_ctrl_c_during_the_search_leaves_nothing(photographs: Path, tmp_path: Path) -> None:
    images, out = tmp_path / "images", tmp_path / "out"
    images.mkdir()
    out.mkdir()
    for k in range(3000):
        os.link(photographs / f"view{k % COUNT + 1}.png", images / f"{k}.png")
    with terminal() as (ours, theirs):
        process = subprocess.Popen(
            program("detect", images, "-o", out / "corners.json"),
            stdout=subprocess.DEVNULL,
            stderr=theirs,
            start_new_session=True,
            # A job in the background of a script, as this suite may be, is deaf to Ctrl-C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        shown_until(ours, b"/3000")  # the progress bar: workers are searching
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: the workers get it too
        shown = shown_until(ours, b"interrupted")
        assert process.wait(60) == 130
    assert b"Traceback" not in shown
    assert list(out.iterdir()) == []


@contextlib.contextmanager
def terminal() -> Iterator[tuple[int, int]]:
    """Both ends of a terminal of 80 columns."""
    import fcntl
    import termios

    try:
        ours, theirs = os.openpty()
    except OSError as error:
        pytest.skip(f"this system has no pseudo-terminals: {error}")
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    yield ours, theirs
    os.close(theirs)
    os.close(ours)


def shown_until(screen: int, words: bytes) -> bytes:
    """What appears on a terminal up to `words`; fails if nothing does for a minute."""
    shown = b""
    while words not in shown:
        ready, _, _ = select.select([screen], [], [], 60)
        assert ready, shown
        shown += os.read(screen, 4096)
    return shown


@posix
def test_a_reader_that_goes_away_is_no_error(corners_file: Path) -> None:
    with subprocess.Popen(
        program("calibrate", corners_file), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        problems = process.stderr.read()
    assert process.returncode == 141
    assert problems == b""


def test_a_terminal_without_unicode_is_served(corners_file: Path, tmp_path: Path) -> None:
    content = json.loads(corners_file.read_text())
    content["views"][0]["image"] = "фото.png"
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    done = subprocess.run(
        program("calibrate", file),
        env=os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"},
        capture_output=True,
        check=True,
    )
    assert done.stdout.isascii() and done.stderr == b""


def test_quiet_still_names_what_was_left_out(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    content = json.loads(corners_file.read_text())
    content["views"].append({"image": "dark.png", "uv": [], "board": [], "reason": "Too dark."})
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    assert main(["calibrate", str(file), "--quiet"]) == 0
    printed, problems = capsys.readouterr()
    assert printed.count("\n") == 1
    assert problems == "Left out\n  dark.png: Too dark.\n"


@posix
def test_a_request_to_end_is_like_ctrl_c(photographs: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    with terminal() as (ours, theirs):
        process = subprocess.Popen(
            program("detect", *[photographs] * 2, "-o", out / "corners.json"),
            stdout=subprocess.DEVNULL,
            stderr=theirs,
        )
        shown_until(ours, b"searching")
        process.terminate()
        shown_until(ours, b"calibgui: interrupted.")
        assert process.wait(60) == 143
    assert list(out.iterdir()) == []


@posix
def test_a_full_disk_behind_stdout_is_no_bug(corners_file: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    for option in ("--json", "--robust"):
        with Path("/dev/full").open("w") as full:
            done = subprocess.run(
                program("calibrate", corners_file, option),
                stdout=full,
                stderr=subprocess.PIPE,
                check=False,
                text=True,
            )
        assert done.returncode == 1
        assert done.stderr.startswith("calibgui: Standard output cannot be written: No space left")


@posix
def test_closed_streams_are_no_bug(corners_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    command = shlex.join(program("calibrate", corners_file, "-o", file))
    assert subprocess.run(["sh", "-c", command + " <&- >&- 2>&-"], check=False).returncode == 0
    assert file.exists()


def test_names_do_not_command_the_terminal(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    content = json.loads(corners_file.read_text())
    content["views"][0]["image"] = "\x1b[31mred\n.png"
    content["views"][1] = {"image": "\x1b[2J.png", "uv": [], "board": []}
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    assert main(["calibrate", str(file), "-v"]) == 0
    printed = capsys.readouterr().out
    assert "\x1b" not in printed
    assert r"\x1b[31mred\n.png" in printed
    assert r"\x1b[2J.png" in printed
    assert main(["calibrate", "\x1b[2J.json"]) == 1
    assert "\x1b" not in capsys.readouterr().err


def test_no_garbage_is_looked_for_among_what_a_command_loads() -> None:
    code = (
        "import contextlib, gc, sys\n"
        "from calibgui.cli.main import main\n"
        "looked = []\n"
        "gc.callbacks.append(lambda phase, _: looked.append('numpy' in sys.modules))\n"
        "with contextlib.suppress(SystemExit):\n"
        "    main(['calibrate', '--help'])\n"
        "print(sum(looked), gc.get_freeze_count(), gc.isenabled())\n"
    )
    command = [sys.executable, "-c", code]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    looked, kept, is_enabled = printed.split()[-3:]
    assert int(looked) < 20  # of some 180, should the formatting of the help look for some
    assert int(kept) > 50_000
    assert is_enabled == "True"

"""The set-up script's judgements; the set-up itself is what CI runs these tests by."""

from __future__ import annotations

import ast
import importlib.util
import io
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

PACKAGE = str(Path(__file__).resolve().parents[2])
SCRIPT = Path(PACKAGE, "packaging", "bootstrap.py")


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location("bootstrap", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


bootstrap = load()


def test_older_pythons_can_read_it() -> None:
    ast.parse(SCRIPT.read_text(encoding="utf-8"), feature_version=(3, 8))


def test_needs_the_standard_library_only() -> None:
    tree = ast.parse(SCRIPT.read_text(encoding="utf-8"))
    names = {
        alias.name if isinstance(node, ast.Import) else node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    assert {str(name).partition(".")[0] for name in names} <= sys.stdlib_module_names


def test_package_list_is_complete() -> None:
    lines = (
        (SCRIPT.parents[1] / "resources/system/debian-packages.txt")
        .read_text(encoding="utf-8")
        .splitlines()
    )
    rows = [line.split() for line in lines if not line.startswith("#")]
    assert all(len(row) == 3 for row in rows)
    assert {purpose for _, _, purpose in rows} == {"qt", "window"}
    assert all(".so." in library for _, library, _ in rows)


@pytest.mark.skipif(sys.platform != "linux", reason="shared libraries by their Debian names")
def test_names_the_package_of_a_library_that_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "resources" / "system"
    folder.mkdir(parents=True)
    (folder / "debian-packages.txt").write_text(
        "# package library purpose\nlibc6 libc.so.6 qt\nabsent1 libabsent.so.1 qt\n"
        "other1 libother.so.1 window\n",
        encoding="utf-8",
    )
    monkeypatch.setattr(bootstrap, "ROOT", tmp_path)
    environment = bootstrap.Environment(tmp_path / "venv")
    assert bootstrap.missing_libraries(environment, {"qt"}) == ["absent1"]
    assert bootstrap.missing_libraries(environment, {"qt", "window"}) == ["absent1", "other1"]
    assert bootstrap.missing_libraries(environment, set()) == []


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is done about missing packages on a machine whose user may install them."""
    done: list[str] = []
    monkeypatch.setattr(bootstrap, "administrator", list)
    monkeypatch.setattr(bootstrap, "unpack", lambda *_: done.append("unpack") or True)
    monkeypatch.setattr(bootstrap, "succeeds", lambda *a, **_: done.append("as root") or bool(a))
    monkeypatch.setattr(bootstrap.shutil, "which", lambda name: f"/usr/bin/{name}")
    return done


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.skipif(sys.platform != "linux", reason="Debian packages")
@pytest.mark.parametrize(
    ("answer", "is_installed"), [("y", True), ("YES", True), ("", False), ("n", False)]
)
def test_asks_before_it_installs_packages_for_the_whole_system(
    answer: str,
    is_installed: bool,
    calls: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "stdin", Terminal(answer + "\n"))
    bootstrap.provide(bootstrap.Environment(tmp_path), ["libgl1"])
    assert ("as root" in calls) == is_installed
    assert ("unpack" in calls) != is_installed
    printed = capsys.readouterr().out
    assert "sudo apt-get install -y --no-install-recommends libgl1" in printed


@pytest.mark.skipif(sys.platform != "linux", reason="Debian packages")
@pytest.mark.parametrize("yes", [False, True])
def test_installs_nothing_as_root_where_nobody_can_be_asked_unless_told_to(
    yes: bool,
    calls: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    bootstrap.provide(bootstrap.Environment(tmp_path), ["libgl1"], yes)
    assert set(calls) == ({"as root"} if yes else {"unpack"})
    if not yes:
        assert "sudo apt-get install -y --no-install-recommends libgl1" in capsys.readouterr().out


@pytest.mark.skipif(sys.platform != "linux", reason="Debian packages")
def test_prints_the_command_where_packages_cannot_be_had(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bootstrap, "administrator", lambda: None)
    monkeypatch.setattr(bootstrap, "unpack", lambda *_: False)
    monkeypatch.setattr(bootstrap.shutil, "which", lambda name: f"/usr/bin/{name}")
    environment = bootstrap.Environment(tmp_path)
    with pytest.raises(
        bootstrap.SetupError, match=r"\n    sudo apt-get install .* libgl1 libegl1$"
    ):
        bootstrap.provide(environment, ["libgl1", "libegl1"])


class TestEnvironment:
    def test_is_of_no_use_before_its_installation_ended(self, tmp_path: Path) -> None:
        environment = bootstrap.Environment(tmp_path / "venv")
        assert environment.holds() is None
        environment.begin()
        assert environment.holds() is None

    def test_is_of_no_use_when_its_sources_changed_or_it_is_broken(self, tmp_path: Path) -> None:
        environment = bootstrap.Environment(tmp_path / "venv")
        environment.begin()
        environment.stamp.write_text(json.dumps({"source": "other", "extra": "dev"}))
        assert environment.holds() is None
        stamp = {"source": environment.source(), "extra": "dev"}
        environment.stamp.write_text(json.dumps(stamp))
        assert environment.holds() is None  # no Python in it
        environment.python = Path(sys.executable)
        assert environment.holds() == "dev"

    def test_replaces_its_own_remains_only(self, tmp_path: Path) -> None:
        environment = bootstrap.Environment(tmp_path / "venv")
        environment.begin()
        (environment.folder / "half-made").touch()
        environment.begin()
        assert not (environment.folder / "half-made").exists()

        environment.stamp.unlink()
        (environment.folder / "precious").touch()
        with pytest.raises(bootstrap.SetupError, match="left alone"):
            environment.begin()
        assert (environment.folder / "precious").exists()

    def test_keeps_the_machines_package_index(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PIP_INDEX_URL", "https://index.example/simple")
        monkeypatch.setenv("PYTHONPATH", "elsewhere")
        variables = bootstrap.Environment(tmp_path).variables()
        assert variables["PIP_INDEX_URL"] == "https://index.example/simple"
        assert "PYTHONPATH" not in variables

    def test_compiles_the_kernels_by_a_command_that_works(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        environment, ended = bootstrap.Environment(tmp_path), []
        environment.python = Path(sys.executable)
        succeeds = bootstrap.succeeds
        monkeypatch.setattr(bootstrap, "succeeds", lambda *a, **k: ended.append(succeeds(*a, **k)))
        monkeypatch.setattr(environment, "variables", lambda: os.environ | {"PYTHONPATH": PACKAGE})
        environment.compile()
        assert ended == [True]

    def test_takes_the_pinned_versions_of_what_is_wanted(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.delenv("PIP_CONSTRAINT", raising=False)
        monkeypatch.setattr(bootstrap, "CONSTRAINTS", tmp_path)
        environment = bootstrap.Environment(tmp_path / "venv")
        environment.folder.mkdir()
        file = tmp_path / f"python3.{sys.version_info[1]}.txt"
        before = environment.source()
        file.write_text(bootstrap.NEXT_EXTRA.join(["base\n", "window\n", "tools\n"]))
        assert environment.source() != before, "other versions make another environment"
        steps: list[tuple[str, ...]] = []
        monkeypatch.setattr(environment, "pip", lambda *arguments: steps.append(arguments))
        pinned = environment.folder / "requirements.txt"
        for extra, content in (
            ("", "base\n"),
            ("gui", "base\nwindow\n"),
            ("dev", "base\nwindow\ntools\n"),
        ):
            environment.install(extra)
            assert pinned.read_text() == content
        assert {"--require-hashes", str(pinned)} <= set(steps[0])
        assert "--no-build-isolation" in steps[1]

        # The user's own constraints, and a Python without a file, take what pyproject allows.
        steps.clear()
        monkeypatch.setenv("PIP_CONSTRAINT", "mine.txt")
        environment.install("dev")
        monkeypatch.delenv("PIP_CONSTRAINT")
        file.unlink()
        environment.install("dev")
        expected = ("-m", "pip", "install", "--editable", f"{bootstrap.ROOT}[dev]")
        assert steps == [expected, expected]

    def test_takes_the_systems_copy_of_pip_where_only_its_module_is_missing(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        environment = bootstrap.Environment(tmp_path / "venv")
        monkeypatch.setattr(bootstrap, "SYSTEM", tmp_path / "system")
        assert environment.find_pip_wheel() is None
        for root in (bootstrap.SYSTEM, environment.debian):
            wheel = root / "usr" / "share" / "python-wheels" / "pip-23.0-py3-none-any.whl"
            wheel.parent.mkdir(parents=True)
            wheel.touch()
            assert environment.find_pip_wheel() == wheel, "what was unpacked comes first"

    def test_finds_libraries_unpacked_for_it(self, tmp_path: Path) -> None:
        libraries = tmp_path / "debian" / "usr" / "lib" / "x86_64-linux-gnu"
        libraries.mkdir(parents=True)
        variables = bootstrap.Environment(tmp_path).variables()
        assert variables["LD_LIBRARY_PATH"].split(os.pathsep)[0] == str(libraries)


@pytest.mark.skipif(os.name != "posix", reason="a script of a shell")
@pytest.mark.skipif(not Path("/usr/share/fonts").is_dir(), reason="has no fonts of the system's")
def test_unpacked_fonts_are_as_wide_as_the_systems(tmp_path: Path) -> None:
    """Full hinting made letters 3 % wider on a bare Debian, and texts of the window did not fit."""
    pytest.importorskip("PySide6", reason="the window is not installed")
    measure = (
        "from PySide6.QtGui import QFont, QFontInfo, QFontMetricsF, QGuiApplication\n"
        "app, font = QGuiApplication([]), QFont('DejaVu Sans', 9)\n"
        "print(QFontInfo(font).family())\n"
        "print(QFontMetricsF(font).horizontalAdvance('centre 0.0057, worst 0.017 px'))\n"
    )
    hinted = bootstrap.FONTS_CONF.format("/usr/share/fonts")
    (slight,) = (line for line in hinted.splitlines() if "hintslight" in line)
    widths = []
    for text in (hinted, hinted.replace(slight, "")):
        (tmp_path / "fonts.conf").write_text(text, encoding="utf-8")
        env = {
            **os.environ,
            "FONTCONFIG_FILE": str(tmp_path / "fonts.conf"),
            "QT_QPA_PLATFORM": "offscreen",
        }
        done = subprocess.run(
            [sys.executable, "-c", measure], env=env, capture_output=True, text=True, check=True
        )
        family, width = done.stdout.splitlines()
        if family != "DejaVu Sans":
            pytest.skip("the font that Debian unpacks is not there")
        widths.append(float(width))
    assert widths[0] < widths[1]


def test_its_commands_find_the_libraries_as_well(tmp_path: Path) -> None:
    environment = bootstrap.Environment(tmp_path / "a venv")
    environment.python.parent.mkdir(parents=True)
    environment.python.write_text(
        f'#!/bin/sh\necho "$LD_LIBRARY_PATH"\nexec {shlex.quote(sys.executable)} "$@"\n'
    )
    commands = [environment.python.with_name(name) for name in ("calibgui", "calibgui-window")]
    for command in (environment.python, *commands):
        command.touch()
        command.chmod(0o755)
    environment.lead_commands_to_libraries()
    assert commands[0].read_text() == "", "there is nothing to find"
    libraries = environment.debian / "usr" / "lib" / "x86_64-linux-gnu"
    libraries.mkdir(parents=True)
    environment.lead_commands_to_libraries()
    displays = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    no_display = {name: value for name, value in os.environ.items() if name not in displays}
    for command in commands:
        done = subprocess.run(
            [command, PACKAGE],
            capture_output=True,
            text=True,
            env=no_display | {"PYTHONPATH": PACKAGE},
            check=False,
        )
        assert done.stdout.startswith(str(libraries))
        assert done.stderr.startswith("calibgui: there is no display")


def test_goes_elsewhere_where_the_checkout_is_read_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CALIBGUI_VENV", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(bootstrap, "ROOT", tmp_path)
    assert bootstrap.place() == tmp_path / ".venv"
    monkeypatch.setattr(bootstrap.os, "access", lambda *_: False)
    assert bootstrap.place().parent == tmp_path / "cache" / "calibgui"
    monkeypatch.setenv("CALIBGUI_VENV", str(tmp_path / "chosen"))
    assert bootstrap.place() == tmp_path / "chosen"


def test_refuses_arguments_that_it_would_drop() -> None:
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "run", "--fast"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "run takes no further arguments" in done.stderr

"""The set-up script's judgements; the set-up itself is what CI runs these tests by."""

from __future__ import annotations

import ast
import importlib.util
import json
import os
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
    lines = (SCRIPT.parent / "debian-packages.txt").read_text(encoding="utf-8").splitlines()
    rows = [line.split() for line in lines if not line.startswith("#")]
    assert all(len(row) == 3 for row in rows)
    assert {purpose for _, _, purpose in rows} == {"qt", "window"}
    assert all(".so." in library for _, library, _ in rows)


@pytest.mark.skipif(sys.platform != "linux", reason="shared libraries by their Debian names")
def test_names_the_package_of_a_library_that_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "packaging"
    folder.mkdir()
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

    def test_compiles_the_kernels_by_a_calibration_that_works(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        environment, ended = bootstrap.Environment(tmp_path), []
        environment.python = Path(sys.executable)
        succeeds = bootstrap.succeeds
        monkeypatch.setattr(bootstrap, "succeeds", lambda *a, **k: ended.append(succeeds(*a, **k)))
        monkeypatch.setattr(environment, "variables", lambda: os.environ | {"PYTHONPATH": PACKAGE})
        environment.compile()
        assert ended == [True]

    def test_finds_libraries_unpacked_for_it(self, tmp_path: Path) -> None:
        libraries = tmp_path / "debian" / "usr" / "lib" / "x86_64-linux-gnu"
        libraries.mkdir(parents=True)
        variables = bootstrap.Environment(tmp_path).variables()
        assert variables["LD_LIBRARY_PATH"].split(os.pathsep)[0] == str(libraries)


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

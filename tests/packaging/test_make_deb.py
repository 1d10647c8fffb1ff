"""The Debian package has what a desktop needs, and depends on what Qt needs."""

from __future__ import annotations

import gzip
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]

pytest.importorskip("PySide6.QtSvg", reason="Qt's system libraries are missing")


@pytest.fixture(scope="module")
def make_deb() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_deb", ROOT / "packaging/make_deb.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def tree(make_deb: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of the package, of a program that PyInstaller did not write."""
    program = tmp_path_factory.mktemp("program") / "calibgui"
    program.mkdir()
    (program / "calibgui").write_text("#!/bin/sh\n")
    (program / "calibgui").chmod(0o755)
    (program / "_internal.so").write_bytes(b"\x7fELF")
    tree = tmp_path_factory.mktemp("tree")
    make_deb.lay_out(program, tree, "1.2.3")
    make_deb.settle_permissions(tree)
    make_deb.describe(tree, "1.2.3", "amd64")
    return tree


@pytest.mark.skipif(sys.platform != "linux", reason="Debian packages are made on Linux")
def test_a_desktop_finds_the_program_its_icons_and_its_manual(tree: Path) -> None:
    command = tree / "usr/bin/calibgui"
    assert command.resolve() == tree / "usr/lib/calibgui/calibgui"
    assert command.stat().st_mode & 0o777 == 0o755
    share = tree / "usr/share"
    assert (share / "applications/calibgui.desktop").is_file()
    assert (share / "metainfo/calibgui.metainfo.xml").is_file()
    assert (share / "mime/packages/calibgui.xml").is_file()
    icons = share / "icons/hicolor"
    for size in (16, 48, 256, 512):
        content = (icons / f"{size}x{size}/apps/calibgui.png").read_bytes()
        assert int.from_bytes(content[16:20], "big") == size  # the width in PNG's header
    assert (icons / "scalable/apps/calibgui.svg").is_file()
    page = gzip.decompress((share / "man/man1/calibgui.1.gz").read_bytes()).decode()
    assert page.startswith(".TH CALIBGUI 1")
    assert "BSD-3-Clause" in (share / "doc/calibgui/copyright").read_text()


def test_the_package_tells_what_it_needs(make_deb: ModuleType, tree: Path) -> None:
    control = dict(
        line.split(": ", 1)
        for line in (tree / "DEBIAN/control").read_text().splitlines()
        if ": " in line and not line.startswith(" ")
    )
    assert control["Version"] == "1.2.3"
    needed = control["Depends"]
    assert "libglib2.0-0 | libglib2.0-0t64" in needed
    for name in make_deb.list_dependencies():
        assert name in needed
    table = (ROOT / "resources/system/debian-packages.txt").read_text()
    for line in table.splitlines():
        if line and not line.startswith("#"):
            assert line.split()[0] in needed
    sums = (tree / "DEBIAN/md5sums").read_text().splitlines()
    assert any(line.endswith("  usr/lib/calibgui/calibgui") for line in sums)
    assert all((tree / line.split("  ", 1)[1]).is_file() for line in sums)


def test_a_folder_without_a_program_is_refused(
    make_deb: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "argv", ["make_deb.py", str(tmp_path)])
    assert make_deb.main() == 1
    assert "pyinstaller packaging/calibgui.spec first" in capsys.readouterr().out

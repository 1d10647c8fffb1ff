"""Make a Debian package of the folder that PyInstaller wrote: python packaging/make_deb.py.

`pyinstaller packaging/calibgui.spec` comes first. The package brings its own Python and libraries,
so that it can be installed on any Debian or Ubuntu that is not older than the machine it was made
on; it depends on the system libraries of Qt alone. Nothing is run when it is installed or removed,
but what Debian itself does for menus, icons and types of files.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from email.utils import formatdate
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NAME = "calibgui"
ICON_SIZES = (16, 22, 24, 32, 48, 64, 128, 256, 512)
"""Widths of the icons in pixels, px: those of the freedesktop icon theme."""
MAINTAINER = "The calibgui authors <packages@calibgui.invalid>"


def read_version() -> str:
    """Read the version of the program."""
    text = (ROOT / "calibgui/version.py").read_text(encoding="utf-8")
    found = re.search(r'"(\d[^"]*)"', text)
    assert found is not None
    return found[1]


def list_dependencies() -> list[str]:
    """List the Debian packages that Qt needs; newer systems have some under another name."""
    table = (ROOT / "resources/system/debian-packages.txt").read_text(encoding="utf-8")
    names = [line.split()[0] for line in table.splitlines() if line and not line.startswith("#")]
    # Debian 13 and Ubuntu 24.04 have renamed those that count seconds in 64 bits.
    renamed = {"libglib2.0-0": "libglib2.0-0 | libglib2.0-0t64"}
    return ["libc6", "sensible-utils", *(renamed.get(name, name) for name in names)]


def draw_icons(target: Path) -> None:
    """Draw the icon in all sizes into a folder of the icon theme."""
    from PySide6.QtCore import Qt
    from PySide6.QtGui import QGuiApplication, QImage, QPainter
    from PySide6.QtSvg import QSvgRenderer

    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    application = QGuiApplication.instance() or QGuiApplication([])
    drawing = QSvgRenderer(str(ROOT / f"resources/icons/{NAME}.svg"))
    for size in ICON_SIZES:
        image = QImage(size, size, QImage.Format.Format_ARGB32)
        image.fill(Qt.GlobalColor.transparent)
        painter = QPainter(image)
        drawing.render(painter)
        painter.end()
        file = target / f"{size}x{size}/apps/{NAME}.png"
        file.parent.mkdir(parents=True, exist_ok=True)
        image.save(str(file))
    del application
    scalable = target / f"scalable/apps/{NAME}.svg"
    scalable.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(ROOT / f"resources/icons/{NAME}.svg", scalable)


def lay_out(program: Path, tree: Path, version: str) -> None:
    """Lay out the files of the package.

    Args:
        program: the folder that PyInstaller wrote.
        tree: where they are laid out, as they will stand below /.
        version: of the program.
    """
    shutil.copytree(program, tree / f"usr/lib/{NAME}", symlinks=True)
    for command in ("usr/bin", "usr/share/man/man1", f"usr/share/doc/{NAME}"):
        (tree / command).mkdir(parents=True, exist_ok=True)
    (tree / f"usr/bin/{NAME}").symlink_to(f"../lib/{NAME}/{NAME}")
    for source, place in (
        (f"{NAME}.desktop", "applications"),
        (f"{NAME}.metainfo.xml", "metainfo"),
        (f"{NAME}-mime.xml", "mime/packages"),
    ):
        target = tree / "usr/share" / place / source.replace("-mime", "")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / "packaging" / source, target)
    draw_icons(tree / "usr/share/icons/hicolor")
    documents = tree / f"usr/share/doc/{NAME}"
    (documents / "copyright").write_text(_write_copyright(), encoding="utf-8")
    changes = (
        f"{NAME} ({version}) unstable; urgency=medium\n\n"
        f"  * See CHANGELOG.md of the sources.\n\n"
        f" -- {MAINTAINER}  {formatdate(0)}\n"
    )
    _write_compressed(documents / "changelog.gz", changes)
    manual = (
        f'.TH CALIBGUI 1 "" "{NAME} {version}"\n.SH NAME\n{NAME} \\- calibrate a camera from '
        f"photographs of a board\n.SH SYNOPSIS\n.B {NAME}\n[PATHS...]\n.br\n.B {NAME}\n"
        "COMMAND [OPTIONS]\n.SH DESCRIPTION\nWithout a command the window opens, with the "
        f"photographs, project or folder that is named.\n.B {NAME} \\-\\-help\nlists the commands, "
        f"and\n.B {NAME} COMMAND \\-\\-help\ntheir options.\n"
    )
    _write_compressed(tree / f"usr/share/man/man1/{NAME}.1.gz", manual)
    overrides = tree / f"usr/share/lintian/overrides/{NAME}"
    overrides.parent.mkdir(parents=True)
    # The program brings the libraries that it was tested with, as wheels do.
    overrides.write_text(
        "".join(
            f"{NAME}: {tag} *\n"
            for tag in (
                "embedded-library",
                "embedded-javascript-library",
                "shared-library-lacks-prerequisites",
                "custom-library-search-path",
                "unstripped-binary-or-object",
                "unstripped-static-library",
                "hardening-no-relro",
                "library-not-linked-against-libc",
            )
        ),
        encoding="utf-8",
    )


def _write_copyright() -> str:
    """Return Debian's statement of the licence."""
    licence = (ROOT / "LICENSE").read_text(encoding="utf-8").splitlines()
    text = "\n".join(f" {line}" if line.strip() else " ." for line in licence)
    return (
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
        f"Upstream-Name: {NAME}\n\nFiles: *\nCopyright: the calibgui authors\n"
        f"License: BSD-3-Clause\n{text}\n"
    )


def _write_compressed(file: Path, text: str) -> None:
    """Write a text compressed, the same bytes each time."""
    with file.open("wb") as stream, gzip.GzipFile("", "wb", 9, stream, mtime=0) as packed:
        packed.write(text.encode())


def describe(tree: Path, version: str, architecture: str) -> None:
    """Write what Debian wants to know of the package."""
    about = tree / "DEBIAN"
    about.mkdir()
    files = sorted(path for path in tree.rglob("*") if path.is_file() and not path.is_symlink())
    files = [path for path in files if about not in path.parents]
    sums = [
        f"{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(tree)}" for path in files
    ]
    (about / "md5sums").write_text("\n".join(sums) + "\n", encoding="utf-8")
    size = sum(path.stat().st_size for path in files) // 1024
    (about / "control").write_text(
        f"Package: {NAME}\nVersion: {version}\nArchitecture: {architecture}\n"
        f"Maintainer: {MAINTAINER}\nInstalled-Size: {size}\n"
        f"Depends: {', '.join(list_dependencies())}\nSection: science\nPriority: optional\n"
        "Description: calibrate cameras from photographs of a board\n"
        " calibgui computes the focal lengths, the principal point and the lens\n"
        " distortion of a camera, each with its standard deviation, from photographs\n"
        " of a flat board, and says how far the result can be trusted. It has a window\n"
        " and a command line, and writes cameras for OpenCV, ROS and others.\n",
        encoding="utf-8",
    )


def settle_permissions(tree: Path) -> None:
    """Give all files the permissions that Debian asks for."""
    for path in tree.rglob("*"):
        if path.is_symlink():
            continue
        is_program = path.is_file() and os.access(path, os.X_OK) and ".so" not in path.name
        path.chmod(0o755 if path.is_dir() or is_program else 0o644)


def main() -> int:
    """Make the package."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("program", type=Path, nargs="?", default=ROOT / "dist" / NAME)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "dist")
    options = parser.parse_args()
    if not (options.program / NAME).is_file():
        print(f"{options.program} holds no program: pyinstaller packaging/calibgui.spec first.")
        return 1
    version = read_version()
    command = ["dpkg", "--print-architecture"]
    architecture = subprocess.run(
        command, check=True, capture_output=True, text=True
    ).stdout.strip()
    options.output.mkdir(parents=True, exist_ok=True)
    target = options.output / f"{NAME}_{version}_{architecture}.deb"
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / NAME
        tree.mkdir()
        lay_out(options.program, tree, version)
        settle_permissions(tree)
        describe(tree, version, architecture)
        subprocess.run(
            ["dpkg-deb", "--root-owner-group", "-Zxz", "-z1", "--build", str(tree), str(target)],
            check=True,
        )
    print(f"Wrote {target}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())

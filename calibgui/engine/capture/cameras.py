"""Cameras: those at this computer, by their names where the system tells them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

_DEVICES = Path("/sys/class/video4linux")
"""Folder in which Linux lists video devices, each in a folder of its own."""
_IS_CAMERA = "0"
"""Content of the file `index` of a device that gives a camera's images; others are side data."""


def list_cameras(devices: Path = _DEVICES) -> Mapping[int, str]:
    """List the cameras at this computer, by their numbers.

    Returns:
        Their names; nothing where the system tells none (Windows and macOS): a camera is opened by
        its number there.
    """
    found = {}
    for folder in devices.glob("video*") if devices.is_dir() else ():
        number = folder.name.removeprefix("video")
        if number.isdecimal() and _read(folder / "index") == _IS_CAMERA:
            found[int(number)] = _read(folder / "name") or f"camera {number}"
    return dict(sorted(found.items()))


def _read(file: Path) -> str:
    """Read what a file of the system says; "" if it says nothing."""
    try:
        return file.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""

"""Presets of limits: files that come with the program, and those in the user's configuration."""

from __future__ import annotations

from pathlib import Path

import platformdirs

from calibgui.app.system.resources import find_resource
from calibgui.dataset.limits import Limits
from calibgui.engine.errors import CalibrationError
from calibgui.formats.limits_toml import read_limits

_SUFFIX = ".toml"


def find_presets_folder() -> Path:
    """Return the folder of the user's own presets, which need not exist."""
    return platformdirs.user_config_path("calibgui", appauthor=False) / "limits"


def list_presets() -> dict[str, Path]:
    """List the files of presets by name; the user's take the place of those of the program."""
    folders = (find_resource("limits"), find_presets_folder())
    files = [file for folder in folders for file in sorted(folder.glob(f"*{_SUFFIX}"))]
    return {file.stem: file for file in files}


def find_limits(name: str) -> Limits:
    """Return the limits of a preset, or those in a file.

    Args:
        name: the preset's name, or the path of a TOML file.

    Raises:
        CalibrationError: if there is neither, or the file cannot be read.
    """
    presets = list_presets()
    if name in presets:
        return read_limits(presets[name])
    if Path(name).suffix == _SUFFIX or Path(name).is_file():
        return read_limits(Path(name))
    raise CalibrationError(
        f"There are no limits of the name {name!r}.",
        f"Choose from {', '.join(presets)}, name a TOML file, or put one into "
        f"{find_presets_folder()}.",
    )


def find_camera_limits(name: str) -> Limits:
    """Return the limits of one camera by the name of a preset or file.

    Raises:
        CalibrationError: as `find_limits`, and if one of them is for a fleet.
    """
    limits = find_limits(name)
    if limits.largest_change_px is not None:
        raise CalibrationError(
            f"The limits {limits.name} have largest_change_px, and there is no earlier calibration "
            "to compare with.",
            "Leave it out, or compare two results: `calibgui diff --limit`.",
        )
    return limits

"""Reading of the result that a subcommand works with."""

from __future__ import annotations

from pathlib import Path

from calibgui.cli.arguments import open_camera_file
from calibgui.cli.console import Console
from calibgui.dataset import Result
from calibgui.formats import camera_import


def read_result_file(path: Path) -> Result:
    """Read the result.json that an argument names, "-" for standard input.

    Raises:
        CalibrationError: as ``formats.camera_import.read_result_file``.
    """
    with open_camera_file(path) as file:
        return camera_import.read_result_file(file)


def read_result_and_warn(path: Path, console: Console) -> Result:
    """Read result.json, and warn if the calibration is partial.

    Raises:
        CalibrationError: as `read_result_file`.
    """
    result = read_result_file(path)
    if result.mode is not None:
        (width, height), (w, h) = result.mode.full, result.mode.size
        console.print_problem(
            f"calibgui: {path} is for images of {w} x {h} px; this works with those of the "
            f"calibration, {width} x {height} px."
        )
    if (diagnosis := result.calibration.diagnosis) is not None:
        console.print_problem(f"calibgui: {path} is a partial calibration. {diagnosis.message}")
    return result

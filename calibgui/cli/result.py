"""Reading of the result that a subcommand works with."""

from __future__ import annotations

from pathlib import Path

from calibgui.cli.arguments import open_input
from calibgui.cli.console import Console
from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.result_json import EXPORTER, read_result


def read_result_file(path: Path) -> Result:
    """Read the result.json that an argument names, "-" for standard input.

    Raises:
        CalibrationError: as `read_result`.
    """
    with open_input(path) as file:
        return read_result(file)


def read_result_and_warn(path: Path, console: Console) -> Result:
    """Read result.json, and warn if the calibration is partial.

    Raises:
        CalibrationError: as `read_result`; if the file is a camera file of another program, the
            message says so.
    """
    try:
        result = read_result_file(path)
    except CalibrationError as error:
        _refuse_camera_file(path, error)
        raise
    if (diagnosis := result.calibration.diagnosis) is not None:
        console.print_problem(f"calibgui: {path} is a partial calibration. {diagnosis.message}")
    return result


def _refuse_camera_file(path: Path, error: CalibrationError) -> None:
    """Raise a CalibrationError if the file holds a camera only."""
    try:
        title = read_camera(path).title
    except CalibrationError:
        return
    if title != EXPORTER.title:
        raise CalibrationError(
            f"{path} holds a camera only ({title}): neither corners, nor the poses and "
            "uncertainties that come from them.",
            "Name a result: `calibgui calibrate -o` writes it.",
        ) from error

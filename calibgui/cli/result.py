"""Reading the result that a subcommand works with."""

from __future__ import annotations

from pathlib import Path

from calibgui.cli.console import Console
from calibgui.dataset.result import Result
from calibgui.formats.result_json import read_result


def read_camera(path: Path, console: Console) -> Result:
    """The calibration in result.json, with a warning if it is partial. Raises as `read_result`."""
    result = read_result(path)
    if (diagnosis := result.calibration.diagnosis) is not None:
        console.problem(f"calibgui: {path} is a partial calibration. {diagnosis.message}")
    return result

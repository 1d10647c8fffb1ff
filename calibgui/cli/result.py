"""Reading of the result that a subcommand works with."""

from __future__ import annotations

from pathlib import Path

from calibgui.cli.console import Console
from calibgui.dataset import Result
from calibgui.formats.result_json import read_result


def read_result_and_warn(path: Path, console: Console) -> Result:
    """Read result.json, and warn if the calibration is partial. Raises as `read_result`."""
    result = read_result(path)
    if (diagnosis := result.calibration.diagnosis) is not None:
        console.print_problem(f"calibgui: {path} is a partial calibration. {diagnosis.message}")
    return result

"""A result's camera in OpenCV's forward model, for the formats that hold no other.

The paper corrects measured points, OpenCV and its relatives distort ideal ones; neither's
coefficients express the other (``engine/refit.py``). How far the two are apart is said in
the file itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from calibgui.dataset.result import Result
from calibgui.engine.calibration import Calibration, Refit, refit
from calibgui.engine.files import write_atomically
from calibgui.formats.exporter import ExportReport

MODEL = "opencv"
_USEFUL = 2.0
"""Error where corners were seen, px, from which on an export is of no use."""


def write_forward(
    result: Result, path: Path, text: Callable[[Calibration, str], str]
) -> ExportReport:
    """Write what `text` makes of the calibration in OpenCV's model and the note on its refit.

    Raises:
        CalibrationError: as `forward`, or if the file cannot be written.
    """
    fitted = forward(result)
    note = refit_note(result, fitted)
    write_atomically(path, text(fitted.calibration, note).encode())
    return ExportReport(path, note, fitted.largest_error)


def forward(result: Result) -> Refit:
    """The calibration in OpenCV's model; itself, if that is what was calibrated.

    Raises:
        CalibrationError: as ``calibrate``.
    """
    if result.calibration.camera.model == MODEL:
        return Refit(result.calibration, 0.0, 0.0)
    return refit(result.observations(), result.calibration, MODEL)


def refit_note(result: Result, fitted: Refit) -> str:
    """How the exported camera differs from the calibrated one.

    Without apostrophes: OpenCV writes them into JSON in a way that only OpenCV reads.
    """
    if fitted.calibration is result.calibration:
        return "Forward distortion model (k1 k2 p1 p2 k3) as calibrated."
    whole = (
        f"{fitted.largest_error:.3g} px over the whole image"
        if math.isfinite(fitted.largest_error)
        else "an unlimited amount in parts of the image that no corner covers"
    )
    caution = (
        "" if fitted.covered_error < _USEFUL else " It cannot follow this lens: do not use it."
    )
    return (
        f"Forward distortion model (k1 k2 p1 p2 k3), refitted on the same corners; differs by "
        f"at most {fitted.covered_error:.3g} px where corners were seen and {whole}.{caution}"
    )

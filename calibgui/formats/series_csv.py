"""The settings of a series as CSV: one row each, every parameter with its standard deviation.

Reader: any reader of CSV. Focal lengths and centre are px in the array frame, coefficients without
dimension. A setting that its photographs do not determine has the reason in the column
``left_out``, and no parameters. Cannot hold: correlations, the function between the settings.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import LeftOut
from calibgui.engine.assessment import Setting
from calibgui.engine.files import write_atomically
from calibgui.formats.csv_table import format_csv


def write_series_csv(
    settings: Sequence[Setting], files: Sequence[str], left_out: Sequence[LeftOut], path: Path
) -> None:
    """Write the settings, each with the name of its file, and those that are left out.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    names = settings[0].known.camera.names
    parameters = [n for p in names for n in (p, f"sigma_{p}")]
    rows: list[Sequence[object]] = [["value", "file", "model", *parameters, "left_out"]]
    for setting, file in zip(settings, files, strict=True):
        known = setting.known
        sigma = np.sqrt(np.diag(known.covariance))
        pairs = np.column_stack([known.camera.params, sigma]).ravel().tolist()
        rows.append([setting.value, file, known.camera.model, *pairs, ""])
    for one in left_out:
        value = "" if math.isnan(one.value) else one.value
        rows.append([value, one.file, "", *[""] * len(parameters), one.reason])
    write_atomically(path, format_csv(rows).encode(errors="backslashreplace"))

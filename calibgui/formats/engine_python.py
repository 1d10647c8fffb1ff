"""The camera as a few lines of Python for this program's own engine, to paste into a program.

Reader: Python with calibgui. Pixels count from 0 at the centre of the first one, coefficients
are dimensionless; nothing is refitted. Cannot hold: correlations, poses, corners.
"""

from __future__ import annotations

import math
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.calibration import Calibration
from calibgui.engine.camera import MODELS
from calibgui.engine.files import write_atomically
from calibgui.formats.exporter import FRAME, Exporter, ExportReport, describe_condition
from calibgui.formats.origin import make_mark

_NOTE = "The camera as calibrated; nothing is refitted."


def write_engine_python(result: Result, path: Path) -> ExportReport:
    """Write the lines as a file."""
    note = result.conversion or _NOTE
    marked = " ".join(filter(None, [make_mark(EXPORTER.name), note, describe_condition(result)]))
    write_atomically(path, format_lines(result.calibration, marked).encode())
    return ExportReport(path, note)


def format_lines(calibration: Calibration, note: str = _NOTE) -> str:
    """Return the program text, with a note on the camera."""
    camera = calibration.camera
    rows = "\n".join(
        f"    {value!r},  # {name}" + (f" +- {sigma:.2g}" if math.isfinite(sigma) else "")
        for name, value, sigma in zip(
            camera.names,
            camera.params.tolist(),
            calibration.sigma.tolist(),
            strict=True,
        )
    )
    return f"""\
# {note}
# {FRAME}
from calibgui import engine

params = [
{rows}
]
camera = engine.Camera({camera.size}, params, {camera.model!r})


def undistorted(image):
    return engine.undistort_image(image, camera).image
"""


EXPORTER = Exporter(
    name="python",
    title="Python lines for calibgui",
    suffixes=(".py",),
    models=tuple(MODELS),
    readers="Python with calibgui",
    keeps="the camera as calibrated, standard deviations as comments",
    loses="correlations, poses, corners",
    write=write_engine_python,
)

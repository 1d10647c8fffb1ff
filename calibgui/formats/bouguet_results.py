"""Calib_Results.m and Calib_Results.mat of Bouguet's Camera Calibration Toolbox for MATLAB.

Reader: the toolbox, MATLAB and GNU Octave, which run the script or load the other, any reader of
MATLAB's format 5, and `read_bouguet`. Pixels are the array frame's (0-based, integer at pixel
centres). `fc` and `cc` are focal lengths and principal point in px, `alpha_c` our skew, `kc` k1 k2
p1 p2 k3 of OpenCV; `omc_1` and `Tc_1` are the board's pose in the first photograph, a rotation
vector and mm, and so on. What ends in `_error` is three standard deviations, as in the toolbox.
The .mat holds the corners as well: `x_1` in px, `X_1` on the board in mm.
Cannot hold: other lens models (they are refitted), correlations; the .m no corners.

A .mat is read as the script that says the same, with its corners behind it.
"""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration, Observation
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.corner_table import CornerText
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.mat_file import NotMatError, read_mat_variables
from calibgui.formats.matlab_text import find_assignments, parse_matrix, remove_comments

_SIGMAS = 3.0
"""Ratio of the toolbox's errors to standard deviations."""
_COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")
_WANTED = re.compile(
    r"fc|cc|alpha_c|kc|nx|ny|[xX]_\d+|active_images|calib_name|format_image|image_numbers"
)
"""Names of the variables of a .mat that are read."""
_HEADER_LENGTH = 116
"""Number of bytes of the text with which a .mat begins."""


def write_bouguet(result: Result, path: Path) -> ExportReport:
    """Write a Calib_Results.m, or a Calib_Results.mat, which has the corners too."""
    observations = result.observations()

    def make(fitted: Calibration, note: str) -> str | bytes:
        if path.suffix.lower() == ".mat":
            return pack_results(list_values(fitted) | list_corners(observations), note)
        return format_results(list_values(fitted), note)

    return write_in_models(result, path, EXPORTER, make)


def list_values(calibration: Calibration) -> dict[str, Array]:
    """Return the matrices of the toolbox's variables; `calibration` is in one of the format's
    models. Errors that are not known are left out."""
    camera = calibration.camera
    value = dict(zip(camera.names, camera.params.tolist(), strict=True))
    sigma = dict(zip(camera.names, calibration.sigma.tolist(), strict=True))

    def stack(names: Sequence[str], numbers: Mapping[str, float]) -> Array:
        return np.array([[numbers.get(name, 0.0)] for name in names])

    listed = {
        "fc": ("fx", "fy"),
        "cc": ("cx", "cy"),
        "alpha_c": ("skew",),
        "kc": _COEFFICIENTS,
    }
    values = {name: stack(names, value) for name, names in listed.items()}
    errors = {f"{name}_error": _SIGMAS * stack(names, sigma) for name, names in listed.items()}
    values |= {name: error for name, error in errors.items() if np.isfinite(error).all()}
    values |= dict(zip(("nx", "ny"), np.array(camera.size, float)[:, None, None], strict=True))
    values["n_ima"] = np.array([[len(calibration.poses)]], float)
    pairs = zip(calibration.poses, calibration.pose_covariances, strict=True)
    for k, (pose, covariance) in enumerate(pairs, 1):
        error = _SIGMAS * np.sqrt(np.diag(covariance))[:, None]
        values |= {f"omc_{k}": pose.rvec[:, None], f"Tc_{k}": pose.tvec[:, None]}
        if np.isfinite(error).all():
            values |= {f"omc_error_{k}": error[:3], f"Tc_error_{k}": error[3:]}
    return values


def list_corners(observations: Sequence[Observation]) -> dict[str, Array]:
    """Return the matrices of the toolbox's variables of corners."""
    values = {"active_images": np.ones((1, len(observations)))}
    for k, view in enumerate(observations, 1):
        values[f"x_{k}"] = view.uv.T
        values[f"X_{k}"] = np.pad(view.xy, ((0, 0), (0, 1))).T
    return values


def format_results(values: Mapping[str, Array], note: str) -> str:
    """Return the text of the script."""
    lines = [
        f"% {note}",
        "% Pixels count from 0 at the centre of the first pixel, x right, y down.",
    ]
    for name, matrix in values.items():
        rows = " ; ".join(" ".join(map(repr, row)) for row in matrix.tolist())
        lines.append(f"{name} = {rows if matrix.size == 1 else f'[ {rows} ]'};")
    return "\n".join(lines) + "\n"


def pack_results(values: Mapping[str, Array], note: str) -> bytes:
    """Return the content of the .mat, whose first line is the note as far as there is room."""
    content: Any = io.BytesIO()
    scipy.io.savemat(content, dict(values))
    head = f"MATLAB 5.0 MAT-file. {note}".encode("ascii", "replace")[:_HEADER_LENGTH]
    return head.ljust(_HEADER_LENGTH) + content.getvalue()[_HEADER_LENGTH:]


def is_mat(content: bytes) -> bool:
    """Return whether the content of a file is a .mat of MATLAB 5 or newer."""
    return content.startswith(b"MATLAB ")


def unpack_mat(content: bytes) -> str:
    """Return the script that assigns the variables of a .mat which are read.

    Raises:
        ValueError: if the content is damaged, too large or of a newer format.
    """
    if content.startswith(b"MATLAB 7.3"):
        raise ValueError("it is in MATLAB's format 7.3; save it with -v7")
    try:
        variables = dict(read_mat_variables(content))
    except NotMatError as error:
        raise ValueError(str(error)) from error
    return "\n".join(
        _format_variable(name, value)
        for name, value in variables.items()
        if _WANTED.fullmatch(name)
    )


def _format_variable(name: str, value: Array | str) -> str:
    """Return the assignment of a text or a matrix of numbers; a comment for anything else, as NaN
    in place of the corners of a photograph that is left out."""
    if isinstance(value, str):
        return f"{name} = '{value}';"
    if value.ndim != 2:
        return f"% {name} is no matrix of numbers"
    if not np.isfinite(value).all():
        return f"% {name} is not known"
    rows = " ; ".join(" ".join(map(repr, row)) for row in value.tolist())
    return f"{name} = [ {rows} ];"


def read_bouguet(source: CameraText) -> ImportedCamera:
    """Read the camera of a script that assigns fc, cc, alpha_c, kc, nx and ny.

    Raises:
        CalibrationError: if one of them is missing or no such matrix.
    """
    assigned = find_assignments(remove_comments(source.text))
    defaults = {"alpha_c": "0", "kc": "[0 0 0 0 0]"}

    def read(name: str, *counts: int) -> list[float]:
        if name not in assigned and name not in defaults:
            source.fail(f"assigns no {name}.")
        word = assigned.get(name, defaults.get(name, ""))
        numbers: list[float] = parse_matrix(source, name, word).ravel().tolist()
        if len(numbers) not in counts:
            source.fail(f"has a {name} of {len(numbers)} numbers.")
        return numbers

    (fx, fy), (cx, cy), (skew,) = read("fc", 2), read("cc", 2), read("alpha_c", 1)
    coefficients = read("kc", 4, 5)
    stated = [*read("nx", 1), *read("ny", 1)] if "nx" in assigned else None
    values = {"fx": fx, "fy": fy, "cx": cx, "cy": cy, "skew": skew}
    values |= dict(zip(_COEFFICIENTS, coefficients, strict=False))
    model = "brown-conrady" if len(coefficients) == 5 else "brown-conrady-4"
    camera = source.make_camera(source.choose_size(stated), model, values)
    return ImportedCamera(camera, EXPORTER.title)


_TEXT = re.compile(r"^(\w+) = '(.*)';$", re.MULTILINE)
"""The assignment of a text."""
CORNERS_SIGNATURE = re.compile(r"^x_\d+ = \[", re.MULTILINE)
"""The corners of a photograph in the script that stands for a .mat."""


def read_bouguet_corners(source: CornerText) -> CornerSet:
    """Read the corners of a .mat with their places on the board; photographs that the toolbox left
    out are not enabled.

    Raises:
        CalibrationError: if a photograph's corners are no such matrices, or the images' size is not
            known.
    """
    if source.grid_size is not None:
        source.fail("gives the corners' places in mm, not by rows.", "Leave --board out.")
    text = CameraText(source.text, source.file, size=source.size)
    assigned = find_assignments(remove_comments(source.text))
    numbers = sorted(int(name[2:]) for name in assigned if re.fullmatch(r"x_\d{1,9}", name))
    active = parse_matrix(text, "active_images", assigned.get("active_images", "1")).ravel()
    views = []
    for k in numbers:
        uv = parse_matrix(text, f"x_{k}", assigned[f"x_{k}"])
        xyz = parse_matrix(text, f"X_{k}", assigned.get(f"X_{k}", "[]"))
        if uv.ndim != 2 or len(uv) != 2 or len(xyz) != 3 or uv.shape[1] != xyz.shape[1]:
            text.fail(f"has an x_{k} or X_{k} that is not that of corners.")
        if xyz[2].any():
            text.fail(f"has corners in X_{k} that do not lie on a plane.")
        points = Observation(uv.T, xyz[:2].T)
        enabled = bool(active[k - 1]) if k <= len(active) else True
        image = _name_image(text, assigned, k)
        views.append(View(image, ViewStatus.FOUND, points=points, enabled=enabled))
    if "nx" in assigned and "ny" in assigned:
        sides = [parse_matrix(text, side, assigned[side]).ravel() for side in ("nx", "ny")]
        size = text.choose_size(np.concatenate(sides).tolist())
    else:
        size = source.find_size(view.image for view in views)
    return CornerSet(size, tuple(views), None, lengths_confirmed=True)


def _name_image(text: CameraText, assigned: Mapping[str, str], k: int) -> str:
    """Return the name of the k-th photograph, counted from 1, or what stands for it."""
    stated = dict(_TEXT.findall(text.text))
    word = assigned.get("image_numbers")
    numbers = [] if word is None else parse_matrix(text, "image_numbers", word).ravel().tolist()
    if "calib_name" not in stated or "format_image" not in stated or k > len(numbers):
        return f"photograph {k}"
    return f"{stated['calib_name']}{numbers[k - 1]:.0f}.{stated['format_image']}"


EXPORTER = Exporter(
    name="bouguet",
    title="Bouguet's Calib_Results",
    suffixes=(".m", ".mat"),
    models=("brown-conrady", "brown-conrady-4", "pinhole"),
    refits=("brown-conrady",),
    holds_skew=True,
    readers="Bouguet's toolbox for MATLAB, GNU Octave",
    keeps="the camera and poses in mm with three standard deviations each; the .mat has the "
    "corners, too",
    loses="correlations",
    write=write_bouguet,
)
IMPORTER = Importer(
    EXPORTER.title, re.compile(r"^[ \t]*fc[ \t]*=[ \t]*\[", re.MULTILINE), read_bouguet
)

"""A MATLAB script that makes the camera: cameraIntrinsics, or fisheyeIntrinsics.

Reader: MATLAB's Computer Vision Toolbox, and `read_matlab`. Pixels count from 1 at the centre of
the first pixel, sizes are rows before columns. `RadialDistortion` is k1 k2 or k1 k2 k3,
`TangentialDistortion` p1 p2 of OpenCV, and `Skew` is in px: fx times ours. A fisheye's ray through
the point (x, y) px from the centre is (x, y, a0 + a2 r^2 + a3 r^3 + a4 r^4) with r in px, so that
a0 = fy, and its coefficients are ours over a0, a0^2 and a0^3; the stretch matrix [fx/fy 0; 0 1]
holds pixels that are not square.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.

Scripts that call cameraParameters are read as well. Its IntrinsicMatrix is the transpose of K. A
stretch matrix that is not diagonal turns the image about the axis, which no camera of ours does.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import PINHOLE, Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.matlab_text import (
    find_assignments,
    format_row,
    parse_matrix,
    remove_comments,
)

_FISHEYE = "scaramuzza"
_RADIAL = {
    "pinhole": (),
    "brown-conrady-4": ("k1", "k2"),
    "brown-conrady": ("k1", "k2", "k3"),
}
"""The coefficients of cameraIntrinsics' RadialDistortion, by lens model."""
_CALL = re.compile(r"\b(cameraIntrinsics|cameraParameters|fisheyeIntrinsics)\s*\(")
_ARGUMENT = re.compile(r"""\s*(\[[^\[\]]*\]'?|"[^"\n]*"|'[^'\n]*'|[^\[\]()'",\s]+'?)\s*([,)])""")
"""An argument of a call, and what ends it."""
_POSITIONAL = {
    "cameraIntrinsics": ("FocalLength", "PrincipalPoint", "ImageSize"),
    "cameraParameters": (),
    "fisheyeIntrinsics": ("MappingCoefficients", "ImageSize", "DistortionCenter", "StretchMatrix"),
}
"""Arguments of the calls that have no name there."""


def write_matlab(result: Result, path: Path) -> ExportReport:
    """Write a MATLAB script."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_script(fitted.camera, note)
    )


def format_script(camera: Camera, note: str) -> str:
    """Return the text of the script; `camera` is in one of the format's models."""
    width, height = camera.size
    size, centre = format_row([height, width]), format_row(camera.centre + 1)
    if camera.model == _FISHEYE:
        fx, fy = camera.focal
        mapping = [fy, *camera.coefficients / fy ** np.array([1, 2, 3])]
        stretch = f"[{float(fx / fy)!r} 0; 0 1]"
        call = f"fisheyeIntrinsics({format_row(mapping)}, {size}, {centre}, {stretch})"
    else:
        call = f"cameraIntrinsics({format_row(camera.focal)}, {centre}, {size}"
        if radial := _RADIAL[camera.model]:
            values = dict(zip(camera.names, camera.params.tolist(), strict=True))
            call += (
                f", ...\n    'RadialDistortion', {format_row([values[k] for k in radial])}"
                f", ...\n    'TangentialDistortion', {format_row([values['p1'], values['p2']])}"
                f", ...\n    'Skew', {values['fx'] * values['skew']!r}"
            )
        call += ")"
    return (
        f"% {note}\n"
        "% Pixels count from 1 at the centre of the first pixel, x right, y down.\n"
        f"intrinsics = {call};\n"
    )


def read_matlab(source: CameraText) -> ImportedCamera:
    """Read the camera of the first call in a script that makes one.

    Its arguments are matrices and numbers, or variables that get such above the call.

    Raises:
        CalibrationError: if an argument is something else, something is missing, or the lens model
            is none of ours.
    """
    text = remove_comments(source.text)
    call = _CALL.search(text)
    if call is None:
        source.fail("calls none of cameraIntrinsics, cameraParameters and fisheyeIntrinsics.")
    arguments = _read_arguments(source, text, call)
    if call[1] == "fisheyeIntrinsics":
        camera = _make_fisheye(source, arguments)
    else:
        camera = _make_camera(source, arguments)
    return ImportedCamera(camera, EXPORTER.title)


def _read_arguments(source: CameraText, text: str, call: re.Match[str]) -> dict[str, Array]:
    """Return the matrices (rows, columns) that a call is given, by their names."""
    variables = find_assignments(text[: call.start()])
    words = []
    place, end = call.end(), ","
    while end == ",":
        argument = _ARGUMENT.match(text, place)
        if argument is None:
            source.fail(f"has a call of {call[1]} with an argument that is no matrix of numbers.")
        word, end = argument.groups()
        name = word.rstrip("'")
        words.append(variables[name] + word[len(name) :] if name in variables else word)
        place = argument.end()
    matrices: dict[str, Array] = {}
    names = iter(_POSITIONAL[call[1]])
    entries = iter(words)
    for word in entries:
        if word[0] in "\"'":
            if word[1:-1] in matrices:
                source.fail(f"has a call of {call[1]} that states {word[1:-1]} twice.")
            matrices[word[1:-1]] = parse_matrix(source, word[1:-1], next(entries, ""))
        elif (name := next(names, None)) is not None:
            matrices[name] = parse_matrix(source, name, word)
        else:
            source.fail(f"has a call of {call[1]} with too many arguments.")
    return matrices


def _make_camera(source: CameraText, arguments: dict[str, Array]) -> Camera:
    """Return the camera of a call of cameraIntrinsics or cameraParameters."""
    if "IntrinsicMatrix" in arguments:
        arguments["K"] = arguments["IntrinsicMatrix"].T
    if "K" in arguments:
        K = arguments["K"]
        if K.shape != (3, 3) or K[1, 0] != 0 or K[2].tolist() != [0, 0, 1]:
            source.fail("has an intrinsic matrix that is not that of a camera.")
        fx, skew, cx, fy, cy = K[[0, 0, 0, 1, 1], [0, 1, 2, 1, 2]].tolist()
    else:
        fx, fy = _read_pair(source, arguments, "FocalLength")
        cx, cy = _read_pair(source, arguments, "PrincipalPoint")
        skew = _read_list(source, arguments, "Skew", (1,), (0.0,))[0]
    radial = _read_list(source, arguments, "RadialDistortion", (2, 3), (0.0, 0.0))
    tangential = _read_list(source, arguments, "TangentialDistortion", (2,), (0.0, 0.0))
    if fx <= 0:
        source.fail("has a focal length that is not above 0.")
    values = {"fx": fx, "fy": fy, "cx": cx - 1, "cy": cy - 1, "skew": skew / fx}
    values |= dict(zip(("k1", "k2", "k3"), radial, strict=False))
    values |= dict(zip(("p1", "p2"), tangential, strict=True))
    model = "brown-conrady" if len(radial) == 3 else "brown-conrady-4"
    if not arguments.keys() & {"RadialDistortion", "TangentialDistortion"} and skew == 0:
        model, values = "pinhole", {name: values[name] for name in PINHOLE}
    return source.make_camera(source.choose_size(_read_size(source, arguments)), model, values)


def _make_fisheye(source: CameraText, arguments: dict[str, Array]) -> Camera:
    """Return the camera of a call of fisheyeIntrinsics."""
    a0, *a = _read_list(source, arguments, "MappingCoefficients", (4,))
    cx, cy = _read_pair(source, arguments, "DistortionCenter")
    (c, d), (e, one) = _read_square(source, arguments.get("StretchMatrix", np.eye(2)))
    if d != 0 or e != 0 or one != 1:
        source.refuse_model(
            "fisheyeIntrinsics with a stretch matrix that is not [c 0; 0 1]",
            ["fisheyeIntrinsics", "cameraIntrinsics"],
            "it turns the image about the axis; calibrate with EstimateAlignment false",
        )
    if a0 <= 0 or c <= 0:
        source.fail("has a focal length that is not above 0.")
    values = {"fx": c * a0, "fy": a0, "cx": cx - 1, "cy": cy - 1}
    with np.errstate(over="ignore"):  # what is not finite makes no camera
        scaled = a * np.float64(a0) ** np.array([1, 2, 3])
    values |= {f"a{n}": scaled[n - 2] for n in (2, 3, 4)}
    return source.make_camera(source.choose_size(_read_size(source, arguments)), _FISHEYE, values)


def _read_square(source: CameraText, matrix: Array) -> list[list[float]]:
    if matrix.shape != (2, 2):
        source.fail("has a StretchMatrix that is not of 2 x 2 numbers.")
    rows: list[list[float]] = matrix.tolist()
    return rows


def _read_list(
    source: CameraText,
    arguments: dict[str, Array],
    name: str,
    lengths: Sequence[int],
    default: Sequence[float] | None = None,
) -> list[float]:
    """Return the numbers of a row or column, of one of `lengths`; `default` if it is not given."""
    if name not in arguments:
        if default is None:
            source.fail(f"states no {name}.")
        return list(default)
    numbers: list[float] = arguments[name].ravel().tolist()
    if len(numbers) not in lengths:
        source.fail(
            f"has a {name} of {len(numbers)} numbers, not {' or '.join(map(str, lengths))}."
        )
    return numbers


def _read_pair(source: CameraText, arguments: dict[str, Array], name: str) -> list[float]:
    """Return two numbers; a single one stands for both."""
    numbers = _read_list(source, arguments, name, (1, 2))
    return numbers * 2 if len(numbers) == 1 else numbers


def _read_size(source: CameraText, arguments: dict[str, Array]) -> tuple[float, float] | None:
    """Return the stated width and height of the images; None if the script does not state them."""
    if "ImageSize" not in arguments:
        return None
    rows, columns = _read_list(source, arguments, "ImageSize", (2,))
    return columns, rows


EXPORTER = Exporter(
    name="matlab",
    title="MATLAB script",
    suffixes=(".m",),
    models=(*_RADIAL, _FISHEYE),
    refits=("brown-conrady", _FISHEYE),
    holds_skew=True,
    readers="MATLAB's Computer Vision Toolbox",
    keeps="the camera as cameraIntrinsics or fisheyeIntrinsics; pixels count from 1",
    loses="standard deviations, poses, corners",
    write=write_matlab,
)
IMPORTER = Importer(EXPORTER.title, _CALL, read_matlab)

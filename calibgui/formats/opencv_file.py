"""OpenCV's camera files in YAML, XML or JSON, by the file's suffix.

Reader: cv2.FileStorage, of OpenCV 4 and 5, and `read_opencv`. Pixels are OpenCV's (0-based,
integer at pixel centres), lengths millimetres, names those of OpenCV's own calibration sample:
`camera_matrix`, `distortion_coefficients` (k1 k2 p1 p2 and up to eight more, see
``opencv_lens``), `fisheye_model` (1 if the coefficients are those of cv2.fisheye),
`extrinsic_parameters` (a row rvec, tvec per used view), `avg_reprojection_error` (its RMS);
standard deviations are one sigma, left out where the data leave one undetermined.
Cannot hold: other lens models and skew (they are refitted), correlations, corners.

Other programs write the same with other names, which `read_opencv` knows; case and underscores
do not matter. Cameras whose sensor is tilted are not read.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine import opencv
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.calibration import Calibration
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.node import Node
from calibgui.formats.opencv_lens import (
    FISHEYE,
    PERSPECTIVE_MODELS,
    list_coefficients,
    make_opencv_camera,
    read_rectification,
)
from calibgui.formats.opencv_storage import parse_storage, read_matrix

_NOTE = f"{FRAME} Lengths are in mm, angles in rad."

_MATRIX_KEYS = ("cameramatrix", "intrinsicmatrix", "mtx", "k")
_COEFFICIENT_KEYS = (
    "distortioncoefficients",
    "distortioncoeffs",
    "distcoeffs",
    "distcoeff",
    "distcoefs",
    "distortion",
    "dist",
    "d",
)
_SIZE_KEYS = ("imagesize", "imgsize", "resolution", "size")
_WIDTH_KEYS, _HEIGHT_KEYS = (
    ("imagewidth", "imgwidth", "width"),
    ("imageheight", "imgheight", "height"),
)
_MODEL_KEYS = ("distortionmodel", "cameramodel", "model")
_FISHEYE_KEYS = ("fisheyemodel", "fisheye", "isfisheye")
_FISHEYE_NAMES = ("equidistant", "fisheye", "kannalabrandt", "kannalabrandt4", "kb4")
"""Names of the model of cv2.fisheye, without case, blanks, hyphens and underscores."""


def write_opencv(result: Result, path: Path) -> ExportReport:
    """Write OpenCV's YAML, XML or JSON file."""
    suffix = path.suffix.lower()
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_storage(fitted, suffix, note)
    )


def format_storage(calibration: Calibration, suffix: str, note: str) -> str:
    """Return the text of the file; `calibration` is in one of the format's models."""
    camera = calibration.camera
    coefficients = list_coefficients(camera)
    values: dict[str, int | float | str | Array] = {
        "image_width": camera.size[0],
        "image_height": camera.size[1],
    }
    if calibration.poses:
        values["nframes"] = len(calibration.poses)
    if camera.model == FISHEYE:
        values["fisheye_model"] = 1
    values |= {
        "camera_matrix": camera.matrix,
        "distortion_coefficients": coefficients[None],
    }
    if calibration.poses:
        values |= {
            "avg_reprojection_error": summarise_residuals(calibration.residuals).rms,
            "extrinsic_parameters": np.array([[*p.rvec, *p.tvec] for p in calibration.poses]),
        }
    if np.isfinite(calibration.sigma).all():
        sigma = np.zeros(4 + len(coefficients))  # a pinhole camera has none for its coefficients
        stated = calibration.sigma[: len(sigma)]
        sigma[: len(stated)] = stated
        values["camera_matrix_std_dev"] = sigma[None, :4]
        values["distortion_coefficients_std_dev"] = sigma[None, 4:]
    if suffix == ".json":
        return opencv.format_storage(suffix, {"note": f"{note} {_NOTE}"} | values)
    return opencv.format_storage(suffix, values, f"{note}\n{_NOTE}")


def read_opencv(source: CameraText) -> ImportedCamera:
    """Read the camera of a file of OpenCV, or of a YAML or JSON file with such entries.

    Raises:
        CalibrationError: if something is missing or wrong, or the lens model is none of ours.
    """
    content = parse_storage(source.text, source.file)
    entries = {_simplify(str(key)): node for key, node in content.members().items()}
    matrix = _find_entry(entries, _MATRIX_KEYS)
    if matrix is None:
        source.fail("has no camera_matrix.")
    K = read_matrix(matrix)
    if len(K) != 9:
        matrix.fail("a matrix of 3 x 3 numbers")
    coefficients = _find_entry(entries, _COEFFICIENT_KEYS)
    if coefficients is None:
        source.fail("has no distortion_coefficients.")
    D = read_matrix(coefficients)
    fisheye = _is_fisheye(entries)
    camera = make_opencv_camera(source, source.choose_size(_read_size(entries)), K, D, fisheye)
    R, P = (_find_entry(entries, (key,)) for key in ("rectificationmatrix", "projectionmatrix"))
    return ImportedCamera(
        camera,
        EXPORTER.title,
        notes=_describe_doubts(fisheye, len(D)),
        rectification=read_rectification(R, P, camera),
    )


def _simplify(key: str) -> str:
    """Return a key without case, blanks, hyphens and underscores."""
    return re.sub(r"[\s_-]", "", key).lower()


def _find_entry(entries: dict[str, Node], keys: tuple[str, ...]) -> Node | None:
    """Return the entry of the first of `keys` that is there; None if none is."""
    return next((entries[key] for key in keys if key in entries), None)


def _is_fisheye(entries: dict[str, Node]) -> bool:
    """Return whether a file says that its coefficients are those of cv2.fisheye."""
    flag, model = _find_entry(entries, _FISHEYE_KEYS), _find_entry(entries, _MODEL_KEYS)
    if flag is not None:
        if not isinstance(flag.value, bool | int | float) or flag.value not in (0, 1):
            flag.fail("0 or 1")
        return bool(flag.value)
    # Other programs keep other things under such names.
    if model is None or not isinstance(model.value, str):
        return False
    return _simplify(model.value) in _FISHEYE_NAMES


def _read_size(entries: dict[str, Node]) -> Size | None:
    """Return the stated width and height of the images; None if the file does not say them."""
    width, height = _find_entry(entries, _WIDTH_KEYS), _find_entry(entries, _HEIGHT_KEYS)
    if width is not None and height is not None:
        return width.integer(), height.integer()
    size = _find_entry(entries, _SIZE_KEYS)
    return None if size is None else size.image_size()


def _describe_doubts(fisheye: bool, count: int) -> tuple[str, ...]:
    """Return what the file leaves open: whose model its four coefficients are."""
    if fisheye or count != 4:
        return ()
    return (
        "The file does not name its lens model: its four coefficients are taken for k1 k2 p1 p2. "
        "If they are those of cv2.fisheye, add the entry 'fisheye_model: 1' to the file.",
    )


EXPORTER = Exporter(
    name="opencv",
    title="OpenCV YAML, XML or JSON",
    suffixes=(".yaml", ".yml", ".xml", ".json"),
    models=(*PERSPECTIVE_MODELS, FISHEYE),
    refits=("brown-conrady", FISHEYE),
    readers="OpenCV 4 and 5: cv2.FileStorage",
    keeps="the camera in the models of cv2.projectPoints or cv2.fisheye, standard deviations, "
    "poses in mm",
    loses="correlations, corners",
    write=write_opencv,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(
        r"""(^[ \t]*|["'<])(camera_?matrix|intrinsic_?matrix|mtx|K)["'\s:>]""",
        re.MULTILINE | re.IGNORECASE,
    ),
    read_opencv,
)

"""mrcal's camera model.

Reader: mrcal 2, its command-line tools and its Python module, and `read_mrcal`; the newer key
`rt_cam_ref` is written beside the older `extrinsics`. Pixels are OpenCV's (0-based, integer at
pixel centres), and so are the coefficients of LENSMODEL_OPENCV4, 5, 8 and 12; a splined model is
that of mrcal, its control points row by row, x before y. A camera by itself is its own reference.
`valid_intrinsics_region` is the convex hull of the corners that were seen, beyond which a refit
extrapolates; for a camera without corners it is the region that was converted.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.

A file of mrcal may hold the data of its calibration (`optimization_inputs`), from which mrcal
computes covariances; it holds none of them itself, and the data are not read.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, SplinedStereographic, find_model
from calibgui.engine.geometry import Pose
from calibgui.formats.camera_places import WORLD
from calibgui.formats.camera_refit import find_seen_region, write_in_models
from calibgui.formats.exporter import FRAME, SPLINED, Exporter, ExportReport
from calibgui.formats.gate import (
    Language,
    NotOfLanguageError,
    parse_text,
    refuse_repeated,
)
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.opencv_lens import list_coefficients

_LENS_MODELS = {
    "brown-conrady": "LENSMODEL_OPENCV5",
    "brown-conrady-4": "LENSMODEL_OPENCV4",
    "pinhole": "LENSMODEL_PINHOLE",
    "rational": "LENSMODEL_OPENCV8",
    "thin-prism": "LENSMODEL_OPENCV12",
}
"""mrcal's names of our models, but for the splined ones."""
_READABLE = {name: model for model, name in _LENS_MODELS.items()}
_SPLINED_NAME = re.compile(
    r"LENSMODEL_SPLINED_STEREOGRAPHIC_"
    r"order=(\d{1,5})_Nx=(\d{1,5})_Ny=(\d{1,5})_fov_x_deg=(\d{1,5})"
)
_CALIBRATION_DATA = re.compile(r"""["']optimization_inputs["']\s*:\s*b(["'])[^"'\\]*\1\s*,?""")
"""The data of the calibration: megabytes in one word, which may stand in the file."""
_MAX_LENGTH = 1 << 18
"""Length of the longest model without such data, characters; 3000 control points take two
fifths, and a text of other signs a hundred times its length of memory."""


def write_mrcal(result: Result, path: Path) -> ExportReport:
    """Write a .cameramodel file."""
    hull = find_seen_region(result)
    return write_in_models(
        result,
        path,
        EXPORTER,
        lambda fitted, note: format_camera_model(fitted.camera, hull, note),
    )


def format_camera_model(camera: Camera, region: Array, note: str, pose: Pose = WORLD) -> str:
    """Return the text of the file.

    Args:
        camera: in one of the format's models.
        region: (n, 2) px, an open contour.
        note: on the refit.
        pose: cam_from_ref, m; a camera by itself is its own reference.
    """
    motion = [*pose.rvec.tolist(), *pose.tvec.tolist()]
    contour = [*region.tolist(), region[0].tolist()]
    lens = find_model(camera.model)
    if isinstance(lens, SplinedStereographic):
        name = f"LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx={lens.Nx}_Ny={lens.Ny}"
        name += f"_fov_x_deg={lens.fov}"
        listed, intrinsics = "x, y of the control points, row by row", camera.params.tolist()
    else:
        name = _LENS_MODELS[camera.model]
        coefficients = [] if camera.model == "pinhole" else list_coefficients(camera).tolist()
        intrinsics = [*camera.params[:4].tolist(), *coefficients]
        listed = ", ".join(camera.names[4 : len(intrinsics)])
    return f"""\
# {note}
# {FRAME}
{{
    'lensmodel': '{name}',
    # fx, fy, cx, cy{listed and f", {listed}"}
    'intrinsics': {intrinsics},
    'valid_intrinsics_region': {contour},
    'extrinsics': {motion},
    'rt_cam_ref': {motion},
    'imagersize': {list(camera.size)},
}}
"""


def read_mrcal(source: CameraText) -> ImportedCamera:
    """Read a .cameramodel file; the camera's pose and the valid region are left out.

    Raises:
        CalibrationError: if something is missing or wrong, or the lens model is none of ours.
    """
    text = _CALIBRATION_DATA.sub("", source.text)
    content = parse_text(text, source.file, _CAMERA_MODEL)
    stated = content["lensmodel"].text()
    model, defaults = _find_model(source, stated)
    numbers = content["intrinsics"].numbers(None).tolist()
    names = [name for name in source.list_parameters(model) if name not in ("skew", *defaults)]
    if len(numbers) != len(names):
        content["intrinsics"].fail(f"the {len(names)} numbers of {stated}")
    values = defaults | dict(zip(names, numbers, strict=True))
    size = source.choose_size(content["imagersize"].image_size())
    camera = source.make_camera(size, model, values)
    return ImportedCamera(camera, EXPORTER.title)


def _parse(text: str) -> dict[Any, Any]:
    """Return the object that a text describes in the syntax of Python."""
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        place = f" in line {error.lineno}" if error.lineno else ""
        raise NotOfLanguageError(f"{error.msg}{place}") from error
    if not isinstance(tree, ast.Dict):
        raise NotOfLanguageError("it does not describe an object")
    refuse_repeated(key.value for key in tree.keys if isinstance(key, ast.Constant))
    content = ast.literal_eval(tree)
    # Tuples are lists to mrcal.
    return {k: list(v) if isinstance(v, tuple) else v for k, v in content.items()}


_CAMERA_MODEL = Language("a camera model of mrcal", _parse, _MAX_LENGTH)


def _find_model(source: CameraText, name: str) -> tuple[str, dict[str, float]]:
    """Return our id of a model of mrcal's, and the coefficients that its name implies."""
    if name in _READABLE:
        return _READABLE[name], {}
    if name == "LENSMODEL_STEREOGRAPHIC":
        return "ucm", {"alpha": 0.5}
    readable = [*_READABLE, "LENSMODEL_STEREOGRAPHIC", "LENSMODEL_SPLINED_STEREOGRAPHIC of order 3"]
    splined = _SPLINED_NAME.fullmatch(name)
    if splined is None:
        source.refuse_model(name, readable)
    order, Nx, Ny, fov = map(int, splined.groups())
    if order != 3:
        source.refuse_model(name, readable, f"its splines are of order {order}")
    return f"{SPLINED}-{Nx}x{Ny}-{fov}", {}


EXPORTER = Exporter(
    name="mrcal",
    title="mrcal camera model",
    suffixes=(".cameramodel",),
    models=(*_LENS_MODELS, SPLINED),
    refits=("brown-conrady", "rational"),
    readers="mrcal 2 and its tools",
    keeps="the camera as OPENCV4, 5, 8 or 12 or as a splined model, and the region where corners "
    "were seen",
    loses="standard deviations, poses, corners",
    write=write_mrcal,
)
IMPORTER = Importer(EXPORTER.title, re.compile(r"""["']lensmodel["']\s*:"""), read_mrcal)

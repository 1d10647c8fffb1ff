"""ROS's camera_info file, as camera_calibration_parsers writes and reads it.

The message that `ros2 topic echo` and `rostopic echo` print is read as well: it has other names for
the same, and a line --- behind it. Of several messages the first one is read.

Reader: camera_calibration_parsers and image_geometry of ROS, any YAML reader, and `read_ros`.
Pixels are OpenCV's (0-based, integer at pixel centres), and so are the coefficients. The
distortion models are plumb_bob (k1 k2 p1 p2 k3), rational_polynomial (k1 k2 p1 p2 k3 k4 k5 k6) and
equidistant (k1 k2 k3 k4 of cv2.fisheye). `rectification_matrix` and `projection_matrix` are those
of the stereo pair of the file that was read; otherwise they are the identity and [K | 0]: a
rectified image keeps the camera's focal lengths and centre.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from calibgui.dataset import Result, StereoRectification
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.node import Node
from calibgui.formats.opencv_lens import (
    FISHEYE,
    list_coefficients,
    make_opencv_camera,
    read_rectification,
)
from calibgui.formats.opencv_storage import read_matrix
from calibgui.formats.yaml_document import format_number, parse_yaml

_DISTORTION_MODELS = {
    "pinhole": "plumb_bob",
    "brown-conrady-4": "plumb_bob",
    "brown-conrady": "plumb_bob",
    "rational": "rational_polynomial",
    FISHEYE: "equidistant",
}
"""ROS's names of the lens models that it holds."""
_READABLE = {
    "plumb_bob": (0, 4, 5),
    "rational_polynomial": (8, 12, 14),
    "equidistant": (4,),
    "fisheye": (4,),
}
"""Numbers of coefficients by distortion models that are read."""
_FILE_NAMES = (
    *("image_width", "image_height", "camera_matrix", "distortion_coefficients"),
    *("rectification_matrix", "projection_matrix"),
)
_MESSAGE_NAMES = (("width", "height", *"kdrp"), ("width", "height", *"KDRP"))
"""Names of the same entries in messages of ROS 2 and ROS 1."""
_MESSAGE_END = re.compile(r"^---[ \t\r]*$", re.MULTILINE)
_REDUCED = (
    "The message states a binning or a region of interest. The camera is that of the whole image "
    "of the sensor: convert it with --binning or --crop."
)


def write_ros(result: Result, path: Path) -> ExportReport:
    """Write a camera_info file; the camera is named after the file."""
    name = _make_camera_name(path)
    return write_in_models(
        result,
        path,
        EXPORTER,
        lambda fitted, note: format_camera_info(fitted.camera, name, note, result.rectification),
    )


def format_camera_info(
    camera: Camera, name: str, note: str, rectification: StereoRectification | None = None
) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    width, height = camera.size
    R, P = np.eye(3), np.hstack([camera.matrix, np.zeros((3, 1))])
    if rectification is not None:
        R, P = rectification.R, rectification.P
    coefficients = list_coefficients(camera)
    if camera.model == "brown-conrady-4":
        coefficients = np.append(coefficients, 0.0)  # ROS's plumb_bob has five
    return "".join(
        [
            f"# {note}\n# {FRAME}\n",
            f"image_width: {width}\nimage_height: {height}\ncamera_name: {name}\n",
            _format_matrix("camera_matrix", camera.matrix),
            f"distortion_model: {_DISTORTION_MODELS[camera.model]}\n",
            _format_matrix("distortion_coefficients", coefficients[None]),
            _format_matrix("rectification_matrix", R),
            _format_matrix("projection_matrix", P),
        ]
    )


def _format_matrix(name: str, values: Array) -> str:
    rows, cols = values.shape
    data = ", ".join(format_number(value) for value in values.ravel().tolist())
    return f"{name}:\n  rows: {rows}\n  cols: {cols}\n  data: [{data}]\n"


def _make_camera_name(path: Path) -> str:
    """Return the file's name as ROS allows it, in letters, digits and underscores."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in path.stem)


def read_ros(source: CameraText) -> ImportedCamera:
    """Read the camera of a camera_info file, and the rectification of a stereo pair.

    Raises:
        CalibrationError: if something is missing or wrong, or the lens model is none of ours.
    """
    messages = (part for part in _MESSAGE_END.split(source.text) if part.strip())
    content = parse_yaml(next(messages, ""), source.file)
    names = next((each for each in _MESSAGE_NAMES if content.get(each[2])), _FILE_NAMES)
    size = source.choose_size((content[names[0]].integer(), content[names[1]].integer()))
    K, D = content[names[2]], content[names[3]]
    matrix, coefficients = read_matrix(K), read_matrix(D)
    if len(matrix) != 9:
        K.fail("a matrix of 3 x 3 numbers")
    model = content["distortion_model"].text()
    if model not in _READABLE:
        source.refuse_model(repr(model), list(_READABLE))
    if len(coefficients) not in _READABLE[model]:
        counts = " or ".join(map(str, _READABLE[model]))
        D.fail(f"{counts} coefficients, as {model} has ({len(coefficients)} are given)")
    fisheye = model in ("equidistant", "fisheye")
    camera = make_opencv_camera(source, size, matrix, coefficients, fisheye)
    R, P = content.get(names[4]), content.get(names[5])
    notes = (_REDUCED,) if names is not _FILE_NAMES and _is_reduced(content) else ()
    found = read_rectification(R, P, camera)
    return ImportedCamera(camera, EXPORTER.title, notes=notes, rectification=found)


def _is_reduced(message: Node) -> bool:
    """Return whether a message states that its images are binned, or a part of the sensor's."""
    binning = [message.get(name) for name in ("binning_x", "binning_y")]
    roi = message.get("roi")
    offsets = [roi.get(name) for name in ("x_offset", "y_offset")] if roi else []
    return any(node and node.number() > 1 for node in binning) or any(
        node and node.number() > 0 for node in offsets
    )


EXPORTER = Exporter(
    name="ros",
    title="ROS camera_info",
    suffixes=(".yaml", ".yml"),
    models=tuple(_DISTORTION_MODELS),
    refits=("brown-conrady", FISHEYE),
    readers="ROS 1 and 2: camera_info_url, image_proc",
    keeps="the camera as plumb_bob, rational_polynomial or equidistant, and a stereo pair's "
    "rectification that was read",
    loses="standard deviations, poses, corners",
    write=write_ros,
    holds_rectification=True,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(
        r"\A(?=.*^(camera_matrix|[kK])[ \t]*:)(?=.*^(image_)?width[ \t]*:)"
        r"(?=.*^distortion_model[ \t]*:)",
        re.MULTILINE | re.DOTALL,
    ),
    read_ros,
)

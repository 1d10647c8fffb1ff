"""PhotonVision's calibrations in JSON: the export of one, or the settings of a camera with several.

    {"resolution": {"width", "height"}, "cameraIntrinsics": {"data"}, "distCoeffs": {"data"}, ...}

Read by `read_photonvision`, never written. Pixels and coefficients are OpenCV's, also where mrcal
has calibrated; older versions call the coefficients cameraExtrinsics. Settings hold a list of such
objects, `calibrations`, one for each size of images: a camera is chosen by that, as 1280x720.
What it says of its observations and of the board's bend is left out.
"""

from __future__ import annotations

import re

from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import parse_json
from calibgui.formats.node import Node
from calibgui.formats.opencv_lens import make_opencv_camera

_TITLE = "PhotonVision calibration"
_OPENCV = "LENSMODEL_OPENCV"


def read_photonvision(source: CameraText) -> ImportedCamera:
    """Read a camera of a calibration, or of several.

    Raises:
        CalibrationError: if something is missing or wrong, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    content = parse_json(source.text, source.file)
    several = content.get("calibrations")
    listed = several.items() if several else [content]
    cameras = {"x".join(map(str, _read_size(node))): node for node in listed}
    name, node = source.choose_camera(cameras)
    model = stated.text() if (stated := node.get("lensmodel")) else _OPENCV
    if not model.startswith(_OPENCV):
        source.refuse_model(model, [_OPENCV])
    coefficients = node.get("distCoeffs") or node["cameraExtrinsics"]
    matrix = node["cameraIntrinsics"]["data"].numbers(9)
    size = source.choose_size(_read_size(node))
    camera = make_opencv_camera(source, size, matrix, coefficients["data"].numbers(None), False)
    notes = (f"Calibration {name} of {len(cameras)}.",) if len(cameras) > 1 else ()
    return ImportedCamera(camera, _TITLE, notes=notes)


def _read_size(node: Node) -> tuple[int, int]:
    size = node["resolution"]
    return size["width"].integer(), size["height"].integer()


IMPORTER = Importer(
    _TITLE, re.compile(r'"cameraIntrinsics"\s*:\s*\{'), read_photonvision, several=True
)

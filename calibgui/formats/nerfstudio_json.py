"""transforms.json of nerfstudio and Instant NGP: a camera, and where it took each photograph.

Reader: nerfstudio's data parser, Instant NGP, programs that take their data, and `read_nerfstudio`.
Pixels have whole
numbers at their corners, as in COLMAP, from which nerfstudio's own files come: the principal point
is half a pixel more than OpenCV's. The models are OPENCV (k1 k2 p1 p2 of OpenCV, and k3 of r^6) and
OPENCV_FISHEYE (cv2.fisheye's k1 k2 k3 k4). `transform_matrix` leads from the camera to the world,
in the axes of OpenGL (``camera_places.py``) and in metres; the world is the board. Paths of images
are relative to the file.
Cannot hold: other lens models and skew (they are refitted), standard deviations, corners.

A file whose frames have a camera each, as that of a rig (``rig_arrays.py``), states none for all
of them, and is not read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from calibgui.dataset import Result
from calibgui.engine.calibration import Calibration
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import corner_from_array
from calibgui.formats.camera_places import world_from_camera_upright
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.image_names import locate_from
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import dumps, parse_json
from calibgui.formats.opencv_lens import FISHEYE

_COEFFICIENTS = ("k1", "k2", "k3", "k4", "p1", "p2")
"""Keys of the coefficients; of OPENCV k4 multiplies r^8, and OPENCV_FISHEYE has p1 and p2."""
_READABLE = {"OPENCV": "brown-conrady", "OPENCV_FISHEYE": FISHEYE, "PINHOLE": "pinhole"}


def write_nerfstudio(result: Result, path: Path) -> ExportReport:
    """Write a transforms.json."""
    images = [locate_from(path.parent, view.image) for view in result.used]
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_transforms(fitted, images, note)
    )


def format_transforms(calibration: Calibration, images: list[str], note: str) -> str:
    """Return the text of the file.

    Args:
        calibration: its camera is in one of the format's models.
        images: the path of each pose's image.
        note: the note on the file.
    """
    content: dict[str, Any] = {
        "note": note,
        "camera_model": name_model(calibration.camera),
        **list_intrinsics(calibration.camera),
        "frames": [
            {"file_path": image, "transform_matrix": world_from_camera_upright(pose).tolist()}
            for image, pose in zip(images, calibration.poses, strict=True)
        ],
    }
    return dumps(content) + "\n"


def name_model(camera: Camera) -> str:
    """Return nerfstudio's name of the model of a camera in one of the format's."""
    return "OPENCV_FISHEYE" if camera.model == FISHEYE else "OPENCV"


def list_intrinsics(camera: Camera) -> dict[str, float]:
    """Return the entries of a camera, which stand beside all frames or within one."""
    (fx, fy), (cx, cy) = camera.focal.tolist(), corner_from_array(camera.centre).tolist()
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    return {
        "w": camera.size[0],
        "h": camera.size[1],
        "fl_x": fx,
        "fl_y": fy,
        "cx": cx,
        "cy": cy,
        **{name: values.get(name, 0.0) for name in _COEFFICIENTS},
    }


def read_nerfstudio(source: CameraText) -> ImportedCamera:
    """Read the camera of all frames; where these were taken is left out.

    Raises:
        CalibrationError: if something is missing or wrong, or the lens model is none of ours.
    """
    content = parse_json(source.text, source.file)
    stated = "OPENCV" if (node := content.get("camera_model")) is None else node.text()
    if stated not in _READABLE:
        source.refuse_model(stated, list(_READABLE))
    model = _READABLE[stated]
    size = source.choose_size([content["w"].number(), content["h"].number()])
    fx, fy, cx, cy = (content[key].number() for key in ("fl_x", "fl_y", "cx", "cy"))
    values = {"fx": fx, "fy": fy, "cx": cx - 0.5, "cy": cy - 0.5}
    names = source.list_parameters(model)
    for key in _COEFFICIENTS:
        coefficient = 0.0 if (node := content.get(key)) is None else node.number()
        if key in names:
            values[key] = coefficient
        elif coefficient != 0:
            source.refuse_model(stated, list(_READABLE), f"its {key} is not 0")
    return ImportedCamera(source.make_camera(size, model, values), EXPORTER.title)


EXPORTER = Exporter(
    name="nerfstudio",
    title="nerfstudio transforms.json",
    suffixes=(".json",),
    models=("brown-conrady", "brown-conrady-4", "pinhole", FISHEYE),
    refits=("brown-conrady", FISHEYE),
    readers="nerfstudio, Instant NGP",
    keeps="the camera as OPENCV or OPENCV_FISHEYE, and where it was at each photograph, in "
    "metres from the board",
    loses="standard deviations, corners",
    write=write_nerfstudio,
    needs_corners=True,
)
IMPORTER = Importer(EXPORTER.title, re.compile(r'"fl_x"\s*:'), read_nerfstudio)

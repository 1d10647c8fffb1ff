"""calibration.toml of Anipose, Pose2Sim and FreeMoCap, with one camera.

Reader: aniposelib, Pose2Sim and what takes their calibrations, and `read_anipose`. Pixels are
OpenCV's (0-based, integer at pixel centres), and so are the coefficients: 4, 5, 8 or 12 of
cv2.projectPoints, or with `fisheye = true` the four of cv2.fisheye, which Pose2Sim does not know.
`rotation` (a rotation vector) and `translation` lead from the world to the camera: one camera is
the world, and of a rig (``rig_arrays.py``) its first one.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose
from calibgui.formats.camera_places import WORLD
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.node import Node
from calibgui.formats.opencv_lens import (
    FISHEYE,
    PERSPECTIVE_MODELS,
    list_coefficients,
    make_opencv_camera,
)
from calibgui.formats.toml_document import parse_toml

_MAX_LENGTH = 1 << 20
"""Length of the longest text that is read, characters: a camera has some five hundred."""


def write_anipose(result: Result, path: Path) -> ExportReport:
    """Write a calibration of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_calibration([fitted.camera], note)
    )


def format_calibration(
    cameras: Sequence[Camera],
    note: str,
    names: Sequence[str] = ("cam_0",),
    poses: Sequence[Pose] = (WORLD,),
) -> str:
    """Return the text of the file.

    Args:
        cameras: each in one of the format's models.
        note: the note on the file.
        names: their names.
        poses: cam_from_world; translations in the file's unit.
    """
    digits = len(str(len(cameras) - 1))  # readers sort the tables by their names
    tables = [
        f"[cam_{c:0{digits}}]\nname = {quote(name)}\n{format_entries(camera, pose)}\n"
        for c, (camera, name, pose) in enumerate(zip(cameras, names, poses, strict=True))
    ]
    metadata = "[metadata]\nadjusted = false\nerror = 0.0\n"
    return f"# {note}\n# {FRAME}\n{''.join(tables)}{metadata}"


def quote(text: str) -> str:
    """Return a text as TOML writes it."""
    return json.dumps(text, ensure_ascii=False)


def format_entries(camera: Camera, pose: Pose = WORLD) -> str:
    """Return the lines of a camera's table that caliscope reads as well."""
    (fx, fy), (cx, cy) = camera.focal.tolist(), camera.centre.tolist()
    return (
        f"size = {list(camera.size)}\n"
        f"matrix = {[[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]}\n"
        f"distortions = {list_coefficients(camera).tolist()}\n"
        f"rotation = {pose.rvec.tolist()}\n"
        f"translation = {pose.tvec.tolist()}\n"
        f"fisheye = {str(camera.model == FISHEYE).lower()}\n"
    )


def read_anipose(source: CameraText) -> ImportedCamera:
    """Read a camera, which has the name of its table; its pose is left out.

    Raises:
        CalibrationError: as `read_tables`.
    """
    return read_tables(source, parse_toml(source.text, source.file, _MAX_LENGTH), EXPORTER.title)


def read_tables(source: CameraText, tables: Node, title: str) -> ImportedCamera:
    """Read a camera of a format with such tables.

    Raises:
        CalibrationError: if something is missing or wrong, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    cameras = {
        name: node
        for name, node in tables.members().items()
        if isinstance(node.value, dict) and node.get("distortions") is not None
    }
    name, node = source.choose_camera(cameras)
    fisheye = node.get("fisheye")
    camera = make_opencv_camera(
        source,
        source.choose_size(node["size"].numbers(2).tolist()),
        node["matrix"].numbers(3, 3).ravel(),
        node["distortions"].numbers(None),
        fisheye=fisheye is not None and fisheye.flag(),
    )
    notes = (f"The camera {name} of {len(cameras)}.",) if len(cameras) > 1 else ()
    return ImportedCamera(camera, title, notes=notes)


EXPORTER = Exporter(
    name="anipose",
    title="Anipose calibration",
    suffixes=(".toml",),
    models=(*PERSPECTIVE_MODELS, FISHEYE),
    refits=("brown-conrady", FISHEYE),
    readers="Anipose, Pose2Sim, FreeMoCap",
    keeps="the camera in the models of cv2.projectPoints, or of cv2.fisheye, which Pose2Sim does "
    "not know",
    loses="standard deviations, poses, corners",
    write=write_anipose,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"^[ \t]*distortions[ \t]*=", re.MULTILINE),
    read_anipose,
    several=True,
)

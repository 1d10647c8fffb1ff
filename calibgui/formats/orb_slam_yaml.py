"""The lines on the camera of a settings file of ORB-SLAM3.

Reader: ORB-SLAM3 and its relatives, by cv2.FileStorage, and `read_orb_slam`, which reads those of
ORB-SLAM2 as well (`Camera.fx` for `Camera1.fx`). Pixels are OpenCV's (0-based, integer at pixel
centres). The types are PinHole (k1 k2 p1 p2 of OpenCV, and k3 where there is one) and
KannalaBrandt8 (cv2.fisheye's k1 k2 k3 k4). A settings file has lines on features and the viewer,
too, which ORB-SLAM3 brings along: these lines take the place of those on the camera.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

import re
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import PINHOLE, Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.opencv_lens import FISHEYE
from calibgui.formats.yaml_document import format_number, parse_yaml

_COEFFICIENTS = {
    "brown-conrady": ("k1", "k2", "p1", "p2", "k3"),
    "brown-conrady-4": ("k1", "k2", "p1", "p2"),
    "pinhole": ("k1", "k2", "p1", "p2"),
    FISHEYE: ("k1", "k2", "k3", "k4"),
}
"""The coefficients of the lines, by lens model; those of a pinhole camera are 0."""
_READABLE = {"PinHole": "brown-conrady", "KannalaBrandt8": FISHEYE}


def write_orb_slam(result: Result, path: Path) -> ExportReport:
    """Write the lines of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_settings(fitted.camera, note)
    )


def format_settings(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    names = (*PINHOLE, *_COEFFICIENTS[camera.model])
    lines = [f"Camera1.{name}: {format_number(values.get(name, 0.0))}" for name in names]
    kind = "KannalaBrandt8" if camera.model == FISHEYE else "PinHole"
    listed = "\n".join(lines)
    return (
        f'%YAML:1.0\n# {note}\n# {FRAME}\nFile.version: "1.0"\nCamera.type: "{kind}"\n{listed}\n'
        f"Camera.width: {camera.size[0]}\nCamera.height: {camera.size[1]}\n"
    )


def read_orb_slam(source: CameraText) -> ImportedCamera:
    """Read the first camera of a settings file.

    Raises:
        CalibrationError: if something is missing or wrong, or the type of camera is none of ours.
    """
    content = parse_yaml(source.text, source.file)
    kind = content["Camera.type"].text()
    if kind not in _READABLE:
        source.refuse_model(kind, list(_READABLE))
    prefix = "Camera1." if content.get("Camera1.fx") is not None else "Camera."
    values = {name: content[f"{prefix}{name}"].number() for name in PINHOLE}
    for name in _COEFFICIENTS[_READABLE[kind]]:
        if (node := content.get(f"{prefix}{name}")) is not None:
            values[name] = node.number()
    sides = [content.get(f"Camera.{side}") for side in ("width", "height")]
    stated = None if None in sides else [side.number() for side in sides if side is not None]
    camera = source.make_camera(source.choose_size(stated), _READABLE[kind], values)
    return ImportedCamera(camera, EXPORTER.title)


EXPORTER = Exporter(
    name="orb-slam3",
    title="ORB-SLAM3 settings",
    suffixes=(".yaml", ".yml"),
    models=tuple(_COEFFICIENTS),
    refits=("brown-conrady", FISHEYE),
    readers="ORB-SLAM3",
    keeps="the camera as PinHole or KannalaBrandt8, in lines for a settings file",
    loses="standard deviations, poses, corners",
    write=write_orb_slam,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"^[ \t]*Camera\.type[ \t]*:", re.MULTILINE),
    read_orb_slam,
)

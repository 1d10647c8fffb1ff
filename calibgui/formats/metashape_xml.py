"""A camera calibration of Agisoft Metashape in XML, and the cameras that Metashape exports.

Reader: Metashape and PhotoScan from 1.2 on (Tools, Camera Calibration, Load), and `read_metashape`.
Pixels have whole numbers at their corners, and the principal point is counted from the middle of
the image. With a point (x, y) of the plane ahead of the camera, or for a fisheye of the same
direction and the length theta,

    x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + p1 (r^2 + 2 x^2) + 2 p2 x y
    y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + p2 (r^2 + 2 y^2) + 2 p1 x y
    u = w / 2 + cx + x' (f + b1) + y' b2,        v = h / 2 + cy + y' f:

p1 and p2 are OpenCV's p2 and p1, f is fy, b1 is fx - fy, and b2 the skew in px. A frame camera is
Brown's model, of which k4 must be 0 here, a fisheye Kannala and Brandt's with decentering.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.

Cameras that Metashape exports have each an initial calibration and, where it has aligned them, the
adjusted one behind it, which is read. They are chosen by their labels.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import corner_from_array
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.gate import Language, parse_text
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.xml_document import convert_number, parse_elements

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_FRAMES = ("brown-conrady", "brown-conrady-4", "pinhole")
_FISHEYES = ("kannala-brandt-decentering", "kannala-brandt")
_OURS = {"k1": "k1", "k2": "k2", "k3": "k3", "k4": "k4", "p1": "p2", "p2": "p1"}
"""Our names of Metashape's coefficients."""
_READABLE = {
    "frame": _FRAMES[0],
    "fisheye": _FISHEYES[0],
    "equidistant_fisheye": _FISHEYES[0],
}
"""Our models of Metashape's types of cameras."""
_MAX_LENGTH = 32 << 20
"""Length of the longest text that is read, characters: some thousand bytes for each photograph."""


def write_metashape(result: Result, path: Path) -> ExportReport:
    """Write the calibration of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_calibration(fitted.camera, note)
    )


def format_calibration(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    lines = "".join(f"  <{name}>{value!r}</{name}>\n" for name, value in list_values(camera))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"{format_note(note)}"
        "<calibration>\n"
        f"  <projection>{'fisheye' if is_fisheye(camera) else 'frame'}</projection>\n"
        f"  <width>{camera.size[0]}</width>\n"
        f"  <height>{camera.size[1]}</height>\n"
        f"{lines}"
        "</calibration>\n"
    )


def format_note(note: str) -> str:
    """Return a note as a comment, with its line's end."""
    return f"<!-- {escape(note, quote=False).replace('--', '- -')} -->\n"


def is_fisheye(camera: Camera) -> bool:
    """Return whether Metashape calls a camera in one of its models a fisheye."""
    return camera.model in _FISHEYES


def list_values(camera: Camera) -> list[tuple[str, float]]:
    """List Metashape's names and values of a camera in one of its models."""
    ours = dict(zip(camera.names, camera.params.tolist(), strict=True))
    cx, cy = (corner_from_array(camera.centre) - [side / 2 for side in camera.size]).tolist()
    values = {"f": ours["fy"], "cx": cx, "cy": cy}
    values |= {name: ours[own] for name, own in _OURS.items() if own in ours}
    values |= {"b1": ours["fx"] - ours["fy"], "b2": ours.get("skew", 0.0) * ours["fx"]}
    return list(values.items())


def read_metashape(source: CameraText) -> ImportedCamera:
    """Read a calibration, or the adjusted one of a camera that Metashape has exported.

    Raises:
        CalibrationError: if something is missing or wrong, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    content = parse_text(source.text, source.file, Language("an XML file", _parse, _MAX_LENGTH))
    cameras = content["cameras"].members()
    name, node = source.choose_camera(cameras)
    stated = node["projection"].text()
    if stated not in _READABLE:
        source.refuse_model(stated, list(_READABLE))
    model = _READABLE[stated]
    if node.get("f") is None and node.get("fx") is not None:
        source.fail(
            "is in the format of PhotoScan before 1.2.", "Write it again with a newer version."
        )
    width, height = source.choose_size([node[side].number() for side in ("width", "height")])
    given = {key: value.number() for key, value in node.members().items() if key in _NUMBERS}
    fy, b1, b2 = node["f"].number(), given.pop("b1", 0.0), given.pop("b2", 0.0)
    if fy + b1 <= 0:
        source.fail("has a focal length that is not above 0.")
    values = {
        "fx": fy + b1,
        "fy": fy,
        "cx": width / 2 + given.pop("cx", 0.0) - 0.5,
        "cy": height / 2 + given.pop("cy", 0.0) - 0.5,
        "skew": b2 / (fy + b1),
    }
    values |= {_OURS.get(key, key): value for key, value in given.items()}
    names = source.list_parameters(model)
    for key in values.keys() - set(names):
        if values.pop(key) != 0:
            name_there = "b2" if key == "skew" else key
            source.refuse_model(stated, list(_READABLE), f"its {name_there} is not 0")
    notes = [f"The camera {name} of {len(cameras)}."] if len(cameras) > 1 else []
    if node.get("class") is not None and node["class"].text() == "initial":
        notes.append("It is the calibration that Metashape began with: it has not adjusted any.")
    camera = source.make_camera((width, height), model, values)
    return ImportedCamera(camera, EXPORTER.title, notes=tuple(notes))


_NUMBERS = ("cx", "cy", "b1", "b2", "p3", "p4", *_OURS)
"""Elements of a calibration that are 0 where they are left out."""


def _parse(text: str) -> dict[str, Any]:
    """Return the calibrations of an XML text by the names of their cameras."""
    root = parse_elements(text)
    if root.tag == "calibration":
        return {"cameras": {"camera": _convert(root)}}
    cameras: dict[str, Any] = {}
    for sensor in root.iter("sensor"):
        label = sensor.get("label") or sensor.get("id") or "camera"
        name = f"{label} ({sensor.get('id')})" if label in cameras else label
        if (calibration := _find_calibration(sensor)) is not None:
            cameras[name] = _convert(calibration)
    return {"cameras": cameras}


def _find_calibration(sensor: Element) -> Element | None:
    """Return the adjusted calibration of a camera, or else the only other one."""
    found = sensor.findall("calibration")
    return next(
        (one for one in found if one.get("class") == "adjusted"), found[0] if found else None
    )


def _convert(calibration: Element) -> dict[str, Any]:
    """Return the entries of a calibration, with its size and type among them."""
    return dict(_list_entries(calibration))


def _list_entries(calibration: Element) -> Iterator[tuple[str, Any]]:
    for attribute, name in (("type", "projection"), ("class", "class")):
        if (value := calibration.get(attribute)) is not None:
            yield name, value
    for entry in calibration:
        if entry.tag == "resolution":
            for side in ("width", "height"):
                yield side, convert_number(entry.get(side, ""))
        else:
            yield entry.tag, convert_number((entry.text or "").strip())


EXPORTER = Exporter(
    name="metashape",
    title="Metashape calibration",
    suffixes=(".xml",),
    models=(*_FRAMES, *_FISHEYES),
    refits=("brown-conrady", "kannala-brandt-decentering"),
    holds_skew=True,
    readers="Metashape, PhotoScan from 1.2 on",
    keeps="the camera as frame or fisheye with k1 to k4, p1, p2, b1, b2",
    loses="standard deviations, poses, corners",
    write=write_metashape,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"<calibration>\s*<projection>|<sensors\b"),
    read_metashape,
    several=True,
)

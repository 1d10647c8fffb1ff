"""Gyroflow's lens profile in JSON, of one camera or of the focal lengths of a zoom lens.

Reader: Gyroflow (src/core/lens_profile.rs), which undistorts and stabilises videos with it, and
`read_gyroflow`. Pixels are OpenCV's (0-based, integer at pixel centres), as Gyroflow calibrates
with OpenCV. The models are opencv_fisheye (cv2.fisheye's k1 k2 k3 k4) and opencv_standard (k1 k2 p1
p2 and up to eight more of cv2.projectPoints). Gyroflow puts the principal point in the middle of
the image unless `asymmetrical` is true, and takes a profile without `calibrator_version` for
damaged, one without `distortion_model` for opencv_fisheye.

It works in images with square pixels: where those of the video are not, by an anamorphic lens or in
PAL, `input_horizontal_stretch` (or vertical) says by how much it stretches them, u' = s u, and the
camera matrix and `calib_dimension` are those of the stretched images. `orig_dimension` is the
video's.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.

A zoom lens has `interpolations`: focal lengths in mm as keys, each with its camera matrix and
coefficients, between which Gyroflow interpolates linearly. All of them are of one lens model and
have the same number of coefficients; the profile's own camera is that of the shortest focal length.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from calibgui.dataset import UNKNOWN_HARDWARE, Hardware, Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.engine.files import write_atomically
from calibgui.formats.camera_conversion import convert_alike, describe_conversion
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import dumps, parse_json
from calibgui.formats.node import Node
from calibgui.formats.opencv_lens import (
    FISHEYE,
    PERSPECTIVE_MODELS,
    list_coefficients,
    make_opencv_camera,
)
from calibgui.formats.origin import make_mark
from calibgui.version import __version__

_MIN_STRETCH = 1.05
"""Ratio of the focal lengths from which pixels are not meant to be square: those of NTSC and PAL
video are 1.07 to 1.09, of the paper's camera 1.0002."""
_MODELS = ("opencv_standard", "opencv_fisheye")
"""Gyroflow's names of the lens models that are read; its others are those of one camera each."""


def write_gyroflow(result: Result, path: Path) -> ExportReport:
    """Write the profile of one camera."""
    hardware = result.find_hardware()
    return write_in_models(
        result,
        path,
        EXPORTER,
        lambda fitted, note: format_profile([(None, fitted.camera)], note, hardware),
    )


def write_gyroflow_zoom(cameras: Sequence[tuple[float, Camera]], path: Path) -> ExportReport:
    """Write the profile of a zoom lens.

    Args:
        cameras: nominal focal lengths, mm, and the camera at each, all of one lens model.
        path: the file.

    Raises:
        CalibrationError: if no lens model of Gyroflow's follows all of them, or the file cannot be
            written.
    """
    ordered = sorted(cameras, key=lambda pair: pair[0])
    originals = [camera for _, camera in ordered]
    found = convert_alike(originals, EXPORTER, path)
    worst = max(range(len(found)), key=lambda k: found[k].largest_error)
    note = describe_conversion(originals[worst], found[worst])
    written = [(focal, one.camera) for (focal, _), one in zip(ordered, found, strict=True)]
    write_atomically(path, format_profile(written, f"{make_mark(EXPORTER.name)} {note}").encode())
    return ExportReport(path, note, found[worst].largest_error)


def format_profile(
    cameras: Sequence[tuple[float | None, Camera]], note: str, hardware: Hardware = UNKNOWN_HARDWARE
) -> str:
    """Return the text of the file.

    Args:
        cameras: focal lengths in ascending order, mm, and the camera at each, in one of the
            format's models; a single camera may have None.
        note: the note on the file.
        hardware: the names of camera and lens.
    """
    focal, camera = cameras[0]
    stretch = _measure_stretch(camera)
    width, height = np.rint(stretch * camera.size).astype(int).tolist()
    content: dict[str, Any] = {
        "name": " ".join(filter(None, [hardware.maker, hardware.model, hardware.lens])),
        "note": note,
        "calibrated_by": "calibgui",
        "camera_brand": hardware.maker or "",
        "camera_model": hardware.model or "",
        "lens_model": hardware.lens or "",
        "camera_setting": "",
        "calib_dimension": {"w": width, "h": height},
        "orig_dimension": dict(zip("wh", camera.size, strict=True)),
        "input_horizontal_stretch": float(stretch[0]),
        "input_vertical_stretch": float(stretch[1]),
        "num_images": 0,
        "fps": 0.0,
        "official": False,
        "asymmetrical": True,
        "fisheye_params": {"RMS_error": 0.0} | _encode_camera(camera, stretch),
        "distortion_model": _MODELS[camera.model == FISHEYE],
        "calibrator_version": f"calibgui {__version__}",
        "date": "",
        "compatible_settings": [],
    }
    if focal is not None:
        content["focal_length"] = focal
        content["interpolations"] = {
            f"{mm:g}": {"focal_length": mm} | _encode_camera(one, stretch) for mm, one in cameras
        }
    return dumps(content) + "\n"


def _measure_stretch(camera: Camera) -> Array:
    """Return (2,) by how much images are stretched to have square pixels; 1 where they nearly
    are."""
    stretch: Array = camera.focal.max() / camera.focal
    return stretch if stretch.max() >= _MIN_STRETCH else np.ones(2)


def _encode_camera(camera: Camera, stretch: Array) -> dict[str, Any]:
    fx, fy, cx, cy = (camera.params[:4] * np.tile(stretch, 2)).tolist()
    return {
        "camera_matrix": [[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]],
        "distortion_coeffs": list_coefficients(camera).tolist(),
    }


def read_gyroflow(source: CameraText) -> ImportedCamera:
    """Read the camera of a profile; that of a zoom lens is named by its focal length in mm.

    Raises:
        CalibrationError: if something is missing or wrong, the profile holds several focal lengths
            and none is chosen, or its lens model is none of ours.
    """
    content = parse_json(source.text, source.file)
    stated = content.get("distortion_model")
    model = "opencv_fisheye" if stated is None else stated.text()
    if model not in _MODELS:
        source.refuse_model(model, _MODELS)
    node = _choose_focal_length(source, content)
    K, D = node["camera_matrix"].numbers(3, 3).ravel(), node["distortion_coeffs"].numbers(None)
    dimension = content["calib_dimension"]
    stretch = np.array([_read_stretch(content, axis) for axis in ("horizontal", "vertical")])
    K = K / np.repeat([*stretch, 1.0], 3)
    stretched = np.array([dimension["w"].integer(), dimension["h"].integer()])
    size = source.choose_size(np.rint(stretched / stretch).tolist())
    camera = make_opencv_camera(source, size, K, D, fisheye=model == "opencv_fisheye")
    notes = []
    if (free := content.get("asymmetrical")) is None or not free.flag():
        notes.append("Gyroflow puts the principal point in the middle; it is read as calibrated.")
    return ImportedCamera(camera, EXPORTER.title, notes=tuple(notes))


def _read_stretch(content: Node, axis: str) -> float:
    """Return by how much Gyroflow stretches the images along an axis; it takes no less than 0.01
    for a stretch."""
    node = content.get(f"input_{axis}_stretch")
    stretch = 1.0 if node is None or node.value is None else node.number()
    return stretch if stretch > 0.01 else 1.0


def _choose_focal_length(source: CameraText, content: Node) -> Node:
    """Return the entries of the wanted focal length, or of a profile's only camera."""
    several = content.get("interpolations")
    if several is not None and several.value:
        return source.choose_camera(several.members())[1]
    if source.wanted is not None:
        source.fail("is of one camera without a name.", f"Leave the name {source.wanted!r} out.")
    return content["fisheye_params"]


EXPORTER = Exporter(
    name="gyroflow",
    title="Gyroflow lens profile",
    suffixes=(".json",),
    models=(*PERSPECTIVE_MODELS, FISHEYE),
    refits=("brown-conrady", FISHEYE),
    readers="Gyroflow",
    keeps="the camera as opencv_standard or opencv_fisheye, a zoom lens with its focal lengths, "
    "the names of camera and lens",
    loses="standard deviations, poses, corners",
    write=write_gyroflow,
    write_zoom=write_gyroflow_zoom,
)
IMPORTER = Importer(
    EXPORTER.title, re.compile(r'"fisheye_params"\s*:'), read_gyroflow, several=True
)

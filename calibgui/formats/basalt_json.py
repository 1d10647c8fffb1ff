"""Basalt's calibration in JSON, with one camera.

Reader: Basalt and what takes its calibrations, any JSON reader, and `read_basalt`. Pixels are
OpenCV's (0-based, integer at pixel centres). Camera types are pinhole, pinhole-radtan8 (k1 k2 p1 p2
k3 k4 k5 k6 of OpenCV's rational model, whose last three are 0 for a camera without them), kb4
(cv2.fisheye's k1 k2 k3 k4), ucm, eucm and ds. The entry `rpmax` of radtan8 is the radius
|(X, Y)| / Z up to which points are projected: the largest in the image.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.

Basalt calibrates cameras with an inertial sensor and wants all entries to be there: the sensor
lies in the camera, and has no bias and no noise, until Basalt calibrates it. Cameras have no
names: they are chosen by their numbers, from 0.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.camera import PINHOLE, Camera, list_parameter_names, rays_from_pixels
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import dumps, parse_json

_CAMERA_TYPES = {
    "kannala-brandt": "kb4",
    "double-sphere": "ds",
    "eucm": "eucm",
    "ucm": "ucm",
    "pinhole": "pinhole",
    "brown-conrady-4": "pinhole-radtan8",
    "brown-conrady": "pinhole-radtan8",
    "rational": "pinhole-radtan8",
}
"""Basalt's names of our models; names of parameters are the same in both."""
_READABLE = {name: model for model, name in _CAMERA_TYPES.items()}
_RADTAN8 = "k1 k2 p1 p2 k3 k4 k5 k6"
_IDENTITY = {"px": 0.0, "py": 0.0, "pz": 0.0, "qx": 0.0, "qy": 0.0, "qz": 0.0, "qw": 1.0}


def write_basalt(result: Result, path: Path) -> ExportReport:
    """Write a calibration of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_calibration(fitted.camera, note)
    )


def format_calibration(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    if _CAMERA_TYPES[camera.model] == "pinhole-radtan8":
        names = (*PINHOLE, *_RADTAN8.split())
        values = {name: values.get(name, 0.0) for name in names}
        values["rpmax"] = _measure_radius(camera)
    content = {
        "note": note,
        "T_imu_cam": [_IDENTITY],
        "intrinsics": [{"camera_type": _CAMERA_TYPES[camera.model], "intrinsics": values}],
        "resolution": [list(camera.size)],
        "calib_accel_bias": [0.0] * 9,
        "calib_gyro_bias": [0.0] * 12,
        "imu_update_rate": 0.0,
        "accel_noise_std": [0.0] * 3,
        "gyro_noise_std": [0.0] * 3,
        "accel_bias_std": [0.0] * 3,
        "gyro_bias_std": [0.0] * 3,
        "cam_time_offset_ns": 0,
        "vignette": [],
    }
    return dumps({"value0": content}) + "\n"


def _measure_radius(camera: Camera) -> float:
    """Return the largest radius |(X, Y)| / Z of the rays of the image, and 1 % more."""
    width, height = camera.size
    u, v = np.meshgrid(np.linspace(0, width - 1, 100), np.linspace(0, height - 1, 100))
    rays = rays_from_pixels(np.stack([u, v], axis=-1), camera)
    radius = np.hypot(rays[..., 0], rays[..., 1]) / rays[..., 2]
    return 1.01 * float(np.max(radius[np.isfinite(radius)], initial=0.0))


def read_basalt(source: CameraText) -> ImportedCamera:
    """Read a camera of a calibration; what it says of the inertial sensor is left out.

    Raises:
        CalibrationError: if something is missing or wrong, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    content = parse_json(source.text, source.file)["value0"]
    cameras = {str(k): node for k, node in enumerate(content["intrinsics"].items())}
    name, node = source.choose_camera(cameras)
    stated = node["camera_type"].text()
    if stated not in _READABLE:
        source.refuse_model(stated, list(_READABLE))
    model = _READABLE[stated]
    entries = node["intrinsics"]
    values = {
        name: entries[name].number() for name in list_parameter_names(model) if name != "skew"
    }
    sizes = content["resolution"].items()
    if int(name) >= len(sizes):
        content["resolution"].fail(f"a list with the size of camera {name}")
    size = source.choose_size(sizes[int(name)].image_size())
    camera = source.make_camera(size, model, values)
    notes = (f"Camera {name} of {len(cameras)}, counted from 0.",) if len(cameras) > 1 else ()
    return ImportedCamera(camera, EXPORTER.title, notes=notes)


EXPORTER = Exporter(
    name="basalt",
    title="Basalt calibration",
    suffixes=(".json",),
    models=tuple(_CAMERA_TYPES),
    refits=("brown-conrady", "kannala-brandt"),
    readers="Basalt",
    keeps="the camera as pinhole, pinhole-radtan8, kb4, ucm, eucm or ds",
    loses="standard deviations, poses, corners",
    write=write_basalt,
)
IMPORTER = Importer(EXPORTER.title, re.compile(r'"camera_type"\s*:'), read_basalt, several=True)

"""kalibr_imucam_chain.yaml of OpenVINS, with one camera.

Reader: OpenVINS, by cv2.FileStorage, and ``kalibr_camchain.read_kalibr``. Pixels are OpenCV's
(0-based, integer at pixel centres). The entries are Kalibr's, of which OpenVINS knows the models
pinhole-radtan (k1 k2 p1 p2) and pinhole-equidistant (cv2.fisheye's k1 k2 k3 k4). The inertial
sensor lies in the camera until its place is calibrated: `T_imu_cam` is the identity, the time shift
0.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.kalibr_camchain import format_camchain
from calibgui.formats.opencv_lens import FISHEYE


def write_openvins(result: Result, path: Path) -> ExportReport:
    """Write a chain of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_chain(fitted.camera, note)
    )


def format_chain(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    rows = "".join(f"    - {row}\n" for row in np.eye(4).tolist())
    return (
        f"%YAML:1.0\n{format_camchain(camera, note)}  T_imu_cam:\n{rows}  timeshift_cam_imu: 0.0\n"
    )


EXPORTER = Exporter(
    name="openvins",
    title="OpenVINS camera chain",
    suffixes=(".yaml", ".yml"),
    models=("brown-conrady-4", FISHEYE),
    refits=("brown-conrady-4", FISHEYE),
    readers="OpenVINS",
    keeps="the camera as radtan or equidistant",
    loses="standard deviations, poses, corners, the place of the inertial sensor",
    write=write_openvins,
)

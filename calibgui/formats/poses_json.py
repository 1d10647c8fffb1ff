"""poses.json: the board's pose in each photograph of a known camera.

    {"format": "calibgui-poses", "version": 1, "camera": {"model", "size", "params": {...}},
     "camera_errors_count": true, "target": board or null, "lengths_confirmed": true,
     "views": [{"image", "corners", "rms_px", "noise_px", "rvec", "tvec_mm", "sigma_rvec",
                "sigma_tvec_mm", "pose_covariance", "pose_covariance_by_noise", "pose_by_camera",
                "mirrored_worse_by_sigmas", "reason"}, ...]}

Reader: any JSON reader; `read_pose`. A point X of the board, mm, is at R X + tvec in the camera's
frame (X right, Y down, Z ahead), R = exp(rvec), rad. `pose_covariance` (6 x 6) is that of (rvec,
tvec); where `camera_errors_count` it includes the errors of the camera, which all views share, and
`pose_by_camera` (6 x P) says how. It includes the error of the board's scale, which they share too,
where `target` has one. A view without a pose has null and the `reason`.
`mirrored_worse_by_sigmas` is null where the board cannot look alike from its other side.
Cannot hold: the corners (``corners_json.py``), correlations between views.
"""

from __future__ import annotations

import math
import os
from pathlib import PurePath
from typing import Any

import numpy as np

from calibgui.dataset import LocatedView, PoseSet
from calibgui.engine.calibration import BoardPose
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.formats.estimates_json import decode_pose, decode_pose_covariance
from calibgui.formats.json_document import check_format, read_json, write_json
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_board, encode_board

FORMAT = "calibgui-poses"
VERSION = 1


def encode_poses(poses: PoseSet) -> dict[str, Any]:
    """Return the content of poses.json."""
    camera = poses.camera
    return {
        "format": FORMAT,
        "version": VERSION,
        "camera": {
            "model": camera.model,
            "size": camera.size,
            "params": dict(zip(camera.names, camera.params.tolist(), strict=True)),
        },
        "camera_errors_count": poses.has_covariance,
        "target": None if poses.board is None else encode_board(poses.board),
        "lengths_confirmed": poses.lengths_confirmed,
        "views": [_encode_view(view) for view in poses.views],
    }


def write_poses(poses: PoseSet, path: str | os.PathLike[str]) -> None:
    """Write poses.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, encode_poses(poses))


def read_pose(path: str | os.PathLike[str], camera: Camera, image: str | None = None) -> BoardPose:
    """Read the pose of the board in one photograph.

    Args:
        path: the file.
        camera: the camera that the poses were found with.
        image: path or name of the photograph; None for the only one with a pose.

    Raises:
        CalibrationError: if the file cannot be read or was found with another camera, there are
            several poses and `image` does not choose one, or something in it is wrong; the message
            names the place.
    """
    node = read_json(path)
    remedy = "Name a file that `calibgui pose -o` wrote."
    check_format(node, FORMAT, VERSION, "a file of poses", remedy)
    _check_camera(node, camera)
    board = decode_board(node.get("target"))
    scale_sigma = 0.0 if board is None else board.scale_sigma
    return _decode_view(_choose_view(node, image), len(camera.params), scale_sigma)


def _check_camera(node: Node, camera: Camera) -> None:
    """Refuse poses that were found with another camera."""
    own, params = node["camera"], node["camera"]["params"]
    is_same = own["size"].image_size() == camera.size and own["model"].text() == camera.model
    if not is_same or any(
        params[name].number() != value
        for name, value in zip(camera.names, camera.params.tolist(), strict=True)
    ):
        raise CalibrationError(
            f"The poses in {node.file} were found with another camera.",
            "Name the camera's file that `calibgui pose` was given.",
        )


def _choose_view(node: Node, image: str | None) -> Node:
    """Return the view of an image, by its path or name, or the only one with a pose."""
    located = {
        view["image"].text(): view
        for view in node["views"].items()
        if view["rvec"].value is not None
    }
    named = [view for name, view in located.items() if image in (None, name, PurePath(name).name)]
    if len(named) != 1:
        what = "several poses" if named else "no pose"
        files = ", ".join(PurePath(name).name for name in located)
        raise CalibrationError(
            f"{node.file} holds {what}{f' of {image}' if image else ''}.",
            f"Name one of its images: {files}." if located else "Locate the board first.",
        )
    return named[0]


def _decode_view(view: Node, parameters: int, scale_sigma: float) -> BoardPose:
    """Return the pose of a view; its residuals are not in the file."""
    lead = view["mirrored_worse_by_sigmas"]
    return BoardPose(
        pose=decode_pose(view),
        covariance=decode_pose_covariance(view),
        noise_covariance=view["pose_covariance_by_noise"].covariances(6, 6, nullable=True),
        by_camera=view["pose_by_camera"].numbers(6, parameters),
        residuals=np.empty((0, 2)),
        noise=view["noise_px"].number(nullable=True),
        lead=math.inf if lead.value is None else lead.number(),
        scale_sigma=scale_sigma,
    )


def _encode_view(view: LocatedView) -> dict[str, Any]:
    found = view.found
    if found is None:
        empty = ("rms_px", "noise_px", "rvec", "tvec_mm", "sigma_rvec", "sigma_tvec_mm")
        return {"image": view.image, "corners": 0, **dict.fromkeys(empty), "reason": view.reason}
    return {
        "image": view.image,
        "corners": len(found.residuals),
        "rms_px": found.rms,
        "noise_px": found.noise,
        "rvec": found.pose.rvec,
        "tvec_mm": found.pose.tvec,
        "sigma_rvec": found.sigma[:3],
        "sigma_tvec_mm": found.sigma[3:],
        "pose_covariance": found.covariance,
        "pose_covariance_by_noise": found.noise_covariance,
        "pose_by_camera": found.by_camera,
        "mirrored_worse_by_sigmas": found.lead,
        "reason": "",
    }

"""Photographs of a camera that is known from a file: it is held, and only boards are located.

What comes of it is a result like that of a calibration, which the window shows in the same panels:
the boards in space, the corners' distances from where this camera images them, the photographs
without distortion. It is not judged.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from calibgui.app.calibrating.board_poses import locate_boards
from calibgui.app.photographs.image_mode import guess_mode
from calibgui.dataset import CornerSet, KnownCamera, Result
from calibgui.engine.arrays import Size
from calibgui.engine.calibration import hold_camera
from calibgui.engine.camera import describe_mode
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.report.board_poses import list_pose_remarks


def read_known_camera(path: Path, size: Size | None = None) -> tuple[KnownCamera, tuple[str, ...]]:
    """Read the camera of a file, and what the user should know about it.

    Args:
        path: result.json, or the camera file of another program.
        size: width and height of the photographs, px, for a file that does not state them.

    Raises:
        CalibrationError: as ``formats.read_camera``.
    """
    try:
        found = read_camera(path)
    except CalibrationError:
        if size is None:
            raise
        found = read_camera(path, size=size)
    covariance = found.covariance
    if covariance is not None and not np.isfinite(covariance).all():
        covariance = None
    return KnownCamera(found.camera, path.name, found.title, covariance), found.notes


def locate_with_known(corner_set: CornerSet, known: KnownCamera) -> Result:
    """Locate the boards of photographs with a camera that is known.

    A camera of images of another size is taken to their sensor mode, where their sizes tell it.
    Photographs whose board it does not explain are left out, with the reason.

    Raises:
        CalibrationError: if no board is located, or the photographs cannot be the camera's.
    """
    remarks = [f"The camera of {known.file} stays as it is: nothing was calibrated."]
    camera, covariance = known.camera, known.covariance
    if corner_set.size != camera.size:
        mode = guess_mode(camera.size, corner_set.size)
        remarks.append(f"The photographs are taken to be {describe_mode(mode)}.")
        if covariance is not None:
            covariance = mode.adapt_covariance(covariance, camera.model)
        camera = mode.adapt_camera(camera)
    located = locate_boards(camera, corner_set, covariance)
    if not located.located:
        reason = next((view.reason for view in located.views), "All are left out.")
        raise CalibrationError(
            f"The board was located in none of the photographs with the camera of {known.file}.",
            f"The first: {reason}",
        )
    lost = {view.image: view.reason for view in located.views if view.found is None}
    views = tuple(
        replace(view, enabled=False, reason=lost[view.image])
        if view.usable and view.image in lost
        else view
        for view in corner_set.views
    )
    used = [view for view in views if view.usable]
    calibration = hold_camera(
        camera,
        [view.observation(corner_set.board) for view in used],
        covariance,
        [view.name for view in used],
    )
    return Result(
        replace(calibration, warnings=(*remarks, *list_pose_remarks(located))),
        views,
        corner_set.board,
        lengths_confirmed=corner_set.lengths_confirmed,
    )

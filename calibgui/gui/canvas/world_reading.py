"""The world at the pixel under the cursor: its ray, and the place on the board that it shows."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QCoreApplication

from calibgui.dataset import Result
from calibgui.engine.arrays import Size
from calibgui.engine.uncertainty import find_board_points, find_rays
from calibgui.gui.widgets.lengths import describe_condition

translate = QCoreApplication.translate


def describe_world(result: Result, image: str, size: Size, uv: tuple[float, float]) -> str:
    """Describe what a pixel looks at, in the user's language.

    Args:
        result: the calibration of the camera.
        image: the photograph; where the result has a pose of the board in it, the place on the
            board's plane is said as well.
        size: its width and height, px.
        uv: the pixel.

    Returns:
        The text; empty if the photograph is of another size than the camera's, or the pixel has no
        ray.
    """
    calibration = result.calibration
    if calibration.camera.size != size:
        return ""
    ray = find_rays([uv], calibration.camera).rays[0]
    if not np.isfinite(ray).all():
        return ""
    across, along = np.degrees(np.arctan2(ray[:2], ray[2])).tolist()
    text = translate("WorldReading", "ray {0:.2f}° {1}, {2:.2f}° {3}").format(
        abs(across),
        translate("WorldReading", "left") if across < 0 else translate("WorldReading", "right"),
        abs(along),
        translate("WorldReading", "up") if along < 0 else translate("WorldReading", "down"),
    )
    poses = zip(result.used, calibration.poses, strict=True)
    pose = next((pose for view, pose in poses if view.image == image), None)
    if pose is None:
        return text
    x, y = find_board_points([uv], calibration.camera, pose).points[0].tolist()
    if not np.isfinite([x, y]).all():
        return text
    on_board = translate("WorldReading", "   board X {0:.2f}, Y {1:.2f} mm").format(x, y)
    return f"{text}{on_board}{describe_condition(result)}"

"""Poses of the board in one fixed frame, measured by other means, as JSON.

    {"view01.png": {"rvec": [x, y, z], "tvec": [x, y, z]}, ...}

Reader: `read_board_poses`. With R = exp(rvec), rad, and tvec in mm, a board point X lies at
R X + tvec in the fixed frame, which is the same for all images: that of a stage that moves the
board, say. Names are those of the images.
Cannot hold: how accurate the poses are.
"""

from __future__ import annotations

import os

from calibgui.engine.geometry import Pose
from calibgui.formats.json_document import read_json


def read_board_poses(path: str | os.PathLike[str]) -> dict[str, Pose]:
    """Read the poses of the board, fixed_from_board, by the names of images.

    Raises:
        CalibrationError: if the file cannot be read or something in it is wrong.
    """
    return {
        name: Pose(pose["rvec"].numbers(3), pose["tvec"].numbers(3))
        for name, pose in read_json(path).members().items()
    }

"""The board's pose in each photograph as comma-separated values, one row a photograph.

    image,corners,rms_px,x_mm,y_mm,z_mm,sigma_x_mm,...,rx_deg,ry_deg,rz_deg,sigma_rx_deg,...,reason

Reader: any reader of CSV. x, y, z is the board's first corner in the camera's frame (X right, Y
down, Z ahead); rx, ry, rz is the rotation vector of cam_from_board, degrees. A photograph without a
pose has the reason and no numbers.
Cannot hold: correlations, the camera.
"""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from calibgui.dataset import LocatedView, PoseSet
from calibgui.engine.files import write_atomically
from calibgui.formats.csv_table import format_csv

_PLACE, _TURN = ("x_mm", "y_mm", "z_mm"), ("rx_deg", "ry_deg", "rz_deg")
_NUMBERS = (
    *_PLACE,
    *(f"sigma_{name}" for name in _PLACE),
    *_TURN,
    *(f"sigma_{name}" for name in _TURN),
)


def write_poses_csv(poses: PoseSet, path: str | os.PathLike[str]) -> None:
    """Write the poses of all photographs.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    rows: list[Sequence[object]] = [["image", "corners", "rms_px", *_NUMBERS, "reason"]]
    rows += [_make_row(view) for view in poses.views]
    write_atomically(path, format_csv(rows).encode(errors="backslashreplace"))


def _make_row(view: LocatedView) -> list[object]:
    found = view.found
    if found is None:
        return [view.image, 0, "", *[""] * len(_NUMBERS), view.reason]
    sigma = found.sigma
    numbers = (found.pose.tvec, sigma[3:], np.degrees(found.pose.rvec), np.degrees(sigma[:3]))
    cells = np.concatenate(numbers).tolist()
    return [view.image, len(found.residuals), found.rms, *cells, ""]

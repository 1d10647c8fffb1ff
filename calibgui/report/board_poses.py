"""The board's poses under a known camera, in words for a terminal of 80 columns."""

from __future__ import annotations

import math

import numpy as np

from calibgui.dataset import PoseSet
from calibgui.engine.assessment import DEFAULT_LIMIT
from calibgui.engine.calibration import BoardPose
from calibgui.report.names import shorten_name
from calibgui.report.numbers import format_with_sigma
from calibgui.report.tables import align_columns

_MIN_LEAD = 3.0
"""Standard deviations below which the board may be seen from its other side as well."""


def tabulate_poses(poses: PoseSet) -> str:
    """Tabulate where the board is in each photograph, with one standard deviation."""
    head = ["image, rms", "", "X", "Y", "Z"]
    rows = [head]
    for image, found in poses.located:
        sigma = found.sigma
        place = map(format_with_sigma, found.pose.tvec.tolist(), sigma[3:].tolist())
        turn = map(
            format_with_sigma,
            np.degrees(found.pose.rvec).tolist(),
            np.degrees(sigma[:3]).tolist(),
        )
        rows.append([shorten_name(image), "mm", *place])
        rows.append([f"  {found.rms:.3f} px", "deg", *turn])
    condition = f", {poses.condition}" if poses.condition else ""
    title = f"First corner and rotation vector in the camera's frame{condition}"
    return f"{title}\n" + align_columns(rows, left=(0, 1))


def list_pose_remarks(poses: PoseSet) -> list[str]:
    """List what the user should know about the poses: a wrong camera, and boards of two sides."""
    remarks = [_describe_misfit(poses)]
    doubtful = [image for image, found in poses.located if found.lead < _MIN_LEAD]
    if doubtful:
        remarks.append(
            f"Seen from so far away that the board may be tilted to the other side as well: "
            f"{', '.join(map(shorten_name, doubtful))}. Photograph it from nearer by."
        )
    if not poses.has_covariance:
        remarks.append(
            "Each ± counts the corners' noise alone: the file does not say how uncertain the "
            "camera is."
        )
    return [remark for remark in remarks if remark]


def _describe_misfit(poses: PoseSet) -> str:
    """Say that the camera is not that of the photographs, by the residuals; empty if it may be."""
    located = [found for _, found in poses.located]
    if not located:
        return ""
    along_axis = float(np.median([_measure_noise(found) for found in located]))
    if not along_axis > DEFAULT_LIMIT:
        return ""
    return (
        f"The corners are off by {along_axis:.2g} px along each axis. That is more than a camera "
        "of these photographs leaves: the file may be of another camera, zoom or focus, of images "
        "that were cropped or corrected, or the board may be bent. `calibgui check` tells more."
    )


def _measure_noise(found: BoardPose) -> float:
    """Measure the standard deviation of a residual coordinate, px; NaN without redundancy."""
    freedom = found.residuals.size - 6
    return math.sqrt(float(np.sum(found.residuals**2)) / freedom) if freedom > 0 else math.nan

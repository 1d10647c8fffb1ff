"""A stored calibration against new pictures, in words for a terminal of 80 columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import assert_never

import numpy as np

from calibgui.engine.assessment import CONFIDENCE, CalibrationCheck, CheckVerdict, Weakness
from calibgui.engine.boards import Board
from calibgui.report.boards import name_point
from calibgui.report.numbers import format_with_sigma
from calibgui.report.tables import align_columns, format_bullet

_ADVICE = {
    Weakness.SCALE: "in which the board fills most of the image and is tilted by 30 to 45 degrees, "
    "each time to another side: only tilted boards tell the focal length from the distance",
    Weakness.SHIFT: "in which the board is tilted to other sides, and one with the camera or the "
    "board turned by 90 degrees: these tell the centre from the poses",
    Weakness.DISTORTION: "in which the board reaches into the corners of the image",
}
"""What further pictures should show, by what the present ones say least about."""
_MIN_SIGMA_OF_REMARK = 3.0
"""Number of standard deviations from which a movement of the image or a bent board is remarked."""
_LARGE_NOISE_PX = 1.0
"""Residual of the whole fit, px along each axis, from which something else must be wrong."""


def describe_check(
    check: CalibrationCheck, names: Sequence[str], board: Board | None = None
) -> str:
    """Describe a check: its numbers, the verdict, and what else the pictures tell.

    Args:
        check: the check.
        names: names of the pictures.
        board: in the pictures; a checkerboard if None.
    """
    points = f"{name_point(board)}s"
    rows = [
        [name, str(view.used), str(view.left_out), f"{view.rms:.3f}" if view.used else ""]
        for name, view in zip(names, check.views, strict=True)
    ]
    lost = sum(view.left_out for view in check.views)
    rows.append(["all", str(check.count), str(lost), f"{check.rms:.3f}"])
    table = align_columns([["picture", points, "left out", "rms, px"], *rows], left=(0,))
    left_out = [
        f"{name} is left out: {view.reason}."
        for name, view in zip(names, check.views, strict=True)
        if view.reason
    ]
    numbers = align_columns(
        [
            ["only the poses free, rms of both coordinates, px", f"{check.rms:.3f}"],
            [
                "  standard deviations along u and v, px",
                f"{check.sigma_x:.3f}, {check.sigma_y:.3f}",
            ],
            [f"change of the camera, px rms at the {points}", _format_change(check)],
            ["  with the rotation that new poses hide, px rms", f"{check.whole_change:.3f}"],
            ["change of the image's scale, %", _format_percent(check)],
            ["noise beside change, board and poses, px along each axis", f"{check.noise:.3f}"],
        ],
        left=(0, 1),
    )
    remarks = [describe_verdict(check), *left_out, *list_remarks(check)]
    return "\n".join(
        ["Reprojection of the board with the stored camera", table, numbers]
        + [format_bullet(remark) for remark in remarks]
    )


def describe_verdict(check: CalibrationCheck) -> str:
    """Say in one sentence or two whether the calibration is still good."""
    change = f"{_format_change(check)} px"
    match check.verdict:
        case CheckVerdict.STILL_GOOD:
            return (
                f"The calibration is still good: the camera's change, {change}, is below "
                f"{check.limit:g} px."
            )
        case CheckVerdict.HAS_CHANGED:
            return (
                f"The camera has changed: by {change}, which is above {check.limit:g} px by more "
                f"than {CONFIDENCE:g} standard deviations. Calibrate it again."
            )
        case CheckVerdict.CANNOT_TELL:
            return (
                "These pictures cannot tell whether the camera has changed by more than "
                f"{check.limit:g} px: its change is {change}. Add pictures "
                f"{_ADVICE[check.weakness]}."
            )
        case _:
            assert_never(check.verdict)


def list_remarks(check: CalibrationCheck) -> list[str]:
    """List what else the pictures tell."""
    remarks = []
    length = float(np.linalg.norm(check.shift))
    if length > _MIN_SIGMA_OF_REMARK * float(check.shift_sigma.max()):
        u, v = (
            format_with_sigma(*pair) for pair in zip(check.shift, check.shift_sigma, strict=True)
        )
        remarks.append(
            f"The image has moved by ({u}, {v}) px against the lens, right and down. A rotation of "
            "the camera hides most of this; what it cannot hide is in the change above. Where the "
            "camera's direction counts, as in a stereo pair or on a robot, calibrate again."
        )
    if check.bend > _MIN_SIGMA_OF_REMARK * check.bend_sigma:
        remarks.append(
            f"The board is bent or twisted, by {format_with_sigma(check.bend, check.bend_sigma)} "
            "mm. That is not counted as a change of the camera."
        )
    if check.noise > _LARGE_NOISE_PX:
        remarks.append(
            f"Neither a change of the camera nor a bent board explains residuals of "
            f"{check.noise:.2f} px. Is this the right file, the right lens, and the board as "
            "described? Are the pictures sharp?"
        )
    if not check.has_covariance:
        remarks.append(
            "The file states no standard deviations: what it was off from the beginning counts as "
            "a change."
        )
    return remarks


def _format_change(check: CalibrationCheck) -> str:
    return f"{check.change:.3f} ± {check.change_sigma:.3f}"


def _format_percent(check: CalibrationCheck) -> str:
    return f"{100 * check.scale:+z.3f} ± {100 * check.scale_sigma:.3f}"

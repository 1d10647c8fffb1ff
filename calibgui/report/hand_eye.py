"""Hand and eye in words for a terminal of 80 columns."""

from __future__ import annotations

import numpy as np

from calibgui.dataset import HandEyeSet
from calibgui.engine.arrays import Array
from calibgui.engine.geometry import Pose
from calibgui.engine.hand_eye import HandEye
from calibgui.report.names import shorten_name
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.tables import align_columns

_STANDS_OUT = 5.0
"""Error of a pose over the median one from which it is named: of 3,000 normal ones one has that."""
_ROUNDING = 1e-9, 1e-6
"""Errors of a robot's pose, rad and mm, below which they are rounding: no robot states so much."""


def describe_tool(found: HandEye) -> str:
    """Describe in a line how far a tool is off that goes by what the camera sees."""
    tool = found.tool
    robot = round(100 * tool.robot_share)
    shift, turn = 2 * tool.sigma_mm, np.degrees(2 * tool.sigma_rad)
    return (
        f"tool ± {_format_mm(shift)} mm, ± {turn:.2g} degrees (k = 2); "
        f"robot {robot} %, camera {100 - robot} %"
    )


def _format_mm(length: float) -> str:
    """Format a length with two digits, and with all those before the point."""
    return f"{length:.0f}" if length >= 10 else f"{length:.2g}"


def tabulate_hand_eye(hand_eye_set: HandEyeSet) -> str:
    """Tabulate the poses of camera and board, each with one ±, and the robot's errors."""
    found = hand_eye_set.found
    camera, board = (
        ("camera in the hand", "board in the base")
        if found.eye_in_hand
        else ("camera in the base", "board in the hand")
    )
    rows = [
        ["", "", "X", "Y", "Z"],
        *_list_pose(camera, found.camera_pose, found.covariance),
        *_list_pose(board, found.board_pose, found.board_covariance),
    ]
    errors = [["image", "robot off by, mm", "degrees"]]
    for name, (turn, shift) in zip(found.names, measure_errors(found), strict=True):
        errors.append([shorten_name(name), _format_mm(shift), f"{np.degrees(turn):.2g}"])
    parts = [
        describe_tool(found),
        align_columns(rows, left=(0, 1)),
        align_columns(errors, left=(0,)),
    ]
    return "\n\n".join(parts)


def _list_pose(name: str, pose: Pose, covariance: Array) -> list[list[str]]:
    sigma = np.sqrt(np.diag(covariance))
    place = map(format_with_sigma, pose.tvec.tolist(), sigma[3:].tolist())
    turn = map(format_with_sigma, np.degrees(pose.rvec).tolist(), np.degrees(sigma[:3]).tolist())
    return [[name, "mm", *place], ["  rotation vector", "deg", *turn]]


def measure_errors(found: HandEye) -> Array:
    """Measure (K, 2) the robot's error in each pose, rad and mm."""
    return np.linalg.norm(found.corrections.reshape(-1, 2, 3), axis=2)


def list_hand_eye_remarks(
    hand_eye_set: HandEyeSet, mount: str = "--mount", leave_out: str = "with --exclude"
) -> list[str]:
    """List how the poses were read, what they leave open, and what is wrong with them.

    Args:
        hand_eye_set: what was found.
        mount: by what the reader states where the camera is.
        leave_out: how the reader leaves a photograph out.
    """
    found = hand_eye_set.found
    turn, shift = found.robot_sigmas.tolist()
    next_best = found.next_scatter
    beyond = (
        f", and by {_format_mm(next_best)} mm in any other way" if np.isfinite(next_best) else ""
    )
    remarks = [
        f"The robot's poses are {found.reading}. Read so, the board scatters by "
        f"{_format_mm(found.scatter)} mm{beyond}.",
        f"A pose of the robot is off by {_format_mm(shift)} mm along each axis and by "
        f"{np.degrees(turn):.2g} degrees about each, one standard deviation. The corners are off "
        f"by {found.rms:.2g} px.",
    ]
    if found.rivals:
        remarks.append(
            f"The poses fit as well as {'; or as '.join(found.rivals)}. Turn the hand about "
            f"more axes, or state where the camera is ({mount})."
        )
    if found.shift:
        before = "one line early" if found.shift > 0 else "one line late"
        remarks.append(
            f"The order is shifted: each pose stands {before}, and was used for the photograph "
            "that it fits. Correct the file."
        )
    remarks += [
        f"{', '.join(map(shorten_name, same))} have the same pose of the robot: if it moved "
        "between them, the file is wrong."
        for same in found.repeated
    ]
    remarks += [*_list_open(found), *_name_outliers(found, leave_out)]
    return remarks + _list_limits(hand_eye_set)


def _list_open(found: HandEye) -> list[str]:
    """Say what the motions do not tell."""
    frame = "hand" if found.eye_in_hand else "base"
    remarks = []
    if len(found.open_turns):
        remarks.append(
            f"Open: the camera may be turned about {_list_axes(found.open_turns)} of the {frame}. "
            "Turn the hand about another axis as well, or move it without turning."
        )
    if len(found.open_shifts):
        axes = {1: "a second axis", 3: "two axes"}.get(len(found.open_shifts), "other axes")
        remarks.append(
            f"Open: the camera may be shifted along {_list_axes(found.open_shifts)} of the "
            f"{frame}. All else is determined, and no ± counts this. Turn the hand about "
            f"{axes}, or measure it."
        )
    return remarks


def _list_axes(axes: Array) -> str:
    """List directions (n, 3); any direction if there are three."""
    if len(axes) == 3:
        return "any axis"
    return " and ".join(
        "({:.2f}, {:.2f}, {:.2f})".format(*(axis)) for axis in (axes + 0.0).tolist()
    )


def find_outliers(found: HandEye) -> list[int]:
    """Find the poses that fit far worse than the others."""
    errors = measure_errors(found)
    ratio = (errors / np.maximum(np.median(errors, axis=0), _ROUNDING)).max(axis=1)
    return np.flatnonzero(ratio > _STANDS_OUT).tolist()


def _name_outliers(found: HandEye, leave_out: str) -> list[str]:
    """Name the poses that fit far worse than the others."""
    errors = measure_errors(found).tolist()
    named = [
        f"{shorten_name(found.names[k])} ({_format_mm(errors[k][1])} mm, "
        f"{np.degrees(errors[k][0]):.2g}°)"
        for k in find_outliers(found)
    ]
    if not named:
        return []
    return [
        f"The robot's pose does not fit in {', '.join(named)}: another moment, or a mistake in the "
        f"file. Leave it out {leave_out}."
    ]


def _list_limits(hand_eye_set: HandEyeSet) -> list[str]:
    """Say what was left out, and what no ± counts."""
    left_out = hand_eye_set.left_out
    remarks = [f"Left out: {sentence}" for sentence in left_out]
    if not hand_eye_set.has_covariance:
        remarks.append("No ± counts the camera's errors: its file does not state them.")
    return remarks


def describe_in_a_line(hand_eye_set: HandEyeSet) -> str:
    """Describe all in a line."""
    found = hand_eye_set.found
    return f"{describe_tool(found)}, from {format_count(len(found.names), 'pose')}"

"""Guidance: what to do with the board so that it comes to where it is wanted next.

The pose that is wanted (`uncertainty/next_view.py`) and the one that is seen differ by a place in
the image, a distance, and a turn. With the rotations R_w and R_s of wanted and seen board, the turn
that is still to be made is

    exp(w) = R_w R_s^T,

about axes of the camera: X to the right, Y down, Z ahead. A turn about +X takes the board's lower
side away from the camera (w x r has the depth w_x y), one about +Y its left side, and one about +Z
is clockwise in the image. A person does one thing at a time: what is farthest off, each over what a
hand is easily exact to, is said first. Half a turn in the plane of the board counts as none: what
is seen of the camera is the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import measure_axis_scale
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation

EASY_SHIFT = 0.05
"""Distance in the image, and difference in the board's size there, to which a hand is easily exact,
widths of the image: a choice."""
_EASY_TURN = np.deg2rad(12.0)
"""Angle to which a hand is easily exact, rad: a choice."""
_HALF_TURN = np.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True, slots=True)
class Guidance:
    """The nearness of a board to where it is wanted, and what to do."""

    match: float
    """Share from 0 to 1 of the way to the wanted place: 1 less the rms distance of the corners from
    where they are wanted, over the size of the wanted board in the image."""
    instruction: str
    """What to do first, in words."""


def guide_board(seen: Pose, wanted: Pose, board: Array, camera: Camera) -> Guidance:
    """Say how to move a board from the pose that is seen to the one that is wanted.

    Args:
        seen, wanted: poses cam_from_board, mm.
        board: (n, 2) places of the corners on the board, mm.
        camera: the camera, as far as it is known.
    """
    middle, size = (board.min(axis=0) + board.max(axis=0)) / 2, np.ptp(board, axis=0)
    here, *either_way = np.split(
        project_points(np.concatenate([[middle], board, 2 * middle - board]), camera, seen),
        [1, 1 + len(board)],
    )
    there, goal = np.split(project_points(np.concatenate([[middle], board]), camera, wanted), [1])
    off = min(np.sqrt(np.mean(np.sum((uv - goal) ** 2, axis=1))) for uv in either_way)
    share = off / np.linalg.norm(np.ptp(goal, axis=0))
    match = float(np.clip(1 - np.nan_to_num(share, nan=1.0), 0.0, 1.0))
    return Guidance(match, _describe_move(seen, wanted, middle, size, (there - here)[0], camera))


def _describe_move(
    seen: Pose, wanted: Pose, middle: Array, size: Array, shift: Array, camera: Camera
) -> str:
    """Describe what is farthest off, with the middle by `shift` px; say to hold still if nothing
    is."""
    u, v = shift / camera.size[0] / EASY_SHIFT
    nearness = 1 / _measure_distance(wanted, middle) - 1 / _measure_distance(seen, middle)
    growth = nearness * np.linalg.norm(size) * measure_axis_scale(camera) / camera.size[0]
    x, y, z = _find_turn(seen, wanted) / _EASY_TURN
    moves = [
        (u, "Move it to the right.", "Move it to the left."),
        (v, "Move it down.", "Move it up."),
        (growth / EASY_SHIFT, "Bring it closer.", "Take it farther away."),
        (x, "Tilt its lower side away.", "Tilt its upper side away."),
        (y, "Tilt its left side away.", "Tilt its right side away."),
        (z, "Turn it clockwise.", "Turn it anticlockwise."),
    ]
    amount, forward, backward = max(moves, key=lambda move: abs(move[0]))
    if not abs(amount) > 1:
        return "Hold it still."
    return forward if amount > 0 else backward


def _measure_distance(pose: Pose, xy: Array) -> float:
    """Measure how far a point of the board (2,) mm is from the camera, mm."""
    R = rotation_from_vector(np.array(pose.rvec))
    return float(np.linalg.norm(R[:, :2] @ xy + pose.tvec))


def _find_turn(seen: Pose, wanted: Pose) -> Array:
    """Find the smaller turn (3,), rad, from one pose to the other or to its half turn."""
    R_seen, R_wanted = (rotation_from_vector(np.array(each.rvec)) for each in (seen, wanted))
    turns = [vector_from_rotation(R_wanted @ half @ R_seen.T) for half in (np.eye(3), _HALF_TURN)]
    return min(turns, key=lambda turn: float(np.linalg.norm(turn)))

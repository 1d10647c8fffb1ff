"""Hand and eye from a calibration, or from a known camera and photographs, with a robot's poses."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import PurePath

import numpy as np

from calibgui.dataset import CornerSet, HandEyeSet, Result, View
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.hand_eye import calibrate_hand_eye
from calibgui.formats.robot_poses import RobotPoseTable


def find_hand_eye(
    source: Result | tuple[Camera, Array | None, CornerSet],
    table: RobotPoseTable,
    eye_in_hand: bool | None = None,
    tool: Array | None = None,
    without: Collection[str] = (),
) -> HandEyeSet:
    """Find where the camera is in the robot's hand, or beside the robot.

    Args:
        source: a calibration with its views; or a camera, the covariance of its parameters if
            that is known, and views of the same size.
        table: the robot's poses.
        eye_in_hand: whether the camera is in the hand; None to find out.
        tool: (3,) the tool's point in the hand's frame, mm; None for where the board is.
        without: names of photographs that take no part.

    Raises:
        CalibrationError: if the poses do not go with the views or do not fit them, if nobody has
            stated the side of a square, or if the photographs have another size than the camera's.
    """
    covariance: Array | None
    if isinstance(source, Result):
        calibration = source.calibration
        camera, covariance = calibration.camera, calibration.covariance
        shape, views, board = calibration.board_shape, source.views, source.board
        confirmed = source.lengths_confirmed
    else:
        camera, covariance, corner_set = source
        shape, views, board = None, corner_set.views, corner_set.board
        confirmed = corner_set.lengths_confirmed
        if corner_set.size != camera.size:
            (width, height), (w, h) = corner_set.size, camera.size
            raise CalibrationError(
                f"The photographs have {width} x {height} px, and the camera {w} x {h} px.",
                "Name the camera of these photographs.",
            )
    if not confirmed:
        raise CalibrationError(
            "The side of a square is not known, and the robot's poses have lengths.",
            "State it, as --square 25 on the command line.",
        )
    if covariance is not None and not np.isfinite(covariance).all():
        covariance = None
    taken = [replace(view, enabled=False) if view.name in without else view for view in views]
    used, rows, left_out = pair_poses(taken, table)
    found = calibrate_hand_eye(
        camera,
        [view.observation(board) for view in used],
        table.numbers[rows],
        covariance=covariance,
        board_shape=shape,
        eye_in_hand=eye_in_hand,
        tool=tool,
        names=[view.name for view in used],
    )
    return HandEyeSet(found, left_out, has_covariance=covariance is not None)


def parse_point(text: str) -> Array:
    """Read a point such as "0,0,120", mm.

    Raises:
        ValueError: if it is none.
    """
    point = np.array([float(part) for part in text.split(",")])
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ValueError(text)
    return point


def pair_poses(
    views: Sequence[View], table: RobotPoseTable
) -> tuple[list[View], list[int], tuple[str, ...]]:
    """Pair photographs with poses: by their names, or else by their order.

    Returns:
        The photographs that show the board and have a pose, the rows of their poses, and sentences
        on what has no counterpart.

    Raises:
        CalibrationError: if there are no names and not as many poses as photographs, or if no
            photograph has a pose.
    """
    if not table.names:
        if len(table.numbers) != len(views):
            raise CalibrationError(
                f"{table.file} has {len(table.numbers)} poses, and there are {len(views)} "
                "photographs.",
                "Give a pose for each photograph, in the order of their names, or name the "
                "photographs in the first column.",
            )
        row_of = {view.image: k for k, view in enumerate(views)}
    else:
        at = {key: k for k, name in enumerate(table.names) for key in _list_keys(name)}
        row_of = {
            view.image: row
            for view in views
            if (row := next((at[key] for key in _list_keys(view.image) if key in at), None))
            is not None
        }
    paired = [view for view in views if view.enabled and view.image in row_of]
    if not paired:
        raise CalibrationError(
            f"{table.file} names none of the photographs.",
            f"Name them as they are called, as {PurePath(views[0].image).name}."
            if views
            else "Name the photographs.",
        )
    used = [view for view in paired if view.usable]
    left_out = [f"{view.name}: {view.why_unused}" for view in paired if not view.usable]
    left_out += [
        f"{view.name}: it has no pose." for view in views if view.enabled and view not in paired
    ]
    rows = [row_of[view.image] for view in used]
    lacking = sorted(set(range(len(table.numbers))) - set(row_of.values()))
    left_out += [f"{table.names[k]}: there is no such photograph." for k in lacking]
    return used, rows, tuple(left_out)


def _list_keys(name: str) -> tuple[str, ...]:
    """List what a photograph is called: its path, its name, and that without the suffix."""
    path = PurePath(name)
    return name, path.name, path.stem

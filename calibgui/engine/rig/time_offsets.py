"""The speed of the board in each view tells how far the clocks of the cameras are apart.

A camera that is late by t sees the board where it will be t later than the others see it. How fast
it moves each camera knows by itself, from its views before and after: with the pose (R, T)
cam_from_board at the times t- and t+, the mean velocity between them is

    omega = log(R+ R-^T) / (t+ - t-),    v = (T+ - T-) / (t+ - t-),

which is exact in the middle for a board that turns and moves evenly, however the cameras stand to
each other and whatever the time of the others. Poses of single views are far off along the line of
sight, but alike in neighbouring views, and what a view's image tells of the motion is kept.

In the joint solve one unknown t for each camera but the first moves the views on along their
velocities (``joint_solve.py``). A view without both neighbours has no velocity and takes no part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.rig.alone import CameraAlone
from calibgui.engine.rig.consensus import ViewPoses
from calibgui.engine.rig.records import RigCamera


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """The motion of the board in a camera's views."""

    velocity: Array
    """(K, 6) omega and v, rad/s and mm/s."""
    lag: Array
    """(K,) time by which each view is known to be later than its instant, s."""
    is_moving: bool
    """True if an offset in time is to be estimated."""

    def move_back(self, alone: CameraAlone, late: float) -> CameraAlone:
        """Return a camera's views with the board where it was at the time of their instants.

        Args:
            alone: the views.
            late: offset of the camera, s.
        """
        back = -(late + self.lag)[:, None] * self.velocity
        R = rotation_from_vector(back[:, :3]) @ alone.poses.R
        poses = replace(alone.poses, R=R, T=alone.poses.T + back[:, 3:])
        return replace(alone, poses=poses)


def hold_board_still(alone: Sequence[CameraAlone]) -> list[Motion]:
    """Return the motions of a board that is held still for each instant."""
    counts = [len(part.poses.instant) for part in alone]
    return [Motion(np.zeros((count, 6)), np.zeros(count), False) for count in counts]


def find_motions(
    cameras: Sequence[RigCamera], instants: Sequence[int], alone: Sequence[CameraAlone]
) -> tuple[list[int], list[CameraAlone], list[Motion]]:
    """Find how the board moves in each camera's views.

    Returns:
        The numbers of the instants, and the views, of which that is known, and the motions in them.

    Raises:
        CalibrationError: if a camera has no view with one before and one after.
    """
    velocities = [
        estimate_velocities(part.poses, instants, camera.times)
        for camera, part in zip(cameras, alone, strict=True)
    ]
    known = [np.flatnonzero(np.isfinite(velocity).all(axis=1)) for velocity in velocities]
    for camera, views in zip(cameras, known, strict=True):
        if not views.size:
            raise CalibrationError(
                f"{camera.name} has no view of the board with one before and one after it.",
                "Offsets in time take videos, or photographs in quick succession.",
            )
    places = [part.poses.instant[views] for part, views in zip(alone, known, strict=True)]
    left = np.unique(np.concatenate(places))
    kept, motions = [], []
    for camera, part, views, velocity in zip(cameras, alone, known, velocities, strict=True):
        chosen = part.select(views)
        at = np.searchsorted(left, chosen.poses.instant).astype(np.int64)
        kept.append(replace(chosen, poses=replace(chosen.poses, instant=at)))
        numbers = [instants[place] for place in part.poses.instant[views].tolist()]
        lag = _find_lags(numbers, camera.times, cameras[0].times)
        motions.append(Motion(velocity[views], lag, True))
    return [instants[place] for place in left.tolist()], kept, motions


def estimate_velocities(
    poses: ViewPoses, instants: Sequence[int], times: Mapping[int, float]
) -> Array:
    """Estimate (K, 6) omega and v of the board in a camera's views, rad/s and mm/s.

    Args:
        poses: the board's poses in the views.
        instants: the numbers of all instants; neighbours are those that differ by 1.
        times: time of the camera's photograph of each instant, s; empty for one second from one
            instant to the next.

    Returns:
        NaN for a view without both neighbours.
    """
    numbers = [instants[at] for at in poses.instant.tolist()]
    view = {number: k for k, number in enumerate(numbers)}
    velocity = np.full((len(numbers), 6), np.nan)
    for k, number in enumerate(numbers):
        before, after = view.get(number - 1), view.get(number + 1)
        if before is None or after is None:
            continue
        ends = [times.get(number + side) for side in (-1, 1)] if times else [0.0, 2.0]
        if ends[0] is None or ends[1] is None or not ends[1] > ends[0]:
            continue
        span = ends[1] - ends[0]
        velocity[k, :3] = vector_from_rotation(poses.R[after] @ poses.R[before].T) / span
        velocity[k, 3:] = (poses.T[after] - poses.T[before]) / span
    return velocity


def _find_lags(
    instants: Sequence[int], times: Mapping[int, float], first_times: Mapping[int, float]
) -> Array:
    """Find by how much a camera's clock says that it was later than the first one, s, at instants.

    It is 0 at an instant that the first camera has no time of, and where times are not known.
    """
    return np.array(
        [
            times[each] - first_times[each] if each in times and each in first_times else 0.0
            for each in instants
        ]
    )

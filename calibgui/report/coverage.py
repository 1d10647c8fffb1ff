"""Attitudes of the board in a set of views: its tilts and distances.

The tilt of a view is the angle between the board's normal and the optical axis, r3 being the
board's third axis in the camera frame: tilt = acos |r33|, and its direction is where the part of
the board that is farther away lies in the image, atan2 of the horizon's gradient. With the
board's depth Z = Z0 + r31 X + r32 Y along the board and the plane's normal n = +-r3 pointing
away from the camera, depth grows in the image along -(n1, n2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration, Observation
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.images import Extent, compute_board_extent


@dataclass(frozen=True, eq=False, slots=True)
class Attitudes:
    """Tilt and distance of the board in each of K views."""

    tilt: Array
    """(K,) angle between the board's normal and the optical axis, rad."""
    direction: Array
    """(K,) direction in the image in which the board recedes, rad: 0 to the right, pi/2 up."""
    distance: Array
    """(K,) distance from the camera's centre to the middle of the corners seen, mm."""


def measure_attitudes(calibration: Calibration, observations: Sequence[Observation]) -> Attitudes:
    """Measure the board's tilt, its direction and distance in each calibrated view."""
    R = rotation_from_vector(np.array([pose.rvec for pose in calibration.poses]))
    T = np.array([pose.tvec for pose in calibration.poses])
    xy = np.concatenate([view.xy for view in observations])
    begins = np.cumsum([0, *(len(view.xy) for view in observations[:-1])])
    middle = (np.minimum.reduceat(xy, begins) + np.maximum.reduceat(xy, begins)) / 2
    normal = R[:, :, 2]
    position = np.einsum("kij,kj->ki", R[:, :, :2], middle) + T
    away = normal * np.sign(np.einsum("ki,ki->k", normal, position))[:, None]
    return Attitudes(
        tilt=np.arccos(np.clip(np.abs(normal[:, 2]), 0.0, 1.0)),
        direction=np.arctan2(away[:, 1], -away[:, 0]),
        distance=np.linalg.norm(position, axis=1),
    )


def find_shown_extent(result: Result) -> Extent:
    """Return the rectangle that the views show, mm: the board's squares, or else its corners."""
    if result.board is not None:
        return compute_board_extent(result.board)
    xy = np.concatenate([view.xy for view in result.observations()])
    low, high = xy.min(axis=0), xy.max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def measure_natural_scale(result: Result) -> float:
    """Return the scale with which the median view shows the board, px per mm."""
    distance = measure_attitudes(result.calibration, result.observations()).distance
    return float(result.calibration.camera.focal.mean() / np.median(distance))

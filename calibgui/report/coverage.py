"""What a set of views covers: the sensor, the board's tilts and distances.

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

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.calibration import Calibration, Observation
from calibgui.engine.geometry import rotation
from calibgui.engine.images import Extent, board_extent

CELLS = (9, 6)
"""Columns and rows in which the sensor is divided when its coverage is judged."""


def density(uv: Array, size: Size, cells: tuple[int, int] = CELLS) -> IntArray:
    """(rows, columns) numbers of corners `uv` (n, 2) in equal cells of the sensor."""
    w, h = size
    counts, _, _ = np.histogram2d(
        uv[:, 1],
        uv[:, 0],
        bins=(cells[1], cells[0]),
        range=((-0.5, h - 0.5), (-0.5, w - 0.5)),
    )
    return counts.astype(np.int64)


@dataclass(frozen=True, eq=False, slots=True)
class Attitudes:
    """How the board was held in each view."""

    tilt: Array
    """(K,) angle between the board's normal and the optical axis, rad."""
    direction: Array
    """(K,) where in the image the board recedes, rad: 0 to the right, pi/2 up."""
    distance: Array
    """(K,) from the camera's centre to the middle of the corners seen, mm."""


def attitudes(calibration: Calibration, observations: Sequence[Observation]) -> Attitudes:
    """The board's tilt, its direction and distance in each calibrated view."""
    R = rotation(np.array([pose.rvec for pose in calibration.poses]))
    T = np.array([pose.tvec for pose in calibration.poses])
    middle = np.array([(view.xy.min(axis=0) + view.xy.max(axis=0)) / 2 for view in observations])
    normal = R[:, :, 2]
    position = np.einsum("kij,kj->ki", R[:, :, :2], middle) + T
    away = normal * np.sign(np.einsum("ki,ki->k", normal, position))[:, None]
    return Attitudes(
        tilt=np.arccos(np.clip(np.abs(normal[:, 2]), 0.0, 1.0)),
        direction=np.arctan2(away[:, 1], -away[:, 0]),
        distance=np.linalg.norm(position, axis=1),
    )


def board_extent_px(result: Result) -> Extent:
    """The part of the plate that the views are about: the board's squares, or else its corners."""
    if result.board is not None:
        return board_extent(result.board)
    xy = np.concatenate([view.xy for view in result.observations()])
    low, high = xy.min(axis=0), xy.max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def natural_scale(result: Result) -> float:
    """Pixels per mm with which the median view shows the board."""
    distance = attitudes(result.calibration, result.observations()).distance
    return float(result.calibration.camera.focal.mean() / np.median(distance))

"""The offset between the clocks of two cameras, from a board that moves before both.

Frames carry the times at which they came. A camera whose images travel longer shows at one time
where the board was before; it is late by

    o < 0:    camera b at the time t shows the board as it was at t + o.

How fast the corners move in the image both cameras tell, and both see the board start and stop: the
o at which the speeds correlate best is the start. It is right to half a frame, as the speeds are
alike, but not in proportion. The corners of b are then interpolated at the times of a, with a
polynomial through six frames, and what is left of the offset is found by the joint solve of a rig
(``rig/time_offsets.py``), in which the board moves on along its velocity and both cameras are held.
Where the board does not move evenly that velocity is wrong by a per cent, and so is what was left:
in three rounds it comes down to microseconds. Each motion from one place to the next gives one
value; their scatter tells how far to trust the mean.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture.board_tracking import measure_motion
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features.corners import Corners
from calibgui.engine.rig.calibrate_rig import calibrate_rig
from calibgui.engine.rig.records import RigCamera


class Seen(NamedTuple):
    """The board in a frame."""

    time: float
    """When the frame came, s."""
    corners: Corners


class Track(NamedTuple):
    """The board in the frames of one camera, one after the other."""

    camera: Camera
    """The camera, as far as it is known."""
    seen: Sequence[Seen]


def estimate_clock_offset(a: Track, b: Track, board: Board) -> tuple[float, float] | None:
    """Estimate by how much camera b is later than camera a.

    Returns:
        The offset and its standard deviation, s; None if the frames do not tell it, as those of a
        board that hardly moves.
    """
    if min(len(a.seen), len(b.seen)) < 3:  # a velocity is that from one before to one after
        return None
    offset = _correlate_speeds(_measure_speeds(a.seen), _measure_speeds(b.seen))
    sigma = np.inf
    for _ in range(3):
        if offset is None or (found := _solve_offset(a, b, board, offset)) is None:
            return None
        offset, sigma = offset + found[0], found[1]
    assert offset is not None
    return offset, sigma


def _solve_offset(a: Track, b: Track, board: Board, start: float) -> tuple[float, float] | None:
    """Solve for what is left of an offset, with its standard deviation, s; None if nothing tells
    it."""
    partners = {
        k: seen._replace(time=each.time)
        for k, each in enumerate(a.seen)
        if (seen := _interpolate(b.seen, each.time - start)) is not None
    }
    cameras = [
        _make_camera("a", a.camera, {k: a.seen[k] for k in partners}, board),
        _make_camera("b", b.camera, partners, board),
    ]
    try:
        rig = calibrate_rig(cameras, estimate_offsets=True)
    except CalibrationError:
        return None
    return float(rig.offsets[1]), rig.offset_sigma(1)


def _interpolate(seen: Sequence[Seen], time: float) -> Seen | None:
    """Interpolate the corners at a time from three frames before and three after; None if one of
    them is missing."""
    times = np.array([each.time for each in seen])
    after = int(np.searchsorted(times, time))
    near = seen[max(0, after - 3) : after + 3]
    at = times[max(0, after - 3) : after + 3]
    if len(near) < 6 or np.ptp(at) > 6 * np.median(np.diff(times)):
        return None
    weights = [
        np.prod([(time - at[m]) / (at[k] - at[m]) for m in range(6) if m != k]) for k in range(6)
    ]  # Lagrange's
    places = [dict(zip(map(tuple, c.grid.tolist()), c.uv, strict=True)) for _, c in near]
    shared = sorted(set.intersection(*map(set, places)))
    if not shared:
        return None
    corners = np.array([[own[cell] for cell in shared] for own in places])
    uv = np.tensordot(weights, corners, 1)
    return Seen(time, replace(near[2].corners, grid=np.array(shared), uv=uv, cov=None))


def _measure_speeds(seen: Sequence[Seen]) -> Array:
    """Measure (n, 2) times, s, and speeds of the corners, px/s, from each frame to the next."""
    speeds = [
        ((before.time + after.time) / 2, motion / (after.time - before.time))
        for before, after in itertools.pairwise(seen)
        if after.time > before.time
        and np.isfinite(motion := measure_motion(before.corners, after.corners))
    ]
    return np.array(speeds).reshape(-1, 2)


def _correlate_speeds(a: Array, b: Array) -> float | None:
    """Find the o at which speeds b at t and a at t + o correlate best; None if nothing moves.

    Beyond its ends a series counts as at rest, so that what one camera alone has seen speaks
    against an o.
    """
    if min(len(a), len(b)) < 2:
        return None
    step = min(float(np.median(np.diff(each[:, 0]))) for each in (a, b)) / 2
    times = np.arange(a[0, 0], a[-1, 0], step)
    speeds = np.interp(times, a[:, 0], a[:, 1])
    offsets = np.arange(a[0, 0] - b[-1, 0], a[-1, 0] - b[0, 0], step)
    products = [speeds @ np.interp(times - o, b[:, 0], b[:, 1], 0.0, 0.0) for o in offsets]
    return float(offsets[np.argmax(products)]) if products else None


def _make_camera(name: str, camera: Camera, seen: dict[int, Seen], board: Board) -> RigCamera:
    """Return a camera that is held, with its views by instants."""
    views = {k: Observation(s.corners.uv, board.points(s.corners.grid)) for k, s in seen.items()}
    times = {k: each.time for k, each in seen.items()}
    return RigCamera(name, camera, views, times=times).hold()

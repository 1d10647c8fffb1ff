"""A hand that holds a board before cameras, and frames of what they see."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.board_poses import locate_board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.images.rendering import render_view

FRAMES_PER_SECOND = 25.0
_BAND = 12
"""Rows of a rolling shutter that are rendered at one time."""


def shake(pose: Pose, board: Board, rng: np.random.Generator, mm: float, degrees: float) -> Pose:
    """Return a pose that is off by so much, as a hand that tries to reach it is."""
    R = rotation_from_vector(np.array(pose.rvec))
    middle = board.points().mean(axis=0)
    at = R[:, :2] @ middle + pose.tvec + rng.normal(0, mm / np.sqrt(3), 3)
    R = rotation_from_vector(rng.normal(0, np.deg2rad(degrees) / np.sqrt(3), 3)) @ R
    return Pose(vector_from_rotation(R), at - R[:, :2] @ middle)


def follow(goal: Array, camera: Camera, board: Board) -> Pose:
    """Return the pose in which a camera sees a board's corners nearest to (rows, cols, 2) px.

    A hand that follows a picture goes there, however wrong the camera is taken to be so far.
    """
    return locate_board(camera, (goal.reshape(-1, 2), board.points())).pose


def go(start: Pose, end: Pose, steps: int) -> Iterator[Pose]:
    """Go from one pose to another in so many steps."""
    for part in np.linspace(0, 1, steps + 1)[1:]:
        rvec = (1 - part) * np.array(start.rvec) + part * np.array(end.rvec)
        yield Pose(rvec, (1 - part) * np.array(start.tvec) + part * np.array(end.tvec))


class Film:
    """Frames of a rendered board, one after the other, each with noise of its own."""

    def __init__(self, camera: Camera, board: Board) -> None:
        self._camera, self._board = camera, board
        self._count = 0

    def take(self, pose: Pose, blur: float = 0.7) -> Frame:
        """Return the next frame."""
        self._count += 1
        image = render_view(self._camera, pose, self._board, blur=blur, noise=8.0, seed=self._count)
        return Frame(image, self._count / FRAMES_PER_SECOND)

    def roll(self, place: Callable[[float], Pose], time: float, readout: float) -> Frame:
        """Return a frame at a time, s, whose rows are read one after the other within `readout` s.

        It is put together of bands of rows, each as a camera sees it whose sensor is the band, at
        the time of its middle row. A readout below 0 begins with the last row.
        """
        width, height = self._camera.size
        bands = []
        for first in range(0, height, _BAND):
            self._count += 1
            params = self._camera.params - first * (np.array(self._camera.names) == "cy")
            sensor = replace(self._camera, size=(width, _BAND), params=params)
            pose = place(time + readout * (first + (_BAND - 1) / 2) / height)
            image = render_view(sensor, pose, self._board, blur=0.7, noise=8.0, seed=self._count)
            bands.append(image)
        return Frame(np.concatenate(bands), time)


class Walk:
    """A hand that goes from place to place before a rig, and holds still in each.

    Args:
        places: poses rig_from_board.
        hold, move: time in each place, and from one to the next, s.
    """

    def __init__(self, places: Sequence[Pose], hold: float = 0.4, move: float = 0.5) -> None:
        self._places, self._hold, self._move = places, hold, move
        self.seconds = len(places) * (hold + move)

    def __call__(self, time: float) -> Pose:
        """Return where the board is at a time, s."""
        k, since = divmod(max(0.0, time), self._hold + self._move)
        start, end = (self._places[(int(k) + step) % len(self._places)] for step in (0, 1))
        if since <= self._hold:
            return start
        s = (since - self._hold) / self._move
        part = s**3 * (10 - 15 * s + 6 * s**2)  # least jerk, as hands move (Flash and Hogan 1985)
        rvec = (1 - part) * np.array(start.rvec) + part * np.array(end.rvec)
        return Pose(rvec, (1 - part) * np.array(start.tvec) + part * np.array(end.tvec))


class RenderedCamera:
    """A camera of a rig that shows the board where it is a little later than its clock says.

    Args:
        camera: the camera.
        pose: its pose cam_from_rig.
        board: what is held before it.
        place: where the board is at a time, rig_from_board.
        late: the time by which it is late, s.
        phase: time of its first frame, s.
        seconds: time at which it ends, s.
        fails_at: time at which it stops sending, s.
    """

    is_continuous, is_live, remark = True, False, ""

    def __init__(
        self,
        camera: Camera,
        pose: Pose,
        board: Board,
        place: Callable[[float], Pose],
        late: float = 0.0,
        phase: float = 0.0,
        seconds: float = np.inf,
        fails_at: float = np.inf,
    ) -> None:
        self.title = "a rendered camera"
        self._camera, self._pose, self._board, self._place = camera, pose, board, place
        self._late, self._phase, self._seconds, self._fails_at = late, phase, seconds, fails_at
        self._count = 0
        self._shown: tuple[Pose, GreyImage] | None = None

    def read(self) -> Frame | None:
        """Render the next frame; one of a board that stands still is like the one before."""
        time = self._phase + self._count / FRAMES_PER_SECOND
        if time >= self._fails_at:
            raise CalibrationError(f"{self.title} stopped sending images.", "Check its cable.")
        if time >= self._seconds:
            return None
        self._count += 1
        board = self._place(time + self._late)
        if self._shown is None or self._shown[0] is not board:
            self._shown = board, self._render(board)
        return Frame(self._shown[1], time)

    def _render(self, board: Pose) -> GreyImage:
        R = rotation_from_vector(np.array(self._pose.rvec))
        turn = R @ rotation_from_vector(np.array(board.rvec))
        seen = Pose(vector_from_rotation(turn), R @ board.tvec + self._pose.tvec)
        seed = self._count + round(1e6 * (self._phase + abs(self._late)))
        return render_view(self._camera, seen, self._board, blur=0.7, noise=8.0, seed=seed)

    def close(self) -> None:
        """Release nothing."""


def spread_places(board: Board, count: int, at: Array) -> list[Pose]:
    """Return poses of a board around a place (3,), mm, each tilted otherwise."""
    places = []
    for k in range(count):
        tilt = 0.6 * np.array([np.cos(2.4 * k), np.sin(2.4 * k), 0.1])
        R = rotation_from_vector(tilt)
        aside = [60 * np.cos(1.7 * k), 40 * np.sin(1.3 * k), 25 * np.cos(3.1 * k)]
        places.append(Pose(tilt, at + aside - R[:, :2] @ board.points().mean(axis=0)))
    return places

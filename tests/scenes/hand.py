"""A hand that holds a board before a camera, and frames of what the camera sees."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.board_poses import locate_board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.images.rendering import render_view

FRAMES_PER_SECOND = 25.0


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

"""Robots with a camera, of which everything is known: poses, corners and their noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye.motions import Motions

CAMERA = Camera((1280, 960), [1200, 1200, 640, 480, -0.1, 0.02, 0, 0, 0], "brown-conrady")
BOARD = Board(6, 8, 30.0).points()
MIDDLE = np.array([*(BOARD.min(axis=0) + BOARD.max(axis=0)) / 2, 0.0])
CORNERS = np.column_stack([BOARD, np.zeros(len(BOARD))])
X = Motions(rotation_from_vector(np.array([0.1, -0.2, 1.5])), np.array([30.0, -60.0, 110.0]))
W = Motions(rotation_from_vector(np.array([2.8, 0.3, 0.1])), np.array([500.0, 100.0, -50.0]))


class Arm(NamedTuple):
    """Photographs of a board with the poses that a robot states."""

    views: list[tuple[Array, Array]]
    poses: Motions
    """(K,) base_from_hand, as stated."""

    def take_matrices(self) -> Array:
        """Return (K, 16) the poses as matrices row by row, mm."""
        matrices = np.tile(np.eye(4), (len(self.views), 1, 1))
        matrices[:, :3, :3], matrices[:, :3, 3] = self.poses.R, self.poses.t
        return matrices.reshape(-1, 16)

    def select(self, which: Array | slice | list[int]) -> Arm:
        """Return the arm with some of its poses."""
        chosen = np.arange(len(self.views))[which]
        return Arm([self.views[k] for k in chosen], self.poses.select(chosen))


def turn_about_board(rng: np.random.Generator, turns: Array, distance: float = 600.0) -> Motions:
    """Return cam_from_board with the board turned by vectors (K, 3), somewhere near the axis."""
    R = rotation_from_vector(turns)
    places = rng.uniform(-60, 60, (len(turns), 3)) + np.array([0.0, 0.0, distance])
    return Motions(R, places - R @ MIDDLE)


def make_arm(
    rng: np.random.Generator,
    count: int = 12,
    noise: float = 0.0,
    robot: tuple[float, float] = (0.0, 0.0),
    boards: Motions | None = None,
) -> Arm:
    """Photograph a board with a camera in the hand.

    Args:
        rng: what noise and poses are drawn from.
        count: number of poses.
        noise: standard deviation of a corner's coordinate, px.
        robot: standard deviations of a pose about each axis, rad, and along each, mm.
        boards: (K,) cam_from_board; drawn if None.
    """
    if boards is None:
        boards = turn_about_board(rng, 0.4 * rng.normal(size=(count, 3)))
    count = len(boards.R)
    hands = W.after(boards.invert()).after(X.invert())
    errors = rng.normal(size=(count, 6)) * np.repeat(robot, 3)
    stated = hands.after(Motions(rotation_from_vector(errors[:, :3]), errors[:, 3:]))
    pixels = pixels_from_rays(boards.move(CORNERS), CAMERA)
    return Arm([(uv + noise * rng.normal(size=uv.shape), BOARD) for uv in pixels], stated)


def make_standing_arm(rng: np.random.Generator, count: int = 12) -> Arm:
    """Photograph a board in the hand with a camera that stands: X is base_from_camera and W
    hand_from_board."""
    arm = make_arm(rng, count)
    return Arm(arm.views, arm.poses.invert())


def rotate_about(axis: Array, angles: Array) -> Array:
    """Return rotations (K, 3, 3) about an axis."""
    return rotation_from_vector(np.outer(angles, axis / np.linalg.norm(axis)))


def move_four_axes(rng: np.random.Generator, count: int = 12, still: bool = False) -> Arm:
    """Return an arm whose hand turns about the base's Z alone; `still` on its spot."""
    first = make_arm(rng, 1).poses
    R = rotate_about(np.array([0.0, 0.0, 1.0]), rng.uniform(-0.5, 0.5, count)) @ first.R
    place = first.t + (0.0 if still else rng.uniform(-50, 50, (count, 3)))
    return photograph(Motions(R, np.broadcast_to(place, (count, 3))))


def move_without_turning(rng: np.random.Generator, count: int = 12) -> Arm:
    """Return an arm whose hand turns not at all."""
    first = make_arm(rng, 1).poses
    return photograph(
        Motions(np.repeat(first.R, count, axis=0), first.t + rng.uniform(-50, 50, (count, 3)))
    )


def photograph(hands: Motions) -> Arm:
    """Photograph the board from poses of the hand."""
    boards = X.invert().after(hands.invert().after(W))
    return Arm([(uv, BOARD) for uv in pixels_from_rays(boards.move(CORNERS), CAMERA)], hands)

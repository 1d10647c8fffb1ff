"""Rigs of known truth that see several boards, which stand fast to each other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.rig import RigBoard, RigCamera
from tests.engine.rig.scenes import BOARD, RigScene, compose, make_rig, photograph_board

PLACES = (
    Pose(np.zeros(3), np.zeros(3)),
    Pose([0.05, -0.35, 0.1], [330.0, 12.0, -20.0]),
    Pose([-0.4, 0.05, -0.15], [-20.0, 260.0, 35.0]),
)
"""Poses first_from_board of the boards."""


@dataclass(frozen=True, eq=False)
class BoardsScene:
    """A rig of known truth with several boards."""

    rig: RigScene
    places: tuple[Pose, ...]

    @property
    def boards(self) -> list[RigBoard]:
        """The boards, of unknown places."""
        return [RigBoard(f"board {b + 1}") for b in range(len(self.places))]

    def keep(self, is_kept: Callable[[int, int, int], bool]) -> BoardsScene:
        """The scene with the views of camera, board and instant that are kept."""
        cameras = [
            take_views(
                camera,
                [
                    {k: view for k, view in views.items() if is_kept(c, b, k)}
                    for b, views in enumerate(camera.views_by_board)
                ],
            )
            for c, camera in enumerate(self.rig.cameras)
        ]
        return replace(self, rig=replace(self.rig, cameras=tuple(cameras)))

    def noisy(self, sigma: float, rng: np.random.Generator) -> list[RigCamera]:
        """The cameras with Gaussian noise of `sigma` px on every coordinate."""
        return [
            take_views(
                camera,
                [
                    {
                        k: v._replace(uv=v.uv + rng.normal(0, sigma, v.uv.shape))
                        for k, v in each.items()
                    }
                    for each in camera.views_by_board
                ],
            )
            for camera in self.rig.cameras
        ]


def take_views(camera: RigCamera, views: list[dict[int, Observation]]) -> RigCamera:
    return replace(camera, views=views[0], others=tuple(views[1:]))


def bend_board(bow: float, twist: float = 0.0) -> Array:
    """Deviations (n, 3) of a board that is bowed out of its plane by `bow` mm in its middle and
    twisted by `twist` mm at its corners, free of motions and scale."""
    xy = BOARD.points()
    u, v = ((2 * xy - xy.max(axis=0)) / xy.max(axis=0)).T
    z = bow * (1 - u**2) + twist * u * v
    return np.column_stack([np.zeros_like(xy), z - z.mean()])


def make_boards_rig(
    count: int,
    boards: int = 2,
    instants: int = 20,
    seed: int = 0,
    deviations: Sequence[Array | None] = (None, None, None),
) -> BoardsScene:
    """A row of cameras before which boards are moved, all together, which may deviate from their
    drawing by (n, 3) mm."""
    scene = make_rig(count, instants, seed)
    # The group of boards is farther away than one board is.
    shift = [-60.0, -60.0, 250.0] if boards > 1 else [0.0, 0.0, 0.0]
    away = tuple(replace(pose, tvec=pose.tvec + shift) for pose in scene.boards)
    cameras = []
    for camera, pose in zip(scene.cameras, scene.poses, strict=True):
        seen: list[dict[int, Observation]] = [{} for _ in range(boards)]
        for k, first in enumerate(away):
            for b in range(boards):
                there = compose(pose, compose(first, PLACES[b]))
                view = photograph_board(camera.camera, there, deviation=deviations[b])
                if view is not None:
                    seen[b][k] = view
        cameras.append(take_views(camera, seen))
    return BoardsScene(replace(scene, cameras=tuple(cameras), boards=away), PLACES[:boards])

"""Rigs of known truth: cameras around a board, and what they see of it at some instants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array, Size
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.rig.records import Rig, RigCamera
from tests.engine.honesty import check_honest

BOARD = Board(rows=7, cols=10, square=30.0)
SIZE: Size = (1280, 960)
LENSES = (
    Camera(SIZE, [900, 905, 631, 492, -0.2, 0.08, 3e-4, -5e-4, -0.02], "brown-conrady"),
    Camera(SIZE, [450, 452, 645, 470, -0.03, 4e-3, -2e-3, 3e-4], "kannala-brandt"),
    Camera(SIZE, [880, 880, 640, 480, 0.25, 0.1, -0.04, 4e-4, -7e-4, 0.0], "lucchese"),
    Camera(SIZE, [700, 702, 650, 475, 0.6, 1.1], "eucm"),
)
"""Lenses of different models, which the cameras of a rig have in turn."""


@dataclass(frozen=True, eq=False)
class RigScene:
    """A rig of known truth."""

    cameras: tuple[RigCamera, ...]
    """The true cameras with exact corners; nothing is held."""
    poses: tuple[Pose, ...]
    """The true poses cam_from_rig; that of the first is the identity."""
    boards: tuple[Pose, ...]
    """The true poses rig_from_board of the instants 0, 1, ..."""

    def noisy(self, sigma: float, rng: np.random.Generator) -> list[RigCamera]:
        """The cameras with Gaussian noise of `sigma` px on every coordinate."""
        return [
            replace(
                camera,
                views={
                    instant: view._replace(uv=view.uv + rng.normal(0, sigma, view.uv.shape))
                    for instant, view in camera.views.items()
                },
            )
            for camera in self.cameras
        ]


def compose(second: Pose, first: Pose) -> Pose:
    """The motion that does `first` and then `second`."""
    R = rotation_from_vector(second.rvec)
    turned = R @ rotation_from_vector(first.rvec)
    return Pose(vector_from_rotation(turned), R @ first.tvec + second.tvec)


def invert(pose: Pose) -> Pose:
    """The motion back."""
    R = rotation_from_vector(pose.rvec).T
    return Pose(-pose.rvec, -R @ pose.tvec)


def photograph_board(
    camera: Camera, pose: Pose, min_corners: int = 12, deviation: Array | None = None
) -> Observation | None:
    """What a camera sees of the board, in part or whole; None if too little. Its corners may
    deviate from the drawing by (n, 3) mm."""
    xy = BOARD.points()
    R = rotation_from_vector(pose.rvec)
    X = xy @ R[:, :2].T + pose.tvec
    if deviation is not None:
        X = X + deviation @ R.T
    with np.errstate(all="ignore"):
        uv = pixels_from_rays(X, camera)
    width, height = camera.size
    inside = (uv > 5).all(axis=1) & (uv < [width - 6, height - 6]).all(axis=1)
    rays = rays_from_pixels(uv, camera)  # others than seen where the lens folds over
    there = np.sum(rays * X, axis=1) > (1 - 1e-9) * np.linalg.norm(X, axis=1)
    seen = inside & there & np.isfinite(uv).all(axis=1)
    faces = R[2, 2] > 0.3
    rows = len(set(xy[seen, 1].tolist()))
    if not faces or seen.sum() < min_corners or rows < 3:
        return None
    return Observation(uv[seen], xy[seen])


def make_rig(
    count: int,
    instants: int = 20,
    seed: int = 0,
    spacing: float = 120.0,
    turn: float = 0.12,
    lenses: Sequence[Camera] = LENSES,
) -> RigScene:
    """A row of cameras, each `spacing` mm from the next and turned inwards by `turn` rad; the board
    is shown to each neighbouring pair in turn."""
    rng = np.random.default_rng(seed)
    centres = [np.array([c * spacing, 10.0 * (c % 2), 0.0]) for c in range(count)]
    turns = [
        Rotation.from_rotvec([0.02 * (c % 3), -turn * (c - (count - 1) / 2), 0.03 * c]).as_matrix()
        for c in range(count)
    ]
    first = Pose(vector_from_rotation(turns[0]), -turns[0] @ centres[0])
    poses = tuple(
        compose(Pose(vector_from_rotation(R), -R @ centre), invert(first))
        for R, centre in zip(turns, centres, strict=True)
    )
    poses = (Pose(np.zeros(3), np.zeros(3)), *poses[1:])
    middle = BOARD.points().mean(axis=0)
    boards = []
    views: list[dict[int, Observation]] = [{} for _ in range(count)]
    for k in range(instants):
        pair = k % max(count - 1, 1)
        R = Rotation.from_rotvec([*rng.uniform(-0.5, 0.5, 2), rng.uniform(-0.3, 0.3)]).as_matrix()
        at = (centres[pair] + centres[min(pair + 1, count - 1)]) / 2
        where = at + np.array([*rng.uniform(-120, 120, 2), rng.uniform(420, 800)])
        world = Pose(vector_from_rotation(R), where - R[:, :2] @ middle)
        board = compose(first, world)
        boards.append(board)
        for c in range(count):
            seen = photograph_board(lenses[c % len(lenses)], compose(poses[c], board))
            if seen is not None:
                views[c][k] = seen
    cameras = tuple(RigCamera(f"cam{c}", lenses[c % len(lenses)], views[c]) for c in range(count))
    return RigScene(cameras, poses, tuple(boards))


def disturb(cameras: Sequence[RigCamera], rng: np.random.Generator) -> list[RigCamera]:
    """The cameras a little beside the truth, as a calibration of each alone would have them."""
    return [
        replace(
            camera,
            camera=replace(
                camera.camera,
                params=camera.camera.params
                + np.r_[rng.normal(0, 1.0, 4), np.zeros(len(camera.camera.params) - 4)],
            ),
        )
        for camera in cameras
    ]


def measure_pose_error(found: Sequence[Pose], true: Sequence[Pose]) -> tuple[float, float]:
    """The largest differences of rotation, rad, and translation, mm."""
    turns = [
        np.linalg.norm(
            vector_from_rotation(rotation_from_vector(f.rvec) @ rotation_from_vector(t.rvec).T)
        )
        for f, t in zip(found, true, strict=True)
    ]
    moves = [np.linalg.norm(f.tvec - t.tvec) for f, t in zip(found, true, strict=True)]
    return float(max(turns)), float(max(moves))


def check_rigs_honest(rigs: Sequence[Rig], scene: RigScene, places: Sequence[Pose] = ()) -> None:
    """Check that the covariances of rigs drawn from a scene are those of their errors, of lenses,
    of the cameras' poses and of the `places` of boards after the first."""
    truth = np.zeros(rigs[0].layout.size)
    errors = []
    for rig in rigs:
        layout, found = rig.layout, np.zeros(rig.layout.size)
        for c, (camera, pose) in enumerate(zip(rig.cameras, rig.poses, strict=True)):
            found[layout.camera(c)] = camera.params
            found[layout.pose(c)] = *pose.rvec, *pose.tvec
            truth[layout.camera(c)] = scene.cameras[c].camera.params
            truth[layout.pose(c)] = *scene.poses[c].rvec, *scene.poses[c].tvec
        for b, place in enumerate(places, 1):
            pose = rig.placed_boards[b].pose
            found[layout.board(b)] = *pose.rvec, *pose.tvec
            truth[layout.board(b)] = *place.rvec, *place.tvec
        errors.append(found - truth)
    free = np.diag(rigs[0].covariance) > 0
    check_honest(
        np.array(errors)[:, free], np.array([rig.covariance[np.ix_(free, free)] for rig in rigs])
    )

"""How many pictures does a hand need that follows what a capture asks for?
`python -m tests.benchmarks.live_guidance [--seeds 20]`.

A hand moves a board at 0.3 m/s and 45 degrees/s before three lenses, and holds it for a second in
each place. It goes where the picture shows the board, 2 cm and 5 degrees off; or so in seven times
of ten, and anywhere else; or anywhere, as somebody does whom nothing guides; or anywhere, and only
what ROS's four bars count as new (place, size and skew of the board in the image) is taken. Corners
have noise of 0.03 px, as those of rendered boards in light noise. Told are, until no pixel's
projection is known worse than to 0.1 px: the pictures and the hand's time, medians over seeds with
the range, and in how many captures the true error is within two standard deviations in 9 of 10
pixels.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.session import CaptureSession
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.images.rendering import render_view
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty
from tests.scenes.hand import follow, shake

BOARD = Board(7, 10, 25.0)
SIZE = (640, 480)
CAMERAS = {
    "plain": Camera(SIZE, [600, 600, 317, 243, -0.1, 0.02, 0, 0, 0], "brown-conrady"),
    "wide": Camera(SIZE, [420, 420, 322, 238, -0.25, 0.07, 0, 0, 0], "brown-conrady"),
    "fisheye": Camera(SIZE, [250, 250, 318, 241, -0.02, 0.003, 0, 0], "kannala-brandt"),
}
LIMIT, NOISE = 0.1, 0.03
SPEED, TURN, HOLD = 300.0, np.deg2rad(45.0), 1.0
"""Of the hand: mm/s, rad/s and s."""
MOST = 60
"""Number of pictures after which a capture has failed."""
NEW_TO_ROS = 0.2
"""Distance, of four numbers from 0 to 1 added up, at which ROS counts a view as new."""


class Outcome(NamedTuple):
    """What a capture took."""

    pictures: int
    seconds: float
    is_honest: bool


class Hand:
    """A hand and a finder that is given the corners that it shows."""

    def __init__(self, camera: Camera, seed: int) -> None:
        self._camera, self._rng = camera, np.random.default_rng(seed)
        self._pattern = find_corners(
            render_view(
                Camera(SIZE, [600, 600, 320, 240], "pinhole"),
                Pose([0, 0, 0], [-110, -75, 420]),
                BOARD,
            ),
            BOARD.grid_size,
        )
        self.seconds = 0.0
        self._pose = self.go_anywhere(moves=False)

    def go_anywhere(self, moves: bool = True) -> Pose:
        """Go where the whole board is seen, up to 45 degrees tilted."""
        while True:
            tilt = self._rng.uniform(-1, 1, 3) * np.deg2rad([45, 45, 20])
            ray = rays_from_pixels(self._rng.uniform(0.15, 0.85, 2) * SIZE, self._camera)
            far = self._rng.uniform(200, 700)
            R = rotation_from_vector(tilt)
            pose = Pose(tilt, far * ray - R[:, :2] @ BOARD.points().mean(axis=0))
            if self._sees(pose):
                return self._go(pose) if moves else pose

    def obey(self, goal: Array) -> Pose:
        """Go where the picture shows the board, nearly, with the whole of it in the image."""
        wanted = follow(goal, self._camera, BOARD)
        for _ in range(100):
            pose = shake(wanted, BOARD, self._rng, 20.0, 5.0)
            if self._sees(pose):
                return self._go(pose)
        return self.go_anywhere()

    def is_obedient(self, share: float) -> bool:
        """Return whether the hand obeys this time."""
        return bool(self._rng.random() < share)

    def find(self, _: GreyImage) -> Corners:
        """Find the corners, with noise."""
        uv = project_points(BOARD.points(), self._camera, self._pose)
        uv = uv + self._rng.normal(0, NOISE, uv.shape)
        if len(self._pattern) != len(uv):
            raise NoBoardError("The pattern was not found whole.")
        cov = np.broadcast_to(NOISE**2 * np.eye(2), (len(uv), 2, 2))
        grid = np.indices(BOARD.grid_size).reshape(2, -1).T
        return replace(self._pattern, grid=grid, uv=uv, estimate=uv, cov=cov)

    def describe(self, pose: Pose) -> Array:
        """Return ROS's four numbers of a view: X, Y, size and skew."""
        uv = project_points(BOARD.points(), self._camera, pose).reshape(*BOARD.grid_size, 2)
        a, b, c = uv[0, -1], uv[0, 0], uv[-1, 0]
        d = uv[-1, -1]
        p, q = d - b, c - a
        area = abs(p[0] * q[1] - p[1] * q[0]) / 2
        border = np.sqrt(area)
        x = np.clip((uv[..., 0].mean() - border / 2) / (SIZE[0] - border), 0, 1)
        y = np.clip((uv[..., 1].mean() - border / 2) / (SIZE[1] - border), 0, 1)
        sides = (b - a) / np.linalg.norm(b - a), (c - b) / np.linalg.norm(c - b)
        angle = np.arccos(np.clip(-sides[0] @ sides[1], -1, 1))
        return np.array(
            [x, y, np.sqrt(area / (SIZE[0] * SIZE[1])), min(1, 2 * abs(np.pi / 2 - angle))]
        )

    def _sees(self, pose: Pose) -> bool:
        """Return whether the whole board is seen, from its front."""
        uv = project_points(BOARD.points(), self._camera, pose)
        R = rotation_from_vector(np.array(pose.rvec))
        is_front = (BOARD.points() @ R[:, :2].T + pose.tvec) @ R[:, 2] > 0
        return bool(((uv > 4) & (uv < np.array(SIZE) - 5)).all() and is_front.all())

    def _go(self, pose: Pose) -> Pose:
        way = np.linalg.norm(pose.tvec - self._pose.tvec)
        R = [rotation_from_vector(np.array(each.rvec)) for each in (pose, self._pose)]
        turn = np.linalg.norm(vector_from_rotation(R[0] @ R[1].T))
        self.seconds += float(max(way / SPEED, turn / TURN)) + HOLD
        self._pose = pose
        return pose


def capture(camera: Camera, seed: int, share: float | None, ros: bool = False) -> Outcome:
    """Capture with a hand that obeys in a share of the times; None for one that is not guided."""
    hand = Hand(camera, seed)
    session = CaptureSession(hand.find, BOARD.square, LIMIT)
    image = np.zeros(SIZE[::-1], np.uint8)
    known: list[Array] = []
    for k in itertools.count():
        if session.is_complete or len(session.pictures) == MOST:
            break
        goal = session.goal
        if share is not None and goal is not None and hand.is_obedient(share):
            pose = hand.obey(goal)
        else:
            pose = hand.go_anywhere()
        if ros:
            numbers = hand.describe(pose)
            is_new = all(np.abs(numbers - each).sum() > NEW_TO_ROS for each in known)
            if not is_new and k < 10 * MOST:
                continue
            known.append(numbers)
        session.take(Frame(image, hand.seconds))
    return Outcome(len(session.pictures), hand.seconds, _is_honest(session, camera))


def _is_honest(session: CaptureSession, camera: Camera) -> bool:
    """Return whether the true error is within two standard deviations nearly everywhere."""
    calibration = session.calibration
    if calibration is None or not session.is_complete:
        return False
    found = estimate_projection_uncertainty(calibration, session.views)
    uv = np.stack(np.meshgrid(found.u, found.v), axis=-1)
    seen, true = (rays_from_pixels(uv, each) for each in (calibration.camera, camera))
    good = np.isfinite(seen).all(-1) & np.isfinite(true).all(-1)
    U, _, Vt = np.linalg.svd(seen[good].T @ true[good])
    turned = true[good] @ (U @ np.diag([1, 1, np.linalg.det(U @ Vt)]) @ Vt).T
    moved = pixels_from_rays(turned, calibration.camera) - uv[good]
    ratio = np.linalg.norm(moved, axis=-1) / found.worst_direction[good]
    return bool(np.mean(ratio < 2.45) > 0.9)


HANDS: dict[str, tuple[float | None, bool]] = {
    "follows": (1.0, False),
    "follows 7 of 10": (0.7, False),
    "anywhere": (None, False),
    "ROS's four bars": (None, True),
}


def make_rows(seeds: int) -> Iterator[str]:
    """Make a row of a table for each lens and hand."""
    for lens, camera in CAMERAS.items():
        for name, (share, ros) in HANDS.items():
            outcomes = [capture(camera, seed, share, ros) for seed in range(seeds)]
            pictures, seconds = (np.array([each[k] for each in outcomes]) for k in (0, 1))
            honest = sum(each.is_honest for each in outcomes)
            yield (
                f"| {lens} | {name} | {np.median(pictures):.0f} ({pictures.min():.0f} to "
                f"{pictures.max():.0f}) | {np.median(seconds):.0f} ({seconds.max():.0f}) | "
                f"{honest} of {seeds} |"
            )


def main() -> None:
    """Run the captures and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20)
    options = parser.parse_args()
    print("| lens | hand | pictures | seconds (most) | honest |\n| --- | --- | --- | --- | --- |")
    for row in make_rows(options.seeds):
        print(row, flush=True)


if __name__ == "__main__":
    main()

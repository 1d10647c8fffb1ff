"""Sets of views that faults are injected into: rendered ones, and real ones where they are present.

Both are a camera, poses of a board and what the corners are off by. Of a real set these are the
calibration of its corners and what that leaves, so that a fault changes real corners by exactly
what it would have changed them by, and the camera without it is known.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.pose import Pose
from tests.conftest import find_data_dir
from tests.engine.scenes import BOARD, barrel, looking, stored

_REAL_SETS = (
    "bouguet_calib_example/corners_and_results/corners_25img__benJephunneh.json",
    "bouguet_merging_example_corners_only/corners_part1.json",
)
_REAL_SHARE = 0.2
"""Share of the draws that a real set is taken for, where there are any."""
VIEWS = (6, 25)
"""Least and largest number of views of a set."""
NOISE = (0.05, 0.3)
"""Least and largest standard deviation of a corner's coordinate in rendered sets, px."""

Rng = np.random.Generator


@dataclass(frozen=True, eq=False)
class PhotographedSet:
    """A camera, poses of a board and the corners' errors: a set without a fault."""

    name: str
    """Where it is from."""
    camera: Camera
    poses: tuple[Pose, ...]
    boards: tuple[Array, ...]
    """Per view the corners (n, 2) that are seen of the board, mm."""
    noise: tuple[Array, ...]
    """Per view what the measured corners are off by, (n, 2) px."""

    @property
    def square(self) -> float:
        """Distance of neighbouring corners, mm."""
        x = np.unique(np.round(np.concatenate(self.boards)[:, 0], 6))
        return float(np.median(np.diff(x)))

    @property
    def level(self) -> float:
        """Standard deviation of the corners' coordinates, px."""
        return float(np.std(np.concatenate(self.noise)))

    def select(self, chosen: Sequence[int]) -> PhotographedSet:
        """Return some of the views."""
        return replace(
            self,
            poses=tuple(self.poses[k] for k in chosen),
            boards=tuple(self.boards[k] for k in chosen),
            noise=tuple(self.noise[k] for k in chosen),
        )


@dataclass(frozen=True, eq=False)
class FaultySet:
    """What a calibration is given, and what it should say."""

    views: list[Observation]
    size: Size
    """The image size that is stated, px."""
    truth: Camera
    story: str
    """The fault, and how large it is."""
    options: Mapping[str, object] = field(default_factory=dict)
    """Arguments of the calibration besides its defaults."""


def state_fault(
    photographed: PhotographedSet, views: list[Observation], story: str, **options: object
) -> FaultySet:
    """Make the faulty set of a clean one, with its true camera and image size."""
    camera = photographed.camera
    story = f"{photographed.name}, {len(views)} views at {photographed.level:.2f} px: {story}"
    return FaultySet(views, camera.size, camera, story, options)


def photograph(
    photographed: PhotographedSet,
    cameras: Camera | Sequence[Camera] | None = None,
    displace: Callable[[Array], Array] | None = None,
    shift: Callable[[int, Array], Array] | None = None,
) -> list[Observation]:
    """Photograph the set's boards from its poses.

    Args:
        photographed: the set.
        cameras: a camera for all views or one for each; that of the set if None.
        displace: function that returns where corners (n, 2) of the board really lie, (n, 3) mm.
        shift: function of a view's index and its exact corners (n, 2) that returns where they are
            imaged instead, px.

    Returns:
        The views, less the corners that lie outside of the image or beyond the lens.
    """
    views = []
    for k, (pose, xy, noise) in enumerate(
        zip(photographed.poses, photographed.boards, photographed.noise, strict=True)
    ):
        camera = photographed.camera if cameras is None else cameras
        camera = camera if isinstance(camera, Camera) else camera[k]
        flat = np.column_stack([xy, np.zeros(len(xy))])
        uv = project_corners(camera, pose, flat if displace is None else displace(xy))
        uv = uv if shift is None else shift(k, uv)
        inside = np.isfinite(uv).all(axis=1)
        inside &= ((uv >= -0.5) & (uv <= np.array(camera.size) - 0.5)).all(axis=1)
        if inside.sum() >= 8 and np.linalg.matrix_rank(xy[inside] - xy[inside].mean(axis=0)) == 2:
            views.append(Observation((uv + noise)[inside], xy[inside]))
    return views


def project_corners(camera: Camera, pose: Pose, points: Array) -> Array:
    """Project points (n, 3) of the board's frame, mm, into the image, (n, 2) px."""
    R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()
    return pixels_from_rays(points @ R.T + np.array(pose.tvec), camera)


def draw_set(rng: Rng) -> PhotographedSet:
    """Draw a set without a fault, a real one now and then."""
    names = [name for name in _REAL_SETS if (find_data_dir() / name).is_file()]
    if not names or rng.random() > _REAL_SHARE:
        return draw_rendered_set(rng)
    real = read_real_set(str(rng.choice(names)))
    count = int(rng.integers(VIEWS[0], min(VIEWS[1], len(real.poses)) + 1))
    return real.select(sorted(rng.choice(len(real.poses), count, replace=False).tolist()))


def draw_rendered_set(rng: Rng, camera: Camera | None = None) -> PhotographedSet:
    """Draw random views with Gaussian noise; the camera is a VGA barrel lens by default."""
    camera = camera or barrel(aspect=rng.uniform(0.98, 1.02), focal=rng.uniform(550, 900))
    count = int(rng.integers(VIEWS[0], VIEWS[1] + 1))
    return add_noise(camera, [looking(camera, rng) for _ in range(count)], rng)


def add_noise(camera: Camera, poses: Sequence[Pose], rng: Rng) -> PhotographedSet:
    """Make a set of the whole board in some poses, with Gaussian noise."""
    sigma, xy = draw_log(rng, *NOISE), BOARD.points()
    noise = tuple(rng.normal(scale=sigma, size=xy.shape) for _ in poses)
    return PhotographedSet("rendered", camera, tuple(poses), (xy,) * len(poses), noise)


def draw_log(rng: Rng, low: float, high: float) -> float:
    """Draw a number from a range, every ratio as likely as every other."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def change_camera(camera: Camera, **factors: float) -> Camera:
    """Return the camera with some of its parameters multiplied."""
    scale = np.array([factors.get(name, 1.0) for name in camera.names])
    return Camera(camera.size, camera.params * scale, camera.model)


@cache
def read_real_set(name: str) -> PhotographedSet:
    """Read the corners of a real set, and calibrate them together with the board's shape.

    The real board's deviations are left out, so that the set is clean but for its corners' errors.
    """
    views, size = stored(find_data_dir() / name)
    found = calibrate(views, size, board_shape="free")
    noise = tuple(np.asarray(view.image) for view in found.residuals)
    boards = tuple(view.xy for view in views)
    return PhotographedSet(Path(name).parts[0], found.camera, found.poses, boards, noise)

"""Synthetic scenes with known truth: a camera, poses of a board, and what the camera sees."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array, Size
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.pose import Pose

VGA: Size = (640, 480)
BOARD = Board(rows=9, cols=12, square=30.0)
TRUE_BOARD = BoardShapePrior(1e-6, 1e-6)
"""A board that is as drawn: uncertainties are then those of the corners' noise alone."""


@dataclass(frozen=True, eq=False)
class Scene:
    """The truth, and the exact corners of every view."""

    camera: Camera
    poses: tuple[Pose, ...]
    views: tuple[Observation, ...]

    @property
    def size(self) -> Size:
        return self.camera.size

    def noisy(self, sigma: float, rng: np.random.Generator) -> list[Observation]:
        """The views with Gaussian noise of `sigma` px on every coordinate."""
        return [
            Observation(view.uv + rng.normal(scale=sigma, size=view.uv.shape), view.xy)
            for view in self.views
        ]


def barrel(aspect: float = 1.0, focal: float = 650.0, size: Size = VGA) -> Camera:
    """A lens like that of the paper's camera, pixels `aspect` as wide as high."""
    w, h = size
    params = [focal, focal * aspect, 0.47 * w, 0.52 * h]
    return Camera(size, [*params, 0.25, 0.1, -0.04, 4e-4, -7e-4, 0.0])


def brown(aspect: float = 1.0, size: Size = VGA) -> Camera:
    """The same kind of camera in OpenCV's model."""
    params = [650.0, 650.0 * aspect, 303.0, 243.0]
    return Camera(size, [*params, -0.25, 0.12, 3e-4, -5e-4, -0.03], "brown-conrady")


_ALL_AT_WORK = (0.25, 0.1, -0.04, 4e-4, -7e-4, 0.4)
_WAVY = np.random.default_rng(7).normal(0, 0.007, (9, 9, 2))
"""Shifts of control points; less the same ones turned by 180 degrees they leave the axis alone."""
LENSES = {
    "lucchese": _ALL_AT_WORK,
    "lucchese-pixels": _ALL_AT_WORK,
    "pinhole": (),
    "brown-conrady-4": (-0.25, 0.12, 3e-4, -5e-4, 2e-3),
    "brown-conrady": (-0.25, 0.12, 3e-4, -5e-4, -0.03, 2e-3),
    "rational": (0.4, 0.2, 3e-4, -5e-4, 0.02, 0.7, 0.3, 0.05, 2e-3),
    "thin-prism": (0.4, 0.2, 3e-4, -5e-4, 0.02, 0.7, 0.3, 0.05, 1e-3, -2e-3, 2e-3, 1e-3, 2e-3),
    "kannala-brandt": (-0.05, 4e-3, -3e-3, 4e-4),
    "kannala-brandt-decentering": (-0.05, 4e-3, -3e-3, 4e-4, 4e-4, -7e-4),
    "ucm": (0.6,),
    "eucm": (0.6, 1.1),
    "double-sphere": (-0.2, 0.55),
    "mei": (1.4, -0.2, 0.03, 4e-4, -7e-4),
    "division": (-0.3,),
    "scaramuzza": (-0.35, 0.02, -0.05),
    "splined-stereographic-9x9-160": tuple((_WAVY - _WAVY[::-1, ::-1]).ravel().tolist()),
}
"""A lens of each model: what `example` is made with, and the tests of all models are."""


VALLEYS = {
    "rational": ("k4", "k5", "k6"),
    "thin-prism": ("k4", "k5", "k6", "s1", "s2", "s3", "s4"),
    "eucm": ("beta",),
    "double-sphere": ("xi",),
    "mei": ("xi",),
}
"""Coefficients that trade with others on a lens of moderate angle: the scatter along a bent valley
is no standard deviation."""


def example(model: str, aspect: float = 1.0) -> Camera:
    """A camera with a lens of any model, all of its coefficients at work."""
    f = 650.0 * (1 + LENSES[model][0] if model == "mei" else 1)  # Mei's is that of the sphere
    return Camera(VGA, [f, f * aspect, 303.0, 243.0, *LENSES[model]], model)


def imaged(camera: Camera, pose: Pose, xy: Array) -> Array:
    """(n, 2) where the camera sees points of the board, px; NaN behind it or beyond the lens."""
    point = xy @ Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()[:, :2].T + pose.tvec
    return pixels_from_rays(point, camera)


def looking(
    camera: Camera,
    rng: np.random.Generator,
    tilt: tuple[float, float] = (15.0, 45.0),
    fill: tuple[float, float] = (0.5, 0.9),
    roll: float = 20.0,
    towards: float | None = None,
    board: Board = BOARD,
) -> Pose:
    """A random pose of the board in front of the camera.

    Args:
        camera: that looks.
        rng: source of the choice.
        tilt: range of the angle between board and sensor, degrees.
        fill: range of the board's width over the image's.
        roll: largest turn about the board's normal, degrees.
        towards: direction of the tilt, degrees; any if None.
        board: the board.
    """
    direction = np.deg2rad(rng.uniform(0, 360) if towards is None else towards)
    angle = np.deg2rad(rng.uniform(*tilt))
    tilting = Rotation.from_rotvec(angle * np.array([np.cos(direction), np.sin(direction), 0.0]))
    turn = Rotation.from_euler("z", rng.uniform(-roll, roll), degrees=True)
    R = (tilting * turn).as_matrix()
    corners = board.points()
    centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
    width = np.ptp(corners[:, 0])
    w, h = camera.size
    depth = width / w * camera.focal[0] / rng.uniform(*fill)
    aim = (np.array([w, h]) * rng.uniform(0.38, 0.62, size=2) - camera.centre) / camera.focal
    return Pose(
        Rotation.from_matrix(R).as_rotvec(), depth * np.append(aim, 1.0) - R[:, :2] @ centre
    )


def seen(
    camera: Camera, poses: Sequence[Pose], board: Board = BOARD, partial: bool = False
) -> Scene:
    """What the camera sees of the board in each pose; partial boards lose what the image cuts."""
    xy = board.points()
    views = []
    for pose in poses:
        uv = imaged(camera, pose, xy)
        inside = np.isfinite(uv).all(axis=1)
        if partial:
            inside &= ((uv >= 0) & (uv <= np.array(camera.size) - 1)).all(axis=1)
        assert partial or inside.all(), "the lens folds over before the board ends"
        views.append(Observation(uv[inside], xy[inside]))
    return Scene(camera, tuple(poses), tuple(views))


def scene(
    camera: Camera, count: int = 10, seed: int = 0, tilt: tuple[float, float] = (15.0, 45.0)
) -> Scene:
    """`count` random views of the whole board."""
    rng = np.random.default_rng(seed)
    return seen(camera, [looking(camera, rng, tilt) for _ in range(count)])


def scene_in_the_middle(camera: Camera, count: int, seed: int, spread: float) -> Scene:
    """Views of a board that is far away, within `spread` (its tangent) of the optical axis."""
    rng = np.random.default_rng(seed)
    poses = []
    for _ in range(count):
        pose = looking(camera, rng, fill=(0.2, 0.25))
        to_middle = Rotation.from_rotvec(np.array(pose.rvec)).apply([*BOARD.points().mean(0), 0.0])
        ray = np.append(rng.uniform(-spread, spread, 2), 1.0)
        poses.append(Pose(pose.rvec, (to_middle + pose.tvec)[2] * ray - to_middle))
    return seen(camera, poses)


def uneven(
    camera: Camera, board: Board, count: int, deviation: float, turned: Sequence[int] = ()
) -> list[Observation]:
    """Views, with 0.1 px of noise, of a board whose corners are off in the plane, mm; in some
    (`turned`) the corners are listed from the other end."""
    rng = np.random.default_rng(count)
    xy = board.points()
    off = rng.normal(scale=deviation, size=xy.shape)
    views = []
    for k in range(count):
        pose = looking(camera, rng, fill=(0.6, 0.8), board=board)
        uv = imaged(camera, pose, xy + off) + rng.normal(scale=0.1, size=xy.shape)
        views.append(Observation(uv[::-1] if k in turned else uv, xy))
    return views


def stored(file: Path) -> tuple[list[Observation], Size]:
    """The corners of one of the real data sets, and the size of its images."""
    content = json.loads(file.read_text())
    views = [
        Observation(np.array(view["image_points"]), np.array(view["object_points"])[:, :2])
        for view in content["views"]
    ]
    width, height = content["image_size"]
    return views, (width, height)


def relative(a: Array, b: Array, floor: float = 1e-12) -> float:
    """Largest difference relative to the largest entry of `b`."""
    return float(np.abs(a - b).max() / max(np.abs(b).max(), floor))


def central_differences(f: Callable[[Array], Array], x: Array, step: Array | float) -> Array:
    """(..., n) derivative of f (returning any shape) by each of x (n,), at x.

    The five-point rule: with steps h of a thousandth of the scale on which f changes, its
    truncation h^4 and its rounding 1e-16 / h are both about 1e-12 of the derivative.
    """
    columns = []
    for i, h in enumerate(np.broadcast_to(step, x.shape)):
        e = np.zeros_like(x)
        e[i] = h
        near, far = f(x + e) - f(x - e), f(x + 2 * e) - f(x - 2 * e)
        columns.append((8 * near - far) / (12 * h))
    return np.stack(columns, axis=-1)

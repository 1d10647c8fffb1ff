"""Random lenses of 60 to 220 degrees, and how near a calibration from nothing comes to the minimum.

Every family of lens models is drawn up to the angle that it can see. The boards are anywhere in
the image, cut by its edge, and cross 90 degrees off the axis where the lens sees that far. The
reference is the solve that starts at the truth: the one that ends higher has failed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.problem import resolve_held_parameters
from calibgui.engine.calibration.refinement.bundle_adjustment import solve_stage_two
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model, list_parameter_names
from calibgui.engine.camera.plane import PlaneLens
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from tests.engine.random_problems import Outcome
from tests.engine.scenes import LENSES, VGA, Scene

SIZES: list[Size] = [(1280, 800), (640, 480), (1920, 1080), (1000, 1000)]
COUNTS = (3, 5, 10)
NOISES = (0.0, 0.1)
BOARD = Board(rows=9, cols=12, square=30.0)

_WIDEST_PLANE, _WIDEST = 120.0, 220.0
"""Largest diagonal angles, degrees, of models of the plane z = 1, and of all others."""
_EXAMPLE_DEG = {"brown-conrady-4": 75.0, "brown-conrady": 75.0}
"""Diagonal angles, degrees, of those examples that fold before the others' angles."""
_MIN_CORNERS, _MIN_LINES = 20, 3
"""Least numbers of corners, and of rows and columns, that a view shows."""
_MAX_TRIES = 200
"""Number of draws of a view after which it need not show corners past 90 degrees."""


def _radial(
    rng: np.random.Generator, end: float, low: float, high: float, count: int
) -> list[float]:
    """Coefficients of r^2, r^4, ..., each of which moves the radius `end` by a share of it."""
    return [rng.uniform(low, high) / end ** (2 * j) for j in range(1, count + 1)]


def _decentring(rng: np.random.Generator, end: float) -> list[float]:
    return list(rng.normal(scale=1e-3, size=2) / end)


def _brown(rng: np.random.Generator, angle: float, count: int) -> list[float]:
    end = np.tan(angle)
    k = _radial(rng, end, -0.25, 0.2, count)
    return [*k[:2], *_decentring(rng, end), *k[2:]]


def _rational(rng: np.random.Generator, angle: float) -> list[float]:
    end = np.tan(angle)
    above, below = _radial(rng, end, -0.1, 0.5, 3), _radial(rng, end, -0.1, 0.6, 3)
    return [*above[:2], *_decentring(rng, end), above[2], *below]


def _thin_prism(rng: np.random.Generator, angle: float) -> list[float]:
    return [*_rational(rng, angle), *(rng.normal(scale=1e-3, size=4) / np.tan(angle))]


def _lucchese(rng: np.random.Generator, angle: float) -> list[float]:
    end = 0.7 * np.tan(angle)
    return [*_radial(rng, end, -0.1, 0.3, 3), *_decentring(rng, end), 0.0]


def _kannala(rng: np.random.Generator, angle: float) -> list[float]:
    return _radial(rng, angle, -0.15, 0.15, 4)


def _mei(rng: np.random.Generator, angle: float) -> list[float]:
    xi = rng.uniform(0.0, 2.5)
    end = max(np.sin(angle) / max(np.cos(angle) + xi, 0.05), 0.05)
    return [xi, *_radial(rng, end, -0.2, 0.2, 2), *_decentring(rng, end)]


def _scaramuzza(rng: np.random.Generator, angle: float) -> list[float]:
    # (d, 1 + a2 r^2) is the stereographic projection at -1/4, and folds soon for large a2.
    shares = rng.uniform(-0.1, 0.1, size=2) / angle ** np.array([3, 4])
    return [rng.uniform(-0.5, 0.1 - 0.2 * angle), *shares]


_Draw = Callable[[np.random.Generator, float], list[float]]
FAMILIES: dict[str, _Draw] = {
    "pinhole": lambda _rng, _angle: [],
    "lucchese": _lucchese,
    "brown-conrady-4": lambda rng, angle: _brown(rng, angle, 2),
    "brown-conrady": lambda rng, angle: _brown(rng, angle, 3),
    "rational": _rational,
    "thin-prism": _thin_prism,
    "kannala-brandt": _kannala,
    "kannala-brandt-decentering": lambda rng, a: [*_kannala(rng, a), *_decentring(rng, a)],
    "ucm": lambda rng, _angle: [rng.uniform(0.0, 0.85)],
    "eucm": lambda rng, _angle: [rng.uniform(0.0, 0.85), rng.uniform(0.6, 1.6)],
    "double-sphere": lambda rng, _angle: [rng.uniform(-0.4, 0.5), rng.uniform(0.3, 0.75)],
    "mei": _mei,
    "division": lambda rng, _angle: [rng.uniform(-0.6, 0.1)],
    "scaramuzza": _scaramuzza,
}
"""Coefficients of a random lens of each family, for half of its diagonal angle, rad."""


class Problem(NamedTuple):
    """Views of a board through a lens."""

    scene: Scene
    views: list[Observation]
    """The scene's views with noise."""
    angle: float
    """Diagonal field of view, degrees."""
    words: str


def draw_camera(rng: np.random.Generator, model: str, angle: float, size: Size) -> Camera:
    """A camera that sees `angle` degrees from corner to corner of an image about its centre.

    The principal point is up to 5 % off, the pixel's aspect up to 3 %.
    """
    defaults = np.array(find_model(model).defaults)
    while True:
        drawn = FAMILIES[model](rng, np.deg2rad(angle) / 2)
        k = np.append(drawn, defaults[len(drawn) :])
        off = np.array(size) * rng.uniform(-0.05, 0.05, size=2)
        camera = fit_into_image(model, k, angle, size, off, rng.uniform(0.97, 1.03))
        if camera is not None:
            return camera


def fit_into_image(
    model: str, k: Array, angle: float, size: Size, off: Array, aspect: float
) -> Camera | None:
    """The camera of a lens that sees `angle` degrees from corner to corner; None if it folds.

    Args:
        model: the lens model.
        k: its coefficients.
        angle: diagonal field of view about the middle of the image, degrees.
        size: of the image, px.
        off: (2,) where the principal point is, px from the middle.
        aspect: fy over fx.
    """
    half = np.deg2rad(angle) / 2
    edge = find_model(model).project(np.array([np.sin(half), 0.0, np.cos(half)]), k).points
    if not edge[0] > 0:
        return None
    f = np.hypot(*size) / 2 / edge[0]
    camera = Camera(size, [f, f * aspect, *((np.array(size) - 1) / 2 + off), *k], model)
    return camera if is_one_to_one(camera) else None


def example_scene(model: str, count: int = 10) -> Scene:
    """Views through the example of a model's lenses, as wide as makes all coefficients matter."""
    angle = _EXAMPLE_DEG.get(model, 118.0 if isinstance(find_model(model), PlaneLens) else 170.0)
    k = np.array(LENSES[model])
    camera = fit_into_image(model, k, angle, VGA, np.array([-16.5, 3.5]), 0.98)
    assert camera is not None
    return draw_scene(np.random.default_rng(3), camera, count)


def draw_scene(
    rng: np.random.Generator, camera: Camera, count: int, past: Sequence[int] = ()
) -> Scene:
    """Random views through a camera; those numbered in `past` cross 90 degrees if it sees them."""
    found = [draw_view(rng, camera, k in past) for k in range(count)]
    return Scene(camera, *(tuple(part) for part in zip(*found, strict=True)))


def is_one_to_one(camera: Camera) -> bool:
    """Whether the angle off the axis grows with the radius all over the image.

    It grows nowhere ten times as slowly as on average, nor as suddenly as at a fold.
    """
    w, h = camera.size
    x, y = np.linspace(0, w - 1, 13), np.linspace(0, h - 1, 13)
    edge = [(u, v) for u in x for v in (0, h - 1)] + [(u, v) for u in (0, w - 1) for v in y]
    along = np.linspace(0.02, 1.05, 52)[:, None, None]
    uv = camera.centre + along * (np.array(edge) - camera.centre)
    rays = rays_from_pixels(uv, camera)
    angle = np.arctan2(np.hypot(rays[..., 0], rays[..., 1]), rays[..., 2])
    back = pixels_from_rays(rays, camera)
    step = np.diff(angle, axis=0)
    return bool(
        np.isfinite(angle).all()
        and np.allclose(back, uv, atol=1e-6)
        and (step > 0.1 * angle.max() / len(step)).all()
        and (step < 0.1 * angle.max()).all()
    )


def draw_view(rng: np.random.Generator, camera: Camera, past: bool) -> tuple[Pose, Observation]:
    """A view of the board, tilted by 10 to 50 degrees against the ray to its middle.

    Args:
        rng: source of the choice.
        camera: the camera that looks.
        past: whether corners more than 90 degrees off the axis are wanted, and tried for.
    """
    xy, size = BOARD.points(), np.array(camera.size)
    middle = (xy.min(axis=0) + xy.max(axis=0)) / 2
    ends = np.array([[0.0, camera.centre[1]], [size[0] - 1, camera.centre[1]]])
    left, right = np.arctan2(*rays_from_pixels(ends, camera)[:, [0, 2]].T)
    tries = 0
    while True:
        tries += 1
        aim = rays_from_pixels(size * rng.uniform(0.1, 0.9, size=2), camera)
        seen = min((right - left) * rng.uniform(0.4, 1.1), np.deg2rad(rng.uniform(60, 120)))
        distance = np.ptp(xy[:, 0]) / 2 / np.tan(seen / 2)
        turn = Rotation.align_vectors(aim[None], np.array([[0.0, 0.0, 1.0]]))[0]
        direction, tilt = rng.uniform(0, 2 * np.pi), np.deg2rad(rng.uniform(10, 50))
        tilting = Rotation.from_rotvec(tilt * np.array([np.cos(direction), np.sin(direction), 0]))
        roll = Rotation.from_euler("z", rng.uniform(-180, 180), degrees=True)
        R = (turn * tilting * roll).as_matrix()
        T = distance * aim - R[:, :2] @ middle
        points = xy @ R[:, :2].T + T
        shown, uv = find_shown(camera, points)
        lines = [len(np.unique(xy[shown, axis])) for axis in (0, 1)]
        if np.count_nonzero(shown) < _MIN_CORNERS or min(lines) < _MIN_LINES:
            continue
        if past and tries < _MAX_TRIES and (points[shown, 2] > 0).all():
            continue
        return Pose(Rotation.from_matrix(R).as_rotvec(), T), Observation(uv[shown], xy[shown])


def find_shown(camera: Camera, points: Array) -> tuple[BoolArray, Array]:
    """Which points (n, 3) the image shows, and the pixels (n, 2) of all."""
    uv = pixels_from_rays(points, camera)
    inside = np.isfinite(uv).all(axis=1)
    inside &= ((uv >= 0) & (uv <= np.array(camera.size) - 1)).all(axis=1)
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    # Beyond its limit a lens can image a second direction at the same place.
    back = rays_from_pixels(np.where(inside[:, None], uv, camera.centre), camera)
    inside &= np.linalg.norm(back - rays, axis=1) < 1e-6
    return inside, uv


def problem(seed: int, model: str | None = None) -> Problem:
    """3, 5 or 10 views through a lens of a family, which changes from seed to seed."""
    rng = np.random.default_rng(seed)
    model = model or list(FAMILIES)[seed % len(FAMILIES)]
    widest = _WIDEST_PLANE if isinstance(find_model(model), PlaneLens) else _WIDEST
    angle = rng.uniform(60.0, widest)
    size = SIZES[rng.integers(len(SIZES))]
    count, noise = int(rng.choice(COUNTS)), float(rng.choice(NOISES))
    camera = draw_camera(rng, model, angle, size)
    scene = draw_scene(rng, camera, count, past=(0, 1) if angle > 180 else ())
    words = f"{model} {angle:.0f} deg, {count} views, {noise} px"
    return Problem(scene, scene.noisy(noise, rng), angle, words)


def true_state(scene: Scene) -> State:
    """The truth as the solver takes it."""
    R = Rotation.from_rotvec(np.array([pose.rvec for pose in scene.poses])).as_matrix()
    return State(scene.camera.params.copy(), R, np.array([pose.tvec for pose in scene.poses]))


def solve_from_truth(scene: Scene, views: list[Observation]) -> Solution:
    """The minimum that a solve from the truth ends in."""
    model = scene.camera.model
    held = resolve_held_parameters((), (), model, scene.size)
    free = np.flatnonzero([name not in held for name in list_parameter_names(model)])
    return solve_stage_two(
        pack_observations(views),
        true_state(scene),
        model=model,
        cost=Cost.IMAGE,
        scale=1.0,
        free=free,
        report=None,
        max_iterations=100,
    )


def outcome(seed: int, model: str | None = None) -> Outcome:
    """Calibrate one problem from nothing."""
    made, views, _, words = problem(seed, model)
    reference = solve_from_truth(made, views)
    best = reference.normal.cost
    try:
        found = calibrate(views, made.size, model=made.camera.model)
    except CalibrationError as error:
        return Outcome(seed, False, False, f"{words}: {type(error).__name__}: {error}")
    cost = found.history[-1].cost
    # Without noise the costs are rounding errors.
    least = cost <= best * (1 + 1e-6) + 1e-18 * made.size[0] ** 2 * sum(len(v.uv) for v in views)
    # A valley can be too long to end in, from the truth as well.
    converged = found.status in (Status.CONVERGED, reference.status)
    words = f"{words}: {found.status.value}: {cost:.6g}, from the truth {best:.6g}"
    return Outcome(seed, least and converged, converged and not least, words)

"""Random calibration problems, and how near a calibration comes to the minimum of each.

Cameras, lenses and views are drawn far beyond what people use. The reference is the solve that
starts at the truth: both minimise the same cost, so that the one that ends higher has failed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Size
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Cost, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import Scene, looking, seen

SIZES: list[Size] = [(640, 480), (4000, 3000), (1920, 1080)]
FREE = np.arange(9)


class Outcome(NamedTuple):
    """The outcome of one problem."""

    seed: int
    reached: bool
    """True if the calibration converged at the minimum."""
    silent: bool
    """True if it reports convergence but is not at the minimum."""
    words: str


def camera(rng: np.random.Generator, size: Size) -> Camera:
    """Focal length 0.4 to 4 widths, aspect 0.7 to 1.4, centre up to 20 % off.

    The corner is moved up to 30 % outwards or inwards, mostly by k1.
    """
    w, h = size
    f = w * np.exp(rng.uniform(np.log(0.4), np.log(4.0)))
    aspect = rng.uniform(0.7, 1.4)
    centre = np.array([w, h]) * (0.5 + rng.uniform(-0.2, 0.2, size=2))
    corner = np.hypot(w / (2 * f), h / (2 * f * aspect))
    moved, share = rng.uniform(-0.3, 0.3), rng.uniform(0.7, 1.0)
    k1, k2 = share * moved / corner**2, (1 - share) * moved / corner**4
    p = rng.normal(scale=1e-3, size=2) / corner
    return Camera(size, [f, f * aspect, *centre, k1, k2, 0.0, *p, 0.0])


def usable(made: Scene) -> bool:
    """A view of at least 12 corners in three rows and columns."""
    xy = made.views[0].xy
    return len(xy) >= 12 and min(len(set(xy[:, 0])), len(set(xy[:, 1]))) >= 3


def problem(seed: int) -> tuple[Scene, list[Observation]]:
    """3 to 40 views, whole or cut by the image's edge, tilted by 5 to 50 degrees, 0 to 1 px."""
    rng = np.random.default_rng(seed)
    lens = camera(rng, SIZES[seed % 3])
    count = int(np.round(np.exp(rng.uniform(np.log(3), np.log(40)))))
    poses: list[Pose] = []
    while len(poses) < count:
        pose = looking(lens, rng, tilt=(5, 50), fill=(0.3, 1.3), roll=30)
        if usable(seen(lens, [pose], partial=True)):
            poses.append(pose)
    made = seen(lens, poses, partial=True)
    return made, made.noisy(rng.choice([0.0, 0.1, 0.3, 1.0]), rng)


def least_cost(made: Scene, views: list[Observation]) -> float:
    """The cost that a solve from the truth ends with."""
    observations = pack_observations(views)
    R = Rotation.from_rotvec(np.array([pose.rvec for pose in made.poses])).as_matrix()
    truth = State(np.array(made.camera.params), R, np.array([pose.tvec for pose in made.poses]))
    cost = build_stage_two(observations, "lucchese", Cost.IMAGE, 1.0, FREE)
    data = float(np.sum(observations.uv**2))
    return minimise(cost, truth, FREE, observations.count, data).normal.cost


def outcome(seed: int) -> Outcome:
    """Calibrate one problem."""
    made, views = problem(seed)
    best = least_cost(made, views)
    try:
        found = calibrate(views, made.size)
    except CalibrationError as error:
        return Outcome(seed, False, False, f"{type(error).__name__}: {error}")
    cost = found.history[-1].cost
    least = cost <= best * (1 + 1e-6) + 1e-12 * made.size[0] ** 2
    converged = found.status is Status.CONVERGED
    words = f"{found.status.value}: {cost:.6g}, from the truth {best:.6g}"
    return Outcome(seed, least and converged, converged and not least, words)

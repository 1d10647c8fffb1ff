"""How far the solve reaches: random cameras, lenses and views, from its own start.

The answer to compare with is the solve that starts at the truth. Both minimise the same cost,
so that the one that ends higher has failed.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from calibgui.engine.calibrate import calibrate
from calibgui.engine.errors import CalibrationError
from calibgui.engine.levenberg_marquardt import minimise
from calibgui.engine.observations import pack
from calibgui.engine.problem import stage_two
from calibgui.engine.stage_two import State
from calibgui.engine.types import Camera, Cost, Observation, Pose, Size, Status
from tests.engine.scenes import Scene, looking, seen

pytestmark = pytest.mark.slow

SIZES: list[Size] = [(640, 480), (4000, 3000), (1920, 1080)]
FREE = np.arange(9)


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
    observations = pack(views)
    R = Rotation.from_rotvec(np.array([pose.rvec for pose in made.poses])).as_matrix()
    truth = State(np.array(made.camera.params), R, np.array([pose.tvec for pose in made.poses]))
    cost = stage_two(observations, "lucchese", Cost.IMAGE, 1.0, FREE)
    data = float(np.sum(observations.uv**2))
    return minimise(cost, truth, FREE, observations.count, data).normal.cost


def test_random_problems_reach_the_minimum() -> None:
    missed = []
    for seed in range(1000, 1120):
        made, views = problem(seed)
        best = least_cost(made, views)
        rounding = 1e-12 * made.size[0] ** 2
        try:
            found = calibrate(views, made.size)
        except CalibrationError as error:
            missed.append((seed, str(error)))
            continue
        cost = found.history[-1].cost
        if cost > best * (1 + 1e-6) + rounding or found.status is not Status.CONVERGED:
            missed.append((seed, f"{found.status}: {cost:.6g} instead of {best:.6g}"))
    # Measured: 5 of 1800, among them pincushion lenses on the brink of folding with 1 px of noise.
    assert len(missed) <= 1, missed

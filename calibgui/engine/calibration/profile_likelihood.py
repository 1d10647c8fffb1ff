"""Profiles: how far a parameter may be off where the cost is no parabola in it.

The covariance sigma^2 (J^T J)^-1 takes the cost for a parabola about its minimum. Few views of a
lens whose parameters can make up for one another lie in a curved valley: of Mei's model, f and xi
grow together along f / (1 + xi), which is known, and the further the valley goes, the flatter it
is. The linear standard deviation is then that of the place where the minimum happens to be, too
small by half where it is short of the truth, and with it the parameter is not said to be open.

The profile of a parameter c is the least cost for each value of it, all others and the poses
estimated again. With sigma_c its standard deviation in the covariance C, board and views included,
and sigma_n that of the corners' noise alone, a parabola has

    cost(c + t sigma_c) - cost(c) = t^2 sigma^2 (sigma_c / sigma_n)^2.

Where the true profile has risen by that of t = 2 at a distance d > 2 sigma_c on one side, the
standard deviation is d / 2: about 2.5 % of the errors lie beyond d there, as is said by 2 sigma
(Bates and Watts 1988, Nonlinear Regression Analysis, 6.1). With s half of the profile's whole step
on its wider side, the others included, and s_c = d / 2 its part along the parameter,

    C + (1 - sigma_c^2 / s_c^2) s s^T

takes the place of C. What is added is positive semidefinite: no combination of parameters becomes
better known than the parabola says. The parameter itself has the variance s_c^2, and the others go
with it as the profile does. Where the valley is straight, s is s_c / sigma_c^2 times the column of
C that belongs to the parameter: its variance alone is replaced, and what is left open once it is
given stays as it is. As s_c comes down to sigma_c, nothing is left to add. The poses follow as in
the linear solution, dp_k = G_k dc, so that (s, G s) widens camera and poses together: their
covariance remains positive definite, whatever board and views have added to the poses before.

(To replace the parabola's c c^T / sigma_c^2 by s s^T, with c that column, is not sound: where the
valley bends it makes combinations better known, and a pose's variance can become negative.)

A profile that does not rise so far before its parameter is of no use leaves that parameter open on
one side, and those that go with it beyond their bounds.

Only the parameter that is known worst is followed, for its use, and only where it is known poorly:
where sigma_c is small, the valley is straight.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.methods.method import Problem
from calibgui.engine.calibration.partial.degeneracy import find_traded_focal_lengths
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError, minimise
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Cost, Undetermined
from calibgui.engine.camera.models import PINHOLE, find_model

_MIN_TOLERATED_SHARE = 0.1
"""Standard deviation, as a share of what any use tolerates (a tenth of the focal length), from
which the profile is followed."""
_LEVEL = 2.0
"""Height at which a profile's width is taken, in standard deviations."""
_LEVEL_TOLERANCE = 0.1
"""Distance from that height which is near enough: a twentieth of the width."""
_MAX_STEPS = 6
"""Number of steps along a side of a profile, at most."""
_MAX_LENGTHENING = 3.0
"""Factor by which a step along the profile is lengthened at once, at most."""
_MAX_ITERATIONS = 50
"""Number of iterations of each solve, at most."""
_MAX_HALVINGS = 2
"""Number of times that a step along the profile is halved where no camera has its images."""
_REASON = "the corners leave it open on one side"
"""Why a parameter is undetermined whose profile does not rise."""


class _Point(NamedTuple):
    """A point of a profile."""

    distance: float
    """Distance of the parameter from the minimum."""
    state: State
    """The camera and poses of least cost there."""
    height: float
    """Height above the minimum, in standard deviations."""


def add_profile_width(estimate: Estimate, problem: Problem, tolerated: Array) -> Estimate:
    """Widen an estimate where its cost rises more slowly than a parabola.

    Args:
        estimate: the estimate with the image cost, with all that its covariance counts, for a board
            whose shape is not estimated.
        problem: the problem that it solves.
        tolerated: (P,) standard deviations beyond which the free parameters count as undetermined.

    Returns:
        The estimate, whose undetermined parameters include those that are open on one side. A
        coordinate of the centre is not among them, nor a focal length that no coefficient makes up
        for: what these cameras image is open as well, which their widened standard deviations say.
    """
    free, covariance = problem.free, estimate.camera_covariance
    sigma = np.sqrt(np.diag(covariance))
    shares = np.where(np.diag(estimate.noise_covariance) > 0, sigma / tolerated, 0.0)
    if not shares.max(initial=0.0) > _MIN_TOLERATED_SHARE:  # also if one is NaN
        return estimate
    if find_model(problem.model).control_points is not None:
        return estimate  # a prior holds what the corners leave open
    i = int(np.argmax(shares))
    profile = _Profile(estimate, problem, i, float(tolerated[i]))
    is_followed = np.zeros(len(free), dtype=bool)
    halves: list[Array] = []
    for sign in (1.0, -1.0):
        end = profile.follow(sign)
        step = end.state.params[free] - estimate.state.params[free]
        if end.height < _LEVEL - _LEVEL_TOLERANCE:  # the others go beyond their bounds with it
            is_followed |= np.abs(step) > _LEVEL * np.minimum(sigma, 0.99 * tolerated)
        halves.append(sign * step / max(end.height, _LEVEL))
    widest = max(halves, key=lambda half: float(half[i]))
    if widest[i] > sigma[i]:
        estimate = _widen(estimate, i, widest, profile.poses_by_camera)
    names, camera = np.array(problem.free_parameters), problem.make_camera(estimate.state)
    traded = find_traded_focal_lengths(camera, problem.free_parameters, covariance)
    is_bounded = np.isin(names, [name for name in PINHOLE if name not in traded])
    if is_bounded[i]:
        return estimate
    opened = names[is_followed & ~is_bounded].tolist()
    undetermined = {name: Undetermined(name, _REASON) for name in opened}
    undetermined |= {u.name: u for u in estimate.undetermined}
    return estimate._replace(undetermined=tuple(undetermined.values()))


def _widen(estimate: Estimate, i: int, half: Array, poses_by_camera: Array) -> Estimate:
    """Widen an estimate to where a step (P,) is one standard deviation along parameter i."""
    covariance = estimate.camera_covariance
    added = (1 - covariance[i, i] / half[i] ** 2) * np.outer(half, half)
    by_poses = poses_by_camera @ added @ np.swapaxes(poses_by_camera, 1, 2)
    return estimate._replace(
        camera_covariance=covariance + added,
        pose_covariances=estimate.pose_covariances + by_poses,
    )


class _Profile:
    """The least cost for each value of one parameter of the camera."""

    def __init__(self, estimate: Estimate, problem: Problem, i: int, tolerated: float) -> None:
        """Take the index of a free parameter, and the standard deviation that is tolerated."""
        normal, noise = estimate.solution.normal, estimate.noise_covariance
        variance = estimate.camera_covariance[i, i]
        self.estimate, self.free = estimate, problem.free
        self.others = np.delete(problem.free, i)
        self.normal_at = build_stage_two(
            estimate.observations, problem.model, Cost.IMAGE, problem.scale, self.others
        )
        self.along = noise[:, i] / noise[i, i]
        """(P,) change of the free parameters with this one."""
        self.poses_by_camera: Array = np.asarray(
            -np.linalg.solve(normal.V, np.swapaxes(normal.W, 1, 2)), dtype=np.float64
        )
        """(K, 6, P) change of the poses with the free parameters."""
        self.unit = float(estimate.sigma2 * variance / noise[i, i])
        """Rise of the cost at one standard deviation, if it is a parabola."""
        self.first = _LEVEL * float(np.sqrt(variance))
        self.farthest = max(self.first, _LEVEL * tolerated)

    def follow(self, sign: float) -> _Point:
        """Follow the profile to one side until it is as high as `_LEVEL`, or too far."""
        point, distance = _Point(0.0, self.estimate.state, 0.0), self.first
        for _ in range(_MAX_STEPS):
            found = self._step_to(sign * distance, point)
            if found is None:  # no camera has its images there: the side ends before
                return point._replace(height=np.inf)
            point = found
            if point.height >= _LEVEL - _LEVEL_TOLERANCE or distance >= self.farthest:
                break
            longer = min(_LEVEL / max(point.height, 1e-9), _MAX_LENGTHENING)
            distance = min(distance * longer, self.farthest)
        return point

    def _step_to(self, distance: float, point: _Point, halvings: int = 0) -> _Point | None:
        """Find the point of the profile at a distance, from another; None if there is none."""
        by_camera = (distance - point.distance) * self.along
        start = point.state.take_step(by_camera, self.poses_by_camera @ by_camera, self.free)
        views = self.estimate.observations
        data = float(np.sum(views.uv**2))
        try:
            solution = minimise(
                self.normal_at, start, self.others, views.count, data, None, _MAX_ITERATIONS
            )
        except StartError:
            if halvings == _MAX_HALVINGS:
                return None
            halfway = self._step_to((distance + point.distance) / 2, point, halvings + 1)
            return halfway and self._step_to(distance, halfway, halvings + 1)
        rise = max(solution.normal.total_cost - self.estimate.solution.normal.total_cost, 0.0)
        return _Point(distance, solution.state, float(np.sqrt(rise / self.unit)))

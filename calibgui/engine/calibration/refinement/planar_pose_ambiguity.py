"""The two poses of a plane: views that were solved in the mirrored one, found and corrected.

Far away, a plane looks alike from two sides (Schweighofer and Pinz 2006;
``geometry.planar_pose``). Both poses can be minima of the view's cost, and a start with a wrong
focal length or principal point can end in the wrong one.

A view in the wrong pose has residuals of the size of the perspective that it denies. The misses of
the outermost corners under the mirrored pose show that size, and only views whose own residuals
are not far below it are tried in the mirrored pose. If the lens of the wrong camera folds before
the corners of the right pose, that pose is tried on the reference plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration.observations import Observations, group_equal_boards
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.geometry.planar_pose import mirror_planar_poses

_MAX_MISS_RATIO = 30.0
"""Miss of the outermost corners in the mirrored pose, over the view's own residuals, beyond which
the pose is certain."""
_MIN_GAIN = 1e-6
"""Decrease of a view's cost, relative to it, from which the mirrored pose is better."""
_MAX_ITERATIONS = 30
"""Number of iterations of the refinement of mirrored poses, at most."""
_DIAGONALS = np.array([[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]])
_NONE_FREE: IntArray = np.zeros(0, dtype=np.int64)

BuildProblem = Callable[[Observations, IntArray], NormalAt]
"""A function from views and the indices of free camera parameters to Stage II's problem."""


def correct_mirrored_poses(
    build_problem: BuildProblem,
    build_registration: BuildProblem,
    observations: Observations,
    solution: Solution,
) -> State | None:
    """Return the solution's state with those poses mirrored that fit better so; None if none do.

    Args:
        build_problem: builds the problem that the solution minimises.
        build_registration: builds the same problem on the reference plane.
        observations: the views.
        solution: the solution to check.
    """
    mirrored = mirror_poses(solution.state, observations)
    views = _find_uncertain_views(build_problem, observations, solution, mirrored)
    if not views.size:
        return None
    sample, poses = observations.select_views(views), mirrored.select_views(views)
    imaged = np.isfinite(build_problem(sample, _NONE_FREE)(poses).costs)
    R, T = solution.state.R.copy(), solution.state.T.copy()
    has_changed = False
    # The lens of a wrong camera can fold before the corners of the right pose.
    for build, chosen in ((build_problem, imaged), (build_registration, ~imaged)):
        which, part = views[chosen], sample.select_views(chosen)
        if not which.size:
            continue
        before = build(part, _NONE_FREE)(solution.state.select_views(which)).costs
        try:
            found = _refine_poses(build, part, poses.select_views(chosen))
        except StartError:
            continue
        better = found.normal.costs < (1 - _MIN_GAIN) * before
        R[which[better]], T[which[better]] = found.state.R[better], found.state.T[better]
        has_changed |= bool(better.any())
    return State(solution.state.params, R, T) if has_changed else None


def _refine_poses(build_problem: BuildProblem, views: Observations, poses: State) -> Solution:
    """Minimise the cost from these poses, with the camera as it is."""
    data = float(np.vdot(views.uv, views.uv))
    return minimise(
        build_problem(views, _NONE_FREE),
        poses,
        _NONE_FREE,
        views.count,
        data,
        max_iterations=_MAX_ITERATIONS,
    )


def mirror_poses(state: State, observations: Observations) -> State:
    """Return the state with every board mirrored about the middle of its corners."""
    weight = observations.mask / observations.mask.sum(axis=1, keepdims=True)
    middle = (weight[:, None] @ observations.xy)[:, 0]
    return State(state.params, *mirror_planar_poses(state.R, state.T, middle))


def _find_uncertain_views(
    build_problem: BuildProblem, observations: Observations, solution: Solution, mirrored: State
) -> IntArray:
    """Return the numbers of the views whose residuals do not exclude the mirrored pose."""
    first, like = group_equal_boards(observations)
    places = np.argmax(observations.xy[first, :, :2] @ _DIAGONALS, axis=1)[like]
    views = np.arange(len(places))[:, None]
    weight = observations.whitening
    outermost = replace(
        observations,
        uv=observations.uv[views, places],
        xy=observations.xy[views, places],
        mask=np.ones(places.shape),
        cov=None,
        whitening=None if weight is None else weight[views, places],
    )
    missed = build_problem(outermost, _NONE_FREE)(mirrored).costs / places.shape[1]
    own = solution.normal.costs / observations.mask.sum(axis=1)
    return np.flatnonzero(missed < _MAX_MISS_RATIO**2 * own)

"""The two poses of a plane: views that were solved in the mirrored one, found and corrected.

Far away, a plane looks alike from two sides (Schweighofer and Pinz 2006;
``geometry.planar_pose``). Both poses can be minima of the view's cost, and a start with a wrong
focal length or principal point can end in the wrong one.

A view in the wrong pose has residuals of the size of the perspective that it denies. What cost c a
mirrored pose would come down to is known without refining it: it lies so near to its minimum that
one step of Gauss and Newton leads there, to c - g^T V^-1 g with the gradient g and the block V of
the normal equations, to some hundredths (tested). Only where that is not far above the view's own
cost the mirrored pose is tried. If the lens of the wrong camera folds before the corners of the
right pose, that pose is tried on the reference plane.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.refinement.schur import NormalEquations, invert_roots
from calibgui.engine.geometry.planar_pose import mirror_planar_poses

_MAX_COST_RATIO = 1.5
"""Cost that the mirrored pose comes down to, over the view's own, beyond which the pose is certain:
a choice, as that of a better pose is below 1 and known to some hundredths."""
_MIN_GAIN = 1e-6
"""Decrease of a view's cost, relative to it, from which the mirrored pose is better."""
_MAX_ITERATIONS = 30
"""Number of iterations of the refinement of mirrored poses, at most."""
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
    reached = _predict_costs(build_problem(observations, _NONE_FREE)(mirrored))
    # An unknown cost is none that makes the view's own pose certain.
    views = np.flatnonzero(~(reached > _MAX_COST_RATIO * solution.normal.costs))
    if not views.size:
        return None
    sample, poses = observations.select_views(views), mirrored.select_views(views)
    imaged = np.isfinite(reached[views])
    R, T = solution.state.R.copy(), solution.state.T.copy()
    has_changed = False
    # The lens of a wrong camera can fold before the corners of the right pose.
    for build, chosen in ((build_problem, imaged), (build_registration, ~imaged)):
        which, part = views[chosen], sample.select_views(chosen)
        if not which.size:
            continue
        own, start = solution.state.select_views(which), poses.select_views(chosen)
        before = build(part, _NONE_FREE)(own).costs
        try:
            found = _refine_poses(build, part, start)
        except StartError:
            continue
        # One that comes back to the view's own pose is no other: it is that pose in more digits.
        is_other = _measure_turns(found.state, start) < _measure_turns(found.state, own)
        better = is_other & (found.normal.costs < (1 - _MIN_GAIN) * before)
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


def _measure_turns(first: State, second: State) -> Array:
    """Return (K,) how far the rotations of two states are apart, by the length of R - R'."""
    return np.asarray(np.linalg.norm(first.R - second.R, axis=(1, 2)))


def mirror_poses(state: State, observations: Observations) -> State:
    """Return the state with every board mirrored about the middle of its corners."""
    weight = observations.mask / observations.mask.sum(axis=1, keepdims=True)
    middle = (weight[:, None] @ observations.xy)[:, 0]
    return State(state.params, *mirror_planar_poses(state.R, state.T, middle))


def _predict_costs(normal: NormalEquations) -> Array:
    """Return (K,) the cost of each view after a step of its pose; NaN for views with no image."""
    imaged = np.isfinite(normal.costs)
    V = np.where(imaged[:, None, None], normal.V, np.eye(6))
    try:
        step = invert_roots(V) @ normal.pose[..., None]
    except np.linalg.LinAlgError:  # a board so far away that its corners leave its pose open
        return np.where(imaged, 0.0, np.nan)
    return np.where(imaged, normal.costs - np.sum(step[..., 0] ** 2, axis=1), np.nan)

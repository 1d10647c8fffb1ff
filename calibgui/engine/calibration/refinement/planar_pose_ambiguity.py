"""Tilts that were taken for their mirror images, found after a solve.

Far away, a plane looks alike from two sides: only perspective tells a tilt from its mirror
image. With v the direction to the middle of the corners, the plate

    R' = (I - 2 v v^T) R diag(1, 1, -1),     the middle of the corners where it was,

has the depths of its points along v reversed and everything across v unchanged. Each of the
two can be a minimum of the view's cost, and a start with a wrong focal length or principal
point can lie by the wrong one.

A view that is by the wrong one has residuals of the size of the perspective that it denies.
What the outermost corners miss by under the mirrored pose says what that size is, and only
views whose own residuals are not far below it are tried the other way round. Where the lens of
the wrong camera folds before the corners of the right tilt, that is tried on the reference plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration.observations import Observations, boards
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalAt

_DOUBTFUL = 30.0
"""What the outermost corners miss by when mirrored, over the view's own residuals, beyond which
there is no doubt."""
_BETTER = 1e-6
"""Decrease of a view's cost by mirroring, relative, that is one."""
_ITERATIONS = 30
_OUTWARDS = np.array([[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]])
_NONE_FREE: IntArray = np.zeros(0, dtype=np.int64)

ProblemOf = Callable[[Observations, IntArray], NormalAt]
"""Stage II's problem of some views and of the camera's parameters that may move."""


def righted(
    problem: ProblemOf, registration: ProblemOf, observations: Observations, solution: Solution
) -> State | None:
    """The solution's state with the tilts mirrored that fit better so; None if there are none.

    Args:
        problem: what the solution minimises.
        registration: the same on the reference plane.
        observations: the views.
        solution: to be checked.
    """
    turned = mirrored(solution.state, observations)
    views = _doubtful(problem, observations, solution, turned)
    some, poses = observations.part(views), turned.part(views)
    imaged = np.isfinite(problem(some, _NONE_FREE)(poses).costs)
    R, T = solution.state.R.copy(), solution.state.T.copy()
    turned_any = False
    # The lens of a wrong camera can fold before the corners of the right tilt.
    for stage, chosen in ((problem, imaged), (registration, ~imaged)):
        which, part = views[chosen], some.part(chosen)
        if not which.size:
            continue
        before = stage(part, _NONE_FREE)(solution.state.part(which)).costs
        try:
            found = _settled(stage, part, poses.part(chosen))
        except StartError:
            continue
        better = found.normal.costs < (1 - _BETTER) * before
        R[which[better]], T[which[better]] = found.state.R[better], found.state.T[better]
        turned_any |= bool(better.any())
    return State(solution.state.params, R, T) if turned_any else None


def _settled(problem: ProblemOf, views: Observations, poses: State) -> Solution:
    """The best poses near these, with the camera as it is."""
    data = float(np.sum(views.uv**2))
    return minimise(
        problem(views, _NONE_FREE), poses, _NONE_FREE, views.count, data, max_iterations=_ITERATIONS
    )


def mirrored(state: State, observations: Observations) -> State:
    """The state with every plate's depths reversed along the ray to the middle of its corners."""
    weight = observations.mask / observations.mask.sum(axis=1, keepdims=True)
    middle = (weight[:, None] @ observations.xy).swapaxes(1, 2)
    axes = middle.shape[1]
    centre = state.R[..., :axes] @ middle + state.T[..., None]
    v = centre / np.linalg.norm(centre, axis=1, keepdims=True)
    R = (state.R - 2 * v @ (v.swapaxes(1, 2) @ state.R)) * np.array([1.0, 1.0, -1.0])
    return State(state.params, R, (centre - R[..., :axes] @ middle)[..., 0])


def _doubtful(
    problem: ProblemOf, observations: Observations, solution: Solution, turned: State
) -> IntArray:
    """Numbers of the views whose residuals do not exclude the mirrored pose."""
    first, like = boards(observations)
    places = np.argmax(observations.xy[first, :, :2] @ _OUTWARDS, axis=1)[like]
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
    missed = problem(outermost, _NONE_FREE)(turned).costs / places.shape[1]
    own = solution.normal.costs / observations.mask.sum(axis=1)
    return np.flatnonzero(missed < _DOUBTFUL**2 * own)

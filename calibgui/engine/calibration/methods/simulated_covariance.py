"""The covariance of an estimate that is not the minimum of a cost, by simulation.

A closed form has no normal equations of its own. Its camera and poses are taken for the truth, the
corners are predicted, noise of the residuals' standard deviation is added (independent from corner
to corner, seeded), and the method is run again; the scatter of many such estimates is its
covariance (the parametric bootstrap, Efron 1979). It does not measure the method's bias: an
ideal lens assumed for a distorted one makes the residuals large and the scatter with them, but
the value may be off by more.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.methods.method import Problem, subtract_states
from calibgui.engine.calibration.refinement import residuals
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.errors import CalibrationError

_DRAWS = 50
"""Number of simulations: the standard deviations are then good to 10 %."""


def simulate_covariances(estimate: Estimate, problem: Problem, free: IntArray) -> Estimate:
    """Return an estimate with the covariances of its method's scatter.

    They are NaN where the method fails on more than half of the simulated corners.

    Args:
        estimate: the estimate, in the image's px.
        problem: the problem as it was stated, without values that the method chose.
        free: indices of the parameters that the method has estimated.
    """
    observations, state = estimate.observations, estimate.state
    miss = residuals.compute_misses(state, observations, problem.model, problem.cost)
    predicted = observations.uv - miss
    rng = np.random.default_rng(0)
    steps = []
    for _ in range(_DRAWS):
        noise = rng.normal(scale=np.sqrt(estimate.sigma2), size=predicted.shape)
        with suppress(CalibrationError):
            views = replace(observations, uv=predicted + noise)
            drawn = replace(problem, observations=views, max_iterations=0)
            start = drawn.method.initialise(drawn)
            drawn = replace(drawn, held=start.held)
            found = drawn.method.refine(drawn, start.state, None).solution.state
            steps.append(_measure_step(state, found))
    if len(steps) <= _DRAWS // 2:
        steps = [np.full_like(steps[0] if steps else _measure_step(state, state), np.nan)] * 2
    P = len(state.params)
    scatter = np.array(steps)
    scatter -= scatter.mean(axis=0)
    camera = scatter[:, free].T @ scatter[:, free] / (len(scatter) - 1)
    poses = scatter[:, P:].reshape(len(scatter), -1, 6)
    return estimate._replace(
        camera_covariance=camera,
        noise_covariance=camera,
        pose_covariances=np.einsum("nki,nkj->kij", poses, poses) / (len(scatter) - 1),
    )


def _measure_step(a: State, b: State) -> Array:
    """Return the change from state a to b: parameters, then (w, tau) of each view."""
    by_shared, by_pose = subtract_states(b, a)
    return np.concatenate([by_shared, by_pose.ravel()])

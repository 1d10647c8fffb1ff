"""Partial calibration: what degenerate views tell of a camera, with as little assumed as possible.

Views that do not determine a camera mostly leave few combinations of its parameters open. Those are
assumed at ordinary values, and all others are estimated.

Assumptions. Every quantity q_i of ``reparametrisation.py`` has a nominal value and a prior standard
deviation d_i: what is known of cameras beforehand. Let S be the information of the views on q once
the poses are eliminated (``refinement/schur.py``), over the variance of the noise. The eigenvalues
of

    D S D,      D = diag(d),

tell how many times smaller the data's variance is than the prior's, direction by direction. As
long as the least is below `_MIN_VARIANCE_RATIO`, the quantity with the largest part in its
eigenvector is assumed at its nominal value, and its row and column are struck out. Solve and choice
alternate, beginning with everything assumed, until they agree.

Uncertainty. With the assumed quantities h off by dh, the others o come out off by
-Soo^-1 Soh dh, so that (the consider covariance, Schmidt 1966)

    cov(o, o) = Soo^-1 + B D^2 B^T,   cov(o, h) = B D^2,   cov(h, h) = D^2,   B = -Soo^-1 Soh.

It is carried to the camera's parameters and poses: ± includes what the assumptions may be off by.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.methods.method import Problem
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.partial.reparametrisation import Quantities, reparametrise
from calibgui.engine.calibration.refinement import covariances, residuals
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import (
    BuildProblem,
    correct_mirrored_poses,
)
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.refinement.schur import eliminate_poses
from calibgui.engine.calibration.result import Assumption, Cost, Status
from calibgui.engine.camera.models import find_model
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_MIN_VARIANCE_RATIO = 9.0
"""Ratio of variances, prior over data, below which a quantity is assumed at its nominal value."""
_PRIOR_FOCAL = 0.5
"""Prior standard deviation of the focal length, as a share of it."""
_PRIOR_ASPECT = 0.01
"""Prior standard deviation of the ratio of focal lengths."""
_PRIOR_CENTRE = 0.05
"""Prior standard deviation of the principal point, in image widths."""
_PRIOR_RADIAL, _PRIOR_DECENTRING = 0.3, 0.005
"""Prior standard deviation of what a coefficient moves the image's corner by, as a share of the
corner's distance from the centre."""
_MIN_FOCAL, _MAX_FOCAL = 0.2, 10.0
"""Focal lengths, in image widths, beyond which a solution is no camera's."""
_MIN_NOISE = 1e-4
"""Least standard deviation of a residual that is believed, px: rounding is not information."""
_MAX_ROUNDS = 8
"""Number of rounds of solve and choice after which the search ends."""
_ROUNDS_WITH_RELEASE = 4
"""Number of rounds after which quantities are still assumed, but no longer released."""


class _Fit(NamedTuple):
    """A solution whose choice of assumptions no further round changes."""

    solution: Solution
    estimated: IntArray
    """Indices of the quantities that are not assumed."""
    S: Array
    """Information of the views on the quantities that the user leaves free, over the noise's
    variance."""
    prior: Array
    """Prior standard deviations of the same quantities."""
    sigma2: float
    """Variance of one residual coordinate."""


class PartialEstimate(NamedTuple):
    """An estimate in which some quantities are assumed."""

    estimate: Estimate
    assumptions: tuple[Assumption, ...]


def estimate_partially(
    observations: Observations, originals: IntArray, problem: Problem, known: Array
) -> PartialEstimate | None:
    """Estimate what the views determine; None if that is not even their poses.

    Args:
        observations: the views.
        originals: (K,) index of the first view that each one copies, or its own: copies count once.
        problem: the problem, with values for what is held.
        known: (P,) the camera's parameters as far as they are known, for another start.
    """
    free, names = problem.free, problem.parameters
    distinct, copy = np.unique(originals, return_inverse=True)
    part = observations.select_views(distinct)
    fits = [
        fit
        for q in _list_starts(problem, known)
        if (fit := _solve_and_choose(part, problem, q)) is not None
    ]
    if not fits:
        return None
    fit = min(
        fits,
        key=lambda fit: (not _has_ordinary_focal_length(fit, problem), fit.solution.normal.cost),
    )
    solution, quantities, q = (
        fit.solution,
        Quantities.of_problem(problem),
        fit.solution.state.params,
    )
    held = ~np.isin(free, fit.estimated)
    J = quantities.differentiate(q)[np.ix_(free, free)]
    camera, by_noise = (J @ c @ J.T for c in compute_consider_covariances(fit.S, fit.prior, held))
    state = State(quantities.to_params(q), solution.state.R[copy], solution.state.T[copy])
    normal = residuals.build_stage_two(
        observations, problem.model, problem.cost, problem.scale, free
    )(state)
    status = Status.PARTIAL if solution.status is Status.CONVERGED else solution.status
    spread = covariances.compute_pose_covariances(eliminate_poses(normal), camera, fit.sigma2)
    solution = Solution(state, normal, solution.history, status)
    estimate = Estimate(solution, state, observations, fit.sigma2, camera, spread, by_noise)
    held_priors = zip(free[held].tolist(), fit.prior[held].tolist(), strict=True)
    assumptions = (
        Assumption(quantities.name_of(i, names), float(q[i]), sigma) for i, sigma in held_priors
    )
    return PartialEstimate(estimate, tuple(assumptions))


def _list_starts(problem: Problem, known: Array) -> list[Array]:
    """List the values (P,) of q to start from.

    They are the nominal ones, and the same with the ratio of focal lengths that is known: a plane
    tilted far away looks like one seen with another ratio.
    """
    quantities = Quantities.of_problem(problem)
    nominal = _make_nominal(problem)
    other = nominal.copy()
    other[1 - quantities.base] = quantities.from_params(known)[1 - quantities.base]
    return [nominal, other]


def _solve_and_choose(part: Observations, problem: Problem, q: Array) -> _Fit | None:
    """Solve and choose assumptions in turns, with everything assumed at first.

    Args:
        part: the views.
        problem: the problem, with values for what is held.
        q: (P,) the quantities to start from.
    """
    quantities, free = Quantities.of_problem(problem), problem.free

    def build_problem(views: Observations, free: IntArray, cost: Cost = problem.cost) -> NormalAt:
        every = np.arange(len(q))
        normal_at = residuals.build_stage_two(views, problem.model, cost, problem.scale, every)
        return reparametrise(normal_at, quantities, free)

    def build_registration(views: Observations, free: IntArray) -> NormalAt:
        return build_problem(views, free, Cost.REFERENCE)

    flat = replace(part, xy=part.xy[..., :2])
    M = closed_form.fit_homographies(flat, q[2:4], 0.0)
    state = State(q, *poses_from_homographies(M, quantities.to_params(q)[:2], flat.xy[:, 0]))
    nominal, assumed = _make_nominal(problem), free
    for turn in range(_MAX_ROUNDS):
        estimated = np.setdiff1d(free, assumed)
        try:
            solution = _solve(build_problem, build_registration, part, state, estimated)
        except StartError:
            return None
        unknowns = len(estimated) + solution.normal.pose.size
        sigma2 = covariances.estimate_variance(solution.normal.cost, part.count, unknowns)
        if not np.isfinite(sigma2):
            return None
        sigma2 = max(sigma2, _MIN_NOISE**2)
        S = eliminate_poses(build_problem(part, free)(solution.state)).S / sigma2
        prior = _compute_priors(quantities, solution.state.params, problem.size)[free]
        chosen = free[choose_assumed(S, prior)]
        if turn >= _ROUNDS_WITH_RELEASE:
            chosen = np.union1d(chosen, assumed)
        if np.array_equal(chosen, assumed):
            break
        q, assumed = solution.state.params.copy(), chosen
        q[assumed] = nominal[assumed]
        state = solution.state._replace(params=q)
    return _Fit(solution, estimated, S, prior, sigma2)


def _has_ordinary_focal_length(fit: _Fit, problem: Problem) -> bool:
    """Return whether the focal length is one that cameras have."""
    f = fit.solution.state.params[Quantities.of_problem(problem).base] / problem.size[0]
    return bool(_MIN_FOCAL < f < _MAX_FOCAL)


def find_poorly_known(params: Array, covariance: Array, problem: Problem) -> list[str]:
    """Find the focal lengths and coordinates of the centre known hardly better than beforehand.

    Args:
        params: (P,) the camera's parameters.
        covariance: covariance of the free parameters.
        problem: the problem, with values for what is held.
    """
    prior = np.append(_PRIOR_FOCAL * params[:2], [_PRIOR_CENTRE * problem.size[0]] * 2)
    limit = dict(zip(problem.parameters[:4], prior / np.sqrt(_MIN_VARIANCE_RATIO), strict=True))
    sigma = np.sqrt(np.diag(covariance))
    known = zip(problem.free_parameters, sigma, strict=True)
    return [n for n, s in known if n in limit and s > limit[n]]


def choose_assumed(S: Array, prior: Array) -> IntArray:
    """Choose the quantities to assume; return their indices, ascending.

    Args:
        S: (P, P) information on the quantities over the variance of the noise.
        prior: (P,) prior standard deviations of their nominal values.
    """
    left = np.arange(len(prior))
    while left.size:
        values, vectors = np.linalg.eigh((S * np.outer(prior, prior))[np.ix_(left, left)])
        if values[0] >= _MIN_VARIANCE_RATIO:
            break
        left = np.delete(left, int(np.argmax(np.abs(vectors[:, 0]))))
    return np.setdiff1d(np.arange(len(prior)), left)


def compute_consider_covariances(S: Array, prior: Array, held: BoolArray) -> tuple[Array, Array]:
    """Compute covariances (P, P) with and without the errors of the quantities that are assumed.

    Args:
        S, prior: as in `choose_assumed`.
        held: (P,) true for a quantity that is assumed.
    """
    free = ~held
    unit = np.diag(prior[free])
    inverse = unit @ np.linalg.inv(unit @ S[np.ix_(free, free)] @ unit) @ unit
    motion = np.zeros((len(prior), np.count_nonzero(held)))
    motion[free] = -inverse @ S[np.ix_(free, held)]
    motion[held] = np.eye(motion.shape[1])
    by_noise = np.zeros_like(S)
    by_noise[np.ix_(free, free)] = inverse
    by_prior = motion * prior[held]
    return by_noise + by_prior @ by_prior.T, by_noise


def _solve(
    build_problem: BuildProblem,
    build_registration: BuildProblem,
    views: Observations,
    start: State,
    free: IntArray,
) -> Solution:
    """Find the minimum, with poses mistaken for their mirror images corrected once."""
    data = float(np.sum(views.uv**2))
    solution = minimise(build_problem(views, free), start, free, views.count, data)
    turned = correct_mirrored_poses(build_problem, build_registration, views, solution)
    if turned is None:
        return solution
    try:
        return minimise(
            build_problem(views, free), turned, free, views.count, data, earlier=solution.history
        )
    except StartError:  # the lens folds there: the camera is still too far off to decide
        return solution


def _make_nominal(problem: Problem) -> Array:
    """Make q (P,) of an ordinary camera: f of an image width, square pixels, no distortion."""
    cx, cy = frames.centre_of_array(problem.size).tolist()
    held, width = problem.settings.fixed, float(problem.size[0])
    nominal = {"fx": held.get("fy", width), "fy": held.get("fx", width), "cx": cx, "cy": cy}
    lens = find_model(problem.model)
    nominal |= dict(zip(lens.names, lens.defaults, strict=True)) | dict(held)
    return Quantities.of_problem(problem).from_params(
        np.array([nominal[name] for name in problem.parameters])
    )


def _compute_priors(quantities: Quantities, q: Array, size: Size) -> Array:
    """Compute the prior standard deviations (P,) of the nominal values."""
    radius = np.hypot(*size) / 2
    prior = np.empty(len(q))
    prior[quantities.base], prior[1 - quantities.base] = (
        _PRIOR_FOCAL * q[quantities.base],
        _PRIOR_ASPECT,
    )
    prior[2:4] = _PRIOR_CENTRE * size[0]
    moved = np.where(quantities.powers == 1, _PRIOR_DECENTRING, _PRIOR_RADIAL)
    prior[4:] = moved / radius**quantities.powers
    return prior

"""What views that do not determine a camera still say of it, with as little assumed as possible.

What to assume. Every quantity q_i of ``quantities.py`` has a nominal value and a doubt d_i about
it, one standard deviation: what is known of cameras beforehand. Let S be the information of the
views on q once the poses are eliminated (``arrow.py``), over the variance of the noise. The
eigenvalues of

    D S D,      D = diag(d),

say how many times smaller the data's variance is than the doubt's, direction by direction. As
long as the least is below `_KNOWN_BETTER`, the quantity with the largest part in its eigenvector is
assumed at its nominal value, and its row and column are struck out. Solve and choice alternate,
beginning with everything assumed, until they agree.

Uncertainty. With the assumed quantities h off by dh, the others o come out off by
-Soo^-1 Soh dh, so that (Schmidt's consider covariance)

    cov(o, o) = Soo^-1 + B D^2 B^T,   cov(o, h) = B D^2,   cov(h, h) = D^2,   B = -Soo^-1 Soh.

It is carried to the camera's parameters and poses: ± includes what the assumptions may be off by.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.partial.reparametrisation import Quantities, in_quantities
from calibgui.engine.calibration.refinement import normal_equations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import ProblemOf, righted
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalAt, schur
from calibgui.engine.calibration.result import Assumed, Cost, Status
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.geometry import frames, rotations

_KNOWN_BETTER = 9.0
"""Ratio of variances, doubt over data, below which a nominal value is kept."""
_FOCAL = 0.5
"""Doubt about the focal length, of itself."""
_ASPECT = 0.01
"""Doubt about the ratio of focal lengths."""
_CENTRE = 0.05
"""Doubt about the principal point, in image widths."""
_RADIAL, _DECENTRED = 0.3, 0.005
"""Doubt about coefficients: what they move the image's corner by, of its distance."""
_LEAST, _MOST = 0.2, 10.0
"""Focal lengths of cameras, in image widths."""
_NOISE = 1e-4
"""Least standard deviation of a residual, px: rounding is not information."""
_ROUNDS = 8
"""Of solve and choice, at the most."""
_FREELY = 4
"""Rounds after which quantities are assumed, but no longer released."""


class _Fit(NamedTuple):
    """A solve of which it is agreed what is assumed."""

    solution: Solution
    estimated: IntArray
    """Places of the quantities that are not assumed."""
    S: Array
    """Information of the views on all that the user leaves free, over the noise's variance."""
    doubt: Array
    """Of the same quantities."""
    sigma2: float


class Partial(NamedTuple):
    """An estimate in which some quantities are assumed."""

    estimate: Estimate
    assumed: tuple[Assumed, ...]


def estimate_partly(
    observations: Observations, like: IntArray, asked: Options, known: Array
) -> Partial | None:
    """Estimate what the views determine; None if that is not even their poses.

    Args:
        observations: the views.
        like: (K,) of each view itself or the first that it is a copy of: copies count once.
        asked: of the views.
        known: (P,) the camera's parameters as far as they are known, for another start.
    """
    free, names = asked.free, asked.names
    distinct, copy = np.unique(like, return_inverse=True)
    part = observations.part(distinct)
    fits = [fit for q in _starts(asked, known) if (fit := _settled(part, asked, q)) is not None]
    if not fits:
        return None
    fit = min(fits, key=lambda fit: (not _credible(fit, asked), fit.solution.normal.cost))
    solution, quantities, q = fit.solution, Quantities.of(asked), fit.solution.state.params
    held = ~np.isin(free, fit.estimated)
    J = quantities.jacobian(q)[np.ix_(free, free)]
    camera, by_noise = (J @ c @ J.T for c in considered(fit.S, fit.doubt, held))
    state = State(quantities.params(q), solution.state.R[copy], solution.state.T[copy])
    normal = normal_equations.stage_two(observations, asked.model, asked.cost, asked.scale, free)(
        state
    )
    status = Status.PARTIAL if solution.status is Status.CONVERGED else solution.status
    rvecs = rotations.rotation_vector(state.R)
    spread = covariances.pose_covariances(normal, camera, rvecs, fit.sigma2)
    solution = Solution(state, normal, solution.history, status)
    estimate = Estimate(solution, state, observations, fit.sigma2, camera, spread, by_noise)
    told = zip(free[held].tolist(), fit.doubt[held].tolist(), strict=True)
    assumed = (Assumed(quantities.name(i, names), float(q[i]), doubt) for i, doubt in told)
    return Partial(estimate, tuple(assumed))


def _starts(asked: Options, known: Array) -> list[Array]:
    """Values (P,) of q to begin with: the nominal ones, and with the ratio of focal lengths that
    is known, of which a plane tilted far away gives the semblance."""
    quantities = Quantities.of(asked)
    nominal = _nominal(asked)
    other = nominal.copy()
    other[1 - quantities.base] = quantities.by_params(known)[1 - quantities.base]
    return [nominal, other]


def _settled(part: Observations, asked: Options, q: Array) -> _Fit | None:
    """Solve and choose in turns, with everything assumed at first.

    Args:
        part: the views.
        asked: of them.
        q: (P,) where to begin.
    """
    quantities, free = Quantities.of(asked), asked.free

    def problem_of(views: Observations, free: IntArray, cost: Cost = asked.cost) -> NormalAt:
        every = np.arange(len(q))
        normal_at = normal_equations.stage_two(views, asked.model, cost, asked.scale, every)
        return in_quantities(normal_at, quantities, free)

    def registration(views: Observations, free: IntArray) -> NormalAt:
        return problem_of(views, free, Cost.REFERENCE)

    flat = replace(part, xy=part.xy[..., :2])
    M = closed_form.homographies(flat, q[2:4], 0.0)
    state = State(q, *closed_form.poses(M, quantities.params(q)[:2], flat))
    nominal, assumed = _nominal(asked), free
    for turn in range(_ROUNDS):
        estimated = np.setdiff1d(free, assumed)
        try:
            solution = _solved(problem_of, registration, part, state, estimated)
        except StartError:
            return None
        unknowns = len(estimated) + solution.normal.pose.size
        sigma2 = covariances.variance(solution.normal.cost, part.count, unknowns)
        if not np.isfinite(sigma2):
            return None
        sigma2 = max(sigma2, _NOISE**2)
        S = schur(problem_of(part, free)(solution.state)).S / sigma2
        doubt = _doubts(quantities, solution.state.params, asked.size)[free]
        chosen = free[unknown(S, doubt)]
        if turn >= _FREELY:
            chosen = np.union1d(chosen, assumed)
        if np.array_equal(chosen, assumed):
            break
        q, assumed = solution.state.params.copy(), chosen
        q[assumed] = nominal[assumed]
        state = solution.state._replace(params=q)
    return _Fit(solution, estimated, S, doubt, sigma2)


def _credible(fit: _Fit, asked: Options) -> bool:
    """Whether the focal length is that of a camera."""
    f = fit.solution.state.params[Quantities.of(asked).base] / asked.size[0]
    return bool(_LEAST < f < _MOST)


def vague(params: Array, covariance: Array, asked: Options) -> list[str]:
    """Names of focal lengths and coordinates of the centre known hardly better than beforehand.

    Args:
        params: (P,) the camera's parameters.
        covariance: of the free ones.
        asked: of the views.
    """
    doubt = np.append(_FOCAL * params[:2], [_CENTRE * asked.size[0]] * 2)
    limit = dict(zip(asked.names[:4], doubt / np.sqrt(_KNOWN_BETTER), strict=True))
    sigma = np.sqrt(np.diag(covariance))
    names = [asked.names[i] for i in asked.free]
    return [n for n, s in zip(names, sigma, strict=True) if n in limit and s > limit[n]]


def unknown(S: Array, doubt: Array) -> IntArray:
    """Which quantities to assume, ascending.

    Args:
        S: (P, P) information on them over the variance of the noise.
        doubt: (P,) standard deviations of their nominal values.
    """
    left = np.arange(len(doubt))
    while left.size:
        values, vectors = np.linalg.eigh((S * np.outer(doubt, doubt))[np.ix_(left, left)])
        if values[0] >= _KNOWN_BETTER:
            break
        left = np.delete(left, int(np.argmax(np.abs(vectors[:, 0]))))
    return np.setdiff1d(np.arange(len(doubt)), left)


def considered(S: Array, doubt: Array, held: BoolArray) -> tuple[Array, Array]:
    """Covariances (P, P) with and without the doubts of the quantities that are held.

    Args:
        S, doubt: as in `unknown`.
        held: (P,) whether a quantity is assumed.
    """
    free = ~held
    unit = np.diag(doubt[free])
    inverse = unit @ np.linalg.inv(unit @ S[np.ix_(free, free)] @ unit) @ unit
    motion = np.zeros((len(doubt), np.count_nonzero(held)))
    motion[free] = -inverse @ S[np.ix_(free, held)]
    motion[held] = np.eye(motion.shape[1])
    by_noise = np.zeros_like(S)
    by_noise[np.ix_(free, free)] = inverse
    by_doubt = motion * doubt[held]
    return by_noise + by_doubt @ by_doubt.T, by_noise


def _solved(
    problem_of: ProblemOf,
    registration: ProblemOf,
    views: Observations,
    start: State,
    free: IntArray,
) -> Solution:
    """The minimum, with tilts that were mistaken for their mirror images righted once."""
    data = float(np.sum(views.uv**2))
    solution = minimise(problem_of(views, free), start, free, views.count, data)
    turned = righted(problem_of, registration, views, solution)
    if turned is None:
        return solution
    try:
        return minimise(
            problem_of(views, free), turned, free, views.count, data, earlier=solution.history
        )
    except StartError:  # the lens folds there: the camera is still too far off to tell
        return solution


def _nominal(asked: Options) -> Array:
    """(P,) q of an ordinary camera: as long as the image is wide, square pixels, no distortion."""
    cx, cy = frames.centre_of_array(asked.size).tolist()
    held, width = asked.held, float(asked.size[0])
    usual = {"fx": held.get("fy", width), "fy": held.get("fx", width), "cx": cx, "cy": cy, **held}
    return Quantities.of(asked).by_params(np.array([usual.get(name, 0.0) for name in asked.names]))


def _doubts(quantities: Quantities, q: Array, size: Size) -> Array:
    """(P,) standard deviations of the nominal values."""
    radius = np.hypot(*size) / 2
    doubt = np.empty(len(q))
    doubt[quantities.base], doubt[1 - quantities.base] = _FOCAL * q[quantities.base], _ASPECT
    doubt[2:4] = _CENTRE * size[0]
    moved = np.where(quantities.powers == 1, _DECENTRED, _RADIAL)
    doubt[4:] = moved / radius**quantities.powers
    return doubt

"""Estimating the plate together with the camera, and refusing where the views cannot carry it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine import frames
from calibgui.engine.errors import CalibrationError
from calibgui.engine.estimation import uncertainty
from calibgui.engine.estimation.arrow import schur
from calibgui.engine.estimation.levenberg_marquardt import Solution, minimise
from calibgui.engine.estimation.observations import Observations
from calibgui.engine.estimation.outcome import Estimate
from calibgui.engine.estimation.problem import Following, residuals
from calibgui.engine.estimation.stage_two import State
from calibgui.engine.estimation.weighting import model_variance, weighted
from calibgui.engine.plate.deviations import basis, corners_of, deviated, gauge, plate_problem
from calibgui.engine.types import Array, Cost, IntArray, Plate, PlateModel, Prior, Report

_LEAST_VIEWS = {PlateModel.AFFINE: 3, PlateModel.BOW: 3, PlateModel.FREE: 6}
"""Views without which the model follows the noise (a free plate without a prior)."""
_LEAST_SEEN = 4
"""Views that must show every corner of a free plate without a prior."""
_ROUNDS = 3
"""Solves until prior and weights have settled."""
_RANK = 1e-9
"""Information left (``uncertainty.py``) below which a plate is not determined."""


def fit_plate(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    shape: PlateModel,
    prior: Prior | None,
    report: Report | None,
) -> Estimate:
    """Estimate the plate with everything else, from the solution for the nominal one.

    Args:
        nominal: the converged Stage II with the image cost.
        observations: the views on the nominal plate.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        shape: affine, bow or free.
        prior: of a free plate's corners.
        report: told of each iteration.

    Raises:
        CalibrationError: if the views cannot determine the plate, with the reason.
    """
    points, index = corners_of(observations)
    _check(observations, index, len(points), shape, prior)
    B = basis(shape, points)
    gauged = prior is None and shape is PlateModel.FREE
    G = gauge(points) if gauged else np.zeros((B.shape[2], 0))
    bend = _Bend(points, index, B, G, prior)
    found = _solved(nominal, observations, model, free, bend, report)
    inverse, left = uncertainty.shared_inverse(schur(found.solution.normal))
    if left < _RANK:
        raise CalibrationError(
            f"These views do not determine the plate's shape ({shape.value}).",
            "Add views tilted in different directions that show the whole board, "
            "state a prior, or keep the nominal plate.",
        )
    P = len(free)
    covariance = _without_gauge(found.sigma2 * inverse, G, P)
    camera, of_plate = covariance[:P, :P], covariance[P:, P:]
    rvecs = frames.rotation_vector(found.state.R)
    motion = np.linalg.solve(camera, covariance[:P, P:]).T
    return Estimate(
        solution=found.solution,
        state=found.state,
        observations=found.observations,
        sigma2=found.sigma2,
        camera=camera,
        poses=uncertainty.pose_covariances(found.solution.normal, covariance, rvecs, found.sigma2),
        by_noise=camera,
        plate=Plate(shape, points, found.deviation, _spread(B, of_plate)),
        plate_unknowns=bend.unknowns,
        following=Following(B @ motion, index),
    )


class _Bend(NamedTuple):
    """How the corners may deviate (``deviations.py``), and what holds them."""

    points: Array
    """(n, 2) the plate's corners, mm."""
    corner: IntArray
    """(K, N) which of them each observation is."""
    B: Array
    """(n, 3, Q) basis of the deviations."""
    G: Array
    """(Q, 7) gauge of a free plate without a prior; (Q, 0) otherwise."""
    prior: Prior | None

    @property
    def unknowns(self) -> int:
        """Of the plate, without its gauge."""
        return self.B.shape[2] - self.G.shape[1]

    def stiffness(self, sigma2: float) -> Array:
        """(Q, Q) what is added to J^T J for the plate: the prior, or the gauge."""
        count, _, Q = self.B.shape
        if self.prior is None or 3 * count != Q:
            return self.G @ self.G.T
        s = np.array([self.prior.in_plane, self.prior.in_plane, self.prior.out_of_plane])
        return np.diag(np.tile(sigma2 / s**2, count))


class _Found(NamedTuple):
    """A solution with the plate's unknowns, and what it makes of camera and corners."""

    solution: Solution
    state: State
    """Camera and poses alone."""
    observations: Observations
    """With the corners where the plate has them."""
    deviation: Array
    """(n, 3) mm."""
    sigma2: float
    """Variance of one residual coordinate."""


def _solved(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    bend: _Bend,
    report: Report | None,
) -> _Found:
    """Camera, poses and plate together, from the solution for the nominal plate.

    Prior and weights are in units of the corners' noise, which the better plate itself lowers.
    """
    Q, P = bend.B.shape[2], len(nominal.state.params)
    known = len(free) + nominal.normal.pose.size
    sigma2 = uncertainty.variance(nominal.normal.cost, observations.count, known)
    start = nominal.state._replace(params=np.append(nominal.state.params, np.zeros(Q)))
    solution = nominal._replace(state=start)
    once = bend.prior is None and observations.cov is None
    for _ in range(1 if once else _ROUNDS):
        solution = minimise(
            plate_problem(observations, model, free, *bend[:3], bend.stiffness(sigma2)),
            solution.state,
            np.append(free, P + np.arange(Q)),
            observations.count,
            float(np.sum(observations.uv**2)),
            report,
            earlier=solution.history,
        )
        state = solution.state._replace(params=solution.state.params[:P])
        deviation = bend.B @ solution.state.params[P:]
        bent = deviated(observations, bend.points, bend.corner, deviation)
        unknowns = known + bend.unknowns
        if observations.cov is not None:
            miss, _ = residuals(state, bent, model, Cost.IMAGE)
            observations = weighted(observations, model_variance(observations, miss, unknowns))
        sigma2 = uncertainty.variance(solution.normal.cost, observations.count, unknowns)
    return _Found(solution, state, bent, deviation, sigma2)


def _check(
    observations: Observations, index: IntArray, count: int, shape: PlateModel, prior: Prior | None
) -> None:
    K = len(observations.mask)
    if prior is None and _LEAST_VIEWS[shape] > K:
        raise CalibrationError(
            f"{K} views cannot carry the plate model {shape.value!r}, which needs "
            f"{_LEAST_VIEWS[shape]}.",
            "Add views, or keep the nominal plate.",
        )
    if shape is not PlateModel.FREE or prior is not None:
        return
    seen = np.bincount(index[observations.mask > 0], minlength=count)
    if (rare := int((seen < _LEAST_SEEN).sum())) > 0:
        raise CalibrationError(
            f"{rare} of the plate's {count} corners are seen in fewer than {_LEAST_SEEN} views.",
            "A free plate needs every corner in several views: add views of those parts, "
            "state a prior, or use the plate models affine or bow.",
        )


def _spread(B: Array, covariance: Array) -> Array:
    """(n, 3) one standard deviation, mm, of the corners' places from the covariance of q."""
    flat = B.reshape(-1, B.shape[2])
    free = len(flat) == len(covariance)  # whose basis is the identity
    variance = np.diag(covariance) if free else np.sum(flat @ covariance * flat, axis=1)
    return np.sqrt(np.maximum(variance, 0.0)).reshape(-1, 3)


def _without_gauge(covariance: Array, G: Array, P: int) -> Array:
    """The covariance with the directions of the gauge, fixed by definition, taken out."""
    left = covariance.copy()
    left[P:] -= G @ (G.T @ left[P:])
    left[:, P:] -= (left[:, P:] @ G) @ G.T
    return left

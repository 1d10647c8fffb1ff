"""Estimating the plate together with the camera, and refusing where the views cannot carry it."""

from __future__ import annotations

import numpy as np

from calibgui.engine import frames
from calibgui.engine.errors import CalibrationError
from calibgui.engine.estimation import uncertainty
from calibgui.engine.estimation.arrow import schur
from calibgui.engine.estimation.levenberg_marquardt import Solution, minimise
from calibgui.engine.estimation.observations import Observations
from calibgui.engine.estimation.outcome import Estimate
from calibgui.engine.estimation.problem import Following, residuals
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
    Q, P, K = B.shape[2], len(nominal.state.params), len(nominal.state.R)
    fixed = prior is None and shape is PlateModel.FREE
    G = gauge(points) if fixed else np.zeros((Q, 0))
    unknowns = len(free) + 6 * K + Q - G.shape[1]
    sigma2 = uncertainty.variance(nominal.normal.cost, observations.count, len(free) + 6 * K)
    solution = nominal._replace(
        state=nominal.state._replace(params=np.append(nominal.state.params, np.zeros(Q)))
    )
    shared = np.append(free, P + np.arange(Q))
    # Prior and weights are in units of the corners' noise, which the better plate itself lowers.
    settled = prior is None and observations.cov is None
    for _ in range(1 if settled else _ROUNDS):
        stiffness = _stiffness(shape, G, prior, sigma2)
        solution = minimise(
            plate_problem(observations, model, free, points, index, B, stiffness),
            solution.state,
            shared,
            observations.count,
            float(np.sum(observations.uv**2)),
            report,
            earlier=solution.history,
        )
        state = solution.state._replace(params=solution.state.params[:P])
        deviation = B @ solution.state.params[P:]
        bent = deviated(observations, points, index, deviation)
        if observations.cov is not None:
            miss, _ = residuals(state, bent, model, Cost.IMAGE)
            observations = weighted(observations, model_variance(observations, miss, unknowns))
        sigma2 = uncertainty.variance(solution.normal.cost, observations.count, unknowns)
    inverse, left = uncertainty.shared_inverse(schur(solution.normal))
    if left < _RANK:
        raise CalibrationError(
            f"These views do not determine the plate's shape ({shape.value}).",
            "Add views tilted in different directions that show the whole board, "
            "state a prior, or keep the nominal plate.",
        )
    covariance = sigma2 * inverse
    if fixed:
        covariance = _without_gauge(covariance, G, len(free))
    of_plate = covariance[len(free) :, len(free) :]
    flat = B.reshape(-1, Q)
    spread = np.diag(of_plate) if len(flat) == Q else np.sum(flat @ of_plate * flat, axis=1)
    rvecs = frames.rotation_vector(state.R)
    camera = covariance[: len(free), : len(free)]
    motion = np.linalg.solve(camera, covariance[: len(free), len(free) :]).T
    return Estimate(
        solution,
        state,
        bent,
        sigma2,
        camera,
        uncertainty.pose_covariances(solution.normal, covariance, rvecs, sigma2),
        camera,
        Plate(shape, points, deviation, np.sqrt(np.maximum(spread, 0.0)).reshape(-1, 3)),
        Q - G.shape[1],
        Following(B @ motion, index),
    )


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


def _stiffness(shape: PlateModel, G: Array, prior: Prior | None, sigma2: float) -> Array:
    """(Q, Q) what is added to J^T J for the plate: the prior, or the free plate's gauge."""
    if shape is not PlateModel.FREE or prior is None:
        return G @ G.T
    s = np.array([prior.in_plane, prior.in_plane, prior.out_of_plane])
    return np.diag(np.tile(sigma2 / s**2, len(G) // 3))


def _without_gauge(covariance: Array, G: Array, P: int) -> Array:
    """The covariance with the directions of the gauge, fixed by definition, taken out."""
    left = covariance.copy()
    left[P:] -= G @ (G.T @ left[P:])
    left[:, P:] -= (left[:, P:] @ G) @ G.T
    return left

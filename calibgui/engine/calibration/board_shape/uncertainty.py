"""What a nominal plate leaves unknown: wider uncertainties where the residuals are not noise.

If the plate is as drawn, the residual of a corner, carried back to its place on the plate,
averages out over the views. With the derivatives J_ik of corner i's image in view k by its
place (2 x 3), g_i = sum_k J_ik^T r_ik and H_i = sum_k J_ik^T J_ik, noise alone makes

    chi^2 = sum_i g_i^T H_i^-1 g_i / sigma^2

at most about three a corner, because camera and poses have been fitted to the same residuals.
An excess is the plate's: deviations of variance s^2 add s^2 tr H_i to each term, which
estimates s^2.

Treated as unknowns with that variance (stiffness sigma^2 / s^2), the deviations can be solved
for by one linear step, which in turn improves s^2 and sigma^2 (expectation-maximisation). It
moves camera and poses by b, and leaves them with the covariance C of the joint estimate. The
nominal plate's answer is off by b with uncertainty C, so that its mean square error is
C + b b^T; this is reported in place of sigma^2 (J^T J)^-1.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.board_shape.estimate import (
    basis,
    board_shape_problem,
    corner_products,
    corners_of,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.schur import schur, step
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.geometry import rotations

_SEEN = 3
"""Views that must show a corner for it to be judged."""
_ROUNDS = 3
"""Of expectation-maximisation for s^2 and sigma^2."""
_ALARM = 5.0
"""Excess of chi^2, in standard deviations, that counts as evidence."""


def with_board_shape_error(
    estimate: Estimate, observations: Observations, model: str, free: IntArray
) -> Estimate:
    """The estimate with the uncertainty that an imperfect plate adds, if the residuals show one.

    Args:
        estimate: with the image cost on the nominal plate.
        observations: the views.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
    """
    points, index = corners_of(observations)
    g, H, seen = _scores(estimate, observations, model, index, len(points))
    judged = seen >= _SEEN
    if not judged.any() or not estimate.sigma2 > 0:
        return estimate
    terms = np.einsum("ia,ia->i", g[judged], np.linalg.solve(H[judged], g[judged, :, None])[..., 0])
    expected = 3 * int(judged.sum())
    excess = float(terms.sum()) / estimate.sigma2 - expected
    if excess < _ALARM * np.sqrt(2 * expected):
        return estimate
    s2 = excess * estimate.sigma2 / float(np.trace(H[judged], axis1=1, axis2=2).sum())
    return _widened(estimate, observations, model, free, points, index, s2)


def _scores(
    estimate: Estimate, observations: Observations, model: str, index: IntArray, count: int
) -> tuple[Array, Array, IntArray]:
    """g (n, 3), H (n, 3, 3) and the number of views of every corner of the plate."""
    g, H = np.zeros((count, 3)), np.zeros((count, 3, 3))
    none_free = np.zeros(0, dtype=np.int64)
    products = corner_products(estimate.state, observations, model, none_free, index, count, False)
    for _, _, _, total in products:
        g += total[..., 0]
        H += total[..., 1:]
    seen = np.bincount(index[observations.mask > 0], minlength=count)
    return g, H, seen.astype(np.int64)


def _widened(
    estimate: Estimate,
    observations: Observations,
    model: str,
    free: IntArray,
    points: Array,
    index: IntArray,
    s2: float,
) -> Estimate:
    """The estimate with C + b b^T for deviations of variance s2, mm^2."""
    B = basis(BoardShapeModel.FREE, points)
    P, Q = len(free), B.shape[2]
    state = estimate.state._replace(params=np.append(estimate.state.params, np.zeros(Q)))
    normal = board_shape_problem(observations, model, free, points, index, B, np.zeros((Q, Q)))(
        state
    )
    unknowns = P + normal.pose.size + Q
    sigma2 = estimate.sigma2
    reduced = schur(normal)
    stiffness = np.zeros_like(normal.U)
    for _ in range(_ROUNDS):
        stiffness[P:, P:] = np.eye(Q) * sigma2 / s2
        stiffened = reduced.stiffened(stiffness)
        by_shared, by_pose = step(normal, stiffened)
        gained = -float(by_shared @ normal.shared + np.sum(by_pose * normal.pose))
        left = covariances.variance(normal.cost - gained, observations.count, unknowns)
        sigma2 = left if left > 0 else sigma2
        covariance = covariances.shared_covariance(stiffened, sigma2)
        s2 = float(by_shared[P:] @ by_shared[P:] + np.trace(covariance[P:, P:])) / Q
    b = by_shared[:P]
    rvecs = rotations.rotation_vector(estimate.state.R)
    shift = (covariances.pose_by_local(rvecs) @ by_pose[..., None])[..., 0]
    rms = float(np.sqrt(np.mean(np.sum(by_shared[P:].reshape(-1, 3) ** 2, axis=1))))
    return estimate._replace(
        camera=covariance[:P, :P] + np.outer(b, b),
        poses=covariances.pose_covariances(normal, covariance, rvecs, sigma2)
        + shift[:, :, None] * shift[:, None, :],
        board_shape_error=rms,
    )

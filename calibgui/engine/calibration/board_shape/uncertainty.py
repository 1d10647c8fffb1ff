"""The uncertainty that an imperfect board adds to a calibration that takes it for the drawing.

If the board is as drawn, the residual of a corner, carried back to its place on the board,
averages out over the views. With the derivatives J_ik of corner i's image in view k by its
place (2 x 3), g_i = sum_k J_ik^T r_ik and H_i = sum_k J_ik^T J_ik, noise alone makes

    chi^2 = sum_i g_i^T H_i^-1 g_i / sigma^2

at most about three a corner, because camera and poses have been fitted to the same residuals.
An excess is the board's: deviations of variance s^2 add s^2 tr H_i to each term, which
estimates s^2.

Treated as unknowns with that variance (stiffness sigma^2 / s^2), the deviations can be solved
for by one linear step, which in turn improves s^2 and sigma^2 (expectation-maximisation, Dempster,
Laird and Rubin 1977). It moves camera and poses by b, and leaves them with the covariance C of the
joint estimate. The camera for the board as drawn is off by b with uncertainty C, so that its mean
square error is C + b b^T; this is reported in place of sigma^2 (J^T J)^-1.

The camera itself is not moved: the test shows that the board is not as drawn, but a board shape is
estimated only if the user asks for it.

A lens that the model does not follow looks like a board that is off, too; which of them it is is
found by ``lens_error.py``. The uncertainties are widened either way. Where it is the lens, b is no
longer the camera's error (the true lens has no such parameters), but it is how far an error of the
residuals' size and smoothness, fixed to the board, moves them: without it, they would be too small.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    iterate_corner_products,
    make_basis,
    make_board_shape_problem,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.schur import eliminate_poses, solve_reduced
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.geometry import rotations

_MIN_VIEWS_OF_CORNER = 3
"""Number of views that must show a corner for it to enter the test."""
_ITERATIONS = 3
"""Number of steps of expectation-maximisation for s^2 and sigma^2."""
_MIN_EXCESS = 5.0
"""Excess of chi^2, in its standard deviations, from which the board counts as imperfect."""


class BoardSuspicion(NamedTuple):
    """The deviations of the board's corners that the residuals suggest."""

    points: Array
    """(n, 2) the board's corners in the drawing, mm."""
    corner: IntArray
    """(K, N) index among these of each observation."""
    variance: float
    """Variance s^2 of the deviations along each axis, mm^2."""
    explained: float
    """Part of the squared residuals that the deviations explain at least, beyond noise."""


def suspect_board(
    estimate: Estimate, observations: Observations, model: str
) -> BoardSuspicion | None:
    """Test whether the residuals look as if the board's corners were off; None if they do not.

    Args:
        estimate: the estimate with the image cost for the board as it is drawn.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.
    """
    points, index = index_board_points(observations)
    g, H, seen = _sum_scores(estimate, observations, model, index, len(points))
    tested = seen >= _MIN_VIEWS_OF_CORNER
    if not tested.any() or not estimate.sigma2 > 0:
        return None
    terms = np.einsum("ia,ia->i", g[tested], np.linalg.solve(H[tested], g[tested, :, None])[..., 0])
    expected = 3 * int(tested.sum())
    excess = float(terms.sum()) / estimate.sigma2 - expected
    if excess < _MIN_EXCESS * np.sqrt(2 * expected):
        return None
    s2 = excess * estimate.sigma2 / float(np.trace(H[tested], axis1=1, axis2=2).sum())
    return BoardSuspicion(points, index, s2, excess * estimate.sigma2)


def _sum_scores(
    estimate: Estimate, observations: Observations, model: str, index: IntArray, count: int
) -> tuple[Array, Array, IntArray]:
    """Sum g (n, 3), H (n, 3, 3) and the number of views of every corner of the board."""
    g, H = np.zeros((count, 3)), np.zeros((count, 3, 3))
    none_free = np.zeros(0, dtype=np.int64)
    products = iterate_corner_products(
        estimate.state, observations, model, none_free, index, count, False
    )
    for _, _, _, total in products:
        g += total[..., 0]
        H += total[..., 1:]
    seen = np.bincount(index[observations.mask > 0], minlength=count)
    return g, H, seen.astype(np.int64)


def add_board_shape_error(
    estimate: Estimate,
    observations: Observations,
    model: str,
    free: IntArray,
    suspicion: BoardSuspicion,
) -> Estimate:
    """Widen an estimate by the uncertainty of an imperfect board: covariances C + b b^T.

    Args:
        estimate: the estimate with the image cost for the board as it is drawn.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        suspicion: the deviations that the residuals suggest.
    """
    points, index, s2, _ = suspicion
    B = make_basis(BoardShapeModel.FREE, points)
    P, Q = len(free), B.shape[2]
    state = estimate.state._replace(params=np.append(estimate.state.params, np.zeros(Q)))
    normal = make_board_shape_problem(
        observations, model, free, points, index, B, np.zeros((Q, Q))
    )(state)
    unknowns = P + normal.pose.size + Q
    sigma2 = estimate.sigma2
    reduced = eliminate_poses(normal)
    stiffness = np.zeros_like(normal.U)
    for _ in range(_ITERATIONS):
        stiffness[P:, P:] = np.eye(Q) * sigma2 / s2
        stiffened = reduced.add_stiffness(stiffness)
        by_shared, by_pose = solve_reduced(normal, stiffened)
        gained = -float(by_shared @ normal.shared + np.sum(by_pose * normal.pose))
        left = covariances.estimate_variance(normal.cost - gained, observations.count, unknowns)
        sigma2 = left if left > 0 else sigma2
        covariance = covariances.compute_shared_covariance(stiffened, sigma2)
        s2 = float(by_shared[P:] @ by_shared[P:] + np.trace(covariance[P:, P:])) / Q
    b = by_shared[:P]
    rvecs = rotations.vector_from_rotation(estimate.state.R)
    shift = (covariances.differentiate_poses(rvecs) @ by_pose[..., None])[..., 0]
    rms = float(np.sqrt(np.mean(np.sum(by_shared[P:].reshape(-1, 3) ** 2, axis=1))))
    return estimate._replace(
        camera_covariance=covariance[:P, :P] + np.outer(b, b),
        pose_covariances=covariances.compute_pose_covariances(normal, covariance, rvecs, sigma2)
        + shift[:, :, None] * shift[:, None, :],
        board_shape_error=rms,
    )

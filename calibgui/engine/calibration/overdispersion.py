"""Overdispersion: views that disagree about the camera by more than their corners' noise explains.

The covariance sigma^2 (J^T J)^-1 holds if the errors of a view's corners are independent. The
errors of a board that bends in the hand, of rows that are read one after the other, of a lens that
the model does not follow, are not independent: they pull at the camera together, and averaging over
corners does not reduce them. Averaging over views does, if one view's pull tells nothing about the
next one's.

The test takes every view by itself. With the poses eliminated (``refinement/schur.py``), view k
pulls the camera's P parameters with the gradient and the information

    h_k = Jc_k^T r_k - Wk Vk^-1 Jp_k^T r_k,      Rk = Uk - Wk Vk^-1 Wk^T,

sum h_k = 0 at the solution and sum Rk = T, where T^-1 is their covariance over sigma^2. An
estimated board shape is eliminated as well: its corners follow the camera by dX_i = N_i dc, so that
the rows of Jc are Jc_i + (d(u, v)/dX_i) N_i. The estimate itself follows view k's pull, so that
noise alone gives h_k the covariance sigma^2 (Rk - Rk T^-1 Rk). In units in which T = 1,

    X = (1 / P) sum_k h_k^T (1 - Rk)^-1 h_k / sigma^2

therefore has the expectation 1 under noise and, of a quadratic form in Gaussian variables, the
variance 2 / n with

    n = P^2 / (sum_k tr Rk^2 + tr (sum_k Dk)^2 - sum_k tr Dk^2),      Dk = Rk (1 - Rk)^-1 Rk;

it is distributed about as chi^2(n) / n. It says what the views' disagreement makes of the
variances, averaged over the parameters.

What one view alone determines, it has nobody to disagree with about: Rk has an eigenvalue of 1
there and h_k is 0, but for rounding. Such directions of Rk are left out of (1 - Rk)^-1, and P is
what is left of sum tr Rk = P without them.

If X is too large for noise (Fisher's F test), the covariance clustered by view takes the place of
the model's where it is larger. Without view k the camera would be at dc_k = (1 - Rk)^-1 h_k from
where it is; the jackknife

    cov = (K - 1) / K sum_k dc_k dc_k^T

allows for each view's leverage in full (Bell and McCaffrey 2002: CR3), and is on the safe side
by the little that a sum of few squares asks for. Where one view alone determines a parameter it
would be without bounds; so nine tenths of the view are left out, (1 - 0.9 Rk)^-1 h_k, which is
the same to first order and for noise at most three times the variance. An estimated board shape has
a leverage of its own, l = Q / (2N - 6K), about alike in all views: of noise's variance it leaves
1 - l in X, and the jackknife's residuals are 1 / (1 - l) of those that are left.

Of the two covariances the larger is taken in each direction of the parameters: with C = L L^T the
noise's and L^-1 cov L^-T = sum_i v_i u_i u_i^T, it exceeds C by

    L (sum_i max(v_i - 1, 0) u_i u_i^T) L^T,

which is added to what is reported. Poses and board shape follow the camera as they do in the model.

Two views cannot be tested: there is a camera between them that suits both. Real views seldom agree
to their corners' noise, so two are taken to disagree as three of them usually do. Of three, a test
that finds nothing says little: with n = 8, as of a lens of nine parameters, it misses every fourth
disagreement of that size. No significance is asked of them: the larger covariance is taken in each
direction, whatever it is.

An error that all views share, such as the board's, is not measured by their disagreement: the
board's is found by ``board_shape/uncertainty.py`` and adds to it, as a bias adds to a scatter; that
of the lens model is found by no comparison of views.
"""

from __future__ import annotations

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.observations import slice_views
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.residuals import compute_view_products
from calibgui.engine.calibration.refinement.schur import invert_pose_roots

_SIGNIFICANCE = 0.01
"""Probability with which noise alone widens the uncertainties."""
_JACKKNIFE_SHARE = 0.9
"""Share of a view that the jackknife leaves out."""
_MIN_VIEWS = 3
"""Number of views below which their disagreement is not tested."""
_MIN_VIEWS_TO_AGREE = 4
"""Number of views below which a disagreement counts that is not significant. From it on the test
finds four of five that are as large as two views are assumed to have, what is customary (Cohen
1988); of 48 subsets of three real views with a value beyond 2.5 standard deviations, it had found
none in 38 (``tests/benchmarks/few_views.py``)."""
_MIN_SHARE_OF_OTHERS = 1e-6
"""Share of the information on a direction below which the other views do not count in it: n is a
difference of sums that grow with the inverse of its square, and keeps four digits."""
_ASSUMED_DISAGREEMENT = 2.0
"""Ratio of the standard deviations of views that are too few to be tested to what board and noise
make of them. With 1, every fifth value that two views of a real set give is beyond 2.5 standard
deviations, and up to half of one set's (``tests/benchmarks/few_views.py``)."""


def add_overdispersion(
    estimate: Estimate, model: str, free: IntArray, views: Array | None = None
) -> Estimate:
    """Widen an estimate by the uncertainty that a significant disagreement of the views shows.

    Args:
        estimate: the estimate with the image cost, on a board of any shape.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        views: (K, P + 7, P + 7) products of each view's columns [camera, pose, r]; computed if
            None.
    """
    K, P, sigma2 = len(estimate.pose_covariances), len(free), estimate.sigma2
    if P == 0 or not sigma2 > 0:
        return estimate
    if K < _MIN_VIEWS:
        return _assume_disagreement(estimate)
    if views is None:
        views = compute_view_products(
            estimate.state, estimate.observations, model, free, estimate.board_motion
        )
    R, h, G = reduce_products(views, P)
    corners = estimate.observations.count
    leverage = estimate.shape_unknowns / (2 * corners - 6 * K)
    left = 2 * corners - 6 * K - P - estimate.shape_unknowns
    added, ratio = measure_disagreement(R, h, estimate.noise_covariance, sigma2, left, leverage)
    shape, following = estimate.board_shape, estimate.board_motion
    if shape is not None and following is not None:
        shape = widen_board_shape(shape, following.motion, added)
    return estimate._replace(
        camera_covariance=estimate.camera_covariance + added,
        pose_covariances=estimate.pose_covariances + G @ added @ np.swapaxes(G, 1, 2),
        board_shape=shape,
        overdispersion=ratio,
    )


def measure_disagreement(
    R: Array,
    h: Array,
    covariance: Array,
    sigma2: float,
    freedom: float,
    leverage: float = 0.0,
) -> tuple[Array, float]:
    """Measure how much views disagree about the parameters that they share.

    Args:
        R: (K, P, P) information of each view; it is overwritten.
        h: (K, P) pull of each view.
        covariance: (P, P) of the parameters from the corners' noise alone.
        sigma2: variance of one residual coordinate.
        freedom: degrees of freedom that sigma^2 is estimated from.
        leverage: l, that of an estimated board shape.

    Returns:
        What is added to the covariance (P, P), and the root of X if it is significant, else 0.
    """
    K, P = h.shape
    nothing = np.zeros((P, P)), 0.0
    try:
        unit = np.linalg.cholesky(covariance / sigma2)  # T^-1 = unit unit^T
    except np.linalg.LinAlgError:
        return nothing  # a combination of parameters is undetermined, and says so
    h = (h - h.mean(axis=0)) @ unit
    square = count = pulled = 0.0
    D_sum, clustered = np.zeros((P, P)), np.zeros((P, P))
    for views in slice_views(K):  # a rig of 8 cameras and 2,000 instants has 250 MB of them
        R[views] = unit.T @ R[views] @ unit
        tested, alone, D = _compare_with_others(R[views])
        D_sum += D.sum(axis=0)
        square += float(np.sum(tested**2) - np.sum(D**2))
        count += float(np.trace(tested, axis1=1, axis2=2).sum())
        pulled += float(np.sum((alone @ h[views, :, None])[..., 0] * h[views]))
        moved = np.linalg.solve(np.eye(P) - _JACKKNIFE_SHARE * R[views], h[views, :, None])
        clustered += moved[..., 0].T @ moved[..., 0]
    square += float(np.sum(D_sum**2))
    if not square > 0:  # of a camera that is open beyond all measure
        return nothing
    X = pulled / (count * sigma2 * (1 - leverage))
    is_significant = scipy.special.fdtrc(count**2 / square, freedom, X) <= _SIGNIFICANCE
    if not is_significant and K >= _MIN_VIEWS_TO_AGREE:
        return nothing
    clustered = unit @ clustered @ unit.T * (K - 1) / K / (1 - leverage) ** 2
    added = _compute_excess(clustered, np.sqrt(sigma2) * np.asarray(unit))
    return added, float(np.sqrt(X)) if is_significant else 0.0


def _compare_with_others(R: Array) -> tuple[Array, Array, Array]:
    """Return Rk (K, P, P), (1 - Rk)^-1 without what view k alone determines, and Dk."""
    norm = np.sqrt(np.sum(R**2, axis=(1, 2)))  # no eigenvalue is more
    is_usual = (norm < 1 - _MIN_SHARE_OF_OTHERS)[:, None, None]
    unit = np.eye(R.shape[1])
    alone = np.asarray(np.linalg.inv(unit - np.where(is_usual, R, 0.0)), np.float64)
    D = alone - unit - R
    if is_usual.all():
        return R, alone, D
    is_usual = is_usual[:, 0, 0]
    shares, axes = np.linalg.eigh(R[~is_usual])
    is_shared = shares < 1 - _MIN_SHARE_OF_OTHERS
    tested = np.where(is_shared, shares, 0.0)[:, None]
    back, gain = np.swapaxes(axes, 1, 2), is_shared[:, None] / (1 - tested)
    R = R.copy()
    R[~is_usual] = (axes * tested) @ back
    alone[~is_usual] = (axes * gain) @ back
    D[~is_usual] = (axes * (tested**2 * gain)) @ back
    return R, alone, D


def _assume_disagreement(estimate: Estimate) -> Estimate:
    """Widen an estimate from views that are too few to show whether they disagree."""
    ratio = _ASSUMED_DISAGREEMENT**2
    return estimate._replace(
        camera_covariance=ratio * estimate.camera_covariance,
        pose_covariances=ratio * estimate.pose_covariances,
        board_shape=estimate.board_shape and estimate.board_shape.scale_errors(ratio),
    )


def reduce_products(A: Array, P: int) -> tuple[Array, Array, Array]:
    """Compute Rk (K, P, P), h_k (K, P) and Vk^-1 Wk^T (K, 6, P) from products of the views' columns
    [shared, pose, r] (K, P + 7, P + 7)."""
    roots, chosen = invert_pose_roots(A[:, P:-1, P:-1]), [*range(P), -1]
    Y = roots @ A[:, P:-1, chosen]
    left = A[:, :P, chosen] - np.swapaxes(Y[..., :-1], 1, 2) @ Y
    return left[..., :-1], left[..., -1], np.swapaxes(roots, 1, 2) @ Y[..., :-1]


def widen_board_shape(board_shape: BoardShape, motion: Array, added: Array) -> BoardShape:
    """Widen an estimated board shape by the uncertainty that it takes over from the camera.

    Args:
        board_shape: the shape.
        motion: (n, 3, P) motion of its corners with the camera's parameters, mm per unit.
        added: (P, P) what is added to the covariance of these.
    """
    values, axes = np.linalg.eigh(added)
    return board_shape.add_errors(motion @ (axes * np.sqrt(np.maximum(values, 0.0))))


def _compute_excess(covariance: Array, root: Array) -> Array:
    """Compute the (P, P) to add to root root^T so that it is nowhere below the covariance."""
    half = np.linalg.solve(root, covariance)
    values, vectors = np.linalg.eigh(np.linalg.solve(root, half.T))
    axes = root @ vectors
    return np.asarray((axes * np.maximum(values - 1, 0.0)) @ axes.T)

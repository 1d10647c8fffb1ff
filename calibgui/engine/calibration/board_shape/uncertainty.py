"""The uncertainty that an imperfect board adds to a calibration that takes it for the drawing.

No board is quite flat or printed quite true, and what it deviates by moves the camera: 0.1 mm of
bow moves the focal length of an ordinary set of views ten times as far as the corners' noise does.
Many views show the deviations; few do not, and then only a prior tells how large they may be.

Prior. The deviations d (n, 3) of the board's corners are random, in polynomials of the place on the
board, orthonormal over the corners and free of the gauge (what a motion, turn or scaling of the
board does): d = B q, q ~ N(0, s^2) with one variance for each kind of deviation,

    flatness   out of the plane, quadratic: bow and twist;
    print      in the plane, up to quadratic: unequal sides, shear, keystone, uneven feed;
    roughness  all further polynomials up to the seventh degree, in and out of the plane.

Higher degrees average out over the corners before they reach the camera, whose map has no terms
beyond the seventh. The root mean square deviation of a kind is expected to be `DEFAULT_FLATNESS` of
the board's longer side (half of it in each polynomial of the roughness), or what the user knows
(`BoardShapePrior`), which is kept. The default gives way to the data, by expectation-maximisation
(Dempster, Laird and Rubin 1977) with the prior as an inverse gamma density of few degrees of
freedom (Gelman et al., Bayesian Data Analysis, 2.6): with A = sum of the squares of a kind's m
expected coefficients, their variances included,

    s^2 <- (nu s0^2 + A) / (nu + m),

which stays at s0^2 where the views say nothing of the coefficients, and is what they say where they
say much.

One linear step from the nominal board's solution, with stiffness sigma^2 / s^2 on q, leads to the
joint estimate of camera, poses and board. It moves camera and poses by b, and leaves them with the
covariance C. The camera for the board as drawn is off by b with uncertainty C, so that its mean
square error is C + b b^T; this is reported in place of sigma^2 (J^T J)^-1. The camera itself is not
moved: a board shape is estimated only if the user asks for it. An estimate by another cost, which
lies at a distance d from that of the image cost, has the mean square error C + (b - d) (b - d)^T.

Test. If the board is as drawn, the residual of a corner, carried back to its place on the board,
averages out over the views. With the derivatives J_ik of corner i's image in view k by its
place (2 x 3), g_i = sum_k J_ik^T r_ik and H_i = sum_k J_ik^T J_ik, noise alone makes

    chi^2 = sum_i g_i^T H_i^-1 g_i / sigma^2

at most about three a corner, because camera and poses have been fitted to the same residuals. An
excess is the board's, or that of a lens that the model does not follow; which of them it is is
found by ``lens_error.py``. The uncertainties are widened either way. Where it is the lens, b is no
longer the camera's error (the true lens has no such parameters), but it is how far an error of the
residuals' size and smoothness, fixed to the board, moves them: without it, they would be too small.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    iterate_corner_products,
    make_board_shape_problem,
    make_gauge,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.schur import eliminate_poses, solve_reduced
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.geometry import rotations

DEFAULT_FLATNESS = 3e-4
"""Expected deviation (rms) of a board from flatness, and from its print, over its longer side:
0.1 mm of a board that is 0.33 m long."""
_ROUGHNESS = 0.5
"""Ratio of the expected coefficient of a rough deviation to `DEFAULT_FLATNESS`."""
_MAX_DEGREE, _SMOOTH_DEGREE = 7, 2
"""Degrees of the polynomials in all, and of those of flatness and print."""
_PRIOR_FREEDOM = 0.3
"""Degrees of freedom nu of the prior: it yields to one well-determined coefficient. With it, and
these degrees, 92 % and more of the intrinsics lie within two standard deviations of the truth on
boards that are bowed, twisted, stretched or rough by 0.05 to 1 mm, in 3 to 25 views
(``tests/benchmarks/standard_deviations.py``)."""
_ITERATIONS = 20
"""Number of steps of expectation-maximisation: few coefficients that are determined draw the
variance of the others down slowly."""
_MIN_VIEWS_OF_CORNER = 3
"""Number of views that must show a corner for it to enter the test."""
_MIN_EXCESS = 5.0
"""Excess of chi^2, in its standard deviations, from which the board counts as imperfect."""
_MIN_DIAGONAL = 1e-6
"""Part of a polynomial that is new beside those before it, below which it is left out."""
_FLATNESS, _PRINT, _ROUGH = 0, 1, 2
"""The kinds of deviation."""


class BoardError(NamedTuple):
    """What the board's deviations, as far as prior and views tell, do to a calibration."""

    covariance: Array
    """(P, P) covariance C of the camera's free parameters of the joint estimate."""
    pose_covariances: Array
    """(K, 6, 6) covariances of (rvec, tvec) of the joint estimate."""
    shift: Array
    """(P,) camera of the joint estimate minus that for the board as drawn."""
    pose_shift: Array
    """(K, 6) the same of the poses, (rvec, tvec)."""
    deviation: float
    """Deviation of the board's corners, mm rms, of the joint estimate."""


def suspect_board(estimate: Estimate, observations: Observations, model: str) -> float:
    """Test whether the residuals look as if the board's corners were off.

    Args:
        estimate: the estimate with the image cost for the board as it is drawn.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.

    Returns:
        Part of the squared residuals that the board's corners explain at least, beyond noise; 0 if
        the residuals do not look so.
    """
    points, index = index_board_points(observations)
    g, H, seen = _sum_scores(estimate, observations, model, index, len(points))
    tested = seen >= _MIN_VIEWS_OF_CORNER
    if not tested.any() or not estimate.sigma2 > 0:
        return 0.0
    terms = np.einsum("ia,ia->i", g[tested], np.linalg.solve(H[tested], g[tested, :, None])[..., 0])
    expected = 3 * int(tested.sum())
    excess = float(terms.sum()) / estimate.sigma2 - expected
    if excess < _MIN_EXCESS * np.sqrt(2 * expected):
        return 0.0
    return excess * estimate.sigma2


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


def estimate_board_error(
    estimate: Estimate,
    observations: Observations,
    model: str,
    free: IntArray,
    prior: BoardShapePrior | None = None,
) -> BoardError:
    """Estimate what the board's deviations do to a calibration that takes it for the drawing.

    Args:
        estimate: the estimate with the image cost for the board as it is drawn.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        prior: deviations to expect; `DEFAULT_FLATNESS` if None.
    """
    points, index = index_board_points(observations)
    B, kind = make_deviations(points)
    P, Q = len(free), B.shape[2]
    expected = _expect_variances(points, kind, prior)
    state = estimate.state._replace(params=np.append(estimate.state.params, np.zeros(Q)))
    normal = make_board_shape_problem(
        observations, model, free, points, index, B, np.zeros((Q, Q))
    )(state)
    reduced = eliminate_poses(normal)
    variances, sigma2 = expected, estimate.sigma2
    stiffness = np.zeros_like(normal.U)
    for _ in range(_ITERATIONS):
        stiffness[range(P, P + Q), range(P, P + Q)] = sigma2 / variances[kind]
        stiffened = reduced.add_stiffness(stiffness)
        by_shared, by_pose = solve_reduced(normal, stiffened)
        inverse, _ = covariances.invert_information(stiffened)
        known = Q - float(np.sum(np.diag(inverse * stiffness)))  # coefficients that views determine
        gained = -float(by_shared @ normal.shared + np.sum(by_pose * normal.pose))
        left = covariances.estimate_variance(
            normal.cost - gained, observations.count, P + normal.pose.size + known
        )
        sigma2 = left if left > 0 else sigma2
        if prior is None:  # what the user knows is not learnt from the views
            squares = by_shared[P:] ** 2 + sigma2 * np.diag(inverse)[P:]
            total, count = (np.bincount(kind, w, len(expected)) for w in (squares, np.ones(Q)))
            variances = (_PRIOR_FREEDOM * expected + total) / (_PRIOR_FREEDOM + count)
    covariance, rvecs = sigma2 * inverse, rotations.vector_from_rotation(estimate.state.R)
    squares = by_shared[P:] ** 2
    # Higher degrees are as rough as most of those before: of noise's squares the median is 0.455.
    typical = float(np.median(squares[kind == _ROUGH])) / 0.455 if (kind == _ROUGH).any() else 0.0
    square = float(squares.sum()) + max(3 * len(points) - Q - 7, 0) * typical
    return BoardError(
        covariance[:P, :P],
        covariances.compute_pose_covariances(normal, covariance, rvecs, sigma2),
        by_shared[:P],
        (covariances.differentiate_poses(rvecs) @ by_pose[..., None])[..., 0],
        float(np.sqrt(square / len(points))),
    )


def add_board_error(
    estimate: Estimate, error: BoardError, offset: tuple[Array, Array] | None = None
) -> Estimate:
    """Widen an estimate's covariances to its mean square errors on an imperfect board.

    Args:
        estimate: the estimate for the board as it is drawn.
        error: what the board does to the estimate by the image cost.
        offset: camera (P,) and poses (K, 6) of an estimate by another cost minus those of that by
            the image cost; None for the latter itself.
    """
    camera, poses = error.shift, error.pose_shift
    if offset is not None:
        camera, poses = camera - offset[0], poses - offset[1]
    return estimate._replace(
        camera_covariance=error.covariance + np.outer(camera, camera),
        pose_covariances=error.pose_covariances + poses[:, :, None] * poses[:, None, :],
    )


def make_deviations(points: Array) -> tuple[Array, IntArray]:
    """Make the deviations of a board that a prior is stated for.

    Args:
        points: (n, 2) the board's corners, mm.

    Returns:
        B (n, 3, Q), orthonormal over the corners and free of the gauge, and the kind (Q,) of each:
        `_FLATNESS`, `_PRINT` or `_ROUGH`.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = ((2 * points - low - high) / np.maximum(high - low, np.finfo(float).tiny)).T
    columns, kinds, n = [make_gauge(points)], [], len(points)
    for degree in range(1, _MAX_DEGREE + 1):
        powers = [x ** (degree - j) * y**j for j in range(degree + 1)]
        for axis in (2, 0, 1):
            block = np.zeros((n, 3, degree + 1))
            block[:, axis] = np.transpose(powers)
            columns.append(block.reshape(3 * n, -1))
            smooth = _FLATNESS if axis == 2 else _PRINT
            kinds += [smooth if degree <= _SMOOTH_DEGREE else _ROUGH] * (degree + 1)
    stacked = np.concatenate(columns, axis=1)
    stacked /= np.linalg.norm(stacked, axis=0)
    # Columns that depend on those before them would take a direction away from those behind.
    new = np.abs(np.diag(np.linalg.qr(stacked, mode="r"))) > _MIN_DIAGONAL
    new = np.append(new, np.zeros(stacked.shape[1] - len(new), dtype=bool))
    q = np.linalg.qr(stacked[:, new])[0][:, 7:]
    return q.reshape(n, 3, -1), np.array(kinds, dtype=np.int64)[new[7:]]


def _expect_variances(points: Array, kind: IntArray, prior: BoardShapePrior | None) -> Array:
    """Return the variances (3,) of a coefficient of each kind that the prior expects, mm^2."""
    usual = DEFAULT_FLATNESS * float(np.ptp(points, axis=0).max())
    flat, true = (usual, usual) if prior is None else (prior.out_of_plane, prior.in_plane)
    counts = np.maximum(np.bincount(kind, minlength=3), 1)
    smooth = len(points) * np.array([flat, true]) ** 2 / counts[:2]
    return np.append(smooth, _ROUGHNESS**2 * flat * true)

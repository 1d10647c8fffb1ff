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
say much. Few coefficients that are determined draw the variance of the others down slowly, by a
tenth of the way in a step: Anderson's (1965) mixing of the last steps, in the logarithms of
sigma^2 / s^2, leads to the end. The camera is eliminated first, after the poses, so that a step
factorises a matrix of the coefficients alone, and most of that is tridiagonal (`Information`).

One linear step from the nominal board's solution, with stiffness sigma^2 / s^2 on q, leads to the
joint estimate of camera, poses and board. It moves camera and poses by b, and leaves them with the
covariance C. The camera for the board as drawn is off by b with uncertainty C; this is reported as

    C + gamma b b^T,      gamma = 1.292,

in place of sigma^2 (J^T J)^-1. With gamma = 1 it is the mean square error; but of errors that are
almost known, not normal about zero, half are beyond its root. The half width s that holds 68.3 % of
the errors, as a standard deviation does, is found from the distance beta of a quantity's shift in
its own standard deviations, Phi(s - beta) - Phi(-s - beta) = 0.683; gamma is the maximum of
(s^2 - 1) / beta^2, which is reached at beta = 1.6, so that no quantity's interval holds less.

The camera itself is not moved: a board shape is estimated only if the user asks for it. An estimate
by another cost, which lies at a distance d from that of the image cost, has b - d in place of b.

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

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.board_shape.deviations import ROUGH, Deviations, make_deviations
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    iterate_corner_products,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    eliminate_poses,
    invert_roots,
    sum_costs,
)
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.kernels import with_kernel

DEFAULT_FLATNESS = 3e-4
"""Expected deviation (rms) of a board from flatness, and from its print, over its longer side:
0.1 mm of a board that is 0.33 m long."""
_ROUGHNESS = 0.5
"""Ratio of the expected coefficient of a rough deviation to `DEFAULT_FLATNESS`."""
_PRIOR_FREEDOM = 0.3
"""Degrees of freedom nu of the prior: it yields to one well-determined coefficient. With it, and
the degrees of ``deviations.py``, 92 % and more of the intrinsics lie within two standard deviations
of the truth on boards that are bowed, twisted, stretched or rough by 0.05 to 1 mm, in 3 to 25 views
(``tests/benchmarks/standard_deviations.py``)."""
_MAX_ITERATIONS = 50
"""Number of steps of expectation-maximisation, at most."""
_MAX_CHANGE = 1e-4
"""Relative change of every variance by a step below which they have settled."""
_MAX_MIXING = 3.0
"""Change of a variance's logarithm by mixing, at most: changes that are nearly alike lead far."""
_SHIFT_WEIGHT = 1.2922
"""The factor gamma of a shift's square, see above."""
_ROUNDING = 1e-12
"""Stiffness, relative to the information of the views, that rounding errors leave meaningful."""
_MIN_VIEWS_OF_CORNER = 3
"""Number of views that must show a corner for it to enter the test."""
_STIFFNESS = 1e-9
"""Part of the trace of a corner's H below which the views leave a direction open."""
_MIN_EXCESS = 5.0
"""Excess of chi^2, in its standard deviations, from which the board counts as imperfect."""


class LinearisedBoard(NamedTuple):
    """A calibration for the board as drawn, linearised in camera, poses and the board's corners."""

    points: Array
    """(n, 2) the board's corners, mm."""
    deviations: Deviations
    """The deviations that a prior is stated for."""
    views: Array
    """(K, P + 7, P + 7) products of each view's columns [camera, pose, r]."""
    normal: NormalEquations
    """The normal equations of the camera's P parameters followed by the Q coefficients of the
    deviations, and of the poses."""
    g: Array
    """(n, 3) see above."""
    H: Array
    """(n, 3, 3) see above."""
    seen: IntArray
    """(n,) number of views that show each corner."""


class BoardError(NamedTuple):
    """What the board's deviations, as far as prior and views tell, do to a calibration."""

    covariance: Array
    """(P, P) covariance C of the camera's free parameters of the joint estimate."""
    pose_covariances: Array
    """(K, 6, 6) covariances of the solver's local (w, tau) of the joint estimate."""
    shift: Array
    """(P,) camera of the joint estimate minus that for the board as drawn."""
    pose_shift: Array
    """(K, 6) the same of the poses, (w, tau)."""
    deviation: float
    """Deviation of the board's corners, mm rms, of the joint estimate."""


def linearise_board(
    estimate: Estimate, observations: Observations, model: str, free: IntArray
) -> LinearisedBoard:
    """Linearise an estimate with the image cost for the board as it is drawn.

    Args:
        estimate: the estimate.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
    """
    points, index = index_board_points(observations)
    deviations = make_deviations(points)
    K, P, n = len(index), len(free), len(points)
    views, total = np.empty((K, P + 7, P + 7)), np.zeros((n, 3, P + 4))
    by_pose = np.empty((K, 6, P + len(deviations.kind)))  # W^T: products with it are the faster
    for part, A, D, each in iterate_corner_products(
        estimate.state, observations, model, free, index, n
    ):
        views[part] = A
        total += each
        by_pose[part, :, :P] = A[:, P:-1, :P]
        deviations.contract(D, out=by_pose[part, :, P:])
    A, sums, H = views.sum(axis=0), deviations.contract(total[..., : P + 1]), total[..., P + 1 :]
    by_camera = sums[:P]
    normal = NormalEquations(
        np.block([[A[:P, :P], by_camera], [by_camera.T, deviations.contract_twice(H)]]),
        np.swapaxes(by_pose, 1, 2),
        views[:, P:-1, P:-1],
        np.append(A[:P, -1], sums[P]),
        views[:, P:-1, -1],
        *sum_costs(views[:, -1, -1]),
    )
    seen = np.bincount(index[observations.mask > 0], minlength=n).astype(np.int64)
    return LinearisedBoard(points, deviations, views, normal, total[..., P], H, seen)


def suspect_board(board: LinearisedBoard, sigma2: float) -> float:
    """Test whether the residuals look as if the board's corners were off.

    Args:
        board: the estimate for the board as it is drawn.
        sigma2: variance of one residual coordinate.

    Returns:
        Part of the squared residuals that the board's corners explain at least, beyond noise; 0 if
        the residuals do not look so.
    """
    tested = board.seen >= _MIN_VIEWS_OF_CORNER
    if not tested.any() or not sigma2 > 0:
        return 0.0
    # Copies of a view see a corner from one side only, which leaves a direction of it open: with a
    # trace of stiffness it adds nothing to chi^2, nor to what is expected of it.
    H, g = board.H[tested], board.g[tested, :, None]
    stiffness = _STIFFNESS * np.trace(H, axis1=1, axis2=2)[:, None, None]
    roots = invert_roots(H + stiffness * np.eye(3))
    expected = 3 * len(H) - float(np.sum(stiffness * roots**2))
    excess = float(np.sum((roots @ g) ** 2)) / sigma2 - expected
    if excess < _MIN_EXCESS * np.sqrt(2 * expected):
        return 0.0
    return excess * sigma2


class _Coefficients(NamedTuple):
    """Estimates of the coefficients q of the deviations from the views, given q's variances."""

    q: Array
    """(Q,) expected coefficients, mm."""
    root: Array
    """(Q, Q) R, where sigma^2 R R^T is their covariance."""
    sigma2: float
    """Variance of one residual coordinate."""


def estimate_board_error(
    board: LinearisedBoard, estimate: Estimate, count: int, prior: BoardShapePrior | None = None
) -> BoardError:
    """Estimate what the board's deviations do to a calibration that takes it for the drawing.

    Args:
        board: the estimate, linearised.
        estimate: the estimate with the image cost for the board as it is drawn.
        count: number of corners in all views.
        prior: deviations to expect; `DEFAULT_FLATNESS` if None.
    """
    normal, kind = board.normal, board.deviations.kind
    P, n = len(normal.U) - len(kind), len(board.points)
    joint = eliminate_poses(normal)
    right, S = joint.reduce_gradient(normal.shared, normal.pose), joint.S
    camera = covariances.invert_information(joint._replace(S=S[:P, :P], unit=joint.unit[:P]))[0]
    follow = -camera @ S[:P, P:]  # of the camera, by each coefficient

    def estimate_sigma2(gained: float, known: float) -> float:
        left = covariances.estimate_variance(
            normal.cost - gained, count, P + normal.pose.size + known
        )
        return left if left > 0 else estimate.sigma2

    q, root, sigma2 = _estimate_coefficients(
        S[P:, P:] + S[P:, :P] @ follow,
        right[P:] + right[:P] @ follow,
        kind,
        _expect_variances(board.points, kind, prior),
        prior is None,
        estimate_sigma2,
    )
    shift, root = follow @ q - camera @ right[:P], np.concatenate([follow @ root, root])
    # Higher degrees are as rough as most of those before: of noise's squares the median is 0.455.
    rough = q[kind == ROUGH] ** 2
    typical = float(np.median(rough)) / 0.455 if rough.size else 0.0
    square = float(q @ q) + max(3 * n - len(q) - 7, 0) * typical
    covariance = sigma2 * (root @ root.T)
    covariance[:P, :P] += sigma2 * camera
    return BoardError(
        covariance[:P, :P],
        covariances.compute_pose_covariances(joint, covariance, sigma2),
        shift,
        joint.solve_poses(-normal.pose, np.append(shift, q)),
        float(np.sqrt(square / n)),
    )


def _estimate_coefficients(
    S: Array,
    right: Array,
    kind: IntArray,
    expected: Array,
    is_learnt: bool,
    estimate_sigma2: Callable[[float, float], float],
) -> _Coefficients:
    """Estimate the coefficients of the deviations together with their variances.

    Args:
        S: (Q, Q) information of the views on them.
        right: (Q,) gradient of half the cost by them, at 0.
        kind: (Q,) kinds of the deviations.
        expected: (3,) variances of a coefficient of each kind that the prior expects, mm^2.
        is_learnt: false to keep these variances: what the user knows is not learnt from the views.
        estimate_sigma2: a function from the decrease of the cost and the number of coefficients
            that the views determine to the variance of one residual coordinate.
    """
    counts, information = np.bincount(kind, minlength=3), turn_rough_axes(S, right, kind)
    least = _ROUNDING * float(S.diagonal().max(initial=0.0))

    def take_step(logarithms: Array) -> tuple[Array, float]:
        stiffness = np.exp(logarithms)
        squares, inverses, gained = solve_stiffened(information, stiffness)
        sigma2 = estimate_sigma2(gained, len(S) - float(stiffness @ inverses))
        variances = expected
        if is_learnt:
            total = squares + sigma2 * inverses
            variances = (_PRIOR_FREEDOM * expected + total) / (_PRIOR_FREEDOM + counts)
        return np.log(np.fmax(sigma2 / variances, least)), sigma2

    start = np.log(np.fmax(estimate_sigma2(0.0, 0.0) / expected, least))
    logarithms, sigma2 = _mix_steps(take_step, start)
    factor, _ = scipy.linalg.lapack.dpotrf(S + np.diag(np.exp(logarithms)[kind]))
    root, _ = scipy.linalg.lapack.dtrtri(factor)
    return _Coefficients(-root @ (right @ root), root, sigma2)


class Information(NamedTuple):
    """Information of the views on m rough and s other coefficients, the rough ones' axes turned.

    All rough coefficients have one variance, and so the prior does not notice a turn that makes
    the views' information on them tridiagonal. Then a step factorises in O(m) what is stiffened,
    and the others' information, less what goes with the rough ones, is small.
    """

    kind: IntArray
    """(s,) kinds of the other coefficients."""
    others: Array
    """(s + 1, s + 1) information on these, and in the last row and column the gradient."""
    beside: Array
    """(m, s + 1) information between the rough and the other ones, and last the gradient."""
    rough: tuple[Array, Array]
    """(m,) entries on the diagonal of the information on the rough ones, (m - 1,) beside it."""


@with_kernel("board_shape", "solve_stiffened")
def solve_stiffened(information: Information, stiffness: Array) -> tuple[Array, Array, float]:
    """Solve for the coefficients, and invert what is known of them.

    Args:
        information: what the views tell of the coefficients.
        stiffness: (3,) sigma^2 / s^2 of each kind.

    Returns:
        By kind the sum (3,) of the squares of the coefficients, and that (3,) of the entries on the
        diagonal of the inverse of the stiffened information; the decrease of the cost.
    """
    kind, others, beside, (diagonal, next_to_it) = information
    tridiagonal = np.diag(diagonal + stiffness[ROUGH])
    tridiagonal += np.diag(next_to_it, 1) + np.diag(next_to_it, -1)
    inverse_of_rough = np.linalg.inv(tridiagonal)
    followed = inverse_of_rough @ beside
    left = others - beside.T @ followed
    inverse = np.linalg.inv(left[:-1, :-1] + np.diag(stiffness[kind]))
    q = -inverse @ left[:-1, -1]
    rough = -followed @ np.append(q, 1.0)
    squares, inverses = (
        np.asarray(np.bincount(kind, x, 3), np.float64) for x in (q * q, inverse.diagonal())
    )
    squares[ROUGH] += rough @ rough
    inverses[ROUGH] += np.trace(inverse_of_rough)
    inverses[ROUGH] += np.sum((followed[:, :-1] @ inverse) * followed[:, :-1])
    return squares, inverses, -float(others[-1, :-1] @ q + beside[:, -1] @ rough)


def turn_rough_axes(S: Array, right: Array, kind: IntArray) -> Information:
    """Turn the axes of the rough coefficients so that the information on them is tridiagonal.

    Args:
        S: (Q, Q) information of the views on the coefficients.
        right: (Q,) gradient of half the cost by them, at 0.
        kind: (Q,) kinds of the deviations. Of rough ones there are none, or three and more.
    """
    turned, others = np.flatnonzero(kind == ROUGH), np.flatnonzero(kind != ROUGH)
    rows = S[turned]
    beside, rough = np.column_stack([rows[:, others], right[turned]]), (np.zeros(0), np.zeros(0))
    if turned.size:
        lapack = scipy.linalg.lapack
        reflected, *chain, shares, _ = lapack.dsytrd(rows[:, turned].T, lower=True)
        rough = chain[0], chain[1]
        # The first axis stays. The workspace: LAPACK asks for 64 numbers a column at most.
        space = 64 * beside.shape[1]
        beside[1:] = lapack.dormqr("L", "T", reflected[1:, :-1], shares, beside[1:], space)[0]
    whole = np.zeros((len(others) + 1, len(others) + 1))
    whole[:-1, :-1] = S[np.ix_(others, others)]
    whole[-1, :-1] = whole[:-1, -1] = right[others]
    return Information(kind[others], whole, beside, rough)


def _mix_steps(take_step: Callable[[Array], tuple[Array, float]], x: Array) -> tuple[Array, float]:
    """Return the fixed point of a step, and what a step finds there, by Anderson's mixing of the
    last steps.

    Args:
        take_step: a function from a point (m,) to the next one and what it finds.
        x: (m,) the point to start from.
    """
    points: list[Array] = []
    changes: list[Array] = []
    for _ in range(_MAX_ITERATIONS):
        before = x
        after, found = take_step(before)
        points, changes = [*points[-len(x) :], x], [*changes[-len(x) :], after - x]
        if np.abs(changes[-1]).max() < _MAX_CHANGE:
            break
        x = after
        if len(points) > 1:
            by_point, by_change = (a[1:] - a[:-1] for a in map(np.array, (points, changes)))
            weights = scipy.linalg.lapack.dgelss(by_change.T, changes[-1])[1][: len(by_change)]
            x = after - np.clip(weights @ (by_point + by_change), -_MAX_MIXING, _MAX_MIXING)
    return before, found


def add_board_error(
    estimate: Estimate, error: BoardError, offset: tuple[Array, Array] | None = None
) -> Estimate:
    """Widen an estimate's covariances to what its errors on an imperfect board come to.

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
        camera_covariance=error.covariance + _SHIFT_WEIGHT * np.outer(camera, camera),
        pose_covariances=error.pose_covariances
        + _SHIFT_WEIGHT * poses[:, :, None] * poses[:, None, :],
    )


def _expect_variances(points: Array, kind: IntArray, prior: BoardShapePrior | None) -> Array:
    """Return the variances (3,) of a coefficient of each kind that the prior expects, mm^2."""
    usual = DEFAULT_FLATNESS * float(np.ptp(points, axis=0).max())
    flat, true = (usual, usual) if prior is None else (prior.out_of_plane, prior.in_plane)
    counts = np.maximum(np.bincount(kind, minlength=3), 1)
    smooth = len(points) * np.array([flat, true]) ** 2 / counts[:2]
    return np.append(smooth, _ROUGHNESS**2 * flat * true)

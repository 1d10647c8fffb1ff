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
(`BoardShapePrior`), which is kept. The default gives way to the data
(``deviation_variances.py``). The camera is eliminated first, after the poses, which leaves the
information on the coefficients alone.

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

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray, compute_median
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.board_shape.deviation_variances import (
    Coefficients,
    Noise,
    VariancePrior,
    estimate_coefficients,
)
from calibgui.engine.calibration.board_shape.deviations import ROUGH, Deviations, make_deviations
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    iterate_corner_products,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    Reduced,
    eliminate_poses,
    invert_roots,
    sum_costs,
)

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
_NO_FREEDOM = 1e-6
"""Degrees of freedom of a prior that yields to any view."""
_MAX_LINEAR = 3e-3
"""Deviation rms over the board's longer side beyond which a linear step from the drawing does not
tell of it: 1 mm of a board of 0.33 m. On one that was bowed by 14 % of its length, the camera for
the drawing explained the print and left a residual of 2 px."""
_SHIFT_WEIGHT = 1.2922
"""The factor gamma of a shift's square, see above."""
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
    """The effect on a calibration of the board's deviations, as far as prior and views tell."""

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


def measure_board_misfit(board: LinearisedBoard, sigma2: float) -> float:
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
    normal, kind, n = board.normal, board.deviations.kind, len(board.points)
    joint, right, camera, follow = _eliminate_camera(board)
    P = len(camera)
    variances = state_variance_prior(board.points, kind, prior)
    q, root, sigma2, _ = _solve_for_coefficients(
        board, joint, right, follow, variances, estimate, count
    )
    shift = follow @ q - camera @ right[:P]
    # Higher degrees are as rough as most of those before: of noise's squares the median is 0.455.
    rough = q[kind == ROUGH] ** 2
    typical = float(compute_median(rough)) / 0.455 if rough.size else 0.0
    square = float(q @ q) + max(3 * n - len(q) - 7, 0) * typical
    root = np.concatenate([follow @ root, root])
    covariance = sigma2 * (root @ root.T)
    covariance[:P, :P] += sigma2 * camera
    return BoardError(
        covariance[:P, :P],
        covariances.compute_pose_covariances(joint, covariance, sigma2),
        shift,
        joint.solve_poses(-normal.pose, np.append(shift, q)),
        float(np.sqrt(square / n)),
    )


def learn_variances(
    board: LinearisedBoard, estimate: Estimate, count: int, prior: BoardShapePrior | None
) -> Array:
    """Learn the variances (3,), mm^2, of a board's deviations by kind, for a shape to be estimated.

    They are what the views say, by restricted maximum likelihood (the prior's nu is next to 0): of
    a board on which noise explains what is seen they are next to 0 as well. What the user knows of
    the board is kept. From a board that is far from flat, the drawing leads astray, and nothing is
    learnt: the variances are then infinite.

    Args:
        board: the estimate, linearised.
        estimate: the estimate with the image cost for the board as it is drawn.
        count: number of corners in all views.
        prior: deviations that the user expects, or None.
    """
    expected = state_variance_prior(board.points, board.deviations.kind, prior)
    if prior is not None:
        return expected.expected
    joint, right, _, follow = _eliminate_camera(board)
    weak = expected._replace(freedom=_NO_FREEDOM)
    found = _solve_for_coefficients(board, joint, right, follow, weak, estimate, count)
    rms = np.linalg.norm(found.q) / np.sqrt(len(board.points))
    is_far = rms > _MAX_LINEAR * np.ptp(board.points, axis=0).max()
    return np.full(3, np.inf) if is_far else found.variances


def _eliminate_camera(board: LinearisedBoard) -> tuple[Reduced, Array, Array, Array]:
    """Eliminate poses and camera from a linearised calibration.

    Returns:
        The equations of camera and coefficients, their gradient (P + Q,), the camera's inverse
        information (P, P) for a board that is known, and how the camera follows the coefficients
        (P, Q).
    """
    normal = board.normal
    P = len(normal.U) - len(board.deviations.kind)
    joint = eliminate_poses(normal)
    right, S = joint.reduce_gradient(normal.shared, normal.pose), joint.S
    camera = covariances.invert_information(joint._replace(S=S[:P, :P], unit=joint.unit[:P]))[0]
    return joint, right, camera, -camera @ S[:P, P:]


def _solve_for_coefficients(
    board: LinearisedBoard,
    joint: Reduced,
    right: Array,
    follow: Array,
    prior: VariancePrior,
    estimate: Estimate,
    count: int,
) -> Coefficients:
    """Estimate the coefficients of a board's deviations, from what `_eliminate_camera` returns."""
    P, S = len(follow), joint.S
    return estimate_coefficients(
        S[P:, P:] + S[P:, :P] @ follow,
        right[P:] + right[:P] @ follow,
        board.deviations.kind,
        prior,
        Noise(board.normal.cost, 2 * count - P - board.normal.pose.size, estimate.sigma2),
    )


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


def state_variance_prior(
    points: Array, kind: IntArray, prior: BoardShapePrior | None
) -> VariancePrior:
    """Return the prior on the variances: what the user knows, else what boards usually have."""
    usual = DEFAULT_FLATNESS * float(np.ptp(points, axis=0).max())
    flat, true = (usual, usual) if prior is None else (prior.out_of_plane, prior.in_plane)
    counts = np.maximum(np.bincount(kind, minlength=3), 1)
    smooth = len(points) * np.array([flat, true]) ** 2 / counts[:2]
    expected = np.append(smooth, _ROUGHNESS**2 * flat * true)
    return VariancePrior(expected, _PRIOR_FREEDOM if prior is None else np.inf)

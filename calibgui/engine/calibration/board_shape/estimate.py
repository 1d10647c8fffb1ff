"""The board's shape, estimated with the camera, and refused where the views cannot carry it.

The solve starts from the solution for the board as it is drawn and adds the deviations
(``parametrisation.py``) to the unknowns. It is repeated where there is a prior or the corners have
covariances, because both are weighed against a noise that the better board lowers. A shape is
refused if there are too few views for it, or if some combination of its unknowns is left
undetermined; whether the shape stands in for the camera is checked by the caller.

A free shape has hundreds of unknowns. Estimated without a prior, they follow the noise, and where
board and camera look alike the camera follows them: of a board that is as drawn, cy comes out with
2 to 3 times the error that it has for the drawing. So its deviations have the prior of
``uncertainty.py``, N(0, s^2) with a variance for each kind, which the views themselves tell
(`learn_variances`; the corner by corner deviations beyond the polynomials have that of the rough
ones). With the projectors P_j on the kinds, which are orthogonal to the gauge,

    Lambda = sigma^2 sum_j P_j / s_j^2

is added to J^T J. Where views show deviations, Lambda is small beside it and changes little; where
noise explains them, they are eased back to the drawing, and the camera with them. Inverse and
sigma^2 are the posterior's: the unknowns count in the latter by what the views know of them,

    tr((S + Lambda)^-1 S) = Q - tr((S + Lambda)^-1 Lambda),

which makes the sum of the squared residuals over what is left of their number unbiased.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import (
    BoardShape,
    BoardShapeModel,
    BoardShapePrior,
    project_covariance,
)
from calibgui.engine.calibration.board_shape.deviations import make_deviations, split_by_kind
from calibgui.engine.calibration.board_shape.parametrisation import (
    displace_board_points,
    index_board_points,
    make_basis,
    make_board_shape_problem,
    make_gauge,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.residuals import BoardMotion, State, compute_misses
from calibgui.engine.calibration.refinement.schur import Reduced, eliminate_poses
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.errors import CalibrationError

_MIN_VIEWS = {BoardShapeModel.AFFINE: 3, BoardShapeModel.BOW: 3, BoardShapeModel.FREE: 6}
"""Number of views below which a model without a prior follows the noise and is refused."""
_MIN_VIEWS_OF_CORNER = 4
"""Number of views that must show every corner of a free board without a prior."""
SOLVES = 3
"""Number of solves where a prior or covariances are given; the noise hardly changes after them."""
_GAUGE_STIFFNESS = 1e4
"""Factor kappa of the gauge (``parametrisation.py``). A prior pulls at the scale of a board that
deviates by its square, which leaves a net scale of 1e-9 of the board or less with this factor."""
MIN_INFORMATION = 1e-9
"""Information left (``covariances.invert_information``) below which a shape is undetermined."""


def fit_board_shape(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    shape: BoardShapeModel,
    prior: BoardShapePrior | None,
    variances: Array,
    report: Report | None,
) -> tuple[Estimate, Array]:
    """Fit the board's shape with camera and poses, from the solution for the board as drawn.

    Args:
        nominal: the minimum with the image cost for the board as it is drawn.
        observations: the views, on the board as it is drawn.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        shape: the model of the deviations: affine, bow or free.
        prior: what is known beforehand of the corners of a free board.
        variances: (3,) variances of a free board's deviations by kind, mm^2.
        report: a function that is called with each iteration.

    Returns:
        The estimate, and the covariance (P, P) of the camera by what the views tell without a prior
        that they state themselves: what they leave open must not be closed by that.

    Raises:
        CalibrationError: if the views cannot determine the shape; the message says why.
    """
    points, index = index_board_points(observations)
    shown = np.bincount(index[observations.mask > 0], minlength=len(points))
    check_views(len(index), shown, shape, prior)
    deviations = allow_deviations(shape, points, variances)
    B, G, P = deviations.B, deviations.G, len(free)
    is_relearnt = prior is None and bool(deviations.precision.any())
    joint = _solve_jointly(
        nominal, observations, index, model, free, deviations, is_relearnt, report
    )
    reduced = eliminate_poses(joint.solution.normal)
    inverse = covariances.invert_information(reduced)[0]
    by_views = inverse
    if prior is None:  # a shape is what the views show: without its prior they must determine it
        by_views, left = covariances.invert_information(_forget_prior(reduced, joint, G))
        if left < MIN_INFORMATION:
            raise refuse_undetermined(shape)
    covariance = remove_gauge(joint.sigma2 * inverse, G, slice(P, None))
    camera, of_shape = covariance[:P, :P], covariance[P:, P:]
    motion = np.linalg.solve(camera, covariance[:P, P:]).T
    estimate = Estimate(
        solution=joint.solution,
        state=joint.state,
        observations=joint.observations,
        sigma2=joint.sigma2,
        camera_covariance=camera,
        pose_covariances=covariances.compute_pose_covariances(reduced, covariance, joint.sigma2),
        noise_covariance=camera,
        board_shape=deviations.describe(joint.deviation, of_shape),
        shape_unknowns=joint.unknowns,
        board_motion=BoardMotion(B @ motion, index),
    )
    return estimate, joint.sigma2 * by_views[:P, :P]


class AllowedDeviations(NamedTuple):
    """The deviations that are allowed (``parametrisation.py``), and what holds them."""

    shape: BoardShapeModel
    """The model of the board's shape that allows them."""
    points: Array
    """(n, 2) the board's corners, mm."""
    B: Array
    """(n, 3, Q) basis of the deviations."""
    G: Array
    """(Q, 7) gauge of a free board; (Q, 0) otherwise."""
    precision: Array
    """(Q, Q) inverse of the prior's covariance, 1/mm^2; 0 for boards that are not free."""

    def make_stiffness(self, sigma2: float) -> Array:
        """Make the (Q, Q) matrix of prior and gauge, which is added to J^T J.

        Args:
            sigma2: variance of one residual coordinate, px^2.
        """
        return sigma2 * self.precision + _GAUGE_STIFFNESS * self.G @ self.G.T

    def describe(self, deviation: Array, covariance: Array) -> BoardShape:
        """Return the shape of deviations (n, 3), mm, of coefficients of a covariance (Q, Q)."""
        flat = self.B.reshape(-1, self.B.shape[2])
        is_free = len(flat) == len(covariance)  # its basis is the identity
        of_corners = covariance if is_free else flat @ covariance @ flat.T
        return BoardShape(
            self.shape,
            self.points,
            deviation,
            np.sqrt(np.maximum(of_corners.diagonal(), 0.0)).reshape(-1, 3),
            project_covariance(self.points, of_corners),
        )


def allow_deviations(shape: BoardShapeModel, points: Array, variances: Array) -> AllowedDeviations:
    """Make the deviations that a model of the board's shape allows.

    Args:
        shape: the model.
        points: (n, 2) the board's corners, mm.
        variances: (3,) variances of a free board's deviations by kind, mm^2.
    """
    B = make_basis(shape, points)
    Q = B.shape[2]
    if shape is not BoardShapeModel.FREE:
        return AllowedDeviations(shape, points, B, np.zeros((Q, 0)), np.zeros((Q, Q)))
    G, (flat, true) = make_gauge(points), split_by_kind(make_deviations(points))
    of_flatness, of_print, of_others = 1 / variances
    precision = of_others * (np.eye(Q) - G @ G.T)
    precision += (of_flatness - of_others) * flat @ flat.T + (of_print - of_others) * true @ true.T
    return AllowedDeviations(shape, points, B, G, precision)


def recall_variances(shape: BoardShape) -> Array:
    """Return the variances (3,), mm^2, that a free shape was estimated with: where they have
    settled, they are the mean of the coefficients' squares, their variances included."""
    bases = split_by_kind(make_deviations(shape.nominal))
    F, rest = shape.factor_errors()
    errors = np.concatenate([F.reshape(shape.deviation.size, -1), np.diag(rest.ravel())], axis=1)
    d, total = shape.deviation.ravel(), float(np.sum(shape.deviation**2) + np.sum(shape.sigma**2))
    sums = [float(np.sum((B.T @ d) ** 2) + np.sum((B.T @ errors) ** 2)) for B in bases]
    return _average_squares(total, sums, [B.shape[1] for B in bases], d.size)


def relearn_variances(points: Array, q: Array, covariance: Array) -> Array:
    """Return the variances (3,) of a free board's deviations, mm^2, after a step of
    expectation-maximisation (``deviation_variances.py``) from corners q (Q,) of that covariance."""
    bases = split_by_kind(make_deviations(points))
    total = float(q @ q + np.trace(covariance))
    sums = [float(np.sum((B.T @ q) ** 2) + np.sum(B * (covariance @ B))) for B in bases]
    return _average_squares(total, sums, [B.shape[1] for B in bases], q.size)


def _average_squares(total: float, sums: list[float], counts: list[int], size: int) -> Array:
    """Return the mean squares (3,) of coefficients by kind, from the sums of the first two kinds
    and of all."""
    others = max(size - 7 - sum(counts), 1)
    found = [each / max(count, 1) for each, count in zip(sums, counts, strict=True)]
    # The sum of the others is a difference, and no smaller than rounding leaves it.
    smallest = max(np.finfo(float).tiny ** 0.25, np.finfo(float).eps * total / size)
    return np.maximum([*found, (total - sum(sums)) / others], smallest)


class _JointSolution(NamedTuple):
    """A solution with the unknowns of the board shape, and the same taken apart."""

    solution: Solution
    state: State
    """Camera and poses, without the unknowns of the board shape."""
    observations: Observations
    """The views, with the corners where the board has them."""
    deviation: Array
    """(n, 3) deviations of the board's corners, mm."""
    sigma2: float
    """Variance of one residual coordinate, px^2."""
    unknowns: float
    """Number of the shape's unknowns that the views know of."""
    stiffness: Array
    """(Q, Q) the part of prior and gauge in the normal equations."""


def _solve_jointly(
    nominal: Solution,
    observations: Observations,
    index: IntArray,
    model: str,
    free: IntArray,
    deviations: AllowedDeviations,
    is_relearnt: bool,
    report: Report | None,
) -> _JointSolution:
    """Solve for camera, poses and board shape together, from the solution for the drawing.

    Prior and weights are in units of the corners' noise, which the better board itself lowers. The
    variances of a free board's deviations are learnt again from each solution (`is_relearnt`): the
    drawing of a board that is far from flat tells little of them.
    """
    Q, P = deviations.B.shape[2], len(nominal.state.params)
    known = len(free) + nominal.normal.pose.size
    sigma2 = covariances.estimate_variance(nominal.normal.cost, observations.count, known)
    start = nominal.state._replace(params=np.append(nominal.state.params, np.zeros(Q)))
    solution = nominal._replace(state=start)
    is_solved_once = not deviations.precision.any() and observations.cov is None
    points, B = deviations.points, deviations.B
    for _ in range(1 if is_solved_once else SOLVES):
        stiffness = deviations.make_stiffness(sigma2)
        solution = minimise(
            make_board_shape_problem(observations, model, free, points, index, B, stiffness),
            solution.state,
            np.append(free, P + np.arange(Q)),
            observations.count,
            float(np.sum(observations.uv**2)),
            report,
            earlier=solution.history,
        )
        q = solution.state.params[P:]
        state = solution.state._replace(params=solution.state.params[:P])
        deviation = B @ q
        displaced = displace_board_points(observations, points, index, deviation)
        inverse = covariances.invert_information(eliminate_poses(solution.normal))[0]
        unknowns = Q - float(np.sum(inverse[-Q:, -Q:] * stiffness))
        if observations.cov is not None:
            miss = compute_misses(state, displaced, model, Cost.IMAGE)
            observations = whiten_observations(
                observations, estimate_model_variance(observations, miss, known + unknowns)
            )
        cost = solution.normal.cost - float(q @ stiffness @ q)
        sigma2 = covariances.estimate_variance(cost, observations.count, known + unknowns)
        if is_relearnt and np.isfinite(sigma2):
            learnt = relearn_variances(points, q, sigma2 * inverse[-Q:, -Q:])
            deviations = allow_deviations(BoardShapeModel.FREE, points, learnt)
    return _JointSolution(solution, state, displaced, deviation, sigma2, unknowns, stiffness)


def _forget_prior(reduced: Reduced, joint: _JointSolution, G: Array) -> Reduced:
    """Return the equations of camera and shape with the gauge G (Q, 7) in place of the prior."""
    S, added = reduced.S.copy(), joint.stiffness - G @ G.T
    diagonal, Q = joint.solution.normal.U.diagonal().copy(), len(added)
    S[-Q:, -Q:] -= added
    diagonal[-Q:] -= added.diagonal()
    return reduced._replace(S=S, unit=1 / np.sqrt(np.maximum(diagonal, np.finfo(float).tiny)))


def check_views(
    views: int, shown: IntArray, shape: BoardShapeModel, prior: BoardShapePrior | None
) -> None:
    """Refuse views that are too few for a model of the board's shape.

    Args:
        views: number of views.
        shown: (n,) number of views that show each of the board's corners.
        shape: the model.
        prior: what is known beforehand of the corners of a free board.

    Raises:
        CalibrationError: if they are.
    """
    if prior is None and _MIN_VIEWS[shape] > views:
        raise CalibrationError(
            f"{views} views cannot carry the board shape {shape.value!r}, which needs "
            f"{_MIN_VIEWS[shape]}.",
            "Add views, or keep the board as it is drawn.",
        )
    if shape is not BoardShapeModel.FREE or prior is not None:
        return
    if (rare := int((shown < _MIN_VIEWS_OF_CORNER).sum())) > 0:
        raise CalibrationError(
            f"{rare} of the board's {len(shown)} corners are seen in fewer than "
            f"{_MIN_VIEWS_OF_CORNER} views.",
            "A free board shape needs every corner in several views: add views of those parts, "
            "state a prior, or use the board shapes affine or bow.",
        )


def refuse_undetermined(shape: BoardShapeModel) -> CalibrationError:
    """Return the error that views do not determine a board's shape."""
    return CalibrationError(
        f"These views do not determine the board's shape ({shape.value}).",
        "Add views tilted in different directions that show the whole board, "
        "state a prior, or keep the board as it is drawn.",
    )


def remove_gauge(covariance: Array, G: Array, place: slice) -> Array:
    """Remove the directions of the gauge G (Q, 7), which are fixed by definition, from the
    coefficients at a place in a covariance."""
    left = covariance.copy()
    left[place] -= G @ (G.T @ left[place])
    left[:, place] -= (left[:, place] @ G) @ G.T
    return left

"""The board's shape, estimated with the camera, and refused where the views cannot carry it.

The solve starts from the solution for the board as it is drawn and adds the deviations
(``parametrisation.py``) to the unknowns. It is repeated where a prior or the corners' covariances
are given, because both are weighed against a noise that the better board lowers. A shape is refused
if there are too few views for it, or if some combination of its unknowns is left undetermined;
whether the shape stands in for the camera is checked by the caller.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import (
    displace_board_points,
    index_board_points,
    make_basis,
    make_board_shape_problem,
    make_gauge,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.residuals import BoardMotion, State, compute_misses
from calibgui.engine.calibration.refinement.schur import eliminate_poses
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.errors import CalibrationError

_MIN_VIEWS = {BoardShapeModel.AFFINE: 3, BoardShapeModel.BOW: 3, BoardShapeModel.FREE: 6}
"""Number of views below which a model without a prior follows the noise and is refused."""
_MIN_VIEWS_OF_CORNER = 4
"""Number of views that must show every corner of a free board without a prior."""
_SOLVES = 3
"""Number of solves where a prior or covariances are given; the noise hardly changes after them."""
_MIN_INFORMATION = 1e-9
"""Information left (``covariances.invert_information``) below which a shape is undetermined."""


def fit_board_shape(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    shape: BoardShapeModel,
    prior: BoardShapePrior | None,
    report: Report | None,
) -> Estimate:
    """Fit the board's shape with camera and poses, from the solution for the board as drawn.

    Args:
        nominal: the minimum with the image cost for the board as it is drawn.
        observations: the views, on the board as it is drawn.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        shape: the model of the deviations: affine, bow or free.
        prior: what is known beforehand of the corners of a free board.
        report: a function that is called with each iteration.

    Raises:
        CalibrationError: if the views cannot determine the shape; the message says why.
    """
    points, index = index_board_points(observations)
    check_views(observations, index, len(points), shape, prior)
    deviations = allow_deviations(shape, points, index, prior)
    B, G = deviations.B, deviations.G
    joint = _solve_jointly(nominal, observations, model, free, deviations, report)
    reduced = eliminate_poses(joint.solution.normal)
    inverse, left = covariances.invert_information(reduced)
    if left < _MIN_INFORMATION:
        raise CalibrationError(
            f"These views do not determine the board's shape ({shape.value}).",
            "Add views tilted in different directions that show the whole board, "
            "state a prior, or keep the board as it is drawn.",
        )
    P = len(free)
    covariance = _remove_gauge(joint.sigma2 * inverse, G, P)
    camera, shape_covariance = covariance[:P, :P], covariance[P:, P:]
    motion = np.linalg.solve(camera, covariance[:P, P:]).T
    return Estimate(
        solution=joint.solution,
        state=joint.state,
        observations=joint.observations,
        sigma2=joint.sigma2,
        camera_covariance=camera,
        pose_covariances=covariances.compute_pose_covariances(reduced, covariance, joint.sigma2),
        noise_covariance=camera,
        board_shape=BoardShape(shape, points, joint.deviation, _compute_sigma(B, shape_covariance)),
        shape_unknowns=deviations.unknowns,
        board_motion=BoardMotion(B @ motion, index),
    )


class AllowedDeviations(NamedTuple):
    """The deviations that are allowed (``parametrisation.py``), and the matrix that holds them."""

    points: Array
    """(n, 2) the board's corners, mm."""
    corner: IntArray
    """(K, N) index among these of each observation."""
    B: Array
    """(n, 3, Q) basis of the deviations."""
    G: Array
    """(Q, 7) gauge of a free board without a prior; (Q, 0) otherwise."""
    prior: BoardShapePrior | None

    @property
    def unknowns(self) -> int:
        """Number of unknowns, less those of the gauge."""
        return self.B.shape[2] - self.G.shape[1]

    def make_stiffness(self, sigma2: float) -> Array:
        """Make the (Q, Q) matrix of the prior or the gauge, which is added to J^T J.

        Args:
            sigma2: variance of one residual coordinate, px^2.
        """
        count, _, Q = self.B.shape
        if self.prior is None or 3 * count != Q:
            return self.G @ self.G.T
        s = np.array([self.prior.in_plane, self.prior.in_plane, self.prior.out_of_plane])
        return np.diag(np.tile(sigma2 / s**2, count))


def allow_deviations(
    shape: BoardShapeModel, points: Array, index: IntArray, prior: BoardShapePrior | None
) -> AllowedDeviations:
    """Make the deviations that a model of the board's shape allows."""
    B = make_basis(shape, points)
    gauged = prior is None and shape is BoardShapeModel.FREE
    G = make_gauge(points) if gauged else np.zeros((B.shape[2], 0))
    return AllowedDeviations(points, index, B, G, prior)


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


def _solve_jointly(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    deviations: AllowedDeviations,
    report: Report | None,
) -> _JointSolution:
    """Solve for camera, poses and board shape together, from the solution for the drawing.

    Prior and weights are in units of the corners' noise, which the better board itself lowers.
    """
    Q, P = deviations.B.shape[2], len(nominal.state.params)
    known = len(free) + nominal.normal.pose.size
    sigma2 = covariances.estimate_variance(nominal.normal.cost, observations.count, known)
    start = nominal.state._replace(params=np.append(nominal.state.params, np.zeros(Q)))
    solution = nominal._replace(state=start)
    is_solved_once = deviations.prior is None and observations.cov is None
    for _ in range(1 if is_solved_once else _SOLVES):
        solution = minimise(
            make_board_shape_problem(
                observations, model, free, *deviations[:3], deviations.make_stiffness(sigma2)
            ),
            solution.state,
            np.append(free, P + np.arange(Q)),
            observations.count,
            float(np.sum(observations.uv**2)),
            report,
            earlier=solution.history,
        )
        state = solution.state._replace(params=solution.state.params[:P])
        deviation = deviations.B @ solution.state.params[P:]
        displaced = displace_board_points(
            observations, deviations.points, deviations.corner, deviation
        )
        unknowns = known + deviations.unknowns
        if observations.cov is not None:
            miss = compute_misses(state, displaced, model, Cost.IMAGE)
            observations = whiten_observations(
                observations, estimate_model_variance(observations, miss, unknowns)
            )
        sigma2 = covariances.estimate_variance(solution.normal.cost, observations.count, unknowns)
    return _JointSolution(solution, state, displaced, deviation, sigma2)


def check_views(
    observations: Observations,
    index: IntArray,
    count: int,
    shape: BoardShapeModel,
    prior: BoardShapePrior | None,
) -> None:
    """Refuse views that are too few for a model of the board's shape."""
    K = len(observations.mask)
    if prior is None and _MIN_VIEWS[shape] > K:
        raise CalibrationError(
            f"{K} views cannot carry the board shape {shape.value!r}, which needs "
            f"{_MIN_VIEWS[shape]}.",
            "Add views, or keep the board as it is drawn.",
        )
    if shape is not BoardShapeModel.FREE or prior is not None:
        return
    seen = np.bincount(index[observations.mask > 0], minlength=count)
    if (rare := int((seen < _MIN_VIEWS_OF_CORNER).sum())) > 0:
        raise CalibrationError(
            f"{rare} of the board's {count} corners are seen in fewer than "
            f"{_MIN_VIEWS_OF_CORNER} views.",
            "A free board shape needs every corner in several views: add views of those parts, "
            "state a prior, or use the board shapes affine or bow.",
        )


def _compute_sigma(B: Array, covariance: Array) -> Array:
    """Compute the standard deviations (n, 3), mm, of the corners from the covariance of q."""
    flat = B.reshape(-1, B.shape[2])
    free = len(flat) == len(covariance)  # its basis is the identity
    variance = np.diag(covariance) if free else np.sum(flat @ covariance * flat, axis=1)
    return np.sqrt(np.maximum(variance, 0.0)).reshape(-1, 3)


def _remove_gauge(covariance: Array, G: Array, P: int) -> Array:
    """Remove the directions of the gauge, which are fixed by definition, from a covariance."""
    left = covariance.copy()
    left[P:] -= G @ (G.T @ left[P:])
    left[:, P:] -= (left[:, P:] @ G) @ G.T
    return left

"""The models of board, lens and views miss something, which is added to the uncertainties here.

The normal equations tell what the corners' noise does to the camera. That a board is not quite as
drawn (``board_shape/uncertainty.py``), or not quite of the shape that is held
(``board_shape/held.py``), that the lens model does not follow the lens
(``lens_error.py``), that views have errors of their own (``overdispersion.py``), they do not tell.

All of it is known of the image cost, whose residuals are those of the corners. The error of an
estimate by another cost, or by a closed form, is its distance from that of the image cost, and the
error of the latter.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.estimate import fit_board_shape
from calibgui.engine.calibration.board_shape.held import add_held_shape_error
from calibgui.engine.calibration.board_shape.uncertainty import (
    LinearisedBoard,
    add_board_error,
    estimate_board_error,
    learn_variances,
    linearise_board,
    measure_board_misfit,
)
from calibgui.engine.calibration.lens_error import measure_lens_error
from calibgui.engine.calibration.methods.lucchese import LUCCHESE
from calibgui.engine.calibration.methods.method import Problem, subtract_states
from calibgui.engine.calibration.overdispersion import add_overdispersion
from calibgui.engine.calibration.partial.partial_calibration import find_poorly_known
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.covariances import Estimate, make_estimate
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.calibration.score_tests import LinearisedFit
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_MAX_ITERATIONS = 100
"""Number of iterations from the minimum of another cost to that of the image cost, at most."""


def add_model_errors(estimate: Estimate, problem: Problem, report: Report | None) -> Estimate:
    """Estimate the board's shape if wanted, and widen the uncertainties by what models miss.

    Nothing is added for a splined lens: it has enough coefficients to follow what a board's shape
    or a single view does to the image, and the tests that tell these apart know few parameters.
    """
    if find_model(problem.model).control_points is not None:
        return estimate
    if problem.cost is not Cost.IMAGE:
        return add_errors_by_way_of_image_cost(estimate, problem)
    observations, model, free = estimate.observations, problem.model, problem.free
    if problem.held_shape is not None:
        estimate = add_held_shape_error(estimate, problem.held_shape, model, free)
        return add_overdispersion(estimate, model, free)
    board = linearise_board(estimate, observations, model, free)
    lens_error, is_suspect = _examine_lens(board, estimate, problem)
    views = None
    if problem.estimated_shape is BoardShapeModel.NOMINAL:
        error = estimate_board_error(board, estimate, observations.count, problem.prior)
        estimate, views = add_board_error(estimate, error), board.views
        if is_suspect:
            estimate = estimate._replace(board_shape_error=error.deviation)
    else:
        estimate = estimate_board_shape(estimate, problem, report, board)
    if lens_error > 0:
        estimate = estimate._replace(lens_error=lens_error, board_shape_error=0.0)
    return add_overdispersion(estimate, model, free, views)


def estimate_board_shape(
    estimate: Estimate,
    problem: Problem,
    report: Report | None,
    board: LinearisedBoard | None = None,
) -> Estimate:
    """Estimate the board's shape with the camera; return the estimate as it is if none is wanted.

    Raises:
        CalibrationError: if the views cannot determine the shape, or not the camera beside it.
    """
    shape, free, observations = problem.estimated_shape, problem.free, estimate.observations
    if shape is BoardShapeModel.NOMINAL:
        return estimate
    variances = np.full(3, np.inf)
    if shape is BoardShapeModel.FREE:
        board = board or linearise_board(estimate, observations, problem.model, free)
        variances = learn_variances(board, estimate, observations.count, problem.prior)
    fitted, by_views = fit_board_shape(
        estimate.solution,
        observations,
        problem.model,
        free,
        shape,
        problem.prior,
        variances,
        report,
    )
    _check_camera_known(fitted.state.params, by_views, problem)
    return fitted._replace(undetermined=estimate.undetermined)


def _examine_lens(
    board: LinearisedBoard, estimate: Estimate, problem: Problem
) -> tuple[float, bool]:
    """Measure the error of the lens model, px, and tell whether the residuals look like a board's.

    The lens is examined only if they do, since that takes its time.
    """
    explained = measure_board_misfit(board, estimate.sigma2)
    if explained == 0:
        return 0.0, False
    state, camera = estimate.state, problem.make_camera(estimate.state)
    fit = LinearisedFit(camera, state, estimate.observations, problem.free)
    return measure_lens_error(fit, explained), True


def add_errors_by_way_of_image_cost(estimate: Estimate, problem: Problem) -> Estimate:
    """Widen an estimate of another kind by its distance from where board and views have it."""
    by_image, free = replace(problem, cost=Cost.IMAGE, max_iterations=_MAX_ITERATIONS), problem.free
    try:
        weighted, solution = LUCCHESE.refine(by_image, estimate.state, None)
    except StartError:  # a lens that folds before it reaches the corners has no image cost
        return estimate
    any_sigma = np.full(len(free), np.inf)
    precision = covariances.measure_precision(
        solution.normal, problem.free_parameters, weighted.count, any_sigma
    )
    image = make_estimate(solution, weighted, precision)
    board = linearise_board(image, weighted, problem.model, free)
    lens_error, is_suspect = _examine_lens(board, image, problem)
    error = estimate_board_error(board, image, weighted.count, problem.prior)
    by_shared, by_pose = subtract_states(estimate.state, image.state)
    widened = add_overdispersion(
        add_board_error(image, error, (by_shared[free], by_pose)), problem.model, free, board.views
    )
    return estimate._replace(
        camera_covariance=widened.camera_covariance,
        pose_covariances=widened.pose_covariances,
        board_shape_error=error.deviation if is_suspect and lens_error == 0 else 0.0,
        lens_error=lens_error,
        overdispersion=widened.overdispersion,
    )


def _check_camera_known(params: Array, covariance: Array, problem: Problem) -> None:
    """Refuse an estimated board shape that stands in for the camera."""
    if names := find_poorly_known(params, covariance, problem):
        raise CalibrationError(
            f"With the board shape {problem.estimated_shape.value!r} these views leave "
            f"{', '.join(names)} undetermined: what the board does and what the camera does look "
            "alike in them.",
            "Add views with the board tilted by 20 to 45 degrees in different directions and all "
            "over the image, or keep the board as it is drawn.",
        )

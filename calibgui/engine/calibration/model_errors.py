"""What the models of board, lens and views miss, added to the uncertainties of a calibration.

The normal equations tell what the corners' noise does to the camera. That a board is not quite as
drawn (``board_shape/uncertainty.py``), that the lens model does not follow the lens
(``lens_error.py``), that views have errors of their own (``overdispersion.py``), they do not tell.

All three are known of the image cost, whose residuals are those of the corners. The error of an
estimate by another cost is its distance from that of the image cost, and the error of the latter.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.boards.shape import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.estimate import fit_board_shape
from calibgui.engine.calibration.board_shape.uncertainty import (
    LinearisedBoard,
    add_board_error,
    estimate_board_error,
    linearise_board,
    measure_board_misfit,
)
from calibgui.engine.calibration.lens_error import measure_lens_error
from calibgui.engine.calibration.methods.lucchese import LUCCHESE
from calibgui.engine.calibration.methods.method import subtract_states
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.overdispersion import add_overdispersion
from calibgui.engine.calibration.partial.partial_calibration import find_poorly_known
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.calibration.result_assembly import Estimate, make_estimate
from calibgui.engine.calibration.score_tests import LinearisedFit
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_MAX_ITERATIONS = 100
"""Number of iterations from the minimum of another cost to that of the image cost, at most."""


def add_model_errors(
    estimate: Estimate,
    observations: Observations,
    options: Options,
    prior: BoardShapePrior | None,
    report: Report | None,
) -> Estimate:
    """Estimate the board's shape if wanted, and widen the uncertainties by what models miss.

    Nothing is added for a splined lens: it has enough coefficients to follow what a board's shape
    or a single view does to the image, and the tests that tell these apart know few parameters.
    """
    if find_model(options.model).control_points is not None:
        return estimate
    if options.cost is not Cost.IMAGE:
        return _add_errors_by_way_of_image_cost(estimate, observations, options, prior)
    if options.board_shape is not None:
        return add_overdispersion(estimate, options.model, options.free)
    board = linearise_board(estimate, observations, options.model, options.free)
    lens_error, is_suspect = _examine_lens(board, estimate, observations, options)
    views = None
    if options.settings["plate"] == BoardShapeModel.NOMINAL:
        error, views = estimate_board_error(board, estimate, observations.count, prior), board.views
        estimate = add_board_error(estimate, error)
        if is_suspect:
            estimate = estimate._replace(board_shape_error=error.deviation)
    else:
        estimate = estimate_board_shape(estimate, observations, options, prior, report)
    if lens_error > 0:
        estimate = estimate._replace(lens_error=lens_error, board_shape_error=0.0)
    return add_overdispersion(estimate, options.model, options.free, views)


def estimate_board_shape(
    estimate: Estimate,
    observations: Observations,
    options: Options,
    prior: BoardShapePrior | None,
    report: Report | None,
) -> Estimate:
    """Estimate the board's shape with the camera; return the estimate as it is if none is wanted.

    Raises:
        CalibrationError: if the views cannot determine the shape, or not the camera beside it.
    """
    shape = BoardShapeModel(options.settings["plate"])
    if shape is BoardShapeModel.NOMINAL or options.board_shape is not None:
        return estimate
    estimate = fit_board_shape(
        estimate.solution, observations, options.model, options.free, shape, prior, report
    )
    _check_camera_known(estimate, options, shape)
    return estimate


def _examine_lens(
    board: LinearisedBoard, estimate: Estimate, observations: Observations, options: Options
) -> tuple[float, bool]:
    """Measure the error of the lens model, px, and tell whether the residuals look like a board's.

    The lens is examined only if they do, since that takes its time.
    """
    explained = measure_board_misfit(board, estimate.sigma2)
    if explained == 0:
        return 0.0, False
    camera = Camera(options.size, estimate.state.params, options.model)
    fit = LinearisedFit(camera, estimate.state, observations, options.free)
    return measure_lens_error(fit, explained), True


def _add_errors_by_way_of_image_cost(
    estimate: Estimate,
    observations: Observations,
    options: Options,
    prior: BoardShapePrior | None,
) -> Estimate:
    """Widen an estimate by another cost, by its distance from where board and views have it."""
    by_image, free = options._replace(cost=Cost.IMAGE), options.free
    try:
        weighted, solution = LUCCHESE.refine(
            whiten_observations(observations), estimate.state, by_image, None, _MAX_ITERATIONS
        )
    except StartError:  # a lens that folds before it reaches the corners has no image cost
        return estimate
    names, any_sigma = [options.names[i] for i in free], np.full(len(free), np.inf)
    image = make_estimate(
        solution,
        weighted,
        covariances.measure_precision(solution.normal, tuple(names), weighted.count, any_sigma),
    )
    board = linearise_board(image, weighted, options.model, free)
    lens_error, is_suspect = _examine_lens(board, image, weighted, by_image)
    error = estimate_board_error(board, image, weighted.count, prior)
    by_shared, by_pose = subtract_states(estimate.state, image.state)
    widened = add_overdispersion(
        add_board_error(image, error, (by_shared[free], by_pose)), options.model, free, board.views
    )
    return estimate._replace(
        camera_covariance=widened.camera_covariance,
        pose_covariances=widened.pose_covariances,
        board_shape_error=error.deviation if is_suspect and lens_error == 0 else 0.0,
        lens_error=lens_error,
        overdispersion=widened.overdispersion,
    )


def _check_camera_known(estimate: Estimate, options: Options, board_shape: BoardShapeModel) -> None:
    """Refuse an estimated board shape that stands in for the camera."""
    if names := find_poorly_known(estimate.state.params, estimate.camera_covariance, options):
        raise CalibrationError(
            f"With the board shape {board_shape.value!r} these views leave {', '.join(names)} "
            "undetermined: what the board does and what the camera does look alike in them.",
            "Add views with the board tilted by 20 to 45 degrees in different directions and all "
            "over the image, or keep the board as it is drawn.",
        )

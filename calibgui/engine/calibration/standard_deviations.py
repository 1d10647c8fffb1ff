"""The standard deviations of a solution, and the test that the views determine it at all.

The normal equations of the minimum tell what the corners' noise does to the camera
(``refinement/schur.py``, ``refinement/covariances.py``). What the models of board, lens and views
miss is added (``model_errors.py``), and where the cost rises more slowly than they say, its rise is
followed (``profile_likelihood.py``).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.methods.method import Refinement
from calibgui.engine.calibration.methods.simulated_covariance import simulate_covariances
from calibgui.engine.calibration.model_errors import (
    add_errors_by_way_of_image_cost,
    add_model_errors,
    estimate_board_shape,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.partial.degeneracy import (
    find_misfits,
    find_undetermined,
    is_in_one_spot,
)
from calibgui.engine.calibration.partial.refusal import refuse_undetermined
from calibgui.engine.calibration.profile_likelihood import add_profile_width
from calibgui.engine.calibration.refinement.covariances import (
    Estimate,
    Precision,
    make_estimate,
    measure_precision,
)
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.calibration.starting_point import StartingPoint
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model


def estimate_standard_deviations(
    point: StartingPoint, refinement: Refinement, report: Report | None
) -> Estimate:
    """Estimate the covariances of a solution, and the board's shape if that is wanted.

    Args:
        point: the problem.
        refinement: its solution.
        report: a function that is called with each iteration of a solve for the board's shape.

    Raises:
        CalibrationError, DegenerateError: as `calibrate`.
    """
    problem, (observations, solution) = point.problem, refinement
    camera = problem.make_camera(solution.state)
    tolerated = _compute_tolerated_deviations(camera, observations)[problem.free]
    precision = _measure_precision(point, refinement, tolerated)
    estimate = make_estimate(solution, observations, precision)
    if not problem.method.is_minimum:
        estimate = simulate_covariances(estimate, point.stated, problem.free)
        if problem.model_errors:
            estimate = add_errors_by_way_of_image_cost(estimate, problem)
    elif problem.model_errors:
        estimate = add_model_errors(estimate, problem, report)
        if problem.cost is Cost.IMAGE and estimate.board_shape is None:
            estimate = add_profile_width(estimate, problem, tolerated)
    else:
        estimate = estimate_board_shape(estimate, problem, report)
    return estimate


def _measure_precision(point: StartingPoint, refinement: Refinement, tolerated: Array) -> Precision:
    """Measure how precise the solution is, and raise if the views do not determine it.

    Args:
        point, refinement: as `estimate_standard_deviations`.
        tolerated: (P,) standard deviations beyond which the free parameters count as undetermined.
    """
    problem, (observations, solution) = point.problem, refinement
    names, camera = problem.free_parameters, problem.make_camera(solution.state)
    precision = measure_precision(solution.normal, names, observations.count, tolerated)

    def name_misfits() -> list[str]:
        misfits = find_misfits(point.stated.stage_one.of_all.rms)
        return [problem.view_names[k] for k in misfits.tolist()]

    lost = find_undetermined(solution, names, precision, name_misfits, camera)
    if lost or is_in_one_spot(observations.uv, problem.size):  # padding repeats a corner
        refuse_undetermined(point, observations, solution.state, lost)
    return precision


def _compute_tolerated_deviations(camera: Camera, observations: Observations) -> Array:
    """Compute the standard deviations (P,) beyond which parameters count as undetermined.

    They are a tenth of the focal length for focal lengths and centre, and for a coefficient the
    value that moves the outermost corner by its whole distance from the centre.
    """
    f, lens = camera.focal, find_model(camera.model)
    x, y = ((observations.uv[..., i] - camera.centre[i]) / f[i] for i in range(2))
    outermost = np.sqrt(np.max(x**2 + y**2))
    return np.concatenate([0.1 * f, 0.1 * f, outermost ** -np.array(lens.powers, float)])

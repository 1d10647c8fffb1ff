"""A calibration with an estimated board shape, led on to the minimum for some of its views.

Cross-validation fits camera and board shape without some of the views, to predict these. That
minimum is near the minimum for all views, from which one step of Gauss and Newton leads there but
for terms of the second order (Beirami et al. 2017; Giordano et al. 2019). Here the iteration begins
there and ends when that much has been reached: with the corners' weights as they are for all views,
and without the covariances of the shape, which nobody asks for. It takes a third of the time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.board_shape.estimate import allow_deviations, check_views
from calibgui.engine.calibration.board_shape.parametrisation import (
    displace_board_points,
    find_board_points,
    fit_basis,
    index_board_points,
    make_board_shape_problem,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.problem import (
    find_free_parameters,
    make_state,
    recover_arguments,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import Calibration, Report
from calibgui.engine.calibration.result_assembly import compute_view_residuals, make_poses
from calibgui.engine.geometry.rotations import vector_from_rotation

_MAX_DECREASE = 1e-8
"""Predicted decrease of the cost, relative to it, at which a fit to some of the views ends. The
views left out pull it back towards the minimum for all with the gradient that the others have
there, so that an end at 1e-5 made their errors up to 1 % too small on rendered boards; at this one
they are within a thousandth, far less than by what one shape has to be better than another
(``assessment/choices/cross_validation.py``)."""


def fit_some_views(
    whole: Calibration, views: Sequence[int], observations: Observations, report: Report | None
) -> Calibration:
    """Fit camera, poses and board shape to some of the views of a calibration.

    Args:
        whole: a calibration of all views that has estimated a board shape.
        views: indices of the views to fit, ascending.
        observations: these views, on the board as it is drawn.
        report: a function that is called with each iteration.

    Returns:
        The calibration with the camera, poses, residuals and board shape that these views have;
        everything else, the uncertainties above all, is still that of all views.

    Raises:
        CalibrationError: if there are too few views for the shape.
    """
    shape, free, camera = whole.board_shape, find_free_parameters(whole), whole.camera
    assert shape is not None
    points, index = index_board_points(observations)
    prior = recover_arguments(whole)["prior"]
    check_views(observations, index, len(points), shape.model, prior)
    deviations = allow_deviations(shape.model, points, index, prior)
    B, P, Q = deviations.B, len(camera.params), deviations.B.shape[2]
    q = fit_basis(B, shape.deviation[find_board_points(shape, points)])
    begin = make_state(camera, [whole.poses[k] for k in views])
    weighted = whiten_observations(observations, whole.model_error**2)
    found = minimise(
        make_board_shape_problem(
            weighted, camera.model, free, *deviations[:3], deviations.make_stiffness(whole.noise**2)
        ),
        begin._replace(params=np.append(begin.params, q)),
        np.append(free, P + np.arange(Q)),
        weighted.count,
        float(np.sum(weighted.uv**2)),
        report,
        max_decrease=_MAX_DECREASE,
    ).state
    state, deviation = found._replace(params=found.params[:P]), B @ found.params[P:]
    placed = displace_board_points(weighted, points, index, deviation)
    return replace(
        whole,
        camera=replace(camera, params=state.params),
        poses=make_poses(vector_from_rotation(state.R), state.T),
        residuals=compute_view_residuals(
            state, placed, camera.model, whole.cost, whole.reference_scale
        ),
        board_shape=BoardShape(shape.model, points, deviation, np.zeros(deviation.shape)),
    )

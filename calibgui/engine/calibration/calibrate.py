"""The whole calibration, in five steps that are the same for every method (``methods/``).

1. ``problem.py``: views and arguments are checked, and state a `Problem`.
2. ``starting_point.py``: the method guesses the camera and the poses.
3. ``solve.py``: the method refines the guess to the minimum of the cost.
4. ``standard_deviations.py``: what the corners' noise does to the camera, and what the models of
   board, lens and views miss; views that do not determine the camera are refused, with what they
   do determine (``partial``).
5. ``result_assembly.py``: the `Calibration` that is handed over.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence

from calibgui.engine.arrays import Array, Size
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.held_values import blame_held_values
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import state_problem
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration, Cost, Report
from calibgui.engine.calibration.result_assembly import assemble_calibration
from calibgui.engine.calibration.solve import solve
from calibgui.engine.calibration.standard_deviations import estimate_standard_deviations
from calibgui.engine.calibration.starting_point import find_starting_point
from calibgui.engine.threads import with_one_blas_thread


@with_one_blas_thread
@blame_held_values
def calibrate(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    cost: Cost | str = Cost.IMAGE,
    fix: Mapping[str, float | None] | Iterable[str] | str = (),
    free: Iterable[str] | str = (),
    model: str | None = None,
    report: Report | None = None,
    board_shape: BoardShapeModel | str | BoardShape = BoardShapeModel.NOMINAL,
    prior: BoardShapePrior | None = None,
    max_iterations: int = 100,
    names: Sequence[str] | None = None,
    method: str | Method = DEFAULT_METHOD,
    model_errors: bool = True,
) -> Calibration:
    """Calibrate a camera from views of a flat board.

    Args:
        views: per view the measured corners uv (n, 2) px in the array frame, the same
            corners on the board xy (n, 2) mm, and optionally the covariances of uv
            (n, 2, 2) px^2, for all views or for none. Views may show different parts of the
            board.
        size: width and height of the images, px.
        cost: the cost to minimise, see `Cost`. `Cost.PAPER` is the printed method: the
            reference grid of equal pixels, radius in pixels and p3 free.
        fix: names of intrinsics to hold, with their values; without a value (or with None)
            coefficients are held at 0, the centre at the array's and focal lengths at the
            closed form.
        free: names of intrinsics to estimate although they are held by default (p3).
        model: the lens model, a key of ``camera.models.MODELS``; the method's own by default, which
            is the paper's for the paper's method.
        report: a function that is called with each iteration; it stops the solve by returning
            False.
        board_shape: the model of the board's deviations from its drawing, which are estimated
            with the camera; or a shape that was estimated before, which is held, and whose errors
            count in every uncertainty (``board_shape/held.py``). Both need the image cost.
        prior: deviations of the board's corners to expect, where more is known of them than that
            boards are flat and true to some 0.03 % of their size (``board_shape/uncertainty.py``).
            They count in every uncertainty for a board that is taken as drawn, and regularise a
            `free` board shape in place of what the views tell of them; the other models need none.
        max_iterations: the largest number of iterations of a solve; corners with covariances take
            a few solves.
        names: names of the views for messages; numbers by default.
        method: the method of calibration, a key of ``methods.METHODS`` or one made like those.
        model_errors: whether the uncertainties count what the models of board, lens and views
            miss. Without, they are those of the corners' noise alone, which saves half of the
            time where many calibrations are made and only their cameras are wanted.

    Raises:
        CalibrationError: if a view cannot be used (the message names it), or if an argument does
            not exist or contradicts another one.
        DegenerateError: if the views do not determine the camera. It says what to photograph and
            holds, in `partial`, what the views do determine.
        Cancelled: if `report` raises it.

    Examples:
        A camera photographs a board of 7 x 6 corners five times, tilted in different directions.

        >>> import numpy as np
        >>> from calibgui.engine import Board, Camera, Pose, calibrate, project_points
        >>> board = Board(rows=6, cols=7, square=30.0)
        >>> truth = Camera((640, 480), [650, 650, 320, 240, 0.2, 0, 0, 0, 0, 0])
        >>> xy = board.points()
        >>> tilts = [(0.5, 0, 0), (-0.5, 0, 0), (0, 0.5, 0), (0, -0.5, 0), (0.3, 0.4, 0)]
        >>> views = [(project_points(xy, truth, Pose(r, (-90, -75, 500))), xy) for r in tilts]
        >>> calibration = calibrate(views, truth.size)
        >>> calibration.status.value
        'converged'
        >>> bool(np.allclose(calibration.camera.params, truth.params, atol=1e-5))
        True
    """
    problem = state_problem(
        views,
        size,
        cost=cost,
        fix=fix,
        free=free,
        model=model,
        board_shape=board_shape,
        prior=prior,
        max_iterations=max_iterations,
        names=names,
        method=method,
        model_errors=model_errors,
    )
    began = time.perf_counter()
    point = find_starting_point(problem)
    refinement = solve(point, report)
    seconds = time.perf_counter() - began
    estimate = estimate_standard_deviations(point, refinement, report)
    return assemble_calibration(point, estimate, seconds)

"""The whole calibration: checks, initialisation, refinement, uncertainty and diagnosis.

`calibrate` follows one order whatever the method (``methods/``):

1. The views are checked and brought into arrays (``observations.py``).
2. The method guesses the camera and the poses, and refines the guess to the minimum of the cost.
3. Views that do not determine the camera are named, with what they do determine (``partial``).
4. The board's shape is estimated if that is wanted, and the uncertainties are widened by what the
   models of board, lens and views miss (``model_errors.py``).
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import place_on_board_shape
from calibgui.engine.calibration.held_values import blame_held_values
from calibgui.engine.calibration.initialisation.control_points import (
    check_control_points,
    choose_control_points,
)
from calibgui.engine.calibration.initialisation.start import check_facing
from calibgui.engine.calibration.methods import DEFAULT_METHOD, check_method, find_method
from calibgui.engine.calibration.methods.method import Given, Method
from calibgui.engine.calibration.methods.simulated_covariance import simulate_covariances
from calibgui.engine.calibration.model_errors import add_model_errors, estimate_board_shape
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    arrange_by_axis,
    measure_pitch,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.options import Options, resolve_held_parameters
from calibgui.engine.calibration.partial.degeneracy import (
    diagnose_degeneracy,
    find_copies,
    find_misfits,
    find_undetermined,
    is_in_one_spot,
)
from calibgui.engine.calibration.partial.partial_calibration import (
    estimate_partially,
)
from calibgui.engine.calibration.profile_likelihood import add_profile_width
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import (
    Calibration,
    Cost,
    DegenerateError,
    Report,
    StageOne,
    StageOneTable,
)
from calibgui.engine.calibration.result_assembly import (
    assemble_calibration,
    make_estimate,
    tabulate_stage_one,
)
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.models import (
    PINHOLE,
    find_model,
    list_parameter_names,
    resolve_model_id,
)
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from calibgui.engine.errors import CalibrationError, parse_choice
from calibgui.engine.threads import with_one_blas_thread

_MAX_OUTSIDE = 0.5
"""Distance outside the image beyond which corners are refused, in the image's longer side."""
_MAX_SHARE_NEGATIVE = 0.1
"""Share of the corners left of the image or above it, beyond which they are of another frame: of
one whose origin is in the middle three quarters are."""


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
            with the camera; or a shape that was estimated before, which is held. Both need the
            image cost.
        prior: deviations of the board's corners to expect, where more is known of them than that
            boards are flat and true to some 0.03 % of their size (``board_shape/uncertainty.py``).
            They count in every uncertainty for a board that is taken as drawn, and regularise a
            `free` board shape; the other models need none.
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
    cost = parse_choice(Cost, cost, "cost")
    steps = find_method(method)
    model = (
        "lucchese-pixels" if cost is Cost.PAPER else resolve_model_id(model or steps.lens_models[0])
    )
    if isinstance(board_shape, BoardShape):
        held_shape, shape_model = board_shape, board_shape.model
    else:
        held_shape, shape_model = None, parse_choice(BoardShapeModel, board_shape, "board shape")
    as_drawn = held_shape is None and shape_model is BoardShapeModel.NOMINAL
    if not as_drawn:
        _check_takes_board_shape(cost, steps)
    size, names = check_image_size(size), names or name_views(len(views))
    observations = pack_observations(views, names)
    if not steps.is_weighted:
        observations = replace(observations, cov=None)
    _check_size(observations, size, names)
    if model == PREFIX:
        model = choose_control_points(observations, size)
    lens, parameters = find_model(model), list_parameter_names(model)
    if lens.control_points is not None and not as_drawn:
        raise CalibrationError(
            "A splined lens model is not estimated together with the shape of a board.",
            "Choose another lens model, or keep the board as it is drawn.",
        )
    check_method(steps, model, cost)
    held = resolve_held_parameters(fix, free, model, size, steps.held)
    scale = REFERENCE_PITCH / measure_pitch(observations)
    given = Given(observations, scale, check_facing(observations, names), size, model, held)
    began = time.perf_counter()
    start, values, remarks = steps.initialise(given)
    seconds = time.perf_counter() - began
    check_control_points(start, observations, lens)
    settings = {
        "cost": cost.value,
        "model": model,
        "fixed": values,
        "max_iterations": max_iterations,
        "plate": shape_model.value,
        "plate_held": held_shape is not None,
        "prior_mm": None if prior is None else [prior.in_plane, prior.out_of_plane],
    }
    if steps.name != DEFAULT_METHOD:  # results of the default stay as they were without others
        settings["method"] = steps.name
    table = StageOneTable(partial(_tabulate_stage_one, given, cost))
    options = Options(size, model, cost, scale, parameters, values, table, held_shape, settings)
    if held_shape is not None:
        observations = place_on_board_shape(observations, held_shape)
    if cost is Cost.IMAGE:  # the covariances are of corners in the image
        observations = whiten_observations(observations)
    originals = find_copies(zip(observations.uv, observations.xy, strict=True))
    if not originals.any():
        # One plane gives two equations on these.
        unheld = [name for name in PINHOLE if name not in held]
        lost = unheld if len(unheld) > 2 else ()
        _raise_if_undetermined(observations, originals, options, start, lost)
    began = time.perf_counter()
    observations, solution = steps.refine(observations, start, options, report, max_iterations)
    seconds += time.perf_counter() - began
    camera = Camera(size, solution.state.params, model)
    tolerated = _compute_tolerated_deviations(camera, observations)[options.free]
    precision = _measure_precision(
        solution, observations, originals, options, tolerated, partial(_name_misfits, given, names)
    )
    estimate = make_estimate(solution, observations, precision)
    undetermined = precision.undetermined
    if not steps.is_minimum:
        run = partial(_rerun_method, steps, given, options)
        estimate = simulate_covariances(estimate, options, run)
    elif model_errors:
        estimate = add_model_errors(estimate, observations, options, prior, report)
        if cost is Cost.IMAGE and estimate.board_shape is None:
            estimate, opened = add_profile_width(estimate, observations, options, tolerated)
            undetermined = tuple({u.name: u for u in (*opened, *undetermined)}.values())
    else:
        estimate = estimate_board_shape(estimate, observations, options, prior, report)
    digest = _compute_digest(observations, settings)
    return assemble_calibration(estimate, options, undetermined, digest, remarks, seconds)


def _check_takes_board_shape(cost: Cost, method: Method) -> None:
    """Refuse a cost or a method that takes the board as it is drawn."""
    if cost is not Cost.IMAGE:
        raise CalibrationError(
            f"The cost {cost.value!r} registers the views on a flat board as it is drawn.",
            "Use the cost 'image' with another board shape.",
        )
    if not method.is_weighted:
        raise CalibrationError(
            f"The method {method.name!r} takes the board as it is drawn.",
            f"Use the method {DEFAULT_METHOD!r} with another board shape.",
        )


def _tabulate_stage_one(given: Given, cost: Cost) -> tuple[StageOne, ...]:
    """Tabulate Stage I of all views, which the start may have done with fewer of."""
    return tabulate_stage_one(given.registration, on_paper_grid=cost is Cost.PAPER)


def _name_misfits(given: Given, names: Sequence[str]) -> list[str]:
    """Name the views whose corners fit no flat board in Stage I."""
    return [names[k] for k in find_misfits(given.registration.rms).tolist()]


def _rerun_method(
    method: Method, given: Given, options: Options, observations: Observations
) -> State:
    """Return what a method finds in other corners of the same views."""
    start = method.initialise(replace(given, observations=observations)).state
    return method.refine(observations, start, options, None, 0).solution.state


def _measure_precision(
    solution: Solution,
    observations: Observations,
    originals: IntArray,
    options: Options,
    tolerated: Array,
    name_misfits: Callable[[], list[str]],
) -> covariances.Precision:
    """Measure how precise the solution is, and raise if the views do not determine it.

    Args:
        solution: the minimum.
        observations: the views.
        originals: (K,) the view that each one copies, from `find_copies`.
        options: the options of the calibration.
        tolerated: (P,) standard deviations beyond which the free parameters count as undetermined.
        name_misfits: a function that returns the names of the views that fit no flat board.

    Raises:
        CalibrationError, DegenerateError: as `calibrate`.
    """
    names = tuple(options.names[i] for i in options.free)
    camera = Camera(options.size, solution.state.params, options.model)
    precision = covariances.measure_precision(solution.normal, names, observations.count, tolerated)
    lost = find_undetermined(solution, names, precision, name_misfits, camera)
    if lost or is_in_one_spot(observations.uv, options.size):  # padding repeats a corner
        _raise_if_undetermined(observations, originals, options, solution.state, lost)
    return precision


def _raise_if_undetermined(
    observations: Observations,
    originals: IntArray,
    options: Options,
    state: State,
    lost: Sequence[str],
) -> None:
    """Raise DegenerateError with what the views do determine; return if that is everything.

    Args:
        observations: the views.
        originals: (K,) the view that each one copies, from `find_copies`.
        options: the options of the calibration.
        state: camera and poses, as far as they are known.
        lost: focal lengths and coordinates of the centre that the views do not determine.
    """
    partial = estimate_partially(observations, originals, options, state.params)
    if partial is None:
        diagnosis = diagnose_degeneracy(observations, options.size, originals, state, lost)
        raise DegenerateError(diagnosis.message, diagnosis.hint)
    estimate, assumptions = partial
    if not (lost or assumptions):
        return
    lost = [assumption.name for assumption in assumptions] or lost
    diagnosis = diagnose_degeneracy(observations, options.size, originals, estimate.state, lost)
    if options.board_shape is None and options.settings["plate"] != BoardShapeModel.NOMINAL:
        message = f"{diagnosis.message} The board's shape is not estimated."
        diagnosis = replace(diagnosis, message=message)
    calibration = assemble_calibration(
        estimate, options, (), _compute_digest(observations, options.settings)
    )
    raise DegenerateError(
        diagnosis.message,
        diagnosis.hint,
        replace(calibration, diagnosis=replace(diagnosis, assumptions=assumptions)),
    )


def _check_size(observations: Observations, size: Size, names: Sequence[str]) -> None:
    """Refuse corners that an image of this size cannot show."""
    u, v = corners = arrange_by_axis(observations.uv)
    low, high = corners.min(axis=2), corners.max(axis=2)  # padding repeats a corner
    if (low >= 0).all() and (high.max(axis=1) <= size).all():
        return
    share = float(np.mean(((u < -1) | (v < -1))[observations.mask > 0])) if low.min() < -1 else 0.0
    if share > _MAX_SHARE_NEGATIVE:
        raise CalibrationError(
            f"{100 * share:.0f} % of the corners lie left of the image or above it.",
            "Is (0, 0) the centre of the upper left pixel? Corners of a frame whose origin is in "
            "the middle of the image must be moved there.",
        )

    def find_views_outside(size: Size, margin: float) -> BoolArray:
        beyond = (low < -margin) | (high > np.array(size)[:, None] + margin)
        return np.asarray(beyond.any(axis=0))

    far, swapped = find_views_outside(size, _MAX_OUTSIDE * max(size)), find_views_outside(size, 0.0)
    if swapped.any():
        swapped &= not find_views_outside(size[::-1], 0.0).any()
    if (wrong := far | swapped).any():
        raise CalibrationError(
            f"{names[int(np.argmax(wrong))]} has corners {'far ' if far.any() else ''}outside an "
            f"image of {size[0]} x {size[1]} pixels.",
            "Check the image size, given as width, height.",
        )


def _compute_tolerated_deviations(camera: Camera, observations: Observations) -> Array:
    """Compute the standard deviations (P,) beyond which parameters count as undetermined.

    They are a tenth of the focal length for focal lengths and centre, and for a coefficient the
    value that moves the outermost corner by its whole distance from the centre.
    """
    f, lens = camera.focal, find_model(camera.model)
    x, y = ((observations.uv[..., i] - camera.centre[i]) / f[i] for i in range(2))
    outermost = np.sqrt(np.max(x**2 + y**2))
    return np.concatenate([0.1 * f, 0.1 * f, outermost ** -np.array(lens.powers, float)])


def _compute_digest(observations: Observations, settings: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the views and settings of a calibration."""
    digest = hashlib.sha256(repr(sorted(settings.items())).encode())
    for array in (observations.uv, observations.xy, observations.mask, observations.cov):
        if array is not None:
            digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()

"""A calibration's problem: stated from views and arguments, or again from the result.

`state_problem` is the first step of `calibrate`: it checks what it is given.

A `Calibration` holds results only: parameters, poses, residuals. Whoever analyses one (how far each
view determines the camera, what a further view would add, what leaving one out changes) needs the
problem as the solver saw it: the arguments of `calibrate`, the views with their weights and on the
board that was found, and the state at the minimum. These are recovered here from the result and its
views, so that a result read from a file can be analysed like a fresh one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import place_on_board_shape
from calibgui.engine.calibration.initialisation.control_points import choose_control_points
from calibgui.engine.calibration.initialisation.start import check_facing
from calibgui.engine.calibration.methods import check_method, find_method
from calibgui.engine.calibration.methods.method import Method, Problem
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    arrange_by_axis,
    measure_pitch,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration, Cost
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.models import find_model, list_parameter_names, resolve_model_id
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from calibgui.engine.errors import CalibrationError, parse_choice
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.pose import Pose

_MAX_HELD = 100.0
"""Largest focal length or coordinate of the centre that can be held, in the image's longer side."""
_MAX_OUTSIDE = 0.5
"""Distance outside the image beyond which corners are refused, in the image's longer side."""
_MAX_SHARE_NEGATIVE = 0.1
"""Share of the corners left of the image or above it, beyond which they are of another frame: of
one whose origin is in the middle three quarters are."""


def state_problem(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    cost: Cost | str,
    fix: Mapping[str, float | None] | Iterable[str] | str,
    free: Iterable[str] | str,
    model: str | None,
    board_shape: BoardShapeModel | str | BoardShape,
    prior: BoardShapePrior | None,
    max_iterations: int,
    names: Sequence[str] | None,
    method: str | Method,
    model_errors: bool,
) -> Problem:
    """State the problem of views and arguments, which are those of `calibrate`, and check both.

    Raises:
        CalibrationError: if a view cannot be used (the message names it), or if an argument does
            not exist or contradicts another one.
    """
    cost, method = parse_choice(Cost, cost, "cost"), find_method(method)
    if type(max_iterations) is not int or max_iterations < 0:
        raise CalibrationError(
            f"A solve cannot have {max_iterations} iterations.",
            "Give their largest number, a whole one from 0 on.",
        )
    model = (
        "lucchese-pixels"
        if cost is Cost.PAPER
        else resolve_model_id(model or method.lens_models[0])
    )
    if not isinstance(board_shape, BoardShape):
        board_shape = parse_choice(BoardShapeModel, board_shape, "board shape")
    is_as_drawn = board_shape is BoardShapeModel.NOMINAL
    if not is_as_drawn:
        _check_takes_board_shape(cost, method)
    size, names = check_image_size(size), names or name_views(len(views))
    observations = pack_observations(views, names)
    if not method.is_weighted:
        observations = replace(observations, cov=None)
    _check_size(observations, size, names)
    if model == PREFIX:
        model = choose_control_points(observations, size)
    if find_model(model).control_points is not None and not is_as_drawn:
        raise CalibrationError(
            "A splined lens model is not estimated together with the shape of a board.",
            "Choose another lens model, or keep the board as it is drawn.",
        )
    check_method(method, model, cost)
    held = resolve_held_parameters(fix, free, model, size, method.held)
    return Problem(
        observations=observations,
        view_names=names,
        scale=REFERENCE_PITCH / measure_pitch(observations),
        facing=check_facing(observations, names),
        size=size,
        method=method,
        model=model,
        cost=cost,
        held=held,
        board_shape=board_shape,
        prior=prior,
        model_errors=model_errors,
        max_iterations=max_iterations,
    )


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


def resolve_held_parameters(
    fix: Mapping[str, float | None] | Iterable[str] | str,
    free: Iterable[str] | str,
    model: str,
    size: Size,
    default: tuple[str, ...] | None = None,
) -> dict[str, float | None]:
    """Find the parameters to hold, with the values wanted, None for the default value.

    Args:
        fix: names of parameters to hold, with or without values.
        free: names of parameters to estimate although they are held by default.
        model: the lens model, a key of ``camera.models.MODELS``.
        size: width and height of the images, px.
        default: names of the parameters that are held by default; None for those of the lens model.

    Raises:
        CalibrationError: if a parameter does not exist, is both held and freed, or is held at a
            value that no camera has.
    """
    names = list_parameter_names(model)
    fix, freed = ([given] if isinstance(given, str) else given for given in (fix, free))
    wanted = dict(fix) if isinstance(fix, Mapping) else dict.fromkeys(fix)
    freed = set(freed)
    for name in [*wanted, *freed]:
        if name not in names:
            raise CalibrationError(
                f"The lens model {model!r} has no parameter {name!r}.",
                f"Choose from {', '.join(names)}.",
            )
    for name, value in wanted.items():
        if value is not None:
            _check_value(name, value, size)
    if both := freed & wanted.keys():
        raise CalibrationError(
            f"{', '.join(sorted(both))} cannot be both held and freed.", "Name it once."
        )
    usual = find_model(model).held if default is None else default
    return dict.fromkeys(name for name in usual if name not in freed) | wanted


def _check_value(name: str, value: float, size: Size) -> None:
    """Refuse to hold a parameter at a value that no camera has."""
    most = _MAX_HELD * max(size)
    low, high = {"f": (0.0, most), "c": (-most, most)}.get(name[0], (-np.inf, np.inf))
    if not low < value < high:
        raise CalibrationError(
            f"{name} cannot be held at {value}.",
            "Focal lengths are positive, in pixels, and the centre is near the image.",
        )


def recover_arguments(calibration: Calibration) -> dict[str, Any]:
    """Recover the keyword arguments of `calibrate` that repeat a calibration on other views.

    They are the cost, the lens model, the held parameters with their values, the board shape, what
    was known of it beforehand, and the method.
    """
    camera = calibration.camera
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    held = {name: values[name] for name in calibration.fixed}
    board_shape: BoardShape | BoardShapeModel = BoardShapeModel.NOMINAL
    if calibration.board_shape is not None:
        is_held = calibration.settings.is_board_shape_held
        board_shape = calibration.board_shape if is_held else calibration.board_shape.model
    return {
        "cost": calibration.cost,
        "model": camera.model,
        "fix": held,
        "free": [name for name in values if name not in held],
        "board_shape": board_shape,
        "prior": calibration.settings.prior,
        "method": calibration.settings.method,
    }


def recover_image_arguments(calibration: Calibration) -> dict[str, Any]:
    """Recover the arguments as `recover_arguments`, but for the image cost and the default method.

    The lens model of `Cost.PAPER` takes no other cost: the default one is estimated instead.
    """
    settings = recover_arguments(calibration)
    if calibration.cost is Cost.PAPER:
        del settings["model"], settings["free"]
    return settings | {"cost": Cost.IMAGE, "method": DEFAULT_METHOD}


def is_held(calibration: Calibration) -> bool:
    """Return whether all of a calibration's camera was held, so that it is no estimate."""
    return len(calibration.fixed) == len(calibration.camera.params)


def find_free_parameters(calibration: Calibration) -> IntArray:
    """Return the indices of the camera's parameters that were estimated, ascending.

    Raises:
        CalibrationError: if all of them were held: the views say nothing of their errors.
    """
    if is_held(calibration):
        raise CalibrationError(
            "This camera is known from a file, and was not estimated from these photographs.",
            "`calibgui check` tells whether it is still good for them.",
        )
    names = calibration.camera.names
    return np.flatnonzero([name not in calibration.fixed for name in names])


def prepare_observations(calibration: Calibration, views: Sequence[Observation]) -> Observations:
    """Prepare views as a calibration takes them: whitened, on the board shape found or held."""
    return weigh_and_place(calibration, pack_observations(views))


def weigh_and_place(calibration: Calibration, observations: Observations) -> Observations:
    """Whiten observations as a calibration does, and place them on the board that it has."""
    if calibration.cost is Cost.IMAGE:
        observations = whiten_observations(observations, calibration.model_error**2)
    return (
        observations
        if calibration.board_shape is None
        else place_on_board_shape(observations, calibration.board_shape)
    )


def make_state(camera: Camera, poses: Sequence[Pose]) -> State:
    """Pack camera and poses as the solver takes them."""
    R = rotations.rotation_from_vector(np.array([pose.rvec for pose in poses]))
    return State(camera.params, R, np.array([pose.tvec for pose in poses]))

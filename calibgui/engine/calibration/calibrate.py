"""The whole calibration: Stage I, closed-form start, Stage II, uncertainty, diagnosis."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.board_shape.estimate import fit_board_shape, on_board_shape
from calibgui.engine.calibration.board_shape.uncertainty import with_board_shape_error
from calibgui.engine.calibration.initialisation.stage_one import prealign
from calibgui.engine.calibration.initialisation.start import in_paper_frame, start_of_stage_two
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    pack,
    pitch,
    view_names,
)
from calibgui.engine.calibration.options import Options, held_parameters
from calibgui.engine.calibration.overdispersion import with_view_scatter
from calibgui.engine.calibration.partial.degeneracy import (
    copies,
    diagnosed,
    in_one_spot,
    misfits,
    undetermined,
)
from calibgui.engine.calibration.partial.partial_calibration import estimate_partly, vague
from calibgui.engine.calibration.refinement.bundle_adjustment import reweighted, solved
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.whitening import weighted
from calibgui.engine.calibration.result import Calibration, Cost, DegenerateError, Report
from calibgui.engine.calibration.result_assembly import Estimate, estimated, reported
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.models import MODELS, PINHOLE, parameter_names
from calibgui.engine.errors import CalibrationError, one_of
from calibgui.engine.threads import on_one_blas_thread

_FAR = 0.5
"""How far outside the image corners may be, in its longer side."""


@on_one_blas_thread
def calibrate(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    cost: Cost | str = Cost.IMAGE,
    fix: Mapping[str, float | None] | Iterable[str] | str = (),
    free: Iterable[str] | str = (),
    model: str = "lucchese",
    report: Report | None = None,
    board_shape: BoardShapeModel | str | BoardShape = BoardShapeModel.NOMINAL,
    prior: BoardShapePrior | None = None,
    max_iterations: int = 100,
    names: Sequence[str] | None = None,
) -> Calibration:
    """Calibrate a camera from views of a flat target.

    Args:
        views: per view the measured corners uv (n, 2) px in the array frame, the same
            corners on the plate xy (n, 2) mm, and optionally the covariances of uv
            (n, 2, 2) px^2, for all views or for none.
            Views may show different parts of the target.
        size: width and height of the images, px.
        cost: what Stage II minimises, see `Cost`. `Cost.PAPER` is the printed method: the
            literal reference grid, radius in pixels and p3 free.
        fix: names of intrinsics to hold, with their values; without a value (or None)
            coefficients are held at 0, the centre at the array's and focal lengths at the
            closed form.
        free: names of intrinsics to estimate that are held by default (p3).
        model: the lens, a key of ``lens.MODELS``.
        plate: how the target may deviate from its nominal shape, estimated with the camera; or
            a plate estimated before, which is held. With the image cost only.
        prior: what is known of a free plate's corners beforehand; other plates need none.
        report: told of each iteration of Stage II; returning False stops it.
        max_iterations: of each solve of Stage II; corners with covariances take a few solves.
        names: of the views, for messages; numbers by default.

    Raises:
        CalibrationError: for views that cannot be used, naming them, and for arguments that
            there are not or that do not go together.
        DegenerateError: if the views do not determine the camera, with what to photograph and,
            in `partial`, what they do determine.
        Cancelled: from `report`.
    """
    cost = one_of(Cost, cost, "cost")
    if cost is Cost.PAPER:
        model = "lucchese-pixels"
    board_shape = (
        board_shape
        if isinstance(board_shape, BoardShape)
        else one_of(BoardShapeModel, board_shape, "plate model")
    )
    if board_shape is not BoardShapeModel.NOMINAL and cost is not Cost.IMAGE:
        raise CalibrationError(
            f"The cost {cost.value!r} registers the views on a flat, nominal plate.",
            "Use the cost 'image' with another plate.",
        )
    size, parameters = check_image_size(size), parameter_names(model)
    held = held_parameters(fix, free, model, size)
    names = names or view_names(len(views))
    observations = pack(views, names)
    _check_size(observations, size, names)
    scale = REFERENCE_PITCH / pitch(observations)
    first = prealign(*in_paper_frame(observations, scale, size, names))
    start, values = start_of_stage_two(observations, first, size, MODELS[model], parameters, held)
    settings = {
        "cost": cost.value,
        "model": model,
        "fixed": values,
        "max_iterations": max_iterations,
        "plate": board_shape.model.value
        if isinstance(board_shape, BoardShape)
        else board_shape.value,
        "plate_held": isinstance(board_shape, BoardShape),
        "prior_mm": None if prior is None else [prior.in_plane, prior.out_of_plane],
    }
    held_board_shape = board_shape if isinstance(board_shape, BoardShape) else None
    asked = Options(size, model, cost, scale, parameters, values, first, held_board_shape, settings)
    if held_board_shape is not None:
        observations = on_board_shape(observations, held_board_shape)
    if cost is Cost.IMAGE:  # the covariances are of corners in the image
        observations = weighted(observations)
    like = copies(zip(observations.uv, observations.xy, strict=True))
    if not like.any():
        # One plane gives two equations on these.
        unheld = [name for name in PINHOLE if name not in held]
        _refuse(observations, like, asked, start, unheld if len(unheld) > 2 else ())
    solve = partial(
        solved,
        model=model,
        cost=cost,
        scale=scale,
        free=asked.free,
        report=report,
        max_iterations=max_iterations,
    )
    solution = solve(observations, start)
    if observations.whitening is not None:
        observations, solution = reweighted(observations, solution, model, solve)
    suspects = [names[k] for k in misfits(first.rms).tolist()]
    precision = _determined(solution, observations, like, asked, suspects)
    estimate = estimated(solution, observations, precision)
    if cost is Cost.IMAGE:
        estimate = _examined(estimate, observations, asked, prior, report)
    return reported(estimate, asked, precision.undetermined, _digest(observations, settings))


def _determined(
    solution: Solution,
    observations: Observations,
    like: IntArray,
    asked: Options,
    suspects: Sequence[str],
) -> covariances.Precision:
    """How precise the solution is; raises as `calibrate` if the views do not determine it.

    Args:
        solution: of Stage II.
        observations: the views.
        like: (K,) as from `copies`.
        asked: of them.
        suspects: names of the views that are `misfits`.
    """
    names = tuple(asked.names[i] for i in asked.free)
    camera = Camera(asked.size, solution.state.params, asked.model)
    tolerated = _tolerated(camera, observations)[asked.free]
    precision = covariances.precision(solution.normal, names, observations.count, tolerated)
    lost = undetermined(solution, names, precision, suspects)
    if lost or in_one_spot(observations.uv, asked.size):  # padding repeats a corner
        _refuse(observations, like, asked, solution.state, lost)
    return precision


def _examined(
    estimate: Estimate,
    observations: Observations,
    asked: Options,
    prior: BoardShapePrior | None,
    report: Report | None,
) -> Estimate:
    """The estimate with the plate that was asked for, and what plate and views leave in doubt."""
    shape = BoardShapeModel(asked.settings["plate"])
    if asked.board_shape is None and shape is BoardShapeModel.NOMINAL:
        estimate = with_board_shape_error(estimate, observations, asked.model, asked.free)
    elif asked.board_shape is None:
        solution = estimate.solution
        estimate = fit_board_shape(
            solution, observations, asked.model, asked.free, shape, prior, report
        )
        _check_carried(estimate, asked, shape)
    return with_view_scatter(estimate, asked.model, asked.free)


def _check_carried(estimate: Estimate, asked: Options, board_shape: BoardShapeModel) -> None:
    """Refuse an estimated plate that stands in for the camera."""
    if names := vague(estimate.state.params, estimate.camera, asked):
        raise CalibrationError(
            f"With the plate model {board_shape.value!r} these views leave {', '.join(names)} "
            "undetermined: what the plate does and what the camera does look alike in them.",
            "Add views with the board tilted by 20 to 45 degrees in different directions and all "
            "over the image, or keep the nominal plate.",
        )


def _refuse(
    observations: Observations, like: IntArray, asked: Options, state: State, lost: Sequence[str]
) -> None:
    """Raise DegenerateError with what the views do determine; return if that is everything.

    Args:
        observations: the views.
        like: (K,) as from `copies`.
        asked: of them.
        state: camera and poses, as far as they are known.
        lost: focal lengths and coordinates of the centre that the views do not determine.
    """
    partly = estimate_partly(observations, like, asked, state.params)
    if partly is None:
        diagnosis = diagnosed(observations, asked.size, like, state, lost)
        raise DegenerateError(diagnosis.message, diagnosis.hint)
    estimate, assumed = partly
    if not (lost or assumed):
        return
    lost = [quantity.name for quantity in assumed] or lost
    diagnosis = diagnosed(observations, asked.size, like, estimate.state, lost)
    if asked.board_shape is None and asked.settings["plate"] != BoardShapeModel.NOMINAL:
        said = f"{diagnosis.message} The board's shape is not estimated."
        diagnosis = replace(diagnosis, message=said)
    calibration = reported(estimate, asked, (), _digest(observations, asked.settings))
    raise DegenerateError(
        diagnosis.message,
        diagnosis.hint,
        replace(calibration, diagnosis=replace(diagnosis, assumed=assumed)),
    )


def _check_size(observations: Observations, size: Size, names: Sequence[str]) -> None:
    """Refuse corners that an image of this size cannot show."""

    def outside(size: Size, margin: float) -> BoolArray:
        beyond = (observations.uv < -margin) | (observations.uv > np.array(size) + margin)
        return np.asarray(beyond.any(axis=(1, 2)))

    far, swapped = outside(size, _FAR * max(size)), outside(size, 0.0)
    swapped &= not outside(size[::-1], 0.0).any()
    if (wrong := far | swapped).any():
        raise CalibrationError(
            f"{names[int(np.argmax(wrong))]} has corners {'far ' if far.any() else ''}outside an "
            f"image of {size[0]} x {size[1]} pixels.",
            "Check the image size, given as width, height.",
        )


def _tolerated(camera: Camera, observations: Observations) -> Array:
    """Standard deviations of `camera.params` beyond which they count as undetermined.

    A tenth of the focal length for focal lengths and centre, and for a coefficient the value
    that moves the outermost corner by its whole distance from the centre.
    """
    f, lens = camera.focal, MODELS[camera.model]
    d = (observations.uv - camera.centre) / f
    outermost = np.sqrt(np.max(d[..., 0] ** 2 + d[..., 1] ** 2))
    return np.concatenate([0.1 * f, 0.1 * f, outermost ** -np.array(lens.powers, float)])


def _digest(observations: Observations, settings: Mapping[str, Any]) -> str:
    """SHA-256 of what a calibration answers."""
    digest = hashlib.sha256(repr(sorted(settings.items())).encode())
    for array in (observations.uv, observations.xy, observations.mask, observations.cov):
        if array is not None:
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()

"""Trials: what an action on a finding leads to, found by carrying it out on the views.

The verdict measures with them what remedies bring (``verdict.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from calibgui.engine.assessment.causes.finding import Action, ActionKind
from calibgui.engine.assessment.choices.cross_validation import choose_board_shape
from calibgui.engine.assessment.choices.lens_choice import choose_lens_stepwise
from calibgui.engine.assessment.residuals.outliers import screen_outliers, select_corners
from calibgui.engine.assessment.residuals.view_weights import calibrate_weighted
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_arguments, recover_image_arguments
from calibgui.engine.calibration.result import Calibration, Iteration, Report
from calibgui.engine.camera.models import PINHOLE
from calibgui.engine.errors import CalibrationError


class Trial(NamedTuple):
    """An action that has been carried out for a trial."""

    action: Action
    """The action, with the model that was found to be best."""
    calibration: Calibration
    """The calibration that it leads to."""
    views: list[Observation]
    """The views that it was made from."""


def try_action_safely(
    action: Action | None,
    calibration: Calibration,
    views: Sequence[Observation],
    check: Callable[[], None] | None,
) -> Trial | None:
    """Carry out an action; None if the views do not allow it, or it does not determine one."""
    is_chosen = "model_reason" in calibration.settings  # from all of them already
    if action is not None and action.kind is ActionKind.CHOOSE_LENS_MODEL and is_chosen:
        return Trial(action, calibration, list(views))
    try:
        trial = try_action(action, calibration, views, check)
    except CalibrationError:
        return None
    if trial is None or trial.calibration.diagnosis is not None:
        return None
    return trial


def try_action(
    action: Action | None,
    calibration: Calibration,
    views: Sequence[Observation],
    check: Callable[[], None] | None = None,
) -> Trial | None:
    """Carry out an action on the views of a calibration; None if it takes other photographs.

    Args:
        action: the action; None for none.
        calibration: the calibration.
        views: the views that it was made from.
        check: a function that is called at every iteration, and raises to abandon the work.

    Raises:
        CalibrationError: if the views do not allow it.
    """
    if action is None or not action.is_of_camera:
        return None
    given, size = list(views), calibration.camera.size
    recover = recover_image_arguments if action.takes_image_cost else recover_arguments
    settings = recover(calibration)
    is_repeated = settings == recover_arguments(calibration)
    if check is not None:
        settings["report"] = _make_report(check)
    match action.kind:
        case ActionKind.ESTIMATE_BOARD_SHAPE:
            del settings["board_shape"], settings["prior"]
            is_nominal = calibration.board_shape is None and is_repeated
            nominal = calibration if is_nominal else None
            board = choose_board_shape(given, size, nominal=nominal, **settings)
            return Trial(replace(action, model=board.model), board.chosen, given)
        case ActionKind.CHOOSE_LENS_MODEL:
            settings["fix"] = {n: v for n, v in settings["fix"].items() if n in PINHOLE}
            shape = {name: settings.pop(name) for name in ("board_shape", "prior")}
            del settings["model"], settings["free"]
            lens = choose_lens_stepwise(given, size, **settings).chosen
            camera = lens.calibration
            if shape["board_shape"] != BoardShapeModel.NOMINAL:  # it is estimated or given again
                settings |= {"model": lens.model, "fix": {**settings["fix"], **lens.fixed}}
                camera = calibrate(given, size, **settings, **shape)
            held = tuple(lens.fixed)
            return Trial(replace(action, model=lens.model, parameters=held), camera, given)
        case ActionKind.LEAVE_OUT_CORNERS:
            screening = screen_outliers(given, size, **settings)
            kept = [
                select_corners(view, good)
                for view, good in zip(given, screening.kept, strict=True)
                if good.any()
            ]
            return Trial(action, screening.calibration, kept)
        case ActionKind.LEAVE_OUT_VIEWS:
            kept = [view for k, view in enumerate(given) if k not in action.views]
            return Trial(action, calibrate(kept, size, **settings), kept)
        case ActionKind.WEIGH_VIEWS:
            return Trial(action, *calibrate_weighted(given, size, **settings))
        case _:
            changed = _change_held(settings, action)
            return Trial(action, calibrate(given, size, **changed), given)


def _make_report(check: Callable[[], None]) -> Report:
    """Return a report of a solve that goes on until `check` raises."""

    def report(_: Iteration) -> bool:
        check()
        return True

    return report


def _change_held(settings: dict[str, Any], action: Action) -> dict[str, Any]:
    """Return the arguments of a calibration with parameters freed, or held at 0."""
    fixed = {n: v for n, v in settings["fix"].items() if n not in action.parameters}
    free = [name for name in settings["free"] if name not in action.parameters]
    if action.kind is ActionKind.FREE_HELD_VALUE:
        return {**settings, "fix": fixed, "free": [*free, *action.parameters]}
    return {**settings, "fix": {**fixed, **dict.fromkeys(action.parameters, 0.0)}, "free": free}

"""Trials: what an action on a finding leads to, found by carrying it out on the views.

The verdict measures with them what remedies bring (``verdict.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from calibgui.engine.arrays import Size
from calibgui.engine.assessment.causes.finding import Action, ActionKind
from calibgui.engine.assessment.choices.cross_validation import choose_board_shape
from calibgui.engine.assessment.choices.lens_choice import choose_lens_stepwise
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.assessment.residuals.outliers import screen_outliers, select_corners
from calibgui.engine.assessment.residuals.view_weights import calibrate_weighted
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
    if action is None:
        return None
    if action.kind is ActionKind.CHOOSE_LENS_MODEL and _is_lens_chosen(calibration):
        return Trial(action, calibration, list(views))  # from all of them already
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
            lens, camera = _choose_lens(given, size, settings)
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
            if _is_lens_chosen(calibration):  # what followed two kinds of views is hardly the best
                return Trial(action, _choose_lens(kept, size, settings)[1], kept)
            return Trial(action, calibrate(kept, size, **settings), kept)
        case ActionKind.ESTIMATE_SKEW:
            fix = {name: value for name, value in settings["fix"].items() if name in PINHOLE}
            settings |= {"model": action.model, "fix": fix, "free": action.parameters}
            return Trial(action, calibrate(given, size, **settings), given)
        case ActionKind.WEIGH_VIEWS:
            return Trial(action, *calibrate_weighted(given, size, **settings))
        case _:
            changed = _change_held(settings, action)
            return Trial(action, calibrate(given, size, **changed), given)


def _is_lens_chosen(calibration: Calibration) -> bool:
    """Return whether the lens model was chosen automatically."""
    return "model_reason" in calibration.settings


def _choose_lens(
    views: list[Observation], size: Size, settings: dict[str, Any]
) -> tuple[LensTrial, Calibration]:
    """Choose the lens model for views with the board's shape of the settings; return it, and the
    calibration with it."""
    fix = {name: value for name, value in settings["fix"].items() if name in PINHOLE}
    of_lens = ("model", "free", "fix")
    others = {name: value for name, value in settings.items() if name not in of_lens}
    lens = choose_lens_stepwise(views, size, fix=fix, **others).chosen
    return lens, lens.calibration


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

"""Trials: what an action on a finding leads to, found by carrying it out on the views.

The verdict measures with them what remedies bring (``verdict.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from calibgui.engine.arrays import Size
from calibgui.engine.assessment.action import AUTO, Action, ActionKind, Change
from calibgui.engine.assessment.choices.board_shape_choice import choose_board_shape
from calibgui.engine.assessment.choices.lens_choice import choose_lens_stepwise
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.assessment.residuals.outliers import screen_outliers
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
    change = None if action is None else action.change
    if action is None or change is None:
        return None
    size = calibration.camera.size
    given = [view for k, view in enumerate(views) if k not in change.leaves_out_views]
    recover = recover_image_arguments if change.takes_image_cost else recover_arguments
    settings = recover(calibration)
    is_nominal = calibration.board_shape is None and settings == recover_arguments(calibration)
    _change_held(settings, change)
    if check is not None:
        settings["report"] = _make_report(check)
    if change.lens_model == AUTO:
        lens, camera = _choose_lens(given, size, settings)
        return Trial(replace(action, model=lens.model, parameters=tuple(lens.fixed)), camera, given)
    if change.lens_model is not None:
        settings["model"] = change.lens_model
    elif change.leaves_out_views and _is_lens_chosen(calibration):
        # What followed two kinds of views is hardly the best of those that are left.
        return Trial(action, _choose_lens(given, size, settings)[1], given)
    if change.board_shape is not None:
        del settings["board_shape"], settings["prior"]
        if change.board_shape == AUTO:
            nominal = calibration if is_nominal else None
            board = choose_board_shape(given, size, nominal=nominal, **settings)
            return Trial(replace(action, model=board.model), board.chosen, given)
        settings["board_shape"] = change.board_shape
    if change.leaves_out_corners:
        screening = screen_outliers(given, size, **settings)
        return Trial(action, screening.calibration, screening.select_kept(given))
    if change.weighs_views:
        return Trial(action, *calibrate_weighted(given, size, **settings))
    return Trial(action, calibrate(given, size, **settings), given)


def _is_lens_chosen(calibration: Calibration) -> bool:
    """Return whether the lens model was chosen automatically."""
    return calibration.settings.model_reason is not None


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


def _change_held(settings: dict[str, Any], change: Change) -> None:
    """Change which parameters the arguments of a calibration hold, and which they free."""
    fix, free = settings.get("fix", {}), list(settings.get("free", ()))
    if change.lens_model is not None:
        fix, free = {name: value for name, value in fix.items() if name in PINHOLE}, []
    changed = (*change.releases, *change.frees, *change.holds_at_zero)
    fix = {name: value for name, value in fix.items() if name not in changed}
    free = [name for name in free if name not in changed]
    settings["fix"] = fix | dict.fromkeys(change.holds_at_zero, 0.0)
    settings["free"] = [*free, *change.releases, *change.frees]

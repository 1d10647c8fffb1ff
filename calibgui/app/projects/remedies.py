"""Carrying out the action on a finding, as an edit of a project."""

from __future__ import annotations

from dataclasses import replace

from calibgui.app.calibrating.settings import DEFAULT_MODEL, Settings
from calibgui.app.projects.project import Project, change_views
from calibgui.dataset import Result
from calibgui.engine.assessment import Action, ActionKind
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import DEFAULT_METHOD, Cost


def apply_action(project: Project, result: Result, action: Action) -> Project:
    """Return the project with an action carried out, to be calibrated again.

    Args:
        project: the project as it is.
        result: the result that the action is about.
        action: an action that needs no other photographs.

    Raises:
        ValueError: if it does need them.
    """
    if not action.is_of_camera:
        raise ValueError(f"{action.kind} is for the user to do")
    if action.kind is ActionKind.LEAVE_OUT_VIEWS:
        images = [result.used[k].image for k in action.views]
        return change_views(project, images, lambda view: replace(view, enabled=False))
    return replace(project, settings=_change_settings(project.settings, result, action))


def _change_settings(settings: Settings, result: Result, action: Action) -> Settings:
    """Return the settings with which a calibration carries an action out."""
    if action.takes_image_cost:
        settings = replace(settings, cost=Cost.IMAGE, method=DEFAULT_METHOD)
    match action.kind:
        case ActionKind.ESTIMATE_BOARD_SHAPE:
            shape = BoardShapeModel(action.model) if action.model else None
            return replace(settings, board_shape=shape, prior=None)
        case ActionKind.CHOOSE_LENS_MODEL:
            fixed = {n: v for n, v in settings.fixed.items() if n in ("fx", "fy", "cx", "cy")}
            held = dict.fromkeys(action.parameters, 0.0)
            model = action.model or None
            return replace(settings, model=model, fixed={**fixed, **held}, freed=())
        case ActionKind.ESTIMATE_SKEW:
            fixed = {n: v for n, v in settings.fixed.items() if n in ("fx", "fy", "cx", "cy")}
            return replace(settings, model=action.model, fixed=fixed, freed=action.parameters)
        case ActionKind.LEAVE_OUT_CORNERS:
            return replace(settings, robust=True)
        case ActionKind.WEIGH_VIEWS:
            return replace(settings, weigh_views=True)
        case ActionKind.FREE_HELD_VALUE:
            fixed = {n: v for n, v in settings.fixed.items() if n not in action.parameters}
            return replace(settings, fixed=fixed)
        case _:
            held = dict.fromkeys(action.parameters, 0.0)
            freed = tuple(name for name in settings.freed if name not in held)
            # A model that is chosen anew may have no such coefficient.
            paper = settings.cost is Cost.PAPER
            model = DEFAULT_MODEL if paper else result.calibration.camera.model
            return replace(settings, model=model, fixed={**settings.fixed, **held}, freed=freed)

"""Carrying out the action on a finding, or what is offered, as an edit of a project."""

from __future__ import annotations

from dataclasses import replace

from calibgui.app.calibrating.settings import change_settings
from calibgui.app.calibrating.true_board import GLASS
from calibgui.app.projects.project import Project, change_views
from calibgui.dataset import Result
from calibgui.engine.assessment import Action
from calibgui.engine.boards import BoardShapeModel


def apply_action(project: Project, result: Result, action: Action) -> Project:
    """Return the project with an action carried out, to be calibrated again.

    Args:
        project: the project as it is.
        result: the result that the action is about.
        action: an action that needs no other photographs.

    Raises:
        ValueError: if it does need them.
    """
    change = action.change
    if change is None:
        raise ValueError(f"{action.kind} is for the user to do")
    if change.leaves_out_views:
        images = [result.used[k].image for k in change.leaves_out_views]
        project = change_views(project, images, lambda view: replace(view, enabled=False))
    settings = change_settings(project.settings, result.calibration.camera.model, change)
    return project if settings == project.settings else replace(project, settings=settings)


def state_glass(project: Project) -> Project:
    """Return the project with its board stated to be of glass, to be calibrated again."""
    settings = replace(project.settings, board_shape=BoardShapeModel.NOMINAL, prior=GLASS)
    return replace(project, settings=settings)

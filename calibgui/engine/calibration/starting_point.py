"""A solve starts from the camera and the poses that the method guesses.

For Lucchese's method they come from Stage I (``initialisation/stage_one.py``), each view by itself,
and the closed form (``initialisation/start.py``).
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from calibgui.engine.calibration.initialisation.control_points import check_control_points
from calibgui.engine.calibration.methods.method import Problem
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.models import find_model


class StartingPoint(NamedTuple):
    """A problem, with a state from which it is solved."""

    stated: Problem
    """The problem as it was stated."""
    problem: Problem
    """The same with the values of all held parameters."""
    state: State
    """Camera and poses."""
    remarks: tuple[str, ...]
    """Sentences on the views that the camera and the poses do not say."""


def find_starting_point(problem: Problem) -> StartingPoint:
    """Find the camera and the poses that the method starts from.

    Raises:
        StartError: if the views allow no guess.
        CalibrationError: if a splined lens ends before the corners do.
    """
    state, held, remarks = problem.method.initialise(problem)
    check_control_points(state, problem.observations, find_model(problem.model))
    return StartingPoint(problem, replace(problem, held=held), state, remarks)

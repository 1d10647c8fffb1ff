"""The refusal of views that do not determine the camera, with what they do determine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.partial.degeneracy import diagnose_degeneracy, find_copies
from calibgui.engine.calibration.partial.partial_calibration import estimate_partially
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.calibration.result_assembly import assemble_calibration
from calibgui.engine.calibration.starting_point import StartingPoint


def refuse_undetermined(
    point: StartingPoint, observations: Observations, state: State, lost: Sequence[str]
) -> None:
    """Raise DegenerateError with what the views do determine; return if that is everything.

    Args:
        point: the problem.
        observations: the views as the solver takes them.
        state: camera and poses, as far as they are known.
        lost: focal lengths and coordinates of the centre that the views do not determine.
    """
    problem = point.problem
    originals = find_copies(zip(observations.uv, observations.xy, strict=True))
    partial = estimate_partially(observations, originals, problem, state.params)
    if partial is None:
        diagnosis = diagnose_degeneracy(observations, problem.size, originals, state, lost)
        raise DegenerateError(diagnosis.message, diagnosis.hint)
    estimate, assumptions = partial
    if not (lost or assumptions):
        return
    lost = [assumption.name for assumption in assumptions] or lost
    diagnosis = diagnose_degeneracy(observations, problem.size, originals, estimate.state, lost)
    if problem.estimated_shape is not BoardShapeModel.NOMINAL:
        message = f"{diagnosis.message} The board's shape is not estimated."
        diagnosis = replace(diagnosis, message=message)
    diagnosis = replace(diagnosis, assumptions=assumptions)
    calibration = replace(assemble_calibration(point, estimate), diagnosis=diagnosis, warnings=())
    raise DegenerateError(diagnosis.message, diagnosis.hint, calibration)

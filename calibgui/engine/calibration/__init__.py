"""From corners to a calibrated camera, with poses and standard deviations."""

from __future__ import annotations

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.covariances import correlations, paper_table
from calibgui.engine.calibration.initialisation.single_view_pose import cosines_equation
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.partial.degeneracy import copies, in_one_spot
from calibgui.engine.calibration.problem import settings_of
from calibgui.engine.calibration.refit import Refit, refit
from calibgui.engine.calibration.result import (
    Assumed,
    Calibration,
    Cost,
    Degeneracy,
    DegenerateError,
    Diagnosis,
    Iteration,
    Report,
    StageOne,
    Status,
    Undetermined,
    ViewResiduals,
)

__all__ = [
    "Assumed",
    "Calibration",
    "Cost",
    "Degeneracy",
    "DegenerateError",
    "Diagnosis",
    "Iteration",
    "Observation",
    "Refit",
    "Report",
    "StageOne",
    "Status",
    "Undetermined",
    "ViewResiduals",
    "calibrate",
    "copies",
    "correlations",
    "cosines_equation",
    "in_one_spot",
    "paper_table",
    "refit",
    "settings_of",
]

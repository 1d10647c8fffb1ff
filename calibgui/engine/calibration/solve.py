"""The solve: the method moves its guess, mostly to the minimum of the cost.

For Lucchese's method it is Stage II (``refinement/bundle_adjustment.py``).
"""

from __future__ import annotations

from calibgui.engine.calibration.methods.method import Refinement
from calibgui.engine.calibration.partial.degeneracy import find_copies
from calibgui.engine.calibration.partial.refusal import refuse_undetermined
from calibgui.engine.calibration.result import Report
from calibgui.engine.calibration.starting_point import StartingPoint
from calibgui.engine.camera.models import PINHOLE


def solve(point: StartingPoint, report: Report | None) -> Refinement:
    """Solve a problem from its starting point.

    Raises:
        DegenerateError: if all views are copies of one, which leave the camera undetermined.
        StartError: if the start images no corners.
    """
    observations = point.problem.prepared
    if not find_copies(zip(observations.uv, observations.xy, strict=True)).any():
        # One plane gives two equations on these.
        unheld = [name for name in PINHOLE if name not in point.stated.held]
        lost = unheld if len(unheld) > 2 else ()
        refuse_undetermined(point, observations, point.state, lost)
    return point.problem.method.refine(point.problem, point.state, report)

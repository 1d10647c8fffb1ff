"""OpenCV's own calibration, as a witness from outside.

`cv2.calibrateCamera` (the function of the library, called and not imitated) minimises the distances
of all corners from their predictions, over fx, fy, cx, cy, k1, k2, p1, p2, k3 and all poses, by a
Levenberg-Marquardt method of its own; its lens model is "brown-conrady" without skew. It starts
from focal lengths in closed form with the centre of the image (OpenCV manual, Camera Calibration
and 3D Reconstruction, ``initCameraMatrix2D``).

Nothing is shared with the other methods but the corners: where its result agrees with that of
another method for the same lens model, errors of either program are unlikely. What is told of it:

- Flags: none, unless parameters are held. It holds fx and fy only together, cx and cy, p1 and p2
  likewise, and starts from the values wanted and ``bouguet.py`` then.
- Criteria: the largest number of iterations that the caller allows, and steps below 2.2e-16 of
  the parameters, which is OpenCV's default and stops hardly any solve.
- It tells nothing of its iterations and cannot be stopped. The one in the result is the evaluation
  of its camera and poses by our residuals, from which uncertainties follow as for other methods.
- It takes corners in single precision (``engine/opencv.py``). The minimum moves by about the same
  3e-5 px, far less than any noise.
- It adds up views on several threads, so that repeated results differ in the tenth digit.
- Whether it has converged is judged by what a step of all unknowns would still gain.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.calibration.methods.bouguet import initialise_from_vanishing_points
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    Refinement,
    evaluate_state,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    StartError,
    predict_full_decrease,
)
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Report, Status
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector

_MAX_DECREASE = 1e-6
"""Decrease of the cost that a step of all unknowns still predicts, relative to it, beyond which
OpenCV's iteration counts as not converged; the parameters are then more than 0.001 sqrt(2 N)
standard deviations from the minimum for N corners. Single precision alone leaves less than 1e-7 in
images 6000 px wide with a noise of 0.05 px."""
_MIN_VARIANCE = 1e-9
"""Mean squared distance, px^2, below which residuals are those of single precision."""


def _initialise(problem: Problem) -> Initialisation:
    """Make the start from vanishing points, which OpenCV uses only if parameters are held.

    Raises:
        CalibrationError: if OpenCV cannot hold just these parameters.
        StartError: if no focal length explains the views.
    """
    held = set(problem.held)
    if problem.held.get("skew", 1.0) not in (None, 0.0):
        raise CalibrationError(
            "OpenCV's calibration knows no skew.", "Hold it at 0, or choose another method."
        )
    for names in opencv.FIX_FLAGS:
        if held & set(names) and not held >= set(names):
            raise CalibrationError(
                f"OpenCV's calibration holds {' and '.join(names)} only together.",
                "Hold both or none, or choose another method.",
            )
    return initialise_from_vanishing_points(problem)


def _refine(problem: Problem, start: State, report: Report | None) -> Refinement:
    """Call OpenCV, and evaluate what it returns."""
    observations = problem.prepared
    fixed = [flag for names, flag in opencv.FIX_FLAGS.items() if names[0] in problem.held]
    counted = [observations.corners_of(k) for k in range(len(observations.uv))]
    found = opencv.calibrate_camera(
        [uv[corners] for uv, corners in zip(observations.uv, counted, strict=True)],
        [xy[corners] for xy, corners in zip(observations.xy, counted, strict=True)],
        problem.size,
        start.params[:9] if fixed else None,
        sum(fixed),
        problem.max_iterations,
    )
    if found is None or not all(np.isfinite(values).all() for values in found):
        raise StartError(
            "OpenCV finds no camera in these views.",
            "Choose another method, or add views with the board tilted in different directions.",
        )
    state = State(np.append(found.params, 0.0), rotation_from_vector(found.rvecs), found.tvecs)
    solution = evaluate_state(problem, observations, state, report)
    rounding = _MIN_VARIANCE * observations.count
    gain = predict_full_decrease(solution.normal)
    if gain > _MAX_DECREASE * solution.normal.cost + rounding:
        solution = solution._replace(status=Status.MAX_ITERATIONS)
    return Refinement(observations, solution)


OPENCV = Method(
    name="opencv",
    label="OpenCV",
    title="OpenCV's calibrateCamera",
    source="OpenCV library, cv::calibrateCamera (https://docs.opencv.org)",
    limits="It takes all corners as equally good, knows no skew, and tells nothing of its "
    "iterations.",
    lens_models=("brown-conrady",),
    initialise=_initialise,
    refine=_refine,
    held=("skew",),
)
"""The method."""

"""Images that are all sheared alike, which looks like a lens or a sheared print and is neither.

A rolling shutter reads one row after the other. Where the camera turns evenly meanwhile, each row
is shifted sideways against the one before, by the same angle in all images; so it is where lines of
a scan or a video signal start at an angle. No lens does that, and of the lens models only those of
OpenCV's kind can hold it, as the skew of the camera matrix, which is 0 in any sensor. A
displacement of the image that all views share explains a shear as well; but it takes a hundred
unknowns for what one does. A sheared print is told from it by views that are rolled or tilted
against each other.

So where lens or board would be named, and a score test says that a skew explains nearly as much
beside the lens model that was found, the calibration is repeated with the skew free, and with
unequal squares and a shear of the board. The skew is the cause if it leaves less than that lens
model, and is more probable than such a board by Akaike's criterion (``cause_fits.py``). Of 20 sets
whose rows were shifted by 0.3 to 7 px it was so by 5 or more in 18, and the board by 7 or more in
all of 20 sets of a print that was off. Motion up or down stretches the images instead, and is no
fault that shows: fy holds it.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.finding import Cause, Finding, describe_harm
from calibgui.engine.assessment.residuals.cause_fits import MIN_LEAD
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import (
    judge_together,
    multiply_by_skew,
    prepare_fit,
    take_open_steps,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.repetition import calibrate_by_model
from calibgui.engine.calibration.score_tests import LinearisedFit
from calibgui.engine.errors import CalibrationError

_MODELS = ("brown-conrady", "brown-conrady-4", "rational")
"""Lens models that hold a skew, and have nothing else that resembles it; the first is taken for all
others."""
_SKEW = "skew"
MIN_PART = 0.8
"""Part of what lens or board explain, from which a skew or a roll of all images, of one unknown,
may be the cause instead. Without it 13 of 51 sets with a wide lens or a poor board were called
sheared (``tests/faults``)."""


def find_shear(case: Case, explained: float) -> Finding | None:
    """Find out whether a shear of all images is what lens or board seem to explain; None if not.

    Args:
        case: a calibration with the image cost.
        explained: the share of the squared residuals that lens or board explain.
    """
    fit = prepare_fit(case.calibration, case.views)
    if judge_together(multiply_by_skew(fit)).share < MIN_PART * explained:
        return None
    model = case.calibration.camera.model
    model = model if model in _MODELS else _MODELS[0]
    try:
        sheared, print_off = (
            calibrate_by_model(case.calibration, case.views, model, **changes)
            for changes in (
                {"board_shape": BoardShapeModel.NOMINAL, "free": (_SKEW,)},
                {"board_shape": BoardShapeModel.AFFINE},
            )
        )
    except CalibrationError:
        return None
    after, by_board = (summarise_residuals(each.residuals).rms for each in (sheared, print_off))
    share = 1 - (after / case.rms) ** 2
    lead = _compute_lead(fit, after, by_board)
    if share < MIN_PART * explained or lead < -MIN_LEAD:
        return None
    harm = case.measure_harm(share)
    degrees = abs(np.degrees(sheared.camera.params[sheared.camera.names.index(_SKEW)]))
    if lead < MIN_LEAD:
        return Finding(
            Cause.DISAGREEMENT,
            "Either all images or the board are sheared, and these views do not tell which.",
            f"A skew of {degrees:.2g} degrees leaves {after:.2g} px of {case.describe_rms()}, a "
            f"board of unequal or oblique squares {by_board:.2g} px; {describe_harm(harm)}.",
            "Measure whether the board's two diagonals are equally long, and add views with the "
            "board turned by 90 degrees in its plane.",
            harm,
            action=Action(ActionKind.PHOTOGRAPH_MORE),
        )
    return Finding(
        Cause.SHEARED_IMAGES,
        "All images are sheared alike: each row is displaced against the next.",
        f"With a skew of {degrees:.2g} degrees {after:.2g} px are left of {case.describe_rms()}, "
        f"and neither a lens nor a board explains it better; {describe_harm(harm)}.",
        "Photograph again with camera and board on a stand, if the camera moved while a rolling "
        "shutter read the rows. If another camera or program makes all images so, estimate the "
        "skew.",
        harm,
        action=Action(ActionKind.ESTIMATE_SKEW, parameters=(_SKEW,), model=model),
    )


def _compute_lead(fit: LinearisedFit, sheared: float, by_board: float) -> float:
    """Compute by how much Akaike's criterion is less with a skew, of one unknown, than with a board
    of two; both leave a RMS residual, px."""
    freedom = fit.degrees_of_freedom / take_open_steps(fit).dispersion
    return float(freedom * np.log(by_board**2 / sheared**2) + 2.0)

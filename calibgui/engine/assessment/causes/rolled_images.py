"""Images that are all rolled alike from row to row, which passes for a decentred lens.

A rolling shutter reads one row after the other. Where the camera rolls evenly about its optical
axis meanwhile, a corner at (x, y) from the principal point is displaced by w y (-y, x), w being the
roll from row to row. A decentred lens displaces it by p (3 x^2 + y^2, 2 x y) (Brown 1966), and a
rotation of the camera, which the poses take up, by f (1 + x^2, x y) times its angle: with p = -w
and an angle of 3 w the sum is w y (-y, x), but for a shift of the principal point by -3 w f. So a
roll that is the same in all images leaves nothing in the residuals, and the camera is wrong: one of
1 degree from the first row to the last moves pixels of a VGA image by 0.9 px rms.

Lenses are decentred, too, but less. The roll that a decentring stands for is how far the images
must be turned back for the calibration to find none. To the first order it is p / (dp/dw), dp/dw
being the change of p that a roll makes in one Gauss-Newton step. Of the cameras of our real image
sets whose views determine it to 0.2 degrees it was at most 0.13. Where it exceeds `_MIN_ROLL`,
either is possible; whoever photographs can tell. Where the shift of the principal point makes
radial distortion do what the decentring would, dp/dw is nearly 0 and the roll's sigma large: it
then stays unseen, as in 4 of 33 rendered sets, all by one lens.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.causes.sheared_images import MIN_PART
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.finding import MIN_HARM_PX, Cause, Finding, describe_harm
from calibgui.engine.assessment.residuals.cause_fits import MIN_LEAD
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import (
    multiply_by_roll,
    prepare_fit,
    take_open_steps,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.repetition import calibrate_by_model, repeat_calibration
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.numbers import format_two_digits

_MIN_ROLL = np.deg2rad(0.2)
"""Roll from the first row to the last that a decentring stands for, from which the lens may have
none, rad."""
_MIN_SIGMAS = 3.0
"""The same, in its standard deviations: a plausibility limit."""
_MAX_STEPS, _MAX_PART_LEFT = 3, 0.05
"""Number of times that the images are turned back, at most, and the part of the decentring that may
be left then."""
_DECENTRING = ("p1", "p2")
_DECENTRED_MODELS = {"pinhole": "brown-conrady", "thin-prism": "rational"}
_DECENTRED_AT_LARGE = "kannala-brandt-decentering"
"""Names of the coefficients of a decentred lens, and the lens models that have them and nothing
else that resembles a roll, for models that have not."""


_ROLLED = "The camera rolled alike in all photographs while their rows were read."
_EITHER = (
    "Either the lens is decentred more than most lenses are, or the camera rolled alike in all "
    "photographs while their rows were read, and these views do not tell which."
)
_IF_THE_SAME = " If the result is the same, the lens is decentred, and nothing is wrong."


class _Roll(NamedTuple):
    """A roll that a decentring stands for."""

    angle: float
    """Angle from the first row to the last, rad."""
    sigma: float
    """Its standard deviation, rad."""
    number: int
    """Index of the decentring among the camera's parameters."""

    @property
    def is_large(self) -> bool:
        """True if lenses are hardly decentred as much, and noise does not make it."""
        return abs(self.angle) >= max(_MIN_ROLL, _MIN_SIGMAS * self.sigma)


def find_roll(case: Case, found: Finding | None, explained: float) -> Finding | None:
    """Find out whether all images may be rolled alike; None if not, or if that does less harm.

    Args:
        case: a calibration with the image cost.
        found: what is found otherwise; a motion in each view is returned with the roll's harm.
        explained: the share of the squared residuals that a wrong lens explains.
    """
    is_moving = found is not None and found.cause is Cause.ROLLING_SHUTTER
    try:
        decentred = _let_lens_be_decentred(case, explained)
        roll = None if decentred is None else _estimate_roll(decentred, case.views)
        if decentred is None or roll is None or not roll.is_large:
            return None
        angle, still = _turn_back(decentred, case.views, roll)
        moved = compare_cameras(still.camera, case.calibration.camera, views=case.views).rms
    except CalibrationError:
        return None
    before, after = (
        summarise_residuals(calibration.residuals).rms for calibration in (decentred, still)
    )
    lead = _compute_lead(case, before, after)
    # The harm of a lens model that cannot be decentred is the roll's own.
    is_less = found is not None and decentred is case.calibration and moved < found.harm
    if moved < MIN_HARM_PX or lead < -MIN_LEAD or is_less:
        return None
    degrees = format_two_digits(abs(float(np.rad2deg(angle))))
    if found is not None and is_moving:
        harm = float(np.hypot(found.harm, moved))
        evidence = (
            f"{found.evidence} With a roll of {degrees} degrees from the first row to the last "
            f"that all images share, and that passes for a decentred lens, {describe_harm(harm)}."
        )
        return replace(found, evidence=evidence, harm=harm, without=still.camera)
    left = f"{after:.3g} px RMS are left, with a decentred lens {before:.3g} px"
    either = lead < MIN_LEAD
    return Finding(
        Cause.ROLLED_IMAGES,
        _EITHER if either else _ROLLED,
        f"With a roll of {degrees} degrees from the first row to the last {left}; "
        f"{'if it is a roll, ' if either else ''}{describe_harm(moved)}.",
        f"Photograph again with camera and board on a stand.{_IF_THE_SAME if either else ''}",
        moved,
        action=Action(ActionKind.PHOTOGRAPH_MORE),
        without=still.camera,
    )


def _compute_lead(case: Case, decentred: float, rolled: float) -> float:
    """Compute by how much Akaike's criterion is less with a roll than with a decentred lens.

    Both have as many unknowns, and leave a RMS residual, px. What the views disagree by is no more
    independent than what their corners do (``cause_fits.py``).
    """
    fit = prepare_fit(case.calibration, case.views)
    dispersion = take_open_steps(fit).dispersion
    dispersion *= max(case.calibration.overdispersion, 1.0) ** 2
    return float(2 * fit.degrees_of_freedom / dispersion * np.log(decentred / rolled))


def _let_lens_be_decentred(case: Case, explained: float) -> Calibration | None:
    """Return a calibration with a lens that may be decentred; None if there is no need for one.

    Raises:
        CalibrationError: if the views do not determine it.
    """
    calibration = case.calibration
    model, names = calibration.camera.model, find_model(calibration.camera.model).names
    is_free = any(name in names and name not in calibration.fixed for name in _DECENTRING)
    if is_free and model not in _DECENTRED_MODELS:
        return calibration
    if not is_free and not explained:
        return None
    other = _DECENTRED_MODELS.get(model, _DECENTRED_AT_LARGE)
    found = calibrate_by_model(calibration, case.views, other)
    settings = recover_image_arguments(found)
    centred = repeat_calibration(
        found,
        case.views,
        free=[name for name in settings["free"] if name not in _DECENTRING],
        fix=settings["fix"] | dict.fromkeys(_DECENTRING, 0.0),
        model_errors=False,
    )
    after, before = (summarise_residuals(one.residuals).rms for one in (found, centred))
    share = (before**2 - after**2) / case.rms**2  # what another lens model explains is no roll
    return found if share >= MIN_PART * explained else None


def _estimate_roll(calibration: Calibration, views: Sequence[Observation]) -> _Roll | None:
    """Estimate the roll that the decentring of a calibration stands for; None if it has none."""
    fit, names = prepare_fit(calibration, views), calibration.camera.names
    products = multiply_by_roll(fit)
    N, by_roll = products.shared.sum(axis=0), products.between.sum(axis=0)[:, 0]
    unit = 1 / np.sqrt(np.maximum(np.diag(N), 1e-24))
    slopes = -unit * np.linalg.lstsq(N * np.outer(unit, unit), unit * by_roll, rcond=None)[0]
    chosen = [k for k, i in enumerate(fit.free) if names[i] in _DECENTRING]
    if not chosen:
        return None
    k = max(chosen, key=lambda k: abs(slopes[k]))
    number, slope = int(fit.free[k]), float(slopes[k])
    if slope == 0:
        return None
    value, sigma = float(calibration.camera.params[number]), float(calibration.sigma[number])
    return _Roll(-value / slope, abs(sigma / slope), number)


def _turn_back(
    calibration: Calibration, views: Sequence[Observation], roll: _Roll
) -> tuple[float, Calibration]:
    """Turn the rows of all images back until the lens is not decentred; return the roll, rad, and
    the calibration of what is then seen.

    The decentring is followed by secants, as that of a large roll is not proportional to it.

    Raises:
        CalibrationError: if the views are no views of a camera then.
    """
    settings = recover_image_arguments(calibration) | {"model_errors": False}
    size, still = calibration.camera.size, calibration
    decentring = first = float(calibration.camera.params[roll.number])
    last, angle = 0.0, roll.angle
    for _ in range(_MAX_STEPS):
        turned = [_turn_rows_back(view, angle, still.camera) for view in views]
        still = calibrate(turned, size, **settings)
        left = float(still.camera.params[roll.number])
        if abs(left) < _MAX_PART_LEFT * abs(first) or left == decentring:
            break
        following = angle - left * (angle - last) / (left - decentring)
        last, angle, decentring = angle, following, left
    return angle, still


def _turn_rows_back(view: Observation, angle: float, camera: Camera) -> Observation:
    """Turn a view's rows back about the principal point, by `angle` from the first to the last."""
    x, y = (view.uv - camera.centre).T
    turn = -angle * y / camera.size[1]
    turned = np.column_stack(
        [np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y]
    )
    return view._replace(uv=camera.centre + turned)

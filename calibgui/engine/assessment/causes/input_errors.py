"""Errors in what a calibration is given: the corners' frame, held values, misplaced corners.

These come before any test of lens or board, which they would mislead.

The harm of wrong values and corners is measured by doing without them: it is the displacement d of
the camera's pixels (``comparison.py``), by the root mean square over the part of the image that the
remaining corners cover. With s' the standard deviation of a pixel without them, its error with them
is sqrt(d^2 + s'^2), of which d^2 is what they add.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.finding import (
    MAX_LISTED,
    MIN_HARM_PX,
    MIN_VIEWS_TO_JUDGE,
    Cause,
    Finding,
    describe_harm,
)
from calibgui.engine.assessment.residuals.outliers import (
    Screening,
    estimate_coordinate_sigma,
    predict_coordinate_sigma,
    screen_outliers,
)
from calibgui.engine.assessment.residuals.residual_statistics import (
    stack_residuals,
    summarise_residuals,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.repetition import repeat_calibration
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_OUTSIDE_PX = 1.0
"""Distance from the image beyond which a corner is outside, px: a plausibility limit, above the
noise of corners."""
_MAX_REACH_OF_QUARTER, _MIN_EXTENT_OF_QUARTER = 0.55, 0.3
"""Largest coordinate of all corners, and their extent, in the image's size, up to and from which
its upper left quarter alone shows any: as if the image were half as large as stated. Plausibility
limits."""
_MIN_SIGMAS_MOVED = 3.0
"""Move of a freed parameter, in its standard deviations, from which its value is wrong."""
_MIN_OUTLYING = 6.0
"""Length of the largest residual, in sigma of the median one, from which outliers are looked for:
of a thousand sets of 4,000 good corners one has such a residual."""
_MIN_GROSS_SIGMAS = 15.0
"""Distance from where it should be, in sigma of the others, beyond which a corner is grossly
misplaced, and not missed by the model or by a little. A plausibility limit."""


def find_wrong_frame(camera: Camera, views: Sequence[Observation]) -> Finding | None:
    """Find out whether the corners are of another frame, or another image size, than stated.

    They lie outside of the image in most of the views, where single ones were misplaced, or in its
    upper left quarter alone.
    """
    low, high = -0.5 - _OUTSIDE_PX, np.array(camera.size) - 0.5 + _OUTSIDE_PX
    beyond = [((v.uv < low) | (v.uv > high)).any(axis=1) for v in views]
    uv = np.concatenate([view.uv for view in views])
    reach, extent = uv.max(axis=0) / np.array(camera.size), np.ptp(uv, axis=0) / camera.size
    if 2 * sum(bool(b.any()) for b in beyond) > len(views):
        share = float(np.mean(np.concatenate(beyond)))
        message = "Corners lie outside of the image."
        evidence = f"{100 * share:.1f} % of them do, by up to {_measure_excess(uv, camera):.0f} px."
    elif (
        len(views) >= MIN_VIEWS_TO_JUDGE
        and (reach < _MAX_REACH_OF_QUARTER).all()
        and (extent > _MIN_EXTENT_OF_QUARTER).all()
    ):
        message = "All corners lie in the upper left quarter of the image."
        evidence = (
            f"They reach to {100 * reach[0]:.0f} % of its width and {100 * reach[1]:.0f} % of its "
            "height."
        )
    else:
        return None
    return Finding(
        Cause.WRONG_FRAME,
        message,
        evidence,
        "Check the image size, and that (0, 0) is the centre of the upper left pixel.",
        float(max(camera.size)),
        action=Action(ActionKind.LOOK_AT_VIEW, views=(0,)),
    )


def _measure_excess(uv: Array, camera: Camera) -> float:
    """Return the largest distance of corners (n, 2) from the image along an axis, px."""
    return float(np.max(np.maximum(-0.5 - uv, uv - np.array(camera.size) + 0.5)))


def find_wrong_values(calibration: Calibration, views: Sequence[Observation]) -> Finding | None:
    """Find the parameters that the user holds at values that the views contradict.

    All that are held by choice are freed; those are at fault that move by many of their standard
    deviations, which include what board and views may do, if that moves the camera's pixels. One
    finding frees them all: each alone may bring little as long as the others are held.
    """
    camera = calibration.camera
    usual = find_model(camera.model).held
    by_choice = [name for name in calibration.fixed if name not in usual]
    if not by_choice or calibration.settings.method != DEFAULT_METHOD:
        return None
    settings = recover_arguments(calibration)
    try:
        free = repeat_calibration(
            calibration,
            views,
            cost=calibration.cost,
            fix={n: v for n, v in settings["fix"].items() if n not in by_choice},
            free=[*settings["free"], *by_choice],
            board_shape=BoardShapeModel.NOMINAL,
            prior=None,
        )
    except CalibrationError:  # that is why it is held
        return None
    harm = measure_displacement(camera, free.camera, views)
    if harm < MIN_HARM_PX:
        return None
    wrong, values = [], []
    for name in by_choice:
        i = camera.names.index(name)
        held, found = camera.params[i], free.camera.params[i]
        sigmas = abs(found - held) / free.sigma[i] if free.sigma[i] > 0 else 0.0
        if sigmas > _MIN_SIGMAS_MOVED:
            wrong.append(name)
            values.append(
                f"{name} is held at {held:.6g}; free it is {found:.6g}, {sigmas:.0f} of its "
                "standard deviations from there."
            )
    if not wrong:
        return None
    before, after = (summarise_residuals(c.residuals).rms for c in (calibration, free))
    listed = ", ".join(wrong)
    one = len(wrong) == 1
    return Finding(
        Cause.HELD_VALUE,
        f"The views contradict the {'value' if one else 'values'} at which {listed} "
        f"{'is' if one else 'are'} held.",
        f"{' '.join(values)} That leaves residuals of {before:.3g} px instead of {after:.3g}; "
        f"{describe_harm(harm)}.",
        f"Free {listed}, or check where {'its value comes' if one else 'their values come'} from.",
        harm,
        action=Action(ActionKind.FREE_HELD_VALUE, parameters=tuple(wrong)),
    )


def measure_displacement(wrong: Camera, right: Camera, views: Sequence[Observation]) -> float:
    """Measure how far wrong values, corners or views move a camera's pixels, px rms.

    It is the image's size where the two cameras have nothing in common.

    Args:
        wrong, right: the camera with them and without.
        views: the views without them.
    """
    try:
        return compare_cameras(right, wrong, views=views).rms
    except CalibrationError:
        return float(max(wrong.size))


def screen_misplaced_corners(
    calibration: Calibration, views: Sequence[Observation]
) -> Screening | None:
    """Leave corners out that are grossly not where the others say; None if there are none.

    Corners that are off by a few standard deviations are those that the model misses.
    """
    if not has_outlying_corners(calibration, views):
        return None
    try:
        screening = screen_outliers(
            views, calibration.camera.size, **recover_arguments(calibration)
        )
    except CalibrationError:
        return None
    if not screening.rejected:
        return None
    kept = stack_residuals(screening.calibration, on_reference=False)
    lengths = np.linalg.norm(kept, axis=1)
    sigma = estimate_coordinate_sigma(lengths)
    off = _measure_rejected(calibration, screening, views)
    return screening if (off > _MIN_GROSS_SIGMAS * sigma).any() else None


def has_outlying_corners(calibration: Calibration, views: Sequence[Observation]) -> bool:
    """Return whether a residual is too long for its corner's noise, and may be of a gross error."""
    lengths = np.linalg.norm(stack_residuals(calibration, on_reference=False), axis=1)
    sigmas = np.concatenate(
        [
            np.broadcast_to(predict_coordinate_sigma(view, calibration.model_error), len(view.uv))
            for view in views
        ]
    )
    relative = lengths / sigmas
    return bool((relative > _MIN_OUTLYING * estimate_coordinate_sigma(relative)).any())


def _measure_rejected(
    calibration: Calibration, screening: Screening, views: Sequence[Observation]
) -> Array:
    """Measure how far rejected corners are off (n,), px: of whole views, before they were left out.

    A view of which a part is left out has its pose from the rest.
    """
    used = [k for k, kept in enumerate(screening.kept) if kept.any()]
    camera, lengths = screening.calibration.camera, []
    for rejected in screening.rejected:
        k, chosen = rejected.view, list(rejected.corners)
        if rejected.is_whole_view:
            miss = calibration.residuals[k].image
        else:
            pose = screening.calibration.poses[used.index(k)]
            miss = views[k].uv[chosen] - project_points(views[k].xy[chosen], camera, pose)
        lengths.append(np.linalg.norm(miss, axis=1))
    found = np.concatenate(lengths)
    return np.where(np.isfinite(found), found, np.inf)


def describe_misplaced_corners(case: Case, screening: Screening) -> Finding | None:
    """Describe misplaced corners and what they do to the camera; None if that is nothing."""
    worst = sorted(screening.rejected, key=lambda r: len(r.corners), reverse=True)
    listed = ", ".join(
        f"{case.names[r.view]} ({'all' if r.is_whole_view else len(r.corners)})"
        for r in worst[:MAX_LISTED]
    )
    others = len(worst) - MAX_LISTED
    more = f" and {others} other view{'s' * (others > 1)}" if others > 0 else ""
    after = summarise_residuals(screening.calibration.residuals).rms
    kept = screening.select_kept(case.views)
    harm = measure_displacement(case.calibration.camera, screening.calibration.camera, kept)
    if harm < MIN_HARM_PX:
        return None
    chosen = tuple(r.view for r in worst)
    return Finding(
        Cause.MISPLACED_CORNERS,
        f"Corners are not where the others say, in {listed}{more}.",
        f"Without them {after:.2g} px are left of {case.describe_rms()}; {describe_harm(harm)}.",
        "Leave outliers out, or look at the corners of these views.",
        harm,
        chosen,
        Action(_choose_action(screening), chosen),
    )


def _choose_action(screening: Screening) -> ActionKind:
    """Choose between leaving out whole views and the corners that do not fit."""
    is_whole = all(rejected.is_whole_view for rejected in screening.rejected)
    return ActionKind.LEAVE_OUT_VIEWS if is_whole else ActionKind.LEAVE_OUT_CORNERS

"""Findings: what is wrong with a calibration, one cause for one trouble, the most harmful first.

A bent board also looks like a lens that the model does not follow, and a misplaced row of corners
like both. So no test speaks for itself. The causes are asked in an order in which each can be told
without those behind it, and what one explains is taken out before the next is asked:

1. **Frame.** Corners outside of the image are of another frame or another image.
2. **Held values.** A parameter that the user holds is freed; it is at fault if the residuals shrink
   and it moves by many of its standard deviations.
3. **Misplaced corners.** Residuals beyond noise in few places (``outliers.py``). They are left out,
   and all that follows is asked of what is left.
4. **Lens**, if ``calibration/lens_error.py`` says so. It comes before the board.
5. **Board, focus, motion, blur**: the cause that explains nearly all that any explains of what
   noise does not (``noise_test.py``).
6. **Views.** Too few, or too much alike: where a point is imaged is not known to a pixel.

A finding is of use only if the answer depends on it. Causes that shift the camera's pixels by less
than `_MIN_HARM_PX` at the image's edge, and less than the uncertainty that is left without them,
are none. What a finding does not measure is how far a single value is off: that is its standard
deviation, which includes what the board and the views' disagreement do.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.assessment.comparison import compare_cameras
from calibgui.engine.assessment.noise_test import NoiseCheck, check_residuals
from calibgui.engine.assessment.outliers import Screening, screen_outliers
from calibgui.engine.assessment.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, name_views
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty

_MIN_HARM_PX = 0.5
"""Uncertainty of a pixel at the image's edge from which its cause is a finding, px."""
_MIN_DISAGREEMENT = 3.0
"""Ratio of the views' disagreement to what noise explains, from which it is a finding by itself."""
_MAX_POOR_PX = 1.0
"""Uncertainty of a pixel, median over the image, above which the views are too few, px."""
_MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known."""
_MIN_OUTLYING = 6.0
"""Length of the largest residual, in sigma of the median one, from which outliers are looked for:
of a thousand sets of 4,000 good corners one has such a residual."""
_MIN_GROSS_SIGMAS, _MIN_GROSS_PX = 15.0, 1.5
"""Distances from where it should be, in sigma of the others and in px, beyond which a corner is
grossly misplaced, and not missed by the model or by a little."""
_MAX_RANK = 0.9
"""Part of all corners that lie closer to the centre than the median of the misplaced ones, above
which a lens that is not followed at the image's edge is the cause."""
_MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known."""
_MIN_OUTLYING = 6.0
"""Length of the largest residual, in sigma of the median one, from which outliers are looked for:
of a thousand sets of 4,000 good corners one has such a residual."""
_MIN_GROSS_SIGMAS, _MIN_GROSS_PX = 15.0, 1.5
"""Distances from where it should be, in sigma of the others and in px, beyond which a corner is
grossly misplaced, and not missed by the model or by a little."""
_MIN_GROSS_SHARE = 0.2
"""Share of the rejected corners that must be so."""
_MIN_OVER_LENS = 20.0
"""Ratio of their distance to the error of the lens model without them (half as much with them),
below which the lens is the cause."""
_MAX_TOUCHED, _MAX_REJECTED = 0.5, 0.02
"""Shares of the views and of all corners beyond which, both together, the model misses them."""
_MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known."""
_MIN_OUTLYING = 6.0
"""Length of the largest residual, in sigma of the median one, from which outliers are looked for:
of a thousand sets of 4,000 good corners one has such a residual."""
_MIN_GROSS = 12.0
"""Distance of the median rejected corner from where it should be, in sigma of the others, from
which corners are misplaced and not missed by the model."""
_MIN_RISE = 1.3
"""Ratio by which misplaced corners raise the residuals, from which they are named."""
_MIN_SIGMAS_MOVED = 5.0
"""Move of a freed parameter, in its standard deviations by noise, from which its value is wrong."""
_MIN_FALL = 0.05
"""Part by which the residuals shrink when a wrong value is freed."""
_MIN_LENS_PX = 0.1
"""Displacement that a lens model leaves, px rms, from which it is a finding."""
_MIN_HARM_OF_VIEWS_PX = 0.2
"""The same for causes that each view has of its own: what they do differs from view to view, and
little of it is seen at the edge of the mean."""
_MIN_SHARE, _MIN_SHARE_SUSPECT = 0.1, 0.01
"""Share of the squared residuals that a cause explains, from which it is named; and that a board
explains that the calibration suspects by itself (``Calibration.board_shape_error``)."""
_MIN_SHARES = {"focus": 0.1, "bending": 0.1, "rows": 0.3, "lines": 0.3}
"""The same for causes with unknowns in each view, which follow anything a little."""
_MIN_PART_OF_BEST, _MIN_PART_OF_BEST_OF_VIEWS = 0.5, 0.9
"""Part of what the best cause explains, from which one that comes before it is the cause: a board,
and one that each view has of its own."""
_CHECKS_OF_BOARD = ("squares", "bow", "board")
"""Tests of a board that is the same in all views."""
_OUTSIDE_PX = 1.0
"""Distance from the image beyond which a corner is outside, px."""
_MAX_VIEWS_OUTSIDE, _MAX_SHARE_OUTSIDE = 0.5, 0.01
"""Shares of the views with corners outside, and of these corners, above which the frame is wrong:
single corners outside are misplaced."""
_MAX_REACH_OF_QUARTER = 0.55
"""Largest coordinate of all corners, in the image's size, up to which only its upper left quarter
shows any: as if the image were half as large as stated."""
_RAYLEIGH_MEDIAN = float(np.sqrt(2 * np.log(2)))
"""Median of a Rayleigh distribution, in units of its parameter."""


class Cause(StrEnum):
    """The causes that a finding can name."""

    WRONG_FRAME = "wrong-frame"
    HELD_VALUE = "held-value"
    MISPLACED_CORNERS = "misplaced-corners"
    LENS = "lens"
    BOARD_SHAPE = "board-shape"
    FOCUS = "focus"
    BENDING_BOARD = "bending-board"
    ROLLING_SHUTTER = "rolling-shutter"
    LINE_JITTER = "line-jitter"
    DISAGREEMENT = "views-disagree"
    """The views disagree about the camera, and the evidence singles no cause out."""
    BLUR = "blur"
    FEW_VIEWS = "few-views"


_CAUSES_OF_CHECKS = {
    "squares": Cause.BOARD_SHAPE,
    "bow": Cause.BOARD_SHAPE,
    "board": Cause.BOARD_SHAPE,
    "lens": Cause.LENS,
    "focus": Cause.FOCUS,
    "bending": Cause.BENDING_BOARD,
    "rows": Cause.ROLLING_SHUTTER,
    "lines": Cause.LINE_JITTER,
    "views": Cause.BLUR,
}
"""Causes by the names of the tests of ``noise_test.py``."""
_MESSAGES = {
    Cause.LENS: "The lens model {model} does not follow this lens.",
    Cause.BOARD_SHAPE: "The board is not as it was drawn.",
    Cause.FOCUS: "The focal length differs between the views.",
    Cause.BENDING_BOARD: "The board bends from view to view.",
    Cause.ROLLING_SHUTTER: "Camera or board moved while the image's rows were read.",
    Cause.LINE_JITTER: "The image's rows are shifted sideways against each other.",
    Cause.BLUR: "Some views are less sharp than the others.",
}
"""What is wrong, in a sentence."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that is wrong with a calibration and matters to who uses it."""

    cause: Cause
    """What it is."""
    message: str
    """Sentence that says what is wrong."""
    evidence: str
    """Sentence with the figures that show it."""
    remedy: str
    """Sentence that says what to do."""
    harm: float
    """How far pixels are off because of it, px: at the image's edge, or rms where it is known."""
    views: tuple[int, ...] = ()
    """Indices of the views that it is found in; none if in all."""


def list_findings(
    calibration: Calibration, views: Sequence[Observation], names: Sequence[str] | None = None
) -> tuple[Finding, ...]:
    """List what is wrong with a calibration, the most harmful first.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
    """
    return tuple(sorted(_find(calibration, views, names), key=lambda f: f.harm, reverse=True))


def _find(
    calibration: Calibration, views: Sequence[Observation], names: Sequence[str] | None
) -> Iterator[Finding]:
    names = names or name_views(len(views))
    frame = find_wrong_frame(calibration.camera, views)
    if frame is not None:
        yield frame
        return
    if calibration.diagnosis is not None:  # it names its cause itself
        return
    held = list(_find_held_values(calibration, views))
    yield from held
    if held:
        return
    screening = _find_misplaced(calibration, views)
    if screening is not None:
        misplaced = _describe_misplaced(calibration, screening, views, names)
        if misplaced is not None:
            yield misplaced
        views = [
            _keep_corners(view, kept)
            for view, kept in zip(views, screening.kept, strict=True)
            if kept.any()
        ]
        calibration = screening.calibration
    few = _find_lack_of_views(calibration, views)
    if len(views) < _MIN_VIEWS_TO_JUDGE and few is not None:
        yield few  # whatever else the residuals look like
        return
    found = _find_systematic_cause(calibration, views, names) or few
    yield from filter(None, [found or _find_disagreement(calibration, views)])


def find_wrong_frame(camera: Camera, views: Sequence[Observation]) -> Finding | None:
    """Find out whether the corners are of another frame, or another image size, than stated.

    They lie outside of the image in most of the views, or in its upper left quarter alone.
    """
    low, high = -0.5 - _OUTSIDE_PX, np.array(camera.size) - 0.5 + _OUTSIDE_PX
    beyond = [((v.uv < low) | (v.uv > high)).any(axis=1) for v in views]
    share = float(np.mean(np.concatenate(beyond)))
    uv = np.concatenate([view.uv for view in views])
    reach = uv.max(axis=0) / np.array(camera.size)
    if np.mean([b.any() for b in beyond]) > _MAX_VIEWS_OUTSIDE and share > _MAX_SHARE_OUTSIDE:
        message = "Corners lie outside of the image."
        evidence = f"{100 * share:.1f} % of them do, by up to {_measure_excess(uv, camera):.0f} px."
    elif len(views) >= _MIN_VIEWS_TO_JUDGE and (reach < _MAX_REACH_OF_QUARTER).all():
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
    )


def _measure_excess(uv: Array, camera: Camera) -> float:
    """Return the largest distance of corners (n, 2) from the image along an axis, px."""
    return float(np.max(np.maximum(-0.5 - uv, uv - np.array(camera.size) + 0.5)))


def _find_held_values(calibration: Calibration, views: Sequence[Observation]) -> Iterator[Finding]:
    """Find parameters that the user holds at values that the views contradict."""
    camera = calibration.camera
    usual = find_model(camera.model).held
    by_choice = [name for name in calibration.fixed if name not in usual]
    if not by_choice or calibration.settings.get("method"):
        return
    settings = _plain_settings(calibration)
    settings["fix"] = {n: v for n, v in settings["fix"].items() if n not in by_choice}
    settings["free"] = [*settings["free"], *by_choice]
    try:
        free = calibrate(views, camera.size, **settings)
    except CalibrationError:  # that is why it is held
        return
    before, after = (summarise_residuals(c.residuals).rms for c in (calibration, free))
    if after > (1 - _MIN_FALL) * before:
        return
    for name in by_choice:
        i = camera.names.index(name)
        moved = free.camera.params[i] - camera.params[i]
        sigmas = abs(moved) / free.sigma_by_noise[i] if free.sigma_by_noise[i] > 0 else 0.0
        if sigmas > _MIN_SIGMAS_MOVED:
            yield Finding(
                Cause.HELD_VALUE,
                f"The views contradict the value at which {name} is held.",
                f"Held at {camera.params[i]:.6g}, it leaves {before:.3g} px RMS; free it is "
                f"{free.camera.params[i]:.6g}, {sigmas:.0f} of its standard deviations from there, "
                f"and {after:.3g} px are left.",
                f"Free {name}, or check where its value comes from.",
                before,
            )


def _plain_settings(calibration: Calibration) -> dict[str, Any]:
    """Return the arguments that repeat a calibration, by the image cost on the board as drawn."""
    settings = recover_arguments(calibration)
    for name in ("board_shape", "prior", "method"):
        del settings[name]
    if settings["cost"] is Cost.PAPER:
        del settings["model"]
    return settings


def _find_misplaced(calibration: Calibration, views: Sequence[Observation]) -> Screening | None:
    """Find corners that are grossly not where the others say; None if there are none.

    Corners that are off by a few standard deviations, at the edges of many views, are those that
    the model misses.
    """
    lengths = np.concatenate([np.linalg.norm(v.image, axis=1) for v in calibration.residuals])
    if lengths.max() < _MIN_OUTLYING * np.median(lengths) / _RAYLEIGH_MEDIAN:
        return None
    settings = recover_arguments(calibration)
    try:
        screening = screen_outliers(views, calibration.camera.size, **settings)
    except CalibrationError:
        return None
    if not screening.rejected:
        return None
    found = screening.calibration
    usual = np.concatenate([np.linalg.norm(view.image, axis=1) for view in found.residuals])
    sigma = float(np.median(usual)) / _RAYLEIGH_MEDIAN
    off = _measure_rejected(calibration, screening, views)
    is_gross = off > max(_MIN_GROSS_SIGMAS * sigma, _MIN_GROSS_PX)
    if not is_gross.any():
        return None
    radius = np.linalg.norm(
        np.concatenate([view.uv for view in views]) - found.camera.centre, axis=1
    )
    uv = np.concatenate([views[r.view].uv[list(r.corners)] for r in screening.rejected])
    rejected = np.linalg.norm(uv - found.camera.centre, axis=1)[is_gross]
    rank = np.mean(radius < np.median(rejected))
    return screening if rank < _MAX_RANK else None


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


def _describe_misplaced(
    calibration: Calibration,
    screening: Screening,
    views: Sequence[Observation],
    names: Sequence[str],
) -> Finding | None:
    """Describe misplaced corners and what they do to the camera; None if that is nothing."""
    worst = sorted(screening.rejected, key=lambda r: len(r.corners), reverse=True)
    listed = ", ".join(
        f"{names[r.view]} ({'all' if r.is_whole_view else len(r.corners)})" for r in worst[:5]
    )
    more = f" and {len(worst) - 5} other views" if len(worst) > 5 else ""
    before, after = (
        summarise_residuals(c.residuals).rms for c in (calibration, screening.calibration)
    )
    try:
        harm = compare_cameras(screening.calibration.camera, calibration.camera, views=views).worst
    except CalibrationError:
        harm = before
    if harm < _MIN_HARM_PX and before < _MIN_RISE * after:
        return None
    return Finding(
        Cause.MISPLACED_CORNERS,
        f"Corners are not where the others say, in {listed}{more}.",
        f"Without them the RMS falls from {before:.3g} to {after:.3g} px, and the camera's pixels "
        f"move by up to {harm:.2g} px.",
        "Leave outliers out (--robust), or look at the corners of these views.",
        max(harm, before),
        tuple(r.view for r in worst),
    )


def _keep_corners(view: Observation, kept: BoolArray) -> Observation:
    """Return the view with the kept corners only."""
    return Observation(view.uv[kept], view.xy[kept], None if view.cov is None else view.cov[kept])


def _find_systematic_cause(
    calibration: Calibration, views: Sequence[Observation], names: Sequence[str]
) -> Finding | None:
    """Find the one cause of residuals that are not noise; None if none matters."""
    model, rms = calibration.camera.model, summarise_residuals(calibration.residuals).rms
    if calibration.lens_error > _MIN_LENS_PX:
        return _describe_lens(model, calibration.lens_error, rms)
    report = check_residuals(calibration, views, names)
    check = _choose_cause(calibration, {c.name: c for c in report.checks if not c.passed})
    if check is None:
        return None
    cause = _CAUSES_OF_CHECKS[check.name]
    if cause is Cause.LENS:
        error = float(np.sqrt(check.share)) * rms
        return _describe_lens(model, error, rms) if error > _MIN_LENS_PX else None
    harm = _measure_edge_uncertainty(calibration, views)
    is_mild = cause in (Cause.BOARD_SHAPE, Cause.LINE_JITTER)
    if harm < (_MIN_HARM_PX if is_mild else _MIN_HARM_OF_VIEWS_PX):
        return None
    return _describe_check(cause, check, calibration, rms, harm)


def _choose_cause(calibration: Calibration, failed: dict[str, NoiseCheck]) -> NoiseCheck | None:
    """Choose the cause among the tests that failed; None if there is none.

    What a board that is always the same explains, boards that bend anew in each view and shutters
    that roll explain as well, since they have unknowns of their own in each view; so it comes
    first. The remaining order is that of the tests.
    """
    found = {name: check for name, check in failed.items() if name in _CAUSES_OF_CHECKS}
    best = max((check.share for check in found.values()), default=0.0)
    board = [found[name] for name in _CHECKS_OF_BOARD if name in found]
    explained = max((check.share for check in board), default=0.0)
    is_suspect = calibration.board_shape_error > 0
    enough = _MIN_SHARE_SUSPECT if is_suspect else _MIN_SHARE
    if board and explained >= max(enough, _MIN_PART_OF_BEST * best):
        return next(c for c in board if c.share >= _MIN_PART_OF_BEST * explained)
    for name, check in found.items():
        if name not in _CHECKS_OF_BOARD and check.share >= _MIN_PART_OF_BEST_OF_VIEWS * best:
            return check if check.share >= _MIN_SHARES.get(name, 0.0) else None
    return None


def _describe_lens(model: str, error: float, rms: float) -> Finding:
    return Finding(
        Cause.LENS,
        _MESSAGES[Cause.LENS].format(model=model),
        f"Of {rms:.3g} px RMS it leaves {error:.2g} px that all views share and the board does not "
        "explain.",
        "Choose another lens model (--model auto), or compare the lens models.",
        error,
    )


def _describe_check(
    cause: Cause, check: NoiseCheck, calibration: Calibration, rms: float, harm: float
) -> Finding:
    """Describe the cause that a test of the residuals points to."""
    evidence = f"It explains {100 * check.share:.0f} % of the squared residuals of {rms:.3g} px RMS"
    if cause is Cause.BOARD_SHAPE and calibration.board_shape_error > 0:
        evidence += f"; corners of the board are off by {calibration.board_shape_error:.2g} mm"
    if cause is Cause.BLUR:
        evidence = f"Their corners scatter unequally: {check.finding}"
    remedy = check.advice.partition(": ")[2]
    return Finding(
        cause,
        _MESSAGES[cause],
        f"{evidence}; pixels at the image's edge are known to {harm:.2g} px.",
        remedy[:1].upper() + remedy[1:],
        harm,
    )


def _measure_edge_uncertainty(calibration: Calibration, views: Sequence[Observation]) -> float:
    """Return one standard deviation of a pixel where it is largest over the image, px."""
    return float(estimate_projection_uncertainty(calibration, views).worst)


def _find_lack_of_views(calibration: Calibration, views: Sequence[Observation]) -> Finding | None:
    """Find out whether the views are too few, or too much alike; None if they are not."""
    known = estimate_projection_uncertainty(calibration, views)
    count = len(views)
    few = count < _MIN_VIEWS_TO_JUDGE
    if not (known.median > _MAX_POOR_PX or (few and known.worst > _MIN_HARM_PX)):
        return None
    return Finding(
        Cause.FEW_VIEWS,
        f"{count} views are too few." if few else "The views are too few, or too much alike.",
        f"A pixel is known to {known.median:.2g} px in the median over the image, and to "
        f"{known.worst:.2g} px at its edge.",
        "Add views with the board tilted by 20 to 45 degrees in different directions and all over "
        "the image; six good ones are enough.",
        float(known.worst),
    )


def _find_disagreement(calibration: Calibration, views: Sequence[Observation]) -> Finding | None:
    """Find views that disagree about the camera for no cause that is known; None if they agree."""
    if calibration.overdispersion < _MIN_DISAGREEMENT:
        return None
    harm = _measure_edge_uncertainty(calibration, views)
    if harm < _MIN_HARM_OF_VIEWS_PX:
        return None
    return Finding(
        Cause.DISAGREEMENT,
        "The views disagree about the camera, and no usual cause explains it.",
        f"They do so {calibration.overdispersion:.1f} times as much as the noise of their corners "
        f"explains; pixels at the image's edge are known to {harm:.2g} px.",
        "Look for photographs of another camera, zoom or board among them, and calibrate each kind "
        "by itself.",
        harm,
    )

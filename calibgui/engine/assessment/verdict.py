"""The verdict on a calibration: good, usable, can be so many times better, or not usable.

It is decided from the error of a pixel over the image, which has two parts. One is the standard
deviation of projection (``changes/camera_uncertainty.py``), at infinity, beside a rotation of the
camera, and in the direction where it is largest; it includes noise, the board's shape and the
views' disagreement. The other is what that leaves out: a lens that the model does not follow,
corners that are not where they are said to be, a wrong value that is held. Both together are
measured by carrying out what remedies a finding (``action_trials.py``). With s' the standard
deviation afterwards and d the displacement of the camera's pixels by the remedy
(``comparison.py``), the error before was

    e = sqrt(d^2 + s'^2),

and the remedy makes it e / s' times smaller, by the root mean square over the part of the image
that the corners of all views cover (``comparison.find_covered_pixels``). So the number in "can be x
times better" is what a trial gave for the stated errors, and the same comes out when it is done
again. Where nothing can be tried, e is the standard deviation as it is. Beyond the corners it
includes how far another lens model goes there that fits as well (``lens_extrapolation.py``). A
board's shape that brings nothing is not what is wrong; where it leaves pixels too poorly known all
the same, the views do not tell board and camera apart, and photographs of a stiff board are needed.

Against the truth of 23 rendered sets with shifted rows, wrong held values, bowed boards and unequal
squares that were remedied (``tests/benchmarks/verdict_gain.py``), e was within 16 % in 21, 27 % too
large in one, and 2.2 times in one that has little to gain; the true error fell by 0.66 to 4.1 times
x, 1.2 in the median: the truth is one draw.

A calibration is good where it has been measured: its grade rests on the pixels that corners cover,
and on half of all pixels. What is found wrong lowers it where it makes errors larger than the
limit. A board in the image's middle is not enough: where corners cover too little to know half of
the pixels, this is a finding. An edge of the image that no photograph shows is no error of the
calibration; its uncertainty is said in a sentence.

The error does not measure what no photograph of the set shows: the length of the squares, or a
lens far from all corners that behaves otherwise than both formulas.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.action_trials import Trial, try_action_safely
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.changes.camera_uncertainty import (
    estimate_camera_uncertainty,
    split_camera_uncertainty,
)
from calibgui.engine.assessment.changes.comparison import compare_cameras, find_covered_pixels
from calibgui.engine.assessment.finding import (
    MAX_GOOD_PX,
    MAX_TELLING_PX,
    MAX_USABLE_PX,
    MIN_GAIN_TO_ACT,
    Cause,
    Finding,
    describe_narrow_views,
)
from calibgui.engine.assessment.lens_extrapolation import map_disagreement
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.threads import with_one_blas_thread
from calibgui.engine.uncertainty.projection_uncertainty import make_map_grid

MIN_TIMES_BETTER = 1.5
"""Ratio by which a remedy must make the error smaller to be worth the headline. A choice, which no
benchmark fixed."""
_REMEDY_OF_BLUR = (
    "Take these again, sharp, in good light and from nearer: to weigh them less brings little."
)
"""The remedy of unequal noise where weights bring the camera little."""
_MIN_VIEWS_TO_USE, MIN_VIEWS_TO_BE_GOOD = 3, 5
"""Number of views below which a calibration is not usable, and not good, however small its error is
said to be: too few are left to find out that it is wrong."""
_REMEDY_OF_BEST_LENS = (
    "No lens model that these views determine follows it better. If the images were scaled, "
    "stitched or corrected, use them as the camera takes them; else add views up to the image's "
    "edges, which determine more of the lens."
)
"""The remedy of a lens that the recommended model does not follow."""
_REMEDY_OF_BOARD = (
    "These photographs do not tell board and camera apart: put the board on glass or another stiff "
    "plate, and take 10 to 20 of it, tilted by 20 to 45 degrees in different directions."
)
_UNTRUSTWORTHY = (Cause.WRONG_FRAME, Cause.HELD_VALUE)
"""Causes that leave a camera unusable if no remedy can be tried."""


class Grade(StrEnum):
    """The grades of a calibration."""

    GOOD = "good"
    USABLE = "usable"
    CAN_BE_BETTER = "can-be-better"
    """Grade of a calibration whose photographs give a better camera, by `Verdict.times_better`."""
    NOT_USABLE = "not-usable"


@dataclass(frozen=True, slots=True)
class PixelError:
    """The error of a pixel over the image, one standard deviation, px.

    NaN where the lens has no ray, infinite where the camera is not determined.
    """

    centre: float
    """At the image's centre."""
    edge: float
    """Root mean square along the edge of the image, or of what the lens shows of it."""
    worst: float
    """At the worst pixel."""
    median: float
    """Median over the image."""
    covered: float
    """Root mean square over the part of the image that the corners of all views cover."""
    worst_covered: float
    """At the worst pixel of that part."""


_UNKNOWN = PixelError(*[np.inf] * 6)


@dataclass(frozen=True, slots=True)
class Verdict:
    """The grade of a calibration, the error of its pixels, and what is wrong with it."""

    grade: Grade
    """The grade."""
    reason: str
    """A sentence that says why."""
    error: PixelError
    """The error of pixels."""
    mm_per_pixel: float
    """Length of a pixel at the boards' distance, mm; it is as certain as the square's length."""
    distance: float
    """Median distance of the boards from the camera, mm."""
    findings: tuple[Finding, ...] = ()
    """The findings, the most harmful first, with what their actions bring."""

    @property
    def times_better(self) -> float:
        """Ratio by which the action on the first finding makes the error smaller; 1 if none does.

        Where the most harmful cause has no remedy, what is done about others brings less than it
        seems.
        """
        return self.findings[0].times_better if self.findings else 1.0

    @property
    def is_known_well(self) -> bool:
        """Return whether the calibration is good, and for every pixel of the image."""
        return self.grade is Grade.GOOD and self.error.worst <= MAX_GOOD_PX


@with_one_blas_thread
def judge_calibration(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str] | None = None,
    check: Callable[[], None] | None = None,
) -> Verdict:
    """Judge a calibration: list what is wrong, try what remedies it, and grade the camera.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
        check: a function that is called now and then, and raises to abandon the work.
    """
    known = split_camera_uncertainty(calibration, views)
    found = list_findings(calibration, views, names, check or (lambda: None), known)
    covered = _find_covered(calibration.camera.size, views)
    errors: list[Array] = []
    tried: list[Finding] = []
    mended: Array | None = None
    for finding in found:
        trial = try_action_safely(finding.action, calibration, views, check)
        if trial is None:
            if finding.without is not None:
                move = _map_move(finding.without, calibration, views)
                errors.append(np.hypot(move, known[0].worst_direction))
            tried.append(_ask_for_photographs(finding))
            continue
        before, after = _compare_with_trial(calibration, views, trial)
        times = max(_compute_rms(before[covered]) / _compute_rms(after[covered]), 1.0)
        if trial.action.kind is ActionKind.ESTIMATE_BOARD_SHAPE:
            if times < MIN_TIMES_BETTER and not np.nanmedian(after) <= MAX_USABLE_PX:
                tried.append(_ask_for_photographs(finding))
                continue
            if times < MIN_GAIN_TO_ACT:
                continue
        is_weighed = trial.action.kind is ActionKind.WEIGH_VIEWS
        if is_weighed and times < MIN_GAIN_TO_ACT and _is_small(finding.harm, before[covered]):
            continue
        if not tried and times >= MIN_TIMES_BETTER:
            mended = after
        errors.append(before)
        tried.append(_state_gain(finding, trial, times))
    error = np.fmax.reduce(errors) if errors else known[0].worst_direction
    if calibration.diagnosis is None:
        error = np.hypot(error, map_disagreement(calibration, views))
    distance = _measure_distance(calibration, views)
    pixels = _UNKNOWN if calibration.diagnosis is not None else _summarise(error, covered)
    left = pixels if mended is None else _summarise(mended, covered)
    if _is_narrow(calibration, left, tried):
        part, is_mended = float(covered[~np.isnan(error)].mean()), mended is not None
        narrow = describe_narrow_views(part, left.covered, left.median, is_mended)
        tried = sorted([*tried, narrow], key=lambda finding: finding.harm, reverse=True)
    grade, reason = _grade(calibration, pixels, tried)
    mm = distance / float(calibration.camera.focal[0])
    return Verdict(grade, reason, pixels, mm, distance, tuple(tried))


def _ask_for_photographs(finding: Finding) -> Finding:
    """Return a finding whose action cannot be tried, with one that helps where that is known.

    The shape of a board that the views do not allow to be estimated well takes more of them.
    """
    if finding.cause is not Cause.BOARD_SHAPE:
        return finding
    return replace(finding, remedy=_REMEDY_OF_BOARD, action=Action(ActionKind.PHOTOGRAPH_MORE))


def _state_gain(finding: Finding, trial: Trial, times: float) -> Finding:
    """Return the finding with what its action brings.

    A lens that no other model follows better takes other photographs, and more of them where they
    are few; photographs whose weights change nothing can be taken again. What is left out remains
    wrong even where the camera does not gain by it.
    """
    found = replace(finding, action=trial.action, times_better=times)
    if times < MIN_GAIN_TO_ACT and trial.action.kind is ActionKind.CHOOSE_LENS_MODEL:
        message, count = found.message, len(trial.calibration.poses)
        if count < MIN_VIEWS_TO_BE_GOOD:
            message = f"{count} views are too few: {message[:1].lower()}{message[1:]}"
        photograph = Action(ActionKind.PHOTOGRAPH_MORE)
        return replace(found, message=message, remedy=_REMEDY_OF_BEST_LENS, action=photograph)
    if times < MIN_GAIN_TO_ACT and trial.action.kind is ActionKind.WEIGH_VIEWS:
        return replace(found, action=None, remedy=_REMEDY_OF_BLUR)
    return found


def _is_small(harm: float, error: Array) -> bool:
    """Return whether errors, px, would hardly be smaller without a harm, px rms."""
    rms = _compute_rms(error)
    return float(np.hypot(harm, rms / MIN_GAIN_TO_ACT)) < rms


def _compare_with_trial(
    calibration: Calibration, views: Sequence[Observation], trial: Trial
) -> tuple[Array, Array]:
    """Return the errors (m, n) before an action and after it, px; NaN where there is no image."""
    uv = make_mesh(*make_map_grid(calibration.camera.size))
    after = estimate_camera_uncertainty(trial.calibration, trial.views).worst_direction
    after = np.where(calibration.camera.lights(uv), after, np.nan)
    return np.hypot(_map_move(trial.calibration.camera, calibration, views), after), after


def _map_move(camera: Camera, calibration: Calibration, views: Sequence[Observation]) -> Array:
    """Map how far a calibration's pixels (m, n) are from those of another camera, px."""
    return compare_cameras(camera, calibration.camera, views=views).length


def _find_covered(size: Size, views: Sequence[Observation]) -> BoolArray:
    """Return (m, n) which pixels of a map over the image the corners of all views cover."""
    return find_covered_pixels(make_mesh(*make_map_grid(size)), views)


def _compute_rms(error: Array) -> float:
    """Return the root mean square of errors that are known; infinite if none is."""
    known = error[np.isfinite(error)]
    return float(np.sqrt(np.mean(known**2))) if known.size else np.inf


def _summarise(error: Array, covered: BoolArray) -> PixelError:
    """Summarise a map (m, n) of errors, px, of which a part is covered (m, n)."""
    seen = np.isfinite(error)
    if not seen.any():
        return _UNKNOWN
    rows, cols = error.shape
    framed = np.pad(seen, 1)
    is_inside = framed[:-2, 1:-1] & framed[2:, 1:-1] & framed[1:-1, :-2] & framed[1:-1, 2:]
    edge = seen & ~is_inside
    return PixelError(
        float(error[rows // 2, cols // 2]),
        _compute_rms(error[edge]),
        float(np.nanmax(error)),
        float(np.nanmedian(error)),
        _compute_rms(error[covered]),
        float(np.fmax.reduce(error[covered], initial=0.0)),
    )


def _measure_distance(calibration: Calibration, views: Sequence[Observation]) -> float:
    """Measure the median distance of the boards' middles from the camera, mm."""
    R = rotation_from_vector(np.array([pose.rvec for pose in calibration.poses]))
    middles = [
        turn[:, :2] @ view.xy.mean(axis=0) + pose.tvec
        for turn, view, pose in zip(R, views, calibration.poses, strict=True)
    ]
    return float(np.median(np.linalg.norm(middles, axis=-1)))


def _is_narrow(calibration: Calibration, error: PixelError, findings: Sequence[Finding]) -> bool:
    """Return whether pixels are known well among corners and too poorly over the image, for no
    other cause that asks for photographs.

    Args:
        calibration: the calibration.
        error: the errors of its pixels, once what makes them much better is done.
        findings: what is wrong.
    """
    is_judged = calibration.diagnosis is None and calibration.status is Status.CONVERGED
    is_told = any(f.cause is Cause.FEW_VIEWS or f.without is not None for f in findings)
    is_poor = error.covered <= MAX_USABLE_PX and not error.median <= MAX_USABLE_PX
    return is_judged and is_poor and not is_told


def _grade(
    calibration: Calibration, error: PixelError, findings: Sequence[Finding]
) -> tuple[Grade, str]:
    """Grade a calibration; return the grade and a sentence that says why."""
    if calibration.diagnosis is not None:
        return Grade.NOT_USABLE, "The views do not determine the camera."
    if calibration.status is not Status.CONVERGED:
        return Grade.NOT_USABLE, "The calibration is not finished."
    count = len(calibration.poses)
    few = "One view cannot be checked" if count == 1 else f"{count} views are too few"
    # A finding has a remedy of its own.
    few += "." if findings else f": take {MIN_VIEWS_TO_BE_GOOD} or more, tilted in all directions."
    if count < _MIN_VIEWS_TO_USE:
        return Grade.NOT_USABLE, few
    if findings and findings[0].times_better >= MIN_TIMES_BETTER:
        return Grade.CAN_BE_BETTER, findings[0].message
    is_poor = not error.median <= MAX_USABLE_PX
    for finding in findings:
        if is_poor or finding.cause in _UNTRUSTWORTHY:
            return Grade.NOT_USABLE, finding.message
    if is_poor:
        return Grade.NOT_USABLE, "The camera is not known well enough: add photographs."
    if findings and (count < MIN_VIEWS_TO_BE_GOOD or not error.worst_covered <= MAX_GOOD_PX):
        return Grade.USABLE, findings[0].message
    if count < MIN_VIEWS_TO_BE_GOOD:
        return Grade.USABLE, few
    if not error.worst_covered <= MAX_GOOD_PX:
        return Grade.USABLE, (
            "The photographs show nothing wrong, but the camera is known to "
            f"{format_two_digits(error.worst_covered)} px only: add photographs."
        )
    if findings:
        known = f"camera is known to {format_two_digits(error.worst_covered)} px."
        little = f"Of little effect: {findings[0].message}"
        if error.median <= MAX_GOOD_PX:
            return Grade.GOOD, f"Nothing needs to be done: the {known} {little}"
        return Grade.USABLE, f"The {known} {little}"
    if error.worst <= MAX_GOOD_PX:
        return Grade.GOOD, "The photographs show nothing wrong."
    grade = Grade.GOOD if error.median <= MAX_GOOD_PX else Grade.USABLE
    return grade, (
        "Nothing is wrong where corners were seen: the camera is known to "
        f"{format_two_digits(error.worst_covered)} px. Beyond them it is "
        f"{_tell_how_known(error)}: hold the board closer to the image's edges."
    )


def _tell_how_known(error: PixelError) -> str:
    """Say how well the worst pixel is known, unless a lens that is open there makes it anything."""
    if not error.worst < MAX_TELLING_PX:
        return "not known"
    return f"known to {format_two_digits(error.worst)} px"

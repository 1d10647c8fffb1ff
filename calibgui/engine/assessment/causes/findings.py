"""Findings: what is wrong with a calibration, one cause for one trouble, the most harmful first.

A bent board also looks like a lens that the model does not follow, and a misplaced row of corners
like both. So no test speaks for itself. The causes are asked in an order in which each can be told
without those behind it, and what one explains is taken out before the next is asked:

1. **What is given** (``input_errors.py``): corners of another frame or image size, values that are
   held and wrong, two pictures in one photograph (``two_pictures.py``), photographs that are turned
   against the others or do not belong to them (``odd_views.py``), corners that are not where the
   others say. The latter are left out, and all that follows is asked of what is left.
2. **Number of views.** Two or three views show nothing but that they are too few, if pixels are
   poorly known. Nor do views so much alike that the noise alone leaves pixels poorly known. Where
   pixels are known well among corners, these cover too small a part of the image.
3. **Residuals that are not noise** (``cause_choice.py``), which have one cause.
A finding is of use only if the answer depends on it: each has the harm that its cause does to
pixels (``case.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.causes.case import Case, prepare_case
from calibgui.engine.assessment.causes.cause_choice import (
    MIN_SHARE_OF_KINDS,
    MIN_SHARE_OF_RIVAL,
    describe_strangers,
    describe_turned_views,
    estimate_board,
    find_systematic_cause,
    list_names,
)
from calibgui.engine.assessment.causes.input_errors import (
    describe_misplaced_corners,
    find_wrong_frame,
    find_wrong_values,
    has_outlying_corners,
    screen_misplaced_corners,
)
from calibgui.engine.assessment.causes.odd_views import Strangers, find_odd_views
from calibgui.engine.assessment.causes.two_pictures import TwoPictures, find_two_pictures
from calibgui.engine.assessment.finding import (
    MAX_GOOD_PX,
    MAX_USABLE_PX,
    MIN_VIEWS_TO_JUDGE,
    REMEDY_OF_FEW_VIEWS,
    Cause,
    Finding,
    describe_harm,
    describe_narrow_views,
)
from calibgui.engine.assessment.residuals.outliers import Screening
from calibgui.engine.assessment.residuals.residual_causes import Family, list_tests
from calibgui.engine.calibration.observations import Observation, name_views
from calibgui.engine.calibration.repetition import repeat_calibration
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.errors import CalibrationError
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.threads import with_one_blas_thread
from calibgui.engine.uncertainty.projection_uncertainty import ProjectionUncertainty

_MAX_NOISE_PX = 0.5
"""Uncertainty of a pixel by the noise that no cause explains, median over the image, above which
the views are too much alike, px. Of ten bursts it was 0.2 to 1.8, above this in nine; of 60 faults
of boards and shutters (``tests/faults``), in which pixels were known to more than 1 px, below 0.27.
"""
_MIN_PART_LEFT = 0.1
"""Part of what a cause explains of all corners that it explains without those that do not fit, from
which the model misses these. Of 401 faults (``tests/faults``) it was below 0.001 where corners were
misplaced; of boards that were bent as well, by up to 1 mm, below 0.06."""


@with_one_blas_thread
def list_findings(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str] | None = None,
    check: Callable[[], None] = lambda: None,
    known: tuple[ProjectionUncertainty, ProjectionUncertainty] | None = None,
) -> tuple[Finding, ...]:
    """List what is wrong with a calibration, the most harmful first.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
        check: a function that is called now and then, and raises to abandon the work.
        known: what ``split_camera_uncertainty`` says of it, if that is at hand.
    """
    found = _find(calibration, views, names or name_views(len(views)), check, known)
    return tuple(sorted(found, key=lambda finding: finding.harm, reverse=True))


def _find(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str],
    check: Callable[[], None],
    known: tuple[ProjectionUncertainty, ProjectionUncertainty] | None,
) -> Iterator[Finding]:
    """Yield what is wrong; the order of the tests is that of the description above."""
    frame = find_wrong_frame(calibration.camera, views)
    if frame is not None:
        yield frame
        return
    if calibration.diagnosis is not None:  # it names its cause itself
        return
    wrong = find_wrong_values(calibration, views)
    if wrong is not None:
        yield wrong
        return
    case = prepare_case(calibration, views, names, check, known)
    open_coefficients = _find_open_coefficients(case)
    if calibration.cost is not Cost.IMAGE:
        calibration = _minimise_image_cost(calibration, views)
        case = prepare_case(calibration, views, names, check).follow(case, "as it was calibrated")
    pictures = find_two_pictures(calibration, views)
    if pictures is not None:
        yield _describe_two_pictures(case, pictures)
        return
    odd = find_odd_views(case)
    if odd.turned is not None and not _are_of_two_kinds(case, odd.turned.views):
        yield describe_turned_views(case, odd.turned)
        return
    screening = screen_misplaced_corners(calibration, views)
    left = None if screening is None else _leave_out(screening, case)
    if left is not None and _misses_views(case, left):
        left = None
    if left is None and odd.strangers is not None and _are_strangers(case, odd.strangers):
        strangers = describe_strangers(case, odd.strangers)
        if strangers is not None:
            yield strangers
            return
    if screening is not None and left is not None:
        misplaced = describe_misplaced_corners(case, screening)
        if misplaced is not None:
            yield misplaced
        case = left  # large errors of a few corners leave coefficients open, too
        open_coefficients = _find_open_coefficients(case)
    found = few = _find_lack_of_views(case)
    if few is None or not (len(case.views) < MIN_VIEWS_TO_JUDGE or _is_noise_enough(case)):
        found = find_systematic_cause(case) or few
    if open_coefficients is not None and (found is None or found.cause is not Cause.LENS):
        yield open_coefficients  # those of a model that is to be replaced go with it
    if found is not None:
        yield found


def _minimise_image_cost(calibration: Calibration, views: Sequence[Observation]) -> Calibration:
    """Return the calibration by the image cost, whose residuals tell of photographs and board.

    Those of another cost tell of the cost as well, which gives views other weights. It is returned
    as it is where the views do not determine a camera by the image cost.
    """
    try:
        return repeat_calibration(calibration, views)
    except CalibrationError:
        return calibration


def _describe_two_pictures(case: Case, found: TwoPictures) -> Finding:
    """Describe photographs that show two pictures, by the views of that with fewer views."""
    is_second = 2 * int(found.is_second.sum()) <= len(found.is_second)
    views = tuple(np.flatnonzero(found.is_second == is_second).tolist())
    sides = (("left of column", "right of column"), ("above row", "below row"))
    where = f"{sides[found.axis][is_second]} {found.border:.0f}"
    harm = case.measure_harm(1 - (found.rms / case.rms) ** 2)
    return Finding(
        Cause.MIXED_VIEWS,
        "The photographs show two pictures of different cameras, as a stereo camera stores them: "
        f"the board is {where} in {list_names([case.names[k] for k in views])}, and on the other "
        "side in the others.",
        f"With a camera for each side, {found.rms:.2g} px would be left of {case.describe_rms()}; "
        f"{describe_harm(harm)}.",
        "Cut the photographs apart, and calibrate each side by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def _are_of_two_kinds(case: Case, odd: tuple[int, ...]) -> bool:
    """Return whether the views certainly are of two kinds, other than some views and the rest."""
    return case.split is not None and tuple(np.flatnonzero(case.split.is_odd).tolist()) != odd


def _are_strangers(case: Case, found: Strangers) -> bool:
    """Return whether views do not belong to the others, and are not of a kind with some of them,
    or those that a cause of all makes the model miss most."""
    if _are_of_two_kinds(case, found.views):
        return False
    rest = [k for k in range(len(case.views)) if k not in found.views]
    views, names = [case.views[k] for k in rest], [case.names[k] for k in rest]
    return not _is_cause_of_all(case, prepare_case(found.others, views, names, case.check))


def _leave_out(screening: Screening, case: Case) -> Case:
    """Prepare what is left of a case without the corners that were rejected."""
    used = [k for k, kept in enumerate(screening.kept) if kept.any()]
    kept, names = screening.select_kept(case.views), [case.names[k] for k in used]
    left = prepare_case(screening.calibration, kept, names, case.check)
    return replace(left, numbers=used).follow(case, "with the corners that do not fit")


def _misses_views(case: Case, left: Case) -> bool:
    """Return whether corners do not fit because one cause makes the model miss whole views.

    Such a cause is a lens that another model follows better. Or it explains the residuals of the
    other corners, too: of corners that are misplaced a cause may explain much by chance, but
    without them it explains nothing. Two kinds of views explain most, and nothing is left of them
    where one kind is left out. With a board that was far from its drawing all corners fit once its
    shape is estimated; misplaced ones do not.
    """
    split = case.split
    is_of_two_kinds = split is not None and split.share > MIN_SHARE_OF_KINDS
    if is_of_two_kinds or _is_cause_of_all(case, left):
        return True
    shaped = estimate_board(case)
    return shaped is not None and not has_outlying_corners(shaped, case.views)


def _is_cause_of_all(case: Case, left: Case) -> bool:
    """Return whether what some views or corners miss is due to a cause that all share: a lens that
    another model follows better, or one that the case without them shows, too."""
    if case.rival.share > MIN_SHARE_OF_RIVAL:
        return True
    before, after = (each.explained * each.rms**2 for each in (case, left))
    return after > _MIN_PART_LEFT * before


def _find_open_coefficients(case: Case) -> Finding | None:
    """Find coefficients of the lens that the views leave open; None if there are none.

    Control points of a spline that no corner depends on are none: nothing else depends on them.
    """
    camera = case.calibration.camera
    if isinstance(find_model(camera.model), SplinedStereographic):
        return None
    lost = [u for u in case.calibration.undetermined if u.name in camera.names[4:]]
    if not lost:
        return None
    listed = ", ".join(u.name for u in lost)
    return Finding(
        Cause.UNDETERMINED,
        f"The views leave {listed} of the lens open.",
        "; ".join(f"{u.name}: {u.reason}" for u in lost) + ".",
        f"Hold {listed} at 0, or bring corners closer to the image's edges.",
        case.measure_harm(share=1.0),
        action=Action(ActionKind.HOLD_AT_ZERO, parameters=tuple(u.name for u in lost)),
    )


def _find_lack_of_views(case: Case) -> Finding | None:
    """Find out whether the views are too few, or too much alike; None if they are not."""
    count = len(case.views)
    few = count < MIN_VIEWS_TO_JUDGE
    if not (case.sigma > MAX_USABLE_PX or (few and case.worst > MAX_GOOD_PX)):
        return None
    harm = case.measure_harm(share=1.0)
    if not few and harm <= MAX_USABLE_PX:
        return describe_narrow_views(case.part, harm, case.sigma)
    return Finding(
        Cause.FEW_VIEWS,
        f"{count} views are too few." if few else "The views are too few, or too much alike.",
        f"A pixel is known to {format_two_digits(case.sigma)} px in the median over the image, and "
        f"to {format_two_digits(case.worst)} px where it is known worst.",
        REMEDY_OF_FEW_VIEWS,
        harm,
        action=Action(ActionKind.PHOTOGRAPH_MORE),
    )


def _is_noise_enough(case: Case) -> bool:
    """Return whether the noise alone, without any cause, would leave pixels known too poorly.

    Views that are too much alike magnify the least that their residuals have in common.
    """
    causes = list_tests(*Family)
    shares = [check.share for check in case.report.checks if check.name in causes]
    explained = max(*shares, case.rival.share)
    return float(np.sqrt(1 - explained)) * case.by_noise_alone > _MAX_NOISE_PX

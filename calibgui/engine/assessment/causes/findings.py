"""Findings: what is wrong with a calibration, one cause for one trouble, the most harmful first.

A bent board also looks like a lens that the model does not follow, and a misplaced row of corners
like both. So no test speaks for itself. The causes are asked in an order in which each can be told
without those behind it, and what one explains is taken out before the next is asked:

1. **What is given** (``input_errors.py``): corners of another frame or image size, values that are
   held and wrong, two pictures in one photograph (``side_by_side.py``), corners that are not where
   the others say. The latter are left out, and all that follows is asked of what is left.
2. **Number of views.** Two or three views show nothing but that they are too few, if pixels are
   poorly known or if lens and board would explain the same residuals. Nor do views so much alike
   that the noise alone leaves pixels poorly known. Where corners cover a small part of the image
   and pixels are known well there, this is what is wrong.
3. **Residuals that are not noise** (``cause_choice.py``), which have one cause.
4. **Views** that are too much alike, or that disagree for no cause that is known.

A finding is of use only if the answer depends on it: each has the harm that its cause does to
pixels (``harm.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.assessment.causes.cause_choice import (
    MIN_SHARE_OF_KINDS,
    MIN_VIEWS_TO_JUDGE,
    describe_disagreement,
    explain_most,
    find_largest_share,
    find_split,
    find_systematic_cause,
    list_names,
)
from calibgui.engine.assessment.causes.finding import (
    MIN_HARM_PX,
    REMEDY_OF_FEW_VIEWS,
    Action,
    ActionKind,
    Cause,
    Finding,
    describe_harm,
    describe_narrow_views,
)
from calibgui.engine.assessment.causes.harm import Case, prepare_case
from calibgui.engine.assessment.causes.input_errors import (
    describe_misplaced_corners,
    find_wrong_frame,
    find_wrong_values,
    screen_misplaced_corners,
)
from calibgui.engine.assessment.causes.rival_lens import fit_rival
from calibgui.engine.assessment.causes.side_by_side import TwoPictures, find_two_pictures
from calibgui.engine.assessment.residuals.outliers import Screening, select_corners
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, name_views
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.errors import CalibrationError
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.threads import with_one_blas_thread

_MAX_WORST_PX = 0.5
"""Uncertainty of the worst pixel of the image above which fewer than `MIN_VIEWS_TO_JUDGE` views
are too few, px."""
_MAX_POOR_PX = 1.0
"""Uncertainty of a pixel, median over the image, above which the views are too few, px."""
_MAX_NOISE_PX = 0.5
"""Uncertainty of a pixel by the noise that no cause explains, median over the image, above which
the views are too much alike, px. Of ten bursts it was 0.2 to 1.8, above this in nine; of 60 faults
of boards and shutters (``tests/faults``), in which pixels were known to more than 1 px, below 0.27.
"""
_MAX_NARROW_PART = 1 / 3
"""Share of the image that corners cover, up to which this and not the number of views is what is
wrong, if pixels are known well among them."""
_MIN_DISAGREEMENT = 3.0
"""Ratio of the views' disagreement to what noise explains, from which it is a finding by itself."""
_MAX_REJECTED = 0.4
"""Share of all corners beyond which those that do not fit are missed by the model."""
_MIN_SHARE_OF_ALL, _MIN_SHARE_OF_RIVAL = 1 / 3, 0.1
"""Shares of the squared residuals that one cause explains, and a lens of another kind, from which
corners that do not fit may be missed by the model. Where corners were misplaced (150 faults of
``tests/faults``) such a lens explained at most 4 %."""
_MIN_PART_LEFT, _LOSS_BY_REJECTION = 0.01, 60
"""Part of what a cause explains that it explains without these corners, from which they are: the
larger of the first and (1 - share of the corners that do not fit) to the power of the second, as
few corners carry little of what all views share. Of the causes that explained enough of all in 401
faults (seeds 7000 to 7002 and 8000 to 8019 of ``tests/faults``) it was below 0.001 where corners
were misplaced, and above 0.013 where they were not, but for two kinds of views. Of boards that were
bent as well, by up to 1 mm, with at most 2 % of the corners misplaced, it was below 0.06; where 2 %
did not fit for another cause it was 0.8."""


@with_one_blas_thread
def list_findings(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str] | None = None,
    check: Callable[[], None] = lambda: None,
) -> tuple[Finding, ...]:
    """List what is wrong with a calibration, the most harmful first.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
        check: a function that is called now and then, and raises to abandon the work.
    """
    found = _find(calibration, views, names or name_views(len(views)), check)
    return tuple(sorted(found, key=lambda finding: finding.harm, reverse=True))


def _find(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str],
    check: Callable[[], None],
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
    case = prepare_case(calibration, views, names, check)
    open_coefficients = _find_open_coefficients(case)
    if calibration.cost is not Cost.IMAGE:
        calibration = _minimise_image_cost(calibration, views)
        case = prepare_case(calibration, views, names, check)
    pictures = find_two_pictures(calibration, views)
    if pictures is not None:
        yield _describe_two_pictures(case, pictures)
        return
    screening = screen_misplaced_corners(calibration, views)
    if screening is not None:
        left = _leave_out(screening, views, names, check)
        if not _misses_views(case, screening, left):
            misplaced = describe_misplaced_corners(calibration, screening, views, names)
            if misplaced is not None:
                yield misplaced
            case = left  # large errors of a few corners leave coefficients open, too
            open_coefficients = _find_open_coefficients(case)
    found = few = _find_lack_of_views(case)
    if few is None or not (len(case.views) < MIN_VIEWS_TO_JUDGE or _is_noise_enough(case)):
        found = find_systematic_cause(case) or _find_disagreement(case) or few
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
        return calibrate(views, calibration.camera.size, **recover_image_arguments(calibration))
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
        f"With a camera for each side, {found.rms:.2g} px would be left of {case.rms:.3g} px RMS; "
        f"{describe_harm(harm)}.",
        "Cut the photographs apart, and calibrate each side by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def _leave_out(
    screening: Screening,
    views: Sequence[Observation],
    names: Sequence[str],
    check: Callable[[], None],
) -> Case:
    """Prepare what is left without the corners that were rejected."""
    used = [k for k, kept in enumerate(screening.kept) if kept.any()]
    left = [select_corners(views[k], screening.kept[k]) for k in used]
    case = prepare_case(screening.calibration, left, [names[k] for k in used], check)
    return replace(case, numbers=used)


def _misses_views(case: Case, screening: Screening, left: Case) -> bool:
    """Return whether corners do not fit because one cause makes the model miss whole views.

    Such a cause is a lens that another model follows better. Or it explains much of the residuals
    of all corners, and much of those of the others. Of corners that are misplaced it may explain
    much by chance; but without them it explains nothing. Two kinds of views explain most, and
    nothing is left of them where one kind is left out.
    """
    if fit_rival(case.calibration, case.views).share > _MIN_SHARE_OF_RIVAL:
        return True
    split = find_split(case)
    if split is not None and split.is_certain and split.share > MIN_SHARE_OF_KINDS:
        return True
    share = explain_most(case)
    if share <= _MIN_SHARE_OF_ALL:
        return False
    rejected = float(np.mean(~np.concatenate(screening.kept)))
    part = explain_most(left) * left.rms**2 / (share * case.rms**2)
    least = max(_MIN_PART_LEFT, (1 - rejected) ** _LOSS_BY_REJECTION)
    return rejected > _MAX_REJECTED or part > least


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
    if not (case.sigma > _MAX_POOR_PX or (few and case.worst > _MAX_WORST_PX)):
        return None
    harm = case.measure_harm(share=1.0)
    if not few and case.part < _MAX_NARROW_PART and harm <= _MAX_WORST_PX:
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
    checks = case.report.checks
    smooth = max((check.share for check in checks if check.name == "smooth"), default=0.0)
    rival = fit_rival(case.calibration, case.views).share
    explained = max(smooth, rival, find_largest_share(checks))
    return float(np.sqrt(1 - explained)) * case.by_noise_alone > _MAX_NOISE_PX


def _find_disagreement(case: Case) -> Finding | None:
    """Find views that disagree about the camera for no cause that is known; None if they agree."""
    is_strong = case.calibration.overdispersion >= _MIN_DISAGREEMENT
    is_harmful = case.measure_harm() > MIN_HARM_PX
    return describe_disagreement(case) if is_strong and is_harmful else None

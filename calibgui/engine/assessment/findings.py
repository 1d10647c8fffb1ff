"""Findings: what is wrong with a calibration, one cause for one trouble, the most harmful first.

A bent board also looks like a lens that the model does not follow, and a misplaced row of corners
like both. So no test speaks for itself. The causes are asked in an order in which each can be told
without those behind it, and what one explains is taken out before the next is asked:

1. **What is given** (``input_errors.py``): corners of another frame or image size, values that are
   held and wrong, two pictures in one photograph (``side_by_side.py``), corners that are not where
   the others say. The latter are left out, and all that follows is asked of what is left.
2. **Number of views.** Two or three views show nothing but that they are too few, if pixels are
   poorly known or if lens and board would explain the same residuals. Nor do views so much alike
   that the noise alone leaves pixels poorly known.
3. **Lens or board**, which all views share: the lens if ``calibration/lens_error.py`` says so, or
   whichever explains most of what any cause does (``residual_checks.py``). What a board or a lens
   explains, causes that differ from view to view explain as well, since they have unknowns of
   their own in each view. A free board, which has many unknowns of its own, takes much of what
   a wrong lens or two kinds of views leave: so it is estimated before it is named, and if one of
   these explains much of what is left, that is the cause; the board follows once it is gone. So
   are two kinds that explain more than any board does. Where it is not the board, a lens of another
   kind (``rival_lens.py``) is fitted in any case.
4. **Two kinds of views** (``mixed_views.py``), which have twice the unknowns of one.
5. **Focus, centre, bending, motion**, which differ from view to view; then **blur**, which moves
   nothing.
6. **Views** that are too much alike, or that disagree for no cause that is known.

A finding is of use only if the answer depends on it: each has the harm that its cause does to
pixels (``harm.py``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import BoolArray
from calibgui.engine.assessment.finding import (
    MIN_HARM_PX,
    REMEDY_OF_LENS,
    Action,
    ActionKind,
    Cause,
    Finding,
    describe_harm,
)
from calibgui.engine.assessment.harm import Case, prepare_case
from calibgui.engine.assessment.input_errors import (
    describe_misplaced_corners,
    find_wrong_frame,
    find_wrong_values,
    screen_misplaced_corners,
)
from calibgui.engine.assessment.mixed_views import Split, find_two_kinds
from calibgui.engine.assessment.outliers import Screening, select_corners
from calibgui.engine.assessment.residual_checks import NoiseCheck, check_residuals
from calibgui.engine.assessment.residual_statistics import summarise_residuals
from calibgui.engine.assessment.rival_lens import fit_rival
from calibgui.engine.assessment.side_by_side import TwoPictures, find_two_pictures
from calibgui.engine.assessment.systematic_errors import prepare_fit
from calibgui.engine.boards.shape import BoardShapeModel
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
"""Uncertainty of the worst pixel of the image above which fewer than `_MIN_VIEWS_TO_JUDGE` views
are too few, px."""
_MIN_LENS_PX = 0.1
"""Displacement that a lens model leaves, px rms, from which it is a finding at any rate."""
_MAX_POOR_PX = 1.0
"""Uncertainty of a pixel, median over the image, above which the views are too few, px."""
_MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known."""
_MIN_DISAGREEMENT = 3.0
"""Ratio of the views' disagreement to what noise explains, from which it is a finding by itself."""
_MAX_REJECTED = 0.4
"""Share of all corners beyond which those that do not fit are missed by the model."""
_MIN_SHARE_OF_ALL, _MIN_SHARE_OF_KINDS = 1 / 3, 0.5
"""Shares of the squared residuals that one cause explains, and two kinds of views, from which
corners that do not fit may be missed by the model."""
_MIN_PART_LEFT, _LOSS_BY_REJECTION = 0.01, 60
"""Part of what a cause explains that it explains without these corners, from which they are: the
larger of the first and (1 - share of the corners that do not fit) to the power of the second, as
few corners carry little of what all views share. Of the causes that explained enough of all in 401
faults (seeds 7000 to 7002 and 8000 to 8019 of ``tests/faults``) it was below 0.001 where corners
were misplaced, and above 0.013 where they were not, but for two kinds of views. Of boards that were
bent as well, by up to 1 mm, with at most 2 % of the corners misplaced, it was below 0.06; where 2 %
did not fit for another cause it was 0.8."""
_MIN_SHARE, _MIN_SHARE_SUSPECT = 0.03, 0.01
"""Share of the squared residuals that lens or board explain, from which they are named; and that a
board explains that the calibration suspects by itself (``Calibration.board_shape_error``)."""
_MIN_PART_OF_LENS, _MIN_PART_OF_BOARD, _MIN_PART_OF_BEST = 0.5, 0.7, 0.9
"""Part of what the best cause explains, from which the cause is a lens that
``calibration/lens_error.py`` suspects, a board, and a lens that it does not suspect."""
_MIN_SHARE_OF_RIVAL, _MIN_SHARE_IN_DOUBT = 1 / 3, 0.1
"""Shares of the squared residuals that a lens of another kind explains, from which the lens is the
cause, and from which corners may not fit because of it. Of real photographs that a model followed
one of another kind explained at most a sixth; where corners were misplaced (150 faults of
``tests/faults``), at most 4 %."""
_ADD_VIEWS = (
    "Add views with the board tilted by 20 to 45 degrees in different directions and all over the "
    "image; six good ones are enough."
)
"""The remedy of too few views."""
_MAX_NAMES = 6
"""Number of views that a sentence names."""
_MIN_PART_OF_BOARDS = 0.5
"""Part of what the best shape of a board explains, from which a simpler one is the cause."""
_MIN_PART_OF_BOARDS_HARM = 0.1
"""Part of the harm that the board does, from which a cause that is left beside a board of any shape
is named instead: a lens model that is off by some hundredths of a pixel is not what to mend where a
bowed board moves pixels by several. It was 0.01 in rendered photographs of such boards, and 1 where
a lens model did not follow the lens (``tests/faults``)."""
_MAX_RMS_IF_TURNED = 1.2
"""RMS residual with the odd views turned by 180 degrees, over what a camera of their own would
leave to the first order, up to which they were upside down: with no unknowns more."""
_CHECKS_OF_BOARD = ("squares", "bow", "board")
"""Tests of a board that is the same in all views."""
_CHECKS_OF_VIEWS = {
    "focus": (0.05, 0.7),
    "centre": (0.05, 0.9),
    "bending": (0.05, 0.7),
    "rows": (0.05, 0.9),
    "lines": (0.3, 1.0),
}
"""Tests of causes that each view has of its own, with the least share of the squared residuals and
the least part of what the best of them explains: the more unknowns a cause has, the more it follows
any other."""
_MIN_PART_OF_SMOOTH = 0.8
"""Part of what any smooth displacement of each view's own explains, from which a cause is singled
out. Of 70 faults that were (seeds 7000 to 7007 and 9000 to 9013 of ``tests/faults``) it was 0.82 at
least; of paper that curls anew in each view, of which no test is, 0.7 at most."""
_MIN_SHARE_OF_SMOOTH = 1 / 3
"""Share of the squared residuals that smooth displacements explain, from which they are told of
where no cause is singled out. Where views were blurred it was at most 0.08, and 0.12 of real
photographs whose lines do not start evenly."""
_CAUSES_OF_CHECKS = {
    **dict.fromkeys(_CHECKS_OF_BOARD, Cause.BOARD_SHAPE),
    "lens": Cause.LENS,
    "focus": Cause.FOCUS,
    "centre": Cause.MOVING_CENTRE,
    "bending": Cause.BENDING_BOARD,
    "rows": Cause.ROLLING_SHUTTER,
    "lines": Cause.LINE_JITTER,
    "smooth": Cause.DISAGREEMENT,
    "views": Cause.BLUR,
}
"""Causes by the names of the tests of ``residual_checks.py``."""
_MESSAGES = {
    Cause.BOARD_SHAPE: "The board is not as it was drawn.",
    Cause.FOCUS: "The focal length differs between the views.",
    Cause.MOVING_CENTRE: "The principal point differs between the views, as if the images were "
    "stabilised or cropped.",
    Cause.BENDING_BOARD: "The board bends from view to view.",
    Cause.ROLLING_SHUTTER: "Camera or board moved while the image's rows were read, or the "
    "images were warped.",
    Cause.LINE_JITTER: "The image's rows are shifted sideways against each other.",
    Cause.DISAGREEMENT: "Each view is distorted in its own way, and no single cause explains it.",
    Cause.BLUR: "Some views show the corners less well than the others.",
}
"""Sentences that say what is wrong."""
_ACTIONS = {
    Cause.BOARD_SHAPE: ActionKind.ESTIMATE_BOARD_SHAPE,
    Cause.BLUR: ActionKind.WEIGH_VIEWS,
}
"""Actions that need no other photographs, by their causes."""


@with_one_blas_thread
def list_findings(
    calibration: Calibration, views: Sequence[Observation], names: Sequence[str] | None = None
) -> tuple[Finding, ...]:
    """List what is wrong with a calibration, the most harmful first.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
    """
    found = _find(calibration, views, names or name_views(len(views)))
    return tuple(sorted(found, key=lambda finding: finding.harm, reverse=True))


def _find(
    calibration: Calibration, views: Sequence[Observation], names: Sequence[str]
) -> Iterator[Finding]:
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
    case = prepare_case(calibration, views, names)
    open_coefficients = _find_open_coefficients(case)
    if calibration.cost is not Cost.IMAGE:
        calibration = _minimise_image_cost(calibration, views)
        case = prepare_case(calibration, views, names)
    pictures = find_two_pictures(calibration, views)
    if pictures is not None:
        yield _describe_two_pictures(case, pictures)
        return
    screening = screen_misplaced_corners(calibration, views)
    if screening is not None:
        left = _leave_out(screening, views, names)
        if not _misses_views(case, screening, left):
            misplaced = describe_misplaced_corners(calibration, screening, views, names)
            if misplaced is not None:
                yield misplaced
            case = left  # large errors of a few corners leave coefficients open, too
            open_coefficients = _find_open_coefficients(case)
    found = few = _find_lack_of_views(case)
    if few is None or not (len(case.views) < _MIN_VIEWS_TO_JUDGE or _is_noise_enough(case)):
        found = _find_systematic_cause(case) or _find_disagreement(case) or few
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
        f"the board is {where} in {_list_names([case.names[k] for k in views])}, and on the other "
        "side in the others.",
        f"With a camera for each side, {found.rms:.2g} px would be left of {case.rms:.3g} px RMS; "
        f"{describe_harm(harm)}.",
        "Cut the photographs apart, and calibrate each side by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def _leave_out(screening: Screening, views: Sequence[Observation], names: Sequence[str]) -> Case:
    """Prepare what is left without the corners that were rejected."""
    used = [k for k, kept in enumerate(screening.kept) if kept.any()]
    left = [select_corners(views[k], screening.kept[k]) for k in used]
    case = prepare_case(screening.calibration, left, [names[k] for k in used])
    return case._replace(numbers=used)


def _misses_views(case: Case, screening: Screening, left: Case) -> bool:
    """Return whether corners do not fit because one cause makes the model miss whole views.

    Such a cause is a lens that another model follows better. Or it explains much of the residuals
    of all corners, and much of those of the others. Of corners that are misplaced it may explain
    much by chance; but without them it explains nothing. Two kinds of views explain most, and
    nothing is left of them where one kind is left out.
    """
    if fit_rival(case.calibration, case.views).share > _MIN_SHARE_IN_DOUBT:
        return True
    split = _find_split(case)
    if split is not None and split.is_certain and split.share > _MIN_SHARE_OF_KINDS:
        return True
    share = _explain_most(case)
    if share <= _MIN_SHARE_OF_ALL:
        return False
    rejected = float(np.mean(~np.concatenate(screening.kept)))
    part = _explain_most(left) * left.rms**2 / (share * case.rms**2)
    least = max(_MIN_PART_LEFT, (1 - rejected) ** _LOSS_BY_REJECTION)
    return rejected > _MAX_REJECTED or part > least


def _find_split(case: Case) -> Split | None:
    """Find out whether the views may be of two kinds; None if not, or if they are too few."""
    if len(case.views) < _MIN_VIEWS_TO_JUDGE:
        return None
    return find_two_kinds(prepare_fit(case.calibration, case.views))


def _explain_most(case: Case) -> float:
    """Return the share of the squared residuals that the best cause explains."""
    report = check_residuals(case.calibration, case.views, case.names)
    return _find_largest_share(report.checks)


def _find_systematic_cause(case: Case) -> Finding | None:
    """Find the one cause of residuals that are not noise; None if none matters."""
    report = check_residuals(case.calibration, case.views, case.names)
    failed = {check.name: check for check in report.checks if not check.passed}
    if report.are_lens_and_board_alike and len(case.views) < _MIN_VIEWS_TO_JUDGE:
        return _describe_lens_or_board(case, failed)
    check = _choose_shared_cause(case.calibration, failed)
    if check is not None:
        found = _describe_check(case, check)
        beside = _find_cause_beside_board(case, failed) if check.name in _CHECKS_OF_BOARD else None
        is_less = found and beside and beside.harm < _MIN_PART_OF_BOARDS_HARM * found.harm
        return found if beside is None or is_less else beside
    explained = _find_largest_share(report.checks)
    lens = _find_wrong_lens(case, explained)
    if lens is not None:
        return lens
    if case.measure_harm(explained) < MIN_HARM_PX:
        return _find_blur(case, failed)
    split = _find_split(case)
    if split is not None and split.is_certain:
        return _describe_two_kinds(case, split)
    check = _choose_cause_of_views(failed)
    if check is not None:
        return _describe_check(case, check)
    disagreement = None if split is None else _describe_disagreement(case, split)
    return _find_blur(case, failed) or disagreement


def _describe_lens_or_board(case: Case, failed: Mapping[str, NoiseCheck]) -> Finding | None:
    """Describe residuals that lens and board explain alike, of views too few to tell which it is;
    None if they do no harm."""
    lens = failed["lens"].share
    board = _find_largest_share(failed[name] for name in _CHECKS_OF_BOARD if name in failed)
    harm = case.measure_harm(max(lens, board))
    if harm < MIN_HARM_PX:
        return None
    return Finding(
        Cause.FEW_VIEWS,
        f"{len(case.views)} views are too few to tell whether the lens model does not follow the "
        "lens or the board is not as it was drawn.",
        f"A lens explains {100 * lens:.0f} %, a board {100 * board:.0f} % of the squared residuals "
        f"of {case.rms:.3g} px RMS, and neither anything beyond the other; {describe_harm(harm)}.",
        _ADD_VIEWS,
        harm,
        action=Action(ActionKind.PHOTOGRAPH_MORE),
    )


def _find_cause_beside_board(case: Case, failed: Mapping[str, NoiseCheck]) -> Finding | None:
    """Find a wrong lens, or two kinds of views, that a board of any shape leaves; None if neither.

    What they explain is measured with the board's shape estimated, unless two kinds of views
    explain more than a board of any shape, which has many more unknowns: of 60 boards that were
    bent or badly printed (``tests/faults``) none made two kinds certain.
    """
    split = _find_split(case)
    if split is not None and split.is_certain:
        board = _find_largest_share(failed[name] for name in _CHECKS_OF_BOARD if name in failed)
        if split.share > board:
            return _describe_two_kinds(case, split)
    settings = recover_image_arguments(case.calibration) | {"board_shape": BoardShapeModel.FREE}
    try:
        free = calibrate(case.views, case.calibration.camera.size, **settings)
    except CalibrationError:
        return None
    beside = prepare_case(free, case.views, case.names)._replace(numbers=case.numbers)
    found = _find_wrong_lens(beside, explained=1.0)
    if found is None:
        split = _find_split(beside)
        if split is None or not split.is_certain or split.share < _MIN_SHARE_OF_KINDS:
            return None
        found = _describe_two_kinds(beside, split)
    told = "These figures are of a fit that estimates the board's shape as well."
    return replace(found, evidence=f"{found.evidence} {told}")


def _find_wrong_lens(case: Case, explained: float) -> Finding | None:
    """Find a lens that a model of another kind follows better; None if it does not.

    It does so by far, or by more than the share `explained` by causes with more unknowns.
    """
    share, displacement = fit_rival(case.calibration, case.views)
    least = max(_MIN_SHARE, min(_MIN_SHARE_OF_RIVAL, explained))
    if share < least or displacement < MIN_HARM_PX:
        return None
    return _describe_lens(case, float(np.sqrt(share)) * case.rms, case.measure_harm(share))


def _find_blur(case: Case, failed: dict[str, NoiseCheck]) -> Finding | None:
    """Find views whose corners scatter more than the others'; None if that does no harm."""
    check = failed.get("views")
    return None if check is None else _describe_check(case, check)


def _choose_shared_cause(
    calibration: Calibration, failed: dict[str, NoiseCheck]
) -> NoiseCheck | None:
    """Choose between board and lens, if either is the cause; None if not."""
    best = _find_largest_share(failed.values())
    lens = failed.get("lens")
    if lens is not None and lens.share >= best * (
        _MIN_PART_OF_LENS if calibration.lens_error > _MIN_LENS_PX else _MIN_PART_OF_BEST
    ):
        return lens if lens.share >= _MIN_SHARE else None
    board = [failed[name] for name in _CHECKS_OF_BOARD if name in failed]
    explained = _find_largest_share(board)
    is_suspect = calibration.board_shape_error > 0
    enough = _MIN_SHARE_SUSPECT if is_suspect else _MIN_SHARE
    if board and explained >= max(enough, _MIN_PART_OF_BOARD * best):
        return next(c for c in board if c.share >= _MIN_PART_OF_BOARDS * explained)
    return None


def _find_largest_share(checks: Iterable[NoiseCheck]) -> float:
    """Return the largest share of the squared residuals that any cause explains, but for noise."""
    causes = (*_CHECKS_OF_BOARD, "lens", *_CHECKS_OF_VIEWS)
    return max((check.share for check in checks if check.name in causes), default=0.0)


def _choose_cause_of_views(failed: dict[str, NoiseCheck]) -> NoiseCheck | None:
    """Choose the cause among those that differ from view to view; None if it is none of them.

    Where none is singled out and much is smooth, that is what there is to be told of.
    """
    best = _find_largest_share(failed[name] for name in _CHECKS_OF_VIEWS if name in failed)
    smooth = failed.get("smooth")
    explained = 0.0 if smooth is None else smooth.share
    for name, (least, part) in _CHECKS_OF_VIEWS.items():
        check = failed.get(name)
        enough = max(least, part * best, _MIN_PART_OF_SMOOTH * explained)
        if check is not None and check.share >= enough:
            return check
    return smooth if explained >= _MIN_SHARE_OF_SMOOTH else None


def _describe_two_kinds(case: Case, split: Split) -> Finding:
    odd = np.flatnonzero(split.is_odd).tolist()
    views = tuple(case.numbers[k] for k in odd)
    left = case.rms * float(np.sqrt(1 - split.share))
    harm = case.measure_harm(split.share)
    listed = _list_names([case.names[k] for k in odd])
    turned = _measure_rms_if_turned(case, split.is_odd)
    if turned < _MAX_RMS_IF_TURNED * left:
        return Finding(
            Cause.MIXED_VIEWS,
            f"{listed} {'stand' if len(odd) > 1 else 'stands'} upside down against the others, "
            "stored by a program that turned what the camera wrote.",
            f"Turned by 180 degrees they leave {turned:.2g} px of {case.rms:.2g} px RMS; "
            f"{describe_harm(harm)}.",
            "Turn them by 180 degrees, or take the files as the camera wrote them.",
            harm,
            views,
            Action(ActionKind.LEAVE_OUT_VIEWS, views),
        )
    return Finding(
        Cause.MIXED_VIEWS,
        f"The photographs are of two kinds: {listed} "
        f"{'disagree' if len(odd) > 1 else 'disagrees'} with the others about the {split.what}.",
        f"If each kind had its own, {left:.2g} px would be left of {case.rms:.2g} px RMS; "
        f"{describe_harm(harm)}.",
        "Look for another camera, zoom, focus or board in these photographs, and calibrate each "
        "kind by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def _measure_rms_if_turned(case: Case, is_turned: BoolArray) -> float:
    """Measure the RMS residual if some views (K,) are turned by 180 degrees, px; infinite if that
    is no calibration."""
    last = np.array(case.calibration.camera.size) - 1
    views = [
        Observation(last - view[0], *view[1:]) if turned else view
        for view, turned in zip(case.views, is_turned, strict=True)
    ]
    settings = recover_image_arguments(case.calibration)
    try:
        turned = calibrate(views, case.calibration.camera.size, **settings)
    except CalibrationError:
        return np.inf
    return summarise_residuals(turned.residuals).rms


def _list_names(names: Sequence[str]) -> str:
    """List the first of many names."""
    more = len(names) - _MAX_NAMES
    return ", ".join(names) if more <= 0 else f"{', '.join(names[:_MAX_NAMES])} and {more} more"


def _describe_lens(case: Case, error: float, harm: float) -> Finding:
    return Finding(
        Cause.LENS,
        f"The lens model {case.calibration.camera.model} does not follow this lens.",
        f"Of {case.rms:.3g} px RMS it leaves {error:.2g} px that all views share and the board "
        "does not explain.",
        REMEDY_OF_LENS,
        max(error, harm),
        action=Action(ActionKind.CHOOSE_LENS_MODEL),
    )


def _describe_check(case: Case, check: NoiseCheck) -> Finding | None:
    """Describe the cause that a test of the residuals points to; None if it does no harm."""
    cause, harm = _CAUSES_OF_CHECKS[check.name], case.measure_harm(check.share)
    if cause is Cause.BLUR:
        harm = case.measure_noise(check.share)
    if cause is Cause.LENS:
        error = case.calibration.lens_error or float(np.sqrt(check.share)) * case.rms
        is_harmful = error > _MIN_LENS_PX or harm > MIN_HARM_PX
        return _describe_lens(case, error, harm) if is_harmful else None
    if harm < MIN_HARM_PX:
        return None
    share = 100 * check.share
    subject = "It explains"
    if cause is Cause.DISAGREEMENT:
        subject = "Smooth displacements, others in each view, explain"
    evidence = f"{subject} {share:.0f} % of the squared residuals of {case.rms:.3g} px RMS"
    if cause is Cause.BOARD_SHAPE and case.calibration.board_shape_error > 0:
        evidence += f"; corners of the board are off by {case.calibration.board_shape_error:.2g} mm"
    if cause is Cause.BLUR:
        evidence = f"Their corners scatter unequally: {check.finding}"
    remedy = check.advice.partition(": ")[2]
    return Finding(
        cause,
        _MESSAGES[cause],
        f"{evidence}; {describe_harm(harm)}.",
        remedy[:1].upper() + remedy[1:],
        harm,
        action=Action(_ACTIONS.get(cause, ActionKind.PHOTOGRAPH_MORE)),
    )


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
    few = count < _MIN_VIEWS_TO_JUDGE
    if not (case.sigma > _MAX_POOR_PX or (few and case.worst > _MAX_WORST_PX)):
        return None
    return Finding(
        Cause.FEW_VIEWS,
        f"{count} views are too few." if few else "The views are too few, or too much alike.",
        f"A pixel is known to {format_two_digits(case.sigma)} px in the median over the image, and "
        f"to {format_two_digits(case.worst)} px where it is known worst.",
        _ADD_VIEWS,
        case.measure_harm(share=1.0),
        action=Action(ActionKind.PHOTOGRAPH_MORE),
    )


def _is_noise_enough(case: Case) -> bool:
    """Return whether pixels where there are corners would be known too poorly without any cause.

    Views that are too much alike magnify the least that their residuals have in common.
    """
    checks = check_residuals(case.calibration, case.views, case.names).checks
    smooth = max((check.share for check in checks if check.name == "smooth"), default=0.0)
    explained = max(smooth, _find_largest_share(checks))
    return case.measure_noise(1 - explained) > _MAX_POOR_PX


def _find_disagreement(case: Case) -> Finding | None:
    """Find views that disagree about the camera for no cause that is known; None if they agree."""
    is_strong = case.calibration.overdispersion >= _MIN_DISAGREEMENT
    is_harmful = case.measure_harm() > MIN_HARM_PX
    return _describe_disagreement(case) if is_strong and is_harmful else None


def _describe_disagreement(case: Case, split: Split | None = None) -> Finding:
    """Describe views that disagree for no known cause, and may be of two kinds by a `split`."""
    rms = [view.rms for view in case.calibration.residuals]
    worst = case.numbers[int(np.argmax(rms))]
    harm = case.measure_harm()
    much = (
        f"They do so {case.calibration.overdispersion:.1f} times as much as the noise of their "
        "corners explains"
    )
    if split is not None:
        left = case.rms * float(np.sqrt(1 - split.share))
        much = (
            f"If they were of two kinds, {left:.2g} px would be left of {case.rms:.2g} px RMS, but "
            "which is of which kind is not certain"
        )
    return Finding(
        Cause.DISAGREEMENT,
        "The views disagree about the camera, and no single cause explains it.",
        f"{much}; {describe_harm(harm)}.",
        "Look for photographs of another camera, zoom or board among them, and calibrate each kind "
        "by itself.",
        harm,
        action=Action(ActionKind.LOOK_AT_VIEW, (worst,)),
    )

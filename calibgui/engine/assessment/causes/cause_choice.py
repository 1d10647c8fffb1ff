"""The one cause of residuals that are not noise, chosen among all that may explain them.

Most causes look like others to some degree, and the more unknowns a cause has, the more it follows
any other. So all are compared by Akaike's criterion (``cause_fits.py``), which tells what is most
probable and weighs the unknowns. Beside it they are asked in an order in which each can be told
without those behind it:

1. **Lens or board**, which all views share: the board if it is most probable; the lens if
   ``calibration/lens_error.py`` says so, or whichever explains most of what any cause does
   (``residual_checks.py``). What a board or a lens explains, causes that differ from view to view
   explain as well, since they have unknowns of their own in each view. A free board, which has many
   unknowns of its own, takes much of what a wrong lens or two kinds of views leave: so it is
   estimated before it is named, and if one of these explains much of what is left, that is the
   cause; the board follows once it is gone. So are two kinds that explain more than any board does.
   Where it is not the board, a lens of another kind (``rival_lens.py``) is fitted in any case. A
   shear of all images (``sheared_images.py``) is asked for where either would be named, and a roll
   (``rolled_images.py``) where the lens would, a motion, no cause or nothing.
2. **Two kinds of views** (``mixed_views.py``), which have twice the unknowns of one.
3. **Focus, centre, bending, motion**, which differ from view to view: that which is most probable
   by far, or else shifts from row to row; then **blur**, which moves nothing. A scale of the images
   (``scaled_images.py``) is the cause where it explains more than any of these.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.assessment.causes.finding import (
    MIN_HARM_PX,
    REMEDY_OF_FEW_VIEWS,
    REMEDY_OF_LENS,
    Action,
    ActionKind,
    Cause,
    Finding,
    describe_harm,
)
from calibgui.engine.assessment.causes.harm import Case, prepare_case
from calibgui.engine.assessment.causes.mixed_views import DISTORTION, Split, find_two_kinds
from calibgui.engine.assessment.causes.rival_lens import fit_rival
from calibgui.engine.assessment.causes.rolled_images import find_roll
from calibgui.engine.assessment.causes.scaled_images import find_scaling
from calibgui.engine.assessment.causes.sheared_images import find_shear
from calibgui.engine.assessment.causes.turned_views import find_turn
from calibgui.engine.assessment.residuals.cause_fits import MIN_LEAD
from calibgui.engine.assessment.residuals.residual_checks import NoiseCheck
from calibgui.engine.assessment.residuals.systematic_errors import prepare_fit
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_MIN_LENS_PX = 0.1
"""Displacement that a lens model leaves, px rms, from which it is a finding at any rate."""
MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known."""
_MIN_SHARE, _MIN_SHARE_SUSPECT = 0.03, 0.01
"""Share of the squared residuals that lens or board explain, from which they are named; and that a
board explains that the calibration suspects by itself (``Calibration.board_shape_error``)."""
_MIN_PART_OF_LENS, _MIN_PART_OF_BOARD, _MIN_PART_OF_BEST = 0.5, 0.7, 0.9
"""Part of what the best cause explains, from which the cause is a lens that
``calibration/lens_error.py`` suspects, a board, and a lens that it does not suspect."""
_MIN_SHARE_OF_RIVAL = 1 / 3
"""Share of the squared residuals that a lens of another kind explains, from which the lens is the
cause. Of real photographs that a model followed one of another kind explained at most a sixth."""
MIN_SHARE_OF_KINDS = 0.5
"""Share of the squared residuals that two kinds of views explain, from which corners that do not
fit may be missed by the model, and from which they are named beside a board of any shape."""
_MAX_NAMES = 6
"""Number of views that a sentence names."""
_MIN_PART_OF_BOARDS = 0.5
"""Part of what the best shape of a board explains, from which a simpler one is the cause."""
_MIN_PART_OF_BOARDS_HARM = 0.1
"""Part of the harm that the board does, from which a cause that is left beside a board of any shape
is named instead: a lens model that is off by some hundredths of a pixel is not what to mend where a
bowed board moves pixels by several. It was 0.01 in rendered photographs of such boards, and 1 where
a lens model did not follow the lens (``tests/faults``)."""
_SOUGHT = {
    DISTORTION: "photographs that the camera or a program has corrected, or another lens, among "
    "these"
}
_SOUGHT_AT_LARGE = "another camera, zoom, focus or board in these photographs"
"""The things to look for where views are of two kinds, by the name of their difference."""
_CHECKS_OF_BOARD = ("squares", "bow", "board")
"""Tests of a board that is the same in all views."""
_CHECKS_OF_VIEWS = ("focus", "centre", "bending", "rows")
"""Tests of causes with few unknowns of each view's own."""
_MIN_SHARE_OF_VIEWS, _MIN_SHARE_OF_LINES = 0.05, 0.3
"""Shares of the squared residuals that they explain, and shifts from row to row, from which one is
named."""
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
_CAUSES_BESIDE_ROLL = (Cause.LENS, Cause.ROLLING_SHUTTER, Cause.DISAGREEMENT, Cause.BLUR)
"""Causes that a roll of all images is mistaken for, or beside which it may be more harmful."""
_CAUSES_OF_VIEWS = (
    Cause.FOCUS,
    Cause.MOVING_CENTRE,
    Cause.BENDING_BOARD,
    Cause.ROLLING_SHUTTER,
    Cause.LINE_JITTER,
    Cause.DISAGREEMENT,
    Cause.BLUR,
)
"""Causes of each view's own, beside which a scale of the images may explain more."""
_MESSAGES = {
    Cause.BOARD_SHAPE: "The board is not as it was drawn.",
    Cause.FOCUS: "The focal length differs between the views.",
    Cause.MOVING_CENTRE: "The principal point differs between the views, as if the images were "
    "stabilised or cropped.",
    Cause.BENDING_BOARD: "The board bends from view to view, or lies under glass or plastic.",
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


def find_split(case: Case) -> Split | None:
    """Find out whether the views may be of two kinds; None if not, or if they are too few."""
    if len(case.views) < MIN_VIEWS_TO_JUDGE:
        return None
    case.check()
    return find_two_kinds(prepare_fit(case.calibration, case.views))


def explain_most(case: Case) -> float:
    """Return the share of the squared residuals that the best cause explains."""
    return find_largest_share(case.report.checks)


def find_systematic_cause(case: Case) -> Finding | None:
    """Find the one cause of residuals that are not noise; None if none matters."""
    found = _find_cause(case)
    if found is not None and found.cause in (Cause.LENS, Cause.BOARD_SHAPE):
        names = ("lens",) if found.cause is Cause.LENS else _CHECKS_OF_BOARD
        explained = find_largest_share(check for check in case.report.checks if check.name in names)
        explained = explained or _MIN_SHARE_OF_RIVAL
        found = find_shear(case, explained) or found
    if found is None or found.cause in _CAUSES_BESIDE_ROLL:
        is_lens = found is not None and found.cause is Cause.LENS
        found = find_roll(case, found, explained if is_lens else 0.0) or found
    if found is None or found.cause in _CAUSES_OF_VIEWS:
        explained = 0.0 if found is None else find_largest_share(case.report.checks)
        return find_scaling(case, explained) or found
    return found


def _find_cause(case: Case) -> Finding | None:
    report = case.report
    failed = {check.name: check for check in report.checks if not check.passed}
    if report.are_lens_and_board_alike and len(case.views) < MIN_VIEWS_TO_JUDGE:
        return _describe_lens_or_board(case, failed)
    check = _choose_shared_cause(case.calibration, report.checks)
    if check is not None:
        found = _describe_check(case, check)
        beside = _find_cause_beside_board(case, failed) if check.name in _CHECKS_OF_BOARD else None
        is_less = found and beside and beside.harm < _MIN_PART_OF_BOARDS_HARM * found.harm
        return found if beside is None or is_less else beside
    explained = find_largest_share(report.checks)
    lens = _find_wrong_lens(case, explained)
    if lens is not None:
        return lens
    if case.measure_harm(explained) < MIN_HARM_PX:
        return _find_blur(case, failed)
    split = find_split(case)
    if split is not None and split.is_certain:
        return _describe_two_kinds(case, split)
    check = _choose_cause_of_views(report.checks)
    if check is not None:
        return _describe_check(case, check)
    disagreement = None if split is None else describe_disagreement(case, split)
    return _find_blur(case, failed) or disagreement


def _describe_lens_or_board(case: Case, failed: Mapping[str, NoiseCheck]) -> Finding | None:
    """Describe residuals that lens and board explain alike, of views too few to tell which it is;
    None if they do no harm."""
    lens = failed["lens"].share
    board = find_largest_share(failed[name] for name in _CHECKS_OF_BOARD if name in failed)
    harm = case.measure_harm(max(lens, board))
    if harm < MIN_HARM_PX:
        return None
    return Finding(
        Cause.FEW_VIEWS,
        f"{len(case.views)} views are too few to tell whether the lens model does not follow the "
        "lens or the board is not as it was drawn.",
        f"A lens explains {100 * lens:.0f} %, a board {100 * board:.0f} % of the squared residuals "
        f"of {case.rms:.3g} px RMS, and neither anything beyond the other; {describe_harm(harm)}.",
        REMEDY_OF_FEW_VIEWS,
        harm,
        action=Action(ActionKind.PHOTOGRAPH_MORE),
    )


def _find_cause_beside_board(case: Case, failed: Mapping[str, NoiseCheck]) -> Finding | None:
    """Find a wrong lens, or two kinds of views, that a board of any shape leaves; None if neither.

    What they explain is measured with the board's shape estimated, unless two kinds of views
    explain more than a board of any shape, which has many more unknowns: of 60 boards that were
    bent or badly printed (``tests/faults``) none made two kinds certain.
    """
    split = find_split(case)
    if split is not None and split.is_certain:
        board = find_largest_share(failed[name] for name in _CHECKS_OF_BOARD if name in failed)
        if split.share > board:
            return _describe_two_kinds(case, split)
    settings = recover_image_arguments(case.calibration) | {"board_shape": BoardShapeModel.FREE}
    try:
        free = calibrate(case.views, case.calibration.camera.size, **settings)
    except CalibrationError:
        return None
    beside = prepare_case(free, case.views, case.names, case.check)
    beside = replace(beside, numbers=case.numbers)
    found = _find_wrong_lens(beside, explained=1.0)
    if found is None:
        split = find_split(beside)
        if split is None or not split.is_certain or split.share < MIN_SHARE_OF_KINDS:
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
    calibration: Calibration, checks: Sequence[NoiseCheck]
) -> NoiseCheck | None:
    """Choose between board and lens, if either is the cause; None if not."""
    failed = {check.name: check for check in checks if not check.passed}
    best = find_largest_share(checks)
    board = [failed[name] for name in _CHECKS_OF_BOARD if name in failed]
    is_board = _order_by_probability(checks)[0] in board
    lens = failed.get("lens")
    enough = _MIN_PART_OF_LENS if calibration.lens_error > _MIN_LENS_PX else _MIN_PART_OF_BEST
    if lens is not None and not is_board and lens.share >= enough * best:
        return lens if lens.share >= _MIN_SHARE else None
    explained = find_largest_share(board)
    least = _MIN_SHARE_SUSPECT if calibration.board_shape_error > 0 else _MIN_SHARE
    if explained >= least and (is_board or explained >= _MIN_PART_OF_BOARD * best):
        return next(c for c in board if c.share >= _MIN_PART_OF_BOARDS * explained)
    return None


def find_largest_share(checks: Iterable[NoiseCheck]) -> float:
    """Return the largest share of the squared residuals that any cause explains, but for noise."""
    causes = (*_CHECKS_OF_BOARD, "lens", *_CHECKS_OF_VIEWS, "lines")
    return max((check.share for check in checks if check.name in causes), default=0.0)


def _choose_cause_of_views(checks: Sequence[NoiseCheck]) -> NoiseCheck | None:
    """Choose the cause among those that differ from view to view; None if it is none of them.

    It is the most probable of all causes, by far. Where it is another, and much is smooth or along
    the rows, that is what there is to be told of.
    """
    first, second = _order_by_probability(checks)[:2]
    is_singled_out = second.criterion - first.criterion >= MIN_LEAD
    if first.name in _CHECKS_OF_VIEWS and first.share >= _MIN_SHARE_OF_VIEWS and is_singled_out:
        return first
    smooth, lines = (next(c for c in checks if c.name == name) for name in ("smooth", "lines"))
    if lines.share >= max(_MIN_SHARE_OF_LINES, smooth.share):
        return lines
    return smooth if smooth.share >= _MIN_SHARE_OF_SMOOTH else None


def _order_by_probability(checks: Iterable[NoiseCheck]) -> list[NoiseCheck]:
    """Order causes with few unknowns and with many, the most probable first.

    Shifts from row to row are none of them: they count as errors that are not independent.
    """
    return sorted((c for c in checks if c.name != "lines"), key=lambda check: check.criterion)


def _describe_two_kinds(case: Case, split: Split) -> Finding:
    """Describe views of two kinds; one kind may be stored upside down or mirrored."""
    odd = np.flatnonzero(split.is_odd).tolist()
    views = tuple(case.numbers[k] for k in odd)
    left = case.rms * float(np.sqrt(1 - split.share))
    harm = case.measure_harm(split.share)
    listed = list_names([case.names[k] for k in odd])
    turn = find_turn(case, split.is_odd, left)
    if turn is not None:
        return Finding(
            Cause.MIXED_VIEWS,
            f"{listed} {'are' if len(odd) > 1 else 'is'} {turn.how} against the others, stored by "
            "a program that turned what the camera wrote.",
            f"Turned back they leave {turn.rms:.2g} px of {case.rms:.2g} px RMS; "
            f"{describe_harm(harm)}.",
            f"{turn.remedy}, or take the files as the camera wrote them. If they are of another "
            "camera, calibrate it by itself.",
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
        f"Look for {_SOUGHT.get(split.what, _SOUGHT_AT_LARGE)}, and calibrate each kind by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def list_names(names: Sequence[str]) -> str:
    """List the first of many names."""
    more = len(names) - _MAX_NAMES
    return ", ".join(names) if more <= 0 else f"{', '.join(names[:_MAX_NAMES])} and {more} more"


def _describe_lens(case: Case, error: float, harm: float) -> Finding:
    """Describe a lens model that leaves `error` px of all views; `harm` is in px, too.

    A board's shape that was estimated takes a part of `error` up, which may exceed the RMS then.
    """
    calibration = case.calibration
    cause = f"{error:.2g} px that all views share and the board does not explain"
    evidence = f"Of {case.rms:.3g} px RMS it leaves {cause}."
    if calibration.lens_error > 0 and calibration.board_shape is not None:
        evidence = (
            f"With the board as drawn, it leaves {cause}; with the board's estimated shape, which "
            f"stands in for the lens, {case.rms:.3g} px RMS are left in all."
        )
    lens = find_model(calibration.camera.model).short_title
    return Finding(
        Cause.LENS,
        f"The lens model {lens} does not follow this lens.",
        evidence,
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


def describe_disagreement(case: Case, split: Split | None = None) -> Finding:
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

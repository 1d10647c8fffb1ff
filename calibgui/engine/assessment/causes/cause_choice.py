"""The one cause of residuals that are not noise, chosen among all that may explain them.

Most causes look like others to some degree, and the more unknowns a cause has, the more it follows
any other. So all are compared by Akaike's criterion (``cause_fits.py``), which tells what is most
probable and weighs the unknowns. Beside it they are asked in an order in which each can be told
without those behind it:

1. **Lens or board**, which all views share: the board if it is most probable, or whichever explains
   most of what any cause does (``residual_checks.py``). What a board or a lens explains, causes
   that differ from view to view explain as well, since they have unknowns of their own in each
   view. A free board, which has many unknowns of its own, takes much of what a wrong lens or two
   kinds of views leave: so it is estimated before it is named, and if one of these explains much of
   what is left, that is the cause; the board follows once it is gone. So are two kinds that explain
   more than any board does. Where it is not the board, a lens of another kind (``rival_lens.py``)
   is fitted in any case. A shear of all images (``sheared_images.py``) is asked for where either
   would be named, and a roll (``rolled_images.py``) where the lens would, a motion, no cause or
   nothing.
2. **Two kinds of views** (``mixed_views.py``), which have twice the unknowns of one.
3. **Focus, centre, bending, motion**, which differ from view to view: that which is most probable,
   or else shifts from row to row; then **blur**, which moves nothing. A scale of the images
   (``scaled_images.py``) is the cause where it explains more than any of these.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.causes.case import Case, prepare_case
from calibgui.engine.assessment.causes.input_errors import measure_displacement
from calibgui.engine.assessment.causes.mixed_views import DISTORTION, Split
from calibgui.engine.assessment.causes.odd_views import Strangers, Turned, find_turn
from calibgui.engine.assessment.causes.rolled_images import find_roll
from calibgui.engine.assessment.causes.scaled_images import find_scaling
from calibgui.engine.assessment.causes.sheared_images import find_shear
from calibgui.engine.assessment.finding import (
    MAX_LISTED,
    MIN_HARM_PX,
    REMEDY_OF_LENS,
    Cause,
    Finding,
    describe_harm,
)
from calibgui.engine.assessment.residuals.residual_causes import (
    CAUSES,
    Family,
    find_cause,
    list_tests,
)
from calibgui.engine.assessment.residuals.residual_checks import NoiseCheck, find_largest_share
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.repetition import repeat_calibration
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_MIN_SHARE = 0.03
"""Share of the squared residuals that a cause with few unknowns explains, from which it is named.
With none at all 2 of 71 sets were called by a wrong name (``tests/faults``)."""
_MIN_PART_OF_BEST = 0.8
"""Part of what the best cause explains, from which lens or board are the cause: causes of each
view's own have more unknowns, and explain nearly all that these do. With 0.5 a print that was
askew was called a lens; without it 3 of 30 boards were said to bend anew (``tests/faults``)."""
MIN_SHARE_OF_RIVAL = 1 / 3
"""Share of the squared residuals from which a cause that could explain nearly anything is named: a
lens of another kind, any smooth displacement of each view's own, shifts from row to row. Of real
photographs that a model followed a lens of another kind explained at most a sixth; of blurred ones
smooth displacements 0.08, and 0.12 of real ones whose lines do not start evenly."""
MIN_SHARE_OF_KINDS = 0.5
"""Share of the squared residuals that two kinds of views explain, from which corners that do not
fit may be missed by the model, and from which they are named beside a board of any shape. Without
it 3 of 71 sets with misplaced corners were called two kinds or too few (``tests/faults``)."""
_MIN_PART_OF_HARM = 0.1
"""Part of the harm that the board does, from which a cause that is left beside a board of any shape
is named instead: it was 0.01 in rendered photographs of bowed boards with a decentred lens, and 1
where a lens model did not follow the lens (``tests/faults``)."""
_SOUGHT = {
    DISTORTION: "photographs that the camera or a program has corrected, or another lens, among "
    "these"
}
_SOUGHT_AT_LARGE = "another camera, zoom, focus or board in these photographs"
"""The things to look for where views are of two kinds, by the name of their difference."""
_CAUSES_BESIDE_ROLL = (Cause.LENS, Cause.ROLLING_SHUTTER, Cause.DISAGREEMENT, Cause.BLUR)
"""Causes that a roll of all images is mistaken for, or beside which it may be more harmful."""
_CAUSES_BESIDE_SCALE = (
    Cause.BLUR,
    *(cause.cause for cause in CAUSES if cause.family in (Family.OF_VIEW, Family.OPEN)),
)
"""Causes of each view's own, beside which a scale of the images may explain more."""
_OF_BOARD, _OF_VIEWS = list_tests(Family.BOARD), list_tests(Family.OF_VIEW)
"""Tests of a board that is the same in all views, and of causes of each view's own."""
_TESTED = list_tests(*Family)
"""Tests of all causes."""


def find_systematic_cause(case: Case) -> Finding | None:
    """Find the one cause of residuals that are not noise; None if none matters."""
    found = _find_cause(case)
    if found is not None and found.cause in (Cause.LENS, Cause.BOARD_SHAPE):
        names = ("lens",) if found.cause is Cause.LENS else _OF_BOARD
        explained = find_largest_share(check for check in case.report.checks if check.name in names)
        explained = explained or MIN_SHARE_OF_RIVAL
        found = find_shear(case, explained) or found
    if found is None or found.cause in _CAUSES_BESIDE_ROLL:
        is_lens = found is not None and found.cause is Cause.LENS
        found = find_roll(case, found, explained if is_lens else 0.0) or found
    if found is None or found.cause in _CAUSES_BESIDE_SCALE:
        explained = 0.0 if found is None else find_largest_share(case.report.checks)
        return find_scaling(case, explained) or found
    return found


def _find_cause(case: Case) -> Finding | None:
    report = case.report
    failed = {check.name: check for check in report.checks if not check.passed}
    check = _choose_shared_cause(report.checks)
    if check is not None:
        found = _describe_check(case, check)
        beside = _find_cause_beside_board(case, failed) if check.name in _OF_BOARD else None
        is_less = found and beside and beside.harm < _MIN_PART_OF_HARM * found.harm
        return found if beside is None or is_less else beside
    explained = find_largest_share(report.checks)
    lens = _find_wrong_lens(case)
    if lens is not None:
        return lens
    if case.measure_harm(explained) < MIN_HARM_PX:
        return _find_blur(case, failed)
    split = case.split
    if split is not None:
        return _describe_two_kinds(case, split)
    check = _choose_cause_of_views(report.checks)
    if check is not None:
        return _describe_check(case, check)
    return _find_blur(case, failed)


def _find_cause_beside_board(case: Case, failed: Mapping[str, NoiseCheck]) -> Finding | None:
    """Find a wrong lens, or two kinds of views, that a board of any shape leaves; None if neither.

    What they explain is measured with the board's shape estimated, unless two kinds of views
    explain more than a board of any shape, which has many more unknowns: of 60 boards that were
    bent or badly printed (``tests/faults``) none made two kinds certain.
    """
    split = case.split
    if split is not None:
        board = find_largest_share(failed[name] for name in _OF_BOARD if name in failed)
        if split.share > board:
            return _describe_two_kinds(case, split)
    try:
        free = repeat_calibration(case.calibration, case.views, board_shape=BoardShapeModel.FREE)
    except CalibrationError:
        return None
    beside = prepare_case(free, case.views, case.names, case.check)
    beside = replace(beside, numbers=case.numbers).follow(case, "with the board as calibrated")
    found = _find_wrong_lens(beside)
    if found is not None:
        return found
    split = beside.split
    if split is None or split.share < MIN_SHARE_OF_KINDS:
        return None
    return _describe_two_kinds(beside, split)


def _find_wrong_lens(case: Case) -> Finding | None:
    """Find a lens that a model of another kind follows better by far; None if it does not.

    None is fitted where no test of a cause fails: they see a part of what a lens leaves.
    """
    if not any(check.share for check in case.report.checks if check.name in _TESTED):
        return None
    share, displacement = case.rival
    if share < MIN_SHARE_OF_RIVAL or displacement < MIN_HARM_PX:
        return None
    return _describe_lens(case, float(np.sqrt(share)) * case.rms, case.measure_harm(share))


def _find_blur(case: Case, failed: dict[str, NoiseCheck]) -> Finding | None:
    """Find views whose corners scatter more than the others'; None if that does no harm."""
    check = failed.get("views")
    return None if check is None else _describe_blur(case, check)


def estimate_board(case: Case) -> Calibration | None:
    """Estimate the board's shape if it is the most probable cause; None if it is not, or if the
    views do not determine it."""
    check = _choose_shared_cause(case.report.checks)
    if check is None or check.name not in _OF_BOARD:
        return None
    adds = find_cause(check.name).adds
    model = adds if adds == BoardShapeModel.AFFINE else BoardShapeModel.FREE
    try:
        return repeat_calibration(case.calibration, case.views, board_shape=model)
    except CalibrationError:
        return None


def _choose_shared_cause(checks: Sequence[NoiseCheck]) -> NoiseCheck | None:
    """Choose between board and lens, if either is the cause; None if not."""
    likely = [c for c in _order_by_probability(checks) if not c.passed and c.share >= _MIN_SHARE]
    board = [check for check in likely if check.name in _OF_BOARD]
    lens = [check for check in likely if check.name == "lens"]
    is_board = board[:1] == _order_by_probability(checks)[:1]
    least = _MIN_PART_OF_BEST * find_largest_share(checks)
    if lens and not is_board and lens[0].share >= least:
        return lens[0]
    return board[0] if board and (is_board or find_largest_share(board) >= least) else None


def _choose_cause_of_views(checks: Sequence[NoiseCheck]) -> NoiseCheck | None:
    """Choose the cause among those that differ from view to view; None if it is none of them.

    It is the most probable of all causes. Where that is another, and much is smooth or along the
    rows, this is what there is to be told of.
    """
    likeliest = _order_by_probability(checks)[0]
    if likeliest.name in _OF_VIEWS and likeliest.share >= _MIN_SHARE:
        return likeliest
    smooth, lines = (next(c for c in checks if c.name == name) for name in ("smooth", "lines"))
    most = max(lines, smooth, key=lambda check: check.share)
    return most if most.share >= MIN_SHARE_OF_RIVAL else None


def _order_by_probability(checks: Iterable[NoiseCheck]) -> list[NoiseCheck]:
    """Order causes with few unknowns and with many, the most probable first.

    Shifts from row to row are none of them: they count as errors that are not independent.
    """
    return sorted((c for c in checks if c.name != "lines"), key=lambda check: check.criterion)


def _describe_two_kinds(case: Case, split: Split) -> Finding:
    """Describe views of two kinds; one kind may be stored upside down or mirrored."""
    turned = find_turn(case, split.is_odd)
    if turned is not None:
        return describe_turned_views(case, turned)
    odd = np.flatnonzero(split.is_odd).tolist()
    views = tuple(case.numbers[k] for k in odd)
    left = case.rms * float(np.sqrt(1 - split.share))
    harm = case.measure_harm(split.share)
    return Finding(
        Cause.MIXED_VIEWS,
        f"The photographs are of two kinds: {list_names([case.names[k] for k in odd])} "
        f"{'disagree' if len(odd) > 1 else 'disagrees'} with the others about the {split.what}.",
        f"If each kind had its own, {left:.2g} px would be left of {case.describe_rms()}; "
        f"{describe_harm(harm)}.",
        f"Look for {_SOUGHT.get(split.what, _SOUGHT_AT_LARGE)}, and calibrate each kind by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def describe_turned_views(case: Case, turned: Turned) -> Finding:
    """Describe photographs that are stored upside down or mirrored against the others."""
    views = tuple(case.numbers[k] for k in turned.views)
    left = summarise_residuals(turned.calibration.residuals).rms
    harm = measure_displacement(case.calibration.camera, turned.calibration.camera, case.views)
    return Finding(
        Cause.MIXED_VIEWS,
        f"{list_names([case.names[k] for k in turned.views])} "
        f"{'are' if len(views) > 1 else 'is'} {turned.how} against the others, stored by a program "
        "that turned what the camera wrote.",
        f"Turned back they leave {left:.2g} px of {case.describe_rms()}; {describe_harm(harm)}.",
        f"{turned.remedy}, or take the files as the camera wrote them. If they are of another "
        "camera, calibrate it by itself.",
        harm,
        views,
        Action(ActionKind.LEAVE_OUT_VIEWS, views),
    )


def describe_strangers(case: Case, found: Strangers) -> Finding | None:
    """Describe photographs that do not belong to the others, and what they disagree about, if that
    parts them from all others; None if they do no harm."""
    split = case.split
    if split is not None and tuple(np.flatnonzero(split.is_odd).tolist()) == found.views:
        return _describe_two_kinds(case, split)
    others = [view for k, view in enumerate(case.views) if k not in found.views]
    harm = measure_displacement(case.calibration.camera, found.others.camera, others)
    if harm < MIN_HARM_PX:
        return None
    names = list_names([case.names[k] for k in found.views])
    left, is_one = summarise_residuals(found.others.residuals).rms, len(found.views) == 1
    return Finding(
        Cause.MIXED_VIEWS,
        f"{names} {'does' if is_one else 'do'} not belong to the others.",
        f"Without {'it' if is_one else 'them'} {left:.2g} px are left of {case.describe_rms()}; "
        f"{describe_harm(harm)}.",
        f"Look whether {'it is' if is_one else 'they are'} of another camera, zoom, focus or board,"
        " or cropped or edited, and leave them out.",
        harm,
        found.views,
        Action(ActionKind.LEAVE_OUT_VIEWS, found.views),
    )


def list_names(names: Sequence[str]) -> str:
    """List the first of many names."""
    more = len(names) - MAX_LISTED
    return ", ".join(names) if more <= 0 else f"{', '.join(names[:MAX_LISTED])} and {more} more"


def _describe_lens(case: Case, error: float, harm: float) -> Finding:
    """Describe a lens model that leaves `error` px of all views; `harm` is in px, too.

    A board's shape that was estimated takes a part of `error` up, which may exceed the RMS then.
    """
    calibration = case.calibration
    cause = f"{error:.2g} px that all views share and the board does not explain"
    evidence = f"Of {case.describe_rms()} it leaves {cause}."
    if calibration.lens_error > 0 and calibration.board_shape is not None:
        evidence = (
            f"With the board as drawn, it leaves {cause}; with the board's estimated shape, which "
            f"stands in for the lens, {case.describe_rms()} are left in all."
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
    tested, harm = find_cause(check.name), case.measure_harm(check.share)
    if tested.cause is Cause.LENS:
        if case.rival.share > check.share:  # what a model misses is no part of its covariance
            harm = max(harm, case.rival.displacement)
        error = case.calibration.lens_error or float(np.sqrt(check.share)) * case.rms
        return _describe_lens(case, error, harm) if harm > MIN_HARM_PX else None
    if harm < MIN_HARM_PX:
        return None
    is_open = tested.cause is Cause.DISAGREEMENT
    evidence = (
        f"{'Distortions, others in each view, explain' if is_open else 'It explains'} "
        f"{100 * check.share:.0f} % of the squared residuals of {case.describe_rms()}"
    )
    if tested.cause is Cause.BOARD_SHAPE and case.calibration.board_shape_error > 0:
        evidence += f"; corners of the board are off by {case.calibration.board_shape_error:.2g} mm"
    return Finding(
        tested.cause,
        tested.message,
        f"{evidence}; {describe_harm(harm)}.",
        tested.remedy,
        harm,
        action=Action(tested.action),
    )


def _describe_blur(case: Case, check: NoiseCheck) -> Finding | None:
    """Describe views whose corners scatter more than others; None if that does no harm."""
    harm = case.measure_noise(check.share)
    if harm < MIN_HARM_PX:
        return None
    remedy = check.advice.partition(": ")[2]
    return Finding(
        Cause.BLUR,
        "Some views show the corners less well than the others.",
        f"Their corners scatter unequally: {check.finding}; {describe_harm(harm)}.",
        f"{remedy[:1].upper()}{remedy[1:]}",
        harm,
        action=Action(ActionKind.WEIGH_VIEWS),
    )

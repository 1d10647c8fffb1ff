"""The best camera that photographs give, in one go: what needs no new photograph is carried out.

A calibration is judged, and what is found wrong with it often has a remedy that a program carries
out: another lens model, an estimated board shape, corners or views left out. So the first camera is
followed by others: of the remedies that leave what the user stated as it is, the one that gains
most, until none makes the error of a pixel smaller by more than a fifth. Each step can be gone back
on, and is said in a sentence. A step whose promise does not hold, by the verdict on what it leads
to, is not taken.

It carries out nothing that the views cannot tell: the verdict asks for photographs then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from threading import Event
from typing import NamedTuple

import numpy as np

from calibgui.app.calibrating.calibration import recall_lens_choice
from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.calibrating.settings import (
    DEFAULT_MODEL,
    Settings,
    change_settings,
    state_board_shape,
    takes_remedies,
)
from calibgui.dataset import CornerSet, Result
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import (
    MIN_GAIN_TO_ACT,
    Action,
    ActionKind,
    Change,
    Finding,
    Verdict,
)
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import Report, Status
from calibgui.engine.errors import CalibrationError, Progress

_DONE = {
    ActionKind.ESTIMATE_BOARD_SHAPE: "its shape was estimated",
    ActionKind.CHOOSE_LENS_MODEL: "another lens model was taken",
    ActionKind.LEAVE_OUT_CORNERS: "left out",
    ActionKind.LEAVE_OUT_VIEWS: "left out",
    ActionKind.HOLD_AT_ZERO: "held at 0",
}
"""The actions that are carried out without being asked for, with the words that say so."""


class Step(NamedTuple):
    """A calibration on the way to the best camera."""

    said: str
    """A sentence that says what was done; empty for the first calibration."""
    action: Action | None
    """The action that led to it; None for the first calibration."""
    result: Result
    """The calibration that it led to, with the sentences of all steps so far."""


def calibrate_best(
    corner_set: CornerSet,
    settings: Settings,
    report: Report | None = None,
    stop: Event | None = None,
    search: bool = True,
    progress: Progress | None = None,
    check: Callable[[], None] | None = None,
) -> Iterator[Step]:
    """Calibrate, and carry out what makes the camera better, as far as the settings allow.

    Args:
        corner_set, settings, report, stop, search, progress: as for ``calibrate_twice``.
        check: a function that is called now and then while a calibration is judged, and raises to
            abandon the work.

    Yields:
        The first calibration and those that follow, each as soon as it is made and better than the
        one before: the last is the best. It is the only one unless the settings ask for more
        (``Settings.improve``). Of a camera that is known it is where the boards are.

    Raises:
        CalibrationError, Cancelled: as ``calibrate_twice``, for the first calibration.
    """
    begin = settings
    if settings.improve:
        begin = replace(settings, board_shape=settings.board_shape or BoardShapeModel.NOMINAL)
    result = calibrate_twice(corner_set, begin, report, stop, search, progress)
    yield Step("", None, result)
    calibration = result.calibration
    is_final = calibration.status is not Status.CONVERGED or calibration.diagnosis is not None
    is_final |= settings.known is not None
    if is_final or not settings.improve or not takes_remedies(settings):
        return
    verdict = judge_result(result, check)
    tried: set[ActionKind] = set()
    while (finding := _choose_finding(verdict, settings, tried)) is not None:
        assert finding.action is not None
        if finding.action.kind is not ActionKind.LEAVE_OUT_VIEWS:  # once they are gone, others show
            tried.add(finding.action.kind)
        try:
            following = _carry_out(finding.action, result, settings, report, stop)
        except CalibrationError:
            tried.add(finding.action.kind)
            continue
        if following.calibration.status is Status.STOPPED:
            break  # the last that is finished is the answer
        judged = judge_result(following, check)
        gain = verdict.error.covered / judged.error.covered
        if not gain >= MIN_GAIN_TO_ACT:
            tried.add(finding.action.kind)
            continue
        said = _describe_step(finding, following, gain)
        verdict = judged
        result = replace(following, improvements=(*result.improvements, said))
        yield Step(said, finding.action, result)


def calibrate_at_once(corner_set: CornerSet, settings: Settings) -> Result | None:
    """Calibrate by the settings without what takes time, for a first answer within a blink.

    What is to be chosen is as the paper has it: the lens, and a board as drawn. No outlier is left
    out, no view is weighed and no image searched again.

    Returns:
        The calibration; None if it is all that the settings ask for, or if it cannot be made:
        `calibrate_best` then says why.
    """
    if settings.known is not None:
        return None
    at_once = replace(
        settings,
        model=settings.model or DEFAULT_MODEL,
        board_shape=settings.board_shape or BoardShapeModel.NOMINAL,
        robust=False,
        weigh_views=False,
        once=True,
        improve=False,
    )
    if at_once == replace(settings, improve=False):
        return None
    try:
        return calibrate_twice(corner_set, at_once)
    except CalibrationError:
        return None


def _choose_finding(verdict: Verdict, settings: Settings, tried: set[ActionKind]) -> Finding | None:
    """Choose the finding whose action gains most, of those that the settings leave open; None if
    none gains enough."""
    open_findings = [
        finding
        for finding in verdict.findings
        if finding.action is not None
        and finding.action.kind in _DONE
        and finding.action.kind not in tried
        and _is_open(finding.action.change, settings)
    ]
    best = max(open_findings, key=lambda finding: finding.times_better, default=None)
    return best if best is not None and best.times_better >= MIN_GAIN_TO_ACT else None


def _is_open(change: Change | None, settings: Settings) -> bool:
    """Return whether a change leaves what the user stated as it is."""
    if change is None:
        return False
    if settings.candidates and change.lens_model not in (None, *settings.candidates):
        return False
    changes_lens = change.lens_model is not None or change.holds_at_zero
    changes_board = change.board_shape is not None
    return not (
        (changes_lens and settings.model is not None)
        or (changes_board and settings.board_shape is not None)
    )


def _carry_out(
    action: Action, result: Result, settings: Settings, report: Report | None, stop: Event | None
) -> Result:
    """Calibrate again from the views of a result, with an action carried out.

    A lens model that was chosen automatically is chosen anew where views are left out, or where the
    board's shape may have stood behind one that is richer than the paper's; what was held of the
    paper's is estimated then, as a flat board may have hidden it.
    """
    change = action.change
    assert change is not None
    views = list(result.views)
    used = [k for k, view in enumerate(views) if view.usable]
    for k in change.leaves_out_views:
        reason = "Left out: it does not belong to the others."
        views[used[k]] = replace(views[used[k]], enabled=False, reason=reason)
    corner_set = CornerSet(
        result.calibration.camera.size, tuple(views), result.board, result.lengths_confirmed
    )
    following = replace(state_board_shape(settings, result.calibration), once=True)
    lens = recall_lens_choice(result)
    if lens is not None and change.board_shape and lens.model == DEFAULT_MODEL:
        following = replace(following, model=DEFAULT_MODEL)
    elif lens is not None and not (change.leaves_out_views or change.board_shape):
        following = lens.apply_to(following)
    following = change_settings(following, result.calibration.camera.model, change)
    return calibrate_twice(corner_set, following, report, stop, search=False)


def _describe_step(finding: Finding, following: Result, gain: float) -> str:
    """Describe what was done about a finding, what it gained, and what views left out are for."""
    assert finding.action is not None
    shape = following.calibration.board_shape
    message = finding.message.removesuffix(".")
    if finding.action.kind is ActionKind.ESTIMATE_BOARD_SHAPE and shape is not None:
        across, off_plane = shape.deviation[:, :2], shape.deviation[:, 2]
        is_flat = np.sum(across**2) > np.sum(off_plane**2)
        message = f"Your board is not {'printed true' if is_flat else 'flat'} ({shape.rms:.2g} mm)"
    said = f"{message}: {_DONE[finding.action.kind]}; errors {gain:.1f} times smaller."
    is_of_views = finding.action.kind is ActionKind.LEAVE_OUT_VIEWS
    return f"{said} {finding.remedy}" if is_of_views else said

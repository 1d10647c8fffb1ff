"""The verdict in words: a headline, the error of a pixel, and one row for each finding."""

from __future__ import annotations

import glob
import itertools
import shlex
from collections.abc import Sequence
from fnmatch import fnmatchcase

import numpy as np

from calibgui.dataset import Result, View
from calibgui.dataset.acceptance import list_broken_limits
from calibgui.dataset.limits import Limits
from calibgui.engine.assessment import (
    Action,
    Grade,
    Verdict,
    summarise_residuals,
)
from calibgui.engine.calibration import DEFAULT_METHOD, Cost
from calibgui.engine.numbers import format_two_digits
from calibgui.report.boards import name_point
from calibgui.report.names import join_words
from calibgui.report.numbers import format_count

_HEADLINES = {
    Grade.GOOD: "GOOD",
    Grade.USABLE: "USABLE",
    Grade.CAN_BE_BETTER: "CAN BE {times} TIMES BETTER",
    Grade.NOT_USABLE: "NOT USABLE",
}
_MOST_NAMES = 3
"""Number of images up to which all are named."""
_MIN_BLUR, _MIN_RELATIVE_BLUR = 1.5, 2.0
"""Blur of a photograph's edges, px, and over that of the median one, from which it is called
blurred. Of photographs that people took for sharp the worst has 1.8 times the median, 0.9 px."""


def format_headline(verdict: Verdict) -> str:
    """Format the grade in capitals, with the ratio by which the camera can be better."""
    return _HEADLINES[verdict.grade].format(times=format_times(verdict.times_better))


def format_times(times: float) -> str:
    """Format a ratio of errors with two digits, which is more than it is known to."""
    return f"{times:.1f}" if times < 9.95 else format_two_digits(times)


def describe_reason(verdict: Verdict, result: Result) -> str:
    """Say why a calibration has its grade, and which photographs are blurred if that is no cause.

    Their corners are as right as others, but scatter more.
    """
    blurred = [] if verdict.findings else _find_blurred(result.used)
    if not blurred or verdict.grade is Grade.NOT_USABLE:
        return verdict.reason
    said = (
        "is blurred, which does no harm here."
        if len(blurred) == 1
        else "are blurred, which does no harm here."
    )
    return f"{verdict.reason} {join_names(blurred)} {said}"


def _find_blurred(views: Sequence[View]) -> list[str]:
    """Return the names of the views that are much less sharp than the median one."""
    # The window does this in a turn of its own, and np.median takes ten times as long.
    blurs = [
        float(np.sort(corners.blur)[len(corners.blur) // 2])
        if (corners := view.corners) is not None and corners.blur is not None
        else np.nan
        for view in views
    ]
    if np.isnan(blurs).all():
        return []
    least = max(_MIN_BLUR, _MIN_RELATIVE_BLUR * float(np.nanmedian(blurs)))
    return [view.name for view, blur in zip(views, blurs, strict=True) if blur > least]


def describe_acceptance(result: Result, limits: Limits) -> str:
    """Describe whether a calibration keeps limits, with what it breaks."""
    reasons = list_broken_limits(result, limits)
    return " ".join([f"{'FAIL' if reasons else 'PASS'} by the limits {limits.name}.", *reasons])


def describe_error(verdict: Verdict) -> str:
    """Describe the error of a pixel over the image, in px."""
    error = verdict.error
    if not np.isfinite(error.worst):
        return "Error of a pixel: unknown"
    places = ("centre", error.centre), ("among corners", error.covered), ("edge", error.edge)
    listed = ", ".join(f"{place} {format_two_digits(px)}" for place, px in places)
    return f"Error of a pixel: {listed}, worst {format_two_digits(error.worst)} px"


def describe_error_in_scene(verdict: Verdict, condition: str) -> str:
    """Describe what the error at the image's edge is at the boards' distance, in mm.

    Args:
        verdict: the verdict.
        condition: what lengths rest on, such as "if squares are 30 mm"; empty if they are known.
    """
    mm = verdict.error.edge * verdict.mm_per_pixel
    if not np.isfinite(mm):
        return ""
    words = f"{format_two_digits(mm)} mm at the edge, {verdict.distance:.0f} mm away"
    return f"{words}, {condition}" if condition else words


def describe_fit(result: Result) -> str:
    """Describe the residuals in a few words: RMS, sigma and the number of corners or circles."""
    fit = summarise_residuals(result.calibration.residuals)
    points = format_count(fit.count, name_point(result.board))
    return f"RMS {fit.rms:.3f} px, σ {fit.sigma:.3f} px of {points}"


def describe_options(action: Action, result: Result) -> str:
    """Describe how to change the command to carry an action out, as "add --robust"; empty if no
    options do.

    Args:
        action: the action.
        result: the result that the action is about.
    """
    change = action.change
    if change is None:
        return ""
    if change.releases:
        return f"leave {','.join(change.releases)} out of --fix"
    given = {
        "--board-shape": change.board_shape,
        "--model": change.lens_model,
        "--fix": ",".join(change.holds_at_zero),
        "--free": ",".join(change.frees),
        "--exclude": _list_files([view.name for view in result.used], change.leaves_out_views),
    }
    options = [f"{option} {value}" for option, value in given.items() if value]
    options += ["--robust"] * change.leaves_out_corners + ["--weigh-views"] * change.weighs_views
    if change.takes_image_cost:
        if result.calibration.cost is not Cost.IMAGE:
            options.append(f"--cost {Cost.IMAGE.value}")
        if result.calibration.settings.method != DEFAULT_METHOD:
            options.append(f"--method {DEFAULT_METHOD}")
    return f"add {' '.join(options)}"


def _list_files(names: Sequence[str], chosen: Sequence[int]) -> str:
    """List the `chosen` of some names as arguments of a command."""
    return shlex.join(_abbreviate_names(names, chosen)) if chosen else ""


def _abbreviate_names(names: Sequence[str], chosen: Sequence[int]) -> list[str]:
    """Return one pattern, as a shell has them, that fits the `chosen` of some names and no others,
    if they are many and there is such a pattern, and otherwise these names."""
    those = [names[k] for k in chosen]
    first = _find_common_start(those)
    last = _find_common_start([name[len(first) :][::-1] for name in those])[::-1]
    pattern = f"{glob.escape(first)}*{glob.escape(last)}"
    are_only_those = sum(fnmatchcase(name, pattern) for name in names) == len(those)
    return [pattern] if len(those) > _MOST_NAMES and are_only_those else those


def _find_common_start(texts: Sequence[str]) -> str:
    """Return the characters that all of some texts begin with."""
    alike = itertools.takewhile(lambda each: len(set(each)) == 1, zip(*texts, strict=False))
    return "".join(each[0] for each in alike)


def join_names(names: Sequence[str], most: int = _MOST_NAMES) -> str:
    """Join names to "a, b and c", or to "a, b, c and 4 more"."""
    if len(names) > most:
        return f"{', '.join(names[:most])} and {len(names) - most} more"
    return join_words(names)

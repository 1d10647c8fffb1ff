"""The window's words for grades and actions: the command line has its own in ``report.verdict``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import assert_never

import numpy as np
from PySide6.QtCore import QCoreApplication

from calibgui.dataset import Result
from calibgui.engine.assessment import (
    Action,
    ActionKind,
    Grade,
    PixelError,
    Verdict,
)
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.widgets.lengths import describe_condition
from calibgui.report.verdict import format_times, join_names

translate = QCoreApplication.translate
_FINEST = 0.01
"""Error of a pixel below which it is stated to 0.001 px, px."""


def describe_grade(grade: Grade, times_better: float) -> str:
    """Describe a grade in capitals."""
    match grade:
        case Grade.GOOD:
            return translate("VerdictTexts", "GOOD")
        case Grade.USABLE:
            return translate("VerdictTexts", "USABLE")
        case Grade.CAN_BE_BETTER:
            text = translate("VerdictTexts", "CAN BE {0}× BETTER")
            return text.format(format_times(times_better))
        case Grade.NOT_USABLE:
            return translate("VerdictTexts", "NOT USABLE")
        case _:
            assert_never(grade)


def describe_pixel_error(error: PixelError) -> str:
    """Describe the error of a pixel over the image, px."""
    if not np.isfinite(error.worst):
        return translate("VerdictTexts", "Error: unknown")
    text = translate("VerdictTexts", "Error: centre {0}, among corners {1}, edge {2}, worst {3} px")
    figures = error.centre, error.covered, error.edge, error.worst
    return text.format(*map(format_pixels, figures))


def format_pixels(px: float) -> str:
    """Format an error, px: below 0.01 px its second digit tells nobody anything."""
    return format_two_digits(px) if px >= _FINEST else f"{px:.3f}".replace("0.000", "<0.001")


def describe_figures(verdict: Verdict, result: Result) -> list[str]:
    """Describe the error of a pixel, and what it is in the scene."""
    parts = [describe_pixel_error(verdict.error)]
    if np.isfinite(mm := verdict.error.edge * verdict.mm_per_pixel):
        text = translate("VerdictTexts", "{0} mm at the edge, {1:.0f} mm away")
        parts.append(text.format(format_two_digits(mm), verdict.distance))
        parts[-1] += describe_condition(result)
    return parts


def describe_length(verdict: Verdict) -> str:
    """Describe in short what the error along the edge is in the scene; empty if it is unknown."""
    if not np.isfinite(mm := verdict.error.edge * verdict.mm_per_pixel):
        return ""
    text = translate("VerdictTexts", "edge: {0} mm at {1} m")
    return text.format(format_two_digits(mm), format_two_digits(verdict.distance / 1000.0))


def describe_button(action: Action, names: Sequence[str]) -> str:
    """Describe what the button of an action does.

    Args:
        action: the action.
        names: names of the calibrated views.
    """
    views = join_names([names[k] for k in action.views], most=1)
    parameters = join_names(action.parameters)
    match action.kind:
        case ActionKind.ESTIMATE_BOARD_SHAPE:
            return translate("VerdictTexts", "Estimate the board's shape")
        case ActionKind.CHOOSE_LENS_MODEL:
            return translate("VerdictTexts", "Take the lens model that fits")
        case ActionKind.LEAVE_OUT_CORNERS:
            return translate("VerdictTexts", "Leave these corners out")
        case ActionKind.LEAVE_OUT_VIEWS:
            return translate("VerdictTexts", "Leave {0} out").format(views)
        case ActionKind.FREE_HELD_VALUE:
            return translate("VerdictTexts", "Free {0}").format(parameters)
        case ActionKind.HOLD_AT_ZERO:
            return translate("VerdictTexts", "Hold {0} at 0").format(parameters)
        case ActionKind.ESTIMATE_SKEW:
            return translate("VerdictTexts", "Estimate the skew")
        case ActionKind.WEIGH_VIEWS:
            return translate("VerdictTexts", "Weigh views by their noise")
        case ActionKind.LOOK_AT_VIEW:
            return translate("VerdictTexts", "Look at {0}").format(views)
        case ActionKind.PHOTOGRAPH_MORE:
            return translate("VerdictTexts", "Show where to hold the board")
        case _:
            assert_never(action.kind)

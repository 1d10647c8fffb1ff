"""What the window says of lengths while nobody has confirmed the side of a square."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from calibgui.dataset import Result

translate = QCoreApplication.translate


def describe_condition(result: Result) -> str:
    """Describe what lengths rest on, as " if squares are 30 mm"; empty if they are confirmed."""
    if result.lengths_confirmed or result.board is None:
        return ""
    return translate("lengths", " if squares are {0:g} mm").format(result.board.square)


def state_condition(result: Result) -> str:
    """State in a sentence what lengths rest on; empty if they are confirmed."""
    if not (condition := describe_condition(result)):
        return ""
    return translate("lengths", "Lengths hold{0}.").format(condition)


def name_unit(result: Result) -> str:
    """Name the unit of lengths, with what they rest on."""
    return translate("lengths", "mm") + describe_condition(result)

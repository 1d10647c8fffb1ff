"""The window marks lengths as long as nobody has confirmed the side of a square."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from calibgui.dataset import Result
from calibgui.engine.boards import AprilGrid

translate = QCoreApplication.translate


def describe_condition(result: Result) -> str:
    """Describe what lengths rest on, as " if squares are 30 mm"; empty if they are confirmed."""
    board = result.board
    if result.lengths_confirmed or board is None:
        return ""
    if not board.pattern.has_squares:
        text = translate("lengths", " if circles are {0:g} mm apart")
    elif isinstance(board.pattern, AprilGrid):
        text = translate("lengths", " if tags are {0:g} mm")
    else:
        text = translate("lengths", " if squares are {0:g} mm")
    return text.format(board.square)


def state_condition(result: Result) -> str:
    """State in a sentence what lengths rest on; empty if they are confirmed."""
    if not (condition := describe_condition(result)):
        return ""
    return translate("lengths", "Lengths hold{0}.").format(condition)


def name_unit(result: Result) -> str:
    """Name the unit of lengths, with what they rest on."""
    return translate("lengths", "mm") + describe_condition(result)

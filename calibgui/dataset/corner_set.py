"""The located corners of a set of photographs: what a calibration is made from."""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.dataset.view import View
from calibgui.engine.arrays import Size
from calibgui.engine.boards import AprilGrid, Board

DEFAULT_SQUARE = 30.0
"""Side of a square until somebody states it, mm; only lengths depend on it."""


@dataclass(frozen=True, eq=False, slots=True)
class CornerSet:
    """Views of one camera and the board that they show."""

    size: Size
    """Width and height of the images, px."""
    views: tuple[View, ...]
    """All photographs, those without corners included."""
    board: Board | None = None
    """The board of known layout; None where the corners came with their board points."""
    lengths_confirmed: bool = True
    """False if nobody has stated the side of a square: all lengths then hold if it is that."""


def describe_lengths(board: Board | None) -> str:
    """Describe what lengths hold on if nobody has stated them, as "if squares are 30 mm"; empty
    without a board of known layout."""
    if board is None:
        return ""
    length = f"{board.square:g} mm"
    if not board.pattern.has_squares:
        return f"if circles are {length} apart"
    parts = "tags" if isinstance(board.pattern, AprilGrid) else "squares"
    return f"if {parts} are {length}"

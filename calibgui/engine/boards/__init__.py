"""What is photographed: boards, what is printed on them, and the shape that they really have."""

from __future__ import annotations

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD, Checkerboard, checkerboard_ambiguity
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.boards.pattern import Ambiguity, Pattern
from calibgui.engine.boards.printed_pattern import Discs, Raster
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior

__all__ = [
    "CHECKERBOARD",
    "KINDS",
    "Ambiguity",
    "Board",
    "BoardShape",
    "BoardShapeModel",
    "BoardShapePrior",
    "Charuco",
    "Checkerboard",
    "Circles",
    "Discs",
    "Pattern",
    "Raster",
    "checkerboard_ambiguity",
]

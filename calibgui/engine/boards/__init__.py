"""Boards: what is photographed, what is printed on it, and the shape that it really has.

A `Board` is a pattern with its numbers of rows and columns and its pitch. A `Pattern` says where
its points lie, which turns leave it unchanged, and what is printed: `Checkerboard`, `Charuco`,
`Circles`, `AprilGrid`, `PuzzleBoard` and `TaggedCheckerboard`, listed by name in `KINDS`.
`FAMILIES` names the families of AprilTags. `BoardShape` holds how far a real board departs from its
drawing. Nothing here looks at images: finding boards is the task of ``detection``.
"""

from __future__ import annotations

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.apriltags import FAMILIES
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD, Checkerboard, checkerboard_symmetry
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.boards.printed_pattern import (
    PrintedDiscs,
    PrintedPattern,
    PrintedRectangles,
    PrintedSquaresAndDots,
)
from calibgui.engine.boards.puzzleboard import CODE_LINES, PuzzleBoard
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard

__all__ = [
    "CHECKERBOARD",
    "CODE_LINES",
    "FAMILIES",
    "KINDS",
    "AprilGrid",
    "Board",
    "BoardShape",
    "BoardShapeModel",
    "BoardShapePrior",
    "Charuco",
    "Checkerboard",
    "Circles",
    "Pattern",
    "PrintedDiscs",
    "PrintedPattern",
    "PrintedRectangles",
    "PrintedSquaresAndDots",
    "PuzzleBoard",
    "Symmetry",
    "TaggedCheckerboard",
    "checkerboard_symmetry",
]

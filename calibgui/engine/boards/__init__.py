"""Boards: what is photographed, what is printed on it, and the shape that it really has.

A `Board` is a pattern with its numbers of rows and columns and its pitch. A `Pattern` says where
its points lie, which turns leave it unchanged, and what is printed: `Checkerboard`, `Charuco`,
`Circles`, `ListedCircles`, `AprilGrid`, `PuzzleBoard` and `TaggedCheckerboard`, listed by name in
`KINDS`. `list_circles` makes a pattern of circles wherever they lie.
`FAMILIES` names the families of AprilTags. `BoardShape` holds how far a real board departs from its
drawing. Nothing here looks at images: finding boards is the task of ``detection``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.boards.april_grid import AprilGrid as AprilGrid
    from calibgui.engine.boards.apriltags import FAMILIES as FAMILIES
    from calibgui.engine.boards.board import Board as Board
    from calibgui.engine.boards.charuco import Charuco as Charuco
    from calibgui.engine.boards.checkerboard import (
        CHECKERBOARD as CHECKERBOARD,
        Checkerboard as Checkerboard,
        checkerboard_symmetry as checkerboard_symmetry,
    )
    from calibgui.engine.boards.circle_grid import Circles as Circles
    from calibgui.engine.boards.kinds import KINDS as KINDS
    from calibgui.engine.boards.listed_circles import (
        ListedCircles as ListedCircles,
        list_circles as list_circles,
    )
    from calibgui.engine.boards.marks import (
        check_boards_differ as check_boards_differ,
        list_marks as list_marks,
    )
    from calibgui.engine.boards.pattern import Pattern as Pattern, Symmetry as Symmetry
    from calibgui.engine.boards.printed_pattern import (
        PrintedDiscs as PrintedDiscs,
        PrintedPattern as PrintedPattern,
        PrintedRectangles as PrintedRectangles,
        PrintedSquaresAndDots as PrintedSquaresAndDots,
    )
    from calibgui.engine.boards.puzzleboard import (
        CODE_LINES as CODE_LINES,
        PuzzleBoard as PuzzleBoard,
    )
    from calibgui.engine.boards.shape import (
        ERROR_COEFFICIENTS as ERROR_COEFFICIENTS,
        BoardShape as BoardShape,
        BoardShapeModel as BoardShapeModel,
        BoardShapePrior as BoardShapePrior,
    )
    from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard as TaggedCheckerboard

load_on_demand(
    __name__,
    {
        "april_grid": ["AprilGrid"],
        "apriltags": ["FAMILIES"],
        "board": ["Board"],
        "charuco": ["Charuco"],
        "checkerboard": ["CHECKERBOARD", "Checkerboard", "checkerboard_symmetry"],
        "circle_grid": ["Circles"],
        "kinds": ["KINDS"],
        "listed_circles": ["ListedCircles", "list_circles"],
        "marks": ["check_boards_differ", "list_marks"],
        "pattern": ["Pattern", "Symmetry"],
        "printed_pattern": [
            "PrintedDiscs",
            "PrintedPattern",
            "PrintedRectangles",
            "PrintedSquaresAndDots",
        ],
        "puzzleboard": ["CODE_LINES", "PuzzleBoard"],
        "shape": ["ERROR_COEFFICIENTS", "BoardShape", "BoardShapeModel", "BoardShapePrior"],
        "tagged_checkerboard": ["TaggedCheckerboard"],
    },
)

"""The marks by which photographs tell several boards apart: the markers and tags on each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco, dictionary_family
from calibgui.engine.boards.puzzleboard import CODE_LINES, PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.errors import CalibrationError


class Marks(NamedTuple):
    """The marks of a board."""

    kind: str
    """The kind of marks: a family of tags, as t36h11, or a family of dictionaries of markers."""
    numbers: frozenset[int]


def list_marks(board: Board) -> Marks | None:
    """List the marks of a board; None if it has none, or it is not stated of which kind."""
    rows, cols, pattern = board.rows, board.cols, board.pattern
    match pattern:
        case Charuco(dictionary=str(dictionary)):
            family = dictionary_family(dictionary)
            # OpenCV has the families of AprilTags as dictionaries.
            kind = family.replace("DICT_APRILTAG_", "t").lower() if "APRILTAG" in family else family
            return Marks(kind, frozenset(pattern.number_markers((rows, cols))))
        case AprilGrid(family=str(family)):
            first = pattern.first_tag or 0
            return Marks(family, frozenset(range(first, first + rows * cols // 4)))
        case TaggedCheckerboard(family=str(family)):
            return Marks(family, frozenset(range((rows + 1) * (cols + 1) // 2)))
        case PuzzleBoard(origin=(row, col)):
            places = np.add.outer(CODE_LINES * (row + np.arange(rows)), col + np.arange(cols))
            return Marks(pattern.kind, frozenset(places.ravel().tolist()))
        case _:
            return None


def check_boards_differ(boards: Sequence[Board], names: Sequence[str]) -> None:
    """Check that photographs tell boards apart.

    Args:
        boards: the boards.
        names: their names, for messages.

    Raises:
        CalibrationError: if one has no marks, or two have the same; the message names them.
    """
    seen: list[tuple[str, Marks]] = []
    for board, name in zip(boards, names, strict=True):
        marks = list_marks(board)
        if marks is None:
            raise CalibrationError(
                f"Nothing is stated of {name} that tells it from the other boards.",
                "Several boards have markers or tags: state --target and --board of each, and the "
                "--dictionary of a ChArUco board, the --family of one with AprilTags.",
            )
        for other, before in seen:
            if before.kind == marks.kind and before.numbers & marks.numbers:
                raise _explain_overlap(other, before, name, marks)
        seen.append((name, marks))


def _explain_overlap(other: str, before: Marks, name: str, marks: Marks) -> CalibrationError:
    """Return the error that two boards have the same marks."""
    if marks.kind == PuzzleBoard().kind:
        return CalibrationError(
            f"Parts of the PuzzleBoard's pattern are on {other} and on {name}: photographs do not "
            "tell the boards apart.",
            "Cut them from different places of the pattern, and state --origin of each.",
        )
    shared = sorted(before.numbers & marks.numbers)
    is_tag = not marks.kind.startswith("DICT")
    what, option = ("tags", "--first-tag") if is_tag else ("markers", "--first-marker")
    return CalibrationError(
        f"The {what} {shared[0]} to {shared[-1]} of {marks.kind} are on {other} and on {name}: "
        "photographs do not tell the boards apart.",
        f"Print one of them with others, numbered from {max(before.numbers) + 1} on or of another "
        f"{'family' if is_tag else 'dictionary'}, and state it ({option} N).",
    )

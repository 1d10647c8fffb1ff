"""The setup of a rig: what a user states before it is calibrated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from calibgui.app.rig.boards import StatedBoard
from calibgui.app.rig.calibrating import CornerSets
from calibgui.app.rig.pairing import recall_pairing
from calibgui.dataset import RigPairing, RigResult
from calibgui.engine.boards import KINDS, AprilGrid, Board, BoardShapeModel, Charuco, list_marks


@dataclass(frozen=True, eq=False, slots=True)
class RigSetup:
    """The photographs of a rig, its boards, and how it is to be calibrated."""

    pairing: RigPairing
    boards: tuple[StatedBoard, ...] = (StatedBoard(),)
    shape: BoardShapeModel = BoardShapeModel.NOMINAL
    """The deviations of the boards from their drawings that are estimated."""
    robust: bool = False
    """True to leave out corners and views that no camera explains."""
    estimate_offsets: bool = False
    """True to estimate by how much the clock of each camera is late."""


@dataclass(frozen=True, eq=False, slots=True)
class SearchedBoards:
    """The boards that were looked for in the photographs of a rig, with their corners."""

    boards: tuple[StatedBoard, ...] = ()
    """The boards that were looked for."""
    corner_sets: tuple[CornerSets, ...] = ()
    """The corners of each."""

    @property
    def seen(self) -> tuple[Board | None, ...]:
        """The boards as the photographs show them."""
        return tuple(
            next((each.board for each in corner_set.values() if each.board is not None), None)
            for corner_set in self.corner_sets
        )

    def answers(self, setup: RigSetup) -> bool:
        """Return whether all photographs of a rig were searched for its boards."""
        if _list_searched(self.boards) != _list_searched(setup.boards):
            return False
        return all(
            {str(file) for file in camera.files.values()}
            <= {view.image for view in corner_set[camera.name].views}
            for corner_set in self.corner_sets
            for camera in setup.pairing.cameras
        )


def _list_searched(boards: Sequence[StatedBoard]) -> list[object]:
    """List what the search for boards depends on."""
    return [(board.grid_size, board.pattern) for board in boards]


def recall_setup(result: RigResult) -> RigSetup:
    """Return what was stated of a rig, as far as its file tells."""
    rig = result.rig
    boards = [
        StatedBoard(
            board.grid_size,
            board.pattern,
            board.square if result.lengths_confirmed else None,
            placed.pose if b and not rig.board_sigma(b).any() and placed.reference != b else None,
        )
        for b, (board, placed) in enumerate(zip(result.boards, rig.placed_boards, strict=False))
    ]
    shape = rig.placed_boards[0].shape
    return RigSetup(
        recall_pairing(result),
        tuple(boards) or (StatedBoard(),),
        BoardShapeModel.NOMINAL if shape is None else shape.model,
        estimate_offsets=any(rig.offset_sigma(c) > 0 for c in range(len(rig.cameras))),
    )


def state_board(board: StatedBoard, seen: Board | None) -> StatedBoard:
    """State kind and size of a board that were left to the photographs.

    Args:
        board: the board as far as it is stated.
        seen: the board that the photographs show; None if they were not searched.
    """
    if board.pattern is not None:
        return board
    if seen is None:
        return replace(board, pattern=KINDS["charuco"])
    return replace(board, grid_size=seen.grid_size, pattern=seen.pattern)


def suggest_board(boards: Sequence[StatedBoard]) -> StatedBoard:
    """Suggest a further board: as the last one, its marks numbered after those of all others."""
    last = boards[-1]
    numbers: set[int] = set()
    for board in boards:
        if board.grid_size is not None and board.pattern is not None:
            marks = list_marks(Board(*board.grid_size, 1.0, board.pattern))
            numbers |= set() if marks is None else marks.numbers
    pattern, first = last.pattern, max(numbers) + 1 if numbers else None
    match pattern:
        case Charuco():
            pattern = replace(pattern, first_marker=first)
        case AprilGrid():
            pattern = replace(pattern, first_tag=first)
    return StatedBoard(last.grid_size, pattern, last.square)

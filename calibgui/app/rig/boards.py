"""The boards of a rig as a user states them, searched in the photographs of all its cameras."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from calibgui.app.photographs.detection import Detection
from calibgui.app.rig.calibrating import CornerSets, search_cameras
from calibgui.dataset import DEFAULT_SQUARE, RigPairing, View
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import (
    AprilGrid,
    Board,
    BoardShapeModel,
    Charuco,
    Pattern,
    check_boards_differ,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.engine.rig import RigBoard


@dataclass(frozen=True, slots=True)
class StatedBoard:
    """A board as a user states it; what is None the photographs tell, if it is the only one."""

    grid_size: GridSize | None = None
    pattern: Pattern | None = None
    square: float | None = None
    """Side of a square, mm."""
    pose: Pose | None = None
    """Pose first_from_board beside the first board, if it is known."""


Search = Callable[[Sequence[str], StatedBoard], Detection]
"""A function that searches photographs of one camera for a board."""


def search_boards(
    pairing: RigPairing, boards: Sequence[StatedBoard], search: Search
) -> list[CornerSets]:
    """Search the photographs of all cameras for each board.

    Args:
        pairing: the cameras with their photographs.
        boards: the boards.
        search: searches the photographs of a camera for one of them.

    Raises:
        CalibrationError: if there are several boards that photographs do not tell apart; or from
            `search`.
    """
    if len(boards) > 1:
        boards = [_state_first_mark(board) for board in boards]
        _check_boards(boards)

    def find(board: StatedBoard) -> CornerSets:
        def search_camera(files: Sequence[str], seen: Board | None) -> Detection:
            if seen is None:
                return search(files, board)
            return search(files, replace(board, grid_size=seen.grid_size, pattern=seen.pattern))

        return search_cameras(pairing, search_camera, board.square, is_only=len(boards) == 1)

    return [find(board) for board in boards]


def list_boardless_views(corner_sets: Sequence[CornerSets], camera: str) -> list[View]:
    """List a camera's photographs of which no board's view can be used."""
    shown = {view.image for each in corner_sets for view in each[camera].views if view.usable}
    return [view for view in corner_sets[0][camera].views if view.image not in shown]


def name_boards(
    boards: Sequence[StatedBoard], shape: BoardShapeModel = BoardShapeModel.NOMINAL
) -> list[RigBoard]:
    """Return what a rig is told of the boards, whose `shape` is estimated."""
    if len(boards) == 1:
        return [RigBoard(shape=shape)]
    return [RigBoard(f"board {b + 1}", board.pose, shape) for b, board in enumerate(boards)]


def _state_first_mark(board: StatedBoard) -> StatedBoard:
    """Return a board whose marks are counted from 0 unless stated: others are other boards'."""
    match board.pattern:
        case Charuco(first_marker=None):
            return replace(board, pattern=replace(board.pattern, first_marker=0))
        case AprilGrid(first_tag=None):
            return replace(board, pattern=replace(board.pattern, first_tag=0))
        case _:
            return board


def _check_boards(boards: Sequence[StatedBoard]) -> None:
    """Refuse boards that are not stated in full, or that photographs do not tell apart."""
    stated, names = [], [board.name for board in name_boards(boards)]
    for board, name in zip(boards, names, strict=True):
        if board.grid_size is None or board.pattern is None:
            raise CalibrationError(
                f"The kind or the size of {name} is not stated.",
                "State both of each board (--target and --board on the command line).",
            )
        stated.append(Board(*board.grid_size, board.square or DEFAULT_SQUARE, board.pattern))
    check_boards_differ(stated, names)
    if boards[0].pose is not None:
        raise CalibrationError(
            f"The place of {names[0]} is stated, and all places are beside it.",
            "State those of the other boards.",
        )

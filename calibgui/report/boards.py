"""Boards in words."""

from __future__ import annotations

from calibgui.engine.boards import (
    AprilGrid,
    Board,
    Charuco,
    Circles,
    Pattern,
    PuzzleBoard,
    TaggedCheckerboard,
)

_KINDS = {
    "checkerboard": "a checkerboard",
    "charuco": "a ChArUco board",
    "circles": "a grid of circles",
    "asymmetric-circles": "an asymmetric grid of circles",
    "aprilgrid": "an AprilGrid",
    "tagged-checkerboard": "a checkerboard with AprilTags",
    "puzzleboard": "a PuzzleBoard",
}


def describe_board(board: Board) -> str:
    """Describe a board, as "ChArUco board of 6 x 8 inner corners, DICT_4X4_50, ..."."""
    rows, cols, pattern = board.rows, board.cols, board.pattern
    if isinstance(pattern, Charuco):
        text = f"ChArUco board of {rows} x {cols} inner corners"
        if pattern.dictionary is not None:
            text += f", {pattern.dictionary}"
        if pattern.marker is not None:
            text += f", markers {pattern.marker:.2f} of a square"
        legacy = not pattern.is_first_square_dark((rows, cols))
        return text + (", first square white (layout before OpenCV 4.6)" if legacy else "")
    if isinstance(pattern, Circles):
        kind = "Asymmetric" if pattern.asymmetric else "Symmetric"
        text = f"{kind} grid of {rows} x {cols} circles"
        size = pattern.diameter
        return text if size is None else f"{text}, diameter {size:.3f} of their distance"
    if isinstance(pattern, AprilGrid):
        text = f"AprilGrid of {rows / 2:g} x {cols / 2:g} tags, {rows} x {cols} corners"
        text += _describe_tags(pattern.family, pattern.border, pattern.from_top)
        if pattern.corner_squares is False:
            text += ", no dark squares between them"
        gap = pattern.spacing
        return text if gap is None else f"{text}, gap {gap:.3f} of a tag's side"
    if isinstance(pattern, TaggedCheckerboard):
        text = f"Checkerboard of {rows} x {cols} inner corners with AprilTags"
        text += _describe_tags(pattern.family, pattern.border, pattern.from_top)
        return text if pattern.step is None else f"{text}, one every {pattern.step} squares"
    if isinstance(pattern, PuzzleBoard):
        text = f"PuzzleBoard of {rows} x {cols} inner corners"
        row, col = pattern.origin
        return text if pattern.origin == (0, 0) else f"{text} from corner {row} x {col} on"
    return f"Checkerboard of {rows} x {cols} inner corners"


def _describe_tags(family: str | None, border: int | None, from_top: bool | None) -> str:
    """Describe what is known of a board's tags, as ", t36h11 with a border of 2 cells, ..."."""
    text = "" if family is None else f", {family}"
    if border is not None:
        text += f" with a border of {border} {'cell' if border == 1 else 'cells'}"
    return text + (", numbered from the top" if from_top else "")


def name_kind(pattern: Pattern) -> str:
    """Name the kind of a pattern, as "a ChArUco board"."""
    return _KINDS.get(pattern.kind, f"a board of the kind {pattern.kind}")


def describe_recognised_board(stated: Pattern, board: Board | None) -> str:
    """Describe a board of which only `stated` was given before; empty if that was all of it."""
    if board is None or board.pattern == stated:
        return ""
    return f"The photographs show: {describe_board(board)}."

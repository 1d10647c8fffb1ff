"""Boards in words."""

from __future__ import annotations

import numpy as np

from calibgui.dataset import CornerSet
from calibgui.engine.arrays import IntArray
from calibgui.engine.boards import (
    AprilGrid,
    Board,
    Charuco,
    Circles,
    ListedCircles,
    Pattern,
    PuzzleBoard,
    TaggedCheckerboard,
)

_KINDS = {
    "checkerboard": "a checkerboard",
    "charuco": "a ChArUco board",
    "circles": "a grid of circles",
    "asymmetric-circles": "an asymmetric grid of circles",
    "listed-circles": "a board of listed circles",
    "aprilgrid": "an AprilGrid",
    "tagged-checkerboard": "a checkerboard with AprilTags",
    "puzzleboard": "a PuzzleBoard",
}


def name_point(board: Board | None) -> str:
    """Name what is measured of a board: "circle" or "corner"."""
    return "corner" if board is None or board.pattern.has_squares else "circle"


def describe_board(board: Board) -> str:
    """Describe a board, as "ChArUco board of 6 x 8 inner corners, DICT_4X4_50, ..."."""
    rows, cols, pattern = board.rows, board.cols, board.pattern
    if isinstance(pattern, Charuco):
        text = f"ChArUco board of {rows} x {cols} inner corners"
        if pattern.dictionary is not None:
            text += f", {pattern.dictionary}"
        if pattern.marker is not None:
            text += f", markers {pattern.marker:.2f} of a square"
        if pattern.first_marker:
            text += f", first marker {pattern.first_marker}"
        legacy = not pattern.is_first_square_dark((rows, cols))
        return text + (", first square white (layout before OpenCV 4.6)" if legacy else "")
    if isinstance(pattern, Circles):
        kind = "Asymmetric" if pattern.asymmetric else "Symmetric"
        text = f"{kind} grid of {rows} x {cols} circles"
        size = pattern.diameter
        return text if size is None else f"{text}, diameter {size:.3f} of their distance"
    if isinstance(pattern, ListedCircles):
        text = f"Board of {len(pattern.grid)} listed circles"
        size = pattern.diameter
        return text if size is None else f"{text}, diameter {size:.3f} of their least distance"
    if isinstance(pattern, AprilGrid):
        text = f"AprilGrid of {rows / 2:g} x {cols / 2:g} tags, {rows} x {cols} corners"
        text += _describe_tags(pattern.family, pattern.border, pattern.from_top)
        if pattern.first_tag:
            text += f", first tag {pattern.first_tag}"
        if pattern.tag_turn:
            text += f", each tag turned clockwise by {90 * pattern.tag_turn} degrees"
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


def describe_recognised_board(stated: Pattern, corner_set: CornerSet) -> str:
    """Describe the board of photographs, of which only `stated` was given before; empty if that was
    all of it."""
    board = corner_set.board
    if board is None or board.pattern == stated:
        return ""
    seen = [view.corners.grid for view in corner_set.views if view.corners is not None]
    text = describe_board(board)
    if isinstance(board.pattern, PuzzleBoard) and seen:
        text = _describe_seen_part(np.concatenate(seen) + board.pattern.origin)
    return f"The photographs show: {text}."


def _describe_seen_part(grid: IntArray) -> str:
    """Describe the part of the PuzzleBoard pattern in which corners (n, 2) were seen.

    Its board is inferred from the pattern's first corner on, and may be hundreds of corners away.
    """
    (top, left), (bottom, right) = grid.min(axis=0).tolist(), grid.max(axis=0).tolist()
    return (
        f"PuzzleBoard, {bottom - top + 1} x {right - left + 1} inner corners of it: rows {top} to "
        f"{bottom}, columns {left} to {right} of the whole pattern"
    )

"""Boards in words."""

from __future__ import annotations

from calibgui.engine.boards import Board, Charuco, Circles, Pattern


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
    return f"Checkerboard of {rows} x {cols} inner corners"


def describe_recognised_board(stated: Pattern, board: Board | None) -> str:
    """Describe a board of which only `stated` was given before; empty if that was all of it."""
    if board is None or board.pattern == stated:
        return ""
    return f"The photographs show: {describe_board(board)}."

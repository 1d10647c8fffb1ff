"""A target in words."""

from __future__ import annotations

from calibgui.engine.boards import Board, Charuco, Circles, Pattern


def described(board: Board) -> str:
    """What the target is, as "ChArUco board of 6 x 8 inner corners, DICT_4X4_50, ..."."""
    rows, cols, pattern = board.rows, board.cols, board.pattern
    if isinstance(pattern, Charuco):
        text = f"ChArUco board of {rows} x {cols} inner corners"
        if pattern.dictionary is not None:
            text += f", {pattern.dictionary}"
        if pattern.marker is not None:
            text += f", markers {pattern.marker:.2f} of a square"
        legacy = not pattern.first_dark((rows, cols))
        return text + (", first square white (layout before OpenCV 4.6)" if legacy else "")
    if isinstance(pattern, Circles):
        kind = "Asymmetric" if pattern.asymmetric else "Symmetric"
        text = f"{kind} grid of {rows} x {cols} circles"
        size = pattern.diameter
        return text if size is None else f"{text}, diameter {size:.3f} of their distance"
    return f"Checkerboard of {rows} x {cols} inner corners"


def learnt(stated: Pattern, board: Board | None) -> str:
    """In words the target of which only `stated` was given before; empty if nothing was open."""
    if board is None or board.pattern == stated:
        return ""
    return f"The photographs show: {described(board)}."

"""Sentences for the user about boards that were found or refused, with what to do next."""

from __future__ import annotations

from calibgui.engine.arrays import GreyImage, GridSize
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.errors import NoBoardError, OtherSizeError
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices.prefilter import LIKE_DOTS, OBJECTIONS_TO_CIRCLES, Refusal

_CHECK_SIZE = (
    "Check the stated number of inner corners, rows x columns, or leave it out; if it is right,"
    " take the picture again with nothing on the board's outermost squares."
)


def describe_other_sizes(
    grey: GreyImage, boards: list[Lattice], grid_size: GridSize, circle: ImageCircle | None
) -> OtherSizeError:
    """Return an error that says what was found instead of the stated board."""
    sizes = [tuple(sorted(board.shape)) for board in boards]
    stated = f"not {grid_size[0]} x {grid_size[1]}"
    if len(sizes) > 1:
        seen = ", ".join(f"{rows} x {cols}" for rows, cols in sizes)
        return OtherSizeError(f"The boards here have {seen} inner corners, {stated}.", _CHECK_SIZE)
    least = "" if all(board_ends.find_ends(boards[0], grey, circle)) else "at least "
    rows, cols = sizes[0]
    return OtherSizeError(
        f"This board has {least}{rows} x {cols} inner corners, {stated}.", _CHECK_SIZE
    )


def describe_refusal(refusal: Refusal) -> NoBoardError:
    """Return an error that says which test refused what looked like a board."""
    rows, cols = sorted(refusal.shape)
    hint = (
        "Mark its four outermost corners, or leave this picture out; where marks are drawn over the"
        " corners, take the original."
    )
    if refusal.reason in OBJECTIONS_TO_CIRCLES:
        hint = (
            "For a grid of circles, or a board with markers, choose that pattern. For a"
            f" checkerboard, {hint[:1].lower()}{hint[1:]}"
        )
    if refusal.reason == LIKE_DOTS:
        hint = (
            "If it is one of uneven squares, state its number of inner corners, rows x columns."
            f" Else {hint[:1].lower()}{hint[1:]}"
        )
    return NoBoardError(
        f"What looks like a checkerboard of {rows} x {cols} inner corners is not trusted:"
        f" {refusal.reason}.",
        hint,
    )


def describe_misfit(grid_size: GridSize) -> NoBoardError:
    """Return an error that says that nothing was found at the marked points."""
    return NoBoardError(
        f"No board of {grid_size[0]} x {grid_size[1]} inner corners fits the four marked points.",
        "Mark the four outermost inner corners, in order around the board, and check their stated"
        " number, rows x columns.",
    )


def describe_cut(shape: tuple[int, int]) -> str:
    """Return a sentence that says of which lattice a board is a part."""
    rows, cols = sorted(shape)
    return (
        f"{rows} x {cols} corners join here and were cut where two boards seem to meet; if"
        " they are one, flatten it, or mark its outermost corners and state its size."
    )


def describe_continuation(grey: GreyImage, lattice: Lattice) -> str:
    """Return a sentence that says where a lattice taken for all of a board seems to go on, empty if
    it does not."""
    top, right, bottom, left = board_ends.find_continuing_sides(lattice, grey)
    if not (top or right or bottom or left):
        return ""
    rows, cols = lattice.shape
    counted = sorted(lattice.shape)
    larger = sorted((rows + top + bottom, cols + left + right))
    return (
        f"Beyond the {counted[0]} x {counted[1]} corners taken here, a line of squares looks like"
        f" the board's own: if it has {larger[0]} x {larger[1]} corners or more, state its size."
    )

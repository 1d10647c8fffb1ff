"""The board that photographs agree on: its rows and columns, and its kind in detail.

If the size of the board is not given, it is the most frequent one of completely seen boards, or
that of a part which several photographs share. Unknown properties of a pattern, such as the
dictionary of its markers, are inferred in the same way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import AprilGrid, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import Corners
from calibgui.engine.lattices import LIKE_DOTS

_MIN_PARTS = 3
"""Number of photographs in which the largest part of a board has one size, from which it counts as
the board: something covers some corners in each of them. Parts that the image cuts, or that end
where something begins, are of many sizes."""


class SharedBoard(NamedTuple):
    """The board that photographs agree on."""

    grid_size: GridSize | None
    """Rows and columns; None if the photographs do not tell them."""
    pattern: Pattern
    """The stated pattern, completed from the photographs."""
    remark: str = ""
    """A sentence on how the size was inferred, where the user should check it; mostly empty."""


def agree_on_board(
    views: Sequence[View], grid_size: GridSize | None, pattern: Pattern
) -> SharedBoard:
    """Return the board that the photographs agree on.

    Args:
        views: the photographs, searched.
        grid_size: rows and columns as stated; None if the photographs are to tell them.
        pattern: the pattern as stated.
    """
    completed = infer_pattern(views, pattern)
    if (size := grid_size or infer_grid_size(views)) is not None:
        return SharedBoard(size, completed)
    if (part := find_shared_part(views)) is None:
        return SharedBoard(None, completed)
    remark = (
        f"No picture shows every corner of the board. It counts as {part[0]} x {part[1]}, the "
        "largest part seen, which several pictures share; state its size if it has more."
    )
    return SharedBoard(part, completed, remark)


def infer_grid_size(views: Iterable[View]) -> GridSize | None:
    """Return the most frequent grid size of completely seen boards; of equals, the largest.

    If the corners identify themselves, the largest part seen is taken. A grid of circles counts as
    complete where a few are covered, and as a part where it may go on outside of its image. A size
    is none if more photographs show a part that is larger: a board may look complete where a shadow
    or the image's edge hides its next corners. None if there is no board.
    """
    found = [view.corners for view in views if view.corners is not None]
    if found and all(corners.pattern.identifies_points for corners in found):
        first = _get_first_tag(infer_pattern(views, found[0].pattern))
        return measure_largest_part([c for c in found if _get_first_tag(c.pattern) == first])
    whole = Counter(
        corners.shape
        for corners in found
        if not corners.relative and (corners.complete or not corners.pattern.has_squares)
    )
    for size in sorted(whole, key=lambda size: (whole[size], size[0] * size[1]), reverse=True):
        if sum(_is_larger(corners.shape, size) for corners in found) <= whole[size]:
            return size
    return None


def _is_larger(part: GridSize, size: GridSize) -> bool:
    """Return whether a part has more corners than a board of a size, one way or the other."""
    return any(seen > most for seen, most in zip(sorted(part), sorted(size), strict=True))


def measure_largest_part(found: Sequence[Corners]) -> GridSize | None:
    """Return the most rows and columns seen in parts of a board; None if there are no parts."""
    rows, cols = (max((corners.shape[i] for corners in found), default=0) for i in (0, 1))
    return (rows, cols) if rows and cols else None


def find_shared_part(views: Iterable[View]) -> GridSize | None:
    """Return the size of the largest part of a board, if many photographs show just that much."""
    parts = [view.corners for view in views if view.corners is not None]
    largest = measure_largest_part(parts)
    shared = sum(corners.shape == largest for corners in parts)
    return largest if shared >= _MIN_PARTS else None


def infer_pattern(views: Iterable[View], stated: Pattern) -> Pattern:
    """Return the `stated` pattern, with unknown properties as the images show them."""
    found = [view.corners.pattern for view in views if view.corners is not None]
    return stated.complete_from([pattern for pattern in found if pattern.kind == stated.kind])


def _get_first_tag(pattern: Pattern) -> int:
    """Return the number of the first tag of an AprilGrid; 0 for other boards."""
    return (pattern.first_tag or 0) if isinstance(pattern, AprilGrid) else 0


def list_worth_searching_again(
    views: Sequence[View], board: SharedBoard, grid_size: GridSize | None, pattern: Pattern
) -> list[int]:
    """List the views whose corners a search for the shared board can change.

    They are none where nothing is known that was not stated: a size or a first tag.

    Args:
        views: the photographs, searched for what was stated.
        board: what they agree on.
        grid_size: rows and columns as stated, if they were.
        pattern: the pattern as stated.
    """
    is_counted = grid_size is None and board.grid_size is not None
    is_renumbered = _get_first_tag(board.pattern) != _get_first_tag(pattern)
    if board.grid_size is None or not (is_counted or is_renumbered):
        return []
    return [k for k, view in enumerate(views) if _may_change(view, board.grid_size, board.pattern)]


def _may_change(view: View, grid_size: GridSize, pattern: Pattern) -> bool:
    """Return whether a search for the known board can change the corners of a view."""
    if view.corners is not None:
        is_numbered_alike = _get_first_tag(view.corners.pattern) == _get_first_tag(pattern)
        return view.corners.shape != grid_size or view.corners.relative or not is_numbered_alike
    is_easier = (
        view.roi is not None
        or pattern.identifies_points
        or not pattern.has_squares
        or LIKE_DOTS in view.reason
    )
    return view.status is ViewStatus.NO_BOARD and is_easier


def explain_unknown_size(views: Iterable[View], pattern: Pattern) -> CalibrationError | None:
    """Return the error that the images do not tell the size of the board in them: they show parts
    of it only, or end where a grid of circles may go on. None if they do, or no board is seen."""
    views = tuple(views)
    found = [view.corners for view in views if view.corners is not None]
    largest = measure_largest_part(found)
    if largest is None or infer_grid_size(views) or find_shared_part(views):
        return None
    is_open = any(corners.relative for corners in found)
    rows, cols = largest
    shown = "where the grid ends on all sides" if is_open else "the whole board"
    points = "inner corners" if pattern.has_squares else "circles"
    remedy = (
        f"State the size of the board: {rows} x {cols} if nothing of it lies beyond that part, "
        f"else count its {points}"
    )
    if not pattern.has_squares:
        remedy += " and take pictures that show its whole border"
    return CalibrationError(
        f"No picture shows {shown}, so its size is not known: the largest part seen has {rows} x "
        f"{cols} {points}.",
        f"{remedy}.",
    )

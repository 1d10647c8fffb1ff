"""From an image to numbered, refined and verified corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.corners import chance, harris, verify
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.finder import Candidate, find_boards
from calibgui.engine.corners.lattice import MIN_LINES, Lattice
from calibgui.engine.corners.located import METHODS, Located, guided, locate
from calibgui.engine.corners.ordering import (
    Numbering,
    ambiguity,
    numberings,
    place,
    relative,
)
from calibgui.engine.errors import NoBoardError
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, Board, Corners, OtherBoard

_SMALLEST = 16
"""Short side of an image that can show a board, px."""
_STATE_SIZE = "State the number of inner corners, rows x columns, or leave it out."


class _OtherSizeError(NoBoardError):
    """There are boards, but none of the stated size."""


def find_corners(
    image: npt.ArrayLike,
    board: Board | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of the checkerboard in an image.

    Args:
        image: (h, w) grey levels, uint8, uint16 or floating.
        board: rows and columns of inner corners; inferred if None. A board of which only a part
            is seen then counts as what is seen of it.
        roi: (4, 2) px, points at or just outside the board's outermost corners, in order around
            it: only corners inside count, and where the pattern leaves the origin open it is the
            corner nearest to the first point.
        method: "edges", the edge model at the Cramer-Rao bound, with covariances; or "saddle",
            the paper's.

    Returns:
        The corners, right-handed in the image, from an origin whose outer square is dark. Of a
        board that is only partly seen `complete` is false, and `relative` is true where its
        rows or columns could be counted otherwise. Corners seen but not trusted are `rejected`
        with the reason; further boards are in `others`, but for those of much smaller squares:
        these are looked for only until the wanted board is found.

    Raises:
        NoBoardError: no acceptable board, why, and what was found instead.
        ValueError: arguments that make no sense.
    """
    if method not in METHODS:
        raise ValueError(f"method {method!r} is none of {', '.join(METHODS)}")
    if board is not None and min(board) < MIN_LINES:
        raise ValueError(f"a board needs {MIN_LINES} x {MIN_LINES} inner corners, not {board}")
    grey = grey_levels(image)
    outline = None if roi is None else region.outline(roi)
    others: list[Located] = []
    try:
        found, others = _automatic(grey, board, outline, method)
    except NoBoardError as error:
        if outline is None or board is None:
            raise
        marked = guided(grey, board, outline, method)
        if marked is None:
            raise error if isinstance(error, _OtherSizeError) else _misfit(board) from None
        found = marked
    return record(grey, found, _numbered(grey, found.lattice, board, outline), outline, others)


def grey_levels(image: npt.ArrayLike) -> Image:
    """The image (h, w) as uint8, uint16 or float32. Raises ValueError for what is none."""
    grey = np.asarray(image)
    if grey.ndim != 2:
        raise ValueError(f"an image of grey levels (h, w) is needed, not of shape {grey.shape}")
    if min(grey.shape) < _SMALLEST:
        raise NoBoardError(
            f"An image of {grey.shape[1]} x {grey.shape[0]} pixels is too small for a board.",
            "Take the original picture, not a thumbnail of it.",
        )
    if grey.dtype in (np.uint8, np.uint16):
        return np.ascontiguousarray(grey)
    grey = np.ascontiguousarray(grey, dtype=np.float32)
    if not np.isfinite(grey).all():
        raise ValueError("the image has grey levels that are not finite")
    return grey


def _automatic(
    grey: Image, board: Board | None, outline: Array | None, method: str
) -> tuple[Located, list[Located]]:
    """The wanted board, that with the most edge of those that may be of the stated size if there
    is one, and the others."""
    boards: list[Located] = []
    tried: dict[Candidate, Located | None] = {}
    for candidates in find_boards(grey, None if outline is None else region.enlarged(outline)):
        for one in candidates:
            if one not in tried:
                tried[one] = _accepted(grey, one, method)
        boards = [found for one in candidates if (found := tried[one])]
        boards.sort(key=lambda found: found.edge, reverse=True)
        for wanted in boards:
            if board is None or _fits(grey, wanted.lattice, board):
                return wanted, [found for found in boards if found is not wanted]
    if boards and board is not None:
        raise _another_size(grey, boards, board)
    if tried:
        raise NoBoardError(
            "What looks like a checkerboard is not regular enough to be trusted.",
            "Mark its four outermost corners, or leave this picture out. For a grid of circles,"
            " state that target; where marks are drawn over the corners, take the original.",
        )
    raise NoBoardError(
        "No checkerboard was found.",
        "Mark its four outermost corners, or take the picture again: all of the board in"
        " view, sharp and evenly lit.",
    )


def _accepted(grey: Image, candidate: Candidate, method: str) -> Located | None:
    """The board that a candidate is, None if it is none or may be one by chance."""
    found = locate(grey, candidate.lattice, method)
    good = found and chance.meaningful(found.lattice.found, candidate.others)
    return found if good else None


def _another_size(grey: Image, boards: list[Located], board: Board) -> _OtherSizeError:
    """What was found instead of the stated board."""
    sizes = [tuple(sorted(found.lattice.shape)) for found in boards]
    stated = f"not {board[0]} x {board[1]}"
    if len(sizes) > 1:
        seen = ", ".join(f"{rows} x {cols}" for rows, cols in sizes)
        return _OtherSizeError(f"The boards here have {seen} inner corners, {stated}.", _STATE_SIZE)
    least = "" if all(verify.ends(boards[0].lattice, grey)) else "at least "
    rows, cols = sizes[0]
    return _OtherSizeError(
        f"This board has {least}{rows} x {cols} inner corners, {stated}.", _STATE_SIZE
    )


def _fits(grey: Image, lattice: Lattice, board: Board) -> bool:
    """Whether `lattice` may be a board of the stated size, or a part of it.

    It may be smaller only along an axis at one end of which the board was not seen to end.
    """
    top, right, bottom, left = verify.ends(lattice, grey)
    whole = (top and bottom, left and right)
    return any(
        all(
            have == want or (have < want and not seen)
            for have, want, seen in zip(lattice.shape, size, whole, strict=True)
        )
        for size in (board, board[::-1])
    )


def _misfit(board: Board) -> NoBoardError:
    """Nothing was found at the marked points."""
    return NoBoardError(
        f"No board of {board[0]} x {board[1]} inner corners fits the four marked points.",
        "Mark the four outermost inner corners, in order around the board. " + _STATE_SIZE,
    )


def _numbered(
    grey: Image, lattice: Lattice, board: Board | None, outline: Array | None
) -> list[Numbering]:
    """The lattice's numberings, the preferred first: of those that only a look at the marked
    points can tell apart the one that starts at the first of them."""
    if board is None or sorted(board) == sorted(lattice.shape):
        numbered = numberings(lattice, board)
    else:
        numbered = numberings(lattice, board, verify.ends(lattice, grey))
    if outline is not None:
        numbered.sort(key=lambda way: not region.starts_at(way.lattice, outline[0]))
    return numbered


def record(
    grey: Image,
    found: Located,
    numbered: list[Numbering],
    outline: Array | None,
    others: list[Located],
) -> Corners:
    """What is handed out."""
    chosen = numbered[0]
    grid, uv, order = place(chosen)
    corners = Corners(
        shape=chosen.board,
        grid=grid,
        uv=uv,
        estimate=harris.first_estimates(grey, uv, chosen.lattice.spacing()[chosen.lattice.found]),
        ambiguity=ambiguity(chosen.board),
        roi=region.around(chosen.lattice) if outline is None else outline,
        method="saddle",
        relative=relative(numbered),
        rejected=found.rejected,
        others=tuple(map(_other, others)),
    )
    fit = found.fit
    if fit is None:
        return corners
    return replace(
        corners,
        method="edges",
        uv=fit.uv[order],
        cov=fit.covariance[order],
        blur=fit.blur[order],
        contrast=fit.contrast[order],
        residual=fit.residual[order],
    )


def _other(board: Located) -> OtherBoard:
    first = numberings(board.lattice, None)[0].lattice
    return OtherBoard(first.shape, region.around(first))

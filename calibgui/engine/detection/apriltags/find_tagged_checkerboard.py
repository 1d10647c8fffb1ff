"""The detector of checkerboards with AprilTags in some of their dark squares.

1. The search for checkerboards (`pyramid_search`) finds lattices that may be boards.
2. The dark squares of a lattice are read as tags (`tag_reader`). Those that stand where their
   numbers say (`tag_places`) place the lattice on the board: no pattern stands there by chance, and
   the tests by which a plain checkerboard is told from a texture are not asked. Tags that are too
   small for that place a lattice on a stated board all together (`lattice_placement`).
3. The corners are refined, verified and fitted (`tagged_corners`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.boards.april_grid import MAX_BORDER
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard, count_tagged_squares
from calibgui.engine.detection.apriltags.tag_places import PlacedTags, place_tags
from calibgui.engine.detection.apriltags.tag_reader import (
    TagPrint,
    TagReader,
    list_prints,
    rate_borders,
    rate_tags,
)
from calibgui.engine.detection.apriltags.tagged_corners import (
    fit_tagged_corners,
    list_tags,
    refine_tagged_corners,
)
from calibgui.engine.detection.charuco.assembly import assemble_corners
from calibgui.engine.detection.charuco.lattice_placement import MarkedBoard, place_by_marks
from calibgui.engine.detection.detector_io import check_grey_levels, invert_levels
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice, compute_filled_share, cut_middle
from calibgui.engine.features.saddle import refine_lattice
from calibgui.engine.lattices import region_of_interest as region
from calibgui.engine.lattices.numbering import turn_lattice
from calibgui.engine.lattices.pyramid_search import (
    MIN_JUDGED_CORNERS,
    Candidate,
    find_candidates,
    find_same,
)

_BARE_REACH = 1 / 8
"""How far from the corners nothing is printed, squares: the narrowest border of a tag, one of the
eight cells of t36h11."""
_MAX_LOOKED_AT, _MIN_SEEN_SHARE = 256, 0.5
"""Number of corners, in the middle of a lattice of hundreds, between which tags are looked for
before it grows, and the least share of them that are not hidden: a texture's has none, and to grow,
refine and read all of it would take longer than all else."""
_MAX_OVERSIZE = 3.0
"""Number of corners of a lattice, over those of a stated board, from which on it is not placed on
it by all tags together (`lattice_placement`): most of its squares would lie beside the board."""


def find_tagged_checkerboard(
    image: npt.ArrayLike,
    pattern: TaggedCheckerboard,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of a checkerboard with tags in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    searched = None if outline is None else region.enlarge_outline(outline)
    tried: list[Candidate] = []
    make_negative = cache(lambda: invert_levels(grey))  # for the candidates that are asked for it
    are_tags_stated = None not in (pattern.family, pattern.step)
    may_show_tags = False  # those of a lattice that grows were read

    def is_other(lattice: Lattice, _: int) -> bool:
        nonlocal may_show_tags
        if may_show_tags or len(lattice) < MIN_JUDGED_CORNERS:
            return False
        looked_at = lattice
        if grid_size is None or not are_tags_stated:
            looked_at = _cut_looked_at(lattice)
        elif len(lattice) < _MAX_OVERSIZE * grid_size[0] * grid_size[1]:
            return False  # its tags need not be read one by one
        may_show_tags = _may_show_tags(grey, make_negative, looked_at, pattern)
        return not may_show_tags

    for candidates in find_candidates(grey, searched, bare_reach=_BARE_REACH, is_other=is_other):
        for candidate in candidates:
            if find_same(candidate, tried):
                continue
            tried.append(candidate)
            if candidate.is_other:
                continue
            board = _identify_board(grey, make_negative, candidate.lattice, pattern, grid_size)
            if board is not None:
                return _locate_corners(grey, *board, outline, method)
    if tried:
        raise NoBoardError(
            "A checkerboard was found, but no tags in its dark squares that tell its corners.",
            "State the board, tag family and size as printed, or leave them out; for tags to be"
            " read, take the picture from nearer.",
        )
    raise NoBoardError(
        "No checkerboard with tags was found.",
        "Take the picture again: sharp, evenly lit, and more of the board in view.",
    )


def _cut_looked_at(lattice: Lattice) -> Lattice:
    """Cut the middle of a lattice, where tags are looked for before it grows."""
    return cut_middle(lattice, int(np.sqrt(_MAX_LOOKED_AT / compute_filled_share(lattice))))


def _may_show_tags(
    grey: GreyImage,
    make_negative: Callable[[], GreyImage],
    lattice: Lattice,
    pattern: TaggedCheckerboard,
) -> bool:
    """Return whether tags are read in a lattice that may be part of another, or too much is hidden
    there to tell; the arguments are those of `_identify_board`."""
    if len(lattice) < _MIN_SEEN_SHARE * _MAX_LOOKED_AT:
        return True
    refined, _ = refine_lattice(grey, lattice, bare_reach=_BARE_REACH)
    prints = list_prints(pattern.family, pattern.border)
    return any(
        len(reader.read(tag_print).which)
        for _, reader in _list_readers(grey, make_negative, refined)
        for tag_print in prints
    )


def _identify_board(
    grey: GreyImage,
    make_negative: Callable[[], GreyImage],
    lattice: Lattice,
    pattern: TaggedCheckerboard,
    grid_size: GridSize | None,
) -> tuple[Lattice, TaggedCheckerboard] | None:
    """Identify a lattice by the tags in its dark squares, or in its bright ones, printed inversely.

    Args:
        grey: (h, w) grey levels.
        make_negative: makes its negative, once.
        lattice: corners.
        pattern: what is stated of the board.
        grid_size: rows and columns of corners, if stated.

    Returns:
        The lattice as the whole board, its first corner in row and column 0, and the pattern;
        None if it does not show such a board.
    """
    for squares, reader in _list_readers(grey, make_negative, lattice):
        boards = [
            board
            for tag_print in list_prints(pattern.family, pattern.border)
            for board in _place_on_boards(lattice, reader, squares, tag_print, pattern, grid_size)
        ]
        if boards:
            # With a border of the wrong width some of the tags are read all the same.
            best = max(boards, key=lambda board: board.rating)
            return best.lattice, best.pattern
    return _place_by_all_tags(grey, lattice, pattern, grid_size)


def _list_readers(
    grey: GreyImage, make_negative: Callable[[], GreyImage], lattice: Lattice
) -> Iterator[tuple[IntArray, TagReader]]:
    """List the squares (n, 2) of a lattice that may be tags with their reader, the dark ones and
    then the bright ones in the negative; most are filled evenly."""
    for is_inverted in (False, True):
        image = make_negative() if is_inverted else grey
        squares, quads = _list_dark_squares(_exchange_colours(lattice) if is_inverted else lattice)
        may_be_tags = np.isfinite(rate_borders(image, quads))
        yield squares[may_be_tags], TagReader(image, quads[may_be_tags])


def _place_by_all_tags(
    grey: GreyImage, lattice: Lattice, pattern: TaggedCheckerboard, grid_size: GridSize | None
) -> tuple[Lattice, TaggedCheckerboard] | None:
    """Place a lattice on a stated board by all of its tags together, which are too small to be read
    one by one; None if it is not there, or not stated."""
    if grid_size is None or pattern.family is None or pattern.step is None:
        return None
    borders = range(1, MAX_BORDER + 1) if pattern.border is None else (pattern.border,)
    orders = (False, True) if pattern.from_top is None else (pattern.from_top,)
    for border, from_top in product(borders, orders):
        stated = replace(pattern, border=border, from_top=from_top)
        first_dark = stated.is_first_square_dark(grid_size)
        tags = list_tags(stated, grid_size)
        for seen_dark in (first_dark, not first_dark):  # printed inversely
            placed = place_by_marks(grey, lattice, MarkedBoard(grid_size, seen_dark, tags))
            if placed is not None:
                return placed, stated
    return None


class _IdentifiedBoard(NamedTuple):
    """A lattice as the board that its tags say it is."""

    rating: float
    """Number of tags that agree, each counting by how well it shows its number."""
    lattice: Lattice
    pattern: TaggedCheckerboard


def _place_on_boards(
    lattice: Lattice,
    reader: TagReader,
    squares: IntArray,
    tag_print: TagPrint,
    pattern: TaggedCheckerboard,
    grid_size: GridSize | None,
) -> Iterator[_IdentifiedBoard]:
    """Place a lattice on the boards that the tags of one print, read in `squares` (n, 2), allow."""
    tags = reader.read(tag_print)
    for turn in np.unique(tags.turns).tolist():
        upright = tags.select(tags.turns == turn)
        turned = turn_squares(squares[upright.which], lattice.shape, turn)
        cols = _count_tags_in_row(pattern, grid_size)
        placed = place_tags(upright.numbers, turned, cols, pattern.from_top, pattern.step)
        if placed is None:
            continue
        board = _place_lattice(turn_lattice(lattice, turn), upright.numbers, placed, grid_size)
        if board is None:
            continue
        which = upright.which[placed.agree]
        quads = reader.quads[which[:, None], (np.arange(4) + turn) % 4]
        rates = rate_tags(reader.image, quads, tag_print, upright.numbers[placed.agree])
        yield _IdentifiedBoard(float(rates.sum()), board, _describe_pattern(tag_print, placed))


def _exchange_colours(lattice: Lattice) -> Lattice:
    """Return the lattice with dark squares for bright ones."""
    return Lattice(lattice.uv, not lattice.dark)


def _list_dark_squares(lattice: Lattice) -> tuple[IntArray, Array]:
    """List row and column (n, 2) of the dark squares between four corners of a lattice, and these
    corners (n, 4, 2) px, from the upper left one in the sense from u to v."""
    uv = lattice.uv
    quads = np.stack([uv[:-1, :-1], uv[:-1, 1:], uv[1:, 1:], uv[1:, :-1]], axis=2)
    parity = np.indices(quads.shape[:2]).sum(axis=0) % 2 == 1
    chosen = np.isfinite(quads).all(axis=(2, 3)) & (lattice.dark ^ parity)
    return np.argwhere(chosen), quads[chosen]


def turn_squares(squares: IntArray, shape: GridSize, quarters: int) -> IntArray:
    """Return row and column (n, 2) of squares after their lattice of rows x columns corners is
    turned by quarters counter-clockwise."""
    rows, cols = shape[0] - 1, shape[1] - 1
    for _ in range(quarters):
        squares = np.column_stack([cols - 1 - squares[:, 1], squares[:, 0]])
        rows, cols = cols, rows
    return squares


def _count_tags_in_row(pattern: TaggedCheckerboard, grid_size: GridSize | None) -> int | None:
    """Return how many tags a row of the board has, None if that is not stated."""
    if grid_size is None or pattern.step is None:
        return None
    return count_tagged_squares(grid_size, pattern.step)[1]


def _place_lattice(
    lattice: Lattice, numbers: IntArray, placed: PlacedTags, grid_size: GridSize | None
) -> Lattice | None:
    """Place a lattice whose tags stand upright on the whole board.

    Without a stated size the board is as large as the tags and the corners seen require.

    Returns:
        None if a tag that was read lies outside of the stated size.
    """
    layout, step, (row, col) = placed.layout, placed.step, placed.origin.tolist()
    tag_rows = int(np.max(numbers[placed.agree] // layout.cols)) + 1
    rows = max(step * (tag_rows - 1) + 2, lattice.shape[0] - row if layout.from_top else row + 2)
    cols = max(step * (layout.cols - 1) + 2, lattice.shape[1] - col)
    if grid_size is not None:
        if step * (tag_rows - 1) + 2 > grid_size[0]:
            return None
        if layout.cols != count_tagged_squares(grid_size, step)[1]:
            return None
        rows, cols = grid_size
    # Corner (0, 0) of the board in rows and columns of the lattice.
    top, left = (row if layout.from_top else row + 2 - rows), col
    uv = np.full((rows, cols, 2), np.nan)
    cells = np.argwhere(lattice.found)
    at = cells - (top, left)
    inside = ((at >= 0) & (at < (rows, cols))).all(axis=1)
    uv[tuple(at[inside].T)] = lattice.uv[tuple(cells[inside].T)]
    return Lattice(uv, lattice.dark ^ bool((top + left) % 2))


def _describe_pattern(tag_print: TagPrint, placed: PlacedTags) -> TaggedCheckerboard:
    """Return the pattern that was read."""
    return TaggedCheckerboard(
        tag_print.family, tag_print.border, placed.step, placed.layout.from_top
    )


def _locate_corners(
    grey: GreyImage,
    board: Lattice,
    pattern: TaggedCheckerboard,
    outline: Array | None,
    method: str,
) -> Corners:
    """Refine, verify and fit the corners of an identified board, and those beside them."""
    tag_print = TagPrint(str(pattern.family), pattern.border or 1)
    bare_reach = tag_print.border / tag_print.side
    lattice, rejected = refine_tagged_corners(grey, board, bare_reach)
    fit = None
    if method == "edges":
        lattice, fit, failing = fit_tagged_corners(grey, lattice, pattern, bare_reach)
        rejected += failing
    return assemble_corners(grey, lattice, fit, outline, rejected, pattern)

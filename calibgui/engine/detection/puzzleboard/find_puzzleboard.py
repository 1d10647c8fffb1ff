"""The detector of PuzzleBoards: a checkerboard, numbered by the dots on its edges.

The corners are found, refined and verified as those of a checkerboard, by what lies nearer to them
than the dots. These then tell which part of the pattern is seen (`dot_levels`, `place_decoding`). A
lattice whose dots leave that open is refused rather than numbered by guess.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.detection.checkerboard.board_refinement import RefinedBoard, refine_board
from calibgui.engine.detection.checkerboard.find_checkerboard import assemble_corners
from calibgui.engine.detection.detector_io import check_grey_levels
from calibgui.engine.detection.puzzleboard.dot_levels import measure_dots
from calibgui.engine.detection.puzzleboard.dot_removal import BARE_REACH, remove_blurred_dots
from calibgui.engine.detection.puzzleboard.place_decoding import (
    Place,
    StatedBoard,
    are_there_dots,
    find_place_of_print,
    is_certain,
    may_be_dots,
)
from calibgui.engine.errors import MirroredError, NoBoardError
from calibgui.engine.features.corners import METHODS, Corners
from calibgui.engine.features.lattice import (
    Lattice,
    compute_filled_share,
    cut_middle,
    is_large_enough,
    is_part,
    is_scattered,
)
from calibgui.engine.features.saddle import refine_lattice
from calibgui.engine.lattices import a_contrario
from calibgui.engine.lattices import region_of_interest as region
from calibgui.engine.lattices.lattice_growth import MIN_FILLED_IN_TEXTURE
from calibgui.engine.lattices.numbering import Numbering, turn_lattice
from calibgui.engine.lattices.prefilter import MIN_CORNERS_TO_TELL, Refusal
from calibgui.engine.lattices.pyramid_search import Candidate, find_candidates, find_same

_MAX_SHOWN_LINES = 6
"""Greatest number of rows, and of columns, of a lattice without dots that are verified to say that
it is a board: it bounds the time."""
_MAX_COMPARED = 800
"""Number of corners of a large lattice between which dots are looked for: what is read in the
"halftone" of `tests.scenes.without_board` passes for dots of the pattern between up to 550."""
_MIN_SEEN_SHARE = 0.4
"""Least share of these that are seen in the middle, if it is to tell."""


@dataclass(frozen=True, eq=False, slots=True)
class _PlacedBoard:
    """A verified board and the likeliest place of its corners on the pattern."""

    board: RefinedBoard
    place: Place
    is_mirrored: bool
    """True if only the mirror image of the dots has a place."""


def find_puzzleboard(
    image: npt.ArrayLike,
    pattern: PuzzleBoard,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the corners of a PuzzleBoard in an image; see ``find_corners``.

    Without `grid_size` a board from the pattern's origin to the last row and column seen is
    returned.
    """
    if method not in METHODS:
        raise ValueError(f"method {method!r} is none of {', '.join(METHODS)}")
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    stated = None if grid_size is None else StatedBoard(pattern.origin, grid_size)
    placed, bare = _find_boards(grey, outline, method, stated)
    readable = [each for each in placed if is_certain(each.place) and not each.is_mirrored]
    if not readable:
        raise _explain_missing_board(grey, placed, bare)
    wanted = max(readable, key=lambda each: each.board.edge_strength)
    others = [each.board for each in placed if each is not wanted]
    return _number_corners(grey, wanted, pattern, grid_size, outline, others)


def _find_boards(
    grey: GreyImage, outline: Array | None, method: str, stated: StatedBoard | None
) -> tuple[list[_PlacedBoard], list[Candidate]]:
    """Find the boards in an image and their places, until one can be read.

    A lattice without dots is no PuzzleBoard, whatever its corners are worth: it is not verified,
    which in a texture of thousands of crossings would take long.

    Args:
        grey: (h, w) grey levels.
        outline: (4, 2) px, the region to search, None for all of the image.
        method: one of `METHODS`.
        stated: the part of the pattern that is expected, None if that is open.

    Returns:
        The boards, and the candidates without dots.
    """
    searched = None if outline is None else region.enlarge_outline(outline)
    tried: dict[Candidate, _PlacedBoard | None] = {}
    placed: list[_PlacedBoard] = []
    bare: list[Candidate] = []

    def is_other(lattice: Lattice, depth: int) -> bool:
        return _lacks_dots(lattice, grey, depth)

    for candidates in find_candidates(grey, searched, bare_reach=BARE_REACH, is_other=is_other):
        for candidate in candidates:
            if candidate in tried:
                continue
            same = find_same(candidate, (each for each in tried if tried[each] is None))
            tried[candidate] = _find_known(candidate.lattice, placed)
            if same or tried[candidate]:
                continue
            if not candidate.is_other and _may_show_dots(candidate.lattice, grey):
                lattice, _ = refine_lattice(grey, candidate.lattice, bare_reach=BARE_REACH)
                tried[candidate] = _verify_lattice(grey, lattice, candidate.others, method, stated)
            else:
                bare.append(candidate)
        placed = [*dict.fromkeys(each for candidate in candidates if (each := tried[candidate]))]
        if any(is_certain(each.place) for each in placed):
            break
    return placed, bare


def _lacks_dots(lattice: Lattice, grey: GreyImage, depth: int) -> bool:
    """Return whether a lattice that a level of a depth shows is large enough to tell that it has no
    dots: the corners of a small one of a coarser level may be off."""
    if len(lattice) >= _MIN_SEEN_SHARE * _MAX_COMPARED:
        return not _may_show_dots(lattice, grey)
    is_large = len(lattice) >= MIN_CORNERS_TO_TELL
    return depth == 0 and is_large and not are_there_dots(measure_dots(grey, lattice))


def _may_show_dots(lattice: Lattice, grey: GreyImage) -> bool:
    """Return whether there may be dots between the corners of a lattice: those in its middle, if
    they are not mostly hidden, since all may be thousands."""
    middle = cut_middle(lattice, int(np.sqrt(_MAX_COMPARED / compute_filled_share(lattice))))
    part = middle if len(middle) >= _MIN_SEEN_SHARE * _MAX_COMPARED else lattice
    return may_be_dots(measure_dots(grey, refine_lattice(grey, part, bare_reach=BARE_REACH)[0]))


def _find_known(lattice: Lattice, placed: list[_PlacedBoard]) -> _PlacedBoard | None:
    """Find the board that a lattice shows no more of, if it is placed already."""
    for each in placed:
        if len(lattice) <= len(each.board) and is_part(lattice, each.board.lattice):
            return each
    return None


def _verify_lattice(
    grey: GreyImage, lattice: Lattice, others: int, method: str, stated: StatedBoard | None
) -> _PlacedBoard | None:
    """Return the board that a refined lattice beside `others` junctions is, None if it is none or
    may be one by chance."""
    board = refine_board(remove_blurred_dots(grey, lattice, stated), lattice, method, BARE_REACH)
    if isinstance(board, Refusal) or not a_contrario.is_meaningful(board.lattice.found, others):
        return None
    place, is_mirrored = find_place_of_print(measure_dots(grey, board.lattice), stated)
    return _PlacedBoard(board, place, is_mirrored)


def _explain_missing_board(
    grey: GreyImage, placed: list[_PlacedBoard], bare: list[Candidate]
) -> NoBoardError:
    """Return the error that says what an image shows instead of a PuzzleBoard that can be read:
    of boards without dots the one of the longest edges, if it is a board."""
    if any(each.is_mirrored for each in placed):
        return MirroredError()
    # Those of many corners that are sparse are a texture's.
    least = MIN_FILLED_IN_TEXTURE
    seen = [each.board.lattice for each in placed if not is_scattered(each.board.lattice, least)]
    if not seen and bare:
        largest = max((each.lattice for each in bare), key=_measure_edges)
        part = cut_middle(largest, _MAX_SHOWN_LINES)  # may be hidden
        is_seen = is_large_enough(part) and compute_filled_share(part) >= least
        if is_seen and not isinstance(refine_board(grey, part, METHODS[0], BARE_REACH), Refusal):
            seen = [largest]
    if not seen:
        return NoBoardError(
            "No PuzzleBoard was found.",
            "Take the picture again: sharp, evenly lit, and squares of at least 8 pixels.",
        )
    rows, cols = max(seen, key=_measure_edges).shape
    return NoBoardError(
        f"The dots of the {rows} x {cols} corners seen do not tell which part of a PuzzleBoard"
        " they are.",
        "Show at least 5 x 5 corners, sharp; for a checkerboard without dots, choose that pattern.",
    )


def _measure_edges(lattice: Lattice) -> float:
    """Measure the length of the edges at a lattice's corners, px."""
    return float(np.nansum(lattice.spacing()[lattice.found]))


def _number_corners(
    grey: GreyImage,
    wanted: _PlacedBoard,
    pattern: PuzzleBoard,
    grid_size: GridSize | None,
    outline: Array | None,
    others: list[RefinedBoard],
) -> Corners:
    """Return the corners of a board with their places on the stated board.

    Raises:
        NoBoardError: if some lie outside of that.
    """
    lattice = turn_lattice(wanted.board.lattice, wanted.place.quarters)
    (row, col), (origin_row, origin_col) = wanted.place.first, pattern.origin
    offset = row - origin_row, col - origin_col
    ends = offset[0] + lattice.shape[0], offset[1] + lattice.shape[1]
    size = grid_size or ends
    if min(offset) < 0 or ends[0] > size[0] or ends[1] > size[1]:
        rows, cols = (
            f"{first} to {first + lines - 1}"
            for first, lines in zip((row, col), lattice.shape, strict=True)
        )
        board = f" and has {size[0]} x {size[1]}" if grid_size else ""
        raise NoBoardError(
            f"This part of a PuzzleBoard has rows {rows} and columns {cols} of the pattern; the"
            f" stated board begins at row {origin_row}, column {origin_col}{board}.",
            "State the board's first row and column and its size, or leave them out.",
        )
    numbering = Numbering(lattice, wanted.place.quarters, size, offset)
    corners = assemble_corners(grey, wanted.board, [numbering], outline, others)
    return replace(corners, ambiguity=Symmetry.NONE, relative=False, pattern=pattern)

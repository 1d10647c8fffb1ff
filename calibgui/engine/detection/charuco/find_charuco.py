"""The detector of ChArUco boards: the markers tell which corner is which.

`MarkerReader` reads the board's markers and thereby finds what is not stated of dictionary, layout
and size; a board printed bright on dark shows them in the negative. `corners_between_markers`
predicts the inner corners from them and refines and verifies each like a corner of a checkerboard.
Where the markers leave open whether the first square is dark or white, the corners tell: one of the
two predicts some beyond the end of the board and none where others are seen.

Markers of few pixels cannot be read one by one. If the board is stated, its corners are then found
like those of a checkerboard, and all of its markers together tell which they are
(`lattice_placement`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize
from calibgui.engine.boards.charuco import Charuco, MarkerLayout
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.charuco.assembly import assemble_corners
from calibgui.engine.detection.charuco.board_identification import (
    contradict,
    count_rows,
    explain_missing_board,
    list_layouts,
    open_readers,
    read_board,
    read_markers,
)
from calibgui.engine.detection.charuco.corners_between_markers import (
    fit_corners,
    predict_corners,
    refine_and_extend_corners,
    refine_corners,
    require_enough_corners,
)
from calibgui.engine.detection.charuco.isolated_corners import (
    fit_isolated_corners,
    locate_isolated_corners,
)
from calibgui.engine.detection.charuco.lattice_placement import (
    MarkedBoard,
    is_too_large,
    measure_margin,
    place_by_marks,
)
from calibgui.engine.detection.charuco.marker_candidates import draw_markers
from calibgui.engine.detection.charuco.marker_reader import MarkerReader, ReadBoard
from calibgui.engine.detection.charuco.marker_subtraction import Marks
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS
from calibgui.engine.detection.detector_io import check_grey_levels
from calibgui.engine.errors import NoBoardError, UnknownPartError
from calibgui.engine.features.corners import Corners, RejectedCorner
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices import region_of_interest as region
from calibgui.engine.lattices.pyramid_search import Candidate, find_candidates, find_same

_FEW_CORNERS = 0.5
"""Share of a board's corners up to which all of its markers are read together."""
_BARE_REACH = 1 / 8
"""Distance from the corners within which nothing is printed, squares: the margin of markers of 3/4
of a square."""
_SIDES = (0.75, 0.6)
"""Sides of a marker that are tried where none is stated, squares: they miss others by less than a
cell."""


class _FoundBoard(NamedTuple):
    """A board and its corners."""

    lattice: Lattice
    rejected: list[RejectedCorner]
    pattern: Charuco
    """As the image shows it."""
    marks: Marks
    first: int = 0
    """Number of its first marker."""


_FittedBoard: TypeAlias = tuple[_FoundBoard, XCornerFit | None]
"""A board and the fit of its corners, if they were fitted."""


class _LocatedBoard(NamedTuple):
    """One reading of a board's markers and the corners found beside them."""

    markers: Markers[MarkerLayout]
    lattice: Lattice
    missing: BoolArray
    """(rows, cols) True where a corner is predicted and none is seen, but all around it is."""
    rejected: list[RejectedCorner]

    def rate(self, rows: int) -> int:
        """Return how many more of the predicted corners are there than are not, in the first
        `rows`. Missing ones count beside others of their row that are there: where none is, the
        board may be too slanted or too blurred to show them."""
        there = self.lattice.found[:rows]
        around = np.pad(there, ((0, 0), (1, 1)))
        missing = self.missing[:rows] & (around[:, :-2] | around[:, 2:])
        return int(np.count_nonzero(there)) - int(np.count_nonzero(missing))


def find_charuco(
    image: npt.ArrayLike,
    pattern: Charuco,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of a ChArUco board in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    readers = open_readers(grey, outline, pattern, grid_size)
    fitted = _find_fitted_board(grey, pattern, grid_size, outline, readers, method)
    if fitted is None:
        raise explain_missing_board(pattern, readers, grid_size)
    board, fit = fitted
    corners = assemble_corners(grey, board.lattice, fit, outline, board.rejected, board.pattern)
    if not board.first or pattern.first_marker is not None:
        return corners
    return replace(corners, remark=f"The board's markers are numbered from {board.first} on.")


def _find_fitted_board(
    grey: GreyImage,
    pattern: Charuco,
    grid_size: GridSize | None,
    outline: Array | None,
    readers: list[MarkerReader],
    method: str,
) -> _FittedBoard | None:
    """Find the board, and fit its corners if the `method` says so; None if nothing of it is seen.

    Raises:
        NoBoardError: if it is not the stated one, or too little of it is seen.
    """
    failure: NoBoardError | None = None
    try:
        board = _find_board(grey, pattern, grid_size, outline, readers)
        if board is not None:
            return _fit_board(grey, board, method)
    except NoBoardError as error:
        failure = error
    few = None
    if grid_size is not None:
        few = _find_isolated_corners(grey, pattern, grid_size, readers, method)
    if few is None and failure is not None:
        raise failure
    return few


def _fit_board(grey: GreyImage, board: _FoundBoard, method: str) -> _FittedBoard:
    """Fit the corners of a board if the `method` says so.

    Raises:
        NoBoardError: if too few are left.
    """
    fit: XCornerFit | None = None
    if method == "edges":
        lattice, fit, more = fit_corners(grey, board.lattice, board.marks)
        board = board._replace(lattice=lattice, rejected=board.rejected + more)
    require_enough_corners(board.lattice)
    return board, fit


def _find_isolated_corners(
    grey: GreyImage, pattern: Charuco, grid_size: GridSize, readers: list[MarkerReader], method: str
) -> _FittedBoard | None:
    """Find corners between markers that were read, two of which are enough, where they are too few
    to be a board's, and fit them if the `method` says so. None if there are none."""
    for least in (CHARUCO_THRESHOLDS.min_markers, CHARUCO_THRESHOLDS.min_markers_if_stated):
        read = read_markers(pattern, readers, grid_size, least)
        if read is not None:
            return _locate_between(grey, pattern, grid_size, *read, method)
    return None


def _locate_between(
    grey: GreyImage,
    pattern: Charuco,
    grid_size: GridSize,
    board: ReadBoard,
    is_inverted: bool,
    method: str,
) -> _FittedBoard | None:
    """Locate the corners between markers that were read; see `_find_isolated_corners`."""
    if len(board.readings) > 1 or contradict(board.readings[0], pattern, grid_size) is not None:
        return None
    markers, fit = board.readings[0], None
    lattice = locate_isolated_corners(grey, markers, grid_size, is_inverted=is_inverted)
    if method == "edges":
        lattice, fit = fit_isolated_corners(grey, lattice, _measure_plain_part(markers))
    if not len(lattice):
        return None
    return _describe_board(board.dictionary, pattern, markers, lattice, []), fit


def _find_board(
    grey: GreyImage,
    pattern: Charuco,
    grid_size: GridSize | None,
    outline: Array | None,
    readers: list[MarkerReader],
) -> _FoundBoard | None:
    """Find the board by markers that are read one by one, or, where these tell hardly half of the
    corners of a stated one, by all of them together; None if neither finds it.

    Raises:
        NoBoardError: if its markers are not the stated ones, or tell too few of its corners.
    """
    try:
        board = _find_by_markers(grey, pattern, grid_size, readers)
    except NoBoardError:
        other = _find_by_lattice(grey, pattern, grid_size, outline)
        if other is None:
            raise
        return other
    if board is not None and len(board.lattice) >= _FEW_CORNERS * board.lattice.found.size:
        return board
    other = _find_by_lattice(grey, pattern, grid_size, outline)
    if board is None or (other is not None and len(other.lattice) > len(board.lattice)):
        return other
    return board


def _find_by_markers(
    grey: GreyImage, pattern: Charuco, grid_size: GridSize | None, readers: list[MarkerReader]
) -> _FoundBoard | None:
    """Find the board by its markers, read one by one; None if too few are read.

    Raises:
        NoBoardError: if they are of another board, or tell too few of its corners.
    """
    identified = read_board(pattern, readers, grid_size)
    if identified is None:
        return None
    read, is_inverted = identified
    located = _choose_reading(grey, read.readings, grid_size, is_inverted=is_inverted)
    lattice, rejected = located.lattice, located.rejected
    board = _describe_board(read.dictionary, pattern, located.markers, lattice, rejected)
    if not lattice.found.all():
        # Beside markers that were not read the corners predict others, which markers do not bound.
        more, lost = refine_and_extend_corners(grey, lattice, board.marks.margin)
        if len(more) > len(lattice):
            return board._replace(lattice=more, rejected=lost)
    return board


def _describe_board(
    dictionary: str,
    stated: Charuco,
    markers: Markers[MarkerLayout],
    lattice: Lattice,
    rejected: list[RejectedCorner],
) -> _FoundBoard:
    """Describe the board that shows markers of a dictionary and a lattice of corners."""
    layout, side = markers.layout, markers.side
    legacy = stated.legacy if stated.legacy is not None else not layout.first_dark
    marks = _list_marks(dictionary, layout, side, lattice.shape)
    pattern = Charuco(dictionary, side, legacy, stated.first_marker)
    return _FoundBoard(lattice, rejected, pattern, marks, layout.first)


def _find_by_lattice(
    grey: GreyImage, pattern: Charuco, grid_size: GridSize | None, outline: Array | None
) -> _FoundBoard | None:
    """Find a board of stated dictionary and size by the lattice of its corners and all of its
    markers together; None if it is not there, or not stated."""
    if pattern.dictionary is None or grid_size is None:
        return None
    searched = None if outline is None else region.enlarge_outline(outline)
    boards = list(_list_stated_boards(pattern, pattern.dictionary, grid_size))
    tried: list[Candidate] = []

    def is_other(lattice: Lattice, _: int) -> bool:
        return is_too_large(lattice, grid_size)

    for candidates in find_candidates(grey, searched, bare_reach=_BARE_REACH, is_other=is_other):
        for candidate in candidates:
            if find_same(candidate, tried):
                continue
            tried.append(candidate)
            placed = _place_on_boards(grey, candidate.lattice, boards, pattern.marker)
            if placed is not None:
                return placed
    return None


def _place_on_boards(
    grey: GreyImage,
    lattice: Lattice,
    boards: list[tuple[MarkedBoard, Charuco]],
    side: float | None,
) -> _FoundBoard | None:
    """Place a lattice on the first of some boards whose markers it shows, and locate its corners;
    the markers' `side`, squares, is measured where it is not stated."""
    for board, described in boards:
        placed = place_by_marks(grey, lattice, board)
        if placed is None:
            continue
        marks = board.marks
        if side is None:
            marks = marks._replace(margin=measure_margin(grey, placed, board))
            described = replace(described, marker=1 - 2 * marks.margin)
        refined, rejected = refine_and_extend_corners(grey, placed, marks.margin)
        return _FoundBoard(refined, rejected, described, marks)
    return None


def _list_stated_boards(
    pattern: Charuco, dictionary: str, grid_size: GridSize
) -> Iterator[tuple[MarkedBoard, Charuco]]:
    """List the boards that a pattern may be, printed dark on bright or inversely."""
    for layout in list_layouts(pattern, grid_size):
        for side in _SIDES if pattern.marker is None else (pattern.marker,):
            marks = _list_marks(dictionary, layout, side, grid_size)
            for first_dark in (layout.first_dark, not layout.first_dark):
                described = Charuco(dictionary, side, not layout.first_dark, pattern.first_marker)
                yield MarkedBoard(grid_size, first_dark, marks), described


def _list_marks(dictionary: str, layout: MarkerLayout, side: float, grid_size: GridSize) -> Marks:
    """List the markers that are printed in the squares of a board."""
    rows, cols = grid_size
    cells = draw_markers(dictionary)[layout.first :][: (rows + 1) * (cols + 1) // 2]
    squares = layout.locate_squares(layout.first + np.arange(len(cells))) - 1
    return Marks(squares, cells, (1 - side) / 2)


def _locate_corners(
    grey: GreyImage,
    markers: Markers[MarkerLayout],
    grid_size: GridSize | None,
    *,
    is_inverted: bool,
) -> _LocatedBoard:
    """Locate the corners beside the markers of a board; its size is the least if none is stated.

    Raises:
        NoBoardError: if there are too few.
    """
    size = _find_size(markers, grid_size)
    predicted = predict_corners(markers, size, grey, is_inverted=is_inverted)
    bare_reach = _measure_plain_part(markers)
    lattice, rejected = refine_corners(grey, predicted, bare_reach, by_markers=True)
    missing = predicted.found & ~lattice.found & _are_whole_in_image(predicted, grey)
    return _LocatedBoard(markers, lattice, missing, rejected)


def _find_size(markers: Markers[MarkerLayout], stated: GridSize | None) -> GridSize:
    """Return the stated size of a board, or else the least that holds its markers."""
    if stated is not None:
        return stated
    rows = count_rows(markers)
    # An even number of rows of squares, if the board begins with a white square.
    rows += not markers.layout.first_dark and rows % 2 == 0
    return rows, markers.layout.cols - 1


def _are_whole_in_image(lattice: Lattice, image: GreyImage) -> BoolArray:
    """Return a mask (rows, cols) of the corners around which half a square is in the image."""
    right, down = lattice.steps()
    around = lattice.uv[..., None, :] + np.stack([right, -right, down, -down], axis=2) / 2
    return np.asarray(board_ends.are_in_image(around, image.shape).all(axis=2))


def _measure_plain_part(markers: Markers[MarkerLayout]) -> float:
    """Return how far from its edges a square with a marker is of one colour, squares."""
    return (1 - markers.side) / 2


def _choose_reading(
    grey: GreyImage,
    readings: list[Markers[MarkerLayout]],
    grid_size: GridSize | None,
    *,
    is_inverted: bool,
) -> _LocatedBoard:
    """Choose the reading of a board's markers whose corners are there, and locate these.

    Raises:
        NoBoardError: if there are too few, or they do not tell the readings apart.
    """
    boards: list[_LocatedBoard] = []
    failure = None
    for markers in readings:
        try:
            boards.append(_locate_corners(grey, markers, grid_size, is_inverted=is_inverted))
        except NoBoardError as error:
            failure = error
    if failure is not None and not boards:
        raise failure
    # One colour may need a row more, which says nothing.
    rows = min(board.lattice.shape[0] for board in boards)
    boards.sort(key=lambda board: board.rate(rows), reverse=True)
    if len(readings) > 1:
        second = boards[1].rate(rows) if len(boards) > 1 else CHARUCO_THRESHOLDS.min_corners - 1
        ahead = boards[0].rate(rows) - second
        if ahead < CHARUCO_THRESHOLDS.min_deciding_corners:
            raise UnknownPartError(
                "The markers seen do not tell which part of the board this is.",
                "State its rows and columns and whether its first square is dark, or show more of"
                " its left or right border.",
            )
    return boards[0]

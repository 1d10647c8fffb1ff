"""The detector of checkerboards: from an image to numbered, refined and verified corners.

A wrong corner harms a calibration more than a missing one, so all that is found is doubted until
its image proves it. The way of an image, entry first:

1. `find_checkerboard` checks its arguments and asks the search (`pyramid_search`) for candidates,
   lattices that may be boards.
2. Each is taken apart, refined and verified (`board_refinement`), and of the boards that it shows
   the wanted one is chosen.
3. Where nothing is found but the user marked the four outermost corners, `find_marked_board` starts
   from the places that these give.
4. The board is numbered from an origin whose outer square is dark (`numbering`), and
   `assemble_corners` makes the record that is handed out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.checkerboard import CHECKERBOARD, Checkerboard, checkerboard_symmetry
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.corner_fit import verification
from calibgui.engine.detection.checkerboard import descriptions
from calibgui.engine.detection.checkerboard.board_refinement import (
    RefinedBoard,
    refine_board,
    verify_parts,
)
from calibgui.engine.detection.detector_io import check_grey_levels, list_rejected_corners
from calibgui.engine.errors import NoBoardError, OtherSizeError
from calibgui.engine.features import harris
from calibgui.engine.features.corners import METHODS, Corners, OtherBoard
from calibgui.engine.features.lattice import MIN_CORNERS, MIN_LINES, Lattice
from calibgui.engine.features.saddle import refine_lattice
from calibgui.engine.images.image_circle_search import find_image_circle
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices import region_of_interest as region
from calibgui.engine.lattices.numbering import (
    Numbering,
    is_relative,
    list_numberings,
    place_corners,
)
from calibgui.engine.lattices.prefilter import Refusal
from calibgui.engine.lattices.pyramid_search import Candidate, find_candidates, find_same


def find_checkerboard(
    image: npt.ArrayLike,
    pattern: Checkerboard = CHECKERBOARD,  # noqa: ARG001 - there is but one
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of the checkerboard in an image.

    Args:
        image: (h, w) grey levels, uint8, uint16 or floating.
        pattern: unused; every detector takes one.
        grid_size: rows and columns of inner corners; inferred if None. A board of which only a part
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
    if grid_size is not None and min(grid_size) < MIN_LINES:
        raise ValueError(f"a board needs {MIN_LINES} x {MIN_LINES} inner corners, not {grid_size}")
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    # Only a stated size asks where boards end, or the light does.
    circle = None if grid_size is None else find_image_circle(grey)
    others: list[RefinedBoard] = []
    try:
        board, others = _find_wanted_board(grey, grid_size, outline, method, circle)
    except NoBoardError as error:
        if outline is None or grid_size is None:
            raise
        marked = find_marked_board(grey, grid_size, outline, method)
        if marked is None:
            if isinstance(error, OtherSizeError):
                raise
            raise descriptions.describe_misfit(grid_size) from None
        board = marked
    numberings = _sort_numberings(grey, board.lattice, grid_size, outline, circle)
    corners = assemble_corners(grey, board, numberings, outline, others)
    if grid_size is None and outline is None:
        continuation = descriptions.describe_continuation(grey, board.lattice)
        remarks = filter(None, (corners.remark, continuation))
        corners = replace(corners, remark=" ".join(remarks))
    return corners


def _find_wanted_board(
    grey: GreyImage,
    grid_size: GridSize | None,
    outline: Array | None,
    method: str,
    circle: ImageCircle | None,
) -> tuple[RefinedBoard, list[RefinedBoard]]:
    """Find the board of the strongest edges among those that may be of the stated size; what goes
    on around another is none, see `_choose_board`.

    Returns:
        The board and all others.

    Raises:
        NoBoardError: there is no board; an `OtherSizeError` if there are boards of other sizes.
    """
    boards: list[RefinedBoard] = []
    tried: dict[Candidate, list[RefinedBoard | Refusal]] = {}
    earlier: list[Candidate] = []  # those of `tried` that coarser levels showed
    refused: list[Refusal] = []
    searched = None if outline is None else region.enlarge_outline(outline)
    may_be_wanted = cache(
        lambda board: grid_size is None or _may_have_size(grey, board.lattice, grid_size, circle)
    )
    for candidates in find_candidates(
        grey, searched, on_refusal=refused.append, grid_size=grid_size
    ):
        for candidate in candidates:
            if candidate not in tried:
                same = find_same(candidate, earlier)
                tried[candidate] = (
                    verify_parts(grey, candidate, method, grid_size)
                    if same is None
                    else tried[same]
                )
        results = (result for candidate in candidates for result in tried[candidate])
        boards = [board for board in results if isinstance(board, RefinedBoard)]
        if chosen := _choose_board(grey, boards, may_be_wanted):
            return chosen, [board for board in boards if board is not chosen]
        earlier += candidates
    if boards and grid_size is not None:
        lattices = [each.lattice for each in boards]
        raise descriptions.describe_other_sizes(grey, lattices, grid_size, circle)
    refusals = [each for results in tried.values() for each in results if isinstance(each, Refusal)]
    for stage in (refusals, refused):  # what came farther is likelier to be meant
        if stage:
            largest = max(stage, key=lambda each: each.shape[0] * each.shape[1])
            raise descriptions.describe_refusal(largest)
    raise NoBoardError(
        "No checkerboard was found.",
        "Mark its four outermost corners, or take the picture again: all of the board in"
        " view, sharp and evenly lit.",
    )


def _choose_board(
    grey: GreyImage, boards: list[RefinedBoard], may_be_wanted: Callable[[RefinedBoard], bool]
) -> RefinedBoard | None:
    """Sort boards by the strength of their edges and return the first that may be of the stated
    size, which is asked of each, None if none may.

    A chequered floor or cloth has stronger edges than the board that lies on it, but no end in the
    image: before such a one comes what is seen to end on most sides, or on two if the floor is all
    around it.
    """
    boards.sort(key=lambda board: board.edge_strength, reverse=True)
    fitting = list(filter(may_be_wanted, boards))
    if len(fitting) > 1 and not any(board_ends.find_ends(fitting[0].lattice, grey)):
        floor, *others = fitting
        ends = [sum(board_ends.find_ends(board.lattice, grey)) for board in others]
        for board, count in zip(others, ends, strict=True):
            if count > 2:
                return board
        for board, count in zip(others, ends, strict=True):
            if count == 2 and board_ends.lies_around(floor.lattice, board.lattice):
                return board
    return fitting[0] if fitting else None


def find_marked_board(
    grey: GreyImage, grid_size: GridSize, outline: Array, method: str
) -> RefinedBoard | None:
    """Find the board whose outermost corners were marked.

    Args:
        grey: (h, w) grey levels.
        grid_size: rows and columns of inner corners.
        outline: (4, 2) px, the marks.
        method: one of `METHODS`.

    Returns:
        The board, None if fewer than half of its corners are where the marks place them.
    """
    parts = []
    for guess in region.guess_lattices(outline, grid_size):
        moved, at_saddle = refine_lattice(grey, guess)
        for dark in (True, False):
            # Where nothing was found the guess stands in for the neighbours of what was.
            candidate = Lattice(moved.uv, dark)
            good = verification.find_sound_corners(candidate, grey) & at_saddle
            parts.append((candidate.select(good), guess.uv[~good]))
    lattice, missing = max(parts, key=lambda part: len(part[0]))
    if len(lattice) < max(MIN_CORNERS, lattice.found.size // 2):
        return None
    board = refine_board(grey, lattice, method, grid_size=grid_size)
    if isinstance(board, Refusal):
        return None
    distance, _ = scipy.spatial.cKDTree(board.lattice.uv[board.lattice.found]).query(missing)
    still_missing = missing[distance > np.nanmedian(board.lattice.spacing()) / 2]
    rejected = list_rejected_corners(still_missing, "not found where the marked points place it")
    return replace(board, rejected=(*board.rejected, *rejected))


def _may_have_size(
    grey: GreyImage, lattice: Lattice, grid_size: GridSize, circle: ImageCircle | None
) -> bool:
    """Return whether a lattice may be a board of the stated size, or a part of it.

    It may be smaller only along an axis at one end of which the board was not seen to end.
    """
    top, right, bottom, left = board_ends.find_ends(lattice, grey, circle)
    whole = (top and bottom, left and right)
    return any(
        all(
            have == want or (have < want and not seen)
            for have, want, seen in zip(lattice.shape, size, whole, strict=True)
        )
        for size in (grid_size, grid_size[::-1])
    )


def _sort_numberings(
    grey: GreyImage,
    lattice: Lattice,
    grid_size: GridSize | None,
    outline: Array | None,
    circle: ImageCircle | None,
) -> list[Numbering]:
    """Return a lattice's numberings, the preferred first.

    With an outline, those that start at its first point come before the others.
    """
    if grid_size is None or sorted(grid_size) == sorted(lattice.shape):
        numberings = list_numberings(lattice, grid_size)
    else:
        ends = board_ends.find_ends(lattice, grey, circle)
        numberings = list_numberings(lattice, grid_size, ends)
    if outline is not None:
        numberings.sort(key=lambda each: not region.starts_at(each.lattice, outline[0]))
    return numberings


def assemble_corners(
    grey: GreyImage,
    board: RefinedBoard,
    numberings: list[Numbering],
    outline: Array | None,
    others: list[RefinedBoard],
) -> Corners:
    """Assemble the record of a board's corners.

    Args:
        grey: (h, w) grey levels.
        board: refined and verified.
        numberings: of its lattice, the one to use first.
        outline: (4, 2) px, the region that was searched, None if all of the image was.
        others: further boards in the image.
    """
    chosen = numberings[0]
    grid, uv, order = place_corners(chosen)
    corners = Corners(
        shape=chosen.grid_size,
        grid=grid,
        uv=uv,
        estimate=harris.estimate_corners(grey, uv, chosen.lattice.spacing()[chosen.lattice.found]),
        ambiguity=checkerboard_symmetry(chosen.grid_size),
        roi=region.find_outline(chosen.lattice) if outline is None else outline,
        method="saddle",
        relative=is_relative(numberings),
        rejected=board.rejected,
        others=tuple(map(_summarise_board, others)),
        remark="" if board.cut_from is None else descriptions.describe_cut(board.cut_from),
    )
    fit = board.fit
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


def _summarise_board(board: RefinedBoard) -> OtherBoard:
    """Return the size and the outline of a board other than the wanted one."""
    lattice = list_numberings(board.lattice, None)[0].lattice
    return OtherBoard(lattice.shape, region.find_outline(lattice))

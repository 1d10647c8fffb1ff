"""The detector of checkerboards: from an image to numbered, refined and verified corners.

A wrong corner harms a calibration more than a missing one, so all that is found is doubted until
its image proves it. The way of an image, entry first:

1. `find_checkerboard` checks its arguments and asks the search (`pyramid_search`) for candidates,
   lattices that may be boards. Boards that hang together are taken apart (`board_separation`).
2. `refine_board` moves a candidate's corners to their saddle points at full resolution, tries its
   gaps again, drops what fails (`verification`) and fits the edge model to the rest
   (`undisturbed_fit`). Where corners are missing, that is done once more without the pixels that
   are dead (`dead_pixels`). What remains must not be explained by chance (`a_contrario`).
3. Where nothing is found but the user marked the four outermost corners, `find_marked_board` starts
   from the places that these give.
4. The board is numbered from an origin whose outer square is dark (`numbering`), and
   `assemble_corners` makes the record that is handed out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.checkerboard import CHECKERBOARD, Checkerboard, checkerboard_symmetry
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.checkerboard import (
    a_contrario,
    board_ends,
    descriptions,
    harris,
    verification,
)
from calibgui.engine.detection.checkerboard.board_separation import cut_at_seam, separate_boards
from calibgui.engine.detection.checkerboard.dead_pixels import repair_dead_pixels
from calibgui.engine.detection.checkerboard.numbering import (
    Numbering,
    is_relative,
    list_numberings,
    place_corners,
)
from calibgui.engine.detection.checkerboard.prefilter import Refusal, find_objection
from calibgui.engine.detection.checkerboard.pyramid_search import (
    Candidate,
    find_candidates,
    find_same,
)
from calibgui.engine.detection.checkerboard.saddle import refine_lattice
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.undisturbed_fit import (
    fit_plain_corners,
    fit_undisturbed,
)
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.corners import METHODS, Corners, OtherBoard, RejectedCorner
from calibgui.engine.detection.detector_io import check_grey_levels, list_rejected_corners
from calibgui.engine.detection.lattice import (
    MIN_CORNERS,
    MIN_LINES,
    Lattice,
    compute_filled_share,
    drop_isolated_and_crop,
    is_large_enough,
)
from calibgui.engine.detection.pixel_noise import estimate_pixel_noise
from calibgui.engine.errors import NoBoardError

_MAX_GAP_ROUNDS = 16
"""Number of times that gaps are tried again; each time next to the corners that are found."""
_MAX_ROUNDS = 4
"""Number of times that corners are left out and the rest fitted again; a board that has not come to
rest by then is none."""
_NO_GRID = "its corners lie on no smooth grid, or too many squares do not alternate"
_TOO_MANY_FAIL = "too many of its corners fail"


@dataclass(frozen=True, eq=False, slots=True)
class RefinedBoard:
    """A verified board whose origin is still open."""

    lattice: Lattice
    rejected: tuple[RejectedCorner, ...]
    fit: XCornerFit | None
    """The edge model at the lattice's corners, None if the method is another."""
    cut_from: tuple[int, int] | None = None
    """Rows and columns of the lattice that it was cut from at a crease, None if it was not."""

    def __len__(self) -> int:
        return len(self.lattice)

    @property
    def edge_strength(self) -> float:
        """Length of the edges at its corners times, if the edge model was fitted, their contrast: a
        measure of what its image tells. A reflection of a board, as large, is fainter."""
        contrast = 1.0 if self.fit is None else self.fit.contrast
        return float(np.nansum(self.lattice.spacing()[self.lattice.found] * contrast))


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
    others: list[RefinedBoard] = []
    try:
        board, others = _find_wanted_board(grey, grid_size, outline, method)
    except NoBoardError as error:
        if outline is None or grid_size is None:
            raise
        marked = find_marked_board(grey, grid_size, outline, method)
        if marked is None:
            if isinstance(error, descriptions.OtherSizeError):
                raise
            raise descriptions.describe_misfit(grid_size) from None
        board = marked
    numberings = _sort_numberings(grey, board.lattice, grid_size, outline)
    corners = assemble_corners(grey, board, numberings, outline, others)
    if grid_size is None and outline is None:
        continuation = descriptions.describe_continuation(grey, board.lattice)
        remarks = filter(None, (corners.remark, continuation))
        corners = replace(corners, remark=" ".join(remarks))
    return corners


def _find_wanted_board(
    grey: GreyImage, grid_size: GridSize | None, outline: Array | None, method: str
) -> tuple[RefinedBoard, list[RefinedBoard]]:
    """Find the board of the strongest edges among those that may be of the stated size; what goes
    on around another is none, see `_choose_board`.

    Returns:
        The board and all others.

    Raises:
        NoBoardError: there is no board; an `OtherSizeError` if there are boards of other sizes.
    """
    boards: list[RefinedBoard] = []
    wanted, others = None, boards
    tried: dict[Candidate, list[RefinedBoard | Refusal]] = {}
    unwanted: list[Candidate] = []  # those of `tried` that are no boards of that size
    refused: list[Refusal] = []
    searched = None if outline is None else region.enlarge_outline(outline)
    may_be_wanted = cache(
        lambda board: grid_size is None or _may_have_size(grey, board.lattice, grid_size)
    )
    for candidates in find_candidates(grey, searched, on_refusal=refused.append):
        for candidate in candidates:
            if candidate not in tried:
                same = find_same(candidate, unwanted)
                tried[candidate] = (
                    _verify_parts(grey, candidate, grid_size, method)
                    if same is None
                    else tried[same]
                )
        results = (result for candidate in candidates for result in tried[candidate])
        boards = [board for board in results if isinstance(board, RefinedBoard)]
        if chosen := _choose_board(grey, boards, may_be_wanted):
            wanted, others = chosen, [board for board in boards if board is not chosen]
            if not board_ends.may_surround_a_board(wanted.lattice, grey):
                break
        unwanted += [each for each in candidates if chosen is None or _is_refused(tried[each])]
    if wanted is not None:
        return wanted, others
    if boards and grid_size is not None:
        raise descriptions.describe_other_sizes(grey, [each.lattice for each in boards], grid_size)
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


def _is_refused(results: list[RefinedBoard | Refusal]) -> bool:
    """Return whether nothing of a candidate is a board."""
    return all(isinstance(result, Refusal) for result in results)


def _verify_parts(
    grey: GreyImage, candidate: Candidate, grid_size: GridSize | None, method: str
) -> list[RefinedBoard | Refusal]:
    """Take a candidate apart where it is cut by a crease or a seam, and verify the parts."""
    results = [
        result
        for part in separate_boards(candidate.lattice, grey)
        for result in _verify_seamed(grey, part, candidate.others, grid_size, method)
    ]
    if len(results) == 1:
        return results
    shape = candidate.lattice.shape
    return [
        replace(each, cut_from=shape) if isinstance(each, RefinedBoard) else each
        for each in results
    ]


def _verify_seamed(
    grey: GreyImage, lattice: Lattice, others: int, grid_size: GridSize | None, method: str
) -> list[RefinedBoard | Refusal]:
    """Return the boards that a lattice is, or why it is none: more than one where boards lie edge
    to edge, unless together they are of the stated size, as one that is printed on several sheets.
    """
    board = _verify_lattice(grey, lattice, others, method)
    if isinstance(board, Refusal) or board.fit is None:
        return [board]
    if grid_size is not None and sorted(grid_size) == sorted(board.lattice.shape):
        return [board]
    uv, fit = board.lattice.uv.copy(), board.fit
    uv[board.lattice.found] = fit.uv
    fitted = Lattice(uv, board.lattice.dark)
    parts = cut_at_seam(fitted, fit.residual / fit.contrast)
    if parts is None:
        return [board]
    return [
        result for part in parts for result in _verify_seamed(grey, part, others, grid_size, method)
    ]


def _verify_lattice(
    grey: GreyImage, lattice: Lattice, others: int, method: str
) -> RefinedBoard | Refusal:
    """Return the board that a lattice is, beside `others` junctions in the image, or why it is
    none."""
    board = _refine_repaired(grey, lattice, method)
    if isinstance(board, Refusal) or a_contrario.is_meaningful(board.lattice.found, others):
        return board
    return Refusal(board.lattice.shape, a_contrario.BY_CHANCE)


def _refine_repaired(grey: GreyImage, lattice: Lattice, method: str) -> RefinedBoard | Refusal:
    """Refine a lattice, of whose corners dead pixels must not cost any; see `refine_board`."""
    board = refine_board(grey, lattice, method)
    if isinstance(board, Refusal) or (board.lattice.found.all() and not board.rejected):
        return board
    repaired = repair_dead_pixels(grey, board.lattice)
    if repaired is None:
        return board
    again = refine_board(repaired, lattice, method)
    return board if isinstance(again, Refusal) or len(again) <= len(board) else again


def refine_board(
    grey: GreyImage, lattice: Lattice, method: str, plain: float = 0.5
) -> RefinedBoard | Refusal:
    """Refine a lattice at full resolution and verify it.

    Its gaps are tried again, as long as that finds more. A corner whose squares overlap or part by
    much has no saddle point; the edge model copes with it.

    Args:
        grey: (h, w) grey levels.
        lattice: corners good to 2 px.
        method: one of `METHODS`.
        plain: how far from the corners nothing is printed in the squares and on their edges.

    Returns:
        The board without the corners that fail, or why the lattice is none.
    """
    is_sparse = compute_filled_share(lattice) < THRESHOLDS.search.min_filled_in_texture
    seen = lattice
    for _ in range(_MAX_GAP_ROUNDS):
        if is_sparse and (objection := find_objection(seen, grey, plain=plain)):
            # To try so many gaps again, as textures have, takes several times as long.
            return Refusal(lattice.shape, objection)
        filled = verification.fill_gaps(seen, grey.shape)
        refined, at_saddle = refine_lattice(grey, filled, plain=plain)
        if method == "saddle":
            refined = refined.select(at_saddle)
        good = verification.find_sound_corners(refined, grey, plain)
        if np.count_nonzero(good) <= len(seen):
            break
        seen = refined.select(good)
    if not verification.is_credible(int(np.count_nonzero(lattice.found & ~good)), len(lattice)):
        return Refusal(lattice.shape, _TOO_MANY_FAIL)
    without_saddle = lattice.found & ~refined.found
    unsound = lattice.found & refined.found & ~good
    rejected = [
        *list_rejected_corners(lattice.uv[without_saddle], "no saddle point"),
        *list_rejected_corners(lattice.uv[unsound], "off place or colours"),
    ]
    return _fit_board(grey, drop_isolated_and_crop(refined.select(good)), rejected, method, plain)


def _fit_board(
    grey: GreyImage,
    lattice: Lattice,
    rejected: list[RejectedCorner],
    method: str,
    plain: float,
) -> RefinedBoard | Refusal:
    """Verify a refined lattice as a whole and, unless the method is "saddle", fit the edge model.

    Corners that the model does not describe mislead what is taken from the whole board: without
    them it is fitted again.

    Args:
        grey: (h, w) grey levels.
        lattice: refined corners.
        rejected: corners rejected so far, to which those rejected here are added.
        method: one of `METHODS`.
        plain: how far from the corners nothing is printed.

    Returns:
        The board, or why the lattice is none.
    """
    failed, shape = 0, lattice.shape
    for _ in range(_MAX_ROUNDS):
        if not is_large_enough(lattice):
            return Refusal(shape, "too few of its corners are sound")
        lattice = verification.drop_broken_lines(lattice, grey)
        if not is_large_enough(lattice):
            return Refusal(shape, _NO_GRID)
        if objection := find_objection(lattice, grey, plain=plain):
            return Refusal(lattice.shape, objection)
        if method == "saddle":
            return RefinedBoard(lattice, tuple(rejected), None)
        fit, displacement = fit_undisturbed(
            lattice, lambda part: fit_plain_corners(grey, part, plain)
        )
        if verification.are_edges_too_wide(fit):
            return Refusal(lattice.shape, verification.TOO_BLURRED)
        described = verification.find_described_corners(fit, lattice, None, displacement)
        residual = verification.compare_residuals(fit.residual, fit.contrast)
        described &= ~verification.find_doubtful_lines(lattice, residual, displacement)
        near = verification.find_tolerable_displacements(displacement, lattice)
        good = described & near
        if good.all():
            noise = estimate_pixel_noise(lattice, grey)
            is_board = verification.has_step_edges(fit, noise=noise) or (
                board_ends.stands_alone(lattice, grey)
                and verification.has_step_edges(fit, is_alone=True, noise=noise)
            )
            if not is_board:
                return Refusal(lattice.shape, verification.TOO_BLURRED)
            return RefinedBoard(lattice, tuple(rejected), fit.widen(displacement))
        failed += int(np.count_nonzero(~described))
        if not verification.is_credible(failed, int(np.count_nonzero(described)) + failed):
            break
        uv = lattice.uv[lattice.found]
        rejected += list_rejected_corners(uv[~described], "not two crossing edges")
        rejected += list_rejected_corners(uv[described & ~near], verification.DRAWN_ASIDE)
        keep = lattice.found
        keep[keep] = good
        lattice = drop_isolated_and_crop(lattice.select(keep))
    return Refusal(shape, _TOO_MANY_FAIL)


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
    board = refine_board(grey, lattice, method)
    if isinstance(board, Refusal):
        return None
    distance, _ = scipy.spatial.cKDTree(board.lattice.uv[board.lattice.found]).query(missing)
    still_missing = missing[distance > np.nanmedian(board.lattice.spacing()) / 2]
    rejected = list_rejected_corners(still_missing, "not found where the marked points place it")
    return replace(board, rejected=(*board.rejected, *rejected))


def _may_have_size(grey: GreyImage, lattice: Lattice, grid_size: GridSize) -> bool:
    """Return whether a lattice may be a board of the stated size, or a part of it.

    It may be smaller only along an axis at one end of which the board was not seen to end.
    """
    top, right, bottom, left = board_ends.find_ends(lattice, grey)
    whole = (top and bottom, left and right)
    return any(
        all(
            have == want or (have < want and not seen)
            for have, want, seen in zip(lattice.shape, size, whole, strict=True)
        )
        for size in (grid_size, grid_size[::-1])
    )


def _sort_numberings(
    grey: GreyImage, lattice: Lattice, grid_size: GridSize | None, outline: Array | None
) -> list[Numbering]:
    """Return a lattice's numberings, the preferred first.

    With an outline, those that start at its first point come before the others.
    """
    if grid_size is None or sorted(grid_size) == sorted(lattice.shape):
        numberings = list_numberings(lattice, grid_size)
    else:
        numberings = list_numberings(lattice, grid_size, board_ends.find_ends(lattice, grey))
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

"""The way from a candidate to a board: its corners refined, fitted and verified.

A candidate of the search (`pyramid_search`) is taken apart where boards hang together
(`board_separation`). The corners of each part move to their saddle points at full resolution; its
gaps are tried again, what fails is dropped (`verification`), and the edge model is fitted to the
rest (`robust_fit`). Where corners are missing, that is done once more without the pixels that
are dead (`pixel_noise`). What remains must not be explained by chance (`a_contrario`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import GreyImage, GridSize
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.robust_fit import fit_plain_corners, fit_robustly
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.features.corners import RejectedCorner
from calibgui.engine.features.lattice import (
    Lattice,
    compute_filled_share,
    drop_isolated_and_crop,
    is_large_enough,
)
from calibgui.engine.features.pixel_noise import estimate_pixel_noise, repair_dead_pixels
from calibgui.engine.features.saddle import refine_lattice
from calibgui.engine.lattices import a_contrario, board_ends
from calibgui.engine.lattices.board_separation import separate_boards
from calibgui.engine.lattices.lattice_growth import MIN_FILLED_IN_TEXTURE
from calibgui.engine.lattices.prefilter import TOO_BLURRED, Refusal, find_objection
from calibgui.engine.lattices.pyramid_search import Candidate

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


def verify_parts(
    grey: GreyImage, candidate: Candidate, method: str, grid_size: GridSize | None = None
) -> list[RefinedBoard | Refusal]:
    """Take a candidate apart where it is cut by a crease, and verify the parts."""
    results = [
        _verify_lattice(grey, part, candidate.others, method, grid_size)
        for part in separate_boards(candidate.lattice, grey)
    ]
    if len(results) == 1:
        return results
    shape = candidate.lattice.shape
    return [
        replace(each, cut_from=shape) if isinstance(each, RefinedBoard) else each
        for each in results
    ]


def _verify_lattice(
    grey: GreyImage, lattice: Lattice, others: int, method: str, grid_size: GridSize | None
) -> RefinedBoard | Refusal:
    """Return the board that a lattice is, beside `others` junctions in the image, or why it is
    none."""
    board = _refine_repaired(grey, lattice, method, grid_size)
    if isinstance(board, Refusal) or a_contrario.is_meaningful(board.lattice.found, others):
        return board
    return Refusal(board.lattice.shape, a_contrario.BY_CHANCE)


def _refine_repaired(
    grey: GreyImage, lattice: Lattice, method: str, grid_size: GridSize | None
) -> RefinedBoard | Refusal:
    """Refine a lattice, of whose corners dead pixels must not cost any; see `refine_board`."""
    board = refine_board(grey, lattice, method, grid_size=grid_size)
    if isinstance(board, Refusal) or (board.lattice.found.all() and not board.rejected):
        return board
    repaired = repair_dead_pixels(grey, board.lattice)
    if repaired is None:
        return board
    again = refine_board(repaired, lattice, method, grid_size=grid_size)
    return board if isinstance(again, Refusal) or len(again) <= len(board) else again


def refine_board(
    grey: GreyImage,
    lattice: Lattice,
    method: str,
    bare_reach: float = 0.5,
    grid_size: GridSize | None = None,
) -> RefinedBoard | Refusal:
    """Refine a lattice at full resolution and verify it.

    Its gaps are tried again, as long as that finds more. A corner whose squares overlap or part by
    much has no saddle point; the edge model copes with it.

    Args:
        grey: (h, w) grey levels.
        lattice: corners good to 2 px.
        method: one of `METHODS`.
        bare_reach: how far from the corners nothing is printed in the squares and on their edges.
        grid_size: rows and columns of the board, if stated.

    Returns:
        The board without the corners that fail, or why the lattice is none.
    """
    is_sparse = compute_filled_share(lattice) < MIN_FILLED_IN_TEXTURE
    sound = lattice
    for _ in range(_MAX_GAP_ROUNDS):
        if is_sparse and (objection := find_objection(sound, grey, bare_reach=bare_reach)):
            # To try so many gaps again, as textures have, takes several times as long.
            return Refusal(lattice.shape, objection)
        filled = verification.fill_gaps(sound, grey.shape)
        refined, at_saddle = refine_lattice(grey, filled, bare_reach=bare_reach)
        if method == "saddle":
            refined = refined.select(at_saddle)
        good = verification.find_sound_corners(refined, grey, bare_reach)
        if np.count_nonzero(good) <= len(sound):
            break
        sound = refined.select(good)
    if not verification.is_credible(int(np.count_nonzero(lattice.found & ~good)), len(lattice)):
        return Refusal(lattice.shape, _TOO_MANY_FAIL)
    without_saddle = lattice.found & ~refined.found
    unsound = lattice.found & refined.found & ~good
    rejected = [
        *list_rejected_corners(lattice.uv[without_saddle], "no saddle point"),
        *list_rejected_corners(lattice.uv[unsound], "off place or colours"),
    ]
    return _fit_board(
        grey, drop_isolated_and_crop(refined.select(good)), rejected, method, bare_reach, grid_size
    )


def _fit_board(
    grey: GreyImage,
    lattice: Lattice,
    rejected: list[RejectedCorner],
    method: str,
    bare_reach: float,
    grid_size: GridSize | None,
) -> RefinedBoard | Refusal:
    """Verify a refined lattice as a whole and, unless the method is "saddle", fit the edge model.

    Corners that the model does not describe mislead what is taken from the whole board: without
    them it is fitted again.

    Args:
        grey: (h, w) grey levels.
        lattice: refined corners.
        rejected: corners rejected so far, to which those rejected here are added.
        method: one of `METHODS`.
        bare_reach: how far from the corners nothing is printed.
        grid_size: rows and columns of the board, if stated.

    Returns:
        The board, or why the lattice is none.
    """
    failed, shape = 0, lattice.shape
    for _ in range(_MAX_ROUNDS):
        if not is_large_enough(lattice):
            return Refusal(shape, "too few of its corners are sound")
        if not verification.lies_on_smooth_map(lattice):
            return Refusal(shape, _NO_GRID)
        lattice = board_ends.drop_stray_lines(lattice, grey)
        if not is_large_enough(lattice):
            return Refusal(shape, _NO_GRID)
        if objection := find_objection(lattice, grey, True, bare_reach, grid_size):
            return Refusal(lattice.shape, objection)
        if method == "saddle":
            return RefinedBoard(lattice, tuple(rejected), None)
        fit, displacement = fit_robustly(
            lattice, lambda part: fit_plain_corners(grey, part, bare_reach)
        )
        if verification.are_edges_too_wide(fit):
            return Refusal(lattice.shape, TOO_BLURRED)
        described = verification.find_described_corners(fit, lattice, displacement)
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
                return Refusal(lattice.shape, TOO_BLURRED)
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

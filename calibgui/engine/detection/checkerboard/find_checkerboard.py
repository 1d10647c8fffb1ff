"""From an image to numbered, refined and verified corners.

From a lattice to a board that can be relied on: refined, verified and fitted.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.checkerboard import CHECKERBOARD, Checkerboard, checkerboard_ambiguity
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.checkerboard import a_contrario, harris, verification, x_corner_fit
from calibgui.engine.detection.checkerboard.numbering import Numbering, numberings, place, relative
from calibgui.engine.detection.checkerboard.prefilter import plausible
from calibgui.engine.detection.checkerboard.pyramid_search import Candidate, find_boards
from calibgui.engine.detection.checkerboard.saddle import at_saddles
from calibgui.engine.detection.checkerboard.x_corner_fit import Fit
from calibgui.engine.detection.corners import Corners, OtherBoard, RejectedCorner
from calibgui.engine.detection.lattice import (
    MIN_CORNERS,
    MIN_LINES,
    Lattice,
    large_enough,
    supported,
)
from calibgui.engine.errors import NoBoardError

_SMALLEST = 16
"""Short side of an image that can show a board, px."""
_STATE_SIZE = "State the number of inner corners, rows x columns, or leave it out."


class _OtherSizeError(NoBoardError):
    """There are boards, but none of the stated size."""


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
    if grid_size is not None and min(grid_size) < MIN_LINES:
        raise ValueError(f"a board needs {MIN_LINES} x {MIN_LINES} inner corners, not {grid_size}")
    grey = grey_levels(image)
    outline = None if roi is None else region.outline(roi)
    others: list[LocatedBoard] = []
    try:
        found, others = _automatic(grey, grid_size, outline, method)
    except NoBoardError as error:
        if outline is None or grid_size is None:
            raise
        marked = guided(grey, grid_size, outline, method)
        if marked is None:
            raise error if isinstance(error, _OtherSizeError) else _misfit(grid_size) from None
        found = marked
    return record(grey, found, _numbered(grey, found.lattice, grid_size, outline), outline, others)


def grey_levels(image: npt.ArrayLike) -> GreyImage:
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
    grey: GreyImage, grid_size: GridSize | None, outline: Array | None, method: str
) -> tuple[LocatedBoard, list[LocatedBoard]]:
    """The wanted board, that with the most edge of those that may be of the stated size if there
    is one, and the others."""
    boards: list[LocatedBoard] = []
    tried: dict[Candidate, LocatedBoard | None] = {}
    for candidates in find_boards(grey, None if outline is None else region.enlarged(outline)):
        for one in candidates:
            if one not in tried:
                tried[one] = _accepted(grey, one, method)
        boards = [found for one in candidates if (found := tried[one])]
        boards.sort(key=lambda found: found.edge, reverse=True)
        for wanted in boards:
            if grid_size is None or _fits(grey, wanted.lattice, grid_size):
                return wanted, [found for found in boards if found is not wanted]
    if boards and grid_size is not None:
        raise _another_size(grey, boards, grid_size)
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


def _accepted(grey: GreyImage, candidate: Candidate, method: str) -> LocatedBoard | None:
    """The board that a candidate is, None if it is none or may be one by chance."""
    found = locate(grey, candidate.lattice, method)
    good = found and a_contrario.meaningful(found.lattice.found, candidate.others)
    return found if good else None


def _another_size(
    grey: GreyImage, boards: list[LocatedBoard], grid_size: GridSize
) -> _OtherSizeError:
    """What was found instead of the stated board."""
    sizes = [tuple(sorted(found.lattice.shape)) for found in boards]
    stated = f"not {grid_size[0]} x {grid_size[1]}"
    if len(sizes) > 1:
        seen = ", ".join(f"{rows} x {cols}" for rows, cols in sizes)
        return _OtherSizeError(f"The boards here have {seen} inner corners, {stated}.", _STATE_SIZE)
    least = "" if all(verification.ends(boards[0].lattice, grey)) else "at least "
    rows, cols = sizes[0]
    return _OtherSizeError(
        f"This board has {least}{rows} x {cols} inner corners, {stated}.", _STATE_SIZE
    )


def _fits(grey: GreyImage, lattice: Lattice, grid_size: GridSize) -> bool:
    """Whether `lattice` may be a board of the stated size, or a part of it.

    It may be smaller only along an axis at one end of which the board was not seen to end.
    """
    top, right, bottom, left = verification.ends(lattice, grey)
    whole = (top and bottom, left and right)
    return any(
        all(
            have == want or (have < want and not seen)
            for have, want, seen in zip(lattice.shape, size, whole, strict=True)
        )
        for size in (grid_size, grid_size[::-1])
    )


def _misfit(grid_size: GridSize) -> NoBoardError:
    """Nothing was found at the marked points."""
    return NoBoardError(
        f"No board of {grid_size[0]} x {grid_size[1]} inner corners fits the four marked points.",
        "Mark the four outermost inner corners, in order around the board. " + _STATE_SIZE,
    )


def _numbered(
    grey: GreyImage, lattice: Lattice, grid_size: GridSize | None, outline: Array | None
) -> list[Numbering]:
    """The lattice's numberings, the preferred first: of those that only a look at the marked
    points can tell apart the one that starts at the first of them."""
    if grid_size is None or sorted(grid_size) == sorted(lattice.shape):
        numbered = numberings(lattice, grid_size)
    else:
        numbered = numberings(lattice, grid_size, verification.ends(lattice, grey))
    if outline is not None:
        numbered.sort(key=lambda way: not region.starts_at(way.lattice, outline[0]))
    return numbered


def record(
    grey: GreyImage,
    found: LocatedBoard,
    numbered: list[Numbering],
    outline: Array | None,
    others: list[LocatedBoard],
) -> Corners:
    """What is handed out."""
    chosen = numbered[0]
    grid, uv, order = place(chosen)
    corners = Corners(
        shape=chosen.grid_size,
        grid=grid,
        uv=uv,
        estimate=harris.first_estimates(grey, uv, chosen.lattice.spacing()[chosen.lattice.found]),
        ambiguity=checkerboard_ambiguity(chosen.grid_size),
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


def _other(grid_size: LocatedBoard) -> OtherBoard:
    first = numberings(grid_size.lattice, None)[0].lattice
    return OtherBoard(first.shape, region.around(first))


METHODS = ("edges", "saddle")
_ROUNDS = 4
"""How often corners may be left out and the rest fitted again."""


@dataclass(frozen=True, eq=False, slots=True)
class LocatedBoard:
    """A verified board whose origin is still open."""

    lattice: Lattice
    rejected: tuple[RejectedCorner, ...]
    fit: Fit | None
    """The edge model at the lattice's corners, unless the method is another."""

    def __len__(self) -> int:
        return len(self.lattice)

    @property
    def edge(self) -> float:
        """Length of edge at its corners, px: how much its image tells."""
        return float(np.nansum(self.lattice.spacing()[self.lattice.found]))


def locate(grey: GreyImage, lattice: Lattice, method: str) -> LocatedBoard | None:
    """The lattice refined, less the corners that fail, or None if it is no board.

    Its gaps are tried again at full resolution, as long as that finds more. A corner whose squares
    overlap or part by much has no saddle point; the edge model copes with it.
    """
    seen = lattice
    for _ in range(_ROUNDS):
        refined, at_saddle = at_saddles(grey, verification.filled(seen, grey.shape))
        if method == "saddle":
            refined = refined.under(at_saddle)
        good = verification.sound(refined, grey)
        if np.count_nonzero(good) <= len(seen):
            break
        seen = refined.under(good)
    if not verification.credible(int(np.count_nonzero(lattice.found & ~good)), len(lattice)):
        return None
    grid_size = supported(refined.under(good))
    rejected = [
        *rejections(lattice.uv[lattice.found & ~refined.found], "no saddle point"),
        *rejections(lattice.uv[lattice.found & refined.found & ~good], "off place or colours"),
    ]
    return _fitted(grey, grid_size, rejected, method)


def guided(
    grey: GreyImage, grid_size: GridSize, outline: Array, method: str
) -> LocatedBoard | None:
    """The board whose outermost corners were pointed at, if half of its corners are there."""
    parts = []
    for guess in region.guesses(outline, grid_size):
        moved, at_saddle = at_saddles(grey, guess)
        for dark in (True, False):
            # Where nothing was found the guess stands in for the neighbours of what was.
            candidate = Lattice(moved.uv, dark)
            good = verification.sound(candidate, grey) & at_saddle
            parts.append((candidate.under(good), guess.uv[~good]))
    lattice, missing = max(parts, key=lambda part: len(part[0]))
    if len(lattice) < max(MIN_CORNERS, lattice.found.size // 2):
        return None
    found = locate(grey, lattice, method)
    if found is None:
        return None
    distance, _ = scipy.spatial.cKDTree(found.lattice.uv[found.lattice.found]).query(missing)
    still = missing[distance > np.nanmedian(found.lattice.spacing()) / 2]
    doubtful = rejections(still, "not found where the marked points place it")
    return replace(found, rejected=(*found.rejected, *doubtful))


def _fitted(
    grey: GreyImage, lattice: Lattice, rejected: list[RejectedCorner], method: str
) -> LocatedBoard | None:
    """The board with the edge model at the corners that it describes, if the method asks for it.

    The others mislead what is taken from the whole board: without them it is fitted again.
    """
    failed = 0
    for _ in range(_ROUNDS):
        lattice = verification.unbroken(lattice, grey) if large_enough(lattice) else lattice
        if not (large_enough(lattice) and plausible(lattice, grey)):
            break
        if method == "saddle":
            return LocatedBoard(lattice, tuple(rejected), None)
        fit = x_corner_fit.fit(grey, lattice)
        described = verification.described(fit, lattice)
        astray = described & verification.astray(fit, lattice)
        good = described & ~astray
        if good.all():
            return (
                LocatedBoard(lattice, tuple(rejected), fit) if verification.stepped(fit) else None
            )
        failed += int(np.count_nonzero(~described))
        if not verification.credible(failed, int(np.count_nonzero(described)) + failed):
            break
        rejected += rejections(lattice.uv[lattice.found][~described], "not two crossing edges")
        rejected += rejections(
            lattice.uv[lattice.found][astray], "drawn aside by what is seen there"
        )
        keep = lattice.found
        keep[keep] = good
        lattice = supported(lattice.under(keep))
    return None


def rejections(uv: Array, reason: str) -> list[RejectedCorner]:
    """Corners (n, 2) px that are not trusted for one reason."""
    return [RejectedCorner(float(u), float(v), reason) for u, v in uv]

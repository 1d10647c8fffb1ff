"""From an image to numbered, refined and verified corners."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.corners import edges, harris, saddle, verify
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.edges import Fit
from calibgui.engine.corners.finder import MIN_CORNERS, MIN_LINES, find_boards
from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.corners.ordering import Board, Numbering, ambiguity, numberings, place
from calibgui.engine.errors import NoBoardError
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, BoolArray, Corners, Rejection

METHODS = ("edges", "saddle")
_ROUNDS = 4
"""How often corners may be left out and the rest fitted again."""
_SPARSE = 0.5
"""Filled share below which a line beyond the stated size is clutter."""
_STATE_SIZE = "State the number of inner corners, rows x columns, or leave it out."


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
        with the reason; further boards are in `others`.

    Raises:
        NoBoardError: no acceptable board, why, and what was found instead.
        ValueError: arguments that make no sense.
    """
    if method not in METHODS:
        raise ValueError(f"method {method!r} is none of {', '.join(METHODS)}")
    if board is not None and min(board) < MIN_LINES:
        raise ValueError(f"a board needs {MIN_LINES} x {MIN_LINES} inner corners, not {board}")
    grey = _grey(image)
    outline = None if roi is None else region.outline(roi)
    search = None if outline is None else region.enlarged(outline)
    try:
        found, others = _automatic(grey, board, search, method)
    except NoBoardError:
        if outline is None or board is None:
            raise
        found, others = _guided(grey, board, outline), ()
    numbered = _numbered(found.lattice, board, outline)
    fit = None
    if method == "edges":
        found, numbered, fit = _fit(grey, found, numbered, board, outline)
    return _record(grey, found, numbered, outline, others, fit)


@dataclass(frozen=True, eq=False, slots=True)
class _Found:
    """A verified board whose origin is still open."""

    lattice: Lattice
    rejected: tuple[Rejection, ...]


def _grey(image: npt.ArrayLike) -> Image:
    grey = np.asarray(image)
    if grey.ndim != 2 or min(grey.shape) < 16:
        raise ValueError(f"an image of grey levels (h, w) is needed, not of shape {grey.shape}")
    if grey.dtype in (np.uint8, np.uint16):
        return np.ascontiguousarray(grey)
    grey = np.ascontiguousarray(grey, dtype=np.float32)
    if not np.isfinite(grey).all():
        raise ValueError("the image has grey levels that are not finite")
    return grey


def _automatic(
    grey: Image, board: Board | None, search: Array | None, method: str
) -> tuple[_Found, tuple[Array, ...]]:
    """The best verified board, and the outlines of the others."""
    candidates = find_boards(grey, search)
    if not candidates:
        raise NoBoardError(
            "No checkerboard was found.",
            "Mark its four outermost corners, or take the picture again: all of the board in"
            " view, sharp and evenly lit.",
        )
    tried = (_verified(grey, lattice, method) for lattice in candidates)
    verified = [found for found in tried if found is not None]
    if not verified:
        raise _untrusted()
    verified.sort(key=lambda found: len(found.lattice), reverse=True)
    chosen, wanted = 0, verified[0].lattice
    if board is not None:
        fitting = [_fitted(grey, found.lattice, board) for found in verified]
        chosen = max(range(len(fitting)), key=lambda i: len(fitting[i] or ()))
        part = fitting[chosen]
        if part is None:
            rows, cols = sorted(wanted.shape)
            raise NoBoardError(
                f"This board has {rows} x {cols} inner corners, not {board[0]} x {board[1]}.",
                _STATE_SIZE,
            )
        wanted = part
    others = [found.lattice for i, found in enumerate(verified) if i != chosen]
    return _Found(wanted, verified[chosen].rejected), tuple(map(region.around, others))


def _verified(grey: Image, lattice: Lattice, method: str) -> _Found | None:
    """The lattice refined, less the corners that fail, or None if it is no board.

    Its gaps are tried once more, at full resolution. A corner whose squares overlap or part by
    much has no saddle point; the edge model copes with it.
    """
    refined, at_saddle = _refined(grey, verify.filled(lattice, grey.shape))
    if method == "saddle":
        refined = refined.under(at_saddle)
    good = verify.sound(refined, grey)
    if not verify.credible(good, lattice.found) or np.count_nonzero(good) < MIN_CORNERS:
        return None
    kept = verify.without_strays(refined.under(good), grey.shape)
    if min(kept.shape) < MIN_LINES:
        return None
    rejected = [
        *_rejections(lattice.uv[lattice.found & ~refined.found], "no saddle point"),
        *_rejections(lattice.uv[lattice.found & refined.found & ~good], "off place or colours"),
    ]
    return _Found(kept, tuple(rejected))


def _rejections(uv: Array, reason: str) -> list[Rejection]:
    return [Rejection(float(u), float(v), reason) for u, v in uv]


def _refined(grey: Image, lattice: Lattice) -> tuple[Lattice, BoolArray]:
    """The lattice with its corners moved to their saddle points, and which (rows, cols) have one
    near."""
    found = lattice.found
    spacing = lattice.spacing()[found]
    uv = lattice.uv.copy()
    uv[found], good = saddle.refine(grey, uv[found], saddle.window(spacing), spacing / 4)
    at_saddle = found.copy()
    at_saddle[found] = good
    return Lattice(uv, lattice.dark), at_saddle


def _fitted(grey: Image, lattice: Lattice, board: Board) -> Lattice | None:
    """The part of `lattice` that a board of the stated size explains, or None if none can.

    A lattice may be smaller than its board only along an axis on which the board leaves the
    image: otherwise its ends were seen, and its size with them.
    """
    for size in (board, board[::-1]):
        part = _without_sparse_lines(lattice, size)
        ends = verify.visible_ends(part, grey.shape)
        if all(
            have == want or (have < want and not (first and last))
            for have, want, (first, last) in zip(part.shape, size, ends, strict=True)
        ):
            return part
    return None


def _without_sparse_lines(lattice: Lattice, size: Board) -> Lattice:
    """The lattice less border lines beyond `size` that are mostly empty."""
    uv, dark = lattice.uv, lattice.dark
    for axis in (0, 1):
        while uv.shape[axis] > size[axis]:
            filled = np.isfinite(uv[..., 0]).mean(axis=1 - axis)
            last = bool(filled[-1] < filled[0])
            if filled[-1 if last else 0] > _SPARSE:
                break
            uv = np.delete(uv, -1 if last else 0, axis=axis)
            dark ^= not last
    return Lattice(uv, dark)


def _guided(grey: Image, board: Board, outline: Array) -> _Found:
    """The board whose outermost corners were pointed at."""
    parts = []
    for guess in region.guesses(outline, board):
        refined, at_saddle = _refined(grey, guess)
        for dark in (True, False):
            # Where nothing was found the guess stands in for the neighbours of what was.
            candidate = Lattice(refined.uv, dark)
            good = verify.sound(candidate, grey) & at_saddle
            doubtful = _rejections(guess.uv[~good], "not found where the marked points place it")
            parts.append(_Found(candidate.under(good), tuple(doubtful)))
    best = max(parts, key=lambda found: len(found.lattice))
    if len(best.lattice) < max(MIN_CORNERS, best.lattice.found.size // 2):
        raise NoBoardError(
            f"No board of {board[0]} x {board[1]} inner corners fits the four marked points.",
            "Mark the four outermost inner corners, in order around the board. " + _STATE_SIZE,
        )
    return best


def _numbered(lattice: Lattice, board: Board | None, outline: Array | None) -> list[Numbering]:
    """The lattice's numberings, the preferred first: of those that only a look at the marked
    points can tell apart the one that starts at the first of them."""
    numbered = numberings(lattice, board)
    if outline is not None:
        numbered.sort(key=lambda way: not region.starts_at(way.lattice, outline[0]))
    return numbered


def _fit(
    grey: Image,
    found: _Found,
    numbered: list[Numbering],
    board: Board | None,
    outline: Array | None,
) -> tuple[_Found, list[Numbering], Fit]:
    """The edge model at the corners that it describes.

    The others mislead what is taken from the whole board: without them it is fitted again.
    """
    for _ in range(_ROUNDS):
        lattice = numbered[0].lattice
        fit = edges.fit(grey, lattice)
        good = verify.described(fit, lattice.uv[lattice.found], lattice.spacing()[lattice.found])
        if good.all() and verify.stepped(fit):
            return found, numbered, fit
        doubtful = _rejections(lattice.uv[lattice.found][~good], "not two crossing edges")
        keep = lattice.found
        keep[keep] = good
        if good.all() or not keep.any():
            break
        lattice = verify.without_strays(lattice.under(keep), grey.shape)
        if len(lattice) < MIN_CORNERS or min(lattice.shape) < MIN_LINES:
            break
        found = _Found(lattice, (*found.rejected, *doubtful))
        numbered = _numbered(lattice, board, outline)
    raise _untrusted()


def _untrusted() -> NoBoardError:
    return NoBoardError(
        "What looks like a checkerboard is not regular enough to be trusted.",
        "Mark its four outermost corners, or leave this picture out.",
    )


def _record(
    grey: Image,
    found: _Found,
    numbered: list[Numbering],
    outline: Array | None,
    others: tuple[Array, ...],
    fit: Fit | None,
) -> Corners:
    """What is handed out."""
    chosen = numbered[0]
    grid, uv = place(chosen)
    corners = Corners(
        shape=chosen.board,
        grid=grid,
        uv=uv,
        estimate=harris.first_estimates(grey, uv, chosen.lattice.spacing()[chosen.lattice.found]),
        ambiguity=ambiguity(chosen.board),
        roi=region.around(chosen.lattice) if outline is None else outline,
        method="saddle",
        relative=len({way.offset for way in numbered}) > 1,
        rejected=found.rejected,
        others=others,
    )
    if fit is None:
        return corners
    return replace(
        corners,
        method="edges",
        uv=fit.uv,
        cov=fit.covariance,
        blur=fit.blur,
        contrast=fit.contrast,
        residual=fit.residual,
    )

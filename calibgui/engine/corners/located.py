"""From a lattice to a board that can be relied on: refined, verified and fitted."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from calibgui.engine.corners import edges, verify
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.edges import Fit
from calibgui.engine.corners.glance import plausible
from calibgui.engine.corners.lattice import MIN_CORNERS, Lattice, large_enough, supported
from calibgui.engine.corners.settle import at_saddles
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, Board, Rejection

METHODS = ("edges", "saddle")
_ROUNDS = 4
"""How often corners may be left out and the rest fitted again."""


@dataclass(frozen=True, eq=False, slots=True)
class Located:
    """A verified board whose origin is still open."""

    lattice: Lattice
    rejected: tuple[Rejection, ...]
    fit: Fit | None
    """The edge model at the lattice's corners, unless the method is another."""

    def __len__(self) -> int:
        return len(self.lattice)

    @property
    def edge(self) -> float:
        """Length of edge at its corners, px: how much its image tells."""
        return float(np.nansum(self.lattice.spacing()[self.lattice.found]))


def locate(grey: Image, lattice: Lattice, method: str) -> Located | None:
    """The lattice refined, less the corners that fail, or None if it is no board.

    Its gaps are tried again at full resolution, as long as that finds more. A corner whose squares
    overlap or part by much has no saddle point; the edge model copes with it.
    """
    seen = lattice
    for _ in range(_ROUNDS):
        refined, at_saddle = at_saddles(grey, verify.filled(seen, grey.shape))
        if method == "saddle":
            refined = refined.under(at_saddle)
        good = verify.sound(refined, grey)
        if np.count_nonzero(good) <= len(seen):
            break
        seen = refined.under(good)
    if not verify.credible(int(np.count_nonzero(lattice.found & ~good)), len(lattice)):
        return None
    board = supported(refined.under(good))
    rejected = [
        *rejections(lattice.uv[lattice.found & ~refined.found], "no saddle point"),
        *rejections(lattice.uv[lattice.found & refined.found & ~good], "off place or colours"),
    ]
    return _fitted(grey, board, rejected, method)


def guided(grey: Image, board: Board, outline: Array, method: str) -> Located | None:
    """The board whose outermost corners were pointed at, if half of its corners are there."""
    parts = []
    for guess in region.guesses(outline, board):
        moved, at_saddle = at_saddles(grey, guess)
        for dark in (True, False):
            # Where nothing was found the guess stands in for the neighbours of what was.
            candidate = Lattice(moved.uv, dark)
            good = verify.sound(candidate, grey) & at_saddle
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
    grey: Image, lattice: Lattice, rejected: list[Rejection], method: str
) -> Located | None:
    """The board with the edge model at the corners that it describes, if the method asks for it.

    The others mislead what is taken from the whole board: without them it is fitted again.
    """
    failed = 0
    for _ in range(_ROUNDS):
        lattice = verify.unbroken(lattice, grey) if large_enough(lattice) else lattice
        if not (large_enough(lattice) and plausible(lattice, grey)):
            break
        if method == "saddle":
            return Located(lattice, tuple(rejected), None)
        fit = edges.fit(grey, lattice)
        described = verify.described(fit, lattice)
        astray = described & verify.astray(fit, lattice)
        good = described & ~astray
        if good.all():
            return Located(lattice, tuple(rejected), fit) if verify.stepped(fit) else None
        failed += int(np.count_nonzero(~described))
        if not verify.credible(failed, int(np.count_nonzero(described)) + failed):
            break
        rejected += rejections(lattice.uv[lattice.found][~described], "not two crossing edges")
        rejected += rejections(
            lattice.uv[lattice.found][astray], "drawn aside by what is seen there"
        )
        keep = lattice.found
        keep[keep] = good
        lattice = supported(lattice.under(keep))
    return None


def rejections(uv: Array, reason: str) -> list[Rejection]:
    """Corners (n, 2) px that are not trusted for one reason."""
    return [Rejection(float(u), float(v), reason) for u, v in uv]

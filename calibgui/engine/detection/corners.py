"""Targets, and what images show of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from calibgui.engine.arrays import Array, GridSize, IntArray, freeze, freeze_ints
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Ambiguity, Pattern


class RejectedCorner(NamedTuple):
    """A corner that was seen but is not trusted."""

    u: float
    v: float
    reason: str


class OtherBoard(NamedTuple):
    """A board seen in an image beside the wanted one."""

    shape: tuple[int, int]
    """Rows and columns of inner corners seen."""
    outline: Array
    """(4, 2) its outermost corners, px."""


@dataclass(frozen=True, eq=False, slots=True)
class Corners:
    """The points located in one image (X-junctions or circles), with their places on the board."""

    shape: GridSize
    """Rows and columns of the board's points (M, N)."""
    grid: IntArray
    """(n, 2) row and column of each corner."""
    uv: Array
    """(n, 2) refined positions, px."""
    estimate: Array
    """(n, 2) first estimates (Harris), px: the paper's red marks."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2, where the method delivers one."""
    ambiguity: Ambiguity = Ambiguity.NONE
    roi: Array | None = None
    """(4, 2) region of interest that was searched, px: the board's outline."""
    method: str = "saddle"
    relative: bool = False
    """Whether a partly seen board's rows or columns could be counted otherwise."""
    blur: Array | None = None
    """(n,) standard deviation of the edges' blur, pixel included, px."""
    contrast: Array | None = None
    """(n,) bright minus dark, grey levels."""
    residual: Array | None = None
    """(n,) root mean square of the grey levels that the fit leaves unexplained."""
    rejected: tuple[RejectedCorner, ...] = ()
    others: tuple[OtherBoard, ...] = ()
    """Further boards in the image."""
    pattern: Pattern = CHECKERBOARD
    """What they are of, with all that the image tells of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "grid", freeze_ints(self.grid))
        freeze(self, "uv", "estimate", "cov", "roi", "blur", "contrast", "residual")

    def __len__(self) -> int:
        return len(self.uv)

    @property
    def complete(self) -> bool:
        """Whether every corner of the board was located."""
        return len(self) == self.shape[0] * self.shape[1]

"""The result of a detector: the corners of one image, with their places on the board."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray, freeze, freeze_ints
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Pattern, Symmetry

METHODS = ("edges", "saddle")
"""The methods by which corners are located: the edge model, and the paper's saddle points."""
_MIN_VARIANCE = 1e-100
"""Variance of a corner below which its covariance cannot be inverted, px^2."""
_MIN_CORNERS_OF_POSE = 4
"""Least number of corners that a board's pose follows from."""
_MAX_VARIANCE_RATIO = 1e12
"""Ratio of a covariance's variances beyond which its inverse has lost most of its digits. In real
photographs the ratio is below 20."""


class RejectedCorner(NamedTuple):
    """A corner that was seen but is not trusted."""

    u: float
    """px"""
    v: float
    """px"""
    reason: str
    """Why it was rejected, for the user."""


class OtherBoard(NamedTuple):
    """A board seen in an image beside the wanted one."""

    shape: tuple[int, int]
    """Rows and columns of inner corners seen."""
    outline: Array
    """(4, 2) its outermost corners, px."""


def find_usable_covariances(cov: Array) -> BoolArray:
    """Find the covariances (n, 2, 2) px^2 that a corner can be weighed with.

    Returns:
        A mask (n,), True for those that are finite, positive definite and far from singular.
    """
    is_finite = np.ravel(np.isfinite(cov).all(axis=(1, 2)))
    values = np.linalg.eigvalsh(np.where(is_finite[:, None, None], cov, 0.0))
    least, largest = values.T
    return np.asarray(is_finite & (least > _MIN_VARIANCE) & (largest < _MAX_VARIANCE_RATIO * least))


@dataclass(frozen=True, eq=False, slots=True)
class Corners:
    """The points located in one image (X-corners or circles), with their places on the board."""

    shape: GridSize
    """Rows and columns of the board's points (M, N)."""
    grid: IntArray
    """(n, 2) row and column of each corner."""
    uv: Array
    """(n, 2) refined positions, px."""
    estimate: Array
    """(n, 2) first estimates (Harris), px: the paper's red marks."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2, where the method estimates one."""
    ambiguity: Symmetry = Symmetry.NONE
    """Turns of the board that this image alone does not tell apart."""
    roi: Array | None = None
    """(4, 2) region of interest that was searched, px: the board's outline."""
    method: str = "saddle"
    """How the positions were refined: "edges", "saddle" or "ellipses"."""
    relative: bool = False
    """True if a partly seen board's rows or columns could be counted otherwise, or if a grid of
    circles may have more of them outside of the image."""
    blur: Array | None = None
    """(n,) standard deviation of the edges' blur, pixel included, px."""
    contrast: Array | None = None
    """(n,) bright minus dark, grey levels."""
    residual: Array | None = None
    """(n,) root mean square of the grey levels that the fit leaves unexplained."""
    rejected: tuple[RejectedCorner, ...] = ()
    """Corners that were seen but are not trusted."""
    others: tuple[OtherBoard, ...] = ()
    """Further boards in the image."""
    remark: str = ""
    """What the user should know of how the board was found, a sentence; mostly empty. It is not
    stored with the corners: a view keeps it as its note."""
    pattern: Pattern = CHECKERBOARD
    """The pattern that they belong to, with its unknown fields as this image shows them."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "grid", freeze_ints(self.grid))
        freeze(self, "uv", "estimate", "cov", "roi", "blur", "contrast", "residual")

    def __len__(self) -> int:
        return len(self.uv)

    @property
    def complete(self) -> bool:
        """True if every corner of the board was located."""
        return len(self) == self.shape[0] * self.shape[1]

    @property
    def determine_pose(self) -> bool:
        """True if these are corners enough to tell the board's pose: at least four, two of them off
        every line through two others."""
        n, grid = len(self), self.grid
        if n < _MIN_CORNERS_OF_POSE or n > max(self.shape) + 1:  # a line holds no more
            return n >= _MIN_CORNERS_OF_POSE
        # A line that holds all corners but one holds two of the first three.
        for a, b in ((0, 1), (0, 2), (1, 2)):
            (row, col), (down, right) = grid[a], grid[b] - grid[a]
            area = (grid[:, 0] - row) * right - (grid[:, 1] - col) * down
            if np.count_nonzero(area) < 2:
                return False
        return True

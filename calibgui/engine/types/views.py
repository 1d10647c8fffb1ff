"""Targets, and what images show of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.errors import CalibrationError
from calibgui.engine.targets.pattern import CHECKERBOARD, Pattern
from calibgui.engine.types.arrays import Array, Board, IntArray, freeze, frozen_int


@dataclass(frozen=True, slots=True)
class Target:
    """A flat target: by default a checkerboard with rows x cols inner corners (the paper's M x N).

    Plate frame: origin at point (0, 0), X along a row (increasing column), Y down the
    rows, both in mm, so that an upright board seen from its front has R close to identity.
    """

    rows: int
    cols: int
    square: float
    """The pattern's pitch, mm: the side of a square (the paper's D_o)."""
    pattern: Pattern = CHECKERBOARD
    """What is printed, and how it is found."""

    def __post_init__(self) -> None:
        if not (self.rows >= 1 and self.cols >= 1 and 0 < self.square < math.inf):
            raise CalibrationError(
                f"There is no target of {self.rows} x {self.cols} points {self.square} mm apart.",
                "Count its rows and columns of inner corners, and measure a square in mm.",
            )

    @property
    def board(self) -> Board:
        """Rows and columns."""
        return self.rows, self.cols

    def points(self, grid: npt.ArrayLike | None = None) -> Array:
        """(n, 2) plate coordinates, mm, of points (n, 2) = (row, column); all by default."""
        if grid is None:
            grid = np.indices(self.board).reshape(2, -1).T
        return self.pattern.places(np.asarray(grid, dtype=np.float64)) * self.square


class Ambiguity(StrEnum):
    """Turns of the board that its pattern does not tell apart."""

    NONE = "none"
    HALF_TURN = "180"
    QUARTER_TURN = "90"


class Rejection(NamedTuple):
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

    shape: Board
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
    rejected: tuple[Rejection, ...] = ()
    others: tuple[OtherBoard, ...] = ()
    """Further boards in the image."""
    pattern: Pattern = CHECKERBOARD
    """What they are of, with all that the image tells of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "grid", frozen_int(self.grid))
        freeze(self, "uv", "estimate", "cov", "roi", "blur", "contrast", "residual")

    def __len__(self) -> int:
        return len(self.uv)

    @property
    def complete(self) -> bool:
        """Whether every corner of the board was located."""
        return len(self) == self.shape[0] * self.shape[1]


class Observation(NamedTuple):
    """What one view contributes to a calibration. A plain tuple (uv, xy) serves as well."""

    uv: Array
    """(n, 2) measured corners, px."""
    xy: Array
    """(n, 2) the same corners on the plate, mm."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2; equal and isotropic if None. What the residuals have
    beyond it is put down to the model, alike for all corners (``estimation/weighting.py``)."""


class ViewStatus(StrEnum):
    """What is known of one image."""

    WAITING = "waiting"
    """Not searched yet."""
    FOUND = "found"
    NO_BOARD = "no-board"
    UNREADABLE = "unreadable"
    WRONG_SIZE = "wrong-size"


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """One image of a project, with its corners or the reason why there are none."""

    image: str
    """Path or name of the image."""
    status: ViewStatus = ViewStatus.WAITING
    reason: str = ""
    """Why the image cannot be used, and the remedy; empty if it can."""
    note: str = ""
    """How its corners came about, where that is worth knowing."""
    corners: Corners | None = None
    """Corners found on a target of known layout."""
    points: Observation | None = None
    """Corners with their plate points, where they came from elsewhere (a corners file)."""
    roi: Array | None = None
    """(4, 2) region of interest given by the user, px."""
    enabled: bool = True
    """Whether the user wants it in the calibration."""

    def __post_init__(self) -> None:
        freeze(self, "roi")

    @property
    def usable(self) -> bool:
        """Whether the view takes part in a calibration."""
        return self.enabled and self.status is ViewStatus.FOUND

    def observation(self, target: Target | None) -> Observation:
        """What the view contributes to a calibration, on `target` (needed for found corners)."""
        if self.points is not None:
            return self.points
        if self.corners is None or target is None:
            raise ValueError(f"{self.image} has no corners on a known target")
        return Observation(self.corners.uv, target.points(self.corners.grid), self.corners.cov)

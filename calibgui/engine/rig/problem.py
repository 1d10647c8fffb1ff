"""The problem that the joint solve of a rig is given: its cameras, its boards, and their views."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.board_shape.estimate import AllowedDeviations
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.rig.records import Layout


@dataclass(frozen=True, eq=False, slots=True)
class CameraProblem:
    """A camera's part in the joint solve."""

    model: str
    """The lens model, a key of ``camera.models.MODELS``."""
    free: IntArray
    """Indices of the camera's parameters that may change."""
    unknown: IntArray
    """Indices of the unknowns among q, S and t: 0 to 5 unless it is the reference, and 6."""
    prior: tuple[Array, Array] | None = None
    """Values (P,) of the parameters, and the stiffness (P, P) with which they are held there."""


@dataclass(frozen=True, eq=False, slots=True)
class BoardProblem:
    """A board's part in the joint solve."""

    unknown: IntArray
    """Indices of the unknowns among m and A: 0 to 5, or none of a board whose place is known."""
    deviations: AllowedDeviations | None = None
    """The deviations that are estimated; None for a board as drawn."""
    stiffness: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """(Q, Q) of their prior and gauge, which is added to J^T J."""

    @property
    def count(self) -> int:
        """Number of coefficients of the deviations."""
        return 0 if self.deviations is None else self.deviations.B.shape[2]


@dataclass(frozen=True, eq=False, slots=True)
class SightProblem:
    """The views of one board by one camera."""

    camera: int
    board: int
    observations: Observations
    """The views, whitened so that all cameras' residuals count in the same px."""
    instant: IntArray
    """(K,) place of the instant of each view among all instants."""
    velocity: Array
    """(K, 6) local rotation and translation per second of the board in each view, rad/s and mm/s.
    """
    lag: Array
    """(K,) time by which each view is known to be later than its instant, s."""
    corner: IntArray | None = None
    """(K, N) number of the board's corner that each observation is, if deviations are estimated."""

    def select_views(self, views: IntArray) -> SightProblem:
        """Return the part of some of the views."""
        return replace(
            self,
            observations=self.observations.select_views(views),
            instant=self.instant[views],
            velocity=self.velocity[views],
            lag=self.lag[views],
            corner=None if self.corner is None else self.corner[views],
        )


@dataclass(frozen=True, eq=False, slots=True)
class RigProblem:
    """The problem that the joint solve is given."""

    cameras: tuple[CameraProblem, ...]
    boards: tuple[BoardProblem, ...]
    sights: tuple[SightProblem, ...]
    layout: Layout
    count: int
    """Number of instants."""

    @property
    def corners(self) -> int:
        """Number of corners in all views."""
        return sum(sight.observations.count for sight in self.sights)

    @property
    def free(self) -> IntArray:
        """(n,) places of the unknowns that instants share in the state's parameters."""
        cameras, boards = range(len(self.cameras)), range(len(self.boards))
        return np.concatenate(
            [
                *(self.list_free(c) for c in cameras),
                *(self.layout.board(b).start + self.boards[b].unknown for b in boards),
                *(np.r_[self.locate_deviations(b)] for b in boards),
            ]
        ).astype(np.int64)

    @property
    def placed(self) -> int:
        """Number of the unknowns in `free` that are no deviations, which come last."""
        return len(self.free) - sum(board.count for board in self.boards)

    def list_free(self, c: int) -> IntArray:
        """Return the places of camera `c`'s unknowns in the vector of `layout`."""
        camera, layout = self.cameras[c], self.layout
        return np.concatenate(
            [layout.camera(c).start + camera.free, layout.pose(c).start + camera.unknown]
        ).astype(np.int64)

    def locate_deviations(self, b: int) -> slice:
        """Return the place of the deviations of board `b` in the state's parameters."""
        start = self.layout.size + sum(board.count for board in self.boards[:b])
        return slice(start, start + self.boards[b].count)

    def find_columns(self) -> Columns:
        """Find the places of the unknowns of each camera and board among all shared ones."""
        sizes = [
            *(size for each in self.cameras for size in (len(each.free), len(each.unknown))),
            *(len(each.unknown) for each in self.boards),
            *(each.count for each in self.boards),
        ]
        ends = np.cumsum([0, *sizes])
        places = [np.arange(end - size, end) for size, end in zip(sizes, ends[1:], strict=True)]
        C, B = len(self.cameras), len(self.boards)
        return Columns(
            places[0 : 2 * C : 2],
            places[1 : 2 * C : 2],
            places[2 * C : 2 * C + B],
            places[2 * C + B :],
            int(ends[-1]),
        )


class Columns(NamedTuple):
    """Places of the unknowns among all those that instants share."""

    cameras: Sequence[IntArray]
    """Columns of each camera's own parameters."""
    poses: Sequence[IntArray]
    """Columns of each camera's pose and time."""
    boards: Sequence[IntArray]
    """Columns of each board's pose."""
    deviations: Sequence[IntArray]
    """Columns of each board's deviations."""
    total: int
    """Number of all."""

    def list_inner(self, sight: SightProblem) -> IntArray:
        """Return the places of what a view depends on otherwise than by its pose."""
        return np.concatenate([self.cameras[sight.camera], self.deviations[sight.board]])

    def list_outer(self, sight: SightProblem) -> IntArray:
        """Return the places of what a view's pose depends on, beside its instant."""
        return np.concatenate([self.poses[sight.camera], self.boards[sight.board]])

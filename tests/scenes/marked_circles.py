"""Grids of circles some of which are larger, as on the boards of robot cells."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GridSize
from calibgui.engine.boards.circle_grid import Circles, list_grid_indices
from calibgui.engine.boards.printed_pattern import Extent, PrintedDiscs, PrintedPattern


@dataclass(frozen=True, slots=True)
class MarkedCircles(Circles):
    """A grid of circles of which some are of another size."""

    marks: frozenset[tuple[int, int]] = field(default_factory=frozenset)
    """Rows and columns of these."""
    mark_diameter: float = 0.8
    """Ratio of their diameter to the pitch."""

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``."""
        assert self.diameter is not None
        grid = list_grid_indices(grid_size)
        is_mark = np.array([place in self.marks for place in map(tuple, grid.tolist())])
        centres = self.locate_points(grid.astype(np.float64))
        left, top, right, bottom = Circles.draw(self, grid_size).extent
        extent = left, top, right, bottom
        return _TwoSizes(
            PrintedDiscs(centres[~is_mark], self.diameter / 2, extent),
            PrintedDiscs(centres[is_mark], self.mark_diameter / 2, extent),
        )


@dataclass(frozen=True, eq=False, slots=True)
class _TwoSizes:
    """A print of discs of two sizes."""

    usual: PrintedDiscs
    marks: PrintedDiscs

    @property
    def extent(self) -> Extent:
        return self.usual.extent

    def compute_ink_share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``PrintedPattern``."""
        (share, cut), (other, other_cut) = (
            discs.compute_ink_share(XY, gradient) for discs in (self.usual, self.marks)
        )
        return share + other, cut | other_cut

"""The base of patterns whose print tells which corner is which.

ChArUco boards, AprilGrids, checkerboards with tags and PuzzleBoards consist of squares, and
something is printed in them by which every corner is known. They have one origin, and a photograph
may show any part of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Self

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.pattern import Symmetry


@dataclass(frozen=True, slots=True)
class CodedPattern:
    """The part of ``Pattern`` that is the same for all of them."""

    @property
    def identifies_points(self) -> bool:
        return True

    @property
    def has_squares(self) -> bool:
        return True

    def locate_points(self, grid: Array) -> Array:
        """See ``Pattern``: rows and columns are a pitch apart, unless a pattern says otherwise."""
        return grid[:, ::-1]

    def symmetry(self, grid_size: GridSize) -> Symmetry:  # noqa: ARG002 - at any size
        """See ``Pattern``."""
        return Symmetry.NONE

    def fill_unknown(self, **seen: Any) -> Self:
        """Return the pattern with those of the fields `seen` that are unknown, None, filled in."""
        unknown = {name: value for name, value in seen.items() if getattr(self, name) is None}
        return replace(self, **unknown)

"""What the engine asks of a pattern, and the checkerboard, the first of them.

A pattern's points are counted by row and column, whatever is printed there, so that corners of
a ChArUco board and circles of a grid are kept, drawn, marked and exported like a checkerboard's.
A pattern does not know its size: rows and columns (a ``Board``) come from the user or the images.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from calibgui.engine.targets.ink import Ink, Raster

if TYPE_CHECKING:
    from calibgui.engine.opencv import Image
    from calibgui.engine.types import Ambiguity, Array, Board, Corners


class Pattern(Protocol):
    """What is printed on a target. An implementation is a frozen dataclass; a field that is None
    is to be found out from the images."""

    @property
    def kind(self) -> str:
        """Its name in files and on the command line."""

    @property
    def identified(self) -> bool:
        """Whether a point says which one it is: then a part of the board shows at least how many
        rows and columns the whole has."""

    @property
    def squared(self) -> bool:
        """Whether it is printed in squares, the points being their corners."""

    def places(self, grid: Array) -> Array:
        """(n, 2) plate coordinates of points (n, 2) = (row, column), pitches."""

    def ambiguity(self, board: Board) -> Ambiguity:
        """Turns that leave the pattern of a board unchanged."""

    def find(
        self, image: Image, board: Board | None, roi: Array | None = None, method: str = "edges"
    ) -> Corners:
        """Locate the points in an image; see ``corners.find_corners``.

        Raises:
            NoBoardError: none that can be trusted, why, and what was found instead.
        """

    def completed(self, seen: Sequence[Pattern]) -> Pattern:
        """The pattern with what it leaves open as the images show it, each by itself."""

    def ink(self, board: Board) -> Ink:
        """What is printed. Raises CalibrationError if something of it is still open."""


@dataclass(frozen=True, slots=True)
class Checkerboard:
    """Squares; its points are the corners where four meet. Square (-1, -1) is dark."""

    @property
    def kind(self) -> str:
        return "checkerboard"

    @property
    def identified(self) -> bool:
        return False

    @property
    def squared(self) -> bool:
        return True

    def places(self, grid: Array) -> Array:
        """See ``Pattern``."""
        return grid[:, ::-1]

    def ambiguity(self, board: Board) -> Ambiguity:
        """See ``Pattern``."""
        from calibgui.engine.corners.ordering import ambiguity  # imports the records, as they this

        return ambiguity(board)

    def find(
        self, image: Image, board: Board | None, roi: Array | None = None, method: str = "edges"
    ) -> Corners:
        """See ``Pattern``."""
        from calibgui.engine.corners import find_corners

        return find_corners(image, board, roi, method)

    def completed(self, seen: Sequence[Pattern]) -> Pattern:  # noqa: ARG002 - nothing is open
        """See ``Pattern``."""
        return self

    def ink(self, board: Board) -> Ink:
        """See ``Pattern``."""
        return squares(board, first_dark=True)


def squares(board: Board, *, first_dark: bool) -> Raster:
    """The squares around rows x cols inner corners."""
    rows, cols = board
    dark = np.indices((rows + 1, cols + 1)).sum(axis=0) % 2 == (0 if first_dark else 1)
    return Raster(np.arange(-1.0, cols + 1), np.arange(-1.0, rows + 1), dark)


CHECKERBOARD = Checkerboard()

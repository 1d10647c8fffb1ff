"""Checkerboards with AprilTags in some of the dark squares.

The board of Deltille grids (Ha, Perdoch, Alismail, So Kweon and Sheikh, ICCV 2017). The points are
the inner corners of the checkerboard; a tag fills a dark square, its black border being that of the
square. Every so many squares along rows and columns, the step, a square holds a tag: the first in
the corner of the inner squares, that between inner corners 0 and 1 both ways. The tags are numbered
along the rows like those of an AprilGrid, usually from the lower left.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from calibgui.engine.arrays import GridSize, IntArray
from calibgui.engine.boards.april_grid import (
    MAX_BORDER,
    TagLayout,
    check_number_of_tags,
    check_tags,
)
from calibgui.engine.boards.apriltags import draw_tag, load_family
from calibgui.engine.boards.checkerboard import draw_squares
from calibgui.engine.boards.coded_pattern import CodedPattern
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedRectangles
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class TaggedCheckerboard(CodedPattern):
    """The pattern of a checkerboard with tags; a field that is None is to be inferred."""

    family: str | None = None
    """Family of the tags, one of ``apriltags.FAMILIES``, such as t25h7."""
    border: int | None = None
    """Width of the black border of a tag, cells."""
    step: int | None = None
    """Number of squares from a tag to the next one in its row or column; even."""
    from_top: bool | None = None
    """True if the tags are numbered from the top row down, False if from the bottom row up."""

    def __post_init__(self) -> None:
        check_tags(self.family, self.border)
        if self.step is not None and (self.step < 2 or self.step % 2):
            raise CalibrationError(
                f"Tags cannot stand in every {self.step} squares of a row.",
                "All are in dark squares: state an even number of squares from one to the next.",
            )

    @property
    def kind(self) -> str:
        return "tagged-checkerboard"

    def complete_from(self, seen: Sequence[Pattern]) -> TaggedCheckerboard:
        """See ``Pattern``: what was seen most often is taken."""
        boards = [pattern for pattern in seen if isinstance(pattern, TaggedCheckerboard)]
        if not boards:
            return self
        most = Counter(boards).most_common(1)[0][0]
        return self.fill_unknown(**asdict(most))

    def is_first_square_dark(self, grid_size: GridSize) -> bool:
        """Return whether the square above and left of inner corner (0, 0) is dark."""
        return bool(self.from_top) or grid_size[0] % 2 == 0

    def locate_tags(self, grid_size: GridSize) -> IntArray:
        """Locate the tags, whose step is known: row and column (n, 2) of the inner corner that is
        the upper left one of each tag's square."""
        step = self.step or 2
        rows, cols = count_tagged_squares(grid_size, step)
        squares = step * TagLayout(cols, bool(self.from_top)).locate_squares(np.arange(rows * cols))
        return squares + np.array([0 if self.from_top else grid_size[0] - 2, 0])

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``.

        Raises:
            CalibrationError: if family or step are unknown, or the family holds too few tags.
        """
        if self.family is None or self.step is None:
            raise CalibrationError(
                "The tags of the board are not known.", "State their family and their step."
            )
        rows, cols = count_tagged_squares(grid_size, self.step)
        check_number_of_tags(self.family, rows * cols)
        border = self.border or MAX_BORDER
        n = load_family(self.family).side + 2 * border
        squares = draw_squares(grid_size, first_dark=self.is_first_square_dark(grid_size))
        dark = np.repeat(np.repeat(squares.dark, n, axis=0), n, axis=1)
        # The squares of the print begin one before corner (0, 0).
        for number, (top, left) in enumerate((n * (self.locate_tags(grid_size) + 1)).tolist()):
            dark[top : top + n, left : left + n] = draw_tag(self.family, number, border)
        x, y = (np.linspace(-1.0, count, (count + 1) * n + 1) for count in grid_size[::-1])
        return PrintedRectangles(x, y, dark)


def count_tagged_squares(grid_size: GridSize, step: int) -> GridSize:
    """Return the rows and columns of tags on a board of rows x columns inner corners."""
    rows, cols = ((count - 2) // step + 1 for count in grid_size)
    return rows, cols

"""AprilGrids: rows of AprilTags with small black squares between their corners.

The board of Kalibr (Furgale, Rehder and Siegwart, IROS 2013), also of EuRoC, TUM-VI and MATLAB. The
points are the corners of the tags, two rows and two columns of them for every row and column of
tags; the small squares make each a crossing of two edges, like a corner of a checkerboard. Some
are printed without them: then the outlines of the tags tell where their corners are. The pitch is
the side of a tag, and the gap between tags is a fraction s of it, so that point (row, column) lies
at

    X = (1 + s) floor(column / 2) + column mod 2,

and Y likewise. Kalibr numbers the tags from the lower left one along the rows, the lowest first;
those who make several boards begin the second one where the first ended, and some print each tag
turned by a quarter, a half or three quarters.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.apriltags import FAMILIES, draw_tag, load_family
from calibgui.engine.boards.coded_pattern import CodedPattern
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedRectangles
from calibgui.engine.errors import CalibrationError

MAX_GAP_BETWEEN_SQUARES = 0.98
"""Widest gap between tags with small squares, sides of a tag: with that of 1 the squares are as
large, and the board is a checkerboard with tags in every second one of its rows and columns."""
MAX_BORDER = 2
"""Greatest width of a tag's border, cells."""
_SIGMA_OF_MEDIAN = 1.4826 * 1.2533
"""Standard deviation of the median of n normal numbers, times the root of n, over the median of
their absolute deviations."""
_MIN_SIGMA_OF_GAP = 7e-5
"""Least standard deviation of a gap that photographs tell, sides of a tag: all are off by as much
in the same sense if the lens is not radial. In rendered photographs it was up to 1.2e-4."""


class TagLayout(NamedTuple):
    """The order in which tags are numbered: along rows, from the left."""

    cols: int
    """Number of tags in a row."""
    from_top: bool
    """True if the first row is the top one, False if it is the bottom one."""
    first: int = 0
    """Number of the first tag."""

    def locate_squares(self, numbers: IntArray) -> IntArray:
        """Return row and column (n, 2) of the tags `numbers` (n,), counted from the first tag;
        rows above it are negative."""
        squares = np.empty((len(numbers), 2), dtype=np.int64)
        np.divmod(numbers - self.first, self.cols, out=(squares[:, 0], squares[:, 1]))
        if not self.from_top:
            squares[:, 0] *= -1
        return squares

    def number_squares(self, squares: IntArray) -> IntArray:
        """Return the numbers (n,) of the tags at `squares` (n, 2), as of `locate_squares`."""
        rows = squares[:, 0] if self.from_top else -squares[:, 0]
        return np.asarray(self.first + self.cols * rows + squares[:, 1])


@dataclass(frozen=True, slots=True)
class AprilGrid(CodedPattern):
    """The pattern of an AprilGrid; a field that is None is to be inferred from the images."""

    family: str | None = None
    """Family of the tags, one of ``apriltags.FAMILIES``, such as t36h11."""
    spacing: float | None = None
    """s, ratio of the gap between tags to the side of a tag (the pitch), no length: above 0 and at
    most 1, or `MAX_GAP_BETWEEN_SQUARES` if there are small squares."""
    border: int | None = None
    """Width of the black border of a tag, cells: 2 on the boards of Kalibr."""
    from_top: bool | None = None
    """True if the tags are numbered from the top row down, False if from the bottom row up."""
    corner_squares: bool | None = None
    """True if small dark squares stand between the corners of the tags, False if they do not."""
    first_tag: int | None = None
    """Number of the first tag; if None it is 0 unless the images show that it is not."""
    tag_turn: int | None = None
    """Number of quarters, 0 to 3, by which each tag is turned clockwise on the board; if None it is
    0 unless the images show that it is not. Those that OpenCV draws are turned by 2, and those of
    makers who count along columns by 1 or 3."""

    def __post_init__(self) -> None:
        check_tags(self.family, self.border)
        if self.spacing is not None and not 0 < self.spacing <= 1:
            raise CalibrationError(
                f"The gap between tags cannot be {self.spacing:g} of their side.",
                "State the gap over the side of a tag: above 0, at most 1; usually 0.3.",
            )
        if self.first_tag is not None and self.first_tag < 0:
            raise CalibrationError(
                f"The first tag cannot have the number {self.first_tag}.",
                "State the lowest number on the board: 0 on most.",
            )
        if self.tag_turn not in (None, 0, 1, 2, 3):
            raise CalibrationError(
                f"Tags cannot be turned by {self.tag_turn} quarters.",
                "It is 0, 1, 2 or 3 quarters.",
            )

    @property
    def kind(self) -> str:
        return "aprilgrid"

    def locate_points(self, grid: Array) -> Array:
        """See ``Pattern``.

        Raises:
            CalibrationError: if the gap between tags is not known.
        """
        if self.spacing is None:
            raise CalibrationError(
                "The gap between the tags of the board is not known.",
                "State it as a fraction of a tag's side, or read it from photographs.",
            )
        tag, corner = np.divmod(grid[:, ::-1], 2)
        return np.asarray((1 + self.spacing) * tag + corner)

    def complete_from(self, seen: Sequence[Pattern]) -> AprilGrid:
        """See ``Pattern``: the gap is the median of those seen, or a round number as likely;
        the rest is what was seen most."""
        boards = [pattern for pattern in seen if isinstance(pattern, AprilGrid)]
        if not boards:
            return self
        most = Counter(
            (
                board.family,
                board.border,
                board.from_top,
                board.corner_squares,
                board.first_tag,
                board.tag_turn,
            )
            for board in boards
        )
        family, border, from_top, squares, first_tag, tag_turn = most.most_common(1)[0][0]
        gaps = [board.spacing for board in boards if board.spacing]
        return self.fill_unknown(
            family=family,
            spacing=_combine_gaps(gaps) if gaps else None,
            border=border,
            from_top=from_top,
            corner_squares=squares,
            first_tag=first_tag,
            tag_turn=tag_turn,
        )

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``.

        Raises:
            CalibrationError: if family or gap are unknown, the gap is too wide for small squares,
                the numbers of points are odd, or the family holds too few tags for the board.
        """
        if self.family is None or self.spacing is None:
            raise CalibrationError(
                "The tags of the board are not known.", "State their family and their gap."
            )
        if self.corner_squares is not False and self.spacing > MAX_GAP_BETWEEN_SQUARES:
            raise CalibrationError(
                "With a gap as wide as the tags and squares between them the board is a "
                "checkerboard with tags.",
                "Choose that pattern with a step of 2, a smaller gap, or no squares.",
            )
        rows, cols = count_tags(grid_size)
        first = self.first_tag or 0
        check_number_of_tags(self.family, first + rows * cols)
        border = self.border or MAX_BORDER
        n = load_family(self.family).side + 2 * border
        dark = np.zeros((rows * (n + 1) + 1, cols * (n + 1) + 1), dtype=np.bool_)
        dark[:: n + 1, :: n + 1] = self.corner_squares is not False
        numbers = np.arange(first, first + rows * cols)
        squares = TagLayout(cols, bool(self.from_top), first).locate_squares(numbers)
        for number, (row, col) in zip(numbers.tolist(), squares.tolist(), strict=True):
            top = (row if self.from_top else row + rows - 1) * (n + 1) + 1
            left = col * (n + 1) + 1
            tag = np.rot90(draw_tag(self.family, number, border), -(self.tag_turn or 0))
            dark[top : top + n, left : left + n] = tag
        within = np.linspace(0, 1, n + 1)
        x, y = (
            np.append(((1 + self.spacing) * np.arange(count)[:, None] + within).ravel(), 0.0)
            for count in (cols, rows)
        )
        x[-1], y[-1] = x[-2] + self.spacing, y[-2] + self.spacing
        return PrintedRectangles(np.append(-self.spacing, x), np.append(-self.spacing, y), dark)


def _combine_gaps(gaps: Sequence[float]) -> float:
    """Return the median of gaps that were measured, or the roundest number that is as likely.

    Gaps are drawn as round numbers. A ten-thousandth of a tag's side is more than its corners are
    off by, so that a calibration would doubt a board whose gap is rounded down to 0.2999.
    """
    median = float(np.median(gaps))
    scatter = _SIGMA_OF_MEDIAN * float(np.median(np.abs(np.array(gaps) - median)))
    most = 2 * max(scatter / len(gaps) ** 0.5, _MIN_SIGMA_OF_GAP)
    likely = [round(median, digits) for digits in (2, 3, 4)]
    return next((number for number in likely if abs(number - median) < most), likely[-1])


def count_tags(grid_size: GridSize) -> GridSize:
    """Return the rows and columns of tags of an AprilGrid with rows x columns corners.

    Raises:
        CalibrationError: if a number of corners is odd.
    """
    rows, cols = grid_size
    if rows % 2 or cols % 2:
        raise CalibrationError(
            f"An AprilGrid cannot have {rows} x {cols} corners: there are two for each tag.",
            "State twice its rows of tags x twice its columns of tags.",
        )
    return rows // 2, cols // 2


def check_tags(family: str | None, border: int | None) -> None:
    """Check what is stated of a board's tags.

    Raises:
        CalibrationError: if there is no such family, or no such border.
    """
    if family is not None and family not in FAMILIES:
        raise CalibrationError(
            f"There is no tag family {family}.", f"Known: {', '.join(FAMILIES)}."
        )
    if border is not None and border not in range(1, MAX_BORDER + 1):
        raise CalibrationError(
            f"The border of a tag cannot be {border} cells wide.", "It is 1 or 2 cells wide."
        )


def check_number_of_tags(family: str, count: int) -> None:
    """Check that a family has `count` tags.

    Raises:
        CalibrationError: if it has fewer.
    """
    available = len(load_family(family).cells)
    if count > available:
        raise CalibrationError(
            f"The family {family} has {available} tags, and the board needs {count}.",
            "Choose a larger family, such as t36h11, or a smaller board.",
        )

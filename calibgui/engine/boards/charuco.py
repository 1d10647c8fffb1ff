"""ChArUco boards: a checkerboard with a numbered marker in every white square.

The points are the inner corners of the checkerboard, as on a plain one; the markers tell which is
which. They come from a dictionary of OpenCV's and are numbered row by row, from 0 unless several
boards share a dictionary. With C squares in a row and known colours of the squares, the number of a
marker tells its square.

Two layouts are in use. Since OpenCV 4.6 the first square is dark on every board. Before, boards
with an even number of rows of squares began with a white one (``legacy``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import GridSize, IntArray
from calibgui.engine.boards.checkerboard import draw_squares
from calibgui.engine.boards.coded_pattern import CodedPattern
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedRectangles
from calibgui.engine.errors import CalibrationError

_FAR_OFF = -1000
"""Row and column of the squares of markers that are not on the board."""


@dataclass(frozen=True, slots=True)
class MarkerLayout:
    """The order of the markers on a board."""

    cols: int
    """Number of squares in a row."""
    first_dark: bool
    """True if the first square is dark and the second holds the first marker."""
    first: int = 0
    """Number of the first marker: several boards may share a dictionary."""

    def locate_squares(self, numbers: IntArray) -> IntArray:
        """Return row and column (n, 2) of the squares that hold the markers `numbers` (n,), those
        of numbers before the first far off."""
        places = numbers - self.first
        rows = 2 * (int(places.max(initial=0)) // max(self.cols - 1, 1)) + 3
        squares = _list_marked_squares(rows, self.cols, self.first_dark)[np.maximum(places, 0)]
        if self.first:
            squares[places < 0] = _FAR_OFF
        return squares


@lru_cache(maxsize=512)
def _list_marked_squares(rows: int, cols: int, first_dark: bool) -> IntArray:
    """List row and column (n, 2) of the squares that hold markers, in the order of their numbers;
    they are kept, since what is read in an image is compared with all layouts."""
    parity = np.indices((rows, cols)).sum(axis=0) % 2
    return np.argwhere(parity == (1 if first_dark else 0))


MARKER_LAYOUTS = tuple(MarkerLayout(cols, dark) for cols in range(2, 65) for dark in (True, False))
"""The layouts that are considered where none is stated: 2 to 64 squares in a row, both colours."""


@dataclass(frozen=True, slots=True)
class Charuco(CodedPattern):
    """The pattern of a ChArUco board; a field that is None is to be inferred from the images.

    Lengths are ratios to the pitch, as in every pattern: markers of 30 mm in squares of 40 mm are
    ``Charuco(marker=30 / 40)``, on a ``Board`` with ``square=40``.
    """

    dictionary: str | None = None
    """Name of one of OpenCV's predefined dictionaries, such as DICT_4X4_50."""
    marker: float | None = None
    """rho, ratio of the side of a marker to the side of a square (the pitch), no length."""
    legacy: bool | None = None
    """True if a board with an even number of rows of squares begins with a white one."""
    first_marker: int | None = None
    """Number of the first marker. If None it is 0, or another one where an image shows the whole
    board; if it is stated, markers of other boards of the dictionary are passed over."""

    def __post_init__(self) -> None:
        if self.dictionary is not None and self.dictionary not in opencv.list_dictionaries():
            known = ", ".join(opencv.list_dictionaries())
            raise CalibrationError(f"There is no dictionary {self.dictionary}.", f"Known: {known}.")
        if self.marker is not None and not 0 < self.marker < 1:
            raise CalibrationError(
                f"The side of a marker is {self.marker:.4g} of the side of its square, and must be "
                "above 0 and below 1.",
                "Measure both in mm. In Python their ratio is stated, as marker=30 / 40.",
            )
        if self.first_marker is not None and self.first_marker < 0:
            raise CalibrationError(
                f"The first marker cannot have the number {self.first_marker}.",
                "State the lowest number on the board: 0 on most.",
            )

    @property
    def kind(self) -> str:
        return "charuco"

    def complete_from(self, seen: Sequence[Pattern]) -> Charuco:
        """See ``Pattern``.

        The dictionary is the largest that was seen of the family seen most often, the marker's
        side the median, and the layout the one seen most often.
        """
        boards = [pattern for pattern in seen if isinstance(pattern, Charuco)]
        if not boards:
            return self
        names = [board.dictionary for board in boards if board.dictionary]
        families = Counter(dictionary_family(name) for name in names)
        most_frequent = max(families, key=lambda family: families[family])
        largest = max(
            (name for name in names if dictionary_family(name) == most_frequent),
            key=lambda name: opencv.list_dictionaries()[name],
        )
        legacy = Counter(board.legacy for board in boards).most_common(1)[0][0]
        side = float(np.median([board.marker for board in boards]))
        return self.fill_unknown(dictionary=largest, marker=round(side, 3), legacy=legacy)

    def is_first_square_dark(self, grid_size: GridSize) -> bool:
        """Return whether the first square of a board of rows x columns inner corners is dark.

        (It has one more row of squares than of inner corners.)
        """
        return not (self.legacy and (grid_size[0] + 1) % 2 == 0)

    def number_markers(self, grid_size: GridSize) -> range:
        """Return the numbers of the markers on a board of rows x columns inner corners."""
        first = self.first_marker or 0
        return range(first, first + (grid_size[0] + 1) * (grid_size[1] + 1) // 2)

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``.

        Raises:
            CalibrationError: if dictionary or size of the markers are unknown, or the dictionary
                holds too few markers for the board.
        """
        if self.dictionary is None or self.marker is None:
            raise CalibrationError(
                "The markers of the board are not known.", "State dictionary and size of a marker."
            )
        rows, cols = grid_size[0] + 1, grid_size[1] + 1
        marked = self.number_markers(grid_size)
        if marked.stop > opencv.list_dictionaries()[self.dictionary]:
            raise CalibrationError(
                f"{self.dictionary} has too few markers for {rows} x {cols} squares.",
                f"Choose a dictionary of at least {marked.stop} markers.",
            )
        first_dark = self.is_first_square_dark(grid_size)
        numbers = np.array(marked)
        cells = np.array([opencv.draw_marker_cells(self.dictionary, k) for k in numbers.tolist()])
        k = cells.shape[1] + 2  # a margin at either end
        dark = np.repeat(np.repeat(draw_squares(grid_size, first_dark=first_dark).dark, k, 0), k, 1)
        squares = MarkerLayout(cols, first_dark, marked.start).locate_squares(numbers)
        for (row, col), marker in zip(squares.tolist(), cells, strict=True):
            dark[row * k + 1 : (row + 1) * k - 1, col * k + 1 : (col + 1) * k - 1] = marker
        margin = (1 - self.marker) / 2
        within = np.append(0.0, np.linspace(margin, 1 - margin, k - 1))
        x, y = ((np.arange(n)[:, None] + within).ravel() - 1 for n in (cols, rows))
        return PrintedRectangles(np.append(x, cols - 1.0), np.append(y, rows - 1.0), dark)


def dictionary_family(dictionary: str) -> str:
    """The name of a dictionary without its size.

    The dictionaries of one family differ in size only: the markers of the smaller are the first of
    the larger.

    >>> dictionary_family("DICT_4X4_50"), dictionary_family("DICT_ARUCO_ORIGINAL")
    ('DICT_4X4', 'DICT_ARUCO_ORIGINAL')
    """
    stem, _, size = dictionary.rpartition("_")
    return stem if size.isdigit() else dictionary

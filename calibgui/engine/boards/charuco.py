"""ChArUco boards: a checkerboard with a numbered marker in every white square.

OpenCV reads the markers; `markers` says which of them are the board's, and thereby, where it is
not stated, the dictionary, the size and the colours. `between_markers` finds the inner corners.

Two layouts are in use. Since OpenCV 4.6 the first square is dark on every board. Before, boards
with an even number of rows of squares began with a white one (``legacy``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.checkerboard import squares
from calibgui.engine.boards.pattern import Ambiguity, Pattern
from calibgui.engine.boards.printed_pattern import Ink, Raster
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class Layout:
    """How a board lays its markers."""

    cols: int
    """Squares in a row."""
    first_dark: bool
    """Whether the first square is dark and the second has marker 0."""

    def squares(self, numbers: IntArray) -> IntArray:
        """(n, 2) row and column of the squares of markers (n,)."""
        rows = 2 * (int(numbers.max(initial=0)) // max(self.cols - 1, 1)) + 3
        parity = np.indices((rows, self.cols)).sum(axis=0) % 2
        return np.argwhere(parity == (1 if self.first_dark else 0))[numbers]


LAYOUTS = tuple(Layout(cols, dark) for cols in range(2, 65) for dark in (True, False))
"""Those that are told apart."""


@dataclass(frozen=True, slots=True)
class Charuco:
    """The markers of a board; what is None is inferred from the images."""

    dictionary: str | None = None
    """Name of one of OpenCV's predefined dictionaries, as DICT_4X4_50."""
    marker: float | None = None
    """rho, side of a marker over that of a square."""
    legacy: bool | None = None
    """Whether a board with an even number of rows of squares begins with a white one."""

    def __post_init__(self) -> None:
        if self.dictionary is not None and self.dictionary not in opencv.dictionaries():
            known = ", ".join(opencv.dictionaries())
            raise CalibrationError(f"There is no dictionary {self.dictionary}.", f"Known: {known}.")
        if self.marker is not None and not 0 < self.marker < 1:
            raise CalibrationError(
                "A marker must be smaller than its square.", "State the sides of both in mm."
            )

    @property
    def kind(self) -> str:
        return "charuco"

    @property
    def identified(self) -> bool:
        return True

    @property
    def squared(self) -> bool:
        return True

    def places(self, grid: Array) -> Array:
        """See ``Pattern``."""
        return grid[:, ::-1]

    def ambiguity(self, grid_size: GridSize) -> Ambiguity:  # noqa: ARG002 - whatever the board
        """See ``Pattern``."""
        return Ambiguity.NONE

    def completed(self, seen: Sequence[Pattern]) -> Charuco:
        """See ``Pattern``."""
        boards = [pattern for pattern in seen if isinstance(pattern, Charuco)]
        if not boards:
            return self
        names = Counter(dictionary_family(one.dictionary) for one in boards if one.dictionary)
        most = max(names, key=lambda name: names[name])
        largest = max(
            (
                one.dictionary
                for one in boards
                if one.dictionary and dictionary_family(one.dictionary) == most
            ),
            key=lambda name: opencv.dictionaries()[name],
        )
        legacy = Counter(one.legacy for one in boards).most_common(1)[0][0]
        side = float(np.median([one.marker for one in boards]))
        return Charuco(
            self.dictionary or largest,
            self.marker or round(side, 3),
            legacy if self.legacy is None else self.legacy,
        )

    def first_dark(self, grid_size: GridSize) -> bool:
        """Whether the first square is dark. (The rows of squares are one more than `board`'s.)"""
        return not (self.legacy and (grid_size[0] + 1) % 2 == 0)

    def ink(self, grid_size: GridSize) -> Ink:
        """See ``Pattern``."""
        if self.dictionary is None or self.marker is None:
            raise CalibrationError(
                "The markers of the board are not known.", "State dictionary and size of a marker."
            )
        rows, cols = grid_size[0] + 1, grid_size[1] + 1
        white = rows * cols // 2
        if white > opencv.dictionaries()[self.dictionary]:
            raise CalibrationError(
                f"{self.dictionary} has too few markers for {rows} x {cols} squares.",
                f"Choose a dictionary of at least {white} markers.",
            )
        numbers = np.arange(white)
        cells = np.array([opencv.marker_cells(self.dictionary, k) for k in numbers.tolist()])
        k = cells.shape[1] + 2  # a margin at either end
        dark = np.repeat(
            np.repeat(squares(grid_size, first_dark=self.first_dark(grid_size)).dark, k, 0), k, 1
        )
        for (row, col), marker in zip(
            Layout(cols, self.first_dark(grid_size)).squares(numbers).tolist(), cells, strict=True
        ):
            dark[row * k + 1 : (row + 1) * k - 1, col * k + 1 : (col + 1) * k - 1] = marker
        margin = (1 - self.marker) / 2
        within = np.append(0.0, np.linspace(margin, 1 - margin, k - 1))
        x, y = ((np.arange(n)[:, None] + within).ravel() - 1 for n in (cols, rows))
        return Raster(np.append(x, cols - 1.0), np.append(y, rows - 1.0), dark)


def dictionary_family(dictionary: str) -> str:
    """The dictionary without its size: dictionaries of one family begin alike."""
    stem, _, size = dictionary.rpartition("_")
    return stem if size.isdigit() else dictionary

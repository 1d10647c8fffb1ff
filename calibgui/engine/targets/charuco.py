"""ChArUco boards: a checkerboard with a numbered marker in every white square.

OpenCV reads the markers; `markers` says which of them are the board's, and thereby, where it is
not stated, the dictionary, the size and the colours. `between_markers` finds the inner corners.

Two layouts are in use. Since OpenCV 4.6 the first square is dark on every board. Before, boards
with an even number of rows of squares began with a white one (``legacy``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.corners import harris
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.edges import Fit
from calibgui.engine.corners.extract import grey_levels
from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.images import stretched
from calibgui.engine.opencv import Image
from calibgui.engine.targets.between_markers import check_enough, expected, fitted, located
from calibgui.engine.targets.ink import Ink, Raster
from calibgui.engine.targets.markers import LAYOUTS, Layout
from calibgui.engine.targets.pattern import Pattern, squares
from calibgui.engine.targets.reader import Reader, Seen, family
from calibgui.engine.types import Ambiguity, Array, Board, Corners, Rejection

_DIFFERENT = 0.1
"""Difference of a marker's side from the stated one that is no error of measurement, squares."""


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

    def ambiguity(self, board: Board) -> Ambiguity:  # noqa: ARG002 - whatever the board
        """See ``Pattern``."""
        return Ambiguity.NONE

    def completed(self, seen: Sequence[Pattern]) -> Charuco:
        """See ``Pattern``."""
        boards = [pattern for pattern in seen if isinstance(pattern, Charuco)]
        if not boards:
            return self
        names = Counter(family(one.dictionary) for one in boards if one.dictionary)
        most = max(names, key=lambda name: names[name])
        largest = max(
            (one.dictionary for one in boards if one.dictionary and family(one.dictionary) == most),
            key=lambda name: opencv.dictionaries()[name],
        )
        legacy = Counter(one.legacy for one in boards).most_common(1)[0][0]
        side = float(np.median([one.marker for one in boards]))
        return Charuco(
            self.dictionary or largest,
            self.marker or round(side, 3),
            legacy if self.legacy is None else self.legacy,
        )

    def first_dark(self, board: Board) -> bool:
        """Whether the first square is dark. (The rows of squares are one more than `board`'s.)"""
        return not (self.legacy and (board[0] + 1) % 2 == 0)

    def ink(self, board: Board) -> Ink:
        """See ``Pattern``."""
        if self.dictionary is None or self.marker is None:
            raise CalibrationError(
                "The markers of the board are not known.", "State dictionary and size of a marker."
            )
        rows, cols = board[0] + 1, board[1] + 1
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
            np.repeat(squares(board, first_dark=self.first_dark(board)).dark, k, 0), k, 1
        )
        for (row, col), marker in zip(
            Layout(cols, self.first_dark(board)).squares(numbers).tolist(), cells, strict=True
        ):
            dark[row * k + 1 : (row + 1) * k - 1, col * k + 1 : (col + 1) * k - 1] = marker
        margin = (1 - self.marker) / 2
        within = np.append(0.0, np.linspace(margin, 1 - margin, k - 1))
        x, y = ((np.arange(n)[:, None] + within).ravel() - 1 for n in (cols, rows))
        return Raster(np.append(x, cols - 1.0), np.append(y, rows - 1.0), dark)

    def find(
        self, image: Image, board: Board | None, roi: Array | None = None, method: str = "edges"
    ) -> Corners:
        """See ``Pattern``."""
        grey = grey_levels(image)
        outline = None if roi is None else region.outline(roi)
        dictionary, markers = self._read(stretched(grey), board, outline)
        rows, _ = np.max(markers.squares, axis=0).tolist()
        size = board or (rows, markers.layout.cols - 1)
        # An even number of rows, if it begins with a white square.
        legacy = self.legacy if self.legacy is not None else not markers.layout.first_dark
        if board is None and not markers.layout.first_dark and size[0] % 2 == 0:
            size = (size[0] + 1, size[1])
        plain = (1 - markers.side) / 2
        lattice, rejected = located(grey, expected(markers, size, grey), plain)
        fit = None
        if method == "edges":
            lattice, fit, more = fitted(grey, lattice, plain)
            rejected += more
        seen = Charuco(dictionary, markers.side, legacy)
        return _record(grey, lattice, fit, outline, rejected, seen)

    def _read(self, image: Image, board: Board | None, outline: Array | None) -> Seen:
        """The dictionary and the board's markers in an 8-bit image (h, w).

        What is stated is tried first; if it does not fit, what does is told.
        """
        read = Reader(image, outline)
        layouts = self._layouts(board)
        found = read.board(self.dictionary, layouts) if self.dictionary else read.unknown(layouts)
        if found is None:
            raise self._wrong(read, board)
        dictionary, markers = found
        if self.marker is not None and abs(markers.side - self.marker) > _DIFFERENT:
            raise NoBoardError(
                f"The markers are {markers.side:.2f} of a square, not {self.marker:.2f}.",
                "State the sides of marker and square as measured, or leave the marker's out.",
            )
        rows, _ = np.max(markers.squares, axis=0).tolist()
        if board is not None and rows > board[0]:
            raise _other_size((rows, markers.layout.cols - 1), board)
        return dictionary, markers

    def _layouts(self, board: Board | None) -> list[Layout]:
        """Those that what is stated allows."""
        if board is None:
            return [one for one in LAYOUTS if one.first_dark or self.legacy is not False]
        if self.legacy is not None:
            return [Layout(board[1] + 1, self.first_dark(board))]
        both = (True, False) if (board[0] + 1) % 2 == 0 else (True,)
        return [Layout(board[1] + 1, dark) for dark in both]

    def _wrong(self, read: Reader, board: Board | None) -> NoBoardError:
        """What is there instead of the board stated."""
        nothing = NoBoardError(
            "No ChArUco board was found.",
            "Take the picture again: sharp, evenly lit and near enough for its markers to be read;"
            " state dictionary and size, or leave them out.",
        )
        found = read.board(self.dictionary, LAYOUTS) if self.dictionary else None
        found = found or read.unknown(LAYOUTS)
        if found is None:
            return nothing
        dictionary, markers = found
        if self.dictionary and family(dictionary) != family(self.dictionary):
            return NoBoardError(
                f"The markers are of {dictionary}, not of {self.dictionary}.",
                "State that dictionary, or leave it out.",
            )
        rows, _ = np.max(markers.squares, axis=0).tolist()
        if board is not None and (markers.layout.cols - 1 != board[1] or rows > board[0]):
            return _other_size((rows, markers.layout.cols - 1), board)
        return NoBoardError(
            "The first square of this board is "
            + ("dark." if markers.layout.first_dark else "white, as before OpenCV 4.6."),
            "State the other layout, or leave it out.",
        )


def _other_size(found: Board, stated: Board) -> NoBoardError:
    return NoBoardError(
        f"This board has at least {found[0]} rows and exactly {found[1]} columns of inner corners, "
        f"not {stated[0]} x {stated[1]}.",
        "State the number of inner corners, rows x columns, or leave it out.",
    )


def _record(
    image: Image,
    lattice: Lattice,
    fit: Fit | None,
    outline: Array | None,
    rejected: list[Rejection],
    pattern: Charuco,
) -> Corners:
    """What is handed out."""
    check_enough(lattice)
    found = lattice.found
    uv = lattice.uv[found]
    corners = Corners(
        shape=lattice.shape,
        grid=np.argwhere(found),
        uv=uv,
        estimate=harris.first_estimates(image, uv, lattice.spacing()[found]),
        roi=region.around(lattice) if outline is None else outline,
        method="saddle",
        rejected=tuple(rejected),
        pattern=pattern,
    )
    if fit is None:
        return corners
    return replace(
        corners,
        method="edges",
        uv=fit.uv,
        cov=fit.covariance,
        blur=fit.blur,
        contrast=fit.contrast,
        residual=fit.residual,
    )

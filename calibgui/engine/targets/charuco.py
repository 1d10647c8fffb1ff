"""ChArUco boards: a checkerboard with a numbered marker in every white square.

OpenCV reads the markers; `markers` says which of them are the board's, and thereby, where it is
not stated, the dictionary, the size and the colours. The marker's corners, known on the plate,
give a homography from plate to image around every inner corner, that of the nearest markers. The
corner is expected there and found by the same means as a checkerboard's: saddle point, test of
its place among its neighbours and of the colours around it, fit of the two edges with its
covariance. Places beside markers that were not read are tried where the corners around expect
them.

A marker leaves only a margin of (1 - rho) / 2 squares of plain white beside the edges, rho being
its side over a square's: nothing beyond that is looked at.

Two layouts are in use. Since OpenCV 4.6 the first square is dark on every board. Before, boards
with an even number of rows of squares began with a white one (``legacy``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from calibgui.engine import opencv
from calibgui.engine.corners import edges, harris, saddle, verify
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.edges import Fit
from calibgui.engine.corners.extract import grey_levels
from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.corners.located import rejections
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.estimation import homography
from calibgui.engine.images import stretched
from calibgui.engine.opencv import Image
from calibgui.engine.targets.ink import Ink, Raster
from calibgui.engine.targets.markers import LAYOUTS, Layout, Markers
from calibgui.engine.targets.pattern import Pattern, squares
from calibgui.engine.targets.reader import Reader, Seen, family
from calibgui.engine.types import Ambiguity, Array, Board, Corners, Rejection

MIN_CORNERS = 6
_NEAREST = 4
"""Markers whose corners place an inner corner."""
_ADJACENT = 0.8
"""Farthest that one of them must be, squares."""
_DIFFERENT = 0.1
"""Difference of a marker's side from the stated one that is no error of measurement, squares."""
_ROUNDS = 4
"""How often corners may be left out and the rest fitted again."""


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
    def counted(self) -> bool:
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
        lattice, rejected = _located(grey, _expected(markers, size, grey), plain)
        fit = None
        if method == "edges":
            lattice, fit, more = _fitted(grey, lattice, plain)
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


def _expected(markers: Markers, board: Board, image: Image) -> Lattice:
    """The inner corners beside markers where the nearest markers place them, inside the image."""
    grid = np.indices(board).reshape(2, -1).T
    xy = grid[:, ::-1].astype(np.float64)
    places = markers.places
    count = min(_NEAREST, len(places))
    near = cKDTree(places.mean(axis=1)).query(xy, np.arange(1, count + 1))
    distance, which = np.asarray(near[0]), np.asarray(near[1])
    # Around the corner: a homography moves nothing else so little.
    source = (places[which] - xy[:, None, None]).reshape(len(xy), -1, 2)
    target = markers.corners[which].reshape(len(xy), -1, 2)
    H = homography.dlt(source, target, np.ones(source.shape[:2]))
    uv = homography.apply(H, np.zeros((len(xy), 1, 2)))[:, 0]
    limit = np.array(image.shape[::-1]) - 1.0
    seen = (distance[:, 0] < _ADJACENT) & ((uv > 0) & (uv < limit)).all(axis=1)
    uv[~seen] = np.nan
    layout = markers.layout
    return Lattice(uv.reshape(*board, 2), dark=layout.first_dark)


def _located(image: Image, expected: Lattice, plain: float) -> tuple[Lattice, list[Rejection]]:
    """The corners that are where and as they must be, and the others."""
    lattice = expected
    for again in (False, True):
        # The second time also where the corners found expect others.
        tried = verify.filled(lattice, image.shape) if again else expected
        known = tried.found & np.isfinite(tried.spacing())
        tried = tried.under(known)
        spacing = tried.spacing()[known]
        uv, converged = tried.uv.copy(), known.copy()
        width = saddle.window(2 * plain * spacing)
        uv[known], converged[known] = saddle.refine(image, uv[known], width, spacing / 4)
        moved = Lattice(uv, tried.dark).under(converged)
        _check_enough(moved)
        lattice = moved.under(verify.sound(moved, image, plain))
    lost = expected.found & ~lattice.found
    return lattice, rejections(expected.uv[lost], "off place or colours")


def _fitted(image: Image, lattice: Lattice, plain: float) -> tuple[Lattice, Fit, list[Rejection]]:
    """The edge model at the corners that it describes, and the others."""
    rejected: list[Rejection] = []
    for _ in range(_ROUNDS):
        _check_enough(lattice)
        fit = edges.fit(image, lattice, plain)
        found = lattice.found
        good = verify.described(fit, lattice)
        if good.all():
            if verify.stepped(fit):
                return lattice, fit, rejected
            break
        rejected += rejections(lattice.uv[found][~good], "not two crossing edges")
        found[found] = good
        lattice = lattice.under(found)
    raise _untrusted()


def _check_enough(lattice: Lattice) -> None:
    lines = [np.count_nonzero(lattice.found.any(axis=axis)) for axis in (0, 1)]
    if len(lattice) < MIN_CORNERS or min(lines) < 2:
        raise _untrusted()


def _untrusted() -> NoBoardError:
    return NoBoardError(
        "Markers of a ChArUco board were read, but too few corners of its squares can be trusted.",
        "Take the picture again: sharp, evenly lit, and more of the board in view.",
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
    _check_enough(lattice)
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

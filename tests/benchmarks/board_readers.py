"""Readers of boards whose points are numbered: ours, OpenCV's, and others' that are installed.

    pip install --no-deps aprilgrid calib-targets

brings the others. Ours are told the kind of the board and its numbers of rows and columns, the
others all that is printed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.util import find_spec
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.boards.april_grid import AprilGrid, TagLayout, count_tags
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import CODE_LINES, PuzzleBoard
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError

_CALIB_TARGETS_OFFSET = 168
"""Row, and column, of the PuzzleBoard pattern under which calib-targets numbers the authors' 0."""
Image = NDArray[np.uint8]


class Read(NamedTuple):
    """The points that a reader found."""

    grid: NDArray[np.int64]
    """(n, 2) row and column."""
    uv: NDArray[np.float64]
    """(n, 2) px."""
    cov: NDArray[np.float64] | None = None
    """(n, 2, 2) px^2."""


Reader = Callable[[Image, Board], Read | None]


def ours(image: Image, board: Board) -> Read | None:
    stated: Mapping[str, Pattern] = {
        "charuco": Charuco(),
        "aprilgrid": AprilGrid(),
        "circles": Circles(),
        "asymmetric-circles": Circles(asymmetric=True),
    }
    pattern = stated.get(board.pattern.kind, board.pattern)
    try:
        corners = find_corners(image, board.grid_size, pattern=pattern)
    except NoBoardError:
        return None
    return Read(corners.grid, corners.uv, corners.cov)


def _number(ids: Any, uv: Any, board: Board) -> Read | None:
    """What was found under numbers that count row by row."""
    if ids is None or not len(ids):
        return None
    grid = np.column_stack(np.divmod(np.ravel(ids).astype(np.int64), board.cols))
    return Read(grid, np.asarray(uv, np.float64).reshape(-1, 2))


def opencv_charuco(image: Image, board: Board) -> Read | None:
    pattern: Any = board.pattern
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, pattern.dictionary))
    drawn = cv2.aruco.CharucoBoard(
        (board.cols + 1, board.rows + 1), 1.0, pattern.marker, dictionary
    )
    drawn.setLegacyPattern(bool(pattern.legacy))
    uv, ids, *_ = cv2.aruco.CharucoDetector(drawn).detectBoard(image)
    return _number(ids, uv, board)


def _number_tags(tags: list[tuple[int, Any]], board: Board) -> Read | None:
    """The corners of tags (number, (4, 2) px from the upper left clockwise) of an AprilGrid."""
    rows, cols = count_tags(board.grid_size)
    tags = [tag for tag in tags if tag[0] < rows * cols]
    if not tags:
        return None
    pattern: Any = board.pattern
    squares = TagLayout(cols, bool(pattern.from_top)).locate_squares(np.array([t[0] for t in tags]))
    squares[:, 0] += 0 if pattern.from_top else rows - 1
    around = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
    grid = (2 * squares[:, None] + around).reshape(-1, 2)
    return Read(grid, np.array([t[1] for t in tags], np.float64).reshape(-1, 2))


def opencv_tags(image: Image, board: Board) -> Read | None:
    pattern: Any = board.pattern
    name = f"DICT_APRILTAG_{str(pattern.family)[1:].upper()}"
    parameters = cv2.aruco.DetectorParameters()
    parameters.markerBorderBits = int(pattern.border)
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    known = {key.upper(): value for key, value in vars(cv2.aruco).items()}
    dictionary = cv2.aruco.getPredefinedDictionary(known[name])
    corners, ids, *_ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(image)
    if ids is None:
        return None
    # OpenCV's tags are upside down.
    turned = [np.roll(quad.reshape(4, 2), 2, axis=0) for quad in corners]
    return _number_tags(list(zip(np.ravel(ids).tolist(), turned, strict=True)), board)


def opencv_circles(image: Image, board: Board) -> Read | None:
    asymmetric = board.pattern.kind == "asymmetric-circles"
    flags = cv2.CALIB_CB_ASYMMETRIC_GRID if asymmetric else cv2.CALIB_CB_SYMMETRIC_GRID
    ok, uv = cv2.findCirclesGrid(image, board.grid_size[::-1], flags=flags)
    return _number(np.arange(board.rows * board.cols), uv, board) if ok else None


def aprilgrid(image: Image, board: Board) -> Read | None:
    from aprilgrid import Detector

    pattern: Any = board.pattern
    found = Detector(pattern.family + ("" if pattern.border == 2 else "b1")).detect(image)
    # Its corners begin at the lower left.
    quads = [np.reshape(tag.corners, (4, 2))[::-1] for tag in found]
    return _number_tags([(int(t.tag_id), q) for t, q in zip(found, quads, strict=True)], board)


def calib_targets_charuco(image: Image, board: Board) -> Read | None:
    import calib_targets as ct

    pattern: Any = board.pattern
    spec = ct.CharucoBoardSpec(
        board.rows + 1, board.cols + 1, 1.0, pattern.marker, pattern.dictionary
    )
    try:
        found = ct.detect_charuco(image, params=ct.CharucoParams(spec))
    except RuntimeError:
        return None
    return _number([c.id for c in found.corners], [c.position for c in found.corners], board)


def calib_targets_puzzleboard(image: Image, board: Board) -> Read | None:
    import calib_targets as ct

    pattern: Any = board.pattern
    spec = ct.PuzzleBoardSpec(board.rows + 1, board.cols + 1, 1.0, *pattern.origin)
    try:
        found = ct.detect_puzzleboard(image, params=ct.PuzzleBoardParams(spec))
    except RuntimeError:
        return None
    grid = np.array([(c.grid.v, c.grid.u) for c in found.corners], np.int64)
    grid = (grid - _CALIB_TARGETS_OFFSET) % CODE_LINES - pattern.origin
    return Read(grid, np.array([c.position for c in found.corners], np.float64))


READERS: dict[str, dict[str, Reader]] = {
    "checkerboard": {"ours": ours},
    "charuco": {"ours": ours, "OpenCV": opencv_charuco},
    "aprilgrid": {"ours": ours, "OpenCV": opencv_tags},
    "bare-aprilgrid": {"ours": ours, "OpenCV": opencv_tags},
    "puzzleboard": {"ours": ours},
    "circles": {"ours": ours, "OpenCV": opencv_circles},
    "asymmetric-circles": {"ours": ours, "OpenCV": opencv_circles},
}
"""The readers of each board, by name."""
MISSING = [name for name in ("aprilgrid", "calib_targets") if not find_spec(name)]
"""Other libraries that are not installed."""
if "aprilgrid" not in MISSING:
    READERS["aprilgrid"]["aprilgrid"] = aprilgrid
    READERS["bare-aprilgrid"]["aprilgrid"] = aprilgrid
if "calib_targets" not in MISSING:
    READERS["charuco"]["calib-targets"] = calib_targets_charuco
    READERS["puzzleboard"]["calib-targets"] = calib_targets_puzzleboard
BOARDS: dict[str, Board] = {
    "checkerboard": Board(7, 10, 26.0, CHECKERBOARD),
    "charuco": Board(7, 10, 26.0, Charuco("DICT_4X4_50", 0.75, False)),
    "aprilgrid": Board(8, 10, 22.0, AprilGrid("t36h11", 0.3, 2, False)),
    "bare-aprilgrid": Board(8, 10, 22.0, AprilGrid("t36h11", 0.3, 2, False, False)),
    "puzzleboard": Board(7, 10, 26.0, PuzzleBoard((50, 101))),
    "circles": Board(7, 10, 26.0, Circles(False, 0.5)),
    "asymmetric-circles": Board(11, 4, 26.0, Circles(True, 0.8)),
}
"""The boards by name; the bare AprilGrid has no small squares between its tags."""

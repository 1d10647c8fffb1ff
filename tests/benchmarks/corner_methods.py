"""Finders of corners to be compared: ours, OpenCV's, and others' that happen to be installed.

    pip install --no-deps calib-targets libcbdetect

brings the others: calib-targets finds boards among ChESS corners, libcbdetect is Geiger's
detector as a C++ library.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.util import find_spec
from multiprocessing import get_context
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError

Array = NDArray[np.float64]
Image = NDArray[Any]
Board = tuple[int, int]
Located = tuple[NDArray[np.int64] | None, Array, Array | None]
"""Grid (n, 2) where it is comparable with ours, positions (n, 2), covariances (n, 2, 2) where
there are any."""
Finder = Callable[[Image, Board], Located | None]
Method = Callable[[Image, Board], tuple[Located | None, float]]
"""What a finder finds, and the time of the processor that it takes, s."""


def timed(finder: Finder) -> Method:
    def run(image: Image, board: Board) -> tuple[Located | None, float]:
        start = time.process_time()
        located = finder(image, board)
        return located, time.process_time() - start

    return run


def apart(method: Method) -> Method:
    """A method in a process of its own: some crash where they find nothing."""

    def run(image: Image, board: Board) -> tuple[Located | None, float]:
        here, there = get_context("fork").Pipe(duplex=False)
        child = get_context("fork").Process(target=lambda: there.send(method(image, board)))
        child.start()
        there.close()
        try:
            answer: tuple[Located | None, float] = here.recv()
        except EOFError:
            answer = None, float("nan")
        child.join()
        return answer

    return run


def ours(method: str, in_part: bool = False) -> Finder:
    """Our finder by a method, of whole boards or of those seen `in_part`, too."""

    def locate(image: Image, board: Board) -> Located | None:
        try:
            corners = find_corners(image, method=method)
        except NoBoardError:
            return None
        if not in_part and (corners.shape != board or not corners.complete):
            return None
        return corners.grid, corners.uv, corners.cov

    return locate


def opencv(kind: str) -> Finder:
    def locate(image: Image, board: Board) -> Located | None:
        rows, cols = board
        grey = _bytes(image)
        if kind == "classic":
            ok, points = cv2.findChessboardCorners(grey, (cols, rows))
        else:
            flags = cv2.CALIB_CB_ACCURACY | cv2.CALIB_CB_EXHAUSTIVE if kind == "accuracy" else 0
            ok, points = cv2.findChessboardCornersSB(grey, (cols, rows), flags=flags)
        if not ok:
            return None
        uv = np.asarray(points, np.float32).reshape(-1, 2)
        if kind == "classic":
            steps = np.linalg.norm(np.diff(uv.reshape(rows, cols, 2), axis=1), axis=2)
            half = int(np.clip(steps.min() / 3, 2, 9))
            stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
            uv = cv2.cornerSubPix(grey, uv.reshape(-1, 1, 2), (half, half), (-1, -1), stop)
        return None, np.asarray(uv, np.float64).reshape(-1, 2), None

    return locate


def calib_targets(image: Image, board: Board) -> Located | None:
    import calib_targets

    found = calib_targets.detect_chessboard(_bytes(image))
    if found is None or len(found.corners) != board[0] * board[1]:
        return None
    return None, np.array([corner.position for corner in found.corners]), None


def libcbdetect(image: Image, board: Board) -> Located | None:
    from libCBDetect.Checkerboard import Checkerboard

    detector = Checkerboard()
    detector.show_processing = False
    detector.array_norm_to_image(_bytes(image) / 255.0, *image.shape)
    detector.find_corners()
    detector.find_board_from_corners()
    u, v = np.zeros((2, detector.rows * detector.cols))
    if len(u) != board[0] * board[1]:
        return None
    detector.get_board_corners(u, v)
    return None, np.column_stack([u, v]), None


def _bytes(image: Image) -> NDArray[np.uint8]:
    """For those that take no other type."""
    return image if image.dtype == np.uint8 else (image // 257).astype(np.uint8)


METHODS: dict[str, Method] = {
    "ours": timed(ours("edges")),
    "saddle": timed(ours("saddle")),
    "cv subpix": timed(opencv("classic")),
    "cv SB": timed(opencv("sb")),
    "cv SB acc": timed(opencv("accuracy")),
}
if find_spec("calib_targets"):
    METHODS["calib-targets"] = timed(calib_targets)
if find_spec("libCBDetect"):
    METHODS["libcbdetect"] = apart(timed(libcbdetect))

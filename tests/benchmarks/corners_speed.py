"""How long does finding the corners take, and how much memory? Ours and OpenCV's.

    python -m tests.benchmarks.corners_speed [--quick]

prints the time of the processor per image, in one thread, and the peak of what is allocated over
the size of the image. The engine is told nothing but the image, OpenCV the board's size; for
images without a board it is asked for 6 x 9. `--quick` leaves OpenCV's longest searches out.
"""

from __future__ import annotations

import argparse
import os
import time
import tracemalloc
from collections.abc import Callable
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.perspective import photograph_board
from tests.scenes.without_board import draw_without_board

Image = NDArray[np.uint8]


class Case(NamedTuple):
    image: Image
    grid_size: tuple[int, int] | None
    """Rows and columns of inner corners, None if there is no board."""
    goal: float
    """ms, as the project asks; more where it asks nothing."""


CASES: dict[str, Callable[[], Case]] = {
    "VGA, 54": lambda: Case(photograph_board((640, 480), (6, 9), 36, 0.8), (6, 9), 12),
    "VGA, noise": lambda: Case(draw_without_board(0), None, 25),
    "VGA, clutter": lambda: Case(draw_without_board(4), None, 25),
    "12 MP, 54": lambda: Case(photograph_board((4000, 3000), (6, 9), 240, 1.2), (6, 9), 40),
    "12 MP, 609": lambda: Case(photograph_board((4000, 3000), (21, 29), 110, 1.2), (21, 29), 250),
    "48 MP, 54": lambda: Case(photograph_board((8000, 6000), (6, 9), 480, 2.0), (6, 9), 90),
    "12 MP, noise": lambda: Case(
        np.random.default_rng(0).integers(0, 256, (3000, 4000), np.uint8), None, np.inf
    ),
}


def engine(image: Image) -> tuple[int, int] | None:
    try:
        return find_corners(image).shape
    except NoBoardError:
        return None


def classic(image: Image, grid_size: tuple[int, int]) -> None:
    ok, points = cv2.findChessboardCorners(image, grid_size[::-1])
    if ok:
        stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
        cv2.cornerSubPix(image, np.asarray(points, np.float32), (9, 9), (-1, -1), stop)


def sector_based(image: Image, grid_size: tuple[int, int]) -> None:
    cv2.findChessboardCornersSB(image, grid_size[::-1])


def milliseconds(repeats: int, work: Callable[..., Any], *arguments: Any) -> float:
    """Least time that `work` takes this thread: what disturbs it only adds."""
    times = []
    for _ in range(repeats):
        start = time.thread_time()
        work(*arguments)
        times.append(time.thread_time() - start)
    return 1e3 * min(times)


def peak(image: Image) -> float:
    """Most that the engine has allocated at a time, over the size of the image."""
    tracemalloc.start()
    engine(image)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most / image.nbytes


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="skip OpenCV's longest searches")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    print(f"{'ms per image':14}{'ours':>9}{'goal':>8}{'memory':>9}{'classic':>10}{'SB':>10}")
    for name, make in CASES.items():
        image, grid_size, goal = make()
        assert engine(image) == grid_size, name
        print(f"{name:14}{milliseconds(7, engine, image):9.1f}", end="")
        print(f"{goal:8.0f}{peak(image):9.2f}", end="", flush=True)
        # In noise of that size OpenCV's finders search for a quarter of an hour and more.
        slow = image.size > 1e6 and (options.quick or grid_size is None)
        for other in () if slow else (classic, sector_based):
            print(f"{milliseconds(1, other, image, grid_size or (6, 9)):10.1f}", end="", flush=True)
        print()


if __name__ == "__main__":
    main()

"""Boards that people have and that finders have lost: which are found whole, ours and OpenCV's.

    python -m tests.benchmarks.corner_troubles [--variants N] [NAME ...]

draws N variants, 20 by default, of each of the `TROUBLES` of `tests.scenes.troubles`, or of those
named, and prints per trouble how many boards are found whole, and how many corners are lost and are
wrong: ours with the size unknown, ours with it stated, and OpenCV's sector-based finder, which is
told the size and flags to search long. Of several boards in a photograph one is asked for where the
size is stated, the first; where it is not, any whole one will do.

A corner is right less than a tenth of a square, or 1 px if that is more, from the true one at its
place on the board, up to the turns that the numbering leaves open. A board of which no corner is
right counts as false.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.troubles import TROUBLES, Photograph

Array = NDArray[np.float64]
VARIANTS = 20


@dataclass(frozen=True)
class Tally:
    """Of photographs of one trouble."""

    photographs: int = 0
    whole: int = 0
    """Those with every corner of a board in its place and none besides."""
    lost: int = 0
    wrong: int = 0
    false: int = 0
    """Boards where there is none."""

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            self.photographs + other.photographs,
            self.whole + other.whole,
            self.lost + other.lost,
            self.wrong + other.wrong,
            self.false + other.false,
        )

    def __str__(self) -> str:
        return f"{self.whole:3d} of {self.photographs:2d} {self.lost:5d} {self.wrong:5d}"


Finder = Callable[[Photograph], tuple[NDArray[np.int64], Array] | None]
"""Finds rows and columns (n, 2), and positions (n, 2) px, of a photograph's board."""


def judge(photograph: Photograph, found: tuple[NDArray[np.int64], Array] | None) -> Tally:
    """Compare what was found with the board that most of it belongs to."""
    if found is None:
        return Tally(1, lost=photograph.boards[0][..., 0].size)
    grid, uv = found
    right, truth = max(
        ((_count_right(grid, uv, board), board) for board in photograph.boards),
        key=lambda pair: pair[0],
    )
    lost, wrong = truth[..., 0].size - right, len(uv) - right
    return Tally(1, int(lost == wrong == 0), lost, wrong, int(right == 0))


def _count_right(grid: NDArray[np.int64], uv: Array, truth: Array) -> int:
    """Count the corners that are in one numbering of the board where they truly are."""
    cols = truth.shape[1]
    flat = truth.reshape(-1, 2)
    distance = np.linalg.norm(uv[:, None] - flat, axis=2)
    nearest = np.argmin(distance, axis=1)
    others = np.linalg.norm(flat[:, None] - flat, axis=2) + 1e9 * np.eye(len(flat))
    at = distance.min(axis=1) < np.maximum(others.min(axis=1)[nearest] / 10, 1.0)
    place = np.column_stack(np.divmod(nearest, cols))
    best = 0
    for quarters in range(4):
        turn = np.linalg.matrix_power(np.array([[0, 1], [-1, 0]]), quarters)
        moved = (grid - place @ turn.T)[at]
        if len(moved):
            best = max(best, int(np.unique(moved, axis=0, return_counts=True)[1].max()))
    return best


def find_ours(photograph: Photograph, known: bool) -> tuple[NDArray[np.int64], Array] | None:
    """Find with the engine, the size stated or not."""
    size = photograph.boards[0].shape[:2] if known else None
    try:
        corners = find_corners(photograph.image, size)
    except NoBoardError:
        return None
    return corners.grid, corners.uv


def find_with_opencv(photograph: Photograph) -> tuple[NDArray[np.int64], Array] | None:
    """Find with OpenCV's sector-based finder."""
    rows, cols = photograph.boards[0].shape[:2]
    image = photograph.image
    if image.dtype != np.uint8:
        image = cv2.normalize(image, np.empty(0), 0, 255, cv2.NORM_MINMAX, cv2.CV_8U)
    flags = cv2.CALIB_CB_ACCURACY | cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_NORMALIZE_IMAGE
    ok, points = cv2.findChessboardCornersSB(image, (cols, rows), flags=flags)
    if not ok:
        return None
    grid = np.argwhere(np.ones((rows, cols), np.bool_))
    return grid, np.asarray(points, np.float64).reshape(-1, 2)


FINDERS: dict[str, Finder] = {
    "ours": lambda photograph: find_ours(photograph, known=False),
    "ours, size stated": lambda photograph: find_ours(photograph, known=True),
    "OpenCV SB": find_with_opencv,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variants", type=int, default=VARIANTS, help="of each trouble")
    parser.add_argument("names", nargs="*", metavar="NAME", help="troubles, all if none")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    print(f"{'':20}" + "".join(f"{name:>24}" for name in FINDERS))
    print(f"{'trouble':20}" + f"{'whole     lost wrong':>24}" * len(FINDERS))
    false: dict[str, int] = dict.fromkeys(FINDERS, 0)
    for name in options.names or TROUBLES:
        tallies = dict.fromkeys(FINDERS, Tally())
        for seed in range(options.variants):
            photograph = TROUBLES[name](seed)
            for finder, find in FINDERS.items():
                tallies[finder] += judge(photograph, find(photograph))
        print(f"{name:20}" + "".join(f"{tally!s:>24}" for tally in tallies.values()), flush=True)
        for finder, tally in tallies.items():
            false[finder] += tally.false
    print("false boards: " + ", ".join(f"{finder} {count}" for finder, count in false.items()))


if __name__ == "__main__":
    main()

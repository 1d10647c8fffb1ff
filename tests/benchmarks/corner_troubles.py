"""Boards that people have and that finders have lost: which are found whole, ours and OpenCV's.

    python -m tests.benchmarks.corner_troubles [--variants N] [--first SEED] [NAME ...]

draws N variants, 20 by default, with the seeds from SEED on, 0 by default, of each of the
`TROUBLES` of `tests.scenes.troubles`, or of those named. It prints per trouble how many boards are
found whole, and how many corners are lost and are wrong: ours with the size unknown, ours with it
stated, and OpenCV's sector-based finder, which is told the size and flags to search long. Of
several boards in a photograph one is asked for where the size is stated, the first; where it is
not, any whole one will do. What counts as right is said by `tests.scenes.tally`.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import cv2
import numpy as np

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.tally import Found, Tally, judge
from tests.scenes.troubles import TROUBLES, Photograph

VARIANTS = 20

Finder = Callable[[Photograph], Found | None]


def find_ours(photograph: Photograph, known: bool) -> Found | None:
    """Find with the engine, the size stated or not."""
    size = photograph.boards[0].shape[:2] if known else None
    try:
        corners = find_corners(photograph.image, size)
    except NoBoardError:
        return None
    return corners.grid, corners.uv


def find_with_opencv(photograph: Photograph) -> Found | None:
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
    parser.add_argument("--first", type=int, default=0, metavar="SEED", help="of the variants")
    parser.add_argument("names", nargs="*", metavar="NAME", help="troubles, all if none")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    print(f"{'':20}" + "".join(f"{name:>24}" for name in FINDERS))
    print(f"{'trouble':20}" + f"{'whole     lost wrong':>24}" * len(FINDERS))
    false: dict[str, int] = dict.fromkeys(FINDERS, 0)
    for name in options.names or TROUBLES:
        tallies = dict.fromkeys(FINDERS, Tally())
        for seed in range(options.first, options.first + options.variants):
            photograph = TROUBLES[name](seed)
            for finder, find in FINDERS.items():
                tallies[finder] += judge(photograph, find(photograph))
        print(f"{name:20}" + "".join(f"{tally!s:>24}" for tally in tallies.values()), flush=True)
        for finder, tally in tallies.items():
            false[finder] += tally.false
    print("false boards: " + ", ".join(f"{finder} {count}" for finder, count in false.items()))


if __name__ == "__main__":
    main()

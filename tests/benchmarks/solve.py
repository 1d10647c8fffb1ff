"""Our calibration against OpenCV's, from the same corners: `python -m tests.benchmarks.solve`.

Both fit the forward model with k1, k2, p1, p2, k3 and end at the same minimum; ours is also
timed with the paper's model. Ours includes everything that ``calibrate`` returns: Stage I,
standard deviations of camera and poses, residuals in the image and on the plate. OpenCV is
timed without standard deviations, and with them where that does not take minutes. One BLAS
thread and one OpenCV thread; our compiled sums use two from 65 views on.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import partial

import cv2
import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.engine.calibrate import calibrate
from calibgui.engine.types import Observation
from tests.engine.scenes import VGA, Target, brown, looking, seen

BOARD = Target(rows=12, cols=13, square=30.0)
COUNTS = (10, 25, 100, 500)
WITH_DEVIATIONS = 100
CRITERIA = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-12)


def corners(count: int) -> list[Observation]:
    """`count` random views of a 12 x 13 board with 0.1 px of noise."""
    camera, rng = brown(), np.random.default_rng(count)
    poses = [looking(camera, rng, board=BOARD, fill=(0.4, 0.8)) for _ in range(count)]
    return seen(camera, poses, board=BOARD).noisy(0.1, rng)


def opencv(views: list[Observation], deviations: bool) -> float:
    """RMS of OpenCV's solve."""
    boards = [np.column_stack([v.xy, np.zeros(len(v.xy))]).astype(np.float32) for v in views]
    uv = [v.uv.astype(np.float32).reshape(-1, 1, 2) for v in views]
    solve = cv2.calibrateCameraExtended if deviations else cv2.calibrateCamera
    return float(solve(boards, uv, VGA, None, None, criteria=CRITERIA)[0])


def ours(views: list[Observation], model: str) -> float:
    """RMS of our solve."""
    residuals = calibrate(views, VGA, model=model).residuals
    lengths = np.concatenate([np.linalg.norm(view.image, axis=1) for view in residuals])
    return float(np.sqrt(np.mean(lengths**2)))


def best(run: Callable[[], float], repeats: int) -> tuple[float, float]:
    """Least time in seconds, and the result."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        result = run()
        times.append(time.perf_counter() - began)
    return min(times), result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=3)
    repeats = parser.parse_args().repeats
    cv2.setNumThreads(1)
    print(f"OpenCV {cv2.__version__}, 156 corners a view, best of {repeats}, one BLAS thread")
    print("views  ours  paper's model  OpenCV  ratio  OpenCV with SDs  ratio  difference of RMS")
    with threadpool_limits(1):
        ours(corners(2 * 65), "opencv")  # compiles, once
        for count in COUNTS:
            views = corners(count)
            forward, rms = best(partial(ours, views, "opencv"), repeats)
            paper, _ = best(partial(ours, views, "lucchese"), repeats)
            plain, theirs = best(partial(opencv, views, False), repeats)
            row = f"{count:5d} {1e3 * forward:5.0f} {1e3 * paper:14.0f} {1e3 * plain:7.0f}"
            row += f" {plain / forward:6.1f}"
            if count <= WITH_DEVIATIONS:
                full, _ = best(partial(opencv, views, True), 1)
                row += f" {1e3 * full:16.0f} {full / forward:6.1f}"
            else:
                row += f" {'-':>16} {'-':>6}"
            print(f"{row} {abs(rms - theirs):18.1e}", flush=True)
    print("times in ms")


if __name__ == "__main__":
    main()

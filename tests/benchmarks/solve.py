"""Our calibration against OpenCV's and mrcal's, same corners: `python -m tests.benchmarks.solve`.

Two comparisons, all programs on one thread.

whole: from corners to result. Ours is ``calibrate`` with everything that it returns: checks,
Stage I of up to 25 views, from which it starts (that of all is done when somebody reads it),
standard deviations of camera and poses, doubt about the board, residuals in the image and on the
board. OpenCV is timed as users call it, without standard deviations, and with
them as long as that takes less than 20 seconds.

solve: from one start, ours, to the minimum. Ours includes the standard deviations of camera and
poses; OpenCV starts from our intrinsics, mrcal from our intrinsics and poses, and both stop
without standard deviations.

All fit the forward model with k1, k2, p1, p2, k3 and end at the same minimum, whose cost is
compared; ours is also timed with the paper's model. What counts is the time on the processor, so
that a busy machine measures the same ratios; `--clock perf_counter` counts the clock's.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from matplotlib.figure import Figure
from threadpoolctl import threadpool_limits

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation.stage_one import register_views
from calibgui.engine.calibration.initialisation.start import (
    check_facing,
    convert_to_paper_frame,
    initialise_stage_two,
)
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    measure_pitch,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement import residuals as residuals_module
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import find_model, list_parameter_names
from calibgui.engine.geometry import rotations
from calibgui.engine.kernels import common
from tests.engine.scenes import VGA, brown, looking, seen

BOARD = Board(rows=12, cols=13, square=30.0)
COUNTS = (10, 25, 50, 100, 200, 500, 1000, 2000, 5000)
DRAWN = {
    "solve": "ours, forward model, with standard deviations",
    "solve, paper's model": "ours, the paper's model, with standard deviations",
    "solve, OpenCV": "OpenCV",
    "solve, mrcal": "mrcal",
    "whole, OpenCV with SDs": "OpenCV with standard deviations",
}
"""What the figure shows, and how it is called there."""
BOARD_SHAPES = ("affine", "bow", "free")
LONGEST = 20.0
"""Seconds beyond which OpenCV's standard deviations are not waited for."""
CRITERIA = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-12)
MRCAL_PYTHON = Path("/usr/bin/python3")
"""Where Debian's python3-mrcal is."""
Timed = Callable[[], float]


def corners(count: int) -> list[Observation]:
    """`count` random views of a 12 x 13 board with 0.1 px of noise."""
    camera, rng = brown(), np.random.default_rng(count)
    poses = [looking(camera, rng, board=BOARD, fill=(0.4, 0.8)) for _ in range(count)]
    return seen(camera, poses, board=BOARD).noisy(0.1, rng)


def whole(views: list[Observation], model: str, board_shape: str = "nominal") -> float:
    """RMS of our calibration, px."""
    residuals = calibrate(views, VGA, model=model, board_shape=board_shape).residuals
    lengths = np.concatenate([np.linalg.norm(view.image, axis=1) for view in residuals])
    return float(np.sqrt(np.mean(lengths**2)))


def started(views: list[Observation], model: str) -> tuple[Observations, State]:
    """The views as the solver takes them, and its start."""
    observations = pack_observations(views)
    scale = REFERENCE_PITCH / measure_pitch(observations)
    facing = check_facing(observations, name_views(len(views)))
    first = register_views(*convert_to_paper_frame(observations, scale, VGA, facing))
    held = dict.fromkeys(find_model(model).held)
    start = initialise_stage_two(observations, first, VGA, model, held)
    return observations, start


def solve(observations: Observations, start: State, model: str) -> float:
    """RMS of our solve, px, with the standard deviations of camera and poses on the way."""
    free = np.arange(9)
    normal_at = residuals_module.build_stage_two(observations, model, Cost.IMAGE, 1.0, free)
    square = float(np.sum(observations.uv**2))
    solution = minimise(normal_at, start, free, observations.count, square)
    names = tuple(list_parameter_names(model)[:9])
    found = covariances.measure_precision(
        solution.normal, names, observations.count, np.full(9, np.inf)
    )
    local = covariances.compute_pose_covariances(found.reduced, found.shared, found.variance)
    rvecs = rotations.vector_from_rotation(solution.state.R)
    covariances.convert_pose_covariances(local, rvecs)
    return float(np.sqrt(solution.normal.cost / observations.count))


def opencv(views: list[Observation], start: State | None = None, deviations: bool = False) -> float:
    """RMS of OpenCV's solve, px; from the camera of a start, or from its own."""
    boards = [np.column_stack([v.xy, np.zeros(len(v.xy))]).astype(np.float32) for v in views]
    uv = [v.uv.astype(np.float32).reshape(-1, 1, 2) for v in views]
    run = cv2.calibrateCameraExtended if deviations else cv2.calibrateCamera
    if start is None:
        return float(run(boards, uv, VGA, None, None, criteria=CRITERIA)[0])
    fx, fy, cx, cy, *lens = start.params
    K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    flags = cv2.CALIB_USE_INTRINSIC_GUESS
    return float(run(boards, uv, VGA, K, np.array(lens[:5]), flags=flags, criteria=CRITERIA)[0])


def mrcal(
    observations: Observations, start: State, repeats: int, clock: str
) -> tuple[float, float] | None:
    """Least time in seconds and RMS, px, of mrcal's solve; None where it is not installed."""
    with tempfile.TemporaryDirectory() as folder:
        given = Path(folder, "given.npz")
        np.savez(
            given,
            boards=observations.uv.reshape(-1, BOARD.rows, BOARD.cols, 2),
            params=start.params[:9],
            poses=np.column_stack([rotations.vector_from_rotation(start.R), start.T]),
            size=np.array(VGA),
            square=BOARD.square,
        )
        command = [MRCAL_PYTHON, "-m", "tests.benchmarks.mrcal_solve", given, str(repeats), clock]
        try:
            answer = subprocess.run(
                command,
                capture_output=True,
                text=True,
                env={"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
                check=True,
            )
        except (OSError, subprocess.CalledProcessError):
            return None
    seconds, rms = map(float, answer.stdout.split())
    return seconds, rms


def best(run: Timed, repeats: int, clock: str) -> tuple[float, float]:
    """Least time in seconds, and the result."""
    now, times = getattr(time, clock), []
    for _ in range(repeats):
        began = now()
        result = run()
        times.append(now() - began)
    return min(times), result


def exponent(times: dict[int, float]) -> float:
    """Slope of log time over log number of views, from 100 views on."""
    counts = [count for count in times if count >= 100]
    if len(counts) < 2:
        return float("nan")
    return float(np.polyfit(np.log(counts), np.log([times[c] for c in counts]), 1)[0])


def drawn(times: dict[str, dict[int, float]], path: Path) -> None:
    """The growth of the solves' times with the number of views, as a figure."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.add_subplot()
    for name, series in times.items():
        if label := DRAWN.get(name):
            label = f"{label}: grows with exponent {exponent(series):.2f}"
            axes.loglog(list(series), list(series.values()), "o-", label=label)
    axes.set_xlabel("views of 156 corners")
    axes.set_ylabel("processor's seconds")
    axes.grid(True, which="both", alpha=0.3)
    figure.legend(loc="outside lower center", fontsize=8)
    figure.savefig(path, dpi=150)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--views", type=int, nargs="+", default=COUNTS)
    parser.add_argument("--clock", choices=["perf_counter", "process_time"], default="process_time")
    parser.add_argument("--figure", type=Path, help="file for the figure of growth")
    arguments = parser.parse_args()
    clock = arguments.clock
    cv2.setNumThreads(1)
    common.THREADS = 1
    print(
        f"OpenCV {cv2.__version__}, 156 corners a view, one thread, {clock}, "
        f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"
    )
    times: dict[str, dict[int, float]] = {}
    with threadpool_limits(1):
        solve(*started(corners(2), "lucchese"), "lucchese")  # compiles, once
        for board_shape in BOARD_SHAPES:
            whole(corners(8), "brown-conrady", board_shape)
        for count in arguments.views:
            row = measured(count, arguments.repeats if count <= 500 else 3, clock, times)
            for name, seconds in row.items():
                times.setdefault(name, {})[count] = seconds
            report(count, row)
    for name, series in times.items():
        print(f"{name:28s} grows with exponent {exponent(series):.2f}")
    if arguments.figure:
        drawn(times, arguments.figure)


def measured(
    count: int, repeats: int, clock: str, before: dict[str, dict[int, float]]
) -> dict[str, float]:
    """Seconds that everything takes with `count` views; checks that all end at one cost."""
    views = corners(count)
    run = partial(best, repeats=repeats, clock=clock)
    row: dict[str, float] = {}
    rms: dict[str, float] = {}
    row["whole, paper's model"], _ = run(partial(whole, views, "lucchese"))
    row["whole"], rms["whole"] = run(partial(whole, views, "brown-conrady"))
    for board_shape in BOARD_SHAPES:
        row[f"whole, {board_shape} board"], _ = run(
            partial(whole, views, "brown-conrady", board_shape)
        )
    row["whole, OpenCV"], rms["OpenCV"] = run(partial(opencv, views))
    slow = before.get("whole, OpenCV with SDs", {})
    if not slow or slow[max(slow)] * (count / max(slow)) ** 3 < LONGEST:
        row["whole, OpenCV with SDs"], _ = best(partial(opencv, views, None, True), 1, clock)
    paper = started(views, "lucchese")
    row["solve, paper's model"], _ = run(partial(solve, *paper, "lucchese"))
    observations, start = started(views, "brown-conrady")
    row["solve"], rms["solve"] = run(partial(solve, observations, start, "brown-conrady"))
    row["solve, OpenCV"], _ = run(partial(opencv, views, start))
    if found := mrcal(observations, start, repeats, clock):
        row["solve, mrcal"], rms["mrcal"] = found
    apart = max(rms.values()) - min(rms.values())
    if apart > 1e-5:
        print(f"RMS differ by {apart:.1e} px: {rms}", file=sys.stderr)
    return row


def report(count: int, row: dict[str, float]) -> None:
    """Print the times, and how they compare."""
    print(f"\n{count} views")
    for name, seconds in row.items():
        kind = name.partition(",")[0]
        own = ["", " paper's model"]
        ratios = [
            f"{seconds / row[kind + (',' + model if model else '')]:.1f} times ours{model}"
            for model in own
        ]
        theirs = "OpenCV" in name or "mrcal" in name
        compared = ", ".join(ratios) if theirs else f"{seconds / row[kind]:.2f} times plain"
        print(f"  {name:26s} {1e3 * seconds:10.1f} ms   {compared}", flush=True)


if __name__ == "__main__":
    main()

"""Lens models against each other: `python -m tests.benchmarks.lens_models`.

accuracy: the 186-degree fisheye of BabelCalib's ov_plane, nothing given but its corners: 18 views
to calibrate from, 7 unseen ones of which only poses are fitted. The figures are root mean square
distances, px, of the corners as they are, none left out. OpenCV's fisheye calibration is tried on
the same views.

speed: ``calibrate`` from corners to result, with standard deviations, on synthetic views of a lens
of each model without skew, which is held, as a multiple of the time of Brown's model on a lens of
its own, one thread.

spline: the splined model of 30 x 20 control points and Brown's on the same views, measured in turn,
as the machine may be shared. Brown's lens is one of 55 degrees, of which corners touch a quarter of
the control points, and one of 116 degrees, of which they touch three quarters.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import partial

import cv2
import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.engine.assessment.choices.cross_validation import resect_views
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import ViewResiduals
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import common
from tests.babelcalib import OV_PLANE_SIZE, read_ov_plane
from tests.conftest import find_data_dir
from tests.engine.scenes import BOARD, LENSES, VGA, brown, example, imaged, looking, seen

BASE = "brown-conrady"
"""The model that others are compared with."""

SPLINED = "splined-stereographic-30x20-150"
"""The splined model whose time is told on Brown's views."""
WIDE = Camera(VGA, [237, 237, 303, 243, -0.1, 0.02, 3e-4, -5e-4, -2e-3], BASE)
"""A wide lens that Brown's model follows."""

CALIB_FLAGS = cv2.CALIB_RECOMPUTE_EXTRINSIC | cv2.CALIB_FIX_SKEW
"""Flags of ``cv2.fisheye.calibrate`` as its users set them."""


def measure_rms(residuals: tuple[ViewResiduals, ...]) -> float:
    """RMS distance, px."""
    return float(np.sqrt(np.mean(np.concatenate([np.sum(v.image**2, axis=1) for v in residuals]))))


def try_opencv(views: list[Observation]) -> str:
    """RMS of cv2.fisheye's solve, px, or what it says."""
    boards = [np.column_stack([v.xy, np.zeros(len(v.xy))]).reshape(1, -1, 3) for v in views]
    uv = [v.uv.reshape(1, -1, 2) for v in views]
    K, D = np.eye(3), np.zeros((4, 1))
    flags = CALIB_FLAGS
    try:
        rms = cv2.fisheye.calibrate(boards, uv, OV_PLANE_SIZE, K, D, flags=flags)[0]
    except cv2.error as error:
        return f"throws: {error.err}"
    return f"{rms:.4f}"


def compare_accuracy() -> None:
    """Print the table of ov_plane."""
    folder = find_data_dir() / "babelcalib_ov_plane"
    training, unseen = read_ov_plane(folder, "train"), read_ov_plane(folder, "test")
    print(f"{'model':28s} n  training   unseen")
    for model in MODELS:
        if model == "lucchese-pixels":
            continue
        try:
            found = calibrate(training, OV_PLANE_SIZE, model=model)
        except CalibrationError as error:
            print(f"{model:28s} {error.message}")
            continue
        held_out = measure_rms(resect_views(found, unseen))
        free = len(found.camera.names) - len(found.fixed)
        print(f"{model:28s} {free:2d}  {measure_rms(found.residuals):.4f}  {held_out:.4f}")
    print(f"{'cv2.fisheye':28s}  8  {try_opencv(training)}")


def make_views(model: str, count: int) -> list[Observation]:
    """`count` views of a camera with a lens of the model without skew, 0.1 px of noise."""
    rng = np.random.default_rng(count)
    camera = example(model)
    values = zip(camera.names, camera.params, strict=True)
    camera = Camera(VGA, [0.0 if name == "skew" else value for name, value in values], model)
    return seen(camera, [looking(camera, rng) for _ in range(count)]).noisy(0.1, rng)


def time_best(run: Callable[[], object], repeats: int) -> float:
    """Least processor's seconds of some runs."""
    times = []
    for _ in range(repeats):
        began = time.process_time()
        run()
        times.append(time.process_time() - began)
    return min(times)


def compare_speed(count: int, repeats: int) -> None:
    """Print the times of all models with `count` views."""
    names = [name for name in LENSES if name != "lucchese-pixels"]
    views = {name: make_views(name, count) for name in names}

    def measure(name: str) -> float:
        calibrate(views[name], VGA, model=name)  # compiles, once
        return time_best(lambda: calibrate(views[name], VGA, model=name), repeats)

    base = measure(BASE)
    print(f"\n{count} views of 108 corners, {BASE}: {1e3 * base:.1f} ms")
    for name in names:
        print(f"  {name:28s} {measure(name) / base:6.2f} times", flush=True)


def make_inner_views(camera: Camera, count: int) -> list[Observation]:
    """`count` views of boards all of whose corners are in the image, 0.1 px of noise."""
    rng, views = np.random.default_rng(count), []
    while len(views) < count:
        pose = looking(camera, rng, fill=(0.4, 0.8))
        uv = imaged(camera, pose, BOARD.points())
        if (np.abs(uv - np.array(VGA) / 2) <= np.array(VGA) / 2).all():
            views.append(Observation(uv + rng.normal(scale=0.1, size=uv.shape), BOARD.points()))
    return views


def compare_spline(count: int, repeats: int) -> None:
    """Print the times of the splined model and of Brown's on the same `count` views."""
    for title, camera in (("55 degrees", brown()), ("116 degrees", WIDE)):
        views = make_inner_views(camera, count)
        times: dict[str, list[float]] = {BASE: [], SPLINED: []}
        for name in times:
            calibrate(views, VGA, model=name)  # compiles, once
        for _ in range(repeats):
            for name, found in times.items():
                found.append(time_best(partial(calibrate, views, VGA, model=name), 3))
        base, splined = min(times[BASE]), min(times[SPLINED])
        print(
            f"\n{count} views of {title}: {BASE} {1e3 * base:.1f} ms, {SPLINED} "
            f"{1e3 * splined:.1f} ms, {splined / base:.1f} times"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--views", type=int, nargs="+", default=(25, 100))
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--part", choices=["accuracy", "speed", "spline", "all"], default="all")
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    common.THREADS = 1
    with threadpool_limits(1):
        if arguments.part in ("accuracy", "all"):
            compare_accuracy()
        for count in arguments.views:
            if arguments.part in ("speed", "all"):
                compare_speed(count, arguments.repeats)
            if arguments.part in ("spline", "all"):
                compare_spline(count, arguments.repeats)


if __name__ == "__main__":
    main()

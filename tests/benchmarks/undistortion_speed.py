"""How long does the map of an undistorted image take? Ours for every lens model, and OpenCV's.

    python -m tests.benchmarks.undistortion_speed [--megapixels 12]

prints the times of the clock for the map from the pixels of an undistorted image to those of the
photograph, and their ratios to that of cv2.initUndistortRectifyMap for a lens of the same size in
the same run, taken in turns. OpenCV uses all processors, ours one; ours is made in bands of rows as
an image is, so that it needs no memory of the map's size. Goals of the project, as ratios: a third
for models whose projection is a closed form, one for all. A second table has the projections of a
fisheye and cv2.fisheye.initUndistortRectifyMap.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Mapping
from functools import partial

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cv2
import numpy as np

from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.outline import prepare_tracing
from calibgui.engine.images.projections import IdealCamera, Projection
from calibgui.engine.images.smooth_map import interpolate_map
from calibgui.engine.images.undistortion import choose_ideal_cameras
from tests.engine.scenes import LENSES

REPEATS = 7
ITERATIVE = ("lucchese", "lucchese-pixels", "division", "scaramuzza")
"""Models whose projection is solved for, not a closed form."""
PIXELS_PER_BAND = 1 << 19


def make_map(camera: Camera, ideal: IdealCamera) -> None:
    """The whole map, band by band, as `make_ideal_image` makes it."""
    trace_rays = prepare_tracing(camera)
    rows_of = interpolate_map(
        ideal.size,
        lambda p: trace_rays(ideal.continue_rays(p)),
        np.full(2, -0.5),
        np.array(camera.size) - 0.5,
    )
    width, height = ideal.size
    rows = max(PIXELS_PER_BAND // width, 1)
    for v in range(0, height, rows):
        rows_of(slice(v, min(v + rows, height)))


def measure(works: Mapping[str, Callable[[], object]]) -> dict[str, float]:
    """Least time, ms, of each work, taken in turns: what disturbs one only adds."""
    times = dict.fromkeys(works, np.inf)
    for _ in range(REPEATS):
        for name, work in works.items():
            start = time.perf_counter()
            work()
            times[name] = min(times[name], 1e3 * (time.perf_counter() - start))
    return times


def show(times: Mapping[str, float], peer: str) -> None:
    print(f"\n{'':34}{'ms':>8}{'ratio':>8}")
    for name, spent in times.items():
        print(f"{name:34}{spent:8.1f}{spent / times[peer]:8.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--megapixels", type=float, default=12.0)
    width = round(np.sqrt(parser.parse_args().megapixels * 1e6 * 4 / 3))
    size = (width, round(0.75 * width))
    f, c = 1.016 * width, (0.473 * width, 0.38 * width)

    peer = "cv2.initUndistortRectifyMap"
    brown = Camera(size, [f, f, *c, -0.25, 0.12, 3e-4, -5e-4, -0.03], "brown-conrady")
    matrix = choose_ideal_cameras(brown)[""].matrix
    distortion = brown.coefficients[:5].copy()
    works: dict[str, Callable[[], object]] = {
        peer: lambda: cv2.initUndistortRectifyMap(
            brown.matrix, distortion, None, matrix, size, cv2.CV_32FC1
        )
    }
    for model, coefficients in LENSES.items():
        focal = f * (1 + coefficients[0]) if model == "mei" else f
        camera = Camera(size, [focal, focal, *c, *coefficients], model)
        ideal = choose_ideal_cameras(camera)[""]
        name = f"{model}{' (iterative)' if model in ITERATIVE else ''}"
        works[name] = partial(make_map, camera, ideal)
    show(measure(works), peer)

    peer = "cv2.fisheye.initUndistortRectifyMap"
    fisheye = Camera(size, [f / 4, f / 4, *c, 0.01, -3e-3, 0, 0], "kannala-brandt")
    fisheye_matrix = choose_ideal_cameras(fisheye)[""].matrix
    works = {
        peer: lambda: cv2.fisheye.initUndistortRectifyMap(
            fisheye.matrix,
            fisheye.coefficients.copy(),
            np.eye(3),
            fisheye_matrix,
            size,
            cv2.CV_32FC1,
        )
    }
    for projection in Projection:
        for face, ideal in choose_ideal_cameras(fisheye, projection=projection).items():
            works[f"{projection} {face}"] = partial(make_map, fisheye, ideal)
    show(measure(works), peer)


if __name__ == "__main__":
    main()

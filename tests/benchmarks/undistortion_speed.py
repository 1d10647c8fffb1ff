"""How long does an undistorted image take? Ours, and OpenCV's.

    python -m tests.benchmarks.undistortion_speed [--megapixels 12]

prints three tables of times and their ratios to those of OpenCV in the same run, taken in turns.

The first is of the whole call, from camera and photograph (8 bits, three channels) to the new
image and the mask of its valid pixels: ours for three lens models, which also chooses the new
image's focal length, and cv2.undistort and cv2.fisheye.undistortImage, which are told it. All have
one thread, as the program gives each processor an image of its own. Goal of the project: a ratio of
at most 1.2, by the clock and in processor time.

The second is of the map alone, from the pixels of an undistorted image to those of the photograph,
for every lens model, and cv2.initUndistortRectifyMap for a lens of the same size. OpenCV uses all
processors, ours one; ours is made in bands of rows as an image is, so that it needs no memory of
the map's size. Goals of the project, as ratios: a third for models whose projection is a closed
form, one for all. The third has the maps of a fisheye's projections and
cv2.fisheye.initUndistortRectifyMap.
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

from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.outline import prepare_tracing
from calibgui.engine.images.projections import IdealCamera, Projection
from calibgui.engine.images.smooth_map import interpolate_map
from calibgui.engine.images.undistortion import choose_ideal_cameras, undistort_image
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


def measure(works: Mapping[str, Callable[[], object]]) -> dict[str, Array]:
    """Least times (2,), ms, of each work by the clock and by the processors.

    The works take turns, and the least counts: what disturbs one only adds.
    """
    times = {name: np.full(2, np.inf) for name in works}
    for _ in range(REPEATS):
        for name, work in works.items():
            start = np.array([time.perf_counter(), time.process_time()])
            work()
            spent = np.array([time.perf_counter(), time.process_time()]) - start
            times[name] = np.minimum(times[name], 1e3 * spent)
    return times


def show(times: Mapping[str, Array], peer: str) -> None:
    print(f"\n{'':34}{'ms':>8}{'ratio':>8}{'CPU ms':>8}{'ratio':>8}")
    for name, (clock, processors) in times.items():
        ratios = np.array([clock, processors]) / times[peer]
        print(f"{name:34}{clock:8.1f}{ratios[0]:8.2f}{processors:8.1f}{ratios[1]:8.2f}")


def measure_whole_calls(brown: Camera, f: float) -> None:
    """Measure the undistortion of photographs by `brown` and by two lenses of focal length `f`."""
    size, centre = brown.size, brown.centre
    image = np.random.default_rng(1).integers(0, 256, (*size[::-1], 3), np.uint8)
    image = cv2.GaussianBlur(image, (0, 0), 3.0)
    paper = Camera(size, [f, f, *centre, *LENSES["lucchese"]])
    fisheye = Camera(size, [f, f, *centre, *LENSES["kannala-brandt"]], "kannala-brandt")
    matrix, k = choose_ideal_cameras(brown)[""].matrix, brown.coefficients[:5].copy()
    fisheye_matrix = choose_ideal_cameras(fisheye)[""].matrix
    peers = {
        "cv2.undistort": lambda: cv2.undistort(image, brown.matrix, k, None, matrix),
        "cv2.fisheye.undistortImage": lambda: cv2.fisheye.undistortImage(
            image, fisheye.matrix, fisheye.coefficients.copy(), None, fisheye_matrix
        ),
    }
    ours = {c.model: partial(undistort_image, image, c) for c in (brown, paper, fisheye)}
    with opencv.single_thread():
        show(measure(peers | ours), "cv2.undistort")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--megapixels", type=float, default=12.0)
    width = round(np.sqrt(parser.parse_args().megapixels * 1e6 * 4 / 3))
    size = (width, round(0.75 * width))
    f, c = 1.016 * width, (0.473 * width, 0.38 * width)

    brown = Camera(size, [f, f, *c, -0.25, 0.12, 3e-4, -5e-4, -0.03], "brown-conrady")
    measure_whole_calls(brown, f)

    peer = "cv2.initUndistortRectifyMap"
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

"""Rigs beside OpenCV's calibrateMultiview and stereoCalibrate: `python -m tests.benchmarks.rig`.

Boards are seen with noise of 0.1 px by cameras in a row, whole or not at all, and every program is
given the same corners and nothing else. What is measured is the processor's time from corners to
the rig, each camera alone included, and the largest error of a camera's centre, mm. OpenCV computes
no standard deviations; calibrateMultiview is given metres, without which it finds nothing.

Another table says which mistakes (``tests/engine/rig/mistaken_rigs.py``) are named, and how often
one is named where there is none; `--seeds 0` leaves it out. Goal: nine of ten, none of 20 clean.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import cv2
import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig import Mistake, RigCamera, calibrate_rig
from tests.engine.rig.mistaken_rigs import LENSES, MISTAKES, make_mistaken
from tests.engine.rig.scenes import BOARD, RigScene, make_rig

RIGS = ((2, 25), (4, 50), (8, 100), (8, 2000))
"""Numbers of cameras and instants."""
MAX_PEERS = 100
"""Number of instants up to which OpenCV is waited for."""
SIGMA = 0.1


def make_scene(cameras: int, instants: int) -> RigScene:
    """A rig whose cameras see the board whole or not at all."""
    scene = make_rig(cameras, instants, seed=1, spacing=50.0, turn=0.05, lenses=LENSES)
    whole = len(BOARD.points())
    kept = tuple(
        replace(c, views={k: view for k, view in c.views.items() if len(view.uv) == whole})
        for c in scene.cameras
    )
    return replace(scene, cameras=kept)


def measure_centres(R: Sequence[Array], T: Sequence[Array], scene: RigScene) -> float:
    """The largest error of a camera's centre in the first one's frame, mm."""
    errors = []
    for Q, S, true in zip(R, T, scene.poses, strict=True):
        found = -Q.T @ S
        errors.append(np.linalg.norm(found + rotation_from_vector(true.rvec).T @ true.tvec))
    return float(max(errors))


def solve_here(scene: RigScene, cameras: Sequence[RigCamera]) -> float:
    """Calibrate each camera alone and all together."""
    known = []
    for camera in cameras:
        views = list(camera.views.values())
        found = calibrate(views, camera.camera.size, model="brown-conrady", model_errors=False)
        known.append(replace(camera, camera=found.camera, fixed=found.fixed))
    rig = calibrate_rig(known)
    R = [rotation_from_vector(pose.rvec) for pose in rig.poses]
    return measure_centres(R, [pose.tvec for pose in rig.poses], scene)


def solve_multiview(scene: RigScene, cameras: Sequence[RigCamera]) -> float:
    """Let OpenCV calibrate all cameras together."""
    instants = sorted({k for camera in cameras for k in camera.views})
    xy = BOARD.points() / 1000
    board = np.c_[xy, np.zeros(len(xy))].astype(np.float32)
    mask = np.array([[k in camera.views for k in instants] for camera in cameras], np.uint8)
    images = [
        [
            camera.views[k].uv.astype(np.float32) if k in camera.views else np.zeros((0, 2), "f4")
            for k in instants
        ]
        for camera in cameras
    ]
    sizes = [camera.camera.size for camera in cameras]
    models = np.zeros(len(cameras), np.uint8)
    found = cv2.calibrateMultiview(
        [board] * len(instants), images, sizes, mask, models, None, None, None, None
    )
    R = [cv2.Rodrigues(r)[0] if r.size == 3 else r for r in map(np.asarray, found[3])]
    return measure_centres(R, [1000 * np.ravel(t) for t in found[4]], scene)


def solve_stereo(scene: RigScene, cameras: Sequence[RigCamera]) -> float:
    """Let OpenCV calibrate two cameras, each alone first."""
    shared = sorted(set(cameras[0].views) & set(cameras[1].views))
    xy = BOARD.points()
    board = np.c_[xy, np.zeros(len(xy))].astype(np.float32)
    alone, images = [], []
    for camera in cameras:
        own = [view.uv.astype(np.float32) for view in camera.views.values()]
        alone += cv2.calibrateCamera([board] * len(own), own, camera.camera.size, None, None)[1:3]
        images.append([camera.views[k].uv.astype(np.float32) for k in shared])
    size = cameras[0].camera.size
    found = cv2.stereoCalibrate([board] * len(shared), *images, *alone, size, flags=0)
    return measure_centres([np.eye(3), found[5]], [np.zeros(3), found[6].ravel()], scene)


PROGRAMS: dict[str, Callable[[RigScene, Sequence[RigCamera]], float]] = {
    "calibgui": solve_here,
    f"OpenCV {cv2.__version__} calibrateMultiview": solve_multiview,
    f"OpenCV {cv2.__version__} stereoCalibrate": solve_stereo,
}


def compare_programs(repeat: int) -> None:
    """Print a table of times and errors."""
    print(f"{'cameras x instants':20}{'program':38}{'CPU, s':>8}{'centre, mm':>12}{'MB':>7}")
    for count, instants in RIGS:
        scene = make_scene(count, instants)
        cameras = scene.noisy(SIGMA, np.random.default_rng(1))
        for name, solve in PROGRAMS.items():
            is_peer = solve is not solve_here
            if (is_peer and instants > MAX_PEERS) or (solve is solve_stereo and count > 2):
                continue
            times = []
            for _ in range(repeat if instants <= MAX_PEERS else 1):
                began = time.process_time()
                try:
                    error = f"{solve(scene, cameras):.3f}"
                except cv2.error as failure:
                    error = str(failure).split(":")[-1].strip()[:20]
                times.append(time.process_time() - began)
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            print(f"{f'{count} x {instants}':20}{name:38}{min(times):8.2f}{error:>12}{peak:7.0f}")


def count_named(seeds: int) -> None:
    """Print how often each mistake is named."""
    print(f"\n{'mistake':16}{'named':>10}{'others named':>14}")
    for name, (_, wanted) in MISTAKES.items():
        draws = seeds if wanted else 2 * seeds
        named = others = 0
        for seed in range(draws):
            found = {each.kind for each in calibrate_rig(make_mistaken(name, seed)).mistakes}
            named += wanted <= found
            others += bool(found - wanted - {Mistake.LESS_AGREEMENT} if wanted else found)
        print(f"{name:16}{f'{named} of {draws}' if wanted else '-':>10}{others:>14}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3, help="runs, of which the least counts")
    parser.add_argument("--seeds", type=int, default=10, help="rigs with each mistake")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    with threadpool_limits(1):
        compare_programs(options.repeat)
        if options.seeds:
            count_named(options.seeds)


if __name__ == "__main__":
    main()

"""How well are boards read that are no checkerboards? Ours and others', from the same photographs.

    python -m tests.benchmarks.boards [--quick]

draws ChArUco boards, AprilGrids, PuzzleBoards and grids of circles under several conditions and
prints for each reader (`board_readers`) how many of the points in view it found in their place, how
many under a wrong number, its root mean square error per axis over the Cramer-Rao bound, the mean
squared error in units of its covariance, and the time of the processor. Below stands the time over
that of a checkerboard with as many squares.

The bound of a point is noise^2 F^-1 with F = sum of (grad I)(grad I)^T over the pixels that show
what lies nearer to it than to any other point and belongs to it: the edges that cross in it, as far
as nothing else is printed there, or the whole circle. The gradient is that of the pixels' own
levels, from images by a camera whose centre is shifted.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cv2
import numpy as np
import scipy
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import rays_and_slopes
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.rendering import Appearance, compute_irradiance
from tests.benchmarks.board_readers import BOARDS, MISSING, READERS, Image, Reader

Array = NDArray[np.float64]
_SIZE = (640, 480)
_NORMAL = [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0]
_WIDE = [300.0, 300.0, 320.0, 240.0, 0.35, 0.1, 0.0, 0.0, 0.0, 0.0]
_SHIFT = 0.1
"""Shift of the camera's centre for the gradient, px."""
_MAX_ERROR = 1.0
"""Distance from its place beyond which a point counts as wrong, px."""
_PLAIN = {"charuco": 0.12, "aprilgrid": 0.15, "puzzleboard": 1 / 3}
"""How far from the edges that cross in a corner nothing else is printed, pitches."""
_REACH = {"puzzleboard": 1 / 3}
"""How far those edges reach without anything on them, pitches; elsewhere half-way to the next."""


@dataclass(frozen=True)
class Conditions:
    """How a photograph is taken."""

    width: float = 0.6
    """Width of the board over the image's."""
    tilt: float = 0.45
    """Rotation about u and v, at most, rad."""
    aside: float = 0.0
    """Distance of the board's middle from the image's, widths of the image."""
    blur: float = 0.7
    noise: float = 2.0
    intrinsics: tuple[float, ...] = tuple(_NORMAL)
    appearance: Appearance | None = None
    is_inverted: bool = False


CONDITIONS = {
    "base": Conditions(),
    "noise 10": Conditions(noise=10.0),
    "blur 2": Conditions(blur=2.0),
    "small": Conditions(width=0.35),
    "tilted": Conditions(tilt=0.95),
    "fisheye": Conditions(intrinsics=tuple(_WIDE), width=0.7),
    "cut": Conditions(aside=0.4),
    "dim": Conditions(appearance=Appearance(12.0, 34.0, 20.0), noise=1.0),
    "inverted": Conditions(is_inverted=True),
}


class Photograph(NamedTuple):
    image: Image
    truth: Array
    """(rows, cols, 2) px."""
    in_view: NDArray[np.bool_]
    """(rows, cols) True for points that can be seen."""
    bound: Array
    """(rows, cols, 2, 2) px^2."""


class Score(NamedTuple):
    """Of one reader under one condition."""

    found: float
    wrong: int
    ratio: float
    chi2: float
    ms: float


def photograph(board: Board, conditions: Conditions, seed: int) -> Photograph:
    """Draw a photograph of a board; the pose follows from `seed`."""
    rng = np.random.default_rng(seed)
    rvec = np.append(rng.uniform(-1, 1, 2) * conditions.tilt, rng.uniform(-0.5, 0.5))
    camera = Camera(_SIZE, np.array(conditions.intrinsics))
    points = board.points()
    across = float(np.ptp(points, axis=0).max())
    distance = camera.params[0] * across / (conditions.width * _SIZE[0])
    direction = rng.choice([-1.0, 1.0])
    R = rotation_from_vector(rvec)
    middle = R[:, :2] @ points.mean(axis=0)
    aside = conditions.aside * direction * _SIZE[0] / camera.params[0] * distance
    pose = Pose(tuple(rvec), np.array([aside, 0.0, distance]) - middle)
    levels, *shifted = (
        compute_irradiance(
            replace(camera, params=camera.params + shift * (np.arange(len(camera.params)) == axis)),
            pose,
            board,
            blur=conditions.blur,
            appearance=conditions.appearance,
        )
        for shift, axis in ((0.0, 2), (_SHIFT, 2), (_SHIFT, 3))
    )
    gradient = np.stack([(each - levels) / _SHIFT for each in shifted], axis=-1)
    noisy = levels + conditions.noise * rng.standard_normal(levels.shape)
    image = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    truth = project_points(points, camera, pose).reshape(board.rows, board.cols, 2)
    fisher = _sum_information(board, camera, pose, gradient)
    margin = 3 * conditions.blur + 4
    in_view = ((truth > margin) & (truth < np.array(_SIZE) - 1 - margin)).all(axis=2)
    bound = (conditions.noise**2 + 1 / 12) * np.linalg.inv(fisher + 1e-12 * np.eye(2))
    return Photograph(255 - image if conditions.is_inverted else image, truth, in_view, bound)


def _sum_information(board: Board, camera: Camera, pose: Pose, gradient: Array) -> Array:
    """Sum (grad I)(grad I)^T (rows, cols, 2, 2) over the pixels that belong to each point."""
    kind = board.pattern.kind
    uv = np.stack(np.meshgrid(np.arange(_SIZE[0]), np.arange(_SIZE[1])), axis=-1).astype(float)
    xy = _map_to_board(uv.reshape(-1, 2), camera, pose) / board.square
    places = board.points() / board.square
    xy[~np.isfinite(xy).all(axis=1)] = 1e6
    nearest = np.asarray(scipy.spatial.cKDTree(places).query(xy, p=np.inf)[1])
    d = np.abs(xy - places[nearest])
    reach = _REACH.get(kind, 0.5 if kind != "asymmetric-circles" else 0.7)
    own = d.max(axis=1) < reach
    own &= d.min(axis=1) < _PLAIN.get(kind, np.inf)
    g = gradient.reshape(-1, 2)[own]
    fisher = np.zeros((len(places), 2, 2))
    np.add.at(fisher, nearest[own], g[:, :, None] * g[:, None, :])
    return fisher.reshape(board.rows, board.cols, 2, 2)


def _map_to_board(uv: Array, camera: Camera, pose: Pose) -> Array:
    """Map pixels (n, 2) to the board (n, 2), mm."""
    rays, _ = rays_and_slopes(uv, camera)
    H = np.column_stack([rotation_from_vector(np.array(pose.rvec))[:, :2], pose.tvec])
    at = rays @ np.linalg.inv(H).T
    with np.errstate(all="ignore"):
        return np.where(at[:, 2:] > 0, at[:, :2] / at[:, 2:], np.inf)


def score(reader: Reader, board: Board, photographs: list[Photograph]) -> Score:
    """Run one reader on the photographs of a board."""
    seen, right, wrong, times = 0, 0, 0, []
    errors, bounds, chi2 = [], [], []
    for shot in photographs:
        start = time.process_time()
        read = reader(shot.image, board)
        times.append(time.process_time() - start)
        seen += int(np.count_nonzero(shot.in_view))
        if read is None:
            continue
        wrong_least, good, grid = min(
            (_compare(read.uv, grid, shot.truth) for grid in _list_turns(read.grid, board)),
            key=lambda each: each[0],
        )
        wrong += wrong_least
        at = tuple(grid[good].T)
        right += int(np.count_nonzero(shot.in_view[at]))
        errors.append(read.uv[good] - shot.truth[at])
        bounds.append(shot.bound[at])
        if read.cov is not None:
            e = errors[-1]
            chi2.append(np.einsum("ni,nij,nj->n", e, np.linalg.inv(read.cov[good]), e) / 2)
    ms = 1e3 * float(np.median(times))
    if not right:
        return Score(0.0, wrong, np.nan, np.nan, ms)
    e, b = np.concatenate(errors), np.concatenate(bounds)
    ratio = np.sqrt(np.mean(e**2) / np.mean(np.trace(b, axis1=1, axis2=2) / 2))
    honest = float(np.mean(np.concatenate(chi2))) if chi2 else np.nan
    return Score(right / seen, wrong, float(ratio), honest, ms)


def _list_turns(grid: NDArray[np.int64], board: Board) -> Iterator[NDArray[np.int64]]:
    """List the numberings that a board without numbers allows: as read, and half a turn on."""
    yield grid
    if not board.pattern.identifies_points:
        yield np.array(board.grid_size) - 1 - grid


def _compare(
    uv: Array, grid: NDArray[np.int64], truth: Array
) -> tuple[int, NDArray[np.bool_], NDArray[np.int64]]:
    """Count the points that are wrong, and tell which are right under a numbering."""
    inside = ((grid >= 0) & (grid < truth.shape[:2])).all(axis=1)
    off = np.full(len(uv), np.inf)
    off[inside] = np.linalg.norm(uv[inside] - truth[tuple(grid[inside].T)], axis=1)
    good = off < _MAX_ERROR
    return int(np.count_nonzero(~good)), good, grid


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one photograph of each kind")
    parser.add_argument("--boards", nargs="+", choices=list(BOARDS), default=list(BOARDS))
    options = parser.parse_args()
    count = 1 if options.quick else 3
    cv2.setNumThreads(1)
    for name in MISSING:
        print(f"{name} is not installed and left out")
    print(f"{'board':20}{'condition':11}{'reader':15}", end="")
    print(f"{'found':>7}{'wrong':>7}{'ratio':>7}{'chi2':>7}{'ms':>8}")
    times: dict[str, Any] = {}
    for kind in options.boards:
        board = BOARDS[kind]
        for name, conditions in CONDITIONS.items():
            if "circles" in kind and conditions.aside:
                continue  # a part of a grid of circles has no numbers
            shots = [photograph(board, conditions, seed) for seed in range(count)]
            for reader_name, reader in READERS[kind].items():
                reader(shots[0].image, board)  # compiles, and draws dictionaries
                s = score(reader, board, shots)
                print(f"{kind:20}{name:11}{reader_name:15}{s.found:7.0%}{s.wrong:7d}", end="")
                print(f"{s.ratio:7.2f}{s.chi2:7.2f}{s.ms:8.1f}", flush=True)
                times.setdefault(reader_name, {}).setdefault(kind, {})[name] = s.ms
    if "checkerboard" in times["ours"]:
        plain = times["ours"]["checkerboard"]
        ratios = {
            kind: float(np.median([ms / plain[name] for name, ms in each.items()]))
            for kind, each in times["ours"].items()
        }
        print("ours, time over the checkerboard's, median of all conditions:")
        print(", ".join(f"{kind} {ratio:.1f}" for kind, ratio in ratios.items()))


if __name__ == "__main__":
    main()

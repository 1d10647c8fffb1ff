"""Whether photographs that do not belong are named: `python -m tests.benchmarks.wrong_views`.

Faults are injected into the corners of one to three of 8 to 30 photographs of real sets: turned by
180 degrees, mirrored, flipped, of another camera of the same make, zoomed, cropped and stretched
back, copies of others that were edited, or of another board. They are calibrated as users do, with
all that is carried out by itself. A fault is

- *named* if all wrong photographs and no others are left out, or named by the verdict,
- *harmless* if all values of the camera are within two of their standard deviations of what the
  good photographs say by themselves with the same lens model and kind of board's shape,
- *false* if a good photograph is left out or named, and *missed* if it is none of these.

A wrong photograph that makes the stated errors larger is the sooner harmless. So those harmless
faults are counted that are *costly*: a value is off by more than two of the standard deviations
that the good photographs have by themselves.

Beside the faults stand subsets of the same sets without any, of which every name is a false one.
Goal: all turned ones named, of the others 95 % named or harmless, one false name in 100 clean sets.

Photographs are searched once, and their corners kept in the folder of temporary files until the
detector changes.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.settings import BEST_SETTINGS
from calibgui.app.photographs.detection import find_views
from calibgui.dataset import CornerSet, Result, View
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import Cause
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera import Camera, project_points
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.formats.corners_json import read_corners, write_corners
from tests.benchmarks.unseen_views import SQUARE, digest_detector
from tests.conftest import find_data_dir

SETS = {
    "bouguet": ("bouguet_calib_example", "Image[0-9]*.tif"),
    "carnd": ("udacity_carnd_9x6_partial", "*.jpg"),
    "gopro": ("gopro_udacity_wide", "GOPR*.jpg"),
    "stereo left": ("stereo_sourishg", "left*.jpg"),
    "stereo right": ("stereo_sourishg", "right*.jpg"),
    "fisheye left": ("fisheye_pairs_sourishg", "left*.jpg"),
    "fisheye right": ("fisheye_pairs_sourishg", "right*.jpg"),
}
"""Folder and pattern of the photographs of each set."""
OTHER_SIDE = {"left": "right", "right": "left"}
COUNTS = (8, 30)
"""Least and largest number of photographs."""
MAX_WRONG = 3
"""Largest number of wrong ones among them."""
MAX_SIGMAS = 2.0
"""Distance from what the good photographs say, in standard deviations, that does no harm."""

Rng = np.random.Generator


@cache
def load_set(name: str) -> CornerSet:
    """Read the corners of a set from the folder of temporary files, or search and keep them."""
    folder, glob = SETS[name]
    file = Path(tempfile.gettempdir()) / "calibgui-wrong-views"
    file = file / f"{name.replace(' ', '-')}-{digest_detector()}.json"
    if not file.is_file():
        file.parent.mkdir(exist_ok=True)
        found = find_views(sorted((find_data_dir() / folder).glob(glob)))
        write_corners(found.corner_set(SQUARE), file)
    corner_set = read_corners(file)
    return replace(corner_set, views=tuple(view for view in corner_set.views if view.usable))


class Known(NamedTuple):
    """What is known of a whole set by its best calibration."""

    camera: Camera
    poses: dict[str, Pose]
    """Poses of the board by the photograph's path."""


@cache
def find_known(name: str) -> Known:
    """Calibrate a whole set."""
    *_, best = calibrate_best(load_set(name), BEST_SETTINGS, search=False)
    result = best.result
    poses = zip((view.image for view in result.used), result.calibration.poses, strict=True)
    return Known(result.calibration.camera, dict(poses))


def move_corners(
    view: View, size: Size, move: Callable[[Array], Array], is_mirrored: bool = False
) -> View:
    """Return the view with its corners moved in the image; those that leave it are lost.

    Args:
        view: a view with corners.
        size: the image's size, px.
        move: a function of points (n, 2) that returns where they are instead.
        is_mirrored: True if the board is numbered from its other side.
    """
    corners = view.corners
    assert corners is not None and corners.cov is not None
    uv = move(corners.uv)
    step = 0.5 * np.eye(2)
    J = np.stack([move(corners.uv + d) - move(corners.uv - d) for d in step], axis=-1)
    grid = corners.grid
    if is_mirrored:
        grid = np.column_stack([grid[:, 0], corners.shape[1] - 1 - grid[:, 1]])
    kept = np.isfinite(uv).all(axis=1) & (uv > -0.5).all(axis=1)
    kept &= (uv < np.array(size) - 0.5).all(axis=1)
    found = replace(
        corners,
        grid=grid[kept],
        uv=uv[kept],
        estimate=uv[kept],
        cov=(J @ corners.cov @ J.swapaxes(1, 2))[kept],
        blur=None,
        roi=None,
    )
    return replace(view, corners=found)


def turn(view: View, name: str, _: Rng) -> View:
    """Turn a photograph by 180 degrees."""
    last = np.array(load_set(name).size) - 1.0
    return move_corners(view, load_set(name).size, lambda uv: last - uv)


def mirror(view: View, name: str, _: Rng) -> View:
    """Mirror a photograph left to right."""
    w, h = load_set(name).size
    return move_corners(view, (w, h), lambda uv: np.abs([w - 1.0, 0.0] - uv), is_mirrored=True)


def flip(view: View, name: str, _: Rng) -> View:
    """Mirror a photograph top to bottom."""
    w, h = load_set(name).size
    return move_corners(view, (w, h), lambda uv: np.abs([0.0, h - 1.0] - uv), is_mirrored=True)


def take_other_camera(view: View, name: str, rng: Rng) -> View:
    """Take the photograph of the pair's other camera, or move to a camera of the same make."""
    kind, _, side = name.partition(" ")
    if side:
        others = load_set(f"{kind} {OTHER_SIDE[side]}").views
        wanted = view.name.replace(side, OTHER_SIDE[side])
        other = next(each for each in others if each.name == wanted)
        return replace(other, image=view.image)
    camera, pose = find_known(name).camera, find_known(name).poses[view.image]
    names = np.array(camera.names)
    spread = np.where(np.isin(names, ["fx", "fy", "cx", "cy"]), 0.0, 0.05)
    params = camera.params * (1 + spread * rng.normal(size=len(spread)))
    params[:2] *= 1 + 0.01 * rng.normal()
    params[2:4] += 0.01 * np.max(camera.size) * rng.normal(size=2)
    xy = view.observation(load_set(name).board).xy
    d = project_points(xy, Camera(camera.size, params, camera.model), pose)
    return _shift(view, name, d - project_points(xy, camera, pose))


def take_other_board(view: View, name: str, rng: Rng) -> View:
    """Photograph a board that was printed 1 to 4 % wider, as by another printer."""
    camera, pose = find_known(name).camera, find_known(name).poses[view.image]
    xy = view.observation(load_set(name).board).xy
    wider = np.array([1 + rng.choice([-1, 1]) * rng.uniform(0.01, 0.04), 1.0])
    d = project_points(xy * wider, camera, pose) - project_points(xy, camera, pose)
    return _shift(view, name, d)


def zoom(view: View, name: str, rng: Rng) -> View:
    """Zoom in or out by 5 to 25 %."""
    factor = (1 + rng.uniform(0.05, 0.25)) ** rng.choice([-1, 1])
    centre = find_known(name).camera.centre
    return move_corners(view, load_set(name).size, lambda uv: centre + factor * (uv - centre))


def crop(view: View, name: str, rng: Rng) -> View:
    """Crop a photograph by up to a fifth at each side, and stretch it to the size of the others."""
    size = np.array(load_set(name).size)
    low, high = rng.uniform(0.02, 0.2, 2) * size, size - rng.uniform(0.02, 0.2, 2) * size
    return move_corners(view, load_set(name).size, lambda uv: (uv - low) * size / (high - low))


def edit_copy(view: View, name: str, rng: Rng) -> View:
    """Straighten a copy of another photograph: turned by 2 to 15 degrees, and scaled to fill."""
    angle = rng.choice([-1, 1]) * np.radians(rng.uniform(2, 15))
    c, s = np.cos(angle), np.sin(angle)
    w, h = load_set(name).size
    middle = np.array([w - 1, h - 1]) / 2
    scale = c + abs(s) * max(w, h) / min(w, h)
    R = scale * np.array([[c, -s], [s, c]])
    others = [each for each in load_set(name).views if each.image != view.image]
    copied = others[int(rng.integers(len(others)))]
    moved = move_corners(copied, (w, h), lambda uv: middle + (uv - middle) @ R.T)
    return replace(moved, image=view.image)


def _shift(view: View, name: str, d: Array) -> View:
    assert view.corners is not None
    return move_corners(view, load_set(name).size, lambda uv: uv + d if len(uv) == len(d) else uv)


FAULTS: dict[str, Callable[[View, str, Rng], View]] = {
    "turned": turn,
    "mirrored": mirror,
    "flipped": flip,
    "other camera": take_other_camera,
    "zoomed": zoom,
    "cropped": crop,
    "edited copy": edit_copy,
    "other board": take_other_board,
}
"""The kinds of faults, each with the function that injects it into a photograph."""


class Drawn(NamedTuple):
    """Photographs, some of them wrong."""

    story: str
    corner_set: CornerSet
    wrong: frozenset[str]
    """Paths of the wrong ones."""


def draw(kind: str | None, seed: int) -> Drawn:
    """Draw a subset of a real set, with a kind of fault or with none."""
    rng = np.random.default_rng([seed, len(kind or "")])
    name = list(SETS)[int(rng.integers(len(SETS)))]
    whole = load_set(name)
    count = int(rng.integers(COUNTS[0], min(COUNTS[1], len(whole.views)) + 1))
    chosen = np.sort(rng.choice(len(whole.views), count, replace=False)).tolist()
    views = [whole.views[k] for k in chosen]
    wrong: list[str] = []
    if kind is not None:
        many = int(rng.integers(1, MAX_WRONG + 1))
        for k in rng.permutation(count).tolist():
            moved = FAULTS[kind](views[k], name, rng)
            if len(wrong) < many and moved.usable and moved.corners is not None:
                views[k] = moved
                wrong.append(moved.image)
    story = f"{name}, {len(wrong)} of {count}"
    return Drawn(story, replace(whole, views=tuple(views)), frozenset(wrong))


class Outcome(NamedTuple):
    """What became of drawn photographs."""

    word: str
    """"named", "harmless", "false" or "missed"."""
    told: tuple[str, ...]
    """Names of the photographs that were left out or named."""
    seconds: float
    """Processor time, s."""
    causes: tuple[str, ...]
    """Causes of the last verdict's findings."""
    is_costly: bool = False
    """True if it is harmless only because of larger standard deviations."""


def judge(drawn: Drawn) -> Outcome:
    """Calibrate drawn photographs, and tell what became of them."""
    begin = time.process_time()
    *_, best = calibrate_best(drawn.corner_set, BEST_SETTINGS, search=False)
    result = best.result
    verdict = judge_result(result)
    seconds = time.process_time() - begin
    is_costly = False
    told = {view.image for view in result.views if not view.usable}
    for finding in verdict.findings:
        if finding.cause in (Cause.MIXED_VIEWS, Cause.MISPLACED_CORNERS):
            told |= {result.used[k].image for k in finding.views}
    if told - drawn.wrong:
        word = "false"
    elif told == drawn.wrong:
        word = "named"
    else:
        sigmas = measure_move(result, drawn)
        word = "harmless" if sigmas[0] <= MAX_SIGMAS else "missed"
        is_costly = word == "harmless" and sigmas[1] > MAX_SIGMAS
    causes = tuple(finding.cause.value for finding in verdict.findings)
    names = tuple(sorted(Path(image).name for image in told))
    return Outcome(word, names, seconds, causes, is_costly)


def measure_move(result: Result, drawn: Drawn) -> tuple[float, float]:
    """Measure how far a camera is from what the good photographs say, in its own standard
    deviations and in theirs, by the value that is farthest; infinite if they say nothing."""
    calibration = result.calibration
    good = [
        view.observation(drawn.corner_set.board)
        for view in drawn.corner_set.views
        if view.image not in drawn.wrong
    ]
    settings = {"model": calibration.camera.model, "board_shape": calibration.settings.board_shape}
    held = set(calibration.fixed)
    names = calibration.camera.names
    fix = {name: calibration.camera.params[names.index(name)] for name in held}
    try:
        right = calibrate(good, calibration.camera.size, fix=fix, **settings)
    except CalibrationError:
        return np.inf, np.inf
    d = np.abs(calibration.camera.params - right.camera.params)
    stated, due = (np.where(c.sigma > 0, c.sigma, np.inf) for c in (calibration, right))
    return float(np.max(d / stated)), float(np.max(d / due))


def measure(kind: str | None, seeds: range, verbose: bool) -> list[Outcome]:
    """Judge the draws of a kind, and print a row of the table."""
    outcomes = []
    for seed in seeds:
        drawn = draw(kind, seed)
        outcomes.append(judge(drawn))
        if verbose and outcomes[-1].word in ("missed", "false"):
            wrong = sorted(Path(image).name for image in drawn.wrong)
            print(f"  {seed} {drawn.story}: {wrong}, {outcomes[-1]}", flush=True)
    counts = Counter(outcome.word for outcome in outcomes)
    clean = counts["named"] if kind is None else 0  # nobody named, as is right
    cells = [kind or "none", len(outcomes), counts["named"] - clean, counts["harmless"] + clean]
    cells += [sum(outcome.is_costly for outcome in outcomes), counts["false"], counts["missed"]]
    seconds = float(np.mean([outcome.seconds for outcome in outcomes]))
    print(f"| {' | '.join(map(str, cells))} | {seconds:.2f} |", flush=True)
    return outcomes


def main() -> None:
    """Print a row for each kind of fault, and one for none."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", choices=[*FAULTS, "none"], default=[*FAULTS, "none"])
    parser.add_argument("--draws", type=int, default=25, help="number of sets of each kind")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--clean", type=int, default=100, help="number of sets without a fault")
    parser.add_argument("--verbose", action="store_true", help="print what is missed or false")
    arguments = parser.parse_args()
    print("| fault | sets | named | harmless | costly | false | missed | s |")
    print("| --- | --: | --: | --: | --: | --: | --: | --: |")
    with threadpool_limits(1):
        for kind in arguments.kinds:
            count = arguments.clean if kind == "none" else arguments.draws
            seeds = range(arguments.first, arguments.first + count)
            measure(None if kind == "none" else kind, seeds, arguments.verbose)


if __name__ == "__main__":
    main()

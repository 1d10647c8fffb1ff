"""Errors on unseen views, ours over OpenCV's: `python -m tests.benchmarks.unseen_views`.

The views of every real image set are dealt into five folds. The camera is calibrated from all but
one fold; of the views in that fold only the poses are fitted, alike for all cameras: least squares
in the image, all corners equally good, none left out. The held-out error is the root mean square
distance, px, of the corners from where the camera images them, over all folds together.

Ours are the lens model that is chosen automatically (`--model auto`, with the coefficients that it
holds at 0; once, from all views: the choice has seen the unseen ones, the parameters have not) and
the paper's, with the corners' covariances as a calibration takes them. OpenCV's are the cameras of
``cv2.calibrateCamera`` with 4, 5 and 8 coefficients. All are given the same corners: those of our
detector, or those that come with the set. The goal is a ratio to the best of OpenCV's, which is
picked with hindsight too, of at most 1.02. With it stands its standard error by the views
(jackknife): a ratio within two of them of 1 may be chance.

`--causes` tells where a difference comes from: what the error becomes without covariances (all
corners weigh alike, as OpenCV's do), with k3 held at 0, with p1 and p2 held at 0, with p3 free, and
with Brown's model, which distorts in OpenCV's direction, both with and without covariances.

Corners are searched once and kept in the folder of temporary files until the detector changes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.app.photographs.detection import find_views
from calibgui.engine import detection
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment.choices.cross_validation import DEFAULT_FOLDS
from calibgui.engine.assessment.choices.lens_choice import choose_lens_stepwise
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.boards import CHECKERBOARD, Charuco, Pattern
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.refinement.residuals import State, compute_residuals
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.babelcalib import OV_PLANE_SIZE, read_ov_plane
from tests.conftest import find_data_dir

GOAL = 1.02
"""Ratio to the best of OpenCV's errors that ours are not to exceed."""
SQUARE = 30.0
"""Side of a square where it does not matter, mm: errors in the image do not depend on it."""
FRAME_STEP = 5
"""Distance of the frames that are taken of a video."""
OPENCV = {
    "4": ("brown-conrady-4", cv2.CALIB_FIX_K3),
    "5": ("brown-conrady", 0),
    "8": ("rational", cv2.CALIB_RATIONAL_MODEL),
}
"""Name, lens model and flags of OpenCV's cameras, by the number of coefficients."""
CRITERIA = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 200, 1e-12)
"""OpenCV's own end after 30 iterations is too early for its rational model."""


class ImageSet(NamedTuple):
    """The corners of a set of photographs."""

    size: Size
    """Width and height of the images, px."""
    views: list[Observation]
    """The views in which the board was found."""


class Errors(NamedTuple):
    """Squared distances of the corners from their predictions when their view was held out."""

    squares: list[Array]
    """(K,) of (n,) px^2; infinite where the camera could not be calibrated, or has no image."""

    @property
    def rms(self) -> float:
        """Root mean square distance, px."""
        return float(np.sqrt(np.mean(np.concatenate(self.squares))))

    def compare(self, other: Errors) -> tuple[float, float]:
        """Return the ratio to another camera's error, and its standard error.

        The latter is that of the jackknife, which leaves out one view after the other.
        """
        with np.errstate(invalid="ignore"):
            mine, others = (
                np.array([np.sum(view) for view in errors.squares]) for errors in (self, other)
            )
            without = np.sqrt((mine.sum() - mine) / (others.sum() - others))
            error = np.sqrt(len(without) - 1) * np.std(without)
            return float(np.sqrt(mine.sum() / others.sum())), float(error)


Calibrator = Callable[[list[Observation]], Camera]
"""Function that calibrates a camera from views."""


def search_images(folder: Path, glob: str, pattern: Pattern = CHECKERBOARD) -> ImageSet:
    """Search photographs for the board."""
    images = sorted(folder.glob(glob))
    if not images:
        raise FileNotFoundError(folder / glob)
    found = find_views(images, pattern=pattern)
    corners = found.corner_set(SQUARE)
    usable = [view for view in corners.views if view.usable]
    return ImageSet(corners.size, [view.observation(corners.board) for view in usable])


def search_video(folder: Path, camera: int) -> ImageSet:
    """Search frames of a video for the ChArUco board, whose print is inverted."""
    video = cv2.VideoCapture(str(folder / "calibration" / "extrinsic" / f"cam_{camera}.mp4"))
    if not video.isOpened():
        raise FileNotFoundError(folder)
    with tempfile.TemporaryDirectory() as scratch:
        for k in range(int(video.get(cv2.CAP_PROP_FRAME_COUNT))):
            good, frame = video.read()
            if good and k % FRAME_STEP == 0:
                cv2.imwrite(str(Path(scratch) / f"{k:04d}.png"), 255 - frame)
        return search_images(Path(scratch), "*.png", Charuco("DICT_4X4_1000"))


def read_corners(file: Path) -> ImageSet:
    """Read the corners that come with a set."""
    text = json.loads(file.read_text())
    w, h = text["image_size"]
    points = [(np.array(v["image_points"]), np.array(v["object_points"])) for v in text["views"]]
    return ImageSet((w, h), [Observation(uv, xy[:, :2]) for uv, xy in points])


def read_fisheye(folder: Path) -> ImageSet:
    """Read both parts of BabelCalib's ov_plane."""
    if not folder.is_dir():
        raise FileNotFoundError(folder)
    views = [view for part in ("train", "test") for view in read_ov_plane(folder, part)]
    return ImageSet(OV_PLANE_SIZE, views)


def list_sets(data: Path) -> dict[str, Callable[[], ImageSet]]:
    """List all real sets, each with the function that reads or searches it."""
    merging, four = (
        data / "bouguet_merging_example_corners_only",
        data / "four_cameras_charuco_video",
    )
    sets: dict[str, Callable[[], ImageSet]] = {
        "bouguet": partial(search_images, data / "bouguet_calib_example", "Image[0-9]*.tif"),
        "bouguet merging 1": partial(read_corners, merging / "corners_part1.json"),
        "bouguet merging 2": partial(read_corners, merging / "corners_part2.json"),
        "zhang": partial(read_corners, data / "zhang1998" / "corners.json"),
        "iphone charuco": partial(
            search_images, data / "charuco_iphone_yzz", "*.jpg", Charuco("DICT_4X4_100")
        ),
        "iphone x": partial(search_images, data / "phone_iphonex", "*.jpg"),
        "carnd": partial(search_images, data / "udacity_carnd_9x6_partial", "*.jpg"),
        "gopro": partial(search_images, data / "gopro_udacity_wide", "GOPR*.jpg"),
        "babelcalib ov_plane": partial(read_fisheye, data / "babelcalib_ov_plane"),
    }
    for side in ("left", "right"):
        sets[f"stereo {side}"] = partial(search_images, data / "stereo_sourishg", f"{side}*.jpg")
        folder = data / "fisheye_pairs_sourishg"
        sets[f"fisheye {side}"] = partial(search_images, folder, f"{side}*.jpg")
    for camera in range(4):
        sets[f"charuco video {camera}"] = partial(search_video, four, camera)
    return sets


def digest_detector() -> str:
    """Return a few digits that tell one state of the detector's sources from another."""
    digest = hashlib.sha256()
    for source in sorted(Path(detection.__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:12]


def load(name: str, make: Callable[[], ImageSet]) -> ImageSet:
    """Return a set from the folder of temporary files, or make it and keep it there."""
    folder = Path(tempfile.gettempdir()) / "calibgui-unseen-views"
    file = folder / f"{name.replace(' ', '-')}-{digest_detector()}.npz"
    if not file.is_file():
        made = make()
        arrays: dict[str, Any] = {}
        for k, view in enumerate(made.views):
            arrays |= {f"uv{k}": view.uv, f"xy{k}": view.xy}
            arrays |= {} if view.cov is None else {f"cov{k}": view.cov}
        folder.mkdir(exist_ok=True)
        np.savez(file, size=np.array(made.size), **arrays)
    with np.load(file) as kept:
        count = sum(key.startswith("uv") for key in kept)
        w, h = kept["size"].tolist()
        return ImageSet(
            (w, h),
            [
                Observation(kept[f"uv{k}"], kept[f"xy{k}"], kept.get(f"cov{k}"))
                for k in range(count)
            ],
        )


def calibrate_by_opencv(size: Size, model: str, flags: int, views: list[Observation]) -> Camera:
    """Calibrate with ``cv2.calibrateCamera``.

    Raises:
        CalibrationError: if it refuses the views or returns no numbers.
    """
    places = [np.pad(view.xy, [(0, 0), (0, 1)]).astype(np.float32) for view in views]
    corners = [view.uv.astype(np.float32) for view in views]
    try:
        _, K, k, *_ = cv2.calibrateCamera(
            places, corners, size, None, None, flags=flags, criteria=CRITERIA
        )
    except cv2.error as error:
        raise CalibrationError("OpenCV refuses the views.", error.err) from error
    coefficients = np.ravel(k)[: {"brown-conrady-4": 4, "brown-conrady": 5, "rational": 8}[model]]
    params = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *coefficients, 0.0])
    if not np.isfinite(params).all():
        raise CalibrationError("OpenCV finds no camera.", "")
    return Camera(size, params, model)


def calibrate_by_engine(
    size: Size, model: str, settings: dict[str, Any], views: list[Observation]
) -> Camera:
    """Calibrate with our own solver."""
    return calibrate(views, size, model=model, **settings).camera


def measure_squares(camera: Camera, views: list[Observation], starts: State) -> list[Array]:
    """Measure the squared distances of the corners of views of which only the poses are fitted.

    The poses start from those of the closed form under this camera, or from `starts`, whichever
    ends in the lower sum.
    """
    observations = pack_observations([Observation(view.uv, view.xy) for view in views])
    given = State(camera.params, starts.R, starts.T)
    best = [np.full(len(view.uv), np.inf) for view in views]
    for start in (lambda: given, lambda: estimate_poses(camera, observations)):
        try:
            state = refine_poses(start(), observations, camera.model, Cost.IMAGE)
            residual = compute_residuals(state, observations, camera.model, Cost.IMAGE)[0]
        except (CalibrationError, np.linalg.LinAlgError):
            continue
        for k, view in enumerate(views):
            squares = np.sum(residual[k, : len(view.uv)] ** 2, axis=1)
            if np.isfinite(squares).all() and np.sum(squares) < np.sum(best[k]):
                best[k] = squares
    return best


def hold_views_out(views: list[Observation], poses: State, calibrator: Calibrator) -> Errors:
    """Measure a calibrator's errors on views that it has not seen.

    Args:
        views: all views.
        poses: the poses of all views, to start from.
        calibrator: a function from views to a camera.
    """
    squares = [np.full(len(view.uv), np.inf) for view in views]
    folds = min(DEFAULT_FOLDS, len(views))
    for fold in range(folds):
        out = np.arange(fold, len(views), folds)
        try:
            camera = calibrator([view for k, view in enumerate(views) if k % folds != fold])
        except CalibrationError:
            continue
        starts = State(camera.params, poses.R[out], poses.T[out])
        measured = measure_squares(camera, [views[k] for k in out], starts)
        for k, found in zip(out, measured, strict=True):
            squares[k] = found
    return Errors(squares)


def drop_covariances(views: Sequence[Observation]) -> list[Observation]:
    """Return the views with all corners equally good."""
    return [Observation(view.uv, view.xy) for view in views]


class Comparison(NamedTuple):
    """The errors of all cameras on one set."""

    chosen: LensTrial
    """The lens model that was chosen automatically."""
    ours: dict[str, Errors]
    """Errors of our cameras."""
    opencv: dict[str, Errors]
    """Errors of OpenCV's cameras, by the number of coefficients."""

    @property
    def best(self) -> Errors:
        """The least of OpenCV's errors."""
        return min(self.opencv.values(), key=lambda errors: errors.rms)


CAUSES: dict[str, tuple[str | None, dict[str, Any], bool]] = {
    "auto, alike": (None, {}, False),
    "lucchese, alike": ("lucchese", {}, False),
    "k3 = 0": ("lucchese", {"fix": {"k3": 0.0}}, True),
    "p1 = p2 = 0": ("lucchese", {"fix": {"p1": 0.0, "p2": 0.0}}, True),
    "p3 free": ("lucchese", {"free": "p3"}, True),
    "Brown": ("brown-conrady", {}, True),
    "Brown, alike": ("brown-conrady", {}, False),
}
"""Lens model (None for the chosen one), settings, and whether corners have their covariances."""


def compare_cameras(images: ImageSet, with_causes: bool) -> Comparison:
    """Measure the errors of all cameras on a set."""
    size, views = images
    chosen = choose_lens_stepwise(views, size).chosen
    poses = chosen.calibration.poses
    rvecs, T = np.array([pose.rvec for pose in poses]), np.array([pose.tvec for pose in poses])
    start = State(chosen.calibration.camera.params, rotation_from_vector(rvecs), T)
    alike = drop_covariances(views)
    wanted: dict[str, tuple[str | None, dict[str, Any], bool]] = {
        "auto": (None, {}, True),
        "lucchese": ("lucchese", {}, True),
    }
    ours = {}
    for name, (model, settings, weighted) in (wanted | (CAUSES if with_causes else {})).items():
        how = settings if model else {"fix": chosen.fixed}
        run = partial(calibrate_by_engine, size, model or chosen.model, how)
        ours[name] = hold_views_out(views if weighted else alike, start, run)
    opencv = {
        count: hold_views_out(alike, start, partial(calibrate_by_opencv, size, model, flags))
        for count, (model, flags) in OPENCV.items()
    }
    return Comparison(chosen, ours, opencv)


def format_error(errors: Errors) -> str:
    """Format an error in px, or say that there is none."""
    return f"{errors.rms:.4f}" if np.isfinite(errors.rms) else "fails"


def print_row(name: str, images: ImageSet, found: Comparison) -> tuple[float, float]:
    """Print a set's row of the table, and return the ratio with its standard error."""
    ratio, error = found.ours["auto"].compare(found.best)
    paper, _ = found.ours["lucchese"].compare(found.best)
    held = f", {' = '.join(found.chosen.fixed)} = 0" if found.chosen.fixed else ""
    cells = [
        name,
        str(len(images.views)),
        found.chosen.model + held,
        *(format_error(found.ours[camera]) for camera in ("auto", "lucchese")),
        *(format_error(errors) for errors in found.opencv.values()),
        f"{ratio:.3f} ± {error:.3f}",
        f"{paper:.3f}",
    ]
    causes = [f"{found.ours[cause].compare(found.best)[0]:.3f}" for cause in found.ours]
    print("| " + " | ".join([*cells, *causes[2:]]) + " |", flush=True)
    return ratio, error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", help="names of sets, or their beginnings")
    parser.add_argument("--causes", action="store_true")
    arguments = parser.parse_args()
    data = find_data_dir()
    if not data.is_dir():
        print(f"No real image sets: set CALIBGUI_DATA ({data} does not exist).")
        return
    columns = ["set", "views", "chosen", "auto, px", "lucchese", "OpenCV 4", "5", "8"]
    columns += ["auto / best", "lucchese / best"]
    columns += list(CAUSES) if arguments.causes else []
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    ratios = []
    with threadpool_limits(1):
        for name, make in list_sets(data).items():
            if arguments.sets and not name.startswith(tuple(arguments.sets)):
                continue
            try:
                images = load(name, make)
                ratios.append(print_row(name, images, compare_cameras(images, arguments.causes)))
            except FileNotFoundError as error:
                print(f"| {name} | absent: {error} |")
            except CalibrationError as error:
                print(f"| {name} | {error.message} |")
    met = sum(ratio <= GOAL for ratio, _ in ratios)
    chance = sum(GOAL < ratio <= 1 + 2 * error for ratio, error in ratios)
    print(f"\n{met} of {len(ratios)} sets within {GOAL} of the best of OpenCV's.")
    print(f"{chance} beyond it, but within two standard errors of 1.")


if __name__ == "__main__":
    main()

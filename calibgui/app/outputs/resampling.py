"""Undistortion and rectification of many photographs into a separate folder.

The images are worked on in threads: decoding, resampling and encoding release the interpreter's
lock, and a thread finishes the file that it is writing when the work is cancelled.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np

from calibgui.app.outputs.output_folder import OutputFolder
from calibgui.app.photographs.sensor_frame import choose_orientation
from calibgui.dataset import PoseSet, Result, find_orientation
from calibgui.engine import opencv
from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError, WriteError
from calibgui.engine.geometry import Pose
from calibgui.engine.images import (
    FieldOfView,
    IdealCamera,
    Pixels,
    Projection,
    ResampledImage,
    choose_ideal_cameras,
    compute_board_extent,
    make_ideal_image,
    read_colour,
    read_image_header,
    rectify_image,
    write_image,
)
from calibgui.formats.resampled_json import write_resampled
from calibgui.report.coverage import find_shown_extent, measure_natural_scale

GEOMETRY_FILE = "resampled.json"
"""Name of the file with the geometry of the new images, and the record of them."""


@dataclass(frozen=True, slots=True)
class WrittenImage:
    """The outcome for one photograph."""

    source: Path
    paths: Mapping[str, Path]
    """Paths of the new images by the face of a cube, or of one new image by the name ""; none if
    there is none."""
    reason: str = ""
    """Reason why there is no new image."""


@dataclass(frozen=True, slots=True)
class Undistortion:
    """The projection and angle that undistorted images show; see `choose_ideal_cameras`."""

    projection: Projection = Projection.PERSPECTIVE
    view: FieldOfView = FieldOfView.ALL
    field_of_view: float | None = None
    """Angle from the left edge to the right one, radians, in place of `view`."""
    square_pixels: bool = False
    """True if perspective images have square pixels where the photographs have not."""

    def choose_cameras(self, camera: Camera) -> dict[str, IdealCamera]:
        """Choose the ideal cameras of the new images.

        Raises:
            CalibrationError: if there are none, for a reason of `choose_ideal_cameras`.
        """
        return choose_ideal_cameras(
            camera,
            self.view,
            projection=self.projection,
            field_of_view=self.field_of_view,
            square_pixels=self.square_pixels,
        )


Progress = Callable[[int, int, WrittenImage], None]
"""Function that is called with the number of finished images, of all images, and the last outcome;
it may raise Cancelled."""

_Change = Callable[[Path], Mapping[str, ResampledImage]]
"""Function from a photograph to its new images, named as in `WrittenImage.paths`."""
_Geometry = tuple[Size, Array]
"""Size and matrix, the same for all new images."""


def undistort_files(
    camera: Camera,
    images: Sequence[Path],
    folder: Path,
    undistortion: Undistortion | None = None,
    progress: Progress | None = None,
    overwrite: bool = False,
    orientation: int | None = None,
) -> tuple[WrittenImage, ...]:
    """Write every image without distortion into `folder`, with the geometry of the new images.

    Args:
        camera: the camera that took the images.
        images: to undistort.
        folder: to write to, created if missing.
        undistortion: what the new images show, the whole photographs in perspective if None; the
            faces of a cube are written as NAME_front.png and so on.
        progress: see `Progress`.
        overwrite: whether files in `folder` may be replaced that this program did not make.
        orientation: EXIF orientation by which the camera's photographs are turned; that which each
            states if None.

    Raises:
        CalibrationError: as `OutputFolder`, if the lens has no such undistorted image, or if an
            image cannot be written.
        ForeignFilesError: as `OutputFolder`.
        Cancelled: from `progress`.
    """
    ideals = (undistortion or Undistortion()).choose_cameras(camera)

    def change(path: Path) -> Mapping[str, ResampledImage]:
        pixels = _read_in_frame(path, camera, orientation)
        return {face: make_ideal_image(pixels, camera, ideal) for face, ideal in ideals.items()}

    outputs = OutputFolder(folder / GEOMETRY_FILE, images, ideals, overwrite)
    return _write_images("undistorted", change, images, outputs, progress, ideals)


def rectify_files(
    result: Result,
    images: Sequence[Path],
    folder: Path,
    pixels_per_mm: float | None = None,
    progress: Progress | None = None,
    overwrite: bool = False,
) -> tuple[WrittenImage, ...]:
    """Write the board of every calibrated image as seen from straight above into `folder`.

    Args:
        result: the calibration; images are matched to its views by path, else by name.
        images: to rectify.
        folder: to write to, created if missing.
        pixels_per_mm: scale; as in the middle of the boards in the original images if None.
        progress: see `Progress`.
        overwrite: whether files in `folder` may be replaced that this program did not make.

    Raises:
        CalibrationError: as `OutputFolder`, or if an image cannot be written.
        ForeignFilesError: as `OutputFolder`.
        Cancelled: from `progress`.
    """
    camera, poses = result.calibration.camera, collect_poses(result)
    scale = pixels_per_mm or measure_natural_scale(result)
    extent = find_shown_extent(result)
    orientation = find_orientation(result.used)

    def change(path: Path) -> Mapping[str, ResampledImage]:
        pose = poses.get(str(path)) or poses.get(path.name)
        if pose is None:
            raise CalibrationError(
                f"{path} is not one of the calibrated views.",
                "Calibrate with it, or rectify the images that were calibrated.",
            )
        pixels = _read_in_frame(path, camera, orientation)
        return {"": rectify_image(pixels, camera, pose, extent, scale)}

    outputs = OutputFolder(folder / GEOMETRY_FILE, images, overwrite=overwrite)
    return _write_images("rectified", change, images, outputs, progress)


def rectify_located(
    located: PoseSet,
    folder: Path,
    pixels_per_mm: float | None = None,
    progress: Progress | None = None,
    overwrite: bool = False,
) -> tuple[WrittenImage, ...]:
    """Write the board of every photograph in which a known camera located it, as `rectify_files`.

    Raises:
        CalibrationError: as `rectify_files`.
    """
    camera, board = located.camera, located.board
    assert board is not None  # it was found in photographs
    extent = compute_board_extent(board)
    found = {Path(view.image): view for view in located.views}
    distances = [np.linalg.norm(view.pose.tvec) for _, view in located.located]
    scale = pixels_per_mm or float(camera.focal.mean() / np.median(distances))

    def change(path: Path) -> Mapping[str, ResampledImage]:
        view = found[path]
        if view.found is None:
            raise CalibrationError(view.reason)
        pixels = _read_in_frame(path, camera, None)
        return {"": rectify_image(pixels, camera, view.found.pose, extent, scale)}

    outputs = OutputFolder(folder / GEOMETRY_FILE, list(found), overwrite=overwrite)
    return _write_images("rectified", change, list(found), outputs, progress)


def _read_in_frame(path: Path, camera: Camera, orientation: int | None) -> Pixels:
    """Read a photograph, turned like the others of the camera."""
    header = read_image_header(path)
    return read_colour(path, choose_orientation(header, camera.size, orientation))


def collect_poses(result: Result) -> dict[str, Pose]:
    """Return the poses by the paths of the images and, where these are unique, their names."""
    pairs = list(zip(result.used, result.calibration.poses, strict=True))
    names = [Path(view.image).name for view, _ in pairs]
    poses = {n: pose for n, (_, pose) in zip(names, pairs, strict=True) if names.count(n) == 1}
    return poses | {view.image: pose for view, pose in pairs}


def _write_images(
    kind: str,
    change: _Change,
    images: Sequence[Path],
    outputs: OutputFolder,
    progress: Progress | None,
    ideals: Mapping[str, IdealCamera] | None = None,
) -> tuple[WrittenImage, ...]:
    """Read, `change` and write every image, under its own name, and the geometry file."""
    outcomes: dict[Path, WrittenImage] = {}
    geometry: _Geometry | None = None
    executor = ThreadPoolExecutor(os.cpu_count())
    with opencv.single_thread():  # every processor has an image of its own
        try:
            jobs = [executor.submit(_write_image, change, path, outputs) for path in images]
            for done, job in enumerate(as_completed(jobs), start=1):
                outcome, made = job.result()
                outcomes[outcome.source] = outcome
                geometry = geometry or made
                if progress is not None:
                    progress(done, len(images), outcome)
        finally:
            executor.shutdown(cancel_futures=True)
            outputs.close()
    written = tuple(outcomes[path] for path in images)
    if geometry is not None:
        names = {path.name: str(w.source) for w in written for path in w.paths.values()}
        write_resampled(outputs.geometry_file, kind, *geometry, names, outputs.written, ideals)
    return written


def _write_image(
    change: _Change, source: Path, outputs: OutputFolder
) -> tuple[WrittenImage, _Geometry | None]:
    """Write the new images of one photograph."""
    try:
        made = change(source)
        paths = {face: path for face, path in outputs.name_images(source).items() if face in made}
        for face, path in paths.items():
            write_image(path, cast(Pixels, made[face].image))  # of the source's type
            outputs.record(path)
    except WriteError:  # the next image could not be written either
        raise
    except CalibrationError as error:
        return WrittenImage(source, {}, str(error)), None
    first = next(iter(made.values()))
    height, width = first.image.shape[:2]
    return WrittenImage(source, paths), ((width, height), first.matrix)

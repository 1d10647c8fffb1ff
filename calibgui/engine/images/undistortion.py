"""Images without distortion, and rectified to the plate (figure 9).

Every output pixel p has a point of the measured image where its light fell: its ideal ray,
or the plate point that it shows, through the lens. That map is smooth, so it is solved on a
grid of knots only (``smooth_map``). Output is made in bands of rows: beyond the images
themselves memory does not grow with their size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.distortion import distort_points, project_points, undistort_points
from calibgui.engine.errors import CalibrationError, one_of
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.smooth_map import TOLERANCE, smooth_map

Pixels = npt.NDArray[np.uint8] | npt.NDArray[np.uint16] | npt.NDArray[np.float32]
Extent = tuple[float, float, float, float]
"""Least X and Y, greatest X and Y of a rectangle on the plate, mm."""

_BAND = 1 << 20
"""Output pixels made at once."""


class FieldOfView(StrEnum):
    """How much of the measured image an undistorted one shows."""

    ALL = "all"
    """Every measured pixel, and some border beyond them."""
    NO_BORDER = "no-border"
    """As much as fits without any pixel that was not measured."""
    SAME_SCALE = "same-scale"
    """The camera's own focal lengths, so that the middle keeps its scale."""


@dataclass(frozen=True, eq=False, slots=True)
class Resampled:
    """An image made from another by a change of geometry."""

    image: Pixels
    """(h, w) or (h, w, c), type and channels of the source; 0 where not valid."""
    matrix: Array
    """(3, 3) camera matrix of an undistorted image; pixel_from_plate (mm) of a rectified one."""
    valid: BoolArray
    """(h, w) whether the measured image covers the pixel."""


def undistort_image(
    image: Pixels,
    camera: Camera,
    view: FieldOfView | str = FieldOfView.ALL,
    size: Size | None = None,
) -> Resampled:
    """The image that an ideal pinhole camera would have taken.

    Args:
        image: (h, w) or (h, w, c) of the camera's size: 8 or 16 bits, or floating-point.
        camera: that took it.
        view: how much to show.
        size: width and height of the output; those of the image if None.

    Raises:
        CalibrationError: if the image has another size than the camera, or the lens model is
            not one-to-one over the image (but for the same scale, where such pixels are invalid).
    """
    _check(image, camera)
    size = check_image_size(size or camera.size)
    matrix = undistorted_matrix(camera, view, size)
    return _resample(image, size, matrix, lambda p: distort_points(p, camera, matrix))


def undistorted_matrix(
    camera: Camera, view: FieldOfView | str = FieldOfView.ALL, size: Size | None = None
) -> Array:
    """(3, 3) camera matrix of `undistort_image`'s output; the pixels keep their aspect ratio."""
    view, size = one_of(FieldOfView, view, "field of view"), check_image_size(size or camera.size)
    out = np.array(size, dtype=np.float64)
    if view is FieldOfView.SAME_SCALE:
        return _matrix(camera.focal, camera.centre + (out - camera.size) / 2)
    left, top, right, bottom = sides = undistort_points(_sides(camera.size), camera, np.eye(3))
    if not np.isfinite(sides).all():
        raise CalibrationError(
            "The lens model folds over within the image: some pixels have no ideal place.",
            f"Undistort with the view {FieldOfView.SAME_SCALE.value!r}, or calibrate again with "
            "corners closer to the image's edges.",
        )
    whole = view is FieldOfView.ALL
    if whole:
        low, high = sides.min(axis=(0, 1)), sides.max(axis=(0, 1))
    else:
        low = np.array([left[:, 0].max(), top[:, 1].max()])
        high = np.array([right[:, 0].min(), bottom[:, 1].min()])

    def matrix(zoom: float) -> Array:
        focal = zoom * camera.focal
        return _matrix(focal, (out - 1) / 2 - focal * (low + high) / 2)

    zoom = float(np.min(out / (camera.focal * (high - low))))
    return matrix(zoom if whole else _least_zoom(matrix, zoom, size, camera))


def _least_zoom(matrix: Callable[[float], Array], zoom: float, size: Size, camera: Camera) -> float:
    """The least zoom, near `zoom`, at which an output of `size` has no border; to 1e-6."""
    edge = _sides(size)

    def borderless(zoom: float) -> bool:
        return bool(_inside(distort_points(edge, camera, matrix(zoom)), camera.size).all())

    low = high = zoom
    while borderless(low):
        low /= 1.25
    while not borderless(high):
        high *= 1.25
    while high - low > 1e-6 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if borderless(middle) else (middle, high)
    return high


def rectify_image(
    image: Pixels, camera: Camera, pose: Pose, extent: Extent, pixels_per_mm: float
) -> Resampled:
    """The plate as seen from straight above: the image through the plane of the plate.

    Args:
        image: (h, w) or (h, w, c) of the camera's size.
        camera: that took it.
        pose: cam_from_plate of this image, mm.
        extent: rectangle of the plate to show, mm; the first pixel's outer corner is its least
            X and Y (`board_extent` gives a board's).
        pixels_per_mm: scale of the output.

    Raises:
        CalibrationError: if the image has another size than the camera, or the output would
            have no pixels or too many.
    """
    _check(image, camera)
    left, top, right, bottom = extent
    low, high = np.array([left, top]), np.array([right, bottom])
    shape = (high - low) * pixels_per_mm
    if not (np.isfinite(shape).all() and shape.min() >= 0.5 and shape.max() <= opencv.LONGEST_SIDE):
        raise CalibrationError(
            f"A rectified image of {shape[0]:.0f} x {shape[1]:.0f} pixels cannot be made.",
            f"Choose an extent and a scale that give 1 to {opencv.LONGEST_SIDE} pixels a side.",
        )
    width, height = np.rint(shape).astype(int)
    matrix = _matrix(np.full(2, pixels_per_mm), -low * pixels_per_mm - 0.5)

    def source(p: Array) -> Array:
        return project_points((p - matrix[:2, 2]) / pixels_per_mm, camera, pose)

    return _resample(image, (int(width), int(height)), matrix, source)


def board_extent(board: Board) -> Extent:
    """The rectangle on the plate that holds the board's points and a square around them, mm."""
    side = board.square
    right, bottom = (board.points().max(axis=0) + side).tolist()
    return -side, -side, right, bottom


def _check(image: Pixels, camera: Camera) -> None:
    """Refuse an image that is not the camera's, or that cannot be resampled."""
    if image.dtype not in (np.uint8, np.uint16, np.float32, np.float64):
        raise CalibrationError(
            f"An image of {image.dtype} samples cannot be resampled.",
            "Use 8 or 16 bits, or floating-point numbers.",
        )
    height, width = image.shape[:2]
    if (width, height) != camera.size:
        raise CalibrationError(
            f"The image has {width} x {height} pixels, the camera "
            f"{camera.size[0]} x {camera.size[1]}.",
            "Use images of the size that the camera was calibrated with.",
        )
    if max(camera.size) > opencv.LONGEST_SIDE:
        raise CalibrationError(
            f"The image has {width} x {height} pixels.",
            f"Images of at most {opencv.LONGEST_SIDE} pixels a side can be resampled.",
        )


def _matrix(focal: Array, centre: Array) -> Array:
    return np.array([[focal[0], 0.0, centre[0]], [0.0, focal[1], centre[1]], [0.0, 0.0, 1.0]])


def _sides(size: Size, count: int = 101) -> Array:
    """(4, count, 2) points along the outer edges of the left, top, right and bottom pixels."""
    w, h = size
    u, v = np.linspace(-0.5, w - 0.5, count), np.linspace(-0.5, h - 0.5, count)
    sides = [(u[:1], v), (u, v[:1]), (u[-1:], v), (u, v[-1:])]
    return np.stack([np.stack(np.broadcast_arrays(*side), axis=-1) for side in sides])


def _inside(uv: Array, size: Size) -> BoolArray:
    """Which of `uv` (..., 2) fall on the pixels of an image; NaN do not."""
    # The allowance keeps the outermost pixels of an image that fits exactly.
    low, (right, bottom) = -0.5 - TOLERANCE, np.array(size) - 0.5 + TOLERANCE
    u, v = uv[..., 0], uv[..., 1]
    return np.asarray((u >= low) & (u <= right) & (v >= low) & (v <= bottom))


def _resample(
    image: Pixels, size: Size, matrix: Array, source: Callable[[Array], Array]
) -> Resampled:
    """Image of `size` whose pixels p (..., 2) look at `source(p)` (..., 2) of `image`."""
    width, height = size
    measured = (image.shape[1], image.shape[0])
    rows_of = smooth_map(size, source, np.full(2, -0.5), np.array(measured) - 0.5)
    out = np.empty((height, width, *image.shape[2:]), image.dtype)
    valid = np.empty((height, width), bool)
    rows = max(1, min(_BAND // width, opencv.LONGEST_SIDE))
    for v in range(0, height, rows):
        band = slice(v, min(v + rows, height))
        uv = rows_of(band)
        valid[band] = _inside(uv, measured)
        outside = np.nonzero(~valid[band])
        uv[outside] = 0.0
        out[band] = opencv.resample(image, uv)
        out[band][outside] = 0
    return Resampled(out, matrix, valid)

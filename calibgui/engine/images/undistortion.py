"""Undistortion: the image that an ideal pinhole camera would have taken (figure 9a).

The ideal camera has the position and the direction of the real one. Its focal lengths decide
how much of the scene it shows; their ratio is the real camera's. To show every measured pixel,
or none that was not measured, the outer edge of the image is undistorted and its extremes are
fitted into the output.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.distortion import distort_points, undistort_points
from calibgui.engine.errors import CalibrationError, parse_choice
from calibgui.engine.images.resampling import (
    Pixels,
    ResampledImage,
    check_image,
    is_inside,
    make_matrix,
    resample_image,
)


class FieldOfView(StrEnum):
    """How much of the measured image an undistorted one shows."""

    ALL = "all"
    """Every measured pixel, and some border beyond them."""
    NO_BORDER = "no-border"
    """As much as fits without any pixel that was not measured."""
    SAME_SCALE = "same-scale"
    """The camera's own focal lengths, so that the middle keeps its scale."""


def undistort_image(
    image: Pixels,
    camera: Camera,
    view: FieldOfView | str = FieldOfView.ALL,
    size: Size | None = None,
) -> ResampledImage:
    """Make the image that an ideal pinhole camera would have taken.

    Args:
        image: (h, w) or (h, w, c) of the camera's size: 8 or 16 bits, or floating-point.
        camera: the camera that took it.
        view: how much to show.
        size: width and height of the output; those of the image if None.

    Raises:
        CalibrationError: if the image has another size than the camera, or the lens model is
            not one-to-one over the image (but for the same scale, where such pixels are invalid).

    Example:
        >>> import numpy as np
        >>> from calibgui.engine.camera import Camera
        >>> from calibgui.engine.images import undistort_image
        >>> camera = Camera((64, 48), [50.0, 50.0, 31.5, 23.5, 0.1, 0, 0, 0, 0, 0])
        >>> grey = np.full((48, 64), 200, np.uint8)
        >>> undistorted = undistort_image(grey, camera, "no-border")
        >>> undistorted.image.shape, bool(undistorted.valid.all())
        ((48, 64), True)
        >>> ideal_focal_length = undistorted.matrix[0, 0]
    """
    check_image(image, camera)
    size = check_image_size(size or camera.size)
    matrix = compute_undistorted_matrix(camera, view, size)
    return resample_image(image, size, matrix, lambda p: distort_points(p, camera, matrix))


def compute_undistorted_matrix(
    camera: Camera, view: FieldOfView | str = FieldOfView.ALL, size: Size | None = None
) -> Array:
    """Compute the (3, 3) camera matrix of `undistort_image`'s output, px.

    The pixels keep their aspect ratio.

    Raises:
        CalibrationError: if the lens model is not one-to-one over the image.
    """
    view = parse_choice(FieldOfView, view, "field of view")
    size = check_image_size(size or camera.size)
    out = np.array(size, dtype=np.float64)
    if view is FieldOfView.SAME_SCALE:
        return make_matrix(camera.focal, camera.centre + (out - camera.size) / 2)
    left, top, right, bottom = sides = undistort_points(
        _sample_sides(camera.size), camera, np.eye(3)
    )
    if not np.isfinite(sides).all():
        raise CalibrationError(
            "The lens model folds over within the image: some pixels have no ideal place.",
            f"Undistort with the view {FieldOfView.SAME_SCALE.value!r}, or calibrate again with "
            "corners closer to the image's edges.",
        )
    shows_all = view is FieldOfView.ALL
    if shows_all:
        low, high = sides.min(axis=(0, 1)), sides.max(axis=(0, 1))
    else:
        low = np.array([left[:, 0].max(), top[:, 1].max()])
        high = np.array([right[:, 0].min(), bottom[:, 1].min()])

    def make_zoomed(zoom: float) -> Array:
        focal = zoom * camera.focal
        return make_matrix(focal, (out - 1) / 2 - focal * (low + high) / 2)

    zoom = float(np.min(out / (camera.focal * (high - low))))
    return make_zoomed(zoom if shows_all else _find_least_zoom(make_zoomed, zoom, size, camera))


def _find_least_zoom(
    make_zoomed: Callable[[float], Array], zoom: float, size: Size, camera: Camera
) -> float:
    """Find by bisection the least zoom at which an output of `size` has no border, to 1e-6."""
    edge = _sample_sides(size)

    def is_borderless(zoom: float) -> bool:
        return bool(is_inside(distort_points(edge, camera, make_zoomed(zoom)), camera.size).all())

    low = high = zoom
    while is_borderless(low):
        low /= 1.25
    while not is_borderless(high):
        high *= 1.25
    while high - low > 1e-6 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if is_borderless(middle) else (middle, high)
    return high


def _sample_sides(size: Size, count: int = 101) -> Array:
    """Return points (4, count, 2) on the outer edges of the left, top, right and bottom pixels."""
    w, h = size
    u, v = np.linspace(-0.5, w - 0.5, count), np.linspace(-0.5, h - 0.5, count)
    sides = [(u[:1], v), (u, v[:1]), (u[-1:], v), (u, v[-1:])]
    return np.stack([np.stack(np.broadcast_arrays(*side), axis=-1) for side in sides])

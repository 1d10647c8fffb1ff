"""Resampling of an image through a change of geometry, for undistortion and rectification.

Every output pixel p has a point of the measured image where its light fell: the image of its
ideal ray, or of the board point that it shows, through the lens. That map is smooth, so it is
solved on a grid of knots only (``smooth_map.py``). Output is made in bands of rows: beyond the
images themselves memory does not grow with their size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, FloatImage, Size
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.smooth_map import MAP_TOLERANCE_PX, interpolate_map
from calibgui.engine.threads import with_one_blas_thread

Pixels = npt.NDArray[np.uint8] | npt.NDArray[np.uint16] | npt.NDArray[np.float32]

_NOWHERE = -2.0
"""Place, px, beside which no pixel lies: what looks there is 0."""
_EVERYWHERE = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])
_PIXELS_PER_BAND = 1 << 17
"""Number of output pixels made at once: their map stays within a processor's cache."""


@dataclass(frozen=True, eq=False, slots=True)
class ResampledImage:
    """An image made from another by a change of geometry."""

    image: Pixels
    """(h, w) or (h, w, c), type and channels of the source; 0 where not valid."""
    matrix: Array
    """(3, 3) camera matrix of an undistorted image; pixel_from_board (mm) of a rectified one."""
    valid: BoolArray
    """(h, w) true where the measured image covers the pixel."""


@with_one_blas_thread
def resample_image(
    image: Pixels,
    size: Size,
    matrix: Array,
    source: Callable[[Array], Array],
    shown: Array = _EVERYWHERE,
) -> ResampledImage:
    """Make the image of `size` whose pixels p (..., 2) look at `source(p)` (..., 2) of `image`.

    Only pixels in the rectangle with the corners `shown` (2, 2) are valid.
    """
    width, height = size
    measured = (image.shape[1], image.shape[0])
    rows_of = interpolate_map(size, source, np.full(2, -0.5), np.array(measured) - 0.5)
    out = np.empty((height, width, *image.shape[2:]), image.dtype)
    valid = np.ones((height, width), bool)
    is_hidden_column, is_hidden_row = (
        (np.arange(n) < low) | (np.arange(n) > high)
        for n, low, high in zip(size, *shown, strict=True)
    )
    last = np.array(measured, np.float32)[:, None] - 1
    rows = max(1, min(_PIXELS_PER_BAND // width, opencv.MAX_SIDE))
    for v in range(0, height, rows):
        band = slice(v, min(v + rows, height))
        uv = rows_of(band)
        uv[:, is_hidden_row[band]] = np.nan
        uv[:, :, is_hidden_column] = np.nan
        is_all_inside = ((uv.min(axis=1) >= 0) & (uv.max(axis=1) <= last)).all(axis=0)
        for columns in _find_runs(~is_all_inside):
            at_edge = uv[:, :, columns]
            is_valid = is_inside(np.moveaxis(at_edge, 0, -1), measured)
            # The outer half of the outermost pixels has the level of their centres.
            np.clip(at_edge, 0, last[:, None], out=at_edge)
            np.copyto(at_edge, _NOWHERE, where=~is_valid)
            valid[band, columns] = is_valid
        opencv.resample_image(image, uv, out[band])
    return ResampledImage(out, matrix, valid)


def _find_runs(is_true: BoolArray) -> list[slice]:
    """Find the slices of a vector (n,) in which all is true."""
    changes = np.flatnonzero(np.diff(is_true, prepend=False, append=False))
    return [slice(*ends) for ends in changes.reshape(-1, 2).tolist()]


def is_inside(uv: Array | FloatImage, size: Size) -> BoolArray:
    """Return (...) whether positions `uv` (..., 2) px fall on an image of `size`; NaN does not."""
    # The allowance keeps the outermost pixels of an image that fits exactly.
    low = -0.5 - MAP_TOLERANCE_PX
    right, bottom = (length - 0.5 + MAP_TOLERANCE_PX for length in size)
    u, v = uv[..., 0], uv[..., 1]
    return np.asarray((u >= low) & (u <= right) & (v >= low) & (v <= bottom))


def check_image(image: npt.ArrayLike, camera: Camera) -> Pixels:
    """Return the pixels of an image, which ``read_image`` may have returned; refuse one that is not
    the camera's, or that cannot be resampled.

    Raises:
        CalibrationError: if its type or size is not one that can be resampled.
    """
    image = np.asarray(image)
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
    if max(camera.size) > opencv.MAX_SIDE:
        raise CalibrationError(
            f"The image has {width} x {height} pixels.",
            f"Images of at most {opencv.MAX_SIDE} pixels a side can be resampled.",
        )
    return image


def make_matrix(focal: Array, centre: Array) -> Array:
    """Return the (3, 3) camera matrix with focal lengths (2,) and centre (2,), px."""
    return np.array([[focal[0], 0.0, centre[0]], [0.0, focal[1], centre[1]], [0.0, 0.0, 1.0]])

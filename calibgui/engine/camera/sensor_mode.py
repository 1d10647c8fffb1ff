"""Sensor modes: one camera with streams that are cropped, binned, scaled, squeezed or flipped.

A mode is a map from the pixels of the images that the camera was calibrated with to those of
another stream, along each axis

    u' = s u + o,    s < 0 where the stream is mirrored.

Whole numbers are at pixel centres, so scaling the image by s maps the edges at -1/2 to -1/2:
u' = s (u + 1/2) - 1/2. The stream's camera has |s| f for f and s c + o for c; its lens is the same
one or, along an axis on which the stream is flipped, the mirrored one (``Lens.mirror``). With A the
mode and M = diag(sign s_x, sign s_y, 1) it images the rays

    project'(M r) = A(project(r)).

M is the identity without flips, and a rotation by 180 degrees for a stream that is upside down. A
stream that is mirrored along one axis alone is no rotated camera: its rays are those of a world
that is mirrored as well. Its undistorted images are right, and the poses of boards in it are not.

All parameters change linearly, so that a covariance is carried over exactly. A lens model that
measures its radius in pixels cannot be squeezed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, Size, freeze
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, eq=False, slots=True)
class SensorMode:
    """The map from the pixels of a camera's images to those of another stream of it.

    Examples:
        >>> from calibgui.engine.camera import Camera, SensorMode
        >>> camera = Camera((640, 480), [600, 600, 319.5, 239.5], "pinhole")
        >>> SensorMode.identity(camera.size).crop(0, 60, (640, 360)).scale(0.5).size
        (320, 180)
        >>> SensorMode.identity(camera.size).scale(0.5).adapt_camera(camera).params.tolist()
        [300.0, 300.0, 159.5, 119.5]
    """

    full: Size
    """Width and height of the images that the camera was calibrated with, px."""
    size: Size
    """Width and height of the stream's images, px."""
    factor: Array
    """(2,) s along u and v; below 0 where the stream is mirrored."""
    offset: Array
    """(2,) o along u and v, px."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "full", check_image_size(self.full))
        object.__setattr__(self, "size", check_image_size(self.size))
        freeze(self, "factor", "offset")
        if self.factor.shape != (2,) or self.offset.shape != (2,):
            raise ValueError("factor and offset have one number for each axis")
        if not (np.isfinite([self.factor, self.offset]).all() and (self.factor != 0).all()):
            raise CalibrationError(
                "A sensor mode needs finite numbers, and factors other than 0.",
                "State how the images were cropped and scaled.",
            )

    @classmethod
    def identity(cls, size: Size) -> SensorMode:
        """Return the mode of the images that the camera was calibrated with."""
        return cls(size, size, np.ones(2), np.zeros(2))

    @classmethod
    def squaring_pixels(cls, camera: Camera) -> SensorMode:
        """Return the mode in which a camera's focal lengths are equal: its images, stretched along
        the axis of the shorter one."""
        factor = camera.focal.max() / camera.focal
        width, height = np.rint(factor * camera.size).astype(int).tolist()
        return cls.identity(camera.size)._scale_to(factor, (width, height))

    @property
    def is_identity(self) -> bool:
        """True if the stream's images are those that the camera was calibrated with."""
        distance = np.abs([self.factor - 1, self.offset]).max()  # but for rounding
        return self.size == self.full and bool(distance < 1e-9)

    @property
    def is_mirrored(self) -> bool:
        """True if the stream is mirrored along one axis alone."""
        return bool(np.prod(self.factor) < 0)

    @property
    def region(self) -> Array:
        """(2, 2) first and last column, and row, of the camera's images that the stream shows, px;
        halves of pixels where it begins or ends within one."""
        edges = np.array([[-0.5, -0.5], np.array(self.size) - 0.5])
        first, last = np.sort((edges - self.offset) / self.factor, axis=0)
        return np.array([first + 0.5, last - 0.5]).T

    def crop(self, left: int, top: int, size: Size) -> SensorMode:
        """Return the mode of the part of the stream's images from a column and a row on.

        Raises:
            CalibrationError: if the part does not lie within the images.
        """
        (width, height), (w, h) = self.size, size
        if not (0 <= left <= left + w <= width and 0 <= top <= top + h <= height):
            raise CalibrationError(
                f"Images of {width} x {height} px have no part of {w} x {h} px from column {left} "
                f"and row {top} on.",
                "State the column and row, counted from 0, of its first pixel, and its size.",
            )
        return self._then(np.ones(2), -np.array([left, top], dtype=np.float64), size)

    def scale(self, factor: float) -> SensorMode:
        """Return the mode of the stream scaled by a factor, with whole numbers of pixels.

        Raises:
            CalibrationError: if nothing is left of the images.
        """
        width, height = (max(round(side * factor), 0) for side in self.size)
        return self._scale_to(np.full(2, factor), (width, height))

    def bin_pixels(self, count: int) -> SensorMode:
        """Return the mode of the stream in which `count` x `count` pixels make one; pixels that are
        left over at the right and at the bottom are lost."""
        width, height = self.size
        return self._scale_to(np.full(2, 1 / count), (width // count, height // count))

    def resize(self, size: Size) -> SensorMode:
        """Return the mode of the whole images in another size, squeezed if its aspect differs."""
        return self._scale_to(np.array(size) / np.array(self.size), size)

    def flip(self, along_u: bool = False, along_v: bool = False) -> SensorMode:
        """Return the mode of the stream mirrored left to right, or top to bottom, or both."""
        is_flipped = np.array([along_u, along_v])
        last = np.array(self.size) - 1.0
        return self._then(np.where(is_flipped, -1.0, 1.0), np.where(is_flipped, last, 0), self.size)

    def then(self, other: SensorMode) -> SensorMode:
        """Return the mode that leads through this one and then another one of its stream."""
        if other.full != self.size:
            raise ValueError(f"{other.full} is not the size of the stream, {self.size}")
        return self._then(other.factor, other.offset, other.size)

    def invert(self) -> SensorMode:
        """Return the mode that leads back."""
        return SensorMode(self.size, self.full, 1 / self.factor, -self.offset / self.factor)

    def map_points(self, uv: npt.ArrayLike) -> Array:
        """Return where pixels (..., 2) of the camera's images are in the stream's."""
        return np.asarray(self.factor * np.asarray(uv, dtype=np.float64) + self.offset)

    def adapt_camera(self, camera: Camera) -> Camera:
        """Return the camera of the stream.

        Raises:
            CalibrationError: if the camera is of images of another size, or its lens model cannot
                be squeezed.
        """
        if camera.size != self.full:
            raise ValueError(f"the mode is of images of {self.full}, the camera of {camera.size}")
        J = self.differentiate(camera.model)
        params = J @ camera.params
        params[2:4] += self.offset
        return Camera(self.size, params, camera.model, self._map_circle(camera.circle))

    def _map_circle(self, circle: ImageCircle | None) -> ImageCircle | None:
        """Return the image circle in the stream; None also where it is squeezed to an ellipse."""
        stretch = np.abs(self.factor)
        if circle is None or stretch[0] != stretch[1]:
            return None
        u, v = self.map_points(circle[:2]).tolist()
        return ImageCircle(u, v, float(stretch[0]) * circle.radius)

    def adapt_covariance(self, covariance: Array, model: str) -> Array:
        """Return the covariance (P, P) of the parameters of the stream's camera."""
        J = self.differentiate(model)
        return np.asarray(J @ covariance @ J.T)

    def differentiate(self, model: str) -> Array:
        """Return the derivatives (P, P) of the parameters of the stream's camera by the camera's.

        Raises:
            CalibrationError: if the lens model cannot be squeezed.
        """
        lens = find_model(model)
        stretch = np.abs(self.factor)
        if lens.radius_in_pixels and stretch[0] != stretch[1]:
            raise CalibrationError(
                f"The lens model {lens.short_title} measures its radius in pixels of equal sides: "
                "it has no squeezed images.",
                "Convert the camera to another lens model first.",
            )
        count = len(lens.names)
        J = np.zeros((4 + count, 4 + count))
        J[:4, :4] = np.diag([*stretch, *self.factor])
        along = bool(self.factor[0] < 0), bool(self.factor[1] < 0)
        for i, unit in enumerate(np.eye(count)):
            J[4:, 4 + i] = lens.mirror(unit, along)
        return J

    def _scale_to(self, factor: Array, size: Size) -> SensorMode:
        """Return the mode of the stream scaled by factors (2,) into images of a size."""
        if min(size) < 1:
            raise CalibrationError(
                f"Nothing is left of images of {self.size[0]} x {self.size[1]} px.",
                "Scale them by less.",
            )
        return self._then(factor, factor / 2 - 0.5, size)

    def _then(self, factor: Array, offset: Array, size: Size) -> SensorMode:
        return SensorMode(self.full, size, factor * self.factor, factor * self.offset + offset)


def describe_mode(mode: SensorMode) -> str:
    """Describe the part of the camera's images that a stream shows, its scale and its flips, as
    "columns 0 to 639 and rows 60 to 419 of 640 x 480 px, scaled by 0.5"."""
    width, height = mode.full
    (left, right), (top, bottom) = mode.region
    is_whole = left == top == 0 and right == width - 1 and bottom == height - 1
    shown = (
        f"the whole of {width} x {height} px"
        if is_whole
        else f"columns {left:g} to {right:g} and rows {top:g} to {bottom:g} of "
        f"{width} x {height} px"
    )
    fu, fv = abs(mode.factor)
    scaled = ""
    if abs(fu - fv) * max(mode.size) < 1:  # whole pixels
        scaled = "" if fu == fv == 1 else f", scaled by {fu:.6g}"
    else:
        scaled = f", scaled by {fu:.6g} across and {fv:.6g} down"
    flips = {(True, False): ", mirrored", (False, True): ", upside down and mirrored"}
    turned = flips.get(tuple((mode.factor < 0).tolist()), "")
    if (mode.factor < 0).all():
        turned = ", turned by 180 degrees"
    return f"{shown}{scaled}{turned}"

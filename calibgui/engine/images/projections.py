"""Ideal cameras: which direction each pixel of an undistorted image looks in, in closed form.

A pixel (u, v) of an ideal camera with focal lengths f and centre c has the image point

    x = (u - cx) / fx,    y = (v - cy) / fy,

and looks along a ray (X, Y, Z) of the camera frame (X to the right, Y down, Z along the axis):

    perspective       (x, y, 1)                              straight lines stay straight
    cylindrical       (sin x, y, cos x)                      upright lines stay straight
    equirectangular   (cos y sin x, sin y, cos y cos x)      x is the longitude, y the latitude
    stereographic     (x, y, 1 - (x^2 + y^2) / 4)            small shapes keep their form

Seen from the ray, with theta its angle off the axis and r = |(X, Y, Z)|,

    perspective       (X, Y) / Z
    cylindrical       (atan2(X, Z), Y / sqrt(X^2 + Z^2))
    equirectangular   (atan2(X, Z), atan2(Y, sqrt(X^2 + Z^2)))
    stereographic     2 (X, Y) / (r + Z) = 2 tan(theta / 2) (X, Y) / sqrt(X^2 + Y^2)

(J. P. Snyder, Map Projections: A Working Manual, USGS Professional Paper 1395, 1987). Near the axis
all four are alike: f is the number of pixels per radian there. They differ in what they can show:
perspective less than 180 degrees, the stereographic projection less than 360, the cylinder all
directions around it but not the two along it, and the equirectangular projection every direction.

A cube is six perspective images of 90 degrees, each of an ideal camera that is turned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, Size, freeze


class Projection(StrEnum):
    """The map of directions onto the plane of an undistorted image."""

    PERSPECTIVE = "perspective"
    """A pinhole camera's image: straight lines stay straight."""
    CYLINDRICAL = "cylindrical"
    """A panorama: upright lines stay straight, the horizon is unrolled."""
    EQUIRECTANGULAR = "equirectangular"
    """A map of longitude and latitude, which viewers of 360-degree images read."""
    STEREOGRAPHIC = "stereographic"
    """A wide view that keeps the form of small shapes, round heads among them."""
    CUBE = "cube"
    """Up to six perspective images of 90 degrees each, which join at their edges."""


@dataclass(frozen=True, eq=False, slots=True)
class IdealCamera:
    """A camera without distortion that stands where the real one does.

    Examples:
        >>> import numpy as np
        >>> from calibgui.engine.images import IdealCamera, Projection
        >>> f = 200 / np.pi  # px per radian
        >>> matrix = [[f, 0, 199.5], [0, f, 99.5], [0, 0, 1]]
        >>> globe = IdealCamera((400, 200), matrix, Projection.EQUIRECTANGULAR)
        >>> globe.find_rays([[199.5, 99.5], [299.5, 99.5]]).round(6) + 0.0
        array([[0., 0., 1.],
               [1., 0., 0.]])
        >>> globe.find_pixels([0, -1, 0])  # straight up
        array([199.5,  -0.5])
    """

    size: Size
    """Width and height of its images, px."""
    matrix: Array
    """(3, 3) focal lengths, px per radian on the axis, and centre, px."""
    projection: Projection = Projection.PERSPECTIVE
    """The formula; a face of a cube has that of perspective."""
    rotation: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) camera_from_ideal: takes its rays to the real camera's frame."""

    def __post_init__(self) -> None:
        freeze(self, "matrix", "rotation")

    def find_rays(self, uv: npt.ArrayLike) -> Array:
        """Return rays (..., 3), of any length, of pixels (..., 2), in the real camera's frame.

        They are NaN where a pixel shows no direction, or one that another pixel shows already.
        """
        pixels, (low, high) = np.asarray(uv, dtype=np.float64), self.shown
        rays = self.continue_rays(pixels)
        rays[~((pixels >= low) & (pixels <= high)).all(axis=-1)] = np.nan
        return rays

    def continue_rays(self, uv: npt.ArrayLike) -> Array:
        """Return rays as `find_rays` does, smoothly continued where another pixel shows them."""
        points = (np.asarray(uv, dtype=np.float64) - self._centre) * (1 / self._focal)
        return np.asarray(_FORMULAS[self.projection].rays(points) @ self.rotation.T)

    def find_pixels(self, rays: npt.ArrayLike) -> Array:
        """Return pixels (..., 2) of rays (..., 3) in the real camera's frame; NaN without one."""
        points = project_ideally(
            np.asarray(rays, dtype=np.float64) @ self.rotation, self.projection
        )
        return np.asarray(self._centre + self._focal * points)

    @property
    def shown(self) -> Array:
        """(2, 2) corners of the rectangle, px, in which pixels show directions of their own."""
        reach = self._focal * _FORMULAS[self.projection].reach
        return np.stack([self._centre - reach, self._centre + reach])

    @property
    def _focal(self) -> Array:
        return self.matrix[[0, 1], [0, 1]]

    @property
    def _centre(self) -> Array:
        return self.matrix[:2, 2]


def project_ideally(rays: Array, projection: Projection) -> Array:
    """Return image points (..., 2), dimensionless, of rays (..., 3); NaN where there is none."""
    return _FORMULAS[projection].points(rays)


def list_cube_rotations() -> dict[str, Array]:
    """Return the rotation (3, 3) of each face of a cube, camera_from_face, by the face's name.

    The four sides stand upright; top and bottom join the front at its upper and lower edge.
    """
    right, down, ahead = np.eye(3)
    axes = {
        "front": (right, down, ahead),
        "left": (ahead, down, -right),
        "right": (-ahead, down, right),
        "top": (right, ahead, -down),
        "bottom": (right, -ahead, down),
        "back": (-right, down, -ahead),
    }
    return {name: np.stack(face, axis=1) for name, face in axes.items()}


def find_widest_field_of_view(projection: Projection) -> float:
    """Return the angle, radians, that a projection's field of view must not exceed.

    Perspective and stereographic images grow beyond all bounds towards it.
    """
    return _FORMULAS[projection].widest


def _see_perspective(p: Array) -> Array:
    return np.concatenate([p, np.ones_like(p[..., :1])], axis=-1)


def _show_perspective(rays: Array) -> Array:
    return np.asarray(rays[..., :2] / np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan))


def _see_cylindrical(p: Array) -> Array:
    return np.stack([np.sin(p[..., 0]), p[..., 1], np.cos(p[..., 0])], axis=-1)


def _show_cylindrical(rays: Array) -> Array:
    X, Y, Z = np.moveaxis(rays, -1, 0)
    across = np.hypot(X, Z)
    return np.stack([np.arctan2(X, Z), Y / np.where(across > 0, across, np.nan)], axis=-1)


def _see_equirectangular(p: Array) -> Array:
    x, y = np.moveaxis(p, -1, 0)
    return np.stack([np.cos(y) * np.sin(x), np.sin(y), np.cos(y) * np.cos(x)], axis=-1)


def _show_equirectangular(rays: Array) -> Array:
    X, Y, Z = np.moveaxis(rays, -1, 0)
    return np.stack([np.arctan2(X, Z), np.arctan2(Y, np.hypot(X, Z))], axis=-1)


def _see_stereographic(p: Array) -> Array:
    return np.concatenate([p, 1 - np.sum(p * p, axis=-1, keepdims=True) / 4], axis=-1)


def _show_stereographic(rays: Array) -> Array:
    length = np.linalg.norm(rays, axis=-1, keepdims=True)
    above = length + rays[..., 2:]
    return np.asarray(2 * rays[..., :2] / np.where(above > 0, above, np.nan))


class _Formula(NamedTuple):
    """A projection's two maps."""

    rays: Callable[[Array], Array]
    """Image points (..., 2) to rays (..., 3)."""
    points: Callable[[Array], Array]
    """Rays (..., 3) to image points (..., 2)."""
    widest: float
    """Bound of its field of view, radians."""
    reach: tuple[float, float] = (np.inf, np.inf)
    """Greatest |x| and |y| of image points; beyond them directions are repeated."""


_FORMULAS = {
    Projection.PERSPECTIVE: _Formula(_see_perspective, _show_perspective, np.pi),
    Projection.CYLINDRICAL: _Formula(
        _see_cylindrical, _show_cylindrical, 2 * np.pi, (np.pi, np.inf)
    ),
    Projection.EQUIRECTANGULAR: _Formula(
        _see_equirectangular, _show_equirectangular, 2 * np.pi, (np.pi, np.pi / 2)
    ),
    Projection.STEREOGRAPHIC: _Formula(_see_stereographic, _show_stereographic, 2 * np.pi),
}

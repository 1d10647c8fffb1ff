"""Stereo rectification: two images in whose rows the same points lie.

With (R, T) b_from_a, the line from a's centre to b's has the direction c = -R^T T in a's frame.
Both cameras are turned, and nothing else, so that their x axes lie along it (Fusiello, Trucco and
Verri 2000). The turn about this axis is free; the new z axis is the mean of both optical axes,
made perpendicular to it, so that both turn equally far (Bouguet). In the images of two ideal
cameras that stand so, with the same focal lengths and centres, a point at (X, Y, Z) has the row
v = cy + f Y / Z in both, and its columns differ by

    d = u_a - u_b = f B / Z,      B = |T|,

so Z = f B / d, which Q writes as a matrix: (X, Y, Z, W) ~ Q (u, v, d, 1). Cameras that stand above
each other are turned so that their y axes lie along the line: then columns agree, and rows differ.

An ideal camera need not be perspective: in a map of angles, with v the angle about the line of
centres and u that towards it, the same points lie in one row as well, and every ray of a lens of
180 degrees has a place. Such images have no Q.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, Size, freeze
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import measure_axis_scale, pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.resampling import (
    Pixels,
    ResampledImage,
    check_image,
    make_matrix,
    resample_image,
)

_MIN_SIDEWAYS = 0.1
"""Sine of the angle between the line of centres and the cameras' mean axis below which images are
not rectified: ten times as wide, most of them would look elsewhere. A plausibility limit."""


@dataclass(frozen=True, eq=False, slots=True)
class RectifiedCamera:
    """An ideal camera that stands where a real one does."""

    size: Size
    """Width and height of its images, px."""
    matrix: Array
    """(3, 3) focal length, px or px per radian, and centre, px."""
    rotation: Array
    """(3, 3) camera_from_rectified."""
    is_upright: bool
    """True if the other camera stands above or below it."""
    is_angular: bool
    """True for a map of angles, False for a perspective image."""

    def __post_init__(self) -> None:
        freeze(self, "matrix", "rotation")

    def find_pixels(self, rays: Array) -> Array:
        """Return pixels (..., 2) of rays (..., 3) in the real camera's frame; NaN without one."""
        X, Y, Z = np.moveaxis(rays @ self.rotation, -1, 0)
        if not self.is_angular:
            ahead = np.where(Z > 0, Z, np.nan)
            points = np.stack([X / ahead, Y / ahead], axis=-1)
        elif self.is_upright:
            points = np.stack([np.arctan2(X, Z), np.arctan2(Y, np.hypot(X, Z))], axis=-1)
        else:
            points = np.stack([np.arctan2(X, np.hypot(Y, Z)), np.arctan2(Y, Z)], axis=-1)
        return np.asarray(points * self.matrix[0, 0] + self.matrix[:2, 2])

    def find_rays(self, uv: Array) -> Array:
        """Return rays (..., 3), of any length, of pixels (..., 2) in the real camera's frame.

        They are NaN where a map of angles has been once around.
        """
        x, y = np.moveaxis((uv - self.matrix[:2, 2]) / self.matrix[0, 0], -1, 0)
        if not self.is_angular:
            rays = np.stack([x, y, np.ones_like(x)], axis=-1)
        elif self.is_upright:
            rays = np.stack([np.cos(y) * np.sin(x), np.sin(y), np.cos(y) * np.cos(x)], axis=-1)
        else:
            rays = np.stack([np.sin(x), np.cos(x) * np.sin(y), np.cos(x) * np.cos(y)], axis=-1)
        if self.is_angular:
            about, towards = (x, y) if self.is_upright else (y, x)
            rays[(np.abs(about) > np.pi) | (np.abs(towards) > np.pi / 2)] = np.nan
        return np.asarray(rays @ self.rotation.T)


@dataclass(frozen=True, eq=False, slots=True)
class StereoPair:
    """Two cameras, how they stand, and the ideal cameras of their rectified images."""

    cameras: tuple[Camera, Camera]
    pose: Pose
    """Pose second_from_first, mm."""
    ideal: tuple[RectifiedCamera, RectifiedCamera]
    """Cameras of the rectified images, each of which stands where the real one does."""

    @property
    def is_upright(self) -> bool:
        """True if the cameras stand above each other: then columns agree, and not rows."""
        return self.ideal[0].is_upright

    @property
    def baseline(self) -> float:
        """Distance of the cameras' centres, mm."""
        return float(np.linalg.norm(self.pose.tvec))

    @property
    def essential(self) -> Array:
        """(3, 3) E, with b^T E a = 0 for rays a and b of one point."""
        x, y, z = self.pose.tvec
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return cross @ rotation_from_vector(self.pose.rvec)

    @property
    def fundamental(self) -> Array:
        """(3, 3) F, with q^T F p = 0 for undistorted pixels p and q, scaled to F[2, 2] = 1."""
        first, second = (np.linalg.inv(camera.matrix) for camera in self.cameras)
        F = second.T @ self.essential @ first
        return F / F[2, 2]

    @property
    def rotations(self) -> tuple[Array, Array]:
        """(3, 3) rectified_from_camera of both: OpenCV's R1 and R2."""
        first, second = self.ideal
        return first.rotation.T, second.rotation.T

    @property
    def projections(self) -> tuple[Array, Array]:
        """(3, 4) OpenCV's P1 and P2 of perspective images: the second's last column holds the
        baseline, px mm, by which points in the first's frame move."""
        first, second = (np.hstack([each.matrix, np.zeros((3, 1))]) for each in self.ideal)
        second[int(self.is_upright), 3] = self._shift * self.ideal[1].matrix[0, 0]
        return first, second

    @property
    def disparity_to_depth(self) -> Array:
        """(4, 4) OpenCV's Q of perspective images: (X, Y, Z, W) ~ Q (u, v, d, 1), mm."""
        K = self.ideal[0].matrix
        Q = np.zeros((4, 4))
        Q[:2, :2] = np.eye(2)
        Q[:2, 3] = -K[:2, 2]
        Q[2, 3] = K[0, 0]
        Q[3, 2] = -1 / self._shift
        return Q

    def rectify_points(self, uv: Array, which: int) -> Array:
        """Return pixels (..., 2) of the rectified image of camera 0 or 1; NaN without one."""
        return self.ideal[which].find_pixels(rays_from_pixels(uv, self.cameras[which]))

    def measure_row_errors(self, first: Array, second: Array) -> Array:
        """Return (n,) by how many px the rows of the same points (n, 2) differ in rectified images;
        columns, if the cameras stand above each other."""
        across = 0 if self.is_upright else 1
        moved = self.rectify_points(second, 1) - self.rectify_points(first, 0)
        return np.asarray(moved[..., across])

    def compute_disparity(self, depth: float) -> float:
        """Compute the disparity, px, of points at a depth, mm, in perspective images."""
        return float(-self.ideal[0].matrix[0, 0] * self._shift / depth)

    @property
    def _shift(self) -> float:
        """Place of the first camera in the second's rectified frame, along the line of centres."""
        return float((self.rotations[1] @ self.pose.tvec)[int(self.is_upright)])


def rectify_pair(
    cameras: tuple[Camera, Camera], pose: Pose, zoom: float = 1.0, is_angular: bool = False
) -> StereoPair:
    """Find the ideal cameras of a pair's rectified images.

    Their focal length is the mean of both cameras' on their axes, their size that of the first.

    Args:
        cameras: both cameras.
        pose: second_from_first, mm.
        zoom: factor of the focal length.
        is_angular: True for maps of angles, which wide lenses need.

    Raises:
        CalibrationError: if the cameras stand at one place, or look along the line of their centres
            or away from each other.
    """
    R = rotation_from_vector(pose.rvec)
    centre = -R.T @ pose.tvec
    baseline = float(np.linalg.norm(centre))
    if not baseline > 0:
        raise CalibrationError(
            "Both cameras stand at one place, which rectifies to nothing.", "Name another pair."
        )
    axis = np.array([0.0, 0.0, 1.0]) + R[2]  # both optical axes in the first camera's frame
    direction = centre / baseline
    ahead = axis - (axis @ direction) * direction
    if np.linalg.norm(ahead) < _MIN_SIDEWAYS * max(1.0, float(np.linalg.norm(axis))):
        raise CalibrationError(
            "The cameras look along the line of their centres, or away from each other: their "
            "images cannot be rectified.",
            "Name a pair of cameras that look side by side.",
        )
    is_upright = bool(abs(direction[1]) > abs(direction[0]))
    direction = direction * np.sign(direction[1 if is_upright else 0])
    z = ahead / np.linalg.norm(ahead)
    if is_upright:
        y = direction
        x = np.cross(y, z)
    else:
        x = direction
        y = np.cross(z, x)
    first = np.stack([x, y, z], axis=1)  # first_from_rectified
    f = zoom * float(np.mean([abs(measure_axis_scale(camera)) for camera in cameras]))
    size = cameras[0].size
    plain = make_matrix(np.full(2, f), np.zeros(2))
    ideal = [
        RectifiedCamera(size, plain, turn, is_upright, is_angular) for turn in (first, R @ first)
    ]
    # The middles of both images come to the middle.
    middles = [
        each.find_pixels(rays_from_pixels((np.array(camera.size) - 1) / 2, camera))
        for each, camera in zip(ideal, cameras, strict=True)
    ]
    centre = (np.array(size) - 1) / 2 - np.nan_to_num(np.mean(middles, axis=0))
    matrix = make_matrix(np.full(2, f), centre)
    return StereoPair(
        cameras, pose, (replace(ideal[0], matrix=matrix), replace(ideal[1], matrix=matrix))
    )


def rectify_stereo_image(image: Pixels, pair: StereoPair, which: int) -> ResampledImage:
    """Make the rectified image of camera 0 or 1 of a pair.

    Raises:
        CalibrationError: if the image has another size than the camera.
    """
    camera, ideal = pair.cameras[which], pair.ideal[which]

    def source(pixels: Array) -> Array:
        return pixels_from_rays(ideal.find_rays(pixels), camera)

    return resample_image(check_image(image, camera), ideal.size, ideal.matrix, source)


def find_epipolar_line(pair: StereoPair, uv: Array, count: int = 100) -> Array:
    """Find the line in the second camera's image on which the point of a pixel of the first lies.

    Args:
        pair: both cameras.
        uv: (2,) pixel of the first camera.
        count: number of points of the line.

    Returns:
        (m, 2) pixels, from near to far, of those that lie in the second image.
    """
    R = rotation_from_vector(pair.pose.rvec)
    ray = R @ rays_from_pixels(uv, pair.cameras[0])
    # Equal steps of the angle between the line of centres and the ray.
    share = np.linspace(0, 1, count + 1)[1:, None]
    rays = (1 - share) * pair.pose.tvec / pair.baseline + share * ray
    pixels = pixels_from_rays(rays, pair.cameras[1])
    width, height = pair.cameras[1].size
    inside = (pixels > -0.5).all(axis=1) & (pixels < [width - 0.5, height - 0.5]).all(axis=1)
    return np.asarray(pixels[inside])

"""From pixels to the world: the ray that a pixel looks along, and where it meets a board's plane.

A pixel's ray of length 1 is b = unproject(uv, c) with the camera's parameters c
(``camera/projection.py``). It meets the plane of a board at (X, Y), at a distance s:
s b = R (X, Y, 0)^T + T. Across the ray, with B (3, 2) a basis there, both sides change alike,

    G d(X, Y) = B^T (s db - w x R X - tau),      G = B^T [r1 r2],

for an error (w, tau) of the pose. The pose was found with the same camera: its error is
D dc + e with D = d pose / d camera and e by the corners' noise (``calibration/board_poses.py``),
and most of what dc does to the ray D undoes again near the corners. With A = d(X, Y)/d(...)

    cov(X, Y) = s_uv^2 A_uv A_uv^T + (A_c + A_p D) cov(c) (A_c + A_p D)^T + A_p cov(e) A_p^T.

If the board is longer than stated by a share of s, so are X and Y: (X, Y) (X, Y)^T s^2 is added.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, freeze
from calibgui.engine.calibration.board_poses import BoardPose
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import unproject
from calibgui.engine.camera.validity import find_valid_pixels
from calibgui.engine.geometry.directions import make_tangent_basis
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import (
    compute_inverse_left_jacobian,
    rotation_from_vector,
)


@dataclass(frozen=True, eq=False, slots=True)
class PixelRays:
    """Rays of pixels in the camera's frame: X to the right, Y down, Z ahead."""

    rays: Array
    """(n, 3) of length 1; NaN for pixels without a ray."""
    covariance: Array
    """(n, 3, 3)."""
    is_in_image: BoolArray
    """(n,) whether the pixel lies in the camera's images."""

    def __post_init__(self) -> None:
        freeze(self, "rays", "covariance")

    @property
    def sigma(self) -> Array:
        """(n,) standard deviations of the directions where they are largest, rad."""
        return _find_largest_sigma(self.covariance)


@dataclass(frozen=True, eq=False, slots=True)
class BoardPoints:
    """Points of a board's plane that pixels look at."""

    points: Array
    """(n, 2) X, Y on the plane, mm; NaN for pixels whose ray does not meet it ahead."""
    covariance: Array
    """(n, 2, 2) mm^2."""
    rays: PixelRays

    def __post_init__(self) -> None:
        freeze(self, "points", "covariance")


def find_rays(
    uv: npt.ArrayLike,
    camera: Camera,
    covariance: Array | None = None,
    sigma: npt.ArrayLike = 0.0,
) -> PixelRays:
    """Find the rays that pixels look along.

    Args:
        uv: (n, 2) pixels.
        camera: the camera.
        covariance: (P, P) covariance of its parameters; None if it counts as exact.
        sigma: standard deviation of the pixels along each axis, px, one or (n,).

    Examples:
        >>> from calibgui.engine import Camera, find_rays
        >>> camera = Camera((640, 480), [600, 600, 320, 240], "pinhole")
        >>> find_rays([[320, 240], [920, 240]], camera).rays.round(6).tolist()
        [[0.0, 0.0, 1.0], [nan, nan, nan]]
    """
    return _trace(uv, camera, covariance, sigma)[0]


def find_board_points(
    uv: npt.ArrayLike,
    camera: Camera,
    plane: BoardPose | Pose,
    covariance: Array | None = None,
    sigma: npt.ArrayLike = 0.0,
) -> BoardPoints:
    """Find the points of a board's plane that pixels look at.

    Args:
        uv, camera, covariance, sigma: as for `find_rays`.
        plane: the board as `locate_board` found it with this camera, or a pose that counts as
            exact.

    Examples:
        >>> from calibgui.engine import Camera, Pose, find_board_points
        >>> camera = Camera((640, 480), [600, 600, 320, 240], "pinhole")
        >>> plane = Pose((0, 0, 0), (0, 0, 300))
        >>> find_board_points([[320, 240], [380, 300]], camera, plane).points.round(6).tolist()
        [[0.0, 0.0], [30.0, 30.0]]
    """
    seen, by_pixel, by_camera = _trace(uv, camera, covariance, sigma)
    pose = plane.pose if isinstance(plane, BoardPose) else plane
    R = rotation_from_vector(pose.rvec)
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = (R[:, 2] @ pose.tvec) / (seen.rays @ R[:, 2])
        distance = np.where(distance > 0, distance, np.nan)
    on_board = (distance[:, None] * seen.rays - pose.tvec) @ R
    points = on_board[:, :2]
    basis = make_tangent_basis(seen.rays)
    across = np.swapaxes(basis, 1, 2)
    # A plane that is seen edge-on has no point.
    G = across @ R[:, :2]
    is_met = np.isfinite(points).all(axis=1)
    inverse = np.full_like(G, np.nan)
    inverse[is_met] = np.linalg.inv(G[is_met])
    along_ray = inverse @ across * distance[:, None, None]
    spread = np.broadcast_to(np.asarray(sigma, dtype=np.float64), (len(points),))
    A_uv, A_c = along_ray @ by_pixel * spread[:, None, None], along_ray @ by_camera
    total = A_uv @ np.swapaxes(A_uv, 1, 2)
    if isinstance(plane, BoardPose):
        A_p = _differentiate_by_pose(inverse @ across, points @ R[:, :2].T, pose)
        A_c = A_c + A_p @ plane.by_camera
        total = total + A_p @ plane.noise_covariance @ np.swapaxes(A_p, 1, 2)
        scaled = plane.scale_sigma * points
        total = total + scaled[:, :, None] * scaled[:, None]
    if covariance is not None:
        total = total + A_c @ covariance @ np.swapaxes(A_c, 1, 2)
    return BoardPoints(points, total, seen)


def _differentiate_by_pose(across: Array, rotated: Array, pose: Pose) -> Array:
    """Return d(X, Y) (n, 2, 6) by (rvec, tvec); `across` is G^-1 B^T, `rotated` R X (n, 3)."""
    by_turn = -np.cross(rotated[:, None], across)  # a . (w x RX) = (RX x a) . w
    by_rvec = by_turn @ np.linalg.inv(compute_inverse_left_jacobian(pose.rvec))
    return np.concatenate([by_rvec, -across], axis=-1)


def _trace(
    uv: npt.ArrayLike, camera: Camera, covariance: Array | None, sigma: npt.ArrayLike
) -> tuple[PixelRays, Array, Array]:
    """Return rays, and their derivatives (n, 3, 2) by the pixel and (n, 3, P) by the camera."""
    pixels = np.asarray(uv, dtype=np.float64).reshape(-1, 2)
    centres = np.array(camera.size) / 2 - 0.5
    inside = np.asarray((np.abs(pixels - centres) <= centres + 0.5).all(axis=1))
    is_imaged = inside & find_valid_pixels(pixels, camera)
    with np.errstate(all="ignore"):  # pixels far outside
        rays, by_pixel, by_camera = unproject(pixels, camera.params, find_model(camera.model))
    rays = np.where(is_imaged[:, None], rays, np.nan)
    spread = np.broadcast_to(np.asarray(sigma, dtype=np.float64), (len(pixels),))
    by_noise = by_pixel * spread[:, None, None]
    total = by_noise @ np.swapaxes(by_noise, 1, 2)
    if covariance is not None:
        total = total + by_camera @ covariance @ np.swapaxes(by_camera, 1, 2)
    total[~is_imaged] = np.nan
    return PixelRays(rays, total, inside), by_pixel, by_camera


def _find_largest_sigma(covariance: Array) -> Array:
    """Return (n,) the standard deviation where it is largest; NaN where it is not known."""
    known = np.isfinite(covariance).all(axis=(1, 2))
    largest = np.full(len(covariance), np.nan)
    if known.any():
        largest[known] = np.linalg.eigvalsh(covariance[known])[:, -1]
    return np.asarray(np.sqrt(np.maximum(largest, 0.0)))

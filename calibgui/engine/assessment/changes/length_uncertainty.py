"""A length in a plane across the axis is as uncertain as both its ends, and the camera, make it.

The ends of a length L at a depth Z are seen at two pixels, and each pixel's ray meets the plane at
a point (X, Y). With S = dq/d(X, Y) at an end, its point moves by -S^-1 J dc with an error dc of the
camera, beside the rotation that makes up for part of it (J, ``camera_uncertainty.py``), and by
S^-1 e with an error e of the corner that is seen there. Along the length's direction d

    dL = d^T (S2^-1 (e2 - J2 dc) - S1^-1 (e1 - J1 dc)),

of which both ends share dc: what moves them alike is no error of the length. The scale of lengths
is that of the board: an error of it by a share s is one of s L, wherever the length is. It counts
that the depth is known, and the plane across the axis; an error of the depth goes into the length
in proportion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.assessment.changes.camera_uncertainty import find_compensating_turn
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import project, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import compute_sensitivity, make_map_grid


@dataclass(frozen=True, eq=False, slots=True)
class LengthUncertainty:
    """One standard deviation of a length in a plane across the axis, by its place in the image."""

    length: float
    """The length, mm."""
    depth: float
    """Depth of the plane, mm."""
    uv: Array
    """(n, 2) pixels of the length's middle."""
    by_calibration: Array
    """(n,) mm, by the camera's error, in the direction along which the whole error is largest; NaN
    where an end is not in the image."""
    by_noise: Array
    """(n,) mm, by the noise of the corners at its ends."""
    by_scale: float = 0.0
    """By the board's scale, mm, the same everywhere."""

    def __post_init__(self) -> None:
        freeze(self, "uv", "by_calibration", "by_noise")

    @property
    def sigma(self) -> Array:
        """(n,) mm, by all three."""
        return np.hypot(np.hypot(self.by_calibration, self.by_noise), self.by_scale)

    @property
    def shares(self) -> tuple[float, float, float]:
        """Shares of calibration, noise and scale in the variance where it is largest."""
        k = self.worst
        parts = np.array([self.by_calibration[k], self.by_noise[k], self.by_scale])
        calibration, noise, scale = (parts**2 / self.sigma[k] ** 2).tolist()
        return calibration, noise, scale

    @property
    def worst(self) -> int:
        """Index of the place where the length is known worst."""
        return int(np.nanargmax(self.sigma))


def estimate_length_uncertainty(
    calibration: Calibration,
    views: Sequence[Observation],
    length: float,
    depth: float,
    uv: npt.ArrayLike | None = None,
    scale_sigma: float = 0.0,
) -> LengthUncertainty:
    """Estimate how wrong a length is that is measured by its two ends.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
        length: the length, mm.
        depth: depth of the plane in which it lies, mm.
        uv: (n, 2) pixels of its middle; all over the image if None.
        scale_sigma: standard deviation of the board's scale, relative (`Board.scale_sigma`).

    Raises:
        CalibrationError: if length or depth is not positive, or the length is nowhere in the image.
    """
    camera, free = calibration.camera, find_free_parameters(calibration)
    if not (length > 0 and depth > 0):
        raise CalibrationError(
            f"A length of {length:g} mm at {depth:g} mm cannot be seen.",
            "State two lengths above 0.",
        )
    u, v = make_map_grid(camera.size)
    mesh = make_mesh(u[::4], v[::4]).reshape(-1, 2)  # lengths differ slowly over the image
    middles = mesh if uv is None else np.asarray(uv, np.float64).reshape(-1, 2)
    turn = find_compensating_turn(camera, free, views)
    rays = rays_from_pixels(middles, camera)
    centre = depth * rays / np.where(rays[:, 2:] > 0, rays[:, 2:], np.nan)
    covariance = calibration.covariance[np.ix_(free, free)]
    parts = []
    for direction in np.eye(2):
        g = np.zeros((len(middles), len(free)))
        noise = np.zeros(len(middles))
        for side in (-1.0, 1.0):
            end = centre + side * length / 2 * np.append(direction, 0.0)
            seen = project(end, camera.params, find_model(camera.model))
            is_seen = ((seen.points >= -0.5) & (seen.points <= np.array(camera.size) - 0.5)).all(1)
            is_seen &= camera.lights(seen.points)
            pixel = np.where(is_seen[:, None], seen.points, np.nan)
            by_params, by_motion = compute_sensitivity(camera, pixel, depth)
            J = by_params[..., free] + by_motion[..., :3] @ turn
            S = np.where(is_seen[:, None, None], seen.by_ray[..., :2], np.nan)
            across = direction @ _invert(S)  # (n, 2)
            g -= side * (across[:, None] @ J)[:, 0]
            noise += calibration.noise**2 * np.sum(across**2, axis=1)
        parts.append((np.sqrt(np.sum(g @ covariance * g, axis=1)), np.sqrt(noise)))
    (first, first_noise), (second, second_noise) = parts
    is_first = np.hypot(first, first_noise) > np.hypot(second, second_noise)
    found = LengthUncertainty(
        length,
        depth,
        middles,
        np.where(is_first, first, second),
        np.where(is_first, first_noise, second_noise),
        length * scale_sigma,
    )
    if not np.isfinite(found.sigma).any():
        raise CalibrationError(
            f"A length of {length:g} mm at {depth:g} mm does not lie in the image.",
            "State a shorter length, a greater distance or another pixel.",
        )
    return found


def _invert(S: Array) -> Array:
    """Invert matrices (n, 2, 2); NaN stays NaN."""
    known = np.asarray(np.isfinite(S).all(axis=(1, 2)))
    return np.where(
        known[:, None, None], np.linalg.inv(np.where(known[:, None, None], S, np.eye(2))), np.nan
    )

"""The uncertainty of points that a rig locates in space is computed at chosen distances.

The points lie ahead: on the line from the middle of the cameras' centres through the middle of the
places where the board was. Their pixels are computed, and what errors of these and of the rig make
of the points is that of triangulation (``triangulation.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig.records import Rig
from calibgui.engine.rig.triangulation import triangulate_points


@dataclass(frozen=True, slots=True)
class PointUncertainty:
    """The standard deviations of a point ahead of a rig."""

    distance: float
    """Distance from the middle of the cameras, mm."""
    cameras: int
    """Number of cameras that see it."""
    along: float
    """Standard deviation along the line to it, mm; NaN if fewer than two cameras see it."""
    across: float
    """Larger standard deviation across that line, mm."""
    share_of_calibration: float
    """Share of the variance that the errors of the rig have, 0 to 1; the rest is the pixels'."""


def estimate_point_uncertainty(
    rig: Rig, sigma: float, distances: Sequence[float] = ()
) -> list[PointUncertainty]:
    """Estimate how well points ahead of a rig are located.

    Args:
        rig: the rig.
        sigma: standard deviation of a pixel along each axis, px.
        distances: of the points, mm; by default half, once, twice and four times that of the board.
    """
    centres = np.array(
        [-rotation_from_vector(pose.rvec).T @ pose.tvec for pose in rig.poses], dtype=np.float64
    )
    start = centres.mean(axis=0)
    aim = np.mean([board.tvec for board in rig.boards], axis=0) - start
    usual = float(np.linalg.norm(aim))
    ahead = aim / usual
    wanted = np.array(distances if len(distances) else [0.5 * usual, usual, 2 * usual, 4 * usual])
    points = start + wanted[:, None] * ahead
    pixels = {c: _see_points(rig, c, points) for c in range(len(rig.cameras))}
    found = triangulate_points(rig, pixels, sigma)
    seen = np.isfinite(found.residuals).all(axis=2).sum(axis=0)
    across = np.eye(3) - np.outer(ahead, ahead)
    estimates = []
    for k, distance in enumerate(wanted.tolist()):
        whole = found.covariance[k]
        along = float(ahead @ whole @ ahead)
        sideways = across @ whole @ across
        largest = np.linalg.eigvalsh(sideways)[-1] if np.isfinite(sideways).all() else np.nan
        share = np.trace(found.by_calibration[k]) / np.trace(whole)
        estimates.append(
            PointUncertainty(
                distance, int(seen[k]), along**0.5, float(largest) ** 0.5, float(share)
            )
        )
    return estimates


def _see_points(rig: Rig, c: int, points: Array) -> Array:
    """Return the pixels (n, 2) of points (n, 3) in camera `c`; NaN outside of its image."""
    camera, pose = rig.cameras[c], rig.poses[c]
    X = points @ rotation_from_vector(pose.rvec).T + pose.tvec
    pixels = pixels_from_rays(X, camera)
    width, height = camera.size
    with np.errstate(invalid="ignore"):
        within = (pixels > -0.5) & (pixels < [width - 0.5, height - 0.5])
        inside = np.asarray(within.all(axis=1), dtype=bool)
        # A lens that folds over images points that it does not see.
        rays = rays_from_pixels(np.where(inside[:, None], pixels, np.nan), camera)
        there = np.sum(rays * X, axis=1) > (1 - 1e-6) * np.linalg.norm(X, axis=1)
    seen = np.asarray(inside & there, dtype=bool)
    return np.where(seen[:, None], pixels, np.nan)

"""The spread of a fleet: how far each of many cameras of one kind is from the median of all.

Raw parameters do not tell: focal length, centre and distortion trade against each other. Cameras
are therefore compared by where they image the same far points. A grid of pixels of camera a, the
one of median focal length, gives the directions; camera k images them, after the rotation that
brings it closest to a, with the displacements

    d_k = project_k(R_k ray) - uv,      min over R_k   sum |d_k|^2.

The median over all cameras at each pixel is the fleet's median camera, whatever the lens models
are. The root mean square over the image of d_k minus it, from which the rotations are eliminated
again, is a camera's difference from the fleet, px. It contains the errors of the calibration. A
camera is an outlier if its difference exceeds the median of all differences by more than
`OUTLIER_Z` times their spread, as the median absolute deviation estimates it: single bad cameras
move neither.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, freeze
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import project_moved_points

MIN_FLEET = 5
"""Least number of cameras of a fleet: of fewer none can be told from the others."""
OUTLIER_Z = 5.0
"""Robust z from which a camera is an outlier: of 1,000 simulated cameras with normal scatter of
focal length, centre and distortion 0 to 4 are beyond it."""
_GRID_STEPS = 20
"""Number of cells along the longer side of the image at whose middles cameras are compared."""
_MAX_ITERATIONS, _MAX_TURN_AT_END = 20, 1e-9
"""Number of Gauss-Newton steps, and the angle, rad, that ends them."""
_MIN_SHARE = 0.5
"""Share of the pixels that two cameras must see both to be compared."""
_MIN_SPREAD_PX = 1e-3
"""Least spread of the differences, px: what is below is rounding, not a fleet."""
_SIGMA_OF_DEVIATION = 1.4826
"""Standard deviation of normal numbers over their median absolute deviation."""


@dataclass(frozen=True, eq=False, slots=True)
class FleetSpread:
    """The differences of cameras from the median camera of their fleet."""

    rms: Array
    """(n,) root mean square difference over the image, px; infinite where a camera has too little
    in common with the others."""
    worst: Array
    """(n,) largest difference, px, up to half a cell of the grid from the image's edge."""
    z: Array
    """(n,) robust z of `rms`: by how many standard deviations it is above the median of all; NaN if
    there are fewer than `MIN_FLEET` cameras."""

    def __post_init__(self) -> None:
        freeze(self, "rms", "worst", "z")

    @property
    def is_outlier(self) -> BoolArray:
        """(n,) true for cameras that are unlike the others."""
        return np.asarray(self.z > OUTLIER_Z)


def measure_fleet_spread(cameras: Sequence[Camera]) -> FleetSpread:
    """Measure the difference of each camera from the median of all.

    Args:
        cameras: cameras of one image size; their lens models may differ.

    Raises:
        CalibrationError: if there are none, or their images have different sizes.
    """
    if len({camera.size for camera in cameras}) != 1:
        raise CalibrationError(
            "A fleet has cameras of one image size.", "Compare those of each size apart."
        )
    middle = sorted(cameras, key=lambda camera: float(camera.focal.mean()))[len(cameras) // 2]
    w, h = middle.size
    steps = np.maximum(np.rint(_GRID_STEPS * np.array([w, h]) / max(w, h)), 2).astype(int)
    u, v = (
        (np.arange(n) + 0.5) * length / n - 0.5 for n, length in zip(steps, (w, h), strict=True)
    )
    uv = make_mesh(u, v).reshape(-1, 2)
    rays = rays_from_pixels(uv, middle)
    uv, rays = (x[np.isfinite(rays).all(axis=1)] for x in (uv, rays))
    shifts = np.array([_compute_shifts(rays, uv, camera) for camera in cameras])
    known = np.isfinite(shifts).all(axis=2).any(axis=1)
    median = np.nanmedian(shifts[known], axis=0) if known.any() else np.zeros_like(uv)
    by_turn = project_moved_points(rays, middle)[2][..., :3]
    rms, worst = np.full(len(cameras), np.inf), np.full(len(cameras), np.inf)
    for k in np.flatnonzero(known):
        length = np.linalg.norm(_remove_turn(shifts[k] - median, by_turn), axis=-1)
        rms[k], worst[k] = np.sqrt(np.nanmean(length**2)), np.nanmax(length)
    return FleetSpread(rms, worst, _compute_robust_z(rms))


def _compute_shifts(rays: Array, uv: Array, camera: Camera) -> Array:
    """Return the displacements (n, 2) of a camera's pixels; all NaN if it sees too few of them."""
    R = np.eye(3)
    for _ in range(_MAX_ITERATIONS):
        turned = rays @ R.T
        seen, _, by_motion = project_moved_points(turned, camera)
        d, J = seen - uv, by_motion[..., :3]
        used = np.asarray(np.isfinite(d).all(axis=1) & np.isfinite(J).all(axis=(1, 2)))
        if used.mean() < _MIN_SHARE:
            break
        turn = np.asarray(
            np.linalg.lstsq(J[used].reshape(-1, 3), -d[used].ravel(), rcond=None)[0], dtype=float
        )
        if np.linalg.norm(turn) < _MAX_TURN_AT_END:
            return np.where(used[:, None], d, np.nan)
        R = rotation_from_vector(turn) @ R
    return np.full_like(uv, np.nan)


def _remove_turn(d: Array, by_turn: Array) -> Array:
    """Return displacements (n, 2) without what a rotation does; NaN stays NaN."""
    used = np.isfinite(d).all(axis=1) & np.isfinite(by_turn).all(axis=(1, 2))
    J = by_turn[used].reshape(-1, 3)
    turn = np.linalg.lstsq(J, d[used].ravel(), rcond=None)[0]
    found = np.full_like(d, np.nan)
    found[used] = d[used] - (J @ turn).reshape(-1, 2)
    return found


def _compute_robust_z(rms: Array) -> Array:
    """Return by how many standard deviations numbers (n,) are above their median."""
    if len(rms) < MIN_FLEET:
        return np.full(len(rms), np.nan)
    known = rms[np.isfinite(rms)]
    if not known.size:
        return np.full(len(rms), np.nan)
    middle = np.median(known)
    spread = max(_SIGMA_OF_DEVIATION * float(np.median(np.abs(known - middle))), _MIN_SPREAD_PX)
    return np.asarray((rms - middle) / spread)

"""Comparison of two calibrations by the pixels at which they see the same point.

Camera a sees a point p = p_a(uv) behind each of its pixels. Camera b, calibrated apart, places
its centre and axis differently, so that p is X = R p + t to it. The motion is the one that brings
the two closest together over the region of interest,

    min over R, t   sum |project_b(R p + t) - uv|^2,

by Gauss-Newton with the motion's derivatives of ``projection_uncertainty.py``; at infinity a
rotation alone. Points that b images an image's side away or farther do not count: towards the limit
of its angle a model may image them anywhere. What then remains is the difference of the two as
cameras (mrcal's "projection diff"). It does not measure what a rotation makes up for: the
difference of the principal points, above all, to which pixels of distant points are almost blind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, Size, freeze
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import (
    back_project_pixels,
    make_map_grid,
    project_moved_points,
)

_MAX_ITERATIONS = 50
"""Number of Gauss-Newton steps beyond which the cameras have too little in common."""
_MAX_CHANGE_AT_END_PX = 1e-10
"""Change of the root mean square difference that ends the iteration, px."""
_MAX_RESTLESSNESS = 0.1
"""Change of the root mean square difference in the last step, relative to it, that is still an
answer: cameras far apart trade points at the edge of what they see."""


@dataclass(frozen=True, eq=False, slots=True)
class CameraDifference:
    """Displacement of camera b's pixels against camera a's, over a's image."""

    size: Size
    """Width and height of the image, px."""
    distance: float
    """Distance of the points from camera a, mm; infinite for directions."""
    u: Array
    """(n,) columns of the map, px."""
    v: Array
    """(m,) rows of the map, px."""
    vector: Array
    """(m, n, 2) b's pixel minus a's, px; NaN where one of the lenses has none."""
    region: BoolArray
    """(m, n) true where the two were brought together and the statistics are taken."""
    turn: Array
    """(3,) rotation vector of the motion b_from_a, rad."""
    shift: Array
    """(3,) its translation, mm; 0 at infinity."""

    def __post_init__(self) -> None:
        freeze(self, "u", "v", "vector", "turn", "shift")

    @property
    def length(self) -> Array:
        """(m, n) length of the displacement, px."""
        return np.asarray(np.linalg.norm(self.vector, axis=-1))

    @property
    def rms(self) -> float:
        """Root mean square length in the region, px."""
        return float(np.sqrt(np.nanmean(self.length[self.region] ** 2)))

    @property
    def median(self) -> float:
        """Median length in the region, px."""
        return float(np.nanmedian(self.length[self.region]))

    @property
    def worst(self) -> float:
        """Largest length in the region, px."""
        return float(np.nanmax(self.length[self.region]))


def compare_cameras(
    a: Camera,
    b: Camera,
    distance: float = np.inf,
    views: Sequence[Observation] | None = None,
) -> CameraDifference:
    """Compute the displacement map of camera b against camera a.

    Args:
        a, b: cameras of one image size.
        distance: distance of the points from a, mm; infinite for directions.
        views: views whose corners outline the region to compare; the whole image if None.

    Raises:
        CalibrationError: if the sizes differ, the distance is not positive or the cameras have
            nothing in common to compare.
    """
    if a.size != b.size:
        raise CalibrationError(
            f"The cameras' images have different sizes, {a.size[0]} x {a.size[1]} and "
            f"{b.size[0]} x {b.size[1]} pixels.",
            "Compare calibrations of one camera at one resolution.",
        )
    if not distance > 0:
        raise CalibrationError(
            f"A distance of {distance:g} mm is not in front of the camera.",
            "Give a positive distance, or none for points far away.",
        )
    u, v = make_map_grid(a.size)
    uv = make_mesh(u, v)
    region = np.ones(uv.shape[:2], dtype=bool) if views is None else find_covered_pixels(uv, views)
    R, t = _fit_motion(a, b, distance, uv[region])
    seen = project_moved_points(back_project_pixels(uv, a, distance) @ R.T + t, b)[0]
    return CameraDifference(a.size, distance, u, v, seen - uv, region, vector_from_rotation(R), t)


def find_covered_pixels(uv: Array, views: Sequence[Observation]) -> BoolArray:
    """Return (...) whether pixels (..., 2) lie in the convex hull of the corners of all views.

    Raises:
        CalibrationError: if a corner is not a finite number.
    """
    corners = np.concatenate([view.uv for view in views])
    if not np.isfinite(corners).all():
        raise CalibrationError(
            "A view holds a corner that is not a finite number.", "Remove that corner or the view."
        )
    sides = scipy.spatial.ConvexHull(corners).equations
    return np.asarray((uv @ sides[:, :2].T + sides[:, 2] <= 0).all(axis=-1))


def _fit_motion(a: Camera, b: Camera, distance: float, uv: Array) -> tuple[Array, Array]:
    """Fit R (3, 3) and t (3,), mm, that bring b closest to a at pixels (n, 2)."""
    p = back_project_pixels(uv, a, distance)
    R, t = np.eye(3), np.zeros(3)
    moving = 6 if np.isfinite(distance) else 3
    last = np.inf
    for _ in range(_MAX_ITERATIONS):
        moved = p @ R.T + t
        seen, _, by_motion = project_moved_points(moved, b)
        miss = seen - uv
        with np.errstate(invalid="ignore"):
            good = np.linalg.norm(miss, axis=-1) < max(a.size)
        if good.sum() < moving:
            break
        rms = float(np.sqrt(np.mean(miss[good] ** 2)))
        change, last = abs(last - rms), rms
        if change < _MAX_CHANGE_AT_END_PX:
            return R, t
        J = by_motion[good][..., :moving].reshape(-1, moving)
        unit = np.linalg.norm(J, axis=0)
        step = -np.linalg.lstsq(J / unit, miss[good].ravel(), rcond=None)[0] / unit
        turn = rotation_from_vector(step[:3])
        R, t = turn @ R, turn @ t + (step[3:] if moving == 6 else 0.0)
    else:
        if change < _MAX_RESTLESSNESS * last:
            return R, t
    raise CalibrationError(
        "The two cameras cannot be brought together: they see too little in common.",
        "Check that both calibrations are of the same camera and lens.",
    )

"""How two calibrations differ where it matters: in the pixels at which they see the same point.

Camera a sees a point p = p_a(uv) behind each of its pixels. Camera b, calibrated on its own,
has its own idea of where its centre and axis are, so that p is X = R p + t to it. The motion is
what brings the two closest together over the region of interest,

    min over R, t   sum |project_b(R p + t) - uv|^2,

by Gauss-Newton with the motion's derivatives of ``projection_uncertainty.py``; at infinity a
rotation alone. What then remains is the difference of the two as cameras. A free rotation
hides what it can: the principal point's difference, above all, to which pixels of distant
points are almost blind.
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
from calibgui.engine.geometry.rotations import rotation, rotation_vector
from calibgui.engine.images.sampling import mesh
from calibgui.engine.uncertainty.projection_uncertainty import grid, imaged, points_behind

_STEPS = 50
_CONVERGED = 1e-10
"""Change of the root mean square difference that ends the iteration, px."""


@dataclass(frozen=True, eq=False, slots=True)
class Difference:
    """Where camera b sees what camera a sees, over a's image."""

    size: Size
    distance: float
    """Of the points from camera a, mm; infinite for directions."""
    u: Array
    """(n,) columns of the map, px."""
    v: Array
    """(m,) rows of the map, px."""
    vector: Array
    """(m, n, 2) b's pixel minus a's, px; NaN where one of the lenses has none."""
    region: BoolArray
    """(m, n) where the two were brought together and the numbers are taken."""
    turn: Array
    """(3,) rotation vector of the motion b_from_a, rad."""
    shift: Array
    """(3,) its translation, mm; 0 at infinity."""

    def __post_init__(self) -> None:
        freeze(self, "u", "v", "vector", "turn", "shift")

    @property
    def length(self) -> Array:
        """(m, n) px."""
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
) -> Difference:
    """The displacement map of camera b against camera a.

    Args:
        a, b: cameras of one image size.
        distance: of the points seen from a, mm; infinite for directions.
        views: whose corners outline the region to compare; the whole image if None.

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
    u, v = grid(a.size)
    uv = mesh(u, v)
    region = np.ones(uv.shape[:2], dtype=bool) if views is None else covered(uv, views)
    R, t = _motion(a, b, distance, uv[region])
    seen = imaged(points_behind(uv, a, distance) @ R.T + t, b)[0]
    return Difference(a.size, distance, u, v, seen - uv, region, rotation_vector(R), t)


def covered(uv: Array, views: Sequence[Observation]) -> BoolArray:
    """(...) whether pixels (..., 2) lie in the convex hull of the corners of all views."""
    sides = scipy.spatial.ConvexHull(np.concatenate([view.uv for view in views])).equations
    return np.asarray((uv @ sides[:, :2].T + sides[:, 2] <= 0).all(axis=-1))


def _motion(a: Camera, b: Camera, distance: float, uv: Array) -> tuple[Array, Array]:
    """R (3, 3) and t (3,) that bring b closest to a at pixels (n, 2)."""
    p = points_behind(uv, a, distance)
    R, t = np.eye(3), np.zeros(3)
    moving = 6 if np.isfinite(distance) else 3
    last = np.inf
    for _ in range(_STEPS):
        moved = p @ R.T + t
        seen, _, by_motion = imaged(moved, b)
        miss = seen - uv
        good = np.isfinite(miss).all(axis=-1)
        if good.sum() < moving:
            break
        rms = float(np.sqrt(np.mean(miss[good] ** 2)))
        if abs(last - rms) < _CONVERGED:
            return R, t
        last = rms
        J = by_motion[good][..., :moving].reshape(-1, moving)
        unit = np.linalg.norm(J, axis=0)
        step = -np.linalg.lstsq(J / unit, miss[good].ravel(), rcond=None)[0] / unit
        turn = rotation(step[:3])
        R, t = turn @ R, turn @ t + (step[3:] if moving == 6 else 0.0)
    raise CalibrationError(
        "The two cameras cannot be brought together: they see too little in common.",
        "Check that both calibrations are of the same camera and lens.",
    )

"""Drift: has a camera changed between two calibrations, or is the difference theirs?

The difference d of the two as cameras, px, is that of ``comparison.py``: where camera b sees the
points behind camera a's pixels, after the motion that brings both closest together, since poses
make up for any: a rotation for far points. The calibrations' covariances Ca and Cb explain a part
of it. With the derivatives Ja and Jb of the pixels by the parameters, from which the motion is
eliminated as well,

    cov(d) = Ja Ca Ja^T + Jb Cb Jb^T = U S^2 U^T,      chi^2 = sum_i (u_i^T d)^2 / s_i^2

is distributed as chi^2 with one degree of freedom for each direction u_i, if the camera has not
changed. Directions in which neither calibration is uncertain by a thousandth of a pixel are left
out: there the model is at its limit, not the camera. What a motion makes up for, which is most of
a shift of the principal point, is neither part of the difference nor of the test.

Both calibrations share the board, if it is the same one: its deviations from the drawing pull at
both cameras alike. `choose_covariance` therefore takes what the corners' noise and the views'
disagreement explain, as long as the residuals do not show that the board is off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.camera_change import factor_covariance
from calibgui.engine.assessment.changes.comparison import CameraDifference, compare_cameras
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import compute_sensitivity

SIGNIFICANCE = 0.05
"""Probability with which two calibrations of an unchanged camera are said to differ."""
_MIN_SIGMA_PX = 1e-3
"""Standard deviation of a direction of the difference, px rms over the image, from which it is
tested."""


class UncertainCamera(NamedTuple):
    """A camera and how well it is known."""

    camera: Camera
    covariance: Array
    """(P, P) covariance of its parameters; 0 where they are held."""


@dataclass(frozen=True, eq=False, slots=True)
class Drift:
    """The difference of two calibrations, and whether their uncertainties explain it."""

    difference: CameraDifference
    """Displacement of camera b's pixels against camera a's."""
    chi_square: float
    """Sum of the squared differences in all directions, in standard deviations."""
    freedom: int
    """Number of directions."""
    expected: float
    """Root mean square difference, px, that the uncertainties explain."""

    @property
    def probability(self) -> float:
        """Probability of a difference as large as this one if the camera has not changed."""
        if not self.freedom:
            return 1.0
        return float(scipy.special.chdtrc(self.freedom, self.chi_square))

    @property
    def has_changed(self) -> bool:
        """True if the difference is more than the uncertainties explain."""
        return self.probability < SIGNIFICANCE


def choose_covariance(calibration: Calibration, is_same_board: bool = True) -> Array:
    """Return the covariance (P, P) of a calibration that matters beside another one.

    Args:
        calibration: the calibration.
        is_same_board: whether the other calibration is made with the same board, whose deviations
            then do the same to both.
    """
    if not is_same_board or calibration.board_shape_error > 0 or calibration.lens_error > 0:
        return np.asarray(calibration.covariance)
    return np.asarray(calibration.noise_covariance * max(calibration.overdispersion, 1.0) ** 2)


def measure_drift(
    a: UncertainCamera,
    b: UncertainCamera,
    *,
    distance: float = np.inf,
    views: Sequence[Observation] | None = None,
) -> Drift:
    """Measure the difference of two calibrations, and test it.

    Args:
        a, b: the cameras, of one image size. Their lens models may differ.
        distance: distance of the points from camera a, mm; infinite for directions.
        views: views whose corners outline the region to compare; the whole image if None.

    Raises:
        CalibrationError: as `compare_cameras`.
    """
    found = compare_cameras(a.camera, b.camera, distance, views)
    uv = make_mesh(found.u, found.v)
    seen = np.isfinite(found.vector).all(axis=-1) & found.region
    roots, motions = zip(
        *(_propagate_root(camera, uv[seen], distance) for camera in (a, b)), strict=True
    )
    columns = np.concatenate(roots, axis=-1)
    finite = np.isfinite(columns).all(axis=(1, 2)) & np.isfinite(motions[0]).all(axis=(1, 2))
    by_motion = motions[0][finite]
    motion = np.linalg.qr(by_motion.reshape(-1, by_motion.shape[-1]))[0]
    both = np.concatenate([columns, found.vector[seen][..., None]], axis=-1)[finite]
    both = both.reshape(-1, both.shape[-1])
    both = both - motion @ (motion.T @ both)
    u, s, _ = np.linalg.svd(both[:, :-1], full_matrices=False)
    tested = s > _MIN_SIGMA_PX * np.sqrt(finite.sum())
    z = (u.T @ both[:, -1])[tested] / s[tested]
    expected = float(np.sqrt(np.sum(s**2) / finite.sum()))
    return Drift(found, float(z @ z), int(tested.sum()), expected)


def _propagate_root(known: UncertainCamera, uv: Array, distance: float) -> tuple[Array, Array]:
    """Return the root (n, 2, E) of the pixels' covariance, and their derivatives by the motion:
    (n, 2, 3) at infinity, where it is a rotation, and (n, 2, 6) otherwise."""
    by_params, by_motion = compute_sensitivity(known.camera, uv, distance)
    root = factor_covariance(known.covariance)
    moving = 6 if np.isfinite(distance) else 3
    return by_params @ root if root.size else by_params[..., :0], by_motion[..., :moving]

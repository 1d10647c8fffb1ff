"""Repeatability of corners: how far they scatter in frames of a board that stands still.

A corner i that is located at u_ki in frame k is at its mean place but for its noise and for what
moved the camera, or the board, meanwhile. The image of a plane moves by a homography, for small
motions linear in eight numbers a_k with the columns of the tangent space at the identity,

    u_ki - mean_k u_ki = B_i a_k + e_ki,   B_i = [1 x y 0 0 0 x^2 xy; 0 0 0 1 x y xy y^2],

x, y the mean place of corner i, scaled to the image. The noise's variance per coordinate is the sum
of e^2 over its (K - 1) (2 N - 8) degrees of freedom, and an F-test of the sum of (B a)^2 over
8 (K - 1) tells whether the frames moved. It does not measure errors that are the same in every
frame: those of the lens model, the board, and of the light at a corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.assessment.changes.calibration_check import DEFAULT_LIMIT
from calibgui.engine.calibration.lens_error import MAX_FALSE_ALARM_RATE
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, eq=False, slots=True)
class Repeatability:
    """The scatter of corners in frames of a board that stands still."""

    uv: Array
    """(n, 2) mean places of the corners that all frames show, px."""
    sigma: Array
    """(n,) standard deviation of each corner along an axis, px, without the frames' motion."""
    rms: float
    """The same of all corners, px."""
    rms_sigma: float
    """Standard deviation of `rms`, px."""
    stated: float
    """Root mean square of the standard deviations that were stated of the corners, px; NaN if none
    were."""
    motion: float
    """Root mean square displacement of the corners by the frames' motion, px; 0 if none is seen."""
    frames: int

    def __post_init__(self) -> None:
        freeze(self, "uv", "sigma")


def measure_repeatability(frames: Sequence[Observation]) -> Repeatability:
    """Measure how far corners scatter in frames of a board that stands still.

    Args:
        frames: the corners of each frame; those of one place on the board are the same corner.

    Raises:
        CalibrationError: if there are fewer than two frames or five corners that all of them show,
            the board does not stand still, or the frames are copies of each other.
    """
    if len(frames) < 2:
        raise CalibrationError(
            "One frame does not show how corners scatter.",
            "Take 20 to 30 photographs of a board and a camera that both stand still.",
        )
    uv, cov = _gather_common_corners(frames)
    if not np.ptp(uv, axis=0).any():
        raise CalibrationError(
            "The frames are copies of one photograph: their corners do not differ.",
            "Take 20 to 30 photographs of a board and a camera that both stand still.",
        )
    mean = uv.mean(axis=0)
    size = float(np.abs(mean - mean.mean(axis=0)).max())
    x, y = ((mean - mean.mean(axis=0)) / size).T
    one, zero = np.ones_like(x), np.zeros_like(x)
    along = np.stack([one, x, y, zero, zero, zero, x * x, x * y], axis=-1)
    across = np.stack([zero, zero, zero, one, x, y, x * y, y * y], axis=-1)
    B = np.stack([along, across], axis=1).reshape(-1, 8)
    off = (uv - mean).reshape(len(uv), -1)
    moved = off @ np.linalg.pinv(B).T @ B.T
    freedom, moves = (len(uv) - 1) * (len(B) - 8), 8 * (len(uv) - 1)
    by_noise, by_motion = float(np.sum((off - moved) ** 2)), float(np.sum(moved**2))
    variance = by_noise / freedom
    probability = scipy.special.fdtrc(moves, freedom, by_motion / moves / variance)
    excess = 2 * (by_motion - moves * variance) / off.size
    motion = float(np.sqrt(max(excess, 0.0))) if probability < MAX_FALSE_ALARM_RATE else 0.0
    if motion > DEFAULT_LIMIT:
        raise CalibrationError(
            f"The board does not stand still: its corners move by {motion:.2g} px rms from frame "
            "to frame.",
            "Fasten board and camera, and let nobody touch the camera: a timer or a cable.",
        )
    each = np.sum(((off - moved) ** 2).reshape(len(uv), -1, 2), axis=(0, 2))
    return Repeatability(
        uv=mean,
        sigma=np.sqrt(each * len(each) / freedom),
        rms=float(np.sqrt(variance)),
        rms_sigma=float(np.sqrt(variance / (2 * freedom))),
        stated=np.nan if cov is None else float(np.sqrt(np.mean(np.trace(cov, 0, 1, 2) / 2))),
        motion=motion,
        frames=len(uv),
    )


def _gather_common_corners(frames: Sequence[Observation]) -> tuple[Array, Array | None]:
    """Return the corners (K, n, 2) that all frames show, and the covariances (K n, 2, 2) if any."""
    places = [[tuple(xy) for xy in np.round(frame.xy, 6).tolist()] for frame in frames]
    common = sorted(set.intersection(*map(set, places)))
    if len(common) < 5:
        raise CalibrationError(
            f"All {len(frames)} frames show only {len(common)} of the board's corners.",
            "Take photographs in which the same corners are seen, sharp and evenly lit.",
        )
    rows = [[place.index(xy) for xy in common] for place in places]
    uv = np.stack([frame.uv[row] for frame, row in zip(frames, rows, strict=True)])
    covs = [frame.cov for frame in frames]
    known = [cov[row] for cov, row in zip(covs, rows, strict=True) if cov is not None]
    return uv, np.concatenate(known) if len(known) == len(frames) else None

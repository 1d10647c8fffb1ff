"""Whitening: weights from the corners' covariances and the model's own errors.

A corner's residual has the covariance C_i + tau^2 I: C_i is the uncertainty of its location, and
tau^2 the variance of the errors of board and lens model, alike for all corners. Weighting by C_i
alone would trust the sharpest corners far beyond the accuracy of the model, so tau is estimated:
the value at which

    sum_i r_i^T (C_i + tau^2 I)^-1 r_i = 2N - unknowns,

falling steadily in tau^2, or 0 if the covariances explain the residuals by themselves. Weights
are scaled to the median corner, so that costs stay in px^2.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observations

_RELATIVE_TOLERANCE = 1e-6
"""Relative change of tau^2 at which its estimate ends."""
_MAX_STEPS = 100
"""Number of steps that the estimate of tau^2 never needs: far off, each nearly doubles it."""


def whiten_observations(observations: Observations, tau2: float = 0.0) -> Observations:
    """Return the observations with whitenings from (C + tau^2 I)^-1; unchanged without covariances.

    Args:
        observations: the views.
        tau2: variance of the model's own errors along each axis, px^2.
    """
    if observations.cov is None:
        return observations
    total = observations.cov + tau2 * np.eye(2)
    places = observations.mask > 0
    typical = float(np.median(np.trace(total[places], axis1=1, axis2=2))) / 2
    root = np.swapaxes(np.linalg.cholesky(np.linalg.inv(total)), -1, -2)
    whitening = np.sqrt(typical) * root * observations.mask[..., None, None]
    return replace(observations, whitening=whitening, tau2=tau2)


def estimate_model_variance(observations: Observations, residual: Array, unknowns: int) -> float:
    """Estimate tau^2, px^2; 0 without covariances or redundancy.

    Args:
        observations: the views, with the covariances of their corners.
        residual: (K, N, 2) residuals, px, not whitened.
        unknowns: number of unknowns that were fitted to them.
    """
    freedom = 2 * observations.count - unknowns
    if observations.cov is None or freedom <= 0:
        return 0.0
    places = observations.mask > 0
    r, C = residual[places], observations.cov[places]
    values, axes = np.linalg.eigh(C)
    along = (np.swapaxes(axes, -1, -2) @ r[..., None])[..., 0] ** 2

    # A sum of hyperbolas is convex: Newton's steps from below the root never pass it.
    tau2 = max(0.0, float(along.sum() / freedom - values.max()))
    for _ in range(_MAX_STEPS):
        terms = along / (values + tau2)
        step = (terms.sum() - freedom) / (terms / (values + tau2)).sum()
        if not step > _RELATIVE_TOLERANCE * tau2:
            break
        tau2 += float(step)
    return tau2

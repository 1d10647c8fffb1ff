"""Whitening: weights from the corners' covariances and the model's own errors.

A corner's residual has the covariance C_i + tau^2 I: C_i is the uncertainty of its location, and
tau^2 the variance of the errors of board and lens model, alike for all corners. Weighting by C_i
alone would trust the sharpest corners far beyond the accuracy of the model, so tau is estimated:
the value at which

    sum_i r_i^T (C_i + tau^2 I)^-1 r_i = 2N - unknowns,

falling steadily in tau^2, or 0 if the covariances explain the residuals by themselves. Weights
are scaled to the median corner, so that costs stay in px^2.

With C + tau^2 I = [[a, b], [b, c]] the weights' root, of which L L^T is the inverse, is

    L^T = [[sqrt(c / (a c - b^2)), -b / sqrt(c (a c - b^2))], [0, 1 / sqrt(c)]].

C's eigenvalues are m + d and m - d with m = (a + c) / 2 and d^2 = ((a - c) / 2)^2 + b^2, and the
squares of r = (x, y) along their axes (|r|^2 +- ((a - c) (x^2 - y^2) / 2 + 2 b x y) / d) / 2.
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
    a, b, c = _take_entries(observations.cov + tau2 * np.eye(2))
    typical = float(np.median((a + c)[observations.mask > 0])) / 2
    weight = np.sqrt(typical) * observations.mask
    root = np.sqrt(c / (a * c - b * b))
    whitening = np.zeros_like(observations.cov)
    whitening[..., 0, 0] = weight * root
    whitening[..., 0, 1] = -weight * root * b / c
    whitening[..., 1, 1] = weight / np.sqrt(c)
    return replace(observations, whitening=whitening, tau2=tau2)


def estimate_model_variance(observations: Observations, residual: Array, unknowns: float) -> float:
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
    values, along = _resolve_along_axes(observations.cov[places], residual[places])

    # A sum of hyperbolas is convex: Newton's steps from below the root never pass it.
    tau2 = max(0.0, float(along.sum() / freedom - values.max()))
    for _ in range(_MAX_STEPS):
        terms = along / (values + tau2)
        step = (terms.sum() - freedom) / (terms / (values + tau2)).sum()
        if not step > _RELATIVE_TOLERANCE * tau2:
            break
        tau2 += float(step)
    return tau2


def _resolve_along_axes(C: Array, r: Array) -> tuple[Array, Array]:
    """Return eigenvalues (2, n) of C (n, 2, 2) and squares (2, n) of r (n, 2) along their axes."""
    a, b, c = _take_entries(C)
    x, y = r.T
    half = (a - c) / 2
    d, square = np.hypot(half, b), x * x + y * y
    larger = (a + c) / 2 + d
    # As a quotient the smaller eigenvalue keeps its digits; where both are equal, any axes will do.
    smaller = (a * c - b * b) / larger
    apart = (half * (x * x - y * y) + 2 * b * x * y) / np.where(d > 0, d, 1.0)
    return np.stack([larger, smaller]), np.stack([square + apart, square - apart]) / 2


def _take_entries(C: Array) -> tuple[Array, Array, Array]:
    """Return the entries a, b and c of symmetric matrices (..., 2, 2), [[a, b], [b, c]]."""
    return C[..., 0, 0], C[..., 1, 0], C[..., 1, 1]

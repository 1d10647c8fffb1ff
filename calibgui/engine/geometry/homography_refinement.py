"""Homographies of least squared distances, from the linear ones.

The DLT (``homography.py``) minimises an error of its equations. For noise that is alike in all
image points the most likely homography makes the distances in the image least,

    sum |m_i - h(X_i)|^2,      h(X) = (h1^T x, h2^T x) / (h3^T x),      x = (X, Y, 1),

over the entries of H but the last, which is 1 (Zhang 2000, appendix A). With w = h3^T x the
derivatives of the first image coordinate u are x / w by h1, 0 by h2, and -u (X, Y) / w by h3, those
of the second likewise. Gauss-Newton steps from the DLT are taken while they decrease the sum.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.homography import (
    apply_homography,
    fit_homography,
    scale_to_unit_last,
)

_MAX_STEPS = 20
"""Number of Gauss-Newton steps, at most; three reach the minimum mostly."""


def fit_closest_homography(source: Array, destination: Array, mask: Array) -> Array:
    """Fit homographies of least squared distances in the destination, one for each set of points.

    Args:
        source: (K, n, 2) points.
        destination: (K, n, 2) points, in units in which they are of the order of 1.
        mask: (K, n) 1 for points that count, 0 for padding.

    Returns:
        (K, 3, 3) with unit last entry, destination ~ H source.
    """
    weight = mask / mask.sum(axis=1, keepdims=True)
    middle = weight[:, None] @ source
    centred = source - middle
    size = np.sqrt(np.sum(weight[..., None] * centred**2, axis=(1, 2)))
    normalise = np.zeros((len(size), 3, 3))
    normalise[:, 0, 0] = normalise[:, 1, 1] = 1 / size
    normalise[:, :2, 2] = -middle[:, 0] / size[:, None]
    normalise[:, 2, 2] = 1.0
    X = centred / size[:, None, None]
    H = _take_steps(fit_homography(X, destination, mask), X, destination, mask)
    return scale_to_unit_last(H @ normalise)


def _take_steps(H: Array, X: Array, m: Array, mask: Array) -> Array:
    """Refine homographies (K, 3, 3) of unit last entry while distances decrease.

    Args:
        H: where to start.
        X: (K, n, 2) source points around their middle.
        m: (K, n, 2) destination points.
        mask: (K, n) 1 for points that count, 0 for padding.
    """
    miss = mask[..., None] * (m - apply_homography(H, X))
    for _ in range(_MAX_STEPS):
        J = (mask[..., None, None] * _differentiate_images(H, X)).reshape(len(H), -1, 8)
        right = np.swapaxes(J, 1, 2) @ miss.reshape(len(H), -1, 1)
        step = np.linalg.solve(np.swapaxes(J, 1, 2) @ J, right)[..., 0]
        trial = H + np.pad(step, [(0, 0), (0, 1)]).reshape(-1, 3, 3)
        at_trial = mask[..., None] * (m - apply_homography(trial, X))
        better = np.sum(at_trial**2, axis=(1, 2)) < np.sum(miss**2, axis=(1, 2))
        if not better.any():
            break
        H = np.where(better[:, None, None], trial, H)
        miss = np.where(better[:, None, None], at_trial, miss)
    return H


def _differentiate_images(H: Array, X: Array) -> Array:
    """Return (K, n, 2, 8) the derivatives of the images by the entries of H but the last."""
    x = np.concatenate([X, np.ones_like(X[..., :1])], axis=-1)
    by_row = x / (x @ H[:, 2, :, None])
    J = np.zeros((*X.shape, 8))
    J[..., 0, :3] = J[..., 1, 3:6] = by_row
    J[..., 6:] = -apply_homography(H, X)[..., None] * by_row[..., None, :2]
    return J

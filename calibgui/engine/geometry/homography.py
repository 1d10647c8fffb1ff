"""2-D homographies between the corrected image and the reference plane (paper 3.4).

Forward, image to reference (eq. 13), and backward, reference to image (eq. 17):

        [a11 a12 b1]               [alpha11 alpha12 beta1]
    H = [a21 a22 b2]    and  H^ =  [alpha21 alpha22 beta2]  = H^-1 up to scale (eq. 22),
        [c1  c2  1 ]               [gamma1  gamma2  1    ]

both with unit last entry. A pair (x, y) -> (x', y') gives two equations linear in the nine
entries (eq. 40 multiplied out); what solves them best in the least-squares sense, for a third
row of unit length, is the direct linear transformation (DLT). Coordinates are first moved to
zero mean and unit spread, without which the equations are badly conditioned.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array


def apply(H: Array, points: Array) -> Array:
    """Map points (..., n, 2) by homographies (..., 3, 3)."""
    mapped = points @ np.swapaxes(H[..., :2], -1, -2) + H[..., None, :, 2]
    return mapped[..., :2] / mapped[..., 2:]


def unit_last(H: Array) -> Array:
    """(..., 3, 3) scaled to a unit last entry."""
    return H / H[..., 2:, 2:]


def inverted(H: Array) -> Array:
    """The homography in the other direction (eq. 22), unit last entry."""
    return unit_last(np.asarray(np.linalg.inv(H), dtype=np.float64))


def fit_homography(source: Array, destination: Array, mask: Array) -> Array:
    """Least-squares homographies by DLT, one per leading index.

    Args:
        source: (..., n, 2) points.
        destination: (..., n, 2) points.
        mask: (..., n) 1 for points that count, 0 for padding.

    Returns:
        (..., 3, 3) with unit last entry, destination ~ H source.
    """
    shape, n = source.shape[:-2], source.shape[-2]
    given = source.reshape(-1, n, 2), destination.reshape(-1, n, 2), mask.reshape(-1, n)
    # A single one is asked for by programs that do not calibrate and need not wait to compile.
    many = kernels.COMPILED and len(given[0]) > 1
    sums, to_source, to_destination = (_compiled if many else moments)(*given)
    S, Su, Sv, Sq = np.moveaxis(sums[..., _SYMMETRIC], 1, 0)
    # For a given third row h3 the others are S^-1 Su h3 and S^-1 Sv h3: h3 is an eigenvector.
    inverse = np.linalg.inv(S + 1e-15 * S[:, 2:, 2:] * np.eye(3))
    first, second = inverse @ Su, inverse @ Sv
    h3 = np.linalg.eigh(Sq - Su @ first - Sv @ second)[1][..., :1]
    H = np.concatenate([first @ h3, second @ h3, h3], axis=-1).swapaxes(-1, -2)
    return unit_last(np.linalg.inv(to_destination) @ H @ to_source).reshape(*shape, 3, 3)


_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
"""Places of a symmetric matrix's entries among its upper triangle's."""


def moments(source: Array, destination: Array, mask: Array) -> tuple[Array, Array, Array]:
    """The sums that the DLT needs, of points (K, n, 2) brought to zero mean and RMS sqrt(2).

    With s = (x, y, 1) its rows are (s, 0, -u s) and (0, s, -v s), so that their products are
    the sums of s s^T by 1, u, v and u^2 + v^2.

    Returns:
        (K, 4, 6) these sums, upper triangles of s s^T, and what normalises source and
        destination (K, 3, 3).
    """
    (x, y), to_source = _normalised(source, mask)
    (u, v), to_destination = _normalised(destination, mask)
    squares = mask * mask
    by = np.stack([squares, squares * u, squares * v, squares * (u * u + v * v)], axis=1)
    of = np.stack([x * x, x * y, x, y * y, y, np.ones_like(x)], axis=1)
    return by @ np.swapaxes(of, 1, 2), to_source, to_destination


def _compiled(source: Array, destination: Array, mask: Array) -> tuple[Array, Array, Array]:
    from calibgui.engine.kernels import homography  # takes a while: only when used

    return homography.moments(source, destination, mask)


def _normalised(points: Array, mask: Array) -> tuple[Array, Array]:
    """Points (2, K, n) of zero mean and RMS length sqrt(2), and the similarity to them."""
    count = mask.sum(axis=1)
    mean = (mask[:, None] @ points)[:, 0] / count[:, None]
    centred = points - mean[:, None]
    square = np.sum((mask * mask)[:, None] @ centred**2, axis=(1, 2))
    scale = np.sqrt(2 * count / np.maximum(square, 1e-300))
    T = np.zeros((len(points), 3, 3))
    T[:, 0, 0] = T[:, 1, 1] = scale
    T[:, :2, 2] = -scale[:, None] * mean
    T[:, 2, 2] = 1.0
    return scale[:, None] * np.moveaxis(centred, -1, 0), T

"""2-D homographies between the corrected image and the reference plane (paper 3.4).

Forward, image to reference (eq. 13), and backward, reference to image (eq. 17):

        [a11 a12 b1]               [alpha11 alpha12 beta1]
    H = [a21 a22 b2]    and  H^ =  [alpha21 alpha22 beta2]  = H^-1 up to scale (eq. 22),
        [c1  c2  1 ]               [gamma1  gamma2  1    ]

both with unit last entry. A pair (x, y) -> (x', y') gives two equations linear in the nine
entries (eq. 40 multiplied out); their least-squares null vector is the direct linear
transformation (DLT). Coordinates are first moved to zero mean and unit spread, without
which the equations are badly conditioned.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.types import Array


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


def dlt(source: Array, destination: Array, mask: Array) -> Array:
    """Least-squares homographies by DLT, one per leading index.

    Args:
        source: (..., n, 2) points.
        destination: (..., n, 2) points.
        mask: (..., n) 1 for points that count, 0 for padding.

    Returns:
        (..., 3, 3) with unit last entry, destination ~ H source.
    """
    (x, y), to_source = _normalised(source, mask)
    (u, v), to_destination = _normalised(destination, mask)
    squares = mask * mask
    one = np.ones_like(x)
    # With s = (x, y, 1) the rows are (s, 0, -u s) and (0, s, -v s), and their products are the
    # sums of s s^T by 1, u, v and u^2 + v^2.
    by = np.stack([squares, squares * u, squares * v, squares * (u * u + v * v)], axis=-2)
    of = np.stack([x * x, x * y, x, y * y, y, one], axis=-1)
    S, Su, Sv, Sq = np.moveaxis((by @ of)[..., _SYMMETRIC], -3, 0)
    zero = np.zeros_like(S)
    products = np.concatenate(
        [
            np.concatenate([S, zero, -Su], axis=-1),
            np.concatenate([zero, S, -Sv], axis=-1),
            np.concatenate([-Su, -Sv, Sq], axis=-1),
        ],
        axis=-2,
    )
    vectors = np.linalg.eigh(products)[1]
    H = vectors[..., 0].reshape(*vectors.shape[:-2], 3, 3)
    return unit_last(np.linalg.inv(to_destination) @ H @ to_source)


_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
"""Places of a symmetric matrix's entries among its upper triangle's."""


def _normalised(points: Array, mask: Array) -> tuple[Array, Array]:
    """Points (2, ..., n) of zero mean and RMS length sqrt(2), and the similarity to them."""
    count = mask.sum(axis=-1)
    mean = (mask[..., None, :] @ points)[..., 0, :] / count[..., None]
    centred = points - mean[..., None, :]
    square = np.sum((mask * mask)[..., None, :] @ centred**2, axis=(-1, -2))
    scale = np.sqrt(2 * count / np.maximum(square, 1e-300))
    T = np.zeros((*points.shape[:-2], 3, 3))
    T[..., 0, 0] = T[..., 1, 1] = scale
    T[..., :2, 2] = -scale[..., None] * mean
    T[..., 2, 2] = 1.0
    return scale[..., None] * np.moveaxis(centred, -1, 0), T

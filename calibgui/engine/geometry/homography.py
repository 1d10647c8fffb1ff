"""Homographies of the plane: fitting, inversion and use (paper 3.4).

A plane seen by a pinhole camera is mapped to its image by a homography, and so is the corrected
image to the paper's reference plane. Forward, image to reference (eq. 13), and backward,
reference to image (eq. 17), they are

        [a11 a12 b1]               [alpha11 alpha12 beta1]
    H = [a21 a22 b2]    and  H^ =  [alpha21 alpha22 beta2]  = H^-1 up to scale (eq. 22),
        [c1  c2  1 ]               [gamma1  gamma2  1    ]

both with unit last entry. A pair (x, y) -> (x', y') gives two equations linear in the nine
entries (eq. 40 multiplied out). Their least-squares solution, with a third row of unit length,
is the direct linear transformation (DLT). Coordinates are first moved to zero mean and unit
spread, without which the equations are badly conditioned (Hartley 1997).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels import with_kernel


def apply_homography(H: Array, points: Array) -> Array:
    """Map points (..., n, 2) by homographies (..., 3, 3)."""
    mapped = points @ np.swapaxes(H[..., :2], -1, -2) + H[..., None, :, 2]
    return mapped[..., :2] / mapped[..., 2:]


def scale_to_unit_last(H: Array) -> Array:
    """Scale (..., 3, 3) to a unit last entry."""
    return H / H[..., 2:, 2:]


def invert_homography(H: Array) -> Array:
    """Return the homography in the other direction (eq. 22), with unit last entry."""
    return scale_to_unit_last(np.asarray(np.linalg.inv(H), dtype=np.float64))


def fit_homography(source: Array, destination: Array, mask: Array) -> Array:
    """Fit homographies by the normalised DLT (Hartley 1997), one per leading index.

    Args:
        source: (..., n, 2) points.
        destination: (..., n, 2) points.
        mask: (..., n) 1 for points that count, 0 for padding.

    Returns:
        (..., 3, 3) with unit last entry, destination ~ H source.
    """
    shape, n = source.shape[:-2], source.shape[-2]
    return fit_homographies(
        source.reshape(-1, n, 2), destination.reshape(-1, n, 2), mask.reshape(-1, n)
    ).reshape(*shape, 3, 3)


def _has_many_sets(source: Array, *_: Array) -> bool:
    """Return whether there is more than one set of points.

    Programs that do not calibrate fit single ones, and need not wait for a kernel to compile.
    """
    return len(source) > 1


@with_kernel("homography", "fit_homographies", _has_many_sets)
def fit_homographies(source: Array, destination: Array, mask: Array) -> Array:
    """Fit K homographies (K, 3, 3), as `fit_homography`.

    With s = (x, y, 1) the equations' rows are (s, 0, -u s) and (0, s, -v s), so that their products
    are the sums S, Su, Sv and Sq of s s^T by 1, u, v and u^2 + v^2.

    Args:
        source: (K, n, 2) points (x, y).
        destination: (K, n, 2) points (u, v).
        mask: (K, n) weights of the points.
    """
    (x, y), to_source = _normalise(source, mask)
    (u, v), to_destination = _normalise(destination, mask)
    squares = mask * mask
    by = np.stack([squares, squares * u, squares * v, squares * (u * u + v * v)], axis=1)
    of = np.stack([x * x, x * y, x, y * y, y, np.ones_like(x)], axis=1)
    S, Su, Sv, Sq = np.moveaxis((by @ np.swapaxes(of, 1, 2))[..., _SYMMETRIC], 1, 0)
    # For a given third row h3 the others are S^-1 Su h3 and S^-1 Sv h3: h3 is an eigenvector.
    inverse = np.linalg.inv(S + 1e-15 * S[:, 2:, 2:] * np.eye(3))
    first, second = inverse @ Su, inverse @ Sv
    h3 = np.linalg.eigh(Sq - Su @ first - Sv @ second)[1][..., :1]
    H = np.concatenate([first @ h3, second @ h3, h3], axis=-1).swapaxes(-1, -2)
    return scale_to_unit_last(np.linalg.inv(to_destination) @ H @ to_source)


_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
"""Places of a symmetric matrix's entries in its upper triangle."""


def _normalise(points: Array, mask: Array) -> tuple[Array, Array]:
    """Return points (2, K, n) of zero mean and RMS length sqrt(2), and the similarity to them."""
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

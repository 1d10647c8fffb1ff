"""Rotations: matrices, rotation vectors and the paper's three angles.

A rotation vector points along the axis, and its length is the angle in radians. It is how poses
are stored. The solver varies a rotation by a small local one, R <- exp(w) R, which has no
singularity anywhere; `compute_inverse_left_jacobian` carries its uncertainty over to the vector.
The paper's angles omega, phi, theta (eq. 7) are for display alone, in its left-handed frame
(``frames.py``).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array


def rotation_from_vector(rvec: Array) -> Array:
    """Return the rotations exp(rvec) (..., 3, 3) of vectors (..., 3), by Rodrigues' formula."""
    half = np.linalg.norm(rvec, axis=-1)[..., None, None] / 2
    W = make_cross_matrix(rvec)
    # np.sinc is sin(pi x) / (pi x), finite at 0, and sin x = 2 sin(x / 2) cos(x / 2).
    sinc = np.sinc(half / np.pi)
    return np.eye(3) + sinc * np.cos(half) * W + 0.5 * sinc**2 * (W @ W)


def vector_from_rotation(R: Array) -> Array:
    """Return the rotation vectors (..., 3) of matrices (..., 3, 3), of length at most pi."""
    turned = np.swapaxes(R, -1, -2)
    skew = (turned - R)[..., [1, 2, 0], [2, 0, 1]]
    sine = np.linalg.norm(skew, axis=-1) / 2
    cosine = (np.trace(R, axis1=-2, axis2=-1) - 1) / 2
    angle = np.arctan2(sine, cosine)[..., None]
    usual = skew / (2 * np.sinc(angle / np.pi))
    is_usual = cosine > -0.9
    if is_usual.all():
        return np.asarray(usual)
    # Near a half turn the skew part vanishes: take the axis from the symmetric part
    # R + R^T = 2 cos I + 2 (1 - cos) n n^T, and its sign from the skew part.
    nn = (R + turned) / 2 - cosine[..., None, None] * np.eye(3)
    longest = np.argmax(np.diagonal(nn, axis1=-2, axis2=-1), axis=-1)[..., None, None]
    axis = np.take_along_axis(nn, longest, axis=-2)[..., 0, :]
    sign = np.where(np.sum(axis * skew, axis=-1, keepdims=True) >= 0, 1.0, -1.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        half_turn = sign * angle * axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    return np.asarray(np.where(is_usual[..., None], usual, half_turn))


def make_cross_matrix(w: Array) -> Array:
    """Return the matrices [w]x (..., 3, 3) with [w]x a = w x a, for w (..., 3)."""
    W = np.zeros((*w.shape, 3))
    W[..., 2, 1], W[..., 0, 2], W[..., 1, 0] = w[..., 0], w[..., 1], w[..., 2]
    return W - np.swapaxes(W, -1, -2)


def compute_inverse_left_jacobian(rvec: Array) -> Array:
    """Return (..., 3, 3) the derivative of log(exp(w) exp(rvec)) with respect to w at w = 0.

    The inverse of the left Jacobian of SO(3); carries the covariance of the solver's local
    rotation over to the rotation vector.
    """
    angle = np.linalg.norm(rvec, axis=-1)[..., None, None]
    W = make_cross_matrix(rvec)
    half = angle / 2
    with np.errstate(invalid="ignore", divide="ignore"):
        c = np.where(angle > 1e-4, (1 - half / np.tan(half)) / angle**2, 1 / 12)
    return np.eye(3) - 0.5 * W + c * (W @ W)


def rotation_from_paper_angles(
    omega: npt.ArrayLike, phi: npt.ArrayLike, theta: npt.ArrayLike
) -> Array:
    """Return R = R(omega) R(phi) R(theta) (..., 3, 3) of eq. 7-8, in the left-handed frame."""
    angles = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (omega, phi, theta)))
    (so, sp, st), (co, cp, ct) = np.sin(angles), np.cos(angles)
    rows = [
        [ct * cp, st * cp, -sp],
        [-st * co + ct * sp * so, ct * co + st * sp * so, cp * so],
        [st * so + ct * sp * co, -ct * so + st * sp * co, cp * co],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def paper_angles_from_rotation(R: Array) -> tuple[float, float, float]:
    """Return omega, phi, theta of eq. 7 with phi in [-pi/2, pi/2], rad."""
    omega = np.arctan2(R[1, 2], R[2, 2])
    phi = np.arctan2(-R[0, 2], np.hypot(R[1, 2], R[2, 2]))
    theta = np.arctan2(R[0, 1], R[0, 0])
    return float(omega), float(phi), float(theta)

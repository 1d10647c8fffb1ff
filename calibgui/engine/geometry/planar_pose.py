"""The pose of a plane from its homography or its rays, and the second pose that looks alike.

Under known focal lengths the homography M from a plane (mm) to the image, measured from the
principal point, is diag(fx, fy, 1) [r1 r2 T] up to scale. Dividing by the focal lengths gives two
columns of the rotation and the translation in closed form (Zhang 2000, section 3.1); the
rotation closest to them is the answer. It minimises no error in the image and is a start only.

Under a known lens every corner X = (X, Y, 1) of the plane has a ray b, and b ~ G X with
G = [r1 r2 T]: b x G X = 0 is linear in G, and as valid for rays at 90 degrees and beyond as for any
other. The sum over the corners of the squares is g^T A g, A = sum (I - b b^T) (x) X X^T; G is the
eigenvector of its least eigenvalue. As in Hartley's normalisation (1997) the rays are first turned
so that their mean is the axis and stretched across it to a unit spread, and the plane's points are
moved and scaled likewise.

From far away a plane looks alike from two sides: only perspective tells a tilt from its mirror
image (Schweighofer and Pinz 2006). With v the direction to the middle of the points, the plane

    R' = (I - 2 v v^T) R diag(1, 1, -1),     the middle of the points where it was,

has the depths of its points along v reversed and everything across v unchanged. Each of the two
can be a minimum of the reprojection error.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.directions import make_tangent_basis

_MIN_RAYS = 4
"""Number of rays below which a plane has no pose in closed form."""
_MIN_SPREAD = 1e-9
"""Least root mean squared angle between rays, rad, that rounding errors leave of a plane."""


def poses_from_homographies(M: Array, f: Array, points: Array) -> tuple[Array, Array]:
    """Return rotations (K, 3, 3) and translations (K, 3) mm under known focal lengths.

    Args:
        M: (K, 3, 3) homographies from the plane, mm, to the undistorted image, px from the
            principal point.
        f: (2,) focal lengths, px.
        points: (K, 2) a point of each plane that lies in front of the camera, mm.
    """
    G = M / np.array([f[0], f[1], 1.0])[:, None]
    first = np.concatenate([points, np.ones((len(M), 1))], axis=1)
    depth = np.einsum("ki,ki->k", G[:, 2], first)
    return _find_closest_poses(G * np.sign(depth)[:, None, None])


def poses_from_rays(rays: Array, points: Array, mask: Array) -> tuple[Array, Array]:
    """Return rotations (K, 3, 3) and translations (K, 3) mm of planes from the rays of points.

    Args:
        rays: (K, N, 3) of length 1; NaN for points without one, which do not count.
        points: (K, N, 2) the same points on the planes, mm.
        mask: (K, N) 1 for points that count, 0 for padding.

    Returns:
        NaN for a plane with fewer than four rays, which has no pose.
    """
    weight = np.where(np.isfinite(rays).all(axis=-1), mask, 0.0)[..., None]
    seen = weight.sum(axis=1)[:, 0] >= _MIN_RAYS
    R, T = np.full((len(rays), 3, 3), np.nan), np.full((len(rays), 3), np.nan)
    if seen.any():
        R[seen], T[seen] = _solve_poses(rays[seen], points[seen], weight[seen])
    return R, T


def _solve_poses(rays: Array, points: Array, weight: Array) -> tuple[Array, Array]:
    """Return the poses of planes with enough rays; `weight` is (K, N, 1), 0 or 1."""
    weight = weight / weight.sum(axis=1, keepdims=True)
    b = np.where(weight > 0, rays, 0.0)
    mean = np.sum(weight * b, axis=1)
    mean /= np.linalg.norm(mean, axis=1, keepdims=True)
    turn = np.concatenate([make_tangent_basis(mean), mean[..., None]], axis=2)
    b = b @ turn
    spread = np.sqrt(np.sum(weight * (1 - b[..., 2:] ** 2), axis=1, keepdims=True) / 2)
    spread = np.maximum(spread, _MIN_SPREAD)
    stretch = np.concatenate([1 / spread, 1 / spread, np.ones_like(spread)], axis=2)
    b = b * stretch
    b /= np.maximum(np.linalg.norm(b, axis=2, keepdims=True), np.finfo(float).tiny)
    middle = np.sum(weight * points, axis=1, keepdims=True)
    scale = np.sqrt(np.sum(weight * (points - middle) ** 2, axis=(1, 2), keepdims=True) / 2)
    X = np.concatenate([(points - middle) / scale, np.ones_like(weight)], axis=2)
    across = np.eye(3) - b[..., None] * b[..., None, :]
    A = np.einsum("knij,knp,knq->kipjq", weight[..., None] * across, X, X, optimize=True)
    G = np.linalg.eigh(A.reshape(-1, 9, 9))[1][:, :, 0].reshape(-1, 3, 3)
    ahead = np.einsum("kni,kij,knj->k", weight * b, G, X, optimize=True)
    G = G * np.sign(ahead)[:, None, None]
    G = turn @ (G / np.swapaxes(stretch, 1, 2))
    G[:, :, :2] /= scale
    G[:, :, 2] -= (G[:, :, :2] @ np.swapaxes(middle, 1, 2))[..., 0]
    return _find_closest_poses(G)


def _find_closest_poses(G: Array) -> tuple[Array, Array]:
    """Return the rotations and translations closest to G (K, 3, 3) ~ [r1 r2 T], scale open.

    With A = [r1 r2], the closest two columns are A M^-1/2, M = A^T A, and the third is their normal
    n. The root of a 2 x 2 matrix is (M + s) / sqrt(tr M + 2 s), where s^2 = det M = |n|^2.

    Raises:
        LinAlgError: if there is none, as where r1 and r2 are parallel or not finite.
    """
    lengths = np.linalg.norm(G[:, :, :2], axis=1)
    G = G / np.sqrt(lengths[:, 0] * lengths[:, 1])[:, None, None]
    A = G[:, :, :2]
    (a, b, c), (d, e, f) = A.transpose(2, 1, 0)
    normal = np.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=1)
    s = np.sqrt(np.sum(normal**2, axis=1))
    M = A.swapaxes(1, 2) @ A
    adjugate = -M
    adjugate[:, 0, 0], adjugate[:, 1, 1] = M[:, 1, 1] + s, M[:, 0, 0] + s
    root = s * np.sqrt(M[:, 0, 0] + M[:, 1, 1] + 2 * s)
    with np.errstate(invalid="ignore", divide="ignore"):
        columns, third = A @ adjugate / root[:, None, None], normal / s[:, None]
    R = np.concatenate([columns, third[..., None]], axis=2)
    if not np.isfinite(R).all():
        raise np.linalg.LinAlgError("A plane is seen edge-on or not at all")
    return R, G[:, :, 2]


def mirror_planar_poses(R: Array, T: Array, middle: Array) -> tuple[Array, Array]:
    """Return the poses with the planes' depths reversed along the rays to their middles.

    Args:
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        middle: (K, 2 or 3) the middle of each plane's points, mm.
    """
    column = middle[..., None]
    axes = column.shape[1]
    centre = R[..., :axes] @ column + T[..., None]
    v = centre / np.linalg.norm(centre, axis=1, keepdims=True)
    mirrored = (R - 2 * v @ (v.swapaxes(1, 2) @ R)) * np.array([1.0, 1.0, -1.0])
    return mirrored, (centre - mirrored[..., :axes] @ column)[..., 0]

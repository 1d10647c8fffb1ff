"""Derivatives of a lens's map from those of its inverse, by the implicit function.

Rays of length 1 change across themselves only. At such a ray b the derivative of the image point
d(ray) has two rows a1, a2, and the derivative of the ray b(d) two columns c1, c2; all four are at
right angles to b, and the maps are inverse to each other if ai . cj = 1 for i = j, otherwise 0.
Either pair is therefore the other's reciprocal basis,

    c1 = a2 x b / det,    c2 = b x a1 / det,    det = b . (a1 x a2),

and the same with a and c exchanged. From d(b(d, k), k) = d follows db/dk = -[c1 c2] dd/dk.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import LensProjection, LensUnprojection


def invert_projection(rays: Array, imaged: LensProjection) -> LensUnprojection:
    """Return rays (..., 3) of length 1 with the derivatives of the unprojection.

    Args:
        rays: the rays that the unprojection found.
        imaged: their image points, with derivatives; where these are NaN, so is the result.
    """
    by_point = np.swapaxes(_make_reciprocal_basis(rays, imaged.by_ray), -1, -2)
    known = np.isfinite(imaged.points).all(axis=-1, keepdims=True)
    return LensUnprojection(
        np.where(known, rays, np.nan),
        by_point,
        -by_point @ imaged.by_coefficients,
    )


def invert_unprojection(points: Array, length: Array, seen: LensUnprojection) -> LensProjection:
    """Return image points (..., 2) with the derivatives of the projection.

    Args:
        points: the image points that the projection found.
        length: (...) lengths of the rays that were projected.
        seen: the rays of the image points, with derivatives; where these are NaN, so is the result.
    """
    across = _make_reciprocal_basis(seen.rays, np.swapaxes(seen.by_point, -1, -2))
    known = np.isfinite(seen.rays).all(axis=-1, keepdims=True)
    return LensProjection(
        np.where(known, points, np.nan),
        across / length[..., None, None],
        -across @ seen.by_coefficients,
    )


def normalise_rays(direction: Array, by_point: Array, by_coefficients: Array) -> LensUnprojection:
    """Return a direction (..., 3) of any length and its derivatives as those of a ray of length 1.

    The derivative of v / |v| is (I - b b^T) dv / |v|, b = v / |v|.
    """
    length = np.sqrt(np.sum(direction * direction, axis=-1))[..., None]
    rays = direction / length

    def turn(change: Array) -> Array:
        along = np.sum(rays[..., None] * change, axis=-2, keepdims=True)
        return (change - rays[..., None] * along) / length[..., None]

    return LensUnprojection(rays, turn(by_point), turn(by_coefficients))


def _make_reciprocal_basis(b: Array, pair: Array) -> Array:
    """Return (..., 2, 3) the reciprocal basis of two vectors (..., 2, 3) across rays b (..., 3)."""
    x, y, z = b[..., 0], b[..., 1], b[..., 2]
    p0, p1, p2 = pair[..., 0, 0], pair[..., 0, 1], pair[..., 0, 2]
    q0, q1, q2 = pair[..., 1, 0], pair[..., 1, 1], pair[..., 1, 2]
    basis = np.empty_like(pair)
    basis[..., 0, 0], basis[..., 0, 1] = q1 * z - q2 * y, q2 * x - q0 * z
    basis[..., 0, 2] = q0 * y - q1 * x
    basis[..., 1, 0], basis[..., 1, 1] = y * p2 - z * p1, z * p0 - x * p2
    basis[..., 1, 2] = x * p1 - y * p0
    det = p0 * basis[..., 0, 0] + p1 * basis[..., 0, 1] + p2 * basis[..., 0, 2]
    with np.errstate(divide="ignore", invalid="ignore"):  # a map that folds has no inverse
        return basis / det[..., None, None]

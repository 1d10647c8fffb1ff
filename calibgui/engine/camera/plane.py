"""Lens models on the plane z = 1: rays through (X/Z, Y/Z), and the chain rule between the two.

With n = (X/Z, Y/Z) and a ray r of any length in front of the camera,

    dn/dr = [1 0 -n1; 0 1 -n2] / Z,

and with the ray b = (n, 1) / |(n, 1)| of an ideal point n

    db/dn = (I - b b^T)[:, :2] / |(n, 1)|.

Rays with Z <= 0 have no point of the plane: these models serve lenses of less than 180 degrees.

Some of them have a skew (Bouguet's alpha_c), u = cx + fx (x + skew y), as if columns of pixels were
not at right angles to rows. With S = [1 skew; 0 1] and (x, y) the measured point without it,

    d = S (x, y),      dd/dn = S d(x, y)/dn,      dd/dskew = (y, 0),
    (x, y) = S^-1 d,   dn/dd = dn/d(x, y) S^-1,   dn/dskew = -dn/dx d2.

It is held at 0 unless freed, since sensors have none.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection


class PlanePoints(NamedTuple):
    """Points of the plane after a map, with its derivatives."""

    points: Array
    """(..., 2)."""
    by_point: Array
    """(..., 2, 2) derivative with respect to the argument."""
    by_coefficients: Array
    """(..., 2, C) derivative with respect to k."""


class PlaneLens(Lens):
    """A lens model of two maps between measured points d and ideal points n = (X/Z, Y/Z)."""

    closed_form_factor: float | None = None
    """Ratio of the model's first coefficient to k1 of n = d (1 + k1 |d|^2), which does the same to
    first order, if the closed form of Stage I starts the model so, and the others at their
    defaults; 0 without coefficients, None if another start is needed."""

    @abstractmethod
    def correct(self, d: Array, k: Array) -> PlanePoints:
        """Map measured to ideal points. NaN where the model has no ideal point."""

    @abstractmethod
    def distort(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal to measured points. NaN where the model has no measured point."""

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points. NaN behind the camera and where the model has no point."""
        n, by_ray = plane_from_rays(rays)
        d, by_n, by_k = _blank_missing(self.distort(n, k))
        return LensProjection(d, by_n @ by_ray, by_k)

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1. NaN where the model has no ideal point."""
        n, by_d, by_k = _blank_missing(self.correct(d, k))
        b, by_n = rays_from_plane(n)
        return LensUnprojection(b, by_n @ by_d, by_n @ by_k)


def plane_from_rays(rays: Array) -> tuple[Array, Array]:
    """Return n (..., 2) of rays (..., 3) and dn/dr (..., 2, 3); NaN behind the camera."""
    Z = np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
    n = rays[..., :2] / Z
    by_ray = np.zeros((*n.shape, 3))
    by_ray[..., 0, 0] = by_ray[..., 1, 1] = 1.0
    by_ray[..., 2] = -n
    return n, by_ray / Z[..., None]


def _blank_missing(mapped: PlanePoints) -> PlanePoints:
    """Return the map with its derivatives NaN wherever its points are."""
    missing = np.asarray(np.isnan(mapped.points).any(axis=-1))
    if not missing.any():
        return mapped
    points, by_point, by_k = mapped
    return PlanePoints(
        np.where(missing[..., None], np.nan, points),
        np.where(missing[..., None, None], np.nan, by_point),
        np.where(missing[..., None, None], np.nan, by_k),
    )


def rays_from_plane(n: Array) -> tuple[Array, Array]:
    """Return the rays (..., 3) of length 1 through points n (..., 2), and db/dn (..., 3, 2)."""
    length = np.sqrt(1 + np.sum(n * n, axis=-1, keepdims=True))
    b = np.concatenate([n, np.ones_like(length)], axis=-1) / length
    by_n = (np.eye(3)[:, :2] - b[..., None] * b[..., None, :2]) / length[..., None]
    return b, by_n

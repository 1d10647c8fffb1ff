"""Scaramuzza's polynomial: the fisheye model of MATLAB and OCamCalib.

An image point d, r = |d|, is seen along (Scaramuzza, Martinelli and Siegwart 2006)

    (d, m),    m = 1 + a2 r^2 + a3 r^3 + a4 r^4.

MATLAB's fisheyeIntrinsics and OCamCalib write m in pixels: their a0 is the focal length f, and
their a2, a3, a4 are these times 1/f, 1/f^2, 1/f^3. Of their stretch matrix fy / fx is c; d and e
are a roll of the camera and have no place here.

A ray (X, Y, Z) with R^2 = X^2 + Y^2 has its point at the radius r where

    Z r - R m(r) = 0,    d = r (X, Y) / R.

The angle atan2(r, m) off the axis grows with r as long as m - r m' = 1 - a2 r^2 - 2 a3 r^3
- 3 a4 r^4 > 0, and up to there the left side is negative below the one zero and positive above it.
Newton's method finds it, and ``camera.tangent`` the derivatives, from those of the ray,

    dm/dd = (2 a2 + 3 a3 r + 4 a4 r^2) d,    dm/d(a2, a3, a4) = (r^2, r^3, r^4).

Limits: beyond the first zero of m - r m' the model folds, and has neither ray nor point.

Scaramuzza, D., Martinelli, A., Siegwart, R. (2006). A flexible technique for accurate
omnidirectional camera calibration and structure from motion. ICVS.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection
from calibgui.engine.camera.root import solve_in_bracket
from calibgui.engine.camera.tangent import invert_unprojection, normalise_rays

_MAX_RADIUS = 1e6
"""Radius, in focal lengths, at which a model that does not fold ends."""
_MARGIN = 1e-7
"""Distance from the fold, as a part of its radius, within which points have no ray: the angle
hardly changes there, and its rounding could take the ray beyond the fold."""


class Scaramuzza(Lens):
    """Scaramuzza's model with the coefficients a2, a3, a4."""

    title = "Scaramuzza (MATLAB fisheye, OCamCalib)"
    names = ("a2", "a3", "a4")
    powers = (2, 3, 4)

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points, by Newton's method."""
        length = np.sqrt(np.sum(rays * rays, axis=-1))
        with np.errstate(invalid="ignore"):
            unit = rays / length[..., None]
        R, Z = np.hypot(unit[..., 0], unit[..., 1]).ravel(), unit[..., 2].ravel()
        r = _find_radii(R, Z, k).reshape(length.shape)
        sine = R.reshape(length.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            stretch = np.where(sine > 0, r / sine, np.where(unit[..., 2] > 0, 1.0, np.nan))
        d = stretch[..., None] * unit[..., :2]
        return invert_unprojection(d, length, _unproject(d, k))

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1."""
        radius = np.hypot(d[..., 0], d[..., 1])
        known = radius < _find_end(k) * (1 - _MARGIN)
        return _unproject(np.where(known[..., None], d, np.nan), k)


def _unproject(d: Array, k: Array) -> LensUnprojection:
    """Return the rays of image points (..., 2), which may lie beyond the fold."""
    a2, a3, a4 = k
    r = np.hypot(d[..., 0], d[..., 1])
    r2 = r * r
    by_d = np.zeros((*d.shape[:-1], 3, 2))
    by_d[..., 0, 0] = by_d[..., 1, 1] = 1.0
    by_d[..., 2, :] = (2 * a2 + r * (3 * a3 + r * 4 * a4))[..., None] * d
    by_k = np.zeros((*d.shape[:-1], 3, 3))
    by_k[..., 2, :] = np.stack([r2, r2 * r, r2 * r2], axis=-1)
    m = 1 + r2 * (a2 + r * (a3 + r * a4))
    return normalise_rays(np.concatenate([d, m[..., None]], axis=-1), by_d, by_k)


def _find_end(k: Array) -> float:
    """Return the radius at which the model folds."""
    a2, a3, a4 = k
    reciprocals = np.roots([1.0, 0.0, -a2, -2 * a3, -3 * a4])  # 1 / r: trailing 0 do no harm
    real = reciprocals[reciprocals.imag == 0].real
    return float(1 / real.max(initial=1 / _MAX_RADIUS))


def _find_radii(R: Array, Z: Array, k: Array) -> Array:
    """Return (n,) the radii at which rays of length 1 are imaged; NaN beyond the fold.

    Args:
        R: (n,) distances of the rays' ends from the axis.
        Z: (n,) their heights.
        k: the coefficients.
    """
    a2, a3, a4 = k

    def curve(r: Array) -> tuple[Array, Array]:
        m = 1 + r * r * (a2 + r * (a3 + r * a4))
        slope = r * (2 * a2 + r * (3 * a3 + r * 4 * a4))
        return Z * r - R * m, Z - R * slope

    end = np.full_like(R, _find_end(k))
    with np.errstate(invalid="ignore"):
        visible = curve(end)[0] > 0
    # The model's beginning is a pinhole's, r = R / Z; far off the axis it is nearer to the angle.
    r = solve_in_bracket(curve, np.arctan2(R, Z), np.zeros_like(R), end)
    return np.where(visible, r, np.nan)

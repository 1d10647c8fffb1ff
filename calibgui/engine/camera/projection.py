"""Projection of rays to pixels and back, with all derivatives.

A lens model knows dimensionless points only; the camera's focal lengths and centre turn these into
pixels. With c = (cx, cy), f = (fx, fy) and a the lengths that make the lens model's argument
dimensionless (a = f, or a = (fx, fx) for a model that measures its radius in pixels),

    unproject   d = (uv - c) / a,   psi = correct(d),   n = psi a / f
    project     psi = n f / a,      d = distort(psi),   uv = c + a d

where n = (X/Z, Y/Z) is the ray. With A = da/df the derivatives by f are

    dn/df  = (dn/da) A - diag(n / f),       dn/da = -(a/f) psi_d diag(d / a) + diag(psi / f)
    duv/df = (duv/da) A + a d_psi diag(n / a),  duv/da = diag(d) - a d_psi diag(psi / a)

whose last terms cancel for a = f.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS


class Projected(NamedTuple):
    """Points mapped by a camera, with derivatives."""

    points: Array
    """(..., 2)."""
    by_point: Array
    """(..., 2, 2)."""
    by_params: Array
    """(..., 2, P) with respect to fx, fy, cx, cy and the lens coefficients."""


def lens_scale(lens: Lens, f: Array) -> tuple[Array, Array]:
    """Return the lengths a (2,), px, and A = da/df (2, 2)."""
    A = np.array([[1.0, 0.0], [1.0, 0.0]]) if lens.radius_in_pixels else np.eye(2)
    return A @ f, A


def unproject(uv: Array, params: Array, lens: Lens) -> Projected:
    """Map measured pixels (..., 2) to rays n (..., 2); NaN where the lens has none.

    Args:
        uv: (..., 2) pixels, array frame.
        params: (P,) as ``Camera.params``.
        lens: the lens model.
    """
    f, c = params[:2], params[2:4]
    a, A = lens_scale(lens, f)
    d = (uv - c) / a
    psi, psi_d, psi_k = lens.correct(d, params[4:])
    ratio = (a / f)[:, None]
    n = psi * (a / f)
    by_d = ratio * psi_d
    by_a = -by_d * (d / a)[..., None, :] + _make_diagonal(psi / f)
    by_params = np.concatenate(
        [by_a @ A - _make_diagonal(n / f), -by_d / a, ratio * psi_k], axis=-1
    )
    return Projected(n, by_d / a, by_params)


def project(n: Array, params: Array, lens: Lens) -> Projected:
    """Map rays n (..., 2) to measured pixels (..., 2); NaN where the lens has none.

    Args:
        n: (..., 2) rays X/Z, Y/Z.
        params: (P,) as ``Camera.params``.
        lens: the lens model.
    """
    f, c = params[:2], params[2:4]
    a, A = lens_scale(lens, f)
    psi = n * (f / a)
    d, d_psi, d_k = lens.distort(psi, params[4:])
    stretched = a[:, None] * d_psi
    by_a = _make_diagonal(d) - stretched * (psi / a)[..., None, :]
    by_f = by_a @ A + stretched * (n / a)[..., None, :]
    unit = np.broadcast_to(np.eye(2), by_a.shape)
    by_params = np.concatenate([by_f, unit, a[:, None] * d_k], axis=-1)
    return Projected(c + a * d, stretched * (f / a), by_params)


def rays_from_pixels(uv: Array, camera: Camera) -> Array:
    """Return rays X/Z, Y/Z (..., 2) of measured pixels (..., 2); NaN where the lens has none."""
    return unproject(uv, camera.params, MODELS[camera.model]).points


def rays_and_slopes(uv: Array, camera: Camera) -> tuple[Array, Array]:
    """Return rays (..., 2) of measured pixels (..., 2), and their derivatives (..., 2, 2) by these.

    It is `unproject` without the derivatives by the camera's parameters.
    """
    lens = MODELS[camera.model]
    a, _ = lens_scale(lens, camera.focal)
    psi, psi_d, _ = lens.correct((uv - camera.centre) / a, camera.coefficients)
    ratio = a / camera.focal
    return psi * ratio, psi_d * (ratio[:, None] / a)


def pixels_from_rays(n: Array, camera: Camera) -> Array:
    """Return measured pixels (..., 2) of rays (..., 2); NaN where the lens has none."""
    return project(n, camera.params, MODELS[camera.model]).points


def _make_diagonal(v: Array) -> Array:
    """Return the diagonal matrices (..., 2, 2) of (..., 2)."""
    return v[..., None] * np.eye(2)

"""Projection of rays to pixels and back, with all derivatives.

A lens model knows dimensionless image points only; the camera's focal lengths and centre turn
these into pixels. With c = (cx, cy), f = (fx, fy), r a ray and d its image point,

    project     d = lens.project(r),        uv = c + f d
    unproject   d = (uv - c) / f,           b = lens.unproject(d),  |b| = 1.

A model that measures its radius in pixels (the paper's, as printed) has other units along Y: with
a = (fx, fx), A = da/df and S = diag(f / a, 1), it images S r at d and uv = c + a d. S is the
identity for all others. By the chain rule

    duv/df = diag(d) A + a dd/ds dS/df r,
    db'/df = db'/dd (-d / a) A + dS^-1/df b,        b' = S^-1 b before its length is made 1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import find_model


class Projected(NamedTuple):
    """Pixels of rays, with derivatives."""

    points: Array
    """(..., 2) px."""
    by_ray: Array
    """(..., 2, 3)."""
    by_params: Array
    """(..., 2, P) with respect to fx, fy, cx, cy and the lens coefficients."""


class Unprojected(NamedTuple):
    """Rays of pixels, with derivatives."""

    rays: Array
    """(..., 3) of length 1."""
    by_point: Array
    """(..., 3, 2)."""
    by_params: Array
    """(..., 3, P) with respect to fx, fy, cx, cy and the lens coefficients."""


def project(rays: Array, params: Array, lens: Lens) -> Projected:
    """Map rays (..., 3) of any length to measured pixels; NaN where the lens has none.

    Args:
        rays: (..., 3) directions in the camera frame.
        params: (P,) as ``Camera.params``.
        lens: the lens model.
    """
    f, c = params[:2], params[2:4]
    unit = np.broadcast_to(np.eye(2), (*rays.shape[:-1], 2, 2))
    if not lens.radius_in_pixels:
        d, by_ray, by_k = lens.project(rays, params[4:])
        by_params = np.concatenate([_make_diagonal(d), unit, f[:, None] * by_k], axis=-1)
        return Projected(c + f * d, f[:, None] * by_ray, by_params)
    fx, aspect = f[0], f[1] / f[0]
    stretch = np.array([1.0, aspect, 1.0])
    d, by_ray, by_k = lens.project(rays * stretch, params[4:])
    by_aspect = by_ray[..., 1] * rays[..., 1:2]  # of d; the aspect changes by -aspect/fx and 1/fx
    by_f = np.stack([d - aspect * by_aspect, by_aspect], axis=-1)
    by_params = np.concatenate([by_f, unit, fx * by_k], axis=-1)
    return Projected(c + fx * d, fx * by_ray * stretch, by_params)


def unproject(uv: Array, params: Array, lens: Lens) -> Unprojected:
    """Map measured pixels (..., 2) to rays (..., 3) of length 1; NaN where the lens has none.

    Args:
        uv: (..., 2) pixels, array frame.
        params: (P,) as ``Camera.params``.
        lens: the lens model.
    """
    f, c = params[:2], params[2:4]
    if not lens.radius_in_pixels:
        d = (uv - c) / f
        rays, by_d, by_k = lens.unproject(d, params[4:])
        by_pixel = by_d / f
        by_params = np.concatenate([-by_d * (d / f)[..., None, :], -by_pixel, by_k], axis=-1)
        return Unprojected(rays, by_pixel, by_params)
    fx, aspect = f[0], f[1] / f[0]
    d = (uv - c) / fx
    seen = lens.unproject(d, params[4:])
    shrink = np.array([1.0, 1 / aspect, 1.0])
    rays = seen.rays * shrink
    length = np.linalg.norm(rays, axis=-1, keepdims=True)
    rays = rays / length
    # The derivative of a vector's direction, after the change of units along Y.
    turn = (np.eye(3) - rays[..., None] * rays[..., None, :]) * shrink / length[..., None]
    by_d = turn @ seen.by_point
    by_pixel = by_d / fx
    by_aspect = turn[..., 1] * (-seen.rays[..., 1:2] / aspect)
    by_f = np.stack(
        [-(by_d @ d[..., None])[..., 0] / fx - by_aspect * (aspect / fx), by_aspect / fx], axis=-1
    )
    by_params = np.concatenate([by_f, -by_pixel, turn @ seen.by_coefficients], axis=-1)
    return Unprojected(rays, by_pixel, by_params)


def project_points(rays: Array, params: Array, lens: Lens) -> Array:
    """Return `project`'s pixels (..., 2) without derivatives."""
    if lens.radius_in_pixels:
        return project(rays, params, lens).points
    return params[2:4] + params[:2] * lens.project_points(rays, params[4:])


def unproject_points(uv: Array, params: Array, lens: Lens) -> tuple[Array, Array]:
    """Return `unproject`'s rays (..., 3) and derivatives (..., 3, 2) by the pixel only."""
    if lens.radius_in_pixels:
        return unproject(uv, params, lens)[:2]
    rays, by_d = lens.unproject_points((uv - params[2:4]) / params[:2], params[4:])
    return rays, by_d / params[:2]


def rays_from_pixels(uv: Array, camera: Camera) -> Array:
    """Return rays (..., 3) of length 1 of measured pixels (..., 2); NaN where there is none."""
    return rays_and_slopes(uv, camera)[0]


def rays_and_slopes(uv: Array, camera: Camera) -> tuple[Array, Array]:
    """Return rays (..., 3) of measured pixels (..., 2), and their derivatives (..., 3, 2) by these.

    It is `unproject` without the derivatives by the camera's parameters.
    """
    return unproject_points(uv, camera.params, find_model(camera.model))


def pixels_from_rays(rays: Array, camera: Camera) -> Array:
    """Return measured pixels (..., 2) of rays (..., 3) of any length; NaN where there is none."""
    return project_points(rays, camera.params, find_model(camera.model))


def measure_axis_scale(camera: Camera) -> float:
    """Measure how far a ray near the axis moves to the right in the image, px per rad.

    It is fx for most models, but fx / (1 + xi) for Mei's.
    """
    return float(
        project(np.array([0.0, 0.0, 1.0]), camera.params, find_model(camera.model)).by_ray[0, 0]
    )


def _make_diagonal(v: Array) -> Array:
    """Return the diagonal matrices (..., 2, 2) of (..., 2)."""
    return v[..., None] * np.eye(2)

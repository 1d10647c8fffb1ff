"""Directions: the angle of a ray off the axis, and the plane of small changes across it."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array


def measure_angles_off_axis(rays: Array) -> Array:
    """Return the angles (...), rad, between rays (..., 3) of any length and the axis Z."""
    return np.asarray(np.arctan2(np.hypot(rays[..., 0], rays[..., 1]), rays[..., 2]))


def make_tangent_basis(rays: Array) -> Array:
    """Return two unit vectors (..., 3, 2) across each ray (..., 3) of length 1, and each other.

    A ray changes by the basis times a change (..., 2), rad. The basis jumps where Z changes its
    sign (Duff et al. 2017, "Building an orthonormal basis, revisited").
    """
    x, y, z = rays[..., 0], rays[..., 1], rays[..., 2]
    sign = np.copysign(1.0, z)
    a = -1 / (sign + z)
    b = x * y * a
    first = np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=-1)
    second = np.stack([b, sign + y * y * a, -y], axis=-1)
    return np.stack([first, second], axis=-1)

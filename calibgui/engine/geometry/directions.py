"""Directions: rays of length 1, and the plane of small changes across them."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array


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

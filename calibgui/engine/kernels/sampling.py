"""Grey levels between pixels, compiled; see ``images.sampling``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import bilinear, compiled, make_contiguous, make_read_only


@compiled
def _fill_levels(image: GreyImage, uv: Array, out: Array) -> None:
    """Fill out (n,) with the levels at uv (n, 2)."""
    for i in range(uv.shape[0]):
        out[i] = bilinear(image, uv[i, 0], uv[i, 1])


def sample_image(image: GreyImage, uv: Array) -> Array:
    """Compute ``sample_image`` of the reference."""
    out = np.empty(uv.shape[:-1])
    _fill_levels(make_read_only(image), make_contiguous(uv).reshape(-1, 2), out.reshape(-1))
    return out

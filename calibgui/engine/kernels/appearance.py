"""Grey levels around corners, compiled: ``corners.appearance``'s samples."""

from __future__ import annotations

import numpy as np

from calibgui.engine.kernels.common import bilinear, compiled
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array


@compiled
def _around(image, uv, right, down, places, out):  # type: ignore[no-untyped-def]
    height, width = image.shape
    for i in range(uv.shape[0]):
        for k in range(places.shape[0]):
            du = places[k, 0] * right[i, 0] + places[k, 1] * down[i, 0]
            dv = places[k, 0] * right[i, 1] + places[k, 1] * down[i, 1]
            u, v = uv[i, 0] + du, uv[i, 1] + dv
            if not (-0.5 <= u <= width - 0.5 and -0.5 <= v <= height - 0.5):
                u, v = uv[i, 0] - du, uv[i, 1] - dv
            out[i, k] = bilinear(image, u, v)


def around(image: Image, uv: Array, right: Array, down: Array, places: Array) -> Array:
    """(n, k) grey levels of `image` at `places` (k, 2), in steps `right` and `down` (n, 2) px from
    points `uv` (n, 2); opposite where that is outside."""
    out = np.empty((len(uv), len(places)))
    _around(image, uv, right, down, places, out)
    return out

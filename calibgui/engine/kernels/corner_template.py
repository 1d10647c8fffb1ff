"""Samples around corners, compiled; see ``detection.checkerboard.corner_template``.

Only `_fill_samples` reads the image: what is computed from the samples would be compiled anew for
each type of image.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.kernels.common import bilinear, compiled, compiled_part, make_read_only


@compiled_part
def _sample_row(
    image: GreyImage, u: float, v: float, right: Array, down: Array, places: Array, out: Array
) -> None:
    """Fill out with the grey levels at places around (u, v); opposite where that is outside."""
    height, width = image.shape
    for k in range(places.shape[0]):
        du = places[k, 0] * right[0] + places[k, 1] * down[0]
        dv = places[k, 0] * right[1] + places[k, 1] * down[1]
        if not (-0.5 <= u + du <= width - 0.5 and -0.5 <= v + dv <= height - 0.5):
            du, dv = -du, -dv
        out[k] = bilinear(image, u + du, v + dv)


@compiled
def _fill_samples(
    image: GreyImage, uv: Array, right: Array, down: Array, places: Array, out: Array
) -> None:
    for i in range(uv.shape[0]):
        _sample_row(image, uv[i, 0], uv[i, 1], right[i], down[i], places, out[i])


def sample_around(
    image: GreyImage, uv: Array, right: Array, down: Array, positions: Array
) -> Array:
    """Compute ``sample_around`` of the reference."""
    out = np.empty((len(uv), len(positions)))
    _fill_samples(make_read_only(image), uv, right, down, positions, out)
    return out


@compiled
def _normalise_patches(light: Array, patches: Array) -> None:
    """Take the terms light (m, k) out of patches (n, k), and scale these to a mean square of 1."""
    k = patches.shape[1]
    for i in range(patches.shape[0]):
        row = patches[i]
        for term in range(light.shape[0]):
            share = 0.0
            for j in range(k):
                share += row[j] * light[term, j]
            for j in range(k):
                row[j] -= share * light[term, j]
        square = 0.0
        for j in range(k):
            square += row[j] * row[j]
        over = 1 / max(np.sqrt(square / k), 1e-12)
        for j in range(k):
            row[j] *= over


def compute_patches(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    positions: Array,
    light: Array,
) -> Array:
    """Compute ``_compute_patches`` of the reference.

    The first column of `light` is constant, so that what is left has no mean.
    """
    patches = sample_around(image, uv, np.where(dark[:, None], right, -right), down, positions)
    _normalise_patches(np.ascontiguousarray(light.T), patches)
    return patches

"""Samples around corners, compiled; see ``features.corner_template``.

Only `_fill_samples` and `_fill_sectors` read the image: what else is computed from the samples
would be compiled anew for each type of image.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.kernels.common import (
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)

_LEAST_REACH = 1e-9
"""As that of the reference."""


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
def _fill_sectors(
    image: GreyImage, uv: Array, right: Array, down: Array, places: Array, out: Array
) -> None:
    """Fill out (n, count) with the means of as many runs of samples."""
    height, width = image.shape
    n, count = out.shape
    k = places.shape[0] // count
    reach = 0.0
    for j in range(places.shape[0]):
        reach = max(reach, places[j, 0], places[j, 1])
    samples, near = np.empty(places.shape[0]), np.empty((2, 2))
    for i in range(n):
        u, v = uv[i, 0], uv[i, 1]
        across = max(reach * (abs(right[i, 0]) + abs(down[i, 0])), _LEAST_REACH)
        along = max(reach * (abs(right[i, 1]) + abs(down[i, 1])), _LEAST_REACH)
        share = min(min(u, width - 1 - u) / across, min(v, height - 1 - v) / along)
        share = min(max(share, 0.1), 1.0)
        for axis in range(2):
            near[0, axis], near[1, axis] = share * right[i, axis], share * down[i, axis]
        _sample_row(image, u, v, near[0], near[1], places, samples)
        for sector in range(count):
            total = 0.0
            for j in range(sector * k, (sector + 1) * k):
                total += samples[j]
            out[i, sector] = total / k


def average_sectors(
    image: GreyImage, uv: Array, right: Array, down: Array, positions: Array, count: int
) -> Array:
    """Compute ``_average_sectors`` of the reference."""
    out = np.empty((len(uv), count))
    uv, right, down = map(make_contiguous, (uv, right, down))
    _fill_sectors(make_read_only(image), uv, right, down, positions, out)
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

"""Samples around corners, compiled; see ``detection.checkerboard.corner_template``."""

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
def _fill_patches(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    places: Array,
    light: Array,
    out: Array,
) -> None:
    """Fill out (n, k) with patches; light (m, k)."""
    k = places.shape[0]
    for i in range(uv.shape[0]):
        row = out[i]
        _sample_row(
            image, uv[i, 0], uv[i, 1], right[i] if dark[i] else -right[i], down[i], places, row
        )
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
    out = np.empty((len(uv), len(positions)))
    terms = np.ascontiguousarray(light.T)
    _fill_patches(make_read_only(image), uv, right, down, dark, positions, terms, out)
    return out


@compiled
def _fill_differences(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    places: Array,
    reach: float,
    gap: Array,
    difference: Array,
) -> None:
    """Fill gap and difference (n,)."""
    height, width = image.shape
    grey, level = np.empty(places.shape[0]), np.empty(4)
    count = places.shape[0] // 4
    for i in range(uv.shape[0]):
        u, v = uv[i]
        nearer = min(u, width - 1 - u) / (reach * (abs(right[i, 0]) + abs(down[i, 0])))
        across = min(v, height - 1 - v) / (reach * (abs(right[i, 1]) + abs(down[i, 1])))
        nearer = min(max(min(nearer, across), 0.1), 1.0)
        _sample_row(image, u, v, nearer * right[i], nearer * down[i], places, grey)
        for sector in range(4):
            total = 0.0
            for k in range(count):
                total += grey[sector * count + k]
            level[sector] = total / count if dark[i] else -total / count
        gap[i] = min(level[2], level[3]) - max(level[0], level[1])
        difference[i] = (level[2] + level[3] - level[0] - level[1]) / 2


def compare_sectors(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    positions: Array,
    reach: float,
) -> tuple[Array, Array]:
    """Compute ``_compare_sectors`` of the reference."""
    gap, difference = np.empty((2, len(uv)))
    image = make_read_only(image)
    _fill_differences(image, uv, right, down, dark, positions, reach, gap, difference)
    return gap, difference

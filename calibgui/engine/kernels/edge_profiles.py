"""Profiles across edges, compiled: see ``detection.checkerboard.edge_profiles``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)


@compiled_part
def _sample_profile(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: float,
    middle: float,
    half: float,
    grey: Array,
) -> None:
    """Fill grey with the levels s steps along an edge, from middle - half to middle + half steps
    across it."""
    height, width = image.shape
    n = grey.shape[0]
    step, first = 2 * half / (n - 1), middle - half
    du, dv = step * across[0], step * across[1]
    u, v = uv[0] + s * along[0] + first * across[0], uv[1] + s * along[1] + first * across[1]
    far_u, far_v = u + (n - 1) * du, v + (n - 1) * dv
    inside = 0 <= min(u, far_u) and max(u, far_u) < width - 1
    if inside and 0 <= min(v, far_v) and max(v, far_v) < height - 1:
        for j in range(n):
            p, q = u + j * du, v + j * dv
            c, r = int(p), int(q)
            a, b = p - c, q - r
            above = (1 - a) * image[r, c] + a * image[r, c + 1]
            below = (1 - a) * image[r + 1, c] + a * image[r + 1, c + 1]
            grey[j] = (1 - b) * above + b * below
    else:
        for j in range(n):
            grey[j] = bilinear(image, u + j * du, v + j * dv)


@compiled
def _fill_ends(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    ends: int,
    first: Array,
    last: Array,
    total: Array,
) -> None:
    """Add to first, last and total (n, k)."""
    grey = np.empty(samples)
    for i in range(uv.shape[0]):
        for k in range(s.shape[0]):
            _sample_profile(image, uv[i], along[i], across[i], s[k], 0.0, reach, grey)
            total[i, k] = -(grey[0] + grey[samples - 1]) / 2
            for j in range(samples):
                total[i, k] += grey[j]
            for j in range(ends):
                first[i, k] += grey[j] / ends
                last[i, k] += grey[samples - 1 - j] / ends


@compiled
def _count(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    middle: Array,
    half: Array,
    samples: int,
    first: Array,
    rise: Array,
    out: Array,
) -> None:
    """Add to out (n, k)."""
    grey = np.empty(samples)
    for i in range(uv.shape[0]):
        for k in range(s.shape[0]):
            _sample_profile(image, uv[i], along[i], across[i], s[k], middle[i, k], half[i], grey)
            for j in range(samples):
                out[i, k] += 0.25 < (grey[j] - first[i, k]) / rise[i, k] < 0.75


def measure_ends(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    ends: int,
) -> tuple[Array, Array, Array]:
    """Compute ``_measure_ends`` of the reference."""
    first, last, total = np.zeros((3, len(uv), len(s)))
    image, (uv, along, across) = make_read_only(image), map(make_contiguous, (uv, along, across))
    _fill_ends(image, uv, along, across, s, reach, samples, ends, first, last, total)
    return first, last, total


def count_between_quartiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    middle: Array,
    half: Array,
    samples: int,
    first: Array,
    rise: Array,
) -> Array:
    """Compute ``_count_between_quartiles`` of the reference."""
    out = np.zeros((len(uv), len(s)))
    image, (uv, along, across) = make_read_only(image), map(make_contiguous, (uv, along, across))
    _count(image, uv, along, across, s, middle, half, samples, first, rise, out)
    return out

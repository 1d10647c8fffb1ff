"""Profiles across edges, compiled: see ``features.edge_profiles``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, Int32Array
from calibgui.engine.kernels.common import (
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)

_NEXT = np.uintp(1)


@compiled_part
def _sample_profile(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: float,
    middle: float,
    half: float,
    pixel: Int32Array,
    w: Array,
) -> None:
    """Fill the last row of w (7, n) with the levels s steps along an edge, from middle - half to
    middle + half steps across it.

    Inside the image only the pixels are read one by one: the places in pixel (2, n) and between the
    pixels, and the levels from these, become vector instructions. All rows are in one array, so
    that the compiler sees that none overlap."""
    height, width = image.shape
    n = pixel.shape[0] // 2
    grey = w[6 * n :]
    step, first = 2 * half / (n - 1), middle - half
    du, dv = step * across[0], step * across[1]
    u, v = uv[0] + s * along[0] + first * across[0], uv[1] + s * along[1] + first * across[1]
    far_u, far_v = u + (n - 1) * du, v + (n - 1) * dv
    inside = 0 <= min(u, far_u) and max(u, far_u) < width - 1
    if not (inside and 0 <= min(v, far_v) and max(v, far_v) < height - 1):
        for j in range(n):
            grey[j] = bilinear(image, u + j * du, v + j * dv)
        return
    for j in range(n):
        x, y = u + j * du, v + j * dv
        left, above = np.int32(x), np.int32(y)
        pixel[j], pixel[n + j] = left, above
        w[j], w[n + j] = x - left, y - above
    for j in range(n):
        # Numbers without a sign are not asked whether they count from the end.
        column, row = np.uintp(np.uint32(pixel[j])), np.uintp(np.uint32(pixel[n + j]))
        w[2 * n + j], w[3 * n + j] = image[row, column], image[row, column + _NEXT]
        w[4 * n + j], w[5 * n + j] = image[row + _NEXT, column], image[row + _NEXT, column + _NEXT]
    for j in range(n):
        a, b = w[j], w[n + j]
        upper = (1 - a) * w[2 * n + j] + a * w[3 * n + j]
        lower = (1 - a) * w[4 * n + j] + a * w[5 * n + j]
        w[6 * n + j] = (1 - b) * upper + b * lower


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
    """Fill first, last and total (n, k)."""
    pixel, w = np.empty(2 * samples, np.int32), np.empty(7 * samples)
    grey = w[6 * samples :]
    for i in range(uv.shape[0]):
        place, right, down = uv[i], along[i], across[i]
        for k in range(s.shape[0]):
            _sample_profile(image, place, right, down, s[k], 0.0, reach, pixel, w)
            low = high = 0.0
            sum_of_all = -(grey[0] + grey[samples - 1]) / 2
            for j in range(samples):
                sum_of_all += grey[j]
            for j in range(ends):
                low += grey[j]
                high += grey[samples - 1 - j]
            first[i, k], last[i, k], total[i, k] = low / ends, high / ends, sum_of_all


@compiled_part
def _compute_median(values: Array) -> float:
    """Compute the median of a few values, which are sorted in place."""
    n = len(values)
    for i in range(1, n):
        value, j = values[i], i
        while j > 0 and values[j - 1] > value:
            values[j] = values[j - 1]
            j -= 1
        values[j] = value
    median: float = (values[(n - 1) // 2] + values[n // 2]) / 2
    return median


@compiled
def _describe_profiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    size: Array,
    sign: Array,
    ends: Array,
    min_rise: float,
    blur_reach: float,
    out: Array,
) -> None:
    """Fill out (5, n); ends (3, n, k) are the results of `_measure_ends`."""
    pixel, w = np.empty(2 * samples, np.int32), np.empty(7 * samples)
    grey, k = w[6 * samples :], len(s)
    growth, counts, low, high = np.empty(k), np.empty(k), np.empty(k), np.empty(k)
    for i in range(len(uv)):
        place, right, down = uv[i], along[i], across[i]
        close = min(reach, blur_reach / size[i])
        is_clear = True
        for j in range(k):
            first, last, total = ends[0, i, j], ends[1, i, j], ends[2, i, j]
            turn = sign[i] if s[j] > 0 else -sign[i]
            low[j], high[j] = (first, last) if turn > 0 else (last, first)
            rise = last - first
            if turn * rise <= min_rise:
                is_clear, rise = False, np.inf
            integral = (total / (samples - 1) - first) / rise * 2 * reach
            growth[j] = (reach - integral) * turn
            middle = min(max(reach - integral, close - reach), reach - close)
            _sample_profile(image, place, right, down, s[j], middle, close, pixel, w)
            count = 0
            for g in grey:
                share = (g - first) / rise
                count += (share > 0.25) & (share < 0.75)
            counts[j] = count
        out[0, i] = out[1, i] = 0.0 if is_clear else np.nan
        for j in range(k):
            out[0, i] += growth[j] / k
            # The profiles of an arm begin with the nearest and end with the farthest.
            if j % (k // 2) == k // 2 - 1:
                out[1, i] += growth[j] / 2
            elif j % (k // 2) == 0:
                out[1, i] -= growth[j] / 2
        out[2, i] = size[i] * _compute_median(counts) * 2 * close / (samples - 1)
        out[3, i], out[4, i] = _compute_median(low), _compute_median(high)


def measure_ends(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    ends: int,
) -> Array:
    """Compute ``_measure_ends`` of the reference."""
    out = np.empty((3, len(uv), len(s)))
    image, (uv, along, across) = make_read_only(image), map(make_contiguous, (uv, along, across))
    _fill_ends(image, uv, along, across, s, reach, samples, ends, out[0], out[1], out[2])
    return out


def describe_profiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    size: Array,
    sign: Array,
    ends: Array,
    min_rise: float,
    blur_reach: float,
) -> Array:
    """Compute ``_describe_profiles`` of the reference."""
    out = np.empty((5, len(uv)))
    image = make_read_only(image)
    uv, along, across, size, sign = map(make_contiguous, (uv, along, across, size, sign))
    _describe_profiles(
        image, uv, along, across, s, reach, samples, size, sign, ends, min_rise, blur_reach, out
    )
    return out

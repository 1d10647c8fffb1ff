"""What corners look like, compiled: ``corners.appearance``'s samples and what it takes of them."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.kernels.common import bilinear, compiled


@compiled
def _row(image, u, v, right, down, places, out):  # type: ignore[no-untyped-def]
    """Fill out with the grey levels at places around (u, v); opposite where that is outside."""
    height, width = image.shape
    for k in range(places.shape[0]):
        du = places[k, 0] * right[0] + places[k, 1] * down[0]
        dv = places[k, 0] * right[1] + places[k, 1] * down[1]
        if not (-0.5 <= u + du <= width - 0.5 and -0.5 <= v + dv <= height - 0.5):
            du, dv = -du, -dv
        out[k] = bilinear(image, u + du, v + dv)


@compiled
def _around(image, uv, right, down, places, out):  # type: ignore[no-untyped-def]
    for i in range(uv.shape[0]):
        _row(image, uv[i, 0], uv[i, 1], right[i], down[i], places, out[i])


def around(image: GreyImage, uv: Array, right: Array, down: Array, places: Array) -> Array:
    """(n, k) grey levels of `image` at `places` (k, 2), in steps `right` and `down` (n, 2) px from
    points `uv` (n, 2); opposite where that is outside."""
    out = np.empty((len(uv), len(places)))
    _around(image, uv, right, down, places, out)
    return out


@compiled
def _surroundings(image, uv, right, down, dark, places, even, out):  # type: ignore[no-untyped-def]
    k = places.shape[0]
    for i in range(uv.shape[0]):
        row = out[i]
        _row(image, uv[i, 0], uv[i, 1], right[i] if dark[i] else -right[i], down[i], places, row)
        for term in range(even.shape[0]):
            share = 0.0
            for j in range(k):
                share += row[j] * even[term, j]
            for j in range(k):
                row[j] -= share * even[term, j]
        square = 0.0
        for j in range(k):
            square += row[j] * row[j]
        over = 1 / max(np.sqrt(square / k), 1e-12)
        for j in range(k):
            row[j] *= over


def surroundings(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    places: Array,
    even: Array,
) -> Array:
    """``appearance._surroundings``: (n, k) `around`, mirrored where not `dark` (n,), less what
    the orthonormal columns of `even` (k, m) explain, over the rest's standard deviation.

    The first of these is constant, so that the rest has no mean.
    """
    out = np.empty((len(uv), len(places)))
    _surroundings(image, uv, right, down, dark, places, np.ascontiguousarray(even.T), out)
    return out


@compiled
def _sectors(image, uv, right, down, dark, places, reach, gap, difference):  # type: ignore[no-untyped-def]
    height, width = image.shape
    grey, level = np.empty(places.shape[0]), np.empty(4)
    count = places.shape[0] // 4
    for i in range(uv.shape[0]):
        u, v = uv[i]
        nearer = min(u, width - 1 - u) / (reach * (abs(right[i, 0]) + abs(down[i, 0])))
        across = min(v, height - 1 - v) / (reach * (abs(right[i, 1]) + abs(down[i, 1])))
        nearer = min(max(min(nearer, across), 0.1), 1.0)
        _row(image, u, v, nearer * right[i], nearer * down[i], places, grey)
        for sector in range(4):
            total = 0.0
            for k in range(count):
                total += grey[sector * count + k]
            level[sector] = total / count if dark[i] else -total / count
        gap[i] = min(level[2], level[3]) - max(level[0], level[1])
        difference[i] = (level[2] + level[3] - level[0] - level[1]) / 2


def sectors(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    places: Array,
    reach: float,
) -> tuple[Array, Array]:
    """``appearance.sectors``: gap and difference (n,) of bright and dark sectors.

    Args:
        image, uv, right, down, dark: as there.
        places: (4 k, 2) where the sectors are sampled, one after the other, in steps.
        reach: the farthest of them.
    """
    gap, difference = np.empty((2, len(uv)))
    _sectors(image, uv, right, down, dark, places, reach, gap, difference)
    return gap, difference

"""The pixels of the bands around crossing edges, compiled: ``corners.bands``, without a mask."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from calibgui.engine.kernels.common import compiled
from calibgui.engine.opencv import Image, Image32
from calibgui.engine.types import Array, IntArray


class Pixels(NamedTuple):
    """The pixels read around n corners, one corner after the other."""

    begin: IntArray
    """(n,) where a corner's pixels begin."""
    number: IntArray
    """(n,) how many there are."""
    base: Array
    """(n, 2) the pixel that offsets count from."""
    offset: NDArray[np.int16]
    """(2, N) u and v of the pixels from their corner's base."""
    grey: Image32
    """(N,) their grey levels."""
    reach: int
    """Greatest offset."""


@compiled
def _holds(u, v, t, n, curvature, arm, width):  # type: ignore[no-untyped-def]
    """Whether the offset (u, v) from a corner lies in the band of an edge."""
    s = t[0] * u + t[1] * v
    d = n[0] * u + n[1] * v - curvature / 2 * s * s
    return abs(d) <= width and abs(s) <= arm


@compiled
def _read(image, uv, tangent, normal, curvature, arm, width, first, count, base, offset, grey):  # type: ignore[no-untyped-def]
    height, breadth = image.shape
    for i in range(uv.shape[0]):
        at = first[i]
        base[i, 0], base[i, 1] = np.rint(uv[i, 0]), np.rint(uv[i, 1])
        for edge in range(2):
            t, n = tangent[i, edge], normal[i, edge]
            main = 0 if abs(t[0]) >= abs(t[1]) else 1
            slant = abs(t[main])
            slope = t[1 - main] / t[main]
            bend = curvature[i, edge] * n[1 - main] / (t[main] * t[main]) / 2
            along = int(np.ceil(arm[i, edge] * slant + width[i, edge]))
            across = int(np.ceil(width[i, edge] / slant + 0.5))
            for line in range(-along, along + 1):
                x = base[i, main] + line
                dx = x - uv[i, main]
                middle = np.rint(uv[i, 1 - main] + slope * dx + bend * dx * dx)
                for k in range(-across, across + 1):
                    y = middle + k
                    pu, pv = (x, y) if main == 0 else (y, x)
                    if pu < 1 or pv < 1 or pu > breadth - 2 or pv > height - 2:
                        continue
                    qu, qv = pu - uv[i, 0], pv - uv[i, 1]
                    if not _holds(qu, qv, t, n, curvature[i, edge], arm[i, edge], width[i, edge]):
                        continue
                    if edge == 1 and _holds(
                        qu, qv, tangent[i, 0], normal[i, 0], curvature[i, 0], arm[i, 0], width[i, 0]
                    ):
                        continue
                    offset[0, at] = pu - base[i, 0]
                    offset[1, at] = pv - base[i, 1]
                    grey[at] = image[int(pv), int(pu)]
                    at += 1
        count[i] = at - first[i]


def read(
    image: Image,
    uv: Array,
    tangent: Array,
    normal: Array,
    curvature: Array,
    arm: Array,
    width: Array,
) -> Pixels:
    """The pixels of `image` in the bands that ``bands.Bands`` describes, each once."""
    slant = abs(tangent).max(axis=2)
    along, across = np.ceil(arm * slant + width), np.ceil(width / slant + 0.5)
    # Of an area at most as many pixels more than its size as columns cross it.
    most = np.ceil(np.sum((2 * arm + 3) * (2 * width + 3), axis=1)).astype(np.int64)
    end = np.cumsum(most)
    first, n = end - most, len(uv)
    pixels = Pixels(
        first,
        np.zeros(n, dtype=np.int64),
        np.empty((n, 2)),
        np.empty((2, end[-1]), dtype=np.int16),
        np.empty(end[-1], dtype=np.float32),
        int(along.max() + across.max()),
    )
    _read(image, uv, tangent, normal, curvature, arm, width, *pixels[:5])
    return pixels

"""The pixels of the bands around crossing edges, compiled: ``corners.bands``, without a mask.

They are read one corner at a time, whenever they are needed: kept for all the corners of a board
they would take many times the memory of the image.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled


def room(bands: Array) -> int:
    """As many pixels as a corner may have in `bands` (n, 2, 7), laid out as `read` says."""
    # Of an area at most as many pixels more than its size as columns cross it.
    arm, width = bands[..., 5], bands[..., 6]
    return int(np.ceil(np.sum((2 * arm + 3) * (2 * width + 3), axis=1).max()))


def reach(bands: Array) -> int:
    """How far along u or v a pixel may be from the one at its corner, px."""
    slant, arm, width = abs(bands[..., :2]).max(axis=2), bands[..., 5], bands[..., 6]
    along, across = np.ceil(arm * slant + width), np.ceil(width / slant + 0.5)
    return int(along.max() + across.max())


@compiled
def _edge(band, flat, width):  # type: ignore[no-untyped-def]
    """One edge's numbers but with that width, u and v exchanged if it does not lie flat."""
    bend, arm = band[4] / 2, band[5]
    if flat:
        return band[0], band[1], band[2], band[3], bend, arm, width
    return band[1], band[0], band[3], band[2], bend, arm, width


@compiled
def _holds(x, y, edge):  # type: ignore[no-untyped-def]
    """Whether the offset (x, y) from a corner lies in the band of an edge."""
    tx, ty, nx, ny, bend, arm, width = edge
    s = tx * x + ty * y
    d = nx * x + ny * y - bend * s * s
    return abs(d) <= width and abs(s) <= arm


@compiled
def _band(image, cx, cy, edge, done, x_offset, y_offset, grey):  # type: ignore[no-untyped-def]
    """The pixels of a flat edge's band that are not in the one `done`; their number."""
    tx, ty, _, ny, bend, arm, width = edge
    height, breadth = image.shape
    x0, y0 = int(np.rint(cx)), int(np.rint(cy))
    slope, bow = ty / tx, bend * ny / (tx * tx)
    along = int(np.ceil(arm * abs(tx) + width))
    across = int(np.ceil(width / abs(tx) + 0.5))
    count = 0
    for x in range(max(x0 - along, 1), min(x0 + along, breadth - 2) + 1):
        dx = x - cx
        middle = int(np.rint(cy + slope * dx + bow * dx * dx))
        for y in range(max(middle - across, 1), min(middle + across, height - 2) + 1):
            dy = y - cy
            if _holds(dx, dy, edge) and not _holds(dx, dy, done):
                x_offset[count], y_offset[count], grey[count] = x - x0, y - y0, image[y, x]
                count += 1
    return count


@compiled
def read(image, uv, bands, offset, grey):  # type: ignore[no-untyped-def]
    """Fill offset (2, room), counted from the pixel at the corner uv (2,), and grey (room,) with
    the pixels of its bands (2, 7), each once; their number. A band is an edge's tangent, normal,
    curvature, arm and width."""
    u, v = offset
    begin = 0
    for i in range(2):
        flat = abs(bands[i, 0]) >= abs(bands[i, 1])
        edge = _edge(bands[i], flat, bands[i, 6])
        done = _edge(bands[0], flat, bands[0, 6] if i else -1.0)
        free = grey[begin:]
        if flat:
            begin += _band(image, uv[0], uv[1], edge, done, u[begin:], v[begin:], free)
        else:
            begin += _band(image.T, uv[1], uv[0], edge, done, v[begin:], u[begin:], free)
    return begin

"""The pixels in the bands along crossing edges, compiled: see ``EdgeSupport`` of
``corner_fit.x_corner_model``.

A band is an edge's tangent, normal, curvature, arm and width, seven numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import compiled_part

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_Ints = npt.NDArray[np.signedinteger[Any]]
"""Arrays of int32."""
_OrientedBand = tuple[float, float, float, float, float, float, float]
"""Tangent, normal, half the curvature, arm and width of an edge, along and across the axis that it
is nearer to."""


@compiled_part
def point_edges(unknowns: Array, frame: Array) -> None:
    """Fill frame (8,) with t_1, t_2, n_1 and n_2 at the unknowns (9,)."""
    for edge in range(2):
        cosine, sine = np.cos(unknowns[2 + edge]), np.sin(unknowns[2 + edge])
        turn = 1.0 if edge == 0 else -1.0
        frame[2 * edge], frame[2 * edge + 1] = cosine, sine
        frame[4 + 2 * edge], frame[5 + 2 * edge] = -turn * sine, turn * cosine


@compiled_part
def bound_pixels(bands: Array) -> int:
    """Bound the number of pixels of a corner in `bands` (n, 2, 7)."""
    most = 0.0
    for i in range(bands.shape[0]):
        # Of an area at most as many pixels more than its size as columns cross it.
        area = 0.0
        for edge in range(2):
            area += (2 * bands[i, edge, 5] + 3) * (2 * bands[i, edge, 6] + 3)
        most = area if most < area < np.inf else most
    return int(np.ceil(most))


@compiled_part
def bound_offsets(bands: Array) -> int:
    """Bound the distance of pixels along u or v from the one at their corner, px."""
    along = across = 0.0
    for i in range(bands.shape[0]):
        for edge in range(2):
            band = bands[i, edge]
            slant = max(abs(band[0]), abs(band[1]))
            length, breadth = band[5] * slant + band[6], band[6] / slant + 0.5
            along = length if along < length < np.inf else along
            across = breadth if across < breadth < np.inf else across
    return int(np.ceil(along) + np.ceil(across))


@compiled_part
def _orient_band(band: Array, flat: bool, width: float) -> _OrientedBand:
    """Return one edge's numbers but with that width, u and v exchanged if it is not flat."""
    bend, arm = band[4] / 2, band[5]
    if flat:
        return band[0], band[1], band[2], band[3], bend, arm, width
    return band[1], band[0], band[3], band[2], bend, arm, width


@compiled_part
def _contains(x: float, y: float, edge: _OrientedBand) -> bool:
    """Return whether the offset (x, y) from a corner lies in the band of an edge."""
    tx, ty, nx, ny, bend, arm, width = edge
    s = tx * x + ty * y
    d = nx * x + ny * y - bend * s * s
    return abs(d) <= width and abs(s) <= arm


@compiled_part
def _may_meet(x: float, first: float, last: float, edge: _OrientedBand) -> bool:
    """Return whether offsets (x, first) to (x, last) may lie in the band of an edge: they do not
    where both ends are on one side of it by more than its arc rises over its chord."""
    tx, ty, nx, ny, bend, _, width = edge
    s, t = tx * x + ty * first, tx * x + ty * last
    d, e = nx * x + ny * first - bend * s * s, nx * x + ny * last - bend * t * t
    reach = width + abs(bend) * (s - t) ** 2 / 4
    return min(d, e) <= reach and max(d, e) >= -reach


@compiled_part
def _read_band(
    image: GreyImage,
    flat: bool,
    cx: float,
    cy: float,
    edge: _OrientedBand,
    done: _OrientedBand,
    x_offset: _Ints,
    y_offset: _Ints,
    grey: _Floats,
) -> int:
    """Read the pixels of an edge's band that are not in the one `done`; return their number.

    All lies in the frame of the bands, whose x and y are the image's u and v if the edge is flat,
    otherwise v and u. (The transposed image would be another type, compiled by itself.)"""
    tx, ty, _, ny, bend, arm, width = edge
    height, breadth = image.shape if flat else image.shape[::-1]
    x0, y0 = int(np.rint(cx)), int(np.rint(cy))
    slope, bow = ty / tx, bend * ny / (tx * tx)
    along = int(np.ceil(arm * abs(tx) + width))
    across = int(np.ceil(width / abs(tx) + 0.5))
    count = 0
    for x in range(max(x0 - along, 1), min(x0 + along, breadth - 2) + 1):
        dx = x - cx
        middle = int(np.rint(cy + slope * dx + bow * dx * dx))
        first, last = max(middle - across, 1), min(middle + across, height - 2)
        # A band meets a column in one piece.
        while first <= last and not _contains(dx, first - cy, edge):
            first += 1
        while first < last and not _contains(dx, last - cy, edge):
            last -= 1
        # Numbers without a sign are not asked whether they count from the end.
        column = np.uintp(x)
        if done[6] < 0 or not _may_meet(dx, first - cy, last - cy, done):
            for y in range(first, last + 1):
                at, row = np.uintp(count + y - first), np.uintp(y)
                x_offset[at], y_offset[at] = x - x0, y - y0
                grey[at] = image[row, column] if flat else image[column, row]
            count += max(last + 1 - first, 0)
            continue
        for y in range(first, last + 1):
            if not _contains(dx, y - cy, done):
                at, row = np.uintp(count), np.uintp(y)
                x_offset[at], y_offset[at] = x - x0, y - y0
                grey[at] = image[row, column] if flat else image[column, row]
                count += 1
    return count


@compiled_part
def read_bands(image: GreyImage, uv: Array, bands: Array, offset: _Ints, grey: _Floats) -> int:
    """Fill offset (2, room), counted from the pixel at the corner uv (2,), and grey (room,) with
    the pixels of its bands (2, 7), each once; return their number, 0 if not all of that is
    finite."""
    total = uv[0] + uv[1]
    for i in range(2):
        for k in range(7):
            total += bands[i, k]
    if not abs(total) < np.inf:
        return 0
    u, v = offset
    begin = 0
    for i in range(2):
        flat = abs(bands[i, 0]) >= abs(bands[i, 1])
        edge = _orient_band(bands[i], flat, bands[i, 6])
        done = _orient_band(bands[0], flat, bands[0, 6] if i else -1.0)
        free = grey[begin:]
        cx, cy, x, y = (uv[0], uv[1], u, v) if flat else (uv[1], uv[0], v, u)
        begin += _read_band(image, flat, cx, cy, edge, done, x[begin:], y[begin:], free)
    return begin

"""The normal equations of the outlines of tags, compiled: see ``apriltags.outline_model``.

The pixels of an edge are sorted by the edge that they see beside it, its neighbour at either end or
none, and taken in blocks that the processor's first cache holds, so that all of a block have the
same columns and the loops over it turn into vector instructions: see ``x_corner_model``, whose
blurred edge is taken. All but the sums over blocks is float32.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    add_products,
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)
from calibgui.engine.kernels.edge_intensity import BLOCK, fill_edge

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_Ints = npt.NDArray[np.signedinteger[Any]]
"""Arrays of int64."""
_COLUMNS = 22
"""Number of columns: 21 unknowns and the residual."""
_D, _DO, _S, _SO, _X, _Y, _GREY, _B, _BO, _ZERO, _E, _EO, _J = (
    BLOCK * row for row in (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 13, 16)
)
"""Where the rows of a block begin: distances from the edge and from the one beside it, shares along
both, places in halves of the tag's side from its middle, grey levels, blurs of both edges, zeros;
value, slope and derivative by the blur of both; the columns of the normal equations."""
_ROWS = 16 + _COLUMNS
"""Number of rows."""
_FAR = 5.7
"""Distance from an edge, in blurs and half widths of a pixel, at which nothing of its blur is left
in a float32."""
_F = np.float32
_HALF, _ONE, _NO = _F(0.5), _F(1), _F(0)


class _Model(Protocol):
    """The fields and methods of ``OutlineModel`` that are used here."""

    @property
    def corners(self) -> Array: ...
    @property
    def blurs(self) -> Array: ...
    @property
    def levels(self) -> Array: ...
    @property
    def bows(self) -> Array: ...
    @property
    def correlation(self) -> Array: ...
    @property
    def half(self) -> Array: ...
    def measure_edges(self) -> tuple[Array, Array, Array]: ...
    def measure_bands(self) -> Array: ...


@compiled_part
def _fill_lines(corners: Array, edges: Array, bands: Array, bows: Array, lines: Array) -> None:
    """Fill in what an edge a row says of pixels, see `_measure` and `_is_within`; edges (4, 5) are
    the length, tangent and inward normal of each."""
    for k in range(4):
        length, u, v = edges[k, 0], corners[k, 0], corners[k, 1]
        tu, tv, nu, nv = edges[k, 1], edges[k, 2], edges[k, 3], edges[k, 4]
        lines[k, 0], lines[k, 1], lines[k, 2] = (
            tu / length,
            tv / length,
            -(tu * u + tv * v) / length,
        )
        lines[k, 3], lines[k, 4], lines[k, 5] = nu, nv, -(nu * u + nv * v)
        lines[k, 6] = 4 * bows[k]
        lines[k, 7], lines[k, 8] = -bands[k, 0], bands[k, 1]
        lines[k, 9] = 0.5 + bands[k, 0] / length


@compiled_part
def _measure(u: float, v: float, line: Array) -> tuple[float, float]:
    """Compute s over the length, and d px, of (u, v) along and within an edge."""
    s = line[0] * u + line[1] * v + line[2]
    return s, line[3] * u + line[4] * v + line[5] + line[6] * s * (1 - s)


@compiled_part
def _is_within(s: float, d: float, line: Array) -> bool:
    """Return whether a pixel lies in the band of an edge."""
    return line[7] <= d <= line[8] and abs(s - 0.5) <= line[9]


@compiled_part
def _is_earlier(u: float, v: float, edge: int, lines: Array) -> bool:
    """Return whether a pixel lies in the band of an edge before this one."""
    for k in range(edge):
        s, d = _measure(u, v, lines[k])
        if _is_within(s, d, lines[k]):
            return True
    return False


@compiled_part
def _fill_columns(
    w: _Floats, edge: int, other: int, edges: Array, correlation: float, levels: Array, m: int
) -> None:
    """Fill rows J of m pixels of an edge that see another beside it; -1 if they see none."""
    n0, n1 = _F(edges[edge, 3]), _F(edges[edge, 4])
    o0, o1, rho, both, sign = _NO, _NO, _NO, _NO, _ONE
    if other >= 0:
        o0, o1 = _F(edges[other, 3]), _F(edges[other, 4])
        # The corner at the beginning of the edge is that of its number, the other the next.
        if (edge + (other == (edge + 1) % 4)) % 2 == 1:
            sign = -_ONE
        rho = n0 * o0 + n1 * o1 + sign * _F(correlation)
        both = w[_B] * w[_BO] / _F(4)
    mine_squared, its_squared = _ONE / (w[_B] * w[_B]), _ONE / (w[_BO] * w[_BO])
    per_both = _ONE / (w[_B] * w[_BO])
    by_2, by_3, by_4 = rho / _F(2), rho * rho / _F(6), rho * rho * rho / _F(24)
    p0, p1, p2 = _F(levels[0, 0]), _F(levels[0, 1]), _F(levels[0, 2])
    i0, i1, i2 = _F(levels[1, 0]), _F(levels[1, 1]), _F(levels[1, 2])
    begin, end = _J + 2 * edge * BLOCK, _J + 2 * ((edge + 1) % 4) * BLOCK
    mine, its = _J + (8 + edge % 2) * BLOCK, _J + (9 - edge % 2) * BLOCK
    bow, residual = _J + (16 + edge) * BLOCK, _J + (_COLUMNS - 1) * BLOCK
    for p in range(m):
        x, y = w[_X + p], w[_Y + p]
        paper, ink = p0 + p1 * x + p2 * y, i0 + i1 * x + i2 * y
        swing = (ink - paper) * _HALF
        here, beside = (w[_E + p] + _ONE) * _HALF, (w[_EO + p] + _ONE) * _HALF
        slope, other_slope = w[_E + BLOCK + p], w[_EO + BLOCK + p]
        xx, yy = w[_D + p] * w[_D + p] * mine_squared, w[_DO + p] * w[_DO + p] * its_squared
        xy = w[_D + p] * w[_DO + p] * per_both
        second, third = (xx - _ONE) * (yy - _ONE), xy * (xx - _F(3)) * (yy - _F(3))
        density = both * slope * other_slope
        Q = here * beside + density * rho * (_ONE + by_2 * xy + by_3 * second + by_4 * third)
        by_rho = _ONE + _F(2) * by_2 * xy + _F(3) * by_3 * second + _F(4) * by_4 * third
        w[_J + 20 * BLOCK + p] = sign * (ink - paper) * density * by_rho
        pull = -swing * beside * slope
        first, last = pull * (_ONE - w[_S + p]), pull * w[_S + p]
        w[begin + p], w[begin + BLOCK + p] = first * n0, first * n1
        w[end + p], w[end + BLOCK + p] = last * n0, last * n1
        w[bow + p] = _F(-4) * first * w[_S + p]
        w[mine + p] = swing * beside * w[_E + 2 * BLOCK + p]
        w[its + p] = swing * here * w[_EO + 2 * BLOCK + p]
        w[residual + p] = w[_GREY + p] - (paper + (ink - paper) * Q)
        w[_J + 13 * BLOCK + p] = Q
    for p in range(m):
        x, y, Q = w[_X + p], w[_Y + p], w[_J + 13 * BLOCK + p]
        w[_J + 10 * BLOCK + p] = _ONE - Q
        w[_J + 11 * BLOCK + p], w[_J + 12 * BLOCK + p] = (_ONE - Q) * x, (_ONE - Q) * y
        w[_J + 14 * BLOCK + p], w[_J + 15 * BLOCK + p] = Q * x, Q * y
    if other < 0:
        return
    # The other edge ends where this one begins, or begins where it ends.
    begin, end = _J + 2 * other * BLOCK, _J + 2 * ((other + 1) % 4) * BLOCK
    shared = end if end == _J + 2 * edge * BLOCK else begin
    alone = begin if shared == end else end
    bow = _J + (16 + other) * BLOCK
    for p in range(m):
        x, y = w[_X + p], w[_Y + p]
        swing = (i0 - p0 + (i1 - p1) * x + (i2 - p2) * y) * _HALF
        here = (w[_E + p] + _ONE) * _HALF
        pull = -swing * here * w[_EO + BLOCK + p]
        first, last = pull * (_ONE - w[_SO + p]), pull * w[_SO + p]
        w[bow + p] = _F(-4) * first * w[_SO + p]
        near, away = (last, first) if shared == end else (first, last)
        w[alone + p], w[alone + BLOCK + p] = away * o0, away * o1
        w[shared + p] += near * o0
        w[shared + BLOCK + p] += near * o1


@compiled_part
def _list_columns(edge: int, other: int, columns: _Ints) -> int:
    """Fill in the numbers, in order, of the columns that are not 0 where an edge and another one
    beside it, or none, are seen; return their count."""
    count = 0
    for k in range(4):
        is_seen = k == edge or k == (edge + 1) % 4
        if is_seen or (other >= 0 and (k == other or k == (other + 1) % 4)):
            columns[count], columns[count + 1] = 2 * k, 2 * k + 1
            count += 2
    for k in range(8, 16):
        if other >= 0 or k != 9 - edge % 2:
            columns[count] = k
            count += 1
    for k in range(4):
        if k in (edge, other):
            columns[count] = 16 + k
            count += 1
    if other >= 0:
        columns[count] = 20
        count += 1
    columns[count] = _COLUMNS - 1
    count += 1
    return count


@compiled_part
def _add_block(
    w: _Floats,
    edge: int,
    end: int,
    edges: Array,
    blurs: Array,
    correlation: float,
    box: Array,
    levels: Array,
    columns: _Ints,
    m: int,
    out: Array,
) -> None:
    """Add the products of m pixels of an edge to the lower triangle of out (22, 22); near its
    beginning (0), near its end (1), or far from both (2)."""
    last = (edge + 3) % 4
    other = last if end == 0 else (edge + 1) % 4 if end == 1 else -1
    for p in range(m):
        w[_B + p], w[_BO + p], w[_ZERO + p] = _F(blurs[edge % 2]), _F(blurs[last % 2]), _NO
    fill_edge(w[_D:], _ONE, w[_ZERO:], _NO, w[_B:], _F(box[edge]), w[_E:], m)
    if other < 0:
        for p in range(m):
            w[_EO + p], w[_EO + BLOCK + p], w[_EO + 2 * BLOCK + p] = _ONE, _NO, _NO
    else:
        fill_edge(w[_DO:], _ONE, w[_ZERO:], _NO, w[_BO:], _F(box[last]), w[_EO:], m)
    _fill_columns(w, edge, other, edges, correlation, levels, m)
    count = _list_columns(edge, other, columns)
    add_products(w[_J:], BLOCK, columns, count, m, out)


@compiled_part
def _follow_edge(
    edge: int, corners: Array, edges: Array, bow: float, wide: float, extent: int, rows: Array
) -> tuple[int, int]:
    """Fill in, for each column of an image that may show the band of an edge, `wide` px to either
    side, the row where the edge passes, or with u and v exchanged if it runs more along v. Return
    the first column, and that after the last, of the `extent` less those at its ends."""
    length, tu, tv = edges[edge, 0], edges[edge, 1], edges[edge, 2]
    flat = abs(tu) >= abs(tv)
    axis, along, across = (0, tu, tv) if flat else (1, tv, tu)
    x0, y0, x1 = corners[edge, axis], corners[edge, 1 - axis], corners[(edge + 1) % 4, axis]
    first = max(int(np.floor(min(x0, x1) - wide)), 1)
    last = min(int(np.ceil(max(x0, x1) + wide)) + 1, extent - 1)
    # Of a normal (-t_v, t_u) the part across is t_u, or -t_v for an edge along v.
    out = -4 * bow / (along if flat else -along)
    for x in range(first, last):
        way = (x - x0) / along
        share = way / length
        rows[x] = np.rint(y0 + way * across + out * share * (1 - share))
    return first, last


@compiled_part
def _find_lone_part(
    edge: int, corners: Array, bows: Array, lines: Array, wide: float, far: float
) -> tuple[float, float]:
    """Find between which shares along an edge no pixel of its band, `wide` px to either side, lies
    in the band of an edge before it, nor within `far` px of its neighbours."""
    low, high = -np.inf, np.inf
    off = wide + 4 * abs(bows[edge]) * lines[edge, 9] ** 2
    begin, end = corners[edge], corners[(edge + 1) % 4]
    for k in range(4):
        is_neighbour = (k - edge) % 2 == 1
        if k == edge or (k > edge and not is_neighbour):
            continue
        limit = max(lines[k, 8] if k < edge else 0.0, far if is_neighbour else 0.0)
        line = lines[k]
        s0 = line[0] * begin[0] + line[1] * begin[1] + line[2]
        s1 = line[0] * end[0] + line[1] * end[1] + line[2]
        d0 = line[3] * begin[0] + line[4] * begin[1] + line[5]
        d1 = line[3] * end[0] + line[4] * end[1] + line[5]
        # A bow moves its edge by 4 b s (1 - s).
        pad = off * np.sqrt(line[0] ** 2 + line[1] ** 2)
        most = abs((s0 + s1) / 2 - 0.5) + abs(s1 - s0) * lines[edge, 9] + pad
        least = limit + off + abs(line[6]) * max(most * most, 0.25)
        if d1 > d0:
            low = max(low, (least - d0) / (d1 - d0))
        elif d1 < d0:
            high = min(high, (least - d0) / (d1 - d0))
        elif d0 <= least:
            high = low
    return low, high


@compiled_part
def _add_edge(
    image: GreyImage,
    edge: int,
    corners: Array,
    edges: Array,
    bands: Array,
    bows: Array,
    blurs: Array,
    correlation: float,
    box: Array,
    levels: Array,
    half: float,
    lines: Array,
    along: Array,
    w: _Floats,
    counts: _Ints,
    columns: _Ints,
    out: Array,
) -> None:
    """Add the products of the pixels of an edge of a tag to the lower triangle of out (22, 22)."""
    height, width = image.shape
    middle_u = (corners[0, 0] + corners[1, 0] + corners[2, 0] + corners[3, 0]) / 4
    middle_v = (corners[0, 1] + corners[1, 1] + corners[2, 1] + corners[3, 1]) / 4
    line, tu, tv = lines[edge], edges[edge, 1], edges[edge, 2]
    flat = abs(tu) >= abs(tv)
    t, extent, across = (tu, width, height) if flat else (tv, height, width)
    s_x, s_y, d_x, d_y = line[0], line[1], line[3], line[4]
    if not flat:
        s_x, s_y, d_x, d_y = s_y, s_x, d_y, d_x
    rows, shares, distances = along
    wide = max(bands[edge, 0], bands[edge, 1])
    first, last = _follow_edge(edge, corners, edges, bows[edge], wide, extent, rows)
    reach = int(np.ceil(wide / abs(t) + 0.5))
    far = _FAR * blurs[(edge + 1) % 2] + box[(edge + 1) % 4]
    low, high = _find_lone_part(edge, corners, bows, lines, wide, far)
    for aside in range(-reach, reach + 1):
        for x in range(first, last):
            y = rows[x] + aside
            s = s_x * x + s_y * y + line[2]
            shares[x] = s
            distances[x] = d_x * x + d_y * y + line[5] + line[6] * s * (1 - s)
        for x in range(first, last):
            s, d, y = shares[x], distances[x], int(rows[x]) + aside
            if not _is_within(s, d, line) or y < 1 or y > across - 2:
                continue
            u, v = (x, y) if flat else (y, x)
            which, s2, d2 = 2, 0.0, 0.0
            if not low < s < high:
                if _is_earlier(u, v, edge, lines):
                    continue
                end = 0 if s < 0.5 else 1
                s2, d2 = _measure(u, v, lines[(edge + 3 + 2 * end) % 4])
                which = end if d2 <= far else 2
            m, block = counts[which], w[which]
            block[_D + m], block[_DO + m], block[_S + m], block[_SO + m] = d, d2, s, s2
            block[_X + m] = (u - middle_u) / half
            block[_Y + m] = (v - middle_v) / half
            block[_GREY + m] = image[v, u]
            counts[which] += 1
            if counts[which] == BLOCK:
                _add_block(
                    block, edge, which, edges, blurs, correlation, box, levels, columns, BLOCK, out
                )
                counts[which] = 0
    for which in range(3):
        if counts[which]:
            m = counts[which]
            _add_block(
                w[which], edge, which, edges, blurs, correlation, box, levels, columns, m, out
            )
            counts[which] = 0


@compiled
def _accumulate(
    image: GreyImage,
    corners: Array,
    edges: Array,
    bands: Array,
    bows: Array,
    blurs: Array,
    correlation: Array,
    box: Array,
    levels: Array,
    half: Array,
    out: Array,
) -> None:
    """Add to out (n, 22, 22)."""
    w, counts = np.zeros((3, _ROWS * BLOCK), dtype=_F), np.zeros(3, dtype=np.int64)
    columns, lines = np.empty(_COLUMNS, dtype=np.int64), np.empty((4, 10))
    along = np.empty((3, max(image.shape)))
    for i in range(len(corners)):
        _fill_lines(corners[i], edges[i], bands[i], bows[i], lines)
        for edge in range(4):
            _add_edge(
                image, edge, corners[i], edges[i], bands[i], bows[i], blurs[i], correlation[i],
                box[i], levels[i], half[i], lines, along, w, counts, columns, out[i],
            )  # fmt: skip
        for a in range(_COLUMNS):
            for b in range(a):
                out[i, b, a] = out[i, a, b]


def accumulate_normal_equations(image: GreyImage, model: _Model, is_sharp: bool) -> Array:
    """Compute ``_accumulate_normal_equations`` of the reference."""
    n = len(model.corners)
    length, tangent, normal = model.measure_edges()
    edges = np.concatenate([length[..., None], tangent, normal], axis=2)
    box = abs(normal).max(axis=2) / 2 if is_sharp else np.zeros((n, 4))
    out = np.zeros((n, _COLUMNS, _COLUMNS))
    corners, bows, blurs, correlation, levels, half = map(
        make_contiguous,
        (model.corners, model.bows, model.blurs, model.correlation, model.levels, model.half),
    )
    _accumulate(
        make_read_only(image), corners, edges, make_contiguous(model.measure_bands()), bows,
        blurs, correlation, box, levels, half, out,
    )  # fmt: skip
    return out


@compiled
def _average_profiles(
    image: GreyImage,
    corners: Array,
    edges: Array,
    bows: Array,
    reach: Array,
    share: Array,
    out: Array,
) -> None:
    """Add to out (n, 4, 3, samples)."""
    m, samples = len(share), out.shape[3]
    for i in range(len(corners)):
        for edge in range(4):
            length, tu, tv = edges[i, edge, 0], edges[i, edge, 1], edges[i, edge, 2]
            nu, nv = edges[i, edge, 3], edges[i, edge, 4]
            for k in range(m):
                s = share[k] * length
                bow = -4 * bows[i, edge] * share[k] * (1 - share[k])
                u, v = corners[i, edge, 0] + s * tu, corners[i, edge, 1] + s * tv
                for j in range(samples):
                    d = bow + reach[i] * (2 * j / (samples - 1) - 1)
                    grey = bilinear(image, u + d * nu, v + d * nv)
                    out[i, edge, 3 * k // m, j] += 3 * grey / m


def average_profiles(
    image: GreyImage, model: _Model, reach: Array, share: Array, samples: int
) -> Array:
    """Compute ``_average_profiles`` of the reference."""
    corners, bows, reach = map(make_contiguous, (model.corners, model.bows, reach))
    out = np.zeros((len(corners), 4, 3, samples))
    edges = np.concatenate(
        [part.reshape(len(out), 4, -1) for part in model.measure_edges()], axis=2
    )
    _average_profiles(make_read_only(image), corners, edges, bows, reach, share, out)
    return out

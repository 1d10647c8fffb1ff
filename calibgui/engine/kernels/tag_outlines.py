"""The normal equations of the outlines of tags, compiled: see ``detection.apriltags.tag_outlines``.

The columns of a few pixels at a time are kept, so that their products are formed from what the
processor's first cache holds.
"""

from __future__ import annotations

from math import erf, exp
from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    bilinear,
    compiled,
    compiled_part,
    gram,
    make_contiguous,
    make_read_only,
)

_COLUMNS = 17
"""Number of columns: sixteen unknowns and the residual."""
_BLOCK = 64
"""Number of pixels taken at once."""
_ROOT2, _ROOT_PI, _ROOT2_PI = np.sqrt(2.0), np.sqrt(np.pi), np.sqrt(2 / np.pi)
_MIN_GAUSSIAN2 = 0.01


class _Model(Protocol):
    """The fields and methods of ``_Model`` that are used here."""

    @property
    def corners(self) -> Array: ...
    @property
    def blurs(self) -> Array: ...
    @property
    def levels(self) -> Array: ...
    @property
    def curvature(self) -> Array: ...
    @property
    def half(self) -> Array: ...
    def measure_edges(self) -> tuple[Array, Array, Array]: ...
    def measure_bands(self) -> Array: ...


@compiled_part
def _compute_edge(d: float, s: float, box: float) -> tuple[float, float, float]:
    """Compute value, slope and derivative by the blur s of ``compute_edge`` at the distance d; the
    half width box of the pixel is 0 where it is part of the blur."""
    if box == 0:
        x = d / (_ROOT2 * s)
        slope = exp(-x * x) * (_ROOT2_PI / s)
        return erf(x), slope, -d / s * slope
    g = np.sqrt(max(s * s - box * box / 3, _MIN_GAUSSIAN2))
    a, b = (d + box) / (_ROOT2 * g), (d - box) / (_ROOT2 * g)
    fall = exp(-a * a) - exp(-b * b)
    erf_a, erf_b = erf(a), erf(b)
    value = (a * erf_a - b * erf_b + fall / _ROOT_PI) * (g / (_ROOT2 * box))
    return value, (erf_a - erf_b) / (2 * box), fall * (_ROOT2_PI / (2 * box) * (s / g))


@compiled_part
def _measure(
    p: float, q: float, corners: Array, edges: Array, curvature: Array, s: Array, d: Array
) -> None:
    """Fill s over the length and d (4,) px with the place of (p, q) along and within the edges,
    whose length, tangent and inward normal are edges (4, 5)."""
    for k in range(4):
        length = edges[k, 0]
        x, y = p - corners[k, 0], q - corners[k, 1]
        s[k] = (edges[k, 1] * x + edges[k, 2] * y) / length
        bow = curvature[k] * length * length / 2
        d[k] = edges[k, 3] * x + edges[k, 4] * y + bow * s[k] * (1 - s[k])


@compiled_part
def _is_own(s: Array, d: Array, edges: Array, bands: Array, edge: int) -> bool:
    """Return whether a pixel lies in the band of an edge and in that of none before it."""
    for k in range(edge + 1):
        out, inside = bands[k, 0], bands[k, 1]
        within = -out <= d[k] <= inside and abs(s[k] - 0.5) <= 0.5 + out / edges[k, 0]
        if within != (k == edge):
            return False
    return True


@compiled_part
def _fill_column(
    edge: int,
    s: Array,
    d: Array,
    edges: Array,
    blurs: Array,
    box: Array,
    levels: Array,
    x: float,
    y: float,
    grey: float,
    J: Array,
    column: int,
) -> None:
    """Fill a column of J (17, ...) at a pixel of an edge, (x, y) halves of the tag's side from its
    middle."""
    last, following = (edge + 3) % 4, (edge + 1) % 4
    other = last if s[edge] < 0.5 else following
    rho = edges[edge, 3] * edges[other, 3] + edges[edge, 4] * edges[other, 4]
    s1, s2 = blurs[edge % 2], blurs[last % 2]
    mine, slope, by_blur = _compute_edge(d[edge], s1, box[edge])
    its, its_slope, its_by_blur = _compute_edge(d[other], s2, box[last])
    beside, here = (1 + its) / 2, (1 + mine) / 2
    turn = rho * d[edge] / s1 * d[other] / s2
    Q = here * beside + s1 * s2 * slope * its_slope / 4 * rho * (1 + turn / 2)
    paper = levels[0, 0] + levels[0, 1] * x + levels[0, 2] * y
    ink = levels[1, 0] + levels[1, 1] * x + levels[1, 2] * y
    swing = (ink - paper) / 2
    for k in range(8):
        J[k, column] = 0.0
    for which in (edge, other):
        by_distance = swing * (beside * slope if which == edge else here * its_slope)
        end = (which + 1) % 4
        for axis in range(2):
            pull = -by_distance * edges[which, 3 + axis]
            J[2 * which + axis, column] += pull * (1 - s[which])
            J[2 * end + axis, column] += pull * s[which]
    J[8 + edge % 2, column] = swing * beside * by_blur
    J[8 + last % 2, column] = swing * here * its_by_blur
    J[10, column], J[11, column], J[12, column] = 1 - Q, (1 - Q) * x, (1 - Q) * y
    J[13, column], J[14, column], J[15, column] = Q, Q * x, Q * y
    J[16, column] = grey - (paper * (1 - Q) + ink * Q)


@compiled_part
def _add_products(J: Array, count: int, N: Array, out: Array) -> None:
    """Add the products of the first columns of J to out (17, 17); N is for use."""
    for k in range(_COLUMNS):
        for i in range(count, _BLOCK):
            J[k, i] = 0.0
    gram(J, N)
    for i in range(_COLUMNS):
        for j in range(_COLUMNS):
            out[i, j] += N[i, j]


@compiled
def _accumulate(
    image: GreyImage,
    corners: Array,
    edges: Array,
    bands: Array,
    curvature: Array,
    blurs: Array,
    box: Array,
    levels: Array,
    half: Array,
    out: Array,
) -> None:
    """Add to out (n, 17, 17)."""
    height, width = image.shape
    J, N = np.empty((_COLUMNS, _BLOCK)), np.empty((_COLUMNS, _COLUMNS))
    s, d = np.empty(4), np.empty(4)
    for i in range(len(corners)):
        middle_u = middle_v = 0.0
        for k in range(4):
            middle_u += corners[i, k, 0] / 4
            middle_v += corners[i, k, 1] / 4
        count = 0
        for edge in range(4):
            length, tu, tv = edges[i, edge, 0], edges[i, edge, 1], edges[i, edge, 2]
            flat = abs(tu) >= abs(tv)
            along, across = (tu, tv) if flat else (tv, tu)
            begin, end = corners[i, edge], corners[i, (edge + 1) % 4]
            x0, y0 = (begin[0], begin[1]) if flat else (begin[1], begin[0])
            x1 = end[0] if flat else end[1]
            wide = max(bands[i, edge, 0], bands[i, edge, 1])
            reach = int(np.ceil(wide / abs(along) + 0.5))
            for x in range(int(np.floor(min(x0, x1) - wide)), int(np.ceil(max(x0, x1) + wide)) + 1):
                way = (x - x0) / along
                bow = -curvature[i, edge] * way * (length - way) / 2
                # Of a normal (-t_v, t_u) the part across is t_u, or -t_v for an edge along v.
                row = int(np.rint(y0 + way * across + bow / (along if flat else -along)))
                for y in range(row - reach, row + reach + 1):
                    u, v = (x, y) if flat else (y, x)
                    if u < 1 or v < 1 or u > width - 2 or v > height - 2:
                        continue
                    _measure(u, v, corners[i], edges[i], curvature[i], s, d)
                    if not _is_own(s, d, edges[i], bands[i], edge):
                        continue
                    _fill_column(
                        edge, s, d, edges[i], blurs[i], box[i], levels[i],
                        (u - middle_u) / half[i], (v - middle_v) / half[i], image[v, u], J, count,
                    )  # fmt: skip
                    count += 1
                    if count == _BLOCK:
                        _add_products(J, count, N, out[i])
                        count = 0
        _add_products(J, count, N, out[i])


def accumulate_normal_equations(image: GreyImage, model: _Model, is_sharp: bool) -> Array:
    """Compute ``_accumulate_normal_equations`` of the reference."""
    n = len(model.corners)
    length, tangent, normal = model.measure_edges()
    edges = np.concatenate([length[..., None], tangent, normal], axis=2)
    box = abs(normal).max(axis=2) / 2 if is_sharp else np.zeros((n, 4))
    out = np.zeros((n, _COLUMNS, _COLUMNS))
    corners, curvature, blurs, levels, half = map(
        make_contiguous, (model.corners, model.curvature, model.blurs, model.levels, model.half)
    )
    _accumulate(
        make_read_only(image), corners, edges, make_contiguous(model.measure_bands()), curvature,
        blurs, box, levels, half, out,
    )  # fmt: skip
    return out


@compiled
def _average_profiles(
    image: GreyImage,
    corners: Array,
    edges: Array,
    curvature: Array,
    reach: Array,
    share: Array,
    out: Array,
) -> None:
    """Add to out (n, 4, 2, samples)."""
    m, samples = len(share), out.shape[3]
    for i in range(len(corners)):
        for edge in range(4):
            length, tu, tv = edges[i, edge, 0], edges[i, edge, 1], edges[i, edge, 2]
            nu, nv = edges[i, edge, 3], edges[i, edge, 4]
            for k in range(m):
                s = share[k] * length
                bow = -curvature[i, edge] * s * (length - s) / 2
                u, v = corners[i, edge, 0] + s * tu, corners[i, edge, 1] + s * tv
                for j in range(samples):
                    d = bow + reach[i] * (2 * j / (samples - 1) - 1)
                    grey = bilinear(image, u + d * nu, v + d * nv)
                    out[i, edge, 2 * k // m, j] += 2 * grey / m


def average_profiles(
    image: GreyImage, model: _Model, reach: Array, share: Array, samples: int
) -> Array:
    """Compute ``_average_profiles`` of the reference."""
    corners, curvature, reach = map(make_contiguous, (model.corners, model.curvature, reach))
    out = np.zeros((len(corners), 4, 2, samples))
    edges = np.concatenate(
        [part.reshape(len(out), 4, -1) for part in model.measure_edges()], axis=2
    )
    _average_profiles(make_read_only(image), corners, edges, curvature, reach, share, out)
    return out

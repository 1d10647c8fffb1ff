"""The normal equations of crossing edges, compiled: see ``corner_fit.x_corner_model``.

The pixels of a corner's support are read when they are needed: kept for all the corners of a board
they would take many times the memory of the image. They are taken in blocks that the processor's
first cache holds. What is computed from them stands in rows of one array at distances that the
compiler knows, so that it can prove the loops over a block independent and turn them into vector
instructions. All but the sums is float32.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)
from calibgui.engine.kernels.edge_bands import (
    bound_offsets,
    bound_pixels,
    point_edges,
    read_bands,
)
from calibgui.engine.kernels.edge_intensity import BLOCK, fill_edge

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_Ints = npt.NDArray[np.signedinteger[Any]]
"""Arrays of int32."""
_Single = np.floating[Any]
"""A float32."""
_F = np.float32
_S1, _S2, _D1, _D2, _B1, _B2, _W1, _W2, _E1, _E2, _F1, _F2, _G, _J = (
    BLOCK * row for row in (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 14, 17, 20, 26)
)
"""Where rows begin: along, distance, blur and spread of edges 1 and 2; an edge's value, slope and
derivative by the blur, shrunk by w and grown; G and its derivatives by d_1, d_2, s_1, s_2 and
rho; the columns of the normal equations."""
_COLUMNS = 10
"""Number of columns: nine unknowns and the residual."""
_LIT_COLUMNS = 14
"""Number of columns with those of the light's gradients, gm and ga, after them."""
_ROWS = 26 + _LIT_COLUMNS
"""Number of rows."""
_ZERO, _HALF, _ONE = _F(0), _F(0.5), _F(1)
_MIN_BLUR = _F(0.3)
_ENOUGH_PIXELS = 4096
"""Number of pixels that tell a corner's noise to 2 %."""


class _Support(Protocol):
    """The methods of ``EdgeSupport`` that are used here."""

    def bound_reach(self) -> int: ...


class _Model(Protocol):
    """The fields and methods of ``XCornerModel`` that are used here."""

    @property
    def unknowns(self) -> Array: ...
    @property
    def sign(self) -> Array: ...
    @property
    def square_height(self) -> Array: ...
    @property
    def arm(self) -> Array: ...
    @property
    def curvature(self) -> Array: ...
    @property
    def curvature_change(self) -> Array: ...
    @property
    def ink_spread(self) -> Array: ...
    @property
    def level_gradient(self) -> Array: ...
    @property
    def contrast_gradient(self) -> Array: ...
    @property
    def blur_gradient(self) -> Array: ...
    @property
    def height_gradient(self) -> Array: ...
    def is_sharp(self) -> bool: ...
    def compute_band_widths(self) -> Array: ...
    def find_support(self) -> _Support: ...


@compiled_part
def _fill_geometry(
    w: _Floats,
    u: _Floats,
    v: _Floats,
    t: _Floats,
    n: _Floats,
    kappa: _Floats,
    change: _Floats,
    blur: _Floats,
    size: _Floats,
    growth: _Single,
    m: int,
) -> None:
    """Fill rows S, D, B and W of m pixels at the offsets u, v from the corner.

    blur and size of both edges are value, derivative by u and by v."""
    for p in range(m):
        s1, s2 = t[0] * u[p] + t[1] * v[p], t[2] * u[p] + t[3] * v[p]
        w[_S1 + p], w[_S2 + p] = s1, s2
        w[_D1 + p] = n[0] * u[p] + n[1] * v[p] - (kappa[0] + change[0] * s1) * s1 * s1
        w[_D2 + p] = n[2] * u[p] + n[3] * v[p] - (kappa[1] + change[1] * s2) * s2 * s2
    for p in range(m):
        w[_B1 + p] = max(blur[0] + blur[2] * u[p] + blur[3] * v[p], _MIN_BLUR)
        w[_B2 + p] = max(blur[1] + blur[4] * u[p] + blur[5] * v[p], _MIN_BLUR)
        w[_W1 + p] = growth * (size[0] + size[2] * u[p] + size[3] * v[p])
        w[_W2 + p] = growth * (size[1] + size[4] * u[p] + size[5] * v[p])


@compiled_part
def _fill_crossing(w: _Floats, rho: _Single, box: _Floats, m: int) -> None:
    """Fill rows G as ``compute_crossing``."""
    fill_edge(w[_D1:], _ONE, w[_W1:], _ZERO, w[_B1:], box[0], w[_E1:], m)
    fill_edge(w[_D2:], _ONE, w[_W2:], _ZERO, w[_B2:], box[1], w[_E2:], m)
    half = _HALF * rho * rho
    for p in range(m):
        v1, v2 = w[_E1 + p], w[_E2 + p]
        d1, d2 = w[_E1 + BLOCK + p], w[_E2 + BLOCK + p]
        both = w[_B1 + p] * w[_B2 + p]
        by_rho = both * d1 * d2
        w[_G + p] = v1 * v2 + by_rho * (rho + half * w[_D1 + p] * w[_D2 + p] / both)
        w[_G + BLOCK + p], w[_G + 2 * BLOCK + p] = d1 * v2, v1 * d2
        w[_G + 3 * BLOCK + p] = w[_E1 + 2 * BLOCK + p] * v2
        w[_G + 4 * BLOCK + p] = v1 * w[_E2 + 2 * BLOCK + p]
        w[_G + 5 * BLOCK + p] = by_rho


@compiled_part
def _fill_spread_crossing(w: _Floats, rho: _Single, box: _Floats, mirror: _Single, m: int) -> None:
    """Fill rows G as ``compute_spread_crossing``, for spreads w of the sign of mirror."""
    fill_edge(w[_D1:], _ONE, w[_W1:], -mirror, w[_B1:], box[0], w[_E1:], m)
    fill_edge(w[_D2:], mirror, w[_W2:], -mirror, w[_B2:], box[1], w[_E2:], m)
    fill_edge(w[_D1:], _ONE, w[_W1:], mirror, w[_B1:], box[0], w[_F1:], m)
    fill_edge(w[_D2:], mirror, w[_W2:], mirror, w[_B2:], box[1], w[_F2:], m)
    half = _HALF * mirror
    for p in range(m):
        e1, e2, f1, f2 = w[_E1 + p], w[_E2 + p], w[_F1 + p], w[_F2 + p]
        de1, de2 = w[_E1 + BLOCK + p], w[_E2 + BLOCK + p]
        df1, df2 = w[_F1 + BLOCK + p], w[_F2 + BLOCK + p]
        by_rho = _HALF * w[_B1 + p] * w[_B2 + p] * (de1 * de2 + df1 * df2)
        w[_G + p] = half * (e1 * e2 + f1 * f2 + e1 - f1 + e2 - f2) + rho * by_rho
        w[_G + BLOCK + p] = half * (de1 * (e2 + _ONE) + df1 * (f2 - _ONE))
        w[_G + 2 * BLOCK + p] = _HALF * (de2 * (e1 + _ONE) + df2 * (f1 - _ONE))
        w[_G + 5 * BLOCK + p] = by_rho
    for p in range(m):
        e1, e2, f1, f2 = w[_E1 + p], w[_E2 + p], w[_F1 + p], w[_F2 + p]
        be1, be2 = w[_E1 + 2 * BLOCK + p], w[_E2 + 2 * BLOCK + p]
        bf1, bf2 = w[_F1 + 2 * BLOCK + p], w[_F2 + 2 * BLOCK + p]
        w[_G + 3 * BLOCK + p] = half * (be1 * (e2 + _ONE) + bf1 * (f2 - _ONE))
        w[_G + 4 * BLOCK + p] = half * (be2 * (e1 + _ONE) + bf2 * (f1 - _ONE))


@compiled_part
def _fill_columns(
    w: _Floats,
    u: _Floats,
    v: _Floats,
    grey: _Floats,
    n: _Floats,
    level: _Floats,
    swing: _Floats,
    sign: _Single,
    m: int,
) -> None:
    """Fill rows J: derivatives of the model by the nine unknowns, and the residual.

    level and swing are value, derivative by u and by v."""
    for p in range(m):
        a = sign * (swing[0] + swing[1] * u[p] + swing[2] * v[p])
        g = w[_G + p]
        w[_J + 7 * BLOCK + p] = sign * g
        w[_J + 9 * BLOCK + p] = grey[p] - level[0] - level[1] * u[p] - level[2] * v[p] - a * g
        by1, by2 = a * w[_G + BLOCK + p], a * w[_G + 2 * BLOCK + p]
        w[_J + p] = -by1 * n[0] - by2 * n[2]
        w[_J + BLOCK + p] = -by1 * n[1] - by2 * n[3]
        w[_J + 2 * BLOCK + p] = -by1 * w[_S1 + p]  # t_1 turns n_1 away from itself,
        w[_J + 3 * BLOCK + p] = by2 * w[_S2 + p]  # and n_2 towards it
    for p in range(m):
        a = sign * (swing[0] + swing[1] * u[p] + swing[2] * v[p])
        w[_J + 4 * BLOCK + p] = a * w[_G + 3 * BLOCK + p]
        w[_J + 5 * BLOCK + p] = a * w[_G + 4 * BLOCK + p]
        w[_J + 6 * BLOCK + p] = _ONE
        w[_J + 8 * BLOCK + p] = a * w[_G + 5 * BLOCK + p]


@compiled_part
def _fill_light_columns(w: _Floats, u: _Floats, v: _Floats, m: int) -> None:
    """Fill the last rows J: derivatives by gm and ga."""
    for p in range(m):
        g = w[_J + 7 * BLOCK + p]
        w[_J + 10 * BLOCK + p], w[_J + 11 * BLOCK + p] = u[p], v[p]
        w[_J + 12 * BLOCK + p], w[_J + 13 * BLOCK + p] = u[p] * g, v[p] * g


@compiled_part
def _add_products(w: _Floats, m: int, out: Array) -> None:
    """Add the products of the first rows J, of which there are an even number, to out
    (columns, columns): two rows by two, on its diagonal and below."""
    n = out.shape[0]
    for a in range(0, n, 2):
        p0, p1 = w[_J + a * BLOCK :], w[_J + (a + 1) * BLOCK :]
        for b in range(0, a + 2, 2):
            q0, q1 = w[_J + b * BLOCK :], w[_J + (b + 1) * BLOCK :]
            s00 = s01 = s10 = s11 = _ZERO
            for p in range(m):
                x, y, z, t = p0[p], p1[p], q0[p], q1[p]
                s00 += x * z
                s01 += x * t
                s10 += y * z
                s11 += y * t
            out[a, b] += s00
            out[a, b + 1] += s01
            out[a + 1, b] += s10
            out[a + 1, b + 1] += s11


@compiled_part
def _add_scores(
    w: _Floats,
    offset: _Ints,
    u: _Floats,
    v: _Floats,
    t: _Floats,
    swing: _Floats,
    sign: _Single,
    mu: int,
    mv: int,
    m: int,
    scores: Array,
) -> None:
    """Add to scores (2, 2, k) what m pixels say, as ``accumulate_scores``; the offsets of pixels
    are mirrored to (mu, mv) less them."""
    for edge in range(2):
        flat = abs(t[2 * edge]) >= abs(t[2 * edge + 1])
        x, mirror = (offset[0], mu) if flat else (offset[1], mv)
        by_distance = w[_G + (1 + edge) * BLOCK :]
        for p in range(m):
            line = abs(2 * x[p] - mirror) // 2
            slope = sign * (swing[0] + swing[1] * u[p] + swing[2] * v[p]) * by_distance[p]
            scores[edge, 0, line] += slope * w[_J + 9 * BLOCK + p]
            scores[edge, 1, line] += slope * slope


@compiled_part
def _add_corner(
    offset: _Ints,
    grey: _Floats,
    du: _Single,
    dv: _Single,
    near: _Floats,
    w: _Floats,
    u: _Floats,
    v: _Floats,
    out: Array,
    scores: Array,
) -> None:
    """Add to out (columns, columns) the products of one corner's pixels, or to scores (2, 2, k) if
    that is not empty, and leave in grey the residuals; near (35,) is laid out as `_pack_model`
    says."""
    t, n, kappa = near[0:4], near[4:8], near[8:10]
    blur, size, level, swing = near[10:16], near[16:22], near[22:25], near[25:28]
    rho, sign, growth, box, change = near[28], near[29], near[30], near[31:33], near[33:35]
    for begin in range(0, grey.shape[0], BLOCK):
        m = min(grey.shape[0] - begin, BLOCK)
        for p in range(m):
            u[p], v[p] = offset[0, begin + p] + du, offset[1, begin + p] + dv
        _fill_geometry(w, u, v, t, n, kappa, change, blur, size, growth, m)
        if growth == _ZERO:
            _fill_crossing(w, rho, box, m)
        else:
            _fill_spread_crossing(w, rho, box, _ONE if growth > _ZERO else -_ONE, m)
        _fill_columns(w, u, v, grey[begin:], n, level, swing, sign, m)
        if out.shape[0] > _COLUMNS:
            _fill_light_columns(w, u, v, m)
        _add_products(w, m, out)
        if scores.shape[2]:
            mu, mv = int(np.rint(-2 * du)), int(np.rint(-2 * dv))
            _add_scores(w, offset[:, begin:], u, v, t, swing, sign, mu, mv, m, scores)
        for p in range(m):
            grey[begin + p] = w[_J + 9 * BLOCK + p]
    for a in range(out.shape[0]):
        for b in range(a):
            out[b, a] = out[a, b]


@compiled_part
def _thin_out(offset: _Ints, residual: _Floats, mu: int, mv: int) -> int:
    """Move to the front the pixels on every 2nd, 4th, 8th... diagonal, such that about
    _ENOUGH_PIXELS are left; return their number. With each the one opposite it stays."""
    count, mask = residual.shape[0], 0
    while count > (mask + 1) * _ENOUGH_PIXELS:
        mask = 2 * mask + 1
    if mask == 0:
        return count
    left = 0
    for p in range(count):
        u, v = offset[0, p], offset[1, p]
        offset[0, left], offset[1, left], residual[left] = u, v, residual[p]
        left += (abs(2 * (u + v) - mu - mv) // 2) & mask == 0
    return left


@compiled_part
def _measure_odd_part(
    offset: _Ints, residual: _Floats, mu: int, mv: int, reach: int, square: _Floats, out: Array
) -> None:
    """Fill out (2,) as ``_measure_odd_part`` of the reference for one corner, about which offsets
    of pixels are mirrored to (mu, mv) less them, none by more than `reach`.

    square ((2 reach + 1)^2,) is full of NaN, before and after. What it does not need of offset and
    residual is lost."""
    pixels, side = range(_thin_out(offset, residual, mu, mv)), 2 * reach + 1
    place = offset[0]
    for p in pixels:
        place[p] += reach + (offset[1, p] + reach) * side
        square[np.uintp(place[p])] = residual[p]
    total = pairs = 0.0
    mirror = mu + 2 * reach + (mv + 2 * reach) * side
    for p in pixels:
        # Of a pair the upper pixel is passed over, or the left one.
        if 2 * place[p] > mirror:
            opposite = square[np.uintp(mirror - place[p])]
            if not np.isnan(opposite):
                total += (residual[p] - opposite) ** 2 / 2
                pairs += 1
    out[0], out[1] = total, pairs
    for p in pixels:
        square[np.uintp(place[p])] = np.nan


@compiled
def _accumulate(
    image: GreyImage,
    unknowns: Array,
    bands: Array,
    near: _Floats,
    is_sharp: bool,
    out: Array,
    odd: Array,
    scores: Array,
) -> None:
    """Fill out (n, columns, columns) and, unless they are empty, odd (n, 2) and scores
    (n, 2, 2, k).

    What follows from the directions among the unknowns (n, 9) is filled into bands (n, 2, 7) and
    near (n, 35)."""
    n, frame = unknowns.shape[0], np.empty(8)
    for i in range(n):
        point_edges(unknowns[i], frame)
        for edge in range(2):
            for k in range(2):
                bands[i, edge, k] = frame[2 * edge + k]
                bands[i, edge, 2 + k] = frame[4 + 2 * edge + k]
        for k in range(8):
            near[i, k] = frame[k]
        for k in range(2):
            half = max(abs(frame[4 + 2 * k]), abs(frame[5 + 2 * k])) / 2
            near[i, 31 + k] = half if is_sharp else 0.0
    # The pixel opposite one read may lie one farther away.
    room, reach = bound_pixels(bands), bound_offsets(bands) + 1
    square = np.full((2 * reach + 1) ** 2 if odd.shape[0] else 0, _F(np.nan))
    offset, grey = np.empty((2, room), dtype=np.int32), np.empty(room, dtype=_F)
    w = np.empty(_ROWS * BLOCK, dtype=_F)
    u, v = np.empty(BLOCK, dtype=_F), np.empty(BLOCK, dtype=_F)
    for i in range(n):
        place = unknowns[i, 0:2]
        count = read_bands(image, place, bands[i], offset, grey)
        du, dv = np.rint(place[0]) - place[0], np.rint(place[1]) - place[1]
        pixels = offset[:, :count], grey[:count]
        _add_corner(*pixels, _F(du), _F(dv), near[i], w, u, v, out[i], scores[i])
        if odd.shape[0]:
            mirror = int(np.rint(-2 * du)), int(np.rint(-2 * dv))
            _measure_odd_part(*pixels, *mirror, reach, square, odd[i])


def accumulate_normal_equations(image: GreyImage, model: _Model, odd: bool) -> tuple[Array, Array]:
    """Compute ``accumulate_normal_equations`` of the reference."""
    n, columns = len(model.unknowns), _LIT_COLUMNS if odd else _COLUMNS
    out, odd_part = np.zeros((n, columns, columns)), np.zeros((n if odd else 0, 2))
    _run(image, model, out, odd_part, np.empty((n, 2, 2, 0)))
    return out, odd_part


def accumulate_scores(image: GreyImage, model: _Model) -> Array:
    """Compute ``accumulate_scores`` of the reference."""
    n = len(model.unknowns)
    scores = np.zeros((n, 2, 2, model.find_support().bound_reach() + 1))
    _run(image, model, np.empty((n, 0, 0)), np.empty((0, 2)), scores)
    return scores


def _run(image: GreyImage, model: _Model, out: Array, odd: Array, scores: Array) -> None:
    """Run the kernel."""
    bands = np.empty((len(model.unknowns), 2, 7))
    bands[..., 4], bands[..., 5] = model.curvature, model.arm
    bands[..., 6] = model.compute_band_widths()
    _accumulate(
        make_read_only(image),
        make_contiguous(model.unknowns),
        bands,
        _pack_model(model),
        model.is_sharp(),
        out,
        odd,
        scores,
    )


def _pack_model(model: _Model) -> _Floats:
    """Pack the model at n corners (n, 35).

    In this order: t_1, t_2, n_1, n_2, kappa_1 / 2, kappa_2 / 2; blur and height of edges 1 and 2
    (s_1, s_2, their gradients); m and gm; a and ga; rho, p, growth of the squares (+, +) over the
    height of a square, half widths of the pixel across edges 1 and 2 or 0; kappa_1' / 6 and
    kappa_2' / 6. The directions, and what follows from them, are left to the kernel.
    """
    x, n = model.unknowns, len(model.unknowns)
    near = np.empty((n, 35), dtype=_F)
    near[:, 8:10], near[:, 10:12] = model.curvature / 2, x[:, 4:6]
    near[:, 12:16], near[:, 16:18] = model.blur_gradient.reshape(n, 4), model.square_height
    near[:, 18:22] = model.height_gradient.reshape(n, 4)
    near[:, 22], near[:, 23:25] = x[:, 6], model.level_gradient
    near[:, 25], near[:, 26:28] = x[:, 7], model.contrast_gradient
    near[:, 28], near[:, 29], near[:, 30] = x[:, 8], model.sign, model.sign * model.ink_spread
    near[:, 33:35] = model.curvature_change / 6
    return near

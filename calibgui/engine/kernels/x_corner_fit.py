"""The edge model's normal equations, compiled: ``corners.edges`` over ``corners.pattern``.

The pixels of a corner are taken in blocks that the processor's first cache holds. What is
computed from them stands in rows of one array at distances that the compiler knows, so that it
can prove the loops over a block independent and turn them into vector instructions; for the same
reason the exponential is arithmetic,

    exp(-y) = (exp(-y / 64))^64,

its argument small enough for five terms of the series. All but the sums is float32.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import compiled, factor, substitute
from calibgui.engine.kernels.edge_support import reach, read, room

_F = np.float32
_BLOCK = 256
_S1, _S2, _D1, _D2, _B1, _B2, _W1, _W2, _E1, _E2, _F1, _F2, _G, _J = (
    _BLOCK * row for row in (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 14, 17, 20, 26)
)
"""Where rows begin: along, distance, blur and spread of edges 1 and 2; an edge's value, slope and
derivative by the blur, shrunk by w and grown; G and its derivatives by d_1, d_2, s_1, s_2 and
rho; the columns of the normal equations."""
_COLUMNS = 10
"""Nine unknowns and the residual."""
_ROWS = 26 + _COLUMNS
_ZERO, _HALF, _ONE = _F(0), _F(0.5), _F(1)
_ROOT_HALF = _F(np.sqrt(0.5))
_ROOT_PI = _F(np.sqrt(np.pi))
_ROOT2_PI = _F(np.sqrt(2 / np.pi))
_THIRD = _F(1 / 3)
_SHARPEST = _F(0.3)
_FINEST2 = _F(0.01)
_FAR, _PART = _F(32), _F(1 / 64)
_C2, _C3, _C4, _C5 = _F(1 / 2), _F(1 / 6), _F(1 / 24), _F(1 / 120)
_P, _A1, _A2, _A3, _A4, _A5 = (
    _F(c) for c in (0.3275911, 0.254829592, -0.284496736, 1.421413741, -1.453152027, 1.061405429)
)


@compiled
def _bell(x):  # type: ignore[no-untyped-def]
    """exp(-x^2)."""
    e = min(x * x, _FAR) * _PART
    b = _ONE - e * (_ONE - e * (_C2 - e * (_C3 - e * (_C4 - e * _C5))))
    b *= b
    b *= b
    b *= b
    b *= b
    b *= b
    return b * b


@compiled
def _erf(x, bell):  # type: ignore[no-untyped-def]
    """erf(x), as ``pattern._erf``."""
    t = _ONE / (_ONE + _P * abs(x))
    value = _ONE - t * (_A1 + t * (_A2 + t * (_A3 + t * (_A4 + t * _A5)))) * bell
    return value if x >= _ZERO else -value


@compiled
def _geometry(w, u, v, t, n, kappa, blur, size, growth, m):  # type: ignore[no-untyped-def]
    """Rows S, D, B and W of m pixels at the offsets u, v from the corner.

    blur and size of both edges are value, derivative by u and by v."""
    for p in range(m):
        s1, s2 = t[0] * u[p] + t[1] * v[p], t[2] * u[p] + t[3] * v[p]
        w[_S1 + p], w[_S2 + p] = s1, s2
        w[_D1 + p] = n[0] * u[p] + n[1] * v[p] - kappa[0] * s1 * s1
        w[_D2 + p] = n[2] * u[p] + n[3] * v[p] - kappa[1] * s2 * s2
    for p in range(m):
        w[_B1 + p] = max(blur[0] + blur[2] * u[p] + blur[3] * v[p], _SHARPEST)
        w[_B2 + p] = max(blur[1] + blur[4] * u[p] + blur[5] * v[p], _SHARPEST)
        w[_W1 + p] = growth * (size[0] + size[2] * u[p] + size[3] * v[p])
        w[_W2 + p] = growth * (size[1] + size[4] * u[p] + size[5] * v[p])


@compiled
def _edge(distance, turn, spread, side, blur, box, to, m):  # type: ignore[no-untyped-def]
    """``pattern.edge`` at turn * d + side * w: its value, slope and derivative by the blur."""
    if box == _ZERO:
        for p in range(m):
            s = _ONE / blur[p]
            y = (turn * distance[p] + side * spread[p]) * s
            x = y * _ROOT_HALF
            bell = _bell(x)
            slope = bell * _ROOT2_PI * s
            to[p] = _erf(x, bell)
            to[_BLOCK + p] = slope
            to[2 * _BLOCK + p] = -y * slope
        return
    over = _HALF / box
    for p in range(m):
        s = blur[p]
        d = turn * distance[p] + side * spread[p]
        g = np.sqrt(max(s * s - box * box * _THIRD, _FINEST2))
        narrow = _ROOT_HALF / g
        a, b = (d + box) * narrow, (d - box) * narrow
        bell_a, bell_b = _bell(a), _bell(b)
        erf_a, erf_b = _erf(a, bell_a), _erf(b, bell_b)
        fall = bell_a - bell_b
        to[p] = (a * erf_a - b * erf_b + fall / _ROOT_PI) * (over / narrow)
        to[_BLOCK + p] = (erf_a - erf_b) * over
        to[2 * _BLOCK + p] = fall * (_ROOT2_PI * over * s / g)


@compiled
def _meeting(w, rho, box, m):  # type: ignore[no-untyped-def]
    """Rows G as ``pattern.meeting``."""
    _edge(w[_D1:], _ONE, w[_W1:], _ZERO, w[_B1:], box[0], w[_E1:], m)
    _edge(w[_D2:], _ONE, w[_W2:], _ZERO, w[_B2:], box[1], w[_E2:], m)
    half = _HALF * rho * rho
    for p in range(m):
        v1, v2 = w[_E1 + p], w[_E2 + p]
        d1, d2 = w[_E1 + _BLOCK + p], w[_E2 + _BLOCK + p]
        both = w[_B1 + p] * w[_B2 + p]
        by_rho = both * d1 * d2
        w[_G + p] = v1 * v2 + by_rho * (rho + half * w[_D1 + p] * w[_D2 + p] / both)
        w[_G + _BLOCK + p], w[_G + 2 * _BLOCK + p] = d1 * v2, v1 * d2
        w[_G + 3 * _BLOCK + p] = w[_E1 + 2 * _BLOCK + p] * v2
        w[_G + 4 * _BLOCK + p] = v1 * w[_E2 + 2 * _BLOCK + p]
        w[_G + 5 * _BLOCK + p] = by_rho


@compiled
def _spread(w, rho, box, mirror, m):  # type: ignore[no-untyped-def]
    """Rows G as ``pattern.spread``, for spreads w of the sign of mirror."""
    _edge(w[_D1:], _ONE, w[_W1:], -mirror, w[_B1:], box[0], w[_E1:], m)
    _edge(w[_D2:], mirror, w[_W2:], -mirror, w[_B2:], box[1], w[_E2:], m)
    _edge(w[_D1:], _ONE, w[_W1:], mirror, w[_B1:], box[0], w[_F1:], m)
    _edge(w[_D2:], mirror, w[_W2:], mirror, w[_B2:], box[1], w[_F2:], m)
    half = _HALF * mirror
    for p in range(m):
        e1, e2, f1, f2 = w[_E1 + p], w[_E2 + p], w[_F1 + p], w[_F2 + p]
        de1, de2 = w[_E1 + _BLOCK + p], w[_E2 + _BLOCK + p]
        df1, df2 = w[_F1 + _BLOCK + p], w[_F2 + _BLOCK + p]
        by_rho = _HALF * w[_B1 + p] * w[_B2 + p] * (de1 * de2 + df1 * df2)
        w[_G + p] = half * (e1 * e2 + f1 * f2 + e1 - f1 + e2 - f2) + rho * by_rho
        w[_G + _BLOCK + p] = half * (de1 * (e2 + _ONE) + df1 * (f2 - _ONE))
        w[_G + 2 * _BLOCK + p] = _HALF * (de2 * (e1 + _ONE) + df2 * (f1 - _ONE))
        w[_G + 5 * _BLOCK + p] = by_rho
    for p in range(m):
        e1, e2, f1, f2 = w[_E1 + p], w[_E2 + p], w[_F1 + p], w[_F2 + p]
        be1, be2 = w[_E1 + 2 * _BLOCK + p], w[_E2 + 2 * _BLOCK + p]
        bf1, bf2 = w[_F1 + 2 * _BLOCK + p], w[_F2 + 2 * _BLOCK + p]
        w[_G + 3 * _BLOCK + p] = half * (be1 * (e2 + _ONE) + bf1 * (f2 - _ONE))
        w[_G + 4 * _BLOCK + p] = half * (be2 * (e1 + _ONE) + bf2 * (f1 - _ONE))


@compiled
def _columns(w, u, v, grey, n, level, swing, sign, m):  # type: ignore[no-untyped-def]
    """Rows J: derivatives of the model by the nine unknowns, and the residual.

    level and swing are value, derivative by u and by v."""
    for p in range(m):
        a = sign * (swing[0] + swing[1] * u[p] + swing[2] * v[p])
        g = w[_G + p]
        w[_J + 7 * _BLOCK + p] = sign * g
        w[_J + 9 * _BLOCK + p] = grey[p] - level[0] - level[1] * u[p] - level[2] * v[p] - a * g
        by1, by2 = a * w[_G + _BLOCK + p], a * w[_G + 2 * _BLOCK + p]
        w[_J + p] = -by1 * n[0] - by2 * n[2]
        w[_J + _BLOCK + p] = -by1 * n[1] - by2 * n[3]
        w[_J + 2 * _BLOCK + p] = -by1 * w[_S1 + p]  # t_1 turns n_1 away from itself,
        w[_J + 3 * _BLOCK + p] = by2 * w[_S2 + p]  # and n_2 towards it
    for p in range(m):
        a = sign * (swing[0] + swing[1] * u[p] + swing[2] * v[p])
        w[_J + 4 * _BLOCK + p] = a * w[_G + 3 * _BLOCK + p]
        w[_J + 5 * _BLOCK + p] = a * w[_G + 4 * _BLOCK + p]
        w[_J + 6 * _BLOCK + p] = _ONE
        w[_J + 8 * _BLOCK + p] = a * w[_G + 5 * _BLOCK + p]


@compiled
def _add_products(w, m, out):  # type: ignore[no-untyped-def]
    """Add the products of the rows J to the lower triangle of out (10, 10)."""
    for a in range(_COLUMNS):
        one = w[_J + a * _BLOCK : _J + (a + 1) * _BLOCK]
        for b in range(a + 1):
            other = w[_J + b * _BLOCK : _J + (b + 1) * _BLOCK]
            total = _ZERO
            for p in range(m):
                total += one[p] * other[p]
            out[a, b] += total


@compiled
def _fitted(offset, grey, du, dv, near, w, u, v, out):  # type: ignore[no-untyped-def]
    """Add to out (10, 10) what the pixels of one corner tell, and leave in grey the residuals;
    near (33,) is laid out as `products` says."""
    t, n, kappa = near[0:4], near[4:8], near[8:10]
    blur, size, level, swing = near[10:16], near[16:22], near[22:25], near[25:28]
    rho, sign, growth, box = near[28], near[29], near[30], near[31:33]
    for begin in range(0, grey.shape[0], _BLOCK):
        m = min(grey.shape[0] - begin, _BLOCK)
        for p in range(m):
            u[p], v[p] = offset[0, begin + p] + du, offset[1, begin + p] + dv
        _geometry(w, u, v, t, n, kappa, blur, size, growth, m)
        if growth == _ZERO:
            _meeting(w, rho, box, m)
        else:
            _spread(w, rho, box, _ONE if growth > _ZERO else -_ONE, m)
        _columns(w, u, v, grey[begin:], n, level, swing, sign, m)
        _add_products(w, m, out)
        for p in range(m):
            grey[begin + p] = w[_J + 9 * _BLOCK + p]
    for a in range(_COLUMNS):
        for b in range(a):
            out[b, a] = out[a, b]


@compiled
def _odd(offset, residual, mu, mv, square, out):  # type: ignore[no-untyped-def]
    """Fill out (2,) as ``edge_model._odd_part`` for one corner, about whose pixel offsets are
    mirrored to (mu, mv) less them; square (side, side) is full of NaN, and is again after."""
    reach, pixels = square.shape[0] // 2, range(residual.shape[0])
    for p in pixels:
        square[offset[1, p] + reach, offset[0, p] + reach] = residual[p]
    for p in pixels:
        u, v = offset[0, p], offset[1, p]
        if max(abs(mu - u), abs(mv - v)) > reach or (2 * u == mu and 2 * v == mv):
            continue
        opposite = square[mv - v + reach, mu - u + reach]
        if not np.isnan(opposite):
            out[0] += (residual[p] - opposite) ** 2 / 4
            out[1] += 0.5
    for p in pixels:
        square[offset[1, p] + reach, offset[0, p] + reach] = np.nan


@compiled
def _products(image, uv, bands, room, centre, near, square, out, odd):  # type: ignore[no-untyped-def]
    """Fill out (n, 10, 10) and, unless it is empty, odd (n, 2)."""
    offset, grey = np.empty((2, room), dtype=np.int32), np.empty(room, dtype=_F)
    w = np.empty(_ROWS * _BLOCK, dtype=_F)
    u, v = np.empty(_BLOCK, dtype=_F), np.empty(_BLOCK, dtype=_F)
    for i in range(uv.shape[0]):
        count = read(image, uv[i], bands[i], offset, grey)
        du, dv = np.rint(uv[i, 0]) - centre[i, 0], np.rint(uv[i, 1]) - centre[i, 1]
        its = offset[:, :count], grey[:count]
        _fitted(*its, _F(du), _F(dv), near[i], w, u, v, out[i])
        if odd.shape[0]:
            _odd(*its, int(np.rint(-2 * du)), int(np.rint(-2 * dv)), square, odd[i])


def products(
    image: GreyImage, uv: Array, bands: Array, centre: Array, near: Array, odd: bool
) -> tuple[Array, Array]:
    """``edge_model.normal_equations`` of n corners.

    Args:
        image: (h, w) grey levels.
        uv, bands: (n, 2) and (n, 2, 7) the pixels to read, see ``bands.read``.
        centre: (n, 2) the corners, px.
        near: (n, 33) t_1, t_2, n_1, n_2, kappa_1 / 2, kappa_2 / 2; blur and size of edges 1 and 2
            (s_1, s_2, their gradients); m and gm; a and ga; rho, p, growth of the squares (+, +)
            over the size of a square, half widths of the pixel across edges 1 and 2 or 0.
        odd: whether the odd part is wanted; else there is none.
    """
    n, side = len(centre), 2 * reach(bands) + 1 if odd else 0
    out, odd_part = np.zeros((n, _COLUMNS, _COLUMNS)), np.zeros((n if odd else 0, 2))
    square = np.full((side, side), np.nan, dtype=_F)
    _products(image, uv, bands, room(bands), centre, near.astype(_F), square, out, odd_part)
    return out, odd_part


@compiled
def _solved(N, damping, step, inverse):  # type: ignore[no-untyped-def]
    L, unit = np.empty(N.shape[1:]), np.empty(N.shape[1])
    for n in range(N.shape[0]):
        L[:] = N[n]
        largest = 1e-300
        for k in range(L.shape[0]):
            largest = max(largest, L[k, k])
        for k in range(L.shape[0]):
            L[k, k] += damping * largest
        factor(L)
        substitute(L, step[n])
        for axis in range(2):
            unit[:] = 0
            unit[axis] = 1
            substitute(L, unit)
            inverse[n, axis] = unit[:2]


def solved(N: Array, g: Array, damping: float) -> tuple[Array, Array]:
    """``edges._solved``: N^-1 g (n, 9) and the first two rows and columns (n, 2, 2) of N^-1, for
    N (n, 9, 9), to whose diagonal `damping` times its largest entry is added."""
    step, inverse = np.array(g, order="C"), np.empty((len(N), 2, 2))
    _solved(np.ascontiguousarray(N), damping, step, inverse)
    return step, inverse

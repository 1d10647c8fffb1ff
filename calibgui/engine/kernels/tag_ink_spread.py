"""The sums of the fit of tags by their cells, compiled: see ``apriltags.tag_ink_spread``.

A tag is taken a few rows of its places at a time, as many as the processor's first cache holds with
all of their terms. These are float32, all but the sums over such blocks.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.kernels.common import (
    add_products,
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)
from calibgui.engine.kernels.edge_intensity import BLOCK

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_SHIFT_TERMS, _OWN_TERMS = 16, 26
"""Numbers of terms where all edges are shifted alike, and where each corner moves by itself."""
_SEEN = np.array([(0, 0, 0), (1, 0, 0), (0, 0, 2), (0, 2, 0), (0, 0, 1), (0, 1, 0)])
"""(6, 3) what is seen of the paper: under the blur of edges (0) or halos (1), and how often it is
differentiated by y, and by x."""
_FAR = 6.5
"""Distance from an edge, blurs, at which nothing of it is left in a float32."""
_ROOT_HALF, _ROOT_2PI = math.sqrt(0.5), math.sqrt(2 * math.pi)
_F = np.float32
_ONE, _NO, _HALF = _F(1), _F(0), _F(0.5)


@compiled_part
def _fill_shares(x: Array, side: int, s: float, out: _Floats) -> None:
    """Fill out (3, side + 2, m) with the shares of the cells at places x (m,), and their first and
    second derivatives, under a blur of s sides."""
    for p in range(len(x)):
        before = by_x = by_x2 = 0.0
        for j in range(side + 2):
            z = (j / side - x[p]) / s
            if j > side or z > _FAR:
                after, density = 1.0, 0.0
            elif z < -_FAR:
                after, density = 0.0, 0.0
            else:
                after = 0.5 * math.erfc(-z * _ROOT_HALF)
                density = math.exp(-z * z / 2) / (_ROOT_2PI * s)
            turn = z * density / s
            out[0, j, p], out[1, j, p], out[2, j, p] = after - before, by_x - density, by_x2 - turn
            before, by_x, by_x2 = after, density, turn


@compiled_part
def _see_row(
    in_y: _Floats, row: int, dark: BoolArray, in_x: _Floats, weight: _Floats, out: _Floats
) -> None:
    """Fill out (m,) with the paper of a tag that is seen along a row of places, given shares in y
    and x (side + 2, m)."""
    count, m = in_x.shape
    for j in range(count):
        weight[j] = _NO
    for i in range(count):
        part = in_y[i, row]
        if part == _NO:
            continue
        for j in range(count):
            is_inside = 0 < i < count - 1 and 0 < j < count - 1
            if not (is_inside and dark[i - 1, j - 1]):
                weight[j] += part
    for p in range(m):
        out[p] = _NO
    for j in range(count):
        part = weight[j]
        if part != _NO:
            for p in range(m):
                out[p] += part * in_x[j, p]


@compiled_part
def _sample_row(
    image: GreyImage, H: Array, bends: Array, weights: Array, x: Array, row: int, w: _Floats
) -> None:
    """Fill w (m,) with the grey levels along a row of places, less that in the middle of the tag's
    upper left corner: the terms of paper and ink take up what is constant."""
    y = x[row]
    base = bilinear(image, H[0, 2] / H[2, 2], H[1, 2] / H[2, 2])
    u0 = u1 = u2 = u3 = v0 = v1 = v2 = v3 = 0.0
    for a in range(4):
        part = weights[row, a]
        u0 += part * bends[4 * a, 0]
        u1 += part * bends[4 * a + 1, 0]
        u2 += part * bends[4 * a + 2, 0]
        u3 += part * bends[4 * a + 3, 0]
        v0 += part * bends[4 * a, 1]
        v1 += part * bends[4 * a + 1, 1]
        v2 += part * bends[4 * a + 2, 1]
        v3 += part * bends[4 * a + 3, 1]
    for p in range(len(x)):
        a0, a1, a2, a3 = weights[p, 0], weights[p, 1], weights[p, 2], weights[p, 3]
        z = H[2, 0] * x[p] + H[2, 1] * y + H[2, 2]
        u = (H[0, 0] * x[p] + H[0, 1] * y + H[0, 2]) / z
        v = (H[1, 0] * x[p] + H[1, 1] * y + H[1, 2]) / z
        u += a0 * u0 + a1 * u1 + a2 * u2 + a3 * u3
        v += a0 * v0 + a1 * v1 + a2 * v2 + a3 * v3
        w[p] = bilinear(image, u, v) - base


@compiled_part
def _fill_terms(seen: _Floats, x: Array, y: float, w: _Floats, at: int) -> None:
    """Fill in the first 12 terms along a row of places, w[at] and following, and the last four of
    edges that are shifted alike."""
    b, m = BLOCK, len(x)
    down = _F(y - 0.5)
    for p in range(m):
        k, paper = at + p, seen[0, p]
        ink, right = _ONE - paper, _F(x[p]) - _HALF
        w[k], w[k + b], w[k + 2 * b] = paper, ink, paper * ink
        w[k + 3 * b], w[k + 4 * b] = right * paper, down * paper
        w[k + 5 * b], w[k + 6 * b] = right * right * paper, down * down * paper
        w[k + 7 * b], w[k + 8 * b] = right * ink, down * ink
    for p in range(m):
        k, right, by_x, by_y = at + p, _F(x[p]) - _HALF, seen[4, p], seen[5, p]
        w[k + 9 * b], w[k + 10 * b], w[k + 11 * b] = seen[1, p], seen[2, p], seen[3, p]
        w[k + 12 * b], w[k + 13 * b] = -by_x, -by_y
        w[k + 14 * b], w[k + 15 * b] = -right * by_x, -down * by_y


@compiled_part
def _fill_own_terms(seen: _Floats, x: Array, y: float, w: _Floats, at: int) -> None:
    """Fill in the terms from the 13th on, of corners that move by themselves, along a row."""
    b, m = BLOCK, len(x)
    down = _F(y - 0.5)
    for p in range(m):
        k, paper = at + p, seen[0, p]
        ink, right = _ONE - paper, _F(x[p]) - _HALF
        curve = paper * ink
        w[k + 12 * b], w[k + 13 * b], w[k + 14 * b] = (
            right * curve,
            down * curve,
            right * down * paper,
        )
        w[k + 15 * b], w[k + 16 * b] = right * right * ink, down * down * ink
        w[k + 17 * b] = right * down * ink
    for p in range(m):
        k, right, by_x, by_y = at + p, _F(x[p]) - _HALF, seen[4, p], seen[5, p]
        near = (_HALF - right) * (_HALF - down)
        w[k + 18 * b], w[k + 22 * b] = -near * by_x, -near * by_y
        near = (_HALF + right) * (_HALF - down)
        w[k + 19 * b], w[k + 23 * b] = -near * by_x, -near * by_y
        near = (_HALF + right) * (_HALF + down)
        w[k + 20 * b], w[k + 24 * b] = -near * by_x, -near * by_y
        near = (_HALF - right) * (_HALF + down)
        w[k + 21 * b], w[k + 25 * b] = -near * by_x, -near * by_y


@compiled
def _accumulate(
    image: GreyImage,
    H: Array,
    bends: Array,
    weights: Array,
    dark: BoolArray,
    x: Array,
    blur: Array,
    wide: Array,
    out: Array,
) -> None:
    """Add to out (n, terms + 1, terms + 1)."""
    m, side, terms = len(x), dark.shape[1], out.shape[1] - 1
    shares = np.empty((2, 2, 3, side + 2, m), dtype=_F)  # along x and y, under both blurs
    seen, weight = np.empty((len(_SEEN), m), dtype=_F), np.empty(side + 2, dtype=_F)
    w, columns = np.empty((terms + 1) * BLOCK, dtype=_F), np.arange(terms + 1)
    for i in range(len(H)):
        for axis in range(2):
            for which in range(2):
                s = wide[i, axis] if which else blur[i, axis]
                _fill_shares(x, side, s, shares[axis, which])
        at = 0
        for row in range(m):
            for k in range(len(_SEEN)):
                which, by_y, by_x = _SEEN[k]
                in_x, in_y = shares[0, which, by_x], shares[1, which, by_y]
                _see_row(in_y, row, dark[i], in_x, weight, seen[k])
            _fill_terms(seen, x, x[row], w, at)
            if terms == _OWN_TERMS:
                _fill_own_terms(seen, x, x[row], w, at)
            _sample_row(image, H[i], bends[i], weights, x, row, w[terms * BLOCK + at :])
            at += m
            if at + m > BLOCK or row == m - 1:
                add_products(w, BLOCK, columns, terms + 1, at, out[i])
                at = 0
        for a in range(terms + 1):
            for b in range(a):
                out[i, b, a] = out[i, a, b]


def sum_products(
    image: GreyImage,
    H: Array,
    bends: Array,
    weights: Array,
    dark: BoolArray,
    x: Array,
    blur: Array,
    wide: Array,
    is_shift: bool,
) -> Array:
    """Compute ``_sum_products`` of the reference."""
    terms = _SHIFT_TERMS if is_shift else _OWN_TERMS
    out = np.zeros((len(H), terms + 1, terms + 1))
    H, bends, weights, x, blur, wide = map(make_contiguous, (H, bends, weights, x, blur, wide))
    dark = np.ascontiguousarray(dark)
    _accumulate(make_read_only(image), H, bends, weights, dark, x, blur, wide, out)
    return out

"""The grey level near a blurred edge, compiled: see ``features.edge_intensity``.

Pixels are taken in blocks that the processor's first cache holds, row after row of one array, so
that loops over a block become vector instructions. For the same reason the exponential is
arithmetic,

    exp(-y) = (exp(-y / 64))^64,

its argument small enough for five terms of the series.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine.kernels.common import compiled_part

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_Single = np.floating[Any]
"""A float32."""
_F = np.float32
BLOCK = 256
"""Number of pixels taken at once."""
_ZERO, _HALF, _ONE = _F(0), _F(0.5), _F(1)
_ROOT_HALF = _F(np.sqrt(0.5))
_ROOT_PI = _F(np.sqrt(np.pi))
_ROOT2_PI = _F(np.sqrt(2 / np.pi))
_THIRD = _F(1 / 3)
_MIN_GAUSSIAN2 = _F(0.01)
_FAR, _PART = _F(32), _F(1 / 64)
_C2, _C3, _C4, _C5 = _F(1 / 2), _F(1 / 6), _F(1 / 24), _F(1 / 120)
_P, _A1, _A2, _A3, _A4, _A5 = (
    _F(c) for c in (0.3275911, 0.254829592, -0.284496736, 1.421413741, -1.453152027, 1.061405429)
)


@compiled_part
def _bell(x: _Single) -> _Single:
    """Compute exp(-x^2)."""
    e = min(x * x, _FAR) * _PART
    b = _ONE - e * (_ONE - e * (_C2 - e * (_C3 - e * (_C4 - e * _C5))))
    b *= b
    b *= b
    b *= b
    b *= b
    b *= b
    return b * b


@compiled_part
def _erf(x: _Single, bell: _Single) -> _Single:
    """Compute erf(x), given exp(-x^2), as ``edge_intensity``."""
    t = _ONE / (_ONE + _P * abs(x))
    value = _ONE - t * (_A1 + t * (_A2 + t * (_A3 + t * (_A4 + t * _A5)))) * bell
    return value if x >= _ZERO else -value


@compiled_part
def fill_edge(
    distance: _Floats,
    turn: _Single,
    spread: _Floats,
    side: _Single,
    blur: _Floats,
    box: _Single,
    to: _Floats,
    m: int,
) -> None:
    """Fill in ``compute_edge`` at turn * d + side * w: value, slope and derivative by the blur."""
    if box == _ZERO:
        for p in range(m):
            s = _ONE / blur[p]
            y = (turn * distance[p] + side * spread[p]) * s
            x = y * _ROOT_HALF
            bell = _bell(x)
            slope = bell * _ROOT2_PI * s
            to[p] = _erf(x, bell)
            to[BLOCK + p] = slope
            to[2 * BLOCK + p] = -y * slope
        return
    over = _HALF / box
    for p in range(m):
        s = blur[p]
        d = turn * distance[p] + side * spread[p]
        g = np.sqrt(max(s * s - box * box * _THIRD, _MIN_GAUSSIAN2))
        narrow = _ROOT_HALF / g
        a, b = (d + box) * narrow, (d - box) * narrow
        bell_a, bell_b = _bell(a), _bell(b)
        erf_a, erf_b = _erf(a, bell_a), _erf(b, bell_b)
        fall = bell_a - bell_b
        to[p] = (a * erf_a - b * erf_b + fall / _ROOT_PI) * (over / narrow)
        to[BLOCK + p] = (erf_a - erf_b) * over
        to[2 * BLOCK + p] = fall * (_ROOT2_PI * over * s / g)

"""Arrows as one line, which is quick to draw."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array


def trace_arrows(at: Array, vector: Array) -> Array:
    """Arrows centred at (n, 2) along (n, 2) as one polyline, broken by NaN."""
    start, tip = at - vector / 2, at + vector / 2
    side = np.stack([-vector[:, 1], vector[:, 0]], axis=1)
    barbs = [tip - 0.3 * vector + sign * 0.18 * side for sign in (1, -1)]
    gap = np.full_like(at, np.nan)
    return np.stack([start, tip, barbs[0], gap, tip, barbs[1], gap], axis=1).reshape(-1, 2)

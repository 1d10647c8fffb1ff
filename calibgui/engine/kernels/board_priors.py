"""The choice of polynomials over a board, compiled: see ``corner_fit.board_priors``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import compiled, make_contiguous


@compiled
def _choose_degrees(
    values: Array,
    weights: Array,
    counts: IntArray,
    term_cost: float,
    degrees: IntArray,
    misfit: Array,
) -> None:
    """Fill degrees (k,) and misfit (k,)."""
    n = values.shape[0]
    for k in range(values.shape[1]):
        rss, begin, least = 0.0, 0, 0.0
        for i in range(n):
            rss += values[i, k] * values[i, k]
        for degree in range(counts.shape[0]):
            count = counts[degree]
            for term in range(begin, count):
                rss -= weights[term, k] * weights[term, k]
            begin = count
            score = max(rss, 0.0) / (1 - term_cost * count / (n + 1)) ** 2
            if degree == 0 or score < least:
                degrees[k], least = degree, score
        misfit[k] = np.sqrt(least / n)


def choose_degrees(
    values: Array, weights: Array, counts: IntArray, term_cost: float
) -> tuple[IntArray, Array]:
    """Compute ``_choose_degrees`` of the reference."""
    degrees, misfit = np.empty(values.shape[1], np.int64), np.empty(values.shape[1])
    values, weights = make_contiguous(values), make_contiguous(weights)
    _choose_degrees(values, weights, counts, term_cost, degrees, misfit)
    return degrees, misfit

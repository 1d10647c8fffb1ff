"""Views of two kinds: photographs of two cameras, of two zoom settings, or of two boards.

The views of each kind agree among themselves. If every view k has a camera of its own, apart from
the common one by c_k (fx, fy, cx, cy), or a board of its own, apart by c_k (unequal sides, shear),
one Gauss-Newton step lowers the squared residuals by

    T_K = sum_k b_k^T N_k^-1 b_k,

N_k and b_k being the products of these columns with themselves and with the residuals after the
view's pose is eliminated (``calibration/score_tests.py``). If the views share one c, they are
lowered by T_1, and if those of two kinds share one each by

    T_2 = max sum_g (sum_k b_k)^T (sum_k N_k)^-1 (sum_k b_k),      k in g,

over the ways to part the views in two, which is sought as in the method of k-means (Lloyd 1982):
every view goes to the kind whose c explains it better. Two kinds make T_2 - T_1 most of T_K - T_1.
Causes that differ from view to view, such as a rolling shutter or a board that bends, do not. Nor
does a focus that changes all the time: where focal lengths explain nearly as much as cameras do,
these alone are parted.

Of K numbers of one normal distribution two kinds make 2 / pi on average of many, and more of few:
in 95 of 100 cases less than 2 / pi + 0.72 / sqrt(K) (simulated for 5 to 100 numbers). Beyond that
two kinds are certain.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.assessment.systematic_errors import (
    ViewProducts,
    explain_by_bending,
    explain_by_rows,
    multiply_by_board,
    multiply_by_camera,
    multiply_by_focus,
)
from calibgui.engine.calibration.score_tests import LinearisedFit

_MAX_FALSE_ALARM_RATE = 1e-3
"""Probability under noise that any way to part the views explains as much."""
_MAX_STEPS = 50
"""Number of times that views change their kind, at most."""
_MIN_PART = 0.65
"""Part of what a camera or board of each view's own explains, from which there may be two kinds."""
_SPREAD_OF_PART = 0.72
"""Excess of the part that two kinds explain by chance, times the root of the number of views."""
_MIN_FOCUS = 0.85
"""Part of what cameras explain, from which focal lengths alone are parted."""
_MIN_PART_OF_MOTION = 0.6
"""Part of what motions and bending of the views' own explain, with their many unknowns, from which
two kinds are the cause."""


class Split(NamedTuple):
    """The views parted in two kinds."""

    is_odd: BoolArray
    """(K,) true for the views of the kind with fewer views."""
    part: float
    """Part of what a camera or board of each view's own explains, that two kinds explain."""
    share: float
    """Share of the squared residuals that two kinds explain; 0 if noise explains as much."""
    share_of_all: float
    """Share that a camera or board of each view's own explains."""

    @property
    def is_certain(self) -> bool:
        """True if views that all differ would hardly look like two kinds."""
        return bool(self.part > 2 / np.pi + _SPREAD_OF_PART / np.sqrt(len(self.is_odd)))


def find_two_kinds(fit: LinearisedFit) -> Split | None:
    """Find out whether the views may be of two kinds; return None if not."""
    camera, board, focus = (
        split_views(multiply(fit))
        for multiply in (multiply_by_camera, multiply_by_board, multiply_by_focus)
    )
    if focus.share_of_all >= _MIN_FOCUS * camera.share_of_all:
        return focus if focus.share > 0 and focus.is_certain else None
    split = max(camera, board, key=lambda split: split.share)
    motion = max(explain_by_rows(fit).share, explain_by_bending(fit).share)
    if split.share > 0 and split.share >= _MIN_PART_OF_MOTION * motion and split.part >= _MIN_PART:
        return split
    return None


def split_views(products: ViewProducts) -> Split:
    """Part the views in the two kinds that explain most.

    Args:
        products: the products of each view's own columns.
    """
    N, b = products.N, products.b
    K, m = b.shape
    common = _explain(N.sum(axis=0), b.sum(axis=0))
    whole = sum(_explain(N[k], b[k]) for k in range(K)) - common
    best, odd = 0.0, np.zeros(K, dtype=bool)
    for k in range(K):
        gain, found = _seek_split(N, b, k)
        if gain - common > best:
            best, odd = gain - common, found
    if odd.sum() > K / 2:
        odd = ~odd
    rest = products.freedom - K * m
    if rest < 1 or not whole > 0:
        return Split(odd, 0.0, 0.0, 0.0)
    variance = max(products.cost - whole - common, 0.0) / rest
    # Any of 2^(K - 1) ways to part the views may look like two kinds by chance.
    needed = scipy.special.chdtri(m, _MAX_FALSE_ALARM_RATE / 2.0 ** (K - 1)) * variance
    share = (best - needed) / products.cost if best > needed else 0.0
    return Split(odd, best / whole, share, max(whole - K * m * variance, 0.0) / products.cost)


def _seek_split(N: Array, b: Array, seed: int) -> tuple[float, BoolArray]:
    """Part the views in two, beginning with one by itself; return T_2 and the views of its kind."""
    odd = np.arange(len(b)) == seed
    for _ in range(_MAX_STEPS):
        gains = []
        for kind in (odd, ~odd):
            c = np.linalg.pinv(N[kind].sum(axis=0), hermitian=True) @ b[kind].sum(axis=0)
            gains.append(2 * b @ c - np.einsum("p,kpq,q->k", c, N, c))
        now = gains[0] > gains[1]
        if (now == odd).all() or now.all() or not now.any():
            break
        odd = now
    total = sum(_explain(N[kind].sum(axis=0), b[kind].sum(axis=0)) for kind in (odd, ~odd))
    return total, odd


def _explain(N: Array, b: Array) -> float:
    """Return b^T N^+ b."""
    return float(b @ np.linalg.pinv(N, hermitian=True) @ b)

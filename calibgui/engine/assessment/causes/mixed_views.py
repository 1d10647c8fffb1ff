"""Views of two kinds: photographs of two cameras, of two zoom settings, or of two boards.

The views of each kind agree among themselves. Let every view k have a camera of its own, apart from
the common one by c_k (fx, fy, cx, cy, radial distortion), or a board of its own, apart by c_k
(unequal sides, shear), beside a step dc that the common camera takes. One Gauss-Newton step then
lowers the squared residuals by

    T_K = max 2 b^T x - x^T N x,      x = (dc, c_1 .. c_K),

N and b being the products of these columns with themselves and with the residuals after the views'
poses are eliminated (``calibration/score_tests.py``). If the views share one c, it is T_1; and T_2
is the most that two kinds with one c each explain. The way to part the views is sought as in the
method of k-means (Lloyd 1982): every view goes to the kind whose c explains it better. Two kinds
make T_2 - T_1 most of T_K - T_1. Causes that differ from view to view, such as a rolling shutter or
a board that bends, do not. Nor does a focus that changes all the time: where focal lengths explain
nearly as much as cameras do, these alone are parted. So are distortions, if they are certain: some
photographs may have been corrected by a phone or a program.

Of K numbers of one normal distribution two kinds make 2 / pi on average of many, and more of few:
in 99 of 100 cases less than 2 / pi + 0.86 / sqrt(K) (simulated for 6 to 100 numbers). Beyond that
two kinds are certain.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.assessment.residuals.cause_fits import (
    MIN_EIGENVALUE,
    fit_nothing,
    fit_own_cause,
)
from calibgui.engine.assessment.residuals.systematic_errors import (
    ViewProducts,
    make_bending_columns,
    make_row_columns,
    multiply_by_board,
    multiply_by_camera,
    multiply_by_distortion,
    multiply_by_focus,
)
from calibgui.engine.calibration.score_tests import LinearisedFit

DISTORTION = "lens distortion"
"""Name of the difference of two kinds of views of which a camera or a program corrected one."""
_MAX_FALSE_ALARM_RATE = 1e-3
"""Probability under noise that any way to part the views explains as much."""
_MAX_STEPS = 50
"""Number of times that views change their kind, at most."""
MAX_SEEDS = 64
"""Number of views that a search among all begins with, at most: its time is their number times all.
"""
_SPREAD_OF_PART = 0.86
"""Excess of the part that two kinds explain by chance, times the root of the number of views."""
_MIN_PART_OF_CAMERA = 0.85
"""Part of what cameras explain, from which focal lengths or distortions alone are parted.
Without it a changed zoom went unnamed (``tests/faults``)."""
_MIN_PART_OF_MOTION = 0.6
"""Part of what motions and bending of the views' own explain, with their many unknowns, from which
two kinds are the cause."""


class Split(NamedTuple):
    """The views parted in two kinds."""

    is_odd: BoolArray
    """(K,) true for the views of the kind with fewer views; of halves, that without the first."""
    part: float
    """Part of what a camera or board of each view's own explains, that two kinds explain."""
    share: float
    """Share of the squared residuals that two kinds explain; 0 if noise explains as much."""
    share_of_all: float
    """Share that a camera or board of each view's own explains."""
    what: str = "camera or board"
    """The part of the set-up that differs between the two kinds, as far as the evidence tells."""

    @property
    def is_certain(self) -> bool:
        """True if views that all differ would hardly look like two kinds."""
        return bool(self.part > 2 / np.pi + _SPREAD_OF_PART / np.sqrt(len(self.is_odd)))


def find_two_kinds(fit: LinearisedFit) -> Split | None:
    """Find out whether the views are certainly of two kinds; return None if not."""
    focus = split_views(multiply_by_focus(fit))._replace(what="focal length")
    distortion = split_views(multiply_by_distortion(fit))._replace(what=DISTORTION)
    camera = split_views(multiply_by_camera(fit))._replace(what="camera")
    board = split_views(multiply_by_board(fit))._replace(what="board")
    if focus.share_of_all >= _MIN_PART_OF_CAMERA * camera.share_of_all:
        return focus if focus.share > 0 and focus.is_certain else None
    least = _MIN_PART_OF_CAMERA * camera.share_of_all
    if distortion.is_certain and distortion.share_of_all >= least:
        camera = distortion
    split = max(camera, board, key=lambda split: (split.is_certain, split.share))
    if camera.is_certain == board.is_certain:
        split = split._replace(what="camera or board")
    without = fit_nothing(fit)
    motion = max(
        fit_own_cause(fit, columns).judge(without, fit.degrees_of_freedom).share
        for columns in (make_row_columns, make_bending_columns)
    )
    is_cause = split.share > 0 and split.is_certain
    return split if is_cause and split.share >= _MIN_PART_OF_MOTION * motion else None


def split_views(products: ViewProducts) -> Split:
    """Part the views in the two kinds that explain most.

    Args:
        products: the products of each view's own columns.
    """
    K, m = products.b.shape
    common = _explain_groups(products, np.zeros(K, dtype=np.intp))[0]
    whole = _explain_each(products) - common
    best, odd = 0.0, np.zeros(K, dtype=bool)
    for k in _choose_seeds(products):
        gain, found = _seek_split(products, k)
        if gain - common > best:
            best, odd = gain - common, found
    if 2 * odd.sum() > K or (2 * odd.sum() == K and odd[0]):
        odd = ~odd
    rest = products.freedom - K * m
    if rest < 1 or not whole > 0:
        return Split(odd, 0.0, 0.0, 0.0)
    variance = max(products.cost - whole - common, 0.0) / rest
    # Any of 2^(K - 1) ways to part the views may look like two kinds by chance.
    needed = scipy.special.chdtri(m, _MAX_FALSE_ALARM_RATE / 2.0 ** (K - 1)) * variance
    share = (best - needed) / products.cost if best > needed else 0.0
    return Split(odd, best / whole, share, max(whole - K * m * variance, 0.0) / products.cost)


def _choose_seeds(products: ViewProducts) -> list[int]:
    """Choose the views that the search begins with: of many those that differ most."""
    K = len(products.b)
    if K <= MAX_SEEDS:
        return list(range(K))
    gains = [float(b @ _solve(N, b)) for N, b in zip(products.N, products.b, strict=True)]
    return np.argsort(gains)[-MAX_SEEDS:].tolist()


def _seek_split(products: ViewProducts, seed: int) -> tuple[float, BoolArray]:
    """Part the views in two, beginning with one by itself; return T_2 and the views of its kind."""
    odd = np.arange(len(products.b)) == seed
    for _ in range(_MAX_STEPS):
        total, dc, own = _explain_groups(products, odd.astype(np.intp))
        b = products.b - products.between.swapaxes(1, 2) @ dc  # what the camera's step leaves
        gains = [2 * b @ c - np.einsum("p,kpq,q->k", c, products.N, c) for c in own]
        now = gains[1] > gains[0]
        if (now == odd).all() or now.all() or not now.any():
            break
        odd = now
    return total, odd


def _explain_groups(products: ViewProducts, group: IntArray) -> tuple[float, Array, Array]:
    """Explain the residuals by one c for each group (K,) of views, beside the camera's step.

    Returns:
        T, the step (P,) of the camera and the c (groups, m).
    """
    P, m = products.between.shape[1:]
    count = int(group.max()) + 1
    N, b = np.zeros((P + count * m, P + count * m)), np.zeros(P + count * m)
    N[:P, :P], b[:P] = products.shared.sum(axis=0), products.gradient.sum(axis=0)
    for g in range(count):
        part, its = slice(P + g * m, P + (g + 1) * m), group == g
        N[part, part], b[part] = products.N[its].sum(axis=0), products.b[its].sum(axis=0)
        N[:P, part] = products.between[its].sum(axis=0)
        N[part, :P] = N[:P, part].T
    step = _solve(N, b)
    return float(b @ step), step[:P], step[P:].reshape(count, m)


def _explain_each(products: ViewProducts) -> float:
    """Return T_K: every view has a c of its own, beside the camera's step."""
    solved = [
        _solve(N, np.column_stack([b, C.T]))
        for N, b, C in zip(products.N, products.b, products.between, strict=True)
    ]
    N, b, T = products.shared.sum(axis=0), products.gradient.sum(axis=0), 0.0
    for x, own, C in zip(solved, products.b, products.between, strict=True):
        T += float(own @ x[:, 0])
        N, b = N - C @ x[:, 1:], b - C @ x[:, 0]
    return T + float(b @ _solve(N, b))


def _solve(N: Array, b: Array) -> Array:
    """Solve N x = b, of unit diagonal, without the directions that are not determined."""
    if not len(b):
        return b
    unit = 1 / np.sqrt(np.maximum(N.diagonal(), 1e-24))  # columns may depend on no corner at all
    values, vectors = np.linalg.eigh(N * unit * unit[:, None])
    is_determined = values > MIN_EIGENVALUE * values[-1]
    axes = unit[:, None] * vectors[:, is_determined]
    return np.asarray(axes / values[is_determined] @ (axes.T @ b))

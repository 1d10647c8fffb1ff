"""Which corner is which, where only the board's own deviations tell.

A turn of the board that its pattern hides, or another offset of a part of it, moves the plate's
frame, which the view's pose undoes: on a nominal plate residuals and camera are the same, and
nothing can or need be decided. A real board deviates from its drawing by d_i at corner i, mm, and
all views must see the same d.

With r the residuals on the nominal plate and B_i their derivatives by the place of corner i, view
k says of it g_ki = -B_i^T r_i and H_ki = B_i^T B_i. Counted otherwise, by a motion x' = Q x + t of
the plate that takes corner i to place i', it says the same of another corner in turned axes,
g_ki' = Q g_ki and H_ki' = Q H_ki Q^T. Under deviations of variance s^2 along each axis, and noise
sigma, the logarithm of the probability of all views together is, but for a constant,

    E = 1/2 sum_i [ g_i^T (H_i + lambda I)^-1 g_i / sigma^2 - log det(I + H_i / lambda) ],

with g_i = sum_k g_ki, H_i = sum_k H_ki and lambda = sigma^2 / s^2: views that agree reinforce each
other, others cancel. s is what it would be if all of the residuals were the board's. One view
after the other is placed where it raises E most, the one that sees most first, as it is; then
each once more against all others, until none moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.corners.ordering import numberings, place
from calibgui.engine.estimation.problem import linearised
from calibgui.engine.lens import MODELS
from calibgui.engine.quality.information import measured, state_of
from calibgui.engine.types import (
    Array,
    Calibration,
    Corners,
    Cost,
    IntArray,
    Observation,
    Target,
    frozen_int,
)

_CERTAIN = 25.0
"""By how much more probable, in powers of e, the chosen place must be than the next."""
_SWEEPS = 10


class Placing(NamedTuple):
    """A view's corners on the board."""

    grid: IntArray
    """(n, 2) row and column of each."""
    certain: bool
    """Whether all other ways to count them are improbable."""


class _Way(NamedTuple):
    """One way to count a view's corners."""

    grid: IntArray
    """(n, 2)"""
    turn: Array
    """Q (3, 3)."""


class _Sums(NamedTuple):
    """What is said of all corners of the board."""

    g: Array
    """(rows, cols, 3)"""
    H: Array
    """(rows, cols, 3, 3)"""


def identified(
    calibration: Calibration, corners: Sequence[Corners], target: Target
) -> tuple[Placing, ...]:
    """Count the corners of all views alike, where the board's deviations tell how.

    Args:
        calibration: from these views with the image cost, on the nominal plate.
        corners: of its views.
        target: the board.

    Returns:
        The views' places: as they were and not certain where nothing is to be told, in the view
        that the others are counted like as it was.
    """
    ways = [_ways(view) for view in corners]
    if all(len(own) == 1 for own in ways):
        return tuple(Placing(own[0].grid, True) for own in ways)
    said = _said(calibration, corners, target)
    sigma2 = calibration.noise**2
    s2 = 2 * sigma2 / float(np.mean(np.concatenate([np.trace(H.T) for _, H in said])))
    board = (target.rows, target.cols)
    total = _Sums(np.zeros((*board, 3)), np.zeros((*board, 3, 3)))
    # What can be counted in one way only is the reference, or else what says most.
    order = sorted(range(len(ways)), key=lambda k: (len(ways[k]) > 1, -len(said[k][0])))
    fixed = {order[0], *(k for k in order if len(ways[k]) == 1)}
    chosen = dict.fromkeys(range(len(ways)), 0)
    certain = dict.fromkeys(fixed, True)
    placed: set[int] = set()
    for sweep in range(_SWEEPS):
        moved = False
        for k in order:
            if k in placed:
                total = _added(total, ways[k][chosen[k]], said[k], -1.0)
            if k not in fixed:
                score = [_evidence(_added(total, way, said[k], 1.0), sigma2, s2) for way in ways[k]]
                best, next_best = np.argsort(score)[::-1][:2].tolist()
                certain[k] = score[best] - score[next_best] > _CERTAIN
                moved |= best != chosen[k]
                chosen[k] = best
            total = _added(total, ways[k][chosen[k]], said[k], 1.0)
            placed.add(k)
        if sweep and not moved:
            break
    return tuple(
        Placing(own[chosen[k] if certain[k] else 0].grid, certain[k]) for k, own in enumerate(ways)
    )


def _ways(corners: Corners) -> list[_Way]:
    """The ways to count a view's corners that its colours allow, as they are first.

    Of a part whose place is known these are the turns of the whole board.
    """
    board, grid = corners.shape, corners.grid
    rows, cols = np.indices(board, dtype=np.float64)
    whole = np.stack([rows, cols], axis=-1)
    if corners.relative:
        part = np.full((*board, 2), np.nan)
        part[grid[:, 0], grid[:, 1]] = whole[grid[:, 0], grid[:, 1]]
        low, high = grid.min(axis=0), grid.max(axis=0) + 1
        whole = part[low[0] : high[0], low[1] : high[1]]
    first_dark = not corners.relative or int(grid.min(axis=0).sum()) % 2 == 0
    ways = []
    for way in numberings(Lattice(whole, first_dark), board):
        if not way.dark:
            continue
        places, was, _ = place(way)  # `was` holds the places as they are
        to = np.full((*board, 2), -1, dtype=np.int64)
        to[tuple(was.astype(np.int64).T)] = places
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[way.quarters]
        turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], dtype=np.float64)
        ways.append(_Way(frozen_int(to[grid[:, 0], grid[:, 1]]), turn))
    ways.sort(key=lambda way: not np.array_equal(way.grid, grid))
    return ways


def _said(
    calibration: Calibration, corners: Sequence[Corners], target: Target
) -> list[tuple[Array, Array]]:
    """g (n, 3) and H (n, 3, 3) of each view's corners."""
    views = [Observation(view.uv, target.points(view.grid), view.cov) for view in corners]
    observations = measured(calibration, views)
    state = state_of(calibration.camera, calibration.poses)
    said = []
    for k in range(len(views)):
        r, _, by_pose = linearised(
            state,
            observations,
            slice(k, k + 1),
            MODELS[calibration.camera.model],
            Cost.IMAGE,
            1.0,
        )
        n = len(views[k].uv)
        B = by_pose[0, :n, :, 3:] @ state.R[k]
        transposed = np.swapaxes(B, 1, 2)
        said.append((-(transposed @ r[0, :n, :, None])[..., 0], transposed @ B))
    return said


def _added(total: _Sums, way: _Way, said: tuple[Array, Array], sign: float) -> _Sums:
    """The sums with a view counted in some way, or without it."""
    g, H = total.g.copy(), total.H.copy()
    at = way.grid[:, 0], way.grid[:, 1]
    g[at] += sign * said[0] @ way.turn.T
    H[at] += sign * way.turn @ said[1] @ way.turn.T
    return _Sums(g, H)


def _evidence(total: _Sums, sigma2: float, s2: float) -> float:
    """E."""
    stiff = total.H + sigma2 / s2 * np.eye(3)
    gain = np.sum(total.g * np.linalg.solve(stiff, total.g[..., None])[..., 0]) / sigma2
    return float(gain - np.linalg.slogdet(np.eye(3) + total.H * (s2 / sigma2))[1].sum()) / 2

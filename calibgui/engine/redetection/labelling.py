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
after the other is placed where it raises E most, until none moves: from all views as they are,
which move only where that is certain, and unless most are known to be right also from none, the one
that sees most first. The higher E is taken.

How all views of a board are counted alike: ``quality/counting.py`` with what colours allow.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray, freeze_ints
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import measured, state_of
from calibgui.engine.calibration.refinement.normal_equations import linearised
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import MODELS
from calibgui.engine.detection.checkerboard.numbering import numberings, place
from calibgui.engine.detection.corners import Corners
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation

_CERTAIN = 25.0
"""By how much more probable, in powers of e, the chosen way must be than the next."""
_LIKELY = 3.0
"""The same for a view that shows the board upside down, which is evidence as well."""
_SWEEPS = 10
_HIT = 1e-3
"""mm within which a turned corner meets another of the plate."""


class Way(NamedTuple):
    """One way to count a view's corners."""

    places: IntArray
    """(n,) which of the plate's corners each is."""
    turn: Array
    """Q (3, 3)."""


class Choice(NamedTuple):
    """How a view's corners are counted."""

    way: int
    """Which of its ways."""
    certain: bool
    """Whether all others are improbable."""


class _Said(NamedTuple):
    """What one view says of the plate's corners, counted in one way."""

    places: IntArray
    """(n,) which they are."""
    g: Array
    """(n, 3)"""
    H: Array
    """(n, 3, 3)"""


class _Sums(NamedTuple):
    """What is said of all corners of the plate."""

    g: Array
    """(m, 3)"""
    H: Array
    """(m, 3, 3)"""


def quarter_turn(quarters: int) -> Array:
    """Q (3, 3) of quarter turns about the plate's normal, from x towards -y."""
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters]
    return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], dtype=np.float64)


def alike(
    calibration: Calibration,
    views: Sequence[Observation],
    ways: Sequence[Sequence[Way]],
    count: int,
    likely: IntArray | None = None,
) -> list[Choice]:
    """Choose the ways that make the views agree about the board's deviations.

    Args:
        calibration: from these views with the image cost, on the nominal plate.
        views: as they are counted first.
        ways: to count the corners of each view, the first as they are.
        count: m, the number of the plate's corners.
        likely: the views that may well be counted otherwise, where most are counted alike as they
            are; None where nothing is known.

    Returns:
        The choices: the first way, and not certain, where nothing is to be told; the first in the
        view that the others are counted like.
    """
    if all(len(own) == 1 for own in ways):
        return [Choice(0, True)] * len(ways)
    said = _said(calibration, views)
    sigma2 = calibration.noise**2
    s2 = 2 * sigma2 / float(np.mean(np.concatenate([np.trace(H.T) for _, H in said])))
    turned = [
        [_Said(way.places, g @ way.turn.T, way.turn @ H @ way.turn.T) for way in own]
        for own, (g, H) in zip(ways, said, strict=True)
    ]
    needed = np.full(len(ways), _CERTAIN)
    needed[[] if likely is None else likely] = _LIKELY
    problem = _Problem(turned, sigma2, s2, count, needed)
    settled = problem.settled(range(len(ways)))
    if likely is None:
        settled = max(settled, problem.settled(()))
    return [Choice(way if sure else 0, sure) for way, sure in settled.choices]


class _Settled(NamedTuple):
    """Choices that no view would change by itself."""

    evidence: float
    """E."""
    choices: tuple[tuple[int, bool], ...]
    """Of each view the way, and whether it is certain."""


class _Problem(NamedTuple):
    """What the views say in each of the ways to count them, and what it is judged by."""

    said: Sequence[Sequence[_Said]]
    sigma2: float
    s2: float
    corners: int
    needed: Array
    """(K,) difference of E from which a way is certain."""

    def settled(self, first: Iterable[int]) -> _Settled:
        """From views that are counted as they are until something else is certain, if there are
        any, to where no view would change."""
        total = _Sums(np.zeros((self.corners, 3)), np.zeros((self.corners, 3, 3)))
        placed = set(first)
        trusted = bool(placed)
        for k in placed:
            total = _added(total, self.said[k][0], 1.0)
        # What can be counted in one way only is the reference, or else what says most.
        order = sorted(
            range(len(self.said)), key=lambda k: (len(self.said[k]) > 1, -len(self.said[k][0].g))
        )
        fixed = {*order[: not placed], *(k for k in order if len(self.said[k]) == 1)}
        chosen, certain = [0] * len(order), [k in fixed for k in range(len(order))]
        for _ in range(_SWEEPS):
            moved = False
            for k in order:
                own = self.said[k]
                if k in placed:
                    total = _added(total, own[chosen[k]], -1.0)
                moved |= k not in placed
                placed.add(k)
                if k not in fixed:
                    score = [self.evidence(_added(total, said, 1.0)) for said in own]
                    best, next_best = np.argsort(score)[::-1][:2].tolist()
                    certain[k] = bool(score[best] > score[next_best] + self.needed[k])
                    if best != chosen[k] and (certain[k] or not trusted):
                        chosen[k], moved = best, True
                total = _added(total, own[chosen[k]], 1.0)
            if not moved:
                break
        return _Settled(self.evidence(total), tuple(zip(chosen, certain, strict=True)))

    def evidence(self, total: _Sums) -> float:
        """E."""
        stiff = total.H + self.sigma2 / self.s2 * np.eye(3)
        gain = np.sum(total.g * np.linalg.solve(stiff, total.g[..., None])[..., 0]) / self.sigma2
        volume = np.linalg.slogdet(np.eye(3) + total.H * (self.s2 / self.sigma2))[1].sum()
        return float(gain - volume) / 2


def turned_alike(calibration: Calibration, views: Sequence[Observation]) -> tuple[Observation, ...]:
    """The views with their plate the same way round in all, as far as its deviations tell.

    Args:
        calibration: from these views with the image cost, on the nominal plate.
        views: any corners of the plate, with nothing that tells a plate from a turned one.

    Returns:
        The views, those as they were that are counted like most.
    """
    board_shape = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    tree = scipy.spatial.cKDTree(board_shape)
    centre = (board_shape.min(axis=0) + board_shape.max(axis=0)) / 2

    def turned(view: Observation, quarters: int) -> Array:
        return np.asarray((view.xy - centre) @ quarter_turn(quarters)[:2, :2].T + centre)

    possible: list[list[int]] = []
    ways: list[list[Way]] = []
    for view in views:
        found = [tree.query(turned(view, quarters)) for quarters in range(4)]
        possible.append([q for q, hit in enumerate(found) if np.max(hit[0]) < _HIT])
        ways.append([Way(np.asarray(found[q][1]), quarter_turn(q)) for q in possible[-1]])
    choices = alike(calibration, views, ways, len(board_shape), upside_down(calibration.poses))
    chosen = [own[choice.way] for own, choice in zip(possible, choices, strict=True)]
    sure = [quarters for quarters, choice in zip(chosen, choices, strict=True) if choice.certain]
    votes = np.bincount(sure, minlength=4)
    usual = int(np.argmax(votes))
    if 2 * votes[usual] <= len(sure):
        return tuple(views)  # nobody can say which are the turned ones
    return tuple(
        view._replace(xy=turned(view, (quarters - usual) % 4))
        if choice.certain and quarters != usual
        else view
        for view, quarters, choice in zip(views, chosen, choices, strict=True)
    )


def upside_down(poses: Sequence[Pose]) -> IntArray:
    """The views, if any, that show the board turned by some 180 degrees against most others."""
    across = rotation(np.array([pose.rvec for pose in poses]))[:, :2, 0]
    across = across / np.linalg.norm(across, axis=1, keepdims=True)
    cosine = across @ across.T
    like = (cosine > np.sqrt(0.5)).sum(axis=1)
    usual = int(np.argmax(like))
    if like[usual] <= 2 / 3 * len(poses):
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(cosine[usual] < -np.sqrt(0.5))


def _said(calibration: Calibration, views: Sequence[Observation]) -> list[tuple[Array, Array]]:
    """g (n, 3) and H (n, 3, 3) of each view's corners."""
    observations = measured(calibration, views)
    state = state_of(calibration.camera, calibration.poses)
    said = []
    for k, view in enumerate(views):
        r, _, by_pose = linearised(
            state,
            observations,
            slice(k, k + 1),
            MODELS[calibration.camera.model],
            Cost.IMAGE,
            1.0,
        )
        n = len(view.uv)
        B = by_pose[0, :n, :, 3:] @ state.R[k]
        transposed = np.swapaxes(B, 1, 2)
        said.append((-(transposed @ r[0, :n, :, None])[..., 0], transposed @ B))
    return said


def _added(total: _Sums, said: _Said, sign: float) -> _Sums:
    """The sums with a view, or without it."""
    g, H = total.g.copy(), total.H.copy()
    g[said.places] += sign * said.g
    H[said.places] += sign * said.H
    return _Sums(g, H)


class Placing(NamedTuple):
    """A view's corners on the board."""

    grid: IntArray
    """(n, 2) row and column of each."""
    certain: bool
    """Whether all other ways to count them are improbable."""


class _Numbering(NamedTuple):
    """One way to count a view's corners."""

    grid: IntArray
    """(n, 2)"""
    turn: Array
    """Q (3, 3) of the plate."""


def identified(
    calibration: Calibration, corners: Sequence[Corners], board: Board
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
    views = [Observation(view.uv, board.points(view.grid), view.cov) for view in corners]
    places = [[Way(way.grid @ np.array([board.cols, 1]), way.turn) for way in own] for own in ways]
    choices = alike(calibration, views, places, board.rows * board.cols)
    return tuple(
        Placing(own[choice.way].grid, choice.certain)
        for own, choice in zip(ways, choices, strict=True)
    )


def _ways(corners: Corners) -> list[_Numbering]:
    """The ways to count a view's corners that its colours allow, as they are first.

    Of a part whose place is known these are the turns of the whole board.
    """
    grid_size, grid = corners.shape, corners.grid
    rows, cols = np.indices(grid_size, dtype=np.float64)
    whole = np.stack([rows, cols], axis=-1)
    if corners.relative:
        part = np.full((*grid_size, 2), np.nan)
        part[grid[:, 0], grid[:, 1]] = whole[grid[:, 0], grid[:, 1]]
        low, high = grid.min(axis=0), grid.max(axis=0) + 1
        whole = part[low[0] : high[0], low[1] : high[1]]
    first_dark = not corners.relative or int(grid.min(axis=0).sum()) % 2 == 0
    ways = []
    for way in numberings(Lattice(whole, first_dark), grid_size):
        if not way.dark:
            continue
        places, was, _ = place(way)  # `was` holds the places as they are
        to = np.full((*grid_size, 2), -1, dtype=np.int64)
        to[tuple(was.astype(np.int64).T)] = places
        numbered = freeze_ints(to[grid[:, 0], grid[:, 1]])
        ways.append(_Numbering(numbered, quarter_turn(way.quarters)))
    ways.sort(key=lambda way: not np.array_equal(way.grid, grid))
    return ways

"""The views of a rig that go together: which contradict the others, and which count the board from
another end.

At each instant the views are compared with the one that most others agree with, under the
relations of the cameras that most instants agree about (``consensus.py``). A view that costs far
more than usual is left out: a photograph of another instant, or a board that was counted wrongly.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.rig.alone import CameraAlone
from calibgui.engine.rig.consensus import (
    Relation,
    apply_turns,
    choose_turns,
    measure_scatter,
)
from calibgui.engine.rig.records import RigPair

_MAX_CONTRADICTION = 10.0
"""Ratio of a view's contradiction of the others to the usual one, in px, beyond which it is left
out. Pairs of real rigs that were not taken at quite the same instant reach 6, those that do not
belong together are beyond 100: a plausibility limit."""
USUAL_COST = 5.348
"""Median of the squared length of a residual with 6 degrees of freedom and variance 1."""
_MIN_COST = 1e-6
"""Cost of a contradiction that is of no consequence, px^2."""


class Agreement(NamedTuple):
    """The agreement of the views of a rig."""

    noise: float
    """Variance of a residual of the cameras alone along each axis, px^2."""

    limit: float
    """Cost beyond which a view contradicts the one that it is compared with, px^2."""
    base: IntArray
    """(n,) camera with which the views of each instant are compared."""
    kept: tuple[BoolArray, ...]
    """(K,) for each camera, whether its views take part."""
    turn: tuple[IntArray, ...]
    """(K,) for each camera, number of the turn that brings each view's count to the base's."""
    cost: tuple[Array, ...]
    """(K,) for each camera, what its views cost beside the base's, px^2; 0 for the base's own."""


def list_turns(alone: Sequence[CameraAlone]) -> list[Array]:
    """List the motions (3, 3) of the board's plane that bring it onto itself, the identity first.

    They are half a turn about the middle of its corners, and quarters of one if it is a square.
    Whether the pattern shows them makes no difference: corners of another program may be counted
    from any end.
    """
    corners = [part.observations.xy[..., :2].reshape(-1, 2) for part in alone]
    low = np.min([part.min(axis=0) for part in corners], axis=0)
    high = np.max([part.max(axis=0) for part in corners], axis=0)
    width, height = high - low
    quarters = (0, 1, 2, 3) if np.isclose(width, height) else (0, 2)
    turns = []
    for quarter in quarters:
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarter]
        motion = np.eye(3)
        motion[:2, :2] = [[c, -s], [s, c]]
        middle = (low + high) / 2
        motion[:2, 2] = middle - motion[:2, :2] @ middle
        turns.append(motion)
    return turns


def count_shared(alone: Sequence[CameraAlone]) -> IntArray:
    """Count (C, C) the instants at which two cameras both see the board."""
    seen = [set(part.poses.instant.tolist()) for part in alone]
    return np.array([[len(first & second) for second in seen] for first in seen])


def find_agreement(
    alone: Sequence[CameraAlone], relations: Sequence[Relation], turns: Sequence[Array], count: int
) -> Agreement:
    """Find which views go together.

    Args:
        alone: the cameras.
        relations: how each stands to the first one.
        turns: motions (3, 3) of the board that leave it as it is.
        count: number of instants.
    """
    C = len(alone)
    costs = np.full((C, C, count), np.inf)
    chosen = np.zeros((C, C, count), dtype=np.int64)
    for a in range(C):
        for b in range(a):
            at, in_a, in_b = np.intersect1d(
                alone[a].poses.instant, alone[b].poses.instant, return_indices=True
            )
            if not at.size:
                continue
            between = relations[b].after(relations[a].invert())
            there = alone[b].poses.select(in_b)
            turn, cost = choose_turns(
                between, alone[a].poses.select(in_a), [there.turn(turn) for turn in turns]
            )
            costs[a, b, at] = costs[b, a, at] = cost
            chosen[a, b, at], chosen[b, a, at] = turn, -turn % len(turns)
    noise = _estimate_noise(alone)
    usual = float(np.median(costs[np.isfinite(costs)]))
    limit = _MAX_CONTRADICTION**2 * max(usual, USUAL_COST * noise, _MIN_COST)
    corners = np.zeros((C, count))
    for c, part in enumerate(alone):
        corners[c, part.poses.instant] = part.observations.mask.sum(axis=1)
    agreeing = (costs <= limit).sum(axis=1)
    base = np.lexsort((corners, agreeing), axis=0)[-1]
    kept, turned, cost_of = [], [], []
    for c, part in enumerate(alone):
        at = part.poses.instant
        cost = np.where(base[at] == c, 0.0, costs[base[at], c, at])
        kept.append(cost <= limit)
        turned.append(chosen[base[at], c, at])
        cost_of.append(cost)
    return Agreement(noise, limit, base, tuple(kept), tuple(turned), tuple(cost_of))


def _estimate_noise(alone: Sequence[CameraAlone]) -> float:
    """Estimate the variance of a residual of the cameras alone along each axis, px^2."""
    corners = sum(part.observations.count for part in alone)
    poses = sum(len(part.poses.instant) for part in alone)
    return sum(part.cost for part in alone) / max(2 * corners - 6 * poses, 1)


def describe_pairs(
    alone: Sequence[CameraAlone],
    relations: Sequence[Relation],
    turns: Sequence[Array],
    agreement: Agreement,
    tree: Sequence[tuple[int, int]],
) -> tuple[RigPair, ...]:
    """Describe how far apart single instants have the cameras of the pairs that join the rig."""
    pairs = []
    for a, b in tree:
        kept = [
            part.poses.select(np.flatnonzero(agreement.kept[c]))
            for c, part in ((a, alone[a]), (b, alone[b]))
        ]
        at, in_a, in_b = np.intersect1d(kept[0].instant, kept[1].instant, return_indices=True)
        if not at.size:
            continue
        between = relations[b].after(relations[a].invert())
        first, second = kept[0].select(in_a), kept[1].select(in_b)
        turned = [second.turn(turn) for turn in turns]
        second = apply_turns(turned, choose_turns(between, first, turned)[0])
        scatter, of_noise = measure_scatter(between, first, second)
        pairs.append(RigPair(a, b, len(at), scatter, of_noise * float(np.sqrt(agreement.noise))))
    return tuple(pairs)

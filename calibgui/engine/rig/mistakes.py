"""The mistakes that people make with rigs are found, and named with the photographs.

Each mistake is a hypothesis about the views of two cameras that are joined. It is named if what the
instants say agrees under it and not without it, by the cost of a relation at an instant
(``consensus.py``).

- *Shifted*: a camera's photographs belong to the instants before or after. Under another pairing
  the median cost falls as it does for photographs that belong together.
- *Exchanged*: the photographs of two cameras are exchanged at some instants, which agree once each
  is taken for the other camera's.
- *Other scale*: the squares were counted as longer or shorter at some instants than at the others.
  Both cameras then see the board at a distance that is wrong by the same factor s, so that the
  relation is that of the others but for its length, which is s times theirs.
- *Moved*: from some instant on a camera stands otherwise. Two relations, before it and after it,
  leave less than one does, by more than the scatter within both parts explains (Fisher's F, at
  every place where the series can be cut).
- *Refocused*: likewise, but two focal lengths of one camera, before it and after it, explain as
  much as two relations do.
- *Other instant*: views that were left out and that none of these explains.
- *Less agreement*: instants that agree less than would be expected of the scatter of all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.agreement import USUAL_COST, Agreement
from calibgui.engine.rig.alone import CameraAlone, locate_views
from calibgui.engine.rig.consensus import (
    Relation,
    ViewPoses,
    apply_turns,
    choose_turns,
    compare_views,
    differentiate_differences,
    find_relation,
    measure_differences,
)
from calibgui.engine.rig.records import Mistake, RigCamera, RigMistake

_MAX_SHIFT = 3
"""Number of instants by which a pairing is tried to be wrong, at most."""
_MIN_IMPROVEMENT = 100.0
"""Ratio of median costs from which another pairing is the right one: ten times less in px."""
_MIN_PART = 4
"""Number of instants before and after a move, at least: fewer may be photographs of others."""
_SIGNIFICANCE = 1e-4
"""Probability with which a rig whose instants scatter by chance is said to have moved."""
_MIN_SCALE = 0.02
"""Least relative difference of squares that is told: below it the instants hardly disagree."""
_MAX_SIMPLER = 1.5
"""Ratio of variances up to which two focal lengths explain what two relations do: a camera that has
moved leaves many times as much under a change of focus."""
_RARE = 0.015
"""Probability of a scatter as large as that of an instant which is named: of 60 one by chance."""


def find_mistakes(
    cameras: Sequence[RigCamera],
    alone: Sequence[CameraAlone],
    relations: Sequence[Relation],
    turns: Sequence[Array],
    agreement: Agreement,
    instants: Sequence[int],
    is_disagreeing: bool,
    tree: Sequence[tuple[int, int]],
) -> tuple[RigMistake, ...]:
    """Find what is wrong with the views of a rig.

    Args:
        cameras: the cameras as they are known.
        alone: the same with the board where each of their views has it.
        relations: how each stands to the first one, as most instants have it.
        turns: motions of the board that leave it as it is.
        agreement: which views go together.
        instants: the numbers of all instants.
        is_disagreeing: True if the instants disagree by more than the corners' noise explains.
        tree: the pairs of cameras that are compared.
    """
    found: list[RigMistake] = []
    explained: set[tuple[int, int]] = set()  # camera and place of the instant
    for a, b in tree:
        pair = _Pair(a, b, (alone[a], alone[b]), turns, agreement, instants)
        both = [(cameras[c], alone[c]) for c in (a, b)]
        between = relations[b].after(relations[a].invert())
        shifted = pair.find_shift(between)
        moved = None if shifted else pair.find_move(between)
        named = [shifted or moved] if shifted or moved else []
        if not named:
            named = [*pair.find_exchange(between, both), *pair.find_scale(between)]
        for mistake in filter(None, named):
            found.append(mistake)
            concerned = mistake.instants
            if mistake.kind in (Mistake.SHIFTED, Mistake.MOVED, Mistake.REFOCUSED):
                concerned = tuple(instants)
            places = {instants.index(each) for each in concerned}
            explained |= {(c, place) for c in (a, b) for place in places}
    strange = _list_strange(alone, agreement, instants, explained, is_disagreeing)
    return (*found, *strange)


@dataclass(frozen=True, eq=False, slots=True)
class _Pair:
    """Two cameras that are joined, and their views."""

    a: int
    b: int
    alone: tuple[CameraAlone, CameraAlone]
    turns: Sequence[Array]
    agreement: Agreement
    instants: Sequence[int]

    @property
    def first(self) -> ViewPoses:
        """The views of the first camera."""
        return self.alone[0].poses

    @property
    def second(self) -> ViewPoses:
        """The views of the second camera."""
        return self.alone[1].poses

    def match(self, shift: int = 0) -> tuple[ViewPoses, list[ViewPoses]]:
        """Return the views of both at the instants that they share, the second's with the board
        counted from every end, if its photographs belong to `shift` instants later."""
        numbers = np.array(self.instants)
        _, in_a, in_b = np.intersect1d(
            numbers[self.first.instant],
            numbers[self.second.instant] + shift,
            return_indices=True,
        )
        there = self.second.select(in_b)
        return self.first.select(in_a), [there.turn(turn) for turn in self.turns]

    def find_shift(self, relation: Relation) -> RigMistake | None:
        """Find by how many instants the pairing is shifted, if it is."""
        costs = {}
        for shift in sorted(range(-_MAX_SHIFT, _MAX_SHIFT + 1), key=abs):
            a, turned = self.match(shift)
            if len(a.instant) < _MIN_PART:
                continue
            relation = find_relation(a, turned) if shift else relation
            costs[shift] = float(np.median(choose_turns(relation, a, turned)[1]))
            if shift == 0 and costs[0] < _MIN_IMPROVEMENT * USUAL_COST * self.agreement.noise:
                return None  # as it is, the photographs go together
        if not costs or 0 not in costs:
            return None
        best = min(costs, key=lambda shift: costs[shift])
        if not costs[best] * _MIN_IMPROVEMENT < costs[0]:
            return None
        return RigMistake(Mistake.SHIFTED, self.b, self.a, (), float(best))

    def find_move(self, start: Relation) -> RigMistake | None:
        """Find from which instant on the second camera stands otherwise, if it does."""
        a, turned = self.match()
        count = len(a.instant)
        if count < 2 * _MIN_PART:
            return None
        b = apply_turns(turned, choose_turns(start, a, turned)[0])
        cuts = np.arange(_MIN_PART, count - _MIN_PART + 1)
        left_at, whole = _fit_both_parts(start, a, b, cuts)
        best = int(np.argmin(left_at))
        left, cut = float(left_at[best]), int(cuts[best])
        freedom = 6 * count - 12
        ratio = (whole - left) / 6 / max(left / freedom, self.agreement.noise)
        if not scipy.special.fdtrc(6, freedom, ratio) * len(cuts) < _SIGNIFICANCE:
            return None
        before, after = (
            find_relation(a.select(part), [each.select(part) for each in turned])
            for part in (np.arange(cut), np.arange(cut, count))
        )
        if not _are_consistent((before, after), a, turned, cut, self.agreement.noise):
            return None
        numbers = tuple(self.instants[at] for at in a.instant[cut:].tolist())
        if (focus := self._find_focus(start, a, b, cut, left / freedom)) is not None:
            camera, ratio = focus
            return RigMistake(Mistake.REFOCUSED, camera, camera, numbers, ratio)
        moved = float(np.linalg.norm(after.T - before.T))
        return RigMistake(Mistake.MOVED, self.b, self.a, numbers, moved)

    def _find_focus(
        self, start: Relation, a: ViewPoses, b: ViewPoses, cut: int, variance: float
    ) -> tuple[int, float] | None:
        """Find the camera whose focal length is another one from a cut on, with the ratio of both;
        None if that leaves more than a move of the camera does."""
        G = np.kron(np.eye(2), start.R)
        after = np.arange(len(a.instant)) >= cut
        for camera, part, turn in ((self.a, self.alone[0], G), (self.b, self.alone[1], -np.eye(6))):
            views = np.searchsorted(part.poses.instant, a.instant)
            column = part.by_focal[views] @ turn.T
            more = np.stack([column, column * after[:, None]], axis=2)
            step, rest = _fit(start, a, b, more)
            if rest / (6 * len(after) - 8) < _MAX_SIMPLER * variance:
                return camera, float(np.exp(step[-1]))
        return None

    def find_exchange(
        self, relation: Relation, both: Sequence[tuple[RigCamera, CameraAlone]]
    ) -> list[RigMistake]:
        """Find instants at which the photographs of both cameras are exchanged."""
        a, turned = self.match()
        wrong = a.instant[~self._agree(choose_turns(relation, a, turned)[1])]
        if not wrong.size or both[0][0].camera.size != both[1][0].camera.size:
            return []
        exchanged = []
        for (camera, _), (_, other) in zip(both, both[::-1], strict=True):
            views = np.searchsorted(other.poses.instant, wrong)
            try:
                located = locate_views(camera, other.observations.select_views(views), wrong)
            except CalibrationError:  # with the other's photographs it has no poses at all
                return []
            exchanged.append(located.poses)
        there = [exchanged[1].turn(turn) for turn in self.turns]
        agrees = self._agree(choose_turns(relation, exchanged[0], there)[1])
        return self._name(Mistake.EXCHANGED, exchanged[0], agrees, 0.0)

    def find_scale(self, relation: Relation) -> list[RigMistake]:
        """Find instants at which the squares were counted as longer or shorter."""
        a, turned = self.match()
        chosen, costs = choose_turns(relation, a, turned)
        b = apply_turns(turned, chosen)
        strange = np.flatnonzero(~self._agree(costs)).astype(np.int64)
        a, b = a.select(strange), b.select(strange)
        # Least squares of T_b - Q T_a = s S over each instant's place.
        along = b.T - a.T @ relation.R.T
        scale = along @ relation.T / max(float(relation.T @ relation.T), 1e-300)
        scaled = np.array(
            [
                compare_views(Relation(relation.R, s * relation.T), a.select(one), b.select(one))[0]
                for s, one in zip(scale.tolist(), np.arange(len(scale))[:, None], strict=True)
            ]
        )
        wrong = self._agree(scaled) & (np.abs(scale - 1) > _MIN_SCALE)
        if wrong.sum() < 2 or np.ptp(scale[wrong]) > 0.1 * np.abs(scale[wrong]).max():
            return []
        return self._name(Mistake.OTHER_SCALE, a, wrong, float(np.median(scale[wrong])))

    def _agree(self, costs: Array, factor: float = 1.0) -> BoolArray:
        """Return whether instants of these costs agree."""
        return np.asarray(costs <= factor * self.agreement.limit, dtype=bool)

    def _name(
        self, kind: Mistake, a: ViewPoses, chosen: BoolArray, value: float
    ) -> list[RigMistake]:
        numbers = tuple(self.instants[at] for at in a.instant[chosen].tolist())
        return [RigMistake(kind, self.b, self.a, numbers, value)] if numbers else []


def _fit(start: Relation, a: ViewPoses, b: ViewPoses, more: Array) -> tuple[Array, float]:
    """Fit a local change (6,) of a relation and n more unknowns to instants.

    Args:
        start, a, b: the relation, and the views of both cameras.
        more: (K, 6, n) change of e with the further unknowns.

    Returns:
        The unknowns (6 + n,), and the cost that is left.
    """
    A, g, whole = _sum_by_instant(start, a, b, more)
    step = np.linalg.solve(A.sum(axis=0), g.sum(axis=0))
    return step, float(whole.sum() - step @ g.sum(axis=0))


def _fit_both_parts(
    start: Relation, a: ViewPoses, b: ViewPoses, cuts: IntArray
) -> tuple[Array, float]:
    """Fit a change of a relation to the instants before each cut, and one to those after it; return
    the costs (n,) that are left of both parts, and that of one change for all."""
    sums = [np.cumsum(part, axis=0) for part in _sum_by_instant(start, a, b)]
    before = [part[cuts - 1] for part in sums]
    after = [part[-1] - earlier for part, earlier in zip(sums, before, strict=True)]
    left = sum(w - _measure_gain(A, g) for A, g, w in (before, after))
    A, g, w = (part[-1:] for part in sums)
    return np.asarray(left), float((w - _measure_gain(A, g))[0])


def _measure_gain(A: Array, g: Array) -> Array:
    """Return by how much the least squares of normal equations (n, 6, 6), (n, 6) save cost."""
    return np.asarray(np.sum(g * np.linalg.solve(A, g[..., None])[..., 0], axis=1))


def _sum_by_instant(
    start: Relation, a: ViewPoses, b: ViewPoses, more: Array | None = None
) -> tuple[Array, Array, Array]:
    """Return each instant's normal equations (K, m, m) and (K, m), and its cost (K,) as it is."""
    e, covariance = measure_differences(start, a, b)
    C = differentiate_differences(start, a)
    if more is not None:
        C = np.concatenate([C, more], axis=2)
    weighted = np.swapaxes(np.linalg.solve(covariance, C), 1, 2)
    cost = np.sum(e * np.linalg.solve(covariance, e[..., None])[..., 0], axis=1)
    return weighted @ C, (weighted @ e[..., None])[..., 0], np.asarray(cost)


def _are_consistent(
    relations: tuple[Relation, Relation],
    a: ViewPoses,
    turned: Sequence[ViewPoses],
    cut: int,
    noise: float,
) -> bool:
    """Return whether most instants of both parts agree with their own relation and not with the
    other: a few that belong to neither make no move."""
    costs = [choose_turns(relation, a, turned)[1] for relation in relations]
    own = np.concatenate([costs[0][:cut], costs[1][cut:]])
    other = np.concatenate([costs[1][:cut], costs[0][cut:]])
    usual = max(float(np.median(own)), USUAL_COST * noise)
    return bool(np.mean(other > own) > 0.8 and np.median(other) > 4 * usual)


def _list_strange(
    alone: Sequence[CameraAlone],
    agreement: Agreement,
    instants: Sequence[int],
    explained: set[tuple[int, int]],
    is_disagreeing: bool,
) -> list[RigMistake]:
    """List the views that were left out, and those that agree less than the others, which nothing
    explains."""
    found = []
    costs = np.concatenate([cost[cost > 0] for cost in agreement.cost])
    usual = float(np.median(costs)) if costs.size else 0.0
    # Of a squared length with 6 degrees of freedom and this median, so large a value is rare.
    rare = scipy.special.chdtri(6, _RARE) / USUAL_COST * usual
    for c, part in enumerate(alone):
        at: IntArray = part.poses.instant
        open_ = np.array([(c, place) not in explained for place in at.tolist()], dtype=bool)
        kept, cost = agreement.kept[c], agreement.cost[c]
        for kind, chosen in (
            (Mistake.OTHER_INSTANT, ~kept & open_),
            (Mistake.LESS_AGREEMENT, kept & open_ & (cost > rare) & is_disagreeing),
        ):
            numbers = tuple(instants[place] for place in at[chosen].tolist())
            if numbers:
                found.append(RigMistake(kind, c, c, numbers, 0.0))
    return found

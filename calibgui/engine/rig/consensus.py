"""The instants agree about a start for the joint solve that no wrong pair can spoil.

Each camera alone tells where the board was at each instant, cam_from_board. So every instant at
which two cameras a and b see the board tells how they stand to each other,
b_from_a = (b_from_board) (a_from_board)^-1. Least squares over all instants would follow those that
are wrong: photographs of other instants, a camera that was late, a board that is counted from its
other end. What most of them say is sought instead.

How far an instant is from a relation b_from_a is measured by what it costs: with the board's pose
as both views would have it, the sum of squares of both rises above that of each alone by

    c = e^T (V_b^-1 + G V_a^-1 G^T)^-1 e,

where e is the local difference (w, tau) of the pose in b from that predicted from a, V the
information of each view on its pose, px^2, and G = diag(Q, Q) turns a's camera into b's. It is the
squared length of a residual in px, of 6 degrees of freedom, whatever the distance of the cameras
and the angle between them. Poses from noisy corners are far apart along the line of sight, and
that costs little.

The relation of an instant is the start for which the median of all other instants' costs is least:
least median of squares (Rousseeuw 1984), over a few instants. From there the mean of all is found
with weights that take away the influence of what is far beyond the others' scatter (Geman and
McClure), each instant counting with its information.

A board whose pattern a turn leaves unchanged may be counted from another end in one camera. Every
instant then has as many relations as there are turns, and the one that costs least is taken.

Cameras are joined in the order of how many instants they share (a spanning tree of most instants),
and boards that stand fast to each other likewise (``joining.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import (
    make_cross_matrix,
    rotation_from_vector,
    vector_from_rotation,
)

_MAX_STARTS = 12
"""Number of instants whose relations are tried as a start: with half of all instants wrong, one of
so many is right but once in 4,000."""
_MAX_STEPS = 20
"""Number of weighted means, at most."""
_MIN_SAVING = 1e-6
"""Cost that a step saves, over the median one, from which on no more are taken."""


@dataclass(frozen=True, eq=False, slots=True)
class ViewPoses:
    """Poses cam_from_board of one camera's views, each from that view alone."""

    R: Array
    """(K, 3, 3)."""
    T: Array
    """(K, 3), mm."""
    covariance: Array
    """(K, 6, 6) V^-1 of the local (w, tau), for residuals of 1 px."""
    instant: IntArray
    """(K,) place of each view's instant, ascending."""

    def select(self, views: IntArray) -> ViewPoses:
        """Return some of the views."""
        return ViewPoses(self.R[views], self.T[views], self.covariance[views], self.instant[views])

    @staticmethod
    def concatenate(parts: Sequence[ViewPoses]) -> ViewPoses:
        """Return the views of several parts in one."""
        fields = ((part.R, part.T, part.covariance, part.instant) for part in parts)
        return ViewPoses(*map(np.concatenate, zip(*fields, strict=True)))

    def turn(self, motion: Array) -> ViewPoses:
        """Return the poses of a board that is counted from another end.

        Args:
            motion: (3, 3) motion of the board's plane that leaves its pattern unchanged, from the
                points as they are to be counted to those as they were.
        """
        turn = np.eye(3)
        turn[:2, :2] = motion[:2, :2]
        return self.express_on(Relation(turn, np.append(motion[:2, 2], 0.0)))

    def express_on(self, relation: Relation) -> ViewPoses:
        """Return the poses of another body that stands fast to the board.

        Args:
            relation: board_from_body.
        """
        carry = self.carry_to(relation)
        covariance = carry @ self.covariance @ np.swapaxes(carry, 1, 2)
        return ViewPoses(
            self.R @ relation.R, self.T + self.R @ relation.T, covariance, self.instant
        )

    def carry_to(self, relation: Relation) -> Array:
        """Return (K, 6, 6) how the local (w, tau) of these poses move those of `express_on`: by
        (w, tau + w x arm)."""
        carry = np.tile(np.eye(6), (len(self.T), 1, 1))
        carry[:, 3:, :3] = -make_cross_matrix(self.R @ relation.T)
        return carry

    def see_from(self, relation: Relation) -> ViewPoses:
        """Return the poses frame_from_board in another frame.

        Args:
            relation: frame_from_cam.
        """
        G = np.kron(np.eye(2), relation.R)
        return ViewPoses(
            relation.R @ self.R,
            self.T @ relation.R.T + relation.T,
            G @ self.covariance @ G.T,
            self.instant,
        )

    def invert(self) -> ViewPoses:
        """Return the poses board_from_cam, as if the board saw the camera: (w, tau) becomes
        (-R^T w, -R^T (tau + [T]x w))."""
        back = np.swapaxes(self.R, 1, 2)
        G = np.zeros((len(back), 6, 6))
        G[:, :3, :3] = G[:, 3:, 3:] = -back
        G[:, 3:, :3] = -back @ make_cross_matrix(self.T)
        return ViewPoses(
            back,
            -(back @ self.T[..., None])[..., 0],
            G @ self.covariance @ np.swapaxes(G, 1, 2),
            self.instant,
        )


class Relation(NamedTuple):
    """The place of camera b beside camera a."""

    R: Array
    """(3, 3) rotation b_from_a."""
    T: Array
    """(3,) translation, mm."""

    @staticmethod
    def of_pose(pose: Pose) -> Relation:
        """Return the relation that a pose b_from_a states."""
        return Relation(rotation_from_vector(np.array(pose.rvec)), np.array(pose.tvec))

    def invert(self) -> Relation:
        """Return how camera a stands to camera b."""
        return Relation(self.R.T, -self.R.T @ self.T)

    def after(self, other: Relation) -> Relation:
        """Return c_from_a of this one, c_from_b, and another one, b_from_a."""
        return Relation(self.R @ other.R, self.R @ other.T + self.T)


def compare_views(relation: Relation, a: ViewPoses, b: ViewPoses) -> Array:
    """Compute the costs c (..., K), px^2, of relations at the instants of two cameras' views.

    Args:
        relation: b_from_a, or several, (..., 1, 3, 3) and (..., 1, 3).
        a, b: the views of both cameras at the same instants.
    """
    e, covariance = measure_differences(relation, a, b)
    return np.asarray(np.sum(e * np.linalg.solve(covariance, e[..., None])[..., 0], axis=-1))


def measure_differences(relation: Relation, a: ViewPoses, b: ViewPoses) -> tuple[Array, Array]:
    """Return e (..., K, 6) and its covariance (..., K, 6, 6) for residuals of 1 px."""
    Q, S = relation
    w = vector_from_rotation(b.R @ np.swapaxes(Q @ a.R, -1, -2))
    tau = b.T - ((Q @ a.T[..., None])[..., 0] + S)
    G = np.zeros((*Q.shape[:-2], 6, 6))
    G[..., :3, :3] = G[..., 3:, 3:] = Q
    covariance = b.covariance + G @ a.covariance @ np.swapaxes(G, -1, -2)
    return np.concatenate([w, tau], axis=-1), covariance


def differentiate_differences(relation: Relation, a: ViewPoses) -> Array:
    """Return (K, 6, 6) how the pose predicted in b moves with a local (w, tau) of the relation: by
    (w, tau - [Q T_a]x w)."""
    C = np.tile(np.eye(6), (len(a.T), 1, 1))
    C[:, 3:, :3] = -make_cross_matrix(a.T @ relation.R.T)
    return C


def measure_scatter(relation: Relation, a: ViewPoses, b: ViewPoses) -> tuple[float, float]:
    """Measure how far apart single instants have the place of camera b from a.

    An instant has it at T + tau + [Q T_a]x w.

    Returns:
        Root mean square distance from T, mm, and that for residuals of 1 px.
    """
    e, covariance = measure_differences(relation, a, b)
    M = np.concatenate(
        [make_cross_matrix(a.T @ relation.R.T), np.tile(np.eye(3), (len(e), 1, 1))], axis=2
    )
    apart = (M @ e[..., None])[..., 0]
    expected = np.trace(M @ covariance @ np.swapaxes(M, 1, 2), axis1=1, axis2=2)
    return float(np.sqrt(np.mean(np.sum(apart**2, axis=1)))), float(np.sqrt(expected.mean()))


def choose_turns(
    relation: Relation, a: ViewPoses, turned: Sequence[ViewPoses]
) -> tuple[IntArray, Array]:
    """Choose the turn of each view of b that costs least; return its number and cost (..., K).

    Args:
        relation: b_from_a, or several, as of `compare_views`.
        a: the views of camera a.
        turned: the views of camera b at the same instants, with the board counted from each end.
    """
    costs = np.stack([compare_views(relation, a, b) for b in turned])
    chosen = np.argmin(costs, axis=0)
    return chosen, np.take_along_axis(costs, chosen[None], axis=0)[0]


def find_relation(a: ViewPoses, turned: Sequence[ViewPoses]) -> Relation:
    """Find what most instants say of how camera b stands to camera a.

    Args:
        a: the views of camera a, at the instants at which both see the board.
        turned: those of camera b, with the board counted from each end that it may have.
    """
    some = _spread_evenly(len(a.instant), 8 * _MAX_STARTS)  # the joint solve takes all
    a, turned = a.select(some), [b.select(some) for b in turned]
    relation = _find_start(a, turned)
    for _ in range(_MAX_STEPS):
        chosen, costs = choose_turns(relation, a, turned)
        scale = float(np.median(costs))
        weights = (scale / (scale + costs)) ** 2 if scale > 0 else np.ones(len(costs))
        relation, saved = _move_relation(relation, a, apply_turns(turned, chosen), weights)
        if saved <= _MIN_SAVING * scale:
            break
    return relation


def _find_start(a: ViewPoses, turned: Sequence[ViewPoses]) -> Relation:
    """Find the instant whose relation the others contradict least; return that.

    Twice as many instants as are tried say so: for a median that is enough.
    """
    some = _spread_evenly(len(a.instant), 2 * _MAX_STARTS)
    a, turned = a.select(some), [b.select(some) for b in turned]
    tried = _spread_evenly(len(a.instant), _MAX_STARTS)
    Q = np.concatenate([b.R[tried] @ np.swapaxes(a.R[tried], 1, 2) for b in turned])
    T = np.concatenate([b.T[tried] for b in turned])
    T -= (Q @ np.tile(a.T[tried], (len(turned), 1))[..., None])[..., 0]
    costs = choose_turns(Relation(Q[:, None], T[:, None]), a, turned)[1]
    best = int(np.argmin(np.median(costs, axis=1)))
    return Relation(Q[best], T[best])


def _spread_evenly(count: int, most: int) -> IntArray:
    """Return at most so many of the numbers up to `count`, at equal distances."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def apply_turns(turned: Sequence[ViewPoses], chosen: IntArray) -> ViewPoses:
    """Return the views, each with the board counted from the end that is chosen."""
    each = np.arange(len(chosen))
    R, T, covariance = (
        np.stack([getattr(b, name) for b in turned])[chosen, each]
        for name in ("R", "T", "covariance")
    )
    return ViewPoses(R, T, covariance, turned[0].instant)


def _move_relation(
    relation: Relation, a: ViewPoses, b: ViewPoses, weights: Array
) -> tuple[Relation, float]:
    """Move a relation to the weighted mean of the instants'; return also the cost that it saves."""
    e, covariance = measure_differences(relation, a, b)
    C = differentiate_differences(relation, a)
    left = weights[:, None, None] * np.swapaxes(np.linalg.solve(covariance, C), 1, 2)
    A, g = (left @ C).sum(axis=0), (left @ e[..., None]).sum(axis=0)[:, 0]
    step = np.linalg.solve(A, g)
    moved = Relation(rotation_from_vector(step[:3]) @ relation.R, relation.T + step[3:])
    return moved, float(step @ g)


def find_tree(shared: IntArray) -> list[tuple[int, int]]:
    """Find pairs (known, new) that join cameras to the first one, those that share most first.

    Cameras that no chain of pairs joins to the first are joined to the first of their own.

    Args:
        shared: (C, C) numbers of instants at which two cameras both see the board.
    """
    joined, tree = [0], []
    others = list(range(1, len(shared)))
    while others:
        a, b = max(
            ((a, b) for a in joined for b in others),
            key=lambda pair: (shared[pair], -pair[0], -pair[1]),
        )
        if shared[a, b] == 0:
            b = others[0]
        else:
            tree.append((a, b))
        joined.append(b)
        others.remove(b)
    return tree

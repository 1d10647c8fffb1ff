"""Labelling of symmetric boards: which corner is which, where only the board's deviations tell.

A turn of the board that its pattern hides, or another offset of a part of it, moves the board's
frame, which the view's pose undoes: on a board as drawn residuals and camera are the same, and
nothing can or need be decided. A real board deviates from its drawing by d_i at corner i, mm, and
all views must see the same d.

With r the residuals on the board as drawn and B_i their derivatives by the place of corner i, view
k tells of this corner g_ki = -B_i^T r_i and H_ki = B_i^T B_i. Labelled otherwise, by a motion
x' = Q x + t of the board that takes corner i to place i', it tells the same of another corner in
turned axes, g_ki' = Q g_ki and H_ki' = Q H_ki Q^T. Under deviations of variance s^2 along each
axis, and noise sigma, the logarithm of the probability of all views together (the evidence, MacKay
1992) is, but for a constant,

    E = 1/2 sum_i [ g_i^T (H_i + lambda I)^-1 g_i / sigma^2 - log det(I + H_i / lambda) ],

with g_i = sum_k g_ki, H_i = sum_k H_ki and lambda = sigma^2 / s^2: views that agree reinforce each
other, others cancel. s is what it would be if all of the residuals were the board's.

One view after the other takes the label that raises E most, until none changes. The search starts
from all views as they are, which change only where that is certain; and, unless most views are
known to be right, also from no view at all, beginning with the one that tells most. The higher E is
taken.

`choose_labels` is this search. `align_board_turns` feeds it with the turns of boards of any pattern
whose corners come from elsewhere, `label_corners` with the turns and offsets that the colours of a
checkerboard leave open. Labels that the deviations do not decide stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray, freeze_ints
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import (
    make_state,
    prepare_observations,
    recover_arguments,
)
from calibgui.engine.calibration.refinement.residuals import linearise_residuals
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.lattices.numbering import list_numberings, place_corners

_MIN_EVIDENCE = 25.0
"""Difference of E to the next best label, in powers of e, from which a label is certain."""
_MIN_EVIDENCE_UPSIDE_DOWN = 3.0
"""Difference of E to the next best label, in powers of e, from which a label is certain for a view
that shows the board upside down, which is evidence as well."""
_MAX_SWEEPS = 10
"""Number of sweeps over the views after which the search for the highest E ends."""
_MAX_MISS = 1e-3
"""Distance within which a turned corner meets another one of the board, mm."""


class Label(NamedTuple):
    """One way to say which corners of the board a view's corners are."""

    points: IntArray
    """(n,) indices of the board's corners."""
    turn: Array
    """Q (3, 3), the motion's turn of the board."""


class LabelChoice(NamedTuple):
    """The label that was chosen for a view."""

    candidate: int
    """Index among the view's candidates."""
    is_certain: bool
    """True if all other candidates are improbable."""


class CornerLabels(NamedTuple):
    """A view's corners on the board."""

    grid: IntArray
    """(n, 2) row and column of each."""
    is_certain: bool
    """True if all other labels are improbable."""


class _Scores(NamedTuple):
    """g and H of the corners that a view shows, under one label."""

    points: IntArray
    """(n,) indices of the board's corners."""
    g: Array
    """(n, 3)"""
    H: Array
    """(n, 3, 3)"""


class _Sums(NamedTuple):
    """g and H of all corners of the board, summed over views."""

    g: Array
    """(m, 3)"""
    H: Array
    """(m, 3, 3)"""


class _GridLabel(NamedTuple):
    """A label of a checkerboard's corners."""

    grid: IntArray
    """(n, 2) row and column of each."""
    turn: Array
    """Q (3, 3), the motion's turn of the board."""


def calibrate_on_nominal_board(
    calibration: Calibration, views: Sequence[Observation]
) -> Calibration:
    """Repeat a calibration on the board as it is drawn, which all labels start from.

    Args:
        calibration: a calibration from these views; it is returned itself if it has no board shape.
        views: the views.
    """
    if calibration.board_shape is None:
        return calibration
    arguments = {**recover_arguments(calibration), "board_shape": BoardShapeModel.NOMINAL}
    return calibrate(views, calibration.camera.size, **arguments)


def align_board_turns(
    calibration: Calibration, views: Sequence[Observation]
) -> tuple[Observation, ...]:
    """Turn the board to lie the same way in all views, as far as its deviations tell.

    Args:
        calibration: a calibration from these views with the image cost, on the board as drawn.
        views: any corners of the board, in which nothing tells the board from a turned one.

    Returns:
        The views. Those that are labelled like most views are the objects that were given.
    """
    places = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    tree = scipy.spatial.cKDTree(places)
    centre = (places.min(axis=0) + places.max(axis=0)) / 2

    def turn(view: Observation, quarters: int) -> Array:
        return np.asarray((view.xy - centre) @ _make_quarter_turn(quarters)[:2, :2].T + centre)

    possible: list[list[int]] = []
    candidates: list[list[Label]] = []
    for view in views:
        found = [tree.query(turn(view, quarters)) for quarters in range(4)]
        possible.append([q for q, hit in enumerate(found) if np.max(hit[0]) < _MAX_MISS])
        candidates.append(
            [Label(np.asarray(found[q][1]), _make_quarter_turn(q)) for q in possible[-1]]
        )
    upside_down = find_upside_down_views(calibration.poses)
    choices = choose_labels(calibration, views, candidates, len(places), upside_down)
    chosen = [turns[choice.candidate] for turns, choice in zip(possible, choices, strict=True)]
    certain = [turns for turns, choice in zip(chosen, choices, strict=True) if choice.is_certain]
    votes = np.bincount(certain, minlength=4)
    usual = int(np.argmax(votes))
    if 2 * votes[usual] <= len(certain):
        return tuple(views)  # nobody can say which are the turned ones
    return tuple(
        view._replace(xy=turn(view, (quarters - usual) % 4))
        if choice.is_certain and quarters != usual
        else view
        for view, quarters, choice in zip(views, chosen, choices, strict=True)
    )


def find_upside_down_views(poses: Sequence[Pose]) -> IntArray:
    """Find the views that show the board turned by some 180 degrees against most others."""
    across = rotation_from_vector(np.array([pose.rvec for pose in poses]))[:, :2, 0]
    across = across / np.linalg.norm(across, axis=1, keepdims=True)
    cosine = across @ across.T
    alike = (cosine > np.sqrt(0.5)).sum(axis=1)
    usual = int(np.argmax(alike))
    if alike[usual] <= 2 / 3 * len(poses):
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(cosine[usual] < -np.sqrt(0.5))


def label_corners(
    calibration: Calibration, corners: Sequence[Corners], board: Board
) -> tuple[CornerLabels, ...]:
    """Label the corners of a checkerboard alike in all views, where the deviations tell how.

    Args:
        calibration: a calibration from these views with the image cost, on the board as drawn.
        corners: the corners of its views.
        board: the board.

    Returns:
        The labels of each view. They are those that it had, and not certain, where nothing can be
        told. The view that the others are labelled like keeps its own.
    """
    grids = [_list_grid_labels(view) for view in corners]
    views = [Observation(view.uv, board.points(view.grid), view.cov) for view in corners]
    row_major = np.array([board.cols, 1])
    candidates = [
        [Label(label.grid @ row_major, label.turn) for label in labels] for labels in grids
    ]
    choices = choose_labels(calibration, views, candidates, board.rows * board.cols)
    return tuple(
        CornerLabels(labels[choice.candidate].grid, choice.is_certain)
        for labels, choice in zip(grids, choices, strict=True)
    )


def has_open_labels(corners: Corners) -> bool:
    """Return whether the pattern leaves open which corners of the board these are."""
    return corners.relative or corners.ambiguity is not Symmetry.NONE


def apply_labels(corners: Corners, labels: CornerLabels) -> Corners:
    """Return the corners under their labels; the same object if these were known or are open."""
    if not labels.is_certain or not has_open_labels(corners):
        return corners
    return replace(corners, grid=labels.grid, relative=False, ambiguity=Symmetry.NONE)


def carry_labels(corners: Corners, before: Corners, after: Corners) -> Corners:
    """Label all corners of a view as some of them were labelled anew.

    Args:
        corners: the view's corners, under the labels of `before`.
        before: some of them, before they were labelled anew.
        after: the same corners under their new labels.
    """
    grids = (each.grid.astype(np.float64) for each in (before, after, corners))
    return replace(
        corners,
        grid=np.rint(carry_places(*grids)).astype(np.int64),
        relative=after.relative,
        ambiguity=after.ambiguity,
    )


def carry_places(before: Array, after: Array, places: Array) -> Array:
    """Move places (n, 2) by the board's motion that takes `before` (m, 2) to `after` (m, 2)."""

    def append_ones(points: Array) -> Array:
        return np.column_stack([points, np.ones(len(points))])

    motion = np.linalg.lstsq(append_ones(before), after)[0]
    return np.asarray(append_ones(places) @ motion)


def choose_labels(
    calibration: Calibration,
    views: Sequence[Observation],
    candidates: Sequence[Sequence[Label]],
    count: int,
    suspects: IntArray | None = None,
) -> list[LabelChoice]:
    """Choose the labels that make the views agree about the board's deviations.

    Args:
        calibration: a calibration from these views with the image cost, on the board as drawn.
        views: the views under the first of their labels.
        candidates: the labels that are possible for each view, the present one first.
        count: m, the number of the board's corners.
        suspects: indices of the views that may well have another label, where most views are known
            to be labelled alike; None where nothing is known.

    Returns:
        The choices. The first label is chosen, and is not certain, where nothing can be told; it is
        chosen in the view that the others are labelled like.
    """
    if all(len(labels) == 1 for labels in candidates):
        return [LabelChoice(0, True)] * len(candidates)
    scores = _compute_scores(calibration, views)
    sigma2 = calibration.noise**2
    s2 = 2 * sigma2 / float(np.mean(np.concatenate([np.trace(H.T) for _, H in scores])))
    turned = [
        [_Scores(label.points, g @ label.turn.T, label.turn @ H @ label.turn.T) for label in labels]
        for labels, (g, H) in zip(candidates, scores, strict=True)
    ]
    needed = np.full(len(candidates), _MIN_EVIDENCE)
    needed[[] if suspects is None else suspects] = _MIN_EVIDENCE_UPSIDE_DOWN
    search = _LabelSearch(turned, sigma2, s2, count, needed)
    optimum = search.find_optimum(range(len(candidates)))
    if suspects is None:
        optimum = max(optimum, search.find_optimum(()))
    return [LabelChoice(index if certain else 0, certain) for index, certain in optimum.choices]


class _Optimum(NamedTuple):
    """Choices that no single view would change."""

    evidence: float
    """E."""
    choices: tuple[tuple[int, bool], ...]
    """(K,) index of the chosen label of each view, and whether it is certain."""


class _LabelSearch(NamedTuple):
    """The views' scores under all of their labels, and the search for the highest E."""

    scores: Sequence[Sequence[_Scores]]
    """(K,) scores of each view, one for each of its labels."""
    sigma2: float
    """Variance of the noise."""
    s2: float
    """Variance of the deviations, in the units of the noise."""
    point_count: int
    """Number of the board's corners."""
    needed: Array
    """(K,) difference of E from which a label is certain."""

    def find_optimum(self, first: Iterable[int]) -> _Optimum:
        """Change one view's label after the other until none would change.

        Args:
            first: the views that count under their present labels until others are certain.
        """
        total = _Sums(np.zeros((self.point_count, 3)), np.zeros((self.point_count, 3, 3)))
        placed = set(first)
        keeps_uncertain = bool(placed)
        for k in placed:
            total = _add_scores(total, self.scores[k][0], 1.0)
        # A view with one label is the reference, or else the view that tells most.
        order = sorted(
            range(len(self.scores)),
            key=lambda k: (len(self.scores[k]) > 1, -len(self.scores[k][0].g)),
        )
        fixed = {*order[: not placed], *(k for k in order if len(self.scores[k]) == 1)}
        chosen, certain = [0] * len(order), [k in fixed for k in range(len(order))]
        for _ in range(_MAX_SWEEPS):
            has_changed = False
            for k in order:
                labels = self.scores[k]
                if k in placed:
                    total = _add_scores(total, labels[chosen[k]], -1.0)
                has_changed |= k not in placed
                placed.add(k)
                if k not in fixed:
                    evidence = [self.compute_evidence(_add_scores(total, s, 1.0)) for s in labels]
                    best, next_best = np.argsort(evidence)[::-1][:2].tolist()
                    certain[k] = bool(evidence[best] > evidence[next_best] + self.needed[k])
                    if best != chosen[k] and (certain[k] or not keeps_uncertain):
                        chosen[k], has_changed = best, True
                total = _add_scores(total, labels[chosen[k]], 1.0)
            if not has_changed:
                break
        return _Optimum(self.compute_evidence(total), tuple(zip(chosen, certain, strict=True)))

    def compute_evidence(self, total: _Sums) -> float:
        """Compute E."""
        stiff = total.H + self.sigma2 / self.s2 * np.eye(3)
        gain = np.sum(total.g * np.linalg.solve(stiff, total.g[..., None])[..., 0]) / self.sigma2
        volume = np.linalg.slogdet(np.eye(3) + total.H * (self.s2 / self.sigma2))[1].sum()
        return float(gain - volume) / 2


def _compute_scores(
    calibration: Calibration, views: Sequence[Observation]
) -> list[tuple[Array, Array]]:
    """Compute g (n, 3) and H (n, 3, 3) of each view's corners."""
    observations = prepare_observations(calibration, views)
    state = make_state(calibration.camera, calibration.poses)
    model = calibration.camera.model
    scores = []
    for k, view in enumerate(views):
        part = slice(k, k + 1)
        r, _, by_pose = linearise_residuals(state, observations, part, model, Cost.IMAGE, 1.0)
        n = len(view.uv)
        B = by_pose[0, :n, :, 3:] @ state.R[k]
        transposed = np.swapaxes(B, 1, 2)
        scores.append((-(transposed @ r[0, :n, :, None])[..., 0], transposed @ B))
    return scores


def _add_scores(total: _Sums, scores: _Scores, sign: float) -> _Sums:
    """Add a view to the sums, or take it out."""
    g, H = total.g.copy(), total.H.copy()
    g[scores.points] += sign * scores.g
    H[scores.points] += sign * scores.H
    return _Sums(g, H)


def _make_quarter_turn(quarters: int) -> Array:
    """Make Q (3, 3) of quarter turns about the board's normal, from x towards -y."""
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters]
    return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], dtype=np.float64)


def _list_grid_labels(corners: Corners) -> list[_GridLabel]:
    """List the labels of a view's corners that its colours allow, the present one first.

    For a part whose place is known these are the turns of the whole board.
    """
    grid_size, grid = corners.shape, corners.grid
    rows, cols = np.indices(grid_size, dtype=np.float64)
    whole = np.stack([rows, cols], axis=-1)
    if corners.relative:
        part = np.full((*grid_size, 2), np.nan)
        part[grid[:, 0], grid[:, 1]] = whole[grid[:, 0], grid[:, 1]]
        low, high = grid.min(axis=0), grid.max(axis=0) + 1
        whole = part[low[0] : high[0], low[1] : high[1]]
    is_first_dark = not corners.relative or int(grid.min(axis=0).sum()) % 2 == 0
    labels = []
    for numbering in list_numberings(Lattice(whole, is_first_dark), grid_size):
        if not numbering.dark:
            continue
        places, present, _ = place_corners(numbering)  # `present` holds the present labels
        by_present = np.full((*grid_size, 2), -1, dtype=np.int64)
        by_present[tuple(present.astype(np.int64).T)] = places
        numbered = freeze_ints(by_present[grid[:, 0], grid[:, 1]])
        labels.append(_GridLabel(numbered, _make_quarter_turn(numbering.quarters)))
    labels.sort(key=lambda label: not np.array_equal(label.grid, grid))
    return labels

"""Photographs that do not belong to the others: turned by a program, or not of this camera at all.

Which view does not belong is asked before any cause is sought in all of them. A program may have
turned a photograph by half a turn, or mirrored it: it is one of the camera once it is turned back,
with no unknowns more. So every view may be read in a few ways, and the question is which reading
suits the others.

The answer follows from products of derivatives at the solution. With A the derivatives of a view's
residuals by the camera and e the residuals, the view's pose eliminated, a step d of the camera
leaves |e + A d|^2 of it. Turned back, with the pose fitted to the camera, it has another A and e.
Let J be the least sum over views, each in its reading, for a step that they share. What view k
loses by sharing its camera with the others is

    E = J(all) - J(all without k) - min |e_k + A_k d|^2,

the last term being what a camera of its own would leave of it as it is. If nothing is wrong, E is
the noise's variance times the number of the camera's parameters, and more by as much as views
disagree. So it is counted in units of its median over the views, and what a good view reaches is
taken from real photographs.

At first all views are read as they are. The view that gains most by another reading takes it, until
none does: a view that is read wrongly draws the camera, so that good ones look odd beside it. A
view that suits the others in no reading counts as a stranger, which is left out of J. Several that
are turned hide each other, as they draw the camera together: so cameras of half of the views are
tried as well, and what costs least is taken. A board of free shape takes a part of a turned view's
errors up: where it was estimated and all views suit each other, they are read on the board as it is
drawn as well. Under a lens in the middle of the image a turned view
is not to be told, and does no harm.

Where as many are turned as are not, none stands out. Then the views part in two kinds
(``mixed_views.py``). Two cameras of one make, each with its principal point somewhere near the
middle, look turned to some degree as well. What tells is E of all the odd views together: if they
were turned, a camera of their own leaves hardly less of them. A lens that the model does not follow
makes some look turned, too: turned back they have to leave less than a lens of another kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.causes.mixed_views import MAX_SEEDS
from calibgui.engine.assessment.finding import MIN_VIEWS_TO_JUDGE
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import (
    compute_reductions,
    multiply_columns,
    prepare_fit,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.problem import prepare_observations, recover_image_arguments
from calibgui.engine.calibration.refinement.residuals import Linearised
from calibgui.engine.calibration.repetition import repeat_calibration
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.calibration.score_tests import LinearisedFit
from calibgui.engine.errors import CalibrationError

_TURNS = {
    (-1, -1): ("upside down", "turn them by 180 degrees"),
    (-1, 1): ("mirrored left to right", "mirror them left to right"),
    (1, -1): ("mirrored top to bottom", "mirror them top to bottom"),
}
"""Ways in which a program may have turned what the camera wrote, by the signs of the coordinates:
how the images stand, and what turns them back. A view's reading is 0 as it is, the number of its
turn, counted from 1, or that behind them, of a stranger."""
_STRANGER = 1 + len(_TURNS)
_COST_OF_TURN = 2.0
"""Median E that a view must gain to be read turned back: of 60 real sets of clean photographs none
gained more than 0.6 (``tests/benchmarks/wrong_views.py``). Nor may a kind of turned views lose more
than twice as much: halves of five real sets lost 2.1 at most, the second cameras of two real pairs
9 at least."""
_COST_OF_STRANGER = 30.0
"""Median E from which a view is a stranger. Good views reached 24 in real sets, with the board's
shape estimated, which leaves next to nothing of them (``tests/benchmarks/wrong_views.py``)."""
_COSTS = np.array([0.0, *[_COST_OF_TURN] * len(_TURNS), _COST_OF_STRANGER])
"""What each reading costs, beside E."""
_MAX_DISAGREEMENT_LEFT = 0.8
"""Overdispersion with the odd views turned back, over that before, from which something else is
wrong with all views: of rendered ones whose rows were read in motion or that were stabilised it was
0.84 at least; of 40 real sets with turned views it was less, but for eleven in which these hardly
moved the camera."""


class Turned(NamedTuple):
    """Photographs that are turned against the others."""

    views: tuple[int, ...]
    """Their indices."""
    how: str
    """Way in which they stand, such as "upside down"."""
    remedy: str
    """The instruction that turns them back."""
    calibration: Calibration
    """The calibration of all views with these turned back."""


class Strangers(NamedTuple):
    """Photographs that do not belong to the others in any reading."""

    views: tuple[int, ...]
    """Their indices."""
    others: Calibration
    """The calibration of the other views."""


class OddViews(NamedTuple):
    """All photographs that do not belong to the others; None where there are none of a kind."""

    turned: Turned | None = None
    strangers: Strangers | None = None


def find_odd_views(case: Case) -> OddViews:
    """Find photographs that are turned against the others, or do not belong to them.

    Nobody is asked about where the views agree as noise lets them.
    """
    if len(case.views) < MIN_VIEWS_TO_JUDGE or not case.calibration.overdispersion > 0:
        return OddViews()
    try:
        chosen = _Readings(case).choose()
        if not chosen.any() and case.calibration.settings.board_shape is BoardShapeModel.FREE:
            chosen = _Readings(_take_board_as_drawn(case)).choose()
    except CalibrationError:
        return OddViews()
    readings = np.where(chosen == _STRANGER, 0, chosen)
    turned = _describe_turned(case, readings, sorted({*readings.tolist()} - {0}))
    odd = np.flatnonzero(chosen == _STRANGER).tolist()
    if not odd:
        return OddViews(turned)
    others = _calibrate(case, [view for k, view in enumerate(case.views) if k not in odd])
    return OddViews(turned, None if others is None else Strangers(tuple(odd), others))


def _take_board_as_drawn(case: Case) -> Case:
    """Return a case with the calibration from its views on the board as it is drawn.

    Raises:
        CalibrationError: if they determine no camera then.
    """
    drawn = repeat_calibration(
        case.calibration, case.views, board_shape=BoardShapeModel.NOMINAL, prior=None
    )
    return replace(case, calibration=drawn)


def find_turn(case: Case, is_odd: BoolArray) -> Turned | None:
    """Find out whether the views of one kind (K,) are turned against the others; None if not."""
    try:
        costs = _Readings(case).measure_turns(is_odd)
    except CalibrationError:
        return None
    if not costs.min() < 2 * _COST_OF_TURN:
        return None
    alike = 1 + np.flatnonzero(costs < costs.min() + _COST_OF_TURN)
    chosen = np.where(is_odd, 1 + int(np.argmin(costs)), 0)
    return _describe_turned(case, chosen, alike.tolist())


def _describe_turned(case: Case, chosen: IntArray, turns: Sequence[int]) -> Turned | None:
    """Describe views (K,) of which some are read turned back, in ways among `turns`; None if none
    are, if they are no views of a camera then, or if a lens of another kind leaves less."""
    if not chosen.any():
        return None
    words = [list(_TURNS.values())[turn - 1] for turn in turns]
    how, back = (" or ".join(said) for said in zip(*words, strict=True))
    calibration = _calibrate(case, _turn_back(case, chosen))
    if calibration is None:
        return None
    if calibration.overdispersion >= _MAX_DISAGREEMENT_LEFT * case.calibration.overdispersion:
        return None
    if summarise_residuals(calibration.residuals).rms > case.rms * np.sqrt(1 - case.rival.share):
        return None  # as they are they suit a lens that the model does not follow
    views = tuple(np.flatnonzero(chosen).tolist())
    return Turned(views, how, f"{back[:1].upper()}{back[1:]}", calibration)


def _calibrate(case: Case, views: list[Observation]) -> Calibration | None:
    """Calibrate some views with the settings of the case; None if they determine no camera."""
    settings = recover_image_arguments(case.calibration)
    try:
        return calibrate(views, case.calibration.camera.size, **settings)
    except CalibrationError:
        return None


def _turn_back(case: Case, chosen: IntArray) -> list[Observation]:
    """Return the views of a case (K,), each turned back if the reading chosen for it is a turn.

    A board that is seen in a mirror is numbered from its other side.
    """
    sides = np.concatenate([view.xy[:, 0] for view in case.views])
    ends, size = float(sides.min() + sides.max()), case.calibration.camera.size
    return [
        turn_view(view, list(_TURNS)[turn - 1], size, ends) if turn else view
        for view, turn in zip(case.views, chosen.tolist(), strict=True)
    ]


def turn_view(view: Observation, turn: tuple[int, int], size: Size, ends: float) -> Observation:
    """Return a view whose image is turned.

    Args:
        view: the view.
        turn: the signs of the image's coordinates.
        size: the image's size, px.
        ends: sum of the least and the largest X of the board's corners, mm.
    """
    sign, last = np.array(turn), np.array(size) - 1
    xy = view.xy
    if sign.prod() < 0:
        xy = np.column_stack([ends - xy[:, 0], xy[:, 1]])
    cov = None if view.cov is None else view.cov * np.outer(sign, sign)
    return Observation(np.where(sign < 0, last - view.uv, view.uv), xy, cov)


class _Readings:
    """The views of a case in all readings, each as a quadratic form of what they share.

    Beside the camera's parameters that is a board which is bent or stretched: a mirror image of it
    looks like that of another.

    Raises:
        CalibrationError: from all methods, if a view that is turned back has no pose.
    """

    def __init__(self, case: Case) -> None:
        self.case = case
        self.fit = prepare_fit(case.calibration, case.views)
        as_it_is = multiply_columns(self.fit, self._make_board_columns)
        self.forms = np.full((_STRANGER + 1, *as_it_is.shape), np.nan)
        """Products (R, K, S + 1, S + 1) of the columns [what is shared, residuals] of every reading
        and view: NaN if not read yet, 0 for a stranger."""
        self.forms[0], self.forms[_STRANGER] = as_it_is, 0.0
        self.alone = _minimise(as_it_is)
        """What a camera and a board of its own leave (K,) of each view."""

    def choose(self) -> IntArray:
        """Choose a reading (K,) for each view."""
        chosen = np.zeros(self.forms.shape[1], dtype=np.int64)
        self._descend(chosen)
        other = self._seek_camera(chosen)
        self._descend(other)
        unit = _find_unit(self._measure_losses(other), other)
        return min(chosen, other, key=lambda readings: self._sum_costs(readings, unit))

    def _descend(self, chosen: IntArray) -> None:
        """Change the readings that are `chosen` (K,) as long as views gain by it, first of those
        that gain most."""
        each = np.arange(len(chosen))
        E = self._measure_costs(chosen)
        for _ in range(2 * len(chosen)):
            self.case.check()
            if self._read(E[0] > _COST_OF_TURN):
                E = self._measure_costs(chosen)
            costs = E + _COSTS[:, None]
            gain = costs[chosen, each] - costs.min(axis=0)
            if not gain.max() > 0:
                break
            most = 2 * gain > gain.max()
            chosen[most] = np.argmin(costs[:, most], axis=0)
            E = self._measure_costs(chosen)

    def _seek_camera(self, chosen: IntArray) -> IntArray:
        """Seek the camera for which views that are no strangers are best read, most as they are.

        It begins with cameras of half of the views each, whose rounds (Lloyd 1982) take the best
        reading of each view and the best camera for these in turn.
        """
        self._read(np.ones(len(chosen), dtype=bool))
        each, known = np.arange(len(chosen)), np.flatnonzero(chosen != _STRANGER)
        best, least, half = chosen, np.inf, (len(known) + 1) // 2
        for first in np.unique(np.linspace(0, len(known) - 1, MAX_SEEDS).astype(int)).tolist():
            now = np.full(len(chosen), _STRANGER)
            now[np.roll(known, first)[:half]] = 0
            for _ in range(len(known)):
                before, step = now, _find_step(self.forms[now, each].sum(axis=0))
                left = self.forms[:_STRANGER, known] @ step @ step
                now = np.full(len(chosen), _STRANGER)
                now[known] = np.argmin(left, axis=0)
                if (now == before).all():
                    break
            J = float(left.min(axis=0).sum())
            if J < least and np.sum(now[known] > 0) < half:
                best, least = now, J
        return best.copy()

    def measure_turns(self, is_odd: BoolArray) -> Array:
        """Measure what odd views (K,) lose together by sharing their camera with the others, for
        each turn, in units of what views lose among their kind."""
        self._read(is_odd)
        kinds = [self.forms[0, kind].sum(axis=0) for kind in (is_odd, ~is_odd)]
        rest = np.where(is_odd[:, None, None], *kinds) - self.forms[0]
        lost = _minimise(rest + self.forms[0]) - _minimise(rest) - self.alone
        odd, others = _minimise(np.array(kinds))
        together = _minimise(self.forms[1:_STRANGER, is_odd].sum(axis=1) + kinds[1])
        return np.asarray((together - odd - others) / np.median(lost))

    def _sum_costs(self, chosen: IntArray, unit: float) -> float:
        """Sum up what the readings (K,) cost, and J in a unit."""
        J = _minimise(self.forms[chosen, np.arange(len(chosen))].sum(axis=0))
        return float(J / unit + _COSTS[chosen].sum())

    def _measure_costs(self, chosen: IntArray) -> Array:
        """Measure E (R, K) of every view in every reading beside the others as they are `chosen`,
        in units of the median; 0 of strangers, and infinite where a view was not read."""
        lost = self._measure_losses(chosen)
        E = lost / _find_unit(lost, chosen)
        E[_STRANGER] = 0.0
        return np.asarray(E)

    def _measure_losses(self, chosen: IntArray) -> Array:
        """Measure E (R, K) as `_measure_costs`, but in the unit of the sums of squares."""
        taken = self.forms[chosen, np.arange(len(chosen))]
        rest = taken.sum(axis=0) - taken
        return np.asarray(_minimise(rest + self.forms) - _minimise(rest) - self.alone)

    def _read(self, wanted: BoolArray) -> bool:
        """Read those of the views (K,) that are wanted in all turns, unless they were already;
        return whether there were any."""
        unread = np.flatnonzero(wanted & np.isnan(self.forms[1, :, 0, 0]))
        if not len(unread):
            return False
        turned: list[Observation] = []
        for turn in range(1, _STRANGER):
            views = _turn_back(self.case, np.where(wanted, turn, 0))
            turned += [views[k] for k in unread]
        fit = _fit_poses(self.case, self.fit, turned, int(unread[0]))
        forms = multiply_columns(fit, self._make_board_columns)
        self.forms[1:_STRANGER, unread] = forms.reshape(-1, len(unread), *forms.shape[1:])
        return True

    def _make_board_columns(self, fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
        """Make the columns (k, N, 2, 5) of a board that is bowed, twisted, stretched or sheared."""
        low, high = self.fit.extent
        xy = (2 * fit.observations.xy[views, :, :2] - low - high) / (high - low)
        x, y = xy[..., None, 0], xy[..., None, 1]
        by_place = linear.by_pose[..., 3:] @ fit.state.R[views, None]
        bent = by_place[..., 2:] * np.stack([x * x, x * y, y * y], axis=-1)
        return np.concatenate([bent, by_place[..., :2] * y[..., None]], axis=-1)


def _fit_poses(
    case: Case, fit: LinearisedFit, views: Sequence[Observation], first: int
) -> LinearisedFit:
    """Fit the poses of other views to the camera of a case; they weigh as those of the case do, of
    which the view at index `first` is the first one turned."""
    start = estimate_poses(fit.camera, pack_observations(views))
    observations = prepare_observations(case.calibration, views)
    if observations.whitening is not None and fit.observations.whitening is not None:
        # Whitened by themselves they are in units of their own median noise.
        unit = np.linalg.norm(fit.observations.whitening[first, 0])
        unit /= np.linalg.norm(observations.whitening[0, 0])
        observations = replace(observations, whitening=unit * observations.whitening)
    state = refine_poses(start, observations, fit.camera.model, case.calibration.cost)
    return LinearisedFit(fit.camera, state, observations, fit.free)


def _find_unit(lost: Array, chosen: IntArray) -> float:
    """Find the median of what views lose (R, K) in the readings chosen (K,), without strangers."""
    return float(np.median(lost[chosen, np.arange(len(chosen))][chosen != _STRANGER]))


def _find_step(form: Array) -> Array:
    """Return the step (S + 1,) that a form (S + 1, S + 1) is least for, and 1."""
    N, g = form[:-1, :-1], form[:-1, -1]
    unit = 1 / np.sqrt(np.maximum(np.diag(N), np.finfo(float).tiny))
    return np.append(
        -unit * (np.linalg.pinv(N * np.outer(unit, unit), hermitian=True) @ (unit * g)), 1.0
    )


def _minimise(forms: Array) -> Array:
    """Return the least values (...) of forms (..., S + 1, S + 1); infinite where there is none."""
    least = np.full(forms.shape[:-2], np.inf)
    known = np.isfinite(forms).all(axis=(-2, -1))
    F = forms[known]
    least[known] = F[:, -1, -1] - compute_reductions(F[:, :-1, :-1], F[:, :-1, -1])[0]
    return least

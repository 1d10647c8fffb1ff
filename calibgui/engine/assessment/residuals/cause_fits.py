"""Causes are fitted to the residuals, and compared by what they explain and their unknowns.

A score test (``calibration/score_tests.py``) takes one step from where a calibration stands. Where
a cause is large, poses and camera have moved far to make up for it, and one step leads part of the
way only: of five views of a board whose squares are 2 % too high it finds that unequal squares
explain 60 % of the residuals, and a motion in each view, with its many unknowns, 71 %. Fitted, they
explain 80 % and 79 %, which is all but noise. So causes with few unknowns are fitted, beside the
camera's parameters c and the poses p: with the residuals

    r(c, p, a, x) = r(c, p, B a) + X(c, p) x,

in which the board's corners are displaced by B a in all views, or each view has an x of its own,
the sum of squares is minimised by Levenberg and Marquardt's method. Its normal equations are an
arrow, as those of bundle adjustment (``refinement/schur.py``), of which each view's block holds its
pose and its x. X is linear in x, and follows the camera and the poses from step to step. Where
noise would explain as much as the first step does, that one is enough.

A cause with more unknowns follows any other better. Causes are compared by Akaike's criterion
(1974), relative to a fit without any, for errors that are not independent (Lebreton et al. 1992):

    A = nu / d ln(r^T r / r0^T r0) + 2 m,

nu being the number of residual coordinates beyond that of the fitted unknowns, m the number of
unknowns that the cause has, and d how much more of the errors an unknown takes than if they were
independent (``systematic_errors.OpenSteps``). The least A is that of the cause which is
likely to predict other corners best, and without a cause it is 0. Schwarz's criterion, which has
ln nu for 2, is for causes all of whose unknowns depend on all corners: it takes motions of some
tenths of a pixel for a changing focus, which has a sixth of their unknowns.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.parametrisation import index_board_points, make_basis
from calibgui.engine.calibration.observations import slice_views
from calibgui.engine.calibration.refinement.residuals import Linearised
from calibgui.engine.calibration.score_tests import (
    Explanation,
    LinearisedFit,
    judge_explanation,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError

MIN_LEAD = 4.0
"""Difference of Akaike's criterion from the next cause, from which one is named: that has
considerably less support (Burnham and Anderson 2002)."""
_MAX_STEPS = 5
"""Number of steps of a fit, at most."""
_MIN_DESCENT = 1e-3
"""Part of the sum of squares by which a step lowers it, below which a fit is at its end."""
_FIRST_DAMPING, _MORE_DAMPING, _LESS_DAMPING = 1e-4, 30.0, 0.1
"""Damping of the first step, in units of the columns' squares, and what multiplies it after a step
that does not lead down, and after one that does."""
MIN_EIGENVALUE = 1e-9
"""Eigenvalue of normal equations of unit diagonal, below which a direction is undetermined."""

_MIN_CHANCE = 0.05
"""Probability that noise explains as much as the first step, above which no other is taken: where
little is explained the sum of squares is a parabola. It takes most of the time where nothing is
wrong."""

Columns = Callable[[LinearisedFit, Linearised, slice], Array]
"""Function that returns the whitened columns (k, N, 2, m) that some views have of their own, from a
fit and its derivatives there."""


class CauseFit(NamedTuple):
    """A fit beside which a cause has unknowns."""

    cost: float
    """The sum of squares r^T r that is left."""
    unknowns: int
    """Number m of unknowns that the cause has."""

    def lower(self, T: float, rank: int) -> CauseFit:
        """Return the fit whose cost further columns of this rank lower by T, in one step."""
        return CauseFit(self.cost - T, self.unknowns + rank)

    def compute_akaike(self, without: CauseFit, freedom: int, dispersion: float) -> float:
        """Compute A against a fit `without` a cause, which has so many degrees of freedom.

        It is infinite where the unknowns are as many, so that they would explain anything.
        """
        if self.unknowns >= freedom:
            return np.inf
        ratio = max(self.cost, 1e-300) / max(without.cost, 1e-300)
        return float(freedom / dispersion * np.log(ratio) + 2 * self.unknowns)

    def judge(self, without: CauseFit, freedom: int) -> Explanation:
        """Judge what the cause explains of the residuals of a fit `without` any."""
        return judge_explanation(without.cost - self.cost, self.unknowns, without.cost, freedom)


class _Products(NamedTuple):
    """Products of the columns: S those of camera and a, v those of each view's pose and x."""

    U: Array
    """(S, S)."""
    W: Array
    """(K, v, S)."""
    V: Array
    """(K, v, v)."""
    by_shared: Array
    """(S,) products with the residuals."""
    by_view: Array
    """(K, v) products with the residuals."""
    cost: float
    """r^T r; NaN where a corner has no prediction."""


class _Trial(NamedTuple):
    """Values of the unknowns: those of camera and poses are the fit's."""

    fit: LinearisedFit
    a: Array
    """(Q,)."""
    x: Array
    """(K, m)."""


def fit_nothing(fit: LinearisedFit) -> CauseFit:
    """Fit camera and poses alone, whose minimum is elsewhere where views were weighed."""
    return fit_own_cause(fit, lambda _, linear, __: linear.by_pose[..., :0])


def fit_own_cause(fit: LinearisedFit, columns: Columns) -> CauseFit:
    """Fit a cause that each view has of its own."""
    K = len(fit.state.R)
    m = columns(fit, fit.linearise(slice(0, 1)), slice(0, 1)).shape[-1]
    first = _Trial(fit, np.zeros(0), np.zeros((K, m)))
    found, V = _minimise(first, columns, None)
    return CauseFit(found, int(sum(np.sum(np.linalg.eigvalsh(V) > MIN_EIGENVALUE, axis=1) - 6)))


def fit_board(fit: LinearisedFit, model: BoardShapeModel) -> CauseFit:
    """Fit a board of another shape, by a model with few unknowns."""
    flat, index = index_board_points(fit.observations)
    basis = make_basis(model, flat)[index]
    first = _Trial(fit, np.zeros(basis.shape[-1]), np.zeros((len(index), 0)))
    return CauseFit(_minimise(first, None, basis)[0], basis.shape[-1])


def _minimise(trial: _Trial, columns: Columns | None, basis: Array | None) -> tuple[float, Array]:
    """Minimise the sum of squares.

    Returns:
        The sum of squares, and the first products (K, v, v) of the views' columns of length 1.
    """
    first = products = _multiply(trial, columns, basis)
    unit = _find_units(np.diagonal(first.V, axis1=1, axis2=2))
    of_length_1 = first.V * unit[:, :, None] * unit[:, None]
    damping = _FIRST_DAMPING
    step = _solve(products, damping)
    descent = -float(step[0] @ first.by_shared + np.sum(step[1] * first.by_view))
    unknowns = len(trial.a) + trial.x.size
    if unknowns and _is_chance(descent, unknowns, first.cost, trial.fit.degrees_of_freedom):
        return first.cost - descent, of_length_1
    for _ in range(_MAX_STEPS):
        following = _take_step(trial, *step)
        found = _multiply(following, columns, basis) if following is not None else None
        if following is None or found is None or not found.cost < products.cost:
            damping *= _MORE_DAMPING
        else:
            is_end = products.cost - found.cost < _MIN_DESCENT * products.cost
            trial, products, damping = following, found, _LESS_DAMPING * damping
            if is_end:
                break
        step = _solve(products, damping)
    return products.cost, of_length_1


def _is_chance(descent: float, unknowns: int, cost: float, freedom: int) -> bool:
    """Return whether noise would let so many unknowns lower the sum of squares as much."""
    found = judge_explanation(descent, unknowns, cost, freedom)
    return bool(found.probability > _MIN_CHANCE)


def _multiply(trial: _Trial, columns: Columns | None, basis: Array | None) -> _Products:
    """Multiply the columns of all unknowns with each other and with the residuals."""
    fit, parts, U = trial.fit, [], np.zeros(())
    if basis is not None:
        fit = _displace_board(fit, basis @ trial.a)
    for views in slice_views(len(fit.state.R)):
        linear = fit.linearise(views)
        r, shared, own = linear.residual, linear.by_params[..., fit.free], linear.by_pose
        if basis is not None:
            by_corner = linear.by_pose[..., 3:] @ fit.state.R[views, None]
            shared = np.concatenate([shared, by_corner @ basis[views]], axis=-1)
        if columns is not None:
            X = columns(fit, linear, views)
            r = r + (X @ trial.x[views, None, :, None])[..., 0]
            own = np.concatenate([own, X], axis=-1)
        J = np.concatenate([shared, r[..., None]], axis=-1)
        J, own = J.reshape(len(r), -1, J.shape[-1]), own.reshape(len(r), -1, own.shape[-1])
        turned = np.swapaxes(own, 1, 2)
        parts.append(np.concatenate([turned @ own, turned @ J], axis=-1))
        U = U + (np.swapaxes(J, 1, 2) @ J).sum(axis=0)
    N, v = np.concatenate(parts), own.shape[-1]
    return _Products(
        U[:-1, :-1], N[..., v:-1], N[..., :v], U[:-1, -1], N[..., -1], float(U[-1, -1])
    )


def _displace_board(fit: LinearisedFit, displacement: Array) -> LinearisedFit:
    """Return a fit whose board's corners (K, N) are displaced (K, N, 3), mm."""
    xy = fit.observations.xy
    flat = np.zeros((*xy.shape[:2], 3 - xy.shape[-1]))
    moved = np.concatenate([xy, flat], axis=-1) + displacement
    return replace(fit, observations=replace(fit.observations, xy=moved))


def _solve(products: _Products, damping: float) -> tuple[Array, Array]:
    """Return the damped step (S,) of the shared unknowns and (K, v) of the views'."""
    U, W, V, by_shared, by_view, _ = products
    S, v = len(U), V.shape[-1]
    of_shared, of_view = _find_units(np.diagonal(U)), _find_units(np.diagonal(V, axis1=1, axis2=2))
    scaled = V * of_view[:, :, None] * of_view[:, None] + damping * np.eye(v)
    right = np.concatenate([W * of_shared, by_view[..., None]], axis=-1) * of_view[..., None]
    solved = np.linalg.solve(scaled, right)
    left = np.swapaxes(right[..., :S], 1, 2) @ solved
    reduced = U * np.outer(of_shared, of_shared) + damping * np.eye(S) - left[..., :S].sum(axis=0)
    step = -np.linalg.solve(reduced, of_shared * by_shared - left[..., S].sum(axis=0))
    return of_shared * step, -of_view * (solved[..., S] + solved[..., :S] @ step)


def _find_units(square: Array) -> Array:
    """Return what columns of these squares are divided by, 0 where no corner depends on one."""
    return np.where(square > 0, 1 / np.sqrt(np.where(square > 0, square, 1.0)), 0.0)


def _take_step(trial: _Trial, by_shared: Array, by_view: Array) -> _Trial | None:
    """Return the unknowns after a step; None if no camera has such parameters."""
    fit, P = trial.fit, len(trial.fit.free)
    state = fit.state.take_step(by_shared[:P], by_view[:, :6], fit.free)
    try:
        camera = Camera(fit.camera.size, state.params, fit.camera.model)
    except CalibrationError:
        return None
    moved = replace(fit, camera=camera, state=state)
    return _Trial(moved, trial.a + by_shared[P:], trial.x + by_view[:, 6:])

"""Levenberg-Marquardt for arrow-shaped normal equations.

Every residual depends on the shared parameters and on one view's pose only, so that

              [ U    W1 .. WK ]                U  = sum_k Jc_k^T Jc_k     (P, P)
    J^T J  =  [ W1^T V1       ]                Wk = Jc_k^T Jp_k           (P, 6)
              [ ..       ..   ]                Vk = Jp_k^T Jp_k           (6, 6)
              [ WK^T       VK ]

Eliminating the poses leaves the Schur complement

    S = U - sum_k Wk Vk^-1 Wk^T,      S dc = -(gc - sum_k Wk Vk^-1 gk),
    dk = -Vk^-1 (gk + Wk^T dc),

a cost linear in the number of views. Marquardt's damping lambda diag(J^T J) makes the steps
independent of the parameters' units; S is further scaled to a unit diagonal of J^T J before
it is solved.

The iteration has converged when the decrease that the linear model still predicts is below
1e-12 of the cost: the unknowns are then within about 1e-6 sqrt(2N) of their standard
deviations of the minimum. A slight step that does what was foreseen leaves J^T J as it was but
for a hundredth: its factors serve again.

Where the sums come from is the caller's choice: `normal_equations` below adds them up from
residuals and derivatives, in chunks of views so that memory does not grow with their number;
``kernels`` does the same compiled.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from calibgui.engine.errors import CalibrationError
from calibgui.engine.observations import chunks
from calibgui.engine.stage_two import Linearised, State
from calibgui.engine.types import Array, IntArray, Iteration, Report, Status

_ELIMINATED = 1024
"""Views whose poses are eliminated together, which bounds the memory that takes."""
_CONVERGED = 1e-12
_SLIGHT = 1e-4
"""Decrease of a step, relative to the cost, that leaves J^T J as it was to a hundredth."""
_SETTLED = 1e-6
"""Decrease that a full step still predicts, relative to the cost, where damped ones fail."""
_ROUNDING = 1e-26
"""Cost below which the residuals are rounding errors, relative to the squared data."""
_DAMPING = 1e-6
"""To start with: less than the information that good views leave (``uncertainty.py``)."""
_MAX_DAMPING = 1e12

Linearise = Callable[[State, slice], Linearised]
"""Whitened residuals of a slice of the views, zero (with zero derivatives) for padding."""
NormalAt = Callable[[State], "NormalEquations"]
"""The normal equations of the free parameters; infinite cost where a corner has no prediction."""


class StartError(CalibrationError):
    """The residuals at the start have no value."""


class NormalEquations(NamedTuple):
    """The blocks of J^T J and J^T r, for the free shared parameters."""

    U: Array
    W: Array
    V: Array
    shared: Array
    """(P,) gradient."""
    pose: Array
    """(K, 6) gradient."""
    cost: float
    """r^T r."""
    costs: Array
    """(K,) of each view."""


class Reduced(NamedTuple):
    """What is left of the normal equations without the poses."""

    S: Array
    """(P, P) Schur complement."""
    gradient: Array
    """(P,) gc - sum_k Wk Vk^-1 gk."""
    roots: Array
    """(K, 6, 6) L^-1 for Vk = L L^T."""
    unit: Array
    """(P,) what scales J^T J to a unit diagonal."""

    @property
    def scaled(self) -> Array:
        """(P, P) S in these units."""
        scaled = self.S * self.unit
        scaled *= self.unit[:, None]
        return scaled

    def stiffened(self, added: Array) -> Reduced:
        """With (P, P) added to the shared parameters' block of J^T J."""
        unit = 1 / np.sqrt(self.unit**-2 + np.diag(added))
        return self._replace(S=self.S + added, unit=unit)


class Factored(NamedTuple):
    """What solves reduced normal equations."""

    reduced: Reduced
    inverse: Callable[[Array], Array]
    """From (P,) to S^-1 times it, both scaled; the shortest solution if S is singular."""

    def at(self, normal: NormalEquations) -> Factored:
        """The same J^T J with the gradient of normal equations close by."""
        gradient = _gradient(normal, self.reduced.roots)
        return self._replace(reduced=self.reduced._replace(gradient=gradient))


class Solution(NamedTuple):
    """Where the iteration ended."""

    state: State
    normal: NormalEquations
    """At `state`, undamped."""
    history: tuple[Iteration, ...]
    status: Status
    barred: bool = False
    """Whether it did not converge and states without residuals barred its way."""


def minimise(
    normal_at: NormalAt,
    start: State,
    free: IntArray,
    count: int,
    data_square: float,
    report: Report | None = None,
    max_iterations: int = 100,
    earlier: Sequence[Iteration] = (),
) -> Solution:
    """Minimise the sum of squared residuals.

    Args:
        normal_at: the problem.
        start: where to begin.
        free: (P,) indices of the shared parameters that may move.
        count: number of corners, for the RMS of the iteration records.
        data_square: sum of the squared data, which sets the level of rounding errors.
        report: told of each iteration; may stop it.
        max_iterations: accepted and rejected steps together.
        earlier: iterations of the solve that this one continues, with its last damping.

    Raises:
        StartError: if the residuals at the start are not finite.
        Cancelled: from `report`.
    """
    began = time.perf_counter() - (earlier[-1].seconds if earlier else 0.0)
    state, damping = start, earlier[-1].damping if earlier else _DAMPING
    normal = normal_at(state)
    if not np.isfinite(normal.cost):
        raise StartError(
            "The closed-form start does not reproject the corners.",
            "Check that the views number their corners alike and come from one camera.",
        )
    history = list(earlier)
    barred, factored = False, None

    def record(step: float) -> bool:
        iteration = Iteration(
            index=len(history),
            cost=normal.cost,
            rms=float(np.sqrt(normal.cost / count)),
            gradient=_scaled_gradient(normal),
            step=step,
            damping=damping,
            seconds=time.perf_counter() - began,
        )
        history.append(iteration)
        return report is None or report(iteration)

    def ended(status: Status) -> Solution:
        return Solution(state, normal, tuple(history), status)

    if not earlier and not record(0.0):
        return ended(Status.STOPPED)
    for _ in range(max_iterations):
        factored = factored.at(normal) if factored else _factored(schur(normal, damping))
        by_shared, by_pose = _step(normal, factored)
        decrease = _decrease(normal, by_shared, by_pose)
        small = decrease <= _CONVERGED * normal.cost
        exact = normal.cost <= _ROUNDING * data_square
        if small or exact or damping > _MAX_DAMPING:
            break
        full = np.zeros(len(state.params))
        full[free] = by_shared
        trial = state.moved(full, by_pose)
        trial_normal = normal_at(trial)
        if trial_normal.cost < normal.cost:
            length = _scaled_length(normal, by_shared, by_pose)
            gained = normal.cost - trial_normal.cost
            foreseen = damping <= _DAMPING and abs(gained - decrease) <= 0.1 * decrease
            if not foreseen or decrease > _SLIGHT * normal.cost:
                factored = None
            state, normal = trial, trial_normal
            damping = max(damping / 10, 1e-12)
            if not record(length):
                return ended(Status.STOPPED)
        else:
            damping *= 10
            factored = None
            barred |= not np.isfinite(trial_normal.cost)
    else:
        return ended(Status.MAX_ITERATIONS)._replace(barred=barred)
    # Damping makes steps small as well, against a wall of states that cannot be imaged; not
    # where it is below the information that rounding leaves (1e-12) over `_SETTLED`.
    slight = exact or (small and damping * 1e12 <= _SETTLED / _CONVERGED)
    if slight or _decrease(normal, *solve(normal, 0.0)) <= _SETTLED * normal.cost:
        return ended(Status.CONVERGED)
    return ended(Status.MAX_ITERATIONS)._replace(barred=barred)


def normal_equations(linearise: Linearise, state: State, free: IntArray) -> NormalEquations:
    """Accumulate J^T J and J^T r over the views, chunk by chunk."""
    K, P = len(state.R), len(free)
    U, W, V = np.zeros((P, P)), np.empty((K, P, 6)), np.empty((K, 6, 6))
    shared, pose, costs = np.zeros(P), np.empty((K, 6)), np.empty(K)
    for views in chunks(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            r, by_params, by_pose = linearise(state, views)
            k = len(r)
            r = r.reshape(k, -1, 1)
            Jc = by_params.reshape(k, -1, by_params.shape[-1])[..., free]
            Jp = by_pose.reshape(k, -1, 6)
            costs[views] = np.sum(r * r, axis=(1, 2))
            JcT, JpT = np.swapaxes(Jc, 1, 2), np.swapaxes(Jp, 1, 2)
            U += (JcT @ Jc).sum(axis=0)
            W[views], V[views] = JcT @ Jp, JpT @ Jp
            shared += (JcT @ r)[..., 0].sum(axis=0)
            pose[views] = (JpT @ r)[..., 0]
    return NormalEquations(U, W, V, shared, pose, *summed(costs))


def summed(costs: Array) -> tuple[float, Array]:
    """The sum of the views' costs, and these; infinite where they have no value."""
    costs = np.where(np.isfinite(costs), costs, np.inf)
    return float(costs.sum()), costs


def schur(normal: NormalEquations, damping: float = 0.0) -> Reduced:
    """Eliminate the poses. With Vk = L L^T, Wk Vk^-1 Wk^T is the square of L^-1 Wk^T."""
    V = normal.V * (1 + damping * np.eye(6))
    roots = np.asarray(np.linalg.inv(np.linalg.cholesky(V)))
    diagonal, S = np.diag(normal.U), None
    for begin in range(0, len(V), _ELIMINATED):
        views = slice(begin, begin + _ELIMINATED)
        Y = roots[views] @ np.swapaxes(normal.W[views], 1, 2)
        Y = Y.reshape(6 * len(Y), len(diagonal))
        # In place where it can be: with hundreds of parameters new memory costs more than sums.
        S = np.subtract(normal.U if S is None else S, square := Y.T @ Y, out=square)
    assert S is not None
    S[np.diag_indices_from(S)] += damping * diagonal
    unit = 1 / np.sqrt(np.maximum(diagonal, 1e-300))
    return Reduced(S, _gradient(normal, roots), roots, unit)


def step(normal: NormalEquations, reduced: Reduced) -> tuple[Array, Array]:
    """The step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
    return _step(normal, _factored(reduced))


def _factored(reduced: Reduced) -> Factored:
    if not len(reduced.unit):
        return Factored(reduced, lambda right: right)
    # S is symmetric: its transpose is in the order that LAPACK works in, without a copy.
    factor, failed = dpotrf(reduced.scaled.T, overwrite_a=True)
    if not failed:
        return Factored(reduced, lambda right: dpotrs(factor, right)[0])
    inverse = np.linalg.pinv(reduced.scaled, rcond=1e-15, hermitian=True)
    return Factored(reduced, lambda right: inverse @ right)


def _step(normal: NormalEquations, factored: Factored) -> tuple[Array, Array]:
    """The step with a matrix of these normal equations or others close to them."""
    _, gradient, roots, unit = factored.reduced
    shared = -unit * factored.inverse(unit * gradient)
    right = normal.pose + np.tensordot(normal.W, shared, axes=([1], [0]))
    return shared, -_by_own_block(roots, right)[..., 0]


def _gradient(normal: NormalEquations, roots: Array) -> Array:
    """(P,) gc - sum_k Wk Vk^-1 gk."""
    by_pose = normal.W @ _by_own_block(roots, normal.pose)
    return np.asarray(normal.shared - by_pose[..., 0].sum(axis=0))


def _by_own_block(roots: Array, right: Array) -> Array:
    """(K, 6, 1) Vk^-1 times (K, 6)."""
    return np.asarray(np.swapaxes(roots, 1, 2) @ (roots @ right[..., None]))


def solve(normal: NormalEquations, damping: float) -> tuple[Array, Array]:
    """The damped step: (P,) shared and (K, 6) poses."""
    return step(normal, schur(normal, damping))


def _decrease(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Decrease of the cost that the linear model predicts of a step, without its curvature."""
    return -float(by_shared @ normal.shared + np.sum(by_pose * normal.pose))


def _scaled_gradient(normal: NormalEquations) -> float:
    """Largest gradient entry, unknowns scaled to a unit diagonal of J^T J."""
    shared = np.abs(normal.shared) / np.sqrt(np.maximum(np.diag(normal.U), 1e-300))
    poses = np.abs(normal.pose) / np.sqrt(np.diagonal(normal.V, axis1=1, axis2=2))
    return float(max(shared.max(initial=0.0), poses.max(initial=0.0)))


def _scaled_length(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Root mean square change of the residuals' scale that a step makes, unknowns scaled alike."""
    square = np.sum(np.diag(normal.U) * by_shared**2)
    square += np.sum(np.diagonal(normal.V, axis1=1, axis2=2) * by_pose**2)
    return float(np.sqrt(square))
